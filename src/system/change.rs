//! Solids that come and go: their boundary particles, and the water in their place.

use std::ops::Range;

use rayon::prelude::*;

use super::{Renewal, System, hem::Stitch, walls};
use crate::{
    error::{Error, Result},
    law::wall::Slip,
    model::Walls,
    solid::{Kinematics, Load, Role, Solid, SolidSpec},
    space::{Bounds, Vector, Wedge},
};

impl<const D: usize> System<D> {
    /// Gives a solid that moves as `kinematics` its boundary particles, behind all others, the `hem` last.
    pub(super) fn join(&mut self, spec: SolidSpec<D>, kinematics: Kinematics<D>, hem: &[Stitch<D>]) -> Result<()> {
        let (model, first) = (&self.model, self.skin.len());
        let mut faces = spec.shape.skin(model.dp, model.layers()).into_iter().map(|point| point.r).collect::<Vec<_>>();
        for r in faces.iter().chain(hem.iter().map(|stitch| &stitch.r)) {
            self.skin.push(kinematics.pose.point(r), self.medium.rho0);
            self.local.push(*r);
        }
        faces.extend(hem.iter().map(|stitch| stitch.of));
        if self.skin.len() == first {
            return Err(Error::scene(format!("solid {:?} is too small for a single boundary particle", spec.name))
                .help("make it larger or dp smaller"));
        }
        if model.slip == Slip::None || model.walls == Walls::Settling {
            self.depths.par_extend(faces.par_iter().map(|r| -spec.shape.signed_distance(r)));
        }
        if model.slip == Slip::None {
            self.normals.par_extend(faces.par_iter().map(|r| spec.shape.outward(r, 0.05 * model.dp)));
        }
        self.boxes.push(Bounds::around(&self.local[first..]));
        let load = Load::zero();
        let (acceleration, whirl, skin) = (Vector::zeros(), Wedge::zero(), first..self.skin.len());
        let yielding = Default::default();
        self.solids.push(Solid { spec, kinematics, acceleration, whirl, skin, load, yielding });
        Ok(())
    }

    /// Marks the boundary particles beside which water is not shifted.
    pub(super) fn mark(&mut self) {
        if self.model.shift().is_none() {
            return;
        }
        self.marks = vec![false; self.skin.len()];
        for solid in &self.solids {
            self.marks[solid.skin.clone()].fill(walls::held(&self.model, solid));
        }
    }

    /// Lets a solid come that moves as `kinematics`; a refusal leaves all as it was. Lists are due then.
    pub(crate) fn admit(&mut self, spec: SolidSpec<D>, kinematics: Kinematics<D>) -> Result<()> {
        self.join(spec, kinematics, &[])?;
        let last = self.solids.len() - 1;
        self.mark();
        self.place(last);
        (self.built, self.changed) = (None, true);
        Ok(())
    }

    /// Takes out the water inside the last solid, whose boundary particles begin with the pressure of the water that is left;
    /// returns what whoever keeps arrays of particles must follow, how many particles went, and their energy (J).
    pub(crate) fn displace(&mut self) -> (Option<Renewal<D>>, usize, f64) {
        let (before, mut energy) = (self.real(), 0.0);
        if let Some(solid) = self.solids.last() {
            let pose = solid.kinematics.pose;
            let inside = |x: &Vector<D>| solid.spec.shape.signed_distance(&pose.local(x)) < 0.0;
            self.ousted = self.fluid.r[..before].par_iter().map(inside).collect();
            let fluid = &self.fluid;
            let gone = (0..before).filter(|&i| self.ousted[i]);
            energy = gone.map(|i| self.particle_energy(&fluid.r[i], &fluid.v[i], fluid.rho[i])).sum();
        }
        let renewal = self.renew();
        self.ousted.clear();
        let newcomer = self.solids.last().map_or(0..0, |solid| solid.skin.clone());
        self.still_skin(newcomer);
        self.look();
        (renewal, before - self.real(), energy)
    }

    /// Takes solid number `i` out: it keeps its number, stands still where it was, and has no boundary particles any more.
    pub(crate) fn oust(&mut self, i: usize) {
        let gone = self.solids[i].skin.clone();
        let Self { skin, local, depths, normals, shown, goals, .. } = self;
        for vectors in [&mut skin.r, &mut skin.v, local, normals, shown] {
            cut(vectors, &gone);
        }
        cut(&mut skin.rho, &gone);
        cut(depths, &gone);
        cut(goals, &gone);
        skin.id.truncate(skin.r.len());
        self.near.shift_wet(gone.clone());
        self.boxes[i] = Bounds { min: Vector::zeros(), max: Vector::zeros() };
        let solid = &mut self.solids[i];
        solid.spec.role = Role::Fixed;
        (solid.kinematics.velocity, solid.kinematics.spin) = (Vector::zeros(), Wedge::zero());
        (solid.acceleration, solid.whirl) = (Vector::zeros(), Wedge::zero());
        solid.load = Load::zero();
        solid.skin = gone.start..gone.start;
        for later in &mut self.solids[i + 1..] {
            later.skin = later.skin.start - gone.len()..later.skin.end - gone.len();
        }
        self.mark();
        self.built = None;
    }
}

/// Takes `gone` out of an array that may be shorter.
fn cut<T>(array: &mut Vec<T>, gone: &Range<usize>) {
    let end = gone.end.min(array.len());
    array.drain(gone.start.min(end)..end);
}
