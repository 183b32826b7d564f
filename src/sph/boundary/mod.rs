//! Walls: the density, velocity and repulsion with which a boundary particle acts on the water.

mod dynamic;
mod relaxed_adami;
mod repulsion;
mod slip;

pub use dynamic::DynamicBoundary;
pub use relaxed_adami::{SupportCoverage, WallExtrapolation, relaxation};
pub use repulsion::Repulsion;
pub use slip::{Slip, no_slip_velocity};
