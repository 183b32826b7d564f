//! The interface of the rigid-body engine to the rest of the crate: it takes loads, returns kinematics, and hides the
//! types of rapier.
//!
//! [`Dim`] selects the engine of a dimension: the feature `dim2` provides that of `Dim<2>`, and `dim3` that of
//! `Dim<3>`.

use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    math::{Bivector, Matrix, Pose, Vector},
    solid::{Constraints, FreeBody, Kinematics, Load, Mobility, SolidSpec},
};

/// Moves the free solids of one world under weight, water loads, contact forces and the user's forces.
///
/// An index names a solid: its position in the list from which the engine is made. Fixed and driven solids act as
/// obstacles. Free solids touch obstacles and one another at their true faces, or at the contact skins that their
/// specifications set.
pub trait Engine<const D: usize>: Send + Sync {
    /// Returns the pose, centre of mass, its velocity, and the spin of the free solid `solid`.
    fn kinematics(&self, solid: usize) -> Kinematics<D>;

    /// Advances every free solid by one step of `dt` (s); the given forces stay constant during the step.
    ///
    /// `loads[i]` is the force and torque of the water about the centre of solid i, without weight; the engine uses it
    /// for free solids only. `driven[i]` is the pose and motion of driven solid i at the end of the step, and `None`
    /// for all other solids. The integrator is symplectic Euler: velocities are exact for constant loads, and positions
    /// are first-order. Positions of a solid that only its weight acts on are exact.
    ///
    /// # Errors
    /// An [`EngineFault`] if a load or a driven pose is not finite (then no solid has moved), or if the state of a
    /// solid becomes non-finite. The engine cannot continue afterwards; restore it or make a new one.
    fn step(
        &mut self,
        dt: f64,
        loads: &[Load<D>],
        driven: &[Option<Kinematics<D>>],
    ) -> std::result::Result<(), EngineFault<D>>;

    /// Adds the user's `force` (N) at the world point `at` (m) of a free solid, in the next step only.
    fn push(&mut self, solid: usize, force: &Vector<D>, at: &Vector<D>);

    /// Adds a load about the centre of a free solid, in the next step only; the call has no effect on any other solid.
    fn add_load(&mut self, solid: usize, load: &Load<D>);

    /// Returns the sum of the user's forces and loads that the next step will apply to a free solid.
    fn applied_push(&self, solid: usize) -> Load<D>;

    /// Sets the velocity of the centre of mass (m/s) and the spin (rad/s) of a free solid.
    fn set_velocity(&mut self, solid: usize, velocity: &Vector<D>, spin: &Bivector<D>);

    /// Returns the contact forces between solids in the last step, pair by pair in order.
    fn contacts(&self) -> Vec<ContactForce<D>>;

    /// Holds a free solid at rest if `held` is true, or else releases it with its original locks.
    fn set_held(&mut self, solid: usize, held: bool);

    /// Sets mass, centre of mass and inertia of a free solid that started with the rotation `start`. Its points keep
    /// their velocities, except that its centre of mass stays at rest along locked translations.
    fn set_mass(&mut self, solid: usize, body: &FreeBody<D>, start: &Matrix<D>);

    /// Sets the acceleration of gravity (m/s²) from the next step on.
    fn set_gravity(&mut self, gravity: &Vector<D>);

    /// Connects joint number `joint` with these frames in its two solids, or disconnects it.
    fn set_joint(&mut self, joint: usize, frames: Option<&[Pose<D>; 2]>);

    /// Connects rope number `rope` with this largest length (m), or disconnects it.
    fn set_rope(&mut self, rope: usize, max_length: Option<f64>);

