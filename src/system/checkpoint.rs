//! The state of a system in a checkpoint: enough to continue with the same bits.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::{
    AxisSet, Escape, FaceExchange, System,
    driving::CurrentState,
    open_boundary::{Buffer, BufferTag},
    own_water::{self, OwnNames},
    water_column::WaterColumn,
};
use crate::{
    error::{Error, ErrorKind, Result},
    interaction::PairSums,
    math::{Bivector, Matrix, Pose, Vector},
    neighbours::Division,
    particles::Particles,
    solid::{Kinematics, Load, Solid},
    wavemaker::AbsorptionState,
};

/// Upper bound (m) of the coordinates of boundary particles; a value that is not finite fails the comparison too.
const FARTHEST: f64 = 1e100;

/// The state of a system in a checkpoint; the arrays are borrowed where it is written. Positions and velocities of boundary
/// particles follow from their solids.
#[derive(Serialize, Deserialize)]
pub(crate) struct SystemState<'a, const D: usize> {
    fluid: WaterState<'a, D>,
    /// Index of the original of each image; the images are the last of the fluid.
    images: Cow<'a, [u32]>,
    /// Along which axes each image is reflected; empty without a symmetry plane.
    reflections: Cow<'a, [AxisSet]>,
    /// The tag of each buffer particle, the name of the next, and what has passed through each face.
    buffer: (Cow<'a, [BufferTag]>, u32, Cow<'a, [FaceExchange<D>]>),
    /// The force that holds a current.
    current: CurrentState,
    /// Number of boundary particles.
    boundary_count: usize,
    /// The boundary particles whose density is not ρ₀, in ascending order, with their densities, kg/m³.
    boundary_density: Vec<(u32, f64)>,
    kinematics: Vec<Kinematics<D>>,
    loads: Vec<Load<D>>,
    accelerations: Vec<(Vector<D>, Bivector<D>)>,
    absorption: Vec<AbsorptionState>,
    stress: Cow<'a, [Matrix<D>]>,
    gradient_correction: WaterColumn<'a, Matrix<D>>,
    /// Positions of the water and poses of the solids when the neighbour lists were built.
    at_rebuild: (WaterColumn<'a, Vector<D>>, Cow<'a, [Pose<D>]>),
    passes: u64,
}

/// Place, velocity, density and name of the water particles, as in [`Particles`].
#[derive(Serialize, Deserialize)]
struct WaterState<'a, const D: usize> {
    r: WaterColumn<'a, Vector<D>>,
    v: WaterColumn<'a, Vector<D>>,
    rho: WaterColumn<'a, f64>,
    id: WaterColumn<'a, u32>,
}

/// Which water a state has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SavedWater {
    /// All, as the other ranks write it at the same time.
    All,
    /// That of this rank alone, if each has its own.
    Own,
}

/// How the columns of the water are saved.
struct Columns<'a> {
    division: Option<&'a Division>,
    which: SavedWater,
}

impl<'a> Columns<'a> {
    fn of<T: Clone>(&self, all: &'a [T]) -> WaterColumn<'a, T> {
        match (self.division, self.which) {
            (None, _) => WaterColumn::Read(Cow::Borrowed(all)),
            (Some(division), SavedWater::All) => WaterColumn::Shared(all, division),
            (Some(division), SavedWater::Own) => WaterColumn::Own(all, division.own_water().map(|(own, _)| own)),
        }
    }
}

impl<const D: usize> SystemState<'_, D> {
    /// Number of solids, with those that were removed.
    pub(crate) fn solid_count(&self) -> usize {
        self.kinematics.len()
    }
}

