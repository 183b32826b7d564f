//! The masses of free solids with ballast: after each step they get their values at the new time.
//!
//! Mass arrives and leaves with the velocity of its point of the body, so that the points of the body keep their velocities. A
//! mass Δm at x brings the momentum Δm v(x). The centre of mass moves within the body by s, its velocity changes by Ω s, and the
//! angular momentum about it becomes I' Ω. Along a locked translation, the centre of mass stays at rest, and the lock bears the
//! necessary load.

use super::{Bodies, body_step::fault_error, load_breakdown::momentum};
use crate::{
    error::{ErrorCode, Result},
    solid::{EngineFault, Kinematics},
    system::System,
};

impl<const D: usize> Bodies<D> {
    /// Gives the free solids with ballast their masses at time `t` (s), the end of a step of `dt` (s).
    ///
    /// # Errors
    /// `Fault` if a mass is not finite.
    pub(crate) fn update_masses(&mut self, system: &mut System<D>, t: f64, dt: f64) -> Result<()> {
        for i in 0..system.solids.len() {
            let solid = &system.solids[i];
            let (Some(before), false) = (solid.body, solid.spec.ballast.is_empty()) else { continue };
            let Some(after) = solid.spec.body_at(t).filter(|after| *after != before) else { continue };
            let was = solid.kinematics;
            if !after.mass.is_finite() {
                let fault = EngineFault {
                    code: ErrorCode::NonFiniteState,
                    solid: i,
                    reason: "ballast not finite".into(),
                    cause: "the formula of its mass has no finite value at this time: check the formula",
                    position: was.centre,
                    velocity: was.velocity,
                };
                return Err(fault_error(system, fault, self.steps, t));
            }
            let Some(engine) = &mut self.engine else { continue };
            engine.set_mass(i, &after, &solid.spec.pose.rotation);
            let now = engine.kinematics(i);
            let energy = solid.energy(&system.potential_gravity());
            // The motion of the same points without the locks.
            let shift = now.centre - was.centre;
            let carried = Kinematics { velocity: was.velocity + was.spin.velocity_at(&shift), ..now };
            let brought = momentum(&after, &carried) - momentum(&before, &was);
            let solid = &mut system.solids[i];
            solid.acceleration = solid.acceleration_at(&now.centre);
            (solid.body, solid.kinematics) = (Some(after), now);
            let added_mass = self.added_masses.iter_mut().find(|added_mass| added_mass.solid == i);
            added_mass.into_iter().for_each(|added_mass| added_mass.shift_centre(&shift));
            if let Some(accounting) = &mut self.accounting {
                let change = momentum(&after, &now) - momentum(&before, &was);
                accounting.add_ballast(i, &after, brought * (1.0 / dt), change * (1.0 / dt));
                accounting.add_solid_energy(system.solids[i].energy(&system.potential_gravity()) - energy);
            }
            system.place_boundary(i);
        }
        Ok(())
    }
}
