//! Co-simulation: a hook in each step before the bodies move, and bodies that an external program moves.

use super::{BodyStep, Dimension, Setup, Simulation};
use crate::{
    error::{Error, Result},
    ranks::Ranks,
    solid::{Dim, SolidSpec},
};

impl<const D: usize> Simulation<D> {
    /// Sets up a simulation whose free solids an external program moves, such as a rapier world of your own: see
    /// [`Simulation::step_with`], and `examples/own_world.rs`.
    ///
    /// The setup gives the shape and mass of each such solid, as for any free solid; [`solid::rapier2d`](crate::solid::rapier2d)
    /// and [`solid::rapier3d`](crate::solid::rapier3d) derive both from a rapier body. Contacts and constraints are those of your
    /// world. Such a simulation does not roll back, because your world cannot.
    ///
    /// # Errors
    /// `Scene` if a constant is invalid, a solid cannot be made or has ballast, or a constraint holds a solid: the message names
    /// it.
    pub fn with_external_bodies(setup: Setup<D>) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        if !setup.constraints.is_empty() {
            return Err(Error::scene(
                "joints, springs, ropes, forces and contacts of a simulation with external bodies",
            )
            .help("put them into the world that moves the bodies, and leave them out here"));
        }
        setup.solids.iter().try_for_each(refuse_ballast)?;
        Ok((Dim::<D>::compiled().set_up)(setup, None, true, Ranks::default().with_all_water())?.without_rollback())
    }

    /// Advances by one step, but not past time `end` (s). Calls `hook` once, after the water has moved and before the bodies
    /// move.
    ///
    /// The hook can read the loads of the water, push bodies, advance them ([`BodyStep::advance_bodies`]; the simulation does so
    /// after the hook if the hook does not) and read their motion. With external bodies the hook steps your own world instead,
    /// which takes loads and returns poses.
    ///
    /// ```
    /// # fn main() -> pontoon::Result<()> {
    /// # let scene = "dimension = 2\ndp = 0.05\nuntil = 1.0\nwater = [{ fill = { box = { min = [0, 0], max = [1, 0.5] } } }]\n\
    /// # [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 1.0] } }\n\
    /// # [[solid]]\nname = \"crate\"\nfree = { density = 500 }\nshape = { box = { size = [0.2, 0.2] } }\n\
    /// # at = { x = 0.5, draft = \"equilibrium\" }";
    /// # let scene = pontoon::scene::Scene::parse(scene, std::path::Path::new(""), &[])?;
    /// # let mut simulation = pontoon::simulation::Simulation::new(scene.build::<2>()?.setup)?;
    /// simulation.step_with(1.0, |step| {
    ///     let lift = step.loads()[1].force[1]; // before the bodies' step
    ///     step.advance_bodies()?;
    ///     let speed = step.solids[1].velocity[1]; // after it
    ///     assert!(lift > 0.0 && speed.abs() < 0.1);
    ///     Ok(())
    /// })
    /// # }
    /// ```
    ///
    /// After an alarm the simulation may roll back to an earlier state, but the variables of `hook` keep their values. Let `hook`
    /// count in simulated time, or switch the rollback off with [`without_rollback`](Simulation::without_rollback).
    ///
    /// # Errors
    /// As [`Simulation::step`], the error that `hook` returns, and `Usage` if an external body was left without kinematics.
    pub fn step_with(&mut self, end: f64, mut hook: impl FnMut(&mut BodyStep<D>) -> Result<()>) -> Result<()> {
        (self.compiled.step_with)(self, end, &mut hook)
    }

    /// Whether an external program moves the free solids.
    pub fn has_external_bodies(&self) -> bool {
        self.bodies.has_external_bodies()
    }
}

/// Refuses ballast of a solid that an external program moves, because the masses are those of that program.
pub(super) fn refuse_ballast<const D: usize>(solid: &SolidSpec<D>) -> Result<()> {
    if solid.ballast.is_empty() {
        return Ok(());
    }
    let what = format!("solid {:?} has ballast, and an external program moves it", solid.name);
    Err(Error::scene(what).help("change the mass of the body in the world that moves it"))
}
