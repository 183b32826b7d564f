//! The time in which a constraint acts, the load at which it breaks, and the record of such events.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, ErrorCode, Result},
    math::Pose,
};

/// Round-off of a time of the run, relative.
const TIME_SLACK: f64 = 1e-12;

/// The time in which a constraint acts, and the loads at which it breaks.
///
/// ```
/// use pontoon::solid::Lifetime;
///
/// let line = Lifetime::default().until(4.0).strength(300.0);
/// assert_eq!((line.since, line.until, line.strength), (0.0, 4.0, 300.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Lifetime {
    /// Time from which it acts, s.
    pub since: f64,
    /// Time at which it ends, s; infinite if it does not.
    pub until: f64,
    /// Tension of a line or force of a joint at which it breaks, N (N/m in 2-D); infinite if it does not.
    pub strength: f64,
    /// Torque of a joint at which it breaks, N m (N m/m in 2-D); infinite if it does not.
    pub torque_strength: f64,
}

impl Default for Lifetime {
    /// The whole run, unbreakable.
    fn default() -> Self {
        Self { since: 0.0, until: f64::INFINITY, strength: f64::INFINITY, torque_strength: f64::INFINITY }
    }
}

impl Lifetime {
    /// The same lifetime from this time (s) on.
    pub fn since(self, since: f64) -> Self {
        Self { since, ..self }
    }

    /// The same lifetime, which ends at this time (s).
    pub fn until(self, until: f64) -> Self {
        Self { until, ..self }
    }

    /// The same lifetime, which ends under this tension or force (N; N/m in 2-D).
    pub fn strength(self, strength: f64) -> Self {
        Self { strength, ..self }
    }

    /// The same lifetime, which ends under this torque (N m; N m/m in 2-D).
    pub fn torque_strength(self, torque_strength: f64) -> Self {
        Self { torque_strength, ..self }
    }

    /// Whether time `t` (s) lies within it, with room for round-off.
    pub(crate) fn contains(&self, t: f64) -> bool {
        self.has_begun(t) && !self.is_over(t)
    }

    /// Whether it has begun at time `t` (s), with room for round-off.
    pub(in crate::solid) fn has_begun(&self, t: f64) -> bool {
        t >= self.since * (1.0 - TIME_SLACK)
    }

    /// Whether it is over at time `t` (s), with room for round-off.
    pub(crate) fn is_over(&self, t: f64) -> bool {
        t >= self.until * (1.0 - TIME_SLACK)
    }

    /// Time (s) from `t` (s) to its next limit; infinite if there is none.
    pub(crate) fn next_limit(&self, t: f64) -> f64 {
        match (self.has_begun(t), self.is_over(t)) {
            (_, true) => f64::INFINITY,
            (true, false) => self.until - t,
            (false, false) => self.since - t,
        }
    }

    /// Whether both act at some time.
    pub(in crate::solid) fn overlaps(&self, other: &Self) -> bool {
        self.since < other.until && other.since < self.until
    }

    /// Refuses a lifetime without duration, and a strength that is not positive.
    ///
    /// # Errors
    /// `Scene`: names the constraint `who` and the range.
    pub(in crate::solid) fn check(&self, who: &str) -> Result<()> {
        let refuse = |what: String, help: &str| {
            Err(Error::scene(format!("{who} {what}")).with_code(ErrorCode::OutOfRange).help(help))
        };
        if !(self.since >= 0.0 && self.since.is_finite() && self.until > self.since) {
            let what = format!("acts from {} s to {} s", self.since, self.until);
            return refuse(what, "it begins at 0 or later, and ends after it begins");
        }
        if !(self.strength > 0.0 && self.torque_strength > 0.0) {
            return refuse("breaks under no load".into(), "it breaks under a load above 0");
        }
        Ok(())
    }
}

