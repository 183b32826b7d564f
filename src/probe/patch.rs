//! Force and pressure on a part of a solid's face: a panel of a wall, a pressure plate.
//!
//! A box selects the part at the start. The part then moves with the solid. The force is Σ m_k f_k over the boundary
//! particles behind the part. The pressures are values of pressure probes on the part, about dp apart.
//!
//! A boundary particle lies behind the face nearest to it. In a wall as thin as the support, and beside corners, the water on it may be
//! before another face. Where all of it is, the force counts there. In a wall that is wet on both sides each side has the pressure
//! forces of its water, −Σ m_b (P_k + P_b)/(ρ_k ρ_b) ∇W, and of what f_k has more, the share of its water in the kernel's weight.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope, axes, empty_row, find_solid, pressure::pressure};
use crate::{
    error::{Error, Result},
    geometry::Shape,
    math::{Bounds, BoxConfig, Pose, Vector},
    simulation::Simulation,
    solid::Solid,
    system::{AxisSet, System, reflected},
};

/// A part of a solid's face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct PatchConfig {
    /// Name of the solid.
    pub solid: String,
    /// The box in which the part lies at the start.
    #[serde(rename = "box")]
    pub corners: BoxConfig,
}

/// Plan of a probe of the force and pressure on a part of a solid's face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct PatchPlan {
    /// The solid's name.
    pub solid: String,
    /// Lowest corner of the box in which the part lies at the start, m.
    pub min: Vec<f64>,
    /// Highest corner of this box, m.
    pub max: Vec<f64>,
}

impl ProbeDefinition for PatchPlan {
    type Config = PatchConfig;
    const LABEL: &'static str = "force and pressure on a part of a face";
    const EXAMPLE: &'static str = "patch = { solid = \"wall\", box = { min = [0.9, 0.1], max = [1.1, 0.2] } }";

    fn verify(config: &PatchConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_solid(&format!("{key}.solid"), &config.solid)?;
        scene.require_box(&format!("{key}.box"), &config.corners)
    }

    fn from_config(PatchConfig { solid, corners }: &PatchConfig) -> Self {
        Self { solid: solid.clone(), min: corners.min.clone(), max: corners.max.clone() }
    }

    fn default_name(config: &PatchConfig) -> Option<String> {
        Some(format!("{}_patch", config.solid))
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(PatchProbe::new(system, &self.solid, &self.min, &self.max)?))
    }
}

/// Largest depth of a boundary particle of the first layer, dp.
const FIRST_LAYER: f64 = 0.75;

/// A boundary particle with a second face within the support behind it, in the solid's frame.
struct Between<const D: usize> {
    at: Vector<D>,
    /// Unit vector to the nearest face.
    way: Vector<D>,
    /// Whether the face behind it is opposite to the nearest one.
    is_thin: bool,
}

/// The water on a boundary particle on one side of it: sums over its particles.
#[derive(Clone, Copy)]
struct Side<const D: usize> {
    /// Of W.
    weight: f64,
    /// Of W times the way there, m.
    towards: Vector<D>,
    /// Of the pressure forces.
    push: Vector<D>,
}

/// Measures the force (N; N/m in 2-D) of the water on a part of a solid's face, and the mean and the largest pressure there
/// (Pa, above that of the air).
pub struct PatchProbe<const D: usize> {
    solid: usize,
    /// The box that holds the part, at the pose that the solid has there, m.
    part: (Bounds<D>, Pose<D>),
    /// For each boundary particle of the solid, whether it lies behind the part.
    behind: Vec<bool>,
    /// Those with a second face behind them, by their number.
    between: BTreeMap<usize, Between<D>>,
    /// Places on the part, in the solid's frame, m.
    places: Vec<Vector<D>>,
}

