//! Buoyancy of parts of solids thinner than dp.
//!
//! A single layer of boundary particles in the middle of a part of thickness t keeps the water off as a part dp thick does. Each
//! particle displaces (dp − t) dpᴰ⁻¹ too much. The buoyancy of this excess, −ρ₀ g (dp − t) dpᴰ⁻¹ s, is subtracted from the load
//! on the solid. The share s of water around the particle, by kernel weights, is 1 under water, ½ with water on one side, and 0
//! in air. Only the buoyancy in water at rest is corrected; the added mass of a plate hardly depends on its thickness.
//!
//! Water in a hollow of the solid, as in a vessel, is a fixed amount: the excess raises its level, and the solid carries its weight
//! without a correction. The side of a layer beside a hollow therefore does not count, until water outside covers the rim.
//!
//! The component across the faces of a layer moves the pressures to the true faces. The component along the faces is the excess
//! of the pressure on the lower end over that on the upper end. Where a fixed or driven part stands on another such solid, no
//! water is below its lower end. The component along the faces is then subtracted from the load on that other solid, whose face
//! the layer covers.

use super::{System, thin_faces::ThinFaces};
use crate::{
    geometry::{
        Shape,
        cells::PointCells,
        hollow::{Enclosure, Place, may_enclose},
        thin::thin_place,
    },
    math::{Matrix, Vector},
    model::{Model, Walls},
    solid::{Load, Solid},
};

/// Depth of a particle below its face, dp, from which on its part is not thinner than dp.
pub(super) const THICK: f64 = 0.499;

/// Distance between neighbours in a layer, dp: along the axes and the diagonals of its faces.
const NEIGHBOURS: f64 = 1.6;

/// Step of the search for the end of a part, and where it is given up, dp.
const SEARCH: [f64; 2] = [0.05, 1.5];

/// Slope of a layer, –, up to which it has no lower end.
const LEVEL: f64 = 1e-3;

/// Gap below the end of a part from which on water is below it, dp.
const OPEN: f64 = 0.25;

/// Largest distance, dp, of a thin particle from the rim of a hollow for which it tells whether water covers the rim.
const RIM: f64 = 3.0;

/// A boundary particle in the middle of a thin part.
struct ThinParticle<const D: usize> {
    /// Its place among the particles of a copy of its solid.
    place: u32,
    /// Place in the frame of its solid, m.
    at: Vector<D>,
    /// Volume (m³; m² in 2-D) for which the water makes way in excess.
    excess: f64,
    /// Outward unit normal of one of its faces, in the frame of its solid.
    normal: Vector<D>,
    /// Numbers of the hollows of the solid before that face and behind the opposite one.
    hollows: [Option<u32>; 2],
    /// Places in this list of those next to it.
    beside: Vec<u32>,
}

/// The water around a boundary particle.
pub(super) struct WaterAround<const D: usize> {
    /// Share of the kernel's support that it fills, –.
    pub weight: f64,
    /// Mean place of the water from the particle, m; zero where it is not known.
    pub offset: Vector<D>,
}

/// What a part stands on.
#[derive(Clone, Copy)]
struct Foot<const D: usize> {
    /// Number of the solid below.
    on: usize,
    /// Place (m) of the end of the part on that solid.
    at: Vector<D>,
    /// Share of the end without water below it, –.
    closed: f64,
}

/// The ends of the thin parts of a solid that is not free.
struct Ends<const D: usize> {
    /// Gravity (m/s²) in the frame of the solid with which they were found.
    gravity: Vector<D>,
    /// Number of the thin particle at the lower end of the part with each thin particle.
    lowest: Vec<u32>,
}

/// The boundary particles in the middle of thin parts, and the faces of such parts.
pub(super) struct ThinLayers<const D: usize> {
    of_solid: Vec<Vec<ThinParticle<D>>>,
    /// The thin particles at the rim of each hollow of each solid.
    rims: Vec<Vec<Vec<u32>>>,
    /// The ends of the parts of each solid; `None` for free solids and for those without thin parts.
    ends: Vec<Option<Ends<D>>>,
    /// Share of the surroundings that is water, without that in hollows, of each particle of each copy at the last force pass.
    wet: Vec<f64>,
    /// Whether walls have the weight of the water before them.
    possible: bool,
    /// The faces that push water away.
    pub(super) faces: ThinFaces<D>,
}

