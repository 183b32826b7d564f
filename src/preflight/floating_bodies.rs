//! Equilibrium of each free body: draft, metacentric height and periods, and whether particles of this size can support
//! it. Water inside a hull counts in the mass m that heaves and in the displacement Δ used for GM, but not in the inertia I in roll. Its
//! free surface lowers GM by ρ₀ I_inner/Δ.
//!
//!   heave  T = 2π √((m + m_a)/(ρ₀ g A)),    roll  T = 2π √(I/(Δ g GM))
//!
//! A is the area of the waterplane and m_a is the added mass in heave. The estimate of m_a is half of the added mass of
//! a flat plate of the same waterplane, because water is on one side only. It is ½ π ρ₀ (A/2)² in 2-D and ½ (8/3) ρ₀ a³
//! with π a² = A in 3-D @newman1977, ch. 4. I has no added inertia of the water, so the real roll period is longer.
//!
//! With Δt = C h/c₀ an explicit exchange of forces is stable for a body whose mass per wetted area exceeds ½ C ρ₀ h. A
//! lighter body, whose draft is a few tenths of a dp at most, moves with the inertia of the water around it
//! (`coupling/acoustic_added_mass.rs`).

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use super::{
    Finding, PreflightContext,
    expected_errors::heave_error,
    gaps::Gaps,
    hinged_bodies::{FreeAssembly, free_assembly, free_assembly_finding, held_findings},
    hollows::{hull, is_in_dry_hollow},
    lifetimes::overload,
    surface_samples::SurfaceSample,
    surroundings::Surroundings,
    thickness::{buoyancy_error, effect_on_sides, load_error, thinnest_part},
    turns::{LARGEST_ESTIMATE, linear_heel, turn_finding},
};
use crate::{
    geometry::world_bounds,
    math::{
        Matrix,
        format::{three_digits, two_digits_down, two_digits_up},
    },
    solid::{
        Constraints, FreeBody, Solid, SolidSpec,
        decks::standing_joint,
        joint_groups::JointGroups,
        righting::{Floating, Turn},
        statics::{MooredEnd, NO_WATER, StaticBody, StaticSystem, Support, WaterAtRest},
    },
};

/// Number of intervals of a run at whose ends the metacentric height of a body with ballast is computed.
const BALLAST_TIMES: u32 = 50;

/// Share by which facets and samples may find a part thinner than it is.
const CHORD_ERROR: f64 = 0.01;

/// Metacentric height over the least extent of a body below which it is neutral: facets and round-off give a
/// homogeneous ball a small one; its true one is 0.
const NEUTRAL: f64 = 1e-3;

/// Error of the buoyancy of a part thinner than dp over its area, dp (record 147).
const THIN_ERROR: f64 = 0.15;

