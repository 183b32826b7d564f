//! Solids: fixed, driven and free, with their kinematics, loads, equilibrium at rest, constraints and mooring lines, and the
//! rigid-body engine (rapier) with its colliders and contacts. The module has no sums over pairs of particles.

mod ballast;
mod body;
pub(crate) mod boundary_motion;
pub(crate) mod constraint;
pub(crate) mod containment;
pub(crate) mod decks;
pub(crate) mod force;
pub mod hydrostatics;
pub(crate) mod joint_groups;
mod load;
pub(crate) mod mooring;
pub(crate) mod prescribed_motion;
pub(crate) mod rapier;
pub(crate) mod righting;
pub(crate) mod statics;
pub(crate) mod tie_loads;
pub(crate) mod wind;
#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../tests/unit/solid/engine.rs"]
mod tests;

pub use ballast::BallastSpec;
pub use constraint::{
    ConstraintChange, ConstraintEvent, Constraints, ContactPairs, ContactSpec, FreeMode, InitialHold, JointKind,
    JointReading, JointSpec, Lifetime, LineEnd, LineReading, Mobility, Motor, MotorCommand, RopeSpec, SpringParameters,
    SpringSpec, TimedRemoval,
};
pub use force::{ForceCommand, ForceSpec};
pub use load::Load;
pub(crate) use load::LoadContext;
pub(crate) use mooring::SHORTEST_SHARE;
pub use mooring::{
    ClumpSpec, LineDamping, LineType, MooringPointSpec, MooringReading, MooringSpec, Winch, WinchTarget,
};
pub use prescribed_motion::{PrescribedMotion, TimeFunction};
pub use rapier::ContactForce;
#[cfg(feature = "dim2")]
pub use rapier::rapier2d;
#[cfg(feature = "dim3")]
pub use rapier::rapier3d;
#[doc(hidden)]
pub use rapier::{Dim, Engine, EngineFault, HasEngine};
pub(crate) use wind::AIR_DENSITY;
pub use wind::WindSpec;

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::wavemaker::AbsorptionState;
use crate::{
    geometry::Shape,
    math::{Bivector, Matrix, Pose, Vector},
};

/// Default of the Coulomb friction coefficient, that of wet wood or plastic, –.
pub const DEFAULT_FRICTION: f64 = 0.3;

/// Default of the restitution coefficient, –: lubrication by water dissipates the rebound.
pub const DEFAULT_RESTITUTION: f64 = 0.0;

/// Default of the contact skin, m: contact begins at the faces.
pub const DEFAULT_CONTACT_SKIN: f64 = 0.0;

/// The specification of a solid: [`SolidSpec::fixed`], [`SolidSpec::driven`], [`SolidSpec::free`] or [`SolidSpec::with_body`].
///
/// ```
/// use pontoon::prelude::*;
///
/// let hull = Shape::Box { size: [0.4, 0.1].into() };
/// let raft = SolidSpec::free("raft", hull, 500.0).at([1.0, 0.2]).friction(0.4);
/// assert_eq!(raft.restitution, 0.0);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SolidSpec<const D: usize> {
    /// The name that the user gave it.
    pub name: String,
    /// Geometry in the solid's own frame.
    pub shape: Shape<D>,
    /// Pose of that frame at the start.
    pub pose: Pose<D>,
    /// What moves it.
    pub role: Role<D>,
    /// Coulomb friction coefficient, –.
    pub friction: f64,
    /// Restitution coefficient, –.
    pub restitution: f64,
    /// Distance outside its faces at which contact begins, m; 0: at the faces. The water is not affected.
    pub contact_skin: f64,
    /// Whether the enclosed space starts dry. `Some(true)`: dry, also in an open hull below its rim; `Some(false)`: water inside
    /// is intended. `None`: closed hollows are dry, and water in an open hull is reported.
    pub dry: Option<bool>,
    /// Masses at points of a free solid that change with time, in addition to its own.
    pub ballast: Vec<BallastSpec<D>>,
}

/// What moves a solid.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Role<const D: usize> {
    /// Nothing.
    Fixed,
    /// A prescribed motion.
    Driven(PrescribedMotion<D>),
    /// Water, weight, contacts: rapier.
    Free(FreeBody<D>),
}

