//! The contribution of a pair of particles to the sums of both: one text for the reference, the SIMD lanes and the trace.

use super::accumulators::Accumulators;
use crate::sph::{Num, Pair, PairGeometry, PairSide, Term, kernel::Kernel};

/// A pair, and what a law gives for it.
pub(super) struct PairContribution<N, const D: usize> {
    pair: Pair<N, D>,
    /// V₀ ∂W.
    factor: N,
    /// Acceleration of the first particle.
    force: [N; D],
    /// Rates of both without the factor.
    rate: (N, N),
}

impl<N: Num, const D: usize> PairContribution<N, D> {
    /// The pair of `a` and `b` under the law `law`. Unless `CORRECTED`, neither has a gradient
    /// correction.
    #[inline(always)]
    pub(super) fn new<K: Kernel, L: Term<D>, const CORRECTED: bool>(
        (kernel, law): (&K, &L),
        geometry: PairGeometry<N, D>,
        eta2: N,
        a: PairSide<N, D>,
        b: PairSide<N, D>,
    ) -> Self {
        let (r_ab, v_ab, r2, _) = geometry;
        let zero = r2.constant(0.0);
        let factor = kernel.slope(r2);
        let pair = Pair::new(geometry, kernel.w(r2), eta2, a, b);
        let along_r = factor * law.along_r(&pair, zero);
        let mut force = [zero; D];
        for (force, r) in force.iter_mut().zip(&r_ab) {
            *force = along_r * *r;
        }
        if L::ALONG_V {
            let along_v = factor * law.along_v(&pair, zero);
            for (force, v) in force.iter_mut().zip(&v_ab) {
                *force = along_v.fma(*v, *force);
            }
        }
        if L::STRESS || L::VECTOR && CORRECTED {
            let vector = law.vector(&pair, [zero; D]);
            for (force, vector) in force.iter_mut().zip(&vector) {
                *force = factor.fma(*vector, *force);
            }
        }
        let rate = law.rate(&pair, (zero, zero));
        Self { pair, factor, force, rate }
    }

    /// |v_ab·r_ab|/(r² + η²) within the support, whose square is `reach2`, else 0.
    #[inline(always)]
    pub(super) fn approach_rate(&self, reach2: N) -> N {
        let zero = reach2.constant(0.0);
        self.pair.r2.select_below(reach2, self.pair.velocity_along_r.abs() * self.pair.inv_r2, zero)
    }

    /// Adds it to the acceleration and density rate of `a` and `b`.
    #[inline(always)]
    pub(super) fn add_rates(&self, a: &mut Accumulators<N, D>, b: &mut Accumulators<N, D>) {
        for (k, force) in self.force.iter().enumerate() {
            a.acceleration[k] = a.acceleration[k] + *force;
            b.acceleration[k] = b.acceleration[k] - *force;
        }
        a.compression_rate = self.factor.fma(self.rate.0, a.compression_rate);
        b.compression_rate = self.factor.fma(self.rate.1, b.compression_rate);
    }

    /// Adds what `law` gives to the auxiliary sums of `a` and `b`.
    #[inline(always)]
    pub(super) fn add_auxiliary<L: Term<D>>(&self, law: &L, a: &mut Accumulators<N, D>, b: &mut Accumulators<N, D>) {
        if L::AUXILIARY {
            law.auxiliary(&self.pair, self.factor, &mut a.auxiliary, &mut b.auxiliary);
        }
    }
}
