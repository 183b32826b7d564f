//! Mooring lines with mass as linear springs about the places of the bodies that they hold.

use super::StaticSystem;
use crate::math::{Matrix, Vector};

/// The end of a mooring line on a free body.
pub(crate) struct MooredEnd<const D: usize> {
    /// Number of the solid.
    pub(crate) solid: usize,
    /// Initial place, m.
    pub(crate) at: Vector<D>,
    /// Force (N/m) against a displacement of this end, with the line at rest.
    pub(crate) stiffness: Matrix<D>,
}

impl<const D: usize> StaticSystem<'_, D> {
    /// The same system, with mooring lines of this stiffness.
    pub(crate) fn with_mooring_stiffness(self, moored: Vec<MooredEnd<D>>) -> Self {
        Self { moored, ..self }
    }

    /// Returns the number of the body that is this solid.
    pub(super) fn number(&self, solid: usize) -> Option<usize> {
        self.bodies.iter().position(|body| body.solid == solid)
    }

    /// Returns the stiffness (N/m) of mooring lines against a rise of body `i`.
    pub(super) fn mooring_stiffness(&self, i: usize) -> f64 {
        let rises = |own: &&MooredEnd<D>| self.number(own.solid).is_some_and(|j| self.group[j] == self.group[i]);
        self.moored.iter().filter(rises).map(|own| own.stiffness[(D - 1, D - 1)]).sum()
    }
}
