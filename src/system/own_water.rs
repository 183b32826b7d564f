//! Water of which each rank has and advances its own particles only: what ranks exchange in a step and for new lists, and when all of
//! it comes together. The arrays have the length of all water; those places that a rank does not write take no memory.

use std::ops::Range;

use rayon::prelude::*;

use super::{Driving, ExitPath, Fluid, RemovedParticle, StepCheck, System};
use crate::{
    math::{Bounds, Matrix, Vector},
    model::{Model, Slip, TimeScheme},
    neighbours::{Columns, Division, IndexRanges, NeighbourLists},
    particles::{PARTICLES_PER_TASK, Particles, zeros},
    ranks::{self, RankPart, Ranks},
};

/// Whether a step of `system` reads water of other ranks only through pairs and within ranges that all ranks know.
pub(crate) fn may_be_divided<const D: usize>(system: &System<D>) -> bool {
    system.neighbours.division().is_some_and(|division| division.ranks.count() > 1)
        && allow_division(&system.model, &system.driving.driving)
        && !system.fluid.images.any()
        && system.fluid_domain.open_boundaries.is_empty()
}

/// Whether ranks may have parts of the water with these laws and drives.
pub(crate) fn allow_division(model: &Model, driving: &Driving) -> bool {
    model.scheme == TimeScheme::Symplectic
        && model.pair_loop.instruction_set().is_some()
        && model.viscosity.stress().is_none()
        && model.shift().is_none()
        && model.slip != Slip::None
        && driving.current.is_none()
        && driving.towed.is_none()
}

/// The ranks that share the pairs of `system`; a single one if each has all pairs.
pub(crate) fn ranks<const D: usize>(system: &System<D>) -> Ranks {
    system.neighbours.division().map(|division| division.ranks.clone()).unwrap_or_default()
}

/// Chooses whether each rank advances its own water only. If not, every rank gets all of it, and lists that name all of it.
pub(crate) fn divide<const D: usize>(system: &mut System<D>, by_owner: bool) {
    let was_divided = division(&system.neighbours).is_some();
    if was_divided != by_owner {
        system.boundary.thin.faces.forget_water();
    }
    if was_divided && !by_owner {
        gather(system, true);
    }
    if let Some(division) = system.neighbours.division_mut() {
        division.by_owner = by_owner && division.ranks.count() > 1;
    }
    if was_divided && !by_owner {
        system.pair_loop.free_buffers();
        let poses = system.boundary.poses_at_rebuild.clone().unwrap_or_default();
        let boundary = system.boundary.positions_at(&poses, &system.solids, &system.fluid.images);
        let water = system.neighbours.positions_at_build().to_vec();
        system.neighbours.build(&water, &boundary);
    }
}

/// Leaves each rank the water of its own slabs before the first lists are made, where it may advance that alone. Until then, a rank has
/// the `part` that was filled for it, or all water.
pub(super) fn divide_at_start<const D: usize>(system: &mut System<D>, part: Option<RankPart>) {
    if !may_be_divided(system) {
        return;
    }
    divide(system, true);
    let System { neighbours, fluid, .. } = system;
    let filled = std::mem::take(&mut fluid.particles);
    let count = part.map_or(filled.len(), |part| part.count);
    let ranks = neighbours.division().map(|division| division.ranks.clone()).unwrap_or_default();
    let filled = match part {
        Some(_) => filled,
        None => filled.slice(ranks::equal_part(count, &ranks)),
    };
    let columns = neighbours.share_out_own(filled.r.iter(), count);
    let Some(division) = neighbours.division_mut() else { return };
    let owner = |r: &Vector<D>| division.owner_of(columns.slab_at(r));
    let (kept, leaving): (Vec<u32>, Vec<u32>) =
        (0..filled.len() as u32).partition(|&i| owner(&filled.r[i as usize]) == ranks.rank());
    let mut own = Particles::unwritten(kept.len());
    set_range(&mut own, 0..kept.len(), &filled, &kept);
    let give = |(filled, _): &(&Particles<D>, &mut Particles<D>), i: usize, given: &mut Vec<f64>| filled.give(i, given);
    let take = |(_, own): &mut (&Particles<D>, &mut Particles<D>), _: usize, given: &[f64]| {
        if owner(&Vector::from_column_slice(&given[..D])) == ranks.rank() {
            own.push_given(given);
        }
    };
    let leaving = IndexRanges::new(leaving);
    division.share_water(&leaving, &mut (&filled, &mut own), Particles::<D>::NUMBERS, give, take);
    drop(filled);
    let mut order: Vec<u32> = (0..own.len() as u32).collect();
    order.sort_unstable_by_key(|&i| own.id[i as usize]);
    let first = ranks.part(own.len()).first;
    let range = first..first + own.len();
    fluid.particles = Particles::unwritten(count);
    set_range(&mut fluid.particles, range.clone(), &own, &order);
    division.set_own_water(range.map(|i| i as u32).collect(), count);
    clear_corrections(system);
    set_apart(system, true);
}

