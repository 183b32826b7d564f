//! Repulsion by the true faces of thin parts of solids, in 3-D.
//!
//! One or two layers of boundary particles have gaps of up to 1 dp between them, through which the pressure of deep water presses
//! particles. Beside a part thinner than 2.5 dp, water nearer than ¼ dp to the face is therefore pushed away from it:
//!
//!   dv/dt = A c₀²/dp² (¼ dp − d) n
//!
//! with the signed distance d from the face, negative inside the part, and its outward normal n. To reach the middle of a part of
//! thickness t, a particle needs the energy ½ A c₀² (¼ + t/2dp)² a mass, which is 6 % of c₀² for the thinnest part. At rest, water
//! lies about half a dp from a face and is not pushed. The solid receives the opposite impulse as a load in the same step.
//!
//! Where a thin part ends at another solid, a particle could pass its end within the face of that solid. The distance d of a particle
//! nearer than ½ dp to the face of a fixed or driven solid is therefore that of the place ½ dp before this face.

use rayon::prelude::*;

use super::{MomentumTransfer, System, impulses::change_velocities, own_water, squeezed_water, thin_sides};
#[cfg(feature = "gpu")]
use crate::math::Bounds;
use crate::{
    geometry::{
        BoundaryPoint, Shape,
        cells::PointCells,
        thin::{face_cells, is_between_opposite_faces},
    },
    math::Vector,
    particles::PARTICLES_PER_TASK,
    solid::Load,
    sph::boundary::Repulsion,
};

/// Thickness of a part, dp, from which on boundary particles alone keep water out (`docs/measurements/thin-tank.toml`).
const THIN: f64 = 2.5;

/// Distance from the face, dp, from which on water is not pushed: there boundary particles, half a dp behind the face, begin to repel it.
const RANGE: f64 = Repulsion::RANGE - 0.5;

/// Largest distance, dp, of water that is pushed from the nearest of the places that mark a thin part: up to 1½ dp across, and the
/// diagonal of a cell of edge dp.
const REACH: f64 = 2.0;

/// Edge, dp, of the cubes whose places have a box in common in which a device finds water.
#[cfg(feature = "gpu")]
const BOX: f64 = 16.0;

/// Depth, dp, beyond which the push does not grow: half of the largest thickness.
const DEEPEST: f64 = 0.5 * THIN;

/// A push of a solid on a water particle.
pub(super) struct Push<const D: usize> {
    pub(super) particle: usize,
    pub(super) solid: usize,
    /// Change of the particle's velocity, m/s.
    pub(super) change: Vector<D>,
    /// Place of the particle from the centre of the solid, m.
    pub(super) arm: Vector<D>,
}

impl<const D: usize> Push<D> {
    /// How many numbers [`Push::numbers`] gives.
    const NUMBERS: usize = 2 + 2 * D;

    fn numbers(&self) -> impl Iterator<Item = f64> {
        let vectors = self.change.iter().chain(self.arm.iter()).copied();
        [self.particle as f64, self.solid as f64].into_iter().chain(vectors)
    }

    /// The push of these [`Push::numbers`].
    fn of(numbers: &[f64]) -> Self {
        let [change, arm] = [2, 2 + D].map(|start| Vector::from_column_slice(&numbers[start..start + D]));
        Self { particle: numbers[0] as usize, solid: numbers[1] as usize, change, arm }
    }
}

/// The faces of thin parts, and the water beside them.
#[derive(Default)]
pub(super) struct ThinFaces<const D: usize> {
    /// Of each solid: places (m, in its frame) beside the faces of its thin parts; `None` without thin parts.
    of_solid: Vec<Option<PointCells<D>>>,
    /// The water of this rank that may come near them before the next lists, for each of [`copies`]; `None` if it is to be found.
    beside: Option<Vec<Vec<u32>>>,
}

impl<const D: usize> ThinFaces<D> {
    /// Adds a solid of this `shape` with these boundary `points`.
    pub(super) fn append(&mut self, shape: &Shape<D>, points: &[BoundaryPoint<D>], dp: f64) {
        if D == 2 {
            self.of_solid.push(None);
            return;
        }
        // The tips of a mesh have no boundary particles.
        let places = match shape {
            Shape::Mesh { .. } => face_cells(shape, dp),
            _ => points.iter().filter(|point| point.layer == 0).map(|point| point.r).collect(),
        };
        let is_thin = |x: &Vector<D>| is_between_opposite_faces(shape, x, THIN * dp, 1e-3 * dp);
        let found: Vec<Vector<D>> = places.into_par_iter().filter(is_thin).collect();
        self.of_solid.push((!found.is_empty()).then(|| PointCells::new(&found, REACH * dp)));
    }

