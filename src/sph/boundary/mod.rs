//! Walls: the density, velocity and repulsion with which a boundary particle acts on the water.

mod dynamic;
mod relaxed_adami;
mod repulsion;
mod slip;

pub(crate) use dynamic::DynamicBoundary; //NARROW
pub use relaxed_adami::SupportCoverage;
pub use relaxed_adami::WallExtrapolation;
pub use relaxed_adami::relaxation;
pub use repulsion::Repulsion;
pub use slip::Slip;
pub use slip::no_slip_velocity;
