//! Walls: by what density a boundary particle shows itself to the water.

mod dbc;
mod settling;
mod slip;

pub use dbc::Dbc;
pub use settling::{Fit, settled};
pub use slip::{Slip, sticking};
