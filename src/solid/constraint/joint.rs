//! Joints: locked modes between two solids, the free coordinate of a hinge or a slider, and end stops. The engine solves the
//! locks; the motor on the coordinate is computed in `motor`.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::{
    jacobian::{ConstraintJacobian, Mobility, kinematics_of_end, orthogonalize},
    lifetime::Lifetime,
    motor::{Motor, MotorCommand, MotorInput},
};
use crate::{
    math::{Bivector, Matrix, Pose, Vector},
    solid::{Engine, Kinematics},
};

/// The free motion of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum JointKind {
    /// Rotation about an axis.
    Hinge,
    /// Moving along a line.
    Slider,
    /// Nothing.
    Fixed,
    /// Rotation about all axes; 3-D.
    Ball,
    /// All but moving along a line: the second solid is towed along it.
    Tow,
    /// The modes in its list.
    Generic,
}

/// A mode of motion that a generic joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMode {
    /// Its number: 0 to D − 1 for translations along the axes of the joint's frame, from D on for rotations about them; in 2-D
    /// the rotation is 2.
    pub mode: usize,
    /// Least and greatest value of its coordinate, m or rad; 0 is where it starts.
    pub limits: Option<[f64; 2]>,
}

/// Number of modes of motion of a pair of solids.
pub(crate) const fn mode_count<const D: usize>() -> usize {
    D + D * (D - 1) / 2
}

/// The modes in the order of the engine: rotations first.
pub(in crate::solid) fn modes_rotations_first<const D: usize>() -> impl Iterator<Item = usize> {
    (D..mode_count::<D>()).chain(0..D)
}

/// The specification of a joint.
///
/// ```
/// use pontoon::{math::Vector, solid::{JointKind, JointSpec, Motor}};
///
/// // Solid number 1 slides upwards along solid number 0, by 0.5 m at most, against a power take-off of 20 N s/m.
/// let (at, up) = (Vector::from([1.0, 0.5]), Vector::from([0.0, 1.0]));
/// let guide = JointSpec::new("guide", JointKind::Slider, [Some(0), Some(1)], at, up)
///     .limits(0.0, 0.5)
///     .motor(Motor::default().damping(20.0));
/// assert!(!guide.contacts_enabled);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JointSpec<const D: usize> {
    /// Its name.
    pub name: String,
    /// What it leaves free.
    pub kind: JointKind,
    /// Numbers of the two solids; `None` is the world.
    pub between: [Option<usize>; 2],
    /// The world point at which it sits at the start, m.
    pub at: Vector<D>,
    /// Direction of a slider or a tow, or axis of a hinge in 3-D (a hinge in 2-D has none); any length but zero. For a generic
    /// joint: first axis of its frame, or zero for the axes of the world.
    pub axis: Vector<D>,
    /// The free modes of a generic joint; empty for any other kind.
    pub free_modes: Vec<FreeMode>,
    /// Least and greatest value of its coordinate, m or rad; 0 is where it starts.
    pub limits: Option<[f64; 2]>,
    /// Its motor or brake.
    pub motor: Option<Motor>,
    /// Whether the two solids have contact with one another.
    pub contacts_enabled: bool,
    /// When it acts, and the load under which it breaks.
    pub lifetime: Lifetime,
    /// Its frames in the two solids, if these have moved since `at` and `axis` were given; by default those of `at` and `axis` at the
    /// start.
    pub(in crate::solid) moved_frames: Option<[Pose<D>; 2]>,
}

impl<const D: usize> JointSpec<D> {
    /// A joint of this kind at the world point `at` (m), along or about `axis`, without limits or motor. Its coordinate is the
    /// motion of the second solid of `between` relative to the first.
    pub fn new(
        name: impl Into<String>,
        kind: JointKind,
        between: [Option<usize>; 2],
        at: Vector<D>,
        axis: Vector<D>,
    ) -> Self {
        Self {
            name: name.into(),
            kind,
            between,
            at,
            axis,
            free_modes: Vec::new(),
            limits: None,
            motor: None,
            contacts_enabled: false,
            lifetime: Lifetime::default(),
            moved_frames: None,
        }
    }