impl<const D: usize> System<D> {
    /// The state from which [`System::restore`] continues with the same bits.
    pub(crate) fn save(&self, which: SavedWater) -> SystemState<'_, D> {
        let Particles { r, v, rho, id } = &self.fluid.particles;
        let column = Columns { division: own_water::divided(&self.neighbours), which };
        let of_solids = |solid: &Solid<D>| (solid.acceleration, solid.angular_acceleration);
        let density = (0u32..).zip(&self.boundary.particles.rho).map(|(i, &rho)| (i, rho));
        SystemState {
            fluid: WaterState { r: column.of(r), v: column.of(v), rho: column.of(rho), id: column.of(id) },
            images: Cow::Borrowed(&self.fluid.images.originals),
            reflections: Cow::Borrowed(&self.fluid.images.reflections),
            buffer: (
                Cow::Borrowed(&self.fluid.buffer.tags),
                self.fluid.buffer.next_id,
                Cow::Borrowed(&self.fluid.buffer.exchange),
            ),
            current: self.driving.current,
            boundary_count: self.boundary.particles.len(),
            boundary_density: density.filter(|(_, rho)| *rho != self.properties.rho0).collect(),
            kinematics: self.solids.iter().map(|s| s.kinematics).collect(),
            loads: self.solids.iter().map(|s| s.load).collect(),
            accelerations: self.solids.iter().map(of_solids).collect(),
            absorption: self.solids.iter().map(|s| s.absorption).collect(),
            stress: Cow::Borrowed(self.fluid.stress.as_deref().unwrap_or_default()),
            gradient_correction: match &self.fluid.gradient_correction {
                Some(corrections) => column.of(corrections),
                None => WaterColumn::Read(Cow::Borrowed(&[])),
            },
            at_rebuild: (
                column.of(self.neighbours.positions_at_build()),
                Cow::Borrowed(self.boundary.poses_at_rebuild.as_deref().unwrap_or_default()),
            ),
            passes: self.status.passes,
        }
    }

    /// Whether `state` has the numbers of particles and solids of this system without the solids `gone`.
    fn matches(&self, state: &SystemState<D>, gone: &[usize]) -> bool {
        let WaterState { r, v, rho, id } = &state.fluid;
        let (count, solids) = (r.as_slice().len(), self.solids.len());
        let whole = [v.as_slice().len(), rho.as_slice().len(), id.as_slice().len()].iter().all(|n| *n == count);
        let skin_gone: usize = gone.iter().map(|&i| self.solids[i].boundary.len()).sum();
        let tensors = |own: &Option<Vec<Matrix<D>>>, kept: &[Matrix<D>]| {
            kept.len() == if own.as_ref().is_none_or(Vec::is_empty) { 0 } else { count }
        };
        let Some(real) = count.checked_sub(state.images.len()) else { return false };
        let fewer = self.status.solids_added || self.fluid_domain.limits.escape == Escape::Remove;
        let faces = self.fluid_domain.open_boundaries.len();
        let fits = state.current.is_finite()
            && state.buffer.2.len() == faces
            && state.buffer.0.len() <= real
            && state.buffer.0.iter().all(|tag| tag.face() < faces);
        let all = if faces > 0 {
            true
        } else if fewer {
            real <= self.fluid_domain.initial_count
        } else {
            real == self.fluid_domain.initial_count
        };
        fits && all
            && state.images.iter().all(|&i| (i as usize) < real)
            && state.reflections.len() == if self.symmetry_planes().any() { state.images.len() } else { 0 }
            && state.boundary_count == self.boundary.particles.len() - skin_gone
            && state.boundary_density.iter().all(|&(i, _)| (i as usize) < state.boundary_count)
            && state.kinematics.len() == solids
            && state.loads.len() == solids
            && state.accelerations.len() == solids
            && state.absorption.len() == solids
            && state.absorption.iter().all(AbsorptionState::is_finite)
            && tensors(&self.fluid.stress, &state.stress)
            && tensors(&self.fluid.gradient_correction, state.gradient_correction.as_slice())
            && state.at_rebuild.0.as_slice().len() == count
            && state.at_rebuild.1.len() == solids
            && whole
    }

    /// Checks that [`System::restore`] can return to `state` once the solids `gone` are removed.
    ///
    /// # Errors
    /// `Restart` if the state belongs to another scene or is damaged.
    pub(crate) fn check_state(&self, state: &SystemState<D>, gone: &[usize]) -> Result<()> {
        if !self.matches(state, gone) {
            return Err(Error::new(ErrorKind::Restart, "the checkpoint holds another number of particles")
                .help("it belongs to another scene: resume in the folder of its own run"));
        }
        // No run continues with water outside its domain, but images lie beyond periodic sides.
        let around = self.fluid_domain.domain.grown(self.fluid_domain.domain.size().max());
        let near = state.at_rebuild.0.as_slice().iter().chain(state.fluid.r.as_slice()).all(|x| around.contains(x));
        // A solid takes no particle further than the furthest corner of the box around them.
        let poses = state.at_rebuild.1.iter().chain(state.kinematics.iter().map(|kinematics| &kinematics.pose));
        let boxes = self.boundary.local_bounds.iter().cycle();
        let mut corners = poses.zip(boxes).flat_map(|(pose, own)| own.corners().map(|x| pose.point(&x)));
        if !near || !corners.all(|x| x.iter().all(|x| x.abs() < FARTHEST)) {
            return Err(Error::new(ErrorKind::Restart, "the checkpoint holds a particle that is nowhere"));
        }
        Ok(())
    }

    /// Restores a saved state of the same scene that [`System::check_state`] has accepted. If it is a state of this rank's water
    /// only, `own` has the names of this water.
    pub(crate) fn restore(&mut self, state: SystemState<D>, own: Option<OwnNames>) {
        let (water, poses) = (state.at_rebuild.0.into_vec(), state.at_rebuild.1.into_owned());
        let boundary = self.boundary.positions_at(&poses, &self.solids, &self.fluid.images);
        self.status.passes = state.passes;
        let WaterState { r, v, rho, id } = state.fluid;
        let particles = Particles { r: r.into_vec(), v: v.into_vec(), rho: rho.into_vec(), id: id.into_vec() };
        self.fluid.stress = self.fluid.stress.take().map(|_| state.stress.into_owned());
        let corrections = self.fluid.gradient_correction.take().map(|_| state.gradient_correction.into_vec());
        let (tags, next_id, exchange) = state.buffer;
        self.driving.current = state.current;
        let rows = std::mem::take(&mut self.fluid.buffer.rows);
        let (tags, exchange) = (tags.into_owned(), exchange.into_owned());
        self.fluid.buffer = Buffer { tags, rows, next_id, exchange, time: 0.0 };
        self.fluid.images.originals = state.images.into_owned();
        self.fluid.images.reflections = state.reflections.into_owned();
        // The corrections of the state belong to its lists, whatever this system was about to do.
        (self.rates.current, self.rates.corrections_current) = (false, true);
        let loads = state.kinematics.into_iter().zip(state.loads);
        for (i, (solid, (kinematics, load))) in self.solids.iter_mut().zip(loads).enumerate() {
            (solid.kinematics, solid.load) = (kinematics, load);
            self.boundary.place(i, solid, &self.fluid.images);
        }
        self.boundary.particles.rho.fill(self.properties.rho0);
        for (i, rho) in state.boundary_density {
            self.boundary.particles.rho[i as usize] = rho;
        }
        for ((solid, rates), yielding) in self.solids.iter_mut().zip(state.accelerations).zip(state.absorption) {
            (solid.acceleration, solid.angular_acceleration) = rates;
            solid.absorption = yielding;
        }
        self.pair_loop.free_buffers();
        match own {
            Some(own) => own_water::restore(self, own, (particles, corrections), &water, &boundary),
            None => {
                own_water::set_apart(self, false);
                (self.fluid.particles, self.fluid.gradient_correction) = (particles, corrections);
                self.neighbours.build(&water, &boundary);
            }
        }
        self.rates.boundary.resize(self.neighbours.boundary_near_fluid().len(), PairSums::zero());
        self.boundary.poses_at_rebuild = Some(poses);
        self.find_gaps(&boundary);
        self.check_water();
    }
}
