//! Energy drift of a run, shown while it goes on if a probe measures the energy.

use std::fmt;

use crate::{
    math::format::three_digits,
    output::CsvTable,
    plan::Plan,
    probe::{EnergyReading, relative_residual},
};

/// Energy drift since the start, by the latest reading of a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EnergyDrift {
    /// By a `budget`: its residual over the sum of its entries' magnitudes, –.
    Unaccounted(f64),
    /// By an `energy`: the change of the total since the start, and its unit, J or J/m.
    Changed(f64, &'static str),
}

impl EnergyDrift {
    /// By the last row of a `budget`; `None` while its entries are 0.
    pub fn from_budget(last: &[f64]) -> Option<Self> {
        relative_residual(last).map(Self::Unaccounted)
    }

    /// By the first and the last row of an `energy`, which ends with the total.
    pub fn from_energy(first: &[f64], last: &[f64], unit: &'static str) -> Option<Self> {
        Some(Self::Changed(last.last()? - first.last()?, unit))
    }
}

impl fmt::Display for EnergyDrift {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unaccounted(share) => write!(f, "energy off {} %", three_digits(100.0 * share)),
            Self::Changed(energy, unit) => {
                write!(f, "energy {}{} {unit}", if *energy < 0.0 { "" } else { "+" }, three_digits(*energy))
            }
        }
    }
}

/// The probe that measures the energy drift of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DriftMonitor {
    /// Its number in the plan.
    pub probe: usize,
    budget: bool,
    unit: &'static str,
}

impl DriftMonitor {
    /// The monitor of the first budget of `plan`, or else of its first energy probe, in `dimension` dimensions.
    pub(crate) fn from_plan(plan: &Plan, dimension: usize) -> Option<Self> {
        let find = |reading| plan.probes.iter().position(|probe| probe.kind.energy_reading() == Some(reading));
        let unit = if dimension == 2 { "J/m" } else { "J" };
        let of = |probe, budget| Self { probe, budget, unit };
        let budget = find(EnergyReading::Budget).map(|probe| of(probe, true));
        budget.or_else(|| find(EnergyReading::Total).map(|probe| of(probe, false)))
    }

    /// The drift by the rows of the probe's `table` so far.
    pub(crate) fn drift(self, table: &CsvTable) -> Option<EnergyDrift> {
        let (first, (_, last)) = (table.first_row()?, table.last_row()?);
        if self.budget { EnergyDrift::from_budget(last) } else { EnergyDrift::from_energy(first, last, self.unit) }
    }
}
