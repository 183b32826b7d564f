//! Prescribed motions: a slide along a direction or a rotation about a hinge. A law (table, formula or wave) gives its value.
//! Each of several motions acts in the frame that the previous ones moved.
//!
//! Positions and velocities both come from the law itself, never from differences of poses, so that a slow
//! start is as exact as a fast motion. At time t the pose of a driven solid is its start pose, moved by the law's value at t. A
//! non-zero first value displaces the solid from the start.

use crate::{
    error::{Error, Result},
    math::{Bivector, Pose, Vector},
    math::{expression::Formula, time_series::TimeSeries},
    solid::Kinematics,
    wavemaker::{Absorber, AbsorptionState, PaddleMotion},
};

/// A driven coordinate over time: a length (m) or an angle (rad) at a time (s).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum TimeFunction {
    /// The smooth curve through measured samples; at rest before the first and after the last.
    Table(TimeSeries),
    /// A formula.
    Formula(Formula),
    /// The motion of a paddle that generates a wave by theory.
    Wave(Box<PaddleMotion>),
}

impl From<f64> for TimeFunction {
    fn from(x: f64) -> Self {
        Self::constant(x)
    }
}

impl From<Formula> for TimeFunction {
    fn from(formula: Formula) -> Self {
        Self::Formula(formula)
    }
}

impl TimeFunction {
    /// The law that is `x` at all times.
    pub fn constant(x: f64) -> Self {
        Self::Formula(Formula::constant(x))
    }

    /// The value of a law that does not change with time.
    pub(crate) fn steady_value(&self) -> Option<f64> {
        let steady = match self {
            Self::Table(series) => series.values().windows(2).all(|pair| pair[0] == pair[1]),
            Self::Formula(formula) => formula.is_constant(),
            Self::Wave(_) => false,
        };
        steady.then(|| self.value_and_rate(0.0).0)
    }

    /// Value (m or rad) and its rate (m/s or rad/s) at time `t` (s).
    pub fn value_and_rate(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Table(series) => series.value_and_rate(t),
            Self::Formula(formula) => formula.value_and_rate(t),
            Self::Wave(wave) => wave.coordinate_and_rate(t),
        }
    }
}

/// A prescribed motion.
#[derive(Clone, Debug)]
pub struct PrescribedMotion<const D: usize> {
    /// The stages from the ground up; most motions have one.
    stages: Vec<Stage<D>>,
    absorbing: Option<Box<Absorbing<D>>>,
}

/// A path and the value along it.
#[derive(Clone, Debug)]
struct Stage<const D: usize> {
    path: Path<D>,
    law: TimeFunction,
}

/// The absorber of a paddle, and its gauge.
#[derive(Clone, Debug)]
struct Absorbing<const D: usize> {
    absorber: Absorber,
    /// The gauge when the paddle is at rest, m.
    gauge: Vector<D>,
    /// Direction of the waves; a unit vector.
    way: Vector<D>,
}

#[derive(Clone, Debug)]
enum Path<const D: usize> {
    /// Along a unit vector.
    Slide(Vector<D>),
    /// About a world point, with a unit axis.
    Hinge { centre: Vector<D>, axis: Bivector<D> },
}

impl<const D: usize> PrescribedMotion<D> {
    /// Sliding along `direction` (any length but zero) by the law's value (m).
    pub fn slide(direction: Vector<D>, law: TimeFunction) -> Self {
        Self::of(Path::Slide(direction.normalize()), law)
    }

    /// Turning about the world point `centre` (m) by the law's angle (rad).
    ///
    /// `axis`: axial components of any length but zero: `[1.0]` in 2-D, where positive angles turn
    /// counter-clockwise (`[-1.0]`: clockwise); the three of the axis in 3-D, right-handed.
    pub(crate) fn hinge(centre: Vector<D>, axis: &[f64], law: TimeFunction) -> Self {
        let axis = Bivector::<D>::from_axial(axis);
        let length = (0.5 * axis.0.norm_squared()).sqrt();
        Self::of(Path::Hinge { centre, axis: axis * (1.0 / length) }, law)
    }

    fn of(path: Path<D>, law: TimeFunction) -> Self {
        Self { stages: vec![Stage { path, law }], absorbing: None }
    }

