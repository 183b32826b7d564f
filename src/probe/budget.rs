//! Where energy came from and went since the start, and what of it is not accounted for.

use super::{EnergyProbe, Probe};
use crate::{coupling::EnergyBudget, simulation::Simulation, system::System};

/// Watches what water and bodies have stored since the start (J; J/m in 2-D): energy of motion, height and compression; every entry
/// of the [`EnergyBudget`]; and what is stored beyond their sum. Nothing but NaN unless energy is booked
/// ([`Simulation::enable_energy_budget`]).
pub struct EnergyBudgetProbe {
    energy: EnergyProbe,
    start: f64,
}

/// What the residual of a row of a [`EnergyBudgetProbe`] is over all that was turned over, –; none before anything was.
pub fn relative_residual(row: &[f64]) -> Option<f64> {
    let (residual, rest) = row.split_last()?;
    let turned: f64 = rest.get(1..)?.iter().map(|energy| energy.abs()).sum();
    (turned > 0.0).then(|| residual.abs() / turned)
}

impl EnergyBudgetProbe {
    /// The probe; the store counts from now.
    pub fn new<const D: usize>(system: &System<D>) -> Self {
        let energy = EnergyProbe::new(system);
        let start = energy.total(system);
        Self { energy, start }
    }
}

impl<const D: usize> Probe<D> for EnergyBudgetProbe {
    fn columns(&self) -> Vec<String> {
        let unit = if D == 2 { "J_per_m" } else { "J" };
        let entries = EnergyBudget::default().entries().map(|(name, _)| name);
        ["stored"].into_iter().chain(entries).chain(["residual"]).map(|name| format!("{name}_{unit}")).collect()
    }

    fn cumulative_columns(&self) -> usize {
        Probe::<D>::columns(self).len()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let Some(ledger) = sim.energy_budget() else { return vec![f64::NAN; Probe::<D>::columns(self).len()] };
        let stored = self.energy.total(sim.system()) - self.start;
        let entries = ledger.entries().map(|(_, energy)| energy);
        let residual = stored - entries.iter().sum::<f64>();
        [stored].into_iter().chain(entries).chain([residual]).collect()
    }
}