/// The box (m) around the water of all ranks, of which this one may have a `part` at the places `own` (m).
pub(super) fn bounds_of_all<const D: usize>(ranks: &Ranks, own: &[Vector<D>], part: Option<RankPart>) -> Bounds<D> {
    let own = Bounds::around(own);
    if part.is_some() { Division::of(ranks).union(&own) } else { own }
}

/// Completes the water on the first rank, or on all if `everyone`: there with the sums of the last force pass and the gradient
/// corrections.
pub(crate) fn gather<const D: usize>(system: &mut System<D>, everyone: bool) {
    let Some(division) = division(&system.neighbours).filter(|division| division.is_apart) else { return };
    let is_first = division.ranks.rank() == 0;
    if everyone {
        system.pair_loop.share_fluid_sums(&system.neighbours);
    }
    let Fluid { particles, gradient_correction, .. } = &mut system.fluid;
    system.neighbours.share_water(particles, gradient_correction.as_deref_mut().filter(|_| everyone), everyone);
    system.neighbours.forget_known();
    set_apart(system, !everyone);
    system.status.has_all_water = everyone || is_first;
}

/// Whether ranks lack the present water of others: the same for all ranks.
pub(crate) fn is_apart<const D: usize>(neighbours: &NeighbourLists<D>) -> bool {
    neighbours.division().is_some_and(|division| division.is_apart)
}

/// Says whether ranks lack the present water of others.
pub(super) fn set_apart<const D: usize>(system: &mut System<D>, is_apart: bool) {
    if let Some(division) = system.neighbours.division_mut() {
        division.is_apart = is_apart;
    }
    system.status.has_all_water = !is_apart;
}

/// Combines what the ranks saw of their own water in the last loop over it, which changed it.
pub(crate) fn combine_checks<const D: usize>(system: &mut System<D>) {
    let own = system.status.step_check;
    let Some(division) = division(&system.neighbours) else { return };
    let [low, high] = ranks::words_of(own.max_displacement2);
    let all = division.ranks.gather_words([low, high, u32::from(own.valid)]);
    let check =
        |[low, high, valid]: [u32; 3]| StepCheck { max_displacement2: ranks::from_words(low, high), valid: valid != 0 };
    system.status.step_check = all.into_iter().map(check).fold(StepCheck::INITIAL, StepCheck::combine);
    set_apart(system, true);
}

/// The least of the numbers of particles that the ranks name, each of its own water if it has that alone. All ranks get the state of that
/// particle.
pub(super) fn share_first<const D: usize>(system: &mut System<D>, own: Option<usize>) -> Option<usize> {
    let Some(division) = divided(&system.neighbours) else { return own };
    let named = division.ranks.gather_words([own.map_or(u32::MAX, |i| i as u32)]);
    let first = named.into_iter().map(|[i]| i).min().filter(|&i| i < u32::MAX)?;
    let these = IndexRanges::new(own.filter(|&i| i == first as usize).map(|i| i as u32));
    let give = |water: &&mut Particles<D>, i: usize, numbers: &mut Vec<f64>| water.give(i, numbers);
    let take = |water: &mut &mut Particles<D>, i: usize, numbers: &[f64]| water.take(i, numbers);
    division.share_water(&these, &mut (&mut system.fluid.particles), Particles::<D>::NUMBERS, give, take);
    Some(first as usize)
}

/// Gives all ranks the state of particle `i`.
pub(crate) fn tell_of<const D: usize>(system: &mut System<D>, i: usize) {
    let is_own = divided(&system.neighbours)
        .and_then(Division::own_water)
        .is_some_and(|(own, _)| own.within(&(i..i + 1)).next().is_some());
    share_first(system, is_own.then_some(i));
}

