//! How solids press on each other: two of them, or all that touch.

use super::{Probe, axes, find_solid};
use crate::{error::Result, math::Vector, simulation::Simulation, solid::ContactForce, system::System};

/// Watches the contact of two solids in the last step: the sum of the normal forces (N), the force on the second, friction
/// included (N), and where it acts (m); NaN there while they do not touch.
pub struct ContactForceProbe {
    solids: [usize; 2],
}

impl ContactForceProbe {
    /// The probe of the solids of these names.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub fn new<const D: usize>(system: &System<D>, [first, second]: [&str; 2]) -> Result<Self> {
        Ok(Self { solids: [find_solid(system, first)?, find_solid(system, second)?] })
    }
}

impl<const D: usize> Probe<D> for ContactForceProbe {
    fn columns(&self) -> Vec<String> {
        columns::<D>().collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let [first, second] = self.solids;
        let pair = [first.min(second), first.max(second)];
        match sim.contacts().iter().find(|contact| contact.between == pair) {
            Some(contact) => contact_values(contact, &contact.loads[usize::from(first < second)].force),
            None => [0.0; D].into_iter().chain([0.0]).chain([f64::NAN; D]).collect(),
        }
    }
}

/// Lists all contacts in the last step: a row for each pair that presses on each other, with the columns of [`ContactForceProbe`] behind
/// the names of the two. The force is that on the second.
pub struct ContactList;

impl ContactList {
    /// Names of the columns.
    pub fn columns<const D: usize>() -> Vec<String> {
        ["first", "second"].map(String::from).into_iter().chain(columns::<D>()).collect()
    }

    /// The names of the two solids of each pair and its numbers, in the order of the scene.
    pub fn sample<const D: usize>(sim: &Simulation<D>) -> Vec<([&str; 2], Vec<f64>)> {
        let solids = sim.system().solids();
        let row = |contact: ContactForce<D>| {
            let names = contact.between.map(|i| solids[i].spec.name.as_str());
            (names, contact_values(&contact, &contact.loads[1].force))
        };
        sim.contacts().into_iter().map(row).collect()
    }
}

/// Names of what is told of a contact, units included.
fn columns<const D: usize>() -> impl Iterator<Item = String> {
    let wide = if D == 2 { "_per_m" } else { "" };
    let forces = axes::<D>().iter().map(move |a| format!("f{a}_N{wide}"));
    let places = axes::<D>().iter().map(|a| format!("{a}_m"));
    [format!("pressing_N{wide}")].into_iter().chain(forces).chain(places)
}

/// What is told of a contact with such a `force` (N) on one of the two.
fn contact_values<const D: usize>(contact: &ContactForce<D>, force: &Vector<D>) -> Vec<f64> {
    [contact.normal_force].into_iter().chain(force.iter().copied()).chain(contact.at.iter().copied()).collect()
}
