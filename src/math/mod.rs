//! Mathematics without physics: vectors and rotations, time series, formulas, SIMD numbers, number formats.

mod config;
pub mod expression; //HIDE
pub mod format; //HIDE
pub mod simd; //HIDE
pub mod time_series; //HIDE
mod vector;

pub(crate) use config::BoxConfig; //NARROW
pub(crate) use config::NumberOrArray; //NARROW
pub use vector::Bivector;
pub use vector::Bounds; //HIDE
pub use vector::Matrix; //HIDE
pub use vector::Pose;
pub use vector::Vector;