/// The phase of a constraint in its lifetime.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::solid) enum Phase {
    /// It does not act yet.
    Waiting,
    /// It acts.
    Acting,
    /// It acts no more.
    Ended,
}

impl Phase {
    /// The phase at the start of a run.
    pub(in crate::solid) fn at_start(lifetime: &Lifetime) -> Self {
        if lifetime.has_begun(0.0) { Self::Acting } else { Self::Waiting }
    }

    /// The phase in the step that begins at time `t` (s).
    pub(in crate::solid) fn at(self, lifetime: &Lifetime, t: f64) -> Self {
        match self {
            Self::Ended => Self::Ended,
            _ if lifetime.is_over(t) => Self::Ended,
            Self::Waiting if !lifetime.has_begun(t) => Self::Waiting,
            Self::Waiting | Self::Acting => Self::Acting,
        }
    }
}

/// The phases of all constraints, and their changes: part of a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::solid) struct Phases<const D: usize> {
    pub(in crate::solid) joints: Vec<Phase>,
    pub(in crate::solid) springs: Vec<Phase>,
    pub(in crate::solid) ropes: Vec<Phase>,
    /// Frames in their solids of the joints that were connected during the run.
    pub(in crate::solid) joint_frames: Vec<Option<[Pose<D>; 2]>>,
    /// Lengths of the ropes that were connected during the run, m.
    pub(in crate::solid) rope_lengths: Vec<Option<f64>>,
    pub(in crate::solid) events: Vec<ConstraintEvent>,
}

/// The beginning or the end of a constraint, or of a solid, during a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConstraintEvent {
    /// Time, s.
    pub time: f64,
    /// Kind and name of the element, such as `spring "line"`.
    pub element: String,
    /// The change.
    pub change: ConstraintChange,
    /// Whether its load is that of a metre of width, as in 2-D.
    pub per_metre: bool,
}

/// A change of a constraint or a solid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ConstraintChange {
    /// It begins to act.
    Connected,
    /// A rope begins to act between ends that are farther apart than its given length (m).
    Lengthened {
        /// Length that it was given, m.
        given: f64,
        /// Distance of its ends, its length from now on, m.
        length: f64,
    },
    /// Its time is over.
    Released,
    /// It broke under this tension or force, N (N/m in 2-D).
    Broken(f64),
    /// It broke under this torque, N m (N m/m in 2-D).
    BrokenByTorque(f64),
    /// The solid was removed.
    Removed,
}

/// Time (s) at which `element`, such as `spring "line"`, ended or broke, as the texts of `events` say.
#[cfg(feature = "cli")]
pub(crate) fn end_in_events(events: &[String], element: &str) -> Option<f64> {
    let end = |event: &String| {
        let told = event.strip_prefix(element)?;
        let told = told.strip_prefix(" breaks at t = ").or_else(|| told.strip_prefix(" is released at t = "))?;
        told.split(' ').next()?.parse().ok()
    };
    events.iter().find_map(end)
}

impl fmt::Display for ConstraintEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, element, change, .. } = self;
        let per_metre = if self.per_metre { "/m" } else { "" };
        match change {
            ConstraintChange::Connected => write!(f, "{element} is connected at t = {time:.6} s"),
            ConstraintChange::Lengthened { given, length } => write!(
                f,
                "{element} is connected at t = {time:.6} s: its ends are {length:.6} m apart, and {length:.6} m is its \
                 length in place of {given} m"
            ),
            ConstraintChange::Released => write!(f, "{element} is released at t = {time:.6} s"),
            ConstraintChange::Broken(load) => {
                write!(f, "{element} breaks at t = {time:.6} s under {load:.6} N{per_metre}")
            }
            ConstraintChange::BrokenByTorque(load) => {
                write!(f, "{element} breaks at t = {time:.6} s under {load:.6} N m{per_metre}")
            }
            ConstraintChange::Removed => write!(f, "{element} is removed at t = {time:.6} s"),
        }
    }
}