    /// The same joint as a generic joint with one more free mode: 0 to D − 1 for translations along the axes of its frame, from D
    /// on for rotations about them.
    pub fn free_mode(mut self, mode: usize, limits: Option<[f64; 2]>) -> Self {
        self.kind = JointKind::Generic;
        self.free_modes.push(FreeMode { mode, limits });
        self
    }

    /// The same joint with end stops, m or rad from the start.
    pub fn limits(mut self, min: f64, max: f64) -> Self {
        self.limits = Some([min, max]);
        self
    }

    /// The same joint with a motor.
    pub fn motor(mut self, motor: Motor) -> Self {
        self.motor = Some(motor);
        self
    }

    /// The same joint, with contact between its two solids.
    pub fn with_contacts(mut self) -> Self {
        self.contacts_enabled = true;
        self
    }

    /// The same joint with this lifetime. A joint that begins later locks its solids in their poses at that time; until then `at`
    /// and `axis` move with the second solid.
    pub fn lifetime(mut self, lifetime: Lifetime) -> Self {
        self.lifetime = lifetime;
        self
    }
}

/// A joint in a running system.
pub(in crate::solid) struct Joint<const D: usize> {
    pub(in crate::solid) spec: JointSpec<D>,
    /// Its frames in the two solids; x is its axis.
    pub(in crate::solid) frames: [Pose<D>; 2],
}

impl<const D: usize> Joint<D> {
    /// The joint between solids that start as `start`.
    pub(in crate::solid) fn new(spec: JointSpec<D>, start: &[Kinematics<D>]) -> Self {
        let frames = spec.frames(start);
        Self { spec, frames }
    }

    /// Kinematics of its two solids.
    pub(in crate::solid) fn end_kinematics(&self, solids: &[Kinematics<D>]) -> [Kinematics<D>; 2] {
        self.spec.between.map(|end| kinematics_of_end(end, solids))
    }

    pub(in crate::solid) fn mobility(&self, engine: &dyn Engine<D>) -> [Mobility<D>; 2] {
        self.spec.between.map(|end| end.map_or_else(Mobility::none, |solid| engine.mobility(solid)))
    }

    /// Its frames in the two solids if it is connected where they are now.
    pub(super) fn frames_at(&self, solids: &[Kinematics<D>]) -> [Pose<D>; 2] {
        let [first, second] = self.end_kinematics(solids);
        let world = second.pose.then(&self.frames[1]);
        let turn = first.pose.rotation.transpose() * world.rotation;
        [Pose { position: first.pose.local(&world.position), rotation: turn }, self.frames[1]]
    }

    fn sits(&self, ends: &[Kinematics<D>; 2]) -> [Pose<D>; 2] {
        [0, 1].map(|k| ends[k].pose.then(&self.frames[k]))
    }

    /// The world point of the second solid at which it sits, m.
    pub(in crate::solid) fn position_on_second(&self, ends: &[Kinematics<D>; 2]) -> Vector<D> {
        self.sits(ends)[1].position
    }

    /// Its coordinate, m or rad (−π to π); 0 if it has none.
    pub(in crate::solid) fn position(&self, ends: &[Kinematics<D>; 2]) -> f64 {
        self.spec.coordinate_mode().map_or(0.0, |mode| self.coordinate(mode, ends))
    }