/// A free body's mass and velocity, from [`FreeBody::from_density`], [`FreeBody::from_mass`] or [`FreeBody::new`].
///
/// ```
/// use pontoon::prelude::*;
///
/// let hull = Shape::<2>::Box { size: [0.4, 0.1].into() };
/// let body = FreeBody::from_density(&hull, 500.0).velocity([0.5, 0.0]).lock_rotation(0);
/// let raft = SolidSpec::with_body("raft", hull, body);
/// assert!(raft.check().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FreeBody<const D: usize> {
    /// Mass, kg (kg/m in 2-D).
    pub mass: f64,
    /// Centre of mass in the solid's frame, m.
    pub centre: Vector<D>,
    /// Inertia about the centre of mass in the solid's frame, kg m² (kg m²/m in 2-D): the 3×3 tensor in
    /// 3-D; in 2-D the number stands in `[(0, 0)]`.
    pub inertia: Matrix<D>,
    /// Velocity of the centre of mass, m/s.
    pub velocity: Vector<D>,
    /// Spin, rad/s.
    pub spin: Bivector<D>,
    /// Which world translations are locked.
    pub locked_translations: [bool; D],
    /// Which world rotations (axial components, one in 2-D) are locked; entries past the last are unused.
    pub locked_rotations: [bool; 3],
}

/// Pose and velocity of a solid at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kinematics<const D: usize> {
    /// Pose of the solid's frame.
    pub pose: Pose<D>,
    /// World position (m) about which `spin` turns and torques are taken: the centre of mass of a free body, the hinge or the
    /// frame's origin of a driven body, the frame's origin of a fixed body.
    pub centre: Vector<D>,
    /// Velocity of `centre`, m/s.
    pub velocity: Vector<D>,
    /// Spin, rad/s.
    pub spin: Bivector<D>,
}

/// How symmetry planes divide a solid in a running system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SolidDivision {
    /// Axes of the planes that cut it, bit by bit.
    pub(crate) cut: u8,
    /// Number of its boundary particles on the computed side, or in one periodic copy; they come first.
    pub(crate) own: usize,
    /// Number of the boundary particles of the whole solid.
    pub(crate) whole: usize,
}

/// A solid in a running system.
#[derive(Clone, Debug)]
pub struct Solid<const D: usize> {
    /// Its specification.
    pub spec: SolidSpec<D>,
    /// Its present mass, of a free solid; `None` of any other.
    pub body: Option<FreeBody<D>>,
    /// Its present kinematics.
    pub kinematics: Kinematics<D>,
    /// Indices of its boundary particles. A free or driven solid that may cross periodic sides has several copies, one after the
    /// other; beside a symmetry plane their mirror images come last.
    pub boundary: Range<usize>,
    /// The periodic axes along which its boundary particles have copies, bit by bit.
    pub(crate) copied_axes: u8,
    /// How symmetry planes divide it and its boundary particles.
    pub(crate) division: SolidDivision,
    /// Acceleration of `kinematics.centre`, a mean over the last few steps, m/s².
    pub acceleration: Vector<D>,
    /// Angular acceleration, the same mean, rad/s².
    pub angular_acceleration: Bivector<D>,
    /// The water's load on it at the last force pass (pressure and viscosity, no weight).
    pub load: Load<D>,
    /// State of the wave absorption, if it is a paddle that absorbs.
    pub(crate) absorption: AbsorptionState,
}

/// Weight of the last step in the mean acceleration of a solid over about five steps. With the last step alone, a body lighter
/// than the water that moves with it would oscillate.
const ACCELERATION_FILTER: f64 = 0.2;

impl<const D: usize> Solid<D> {
    /// Whether it was removed: it has no boundary particles then.
    pub(crate) fn is_removed(&self) -> bool {
        self.boundary.is_empty()
    }

    /// Whether forces move it.
    pub(crate) fn is_free(&self) -> bool {
        matches!(self.spec.role, Role::Free(_))
    }

    /// Signed distance (m) of `x` (m) from its face, negative inside.
    pub(crate) fn distance(&self, x: &Vector<D>) -> f64 {
        self.spec.shape.signed_distance(&self.kinematics.pose.local(x))
    }

    /// Number of copies of its boundary particles.
    pub(crate) fn copies(&self) -> usize {
        1 << self.copied_axes.count_ones()
    }

