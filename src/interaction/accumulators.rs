//! Running sums, and in which rows they lie in memory.

use crate::sph::{AuxiliarySums, Num, Term};

/// What a set of laws reads and sums beside acceleration and density rate.
#[derive(Clone, Copy, Debug)]
pub struct RequiredSums {
    /// The sums of shifting.
    pub shift: bool,
    /// Tensile repulsions.
    pub repulsion: bool,
    /// Marks, and the sum that holds shifting back.
    pub suppression: bool,
    /// Stress, and the sum of strain.
    pub stress: bool,
    /// Corrected gradients.
    pub gradient_correction: bool,
    /// The moment of the neighbours.
    pub moment: bool,
}

/// Entries of a symmetric tensor that are kept.
const fn entries(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

impl RequiredSums {
    /// Those of the laws `Y`.
    pub const fn of<Y: Term<D>, const D: usize>() -> Self {
        Self {
            shift: Y::SHIFT,
            repulsion: Y::REPULSION,
            suppression: Y::MARK,
            stress: Y::STRESS,
            gradient_correction: Y::FORM,
            moment: Y::MOMENT,
        }
    }

    /// Whether there are sums.
    pub const fn any(self) -> bool {
        self.shift || self.suppression || self.stress || self.moment
    }

    const fn held_at(self, dimension: usize) -> usize {
        dimension + 1 + if self.shift { dimension + 1 } else { 0 }
    }

    const fn strain_at(self, dimension: usize) -> usize {
        self.held_at(dimension) + if self.suppression { 1 } else { 0 }
    }

    const fn moment_at(self, dimension: usize) -> usize {
        self.strain_at(dimension) + if self.stress { entries(dimension) } else { 0 }
    }

    /// Rows of sums: acceleration and density rate, then what the laws ask for.
    pub(super) const fn sums(self, dimension: usize) -> usize {
        self.moment_at(dimension) + if self.moment { entries(dimension) } else { 0 }
    }

    /// The row of repulsion among the inputs beside places, velocities and densities; before it is the mark.
    pub(super) const fn repulsion_at(self) -> usize {
        if self.suppression { 1 } else { 0 }
    }

    /// The first row of stress, after the repulsion.
    pub(super) const fn stress_at(self) -> usize {
        self.repulsion_at() + if self.repulsion { 1 } else { 0 }
    }

    /// The first row of the corrected gradient, after the stress.
    pub(super) const fn form_at(self, dimension: usize) -> usize {
        self.stress_at() + if self.stress { entries(dimension) } else { 0 }
    }

    /// Rows of such inputs.
    pub(super) const fn inputs(self, dimension: usize) -> usize {
        self.form_at(dimension) + if self.gradient_correction { entries(dimension) } else { 0 }
    }
}

/// Running sums of a particle, or of eight.
#[derive(Clone, Copy)]
pub(super) struct Accumulators<N, const D: usize> {
    pub(super) dv: [N; D],
    pub(super) dx: N,
    pub(super) extra: AuxiliarySums<N, D>,
}

impl<N: Num, const D: usize> Accumulators<N, D> {
    /// All `zero`.
    #[inline(always)]
    pub(super) fn all(zero: N) -> Self {
        Self { dv: [zero; D], dx: zero, extra: AuxiliarySums::all(zero) }
    }

    /// Calls `visit` with each sum that laws of needs `own` make and its row, where laws of needs `all` share the rows.
    #[inline(always)]
    pub(super) fn each(&mut self, own: RequiredSums, all: RequiredSums, mut visit: impl FnMut(usize, &mut N)) {
        for (k, dv) in self.dv.iter_mut().enumerate() {
            visit(k, dv);
        }
        visit(D, &mut self.dx);
        if own.shift {
            for (k, grad) in self.extra.concentration_gradient.iter_mut().enumerate() {
                visit(D + 1 + k, grad);
            }
            visit(2 * D + 1, &mut self.extra.position_divergence);
        }
        if own.suppression {
            visit(all.held_at(D), &mut self.extra.shifting_suppressed);
        }
        if own.stress {
            triangle(&mut self.extra.strain, all.strain_at(D), &mut visit);
        }
        if own.moment {
            triangle(&mut self.extra.moment, all.moment_at(D), &mut visit);
        }
    }
}

/// Calls `visit` with the entries of a symmetric tensor that are kept, and their rows from `row` on.
#[inline(always)]
pub(super) fn triangle<N, const D: usize>(
    tensor: &mut [[N; D]; D],
    mut row: usize,
    visit: &mut impl FnMut(usize, &mut N),
) {
    for (i, entries) in tensor.iter_mut().enumerate() {
        for entry in &mut entries[..=i] {
            visit(row, entry);
            row += 1;
        }
    }
}
