//! What a case is judged by: figures of its physics against bounds. Pure numbers.
//!
//! | figure | what | why it must be small |
//! |---|---|---|
//! | `energy` | (E(t) − E(0) − W(t)) / scale, the most | nothing makes energy but the work W of driven solids, springs, motors and forces |
//! | `walls` | deepest water inside a solid, dp | what is there is on its way through |
//! | `bodies` | deepest face of a free body inside another solid, dp | the same |
//! | `outside` | water beside or below a tank | it went through |
//! | `momentum` | ‖P(t) − P(0) − M g t‖ / scale, the most | nothing outside acts on a free system |
//! | `quiet` | largest speed over the second half, over √(g depth) | still water stays still |
//! | `draft of …` | height off Archimedes' over the second half, dp | weight and buoyancy balance |
//! | `… of …` | distance from an exact motion, in its unit | it is known |

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A bound and its reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// The largest figure that passes.
    pub within: f64,
    /// Why so much and no more.
    pub why: String,
}

/// A bound on something of a solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidBound {
    /// The solid's name.
    pub solid: String,
    /// The largest figure that passes.
    pub within: f64,
    /// Why so much and no more.
    pub why: String,
}

/// A motion that is known exactly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionBound {
    /// The solid's name.
    pub solid: String,
    /// A column of its motion, as in `heave_m`.
    pub column: String,
    /// What it should be: a formula of the time t (s).
    pub formula: String,
    /// The largest distance that passes, in the column's unit.
    pub within: f64,
    /// Why so much and no more.
    pub why: String,
}

/// What a case is judged by.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Criteria {
    /// Energy made of nothing, as a share of the case's energy scale.
    pub energy: Option<Bound>,
    /// Depth of water or a body inside a solid, dp; no water may be beside or below a tank.
    pub walls: Option<Bound>,
    /// Speed of water that should be still, over √(g depth).
    pub quiet: Option<Bound>,
    /// Momentum made of nothing, as a share of what moves.
    pub momentum: Option<Bound>,
    /// Bodies that should float at Archimedes' draft, dp.
    pub draft: Vec<SolidBound>,
    /// Motions that are known.
    pub motion: Vec<MotionBound>,
}

/// What was measured of a run, by name.
pub(crate) type MeasuredFigures = BTreeMap<String, f64>;

/// How a case came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CaseOutcome {
    /// All figures are within their bounds.
    Right,
    /// The program stopped or refused, and said why.
    Stopped,
    /// The budget was used up before the end.
    Unfinished,
    /// A figure misses its bound, or the program panicked.
    Wrong,
}

impl Criteria {
    /// Names and bounds of all that is asked.
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

    /// What must be measured, whatever the bounds are: a run need not be made again for another bound.
    pub(crate) fn required_figures(&self) -> String {
        let names: Vec<String> = self.bounds().into_iter().map(|(name, _)| name).collect();
        let formulae: Vec<&str> = self.motion.iter().map(|course| course.formula.as_str()).collect();
        format!("{}; {}", names.join(", "), formulae.join(", "))
    }

    /// What of `figures` misses its bound, in words; a figure that is not there misses it.
    pub(crate) fn missed_bounds(&self, figures: &MeasuredFigures) -> Vec<String> {
        let said = |(name, within): (String, f64)| match figures.get(&name) {
            Some(figure) if *figure <= within => None,
            Some(figure) => Some(format!("{name} {} > {within}", format_figure(*figure))),
            None => Some(format!("{name} not measured")),
        };
        self.bounds().into_iter().filter_map(said).collect()
    }
}

/// A figure as it is read.
fn format_figure(x: f64) -> String {
    if (0.01..1e4).contains(&x.abs()) { format!("{x:.3}") } else { format!("{x:.2e}") }
}

/// The name of the figure of a draft.
pub(crate) fn draft_figure(solid: &str) -> String {
    format!("draft of {solid}")
}

/// The name of the figure of a motion.
pub(crate) fn motion_figure(course: &MotionBound) -> String {
    format!("{} of {}", course.column, course.solid)
}

/// The larger of two figures; one that is not a number is larger than any, and still can be written down.
pub(crate) fn max_or_invalid(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::MAX } else { a.max(b.min(f64::MAX)) }
}

/// Energies (J; J/m in 2-D) at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Energies {
    /// Of motion.
    pub kinetic: f64,
    /// Of height, since the start.
    pub potential: f64,
    /// Of compression.
    pub compression: f64,
}

/// The books of a run's energy.
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
    /// Opens them at the start with `first`. `lift` is M g dp: what lifts everything by one particle.
    ///
    /// The scale is the largest of the motion and compression at the start, the fall of the potential, the work done, and a
    /// tenth of `lift`: bodies and levels are not known better than to a tenth of dp, so less energy than that means nothing.
    pub(crate) fn new(first: Energies, lift: f64) -> Self {
        let start = first.kinetic + first.potential + first.compression;
        let floor = (0.1 * lift).max(first.kinetic + first.compression);
        Self { start, scale_floor: floor, potential_drop: 0.0, work: 0.0, largest_work: 0.0, excess: 0.0 }
    }

    /// Enters the work (J) of driven solids, springs, motors and forces over a step.
    pub(crate) fn add_work(&mut self, joules: f64) {
        self.work += joules;
        self.largest_work = self.largest_work.max(self.work.abs());
    }

    /// Enters the energies now.
    pub(crate) fn update(&mut self, now: Energies) {
        self.potential_drop = self.potential_drop.max(-now.potential);
        self.excess =
            max_or_invalid(self.excess, now.kinetic + now.potential + now.compression - self.start - self.work);
    }

    /// The largest excess over the scale (–).
    pub(crate) fn relative_excess(&self) -> f64 {
        let scale = self.scale_floor.max(self.potential_drop).max(self.largest_work);
        if self.excess <= 0.0 { 0.0 } else { max_or_invalid(0.0, self.excess / scale) }
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/study/stress/criteria.rs"]
mod tests;
