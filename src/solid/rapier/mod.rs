//! The rigid-body engine rapier behind one trait, in two and three dimensions from one source.

mod engine;
#[cfg(feature = "dim2")]
pub mod rapier2d;
#[cfg(feature = "dim3")]
pub mod rapier3d;

pub use engine::{ContactForce, Dim, Engine, EngineFault, HasEngine};
