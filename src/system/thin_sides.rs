//! Water on the two sides of parts thinner than dp, in 2-D.
//!
//! The layer of boundary particles that stands for such a part is within the support of the water on both of its sides. Each particle
//! has one pressure, between those of the two sides, and pairs of water act through the part. Where the pressures differ, the water
//! moves with the part until the change of density balances the difference. Once a step, water a beside a part
//! that is wet on both sides therefore receives the impulse of
//!
//!   dv_a/dt = −Σ_b V_b/ρ_a (P_a(b) − P_b) s ∇_a W,   s = min(1, 2 d/dp),
//!
//! summed over the boundary particles b of the part and the water b behind it. P_a(b) is the pressure of the water on the side of a,
//! extrapolated to b as to boundary particles, and d the distance of a from the middle of the part. Water is behind the part as far
//! as the line to it passes the part. The solid receives the opposite impulse as a load in the same step.

use rayon::prelude::*;

use super::{System, known_water, own_water, symmetry::reflected, thin_faces::Push, thin_layers::thin_particles};
use crate::{
    geometry::cells::PointCells,
    math::{Bounds, Vector},
    sph::boundary::WallExtrapolation,
};

/// Share of the surroundings of a boundary particle that is water, –, above which both sides may be wet; with water on one side it is ½.
const BOTH_WET: f64 = 0.7;

/// Weights of the water on the drier side over that behind a flat face, –: the impulse rises from none to all between them.
const SIDE: [f64; 2] = [0.6, 0.9];

/// Distances along the part from its nearest boundary particle, dp: up to the first a line passes the part, from the second on beside it.
const PASSES: [f64; 2] = [0.5, 1.0];

/// Water particles of a layer, each with many pairs, that a thread takes at a time.
const WATER_PER_TASK: usize = 64;

/// A boundary particle of a thin part, or its image across symmetry planes.
struct LayerParticle<const D: usize> {
    /// Index of the boundary particle.
    particle: usize,
    /// Place, m.
    x: Vector<D>,
    /// Outward unit normal of one of the faces.
    normal: Vector<D>,
}

/// The water on the two sides of a boundary particle.
struct Sides<const D: usize> {
    /// P/ρ₀ (m²/s²) of the water before it, on the side of its normal, and behind it.
    pressure: [f64; 2],
    /// Gravity less the acceleration of the part, m/s².
    pull: Vector<D>,
    /// Share of the impulse, –.
    apart: f64,
}

/// Points with their cells.
struct Points<const D: usize> {
    places: Vec<Vector<D>>,
    cells: PointCells<D>,
}

impl<const D: usize> Points<D> {
    fn new(places: Vec<Vector<D>>, reach: f64) -> Self {
        Self { cells: PointCells::new(&places, reach), places }
    }

    /// Numbers of the points nearer than `reach` (m) to `x`, in ascending order.
    fn within(&self, x: &Vector<D>, reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        self.cells.visit_near(x, reach, |k, y| {
            if (x - y).norm_squared() < reach * reach {
                found.push(k);
            }
        });
        found.sort_unstable();
        found
    }