    /// Forgets the faces of solid number `solid`.
    pub(super) fn remove(&mut self, solid: usize) {
        if let Some(faces) = self.of_solid.get_mut(solid) {
            *faces = None;
        }
        self.forget_water();
    }

    /// Lets the next step find the water beside thin parts: lists, or the water of this rank, have changed.
    pub(super) fn forget_water(&mut self) {
        self.beside = None;
    }

    /// Whether no solid has thin parts.
    fn is_empty(&self) -> bool {
        self.of_solid.iter().all(Option::is_none)
    }
}

/// Whether a solid has parts whose faces push the water.
pub(crate) fn has_thin_faces<const D: usize>(system: &System<D>) -> bool {
    !system.boundary.thin.faces.is_empty()
}

/// The copies of the solids with thin parts: the number of the solid, the places that mark its thin parts, and the displacement (m) to
/// the copy across periodic sides.
fn copies<const D: usize>(system: &System<D>) -> impl Iterator<Item = (usize, &PointCells<D>, Vector<D>)> {
    let System { solids, boundary, fluid, .. } = system;
    let thin = solids.iter().zip(&boundary.thin.faces.of_solid).enumerate();
    thin.filter_map(|(number, (solid, faces))| Some((number, solid, faces.as_ref()?))).flat_map(
        |(number, solid, faces)| {
            let copies = boundary.copies(&fluid.images, (number, solid), &solid.kinematics.pose);
            copies.map(move |(_, way)| (number, faces, way))
        },
    )
}

/// The water of this rank that may come near thin parts before the next lists, for each of [`copies`].
fn water_beside<const D: usize>(system: &System<D>) -> Vec<Vec<u32>> {
    // Water and solids may both have moved by the margin, and a step may pass it.
    let reach = REACH * system.model.dp + 3.0 * system.neighbours.margin();
    let (these, own) = own_water::own(&system.neighbours, system.own_count());
    let water = (these.start as u32..these.end as u32).into_par_iter().with_min_len(PARTICLES_PER_TASK);
    water_within(system, reach, water.filter(|i| own.is_none_or(|own| own[*i as usize])))
}

/// The particles among the `water` that are within `reach` (m) of the places that mark thin parts, for each of [`copies`].
fn water_within<const D: usize>(
    system: &System<D>,
    reach: f64,
    water: impl ParallelIterator<Item = u32> + Clone,
) -> Vec<Vec<u32>> {
    let r = &system.fluid.particles.r;
    let beside = |(number, faces, way): (usize, &PointCells<D>, Vector<D>)| {
        let (pose, bounds) = (&system.solids[number].kinematics.pose, &system.boundary.local_bounds[number]);
        let bounds = bounds.grown(reach);
        let is_near = |i: &u32| {
            let x = pose.local(&(r[*i as usize] - way));
            let mut near = false;
            if bounds.contains(&x) {
                faces.visit_near(&x, reach, |_, y| near |= (x - y).norm_squared() < reach * reach);
            }
            near
        };
        water.clone().filter(is_near).collect()
    };
    copies(system).map(beside).collect()
}

/// Boxes (m), in the frame of each solid, around the places that mark its thin parts.
#[cfg(feature = "gpu")]
pub(crate) fn boxes<const D: usize>(system: &System<D>) -> Vec<Vec<Bounds<D>>> {
    let of = |faces: &Option<PointCells<D>>| {
        faces.as_ref().map_or_else(Vec::new, |faces| faces.boxes(BOX * system.model.dp))
    };
    system.boundary.thin.faces.of_solid.iter().map(of).collect()
}

/// The boxes (m) in which thin parts at their present places may push water, from those [around them](boxes).
#[cfg(feature = "gpu")]
pub(crate) fn ranges_beside<const D: usize>(system: &System<D>, boxes: &[Vec<Bounds<D>>]) -> Vec<Bounds<D>> {
    let of_copy = |(number, _, way): (usize, &PointCells<D>, Vector<D>)| {
        let pose = system.solids[number].kinematics.pose;
        let placed = move |range: &Bounds<D>| {
            let corners: Vec<Vector<D>> = range.corners().map(|x| pose.point(&x) + way).collect();
            Bounds::around(&corners).grown(REACH * system.model.dp)
        };
        boxes[number].iter().map(placed)
    };
    copies(system).flat_map(of_copy).collect()
}

/// Lets the next step push the water that a device has told alone, where it is near thin parts.
#[cfg(feature = "gpu")]
pub(crate) fn find_known_water<const D: usize>(system: &mut System<D>) {
    let (count, known) = (system.own_count(), system.neighbours.known_water().unwrap_or_default());
    let water = known.par_iter().with_min_len(PARTICLES_PER_TASK).copied().filter(|i| (*i as usize) < count);
    system.boundary.thin.faces.beside = Some(water_within(system, REACH * system.model.dp, water));
}

