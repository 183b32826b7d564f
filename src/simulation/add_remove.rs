//! Adding and removing solids during a simulation.

#[cfg(feature = "gpu")]
use super::on_device;
use super::{Dimension, Simulation, SimulationState, external_bodies::refuse_ballast, state_bytes::read};
use crate::{
    coupling::AcousticAddedMass,
    error::{Error, ErrorCode, ErrorKind, Result},
    interaction::RequestedSums,
    solid::{Constraints, Dim, HasEngine as _, Kinematics, Role, Solid, SolidSpec, containment::depth_inside_mesh},
    system::{Reordering, return_impulse},
};

/// Largest overlap of a solid that is added, dp.
const OVERLAP_MAX: f64 = 0.05;

/// The result of adding a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AddedSolid {
    /// Its number.
    pub solid: usize,
    /// Number of water particles that it displaced.
    pub displaced: usize,
}

impl<const D: usize> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    /// Adds a solid between two steps. A driven solid starts at the present value of its law, and ballast has its present mass.
    ///
    /// Water particles inside the solid are removed, with their mass and momentum; the result has their number. Results of a run
    /// with added solids are bit-identical for any number of threads. [`Simulation::restore_with_added_solids`] restores states
    /// of such a run.
    ///
    /// # Errors
    /// `Scene` if the solid is invalid, if its name is or was in use, or if it lies deeper than 0.05 dp inside another solid: the
    /// message names that solid and the depth. The simulation is unchanged then.
    pub fn add_solid(&mut self, spec: SolidSpec<D>) -> Result<AddedSolid> {
        (self.compiled.add_solid)(self, spec)
    }

    pub(super) fn put_in_solid(&mut self, spec: SolidSpec<D>) -> Result<AddedSolid> {
        spec.check()?;
        if self.has_external_bodies() {
            refuse_ballast(&spec)?;
        }
        if self.system.find_solid(&spec.name).is_some() {
            return Err(Error::scene(format!("a solid is or was called {:?} already", spec.name))
                .help("give each its own name, also after one was removed"));
        }
        if let Some(axis) = self.system.periodic().iter().position(Option::is_some) {
            let name = ["x", "y", "z"][axis];
            return Err(Error::scene(format!("solids cannot come into a simulation that is periodic along {name}"))
                .help("put them in at set-up, where it is seen whether they end at a periodic side"));
        }
        if let Some((axis, _)) = self.system.symmetry_planes().each().next() {
            let name = ["x", "y", "z"][axis];
            let what = format!("solids cannot come into a simulation with a symmetry plane normal to {name}");
            return Err(Error::scene(what).help("put them in at set-up, where it is seen how the plane divides them"));
        }
        let start = match &spec.role {
            Role::Driven(motion) => motion.kinematics(&spec.pose, self.clock.time),
            Role::Fixed | Role::Free(_) => spec.initial_kinematics(),
        };
        self.refuse_overlap(&spec, &start)?;
        self.insert_solid(spec, start)?;
        let (reordering, displaced, energy) = self.system.displace();
        let solid = self.system.solids().len() - 1;
        if let Some(accounting) = &mut self.bodies.accounting {
            accounting.add_displaced(energy);
            accounting.add_solid_energy(self.system.solids()[solid].energy(&self.system.potential_gravity()));
        }
        self.bodies.update_masses(&mut self.system, self.clock.time, self.clock.dt)?;
        self.finish_change(reordering);
        Ok(AddedSolid { solid, displaced })
    }

    /// Restores a state as [`Simulation::restore`] does, in a simulation made from the same setup. `added` are the solids that
    /// the simulation of the state had added, in this order.
    ///
    /// # Errors
    /// `Restart` if the bytes are damaged or the number of added solids differs: nothing has changed then. `Restart` also if the
    /// bytes belong to another setup or to other added solids: the simulation has the solids `added` then.
    pub fn restore_with_added_solids(&mut self, bytes: &[u8], added: Vec<SolidSpec<D>>) -> Result<()> {
        (self.compiled.restore_with_added_solids)(self, bytes, added)
    }

    pub(super) fn restore_state_with_added_solids(&mut self, bytes: &[u8], added: Vec<SolidSpec<D>>) -> Result<()> {
        let kept = read::<SimulationState<'static, D>>(bytes)?;
        let (own, there) = (self.system.solids().len() + added.len(), kept.system.solid_count());
        if own != there || kept.removed_solids.iter().any(|solid| *solid as usize >= there) {
            let what = format!("the state is of {there} solids, and with the added ones there are {own} here");
            return Err(Error::new(ErrorKind::Restart, what)
                .with_code(ErrorCode::OtherSetup)
                .help("give all solids that had been added, in their order"));
        }
        added.iter().try_for_each(SolidSpec::check)?;
        for spec in added {
            let start = spec.initial_kinematics();
            self.insert_solid(spec, start)?;
        }
        kept.removed_solids.iter().for_each(|solid| self.delete_solid(*solid as usize));
        self.restore(bytes)
    }

    /// Refuses a solid deeper inside another solid than is allowed.
    fn refuse_overlap(&self, spec: &SolidSpec<D>, start: &Kinematics<D>) -> Result<()> {
        let Some(engine) = self.bodies.engine() else { return Ok(()) };
        let allowed = OVERLAP_MAX * self.system.model().dp;
        let touched = engine.deepest_overlap(spec, start)?.into_iter();
        match touched.chain(self.overlap_inside_mesh(spec, start, allowed)).max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((other, depth)) if depth > allowed => {
                let other = &self.system.solids()[other].spec;
                let what = format!("\"{}\" would come {depth:.5} m inside \"{}\"", spec.name, other.name);
                let padded = if spec.contact_skin + other.contact_skin > 0.0 { ", contact skins counted" } else { "" };
                Err(Error::scene(what + padded)
                    .help(format!("move it by that much or more; {allowed:.5} m (0.05 dp) is let pass")))
            }
            _ => Ok(()),
        }
    }

    /// Returns the solid that a new solid would overlap most where the engine finds no contact, inside a mesh, and the depth (m).
    fn overlap_inside_mesh(&self, spec: &SolidSpec<D>, start: &Kinematics<D>, allowed: f64) -> Option<(usize, f64)> {
        let free = |role: &Role<D>| matches!(role, Role::Free(_));
        let depth = |(i, other): (usize, &Solid<D>)| {
            let meets = !other.boundary.is_empty() && (free(&spec.role) || free(&other.spec.role));
            let (new, old) = ((spec, &start.pose), (&other.spec, &other.kinematics.pose));
            let within = [(new, old), (old, new)].into_iter().filter(|_| meets);
            Some((i, within.filter_map(|(inner, outer)| depth_inside_mesh(inner, outer, allowed)).reduce(f64::max)?))
        };
        let depths = self.system.solids().iter().enumerate().filter_map(depth);
        depths.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Lets a solid come into water and world, unchecked and without making room for it.
    fn insert_solid(&mut self, spec: SolidSpec<D>, start: Kinematics<D>) -> Result<()> {
        let free = matches!(spec.role, Role::Free(_));
        let founding = free && !self.bodies.has_external_bodies();
        match self.bodies.engine_mut() {
            Some(engine) => engine.add_body(&spec, &start)?,
            None if founding => {
                let solids: Vec<_> =
                    self.system.solids().iter().map(|s| s.spec.clone()).chain([spec.clone()]).collect();
                let starts: Vec<_> = self.system.solids().iter().map(|s| s.kinematics).chain([start]).collect();
                let (gravity, dp) = (self.system.gravity(), self.system.model().dp);
                self.bodies.set_engine(Dim::<D>::engine(&solids, &starts, &Constraints::default(), &gravity, dp)?);
            }
            None => {}
        }
        self.system.add_body(spec, start)?;
        let last = self.system.solids().len() - 1;
        self.bodies.add_body(AcousticAddedMass::for_solid(&mut self.system, last), start);
        #[cfg(feature = "gpu")]
        on_device::note_other_solids(self);
        Ok(())
    }
}

