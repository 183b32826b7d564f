//! The sums of one slab: eight pairs at a time, each pair once. A particle is paired with later clusters; the partners receive
//! the opposite force.
//!
//! Positions are integers, whose differences are exact; all else is single precision in units of the kernel support and of the
//! time in which sound crosses h.

use fearless_simd::{SimdBase, SimdCvtFloat, SimdFloat};

use super::{
    RequestedSums,
    accumulators::{Accumulators, RequiredSums, for_each_auxiliary, for_each_symmetric_entry},
    compiled::CompiledTerms,
    pair_contribution::PairContribution,
    simd_layout::{PackedCluster, PackedParticles},
};
use crate::{
    math::simd::{self, LANES, LaneRow, Level, Simd, SimdTask, f32x8, i32x8},
    neighbours::{ListPart, Slab},
    sph::{PairSide, Term, kernel::Kernel},
};

/// Computes the sums `requested` of a slab by the terms `laws`.
pub(super) fn sum_slab<K: Kernel, T: Term<D>, W: Term<D>, const D: usize>(
    laws: &CompiledTerms<K, T, W>,
    level: Level,
    packed: &PackedParticles<D>,
    requested: RequestedSums,
    slab: &Slab,
    sums: &mut [LaneRow],
) -> f32 {
    simd::dispatch(level, SlabTask { laws: *laws, packed, requested, slab, sums })
}

/// The square of the distance from which on a kernel with this squared support is 0 in single precision, too.
pub(super) fn end_of_support(reach2: f64) -> f32 {
    (reach2 * (1.0 + 1e-5)) as f32
}

struct SlabTask<'a, K, T, W, const D: usize> {
    /// By value: the compiler then knows that writing a sum does not change it.
    laws: CompiledTerms<K, T, W>,
    packed: &'a PackedParticles<D>,
    requested: RequestedSums,
    slab: &'a Slab,
    sums: &'a mut [LaneRow],
}

/// One particle in all lanes.
struct BroadcastParticle<S: Simd, const D: usize> {
    cluster: usize,
    x: [i32x8<S>; D],
    v: [f32x8<S>; D],
    /// Remainder of the compression beyond single precision, with which differences keep their digits in deep water.
    compression_lo: f32x8<S>,
    side: PairSide<f32x8<S>, D>,
}

/// Data that every pair of a slab needs. The pair loop is compiled with and without `AUXILIARY` sums, so that the number of rows is
/// a constant and a pass without these sums keeps its registers.
#[derive(Clone, Copy)]
struct SlabInput<'a, S: Simd, K, const AUXILIARY: bool, const D: usize> {
    simd: S,
    kernel: K,
    eta2: f32x8<S>,
    reach2: f32x8<S>,
    /// From this square of the distance on, every contribution is an exact 0.
    end2: f32x8<S>,
    zero: f32x8<S>,
    clusters: &'a [PackedCluster<D>],
    /// Rows of input.
    rows: &'a [LaneRow],
    /// Whether a particle of the cluster has a gradient correction, if terms read it.
    corrected: &'a [bool],
    /// Where the slab's first cluster is packed.
    first: usize,
    /// The needs of all terms together.
    needs: RequiredSums,
}

impl<K: Kernel, T: Term<D>, W: Term<D>, const D: usize> SimdTask for SlabTask<'_, K, T, W, D> {
    type Output = f32;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> f32 {
        if const { RequiredSums::of_terms::<(T, W), D>().any_auxiliary() } && self.requested == RequestedSums::All {
            self.sum::<S, true>(simd)
        } else {
            self.sum::<S, false>(simd)
        }
    }
}

