//! The native part of the Python package: scenes, runs and simulations. The classes for users are in
//! `python/pontoon/`, and use what is here.

mod bodies;
mod error;
mod run;
mod scene;
mod simulation;
mod threads;
mod water;
mod world;

use std::ffi::OsString;

use pyo3::prelude::*;

use crate::error::OrRaise;

/// The native part of the package `pontoon`.
#[pymodule]
mod _pontoon {
    #[pymodule_export]
    use super::{
        bodies::{BodyState, BodyStep, Load},
        bundled_scenes, check_cases, main,
        run::{frame, frame_times, resume, statistics, unit, write_report},
        scene::NativeScene,
        simulation::NativeSimulation,
        version,
        water::Lease,
    };
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::threads::remember_process();
        Ok(())
    }
}

/// Returns the version of the program.
#[pyfunction]
fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// Returns name, caption and first sentence of the scenes that come with the package.
#[pyfunction]
fn bundled_scenes() -> Vec<(String, String, String)> {
    let all = pontoon::cli::scene_lookup::scene_infos();
    all.into_iter().map(|scene| (scene.name, scene.title, scene.about)).collect()
}

/// Refuses names of validation cases that do not exist.
#[pyfunction]
fn check_cases(py: Python<'_>, names: Vec<String>) -> PyResult<()> {
    pontoon::study::select_cases(&names, false).map(drop).or_raise(py)
}

/// Runs the command line of the program, of which the first argument is its name, and returns the exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| pontoon::cli::main(arguments))
}