impl<const D: usize> ThinLayers<D> {
    pub(super) fn new(model: &Model) -> Self {
        let (possible, faces) = (model.walls == Walls::RelaxedAdami, ThinFaces::default());
        Self { of_solid: Vec::new(), rims: Vec::new(), ends: Vec::new(), wet: Vec::new(), possible, faces }
    }

    /// Whether no part is thin.
    pub(super) fn is_empty(&self) -> bool {
        self.of_solid.iter().all(Vec::is_empty)
    }

    /// Adds a solid of this `shape`, turned by `rotation`, with boundary particles at `places` (m, in its frame), `depths` (m) below
    /// its face.
    pub(super) fn append(
        &mut self,
        (shape, rotation): (&Shape<D>, &Matrix<D>),
        places: &[Vector<D>],
        depths: &[f64],
        dp: f64,
    ) {
        let thin = |(place, (x, depth)): (usize, (&Vector<D>, &f64))| {
            let candidate = self.possible && *depth < THICK * dp;
            let found = candidate.then(|| thin_place(shape, x, dp, 1e-3 * dp)).flatten()?;
            let excess = (dp - found.thickness) * dp.powi(D as i32 - 1);
            let (normal, beside) = (found.normal, Vec::new());
            Some(ThinParticle { place: place as u32, at: *x, excess, normal, hollows: [None; 2], beside })
        };
        let mut found: Vec<_> = places.iter().zip(depths).enumerate().filter_map(thin).collect();
        let points: Vec<_> = found.iter().map(|particle| places[particle.place as usize]).collect();
        let cells = PointCells::new(&points, NEIGHBOURS * dp);
        for (k, particle) in found.iter_mut().enumerate() {
            let near = |x: &Vector<D>| (x - points[k]).norm() < NEIGHBOURS * dp;
            cells.visit_near(&points[k], NEIGHBOURS * dp, |m, x| {
                if m != k && near(x) {
                    particle.beside.push(m as u32);
                }
            });
            particle.beside.sort_unstable();
        }
        let enclosure = (!found.is_empty() && may_enclose(shape, true)).then(|| Enclosure::of(shape, rotation, dp));
        let rims = enclosure.flatten().map(|enclosure| {
            for particle in &mut found {
                let thickness = dp - particle.excess / dp.powi(D as i32 - 1);
                let aside = particle.normal * (0.5 * (thickness + dp));
                particle.hollows = [aside, -aside].map(|aside| match enclosure.place(shape, &(particle.at + aside)) {
                    Place::Hollow(number) => Some(number as u32),
                    Place::Outside | Place::Material => None,
                });
            }
            let nearest = |rim: &Vector<D>| {
                let distance = |k: &usize| (points[*k] - rim).norm();
                let nearest = (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
                nearest.filter(|k| distance(k) < RIM * dp).map(|k| k as u32)
            };
            enclosure.hollows.iter().map(|hollow| hollow.rim().iter().filter_map(nearest).collect()).collect()
        });
        self.rims.push(rims.unwrap_or_default());
        self.of_solid.push(found);
    }

    /// Forgets the particles of solid number `solid`.
    pub(super) fn remove(&mut self, solid: usize) {
        if let Some(particles) = self.of_solid.get_mut(solid) {
            particles.clear();
        }
        self.wet.clear();
        self.faces.remove(solid);
    }

    /// Number of the solid, first boundary particle and thin particles of each copy.
    fn each<'a>(&'a self, solids: &'a [Solid<D>]) -> impl Iterator<Item = (usize, usize, &'a [ThinParticle<D>])> + 'a {
        self.of_solid.iter().zip(solids).enumerate().flat_map(|(number, (particles, solid))| {
            (0..solid.copies()).map(move |copy| (number, solid.boundary_of_copy(copy).start, &particles[..]))
        })
    }
}

/// Of each copy of a solid with thin particles: the number of the solid, and index, share of the surroundings that is water, and outward
/// normal of each.
pub(super) fn thin_particles<const D: usize>(
    system: &System<D>,
) -> impl Iterator<Item = (usize, Vec<(usize, f64, Vector<D>)>)> + '_ {
    let thin = &system.boundary.thin;
    let mut first = 0;
    thin.each(&system.solids).filter(|each| !each.2.is_empty()).map(move |(number, start, particles)| {
        let rotation = &system.solids[number].kinematics.pose.rotation;
        let wet = thin.wet.get(first..first + particles.len()).unwrap_or_default();
        first += particles.len();
        let of = |(particle, wet): (&ThinParticle<D>, &f64)| {
            (start + particle.place as usize, *wet, rotation * particle.normal)
        };
        (number, particles.iter().zip(wet).map(of).collect())
    })
}