/// The division of the water, if each rank advances its own.
fn division<const D: usize>(neighbours: &NeighbourLists<D>) -> Option<&Division> {
    neighbours.division().filter(|division| division.by_owner)
}

/// The range of particles that this rank advances, of `count`, and which ones there; `None` if all there.
pub(crate) fn own<const D: usize>(neighbours: &NeighbourLists<D>, count: usize) -> (Range<usize>, Option<&[bool]>) {
    match division(neighbours) {
        Some(division) => (division.own_range(count), division.own_water().and_then(|(_, is_own)| is_own)),
        None => (0..count, None),
    }
}

/// As [`own`], of the particles whose present state this rank has: all of them while ranks do not lack the water of others.
pub(super) fn present<const D: usize>(neighbours: &NeighbourLists<D>, count: usize) -> (Range<usize>, Option<&[bool]>) {
    if is_apart(neighbours) { own(neighbours, count) } else { (0..count, None) }
}

/// The places, among the boundary particles near water, of those that this rank advances; `None` if all.
pub(super) fn own_boundary<const D: usize>(neighbours: &NeighbourLists<D>) -> Option<&[u32]> {
    neighbours.division().and_then(Division::own_boundary)
}

/// Completes the densities (kg/m³) of all boundary particles with those of the boundary particles that other ranks advance.
pub(super) fn share_boundary_density<const D: usize>(neighbours: &NeighbourLists<D>, rho: &mut [f64]) {
    let (Some(division), near) = (division(neighbours), neighbours.boundary_near_fluid()) else { return };
    let give = |rho: &&mut [f64], k: usize, numbers: &mut Vec<f64>| numbers.push(rho[near[k] as usize]);
    let take = |rho: &mut &mut [f64], k: usize, numbers: &[f64]| rho[near[k] as usize] = numbers[0];
    division.share_boundary(&mut { rho }, 1, give, take);
}

/// Completes the velocities (m/s) with which all boundary particles act as [`share_boundary_density`].
pub(super) fn share_boundary_velocity<const D: usize>(neighbours: &NeighbourLists<D>, v: &mut [Vector<D>]) {
    let (Some(division), near) = (division(neighbours), neighbours.boundary_near_fluid()) else { return };
    let give = |v: &&mut [Vector<D>], k: usize, numbers: &mut Vec<f64>| numbers.extend(v[near[k] as usize].iter());
    let take = |v: &mut &mut [Vector<D>], k: usize, numbers: &[f64]| {
        v[near[k] as usize] = Vector::from_column_slice(numbers);
    };
    division.share_boundary(&mut { v }, D, give, take);
}

/// The numbers that the ranks give, in the order of the ranks, where each advances its own water; else `own`.
pub(super) fn gather_numbers<const D: usize>(neighbours: &NeighbourLists<D>, own: Vec<f64>) -> Vec<f64> {
    match division(neighbours) {
        Some(division) => division.ranks.concat(own),
        None => own,
    }
}

/// The numbers of a rank's water particles in ascending order, and how many all ranks have.
pub(crate) type OwnNames = (Vec<u32>, usize);

/// How ranks share the water, if each has its own and none needs to have that of others.
pub(super) fn divided<const D: usize>(neighbours: &NeighbourLists<D>) -> Option<&Division> {
    division(neighbours).filter(|division| division.is_apart)
}

/// The names of this rank's water, if ranks lack that of others.
pub(crate) fn own_names<const D: usize>(system: &System<D>) -> Option<OwnNames> {
    let (own, _) = divided(&system.neighbours)?.own_water()?;
    Some((own.iter().collect(), system.fluid.particles.len()))
}

