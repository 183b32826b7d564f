//! pontoon: rigid bodies that float, collide and are driven in water.
//!
//! δ-SPH computes the water, rapier the bodies with their contacts and joints. A [`Scene`] is built into
//! a [`Simulation`], which steps a [`System`] of water and solids; probes watch, records keep, checks judge.
//! The rooms stand in the order in which they depend on one another.

// words
pub mod error;
pub mod series;
pub mod space;
// equations
pub mod law;
// matter
pub mod particles;
pub mod shape;
pub mod solid;
// motion
pub mod model;
pub mod near;
pub mod probe;
pub mod simulation;
pub mod sweep;
pub mod system;
pub mod time;
// results
pub mod check;
pub mod record;
// entrance
pub mod run;
pub mod scene;

pub use error::{Error, Result};