    /// Number of the point nearest to `x`, with its distance (m), if that is below `reach` (m).
    fn nearest(&self, x: &Vector<D>, reach: f64) -> Option<(usize, f64)> {
        let distance = |k: usize| (k, (self.places[k] - x).norm());
        self.within(x, reach).into_iter().map(distance).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// A thin layer and the water around it.
struct Layer<'a, const D: usize> {
    system: &'a System<D>,
    /// Number of the solid.
    solid: usize,
    particles: Vec<LayerParticle<D>>,
    /// Their places.
    points: Points<D>,
    /// Indices of the water within the support of the layer, in ascending order, and its places.
    water: Vec<usize>,
    around: Points<D>,
}

/// 0 up to the first of `limits`, 1 from the second on, linear between.
fn ramp(x: f64, limits: [f64; 2]) -> f64 {
    ((x - limits[0]) / (limits[1] - limits[0])).clamp(0.0, 1.0)
}

/// Whether solids have parts of which the sides are told apart. A device computes none but those beside hollows, which are dry on one side.
pub(super) fn has_thin_sides<const D: usize>(system: &System<D>) -> bool {
    #[cfg(feature = "gpu")]
    if system.boundary.on_device.is_some() {
        return false;
    }
    D == 2 && !system.boundary.thin.is_empty()
}

/// Gives all ranks the water around layers that may be wet on both sides.
pub(super) fn know_water<const D: usize>(system: &mut System<D>) {
    if !has_thin_sides(system) {
        return;
    }
    let (thin, r) = (thin_particles(system), &system.boundary.particles.r);
    let reach = 2.0 * system.model.support_radius();
    let range = |(_, particles): (usize, Vec<(usize, f64, Vector<D>)>)| {
        let wet = particles.iter().filter(|(_, wet, _)| *wet > BOTH_WET);
        let places: Vec<Vector<D>> = wet.map(|(particle, ..)| r[*particle]).collect();
        (!places.is_empty()).then(|| Bounds::around(&places).grown(reach))
    };
    let ranges: Vec<Bounds<D>> = thin.filter_map(range).collect();
    known_water::know_within(system, &ranges);
}

/// The pushes of thin parts on the water on their two sides over a step `dt` (s).
pub(super) fn pushes<const D: usize>(system: &System<D>, dt: f64) -> Vec<Push<D>> {
    if !has_thin_sides(system) {
        return Vec::new();
    }
    let (these, own) = own_water::own(&system.neighbours, system.own_count());
    let mut pushes = Vec::new();
    for (solid, particles) in thin_particles(system) {
        let Some(layer) = Layer::new(system, solid, particles) else { continue };
        let sides: Vec<Sides<D>> = layer.particles.iter().map(|particle| layer.sides(particle)).collect();
        let centre = system.solids[solid].kinematics.centre;
        let push = |k: usize| {
            let particle = layer.water[k];
            if !these.contains(&particle) || own.is_some_and(|own| !own[particle]) {
                return None;
            }
            let change = layer.acceleration(k, &sides)? * dt;
            // A copy across periodic sides is one period away from the solid.
            let (nearest, _) = layer.points.nearest(&layer.around.places[k], system.model.support_radius())?;
            let LayerParticle { particle: on, x, .. } = layer.particles[nearest];
            let way = if system.solids[solid].copied_axes == 0 {
                Vector::zeros()
            } else {
                system.place_on_solid(solid, on) - x
            };
            Some(Push { particle, solid, change, arm: layer.around.places[k] + way - centre })
        };
        let water = (0..layer.water.len()).into_par_iter().with_min_len(WATER_PER_TASK);
        pushes.par_extend(water.filter_map(push));
    }
    pushes
}

impl<'a, const D: usize> Layer<'a, D> {
    /// The layer of the thin `particles` (index, share of the surroundings that is water, normal) of solid number `solid` that may be wet
    /// on both sides; `None` without any.
    fn new(system: &'a System<D>, solid: usize, particles: Vec<(usize, f64, Vector<D>)>) -> Option<Self> {
        let r = &system.boundary.particles.r;
        let wet = particles.into_iter().filter(|(_, wet, _)| *wet > BOTH_WET);
        let of = |(particle, _, normal): (usize, f64, Vector<D>)| LayerParticle { particle, x: r[particle], normal };
        let mut particles: Vec<LayerParticle<D>> = wet.map(of).collect();
        let (own, division) = (particles.len(), &system.solids[solid].division);
        let start = system.solids[solid].boundary.start;
        for (k, image) in system.boundary.mirrored[solid].iter().enumerate() {
            let original = start + image.own as usize;
            if let Ok(at) = particles[..own].binary_search_by_key(&original, |particle| particle.particle) {
                let normal = reflected(image.axes, particles[at].normal);
                particles.push(LayerParticle { particle: original, x: r[start + division.own + k], normal });
            }
        }
        let support = system.model.support_radius();
        let places: Vec<_> = particles.iter().map(|particle| particle.x).collect();
        let bounds = (!places.is_empty()).then(|| Bounds::around(&places).grown(support))?;
        let points = Points::new(places, support);
        let r = &system.fluid.particles.r;
        let is_near = |i: &usize| bounds.contains(&r[*i]) && points.nearest(&r[*i], support).is_some();
        let water: Vec<usize> = system.neighbours.fluid_within(&bounds).into_iter().filter(is_near).collect();
        let around = Points::new(water.iter().map(|i| r[*i]).collect(), support);
        Some(Self { system, solid, particles, points, water, around })
    }

