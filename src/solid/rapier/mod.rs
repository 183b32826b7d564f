//! The rigid-body engine rapier behind one trait, in two and three dimensions from one source.

mod engine;
#[cfg(feature = "dim2")]
pub mod rapier2d;
#[cfg(feature = "dim3")]
pub(crate) mod rapier3d; //NARROW

pub(crate) use engine::ContactForce; //NARROW
pub use engine::Dim;
pub(crate) use engine::Engine; //NARROW
pub(crate) use engine::EngineFault; //NARROW
pub(crate) use engine::HasEngine; //NARROW
