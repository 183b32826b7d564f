//! The equations in time: how long a step may be, and how a step is made. No pairs.

mod bodies;
mod light;
pub mod limit;
mod symplectic;
mod verlet;

pub use bodies::Bodies;
pub(crate) use light::{Held, Light};
pub use symplectic::Symplectic;
pub use verlet::Verlet;

use serde::{Deserialize, Serialize};

use crate::{
    error::Result,
    model::{Model, Scheme},
    system::{Renewal, System},
};

/// Where a step starts and how long it is, s.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    /// Time at its start, s.
    pub t: f64,
    /// Its length, s.
    pub dt: f64,
}

/// The chosen scheme with what it remembers.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Stepper<const D: usize> {
    /// Verlet.
    Verlet(Verlet<D>),
    /// Symplectic.
    Symplectic,
}

impl<const D: usize> Stepper<D> {
    /// The stepper of a model's scheme, at the start of a run.
    pub fn new(model: &Model) -> Self {
        match model.scheme {
            Scheme::Verlet { euler_every } => Self::Verlet(Verlet::new(euler_every, model)),
            Scheme::Symplectic => Self::Symplectic,
        }
    }

    /// Follows the particles to new lists in water of reference density `rho0` (kg/m³).
    pub(crate) fn follow(&mut self, renewal: &Renewal<D>, rho0: f64) {
        if let Self::Verlet(verlet) = self {
            verlet.follow(renewal, rho0);
        }
    }

    /// Moves the system, whose rates at the start are known, over an interval.
    ///
    /// # Errors
    /// Whatever stops the bodies: see [`crate::solid::EngineFault`].
    pub fn step(&mut self, system: &mut System<D>, bodies: &mut Bodies<D>, over: Interval) -> Result<()> {
        let before = match self {
            Self::Verlet(verlet) => {
                verlet.step(system, bodies, over)?;
                Some(verlet.before_mut())
            }
            Self::Symplectic => {
                Symplectic.step(system, bodies, over)?;
                None
            }
        };
        system.damp(over.dt, before);
        Ok(())
    }
}
