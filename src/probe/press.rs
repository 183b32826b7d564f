//! How two solids press on each other.

use super::{Probe, axes, find_solid};
use crate::{error::Result, simulation::Simulation, system::System};

/// Watches the contact of two solids in the last step: the sum of the normal forces (N), the force on the second, friction
/// included (N), and where it acts (m); NaN there while they do not touch.
pub struct Press {
    solids: [usize; 2],
}

impl Press {
    /// The probe of the solids of these names.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub fn new<const D: usize>(system: &System<D>, [first, second]: [&str; 2]) -> Result<Self> {
        Ok(Self { solids: [find_solid(system, first)?, find_solid(system, second)?] })
    }
}

impl<const D: usize> Probe<D> for Press {
    fn columns(&self) -> Vec<String> {
        let wide = if D == 2 { "_per_m" } else { "" };
        let forces = axes::<D>().iter().map(|a| format!("f{a}_N{wide}"));
        let places = axes::<D>().iter().map(|a| format!("{a}_m"));
        [format!("pressing_N{wide}")].into_iter().chain(forces).chain(places).collect()
    }

    fn look(&self, sim: &Simulation<D>) -> Vec<f64> {
        let [first, second] = self.solids;
        let pair = [first.min(second), first.max(second)];
        match sim.contacts().iter().find(|contact| contact.between == pair) {
            Some(contact) => {
                let force = contact.loads[usize::from(first < second)].force;
                [contact.pressing].into_iter().chain(force.iter().copied()).chain(contact.at.iter().copied()).collect()
            }
            None => [0.0; D].into_iter().chain([0.0]).chain([f64::NAN; D]).collect(),
        }
    }
}
