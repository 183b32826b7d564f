//! Pressure of the film of water between a free solid and a solid that it touches or nearly touches.
//!
//! No particle of water fits into a gap narrower than a row, so that a body on the bed would be pressed onto it by all the water
//! above. Such a gap carries the pressure that the water has at its rim. In a film of constant thickness the pressure is a
//! harmonic function. With P* = p − ρ₀ g·x, which is constant in water at rest, the pressure at particle i is
//!
//!   P*_i = Σ_j P*_j / |x_i − x_j|ᴰ⁻¹ / Σ_j 1 / |x_i − x_j|ᴰ⁻¹,   p_i = max(0, P*_i + ρ₀ g·x_i),
//!
//! with the particles j at the rim. For a strip (D = 2) and for a disc (D = 3, Poisson's integral) this is the harmonic function
//! exactly.
//! Rims in air have p = 0, even if their particles see water on the other side of a film of few rows; a film of one row has the
//! mean of its two sides. The film presses on the face of each boundary particle, dpᴰ⁻¹ in size, along the normal of the other
//! solid, and on the other solid with the opposite force at the same place. It is what the particles of the water lack of the pressure
//! on the first row of the solid, and falls to zero as the gap grows from half a dp to one dp. Below a curved or inclined face the gap
//! widens outwards, and the film ends where the gap has room for water.
//!
//! Through a body thinner than the kernel's support, water above it acts on the solid below, too. With a film between them it cannot:
//! the forces of the water on the boundary particles that the film covers act on the body instead.
//!
//! A gap g that opens at the speed V draws water in through its rim. With N particles in the film and M at its rim, this water
//! has the speed u = V N dp/(M g), which lowers the pressure by ½ ρ₀ u². In this formula g is at least half a dp.

use rayon::prelude::*;

use super::{Boundary, System, thin_layers::THICK};
use crate::{
    geometry::{cells::PointCells, thin::thin_place},
    interaction::PairSums,
    math::{Bounds, Pose, Vector},
    model::{Model, Walls},
    particles::PARTICLES_PER_TASK,
    solid::{Kinematics, Load, Solid},
};

/// Gaps over which the film fades, dp: half a row of water flows into the first, a whole row into the last.
const FADING: [f64; 2] = [0.5, 1.0];

/// Depth below the face of the particles that have the face's size, dp: the first row.
const FIRST_ROW: f64 = 0.75;

/// Distance between neighbours in a film, dp: along the axes and the diagonals of a face.
const NEIGHBOURS: f64 = 1.6;

/// Length of the vector sum of the distances to the neighbours, over the sum of their lengths, above which a particle is at the
/// rim, –. The ratio is 0 inside, 0.5 at a straight rim, and 1 at the end of a strip.
const ONE_SIDED: f64 = 0.25;

/// Distance along a face, dp, up to which a particle of a film covers what is below it: half a diagonal between particles.
const COVERS: f64 = 0.75;

/// Share of a face that the other solid sees, –, above which the faces count as parallel.
const PARALLEL: f64 = 1.0 - 1e-6;

/// Distance from a rim, away from the film, at which water or air must have room, dp.
const OUTSIDE: f64 = 1.25;

/// Distance from all solids, dp, from which on a place has room for water or air.
const ROOM: f64 = 0.25;

/// What the particles past a rim lack of the pressure where the solid goes on, over the square of what the particle at the rim lacks.
/// Water beside the end of the other solid pushes two particles as far before and behind this end with shares that sum up to 1: about
/// 0.29 and 0.71 at half a dp, and 0.04 and 0.96 at 1½ dp.
const PAST_RIM: f64 = 2.0 / 3.0;

/// What the solid does at a rim.
#[derive(Clone, Copy, PartialEq)]
enum End {
    /// It ends there with a side face.
    Side,
    /// It goes on, over the end of the other solid or in a gap that widens.
    Overhang,
}