/// Gives each rank `water` with gradient corrections that it had stored, of the particles `own`, and makes the lists for the places
/// `then` (m) of these and for the places `boundary` (m). The ranks may part it otherwise now.
pub(super) fn restore<const D: usize>(
    system: &mut System<D>,
    (own, count): OwnNames,
    (water, corrections): (Particles<D>, Option<Vec<Matrix<D>>>),
    then: &[Vector<D>],
    boundary: &[Vector<D>],
) {
    let mut now = Particles::unwritten(count);
    scatter(&mut now.r, &water.r, &own);
    scatter(&mut now.v, &water.v, &own);
    scatter(&mut now.rho, &water.rho, &own);
    scatter(&mut now.id, &water.id, &own);
    drop(water);
    system.fluid.particles = Particles::unwritten(count);
    scatter(&mut system.fluid.particles.r, then, &own);
    system.fluid.gradient_correction = corrections.map(|corrections| {
        let mut all = zeros(count);
        scatter(&mut all, &corrections, &own);
        all
    });
    if let Some(division) = system.neighbours.division_mut() {
        division.by_owner = true;
        division.set_own_water(own, count);
    }
    set_apart(system, true);
    let mut now = StateAtStart { water: now, first: 0, boundary_density: Vec::new() };
    let columns = share_out(system, Some(&mut now), true);
    let next = take_next_slab(system, &columns);
    system.neighbours.build_own(&columns, &system.fluid.particles.r, &next, boundary);
    system.fluid.particles = now.water;
    if let Some(corrections) = &mut system.fluid.gradient_correction {
        take_next_corrections(&system.neighbours, corrections);
    }
}

/// Sets the items `these` of `all`.
fn scatter<T: Copy>(all: &mut [T], items: &[T], these: &[u32]) {
    these.iter().zip(items).for_each(|(&i, item)| all[i as usize] = *item);
}

/// Shares the slabs out anew and gives each particle, with its state in `start` and, if `corrected`, its gradient correction, to the rank
/// that has its slab now. Returns the columns for new lists.
pub(super) fn share_out<const D: usize>(
    system: &mut System<D>,
    start: Option<&mut StateAtStart<D>>,
    corrected: bool,
) -> Columns<D> {
    let columns = system.neighbours.share_out(&system.fluid.particles.r);
    let count = system.fluid.particles.len();
    let Some(division) = division(&system.neighbours) else { return columns };
    let (rank, now) = (division.ranks.rank(), &system.fluid.particles);
    let owner = |r: &Vector<D>| division.owner_of(columns.slab_at(r));
    let is_kept = |&i: &u32| owner(&now.r[i as usize]) == rank;
    let (mut own, leaving): (Vec<u32>, Vec<u32>) = division.own_indices().partition(is_kept);
    let mut arrived = Vec::new();
    let numbers = Particles::<D>::NUMBERS;
    let Fluid { particles, gradient_correction, .. } = &mut system.fluid;
    let corrections = gradient_correction.as_mut().filter(|_| corrected);
    let start = start.map(|start| start.for_all(count));
    let states = if start.is_some() { 2 } else { 1 };
    let width = states * numbers + if corrections.is_some() { D * D } else { 0 };
    type Data<'a, const D: usize> =
        (&'a mut Particles<D>, Option<&'a mut Particles<D>>, Option<&'a mut Vec<Matrix<D>>>);
    let give = |(now, start, corrections): &Data<'_, D>, i: usize, numbers: &mut Vec<f64>| {
        now.give(i, numbers);
        start.iter().for_each(|start| start.give(i, numbers));
        corrections.iter().for_each(|corrections| numbers.extend(corrections[i].iter()));
    };
    let take = |(now, start, corrections): &mut Data<'_, D>, i: usize, given: &[f64]| {
        if owner(&Vector::from_column_slice(&given[..D])) == rank {
            now.take(i, given);
            start.iter_mut().for_each(|start| start.take(i, &given[numbers..]));
            let correction = &given[states * numbers..];
            corrections.iter_mut().for_each(|all| all[i] = Matrix::from_column_slice(correction));
            arrived.push(i as u32);
        }
    };
    division.share_water(&IndexRanges::new(leaving), &mut (particles, start, corrections), width, give, take);
    own.extend(arrived);
    own.sort_unstable();
    if let Some(division) = system.neighbours.division_mut() {
        division.set_own_water(own, count);
    }
    columns
}

/// Sorts the water along the columns, as [`System::sort_water`] does, where each rank has its own: takes out what has left the domain,
/// and gives every rank what was taken out. Returns the columns for new lists, if no more than the order has changed.
pub(super) fn sort<const D: usize>(system: &mut System<D>) -> (Option<Columns<D>>, Vec<RemovedParticle<D>>) {
    let columns = share_out(system, None, false);
    let mut order = system.neighbours.own_order(&columns, &system.fluid.particles.r);
    let removed = system.remove_outside(&mut order);
    let Some(division) = division(&system.neighbours) else { return (None, removed) };
    let removed = gather_removed(division, &removed);
    let RankPart { first, count } = division.ranks.part(order.len());
    let own = first..first + order.len();
    let mut new = Particles::unwritten(count);
    set_range(&mut new, own.clone(), &system.fluid.particles, &order);
    system.fluid.particles = new;
    clear_corrections(system);
    if let Some(division) = system.neighbours.division_mut() {
        division.set_own_water(own.map(|i| i as u32).collect(), count);
    }
    set_apart(system, true);
    (removed.is_empty().then_some(columns), removed)
}

