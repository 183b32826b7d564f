//! Energy budget since the start: sources, sinks and the residual.

use serde::{Deserialize, Serialize};

use super::{EnergyProbe, EnergyReading, Probe, ProbeDefinition, ProbeScope, require_true};
use crate::{
    coupling::EnergyBudget,
    error::Result,
    simulation::{Dimension, Simulation},
    solid::Dim,
    system::System,
};

/// The energy budget of water and bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyBudgetPlan;

impl ProbeDefinition for EnergyBudgetPlan {
    type Config = bool;
    const LABEL: &'static str = "energy budget";
    const EXAMPLE: &'static str = "budget = true";

    fn verify(config: &bool, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        require_true(*config, key, scene)
    }

    fn from_config(_: &bool) -> Self {
        Self
    }

    fn energy_reading(&self) -> Option<EnergyReading> {
        Some(EnergyReading::Budget)
    }

    // Energies at one instant add up to the stored energy.
    fn is_cumulative(&self, _: &str) -> bool {
        true
    }

    fn enable_records<const D: usize>(&self, sim: &mut Simulation<D>)
    where
        Dim<D>: Dimension<D>,
    {
        sim.enable_energy_budget();
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(EnergyBudgetProbe::new(system)))
    }
}

/// Measures the energy (J; J/m in 2-D) that water and bodies have stored since the start: kinetic, potential and
/// compression energy. The next columns are the entries of the [`EnergyBudget`]. The last column is the stored energy
/// less the sum of these entries. All columns are NaN unless the budget is recorded
/// ([`Simulation::enable_energy_budget`]).
pub struct EnergyBudgetProbe {
    energy: EnergyProbe,
    start: f64,
}

/// Returns the residual of a row of an [`EnergyBudgetProbe`], divided by the sum of |entries|, –. Returns `None` if
/// that sum is 0.
pub(crate) fn relative_residual(row: &[f64]) -> Option<f64> {
    let (residual, rest) = row.split_last()?;
    let turnover: f64 = rest.get(1..)?.iter().map(|energy| energy.abs()).sum();
    (turnover > 0.0).then(|| residual.abs() / turnover)
}

impl EnergyBudgetProbe {
    /// Creates the probe. The stored energy counts from the present state of `system`.
    pub fn new<const D: usize>(system: &System<D>) -> Self {
        let energy = EnergyProbe::new(system);
        let start = energy.total(system);
        Self { energy, start }
    }
}

impl<const D: usize> Probe<D> for EnergyBudgetProbe {
    fn read_start(&mut self, system: &System<D>) {
        *self = Self::new(system);
    }

    fn columns(&self) -> Vec<String> {
        let unit = if D == 2 { "J_per_m" } else { "J" };
        let entries = EnergyBudget::default().entries().map(|(name, _)| name);
        ["stored"].into_iter().chain(entries).chain(["residual"]).map(|name| format!("{name}_{unit}")).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let Some(budget) = sim.energy_budget() else { return vec![f64::NAN; Probe::<D>::columns(self).len()] };
        let stored = self.energy.total(sim.system()) - self.start;
        let entries = budget.entries().map(|(_, energy)| energy);
        let residual = stored - entries.iter().sum::<f64>();
        [stored].into_iter().chain(entries).chain([residual]).collect()
    }
}
