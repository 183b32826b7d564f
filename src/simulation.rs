//! Simulation (stub: written meanwhile).
use crate::{
    error::Result,
    model::Model,
    solid::{Dim, HasEngine, SolidSpec},
    space::{Bounds, Vector},
    system::System,
};
/// What a simulation starts from.
pub struct Setup<const D: usize> {
    pub model: Model,
    pub water: Vec<Vector<D>>,
    pub still_level: f64,
    pub solids: Vec<SolidSpec<D>>,
    pub domain: Option<Bounds<D>>,
}
/// A running simulation.
pub struct Simulation<const D: usize> {
    system: System<D>,
}
impl<const D: usize> Simulation<D> {
    pub fn new(_setup: Setup<D>) -> Result<Self>
    where
        Dim<D>: HasEngine<D>,
    {
        unimplemented!()
    }
    pub fn step(&mut self) -> Result<()> {
        unimplemented!()
    }
    pub fn step_to(&mut self, _t: f64) -> Result<()> {
        unimplemented!()
    }
    pub fn time(&self) -> f64 {
        unimplemented!()
    }
    pub fn dt(&self) -> f64 {
        unimplemented!()
    }
    pub fn steps(&self) -> u64 {
        unimplemented!()
    }
    pub fn passes(&self) -> u64 {
        unimplemented!()
    }
    pub fn system(&self) -> &System<D> {
        &self.system
    }
    pub fn push(&mut self, _solid: usize, _force: &Vector<D>, _at: &Vector<D>) {
        unimplemented!()
    }
    pub fn save(&self) -> Result<Vec<u8>> {
        unimplemented!()
    }
    pub fn restore(&mut self, _bytes: &[u8]) -> Result<()> {
        unimplemented!()
    }
}