impl<const D: usize> PatchProbe<D> {
    /// Creates the probe of the part of the face of the solid called `solid` that now lies between the corners `min`
    /// and `max` (m).
    ///
    /// # Errors
    /// `Usage` if the number of coordinates of the corners differs from `D`; `Scene` if there is no such solid, or if
    /// no part of its face lies in the box.
    pub fn new(system: &System<D>, solid: &str, min: &[f64], max: &[f64]) -> Result<Self> {
        let part = Bounds { min: super::point(min, D)?, max: super::point(max, D)? };
        let number = find_solid(system, solid)?;
        let (of, dp, reach) = (&system.solids()[number], system.model().dp, system.model().support_radius());
        let (shape, pose) = (&of.spec.shape, of.kinematics.pose);
        // A place on an edge of the box belongs to it; no boundary particle lies deeper than the kernel reaches.
        let (near, around) = (part.grown(reach + dp), part.grown(dp));
        let mut own = Self {
            solid: number,
            part: (part.grown(1e-9), pose),
            behind: Vec::new(),
            between: BTreeMap::new(),
            places: Vec::new(),
        };
        for (k, r) in of.boundary_of_whole().map(|i| system.place_on_solid(number, i)).enumerate() {
            if !near.contains(&r) {
                own.behind.push(false);
                continue;
            }
            let at = pose.local(&r);
            let depth = -shape.signed_distance(&at);
            let mut way = shape.outward_normal(&at, 0.05 * dp);
            let exits =
                if is_deep(shape, &at, &way, (depth, reach)) { Vec::new() } else { exits(shape, &at, reach, dp) };
            if way.norm() < 0.5 {
                // Midway between two faces.
                let length = |exit: &&Vector<D>| (**exit - at).norm();
                let nearest = exits.iter().min_by(|a, b| length(a).total_cmp(&length(b)));
                way = nearest.map_or(way, |exit| (exit - at).normalize());
            }
            let foot = at + way * depth;
            let is_chosen = own.holds(&foot);
            own.behind.push(is_chosen);
            let opposite = if exits.is_empty() { None } else { exit(shape, &at, &-way, reach, dp) };
            for place in [Some(foot), opposite].into_iter().flatten() {
                let is_first = (place - at).norm() < FIRST_LAYER * dp;
                if is_first && own.holds(&place) && !is_in_corner(shape, &place, &(place - at), dp) {
                    own.places.push(place);
                }
            }
            let is_near_part = is_chosen || exits.iter().any(|exit| around.contains(&pose.point(exit)));
            if is_near_part && exits.iter().any(|exit| (exit - at).dot(&way) <= 0.0) {
                own.between.insert(k, Between { at, way, is_thin: opposite.is_some() });
            }
        }
        if own.places.is_empty() {
            let what = format!("no face of solid {solid:?} is between {min:?} and {max:?} m");
            return Err(Error::scene(what).help("a box that holds a part of the face, a dp of it or more"));
        }
        Ok(own)
    }

    /// Whether the part holds this place on the face (m, in the solid's frame).
    fn holds(&self, place: &Vector<D>) -> bool {
        self.part.0.contains(&self.part.1.point(place))
    }

    /// Returns how much of the `force` on boundary particle number `k` of the solid acts on the part. Across symmetry planes the particle
    /// is the image of particle `original` of all, along `axes`.
    fn force_on_part(
        &self,
        (system, slope): (&System<D>, &dyn Fn(f64) -> f64),
        k: usize,
        (original, axes): (usize, AxisSet),
        force: Vector<D>,
    ) -> Vector<D> {
        let on_nearest = if self.behind[k] { force } else { Vector::zeros() };
        let Some(between) = self.between.get(&k) else { return on_nearest };
        let solid = &system.solids()[self.solid];
        let sides = sides((system, slope), solid, &between.way, (original, axes));
        let towards = sides[0].towards + sides[1].towards;
        let weight = sides[0].weight + sides[1].weight;
        let is_before_nearest = match between.is_thin {
            true => sides[1].weight == 0.0,
            false => towards.dot(&(solid.kinematics.pose.rotation * between.way)) >= 0.0,
        };
        if is_before_nearest {
            return on_nearest;
        }
        let (model, side) = (system.model(), if between.is_thin { sides[1].towards } else { towards });
        let way = solid.kinematics.pose.rotation.transpose() * side;
        let other = exit(&solid.spec.shape, &between.at, &way.normalize(), model.support_radius(), model.dp);
        let is_other = other.is_some_and(|place| self.holds(&place));
        if !between.is_thin || sides[0].weight == 0.0 {
            return if is_other { force } else { Vector::zeros() };
        }
        let rest = force - sides[0].push - sides[1].push;
        let of = |side: &Side<D>| side.push + rest * (side.weight / weight);
        let chosen = sides.iter().zip([self.behind[k], is_other]).filter(|(_, is_chosen)| *is_chosen);
        chosen.fold(Vector::zeros(), |sum, (side, _)| sum + of(side))
    }

    /// The places on the part now, m.
    fn places(&self, system: &System<D>) -> impl Iterator<Item = Vector<D>> {
        let pose = system.solids()[self.solid].kinematics.pose;
        self.places.iter().map(move |place| system.wrapped(&pose.point(place)))
    }
}

