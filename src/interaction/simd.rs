//! The SIMD pair loop: packs the particles, lets each thread compute slabs, and adds the sums.
//!
//! A thread computes one slab and writes its sums, and those of the next slab, into rows of its own. Every particle then
//! adds two rows, so that the result does not depend on the threads and no thread waits.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::{
    PairLoop, PairLoopInput, PairSums, RequestedSums, StepLimits,
    accumulators::{RequiredSums, for_each_auxiliary, for_each_symmetric_entry},
    boundary_sums::{self, BoundarySums},
    compiled::PairTerms,
    exchange,
    simd_layout::{PackedParticles, clusters},
};
use crate::{
    math::simd::{LANES, LaneRow, Level},
    math::{Matrix, Vector},
    neighbours::{Clusters, NeighbourLists, Slab},
    particles::PARTICLES_PER_TASK,
    ranks,
    sph::{AuxiliarySums, FluidProperties, Units, boundary::WallExtrapolation},
};

/// The SIMD pair loop with its terms.
pub(super) struct SimdPairLoop<const D: usize> {
    /// The sums over pairs.
    laws: Box<dyn PairTerms<D>>,
    /// The moments of the neighbours, if the terms correct gradients.
    moments: Option<Box<dyn PairTerms<D>>>,
    /// The extrapolation of the water to boundary particles.
    fits: Box<dyn BoundarySums<D>>,
    units: Units,
    level: Level,
    /// Acceleration of gravity in the last pass, m/s².
    gravity: Vector<D>,
    packed: PackedParticles<D>,
    /// Whether the water is packed for this pass already.
    has_water: bool,
    /// Whether the stress and the marks of the last pass are packed and hold.
    has_inputs: bool,
    /// The sums that each slab computes for itself and the next slab, slab by slab; rows of zeros at the end.
    sums: Vec<LaneRow>,
    /// The first cluster with rows in `sums`.
    first: usize,
    /// Where the rows of each cluster from `first` on begin in `sums`: those of its own slab and those of the slab before.
    at: Vec<[u32; 2]>,
    /// Whether `sums` are those of [`PairLoop::rates`].
    has_rates: bool,
    /// Acceleration, gravity included, and density rate of all water particles, if they were gathered from all ranks after the
    /// last pass.
    gathered: Vec<PairSums<D>>,
    spent: Duration,
}

impl<const D: usize> SimdPairLoop<D> {
    /// The pair loop with those terms, in `units`.
    pub(super) fn new(
        laws: Box<dyn PairTerms<D>>,
        moments: Option<Box<dyn PairTerms<D>>>,
        fits: Box<dyn BoundarySums<D>>,
        units: Units,
        level: Level,
    ) -> Self {
        let (packed, sums, at) = (PackedParticles::default(), Vec::new(), Vec::new());
        let (gravity, gathered, spent) = (Vector::zeros(), Vec::new(), Duration::ZERO);
        let (has_water, has_inputs, has_rates, first) = (false, false, false, 0);
        Self {
            laws,
            moments,
            fits,
            units,
            level,
            gravity,
            packed,
            has_water,
            has_inputs,
            sums,
            first,
            at,
            has_rates,
            gathered,
            spent,
        }
    }

    /// Packs what the next sums read: of boundary particles the positions alone if `outline`; no water that is packed for this pass
    /// already, nor the positions that were packed with it.
    fn pack(&mut self, input: &PairLoopInput<'_, D>, clusters: &Clusters, outline: bool) {
        let has_water = std::mem::replace(&mut self.has_water, true);
        self.packed.pack(input, clusters, &self.units, [has_water, outline]);
        if !has_water {
            exchange::receive_next_water(&mut self.packed, clusters);
        }
    }

