//! The f64 reference: each particle sums over its own neighbours in stored order, so that the result depends on
//! neither threads nor chunks.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::{
    PairLoop, PairLoopInput, PairSums, RequestedSums, StepLimits,
    accumulators::{Accumulators, RequiredSums},
    boundary_sums::BoundarySums,
    compiled::{CompiledTerms, PairTerms},
    pair_contribution::PairContribution,
};
use crate::{
    math::{Matrix, Vector},
    neighbours::{CHUNK, NeighbourLists, PairLists, ParticleListChunk, ParticleLists},
    particles::{PARTICLES_PER_TASK, Particles},
    sph::{
        AuxiliarySums, FluidProperties, PairSide, Term, boundary::WallExtrapolation, kernel::Kernel,
        pressure::repulsion,
    },
};

/// The reference with its terms.
pub(super) struct ReferencePairLoop<const D: usize> {
    laws: Box<dyn PairTerms<D>>,
    /// The moments of the neighbours, if the terms correct gradients.
    moments: Option<Box<dyn PairTerms<D>>>,
    fits: Box<dyn BoundarySums<D>>,
    nodes: [Vec<ReferenceParticle<D>>; 2],
    /// The sums of the water.
    fluid: Vec<PairSums<D>>,
    /// The sums of the water that only some terms need; none if none does.
    auxiliary: Vec<AuxiliarySums<f64, D>>,
    spent: Duration,
}

/// The data of a particle that a pair needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReferenceParticle<const D: usize> {
    pub(super) r: [f64; D],
    pub(super) v: [f64; D],
    pub(super) side: PairSide<f64, D>,
}

impl<const D: usize> ReferencePairLoop<D> {
    /// The reference with those terms, in SI.
    pub(super) fn new(
        laws: Box<dyn PairTerms<D>>,
        moments: Option<Box<dyn PairTerms<D>>>,
        fits: Box<dyn BoundarySums<D>>,
    ) -> Self {
        let (nodes, fluid, auxiliary) = ([Vec::new(), Vec::new()], Vec::new(), Vec::new());
        Self { laws, moments, fits, nodes, fluid, auxiliary, spent: Duration::ZERO }
    }

    /// Reads the particles.
    fn set_nodes(&mut self, input: &PairLoopInput<'_, D>) {
        let needs = self.laws.required_sums();
        nodes(
            input,
            input.fluid,
            &input.fluid.v,
            [input.stress, input.gradient_correction],
            &[],
            needs,
            &mut self.nodes[0],
        );
        nodes(
            input,
            input.boundary,
            input.boundary_velocity,
            [&[], &[]],
            input.shifting_suppressed,
            needs,
            &mut self.nodes[1],
        );
    }
}

/// The lists of particles.
fn lists<'a, const D: usize>(input: &PairLoopInput<'a, D>) -> &'a ParticleLists {
    let PairLists::Lists(lists) = input.neighbours.pair_lists() else {
        unreachable!("the reference has lists of particles")
    };
    lists
}

/// Adds the contribution of neighbour `b` by `law` to `sum`; returns |v_ab·r_ab|/(r² + η²).
#[inline(always)]
fn add<K: Kernel, T, W, L: Term<D>, const D: usize>(
    laws: &CompiledTerms<K, T, W>,
    law: &L,
    a: &ReferenceParticle<D>,
    b: &ReferenceParticle<D>,
    sum: &mut Accumulators<f64, D>,
) -> f64 {
    let r_ab: [f64; D] = std::array::from_fn(|i| a.r[i] - b.r[i]);
    let v_ab: [f64; D] = std::array::from_fn(|i| a.v[i] - b.v[i]);
    let r2: f64 = r_ab.iter().map(|x| x * x).sum();
    // The lists reach beyond the kernel support: a quarter of their entries are skipped here.
    if r2 >= laws.reach2 {
        return 0.0;
    }
    let difference = b.side.compression - a.side.compression;
    let pair = PairContribution::new::<K, L, true>(
        (&laws.kernel, law),
        (r_ab, v_ab, r2, difference),
        laws.eta2,
        a.side,
        b.side,
    );
    let none = &mut Accumulators::filled_with(0.0);
    pair.add_rates(sum, none);
    pair.add_auxiliary(law, sum, none);
    pair.approach_rate(laws.reach2)
}

