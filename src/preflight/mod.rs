//! Pre-flight: what a run of a built scene will cost and what looks wrong with it, told before its first step. Nothing
//! is stepped, written or changed.
//!
//! Facts are numbers; a [`Finding`] is a sentence with the number that would mend it. What a run prints at its start
//! are the findings that are warnings.

mod absorption_limits;
mod misplaced_bodies;
mod floating_bodies;
mod surface_samples;
mod gaps;
mod wavemaker_checks;
mod probe_positions;
mod run_size;
mod sound_speed;
mod wavemaker_site;
mod driven_motion;
mod thickness;
mod generated_waves;

use std::collections::BTreeMap;

use serde::Serialize;

pub use absorption_limits::AbsorberSummary;
pub use floating_bodies::BodySummary;
pub use generated_waves::GeneratedWave;
pub use run_size::DiskUse;
pub(crate) use run_size::RunSize;
pub(crate) use sound_speed::{SoundSpeed, StepSizeLimits};

use crate::{
    error::Error,
    plan::Plan,
    scene::{RenamedName, StillWaterLevel},
    simulation::Simulation,
    solid::{Role, Solid},
    system::System,
};
use surface_samples::SurfaceSample;

/// So many findings of a kind are read one by one: a crowd of bodies has one for each.
const MOST: usize = 3;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The results will suffer, or the run will not show what it is meant to.
    Warning,
    /// Worth knowing; it may well be meant.
    Note,
}

/// Something that may not be as it was meant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Its kind, for programs: `capsizes`, `thin_body`, ...
    pub topic: &'static str,
    /// What is wrong, with its numbers, as one sentence.
    pub what: String,
    /// What would mend it, with the number.
    pub mend: String,
}

impl Finding {
    fn warning(topic: &'static str, what: String, mend: String) -> Self {
        Self { severity: Severity::Warning, topic, what, mend }
    }

    fn note(topic: &'static str, what: String, mend: String) -> Self {
        Self { severity: Severity::Note, topic, what, mend }
    }

    /// That the scene writes a key or a value with an old name.
    pub(crate) fn renamed_name(name: &RenamedName) -> Self {
        Self::note("old_name", name.to_string(), format!("write  {}", name.new))
    }

    /// That the timing stopped with `error` after so many `steps`.
    pub(crate) fn timing_stopped(error: &Error, steps: usize) -> Self {
        let mend = error.help.clone().unwrap_or_else(|| "see the other findings".into());
        Self::warning("breaks_down", format!("after {steps} steps: {}", error.message), mend)
    }

    /// The finding in one line, for a record.
    pub(crate) fn one_line(&self) -> String {
        format!("{}: {}", self.what, self.mend)
    }
}

/// What is known before the first step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Preflight {
    /// Particles, memory, disk.
    pub size: RunSize,
    /// Speed of sound and the speeds that it must outrun.
    pub sound: SoundSpeed,
    /// How long a step may be, and why.
    pub step: StepSizeLimits,
    /// Waves that driven solids make.
    pub waves: Vec<GeneratedWave>,
    /// Paddles that take the waves which come to them.
    pub absorbers: Vec<AbsorberSummary>,
    /// Free bodies.
    pub bodies: Vec<BodySummary>,
    /// What may not be as it was meant; warnings first.
    pub findings: Vec<Finding>,
}

impl Preflight {
    /// The findings to read: of a kind the first three, and how many more there are.
    pub fn brief(&self) -> Vec<Finding> {
        let kind = |finding: &Finding| (finding.severity, finding.topic);
        let (mut all, mut seen) = (BTreeMap::new(), BTreeMap::new());
        self.findings.iter().for_each(|finding| *all.entry(kind(finding)).or_insert(0) += 1);
        let mut brief = Vec::new();
        for finding in &self.findings {
            let (all, seen) = (all[&kind(finding)], seen.entry(kind(finding)).or_insert(0));
            *seen += 1;
            // A fourth and last one takes no more room than to say that there is one.
            if *seen <= MOST || all == MOST + 1 {
                brief.push(finding.clone());
            } else if *seen == MOST + 1 {
                let what = format!("{} more of this kind ({})", all - MOST, finding.topic);
                let mend = "`pontoon inspect SCENE --json` has them all".into();
                brief.push(Finding { what, mend, ..finding.clone() });
            }
        }
        brief
    }

    /// The findings that a run tells at its start.
    pub fn warnings(&self) -> Vec<String> {
        self.brief().iter().filter(|f| f.severity == Severity::Warning).map(Finding::one_line).collect()
    }
}

/// What a look at a simulation's start rests on.
struct PreflightContext<'a, const D: usize> {
    system: &'a System<D>,
    plan: &'a Plan,
    still_water: StillWaterLevel,
    /// Gravity down the last axis, m/s²; 0 if it points elsewhere, and then nothing floats.
    g: f64,
    /// The outermost layer of each solid; empty where nobody asks.
    surface_samples: Vec<Vec<SurfaceSample<D>>>,
}

/// Looks at a simulation before its first step. `columns`: how many columns each of the plan's probes writes beside the
/// time; `overlapped`: places of the water's lattice that solids took.
pub fn preflight<const D: usize>(
    sim: &Simulation<D>,
    plan: &Plan,
    still: StillWaterLevel,
    overlapped: usize,
    columns: &[usize],
) -> Preflight {
    let system = sim.system();
    let down = -system.gravity()[D - 1];
    let g = if down > 0.9 * system.gravity().norm() { down } else { 0.0 };
    let samples = system.solids().iter().map(|s| surface_samples::of_solid(s, system.model().dp)).collect();
    let look = PreflightContext { system, plan, still_water: still, g, surface_samples: samples };
    let mut findings = Vec::new();
    let sound = look.sound_speed(&mut findings);
    let step = look.step_size_limits(sim.spring_step_limit(), &mut findings);
    let size = look.size(&step, columns, overlapped, &mut findings);
    let gaps = look.gaps(&mut findings);
    let bodies = look.bodies(&gaps.touching, &mut findings);
    look.misplaced_bodies(&gaps.touching, &mut findings);
    look.check_thickness(&mut findings);
    look.check_probes(&sound, &mut findings);
    let (waves, absorbers) = (look.generated_waves(&mut findings), look.absorbers());
    findings.sort_by_key(|f| f.severity);
    Preflight { size, sound, step, waves, absorbers, bodies, findings }
}

impl<const D: usize> PreflightContext<'_, D> {
    fn dp(&self) -> f64 {
        self.system.model().dp
    }

    /// The kernel's support over dp.
    fn support_radius_dp(&self) -> f64 {
        self.system.model().support_radius() / self.dp()
    }

    fn solids(&self) -> &[Solid<D>] {
        self.system.solids()
    }

    /// How long (s) a run is.
    fn end_time(&self) -> f64 {
        self.plan.until
    }
}

/// What moves a solid, in a word of the scene.
pub(crate) fn role_name<const D: usize>(role: &Role<D>) -> &'static str {
    match role {
        Role::Fixed => "fixed",
        Role::Driven(_) => "driven",
        Role::Free(_) => "free",
    }
}
