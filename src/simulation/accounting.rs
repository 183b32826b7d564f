//! The load breakdown and the energy budget of a running simulation. Disabled by default; no cost when disabled.

use super::{Dimension, Simulation};
use crate::{
    coupling::{Accounting, Bodies, EnergyBudget, LoadBreakdown},
    math::Vector,
    model::Viscosity,
    solid::Dim,
    sph::boundary::Slip,
    system::{System, set_gravity_at},
};

/// Steps between two power breakdowns if only the energy budget is enabled: one additional force pass in sixteen.
const INTERVAL: u32 = 8;

impl<const D: usize> Simulation<D> {
    /// Enables the load breakdown of free bodies: [`Simulation::load_breakdown`]. If viscosity acts between water and solids,
    /// every step makes another force pass for the viscous load; otherwise the breakdown costs nothing.
    pub fn enable_load_breakdown(&mut self)
    where
        Dim<D>: Dimension<D>,
    {
        let model = self.system.model();
        let drags = model.viscosity != Viscosity::None && model.slip != Slip::Free;
        let (energy, interval) = self.accounted();
        (self.compiled.account)(self, energy, if drags { Some(1) } else { interval });
    }

    /// Enables the energy budget: [`Simulation::energy_budget`]. Every eighth step takes another force pass.
    pub fn enable_energy_budget(&mut self)
    where
        Dim<D>: Dimension<D>,
    {
        let (_, interval) = self.accounted();
        (self.compiled.account)(self, true, Some(interval.unwrap_or(INTERVAL)));
    }

    /// Whether the energy budget is enabled already, and the interval of power breakdowns.
    fn accounted(&self) -> (bool, Option<u32>) {
        let accounting = self.bodies.accounting.as_ref();
        accounting.map_or((false, None), |accounting| (accounting.has_energy_budget(), accounting.power_interval()))
    }

    pub(super) fn begin_accounting(&mut self, energy: bool, interval: Option<u32>)
    where
        Dim<D>: Dimension<D>,
    {
        self.gather_water(true);
        self.bodies.accounting = Some(Accounting::new(&self.system, energy, interval));
    }

    /// The loads on free solid number `solid` in the last step by their origin, if the load breakdown is enabled.
    pub fn load_breakdown(&self, solid: usize) -> Option<&LoadBreakdown<D>> {
        self.bodies.accounting.as_ref().map(|accounting| accounting.breakdown(solid))
    }

    /// The energy budget since the start of the accounting, if it is enabled.
    pub fn energy_budget(&self) -> Option<&EnergyBudget> {
        self.bodies.accounting.as_ref().and_then(Accounting::budget)
    }
}

/// Sets gravity to that of time `t` (s), if it changes.
pub(super) fn change_gravity<const D: usize>(system: &mut System<D>, bodies: &mut Bodies<D>, t: f64) {
    let Some(change) = change_gravity_of_bodies(system, bodies, t) else { return };
    if let Some(accounting) = &mut bodies.accounting {
        accounting.add_gravity_change(system, &change, || {
            system.fluid().r.iter().map(|r| system.non_periodic(&change).dot(r)).sum()
        });
    }
}

/// Sets gravity to that of time `t` (s), without an entry in the energy budget. Returns the change, m/s², if it changes.
pub(super) fn change_gravity_of_bodies<const D: usize>(
    system: &mut System<D>,
    bodies: &mut Bodies<D>,
    t: f64,
) -> Option<Vector<D>> {
    let change = set_gravity_at(system, t)?;
    if let Some(engine) = bodies.engine_mut() {
        engine.set_gravity(&system.gravity());
    }
    Some(change)
}
