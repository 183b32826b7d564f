//! The speed of sound compared with the speeds that are known in advance, and the limits of the time step.

use serde::Serialize;

use super::{Finding, PreflightContext, surface_samples};
use crate::{
    math::{
        Vector,
        format::{three_digits, two_digits_down, two_digits_up},
    },
    model::TimeScheme,
    solid::{JointKind, Kinematics, Lifetime, LineEnd, Role},
    sph::boundary::Slip,
    system::driven_speeds,
};

/// Least ratio of the speed of sound to the largest speed. Densities vary by the inverse square of this ratio,
/// here by 1 %.
const TIMES: f64 = 10.0;

/// Distance (dp) below which a body stands on a solid under it.
const STANDING: f64 = 0.1;

/// Largest height of the normal of a face on which a body stands, –.
const DOWNWARD: f64 = -0.9;

/// Largest slope of a level slider, –.
const LEVEL: f64 = 1e-6;

/// Number of times at which the motion of a driven solid is sampled.
const TIMES_SEEN: usize = 1000;

/// Number of points at which a driven solid is sampled.
const PLACES_SEEN: usize = 32;

/// The speed of sound and the expected speeds that it must exceed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SoundSpeed {
    /// Speed of sound c₀, m/s.
    pub c0_mps: f64,
    /// c₀ over √(g·depth), –; absent without gravity.
    pub over_depth: Option<f64>,
    /// Speeds that are known in advance, the largest first.
    pub expected: Vec<ExpectedSpeed>,
}

/// A speed that is known in advance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExpectedSpeed {
    /// Description of the moving object.
    pub what: String,
    /// Speed, m/s.
    pub speed_mps: f64,
}

impl SoundSpeed {
    /// Returns the largest expected speed, m/s, or 0 if no speed is known.
    pub(crate) fn fastest(&self) -> f64 {
        self.expected.first().map_or(0.0, |e| e.speed_mps)
    }
}