    /// The coordinate of a mode, m or rad (−π to π): the displacement of the second solid along the mode's axis in the frame on
    /// the first, or the rotation about this axis, twice the angle of its part of the quaternion.
    pub(in crate::solid) fn coordinate(&self, mode: usize, ends: &[Kinematics<D>; 2]) -> f64 {
        let [first, second] = self.sits(ends);
        if mode < D {
            return first.rotation.column(mode).dot(&(second.position - first.position));
        }
        let turn = first.rotation.transpose() * second.rotation;
        let (i, j) = if D == 2 { (0, 1) } else { ((mode + 1) % D, (mode + 2) % D) };
        (turn[(j, i)] - turn[(i, j)]).atan2(turn[(i, i)] + turn[(j, j)])
    }

    /// The distance (m, or rad from −π to π) from the value `from` of a mode's coordinate to the value `to`.
    pub(in crate::solid) fn distance(mode: usize, from: f64, to: f64) -> f64 {
        let apart = to - from;
        if mode < D { apart } else { apart - whole_turns(apart) }
    }

    /// Distance (m) and angle (rad) between its ends along the locked modes.
    pub(in crate::solid) fn gap(&self, ends: &[Kinematics<D>; 2]) -> [f64; 2] {
        let locked = |modes: std::ops::Range<usize>| modes.filter(|&mode| self.spec.is_locked(mode));
        let off = |mode: usize| self.coordinate(mode, ends);
        let apart = locked(0..D).map(|mode| off(mode).powi(2)).sum::<f64>().sqrt();
        [apart, locked(D..mode_count::<D>()).map(|mode| off(mode).abs()).fold(0.0, f64::max)]
    }

    /// The row of its coordinate, if it has one.
    pub(in crate::solid) fn coordinate_jacobian(&self, ends: &[Kinematics<D>; 2]) -> Option<ConstraintJacobian<D>> {
        self.spec.coordinate_mode().map(|mode| self.row(mode, ends))
    }

    /// The row of a mode's coordinate.
    pub(in crate::solid) fn row(&self, mode: usize, ends: &[Kinematics<D>; 2]) -> ConstraintJacobian<D> {
        let [first, second] = self.sits(ends);
        match mode.checked_sub(D) {
            None => {
                // The engine applies the load on the first solid at the point of the second too, except for the displacement
                // along locked axes.
                let off = first.local(&second.position);
                let held = Vector::from_fn(|axis, _| if self.spec.is_locked(axis) { off[axis] } else { 0.0 });
                let places = [second.position - first.rotation * held, second.position];
                ConstraintJacobian::between_points(first.rotation.column(mode).into(), &places, ends)
            }
            Some(axis) => ConstraintJacobian::about_axis(turning(&first.rotation.column(axis).into())),
        }
    }

    /// The rows of the joint's locks in the engine's order. In 3-D the engine measures a locked turn by its part of v in the
    /// quaternion (w, v) between the frames. The rate of v is ½ (w ω + ω × v).
    pub(in crate::solid) fn lock_jacobians(&self, ends: &[Kinematics<D>; 2]) -> Vec<ConstraintJacobian<D>> {
        let locked = modes_rotations_first::<D>().filter(|&mode| self.spec.is_locked(mode));
        if D == 2 {
            return locked.map(|mode| self.row(mode, ends)).collect();
        }
        let [first, second] = self.sits(ends);
        let turn = first.rotation.transpose() * second.rotation;
        let turn = Matrix3::from_fn(|i, j| turn[(i, j)]);
        let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
        let rates = (Matrix3::identity() * q.w - q.imag().cross_matrix()) * 0.5_f64.copysign(q.w);
        let row = |mode: usize| match mode.checked_sub(D) {
            None => self.row(mode, ends),
            Some(axis) => {
                let about: Vector<D> = first.rotation * Vector::from_fn(|i, _| rates[(axis, i)]);
                ConstraintJacobian::about_axis(Bivector::from_axial(about.as_slice()))
            }
        };
        locked.map(row).collect()
    }

