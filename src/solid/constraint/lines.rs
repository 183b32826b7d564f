//! Lines between two points of solids or of the ground: springs, computed here, and ropes, solved by the engine.
//!
//! A spring of length l pulls with  T = k (l − l₀) + c l̇;  a mooring line (`tension_only`) never pushes. The elastic force is
//! explicit and limits the time step: a mode of frequency ω is stable while Δt ω < 2, and its frequency is too high by the share
//! (Δt ω)²/24. The damping does not: it acts at the rate that it alone would give at the end of the step.
//!
//! In real water a body that oscillates on a spring radiates sound, which damps it with ρ₀ c₀ A/(2 m ω) of the critical damping.
//! Particles carry no sound with ω h/c₀ > 2, and their delayed load would increase such an oscillation. The spring therefore has
//! at least 3 % of the critical damping while an end is wet.

use serde::{Deserialize, Serialize};

use super::{
    jacobian::{ConstraintJacobian, Mobility, kinematics_of_end},
    lifetime::Lifetime,
    reactions::borne,
};
use crate::{
    math::Vector,
    solid::{Engine, Kinematics},
};

/// ω h/c₀ from which on particles do not carry a swing away as sound, –.
const SOUNDLESS: f64 = 2.0;

/// What such a swing has of the critical damping, at least, –.
const CALMED: f64 = 0.03;

/// The end of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineEnd<const D: usize> {
    /// Number of the solid; `None` is the ground.
    pub solid: Option<usize>,
    /// World position of the attachment point at the start, m.
    pub at: Vector<D>,
}

impl<const D: usize> LineEnd<D> {
    /// An end on solid number `solid`, at this world point (m) at the start.
    pub fn on(solid: usize, at: impl Into<Vector<D>>) -> Self {
        Self { solid: Some(solid), at: at.into() }
    }

    /// An end on the ground, at this world point (m).
    pub fn ground(at: impl Into<Vector<D>>) -> Self {
        Self { solid: None, at: at.into() }
    }
}

/// The specification of a spring or a mooring line.
///
/// ```
/// use pontoon::solid::{LineEnd, SpringSpec};
///
/// // A mooring line from solid number 1 to the bottom, 2 kN/m.
/// let ends = [LineEnd::on(1, [2.0, 0.4]), LineEnd::ground([1.0, 0.0])];
/// let line = SpringSpec::<2>::new("line", ends, 2000.0).damping(5.0).tension_only();
/// assert!(line.rest_length.is_none());
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SpringSpec<const D: usize> {
    /// Its name.
    pub name: String,
    /// Its two ends.
    pub ends: [LineEnd<D>; 2],
    /// k, N/m (N/m² in 2-D).
    pub stiffness: f64,
    /// c, N s/m.
    pub damping: f64,
    /// l₀, m; `None`: its length where it begins.
    pub rest_length: Option<f64>,
    /// Whether it goes slack instead of pushing.
    pub tension_only: bool,
    /// When it acts, and the load under which it breaks.
    pub lifetime: Lifetime,
}

impl<const D: usize> SpringSpec<D> {
    /// A spring of `stiffness` (N/m; N/m² in 2-D) without damping, as long as at the start.
    pub fn new(name: impl Into<String>, ends: [LineEnd<D>; 2], stiffness: f64) -> Self {
        Self {
            name: name.into(),
            ends,
            stiffness,
            damping: 0.0,
            rest_length: None,
            tension_only: false,
            lifetime: Lifetime::default(),
        }
    }

    /// The same spring with a damping (N s/m).
    pub fn damping(self, damping: f64) -> Self {
        Self { damping, ..self }
    }

    /// The same spring with this length without tension (m).
    pub fn rest_length(self, length: f64) -> Self {
        Self { rest_length: Some(length), ..self }
    }

    /// The same spring as a mooring line, which goes slack instead of pushing.
    pub fn tension_only(self) -> Self {
        Self { tension_only: true, ..self }
    }

    /// Tension (N) between the places of its ends at the start; negative if it pushes.
    pub(crate) fn start_tension(&self) -> f64 {
        let stretch = start_length(&self.ends) - self.rest_length.unwrap_or_else(|| start_length(&self.ends));
        self.stiffness * if self.tension_only { stretch.max(0.0) } else { stretch }
    }

    /// Whether it breaks in the first step.
    pub(crate) fn breaks_at_start(&self) -> bool {
        self.lifetime.contains(0.0) && self.start_tension() > self.lifetime.strength
    }

    /// The same spring with this lifetime.
    pub fn lifetime(self, lifetime: Lifetime) -> Self {
        Self { lifetime, ..self }
    }
}

/// The specification of a rope, which cannot be stretched.
///
/// ```
/// use pontoon::solid::{LineEnd, RopeSpec};
///
/// let ends = [LineEnd::on(1, [2.0, 0.4]), LineEnd::ground([1.0, 0.0])];
/// let rope = RopeSpec::<2>::new("rope", ends).max_length(1.2);
/// assert_eq!(rope.max_length, Some(1.2));
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RopeSpec<const D: usize> {
    /// Its name.
    pub name: String,
    /// Its two ends.
    pub ends: [LineEnd<D>; 2],
    /// The longest that it can be, m; `None`: its length where it begins.
    pub max_length: Option<f64>,
    /// When it acts, and the load under which it breaks.
    pub lifetime: Lifetime,
}

impl<const D: usize> RopeSpec<D> {
    /// A rope that is taut at the start.
    pub fn new(name: impl Into<String>, ends: [LineEnd<D>; 2]) -> Self {
        Self { name: name.into(), ends, max_length: None, lifetime: Lifetime::default() }
    }