    /// Returns the solid that `solid`, placed at `start`, would overlap most, and the depth (m) including contact
    /// skins.
    ///
    /// # Errors
    /// `Scene` if contacts do not support the shape of `solid`.
    fn deepest_overlap(&self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<Option<(usize, f64)>>;

    /// Adds a solid that starts with the kinematics `start`; the solid gets the next number.
    ///
    /// # Errors
    /// `Scene` if contacts do not support its shape; the engine is unchanged then.
    fn add_body(&mut self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<()>;

    /// Removes a solid that no joint or rope holds: the solid keeps its number but has no further effect.
    fn remove_body(&mut self, solid: usize);

    /// Returns the rate I(R₀) ΔΩ/Δt less the gyroscopic torque (N m) of a free solid in the last step, if the engine
    /// turns it by its spin. In 3-D the engine does so for a solid in a joint, on a rope, or with a locked axis. It
    /// turns all other solids by their angular momentum.
    fn gyroscopic_rate(&self, solid: usize) -> Option<Bivector<D>>;

    /// Returns the present mobility of a solid.
    fn mobility(&self, solid: usize) -> Mobility<D>;

    /// Returns the impulses (N s, N m s) of joint number `joint` on its second solid in the last step. The impulses of
    /// its locks come first, rotations before translations, and then that of its end stop. Each impulse acts along the
    /// part of its row that is independent of the rows before: see `solid/constraint/jacobian.rs`.
    fn joint_impulses(&self, joint: usize) -> Vec<f64>;

    /// Returns the impulse (N s) of rope number `rope` in the last step.
    fn rope_impulse(&self, rope: usize) -> f64;

    /// Returns the whole state as bytes; [`Engine::restore`] continues from them bit for bit.
    ///
    /// # Errors
    /// `Restart` if the state cannot be written.
    fn save(&self) -> Result<Vec<u8>>;

    /// Checks that [`Engine::restore`] takes these bytes.
    ///
    /// # Errors
    /// As [`Engine::restore`].
    fn check(&self, bytes: &[u8]) -> Result<()>;

    /// Restores a state that an engine made from the same solids has saved.
    ///
    /// # Errors
    /// `Restart` if the bytes are damaged, or belong to another version or list of solids; the engine is unchanged.
    fn restore(&mut self, bytes: &[u8]) -> Result<()>;
}

/// The contact force between two solids in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce<const D: usize> {
    /// Numbers of both solids, the lower first.
    pub between: [usize; 2],
    /// Sum of the normal forces at the contact points of the pair, N (N/m in 2-D).
    pub normal_force: f64,
    /// Point of action: the mean of the contact points, weighted by the normal forces, m.
    pub at: Vector<D>,
    /// Loads on the first and on the second solid, including friction, each about the centre of that solid.
    pub loads: [Load<D>; 2],
}

/// A failed step of the engine, and the solid that caused the failure.
#[derive(Clone, Debug, PartialEq)]
pub struct EngineFault<const D: usize> {
    /// Error code of the family of this fault.
    pub code: ErrorCode,
    /// Index of the solid that caused the fault.
    pub solid: usize,
    /// Observed fault, such as "load not finite".
    pub reason: String,
    /// Usual cause and suggested remedy.
    pub cause: &'static str,
    /// Last valid position of the solid's frame, m.
    pub position: Vector<D>,
    /// Velocity before the step, m/s.
    pub velocity: Vector<D>,
}

/// A number of dimensions, as a type that selects its engine.
pub struct Dim<const D: usize>;

/// Dimensions that have an engine.
pub trait HasEngine<const D: usize> {
    /// Name and version of the engine.
    const VERSION: (&'static str, &'static str);

    /// Makes the engine of `solids`, each with its starting kinematics and connected by `links`, under `gravity`
    /// (m/s²).
    ///
    /// `dp` is the particle spacing (m), which sets the largest allowed overlap. This function checks links, mass,
    /// inertia, friction, restitution and motion; `SolidSpec::check` checks shapes.
    ///
    /// # Errors
    /// `Scene` for a solid with invalid values, and if a free solid starts deeper than 0.05 dp inside another solid:
    /// the error names both solids and the depth.
    fn engine(
        solids: &[SolidSpec<D>],
        start: &[Kinematics<D>],
        links: &Constraints<D>,
        gravity: &Vector<D>,
        dp: f64,
    ) -> Result<Box<dyn Engine<D>>>;
}

#[cfg(feature = "dim2")]
impl HasEngine<2> for Dim<2> {
    const VERSION: (&'static str, &'static str) = ("rapier2d", rapier2d::VERSION);

    fn engine(
        solids: &[SolidSpec<2>],
        start: &[Kinematics<2>],
        links: &Constraints<2>,
        gravity: &Vector<2>,
        dp: f64,
    ) -> Result<Box<dyn Engine<2>>> {
        Ok(Box::new(super::rapier2d::RapierWorld::new(solids, start, links, gravity, dp)?))
    }
}

#[cfg(feature = "dim3")]
impl HasEngine<3> for Dim<3> {
    const VERSION: (&'static str, &'static str) = ("rapier3d", rapier3d::VERSION);

    fn engine(
        solids: &[SolidSpec<3>],
        start: &[Kinematics<3>],
        links: &Constraints<3>,
        gravity: &Vector<3>,
        dp: f64,
    ) -> Result<Box<dyn Engine<3>>> {
        Ok(Box::new(super::rapier3d::RapierWorld::new(solids, start, links, gravity, dp)?))
    }
}

/// Largest number of iterations: a contact is then 4096 times as stiff.
const ITERATIONS_MAX: usize = 64;

/// Returns the number of iterations n with which contacts are as firm under the heaviest free solid as under the
/// lightest. The compression of a contact by the load on the lighter body is proportional to 1/n².
pub(super) fn iterations_for_masses(masses: impl Iterator<Item = f64>) -> usize {
    let (lightest, heaviest) = masses.fold((f64::INFINITY, 0.0_f64), |(a, b), mass| (a.min(mass), b.max(mass)));
    let wanted = (heaviest / lightest).sqrt() / 1.5;
    if wanted > 1.0 { (wanted.ceil() as usize).next_power_of_two().min(ITERATIONS_MAX) } else { 1 }
}

/// Returns the error of a state that the engine cannot save or restore.
pub(super) fn restart_error(why: impl std::fmt::Display) -> Error {
    Error::new(ErrorKind::Restart, format!("the rigid bodies of the checkpoint: {why}"))
        .help("a checkpoint is read only by the version and for the scene that wrote it; start the run anew")
}
