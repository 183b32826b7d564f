//! What a simulation starts from.

use super::{
    SpongeLayer,
    periodic::{self, Periodic},
    step_check::ParticleLimits,
};
use crate::{
    error::{Error, Result},
    math::{Bounds, Vector},
    model::Model,
    solid::{Constraints, SolidSpec},
};

/// What a simulation starts from.
#[derive(Clone, Debug)]
pub struct Setup<const D: usize> {
    /// The model.
    pub model: Model,
    /// Places of the water particles, m.
    pub water: Vec<Vector<D>>,
    /// Height of the still surface above each of them, m.
    pub surface_levels: Vec<f64>,
    /// Velocity of each of them, m/s; empty if all are at rest.
    pub velocity: Vec<Vector<D>>,
    /// Pressure of each beyond that of water at rest, Pa; empty if there is none.
    pub pressure: Vec<f64>,
    /// The solids.
    pub solids: Vec<SolidSpec<D>>,
    /// What ties them.
    pub constraints: Constraints<D>,
    /// Where particles may be; by default everything at the start, with its own largest extent around it.
    pub domain: Option<Bounds<D>>,
    /// Which sides are periodic.
    pub periodic: Periodic<D>,
    /// The valid range of a water particle.
    pub limits: ParticleLimits,
    /// Where water loses its motion.
    pub sponge_layers: Vec<SpongeLayer<D>>,
}

impl<const D: usize> Setup<D> {
    /// Water at rest at the places `water` (m) below the levels `levels` (m), and solids.
    pub fn new(model: Model, water: Vec<Vector<D>>, levels: Vec<f64>, solids: Vec<SolidSpec<D>>) -> Self {
        let (velocity, pressure, links, limits) =
            (Vec::new(), Vec::new(), Constraints::default(), ParticleLimits::default());
        let (domain, periodic, damping) = (None, [None; D], Vec::new());
        Self {
            model,
            water,
            surface_levels: levels,
            solids,
            constraints: links,
            velocity,
            pressure,
            domain,
            periodic,
            limits,
            sponge_layers: damping,
        }
    }

    /// Refuses a setup whose constants have no meaning.
    pub(crate) fn check(&self) -> Result<()> {
        let m = &self.model;
        let positive = [
            ("dp", m.dp),
            ("h", m.h),
            ("rho0", m.rho0),
            ("c0", m.c0),
            ("gamma", m.gamma),
            ("cfl", m.cfl),
            ("dt_max", m.dt_max),
        ];
        for (name, value) in positive {
            let finite = value.is_finite() || name == "dt_max";
            if !(value > 0.0 && finite) {
                return Err(Error::scene(format!("{name} must be a positive number, not {value}")));
            }
        }
        if m.support_radius() <= m.dp {
            return Err(Error::scene(format!("h must exceed dp/2 for particles to see one another, and is {} m", m.h)));
        }
        if m.gravity.len() != D || m.gravity.iter().any(|g| !g.is_finite()) {
            return Err(Error::scene(format!("gravity needs {D} finite components")));
        }
        if self.surface_levels.len() != self.water.len() {
            return Err(Error::scene("every water particle needs the level of its surface"));
        }
        let each = |n: usize| n == 0 || n == self.water.len();
        if !each(self.velocity.len()) || !each(self.pressure.len()) {
            return Err(Error::scene("velocities and pressures are given for every water particle or for none"));
        }
        if let Some(i) = self.water.iter().position(|r| r.iter().any(|x| !x.is_finite())) {
            return Err(Error::scene(format!("water particle {i} has no finite place")));
        }
        self.sponge_layers.iter().try_for_each(SpongeLayer::check)?;
        self.constraints.check(&self.solids)?;
        periodic::check(&self.periodic, m, &self.solids)
    }
}