/// The boundary particles in the middle of thin parts.
#[cfg(feature = "gpu")]
pub(super) fn particles<const D: usize>(system: &System<D>) -> impl Iterator<Item = u32> + '_ {
    let each = system.boundary.thin.each(&system.solids);
    each.flat_map(|(_, start, particles)| particles.iter().map(move |particle| start as u32 + particle.place))
}

/// Whether a thin part is beside a hollow.
#[cfg(feature = "gpu")]
pub(super) fn has_hollows<const D: usize>(system: &System<D>) -> bool {
    let all = system.boundary.thin.of_solid.iter().flatten();
    all.flat_map(|particle| particle.hollows).any(|hollow| hollow.is_some())
}

/// Whether a thin part is beside no hollow, so that water may be on both of its sides.
#[cfg(feature = "gpu")]
pub(super) fn may_be_wet_on_both_sides<const D: usize>(system: &System<D>) -> bool {
    let all = system.boundary.thin.of_solid.iter().flatten();
    all.into_iter().any(|particle| particle.hollows.iter().all(Option::is_none))
}

/// Reads the `water` around the thin parts, if there is any around a boundary particle, and finds the ends of parts that have turned.
pub(super) fn update_water<const D: usize>(
    system: &mut System<D>,
    water: impl Fn(&System<D>, u32) -> Option<WaterAround<D>>,
) {
    let (thin, dp) = (&system.boundary.thin, system.model.dp);
    let both_sides = 2.0 * system.boundary.coverage.full_weight(0.5 * dp);
    let mut wet = Vec::new();
    for (number, start, particles) in thin.each(&system.solids) {
        let around = particles.iter().map(|particle| {
            let water = water(system, start as u32 + particle.place);
            water.map_or((0.0, Vector::zeros()), |water| ((water.weight / both_sides).min(1.0), water.offset))
        });
        let around: Vec<(f64, Vector<D>)> = around.collect();
        // With water on both sides at the rim, a hollow is a part of the water outside.
        let most = |rim: &Vec<u32>| rim.iter().map(|&k| around[k as usize].0).fold(0.0, f64::max);
        let apart: Vec<f64> = thin.rims[number].iter().map(|rim| (2.0 - 2.0 * most(rim)).clamp(0.0, 1.0)).collect();
        let rotation = &system.solids[number].kinematics.pose.rotation;
        let share = |(particle, (share, offset)): (&ThinParticle<D>, &(f64, Vector<D>))| {
            let before = (0.5 + (rotation * particle.normal).dot(offset) / dp).clamp(0.0, 1.0);
            let in_hollow = |(hollow, part): (Option<u32>, f64)| hollow.map_or(0.0, |k| apart[k as usize] * part);
            let in_hollows: f64 = particle.hollows.into_iter().zip([before, 1.0 - before]).map(in_hollow).sum();
            share * (1.0 - in_hollows)
        };
        wet.extend(particles.iter().zip(&around).map(share));
    }
    system.boundary.thin.wet = wet;
    update_ends(system);
}

/// Finds the lower ends of the parts of each solid that is new, or has turned.
fn update_ends<const D: usize>(system: &mut System<D>) {
    let mut ends = std::mem::take(&mut system.boundary.thin.ends);
    ends.resize_with(system.solids.len(), || None);
    for (number, (solid, particles)) in system.solids.iter().zip(&system.boundary.thin.of_solid).enumerate() {
        // A film presses on the foot of a free body.
        if particles.is_empty() || solid.is_free() {
            ends[number] = None;
            continue;
        }
        let gravity = solid.kinematics.pose.rotation.transpose() * system.properties.gravity;
        if ends[number].as_ref().is_none_or(|ends| ends.gravity != gravity) {
            ends[number] = Some(Ends { gravity, lowest: lower_ends(&gravity, particles) });
        }
    }
    system.boundary.thin.ends = ends;
}

/// Number of the particle at the lower end of the part with each of these `particles`; `gravity` (m/s²) in the frame of their solid.
fn lower_ends<const D: usize>(gravity: &Vector<D>, particles: &[ThinParticle<D>]) -> Vec<u32> {
    let drop: Vec<f64> = particles.iter().map(|particle| gravity.dot(&particle.at)).collect();
    let mut downwards: Vec<usize> = (0..particles.len()).collect();
    downwards.sort_by(|&a, &b| drop[b].total_cmp(&drop[a]));
    let mut ends: Vec<u32> = (0..particles.len() as u32).collect();
    // The lowest come first: each has the end of its lowest neighbour.
    for k in downwards {
        let beside = particles[k].beside.iter().map(|&m| m as usize);
        let lowest = beside.max_by(|&a, &b| drop[a].total_cmp(&drop[b])).filter(|&m| drop[m] > drop[k]);
        ends[k] = lowest.map_or(k as u32, |m| ends[m]);
    }
    ends
}

