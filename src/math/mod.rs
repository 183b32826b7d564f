//! Mathematics without physics: vectors and rotations, time series, formulas, SIMD numbers, number formats.

mod config;
pub(crate) mod expression; //NARROW
pub(crate) mod format; //NARROW
pub(crate) mod simd; //NARROW
pub(crate) mod time_series; //NARROW
mod vector;

pub(crate) use config::BoxConfig; //NARROW
pub(crate) use config::NumberOrArray; //NARROW
pub use vector::Bivector;
pub(crate) use vector::Bounds; //NARROW
pub(crate) use vector::Matrix; //NARROW
pub use vector::Pose;
pub use vector::Vector;