pub(super) fn sum_fluid<K: Kernel, T: Term<D>, W: Term<D>, const D: usize>(
    laws: &CompiledTerms<K, T, W>,
    [water, skin]: [&[ReferenceParticle<D>]; 2],
    first: usize,
    lists: &ParticleListChunk,
    sums: &mut [PairSums<D>],
    extra: &mut [AuxiliarySums<f64, D>],
) -> f64 {
    let mut closing = 0.0f64;
    for (k, out) in sums.iter_mut().enumerate() {
        let (a, (among, beside)) = (&water[first + k], lists.neighbours_of(k));
        let mut sum = Accumulators::filled_with(0.0);
        for &j in among {
            closing = closing.max(add(laws, &laws.fluid, a, &water[j as usize], &mut sum));
        }
        for &j in beside {
            closing = closing.max(add(laws, &laws.wall, a, &skin[j as usize], &mut sum));
        }
        *out = PairSums { acceleration: Vector::from(sum.acceleration), compression_rate: sum.compression_rate };
        if let Some(extra) = extra.get_mut(k) {
            *extra = sum.auxiliary;
        }
    }
    closing
}

pub(super) fn sum_boundary<K: Kernel, T: Term<D>, W: Term<D>, const D: usize>(
    laws: &CompiledTerms<K, T, W>,
    [water, skin]: [&[ReferenceParticle<D>]; 2],
    wet: &[u32],
    lists: &ParticleListChunk,
    sums: &mut [PairSums<D>],
) {
    for (k, (out, &i)) in sums.iter_mut().zip(wet).enumerate() {
        let mut sum = Accumulators::filled_with(0.0);
        for &j in lists.neighbours_of(k).0 {
            add(laws, &laws.wall, &skin[i as usize], &water[j as usize], &mut sum);
        }
        *out = PairSums { acceleration: Vector::from(sum.acceleration), compression_rate: sum.compression_rate };
    }
}

fn rows<const D: usize>(m: &Matrix<D>) -> [[f64; D]; D] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

/// The particles as the reference reads them.
fn nodes<const D: usize>(
    input: &PairLoopInput<'_, D>,
    particles: &Particles<D>,
    v: &[Vector<D>],
    tensors: [&[Matrix<D>]; 2],
    marks: &[bool],
    needs: RequiredSums,
    nodes: &mut Vec<ReferenceParticle<D>>,
) {
    let (rho0, [stress, forms]) = (input.properties.rho0, tensors);
    let tensor = |of: &[Matrix<D>], i: usize| of.get(i).map_or([[0.0; D]; D], rows);
    (0..particles.len())
        .into_par_iter()
        .with_min_len(PARTICLES_PER_TASK)
        .map(|i| {
            let x = (particles.rho[i] - rho0) / rho0;
            let (p, s) = (input.equation_of_state.pressure(x), 1.0 / (1.0 + x));
            let side = PairSide {
                compression: x,
                p,
                specific_volume: s,
                repulsion: if needs.repulsion { repulsion(p, s) } else { 0.0 },
                shifting_suppressed: marks.get(i).map_or(0.0, |&m| f64::from(u8::from(m))),
                stress: tensor(stress, i),
                gradient_correction: tensor(forms, i),
            };
            ReferenceParticle { r: particles.r[i].into(), v: v[i].into(), side }
        })
        .collect_into_vec(nodes);
}

impl<const D: usize> PairLoop<D> for ReferencePairLoop<D> {
    fn time_spent(&self) -> Duration {
        self.spent
    }

    fn extrapolate_to_boundary(
        &mut self,
        input: &PairLoopInput<'_, D>,
        flow: bool,
        // Each rank advances all boundary particles here.
        _own: Option<&[u32]>,
        extrapolate_to_boundary: &mut [WallExtrapolation<f64, D>],
    ) {
        let lists = lists(input);
        self.set_nodes(input);
        let start = Instant::now();
        let (sums, nodes) = (&self.fits, [&self.nodes[0][..], &self.nodes[1][..]]);
        let chunks = extrapolate_to_boundary
            .par_chunks_mut(CHUNK)
            .zip(input.neighbours.boundary_near_fluid().par_chunks(CHUNK))
            .zip(&lists.boundary);
        chunks.for_each(|((extrapolate_to_boundary, wet), chunk)| {
            sums.sum_reference(nodes, wet, chunk, flow, extrapolate_to_boundary)
        });
        self.spent += start.elapsed();
    }