/// Where the rim of a film is.
#[derive(Clone, Copy)]
enum Rim<const D: usize> {
    /// Not at this particle.
    Elsewhere,
    /// At this particle, towards this unit vector.
    Towards(Vector<D>, End),
    /// All around this particle, which is alone between faces with this unit normal.
    Around(Vector<D>),
}

impl<const D: usize> Rim<D> {
    /// Share (–) of the pressure of the water near the particle that acts at the rim. `away` is the unit vector away from that
    /// water. The share is 0 if the water is on the other side of the film, and ½ if it is on one side of a single particle.
    fn share(&self, away: &Vector<D>) -> f64 {
        match self {
            Self::Elsewhere => 1.0,
            Self::Towards(outwards, _) => (1.0 - 2.0 * away.dot(outwards)).clamp(0.0, 1.0),
            Self::Around(normal) => 1.0 - (away - normal * normal.dot(away)).norm().min(0.5),
        }
    }
}

/// A boundary particle of a free solid whose face looks at the other solid across a narrow gap.
pub(super) struct FilmParticle<const D: usize> {
    /// Its index.
    pub(super) boundary: u32,
    rim: Rim<D>,
    /// From the particle to its face, m.
    to_face: Vector<D>,
    /// Share (–) of its face that the other solid sees: less than 1 on a curved or inclined face.
    facing: f64,
    /// Indices of the boundary particles of the other solid below it that see water through the solid.
    covered: Vec<u32>,
}

impl<const D: usize> FilmParticle<D> {
    /// The unit vector away from the film; `None` if it does not end here on one side.
    pub(super) fn outwards(&self) -> Option<Vector<D>> {
        if let Rim::Towards(outwards, _) = self.rim { Some(outwards) } else { None }
    }

    pub(super) fn at_rim(&self) -> bool {
        !matches!(self.rim, Rim::Elsewhere)
    }
}

/// One film: a connected part of the gap between two solids.
pub(super) struct Film<const D: usize> {
    pub(super) solid: usize,
    pub(super) other: usize,
    pub(super) particles: Vec<FilmParticle<D>>,
}

/// The gap at a particle of a film.
pub(super) struct Gap<const D: usize> {
    /// The place of the particle on the solid and on the other one, m.
    pub(super) at: [Vector<D>; 2],
    /// Unit normal of the face of the other solid.
    pub(super) normal: Vector<D>,
    /// Distance of the particle from that face, m.
    pub(super) height: f64,
    /// The gap, m.
    width: f64,
    /// How narrow the gap is: 0 from one dp on, 1 up to half a dp.
    pub(super) narrow: f64,
}

/// What a film does at one of its particles.
struct FilmForce<const D: usize> {
    /// The place on the solid and on the other one, m.
    at: [Vector<D>; 2],
    /// What water and film press more than still water at the rim would, P/ρ₀ in m²/s², times [`Gap::narrow`].
    excess: f64,
    /// The force on the solid, N (N/m in 2-D).
    force: Vector<D>,
    /// How far the gap is closed to water, 0 to 1.
    share: f64,
}

/// What the films do in a force pass.
#[derive(Default)]
pub(crate) struct FilmLoads<const D: usize> {
    /// The loads on the computed part of each solid, about its centre; empty without a film.
    pub(crate) loads: Vec<Load<D>>,
    /// The mean of [`FilmForce::excess`] of each film.
    pub(super) excess: Vec<f64>,
}

/// The films between all solids.
pub(super) struct Films<const D: usize> {
    pub(super) films: Vec<Film<D>>,
    /// Pressure of the water at each particle of each film at the last force pass, extrapolated, times [`Rim::share`], P/ρ₀ in m²/s²; 0
    /// without water.
    pub(super) pressures: Vec<Vec<f64>>,
    /// Speed (m/s) at which caught water leaves each film since the last force pass; empty if none does.
    pub(super) outflow: Vec<f64>,
    /// Whether walls have the pressure of the water before them.
    possible: bool,
}