    /// Allocates the sums, `rows` a cluster, of the slabs that this rank computes, after what the slab before adds to the first of
    /// them; or those of all slabs if it needs the sums of all. Returns the number of rows that each slab writes.
    fn lay_out(&mut self, clusters: &Clusters, rows: usize) -> Vec<usize> {
        self.has_rates = false;
        let laid_out = if clusters.division.by_owner { clusters.own_slabs() } else { 0..clusters.slabs.len() };
        let these = clusters.clusters_of(laid_out.clone());
        self.first = these.start;
        self.at.clear();
        self.at.resize(these.len(), [0; 2]);
        let mut lengths = vec![0; clusters.slabs.len()];
        let (mut offset, mut before) = (0, None);
        if !laid_out.is_empty() && laid_out.start > 0 {
            let first = &clusters.slabs[laid_out.start];
            offset = (first.end - first.first) * rows;
            lengths[laid_out.start - 1] = offset;
            before = Some((0, first.first));
        }
        for s in laid_out {
            let slab = &clusters.slabs[s];
            for (c, at) in (slab.first..slab.end).zip(&mut self.at[slab.first - these.start..]) {
                at[0] = (offset + (c - slab.first) * rows) as u32;
                at[1] = before.map_or(u32::MAX, |(offset, first)| (offset + (c - first) * rows) as u32);
            }
            let last = clusters.slabs.get(s + 1).map_or(slab.end, |next| next.end);
            before = Some((offset, slab.first));
            // One more set of rows is for discarded sums.
            lengths[s] = (last - slab.first + 1) * rows;
            offset += lengths[s];
        }
        // The first slab has no slab before it: rows of zeros replace it.
        self.at.iter_mut().take_while(|at| at[1] == u32::MAX).for_each(|at| at[1] = offset as u32);
        let count = offset + rows;
        if self.sums.capacity() < count {
            // No copy of the last sums beside the next ones.
            self.sums = Vec::with_capacity(count);
        }
        // Passes differ in their rows; what a pass does not need stays, so that the next one need not fill it.
        if self.sums.len() < count {
            self.sums.resize(count, LaneRow::default());
        }
        self.sums[offset..count].fill(LaneRow::default());
        lengths
    }

    /// The sums of the particle in `slot`, in the units of the pair loop, by row among the first `rows`.
    #[inline(always)]
    fn of_slot(&self, slot: u32, rows: usize) -> impl Fn(usize) -> f64 {
        let (c, l) = (slot as usize / LANES, slot as usize % LANES);
        let [own, before] = self.at[c - self.first];
        let (own, before) = (&self.sums[own as usize..][..rows], &self.sums[before as usize..][..rows]);
        move |row| f64::from(own[row].0[l]) + f64::from(before[row].0[l])
    }

    /// Acceleration and density rate of the particle in `slot`, in SI.
    #[inline(always)]
    fn pair_sums_of(&self, slot: u32) -> PairSums<D> {
        let rate = 1.0 / self.units.time;
        let acceleration = self.units.length * rate * rate;
        let sum = self.of_slot(slot, D + 1);
        let mut dv = Vector::<D>::zeros();
        for (k, dv) in dv.iter_mut().enumerate() {
            *dv = sum(k) * acceleration;
        }
        PairSums { acceleration: dv, compression_rate: sum(D) * rate }
    }

    /// Sets `sums` to those auxiliary sums of the particle in `slot` that `needs` names, in SI.
    #[inline(always)]
    fn read_auxiliary_sums_of(&self, slot: u32, needs: RequiredSums, sums: &mut AuxiliarySums<f64, D>) {
        let sum = self.of_slot(slot, needs.sum_rows(D));
        for_each_auxiliary(sums, needs, needs, |row, x| *x = sum(row));
        let [per_length, per_time] = [1.0 / self.units.length, 1.0 / self.units.time];
        if needs.shift {
            sums.concentration_gradient.iter_mut().for_each(|x| *x *= per_length);
        }
        if needs.stress {
            for_each_symmetric_entry(&mut sums.strain, 0, &mut |_, x| *x *= per_time);
        }
    }
}

/// The slabs of this rank, each with the rows of `sums` that it writes.
fn works<'a>(clusters: &'a Clusters, lengths: &[usize], sums: &'a mut [LaneRow]) -> Vec<(&'a Slab, &'a mut [LaneRow])> {
    let own = clusters.own_slabs();
    let mut rest = &mut sums[lengths[..own.start].iter().sum()..];
    let mut works = Vec::with_capacity(own.len());
    for (slab, &length) in clusters.slabs[own.clone()].iter().zip(&lengths[own]) {
        let (these, others) = rest.split_at_mut(length);
        works.push((slab, these));
        rest = others;
    }
    works
}