    /// Returns the rows of the locks, then the row of the coordinate (for a generic joint: of each end stop), made independent of
    /// the locks, and the number of locks.
    pub(in crate::solid) fn jacobians(
        &self,
        ends: &[Kinematics<D>; 2],
        mobility: &[Mobility<D>; 2],
    ) -> (Vec<ConstraintJacobian<D>>, usize) {
        let mut rows = self.lock_jacobians(ends);
        let locks = rows.len();
        match self.spec.coordinate_mode() {
            Some(mode) => rows.push(self.row(mode, ends)),
            None => rows.extend(self.spec.end_stops().iter().map(|(mode, _)| self.row(*mode, ends))),
        }
        orthogonalize(&mut rows, locks, mobility);
        (rows, locks)
    }

    /// Whether it has a motor: a program's `set`, or its own.
    pub(in crate::solid) fn has_motor(&self, set: Option<&MotorCommand>) -> bool {
        set.is_some() || self.spec.motor.is_some()
    }

    /// The motor command at time `t` (s): a program's `set`, or its own motor.
    pub(in crate::solid) fn motor_command(&self, set: Option<MotorCommand>, t: f64) -> Option<MotorCommand> {
        set.or_else(|| self.spec.motor.as_ref().map(|motor| motor.command_at(t)))
    }

    /// Its coordinate, m or rad, where it was `last` (m or rad) a step ago: an angle goes on past π.
    pub(in crate::solid) fn position_after(&self, last: f64, ends: &[Kinematics<D>; 2]) -> f64 {
        let at = self.position(ends);
        if self.spec.coordinate_mode() == Some(D) { at + whole_turns(last - at) } else { at }
    }

    /// The force (N or N m) of the motor at the coordinate `position` (m or rad) over a step of `dt` (s). `known` and `reaction` (m/s²
    /// or rad/s²) are the accelerations of the coordinate by the known loads and by the reactions of the last step.
    pub(in crate::solid) fn motor_force(
        drive: &MotorCommand,
        position: f64,
        [rate, known, reaction, ease]: [f64; 4],
        dt: f64,
    ) -> f64 {
        drive.force(&MotorInput {
            position,
            rate,
            known_acceleration: known,
            reaction,
            inverse_effective_mass: ease,
            dt,
        })
    }
}

impl<const D: usize> JointSpec<D> {
    /// Its frame in both solids, which start as `start`; x is its axis.
    pub(in crate::solid) fn frames(&self, start: &[Kinematics<D>]) -> [Pose<D>; 2] {
        if let Some(frames) = self.moved_frames {
            return frames;
        }
        let axis = if D == 2 && self.kind == JointKind::Hinge { Vector::zeros() } else { self.axis };
        let world = Pose { position: self.at, rotation: frame(&axis) };
        self.between.map(|end| {
            let pose = kinematics_of_end(end, start).pose;
            Pose { position: pose.local(&world.position), rotation: pose.rotation.transpose() * world.rotation }
        })
    }

    /// Its coordinate (m or rad) between solids that start as `start`: 0 unless they have moved since `at` and `axis` were given.
    pub(crate) fn coordinate_at_start(&self, start: &[Kinematics<D>]) -> f64 {
        let Some(frames) = self.moved_frames else { return 0.0 };
        let joint = Joint { spec: self.clone(), frames };
        joint.position(&joint.end_kinematics(start))
    }

    /// The mode of its one coordinate, if it is of a kind that has one.
    pub(crate) fn coordinate_mode(&self) -> Option<usize> {
        match self.kind {
            JointKind::Hinge => Some(D),
            JointKind::Slider => Some(0),
            JointKind::Fixed | JointKind::Ball | JointKind::Tow | JointKind::Generic => None,
        }
    }

    /// Whether it locks a mode.
    pub(crate) fn is_locked(&self, mode: usize) -> bool {
        match self.kind {
            JointKind::Hinge | JointKind::Slider => self.coordinate_mode() != Some(mode),
            JointKind::Fixed => true,
            JointKind::Ball => mode < D,
            JointKind::Tow => mode == 0,
            JointKind::Generic => self.free_modes.iter().all(|free| free.mode != mode),
        }
    }

