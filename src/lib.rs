//! pontoon: rigid bodies that float, collide and are driven in water.
//!
//! δ-SPH computes the water; rapier computes the bodies, contacts and joints. A [`Scene`](scene::Scene), read from TOML or built in
//! Rust, becomes a [`Simulation`](simulation::Simulation), which advances a [`System`](system::System) of water and solids. Probes
//! sample it. A [`Setup`](simulation::Setup) starts a simulation without a scene.
//!
//! ```
//! use pontoon::prelude::*;
//!
//! let scene = Scene::new(2, 0.05, 1.0)
//!     .water_box([0.0, 0.0], [1.0, 0.5])
//!     .solid(SolidConfig::fixed("tank", ShapeConfig::tank([1.0, 1.0])))
//!     .solid(SolidConfig::free("crate", ShapeConfig::cuboid([0.2, 0.2]), 500.0).at(PlacementConfig::afloat(&[0.5])));
//! let mut simulation = Simulation::new(scene.build::<2>()?.setup)?;
//! while simulation.time() < 0.05 {
//!     simulation.step()?;
//! }
//! let weight = 9.81 * 500.0 * 0.2 * 0.2;
//! let lift = simulation.system().solids()[1].load.force[1];
//! assert!((lift / weight - 1.0).abs() < 0.1, "the crate floats: the water carries its weight");
//! # Ok::<(), Error>(())
//! ```
//!
//! # Modules, in dependency order
//!
//! | module | content |
//! |---|---|
//! | [`error`] | errors with place, expectation and remedy |
//! | [`math`] | vectors, bivectors, poses, time series, formulas, SIMD numbers |
//! | [`ranks`] | processes or threads that compute one simulation together |
//! | [`sph`] | the equations of the water, one law a file |
//! | [`particles`] | arrays of particles |
//! | [`geometry`] | shapes, submerged volumes, meshes, filling and packing |
//! | [`neighbours`] | neighbour lists |
//! | [`wavemaker`] | wave theory, transfer functions, absorption |
//! | [`solid`] | solids, constraints, hydrostatics, and rapier |
//! | [`interaction`] | the pair loop: f64 reference and SIMD |
//! | [`model`] | the chosen laws |
//! | [`system`] | water and solids at one instant, and their rates |
//! | [`coupling`] | the body step, acoustic added mass, load breakdown, energy budget |
//! | [`time_integration`] | step size, symplectic and Verlet schemes |
//! | `device` | whole steps on a graphics card (feature `gpu`) |
//! | [`simulation`] | steps, rollback, adding and removing solids, external bodies |
//! | [`plan`], [`probe`], [`analysis`], [`output`] | what a run samples, judges and writes |
//! | [`scene`] | the TOML scene |
//! | [`preflight`], [`run`] | checks before a run, and a run with its files |
//! | `report`, `study`, `bench` | pages, studies and timings of the program (feature `cli`) |
//!
//! # Cargo features
//!
//! | feature | adds |
//! |---|---|
//! | `dim2`, `dim3` (default) | the engine for bodies in 2-D, in 3-D; one of them at least |
//! | `cli` (default) | the program `pontoon` and the modules behind it |
//! | `gpu` | whole steps on a graphics card |
//! | `mpi` | one run on several machines, by MPI |
//! | `surface` | meshes of the free surface from 3-D frames |

#![cfg_attr(test, allow(clippy::unwrap_used, clippy::expect_used, reason = "tests may"))]

pub mod error;
pub mod math;
pub mod ranks;
pub mod sph;
#[doc(hidden)]
pub mod particles;
pub mod geometry;
#[doc(hidden)]
pub mod neighbours;
pub mod wavemaker;
pub mod solid;
#[doc(hidden)]
pub mod interaction;
pub mod model;
pub mod system;
#[doc(hidden)]
pub mod coupling;
#[doc(hidden)]
pub mod time_integration;
#[cfg(feature = "gpu")]
pub mod device;
pub mod simulation;
#[doc(hidden)]
pub mod plan;
pub mod probe;
pub mod analysis;
pub mod output;
pub mod scene;
#[doc(hidden)]
pub mod preflight;
pub mod run;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod report;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod study;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod bench;
pub mod prelude;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;

pub use error::{Error, Result};

#[cfg(test)]
#[path = "../tests/house.rs"]
mod house;

/// The programs of a document, compiled and run as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/how-to/use-from-rust.md")]
pub struct DocumentedPrograms;
