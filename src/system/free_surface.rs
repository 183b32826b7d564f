//! Where the surface of the water is: a height at which Σ V_b W, the share of the kernel's weight that water fills, falls
//! through ½. On flat water that is the surface itself.

use rayon::prelude::*;

use super::{System, known_water};
use crate::{
    math::{Bounds, Vector},
    particles::PARTICLES_PER_TASK,
    solid::{Role, Solid},
};

/// A face beside a gauge.
struct SteepFace<const D: usize> {
    /// A point of it, m.
    foot: Vector<D>,
    normal: Vector<D>,
    /// How much of the mirror image counts: 1 at an upright face, 0 at a slope of 45°.
    share: f64,
}

impl<const D: usize> SteepFace<D> {
    /// Height (m) of `x` (m) above it.
    fn height(&self, x: &Vector<D>) -> f64 {
        (x - self.foot).dot(&self.normal)
    }
}

impl<const D: usize> System<D> {
    /// Heights (m) of the water surfaces at the horizontal position `at` (m; its last coordinate does not count), from the
    /// highest down, to a thousandth of dp. Spray that fills less than half of a kernel does not count.
    pub fn surface_heights(&self, at: &Vector<D>) -> impl Iterator<Item = f64> {
        self.heights_where_half(at, |x| {
            let mut sum = 0.0;
            self.visit_fluid_near(x, &mut |b, _, w| sum += self.particle_mass() / self.fluid.particles.rho[b] * w);
            sum
        })
    }

    /// The same for a gauge, which also sees the water of the buffers of open boundaries. Where the kernel reaches into a solid with a
    /// steep face, the mirror image of the water in front of this face fills that part.
    pub(crate) fn gauge_heights(&self, at: &Vector<D>) -> impl Iterator<Item = f64> {
        let (reach, own) = (self.model.support_radius(), *at);
        let beside = move |solid: &&Solid<D>| {
            let bounds = solid.spec.shape.bounds_at(&solid.kinematics.pose).grown(reach);
            !solid.is_removed() && (0..D - 1).all(|i| bounds.min[i] <= own[i] && own[i] <= bounds.max[i])
        };
        let solids: Vec<&Solid<D>> = self.solids.iter().filter(beside).collect();
        self.heights_where_half(at, move |x| self.share_with_images(x, &self.steep_faces(x, &solids), &|_| true))
    }

    /// The share of the kernel's weight at `x` (m) that the `counted` places of water fill.
    fn water_share(&self, x: &Vector<D>, counted: impl Fn(&Vector<D>) -> bool) -> f64 {
        let (mass, rho) = (self.particle_mass(), &self.fluid.particles.rho);
        let mut sum = 0.0;
        self.visit_water_and_buffers_near(x, &mut |b, r, w| sum += if counted(r) { mass / rho[b] * w } else { 0.0 });
        sum
    }

    /// The same with the mirror images of the counted water across these faces. All of the image counts at an upright face.
    fn share_with_images(&self, x: &Vector<D>, faces: &[SteepFace<D>], counted: &dyn Fn(&Vector<D>) -> bool) -> f64 {
        let Some((face, others)) = faces.split_first() else { return self.water_share(x, counted) };
        let in_front = |r: &Vector<D>| face.height(r) > 0.0 && counted(r);
        let image = x - face.normal * (2.0 * face.height(x));
        let mirrored = [*x, image].map(|x| self.share_with_images(&x, others, &in_front)).iter().sum::<f64>();
        let plain = if face.share < 1.0 { self.share_with_images(x, others, counted) } else { 0.0 };
        face.share * mirrored + (1.0 - face.share) * plain
    }

    /// The steep face of `solids` nearest to `x` (m), if the kernel reaches it, and one across it that the kernel reaches too.
    fn steep_faces(&self, x: &Vector<D>, solids: &[&Solid<D>]) -> Vec<SteepFace<D>> {
        let reach = self.model.support_radius();
        // A gauge may stand on a face.
        let is_near = |face: &SteepFace<D>| (-1e-9..reach).contains(&face.height(x));
        let Some(first) = self.nearest_face(x, solids).filter(is_near) else { return Vec::new() };
        let aside = x + first.normal * reach;
        let across = |face: &SteepFace<D>| is_near(face) && face.normal.dot(&first.normal).abs() < 0.5;
        let second = self.nearest_face(&aside, solids).filter(across);
        std::iter::once(first).chain(second).collect()
    }

