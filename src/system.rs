//! System (stub: written meanwhile).
use crate::{model::Model, particles::Particles, solid::Solid, space::Vector};
/// The system of water and solids at an instant.
pub struct System<const D: usize> {
    model: Model,
    fluid: Particles<D>,
    skin: Particles<D>,
    solids: Vec<Solid<D>>,
    dv: Vec<Vector<D>>,
}
impl<const D: usize> System<D> {
    pub fn model(&self) -> &Model {
        &self.model
    }
    pub fn fluid(&self) -> &Particles<D> {
        &self.fluid
    }
    pub fn skin(&self) -> &Particles<D> {
        &self.skin
    }
    pub fn solids(&self) -> &[Solid<D>] {
        &self.solids
    }
    pub fn solid(&self, name: &str) -> Option<usize> {
        self.solids.iter().position(|s| s.spec.name == name)
    }
    pub fn particle_mass(&self) -> f64 {
        unimplemented!()
    }
    pub fn pressure(&self, _rho: f64) -> f64 {
        unimplemented!()
    }
    pub fn fluid_dv(&self) -> &[Vector<D>] {
        &self.dv
    }
    pub fn gravity(&self) -> Vector<D> {
        unimplemented!()
    }
    pub fn water_near(&self, _x: &Vector<D>, _visit: &mut dyn FnMut(usize, f64)) {
        unimplemented!()
    }
    pub fn solid_near(&self, _x: &Vector<D>, _visit: &mut dyn FnMut(usize, f64)) {
        unimplemented!()
    }
}