/// The extrapolated pressure (P/ρ₀, m²/s²) of the water near a boundary particle, and the unit vector from that water to it.
pub(super) type NearWater<const D: usize> = (f64, Vector<D>);

impl<const D: usize> Films<D> {
    pub(super) fn new(model: &Model) -> Self {
        let possible = model.walls == Walls::RelaxedAdami;
        Self { films: Vec::new(), pressures: Vec::new(), outflow: Vec::new(), possible }
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.films.is_empty()
    }

    /// Whether there may be films beside free solids.
    #[cfg(feature = "gpu")]
    pub(super) fn are_possible(&self) -> bool {
        self.possible
    }

    /// The solids with films.
    #[cfg(feature = "gpu")]
    pub(super) fn solids(&self) -> impl Iterator<Item = usize> {
        self.films.iter().flat_map(|film| [film.solid, film.other])
    }

    /// The boundary particles that films read, in ascending order.
    #[cfg(feature = "gpu")]
    pub(super) fn particles(&self) -> Vec<u32> {
        let all = self.films.iter().flat_map(|film| &film.particles);
        let mut particles: Vec<u32> = all
            .flat_map(|particle| std::iter::once(particle.boundary).chain(particle.covered.iter().copied()))
            .collect();
        particles.sort_unstable();
        particles.dedup();
        particles
    }

    /// Takes these films, without the pressures of a force pass.
    pub(super) fn set(&mut self, films: Vec<Film<D>>) {
        (self.films, self.pressures, self.outflow) = (films, Vec::new(), Vec::new());
    }
}

/// Each free solid with each solid that may touch it at these `poses`. Of two free solids, the first has the film.
pub(super) fn touching<const D: usize>(system: &System<D>, poses: &[Pose<D>]) -> impl Iterator<Item = [usize; 2]> {
    let solids = &system.solids;
    let free = (0..solids.len()).filter(|&i| system.boundary.films.possible && solids[i].is_free());
    let pairs = free.flat_map(move |i| {
        let others = (0..solids.len()).filter(move |&j| j != i && (j > i || !solids[j].is_free()));
        others.map(move |j| [i, j])
    });
    pairs.filter(|[i, j]| may_touch(system, [*i, *j], poses))
}

/// The films at the `poses` of the solids and the positions `r` (m) of all boundary particles. They hold until a solid has moved by the
/// margin of the neighbour lists.
pub(super) fn find<const D: usize>(system: &System<D>, poses: &[Pose<D>], r: &[Vector<D>]) -> Vec<Film<D>> {
    touching(system, poses).flat_map(|pair| films_between(system, pair, poses, r)).collect()
}

/// Reads the `water` near the particles of the films; it gives nothing where no water is near.
pub(super) fn update_water<const D: usize>(
    system: &mut System<D>,
    water: impl Fn(&System<D>, usize, u32) -> Option<NearWater<D>>,
) {
    let of = |solid: usize, particle: &FilmParticle<D>| {
        let (pressure, away) = water(system, solid, particle.boundary)?;
        // As it acts in the pair force, and on the face.
        let state = &system.equation_of_state;
        let pressure = state.lattice_pressure(state.compression(pressure.max(0.0)));
        let on_face = if pressure > 0.0 { pressure + system.properties.gravity.dot(&particle.to_face) } else { 0.0 };
        Some(on_face.max(0.0) * particle.rim.share(&away))
    };
    let of_film =
        |film: &Film<D>| film.particles.iter().map(|particle| of(film.solid, particle).unwrap_or(0.0)).collect();
    system.boundary.films.pressures = system.boundary.films.films.iter().map(of_film).collect();
}

/// Distance (m) at which the faces of two solids may have a film before the next lists.
fn reach<const D: usize>(system: &System<D>) -> f64 {
    FADING[1] * system.model.dp + 2.0 * system.neighbours.margin()
}