/// Makes arrays for gradient corrections, which new lists will fill.
fn clear_corrections<const D: usize>(system: &mut System<D>) {
    let (count, corrections) = (system.fluid.particles.len(), &mut system.fluid.gradient_correction);
    corrections.iter_mut().for_each(|corrections| *corrections = zeros(count));
}

/// Takes the gradient `corrections` of the particles in the first slab of the rank after this one.
pub(super) fn take_next_corrections<const D: usize>(neighbours: &NeighbourLists<D>, corrections: &mut [Matrix<D>]) {
    let Some(division) = division(neighbours) else { return };
    let ([before, after], slabs) = (division.adjacent(), division.own_slabs());
    let mut out = Vec::new();
    if before.is_some() {
        let first = neighbours.water_of_slab(slabs.start);
        out.extend(first.flat_map(|i| corrections[i].iter().flat_map(|&x| ranks::words_of(x)).collect::<Vec<_>>()));
    }
    let next: Vec<usize> = if after.is_some() { neighbours.water_of_slab(slabs.end).collect() } else { Vec::new() };
    let mut into = vec![0; next.len() * 2 * D * D];
    division.ranks.pass((before, &out), (after, &mut into));
    for (i, words) in next.into_iter().zip(into.chunks_exact(2 * D * D)) {
        corrections[i] = Matrix::from_iterator(ranks::doubles(words));
    }
}

/// Sets the particles `range` of `new` to those of `old` in `order`.
fn set_range<const D: usize>(new: &mut Particles<D>, range: Range<usize>, old: &Particles<D>, order: &[u32]) {
    fill(&mut new.r[range.clone()], &old.r, order);
    fill(&mut new.v[range.clone()], &old.v, order);
    fill(&mut new.rho[range.clone()], &old.rho, order);
    fill(&mut new.id[range], &old.id, order);
}

/// Sets `new` to the items of `old` in `order`.
fn fill<T: Copy + Send + Sync>(new: &mut [T], old: &[T], order: &[u32]) {
    let new = new.par_iter_mut().zip(order).with_min_len(PARTICLES_PER_TASK);
    new.for_each(|(new, &i)| *new = old[i as usize]);
}

/// What all ranks have removed, in the order of the columns.
fn gather_removed<const D: usize>(division: &Division, own: &[RemovedParticle<D>]) -> Vec<RemovedParticle<D>> {
    let paths = [ExitPath::Up, ExitPath::Over, ExitPath::Through];
    let bytes = |lost: &RemovedParticle<D>| {
        let path = paths.iter().position(|path| *path == lost.exit).unwrap_or_default();
        let numbers = [f64::from(lost.id), lost.rho, path as f64];
        let numbers = numbers.into_iter().chain(lost.r.iter().chain(lost.v.iter()).copied());
        numbers.flat_map(f64::to_le_bytes).collect::<Vec<u8>>()
    };
    let all = division.ranks.gather_bytes(&own.iter().flat_map(bytes).collect::<Vec<u8>>()).concat();
    let number = |bytes: &[u8]| f64::from_le_bytes(std::array::from_fn(|k| bytes[k]));
    let numbers: Vec<f64> = all.chunks_exact(8).map(number).collect();
    let lost = |numbers: &[f64]| RemovedParticle {
        id: numbers[0] as u32,
        rho: numbers[1],
        exit: paths[numbers[2] as usize],
        r: Vector::from_column_slice(&numbers[3..3 + D]),
        v: Vector::from_column_slice(&numbers[3 + D..]),
    };
    numbers.chunks_exact(3 + 2 * D).map(lost).collect()
}