    /// Indices of the boundary particles of its copy number `copy`.
    pub(crate) fn boundary_of_copy(&self, copy: usize) -> Range<usize> {
        let (start, count) = (self.boundary.start, self.division.own);
        start + copy * count..start + (copy + 1) * count
    }

    /// Indices of the boundary particles of the whole solid, without those of its images.
    pub(crate) fn boundary_of_whole(&self) -> Range<usize> {
        self.boundary.start
            ..self.boundary.start + if self.copied_axes != 0 { self.boundary.len() } else { self.division.whole }
    }

    /// Moves it to `next` over `dt` (s).
    pub(crate) fn advance(&mut self, next: Kinematics<D>, dt: f64) {
        let now = &self.kinematics;
        self.acceleration += ((next.velocity - now.velocity) / dt - self.acceleration) * ACCELERATION_FILTER;
        let whirl = (next.spin + now.spin * -1.0) * (1.0 / dt);
        self.angular_acceleration =
            self.angular_acceleration * (1.0 - ACCELERATION_FILTER) + whirl * ACCELERATION_FILTER;
        self.kinematics = next;
    }

    /// Its kinematics by `motion` at time `t` (s), with wave absorption.
    pub(crate) fn prescribed_kinematics(&self, motion: &PrescribedMotion<D>, t: f64) -> Kinematics<D> {
        motion.kinematics_with_absorption(&self.spec.pose, t, &self.absorption)
    }

    /// Kinetic energy, ½ M V² + ½ Ω·I Ω, J (J/m in 2-D); 0 for a solid that is not free.
    pub(crate) fn kinetic_energy(&self) -> f64 {
        let Some(body) = &self.body else { return 0.0 };
        let now = &self.kinematics;
        let turning = rotational_energy_twice(&body.inertia, &now.pose.rotation, &now.spin.axial());
        0.5 * body.mass * now.velocity.norm_squared() + 0.5 * turning
    }

    /// Potential energy under `gravity` (m/s²), −M g·R, J (J/m in 2-D); 0 for a solid that is not free.
    pub(crate) fn potential_energy(&self, gravity: &Vector<D>) -> f64 {
        let Some(body) = &self.body else { return 0.0 };
        -body.mass * gravity.dot(&self.kinematics.centre)
    }

    /// Both energies, J (J/m in 2-D).
    pub(crate) fn energy(&self, gravity: &Vector<D>) -> f64 {
        self.kinetic_energy() + self.potential_energy(gravity)
    }

    /// Whether a point of it may have an acceleration: it has an exact 0 otherwise.
    pub(crate) fn may_accelerate(&self) -> bool {
        let turns = [&self.kinematics.spin, &self.angular_acceleration].into_iter().flat_map(|turn| turn.0.iter());
        self.acceleration.iter().chain(turns).any(|x| *x != 0.0)
    }

    /// Acceleration (m/s²) of its point at the world position `x` (m).
    pub(crate) fn acceleration_at(&self, x: &Vector<D>) -> Vector<D> {
        let (arm, spin) = (x - self.kinematics.centre, &self.kinematics.spin);
        self.acceleration + self.angular_acceleration.velocity_at(&arm) + spin.velocity_at(&spin.velocity_at(&arm))
    }
}

/// Ω·I Ω with the inertia given in the body's frame, which is turned by `rotation`.
fn rotational_energy_twice<const D: usize>(inertia: &Matrix<D>, rotation: &Matrix<D>, spin: &[f64]) -> f64 {
    if D == 2 {
        return inertia[(0, 0)] * spin[0] * spin[0];
    }
    let local = rotation.transpose() * Vector::<D>::from_iterator(spin.iter().copied());
    local.dot(&(inertia * local))
}

#[cfg(test)]
mod energy {
    use super::*;

    #[test]
    fn turning_energy_follows_the_body_frame() {
        let inertia = Matrix::<3>::from_diagonal(&Vector::<3>::new(1.0, 2.0, 3.0));
        let quarter = Bivector::<3>::from_axial(&[0.0, 0.0, std::f64::consts::FRAC_PI_2]).exp();
        let energy = rotational_energy_twice(&inertia, &quarter, &[1.0, 0.0, 0.0]);
        assert!((energy - 2.0).abs() < 1e-14, "the world's x is the body's −y; got {energy}");
    }
}
