//! Programs that step a simulation as part of their own: what they may do at the moment when the water hands over to the bodies,
//! and worlds of rigid bodies that are theirs.

use super::{Handover, Setup, Simulation};
use crate::{
    error::{Error, Result},
    model::Dimension,
    solid::Dim,
};

impl<const D: usize> Simulation<D> {
    /// Sets up a simulation whose free solids are moved by somebody else, such as a rapier world of your own: see
    /// [`Simulation::step_with`], and `examples/own_world.rs`.
    ///
    /// The setup says of each of them its shape and mass, as of any free solid; [`solid::planar`](crate::solid::planar) and
    /// [`solid::spatial`](crate::solid::spatial) take both from a body of rapier's. Which touch, and what ties them, is your
    /// world's affair. Such a simulation does not go back to a good state by itself, as it cannot take your world along.
    ///
    /// # Errors
    /// `Scene` if a constant has no valid value, a solid cannot be made, or solids are tied: says which.
    pub fn hosted(setup: Setup<D>) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        if !setup.links.is_empty() {
            return Err(Error::scene("joints, springs, ropes, forces and contacts of a hosted simulation")
                .help("put them into the world that moves the bodies, and leave setup.links as Links::default()"));
        }
        Ok(Self::made(setup, true)?.without_rescue())
    }

    /// Goes one step on, and not past time `end` (s), and calls `between` once, when the water has moved and the bodies are
    /// about to.
    ///
    /// There you may read what the water gives them, push them, let them go ([`Handover::go`]; done for you if you do not) and
    /// look at them afterwards. In a hosted simulation you step your own world instead: forces out, poses in.
    ///
    /// ```
    /// # fn main() -> pontoon::Result<()> {
    /// # let scene = "dimension = 2\ndp = 0.05\nuntil = 1.0\nwater = [{ fill = { box = { min = [0, 0], max = [1, 0.5] } } }]\n\
    /// # [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 1.0] } }\n\
    /// # [[solid]]\nname = \"crate\"\nfree = { density = 500 }\nshape = { box = { size = [0.2, 0.2] } }\n\
    /// # at = { x = 0.5, draft = \"equilibrium\" }";
    /// # let scene = pontoon::scene::Scene::parse(scene, std::path::Path::new(""), &[])?;
    /// # let mut simulation = pontoon::simulation::Simulation::new(scene.build::<2>()?.setup)?;
    /// simulation.step_with(1.0, |handover| {
    ///     let lift = handover.loads()[1].force[1]; // before the bodies' step
    ///     handover.go()?;
    ///     let speed = handover.solids[1].velocity[1]; // after it
    ///     assert!(lift > 0.0 && speed.abs() < 0.1);
    ///     Ok(())
    /// })
    /// # }
    /// ```
    ///
    /// After an alarm the simulation may go back to a good state, and what `between` keeps does not: count in simulated time, or
    /// make the simulation one [`without_rescue`](Simulation::without_rescue).
    ///
    /// # Errors
    /// As [`Simulation::step`], whatever `between` returns, and `Usage` if a hosted body was left without a place.
    pub fn step_with(&mut self, end: f64, mut between: impl FnMut(&mut Handover<D>) -> Result<()>) -> Result<()> {
        self.stride(end, &mut between)
    }

    /// Whether the free solids are moved by somebody else.
    pub fn is_hosted(&self) -> bool {
        self.bodies.hosted()
    }
}