    /// Whether the joint leaves most of a displacement along the unit vector `along` free.
    pub(in crate::solid) fn frees_translation(&self, along: &Vector<D>) -> bool {
        self.freedom(0..D, along) > 0.5
    }

    /// Whether the joint leaves most of a rotation about this axis (axial components, of length 1) free.
    pub(in crate::solid) fn frees_rotation(&self, axis: &[f64]) -> bool {
        if D == 2 { !self.is_locked(D) } else { self.freedom(D..2 * D, &Vector::from_fn(|i, _| axis[i])) > 0.5 }
    }

    /// Square of the part of `direction` along the axes of those of these modes that are free.
    fn freedom(&self, modes: std::ops::Range<usize>, direction: &Vector<D>) -> f64 {
        let axis = if D == 2 && self.kind == JointKind::Hinge { Vector::zeros() } else { self.axis };
        let (first, frame) = (modes.start, frame(&axis));
        let free = modes.filter(|mode| !self.is_locked(*mode));
        free.map(|mode| frame.column(mode - first).dot(direction).powi(2)).sum()
    }

    /// Returns the steady load of a slider's motor: the direction in which the motor drives the second solid, the force (N) where
    /// the joint starts, the stiffness (N/m) and the largest force (N).
    pub(in crate::solid) fn steady_drive(&self) -> Option<(Vector<D>, f64, f64, f64)> {
        let motor = self.motor.as_ref().filter(|_| self.coordinate_mode() == Some(0))?;
        let (force, stiffness) = motor.steady_force()?;
        Some((self.axis.normalize(), force, stiffness, motor.max_force))
    }

    /// Returns the line along which alone its ends move apart: of a slider, or of a generic joint with one free translation.
    pub(in crate::solid) fn guide(&self) -> Option<Vector<D>> {
        let mut free = (0..D).filter(|mode| !self.is_locked(*mode));
        let (mode, None) = (free.next()?, free.next()) else { return None };
        let axis = if D == 2 && self.kind == JointKind::Hinge { Vector::zeros() } else { self.axis };
        Some(frame(&axis).column(mode).into())
    }

    /// The modes that have end stops, with these, in the order of the engine.
    pub(in crate::solid) fn end_stops(&self) -> Vec<(usize, [f64; 2])> {
        let of = |mode: usize| match self.coordinate_mode() == Some(mode) {
            true => self.limits,
            false => self.free_modes.iter().find(|free| free.mode == mode)?.limits,
        };
        modes_rotations_first::<D>().filter_map(|mode| Some((mode, of(mode)?))).collect()
    }
}

/// The whole turns nearest to an `angle`, rad.
fn whole_turns(angle: f64) -> f64 {
    TAU * (angle / TAU).round()
}

/// Turning once about `axis`; in 2-D counter-clockwise.
fn turning<const D: usize>(axis: &Vector<D>) -> Bivector<D> {
    if D == 2 { Bivector::from_axial(&[1.0]) } else { Bivector::from_axial(axis.as_slice()) }
}

/// A right-handed frame with its x along `axis`; the world's if that is nowhere.
fn frame<const D: usize>(axis: &Vector<D>) -> Matrix<D> {
    let length = axis.norm();
    if length == 0.0 {
        return Matrix::identity();
    }
    let mut all = Matrix::<D>::identity();
    let x = axis / length;
    all.set_column(0, &x);
    if D == 2 {
        all.set_column(1, &turning(&x).velocity_at(&x));
    } else {
        let away = x.iamin();
        let z = turning(&x).velocity_at(&Vector::from_fn(|i, _| f64::from(u8::from(i == away)))).normalize();
        all.set_column(1, &turning(&z).velocity_at(&x));
        all.set_column(2, &z);
    }
    all
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/constraint/joint.rs"]
mod tests;
