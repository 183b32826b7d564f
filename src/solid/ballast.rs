//! Ballast: masses at points of a free body that change with time, such as ballast water, payload or fuel.
//!
//! A body of mass m, centre of mass c and inertia I that takes a point mass μ at x has, with d = x − c,
//!
//!   m' = m + μ,   c' = c + (μ/m') d,   I' = I + (m μ/m') (|d|² 1 − d dᵀ)

use super::{FreeBody, Role, SolidSpec, TimeFunction};
use crate::math::{Matrix, Vector};

/// Number of intervals of a run at whose ends the mass of a body is sought.
const INTERVALS: u32 = 1000;

/// Share of the largest mass below zero that counts as round-off.
const ROUND_OFF: f64 = 1e-9;

/// A mass at a point of a free body, as a function of time. It arrives and leaves with the velocity of that point.
///
/// ```
/// use pontoon::{prelude::*, solid::BallastSpec};
///
/// let hull = Shape::Box { size: [0.4, 0.1].into() };
/// let tank = BallastSpec::new([0.15, 0.0], 2.0);
/// let raft = SolidSpec::free("raft", hull, 500.0).ballast(tank);
/// assert!((raft.body_at(0.0).unwrap().mass - 22.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BallastSpec<const D: usize> {
    /// Its point in the solid's frame, m.
    pub at: Vector<D>,
    /// Its mass, kg (kg/m in 2-D); a negative value counts as 0.
    pub mass: TimeFunction,
}

impl<const D: usize> BallastSpec<D> {
    /// The mass `mass` (kg; kg/m in 2-D) at the point `at` (m) of the solid's frame.
    pub fn new(at: impl Into<Vector<D>>, mass: impl Into<TimeFunction>) -> Self {
        Self { at: at.into(), mass: mass.into() }
    }

    /// Its mass (kg; kg/m in 2-D) at time `t` (s).
    pub fn mass_at(&self, t: f64) -> f64 {
        let mass = self.mass.value_and_rate(t).0;
        // A comparison keeps a value that is not a number.
        if mass < 0.0 { 0.0 } else { mass }
    }

    /// The first time (s) of a run of `until` s at which the mass is negative beyond round-off, or not finite, and the mass (kg)
    /// then. All samples of a table count.
    pub(crate) fn first_invalid(&self, until: f64) -> Option<(f64, f64)> {
        let mut values: Vec<(f64, f64)> = Vec::new();
        if let TimeFunction::Table(series) = &self.mass {
            values.extend(series.times().iter().copied().zip(series.values().iter().copied()));
        }
        values.extend(sample_times(&self.mass, until).map(|t| (t, self.mass.value_and_rate(t).0)));
        let size = values.iter().map(|(_, mass)| mass.abs()).fold(0.0, f64::max);
        values.into_iter().find(|(_, mass)| !(mass.is_finite() && *mass >= -ROUND_OFF * size))
    }
}

impl<const D: usize> SolidSpec<D> {
    /// The same solid with another mass at one of its points. Only a free solid may have ballast.
    pub fn ballast(mut self, ballast: BallastSpec<D>) -> Self {
        self.ballast.push(ballast);
        self
    }

    /// Mass of a free solid with its ballast at time `t` (s); `None` of any other solid.
    pub fn body_at(&self, t: f64) -> Option<FreeBody<D>> {
        let Role::Free(body) = &self.role else { return None };
        Some(self.ballast.iter().fold(*body, |body, ballast| body.with_point_mass(&ballast.at, ballast.mass_at(t))))
    }

    /// Mass of a free solid with its ballast at t = 0; `None` of any other solid.
    pub fn initial_body(&self) -> Option<FreeBody<D>> {
        self.body_at(0.0)
    }

    /// Largest mass (kg; kg/m in 2-D) in a run of `until` s; `None` of a solid without ballast.
    pub(crate) fn largest_mass(&self, until: f64) -> Option<f64> {
        let times = self.ballast.iter().flat_map(|ballast| sample_times(&ballast.mass, until));
        times.filter_map(|t| self.body_at(t)).map(|body| body.mass).reduce(f64::max)
    }
}

impl<const D: usize> FreeBody<D> {
    /// The same body with a point mass `mass` (kg; kg/m in 2-D) at `at` (m) in the solid's frame; its velocities stay.
    pub fn with_point_mass(self, at: &Vector<D>, mass: f64) -> Self {
        let (all, arm) = (self.mass + mass, at - self.centre);
        let reduced = self.mass * mass / all;
        let about_centre = if D == 2 {
            Matrix::from_fn(|i, j| if (i, j) == (0, 0) { arm.norm_squared() } else { 0.0 })
        } else {
            Matrix::identity() * arm.norm_squared() - arm * arm.transpose()
        };
        Self {
            mass: all,
            centre: self.centre + arm * (mass / all),
            inertia: self.inertia + about_centre * reduced,
            ..self
        }
    }
}

/// Times (s) at which a mass is checked in a run of `until` s: evenly spaced, and the samples of a table.
fn sample_times(mass: &TimeFunction, until: f64) -> impl Iterator<Item = f64> {
    let samples = match mass {
        TimeFunction::Table(series) => series.times(),
        TimeFunction::Formula(_) | TimeFunction::Wave(_) => &[],
    };
    let even = (0..=INTERVALS).map(move |i| until * f64::from(i) / f64::from(INTERVALS));
    even.chain(samples.iter().copied().filter(move |t| (0.0..=until).contains(t)))
}

#[cfg(test)]
#[path = "../../tests/unit/solid/ballast.rs"]
mod tests;
