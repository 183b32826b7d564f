//! What ties bodies at rest: lines, motors of sliders, mooring lines as linear springs, and steady forces.

use crate::{
    math::{Bivector, Matrix, Vector},
    solid::mooring::MooringSpec,
};

/// A line between two bodies, or a body and the ground.
pub(super) struct Line<const D: usize> {
    pub(super) name: String,
    /// Tension at which it breaks, N; infinite if it does not.
    pub(super) strength: f64,
    /// Numbers of the bodies; `None`: the ground.
    pub(super) bodies: [Option<usize>; 2],
    pub(super) at: [Vector<D>; 2],
    pub(super) stiffness: f64,
    /// Length without tension, m.
    pub(super) length: f64,
    /// Whether it bears compression.
    pub(super) pushes: bool,
    pub(super) is_rope: bool,
    /// Whether its ends come to hang one above the other.
    pub(super) hangs: bool,
}

/// A steady force on a body, N, and its point of application, m.
pub(super) struct SteadyForce<const D: usize> {
    pub(super) body: usize,
    pub(super) at: Vector<D>,
    pub(super) force: Vector<D>,
    pub(super) torque: Bivector<D>,
    /// Whether both turn with the body.
    pub(super) turns: bool,
}

/// The motor of a slider between two bodies, or a body and the ground.
pub(super) struct Drive<const D: usize> {
    /// Numbers of the bodies; `None`: the ground. It drives the second.
    pub(super) bodies: [Option<usize>; 2],
    /// Its direction.
    pub(super) along: Vector<D>,
    /// Force (N) where the joint starts.
    pub(super) force: f64,
    /// Stiffness, N/m.
    pub(super) stiffness: f64,
    /// Largest force, N.
    pub(super) largest: f64,
}

/// Stiffness of a line against motions of its ends.
#[derive(Clone, Copy)]
pub(super) struct LineStiffness<const D: usize> {
    /// Its direction.
    pub(super) unit: Vector<D>,
    /// Against its stretch, N/m.
    pub(super) along: f64,
    /// Against its turn, N/m.
    pub(super) across: f64,
}

impl<const D: usize> LineStiffness<D> {
    /// Returns the force (N/m) against a motion of an end along `way`, along another one.
    pub(super) fn between(&self, way: &Vector<D>, other: &Vector<D>) -> f64 {
        let stretch = self.unit.dot(way) * self.unit.dot(other);
        self.along * stretch + self.across * (way.dot(other) - stretch)
    }
}

/// The end of a mooring line on a free body.
pub(crate) struct MooredEnd<const D: usize> {
    /// Number of the solid.
    pub(crate) solid: usize,
    /// Initial place, m.
    pub(crate) at: Vector<D>,
    /// Force (N/m) against a displacement of this end, with the line at rest.
    pub(crate) stiffness: Matrix<D>,
}

impl<const D: usize> MooredEnd<D> {
    /// The ends of a line on free bodies; `stiffness` gives that of an end by its number. A line between two free bodies has none to the
    /// ground.
    pub(crate) fn of(
        spec: &MooringSpec<D>,
        is_free: impl Fn(usize) -> bool,
        stiffness: impl Fn(usize) -> Matrix<D>,
    ) -> Vec<Self> {
        let free = spec.ends.each_ref().map(|end| end.solid.filter(|solid| is_free(*solid)));
        let own = |k: usize| {
            let solid = free[k].filter(|_| free[1 - k].is_none())?;
            Some(Self { solid, at: spec.ends[k].at, stiffness: stiffness(k) })
        };
        (0..2).filter_map(own).collect()
    }
}

/// Returns the force (N) of a line at `at` towards its fixed end: for a spring by its length, for a rope as at rest.
pub(super) fn tension_towards<const D: usize>(line: &Line<D>, at: &Vector<D>, end: &Vector<D>, rest: f64) -> Vector<D> {
    let along = end - at;
    let length = along.norm();
    let stretch = length - line.length;
    if rest == 0.0 || length == 0.0 {
        return Vector::zeros();
    }
    along / length * if line.is_rope { rest } else { line.stiffness * stretch }
}
