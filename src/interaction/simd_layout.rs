//! Memory layout of the particles for the SIMD pair loop.

use rayon::prelude::*;

use super::{PairLoopInput, accumulators::RequiredSums};
use crate::{
    math::simd::{LANES, LaneRow},
    math::{Matrix, Vector},
    neighbours::{self, Clusters, NeighbourLists, PairLists, Slab},
    sph::{Units, pressure::repulsion},
};

/// The lists of clusters.
pub(super) fn clusters<const D: usize>(neighbours: &NeighbourLists<D>) -> &Clusters {
    match neighbours.pair_lists() {
        PairLists::Clusters(clusters, _) => clusters,
        PairLists::Lists(_) => unreachable!("lanes have lists of clusters"),
    }
}

/// Eight particles of one kind, in the units of the pair loop.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct PackedCluster<const D: usize> {
    /// Position in integer units.
    pub(super) x: [[i32; LANES]; D],
    /// Velocity.
    pub(super) v: [[f32; LANES]; D],
    /// Compression ρ/ρ₀ − 1, its remainder in single precision, pressure over ρ₀, specific volume.
    pub(super) s: [[f32; LANES]; 4],
}

impl<const D: usize> PackedCluster<D> {
    /// Words of 32 bits.
    pub(super) const WORDS: usize = (2 * D + 4) * LANES;

    const EMPTY: Self =
        Self { x: [[0; LANES]; D], v: [[0.0; LANES]; D], s: [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]] };
}

/// The packed particles, with additional rows where terms read a mark or a tensor.
#[derive(Clone, Debug, Default)]
pub(super) struct PackedParticles<const D: usize> {
    /// The first packed cluster: a rank packs those that it reads.
    pub(super) first: usize,
    pub(super) clusters: Vec<PackedCluster<D>>,
    pub(super) rows: Vec<LaneRow>,
    /// Whether a particle of the cluster has a gradient correction, if terms read it.
    pub(super) corrected: Vec<bool>,
}

impl<const D: usize> PackedParticles<D> {
    /// Packs all particles that may have pairs, of boundary particles the positions alone if `outline`. If the `water_stays`, it is
    /// packed already, and so are the positions of boundary particles.
    pub(super) fn pack(
        &mut self,
        input: &PairLoopInput<'_, D>,
        clusters: &Clusters,
        units: &Units,
        [water_stays, outline]: [bool; 2],
    ) {
        let these = clusters.clusters_of(clusters.read_slabs());
        self.first = these.start;
        self.clusters.reserve_exact(these.len().saturating_sub(self.clusters.len()));
        self.clusters.resize(these.len(), PackedCluster::EMPTY);
        let inv_unit = 1.0 / units.length;
        let works = clusters.split_by_slab(clusters.read_slabs(), &mut self.clusters, 1);
        works.into_par_iter().with_max_len(1).for_each(|(slab, packed)| {
            let skip = if water_stays { slab.middle - slab.first } else { 0 };
            for (c, cluster) in (slab.first..).zip(packed).skip(skip) {
                let source = &clusters.source[c * LANES..(c + 1) * LANES];
                let (particles, v) = if c < slab.middle {
                    (input.fluid, &input.fluid.v[..])
                } else {
                    (input.boundary, input.boundary_velocity)
                };
                if !water_stays || outline {
                    neighbours::fill_positions(&mut cluster.x, source, &particles.r, inv_unit);
                }
                if c < slab.middle || !outline {
                    state(cluster, source, (&particles.rho, v), input, units);
                }
            }
        });
    }

    /// Where the slab's first cluster of water, its first of boundary particles, and its end are packed.
    pub(super) fn clusters_of(&self, slab: &Slab) -> [usize; 3] {
        [slab.first, slab.middle, slab.end].map(|c| c - self.first)
    }

    /// Appends the words of cluster `c`.
    pub(super) fn give(&self, c: usize, words: &mut Vec<u32>) {
        let PackedCluster { x, v, s } = self.clusters[c - self.first];
        words.extend(x.into_iter().flatten().map(|x| x as u32));
        words.extend(v.into_iter().chain(s).flatten().map(f32::to_bits));
    }

