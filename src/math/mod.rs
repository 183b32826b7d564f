//! Mathematics without physics: vectors and rotations, time series, readings, tables, formulas, SIMD numbers, number formats.

mod config;
mod dimension;
pub mod expression;
#[doc(hidden)]
pub mod format;
mod poles;
pub mod readings;
#[doc(hidden)]
pub mod simd;
#[doc(hidden)]
pub mod table;
pub mod time_series;
mod vector;

pub use config::{BoxConfig, NumberOrArray};
pub(crate) use dimension::in_dimension;
pub(crate) use poles::find_pole;
pub(crate) use vector::rotated_tensor;
pub use vector::{Bivector, Bounds, Matrix, Pose, Vector};
