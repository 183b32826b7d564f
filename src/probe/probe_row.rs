//! Several probes of one kind as one probe. The names of its columns contain the places.

use super::Probe;
use crate::{
    error::Result,
    math::{Bounds, format::decimals},
    simulation::Simulation,
    system::System,
};

/// A row of probes. The column `eta_m` of the probe at x = 1.5 m is called `eta_at_1.5_m`.
pub struct ProbeRow<const D: usize> {
    members: Vec<(Vec<f64>, Box<dyn Probe<D>>)>,
}

impl<const D: usize> ProbeRow<D> {
    /// Creates a row with a probe at each of `places` (m). For a single place it returns the probe itself.
    ///
    /// # Errors
    /// The errors of `make`.
    pub(crate) fn at_places(
        places: &[Vec<f64>],
        make: impl Fn(&[f64]) -> Result<Box<dyn Probe<D>>>,
    ) -> Result<Box<dyn Probe<D>>> {
        match places {
            [at] => make(at),
            _ => {
                let members: Result<Vec<_>> = places.iter().map(|at| Ok((at.clone(), make(at)?))).collect();
                Ok(Box::new(Self::new(members?)))
            }
        }
    }

    /// Creates a row of the probes in `members`, each with its place (m).
    pub fn new(members: Vec<(Vec<f64>, Box<dyn Probe<D>>)>) -> Self {
        Self { members }
    }
}

/// Returns the name of the column `column` at the place `at` (m), to a micrometre.
pub(crate) fn column_at_place(column: &str, at: &[f64]) -> String {
    let rounded = at.iter().map(|x| decimals(*x, 6));
    let place = rounded.collect::<Vec<_>>().join("_");
    match column.rsplit_once('_') {
        Some((name, unit)) => format!("{name}_at_{place}_{unit}"),
        None => format!("{column}_at_{place}"),
    }
}

impl<const D: usize> Probe<D> for ProbeRow<D> {
    fn columns(&self) -> Vec<String> {
        let each = self.members.iter();
        each.flat_map(|(at, probe)| probe.columns().into_iter().map(|column| column_at_place(&column, at))).collect()
    }

    fn water_ranges(&self, system: &System<D>) -> Option<Vec<Bounds<D>>> {
        let each = self.members.iter().map(|(_, probe)| probe.water_ranges(system));
        each.collect::<Option<Vec<_>>>().map(|ranges| ranges.concat())
    }

    fn read_start(&mut self, system: &System<D>) {
        self.members.iter_mut().for_each(|(_, probe)| probe.read_start(system));
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        self.members.iter().flat_map(|(_, probe)| probe.sample(sim)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::column_at_place;

    #[test]
    fn a_place_is_written_without_the_noise_of_round_off() {
        let columns = [
            column_at_place("eta_m", &[0.1 + 0.2]),
            column_at_place("vx_mps", &[-0.5, 2.0]),
            column_at_place("p_Pa", &[-1e-9, 0.0]),
        ];
        assert_eq!(columns, ["eta_at_0.3_m", "vx_at_-0.5_2_mps", "p_at_0_0_Pa"]);
    }
}