/// Whether solids `i` and `j` may have a film at these `poses`, by the boxes around them.
fn may_touch<const D: usize>(system: &System<D>, [i, j]: [usize; 2], poses: &[Pose<D>]) -> bool {
    let (dp, reach) = (system.model.dp, reach(system));
    let [pose, other_pose] = [i, j].map(|k| system.home_of(k, &poses[k]));
    let [middle, other_middle] = [(i, &pose), (j, &other_pose)].map(|(k, pose)| system.boundary.middle(k, pose));
    let [radius, other_radius] = [i, j].map(|k| 0.5 * system.boundary.local_bounds[k].size().norm());
    if system.fluid.images.periodic.iter().all(Option::is_none)
        && (middle - other_middle).norm() > radius + other_radius + dp + reach
    {
        return false;
    }
    let middle = other_pose.local(&system.fluid.images.wrapped(&middle));
    system.solids[j].spec.shape.signed_distance(&middle) <= radius + dp + reach
}

/// The films between free solid `i` and solid `j`.
fn films_between<const D: usize>(
    system: &System<D>,
    [i, j]: [usize; 2],
    poses: &[Pose<D>],
    r: &[Vector<D>],
) -> Vec<Film<D>> {
    let (dp, reach) = (system.model.dp, reach(system));
    let (solid, other) = (&system.solids[i], &system.solids[j]);
    let [pose, other_pose] = [i, j].map(|k| system.home_of(k, &poses[k]));
    let to_other = |x: &Vector<D>| other_pose.local(&system.fluid.images.wrapped(x));
    let distance = |x: &Vector<D>| other.spec.shape.signed_distance(&to_other(x));
    let depths = system.boundary.depths.as_deref().unwrap_or_default();
    let normal = |x: &Vector<D>| other_pose.rotation * other.spec.shape.outward_normal(&to_other(x), 0.05 * dp);
    let faces_other = |b: &usize| {
        let x = &r[*b];
        if depths[*b] > FIRST_ROW * dp || distance(x) > reach + depths[*b] {
            return false;
        }
        let normal = normal(x);
        solid.spec.shape.signed_distance(&pose.local(&(x - normal * (FIRST_ROW * dp)))) > 0.0
    };
    let range = system.home_boundary_at(i, &poses[i]);
    let found: Vec<usize> = range.into_par_iter().with_min_len(PARTICLES_PER_TASK).filter(faces_other).collect();
    let points: Vec<Vector<D>> = found.iter().map(|&b| r[b]).collect();
    let cells = PointCells::new(&points, NEIGHBOURS * dp);
    let neighbours = |k: usize| {
        let mut near = Vec::new();
        cells.visit_near(&points[k], NEIGHBOURS * dp, |m, x| {
            if m != k && (x - points[k]).norm() < NEIGHBOURS * dp {
                near.push(m);
            }
        });
        near.sort_unstable();
        near
    };
    let around: Vec<Vec<usize>> = (0..points.len()).map(neighbours).collect();
    // Water beside the film stands half a row above the other solid, also beside a part so thin that its particle is lower.
    let beside = |k: usize| {
        let lower = if depths[found[k]] < THICK * dp { (0.5 * dp - distance(&points[k])).max(0.0) } else { 0.0 };
        points[k] + normal(&points[k]) * lower
    };
    let side = |k: usize, outwards: &Vector<D>| beside(k) + outwards * (OUTSIDE * dp);
    // Where the solid goes on past the film, over the end of the other one or in a gap that widens, the water stands half a row before
    // its face, or between the faces.
    let overhang = |k: usize, outwards: &Vector<D>| {
        let n = normal(&points[k]);
        let up = (n - outwards * outwards.dot(&n)).try_normalize(f64::EPSILON)?;
        let face = points[k] + outwards * (OUTSIDE * dp) - up * depths[found[k]];
        Some(face - up * (0.5 * distance(&face).min(dp)))
    };
    let facing = |k: usize| {
        let n = normal(&points[k]);
        let arms = around[k].iter().map(|&m| points[k] - points[m]);
        let least = arms.map(|arm| (arm - n * n.dot(&arm)).norm() / arm.norm()).fold(1.0, f64::min);
        if least > PARALLEL { 1.0 } else { least }
    };
    let rim = |k: usize| {
        let arms = around[k].iter().map(|&m| points[k] - points[m]);
        let (sum, length) = arms.fold((Vector::zeros(), 0.0), |(sum, length), arm| (sum + arm, length + arm.norm()));
        let outwards: Option<Vector<D>> = sum.try_normalize(ONE_SIDED * length);
        let Some(outwards) = outwards else {
            return if around[k].is_empty() { Rim::Around(normal(&points[k])) } else { Rim::Elsewhere };
        };
        let side = side(k, &outwards);
        let goes_on = solid.spec.shape.signed_distance(&pose.local(&side)) < ROOM * dp;
        let (place, end) = if goes_on { (overhang(k, &outwards), End::Overhang) } else { (Some(side), End::Side) };
        match place.filter(|x| has_room(system, x, poses)) {
            Some(_) => Rim::Towards(outwards, end),
            None => Rim::Elsewhere,
        }
    };
    let support = system.model.support_radius();
    // The height of the solid above each point of the film, where its faces are parallel and nearer than the support.
    let height = |&b: &usize| {
        let thin = thin_place(&solid.spec.shape, &pose.local(&r[b]), support, 1e-3 * dp)?;
        Some(thin.thickness - depths[b])
    };
    let heights: Vec<Option<f64>> = found.par_iter().with_min_len(PARTICLES_PER_TASK).map(height).collect();
    // The point of the film that covers the boundary particle at `x`, if a row of water on the solid sees it.
    let covers = |x: &Vector<D>| {
        let mut nearest = (COVERS * dp, None);
        cells.visit_near(x, support, |m, y| {
            let (n, way) = (normal(y), x - y);
            let down = -n.dot(&way);
            let aside = (way + n * down).norm();
            let sees = heights[m].is_some_and(|height| down + height + 0.5 * dp < support);
            if sees && down > 0.0 && aside < nearest.0 {
                nearest = (aside, Some(m));
            }
        });
        nearest.1
    };
    let mut covered = vec![Vec::new(); points.len()];
    if heights.iter().any(Option::is_some) {
        let near = Bounds::around(&points).grown(support);
        let below = system.home_boundary_at(j, &poses[j]).into_par_iter().with_min_len(PARTICLES_PER_TASK);
        for b in below.filter(|b| near.contains(&r[*b])).collect::<Vec<_>>() {
            if let Some(by) = covers(&r[b]) {
                covered[by].push(b as u32);
            }
        }
    }
    let mut particle = |k: usize| FilmParticle {
        boundary: found[k] as u32,
        rim: rim(k),
        to_face: -normal(&points[k]) * depths[found[k]],
        facing: facing(k),
        covered: std::mem::take(&mut covered[k]),
    };
    let mut film =
        |part: Vec<usize>| Film { solid: i, other: j, particles: part.into_iter().map(&mut particle).collect() };
    connected_parts(&around).into_iter().map(&mut film).collect()
}

