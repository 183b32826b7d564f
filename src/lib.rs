//! pontoon: rigid bodies that float, collide and are driven in water.
//!
//! δ-SPH computes the water, rapier the bodies with their contacts and joints. A [`Scene`] is built into
//! a [`Simulation`], which steps a [`System`] of water and solids; probes watch, records keep, checks judge.
//! The rooms stand in the order in which they depend on one another.

// words
pub mod error;
pub mod math;
// equations
pub mod sph;
// matter
pub mod particles;
pub mod geometry;
// neighbours and bodies
pub mod neighbours;
pub mod wavemaker;
pub mod solid;
// motion
pub mod interaction;
pub mod model;
pub mod system;
pub mod coupling;
pub mod time_integration;
pub mod simulation;
// results
pub mod plan;
pub mod probe;
pub mod analysis;
pub mod output;
// entrance
pub mod scene;
pub mod preflight;
pub mod run;
pub mod report;
pub mod study;
pub mod bench;

pub use error::{Error, Result};

/// The programs of the book, compiled and run as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/how-to/use-from-rust.md")]
#[doc = include_str!("../docs/reference/scene.md")]
pub struct DocumentedPrograms;