    /// Several motions at once, from the ground up. Each takes place in the frame that the motions before it have moved; its
    /// direction or hinge is given in the position in which all motions are zero. A point at x then lies at A₁(t) A₂(t) … Aₙ(t)
    /// x. No motion of a chain may make a wave.
    pub fn chain(motions: impl IntoIterator<Item = Self>) -> Self {
        Self { stages: motions.into_iter().flat_map(|motion| motion.stages).collect(), absorbing: None }
    }

    /// The same motion of an absorbing paddle. Its gauge is above `gauge` (m) when the paddle is at rest, and moves with the
    /// paddle along the unit vector `way`. The call has no effect on a law that makes no wave.
    pub(crate) fn with_absorber(self, absorber: Absorber, gauge: Vector<D>, way: Vector<D>) -> Self {
        Self { absorbing: Some(Box::new(Absorbing { absorber, gauge, way })), ..self }
    }

    /// The absorber, if there is one.
    pub(crate) fn absorber(&self) -> Option<&Absorber> {
        self.absorbing.as_ref().map(|own| &own.absorber)
    }

    /// The wave that it generates, if it is a paddle with a wave by name.
    pub(crate) fn wave(&self) -> Option<&PaddleMotion> {
        match &self.stages[..] {
            [Stage { law: TimeFunction::Wave(wave), .. }] => Some(wave),
            _ => None,
        }
    }

    /// Position of the gauge of an absorbing paddle at time `t` (s); `None` if it does not absorb.
    pub(crate) fn gauge_position(&self, yielding: &AbsorptionState, t: f64) -> Option<Vector<D>> {
        let (own, wave) = (self.absorbing.as_ref()?, self.wave()?);
        Some(own.gauge + own.way * (wave.displacement(t).0 + yielding.offset_and_rate(t).0))
    }

    /// The absorption state from time `t` (s) on, with the water level `level` (m) at its gauge, if there is water.
    pub(crate) fn update_absorption(&self, before: &AbsorptionState, t: f64, level: Option<f64>) -> AbsorptionState {
        match (&self.absorbing, self.wave()) {
            (Some(own), Some(wave)) => own.absorber.update(wave, before, t, level),
            _ => *before,
        }
    }

    /// World point (m) about which it turns; none of a slide, or of several motions.
    pub(crate) fn hinged(&self) -> Option<&Vector<D>> {
        match &self.stages[..] {
            [Stage { path: Path::Hinge { centre, .. }, .. }] => Some(centre),
            _ => None,
        }
    }

    /// Height (m) of the hinge of a single rotation; `None` for a slide or several motions.
    pub(crate) fn hinge_height(&self) -> Option<f64> {
        self.hinged().map(|centre| centre[D - 1])
    }

    /// Whether the motion may move a point along axis number `axis`. A steady stage counts: it may turn the stages above it.
    pub(crate) fn moves_along(&self, axis: usize) -> bool {
        self.stages.iter().any(|stage| stage.law.steady_value().is_none())
            && self.stages.iter().any(|stage| stage.path.leads_along(axis))
    }

    /// Whether it turns a solid at any time.
    pub(crate) fn turns(&self) -> bool {
        let turns = |stage: &Stage<D>| matches!(stage.path, Path::Hinge { .. }) && stage.law.steady_value().is_none();
        self.stages.iter().any(turns)
    }

    /// The directions in which the point at `x` (m) at the start moves as the value of each law grows: unit vectors, from the
    /// ground up; zero on the axis of a hinge.
    pub(crate) fn directions_at(&self, x: &Vector<D>) -> Vec<Vector<D>> {
        let way = |k: usize| {
            let alone = |i: usize, law: &TimeFunction| (law.value_and_rate(0.0).0, if i == k { 1.0 } else { 0.0 });
            let now = self.moved(&Pose::identity(), alone);
            (now.velocity + now.spin.velocity_at(&(x - now.centre))).try_normalize(0.0).unwrap_or_else(Vector::zeros)
        };
        (0..self.stages.len()).map(way).collect()
    }

    /// The kinematics at time `t` (s) of a solid that starts at `start`, with exact rates.
    ///
    /// The `centre` of the result is the hinge if the motion is a single rotation, and otherwise the frame's origin.
    pub fn kinematics(&self, start: &Pose<D>, t: f64) -> Kinematics<D> {
        self.moved(start, |_, law| law.value_and_rate(t))
    }