/// Whether `x` (m) is in no solid at its pose of `poses`, nor beyond a symmetry plane.
fn has_room<const D: usize>(system: &System<D>, x: &Vector<D>, poses: &[Pose<D>]) -> bool {
    let (x, margin) = (&system.fluid.images.wrapped(x), ROOM * system.model.dp);
    let is_in = |(k, solid): (usize, &Solid<D>)| {
        let local = system.home_of(k, &poses[k]).local(x);
        system.boundary.local_bounds[k].grown(system.model.dp).contains(&local)
            && solid.spec.shape.signed_distance(&local) < margin
    };
    system.symmetry_planes().axes_beyond(x) == 0 && !system.solids.iter().enumerate().any(is_in)
}

/// What the films do, by the `sums` of the boundary particles near water.
pub(crate) fn loads<const D: usize>(system: &System<D>, sums: &[PairSums<D>]) -> FilmLoads<D> {
    let near = system.neighbours.boundary_near_fluid();
    loads_by(system, |i| near.binary_search(&i).ok().map(|place| sums[place].acceleration))
}

/// The same by the `acceleration` (m/s²) of each boundary particle with water near it.
pub(super) fn loads_by<const D: usize>(
    system: &System<D>,
    acceleration: impl Fn(u32) -> Option<Vector<D>> + Sync,
) -> FilmLoads<D> {
    if system.boundary.films.films.is_empty() {
        return FilmLoads::default();
    }
    let mut loads = vec![Load::zero(); system.solids.len()];
    let mut excess = Vec::new();
    for (film, pressures) in system.boundary.films.films.iter().zip(&system.boundary.films.pressures) {
        let (solid, other) = (&system.solids[film.solid], &system.solids[film.other]);
        let mut act = |at: [Vector<D>; 2], force: Vector<D>| {
            loads[film.solid] += Load::from_force_at(&(at[0] - solid.kinematics.centre), force);
            loads[film.other] += Load::from_force_at(&(at[1] - other.kinematics.centre), -force);
        };
        let (r, mass) = (&system.boundary.particles.r, system.particle_mass());
        let forces = forces(system, film, pressures, &acceleration);
        excess.push(forces.iter().map(|force| force.excess).sum::<f64>() / forces.len().max(1) as f64);
        for (particle, FilmForce { at, force, share, .. }) in film.particles.iter().zip(forces) {
            act(at, force);
            // What lies below the rim sees as much water beside the film as through the solid.
            let share = if particle.at_rim() { 0.5 * share } else { share };
            for &below in &particle.covered {
                let Some(by_water) = acceleration(below) else { continue };
                let aside = r[below as usize] - r[particle.boundary as usize];
                act(at.map(|at| at + aside), by_water * (mass * share));
            }
        }
    }
    FilmLoads { loads, excess }
}