impl<K: Kernel, T: Term<D>, W: Term<D>, const D: usize> SlabTask<'_, K, T, W, D> {
    /// Computes the sums, with the auxiliary ones if `AUXILIARY`.
    #[inline(always)]
    fn sum<S: Simd, const AUXILIARY: bool>(self, simd: S) -> f32 {
        let Self { laws, packed, slab, sums, .. } = self;
        let [first, middle, end] = packed.clusters_of(slab);
        let needs = const { RequiredSums::of_terms::<(T, W), D>() };
        let given = SlabInput::<'_, S, K, AUXILIARY, D> {
            simd,
            kernel: laws.kernel,
            eta2: f32x8::splat(simd, laws.eta2 as f32),
            reach2: f32x8::splat(simd, laws.reach2 as f32),
            end2: f32x8::splat(simd, end_of_support(laws.reach2)),
            zero: f32x8::splat(simd, 0.0),
            clusters: &packed.clusters,
            rows: &packed.rows,
            corrected: &packed.corrected,
            first,
            needs,
        };
        let rows = given.sum_rows();
        sums.fill(LaneRow::default());
        let mut closing = given.zero;
        for c in first..end {
            for l in 0..LANES {
                let slot = (c - first) * LANES + l;
                if slab.is_unpaired(slot) {
                    continue;
                }
                let (one, mut sum) = (given.particle_in_lane(c, l), Accumulators::filled_with(given.zero));
                let is_water = c < middle;
                // First pairs of water particles; a boundary particle is paired with water only, by the wall terms.
                for ListPart { base, water, .. } in slab.list(slot) {
                    let water = if is_water { water } else { &[] };
                    if !needs.gradient_correction || given.corrected[c] {
                        given.add_pairs::<_, true>(&laws.fluid, &one, (base, water), sums, &mut sum, &mut closing);
                        continue;
                    }
                    // Far from the surface no particle has a correction, and most partners have none.
                    let corrected = |entry: &u16| given.corrected[first + base + usize::from(*entry)];
                    for run in water.chunk_by(|a, b| corrected(a) == corrected(b)) {
                        if corrected(&run[0]) {
                            given.add_pairs::<_, true>(&laws.fluid, &one, (base, run), sums, &mut sum, &mut closing);
                        } else {
                            given.add_pairs::<_, false>(&laws.fluid, &one, (base, run), sums, &mut sum, &mut closing);
                        }
                    }
                }
                for ListPart { base, water, boundary } in slab.list(slot) {
                    let others = if is_water { boundary } else { water };
                    given.add_pairs::<_, true>(&laws.wall, &one, (base, others), sums, &mut sum, &mut closing);
                }
                let mine = &mut sums[(c - first) * rows..][..rows];
                sum.for_each_rate(|row, sum| mine[row].0[l] += simd::sum_lanes(*sum));
                // Nobody reads those of boundary particles.
                if AUXILIARY && is_water {
                    for_each_auxiliary(&mut sum.auxiliary, needs, needs, |row, sum| {
                        mine[row].0[l] += simd::sum_lanes(*sum)
                    });
                }
            }
        }
        simd::max_lane(closing)
    }
}

