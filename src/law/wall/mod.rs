//! Walls: by what density a boundary particle shows itself to the water.

mod barrier;
mod dbc;
mod settling;
mod slip;

pub use barrier::Barrier;
pub use dbc::Dbc;
pub use settling::{Cover, Fit, settled};
pub use slip::{Slip, sticking};
