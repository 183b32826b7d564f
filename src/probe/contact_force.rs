//! Contact forces of two solids, or of all pairs of solids that touch.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeConfig, ProbeDefinition, ProbeReads, ProbeScope, axes, empty_row, find_solid, require_true};
use crate::{error::Result, math::Vector, simulation::Simulation, solid::ContactForce, system::System};

/// Example of a section with a list of contacts.
pub(super) const LIST_EXAMPLE: &str = "contacts = true";

/// Plan of a probe of the contact of two solids.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactForcePlan {
    /// Names of the two solids.
    pub between: [String; 2],
}

impl ProbeDefinition for ContactForcePlan {
    type Config = [String; 2];
    const LABEL: &'static str = "contact";
    const EXAMPLE: &'static str = "contact = [\"crate\", \"raft\"]";

    fn verify(config: &[String; 2], key: &str, scene: &dyn ProbeScope) -> Result<()> {
        config.iter().try_for_each(|name| scene.require_solid(key, name))?;
        scene.require_contact(key, config)
    }

    fn from_config(config: &[String; 2]) -> Self {
        Self { between: config.clone() }
    }

    fn default_name([first, second]: &[String; 2]) -> Option<String> {
        Some(format!("{first}_{second}_contact"))
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        let [first, second] = &self.between;
        Ok(Box::new(ContactForceProbe::new(system, [first, second])?))
    }
}

/// Plan of a list of all contacts. Each reading writes a row for each pair of solids that touches.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ContactListPlan {
    /// Stem of the file; no probe of the scene has the same stem.
    pub name: String,
    /// Simulated time from one reading to the next, s.
    pub every: f64,
}

/// Checks the section of a list of contacts.
pub(super) fn verify_list(config: &ProbeConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
    let Some(given) = config.contacts else { return Ok(()) };
    require_true(given, &format!("{key}.contacts"), scene)?;
    if config.average.is_none() {
        return Ok(());
    }
    let help = "remove it; the mean of one pair is that of  contact = [\"crate\", \"raft\"]";
    Err(scene.error_with_help(&format!("{key}.average"), "a list of contacts takes no means", help))
}

/// Measures the contact of two solids in the last step: the sum of the normal forces (N), the force on the second solid
/// with friction (N), and its point of action (m). The point is NaN if the solids do not touch.
/// All columns are NaN before the first step.
pub(crate) struct ContactForceProbe {
    solids: [usize; 2],
}

impl ContactForceProbe {
    /// Creates the probe of the solids called `first` and `second`.
    ///
    /// # Errors
    /// `Scene` if there is no such solid.
    pub(crate) fn new<const D: usize>(system: &System<D>, [first, second]: [&str; 2]) -> Result<Self> {
        Ok(Self { solids: [find_solid(system, first)?, find_solid(system, second)?] })
    }
}

impl<const D: usize> Probe<D> for ContactForceProbe {
    fn reads(&self) -> ProbeReads {
        ProbeReads::Solids
    }

    fn columns(&self) -> Vec<String> {
        columns::<D>().collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        if sim.steps() == 0 || self.solids.iter().any(|&solid| sim.system().solids()[solid].is_removed()) {
            return empty_row::<D>(self);
        }
        let [first, second] = self.solids;
        let pair = [first.min(second), first.max(second)];
        match sim.contacts().iter().find(|contact| contact.between == pair) {
            Some(contact) => contact_values(contact, &contact.loads[usize::from(first < second)].force),
            None => [0.0; D].into_iter().chain([0.0]).chain([f64::NAN; D]).collect(),
        }
    }
}

/// Lists all contacts in the last step, with a row for each pair of solids that touches. A row contains the two names
/// and the columns of [`ContactForceProbe`]. The force acts on the second solid.
pub(crate) struct ContactList;

impl ContactList {
    /// Returns the names of the columns.
    pub(crate) fn columns<const D: usize>() -> Vec<String> {
        ["first", "second"].map(String::from).into_iter().chain(columns::<D>()).collect()
    }

    /// Returns the names of the two solids and the values of each pair, in the order of the scene.
    pub(crate) fn sample<const D: usize>(sim: &Simulation<D>) -> Vec<([&str; 2], Vec<f64>)> {
        let solids = sim.system().solids();
        let row = |contact: ContactForce<D>| {
            let names = contact.between.map(|i| solids[i].spec.name.as_str());
            (names, contact_values(&contact, &contact.loads[1].force))
        };
        sim.contacts().into_iter().map(row).collect()
    }
}

/// Returns the names of the columns of a contact.
fn columns<const D: usize>() -> impl Iterator<Item = String> {
    let wide = if D == 2 { "_per_m" } else { "" };
    let forces = axes::<D>().iter().map(move |a| format!("f{a}_N{wide}"));
    let places = axes::<D>().iter().map(|a| format!("{a}_m"));
    [format!("pressing_N{wide}")].into_iter().chain(forces).chain(places)
}

/// Returns the values of a contact with `force` (N) on one of the two solids.
fn contact_values<const D: usize>(contact: &ContactForce<D>, force: &Vector<D>) -> Vec<f64> {
    [contact.normal_force].into_iter().chain(force.iter().copied()).chain(contact.at.iter().copied()).collect()
}