impl<const D: usize> Simulation<D> {
    /// Removes solid number `solid` between two steps; water flows into its place. The solid keeps its number, name and position,
    /// but has no boundary particles and no load any more. Impulse that the water had not yet passed to the solid returns to the
    /// water.
    ///
    /// # Errors
    /// `Usage` if there is no such solid, or if a constraint holds it: the message names the constraint.
    pub fn remove_solid(&mut self, solid: usize) -> Result<()> {
        (self.compiled.remove_solid)(self, solid)
    }

    pub(super) fn take_out_solid(&mut self, solid: usize) -> Result<()> {
        let Some(there) = self.system.solids().get(solid) else {
            let last = self.system.solids().len();
            return Err(Error::new(ErrorKind::Usage, format!("there is no solid number {solid}")).help(format!(
                "they are numbered from 0, and there are {last}; find_solid tells the number of a name"
            )));
        };
        if let Some(tie) = self.system.constraints().constraint_on(solid, self.clock.time) {
            return Err(Error::new(ErrorKind::Usage, format!("{tie} is tied to solid {:?}", there.spec.name))
                .help("only what nothing is tied to can be removed"));
        }
        if there.boundary.is_empty() {
            return Ok(());
        }
        let pending = self.bodies.pending_impulse(solid);
        let energy = return_impulse(&mut self.system, solid, &pending).map_or(0.0, |transfer| transfer.energy);
        if let Some(accounting) = &mut self.bodies.accounting {
            accounting.add_returned(energy);
            accounting.add_solid_energy(-self.system.solids()[solid].energy(&self.system.potential_gravity()));
        }
        self.delete_solid(solid);
        let reordering = self.system.rebuild_neighbours();
        self.finish_change(reordering);
        Ok(())
    }

