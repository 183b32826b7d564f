//! Loads on a free body in the last step, by kind, compared with the change of its momentum.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeScope, axes, empty_row, find_solid};
use crate::{
    coupling::LoadBreakdown,
    error::{Error, Result},
    simulation::{Dimension, Simulation},
    solid::{Dim, Load},
    system::System,
};

/// Loads on a free body, by kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LoadBalancePlan {
    /// The body's name.
    pub solid: String,
}

impl ProbeDefinition for LoadBalancePlan {
    type Config = String;
    const LABEL: &'static str = "loads by kind";
    const EXAMPLE: &'static str = "balance = \"box\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_solid(key, config)?;
        if scene.is_free(config) {
            return Ok(());
        }
        let what = format!("\"{config}\" is not free: what it weighs and carries is not known");
        let help = format!("the water's load on any solid is  force = \"{config}\"");
        Err(scene.error_with_help(key, &what, &help))
    }

    fn from_config(config: &String) -> Self {
        Self { solid: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(format!("{config}_balance"))
    }

    fn enable_records<const D: usize>(&self, sim: &mut Simulation<D>)
    where
        Dim<D>: Dimension<D>,
    {
        sim.enable_load_breakdown();
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(LoadBalanceProbe::new(system, &self.solid)?))
    }
}

/// Measures the loads on a free body: force (N) and torque about its centre of mass (N m) of pressure, viscosity,
/// weight, contacts, constraints and ballast, as far as the scene has them. The next columns are the sum of the loads, the
/// change of momentum and angular momentum, and the difference between the two. All columns are NaN before the first step, and
/// unless loads are recorded ([`Simulation::enable_load_breakdown`]).
pub(crate) struct LoadBalanceProbe {
    solid: usize,
    kinds: Vec<&'static str>,
}

impl LoadBalanceProbe {
    /// Creates the probe of the free solid called `name`.
    ///
    /// # Errors
    /// `Scene` if there is no such solid or the solid is not free.
    pub(crate) fn new<const D: usize>(system: &System<D>, name: &str) -> Result<Self> {
        let index = find_solid(system, name)?;
        let solid = &system.solids()[index];
        let Some(body) = &solid.body else {
            return Err(Error::scene(format!("\"{name}\" is not free: what it weighs and carries is not known"))
                .help("the water's load on any solid is  force = \"...\""));
        };
        let links = system.constraints();
        let held = links.holds.iter().any(|hold| hold.solid == index);
        let locked = body.locked_translations.iter().chain(&body.locked_rotations).any(|locked| *locked);
        let absent = [
            ("joints", links.joints.is_empty()),
            ("motors", links.joints.is_empty()),
            ("ropes", links.ropes.is_empty()),
            ("springs", links.springs.is_empty()),
            ("moorings", links.moorings.is_empty()),
            ("forces", links.forces.is_empty() && links.winds.is_empty()),
            ("ballast", solid.spec.ballast.is_empty()),
            ("locks", !(held || locked)),
        ];
        let all = LoadBreakdown::<D>::zero().kinds().map(|(kind, _)| kind);
        let kinds = all.into_iter().filter(|kind| !absent.contains(&(kind, true))).collect();
        Ok(Self { solid: index, kinds })
    }
}

/// Returns the components of a load: force, then torque.
fn load_components<const D: usize>(load: &Load<D>) -> Vec<f64> {
    load.force.iter().copied().chain(load.torque.axial()).collect()
}

impl<const D: usize> Probe<D> for LoadBalanceProbe {
    fn columns(&self) -> Vec<String> {
        let own: Vec<String> = match D {
            2 => ["fx_N_per_m", "fy_N_per_m", "torque_Nm_per_m"].map(String::from).to_vec(),
            _ => {
                let forces = axes::<D>().iter().map(|a| format!("f{a}_N"));
                forces.chain(axes::<D>().iter().map(|a| format!("t{a}_Nm"))).collect()
            }
        };
        let groups = self.kinds.iter().copied().chain(["sum", "change", "residual"]);
        groups.flat_map(|group| own.iter().map(move |name| format!("{group}_{name}"))).collect()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let is_known = sim.steps() > 0 && !sim.system().solids()[self.solid].is_removed();
        let Some(shares) = sim.load_breakdown(self.solid).filter(|_| is_known) else {
            return empty_row::<D>(self);
        };
        let kinds = shares.kinds().into_iter().filter(|(kind, _)| self.kinds.contains(kind)).map(|(_, load)| load);
        kinds.chain([shares.sum(), shares.change, shares.residual()]).flat_map(|load| load_components(&load)).collect()
    }
}