    /// As [`Motion::kinematics`], of a paddle that has yielded.
    pub(crate) fn kinematics_with_absorption(
        &self,
        start: &Pose<D>,
        t: f64,
        yielding: &AbsorptionState,
    ) -> Kinematics<D> {
        match (&self.absorbing, self.wave()) {
            (Some(_), Some(wave)) => self.moved(start, |_, _| wave.with_offset(t, yielding.offset_and_rate(t))),
            _ => self.kinematics(start, t),
        }
    }

    /// The kinematics of a solid that starts at `start`; `values` returns the value and the rate of the law of each stage.
    fn moved(&self, start: &Pose<D>, values: impl Fn(usize, &TimeFunction) -> (f64, f64)) -> Kinematics<D> {
        let still =
            Kinematics { pose: *start, centre: start.position, velocity: Vector::zeros(), spin: Bivector::zero() };
        let stages = self.stages.iter().enumerate().rev();
        let moved = stages.fold(still, |inner, (i, stage)| stage.path.carry(&inner, values(i, &stage.law)));
        match self.hinged() {
            Some(hinge) => Kinematics { centre: *hinge, velocity: Vector::zeros(), ..moved },
            None => moved,
        }
    }

    /// Checks the motion.
    ///
    /// # Errors
    /// `Scene` if there is no motion, one of several makes a wave, a direction or axis is zero or not finite, or a law is not
    /// finite at t = 0.
    pub fn check(&self) -> Result<()> {
        let several = self.stages.len() > 1;
        if self.stages.is_empty() {
            return Err(Error::scene("its list of motions is empty").help("give one or more, or make the solid fixed"));
        }
        if several && self.stages.iter().any(|stage| matches!(stage.law, TimeFunction::Wave(_))) {
            return Err(Error::scene("one of its several motions makes a wave")
                .help("a paddle that makes waves by name has no other motion beside it"));
        }
        self.stages.iter().enumerate().try_for_each(|(i, stage)| {
            stage.check().map_err(|e| match several {
                true => Error { message: format!("motion {}: {}", i + 1, e.message), ..e },
                false => e,
            })
        })
    }
}

impl<const D: usize> Path<D> {
    /// Whether it leads along axis number `axis`; of a hinge, unless its own axis is that one.
    fn leads_along(&self, axis: usize) -> bool {
        match self {
            Self::Slide(direction) => direction[axis] != 0.0,
            Self::Hinge { axis: own, .. } => own.0.row(axis).iter().any(|x| *x != 0.0),
        }
    }

    /// The kinematics `inner`, with their centre, moved along this path by a value (m or rad) that grows at a rate (m/s or
    /// rad/s).
    fn carry(&self, inner: &Kinematics<D>, (value, rate): (f64, f64)) -> Kinematics<D> {
        match self {
            Self::Slide(direction) => {
                let centre = inner.centre + direction * value;
                let pose = Pose { position: centre, ..inner.pose };
                Kinematics { pose, centre, velocity: inner.velocity + direction * rate, ..*inner }
            }
            Self::Hinge { centre, axis } => {
                let (turn, spin) = ((*axis * value).exp(), *axis * rate);
                let arm = turn * (inner.centre - centre);
                let pose = Pose { position: centre + arm, rotation: turn * inner.pose.rotation };
                Kinematics {
                    pose,
                    centre: pose.position,
                    velocity: turn * inner.velocity + spin.velocity_at(&arm),
                    spin: inner.spin.rotated(&turn) + spin,
                }
            }
        }
    }
}

impl<const D: usize> Stage<D> {
    fn check(&self) -> Result<()> {
        let (fine, what) = match &self.path {
            Path::Slide(direction) => (direction.norm().is_finite(), "direction of its slide"),
            Path::Hinge { centre, axis } => {
                (centre.norm().is_finite() && axis.0.norm().is_finite(), "centre or axis of its hinge")
            }
        };
        if !fine {
            return Err(Error::scene(format!("the {what} is zero or not finite"))
                .help("give finite numbers; a direction and an axis need a length"));
        }
        let (value, rate) = self.law.value_and_rate(0.0);
        if !(value.is_finite() && rate.is_finite()) {
            return Err(Error::scene(format!("the law of motion gives {value} at the rate {rate} at t = 0"))
                .help("use a law that is finite and smooth where the run starts"));
        }
        Ok(())
    }
}

#[cfg(test)]
#[path = "../../tests/unit/solid/prescribed_motion.rs"]
mod tests;