impl<S: Simd, K: Kernel, const AUXILIARY: bool, const D: usize> SlabInput<'_, S, K, AUXILIARY, D> {
    /// Rows of sums of a cluster.
    #[inline(always)]
    fn sum_rows(&self) -> usize {
        self.needs.requested_rows(D, if AUXILIARY { RequestedSums::All } else { RequestedSums::Rates })
    }

    /// The particle in lane `l` of cluster `c`.
    #[inline(always)]
    fn particle_in_lane(&self, c: usize, l: usize) -> BroadcastParticle<S, D> {
        let PackedCluster { x, v, s } = &self.clusters[c];
        let all = |x: f32| f32x8::splat(self.simd, x);
        let mut one = BroadcastParticle {
            cluster: c,
            x: [i32x8::splat(self.simd, 0); D],
            v: [self.zero; D],
            compression_lo: all(s[1][l]),
            side: self.pair_side::<true>(c, [all(s[0][l]), all(s[2][l]), all(s[3][l])], |row| all(row[l])),
        };
        for k in 0..D {
            one.x[k] = i32x8::splat(self.simd, x[k][l]);
            one.v[k] = all(v[k][l]);
        }
        one
    }

    /// A side of a pair from its compression, pressure and specific volume `s`, and from the additional rows of cluster `c`,
    /// which `read` reads.
    #[inline(always)]
    fn pair_side<const CORRECTED: bool>(
        &self,
        c: usize,
        s: [f32x8<S>; 3],
        read: impl Fn(&[f32; LANES]) -> f32x8<S>,
    ) -> PairSide<f32x8<S>, D> {
        let [x, p, s] = s;
        let (repulsion, mark, none) = (self.zero, self.zero, [[self.zero; D]; D]);
        let mut side = PairSide {
            compression: x,
            p,
            specific_volume: s,
            repulsion,
            shifting_suppressed: mark,
            stress: none,
            gradient_correction: none,
        };
        let inputs = self.needs.input_rows(D);
        if inputs > 0 {
            let rows = &self.rows[c * inputs..][..inputs];
            if self.needs.suppression {
                side.shifting_suppressed = read(&rows[0].0);
            }
            if self.needs.repulsion {
                side.repulsion = read(&rows[self.needs.repulsion_row()].0);
            }
            let mut entry = |row: usize, entry: &mut f32x8<S>| *entry = read(&rows[row].0);
            if self.needs.stress {
                for_each_symmetric_entry(&mut side.stress, self.needs.stress_row(), &mut entry);
            }
            if CORRECTED && self.needs.gradient_correction {
                for_each_symmetric_entry(
                    &mut side.gradient_correction,
                    self.needs.gradient_correction_row(D),
                    &mut entry,
                );
            }
        }
        side
    }

    /// Pairs the particle `one` with the clusters `others`, counted from `base` in the slab, by the terms `law`. Adds their
    /// contributions to `sum`, and those of `one` to their `sums`. In its own cluster every particle is `one` in turn, so the
    /// contributions of `one` to this cluster are discarded into the last rows. Unless `CORRECTED`, no particle of the pairs has
    /// a gradient correction.
    #[inline(always)]
    fn add_pairs<L: Term<D>, const CORRECTED: bool>(
        &self,
        law: &L,
        one: &BroadcastParticle<S, D>,
        (base, others): (usize, &[u16]),
        sums: &mut [LaneRow],
        sum: &mut Accumulators<f32x8<S>, D>,
        closing: &mut f32x8<S>,
    ) {
        let (simd, zero, own) = (self.simd, self.zero, const { RequiredSums::of_terms::<L, D>() });
        let rows = self.sum_rows();
        let nowhere = sums.len() - rows;
        for &entry in others {
            let place = base + usize::from(entry);
            let j = self.first + place;
            let PackedCluster { x, v, s } = &self.clusters[j];
            let (mut r_ab, mut v_ab) = ([zero; D], [zero; D]);
            for k in 0..D {
                r_ab[k] = f32x8::float_from(one.x[k] - simd::load_integers(simd, &x[k]));
            }
            let mut r2 = r_ab[0] * r_ab[0];
            for d in &r_ab[1..] {
                r2 = d.mul_add(*d, r2);
            }
            // The lists reach beyond the support, as far as particles may move while they hold.
            if !simd::any_below(r2, self.end2) {
                continue;
            }
            let load = |row: &[f32; LANES]| simd::load(simd, row);
            for k in 0..D {
                v_ab[k] = one.v[k] - load(&v[k]);
            }
            let side = self.pair_side::<CORRECTED>(j, [load(&s[0]), load(&s[2]), load(&s[3])], load);
            let difference = (side.compression - one.side.compression) + (load(&s[1]) - one.compression_lo);
            let geometry = (r_ab, v_ab, r2, difference);
            let pair =
                PairContribution::new::<K, L, CORRECTED>((&self.kernel, law), geometry, self.eta2, one.side, side);
            *closing = SimdBase::max(*closing, pair.approach_rate(self.reach2));

            let at = if j == one.cluster { nowhere } else { place * rows };
            let theirs = &mut sums[at..][..rows];
            let mut b = Accumulators::filled_with(zero);
            b.for_each_rate(|row, b| *b = load(&theirs[row].0));
            pair.add_rates(sum, &mut b);
            b.for_each_rate(|row, b| b.store_array(&mut theirs[row].0));
            if AUXILIARY && own.any_auxiliary() {
                for_each_auxiliary(&mut b.auxiliary, own, self.needs, |row, b| *b = load(&theirs[row].0));
                pair.add_auxiliary(law, sum, &mut b);
                for_each_auxiliary(&mut b.auxiliary, own, self.needs, |row, b| b.store_array(&mut theirs[row].0));
            }
        }
    }
}
