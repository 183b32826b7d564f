//! Equilibrium of each free body: draft, metacentric height and periods, and whether particles of this size can support
//! it.
//!
//!   heave  T = 2π √((m + m_a)/(ρ₀ g A)),    roll  T = 2π √(I/(m g GM))
//!
//! A is the area of the waterplane and m_a is the added mass in heave. The estimate of m_a is half of the added mass of
//! a flat plate of the same waterplane, because water is on one side only. It is ½ π ρ₀ (A/2)² in 2-D and ½ (8/3) ρ₀ a³
//! with π a² = A in 3-D @newman1977, ch. 4. Nothing is added to I, so that the real roll period is longer.
//!
//! With Δt = C h/c₀ an explicit exchange of forces is stable for a body whose mass per wetted area exceeds ½ C ρ₀ h. A
//! lighter body moves with the inertia of the water around it (`time/light.rs`), and its draft is a few tenths of a dp.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use super::{Finding, PreflightContext, surface_samples::SurfaceSample, thickness::thinnest_part};
use crate::{
    math::{
        Bivector, Pose, Vector,
        format::{three_digits, two_digits_down, two_digits_up},
    },
    scene::world_bounds,
    solid::{
        FreeBody, Role, Solid,
        hydrostatics::{equilibrium_height, metacentric_height},
    },
};

/// Heel (rad) from equilibrium below which no finding is reported: half a degree.
const LEVEL: f64 = 0.5 * PI / 180.0;

/// A free body before its first step. In 2-D masses are kg/m and volumes m².
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodySummary {
    /// Name of the body.
    pub name: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Volume, m³.
    pub volume_m3: f64,
    /// Mean density of the body over the density of the water, –.
    pub density_ratio: f64,
    /// Mass of the water that the body displaces at its start, kg.
    pub displaced_kg: f64,
    /// Depth of the lowest point of the body below the still water level at its start, m; negative if the point is
    /// above the level.
    pub draft_m: f64,
    /// Equilibrium in the initial orientation; absent if the body sinks, its height is held, or nothing floats.
    pub afloat: Option<Equilibrium>,
    /// Thickness of its thinnest part, m, except for tips.
    pub thinnest_m: f64,
    /// The same thickness over dp.
    pub thinnest_dp: f64,
    /// Mass per wetted area over ½ C ρ₀ h, –; below 1 the body moves with the inertia of the water.
    pub over_limit: f64,
    /// The density ratio at which `over_limit` is 1.
    pub least_ratio: f64,
}

/// The equilibrium of a floating body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Equilibrium {
    /// Draft at rest, m.
    pub draft_m: f64,
    /// Area of its waterplane, m²; in 2-D the breadth of the waterplane, m.
    pub waterplane_m2: f64,
    /// Period of heave without added mass, s.
    pub heave_s: f64,
    /// Estimated added mass in heave, kg.
    pub heave_added_kg: f64,
    /// Period of heave with the added mass, s.
    pub heave_with_added_s: f64,
    /// Tilts that are not locked: one in 2-D; in 3-D the tilts about the horizontal axes of least and greatest GM.
    pub tilts: Vec<Tilt>,
    /// Heel of the initial orientation from equilibrium, degrees; absent if the body capsizes.
    pub heel_deg: Option<f64>,
}

