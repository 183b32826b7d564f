//! Prescribed motions: a slide along a direction or a turn about a hinge, after a table or a formula.
//!
//! Positions and velocities both come from the law itself, never from differences of poses, so that a slow
//! start is as exact as a fast swing. At time t a driven solid is its start pose moved by the law's value
//! at t: a table that starts at a non-zero value starts there.

use crate::{
    error::{Error, Result},
    series::Series,
    solid::{
        Formula, Kinematics,
        wave::{Absorber, Wave, Yielding},
    },
    space::{Pose, Vector, Wedge},
};

/// How a driven coordinate moves in time: a length (m) or an angle (rad) at a time (s).
#[derive(Clone, Debug)]
pub enum Law {
    /// The smooth curve through measured samples; at rest before the first and after the last.
    Table(Series),
    /// A formula.
    Formula(Formula),
    /// A paddle's, that makes a wave of theory.
    Wave(Box<Wave>),
}

impl Law {
    /// The law that is `x` at all times.
    pub fn constant(x: f64) -> Self {
        Self::Formula(Formula::constant(x))
    }

    /// Value (m or rad) and its rate (m/s or rad/s) at time `t` (s).
    pub fn at(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Table(series) => series.smooth(t),
            Self::Formula(formula) => formula.at(t),
            Self::Wave(wave) => wave.at(t),
        }
    }
}

/// A prescribed motion.
#[derive(Clone, Debug)]
pub struct Motion<const D: usize> {
    path: Path<D>,
    law: Law,
    absorbing: Option<Box<Absorbing<D>>>,
}

/// What makes a paddle absorb, and where its gauge is.
#[derive(Clone, Debug)]
struct Absorbing<const D: usize> {
    absorber: Absorber,
    /// The gauge when the paddle is at rest, m.
    gauge: Vector<D>,
    /// Where the waves go; a unit vector.
    way: Vector<D>,
}

#[derive(Clone, Debug)]
enum Path<const D: usize> {
    /// Along a unit vector.
    Slide(Vector<D>),
    /// About a world point, with a unit axis.
    Hinge { centre: Vector<D>, axis: Wedge<D> },
}

impl<const D: usize> Motion<D> {
    /// Sliding along `direction` (any length but zero) by the law's value (m).
    pub fn slide(direction: Vector<D>, law: Law) -> Self {
        Self { path: Path::Slide(direction.normalize()), law, absorbing: None }
    }

    /// Turning about the world point `centre` (m) by the law's angle (rad).
    ///
    /// `axis`: axial components of any length but zero: `[1.0]` in 2-D, where positive angles turn
    /// counter-clockwise (`[-1.0]`: clockwise); the three of the axis in 3-D, right-handed.
    pub fn hinge(centre: Vector<D>, axis: &[f64], law: Law) -> Self {
        let axis = Wedge::<D>::from_axial(axis);
        let length = (0.5 * axis.0.norm_squared()).sqrt();
        Self { path: Path::Hinge { centre, axis: axis * (1.0 / length) }, law, absorbing: None }
    }

    /// The same motion, of a paddle that absorbs: its gauge is above `gauge` (m) when it is at rest, and goes with it along
    /// `way`, a unit vector. Without effect on a law that is no wave's.
    pub fn absorbing(self, absorber: Absorber, gauge: Vector<D>, way: Vector<D>) -> Self {
        Self { absorbing: Some(Box::new(Absorbing { absorber, gauge, way })), ..self }
    }

    /// What makes it absorb, if it does.
    pub fn absorber(&self) -> Option<&Absorber> {
        self.absorbing.as_ref().map(|own| &own.absorber)
    }

    /// Where the gauge of a paddle that absorbs is at time `t` (s); nowhere if it does not.
    pub(crate) fn gauge(&self, yielding: &Yielding, t: f64) -> Option<Vector<D>> {
        let (Some(own), Law::Wave(wave)) = (&self.absorbing, &self.law) else { return None };
        Some(own.gauge + own.way * (wave.displacement(t).0 + yielding.at(t).0))
    }

    /// How it goes on yielding from time `t` (s), when the water at its gauge stands at `level` (m), if there is any.
    pub(crate) fn steer(&self, before: &Yielding, t: f64, level: Option<f64>) -> Yielding {
        match (&self.absorbing, &self.law) {
            (Some(own), Law::Wave(wave)) => own.absorber.steer(wave, before, t, level),
            _ => *before,
        }
    }

    /// Height (m) of the world point about which it turns; none of a slide.
    pub fn hinge_height(&self) -> Option<f64> {
        match &self.path {
            Path::Slide(_) => None,
            Path::Hinge { centre, .. } => Some(centre[D - 1]),
        }
    }

    /// Which way its point that is at `x` (m) goes as the law's value grows, a unit vector; zero on the axis of a hinge.
    pub fn heading(&self, x: &Vector<D>) -> Vector<D> {
        match &self.path {
            Path::Slide(direction) => *direction,
            Path::Hinge { centre, axis } => axis.at(&(x - centre)).try_normalize(0.0).unwrap_or_else(Vector::zeros),
        }
    }

