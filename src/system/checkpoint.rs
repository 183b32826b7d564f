//! The state of a system in a checkpoint: enough to continue with the same bits.

use serde::{Deserialize, Serialize};

use super::{Escape, System};
use crate::{
    error::{Error, ErrorKind, Result},
    interaction::PairSums,
    math::{Bivector, Matrix, Pose, Vector},
    particles::Particles,
    solid::{Kinematics, Load, Solid},
    wavemaker::AbsorptionState,
};

/// No boundary particle is so far away, m; a value that is not finite fails the comparison too.
const FARTHEST: f64 = 1e100;

/// The state of a system in a checkpoint.
#[derive(Serialize, Deserialize)]
pub(crate) struct SystemState<const D: usize> {
    fluid: Particles<D>,
    /// Index of the original of each image; the images are the last of the fluid.
    images: Vec<u32>,
    boundary: Particles<D>,
    kinematics: Vec<Kinematics<D>>,
    loads: Vec<Load<D>>,
    accelerations: Vec<(Vector<D>, Bivector<D>)>,
    absorption: Vec<AbsorptionState>,
    stress: Vec<Matrix<D>>,
    gradient_correction: Vec<Matrix<D>>,
    /// Positions of the water and poses of the solids when the neighbour lists were built.
    at_rebuild: (Vec<Vector<D>>, Vec<Pose<D>>),
    passes: u64,
}

impl<const D: usize> System<D> {
    /// The state from which [`System::restore`] continues with the same bits.
    pub(crate) fn save(&self) -> SystemState<D> {
        let of_solids = |solid: &Solid<D>| (solid.acceleration, solid.angular_acceleration);
        SystemState {
            fluid: self.fluid.particles.clone(),
            images: self.fluid.images.originals.clone(),
            boundary: self.boundary.particles.clone(),
            kinematics: self.solids.iter().map(|s| s.kinematics).collect(),
            loads: self.solids.iter().map(|s| s.load).collect(),
            accelerations: self.solids.iter().map(of_solids).collect(),
            absorption: self.solids.iter().map(|s| s.absorption).collect(),
            stress: self.fluid.stress.clone().unwrap_or_default(),
            gradient_correction: self.fluid.gradient_correction.clone().unwrap_or_default(),
            at_rebuild: (
                self.neighbours.positions_at_build().to_vec(),
                self.boundary.poses_at_rebuild.clone().unwrap_or_default(),
            ),
            passes: self.status.passes,
        }
    }

    /// Whether `state` has the numbers of particles and solids of this system.
    fn matches(&self, state: &SystemState<D>) -> bool {
        let whole = |p: &Particles<D>| p.v.len() == p.len() && p.rho.len() == p.len() && p.id.len() == p.len();
        let (count, solids) = (state.fluid.len(), self.solids.len());
        let tensors = |own: &Option<Vec<Matrix<D>>>, kept: &[Matrix<D>]| {
            kept.len() == if own.as_ref().is_none_or(Vec::is_empty) { 0 } else { count }
        };
        let Some(real) = count.checked_sub(state.images.len()) else { return false };
        let fewer = self.status.solids_added || self.fluid_domain.limits.escape == Escape::Remove;
        let all = if fewer { real <= self.fluid_domain.initial_count } else { real == self.fluid_domain.initial_count };
        all && state.images.iter().all(|&i| (i as usize) < real)
            && state.boundary.len() == self.boundary.particles.len()
            && state.kinematics.len() == solids
            && state.loads.len() == solids
            && state.accelerations.len() == solids
            && state.absorption.len() == solids
            && state.absorption.iter().all(AbsorptionState::is_finite)
            && tensors(&self.fluid.stress, &state.stress)
            && tensors(&self.fluid.gradient_correction, &state.gradient_correction)
            && state.at_rebuild.0.len() == count
            && state.at_rebuild.1.len() == solids
            && whole(&state.fluid)
            && whole(&state.boundary)
    }

    /// Returns to a saved state of the same scene.
    pub(crate) fn restore(&mut self, state: SystemState<D>) -> Result<()> {
        if !self.matches(&state) {
            return Err(Error::new(ErrorKind::Restart, "the checkpoint holds another number of particles")
                .help("it belongs to another scene: resume in the folder of its own run"));
        }
        let (water, poses) = state.at_rebuild;
        let boundary = self.boundary.positions_at(state.boundary.r.clone(), &poses, &self.solids, &self.fluid.images);
        // No run continues with water outside its domain, but images lie beyond periodic sides.
        let around = self.fluid_domain.domain.grown(self.fluid_domain.domain.size().max());
        let near = water.iter().chain(&state.fluid.r).all(|x| around.contains(x));
        if !near || !boundary.iter().chain(&state.boundary.r).all(|x| x.amax() < FARTHEST) {
            return Err(Error::new(ErrorKind::Restart, "the checkpoint holds a particle that is nowhere"));
        }
        (self.boundary.particles, self.status.passes) = (state.boundary, state.passes);
        self.fluid.particles = state.fluid;
        self.fluid.stress = self.fluid.stress.take().map(|_| state.stress);
        self.fluid.gradient_correction = self.fluid.gradient_correction.take().map(|_| state.gradient_correction);
        self.fluid.images.originals = state.images;
        self.rates.fluid.resize(self.fluid.particles.len(), PairSums::zero());
        let loads = state.kinematics.into_iter().zip(state.loads);
        for (solid, (kinematics, load)) in self.solids.iter_mut().zip(loads) {
            (solid.kinematics, solid.load) = (kinematics, load);
        }
        for ((solid, rates), yielding) in self.solids.iter_mut().zip(state.accelerations).zip(state.absorption) {
            (solid.acceleration, solid.angular_acceleration) = rates;
            solid.absorption = yielding;
        }
        self.neighbours.build(&water, &boundary);
        self.rates.boundary.resize(self.neighbours.boundary_near_fluid().len(), PairSums::zero());
        self.boundary.poses_at_rebuild = Some(poses);
        self.check_water();
        Ok(())
    }
}