/// The limits of the time step, s.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepSizeLimits {
    /// The longest step: the least of the limits below. Impacts shorten it further.
    pub dt_s: f64,
    /// The governing limit: `sound`, `gravity`, `viscosity`, `springs` or `dt_max`.
    pub bound_by: String,
    /// By sound, CFL h/c₀.
    pub sound_s: f64,
    /// By gravity, CFL √(h/g); absent without it.
    pub gravity_s: Option<f64>,
    /// By viscosity, h²/(8 ν₀); absent without one.
    pub viscosity_s: Option<f64>,
    /// By springs and stiff motors; absent without any.
    pub springs_s: Option<f64>,
    /// By the model's `dt_max`; absent without one.
    pub dt_max_s: Option<f64>,
    /// Number of steps to the end with `dt_s`; the run takes somewhat more steps.
    pub steps: f64,
    /// Force passes per step.
    pub passes: usize,
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Returns the speeds that are known in advance: of long waves, the current, driven faces, falling bodies, and water and bodies
    /// at the start.
    pub(super) fn sound_speed(&self, findings: &mut Vec<Finding>) -> SoundSpeed {
        let long = (self.g * self.still_water.depth).sqrt();
        let water = self.system.fluid().v.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let mut expected = vec![("long waves, √(g·depth)".to_string(), long), ("the water at the start".into(), water)];
        let driven = (0..=TIMES_SEEN).flat_map(|k| driven_speeds(self.system, self.time_seen(k)));
        expected.push(("the current".into(), driven.fold(0.0, f64::max)));
        for (i, solid) in self.solids().iter().enumerate() {
            let name = &solid.spec.name;
            match &solid.spec.role {
                Role::Fixed => {}
                Role::Driven(_) => expected.push((format!("\"{name}\", driven"), self.driven_speed(i))),
                Role::Free(_) => expected.push(self.impact_speed(i)),
            }
        }
        expected.retain(|(_, speed)| *speed > 0.0);
        expected.sort_by(|a, b| b.1.total_cmp(&a.1));
        let c0 = self.system.model().c0;
        if let Some((what, speed)) = expected.first()
            && c0 < TIMES * speed * (1.0 - 1e-3)
        {
            let text = format!(
                "the speed of sound, {} m/s, is only {} times that of {what}, {} m/s: the water's \
                 density will vary by {} %",
                three_digits(c0),
                three_digits(c0 / speed),
                three_digits(*speed),
                three_digits(100.0 * (speed / c0).powi(2)),
            );
            let mend = format!("{TIMES} times needs  c0 = {}  in [model]", two_digits_up(TIMES * speed));
            findings.push(Finding::warning("slow_sound", text, mend));
        }
        let over_depth = (long > 0.0).then(|| c0 / long);
        let expected = expected.into_iter().map(|(what, speed_mps)| ExpectedSpeed { what, speed_mps }).collect();
        SoundSpeed { c0_mps: c0, over_depth, expected }
    }

    /// The largest speed (m/s) with which a face of driven solid `i` pushes water below the still level. With free slip, only its
    /// component along the outward normal counts: a receding face pushes no water.
    pub(super) fn driven_speed(&self, i: usize) -> f64 {
        let speed = |k: usize| self.pushing_speed(i, self.time_seen(k), &Vector::zeros());
        (0..=TIMES_SEEN).map(speed).fold(0.0, f64::max)
    }

    /// Time number `k` (s) at which motions are sampled.
    fn time_seen(&self, k: usize) -> f64 {
        self.end_time() * k as f64 / TIMES_SEEN as f64
    }

    /// The largest speed (m/s) at time `t` (s) with which a face of driven solid `i` pushes water of the velocity `water` (m/s) below
    /// the still level.
    pub(super) fn pushing_speed(&self, i: usize, t: f64, water: &Vector<D>) -> f64 {
        let Role::Driven(motion) = &self.solids()[i].spec.role else { return 0.0 };
        let slips = self.system.model().slip == Slip::Free;
        let now = motion.kinematics(&self.solids()[i].spec.pose, t);
        let mut fastest: f64 = 0.0;
        for face in surface_samples::thinned(&self.surface_samples[i], PLACES_SEEN) {
            let x = now.pose.point(&face.x);
            if x[D - 1] <= self.still_water.level {
                let v = now.velocity + now.spin.velocity_at(&(x - now.centre)) - water;
                fastest = fastest.max(if slips { (now.pose.rotation * face.n).dot(&v) } else { v.norm() });
            }
        }
        fastest
    }

    /// The speed (m/s) of free body `i` at the start, or with which it will strike the water, if nothing holds it above.
    fn impact_speed(&self, i: usize) -> (String, f64) {
        let solid = &self.solids()[i];
        let (name, start) = (&solid.spec.name, solid.kinematics.velocity.norm());
        let level = self.level_around(i).filter(|_| self.g > 0.0 && !self.is_carried(i));
        let drop = level.map_or(0.0, |level| self.lowest_point(solid) - level);
        if drop > 0.0 && self.fall_on_joints(i).min(self.fall_on_lines(i)) >= drop {
            let what = format!("\"{name}\" after a fall of {} m", three_digits(drop));
            return (what, (start * start + 2.0 * self.g * drop).sqrt());
        }
        (format!("\"{name}\" at the start"), start)
    }

    /// Whether free body `i` does not fall during the run: it is released later, its height is locked, or it stands on another solid.
    fn is_carried(&self, i: usize) -> bool {
        let Role::Free(body) = &self.solids()[i].spec.role else { return false };
        let mut holds = self.system.constraints().holds.iter();
        let is_held = holds.any(|hold| hold.solid == i && hold.until >= self.end_time());
        is_held || body.locked_translations[D - 1] || self.decks[i].is_some() || self.is_on_solids(i)
    }

    /// Whether solids that are fixed or driven carry free body `i` to the end: they touch it from below, on both sides of its centre of
    /// mass.
    fn is_on_solids(&self, i: usize) -> bool {
        let Kinematics { pose, centre, .. } = &self.solids()[i].kinematics;
        let below = self.surface_samples[i].iter().filter(|face| (pose.rotation * face.n)[D - 1] < DOWNWARD);
        let carriers = || (0..self.solids().len()).filter(|j| self.is_firm(*j)).map(|j| &self.solids()[j]);
        let touches = |x: &Vector<D>| carriers().any(|solid| solid.distance(x) < STANDING * self.dp());
        let touched: Vec<Vector<D>> = below.map(|face| pose.point(&face.x)).filter(touches).collect();
        let has = |axis: usize, sense: f64| touched.iter().any(|x| sense * (x[axis] - centre[axis]) >= 0.0);
        (0..D - 1).all(|axis| has(axis, 1.0) && has(axis, -1.0))
    }

    /// Whether solid `i` is not free, and stays to the end.
    fn is_firm(&self, i: usize) -> bool {
        let mut removals = self.system.constraints().removals.iter();
        let is_removed = removals.any(|removal| removal.solid == i && removal.at < self.end_time());
        !is_removed && !matches!(self.solids()[i].spec.role, Role::Free(_))
    }

    /// Whether a constraint with these ends holds free body `i` from the start to the end, at something that is not free, under its
    /// weight.
    fn holds(&self, i: usize, lifetime: &Lifetime, ends: [Option<usize>; 2]) -> bool {
        let other = if ends[0] == Some(i) { ends[1] } else { ends[0] };
        let lasts = lifetime.contains(0.0) && lifetime.until >= self.end_time() && lifetime.strength > self.weight(i);
        lasts && ends.contains(&Some(i)) && other.is_none_or(|j| self.is_firm(j))
    }

    /// The weight of free body `i`, N (N/m in 2-D).
    fn weight(&self, i: usize) -> f64 {
        self.g * self.solids()[i].body.map_or(0.0, |body| body.mass)
    }

    /// The depth (m) to which free body `i` falls on the joints that hold it; ∞ without any.
    fn fall_on_joints(&self, i: usize) -> f64 {
        let solid = &self.solids()[i];
        let (lowest, pose) = (self.lowest_point(solid), &solid.kinematics.pose);
        let corners: Vec<Vector<D>> = solid.spec.shape.bounds().corners().map(|x| pose.point(&x)).collect();
        let joints = self.system.constraints().joints.iter();
        let joints = joints.filter(|joint| self.holds(i, &joint.lifetime, joint.between));
        let depth = joints.map(|joint| match joint.kind {
            JointKind::Fixed => 0.0,
            JointKind::Slider if joint.axis.normalize()[D - 1].abs() < LEVEL => 0.0,
            // The farthest corner falls to the lowest point of its circle.
            JointKind::Hinge | JointKind::Ball => {
                let reach = corners.iter().map(|x| (x - joint.at).norm()).fold(0.0, f64::max);
                reach + lowest - joint.at[D - 1]
            }
            _ => f64::INFINITY,
        });
        depth.fold(f64::INFINITY, f64::min)
    }

    /// The depth (m) to which free body `i` falls on the springs, ropes and mooring lines that hold it, as if each hung straight down
    /// from a support that is not free; ∞ without any.
    fn fall_on_lines(&self, i: usize) -> f64 {
        let links = self.system.constraints();
        let acts = |lifetime: &Lifetime, ends: &[LineEnd<D>; 2]| self.holds(i, lifetime, ends.map(|end| end.solid));
        let distance = |ends: &[LineEnd<D>; 2]| (ends[1].at - ends[0].at).norm();
        let springs = links.springs.iter().filter(|spring| acts(&spring.lifetime, &spring.ends)).map(|spring| {
            let start = distance(&spring.ends);
            let stretch = start - spring.rest_length.unwrap_or(start);
            // From rest it swings about its equilibrium.
            2.0 * (self.weight(i) / spring.stiffness - stretch).max(0.0)
        });
        let ropes = links.ropes.iter().filter(|rope| acts(&rope.lifetime, &rope.ends)).map(|rope| {
            let start = distance(&rope.ends);
            rope.max_length.unwrap_or(start) - start
        });
        let moorings = links.moorings.iter().filter(|line| acts(&line.lifetime, &line.ends));
        let moorings = moorings.map(|line| line.length - distance(&line.ends));
        springs.chain(ropes).chain(moorings).fold(f64::INFINITY, f64::min)
    }

    /// Returns the limits of the time step; `springs` (s) is the limit by springs and motors.
    pub(super) fn step_size_limits(&self, springs: f64, findings: &mut Vec<Finding>) -> StepSizeLimits {
        let model = self.system.model();
        let finite = |x: f64| (x > 0.0 && x.is_finite()).then_some(x);
        let sound_s = model.cfl * model.h / model.c0;
        let gravity_s = finite(model.cfl * (model.h / self.system.gravity().norm()).sqrt());
        let (viscosity_s, dt_max_s) = (finite(model.viscosity.step_limit(model.h)), finite(model.dt_max));
        let springs_s = finite(springs);
        let others = [("gravity", gravity_s), ("viscosity", viscosity_s), ("springs", springs_s), ("dt_max", dt_max_s)];
        let mut all = vec![("sound".to_string(), sound_s)];
        all.extend(others.into_iter().filter_map(|(what, dt)| Some((what.to_string(), dt?))));
        let (bound_by, dt_s) =
            all.into_iter().fold((String::new(), f64::INFINITY), |least, x| if x.1 < least.1 { x } else { least });
        let slower = sound_s / dt_s;
        if bound_by == "springs" && slower > 2.0 {
            let what = format!(
                "springs or motors are so stiff that the run takes {} times as many steps",
                three_digits(slower)
            );
            // Particles cannot carry sound of so high a frequency: docs/explanation/stability.md.
            let damped =
                "in water a spring whose body swings as fast has a hundredth of the critical damping, 2 √(k m)";
            let soft = two_digits_down(slower.powi(-2));
            let mend = format!("{soft} of the stiffness is soft enough; a rope costs no steps; {damped}");
            findings.push(Finding::warning("stiff_spring", what, mend));
        }
        let passes = if matches!(model.scheme, TimeScheme::Verlet { .. }) { 1 } else { 2 };
        let steps = (self.end_time() / dt_s).ceil();
        StepSizeLimits { dt_s, bound_by, sound_s, gravity_s, viscosity_s, springs_s, dt_max_s, steps, passes }
    }
}
