//! Walls: by what density a boundary particle shows itself to the water.

mod dbc;
mod settling;

pub use dbc::Dbc;
pub use settling::{Fit, settled};