/// Pushes the water beside thin parts and in [narrow gaps](squeezed_water) over a step `dt` (s), and adds the loads on the solids; they
/// act on bodies by the factor `weight` (–). Returns what the water received and the impulse (N s, N m s) on each solid, or `None` if
/// there is no such water.
pub(crate) fn repel<const D: usize>(
    system: &mut System<D>,
    dt: f64,
    weight: f64,
) -> Option<(MomentumTransfer<D>, Vec<Load<D>>)> {
    let flows = squeezed_water::flows(system);
    let (has_faces, has_sides) = (has_thin_faces(system), thin_sides::has_thin_sides(system));
    if !has_faces && !has_sides && !flows {
        return None;
    }
    let mut own = if flows { squeezed_water::pushes(system) } else { Vec::new() };
    if has_faces {
        let beside = system.boundary.thin.faces.beside.take().unwrap_or_else(|| water_beside(system));
        own.extend(pushes(system, &beside, dt));
        system.boundary.thin.faces.beside = Some(beside);
    }
    if has_sides {
        thin_sides::know_water(system);
        own.extend(thin_sides::pushes(system, dt));
    }
    let (mass, numbers) = (system.particle_mass(), own.iter().flat_map(Push::numbers).collect());
    let numbers = own_water::gather_numbers(&system.neighbours, numbers);
    let mut all: Vec<Push<D>> = numbers.chunks_exact(Push::<D>::NUMBERS).map(Push::of).collect();
    all.sort_by_key(|push| (push.particle, push.solid));
    let mut impulses = vec![Load::zero(); system.solids.len()];
    for push in all {
        impulses[push.solid] += Load::from_force_at(&push.arm, push.change * -mass);
    }
    for (solid, impulse) in impulses.iter_mut().enumerate() {
        if system.solids[solid].division.cut != 0 {
            *impulse = system.load_on_whole(&system.solids[solid], *impulse);
        }
        if *impulse != Load::zero() {
            system.solids[solid].load += *impulse * (1.0 / (dt * weight));
        }
    }
    own.sort_by_key(|push| push.particle);
    let by_particle = own.chunk_by(|a, b| a.particle == b.particle);
    let change = |same: &[Push<D>]| same[1..].iter().fold(same[0].change, |sum, push| sum + push.change);
    let changes = by_particle.map(|same| (same[0].particle, change(same))).collect();
    Some((change_velocities(system, changes, mass * system.water_multiplicity()), impulses))
}

/// The pushes of thin parts on the water `beside` each of [`copies`] over a step `dt` (s).
fn pushes<const D: usize>(system: &System<D>, beside: &[Vec<u32>], dt: f64) -> Vec<Push<D>> {
    let dp = system.model.dp;
    // Long steps, as with large h and Courant numbers, limit the push; it is stable up to four times this limit.
    let stiffness = (Repulsion::STRENGTH * (system.properties.c0 / dp).powi(2)).min(1.0 / (dt * dt));
    let by_copy = |((number, _, way), particles): ((usize, &PointCells<D>, Vector<D>), &Vec<u32>)| {
        let solid = &system.solids[number];
        let (shape, kinematics) = (&solid.spec.shape, &solid.kinematics);
        let push = |particle: &u32| {
            let particle = *particle as usize;
            let on_solid = system.fluid.particles.r[particle] - way;
            let x = kinematics.pose.local(&before_others(system, number, on_solid));
            let near = RANGE * dp - shape.signed_distance(&x).max(-DEEPEST * dp);
            if near <= 0.0 {
                return None;
            }
            let normal = kinematics.pose.rotation * shape.outward_normal(&x, 1e-3 * dp);
            let change = normal * (stiffness * near * dt);
            Some(Push { particle, solid: number, change, arm: on_solid - kinematics.centre })
        };
        particles.par_iter().with_min_len(PARTICLES_PER_TASK).filter_map(push).collect::<Vec<_>>()
    };
    copies(system).zip(beside).flat_map(by_copy).collect()
}

/// The place `x` (m) beside solid number `number`, or the place half a dp before the face of another solid that is not free if `x` is
/// nearer to that face.
fn before_others<const D: usize>(system: &System<D>, number: usize, mut x: Vector<D>) -> Vector<D> {
    let dp = system.model.dp;
    for (other, solid) in system.solids.iter().enumerate().filter(|(other, solid)| *other != number && !solid.is_free())
    {
        let (shape, pose) = (&solid.spec.shape, &solid.kinematics.pose);
        let local = pose.local(&x);
        if system.boundary.local_bounds[other].grown(dp).contains(&local) {
            let missing = 0.5 * dp - shape.signed_distance(&local);
            if missing > 0.0 {
                x += pose.rotation * shape.outward_normal(&local, 1e-3 * dp) * missing;
            }
        }
    }
    x
}