/// What `film` does at each of its particles; an empty list if its rim is dry.
fn forces<const D: usize>(
    system: &System<D>,
    film: &Film<D>,
    pressures: &[f64],
    acceleration: &(impl Fn(u32) -> Option<Vector<D>> + Sync),
) -> Vec<FilmForce<D>> {
    let (dp, rho0, gravity) = (system.model.dp, system.properties.rho0, system.properties.gravity);
    let mass = system.particle_mass();
    let (solid, other) = (&system.solids[film.solid], &system.solids[film.other]);
    let Boundary { particles, depths, .. } = &system.boundary;
    let depths = depths.as_deref().unwrap_or_default();
    let rim = film.particles.iter().zip(pressures).filter(|(particle, _)| particle.at_rim());
    let rim: Vec<(Vector<D>, f64)> =
        rim.map(|(particle, pressure)| (particles.r[particle.boundary as usize], *pressure)).collect();
    // The head at which air stays out of the film, from the part of the rim that is in water.
    let wet = || rim.iter().filter(|(_, p)| *p > 0.0);
    let head = wet().map(|(x, p)| p - gravity.dot(x)).sum::<f64>() / wet().count() as f64;
    let counted: Vec<_> = rim.iter().filter(|(x, p)| *p > 0.0 || head + gravity.dot(x) > 0.0).collect();
    if wet().next().is_none() {
        return Vec::new();
    }
    // Caught water raises the pressure at the rim near it.
    let least = wet().map(|(x, p)| p - gravity.dot(x)).fold(f64::INFINITY, f64::min);
    let inside = |x: &Vector<D>| {
        let weighted = counted.iter().map(|(y, p)| {
            let weight = (x - y).norm().powi(1 - D as i32);
            (weight, weight * (p - gravity.dot(y)))
        });
        let (weights, sum) = weighted.fold((0.0, 0.0), |(w, s), (weight, term)| (w + weight, s + term));
        (sum / weights + gravity.dot(x)).max(0.0)
    };
    // Water beside the solid pushes the particle at the rim. The water above the face, which is no part of the push across the gap, pushes
    // it towards the film, with this share of the pressure.
    let beside = system.boundary.coverage.full_weight(0.5 * dp);
    let spread = dp * film.particles.len() as f64 / rim.len() as f64;
    let force = |(particle, own): (&FilmParticle<D>, &f64)| {
        let i = particle.boundary as usize;
        let x = particles.r[i];
        let Gap { at, normal, width, narrow, .. } = gap(system, film, particle);
        let still = if particle.at_rim() { *own } else { inside(&x) };
        // The water's particles do a part of it already.
        let size = dp.powi(D as i32 - 1);
        let pushed = acceleration(particle.boundary).map_or(0.0, |by_water| by_water.dot(&normal)) * mass;
        let full = rho0 * still * size * particle.facing * system.boundary.coverage.row_share(depths[i], dp);
        let end = if let Rim::Towards(_, end) = particle.rim { Some(end) } else { None };
        let beside = if end == Some(End::Side) { beside } else { 0.0 };
        let borne = pushed / full.max(f64::MIN_POSITIVE) + beside;
        let lack = 1.0 - borne.clamp(0.0, 1.0);
        let past_rim = if end == Some(End::Overhang) { PAST_RIM * lack } else { 0.0 };
        let share = narrow * lack * particle.facing * system.computed_share(solid, &x);
        let opening = (velocity_at(solid, &at[0]) - velocity_at(other, &at[1])).dot(&normal).max(0.0);
        let inflow = opening * spread / width.max(FADING[0] * dp);
        let pressure = (still - 0.5 * inflow * inflow).max(0.0);
        FilmForce {
            at,
            excess: narrow * (still * borne + pressure * lack - (least + gravity.dot(&x)).max(0.0)),
            force: normal * (rho0 * pressure * share * (1.0 + past_rim) * size),
            share,
        }
    };
    film.particles.par_iter().zip(pressures).with_min_len(PARTICLES_PER_TASK).map(force).collect()
}

