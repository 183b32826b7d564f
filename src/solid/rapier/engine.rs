//! The rigid-body engine as the rest sees it: loads in, kinematics out, nothing of rapier.
//!
//! [`Dim`] picks the engine of a dimension: `Dim<2>` has one if the feature `dim2` is on, `Dim<3>` with `dim3`.

use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    math::{Bivector, Vector},
    solid::{Constraints, Kinematics, Load, Mobility, SolidSpec},
};

/// Moves the free solids of one world under weight, water, contacts and the user's pushes.
///
/// Solids are named by their index in the list that the engine was made from. Fixed and driven solids take
/// part as obstacles; free ones touch those and one another at their true faces, or at the contact skins that they ask for.
pub trait Engine<const D: usize>: Send + Sync {
    /// Pose, centre of mass, its velocity, and spin of the free solid `solid`.
    fn kinematics(&self, solid: usize) -> Kinematics<D>;

    /// Advances every free solid by `dt` (s), once, with the given forces held constant.
    ///
    /// `loads[i]`: the water's force and torque about the centre of solid i, without weight; used for free
    /// solids only. `driven[i]`: where driven solid i is at the end of the step; `None` for all others.
    /// Velocities are exact for constant loads, positions first-order: symplectic Euler; exact for what has only its weight.
    ///
    /// # Errors
    /// An [`EngineFault`] if a load or a driven pose is not finite (nothing has moved then), or if a solid's
    /// state became so. The engine cannot go on afterwards; restore it or make a new one.
    fn step(
        &mut self,
        dt: f64,
        loads: &[Load<D>],
        driven: &[Option<Kinematics<D>>],
    ) -> std::result::Result<(), EngineFault<D>>;

    /// Adds the user's `force` (N) at the world point `at` (m) of a free solid, in the next step only.
    fn push(&mut self, solid: usize, force: &Vector<D>, at: &Vector<D>);

    /// Adds a load about the centre of a free solid, in the next step only; without effect on any other.
    fn add_load(&mut self, solid: usize, load: &Load<D>);

    /// What the pushes and burdens that wait for the next step come to on a free solid.
    fn applied_push(&self, solid: usize) -> Load<D>;

    /// Sets the velocity of the centre of mass (m/s) and the spin (rad/s) of a free solid.
    fn set_velocity(&mut self, solid: usize, velocity: &Vector<D>, spin: &Bivector<D>);

    /// How the solids pressed on one another in the last step, pair by pair in order.
    fn contacts(&self) -> Vec<ContactForce<D>>;

    /// Holds a free solid still, or lets it go as it was made.
    fn set_held(&mut self, solid: usize, held: bool);

    /// With which solid, and how deep (m), a `solid` that starts as `start` would overlap most, contact skins counted.
    ///
    /// # Errors
    /// `Scene` if its shape cannot be touched.
    fn deepest_overlap(&self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<Option<(usize, f64)>>;

    /// Lets a solid come that starts as `start`; it gets the next number.
    ///
    /// # Errors
    /// `Scene` if its shape cannot be touched; nothing has changed then.
    fn add_body(&mut self, solid: &SolidSpec<D>, start: &Kinematics<D>) -> Result<()>;

    /// Takes a solid out that nothing is tied to: it keeps its number and takes no part any more.
    fn remove_body(&mut self, solid: usize);

    /// What a free solid did in the last step against torques (N m), if it is one that the engine turns by its spin: in space one in
    /// a joint, on a rope, or with something locked, I(R₀) ΔΩ/Δt less its gyroscopic torque. All others turn by their angular momentum.
    fn gyroscopic_rate(&self, solid: usize) -> Option<Bivector<D>>;

    /// How easily a solid is moved now.
    fn mobility(&self, solid: usize) -> Mobility<D>;

    /// Iterations of the last step. Joints and ropes tell the impulses of its last iteration, times their number.
    fn solver_iterations(&self) -> usize;

    /// Impulses (N s, N m s) of joint number `joint` on its second solid in the last step: of its locks, turns first, then of
    /// its end stop. Each is along what the rows before it leave of its own: see `solid/rows.rs`.
    fn joint_impulses(&self, joint: usize) -> Vec<f64>;

    /// Impulse (N s) of rope number `rope` in the last step.
    fn rope_impulse(&self, rope: usize) -> f64;

    /// The whole state as bytes; [`Engine::restore`] continues from them to the same bits.
    ///
    /// # Errors
    /// `Restart` if the state cannot be written.
    fn save(&self) -> Result<Vec<u8>>;

    /// Puts back a state saved by an engine made from the same solids.
    ///
    /// # Errors
    /// `Restart` if the bytes are damaged, or of another version or list of solids; the engine is unchanged.
    fn restore(&mut self, bytes: &[u8]) -> Result<()>;
}

/// How two solids pressed on each other in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce<const D: usize> {
    /// Their numbers, the lower first.
    pub between: [usize; 2],
    /// Sum of the normal forces at their contact points, N (N/m in 2-D).
    pub normal_force: f64,
    /// Where they act: the mean of the contact points, weighed by the normal forces, m.
    pub at: Vector<D>,
    /// Loads on the first and on the second, friction included, each about its own centre.
    pub loads: [Load<D>; 2],
}

/// A step that the engine could not make, and the solid to blame.
#[derive(Clone, Debug, PartialEq)]
pub struct EngineFault<const D: usize> {
    /// The identifier of its family.
    pub code: ErrorCode,
    /// Index of the solid.
    pub solid: usize,
    /// What was seen: "load not finite".
    pub reason: String,
    /// What usually causes it and what to try.
    pub cause: &'static str,
    /// Last valid position of the solid's frame, m.
    pub position: Vector<D>,
    /// Velocity before the step, m/s.
    pub velocity: Vector<D>,
}

/// A number of dimensions, to be asked for its engine.
pub struct Dim<const D: usize>;

/// Dimensions that have an engine.
pub trait HasEngine<const D: usize> {
    /// Name and version of the engine.
    const VERSION: (&'static str, &'static str);

    /// Makes the engine of `solids`, each starting as `start` says and tied by `links`, under `gravity` (m/s²).
    ///
    /// `dp`: particle spacing (m), the measure of what overlap is too deep. Shapes are not checked here but by
    /// `SolidSpec::check`; ties, mass, inertia, friction, restitution and motion are.
    ///
    /// # Errors
    /// `Scene` for a solid that cannot be meant, and if a free solid starts deeper than 0.05 dp inside another:
    /// names both and the depth.
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

/// Most iterations: a contact 4096 times as stiff.
const ITERATIONS_MAX: usize = 64;

/// Iterations that keep contacts as firm under the heaviest of the free solids as under the lightest: a contact yields to what
/// lies on the lighter body with 1/n².
pub(super) fn iterations_for_masses(masses: impl Iterator<Item = f64>) -> usize {
    let (lightest, heaviest) = masses.fold((f64::INFINITY, 0.0_f64), |(a, b), mass| (a.min(mass), b.max(mass)));
    let wanted = (heaviest / lightest).sqrt() / 1.5;
    if wanted > 1.0 { (wanted.ceil() as usize).next_power_of_two().min(ITERATIONS_MAX) } else { 1 }
}

/// The error of a state that cannot be saved or restored.
pub(super) fn restart_error(why: impl std::fmt::Display) -> Error {
    Error::new(ErrorKind::Restart, format!("the rigid bodies of the checkpoint: {why}"))
        .help("a checkpoint is read only by the version and for the scene that wrote it; start the run anew")
}
