//! Walls: the density, velocity and repulsion with which a boundary particle acts on the water.

mod dynamic;
mod relaxed_adami;
mod repulsion;
mod slip;

pub(crate) use dynamic::DynamicBoundary; //NARROW
pub(crate) use relaxed_adami::SupportCoverage; //NARROW
pub(crate) use relaxed_adami::WallExtrapolation; //NARROW
pub(crate) use relaxed_adami::relaxation; //NARROW
pub use repulsion::Repulsion;
pub(crate) use slip::Slip; //NARROW
pub(crate) use slip::no_slip_velocity; //NARROW