/// Takes the positions of the particles in the first slab of the rank after this one; returns which these are.
pub(super) fn take_next_slab<const D: usize>(system: &mut System<D>, columns: &Columns<D>) -> Vec<u32> {
    let Some(division) = division(&system.neighbours) else { return Vec::new() };
    let ([before, after], slabs) = (division.adjacent(), division.own_slabs());
    let r = &mut system.fluid.particles.r;
    let first = division.own_indices();
    let first = first.filter(|&i| before.is_some() && columns.slab_at(&r[i as usize]) == slabs.start);
    let words =
        |i: u32| std::iter::once(i).chain(r[i as usize].iter().flat_map(|&x| ranks::words_of(x)).collect::<Vec<_>>());
    let (out, width) = (first.flat_map(words).collect::<Vec<u32>>(), 1 + 2 * D);
    let counts = division.ranks.counts(out.len());
    let mut into = vec![0; after.map_or(0, |rank| counts[rank])];
    division.ranks.pass((before, &out), (after, &mut into));
    let mut next = Vec::with_capacity(into.len() / width);
    for words in into.chunks_exact(width) {
        next.push(words[0]);
        r[words[0] as usize] = Vector::from_iterator(ranks::doubles(&words[1..]));
    }
    next
}

/// The state of this rank's water and of its boundary particles near water at the start of a step.
pub(crate) struct StateAtStart<const D: usize> {
    /// The water from particle `first` on, without names.
    water: Particles<D>,
    first: usize,
    /// Densities of the boundary particles near water that this rank advances, kg/m³.
    boundary_density: Vec<f64>,
}

impl<const D: usize> StateAtStart<D> {
    /// That of the present.
    pub(crate) fn of(system: &System<D>) -> Self {
        let Particles { r, v, rho, .. } = &system.fluid.particles;
        let own = division(&system.neighbours).map_or(0..r.len(), |division| division.own_range(r.len()));
        let first = own.start;
        let water = Particles {
            r: r[own.clone()].to_vec(),
            v: v[own.clone()].to_vec(),
            rho: rho[own].to_vec(),
            id: Vec::new(),
        };
        let mut start = Self { water, first, boundary_density: Vec::new() };
        start.set_boundary_densities(system, &system.boundary.particles.rho);
        start
    }

    /// Position (m), velocity (m/s) and density (kg/m³) of water particle `i`.
    #[inline(always)]
    pub(crate) fn particle(&self, i: usize) -> (Vector<D>, Vector<D>, f64) {
        let (Particles { r, v, rho, .. }, i) = (&self.water, i - self.first);
        (r[i], v[i], rho[i])
    }

    /// The water, in arrays that have places for all `count` particles.
    fn for_all(&mut self, count: usize) -> &mut Particles<D> {
        let Self { water, first, .. } = self;
        if water.len() < count {
            let (own, part) = (*first..*first + water.len(), std::mem::replace(water, Particles::unwritten(count)));
            water.r[own.clone()].copy_from_slice(&part.r);
            water.v[own.clone()].copy_from_slice(&part.v);
            water.rho[own].copy_from_slice(&part.rho);
            *first = 0;
        }
        water
    }

    /// Density (kg/m³) of the boundary particle at this place among those near water that this rank advances.
    pub(crate) fn boundary_density(&self, place: usize) -> f64 {
        self.boundary_density[place]
    }

    /// Those of all boundary particles; far from water these are the present ones.
    pub(super) fn all_boundary_densities(&self, system: &System<D>) -> Vec<f64> {
        let mut all = system.boundary.particles.rho.clone();
        own_near(&system.neighbours).zip(&self.boundary_density).for_each(|(i, rho)| all[i] = *rho);
        share_boundary_density(&system.neighbours, &mut all);
        all
    }

    /// Keeps those that this rank advances now of the densities of `all` boundary particles.
    pub(super) fn set_boundary_densities(&mut self, system: &System<D>, all: &[f64]) {
        self.boundary_density = own_near(&system.neighbours).map(|i| all[i]).collect();
    }
}

/// The boundary particles near water that this rank advances.
fn own_near<const D: usize>(neighbours: &NeighbourLists<D>) -> impl Iterator<Item = usize> {
    let near = neighbours.boundary_near_fluid();
    let own = own_boundary(neighbours);
    (0..own.map_or(near.len(), <[u32]>::len))
        .map(move |place| near[own.map_or(place, |own| own[place] as usize)] as usize)
}

#[cfg(test)]
#[path = "../../tests/unit/system/own_water.rs"]
mod tests;
