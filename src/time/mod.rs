//! The equations in time: how long a step may be, and how a step is made. No pairs.

mod bodies;
mod books;
mod light;
pub mod limit;
mod symplectic;
mod verlet;

pub use bodies::{Bodies, Handover};
pub(crate) use books::Books;
pub use books::{Ledger, Shares};
pub(crate) use light::{Held, Light};
pub use symplectic::Symplectic;
pub use verlet::Verlet;

use serde::{Deserialize, Serialize};

use crate::{
    model::{Model, Scheme},
    space::Vector,
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

    /// Lets the velocities before, from which a next step goes on, have what the water was given: which, and how much (m/s).
    pub(crate) fn given(&mut self, gifts: &[(Vec<usize>, Vector<D>)]) {
        if let Self::Verlet(verlet) = self {
            let before = verlet.before_mut();
            gifts.iter().for_each(|(these, share)| these.iter().for_each(|&i| before[i] += *share));
        }
    }

    /// Forgets the step before, after particles have come or gone; the next step is one that needs none.
    pub(crate) fn forget(&mut self) {
        if let Self::Verlet(verlet) = self {
            verlet.forget();
        }
    }

    /// Moves the water of the system, whose rates at the start are known, over an interval; returns the weight with which the
    /// loads of the last force pass then act on the bodies, –. Keeps the `books`, if there are any.
    pub(crate) fn step(&mut self, system: &mut System<D>, over: Interval, mut books: Option<&mut Books<D>>) -> f64 {
        let weight = match self {
            Self::Verlet(verlet) => verlet.step(system, over, books.as_deref_mut()),
            Self::Symplectic => Symplectic.step(system, over, books.as_deref_mut()),
        };
        let before = if let Self::Verlet(verlet) = self { Some(verlet.before_mut()) } else { None };
        let taken = system.damp(over.dt, before, books.as_ref().is_some_and(|books| books.energy));
        books.into_iter().for_each(|books| books.damped(taken));
        weight
    }
}