    fn moments(&mut self, input: &PairLoopInput<'_, D>, moments: &mut [Matrix<D>]) {
        if self.moments.is_none() {
            return;
        }
        self.set_nodes(input);
        let Some(terms) = &self.moments else { return };
        let start = Instant::now();
        let (lists, none) = (lists(input), AuxiliarySums::filled_with(0.0));
        let nodes = [&self.nodes[0][..], &self.nodes[1][..]];
        moments.par_chunks_mut(CHUNK).enumerate().for_each(|(c, moments)| {
            let (mut sums, mut auxiliary) = (vec![PairSums::zero(); moments.len()], vec![none; moments.len()]);
            terms.sum_fluid(nodes, c * CHUNK, &lists.fluid[c], &mut sums, &mut auxiliary);
            for (moment, sums) in moments.iter_mut().zip(&auxiliary) {
                *moment = Matrix::from_fn(|i, j| sums.renormalization[i.max(j)][i.min(j)]);
            }
        });
        self.spent += start.elapsed();
    }

    fn set_gravity(&mut self, properties: &FluidProperties<D>) {
        self.laws.set_gravity(&properties.gravity.into());
    }

    fn rates(
        &mut self,
        input: &PairLoopInput<'_, D>,
        requested: RequestedSums,
        boundary: &mut [PairSums<D>],
    ) -> StepLimits {
        let lists = lists(input);
        self.set_nodes(input);
        let auxiliary = requested == RequestedSums::All && self.laws.required_sums().any_auxiliary();
        let start = Instant::now();
        self.fluid.resize(input.fluid.len(), PairSums::zero());
        let count = if auxiliary { input.fluid.len() } else { 0 };
        self.auxiliary.resize(count, AuxiliarySums::filled_with(0.0));
        let (laws, nodes) = (&self.laws, [&self.nodes[0][..], &self.nodes[1][..]]);
        let g = input.properties.gravity;
        let one = |c: usize, sums: &mut [PairSums<D>], extra: &mut [AuxiliarySums<f64, D>]| {
            let closing = laws.sum_fluid(nodes, c * CHUNK, &lists.fluid[c], sums, extra);
            let a2 = sums.iter_mut().map(|s| {
                s.acceleration += g;
                s.acceleration.norm_squared()
            });
            (a2.fold(0.0, f64::max), closing)
        };
        let larger = |a: (f64, f64), b: (f64, f64)| (a.0.max(b.0), a.1.max(b.1));
        let chunks = self.fluid.par_chunks_mut(CHUNK).enumerate();
        let (a2, closing) = if self.auxiliary.is_empty() {
            chunks.map(|(c, sums)| one(c, sums, &mut [])).reduce(|| (0.0, 0.0), larger)
        } else {
            let both = chunks.zip(self.auxiliary.par_chunks_mut(CHUNK));
            both.map(|((c, sums), extra)| one(c, sums, extra)).reduce(|| (0.0, 0.0), larger)
        };
        let wet = input.neighbours.boundary_near_fluid().par_chunks(CHUNK);
        boundary
            .par_chunks_mut(CHUNK)
            .zip(wet)
            .zip(&lists.boundary)
            .for_each(|((sums, wet), chunk)| laws.sum_boundary(nodes, wet, chunk, sums));
        self.spent += start.elapsed();
        StepLimits { acceleration: a2.sqrt(), approach_rate: closing }
    }

    #[cfg(feature = "gpu")]
    fn traces(&self) -> Option<super::PairTraces> {
        let [fluid, wall] = self.laws.traces();
        let needs = self.laws.required_sums();
        let [extrapolation, slope] = self.fits.traces();
        Some(super::PairTraces {
            fluid,
            wall,
            extrapolation,
            slope,
            moments: self.moments.as_ref().map(|moments| moments.traces()),
            rows: [needs.input_rows(D), needs.sum_rows(D)],
            layout: super::RowLayout::new::<D>(needs),
            reach2: self.laws.reach2(),
        })
    }

    fn memory_bytes(&self) -> usize {
        let nodes: usize = self.nodes.iter().map(|nodes| size_of_val(&nodes[..])).sum();
        nodes + size_of_val(&self.fluid[..]) + size_of_val(&self.auxiliary[..])
    }

    fn free_buffers(&mut self) {
        (self.nodes, self.fluid, self.auxiliary) = ([Vec::new(), Vec::new()], Vec::new(), Vec::new());
    }

    fn fluid_sums(&self, _: &NeighbourLists<D>, i: usize) -> PairSums<D> {
        self.fluid[i]
    }

    fn read_auxiliary_sums(&self, _: &NeighbourLists<D>, i: usize, sums: &mut AuxiliarySums<f64, D>) {
        *sums = self.auxiliary[i];
    }
}
