//! The criteria of a stress case: the measured figures of a run and their bounds. This module only computes numbers.
//!
//! | figure | quantity | reason for a bound |
//! |---|---|---|
//! | `energy` | largest (E(t) − E(0) − W(t)) / scale | only the work W of driven solids, springs, motors, forces and films adds energy |
//! | `walls` | deepest water inside a solid, dp | water inside a solid is passing through its wall |
//! | `bodies` | deepest face of a free body inside another solid, dp | solids do not overlap |
//! | `outside` | water beside or below a tank | the water passed through the wall |
//! | `momentum` | largest ‖P(t) − P(0) − M g t‖ / scale | no external force but gravity acts on a free system |
//! | `quiet` | largest speed over the second half, over √(g depth) | still water stays at rest |
//! | `draft of …` | height error against Archimedes over the second half, dp | weight balances buoyancy |
//! | `… of …` | distance from an exact motion, in its unit | the exact motion is known |

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A bound on a figure, with its reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// The largest figure that passes.
    pub within: f64,
    /// The reason for this bound.
    pub why: String,
}

/// A bound on a figure of a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidBound {
    /// The name of the solid.
    pub solid: String,
    /// The largest figure that passes.
    pub within: f64,
    /// The reason for this bound.
    pub why: String,
}

/// A bound on the distance of a motion from its exact solution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionBound {
    /// The name of the solid.
    pub solid: String,
    /// The name of a column of the motion table, such as `heave_m`.
    pub column: String,
    /// The exact motion, as a formula of the time t (s).
    pub formula: String,
    /// The largest distance that passes, in the unit of the column.
    pub within: f64,
    /// The reason for this bound.
    pub why: String,
}

/// The criteria of a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Criteria {
    /// The spurious energy gain, as a share of the energy scale of the case.
    pub energy: Option<Bound>,
    /// The penetration of water or a body into a solid, dp; water beside or below a tank also fails this criterion.
    pub walls: Option<Bound>,
    /// The speed of water that should stay at rest, over √(g depth).
    pub quiet: Option<Bound>,
    /// The spurious momentum, as a share of the momentum scale.
    pub momentum: Option<Bound>,
    /// The bodies that should float at the draft of Archimedes' principle, with bounds in dp.
    pub draft: Vec<SolidBound>,
    /// The motions with an exact solution.
    pub motion: Vec<MotionBound>,
}

/// The measured figures of a run, by name.
pub(crate) type MeasuredFigures = BTreeMap<String, f64>;

/// The outcome of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseOutcome {
    /// All figures are within their bounds.
    Right,
    /// The program stopped or rejected the case, and reported the reason.
    Stopped,
    /// The time budget ended before the run ended.
    Unfinished,
    /// A figure exceeds its bound, or the program panicked.
    Wrong,
}

impl Criteria {
    /// Returns the name and bound of each criterion.
    pub(crate) fn bounds(&self) -> Vec<(String, f64)> {
        let plain =
            [("energy", &self.energy), ("walls", &self.walls), ("quiet", &self.quiet), ("momentum", &self.momentum)];
        let mut all: Vec<(String, f64)> =
            plain.iter().filter_map(|(name, bound)| Some((name.to_string(), bound.as_ref()?.within))).collect();
        all.extend(self.walls.iter().flat_map(|bound| [("bodies".into(), bound.within), ("outside".into(), 0.0)]));
        all.extend(self.draft.iter().map(|of| (draft_figure(&of.solid), of.within)));
        all.extend(self.motion.iter().map(|course| (motion_figure(course), course.within)));
        all
    }

    /// Returns a key of the figures to measure, without the bounds, so a changed bound does not require a new run.
    pub(crate) fn required_figures(&self) -> String {
        let names: Vec<String> = self.bounds().into_iter().map(|(name, _)| name).collect();
        let formulae: Vec<&str> = self.motion.iter().map(|course| course.formula.as_str()).collect();
        format!("{}; {}", names.join(", "), formulae.join(", "))
    }

    /// Returns a message for each figure of `figures` that exceeds its bound; a missing figure also fails.
    pub(crate) fn missed_bounds(&self, figures: &MeasuredFigures) -> Vec<String> {
        let said = |(name, within): (String, f64)| match figures.get(&name) {
            Some(figure) if *figure <= within => None,
            Some(figure) => Some(format!("{name} {} > {within}", format_figure(*figure))),
            None => Some(format!("{name} not measured")),
        };
        self.bounds().into_iter().filter_map(said).collect()
    }
}

/// Formats a figure for the reader.
fn format_figure(x: f64) -> String {
    if (0.01..1e4).contains(&x.abs()) { format!("{x:.3}") } else { format!("{x:.2e}") }
}

/// Returns the name of the draft figure of `solid`.
pub(crate) fn draft_figure(solid: &str) -> String {
    format!("draft of {solid}")
}

/// Returns the name of the figure of a motion.
pub(crate) fn motion_figure(course: &MotionBound) -> String {
    format!("{} of {}", course.column, course.solid)
}

/// Returns the larger of two figures; a NaN counts as larger than any number and becomes a figure that can be
/// serialised.
pub(crate) fn max_or_invalid(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::MAX } else { a.max(b.min(f64::MAX)) }
}

/// The energies (J; J/m in 2-D) at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Energies {
    /// The kinetic energy.
    pub kinetic: f64,
    /// The potential energy relative to the start.
    pub potential: f64,
    /// The compression energy.
    pub compression: f64,
}

/// The energy balance of a run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EnergyBalance {
    start: f64,
    scale_floor: f64,
    potential_drop: f64,
    work: f64,
    largest_work: f64,
    excess: f64,
}

impl EnergyBalance {
    /// Starts the balance with the energies `first`. `lift` is M g dp, the energy that raises all mass by one particle
    /// spacing.
    ///
    /// The scale is the largest of the initial kinetic and compression energy, the fall of the potential energy, the
    /// work done, and a tenth of `lift`. Positions of bodies and water levels are uncertain by a tenth of dp, so
    /// smaller energies are not significant.
    pub(crate) fn new(first: Energies, lift: f64) -> Self {
        let start = first.kinetic + first.potential + first.compression;
        let floor = (0.1 * lift).max(first.kinetic + first.compression);
        Self { start, scale_floor: floor, potential_drop: 0.0, work: 0.0, largest_work: 0.0, excess: 0.0 }
    }

    /// Adds the work (J) of driven solids, springs, motors, forces and films over a step.
    pub(crate) fn add_work(&mut self, joules: f64) {
        self.work += joules;
        self.largest_work = self.largest_work.max(self.work.abs());
    }

    /// Records the current energies.
    pub(crate) fn update(&mut self, now: Energies) {
        self.potential_drop = self.potential_drop.max(-now.potential);
        self.excess =
            max_or_invalid(self.excess, now.kinetic + now.potential + now.compression - self.start - self.work);
    }

    /// Returns the largest energy excess divided by the scale (–).
    pub(crate) fn relative_excess(&self) -> f64 {
        let scale = self.scale_floor.max(self.potential_drop).max(self.largest_work);
        if self.excess <= 0.0 { 0.0 } else { max_or_invalid(0.0, self.excess / scale) }
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/study/stress/criteria.rs"]
mod tests;