/// A free body before its first step. In 2-D masses are kg/m and volumes m².
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodySummary {
    /// Name of the body.
    pub name: String,
    /// Mass at the start, kg.
    pub mass_kg: f64,
    /// Largest mass in the run, kg; absent unless it has ballast.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_mass_kg: Option<f64>,
    /// Volume, m³.
    pub volume_m3: f64,
    /// Mean density of the body over the density of the water, –.
    pub density_ratio: f64,
    /// Mass of the water that the body displaces at its start, kg.
    pub displaced_kg: f64,
    /// Depth of the lowest point of the body below the still water level at its start, m; negative if the point is
    /// above the level.
    pub draft_m: f64,
    /// Equilibrium in the initial orientation; absent unless the water carries it.
    pub afloat: Option<Equilibrium>,
    /// The effect that carries it at rest: `water`, `lines` (it hangs on them, or they hold it down), `held` (by a joint
    /// or a lock), `bottom` (it sinks, or lies on a solid), `solid` (it stands on one in the air), `floods` (water runs over its
    /// rim), `neutral` (as dense as the water), `none` without gravity.
    pub support: &'static str,
    /// Names of the other bodies of its assembly, between which there are joints.
    pub tied_to: Vec<String>,
    /// Load of lines and steady forces on it at rest, over gravity, kg; positive downward.
    pub load_kg: f64,
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
    /// Mass of the water of its own in its hollows, which moves with it, kg; absent without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub enclosed_water_kg: Option<f64>,
    /// Area of its waterplane, m²; in 2-D the breadth of the waterplane, m.
    pub waterplane_m2: f64,
    /// Period of heave without added mass, s.
    pub heave_s: f64,
    /// Estimated added mass in heave, kg.
    pub heave_added_kg: f64,
    /// Period of heave with the added mass, s.
    pub heave_with_added_s: f64,
    /// Share of its first swing in heave that it loses at this dp, –, as measured on a disc.
    pub first_swing_error: f64,
    /// Tilts that are not locked: one in 2-D; in 3-D the tilts about the horizontal axes of least and greatest GM.
    pub tilts: Vec<Tilt>,
    /// Turn from the initial orientation to rest, degrees. Absent if it floods on its way, and if it is an estimate and GM is
    /// negative.
    pub heel_deg: Option<f64>,
    /// Whether `heel_deg` is an estimate for small angles, at most 45°: of tied bodies, and of open hulls that start turned.
    pub heel_is_estimate: bool,
    /// The turn that `heel_deg` tells, if it is no estimate.
    #[serde(skip)]
    pub(crate) turn: Option<Turn>,
    /// The body with all that joints, ropes and springs tie to it, and with their motions free, at the first of these bodies that floats;
    /// absent without ties that leave a motion free, and if their rest is not found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_joints: Option<FreeAssembly>,
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
    /// Returns the summaries of the free bodies and adds findings about them. `gaps` tells which solids touch one
    /// another; `moored` are the ends of mooring lines.
    pub(super) fn bodies(
        &self,
        gaps: &Gaps,
        moored: Vec<MooredEnd<D>>,
        findings: &mut Vec<Finding>,
    ) -> Vec<BodySummary> {
        let specs: Vec<&SolidSpec<D>> = self.solids().iter().map(|solid| &solid.spec).collect();
        let constraints = self.system.constraints().at_start();
        let groups = JointGroups::of(&specs, &constraints);
        let stands = |pair: &[usize; 2]| [[0, 1], [1, 0]].iter().any(|[a, b]| self.decks[pair[*a]] == Some(pair[*b]));
        let lies: Vec<bool> =
            (0..specs.len()).map(|i| gaps.pairs.iter().any(|pair| pair.contains(&i) && !stands(pair))).collect();
        let statics = self.statics(&lies, constraints).map(|statics| statics.with_mooring_stiffness(moored));
        findings.extend(statics.iter().flat_map(StaticSystem::overloads).map(overload::<D>));
        let mut bodies = Vec::new();
        for (i, solid) in self.solids().iter().enumerate() {
            let Some(body) = &solid.body else { continue };
            let mut found = self.body(i, body, (&statics, bodies.len()));
            let others = (0..specs.len()).filter(|j| *j != i && groups.jointed[*j] == groups.jointed[i]);
            found.tied_to = others.map(|j| specs[j].name.clone()).collect();
            bodies.push(found);
            let first = bodies.len() - 1;
            let touches = (0..specs.len()).any(|j| lies[j] && groups.jointed[j] == groups.jointed[i]);
            let tied = statics.as_ref().map_or_else(Vec::new, |statics| statics.tied_to(first));
            let free = tied.iter().find_map(|j| bodies.get(*j)?.afloat.as_ref()?.free_joints.as_ref());
            self.flotation_findings((&bodies[first], free), (&statics, first), touches, findings);
            statics.iter().for_each(|statics| held_findings(self, statics, first, findings));
            self.ballast_findings(i, (&statics, first), &bodies[first], findings);
            findings.extend(self.unstable_ballast((&statics, first), i, &bodies[first]));
            self.resolution_findings(&bodies[first], findings);
        }
        self.thin_bodies(&bodies, findings);
        bodies
    }

    /// Returns the free bodies with their ties and the bodies on their decks, at rest; `None` without gravity. `lies` tells which
    /// solids touch another that is not such a body or its deck.
    fn statics(&self, lies: &[bool], mut constraints: Constraints<D>) -> Option<StaticSystem<'_, D>> {
        if self.g == 0.0 {
            return None;
        }
        let level = self.still_water.level;
        let specs: Vec<&SolidSpec<D>> = self.solids().iter().map(|solid| &solid.spec).collect();
        let standing = self.decks.iter().enumerate().filter_map(|(i, deck)| Some([i, (*deck)?]));
        constraints.joints.extend(standing.map(|pair| standing_joint(&specs, pair)));
        let body = |(i, solid): (usize, &'_ Solid<D>)| {
            let body = self.solids()[i].body.as_ref()?;
            let (hull, pose) = (hull(self, i), solid.kinematics.pose);
            let [start, _] = hull.extent(&pose);
            // Under a body without water and ties, which falls, the ground is not known.
            let falls = self.level_around(i).is_none() && constraints.constraint_on(i, 0.0).is_none();
            let bed = self.basin(&world_bounds(&solid.spec.shape, &pose)).bottom();
            let bottom = if lies[i] || falls { start } else { start.min(bed) };
            let level = self.level_around(i).unwrap_or(NO_WATER);
            Some(StaticBody { solid: i, hull, body, pose, bottom, level })
        };
        let bodies = self.solids().iter().enumerate().filter_map(body).collect();
        let water = WaterAtRest { rho0: self.system.model().rho0, g: self.g, level };
        Some(StaticSystem::new(bodies, &specs, &constraints, water))
    }

    /// Adds findings about bodies that are thick enough to separate the water of both sides, but whose middle still
    /// interacts with both.
    fn thin_bodies(&self, bodies: &[BodySummary], findings: &mut Vec<Finding>) {
        let reach = self.system.model().support_radius() * (1.0 - CHORD_ERROR);
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

    /// Returns the summary of solid number `i`, a free body with this number in the static system.
    fn body(&self, i: usize, body: &FreeBody<D>, (statics, number): (&Option<StaticSystem<D>>, usize)) -> BodySummary {
        let (solid, faces) = (&self.solids()[i], &self.surface_samples[i]);
        let (model, shape, pose) = (self.system.model(), &solid.spec.shape, &solid.kinematics.pose);
        let volume = shape.volume_properties().volume;
        let support = statics.as_ref().map(|statics| self.support(statics, number));
        let afloat = statics.as_ref().filter(|_| support == Some(Support::Water));
        let rest = match support {
            Some(Support::Water) => afloat.map(|statics| statics.pose(number)),
            // What stands in the air is judged as it would float.
            Some(Support::Solid) => {
                let mut pose = *pose;
                let rise = hull(self, i).equilibrium_height(&pose, body.mass, model.rho0, self.draft_level(i));
                rise.ok().map(|rise| {
                    pose.position[D - 1] += rise;
                    pose
                })
            }
            _ => None,
        };
        let wet = |face: &&SurfaceSample<D>| {
            let below = rest.is_none_or(|pose| pose.point(&face.x)[D - 1] < self.draft_level(i));
            below && !is_in_dry_hollow(self, i, &(face.x + face.n * (0.5 * model.dp)))
        };
        let share = faces.iter().filter(wet).count() as f64 / faces.len().max(1) as f64;
        let least = 0.5 * model.cfl * model.rho0 * model.h * share * shape.surface_area();
        let thinnest_m = thinnest_part(shape, faces, model.dp).unwrap_or(model.dp);
        let displaced = match statics {
            Some(statics) => hull(self, i).submerged_volume(pose, statics.bodies[number].level).0,
            None => volume,
        };
        BodySummary {
            name: solid.spec.name.clone(),
            mass_kg: body.mass,
            largest_mass_kg: solid.spec.largest_mass(self.plan.until),
            volume_m3: volume,
            density_ratio: body.mass / (model.rho0 * volume),
            displaced_kg: model.rho0 * displaced,
            draft_m: self.draft_level(i) - self.lowest_point(solid),
            afloat: afloat.map(|statics| self.afloat(solid, statics, number)),
            support: match support {
                Some(Support::Water) => "water",
                Some(Support::Lines) => "lines",
                Some(Support::Held) => "held",
                Some(Support::Bottom) => "bottom",
                Some(Support::Solid) => "solid",
                Some(Support::Floods) => "floods",
                Some(Support::Neutral) => "neutral",
                None => "none",
            },
            tied_to: Vec::new(),
            load_kg: statics.as_ref().map_or(0.0, |statics| statics.tie_load(number) / self.g),
            thinnest_m,
            thinnest_dp: thinnest_m / model.dp,
            over_limit: body.mass / least,
            least_ratio: least / (model.rho0 * volume),
        }
    }

    /// Returns the equilibrium of body `number` with its assembly.
    fn afloat(&self, solid: &Solid<D>, statics: &StaticSystem<D>, number: usize) -> Equilibrium {
        let (level, rho0) = (self.draft_level(statics.bodies[number].solid), self.system.model().rho0);
        let area = statics.waterplane(number);
        let added = rho0 * if D == 2 { PI * area * area / 8.0 } else { 4.0 / 3.0 * (area / PI).powf(1.5) };
        let (mass, stiffness) = statics.heaving_mass_and_stiffness(number);
        let heave = |mass: f64| TAU * (mass / (rho0 * self.g * area + stiffness)).sqrt();
        let tilts = self.tilts(statics, number);
        let turn = self.turn(statics, number);
        let heel_deg = match turn {
            Some(Turn::Rests(angle)) => Some(angle.to_degrees()),
            Some(Turn::Floods(_)) => None,
            None => tilts
                .iter()
                .all(|t| t.gm_m >= 0.0)
                .then(|| linear_heel(statics, number, &tilts).to_degrees().min(LARGEST_ESTIMATE)),
        };
        let draft = level - world_bounds(&solid.spec.shape, &statics.pose(number)).min[D - 1];
        Equilibrium {
            draft_m: draft,
            enclosed_water_kg: Some(statics.enclosed_water(number)).filter(|water| *water > 0.0),
            waterplane_m2: area,
            heave_s: heave(mass),
            heave_added_kg: added,
            heave_with_added_s: heave(mass + added),
            first_swing_error: heave_error::<D>(area, draft, self.dp()),
            heel_deg,
            heel_is_estimate: turn.is_none() && !tilts.is_empty(),
            turn,
            tilts,
            free_joints: free_assembly(self, statics, number),
        }
    }

    /// Returns the turn of body `number` to its rest; `None` if it is tied, or an open hull that starts turned.
    fn turn(&self, statics: &StaticSystem<D>, number: usize) -> Option<Turn> {
        let floating = self.floating(statics, number, statics.bodies[number].body);
        // The space below the rim of a hull that starts turned is not all of that below its rim when it is upright.
        let opens = floating.hull.rim_height(&floating.pose).is_finite();
        let is_turned = (floating.pose.rotation - Matrix::identity()).norm() > 1e-6;
        if statics.floats_alone(number) && !(opens && is_turned) { floating.turn() } else { None }
    }

    /// Returns body `number` at its rest, as free of ties, with the mass of `body`.
    fn floating<'a>(&self, statics: &'a StaticSystem<D>, number: usize, body: &'a FreeBody<D>) -> Floating<'a, D> {
        let hull = &statics.bodies[number].hull;
        let axes = if D == 2 { 0..1 } else { 0..2 };
        let unit = |axis: usize| (0..if D == 2 { 1 } else { 3 }).map(|k| f64::from(k == axis)).collect::<Vec<f64>>();
        let free = axes.filter(|axis| !statics.is_tilt_locked(number, &unit(*axis))).collect();
        Floating {
            hull,
            body,
            pose: statics.pose(number),
            rho0: self.system.model().rho0,
            level: statics.bodies[number].level,
            free,
            neutral: NEUTRAL * hull.shape.bounds().size().min(),
        }
    }

    /// Returns the tilts of the assembly of body `number` that are not locked, with their metacentric heights.
    fn tilts(&self, statics: &StaticSystem<D>, number: usize) -> Vec<Tilt> {
        let sizes = statics.assembly_of(number).map(|j| statics.bodies[j].hull.shape.bounds().size().min());
        let neutral = NEUTRAL * sizes.fold(0.0, f64::max);
        let flat = |x: f64| if x.abs() < neutral { 0.0 } else { x };
        let gm = |axis: &[f64]| flat(statics.metacentric_height(number, axis));
        let tilt = |axis: Vec<f64>, gm_m: f64| {
            let (inertia, displaced) = statics.inertia_and_displacement(number, &axis);
            let period_s = (gm_m > 0.0).then(|| TAU * (inertia / (displaced * self.g * gm_m)).sqrt());
            Tilt { axis, gm_m, period_s }
        };
        let (x, y) = (vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]);
        let locked = |axis: &[f64]| statics.is_tilt_locked(number, axis);
        if D == 2 {
            return if locked(&[1.0]) { Vec::new() } else { vec![tilt(vec![1.0], gm(&[1.0]))] };
        }
        match [locked(&x), locked(&y)] {
            [true, true] => Vec::new(),
            [false, true] => vec![tilt(x.clone(), gm(&x))],
            [true, false] => vec![tilt(y.clone(), gm(&y))],
            [false, false] => {
                // GM is a tensor in the waterplane; three directions determine its principal axes.
                let (xx, yy, between) = (gm(&x), gm(&y), gm(&[0.5f64.sqrt(), 0.5f64.sqrt(), 0.0]));
                let xy = flat(between - 0.5 * (xx + yy));
                let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
                let (middle, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
                vec![tilt(vec![-sin, cos, 0.0], middle - half), tilt(vec![cos, sin, 0.0], middle + half)]
            }
        }
    }

    /// Adds a finding about a body that floats at the start, with the bodies on its deck, and sinks at its largest mass.
    fn ballast_findings(
        &self,
        i: usize,
        (statics, number): (&Option<StaticSystem<D>>, usize),
        body: &BodySummary,
        findings: &mut Vec<Finding>,
    ) {
        let floats_alone = body.support == "water" && body.tied_to.is_empty() && body.load_kg == 0.0;
        let (Some(largest), Some(statics)) = (body.largest_mass_kg.filter(|_| floats_alone), statics) else { return };
        let others = statics.assembly_of(number).filter(|j| *j != number);
        let largest = largest + others.map(|j| statics.bodies[j].body.mass).sum::<f64>();
        let (pose, rho0) = (&self.solids()[i].kinematics.pose, self.system.model().rho0);
        if hull(self, i).equilibrium_height(pose, largest, rho0, self.draft_level(i)).is_ok() {
            return;
        }
        let what = format!(
            "\"{}\" floats at the start, and sinks at its largest mass, {} kg with its ballast",
            body.name,
            three_digits(largest)
        );
        findings.push(Finding::warning("ballast_sinks", what, "give it less ballast, or make it larger".into()));
    }

    /// Returns a finding about a body without ties that is stable at the start, and unstable later by its ballast.
    fn unstable_ballast(
        &self,
        (statics, number): (&Option<StaticSystem<D>>, usize),
        i: usize,
        body: &BodySummary,
    ) -> Option<Finding> {
        let (statics, afloat) = (statics.as_ref()?, body.afloat.as_ref()?);
        let spec = &self.solids()[i].spec;
        if spec.ballast.is_empty() || !statics.floats_alone(number) || afloat.tilts.iter().any(|t| t.gm_m < 0.0) {
            return None;
        }
        let heights = (0..=BALLAST_TIMES).filter_map(|k| {
            let t = self.plan.until * f64::from(k) / f64::from(BALLAST_TIMES);
            let with_ballast = spec.body_at(t)?;
            let floating = self.floating(statics, number, &with_ballast);
            let height = floating.least_metacentric_height()?;
            (height < -floating.neutral).then_some((t, height))
        });
        let (t, least) = heights.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let what = format!(
            "\"{}\" will turn over by its ballast: its metacentric height falls to {} m at t = {} s",
            body.name,
            three_digits(least),
            three_digits(t)
        );
        Some(Finding::warning("capsizes", what, "give it less ballast, or place it lower".into()))
    }

    /// Returns the effect that carries body `number`: the deck on which it stands, if the water carries that.
    pub(super) fn support(&self, statics: &StaticSystem<D>, number: usize) -> Support {
        match statics.support(number) {
            Support::Water if self.decks[statics.bodies[number].solid].is_some() => Support::Solid,
            support => support,
        }
    }

    /// Returns whether body `number` is the first of its assembly that floats.
    fn is_first_afloat(&self, statics: &StaticSystem<D>, number: usize) -> bool {
        statics.assembly_of(number).find(|j| self.support(statics, *j) == Support::Water) == Some(number)
    }

    /// Adds findings about the equilibrium of a body, of an assembly with its first body. `free`: the rest of what is tied to it.
    fn flotation_findings(
        &self,
        (body, free): (&BodySummary, Option<&FreeAssembly>),
        (statics, number): (&Option<StaticSystem<D>>, usize),
        touches: bool,
        findings: &mut Vec<Finding>,
    ) {
        let Some(statics) = statics else { return };
        if body.support == "floods" {
            let what = format!("\"{}\" floods: at its mass, the still water would stand above its rim", body.name);
            let mend = "make it lighter, or its sides higher".into();
            findings.push(Finding::warning("hull_floods", what, mend));
        }
        let Some(equilibrium) = &body.afloat else { return };
        let all: Vec<usize> = statics.assembly_of(number).collect();
        let (name, its) = self.called(statics, &all);
        let verb = if all.len() == 1 { "s" } else { "" };
        let afloat = |j: &usize| self.support(statics, *j) == Support::Water;
        let is_first = self.is_first_afloat(statics, number);
        let loose = statics.loose_joints(number);
        if let (Some(joint), None, true) = (loose.first(), free, is_first) {
            let what = format!(
                "GM, trim and roll of {name} take joint \"{joint}\"{} as rigid: the motion that it leaves free is not judged",
                if loose.len() > 1 { " and others" } else { "" }
            );
            let mend = "look at that motion in a short run: a mast on a hinge falls though the GM is positive";
            findings.push(Finding::note("loose_joint", what, mend.into()));
        }
        // A body in the air that lies on another does not float.
        let is_carried = touches && body.displaced_kg <= 0.0;
        if let Some(free) = &equilibrium.free_joints {
            let called = self.called(statics, &statics.tied_to(number));
            findings.extend(free_assembly_finding(free, called, &equilibrium.tilts));
        } else if free.is_none() && is_first && !is_carried {
            findings.extend(turn_finding(equilibrium, (statics, number), (&name, verb, its)));
        }
        // A body that rests on another solid need not float at equilibrium.
        let off = body.draft_m - equilibrium.draft_m;
        let first =
            statics.assembly_of(number).filter(afloat).find(|j| statics.rise_together(*j, number)) == Some(number);
        if off.abs() > self.dp() && !touches && first {
            let side = if off > 0.0 { "below" } else { "above" };
            let what = format!(
                "\"{}\" starts {} m, {} dp, {side} its draft of {} m",
                body.name,
                three_digits(off.abs()),
                three_digits(off.abs() / self.dp()),
                three_digits(equilibrium.draft_m)
            );
            let mend = match (all.len(), self.surroundings[statics.bodies[number].solid]) {
                (1, Surroundings::Hull(level)) => {
                    format!("it starts at rest with  bottom = {}", three_digits(level - equilibrium.draft_m))
                }
                (1, _) => "it starts at rest with  draft = \"equilibrium\"".into(),
                _ => {
                    let way = if off > 0.0 { "raise" } else { "lower" };
                    format!("{way} it by so much, and the bodies and joints of its assembly with it")
                }
            };
            findings.push(Finding::note("off_draft", what, mend));
        }
    }

    /// Describes the error in the buoyancy of a thin body. After the correction of parts thinner than dp it is 0.15 dp times their area
    /// (record 147).
    fn thin_buoyancy_error(&self, body: &BodySummary) -> String {
        let model = self.system.model();
        if body.thinnest_dp >= 1.0 - 1e-6 {
            return buoyancy_error(body.thinnest_dp).into();
        }
        let shape = self.solids().iter().find(|solid| solid.spec.name == body.name).map(|solid| &solid.spec.shape);
        let area = shape.map_or(0.0, |shape| 0.5 * shape.surface_area());
        let error = model.rho0 * THIN_ERROR * model.dp * area;
        format!(
            "; where it is thinner than dp its buoyancy errs by up to {THIN_ERROR} dp over the area, {} kg in all of its {} kg",
            three_digits(error),
            three_digits(body.mass_kg)
        )
    }

    /// Returns the names of these bodies, and "its" for one of them or "their".
    pub(super) fn called(&self, statics: &StaticSystem<D>, numbers: &[usize]) -> (String, &'static str) {
        let name = |j: &usize| format!("\"{}\"", self.solids()[statics.bodies[*j].solid].spec.name);
        let names: Vec<String> = numbers.iter().map(name).collect();
        (names.join(" with "), if names.len() == 1 { "its" } else { "their" })
    }

    /// Adds findings about whether the particles can support a body.
    fn resolution_findings(&self, body: &BodySummary, findings: &mut Vec<Finding>) {
        let (model, name) = (self.system.model(), &body.name);
        let density = body.density_ratio * model.rho0;
        let reach = model.support_radius();
        if body.thinnest_m < reach * (1.0 - CHORD_ERROR) {
            let what = format!(
                "\"{name}\" is {} m thin, {} dp, and the kernel reaches {} dp: {}{}{}",
                three_digits(body.thinnest_m),
                three_digits(body.thinnest_dp),
                three_digits(self.support_radius_dp()),
                effect_on_sides::<D>(body.thinnest_dp),
                load_error(body.thinnest_dp),
                self.thin_buoyancy_error(body)
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

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../tests/unit/preflight/floating_bodies.rs"]
mod tests;