/// Calls `set` with the item of each boundary particle near water whose sums this rank has, and with its slot.
fn for_each_own<T: Send>(clusters: &Clusters, items: &mut [T], set: impl Fn(&mut T, u32) + Sync) {
    let own = match clusters.division.by_owner {
        true => clusters.clusters_of(clusters.own_slabs()),
        false => 0..clusters.len(),
    };
    let slots = (own.start * LANES) as u32..(own.end * LANES) as u32;
    let items = items.par_iter_mut().zip(&clusters.boundary_slots).with_min_len(PARTICLES_PER_TASK);
    items.filter(|(_, slot)| slots.contains(slot)).for_each(|(item, &slot)| set(item, slot));
}

/// Computes the sums `requested` of all slabs by `terms`; returns the largest |v_ab·r_ab|/(r² + η²), in the units of the pair loop.
fn sum_slabs<const D: usize>(
    terms: &dyn PairTerms<D>,
    level: Level,
    packed: &PackedParticles<D>,
    requested: RequestedSums,
    works: Vec<(&Slab, &mut [LaneRow])>,
) -> f32 {
    let sum = |(slab, sums)| terms.sum_slab(level, packed, requested, slab, sums);
    works.into_par_iter().with_max_len(1).map(sum).reduce(|| 0.0, |a, b| if b > a { b } else { a })
}

impl<const D: usize> PairLoop<D> for SimdPairLoop<D> {
    fn time_spent(&self) -> Duration {
        self.spent
    }

    fn extrapolate_to_boundary(
        &mut self,
        input: &PairLoopInput<'_, D>,
        flow: bool,
        own: Option<&[u32]>,
        fits: &mut [WallExtrapolation<f64, D>],
    ) {
        let clusters = clusters(input.neighbours);
        self.pack(input, clusters, true);
        let lengths = self.lay_out(clusters, boundary_sums::row_count(D, flow));
        let start = Instant::now();
        let works = works(clusters, &lengths, &mut self.sums);
        let (sums, level, packed) = (&self.fits, self.level, &self.packed);
        works.into_par_iter().with_max_len(1).for_each(|(slab, rows)| sums.sum_slab(level, packed, slab, flow, rows));
        self.spent += start.elapsed();
        exchange::complete_sums(&mut self.sums, clusters, &lengths);
        let (rows, speed) = (boundary_sums::row_count(D, flow), self.units.length / self.units.time);
        let units = [speed.powi(2), self.units.length, speed];
        let read = |fit: &mut WallExtrapolation<f64, D>, slot: u32| {
            boundary_sums::set(fit, flow, self.of_slot(slot, rows), units);
        };
        let Some(own) = own else {
            for_each_own(clusters, fits, read);
            return exchange::share_extrapolations(fits, clusters, flow);
        };
        let fits = fits.par_iter_mut().zip(own).with_min_len(PARTICLES_PER_TASK);
        fits.for_each(|(fit, &place)| read(fit, clusters.boundary_slots[place as usize]));
    }

    fn moments(&mut self, input: &PairLoopInput<'_, D>, moments: &mut [Matrix<D>]) {
        let Some(needs) = self.moments.as_ref().map(|terms| terms.required_sums()) else { return };
        let clusters = clusters(input.neighbours);
        self.pack(input, clusters, false);
        let lengths = self.lay_out(clusters, needs.sum_rows(D));
        let start = Instant::now();
        if let Some(terms) = &self.moments {
            let works = works(clusters, &lengths, &mut self.sums);
            sum_slabs(&**terms, self.level, &self.packed, RequestedSums::All, works);
        }
        self.spent += start.elapsed();
        exchange::complete_sums(&mut self.sums, clusters, &lengths);
        let these = clusters.division.own_range(moments.len());
        let slots = clusters.fluid_slots[these.clone()].par_iter().enumerate().with_min_len(PARTICLES_PER_TASK);
        let is_own = clusters.division.own_water().and_then(|(_, is_own)| is_own).map(|is_own| &is_own[these.clone()]);
        let own = moments[these].par_iter_mut().zip(slots).filter(|(_, (k, _))| is_own.is_none_or(|is_own| is_own[*k]));
        own.for_each(|(moment, (_, &slot))| {
            let mut sums = AuxiliarySums::filled_with(0.0);
            self.read_auxiliary_sums_of(slot, needs, &mut sums);
            *moment = Matrix::from_fn(|i, j| sums.renormalization[i.max(j)][i.min(j)]);
        });
    }

    fn set_gravity(&mut self, properties: &FluidProperties<D>) {
        self.laws.set_gravity(&properties.in_units(&self.units).gravity.into());
    }

