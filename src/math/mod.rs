//! Mathematics without physics: vectors and rotations, time series, formulas, SIMD numbers, number formats.

mod config;
pub mod expression;
pub mod format;
pub mod simd;
pub mod time_series;
mod vector;

pub use config::BoxConfig;
pub use config::NumberOrArray;
pub use vector::Bivector;
pub use vector::Bounds;
pub use vector::Matrix;
pub use vector::Pose;
pub use vector::Vector;
