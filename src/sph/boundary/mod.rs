//! Walls: the density, velocity and repulsion with which a boundary particle acts on the water.

mod dynamic;
mod relaxed_adami;
mod repulsion;
mod slip;

pub(crate) use dynamic::DynamicBoundary;
#[cfg(feature = "gpu")]
pub(crate) use relaxed_adami::RELAXATION_TIME;
#[doc(hidden)]
pub use relaxed_adami::{Cover, SupportCoverage, WallExtrapolation, WallTarget, promptness, relaxation};
pub use repulsion::Repulsion;
pub use slip::Slip;
#[cfg(feature = "gpu")]
pub(crate) use slip::no_slip_difference;
#[doc(hidden)]
pub use slip::no_slip_velocity;
