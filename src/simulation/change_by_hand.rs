//! States of water and solids that a program sets.

use rayon::prelude::*;

use super::{Simulation, dimension::Field};
use crate::math::{Bivector, Vector};

pub(super) fn set_velocity<const D: usize>(
    sim: &mut Simulation<D>,
    solid: usize,
    velocity: &Vector<D>,
    spin: &Bivector<D>,
) {
    if let Some(engine) = sim.bodies.engine_mut() {
        engine.set_velocity(solid, velocity, spin);
        let (now, kinematics) = (engine.kinematics(solid), &mut sim.system.solids[solid].kinematics);
        (kinematics.velocity, kinematics.spin) = (now.velocity, now.spin);
        sim.system.place_boundary(solid);
        note_change(sim);
    }
}

pub(super) fn set_water_velocity<const D: usize>(sim: &mut Simulation<D>, field: Field<D, Vector<D>>) {
    let fluid = &mut sim.system.fluid.particles;
    fluid.v.par_iter_mut().zip(&fluid.r).for_each(|(v, r)| *v = field(r));
    finish_water(sim);
}

pub(super) fn set_water_density<const D: usize>(sim: &mut Simulation<D>, field: Field<D, f64>) {
    let fluid = &mut sim.system.fluid.particles;
    fluid.rho.par_iter_mut().zip(&fluid.r).for_each(|(rho, r)| *rho = field(r));
    finish_water(sim);
}

/// Copies the new state of the water to its images.
fn finish_water<const D: usize>(sim: &mut Simulation<D>) {
    sim.system.fluid.update_reflected_images();
    note_change(sim);
}

/// A device gets the new state before the next step.
#[cfg_attr(not(feature = "gpu"), expect(unused_variables, reason = "only a device keeps a copy of the state"))]
fn note_change<const D: usize>(sim: &mut Simulation<D>) {
    #[cfg(feature = "gpu")]
    if let Some(own) = &mut sim.device {
        own.host_changed = true;
    }
}
