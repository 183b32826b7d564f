//! What of a system must be kept to go on to the same bits.

use serde::{Deserialize, Serialize};

use super::{Escape, System};
use crate::{
    error::{Error, Kind, Result},
    particles::Particles,
    solid::{Kinematics, Load, wave::Yielding},
    space::{Matrix, Pose, Vector, Wedge},
    sweep::Sums,
};

/// No place of a solid is so far away, m; nor is what is not finite.
const FARTHEST: f64 = 1e100;

/// What of a system must be kept to go on to the same bits.
#[derive(Serialize, Deserialize)]
pub(crate) struct SystemState<const D: usize> {
    fluid: Particles<D>,
    /// Which particle each image mirrors; the images are the last of the fluid.
    images: Vec<u32>,
    skin: Particles<D>,
    kinematics: Vec<Kinematics<D>>,
    loads: Vec<Load<D>>,
    accelerations: Vec<(Vector<D>, Wedge<D>)>,
    yielding: Vec<Yielding>,
    stress: Vec<Matrix<D>>,
    forms: Vec<Matrix<D>>,
    /// Where the water and the solids were when the lists were made.
    built: (Vec<Vector<D>>, Vec<Pose<D>>),
    passes: u64,
}

impl<const D: usize> System<D> {
    /// Everything that must be kept to go on to the same bits.
    pub(crate) fn save(&self) -> SystemState<D> {
        SystemState {
            fluid: self.fluid.clone(),
            images: self.images.of.clone(),
            skin: self.skin.clone(),
            kinematics: self.solids.iter().map(|s| s.kinematics).collect(),
            loads: self.solids.iter().map(|s| s.load).collect(),
            accelerations: self.solids.iter().map(|s| (s.acceleration, s.whirl)).collect(),
            yielding: self.solids.iter().map(|s| s.yielding).collect(),
            stress: self.stress.clone(),
            forms: self.forms.clone(),
            built: (self.near.built().to_vec(), self.built.clone().unwrap_or_default()),
            passes: self.passes,
        }
    }

    /// Goes back to a kept state of the same scene.
    pub(crate) fn restore(&mut self, kept: SystemState<D>) -> Result<()> {
        let whole = |p: &Particles<D>| p.v.len() == p.len() && p.rho.len() == p.len() && p.id.len() == p.len();
        let number = |own: &[Matrix<D>]| if own.is_empty() { 0 } else { kept.fluid.len() };
        let Some(real) = kept.fluid.len().checked_sub(kept.images.len()) else { return Err(other()) };
        let all =
            if self.changed || self.limits.escape == Escape::Remove { real <= self.count } else { real == self.count };
        let same = all
            && kept.images.iter().all(|&i| (i as usize) < real)
            && kept.skin.len() == self.skin.len()
            && kept.kinematics.len() == self.solids.len()
            && kept.loads.len() == self.solids.len()
            && kept.accelerations.len() == self.solids.len()
            && kept.yielding.len() == self.solids.len()
            && kept.yielding.iter().all(Yielding::is_finite)
            && kept.stress.len() == number(&self.stress)
            && kept.forms.len() == number(&self.forms)
            && kept.built.0.len() == kept.fluid.len()
            && kept.built.1.len() == kept.kinematics.len()
            && whole(&kept.fluid)
            && whole(&kept.skin);
        if !same {
            return Err(other());
        }
        let (water, poses) = kept.built;
        let mut skin = kept.skin.r.clone();
        for (solid, pose) in self.solids.iter().zip(&poses) {
            for i in solid.skin.clone() {
                skin[i] = pose.point(&self.local[i]);
            }
        }
        // No run goes on with water outside its domain, but images lie beyond periodic sides.
        let around = self.domain.grown(self.domain.size().max());
        let near = water.iter().chain(&kept.fluid.r).all(|x| around.contains(x));
        if !near || !skin.iter().chain(&kept.skin.r).all(|x| x.amax() < FARTHEST) {
            return Err(Error::new(Kind::Restart, "the checkpoint holds a particle that is nowhere"));
        }
        (self.fluid, self.skin, self.passes) = (kept.fluid, kept.skin, kept.passes);
        (self.stress, self.forms) = (kept.stress, kept.forms);
        self.images.of = kept.images;
        self.sums.resize(self.fluid.len(), Sums::zero());
        for ((solid, k), load) in self.solids.iter_mut().zip(kept.kinematics).zip(kept.loads) {
            (solid.kinematics, solid.load) = (k, load);
        }
        for ((solid, kept), yielding) in self.solids.iter_mut().zip(kept.accelerations).zip(kept.yielding) {
            (solid.acceleration, solid.whirl) = kept;
            solid.yielding = yielding;
        }
        self.near.build(&water, &skin);
        self.skin_sums.resize(self.near.wet().len(), Sums::zero());
        self.built = Some(poses);
        self.look();
        Ok(())
    }
}

fn other() -> Error {
    Error::new(Kind::Restart, "the checkpoint holds another number of particles")
        .help("it belongs to another scene: resume in the folder of its own run")
}
