//! Pre-flight: the expected cost of a run of a built scene and its probable faults, reported before the first step. The
//! pre-flight steps, writes and changes nothing.
//!
//! Facts are numbers. A [`Finding`] is a sentence with the number that would correct the fault. A run prints the
//! findings of severity [`Severity::Warning`] at its start.

mod absorption_limits;
mod carried_bodies;
mod lifetimes;
mod misplaced_bodies;
mod moorings;
mod open_boundaries;
mod overlapping_bodies;
mod periodic_sides;
mod floating_bodies;
mod hinged_bodies;
mod hollows;
mod initial_water;
mod surface_samples;
mod surroundings;
mod frame_box;
mod gaps;
mod wavemaker_checks;
mod probe_positions;
mod reynolds;
mod run_size;
mod short_pulses;
mod sound_speed;
mod start_motions;
mod wavemaker_site;
mod driven_motion;
mod driven_paths;
mod expected_errors;
mod face_waves;
mod thickness;
mod thin_parts;
mod turns;
mod generated_waves;

use std::collections::BTreeMap;

use serde::Serialize;

pub use absorption_limits::AbsorberSummary;
pub use face_waves::FaceWave;
pub use floating_bodies::BodySummary;
pub use generated_waves::GeneratedWave;
pub use hinged_bodies::FreeAssembly;
pub use moorings::{MooredSurge, MooringSummary};
pub use reynolds::BodyFlow;
pub use run_size::DiskUse;
pub(crate) use run_size::RunSize;
pub(crate) use sound_speed::{SoundSpeed, StepSizeLimits};

use crate::{
    error::Error,
    math::Bounds,
    plan::Plan,
    scene::{FileNote, InitialWater, RenamedName, StillWaterLevel, basin},
    simulation::Simulation,
    solid::{Role, Solid},
    system::System,
};
use hollows::SolidHollows;
use surface_samples::SurfaceSample;
use surroundings::Surroundings;

/// The default speed in 2-D and 3-D: water particles × force passes per second on one thread. The speed is half the
/// result of `pontoon bench` on a slow machine with the default models.
pub const DEFAULT_SPEED: [f64; 2] = [4e6, 1.2e6];

/// Number of findings of a kind that are listed individually, because many bodies have a finding each.
const MOST: usize = 3;

/// The severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// The results are inaccurate, or the run does not show the intended behaviour.
    Warning,
    /// The finding is useful information and may be intended.
    Note,
}

/// A property of the scene that may be unintended.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Severity of the finding.
    pub severity: Severity,
    /// Identifier of its kind, for programs: `capsizes`, `thin_body`, ...
    pub topic: &'static str,
    /// Description of the fault, with its numbers, as one sentence.
    pub what: String,
    /// The correction, with its number.
    pub mend: String,
}

impl Finding {
    fn warning(topic: &'static str, what: String, mend: String) -> Self {
        Self { severity: Severity::Warning, topic, what, mend }
    }

    fn note(topic: &'static str, what: String, mend: String) -> Self {
        Self { severity: Severity::Note, topic, what, mend }
    }

    /// Creates the finding that the scene writes a key or a value with a former name.
    pub(crate) fn renamed_name(name: &RenamedName) -> Self {
        Self::note("old_name", name.to_string(), format!("write  {}", name.new))
    }

    /// Creates the finding of a note about a file that the scene names.
    fn file_note(note: &FileNote) -> Self {
        let severity = if note.is_warning { Severity::Warning } else { Severity::Note };
        Self { severity, topic: note.topic, what: note.what.clone(), mend: note.remedy.clone() }
    }

    /// Creates the finding that the timing stopped with `error` after `steps` steps.
    pub(crate) fn timing_stopped(error: &Error, steps: usize) -> Self {
        let mend = error.help.clone().unwrap_or_else(|| "see the other findings".into());
        Self::warning("breaks_down", format!("after {steps} steps: {}", error.message), mend)
    }

