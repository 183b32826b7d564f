//! Walls: by what density a boundary particle shows itself to the water.

mod dynamic;
mod relaxed_adami;
mod repulsion;
mod slip;

pub use dynamic::Dbc;
pub use relaxed_adami::{Cover, Fit, settled};
pub use repulsion::Barrier;
pub use slip::{Slip, sticking};