    /// Removes the solids whose time is over.
    pub(super) fn remove_due(&mut self) -> Result<()> {
        let due: Vec<usize> = self.bodies.constraints().due_removals(self.clock.time).collect();
        for solid in due {
            if !self.system.solids()[solid].boundary.is_empty() {
                self.remove_solid(solid)?;
                let name = self.system.solids()[solid].spec.name.clone();
                self.bodies.constraints_mut().record_removal(&name, self.clock.time);
            }
        }
        Ok(())
    }

    /// Those of `solids` that are still there and whose removal is part of the set-up.
    pub(super) fn planned_removals(&self, solids: &[u32]) -> Vec<usize> {
        let there = |solid: usize| self.system.solids().get(solid).is_some_and(|solid| !solid.boundary.is_empty());
        let planned = |solid: &usize| there(*solid) && self.bodies.constraints().plans_removal(*solid);
        solids.iter().map(|solid| *solid as usize).filter(planned).collect()
    }

    /// Takes solids out of water and world, before the state after that is restored.
    pub(super) fn delete_solids(&mut self, solids: &[usize]) {
        solids.iter().for_each(|solid| self.delete_solid(*solid));
    }

    /// Takes a solid out of water and world.
    fn delete_solid(&mut self, solid: usize) {
        let skin = self.system.solids()[solid].boundary.clone();
        self.bodies.remove_body(solid, skin.len() as u32);
        self.system.remove_body(solid);
        #[cfg(feature = "gpu")]
        on_device::note_other_solids(self);
    }

    /// Completes a change of the solids: restarts the stepper, records the removed particles, and computes the rates.
    fn finish_change(&mut self, reordering: Option<Reordering<D>>) {
        self.stepper.reset();
        if let (Some(accounting), Some(reordering)) = (&mut self.bodies.accounting, &reordering) {
            accounting.add_removed(&self.system, &reordering.removed);
        }
        self.removed.extend(
            reordering.into_iter().flat_map(|reordering| reordering.removed).map(|lost| (self.clock.time, lost)),
        );
        let log = std::mem::take(&mut self.rollback.log);
        self.rollback.restart(log);
        self.system.update_rates(RequestedSums::Rates);
    }
}