    /// Sets cluster `c` to the words that [`PackedParticles::give`] appended.
    pub(super) fn take(&mut self, c: usize, words: &[u32]) {
        let cluster = &mut self.clusters[c - self.first];
        let row = |k: usize| -> [u32; LANES] { std::array::from_fn(|l| words[k * LANES + l]) };
        cluster.x = std::array::from_fn(|k| row(k).map(|x| x as i32));
        cluster.v = std::array::from_fn(|k| row(D + k).map(f32::from_bits));
        cluster.s = std::array::from_fn(|k| row(2 * D + k).map(f32::from_bits));
    }

    /// Packs the additional rows: marks of boundary particles, stress and gradient correction of the water, repulsion of both.
    pub(super) fn pack_rows(
        &mut self,
        input: &PairLoopInput<'_, D>,
        clusters: &Clusters,
        units: &Units,
        needs: RequiredSums,
    ) {
        let (mark, count) = (needs.suppression, needs.input_rows(D));
        self.rows.clear();
        self.rows.reserve_exact(self.clusters.len() * count);
        self.rows.resize(self.clusters.len() * count, LaneRow::default());
        let scale = (units.time / units.length).powi(2);
        let (packed, first_packed) = (&self.clusters, self.first);
        let works = clusters.split_by_slab(clusters.read_slabs(), &mut self.rows, count);
        works.into_par_iter().with_max_len(1).for_each(|(slab, rows)| {
            for (c, rows) in (slab.first..).zip(rows.chunks_mut(count)) {
                if needs.repulsion {
                    let [_, _, p, s] = packed[c - first_packed].s;
                    let of = |l: usize| repulsion(f64::from(p[l]), f64::from(s[l])) as f32;
                    rows[needs.repulsion_row()] = LaneRow(std::array::from_fn(of));
                }
                let source = &clusters.source[c * LANES..(c + 1) * LANES];
                for (l, &i) in source[..neighbours::occupied_lanes(source)].iter().enumerate() {
                    let i = i as usize;
                    if mark && c >= slab.middle {
                        rows[0].0[l] = f32::from(u8::from(input.shifting_suppressed[i]));
                    }
                    let mut tensor = |tensor: &Matrix<D>, mut k: usize, scale: f64| {
                        for row in 0..D {
                            for column in 0..=row {
                                rows[k].0[l] = (tensor[(row, column)] * scale) as f32;
                                k += 1;
                            }
                        }
                    };
                    if needs.stress && c < slab.middle {
                        tensor(&input.stress[i], needs.stress_row(), scale);
                    }
                    if needs.gradient_correction && c < slab.middle {
                        tensor(&input.gradient_correction[i], needs.gradient_correction_row(D), 1.0);
                    }
                }
            }
        });
        if needs.gradient_correction {
            let first = needs.gradient_correction_row(D);
            let any = |rows: &[LaneRow]| rows[first..].iter().any(|row| row.0.iter().any(|&c| c != 0.0));
            self.corrected.clear();
            self.corrected.reserve_exact(self.clusters.len());
            self.corrected.extend(self.rows.chunks(count).map(any));
        }
    }
}

/// Velocity, density and pressure of a cluster.
#[inline(always)]
fn state<const D: usize>(
    cluster: &mut PackedCluster<D>,
    source: &[u32],
    (rho, v): (&[f64], &[Vector<D>]),
    input: &PairLoopInput<'_, D>,
    units: &Units,
) {
    let speed = units.time / units.length;
    let (rho0, inv_rho0) = (input.properties.rho0, 1.0 / input.properties.rho0);
    let n = neighbours::occupied_lanes(source);
    if n < LANES {
        (cluster.v, cluster.s) = (PackedCluster::<D>::EMPTY.v, PackedCluster::<D>::EMPTY.s);
    }
    for (l, &i) in source[..n].iter().enumerate() {
        let i = i as usize;
        for (out, v) in cluster.v.iter_mut().zip(v[i].iter()) {
            out[l] = (v * speed) as f32;
        }
        let x = (rho[i] - rho0) * inv_rho0;
        cluster.s[0][l] = x as f32;
        cluster.s[1][l] = (x - f64::from(x as f32)) as f32;
        cluster.s[2][l] = (input.equation_of_state.pressure(x) * (speed * speed)) as f32;
        cluster.s[3][l] = (1.0 / (1.0 + x)) as f32;
    }
}