impl<const D: usize> Probe<D> for PatchProbe<D> {
    fn reads(&self) -> ProbeReads {
        ProbeReads::BoundaryForces
    }

    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        let pose = system.solids()[self.solid].kinematics.pose;
        let between = self.between.values().map(|between| system.wrapped(&pose.point(&between.at)));
        let around = |a: Bounds<D>, b: Bounds<D>| Bounds { min: a.min.inf(&b.min), max: a.max.sup(&b.max) };
        let between = between.map(|place| system.reading_range(&place)).reduce(around);
        Some(self.places(system).map(|place| system.reading_range(&place)).chain(between).collect())
    }

    fn columns(&self) -> Vec<String> {
        let wide = if D == 2 { "_per_m" } else { "" };
        let forces = axes::<D>().iter().map(|a| format!("f{a}_N{wide}"));
        forces.chain(["p_mean_Pa", "p_max_Pa"].map(String::from)).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        let solid = &system.solids()[self.solid];
        if solid.is_removed() {
            return empty_row(self);
        }
        let (mut force, slope) = (Vector::<D>::zeros(), system.model().kernel_slope::<D>());
        system.visit_boundary_forces(self.solid, &mut |i, origin, f| {
            force += self.force_on_part((system, &*slope), i - solid.boundary.start, origin, f);
        });
        let (mut sum, mut most) = (0.0, f64::NEG_INFINITY);
        for place in self.places(system) {
            let p = pressure(system, &place);
            (sum, most) = (sum + p, most.max(p));
        }
        force.iter().copied().chain([sum / self.places.len() as f64, most]).collect()
    }
}

/// Whether a ball of radius `reach` (m) that touches the face nearest to `at`, `depth` (m) above it in direction `way`, lies in the solid:
/// there is no other face near.
fn is_deep<const D: usize>(shape: &Shape<D>, at: &Vector<D>, way: &Vector<D>, (depth, reach): (f64, f64)) -> bool {
    way.norm() > 0.5 && shape.signed_distance(&(at - way * (reach - depth))) <= -reach * (1.0 - 1e-6)
}

/// Returns the places (m) on the face straight from `at` along the axes and the diagonals between them, up to `reach` (m) away.
fn exits<const D: usize>(shape: &Shape<D>, at: &Vector<D>, reach: f64, dp: f64) -> Vec<Vector<D>> {
    let way = |n: u32| Vector::<D>::from_fn(|i, _| f64::from((n / 3u32.pow(i as u32)) % 3) - 1.0);
    let ways = (0..3u32.pow(D as u32)).map(way).filter(|way| way.norm() > 0.5);
    let exits = ways.filter_map(|way| exit(shape, at, &way.normalize(), reach, dp));
    // A particle on a face, by round-off, has no way to it.
    exits.filter(|exit| (exit - at).norm() > 1e-6 * dp).collect()
}

/// Returns the place (m) on the face where the ray from `at`, inside the solid, along the unit vector `way` leaves the solid; `None`
/// beyond `reach` (m).
fn exit<const D: usize>(shape: &Shape<D>, at: &Vector<D>, way: &Vector<D>, reach: f64, dp: f64) -> Option<Vector<D>> {
    // The joints of a compound are no faces.
    let outside = |t: f64| shape.signed_distance(&(at + way * t)) > 1e-9 * dp;
    let (mut inside, mut t) = (0.0, 0.0);
    while !outside(t) {
        inside = t;
        t += (-shape.signed_distance(&(at + way * t))).max(0.05 * dp);
        if inside > reach {
            return None;
        }
    }
    for _ in 0..40 {
        let middle = 0.5 * (inside + t);
        if outside(middle) { t = middle } else { inside = middle }
    }
    (t <= reach).then(|| at + way * t)
}

/// Whether the place (m) on the face, in the direction `way` of a boundary particle behind it, is an inner edge: water fills less than
/// half of the kernel there.
fn is_in_corner<const D: usize>(shape: &Shape<D>, place: &Vector<D>, way: &Vector<D>, dp: f64) -> bool {
    way.try_normalize(0.0).is_some_and(|way| shape.signed_distance(&(place + way * (0.1 * dp))) < 0.09 * dp)
}

/// Returns the water on the boundary particle that is the image of particle `original` of all along `axes`, in front of it in the direction
/// `way` (in the frame of `solid`) and behind.
fn sides<const D: usize>(
    (system, slope): (&System<D>, &dyn Fn(f64) -> f64),
    solid: &Solid<D>,
    way: &Vector<D>,
    (original, axes): (usize, AxisSet),
) -> [Side<D>; 2] {
    let (boundary, water, mass) = (system.boundary(), system.fluid(), system.particle_mass());
    let (r, rho) = (boundary.r[original], boundary.rho[original]);
    let (p, rho0) = (system.lattice_pressure(rho), system.properties().rho0);
    let way = solid.kinematics.pose.rotation * way;
    let mut sides = [Side { weight: 0.0, towards: Vector::zeros(), push: Vector::zeros() }; 2];
    system.visit_fluid_near(&r, &mut |b, place, w| {
        let off = reflected(axes, place - r);
        let side = &mut sides[usize::from(off.dot(&way) < 0.0)];
        let pressure = (p + system.lattice_pressure(water.rho[b])) / (rho * water.rho[b]);
        side.weight += w;
        side.towards += off * w;
        side.push += off * (mass * rho0 * pressure * slope(off.norm_squared()));
    });
    sides
}