    /// P/ρ₀ (m²/s²) and ρ₀/ρ of density `rho` (kg/m³).
    fn state(&self, rho: f64) -> (f64, f64) {
        let rho0 = self.system.properties.rho0;
        (self.system.equation_of_state.pressure(rho / rho0 - 1.0), rho0 / rho)
    }

    /// The water on the two sides of one of its particles.
    fn sides(&self, LayerParticle { particle, x, normal }: &LayerParticle<D>) -> Sides<D> {
        let Self { system, solid, .. } = self;
        let volume = system.properties.particle_volume();
        let mut fits = [WallExtrapolation::<f64, D>::filled_with(0.0); 2];
        for k in self.around.within(x, system.model.support_radius()) {
            let (p, s) = self.state(system.fluid.particles.rho[self.water[k]]);
            let arm = x - self.around.places[k];
            let weight = volume * system.model.kernel_value(arm.norm_squared(), D);
            fits[usize::from(normal.dot(&arm) > 0.0)].add(weight, p, s, arm.into());
        }
        let behind_face = system.boundary.coverage.full_weight(0.5 * system.model.dp);
        let drier = fits[0].weight_sum.min(fits[1].weight_sum) / behind_face;
        Sides {
            pressure: fits.map(|fit| system.extrapolated_pressure(&fit, *solid, *particle)),
            pull: system.properties.gravity
                - system.solids[*solid].acceleration_at(&system.place_on_solid(*solid, *particle)),
            apart: ramp(drier, SIDE),
        }
    }

    /// The acceleration (m/s²) of its water number `k`; `None` where there is none.
    fn acceleration(&self, k: usize, sides: &[Sides<D>]) -> Option<Vector<D>> {
        let system = self.system;
        let (dp, support, x) = (system.model.dp, system.model.support_radius(), self.around.places[k]);
        let (_, own) = self.state(system.fluid.particles.rho[self.water[k]]);
        let share = |height: f64| (2.0 * height.abs() / dp).min(1.0);
        // What a particle at `y` of density `rho` lacks of the pressure `wanted`.
        let lack = |y: &Vector<D>, rho: f64, wanted: f64| {
            let ((p, s), arm) = (self.state(rho), x - y);
            arm * ((p - wanted) * own * s * (system.gap_pressure.slope)(arm.norm_squared()))
        };
        let mut sum = Vector::<D>::zeros();
        for m in self.points.within(&x, support) {
            let LayerParticle { particle, x: y, normal } = &self.particles[m];
            let height = normal.dot(&(x - y));
            let wanted = sides[m].pressure[usize::from(height < 0.0)];
            sum += lack(y, system.boundary.particles.rho[*particle], wanted) * (sides[m].apart * share(height));
        }
        let (nearest, _) = self.points.nearest(&x, support)?;
        let LayerParticle { x: foot, normal, .. } = &self.particles[nearest];
        let height = normal.dot(&(x - foot));
        for m in self.around.within(&x, support) {
            let y = self.around.places[m];
            let behind = normal.dot(&(y - foot));
            if height * behind >= 0.0 {
                continue;
            }
            let crossing = x + (y - x) * (height / (height - behind));
            let Some((at, distance)) = self.points.nearest(&crossing, PASSES[1] * dp) else { continue };
            let is_same = self.particles[at].normal.dot(normal) > 0.0;
            let side = usize::from((height < 0.0) == is_same);
            let wanted = sides[at].pressure[side] + sides[at].pull.dot(&(y - self.points.places[at]));
            let passes = 1.0 - ramp(distance / dp, PASSES);
            sum += lack(&y, system.fluid.particles.rho[self.water[m]], wanted)
                * (sides[at].apart * passes * share(height));
        }
        (sum != Vector::<D>::zeros()).then_some(sum)
    }
}