/// A tilt (roll or pitch) of a floating body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tilt {
    /// Axial components of the axis.
    pub axis: Vec<f64>,
    /// Metacentric height, m; if it is negative, the body capsizes.
    pub gm_m: f64,
    /// Period of roll without added inertia, s; absent unless GM is positive.
    pub period_s: Option<f64>,
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Returns the summaries of the free bodies and adds findings about them. `touching` marks the solids that touch
    /// another.
    pub(super) fn bodies(&self, touching: &[bool], findings: &mut Vec<Finding>) -> Vec<BodySummary> {
        let mut bodies = Vec::new();
        for (i, solid) in self.solids().iter().enumerate() {
            let Role::Free(body) = &solid.spec.role else { continue };
            let found = self.body(solid, body, &self.surface_samples[i]);
            self.flotation_findings(&found, touching[i], findings);
            self.resolution_findings(&found, findings);
            bodies.push(found);
        }
        self.thin_bodies(&bodies, findings);
        bodies
    }

    /// Adds findings about bodies that are thick enough to separate the water of both sides, but whose middle still
    /// interacts with both.
    fn thin_bodies(&self, bodies: &[BodySummary], findings: &mut Vec<Finding>) {
        let reach = self.system.model().support_radius() * (1.0 - 1e-6);
        let thin: Vec<&BodySummary> = bodies.iter().filter(|b| (reach..2.0 * reach).contains(&b.thinnest_m)).collect();
        let Some(thinnest) = thin.iter().map(|b| b.thinnest_m).reduce(f64::min) else { return };
        let names: Vec<String> = thin.iter().map(|b| format!("\"{}\"", b.name)).collect();
        let what = format!(
            "thinner than twice the kernel's reach, {} dp: {}; boundary particles in their middle see the water of both \
             sides",
            three_digits(2.0 * self.support_radius_dp()),
            names.join(", ")
        );
        let mend = format!("none would be with  dp = {}", two_digits_down(0.5 * thinnest / self.support_radius_dp()));
        findings.push(Finding::note("slender_body", what, mend));
    }

    fn body(&self, solid: &Solid<D>, body: &FreeBody<D>, faces: &[SurfaceSample<D>]) -> BodySummary {
        let (model, shape, pose) = (self.system.model(), &solid.spec.shape, &solid.kinematics.pose);
        let volume = shape.volume_properties().volume;
        let rest = self.equilibrium_pose(solid, body);
        let wet =
            |face: &&SurfaceSample<D>| rest.is_none_or(|pose| pose.point(&face.x)[D - 1] < self.still_water.level);
        let share = faces.iter().filter(wet).count() as f64 / faces.len().max(1) as f64;
        let least = 0.5 * model.cfl * model.rho0 * model.h * share * shape.surface_area();
        let thinnest_m = thinnest_part(shape, faces, model.dp).unwrap_or(model.dp);
        let displaced = if self.g > 0.0 { shape.submerged_volume(pose, self.still_water.level).0 } else { volume };
        BodySummary {
            name: solid.spec.name.clone(),
            mass_kg: body.mass,
            volume_m3: volume,
            density_ratio: body.mass / (model.rho0 * volume),
            displaced_kg: model.rho0 * displaced,
            draft_m: self.still_water.level - self.lowest_point(solid),
            afloat: rest.map(|pose| self.afloat(solid, body, &pose)),
            thinnest_m,
            thinnest_dp: thinnest_m / model.dp,
            over_limit: body.mass / least,
            least_ratio: least / (model.rho0 * volume),
        }
    }

    /// Returns the pose of the body in vertical equilibrium with its initial orientation.
    fn equilibrium_pose(&self, solid: &Solid<D>, body: &FreeBody<D>) -> Option<Pose<D>> {
        if self.g == 0.0 || body.locked_translations[D - 1] || self.is_pinned(solid) {
            return None;
        }
        let mut pose = solid.kinematics.pose;
        let rho0 = self.system.model().rho0;
        pose.position[D - 1] +=
            equilibrium_height(&solid.spec.shape, &pose, body.mass, rho0, self.still_water.level).ok()?;
        Some(pose)
    }

    /// Returns whether a joint to a solid that is not free holds a point of `solid`.
    fn is_pinned(&self, solid: &Solid<D>) -> bool {
        let number = self.system.find_solid(&solid.spec.name);
        let free = |i: usize| matches!(self.solids()[i].spec.role, Role::Free(_));
        self.system.constraints().joints.iter().any(|joint| {
            let [one, other] = joint.between;
            (0..D).all(|mode| joint.is_locked(mode))
                && ((one == number && !other.is_some_and(free)) || (other == number && !one.is_some_and(free)))
        })
    }

    /// Returns the equilibrium of the body at `pose`.
    fn afloat(&self, solid: &Solid<D>, body: &FreeBody<D>, pose: &Pose<D>) -> Equilibrium {
        let (shape, level, rho0) = (&solid.spec.shape, self.still_water.level, self.system.model().rho0);
        let bounds = world_bounds(shape, pose);
        let step = 1e-4 * bounds.size()[D - 1];
        let area = (shape.submerged_volume(pose, level + step).0 - shape.submerged_volume(pose, level - step).0)
            / (2.0 * step);
        let added = rho0 * if D == 2 { PI * area * area / 8.0 } else { 4.0 / 3.0 * (area / PI).powf(1.5) };
        let heave = |mass: f64| TAU * (mass / (rho0 * self.g * area)).sqrt();
        let tilts = self.tilts(solid, body, pose);
        let mut up = Vector::zeros();
        up[D - 1] = 1.0;
        let lever = Bivector::torque(&(shape.submerged_volume(pose, level).1 - pose.point(&body.centre)), &up).axial();
        let along = |axis: &[f64]| lever.iter().zip(axis).map(|(l, a)| l * a).sum::<f64>();
        // A body of revolution on its side has GM = 0 and no heel.
        let heel = |t: &Tilt| if t.gm_m > 0.0 { along(&t.axis) / t.gm_m } else { 0.0 };
        let turned = tilts.iter().map(|t| heel(t).powi(2)).sum::<f64>().sqrt();
        Equilibrium {
            draft_m: level - bounds.min[D - 1],
            waterplane_m2: area,
            heave_s: heave(body.mass),
            heave_added_kg: added,
            heave_with_added_s: heave(body.mass + added),
            heel_deg: tilts.iter().all(|t| t.gm_m >= 0.0).then(|| turned.to_degrees()),
            tilts,
        }
    }

    /// Returns the tilts that are not locked, with their metacentric heights.
    fn tilts(&self, solid: &Solid<D>, body: &FreeBody<D>, pose: &Pose<D>) -> Vec<Tilt> {
        let rho0 = self.system.model().rho0;
        let size = solid.spec.shape.bounds().size().max();
        let gm = |axis: &[f64]| {
            let gm =
                metacentric_height(&solid.spec.shape, pose, body, rho0, self.still_water.level, axis).unwrap_or(0.0);
            // Round-off and facets give a ball a small GM; its true GM is 0.
            if gm.abs() < 1e-4 * size { 0.0 } else { gm }
        };
        let tilt = |axis: Vec<f64>, gm_m: f64| {
            let own = pose.rotation.transpose() * Vector::<D>::from_fn(|i, _| axis.get(i).copied().unwrap_or(0.0));
            let inertia = if D == 2 { body.inertia[(0, 0)] } else { own.dot(&(body.inertia * own)) };
            let period_s = (gm_m > 0.0).then(|| TAU * (inertia / (body.mass * self.g * gm_m)).sqrt());
            Tilt { axis, gm_m, period_s }
        };
        let (x, y) = (vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]);
        match (D, body.locked_rotations) {
            (2, [true, ..]) | (3, [true, true, _]) => Vec::new(),
            (2, _) => vec![tilt(vec![1.0], gm(&[1.0]))],
            (_, [false, true, _]) => vec![tilt(x.clone(), gm(&x))],
            (_, [true, false, _]) => vec![tilt(y.clone(), gm(&y))],
            _ => {
                // GM is a tensor in the waterplane; three directions determine its principal axes.
                let (xx, yy, between) = (gm(&x), gm(&y), gm(&[0.5f64.sqrt(), 0.5f64.sqrt(), 0.0]));
                let xy = between - 0.5 * (xx + yy);
                let xy = if xy.abs() < 1e-4 * size { 0.0 } else { xy };
                let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
                let (middle, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
                vec![tilt(vec![-sin, cos, 0.0], middle - half), tilt(vec![cos, sin, 0.0], middle + half)]
            }
        }
    }

    /// Adds findings about the equilibrium of a body.
    fn flotation_findings(&self, body: &BodySummary, touches: bool, findings: &mut Vec<Finding>) {
        let (name, Some(afloat)) = (&body.name, &body.afloat) else { return };
        let least = afloat.tilts.iter().map(|t| t.gm_m).fold(f64::INFINITY, f64::min);
        if least < 0.0 {
            let what = format!("\"{name}\" will turn over: its metacentric height is {} m", three_digits(least));
            let mend = format!(
                "lower its centre of mass by {} m or more (centre_offset), or lock its turn",
                two_digits_up(-least)
            );
            findings.push(Finding::warning("capsizes", what, mend));
        } else if afloat.heel_deg.is_some_and(|heel| heel > LEVEL.to_degrees()) {
            let heel = afloat.heel_deg.unwrap_or_default();
            // The metacentric height holds for small tilts only.
            let far = if heel > 45.0 { "more than 45".into() } else { format!("about {}", three_digits(heel)) };
            let what = format!("\"{name}\" starts {far}° out of the trim in which it rests");
            let mend = "turn it by so much (angle_deg, turn_deg), or put its centre of mass under its buoyancy".into();
            findings.push(Finding::note("lists", what, mend));
        }
        // A body that rests on another solid need not float at equilibrium.
        let off = body.draft_m - afloat.draft_m;
        if off.abs() > self.dp() && !touches {
            let side = if off > 0.0 { "below" } else { "above" };
            let what = format!(
                "\"{name}\" starts {} m, {} dp, {side} its draft of {} m",
                three_digits(off.abs()),
                three_digits(off.abs() / self.dp()),
                three_digits(afloat.draft_m)
            );
            let mend = "it starts at rest with  draft = \"equilibrium\"".into();
            findings.push(Finding::note("off_draft", what, mend));
        }
    }

    /// Adds findings about whether the particles can support a body.
    fn resolution_findings(&self, body: &BodySummary, findings: &mut Vec<Finding>) {
        let (model, name) = (self.system.model(), &body.name);
        let density = body.density_ratio * model.rho0;
        let reach = model.support_radius();
        if body.thinnest_m < reach * (1.0 - 1e-6) {
            let what = format!(
                "\"{name}\" is {} m thin, {} dp, and the kernel reaches {} dp: water sees through it",
                three_digits(body.thinnest_m),
                three_digits(body.thinnest_dp),
                three_digits(self.support_radius_dp())
            );
            let mend = format!(
                "make it {} m thick, or dp = {}",
                two_digits_up(reach),
                two_digits_down(body.thinnest_m / self.support_radius_dp())
            );
            findings.push(Finding::warning("thin_body", what, mend));
        }
        if body.over_limit < 1.0 {
            let what = format!(
                "\"{name}\" is lighter than the water that a step sets moving with it, {} kg/m³ for {} kg/m³: it answers with \
                 that water's inertia, and its draft may be a dp off",
                three_digits(density),
                three_digits(body.least_ratio * model.rho0)
            );
            let mend = format!(
                "density = {} would not need it, nor dp = {}",
                two_digits_up(body.least_ratio * model.rho0),
                two_digits_down(model.dp * body.over_limit)
            );
            findings.push(Finding::note("light_body", what, mend));
        }
    }

    /// Returns the height (m) of the lowest point of `solid`.
    pub(super) fn lowest_point(&self, solid: &Solid<D>) -> f64 {
        world_bounds(&solid.spec.shape, &solid.kinematics.pose).min[D - 1]
    }
}
