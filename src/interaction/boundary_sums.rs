//! Extrapolation of the water to boundary particles, for relaxed Adami walls and no-slip faces: one kernel, no terms.

use fearless_simd::{SimdBase, SimdCvtFloat, SimdFloat};

use super::{
    reference::ReferenceParticle,
    simd_layout::{PackedCluster, PackedParticles},
    simd_slab::end_of_support,
};
use crate::{
    math::simd::{self, LANES, LaneRow, Level, Simd, SimdTask, f32x8, i32x8},
    neighbours::{ListPart, ParticleListChunk, Slab},
    sph::{Num, boundary::WallExtrapolation, kernel::Kernel},
};

/// The sums under one kernel.
pub(super) trait BoundarySums<const D: usize>: Send + Sync {
    /// By the reference: the sums of the boundary particles `wet`, whose neighbours are in `lists`; with the velocity if `flow`.
    fn sum_reference(
        &self,
        nodes: [&[ReferenceParticle<D>]; 2],
        wet: &[u32],
        lists: &ParticleListChunk,
        flow: bool,
        fits: &mut [WallExtrapolation<f64, D>],
    );

    /// The traces of what a water particle adds, with its velocity, and of the kernel's slope.
    #[cfg(feature = "gpu")]
    fn traces(&self) -> [crate::sph::trace::Trace; 2];

    /// In SIMD lanes: the sums of a slab and of the next one; with the velocity if `flow`.
    fn sum_slab(&self, level: Level, packed: &PackedParticles<D>, slab: &Slab, flow: bool, sums: &mut [LaneRow]);
}

/// The sums under a kernel.
pub(super) struct KernelSums<K> {
    /// The kernel, multiplied by the volume of a particle at ρ₀.
    pub(super) kernel: K,
    /// The square of its support.
    pub(super) reach2: f64,
}

/// Number of rows of sums, with the velocity or without.
#[inline(always)]
pub(super) const fn row_count(dimension: usize, flow: bool) -> usize {
    dimension + 2 + if flow { dimension } else { 0 }
}

impl<K: Kernel, const D: usize> BoundarySums<D> for KernelSums<K> {
    fn sum_reference(
        &self,
        [water, skin]: [&[ReferenceParticle<D>]; 2],
        wet: &[u32],
        lists: &ParticleListChunk,
        flow: bool,
        fits: &mut [WallExtrapolation<f64, D>],
    ) {
        for (k, (out, &i)) in fits.iter_mut().zip(wet).enumerate() {
            let mut fit = WallExtrapolation::filled_with(0.0);
            for &j in lists.neighbours_of(k).0 {
                let (wall, water) = (&skin[i as usize], &water[j as usize]);
                let r: [f64; D] = std::array::from_fn(|k| wall.r[k] - water.r[k]);
                let r2 = r.iter().map(|x| x * x).sum();
                let w = self.kernel.w(r2);
                fit.add(w, water.side.p, water.side.specific_volume, r);
                if flow {
                    fit.add_velocity(w, water.side.specific_volume, water.v);
                }
            }
            *out = fit;
        }
    }

    #[cfg(feature = "gpu")]
    fn traces(&self) -> [crate::sph::trace::Trace; 2] {
        [super::trace::extrapolation::<K, D>(&self.kernel), super::trace::slope(&self.kernel)]
    }

    fn sum_slab(&self, level: Level, packed: &PackedParticles<D>, slab: &Slab, flow: bool, sums: &mut [LaneRow]) {
        let Self { kernel, reach2 } = *self;
        match flow {
            true => simd::dispatch(level, BoundarySlabTask::<_, true, D> { kernel, reach2, packed, slab, sums }),
            false => simd::dispatch(level, BoundarySlabTask::<_, false, D> { kernel, reach2, packed, slab, sums }),
        }
    }
}

/// Sets `fit` to the sums by row, with the velocity if `flow`; their units are one of pressure over density, of length and of speed.
#[inline(always)]
pub(super) fn set<const D: usize>(
    fit: &mut WallExtrapolation<f64, D>,
    flow: bool,
    sums: impl Fn(usize) -> f64,
    [pressure, length, speed]: [f64; 3],
) {
    for_each_row(fit, flow, |row, x| *x = sums(row));
    fit.pressure_sum *= pressure;
    fit.offset_sum = fit.offset_sum.map(|x| x * length);
    if flow {
        fit.velocity_sum = fit.velocity_sum.map(|x| x * speed);
    }
}

