//! Water that a narrow gap squeezes out.
//!
//! Particles of water in a gap narrower than dp lie between the boundary particles of both faces and cannot slide along them: a caught
//! row would carry a sunk body for ever. The faces are smooth, and such water leaves. Where water and [film](super::film) press two
//! faces apart with more than still water at the rim would, particles flow along the gap to the nearest rim with Bernoulli's speed
//!
//!   u = s min(√(2 (p − |g| dp)), √(|g| dp)),
//!
//! with p the mean of what they press more, over ρ₀, and s the share of [`Gap::narrow`]. |g| dp is the pressure of one row, which
//! rows of water near a face have more or less. Water that is slower relative to the mean of both faces receives this speed in a step;
//! one half of the opposite impulse acts on each solid.

use rayon::prelude::*;

use super::{
    System,
    film::{self, Film, FilmParticle, Gap},
    own_water,
    thin_faces::Push,
};
use crate::{
    geometry::cells::PointCells,
    math::{Bounds, Vector},
    particles::PARTICLES_PER_TASK,
};

/// Distance along the face, dp, up to which water is before a particle of a film: half a diagonal between particles.
const BEFORE: f64 = 0.75;

/// Largest distance, dp, of caught water from the particle of the film: half a dp of depth, the gap, and the way along the face.
const REACH: f64 = 2.0;

/// Where caught water is, and which way it leaves.
struct Place<const D: usize> {
    gap: Gap<D>,
    /// Unit vector along the gap to the nearest rim, if there is one.
    way: Option<Vector<D>>,
}

/// Sets the speeds at which caught water leaves the films, from what water and film press more than still water would in the last
/// force pass, the mean of each film (m²/s²).
pub(super) fn update<const D: usize>(system: &mut System<D>, excess: &[f64]) {
    let row = system.properties.gravity.norm() * system.model.dp;
    let speeds: Vec<f64> = excess.iter().map(|excess| (2.0 * (excess - row).max(0.0)).min(row).sqrt()).collect();
    let flows = speeds.iter().any(|speed| *speed > 0.0);
    system.boundary.films.outflow = if flows { speeds } else { Vec::new() };
}

/// The boxes (m) with the water that may leave films.
#[cfg(feature = "gpu")]
pub(crate) fn ranges<const D: usize>(system: &System<D>) -> Vec<Bounds<D>> {
    system.boundary.films.films.iter().map(|film| range(system, film)).collect()
}

/// The box (m) with the water before `film`.
fn range<const D: usize>(system: &System<D>, film: &Film<D>) -> Bounds<D> {
    let r: Vec<Vector<D>> =
        film.particles.iter().map(|particle| system.boundary.particles.r[particle.boundary as usize]).collect();
    Bounds::around(&r).grown(REACH * system.model.dp)
}

/// Whether water leaves a film.
pub(crate) fn flows<const D: usize>(system: &System<D>) -> bool {
    !system.boundary.films.outflow.is_empty()
}

/// The pushes on the water that leaves films, and on their solids.
pub(super) fn pushes<const D: usize>(system: &System<D>) -> Vec<Push<D>> {
    let films = &system.boundary.films;
    let flowing = films.films.iter().zip(&films.outflow).filter(|(_, speed)| **speed > 0.0);
    flowing.flat_map(|(film, speed)| pushes_of(system, film, *speed)).collect()
}

/// The pushes on the water that leaves `film` at this `speed` (m/s).
fn pushes_of<const D: usize>(system: &System<D>, film: &Film<D>, speed: f64) -> Vec<Push<D>> {
    let dp = system.model.dp;
    let (water, r) = (&system.fluid.particles, &system.boundary.particles.r);
    let points: Vec<Vector<D>> = film.particles.iter().map(|particle| r[particle.boundary as usize]).collect();
    let places = places(system, film, &points);
    let cells = PointCells::new(&points, REACH * dp);
    let bounds = range(system, film);
    let (shape, pose) = (&system.solids[film.solid].spec.shape, system.home_pose(film.solid));
    let is_under = |x: &Vector<D>| shape.signed_distance(&pose.local(x)) < 0.0;
    let push = |i: u32| {
        let x = &water.r[i as usize];
        if !bounds.contains(x) {
            return Vec::new();
        }
        let mut nearest = (BEFORE * dp, None);
        cells.visit_near(x, REACH * dp, |k, point| {
            let (normal, way) = (places[k].gap.normal, x - point);
            let below = -normal.dot(&way);
            let aside = (way + normal * below).norm();
            let is_between = below > 0.0 && below < places[k].gap.height && is_under(&(x + normal * below));
            if is_between && aside < nearest.0 {
                nearest = (aside, Some(k));
            }
        });
        let Some((k, Place { gap, way: Some(way) })) = nearest.1.map(|k| (k, &places[k])) else { return Vec::new() };
        // The gap may move along: the speed is relative to the mean of both faces.
        let [one, other] = [film.solid, film.other].map(|solid| &system.solids[solid]);
        let along = (film::velocity_at(one, &gap.at[0]) + film::velocity_at(other, &gap.at[1])) * 0.5;
        let lack = speed * gap.narrow - (water.v[i as usize] - along).dot(way);
        if lack <= 0.0 {
            return Vec::new();
        }
        let half = |(solid, at): (usize, &Vector<D>)| {
            let arm = at + (x - points[k]) - system.solids[solid].kinematics.centre;
            Push { particle: i as usize, solid, change: way * (0.5 * lack), arm }
        };
        [film.solid, film.other].into_iter().zip(&gap.at).map(half).collect()
    };
    own_water_near(system).into_par_iter().with_min_len(PARTICLES_PER_TASK).flat_map_iter(push).collect()
}

/// The water of this rank; on a device that which the host has read.
fn own_water_near<const D: usize>(system: &System<D>) -> Vec<u32> {
    let count = system.own_count();
    #[cfg(feature = "gpu")]
    if system.boundary.on_device.is_some() {
        let known = system.neighbours.known_water().unwrap_or_default();
        return known.iter().copied().filter(|i| (*i as usize) < count).collect();
    }
    let (these, own) = own_water::own(&system.neighbours, count);
    (these.start as u32..these.end as u32).filter(|i| own.is_none_or(|own| own[*i as usize])).collect()
}

/// What is before each particle of `film`, which are at the `points` (m).
fn places<const D: usize>(system: &System<D>, film: &Film<D>, points: &[Vector<D>]) -> Vec<Place<D>> {
    let rims: Vec<(Vector<D>, Vector<D>)> =
        film.particles.iter().zip(points).filter_map(|(particle, x)| Some((*x, particle.outwards()?))).collect();
    let place = |(particle, x): (&FilmParticle<D>, &Vector<D>)| {
        let gap = film::gap(system, film, particle);
        let distance = |rim: &Vector<D>| (rim - x).norm_squared();
        let nearest = rims.iter().min_by(|(a, _), (b, _)| distance(a).total_cmp(&distance(b)));
        let way = nearest.and_then(|(rim, outwards)| {
            let way = if rim == x { *outwards } else { rim - x };
            (way - gap.normal * gap.normal.dot(&way)).try_normalize(f64::EPSILON)
        });
        Place { gap, way }
    };
    film.particles.iter().zip(points).map(place).collect()
}