/// The gap at a `particle` of `film`.
pub(super) fn gap<const D: usize>(system: &System<D>, film: &Film<D>, particle: &FilmParticle<D>) -> Gap<D> {
    let (dp, i, other) = (system.model.dp, particle.boundary as usize, &system.solids[film.other]);
    let pose = system.home_pose(film.other);
    let x = system.fluid.images.wrapped(&system.boundary.particles.r[i]);
    let local = pose.local(&x);
    let height = other.spec.shape.signed_distance(&local);
    let width = height - system.boundary.depths.as_ref().map_or(0.0, |depths| depths[i]);
    Gap {
        at: [system.place_on_solid(film.solid, i), x + other.kinematics.pose.position - pose.position],
        normal: pose.rotation * other.spec.shape.outward_normal(&local, 0.05 * dp),
        height,
        width,
        narrow: ((FADING[1] - width / dp) / (FADING[1] - FADING[0])).clamp(0.0, 1.0),
    }
}

/// Velocity (m/s) of the point `x` (m) of `solid`.
pub(super) fn velocity_at<const D: usize>(solid: &Solid<D>, x: &Vector<D>) -> Vector<D> {
    let Kinematics { velocity, spin, centre, .. } = &solid.kinematics;
    velocity + spin.velocity_at(&(x - centre))
}

/// The connected parts of a graph whose nodes have the neighbours `around`, each in ascending order.
fn connected_parts(around: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut seen = vec![false; around.len()];
    let mut parts = Vec::new();
    for first in 0..around.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let (mut part, mut next) = (vec![first], 0);
        while let Some(&k) = part.get(next) {
            next += 1;
            part.extend(around[k].iter().filter(|&&m| !std::mem::replace(&mut seen[m], true)));
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}