    fn rates(
        &mut self,
        input: &PairLoopInput<'_, D>,
        requested: RequestedSums,
        boundary: &mut [PairSums<D>],
    ) -> StepLimits {
        let clusters = clusters(input.neighbours);
        let needs = self.laws.required_sums();
        self.pack(input, clusters, false);
        self.has_water = false;
        // The two passes of a symplectic step have the same stress.
        let hold = self.has_inputs && !needs.repulsion && !needs.gradient_correction;
        if needs.input_rows(D) > 0 && !hold {
            self.packed.pack_rows(input, clusters, &self.units, needs);
            self.has_inputs = true;
        }
        let lengths = self.lay_out(clusters, needs.requested_rows(D, requested));
        let start = Instant::now();
        let works = works(clusters, &lengths, &mut self.sums);
        let closing = sum_slabs(&*self.laws, self.level, &self.packed, requested, works);
        self.spent += start.elapsed();
        exchange::complete_sums(&mut self.sums, clusters, &lengths);
        self.gravity = input.properties.gravity;
        let acceleration2 = |slot: u32| (self.pair_sums_of(slot).acceleration + self.gravity).norm_squared();
        let slots = &clusters.fluid_slots;
        let a2 = match clusters.division.own_water() {
            None => {
                let all = slots.par_iter().with_min_len(PARTICLES_PER_TASK);
                all.map(|&slot| acceleration2(slot)).reduce(|| 0.0, f64::max)
            }
            Some((_, is_own)) => {
                let own = clusters.division.own_range(slots.len()).into_par_iter().with_min_len(PARTICLES_PER_TASK);
                let own = own.filter(|&i| is_own.is_none_or(|is_own| is_own[i]));
                own.map(|i| acceleration2(slots[i])).reduce(|| 0.0, f64::max)
            }
        };
        let [low, high] = ranks::words_of(a2);
        let mut largest = (0.0, 0.0);
        for [low, high, closing] in clusters.division.ranks.gather_words([low, high, closing.to_bits()]) {
            largest.0 = f64::max(largest.0, ranks::from_words(low, high));
            largest.1 = f32::max(largest.1, f32::from_bits(closing));
        }
        let (a2, closing) = largest;
        (self.has_rates, self.gathered) = (true, Vec::new());
        for_each_own(clusters, boundary, |out, slot| *out = self.pair_sums_of(slot));
        exchange::share_boundary_sums(boundary, clusters);
        StepLimits { acceleration: a2.sqrt(), approach_rate: f64::from(closing) / self.units.time }
    }

    fn memory_bytes(&self) -> usize {
        let PackedParticles { clusters, rows, corrected, .. } = &self.packed;
        // The extrapolation to the walls has more rows of sums than some pair loops, and shorter vectors keep their
        // memory.
        let packed = size_of_val(&clusters[..]) + rows.capacity() * size_of::<LaneRow>() + corrected.capacity();
        let sums = self.sums.capacity() * size_of::<LaneRow>();
        let places = size_of_val(&self.at[..]);
        packed + sums + places
    }

    fn inputs_changed(&mut self) {
        self.has_inputs = false;
    }

    fn free_buffers(&mut self) {
        self.has_inputs = false;
        (self.packed, self.sums, self.at) = (PackedParticles::default(), Vec::new(), Vec::new());
        (self.has_rates, self.gathered) = (false, Vec::new());
    }

    fn share_fluid_sums(&mut self, neighbours: &NeighbourLists<D>) {
        if !self.has_rates {
            return;
        }
        self.gathered = exchange::gather_sums(clusters(neighbours), |i| self.fluid_sums(neighbours, i));
    }

    fn fluid_sums(&self, neighbours: &NeighbourLists<D>, i: usize) -> PairSums<D> {
        if let Some(sums) = self.gathered.get(i) {
            return *sums;
        }
        let mut sums = self.pair_sums_of(clusters(neighbours).fluid_slots[i]);
        sums.acceleration += self.gravity;
        sums
    }

    fn read_auxiliary_sums(&self, neighbours: &NeighbourLists<D>, i: usize, sums: &mut AuxiliarySums<f64, D>) {
        self.read_auxiliary_sums_of(clusters(neighbours).fluid_slots[i], self.laws.required_sums(), sums);
    }
}
