//! Running sums of the pair loop, and the rows in which they lie in memory.

use super::RequestedSums;
use crate::sph::{AuxiliarySums, Num, Term};

/// Inputs and sums that a set of terms needs beside acceleration and density rate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RequiredSums {
    /// The sums of shifting.
    pub shift: bool,
    /// Tensile repulsions.
    pub repulsion: bool,
    /// Marks of boundary particles, and the sum that suppresses shifting.
    pub suppression: bool,
    /// Stress, and the sum of strain.
    pub stress: bool,
    /// Corrected gradients.
    pub gradient_correction: bool,
    /// The renormalization matrix of the neighbours.
    pub renormalization: bool,
}

/// Entries of a symmetric tensor that are kept.
const fn entries(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

impl RequiredSums {
    /// The needs of the terms `Y`.
    pub(crate) const fn of_terms<Y: Term<D>, const D: usize>() -> Self {
        Self {
            shift: Y::SHIFT,
            repulsion: Y::REPULSION,
            suppression: Y::SHIFTING_SUPPRESSION,
            stress: Y::STRESS,
            gradient_correction: Y::GRADIENT_CORRECTION,
            renormalization: Y::RENORMALIZATION,
        }
    }

    /// Whether there are sums.
    pub(crate) const fn any_auxiliary(self) -> bool {
        self.shift || self.suppression || self.stress || self.renormalization
    }

    #[inline(always)]
    pub(super) const fn held_at(self, dimension: usize) -> usize {
        dimension + 1 + if self.shift { dimension + 1 } else { 0 }
    }

    #[inline(always)]
    pub(super) const fn strain_at(self, dimension: usize) -> usize {
        self.held_at(dimension) + if self.suppression { 1 } else { 0 }
    }

    #[inline(always)]
    const fn moment_at(self, dimension: usize) -> usize {
        self.strain_at(dimension) + if self.stress { entries(dimension) } else { 0 }
    }

    /// Number of rows of sums: acceleration and density rate, then those that the terms need.
    #[inline(always)]
    pub(super) const fn sum_rows(self, dimension: usize) -> usize {
        self.moment_at(dimension) + if self.renormalization { entries(dimension) } else { 0 }
    }

    /// Number of rows of the sums `requested`.
    #[inline(always)]
    pub(super) const fn requested_rows(self, dimension: usize, requested: RequestedSums) -> usize {
        match requested {
            RequestedSums::Rates => dimension + 1,
            RequestedSums::All => self.sum_rows(dimension),
        }
    }

    /// Row of the repulsion among the additional inputs; the mark comes before it.
    pub(super) const fn repulsion_row(self) -> usize {
        if self.suppression { 1 } else { 0 }
    }

    /// The first row of stress, after the repulsion.
    pub(super) const fn stress_row(self) -> usize {
        self.repulsion_row() + if self.repulsion { 1 } else { 0 }
    }

    /// The first row of the corrected gradient, after the stress.
    pub(super) const fn gradient_correction_row(self, dimension: usize) -> usize {
        self.stress_row() + if self.stress { entries(dimension) } else { 0 }
    }

    /// Number of rows of additional inputs.
    pub(super) const fn input_rows(self, dimension: usize) -> usize {
        self.gradient_correction_row(dimension) + if self.gradient_correction { entries(dimension) } else { 0 }
    }
}

/// Running sums of a particle, or of eight.
#[derive(Clone, Copy)]
pub(super) struct Accumulators<N, const D: usize> {
    pub(super) acceleration: [N; D],
    pub(super) compression_rate: N,
    pub(super) auxiliary: AuxiliarySums<N, D>,
}

impl<N: Num, const D: usize> Accumulators<N, D> {
    /// All `zero`.
    #[inline(always)]
    pub(super) fn filled_with(zero: N) -> Self {
        Self { acceleration: [zero; D], compression_rate: zero, auxiliary: AuxiliarySums::filled_with(zero) }
    }

    /// Calls `visit` with acceleration and density rate and their rows.
    #[inline(always)]
    pub(super) fn for_each_rate(&mut self, mut visit: impl FnMut(usize, &mut N)) {
        for (k, dv) in self.acceleration.iter_mut().enumerate() {
            visit(k, dv);
        }
        visit(D, &mut self.compression_rate);
    }
}

/// Calls `visit` with each auxiliary sum that terms with the needs `own` compute, and with its row among the rows for the needs
/// `all`.
#[inline(always)]
pub(super) fn for_each_auxiliary<N, const D: usize>(
    sums: &mut AuxiliarySums<N, D>,
    own: RequiredSums,
    all: RequiredSums,
    mut visit: impl FnMut(usize, &mut N),
) {
    if own.shift {
        for (k, gradient) in sums.concentration_gradient.iter_mut().enumerate() {
            visit(D + 1 + k, gradient);
        }
        visit(2 * D + 1, &mut sums.position_divergence);
    }
    if own.suppression {
        visit(all.held_at(D), &mut sums.shifting_suppressed);
    }
    if own.stress {
        for_each_symmetric_entry(&mut sums.strain, all.strain_at(D), &mut visit);
    }
    if own.renormalization {
        for_each_symmetric_entry(&mut sums.renormalization, all.moment_at(D), &mut visit);
    }
}

/// Calls `visit` with the entries of a symmetric tensor that are kept, and their rows from `row` on.
#[inline(always)]
pub(super) fn for_each_symmetric_entry<N, const D: usize>(
    tensor: &mut [[N; D]; D],
    row: usize,
    visit: &mut impl FnMut(usize, &mut N),
) {
    // Loops of constant length, so that the entries stay in registers.
    for (i, entries) in tensor.iter_mut().enumerate() {
        for (j, entry) in entries.iter_mut().enumerate() {
            if j <= i {
                visit(row + i * (i + 1) / 2 + j, entry);
            }
        }
    }
}