    /// Returns the finding as one line, for the manifest.
    pub(crate) fn one_line(&self) -> String {
        format!("{}: {}", self.what, self.mend)
    }
}

/// The results of the pre-flight.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Preflight {
    /// Number of particles, memory and disk space.
    pub size: RunSize,
    /// Speed of sound and the expected speeds that it must exceed.
    pub sound: SoundSpeed,
    /// The limits of the time step.
    pub step: StepSizeLimits,
    /// The waves that driven solids make.
    pub waves: Vec<GeneratedWave>,
    /// The waves that enter through faces.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub face_waves: Vec<FaceWave>,
    /// The paddles that absorb incident waves.
    pub absorbers: Vec<AbsorberSummary>,
    /// The free bodies.
    pub bodies: Vec<BodySummary>,
    /// The mooring lines with mass.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moorings: Vec<MooringSummary>,
    /// The surge of the bodies that they hold.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub moored_surge: Vec<MooredSurge>,
    /// The flow about the free and driven bodies.
    pub flows: Vec<BodyFlow>,
    /// The findings, warnings first.
    pub findings: Vec<Finding>,
}

impl Preflight {
    /// Returns the findings to print: the first three of each kind and the number of omitted findings.
    pub fn brief(&self) -> Vec<Finding> {
        let kind = |finding: &Finding| (finding.severity, finding.topic);
        let (mut all, mut seen) = (BTreeMap::new(), BTreeMap::new());
        self.findings.iter().for_each(|finding| *all.entry(kind(finding)).or_insert(0) += 1);
        let mut brief = Vec::new();
        for finding in &self.findings {
            let (all, seen) = (all[&kind(finding)], seen.entry(kind(finding)).or_insert(0));
            *seen += 1;
            // If only a fourth finding remains, it is listed, because a line with the number of omitted findings takes
            // as much space.
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

    /// Returns the pre-flight with findings about the files that the scene names.
    pub(crate) fn with_file_notes(mut self, notes: &[FileNote]) -> Self {
        self.findings.extend(notes.iter().map(Finding::file_note));
        self.findings.sort_by_key(|f| f.severity);
        self
    }

    /// Returns the warnings that a run prints at its start.
    pub fn warnings(&self) -> Vec<String> {
        self.brief().iter().filter(|f| f.severity == Severity::Warning).map(Finding::one_line).collect()
    }
}

/// The data that the pre-flight evaluates.
struct PreflightContext<'a, const D: usize> {
    system: &'a System<D>,
    plan: &'a Plan,
    still_water: StillWaterLevel,
    /// Gravity along the last axis, downward, m/s²; 0 if gravity has another direction, and then nothing floats.
    g: f64,
    /// The outermost layer of each solid; empty for solids that no check evaluates.
    surface_samples: Vec<Vec<SurfaceSample<D>>>,
    /// The space that each solid encloses.
    hollows: Vec<Option<SolidHollows<D>>>,
    /// Boxes around the open bodies of water, up to their levels.
    open_water: Vec<Bounds<D>>,
    /// The number of the body of water in each of these boxes.
    open_numbers: Vec<usize>,
    /// The water around each solid.
    surroundings: Vec<Surroundings>,
    /// The free body on which each free body stands.
    decks: Vec<Option<usize>>,
}

/// Evaluates a simulation before its first step. `columns` is the number of columns that each probe of the plan writes,
/// without the time.
pub fn preflight<const D: usize>(
    sim: &Simulation<D>,
    plan: &Plan,
    initial: InitialWater<D>,
    columns: &[usize],
) -> Preflight {
    let system = sim.system();
    let down = -system.gravity()[D - 1];
    let g = if down > 0.9 * system.gravity().norm() { down } else { 0.0 };
    let (dp, reach) = (system.model().dp, system.model().support_radius());
    let samples = system.solids().iter().map(|s| surface_samples::of_solid(s, dp, reach)).collect();
    let hollow = |(solid, enclosure): (&Solid<D>, Option<_>)| Some(SolidHollows::new(enclosure?, solid, system));
    let hollows = system.solids().iter().zip(initial.enclosures).map(hollow).collect();
    let inside = initial.inside;
    let mut look = PreflightContext {
        system,
        plan,
        still_water: initial.still,
        g,
        surface_samples: samples,
        hollows,
        open_water: initial.boxes,
        open_numbers: initial.box_numbers,
        surroundings: Vec::new(),
        decks: Vec::new(),
    };
    look.surroundings = surroundings::find_surroundings(&look, &inside);
    look.decks = carried_bodies::find_decks(&look);
    let mut findings = Vec::new();
    let sound = look.sound_speed(&mut findings);
    let step = look.step_size_limits(sim.spring_step_limit(), &mut findings);
    let size = look.size(&step, columns, initial.removed_by_solids, &mut findings);
    let gaps = look.gaps(&mut findings);
    hollows::check_hollows(&look, &mut findings);
    hollows::check_own_water(&look, &inside, &mut findings);
    let bodies = look.bodies(&gaps, moorings::moored_ends(&look, sim), &mut findings);
    carried_bodies::check(&look, &gaps.touching, &bodies, &mut findings);
    overlapping_bodies::check(&look, &mut findings);
    hinged_bodies::check(&look, &mut findings);
    start_motions::check(&look, &mut findings);
    look.misplaced_bodies(&gaps.touching, &mut findings);
    look.check_thickness(&mut findings);
    thin_parts::check_parts(&look, &mut findings);
    periodic_sides::check(&look, &mut findings);
    initial_water::check(&look, &mut findings);
    open_boundaries::check(&look, &mut findings);
    look.check_probes(&sound, &mut findings);
    frame_box::check(&look, &mut findings);
    lifetimes::check(&look, &mut findings);
    lifetimes::check_strength(&look, &mut findings);
    driven_paths::check(&look, &mut findings);
    short_pulses::check(&look, &step, &mut findings);
    let (waves, absorbers) = (look.generated_waves(&mut findings), look.absorbers());
    let face_waves = face_waves::face_waves(&look, &mut findings);
    let flows = reynolds::body_flows(&look, &waves, &mut findings);
    let (moorings, moored_surge) = moorings::summaries(&look, sim, &mut findings);
    findings.sort_by_key(|f| f.severity);
    Preflight { size, sound, step, waves, face_waves, absorbers, bodies, moorings, moored_surge, flows, findings }
}

impl<const D: usize> PreflightContext<'_, D> {
    fn dp(&self) -> f64 {
        self.system.model().dp
    }