/// Calls `visit` with the row and the value of each sum.
#[inline(always)]
pub(super) fn for_each_row<N: Num, const D: usize>(
    fit: &mut WallExtrapolation<N, D>,
    flow: bool,
    mut visit: impl FnMut(usize, &mut N),
) {
    visit(0, &mut fit.weight_sum);
    visit(1, &mut fit.pressure_sum);
    for (k, arm) in fit.offset_sum.iter_mut().enumerate() {
        visit(2 + k, arm);
    }
    if flow {
        for (k, flow) in fit.velocity_sum.iter_mut().enumerate() {
            visit(2 + D + k, flow);
        }
    }
}

struct BoundarySlabTask<'a, K, const FLOW: bool, const D: usize> {
    kernel: K,
    reach2: f64,
    packed: &'a PackedParticles<D>,
    slab: &'a Slab,
    sums: &'a mut [LaneRow],
}

impl<'a, K: Kernel, const FLOW: bool, const D: usize> SimdTask for BoundarySlabTask<'a, K, FLOW, D> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { kernel, reach2, packed, slab, sums } = self;
        let end2 = f32x8::splat(simd, end_of_support(reach2));
        let [first, middle, end] = packed.clusters_of(slab);
        let (rows, zero) = (row_count(D, FLOW), f32x8::splat(simd, 0.0));
        sums.fill(LaneRow::default());
        for c in first..end {
            for l in 0..LANES {
                let (is_water, slot) = (c < middle, (c - first) * LANES + l);
                let others = |part: &ListPart<'a>| if is_water { part.boundary } else { part.water };
                // Most of the water is far from boundary particles.
                if slab.list(slot).all(|part| others(&part).is_empty()) {
                    continue;
                }
                let PackedCluster { x, v, s } = &packed.clusters[c];
                let all = |x: f32| f32x8::splat(simd, x);
                let (p, volume) = (all(s[2][l]), all(s[3][l]));
                let moves: [f32x8<S>; D] = std::array::from_fn(|k| all(v[k][l]));
                let mine: [i32x8<S>; D] = std::array::from_fn(|k| i32x8::splat(simd, x[k][l]));
                let mut sum = WallExtrapolation::filled_with(zero);
                for part in slab.list(slot) {
                    for &entry in others(&part) {
                        let place = part.base + usize::from(entry);
                        let PackedCluster { x, v, s } = &packed.clusters[first + place];
                        let mut r = [zero; D];
                        for k in 0..D {
                            r[k] = f32x8::float_from(mine[k] - simd::load_integers(simd, &x[k]));
                        }
                        let mut r2 = r[0] * r[0];
                        for d in &r[1..] {
                            r2 = d.mul_add(*d, r2);
                        }
                        if !simd::any_below(r2, end2) {
                            continue;
                        }
                        let w = kernel.w(r2);
                        if is_water {
                            // One water particle beside eight boundary particles, which receive its contribution.
                            let theirs = &mut sums[place * rows..][..rows];
                            let mut fit = WallExtrapolation::filled_with(zero);
                            for_each_row(&mut fit, FLOW, |row, x| *x = simd::load(simd, &theirs[row].0));
                            fit.add(w, p, volume, r.map(|x| -x));
                            if FLOW {
                                fit.add_velocity(w, volume, moves);
                            }
                            for_each_row(&mut fit, FLOW, |row, x| x.store_array(&mut theirs[row].0));
                        } else {
                            let volume = simd::load(simd, &s[3]);
                            sum.add(w, simd::load(simd, &s[2]), volume, r);
                            if FLOW {
                                sum.add_velocity(w, volume, std::array::from_fn(|k| simd::load(simd, &v[k])));
                            }
                        }
                    }
                }
                if !is_water {
                    let mine = &mut sums[(c - first) * rows..][..rows];
                    for_each_row(&mut sum, FLOW, |row, sum| mine[row].0[l] += simd::sum_lanes(*sum));
                }
            }
        }
    }
}