    /// The same rope with this length (m).
    pub fn max_length(self, length: f64) -> Self {
        Self { max_length: Some(length), ..self }
    }

    /// The same rope with this lifetime.
    pub fn lifetime(self, lifetime: Lifetime) -> Self {
        Self { lifetime, ..self }
    }
}

/// Parameters of a spring, which a program may change during a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpringParameters {
    /// k, N/m.
    pub stiffness: f64,
    /// c, N s/m.
    pub damping: f64,
    /// l₀, m.
    pub rest_length: f64,
}

/// A line in a running system.
pub(in crate::solid) struct AttachedLine<const D: usize> {
    solids: [Option<usize>; 2],
    /// Its ends in their solids, m.
    pub(in crate::solid) local_ends: [Vector<D>; 2],
}

impl<const D: usize> AttachedLine<D> {
    /// The line between the starting points of its ends.
    pub(in crate::solid) fn new(ends: &[LineEnd<D>; 2], start: &[Kinematics<D>]) -> Self {
        Self {
            solids: ends.map(|end| end.solid),
            local_ends: ends.map(|end| kinematics_of_end(end.solid, start).pose.local(&end.at)),
        }
    }

    pub(in crate::solid) fn end_kinematics(&self, solids: &[Kinematics<D>]) -> [Kinematics<D>; 2] {
        self.solids.map(|end| kinematics_of_end(end, solids))
    }

    pub(in crate::solid) fn solids(&self) -> [Option<usize>; 2] {
        self.solids
    }

    /// Its length, m, and the row along it; none where it has no length.
    pub(in crate::solid) fn length_and_jacobian(
        &self,
        ends: &[Kinematics<D>; 2],
    ) -> (f64, Option<ConstraintJacobian<D>>) {
        let [a, b] = [0, 1].map(|k| ends[k].pose.point(&self.local_ends[k]));
        let length = (b - a).norm();
        (length, (length > 0.0).then(|| ConstraintJacobian::at_point((b - a) / length, &b, ends)))
    }

    pub(in crate::solid) fn mobility(&self, engine: &dyn Engine<D>) -> [Mobility<D>; 2] {
        self.solids.map(|end| end.map_or_else(Mobility::none, |solid| engine.mobility(solid)))
    }
}

/// State of a spring for which it computes its tension.
pub(in crate::solid) struct SpringInput {
    /// Its length, m.
    pub(in crate::solid) length: f64,
    /// Rate of its length, m/s.
    pub(in crate::solid) rate: f64,
    /// Acceleration of its length by the known loads without its own, m/s².
    pub(in crate::solid) known_acceleration: f64,
    /// Acceleration of its length by the joints, ropes and contacts of the last step, m/s². `None` before the first step: it
    /// opposes all of the known acceleration.
    pub(in crate::solid) reaction: Option<f64>,
    /// Inverse effective mass of its ends, 1/kg.
    pub(in crate::solid) g: f64,
    /// The step, s.
    pub(in crate::solid) dt: f64,
}

impl SpringParameters {
    /// The same parameters for ends in water. `crossing` (s) is the time in which sound crosses a smoothing length, and `g`
    /// (1/kg) is the inverse effective mass of the ends.
    pub(in crate::solid) fn damped_in_water(&self, crossing: f64, g: f64) -> Self {
        let swings = (self.stiffness * g).sqrt() * crossing > SOUNDLESS;
        let calmed = if swings { CALMED * 2.0 * (self.stiffness / g).sqrt() } else { 0.0 };
        Self { damping: self.damping.max(calmed), ..*self }
    }

    /// The tension (N) over a step, in which the damping acts at the rate at the end of the step.
    pub(in crate::solid) fn tension(&self, input: &SpringInput, tension_only: bool) -> f64 {
        let SpringInput { length, rate, known_acceleration, reaction, g, dt } = *input;
        let stretch = length - self.rest_length;
        if tension_only && stretch <= 0.0 {
            return 0.0;
        }
        let known = known_acceleration - g * self.stiffness * stretch;
        let borne = reaction.map_or(-known, |reaction| borne(known, reaction));
        let damped = self.damping * (rate + dt * (known + borne)) / (1.0 + dt * self.damping * g);
        let tension = self.stiffness * stretch + damped;
        if tension_only { tension.max(0.0) } else { tension }
    }

    /// The tension (N) at this length (m) and at this rate of the length (m/s).
    pub(in crate::solid) fn tension_at(&self, [length, rate]: [f64; 2], tension_only: bool) -> f64 {
        let stretch = length - self.rest_length;
        let tension = self.stiffness * stretch + self.damping * rate;
        match tension_only {
            true if stretch <= 0.0 => 0.0,
            true => tension.max(0.0),
            false => tension,
        }
    }

    /// The tension (N) after a step in which it applied the tension `applied` (N) and its length (m) changed from `was` to `is`.
    /// The damping of `applied` is that at the end of the step already; its elastic part is that at the start.
    pub(in crate::solid) fn tension_after(&self, applied: f64, [was, is]: [f64; 2], tension_only: bool) -> f64 {
        let elastic = |length: f64| self.tension_at([length, 0.0], tension_only);
        let tension = applied + (elastic(is) - elastic(was));
        match tension_only {
            true if is <= self.rest_length => 0.0,
            true => tension.max(0.0),
            false => tension,
        }
    }
}

/// Length of a line between the points at which its ends start, m.
pub(in crate::solid) fn start_length<const D: usize>(ends: &[LineEnd<D>; 2]) -> f64 {
    (ends[1].at - ends[0].at).norm()
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/constraint/lines.rs"]
mod tests;