    /// Returns the radius of the kernel's support over dp.
    fn support_radius_dp(&self) -> f64 {
        self.system.model().support_radius() / self.dp()
    }

    fn solids(&self) -> &[Solid<D>] {
        self.system.solids()
    }

    /// Returns the still level (m) around solid number `i`; `None` if no water is there.
    fn level_around(&self, i: usize) -> Option<f64> {
        match self.surroundings[i] {
            Surroundings::Open(level) | Surroundings::Hull(level) => Some(level),
            Surroundings::Dry => None,
        }
    }

    /// Returns the level (m) from which the draft of solid number `i` is measured: the highest one if no water is there.
    fn draft_level(&self, i: usize) -> f64 {
        self.level_around(i).unwrap_or(self.still_water.level)
    }

    /// Returns the still water of the basin nearest to a solid in the box `own`.
    fn basin(&self, own: &Bounds<D>) -> StillWaterLevel {
        basin(&self.open_water, own).unwrap_or(self.still_water)
    }

    /// Returns the end time (s) of the run.
    fn end_time(&self) -> f64 {
        self.plan.until
    }
}

/// Returns the name of a role as a scene writes it.
pub(crate) fn role_name<const D: usize>(role: &Role<D>) -> &'static str {
    match role {
        Role::Fixed => "fixed",
        Role::Driven(_) => "driven",
        Role::Free(_) => "free",
    }
}