    /// How it goes along its way.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// Where a solid that starts at `start` is at time `t` (s), and how it moves there: exact rates.
    ///
    /// The `centre` of the result is the hinge, or the frame's origin of a sliding solid.
    pub fn kinematics(&self, start: &Pose<D>, t: f64) -> Kinematics<D> {
        self.moved(start, self.law.at(t))
    }

    /// As [`Motion::kinematics`], of a paddle that has yielded.
    pub(crate) fn beside(&self, start: &Pose<D>, t: f64, yielding: &Yielding) -> Kinematics<D> {
        match (&self.absorbing, &self.law) {
            (Some(_), Law::Wave(wave)) => self.moved(start, wave.beside(t, yielding.at(t))),
            _ => self.kinematics(start, t),
        }
    }

    fn moved(&self, start: &Pose<D>, (value, rate): (f64, f64)) -> Kinematics<D> {
        match &self.path {
            Path::Slide(direction) => {
                let position = start.position + direction * value;
                Kinematics {
                    pose: Pose { position, rotation: start.rotation },
                    centre: position,
                    velocity: direction * rate,
                    spin: Wedge::zero(),
                }
            }
            Path::Hinge { centre, axis } => {
                let turn = Pose { position: *centre, rotation: (*axis * value).exp() };
                let arm = Pose { position: start.position - centre, rotation: start.rotation };
                Kinematics { pose: turn.then(&arm), centre: *centre, velocity: Vector::zeros(), spin: *axis * rate }
            }
        }
    }

    /// Whether the motion can be meant.
    ///
    /// # Errors
    /// `Scene` if its direction or axis is zero or not finite, or its law is not finite at time 0.
    pub fn check(&self) -> Result<()> {
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
        let (value, rate) = self.law.at(0.0);
        if !(value.is_finite() && rate.is_finite()) {
            return Err(Error::scene(format!("the law of motion gives {value} at the rate {rate} at t = 0"))
                .help("use a law that is finite and smooth where the run starts"));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formula(text: &str) -> Law {
        Law::Formula(Formula::parse(text).unwrap())
    }

    #[test]
    fn a_slide_starts_where_its_law_says_and_moves_at_its_rate() {
        let table = Series::new([0.0, 0.5, 1.0, 2.0], [0.1, 0.2, 0.15, 0.3]).unwrap();
        let motion = Motion::slide(Vector::from([2.0, 0.0]), Law::Table(table));
        let start = Pose::at(Vector::from([1.0, 1.0]));
        assert_eq!(motion.kinematics(&start, 0.0).pose.position, Vector::from([1.1, 1.0]));
        let (t, step) = (0.8, 1e-6);
        let (a, b) = (motion.kinematics(&start, t - step), motion.kinematics(&start, t + step));
        let difference = (b.pose.position - a.pose.position) / (2.0 * step);
        // Central difference: truncation step² times the third derivative, round-off 1e-16/step.
        assert!((difference - motion.kinematics(&start, t).velocity).norm() < 1e-9);
    }

    #[test]
    fn a_hinge_keeps_its_centre_and_turns_at_its_rate() {
        let centre = Vector::from([0.2, 0.0, -0.1]);
        let motion = Motion::hinge(centre, &[0.0, 3.0, 4.0], formula("0.3*sin(2*t)"));
        let start = Pose::turned(Vector::from([0.2, 0.5, 0.3]), &[0.1, 0.2, 0.3]);
        let (t, step) = (0.6, 1e-6);
        let now = motion.kinematics(&start, t);
        let (a, b) = (motion.kinematics(&start, t - step), motion.kinematics(&start, t + step));
        let local = Vector::from([0.05, -0.4, 0.7]);
        let difference = (b.pose.point(&local) - a.pose.point(&local)) / (2.0 * step);
        let velocity = now.velocity + now.spin.at(&(now.pose.point(&local) - now.centre));
        assert!((difference - velocity).norm() < 1e-9);
        let hinge = start.local(&centre);
        assert!((now.pose.point(&hinge) - centre).norm() < 1e-15);
        // Axis (0, 3, 4)/5, rate 0.6 cos 1.2.
        assert!((now.spin.axial()[2] - 0.8 * 0.6 * 1.2_f64.cos()).abs() < 1e-15);
    }

    #[test]
    fn a_positive_angle_turns_counter_clockwise_in_two_dimensions() {
        let motion = Motion::hinge(Vector::zeros(), &[1.0], formula("t"));
        let now = motion.kinematics(&Pose::at(Vector::from([1.0, 0.0])), 0.5);
        assert!(now.pose.position[1] > 0.4 && now.spin.axial()[0] == 1.0);
    }

    #[test]
    fn a_motion_without_direction_is_refused() {
        assert!(Motion::slide(Vector::<2>::zeros(), formula("t")).check().is_err());
        assert!(Motion::hinge(Vector::<3>::zeros(), &[0.0; 3], formula("t")).check().is_err());
        assert!(Motion::slide(Vector::from([1.0, 0.0]), formula("1/t")).check().is_err());
        assert!(Motion::slide(Vector::from([1.0, 0.0]), formula("t")).check().is_ok());
    }
}
