//! Walls: by what density a boundary particle shows itself to the water.

mod dbc;
mod extrapolating;

pub use dbc::Dbc;
pub use extrapolating::{Fit, Place};
