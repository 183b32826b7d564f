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

use rayon::prelude::*;

use super::{MomentumTransfer, System, impulses::change_velocities, own_water};
use crate::{
    geometry::{
        BoundaryPoint, Shape,
        cells::PointCells,
        thin::{face_cells, opposite_faces},
    },
    math::Vector,
    particles::PARTICLES_PER_TASK,
    solid::Load,
};

/// Thickness of a part, dp, from which on boundary particles alone keep water out (`docs/measurements/thin-tank.toml`).
const THIN: f64 = 2.5;

/// Faces less than 60° from parallel are opposite: cos 60°. Boundary particles keep water out of blunter wedges.
const OPPOSITE: f64 = 0.5;

/// Distance from the face, dp, from which on water is not pushed: that at which boundary particles begin to repel it.
const RANGE: f64 = 0.25;

/// A, –, as that of boundary particles. With steps Δt longer than dp/(c₀ √A), as at large h and Courant numbers, 1/Δt² replaces
/// A c₀²/dp²: the oscillation of a particle is stable up to four times that.
const STRENGTH: f64 = 2.0;

/// Largest distance, dp, of water that is pushed from the nearest of the places that mark a thin part: up to 1½ dp across, and the
/// diagonal of a cell of edge dp.
const REACH: f64 = 2.0;

/// Depth, dp, beyond which the push does not grow: half of the largest thickness.
const DEEPEST: f64 = 0.5 * THIN;

/// A water particle that may come near a thin part before the next lists.
#[derive(Clone, Copy)]
struct Candidate {
    particle: u32,
    solid: u32,
    copy: u32,
}

/// A particle that a thin part pushes.
struct Push<const D: usize> {
    particle: usize,
    /// Change of its velocity, m/s.
    change: Vector<D>,
    solid: usize,
    /// The impulse on the solid about its centre, N s and N m s.
    reaction: Load<D>,
}

/// The faces of thin parts, and the water beside them.
#[derive(Default)]
pub(super) struct ThinFaces<const D: usize> {
    /// Of each solid: places (m, in its frame) beside the faces of its thin parts; `None` without thin parts.
    of_solid: Vec<Option<PointCells<D>>>,
    /// The water of this rank that may come near them before the next lists; `None` if it is to be found.
    candidates: Option<Vec<Candidate>>,
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
        let is_thin = |x: &Vector<D>| opposite_faces(shape, x, THIN * dp, 1e-3 * dp, OPPOSITE).is_some();
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
        self.candidates = None;
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

/// Displacement (m) to copy number `copy` of solid number `number` across periodic sides.
fn way_to_copy<const D: usize>(system: &System<D>, number: usize, copy: usize) -> Vector<D> {
    let solid = &system.solids[number];
    if solid.copied_axes == 0 {
        return Vector::zeros();
    }
    system.fluid.images.way_to_copy(&system.boundary.middle(number, &solid.kinematics.pose), solid.copied_axes, copy)
}

/// The water of this rank that may come near thin parts before the next lists.
fn candidates<const D: usize>(system: &System<D>) -> Vec<Candidate> {
    let (r, faces) = (&system.fluid.particles.r, &system.boundary.thin.faces.of_solid);
    // Water and solids may both have moved by the margin, and a step may pass it.
    let reach = REACH * system.model.dp + 3.0 * system.neighbours.margin();
    let mut found = Vec::new();
    let (these, own) = own_water::own(&system.neighbours, system.own_count());
    for (number, (solid, faces)) in system.solids.iter().zip(faces).enumerate() {
        let Some(faces) = faces else { continue };
        let bounds = system.boundary.local_bounds[number].grown(reach);
        for copy in 0..solid.copies() {
            let (way, pose) = (way_to_copy(system, number, copy), &solid.kinematics.pose);
            let is_near = |i: &u32| {
                let x = pose.local(&(r[*i as usize] - way));
                let mut near = false;
                if own.is_none_or(|own| own[*i as usize]) && bounds.contains(&x) {
                    faces.visit_near(&x, reach, |_, y| near |= (x - y).norm_squared() < reach * reach);
                }
                near
            };
            let water = (these.start as u32..these.end as u32).into_par_iter().with_min_len(PARTICLES_PER_TASK);
            let candidate = |particle| Candidate { particle, solid: number as u32, copy: copy as u32 };
            found.par_extend(water.filter(is_near).map(candidate));
        }
    }
    found
}

/// Pushes the water beside thin parts over a step `dt` (s), and adds the loads on the solids; they act on bodies by the factor `weight`
/// (–). Returns what the water received and the impulse (N s, N m s) on each solid, or `None` without thin parts.
pub(crate) fn repel<const D: usize>(
    system: &mut System<D>,
    dt: f64,
    weight: f64,
) -> Option<(MomentumTransfer<D>, Vec<Load<D>>)> {
    if !has_thin_faces(system) {
        return None;
    }
    let candidates = system.boundary.thin.faces.candidates.take().unwrap_or_else(|| candidates(system));
    let mut pushes = own_pushes(system, &candidates, dt);
    system.boundary.thin.faces.candidates = Some(candidates);
    let mass = system.particle_mass();
    let mut impulses = vec![Load::zero(); system.solids.len()];
    let reactions = pushes.iter().map(|push| (push.particle, push.solid, push.reaction)).collect();
    for (_, solid, reaction) in own_water::gather_reactions(&system.neighbours, reactions) {
        impulses[solid] += reaction;
    }
    for (solid, impulse) in impulses.iter_mut().enumerate() {
        if system.solids[solid].division.cut != 0 {
            *impulse = system.load_on_whole(&system.solids[solid], *impulse);
        }
        if *impulse != Load::zero() {
            system.solids[solid].load += *impulse * (1.0 / (dt * weight));
        }
    }
    // A particle may have pushes by several solids.
    pushes.sort_by_key(|push| push.particle);
    let mut changes: Vec<(usize, Vector<D>)> = Vec::with_capacity(pushes.len());
    for push in pushes {
        match changes.last_mut() {
            Some((particle, change)) if *particle == push.particle => *change += push.change,
            _ => changes.push((push.particle, push.change)),
        }
    }
    Some((change_velocities(system, changes, mass * system.water_multiplicity()), impulses))
}

/// The pushes on the `candidates` over a step `dt` (s), in the order of the solids.
fn own_pushes<const D: usize>(system: &System<D>, candidates: &[Candidate], dt: f64) -> Vec<Push<D>> {
    let (dp, mass, water) = (system.model.dp, system.particle_mass(), &system.fluid.particles);
    let stiffness = (STRENGTH * (system.properties.c0 / dp).powi(2)).min(1.0 / (dt * dt));
    let push = |candidate: &Candidate| {
        let Candidate { particle, solid: number, copy } = *candidate;
        let (particle, number) = (particle as usize, number as usize);
        let solid = &system.solids[number];
        let (pose, r) = (&solid.kinematics.pose, &water.r[particle]);
        let on_solid = r - way_to_copy(system, number, copy as usize);
        let x = pose.local(&on_solid);
        let near = RANGE * dp - solid.spec.shape.signed_distance(&x).max(-DEEPEST * dp);
        if near <= 0.0 {
            return None;
        }
        let normal = pose.rotation * solid.spec.shape.outward_normal(&x, 1e-3 * dp);
        let change = normal * (stiffness * near * dt);
        let reaction = Load::from_force_at(&(on_solid - solid.kinematics.centre), change * -mass);
        Some(Push { particle, change, solid: number, reaction })
    };
    candidates.par_iter().with_min_len(PARTICLES_PER_TASK).filter_map(push).collect()
}