/// The loads that take the buoyancy in excess off the computed part of each solid, about its centre; an empty list without thin parts.
pub(super) fn loads<const D: usize>(system: &System<D>) -> Vec<Load<D>> {
    let thin = &system.boundary.thin;
    if thin.wet.is_empty() {
        return Vec::new();
    }
    let weight = system.properties.gravity * system.properties.rho0;
    let mut loads = vec![Load::zero(); system.solids.len()];
    let mut wet = thin.wet.iter();
    for (number, start, particles) in thin.each(&system.solids) {
        let (solid, feet) = (&system.solids[number], feet(system, number, start, particles));
        for ((k, particle), wet) in particles.iter().enumerate().zip(&mut wet) {
            let i = start + particle.place as usize;
            let r = &system.boundary.particles.r[i];
            if !system.is_in_counted_water(r) {
                continue;
            }
            let arm = system.place_on_solid(number, i) - solid.kinematics.centre;
            let force = weight * (particle.excess * wet * system.computed_share(solid, r));
            loads[number] += Load::from_force_at(&arm, force);
            if let Some(Foot { on, at, closed }) = feet.get(k).copied().flatten() {
                let along = along_faces(&force, solid, particle) * closed;
                loads[number] += Load::from_force_at(&arm, -along);
                loads[on] += Load::from_force_at(&(at - system.solids[on].kinematics.centre), along);
            }
        }
    }
    loads
}

/// The part of `x` along the faces beside `particle` of `solid`.
fn along_faces<const D: usize>(x: &Vector<D>, solid: &Solid<D>, particle: &ThinParticle<D>) -> Vector<D> {
    let normal = solid.kinematics.pose.rotation * particle.normal;
    x - normal * normal.dot(x)
}

/// What each of the `particles` of solid number `number`, whose boundary particles begin at `start`, stands on; an empty list if
/// nothing does.
fn feet<const D: usize>(
    system: &System<D>,
    number: usize,
    start: usize,
    particles: &[ThinParticle<D>],
) -> Vec<Option<Foot<D>>> {
    let Some(Some(ends)) = system.boundary.thin.ends.get(number) else { return Vec::new() };
    let mut feet = vec![None; particles.len()];
    for (k, particle) in particles.iter().enumerate().filter(|(k, _)| ends.lowest[*k] == *k as u32) {
        feet[k] = foot(system, number, start, particle);
    }
    ends.lowest.iter().map(|lowest| feet[*lowest as usize]).collect()
}

/// What the lowest particle of a thin part of solid number `number` stands on.
fn foot<const D: usize>(
    system: &System<D>,
    number: usize,
    start: usize,
    particle: &ThinParticle<D>,
) -> Option<Foot<D>> {
    let (solid, dp) = (&system.solids[number], system.model.dp);
    let gravity = system.properties.gravity;
    let down: Vector<D> = along_faces(&gravity, solid, particle).try_normalize(LEVEL * gravity.norm())?;
    let x = system.boundary.particles.r[start + particle.place as usize];
    let on_solid = system.place_on_solid(number, start + particle.place as usize);
    let is_outside = |way: &f64| {
        let local = solid.kinematics.pose.local(&(on_solid + down * *way));
        solid.spec.shape.signed_distance(&local) > 0.0
    };
    let [step, most] = SEARCH.map(|x| x * dp);
    let way = (1..=(most / step) as usize).map(|n| n as f64 * step).find(is_outside)?;
    let end = system.fluid.images.wrapped(&(x + down * way));
    let below = |(on, other): (usize, &Solid<D>)| {
        let pose = system.home_pose(on);
        let local = pose.local(&end);
        if on == number || other.is_free() || !system.boundary.local_bounds[on].grown(dp).contains(&local) {
            return None;
        }
        let gap = other.spec.shape.signed_distance(&local);
        let closed = (1.0 - gap / (OPEN * dp)).clamp(0.0, 1.0);
        (closed > 0.0).then(|| Foot { on, at: end + other.kinematics.pose.position - pose.position, closed })
    };
    let feet = system.solids.iter().enumerate().filter_map(below);
    feet.max_by(|a, b| a.closed.total_cmp(&b.closed))
}