    /// The face of `solids` nearest to `x` (m), unless it slopes by 45° or less.
    fn nearest_face(&self, x: &Vector<D>, solids: &[&Solid<D>]) -> Option<SteepFace<D>> {
        let near = solids.iter().map(|solid| (solid.distance(x), *solid)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (distance, solid) = near.filter(|(distance, _)| *distance < self.model.support_radius())?;
        let (shape, pose) = (&solid.spec.shape, &solid.kinematics.pose);
        let normal = pose.rotation * shape.outward_normal(&pose.local(x), 0.05 * self.model.dp);
        let share = 1.0 - 2.0 * normal[D - 1].powi(2);
        // In the middle between two faces there is no normal.
        (share > 0.0 && normal.norm() > 0.5).then(|| SteepFace { foot: x - normal * distance, normal, share })
    }

    /// The heights (m) above `at` at which the share `filled` of the kernel falls through ½, from the highest down.
    fn heights_where_half(&self, at: &Vector<D>, filled: impl Fn(&Vector<D>) -> f64) -> impl Iterator<Item = f64> {
        let (dp, h, up) = (self.model.dp, self.model.h, D - 1);
        let beside = |r: &Vector<D>| (0..up).map(|i| (r[i] - at[i]).powi(2)).sum::<f64>() < (2.0 * h).powi(2);
        let nothing = || (f64::INFINITY, f64::NEG_INFINITY);
        let (r, known) = (self.fluid().r, self.neighbours.known_water());
        let count = known.map_or(r.len(), <[u32]>::len);
        let place = |k: usize| &r[known.map_or(k, |known| known[k] as usize)];
        let all = (0..count).into_par_iter().with_min_len(PARTICLES_PER_TASK).map(place);
        let heights = all.filter(|r| beside(r)).map(|r| (r[up], r[up]));
        let (low, high) = heights.reduce(nothing, |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let at = *at;
        let filled_at = move |z: f64| {
            let mut x = at;
            x[up] = z;
            filled(&x)
        };
        half_crossings(filled_at, low, high + 2.0 * h, 0.5 * dp, 1e-3 * dp)
    }

    /// Updates the absorbing paddles for the surface in front of them at time `t` (s), the start of a step; the lists must hold.
    pub(crate) fn update_absorption(&mut self, t: f64) {
        known_water::know_within(self, &self.absorption_ranges(t));
        for i in 0..self.solids.len() {
            let solid = &self.solids[i];
            let Role::Driven(motion) = &solid.spec.role else { continue };
            let Some(gauge) = motion.gauge_position(&solid.absorption, t) else { continue };
            let level = self.surface_heights(&self.wrapped(&gauge)).next();
            self.solids[i].absorption = motion.update_absorption(&solid.absorption, t, level);
        }
    }

    /// The boxes (m) in which absorbing paddles read the surface at time `t` (s), the start of a step.
    pub(crate) fn absorption_ranges(&self, t: f64) -> Vec<Bounds<D>> {
        let range = |solid: &Solid<D>| match &solid.spec.role {
            Role::Driven(motion) => {
                Some(self.surface_range(&self.wrapped(&motion.gauge_position(&solid.absorption, t)?)))
            }
            _ => None,
        };
        self.solids.iter().filter_map(range).collect()
    }

    /// The box (m) in which [`System::surface_heights`] reads the water.
    pub(crate) fn surface_range(&self, at: &Vector<D>) -> Bounds<D> {
        let mut range = Bounds { min: *at, max: *at }.grown(self.model.support_radius().max(2.0 * self.model.h));
        (range.min[D - 1], range.max[D - 1]) = (f64::NEG_INFINITY, f64::INFINITY);
        range
    }
}

/// The heights between `low` and `high` at which `filled` falls through ½ on the way up, from the highest down: found by
/// steps of `step` downwards and bisection to `tolerance`.
fn half_crossings(
    filled: impl Fn(f64) -> f64,
    low: f64,
    high: f64,
    step: f64,
    tolerance: f64,
) -> impl Iterator<Item = f64> {
    // Where the water of the surface before was met.
    let mut met: Option<f64> = None;
    std::iter::from_fn(move || {
        let mut dry = match met {
            None => high,
            Some(mut z) => {
                while filled(z) >= 0.5 {
                    z -= step;
                }
                z
            }
        };
        let mut wet = dry;
        while filled(wet) < 0.5 {
            (dry, wet) = (wet, wet - step);
            if wet.is_nan() || wet < low {
                return None;
            }
        }
        met = Some(wet);
        while dry - wet > tolerance {
            let middle = 0.5 * (wet + dry);
            if filled(middle) < 0.5 { dry = middle } else { wet = middle }
        }
        Some(0.5 * (wet + dry))
    })
}

#[cfg(test)]
#[path = "../../tests/unit/system/free_surface.rs"]
mod tests;
