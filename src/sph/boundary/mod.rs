//! Walls: the density, velocity and repulsion with which a boundary particle acts on the water.

mod dynamic;
mod relaxed_adami;
mod repulsion;
mod slip;

pub(crate) use dynamic::DynamicBoundary; //NARROW
pub use relaxed_adami::SupportCoverage; //HIDE
pub use relaxed_adami::WallExtrapolation; //HIDE
pub use relaxed_adami::relaxation; //HIDE
pub use repulsion::Repulsion;
pub use slip::Slip; //HIDE
pub use slip::no_slip_velocity; //HIDE
