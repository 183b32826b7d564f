//! The discharge of a periodic channel and the body force that holds it.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeScope, require_true};
use crate::{
    error::{Error, ErrorKind, Result},
    simulation::Simulation,
    system::System,
};

/// Plan of a probe of the current.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurrentPlan;

impl ProbeDefinition for CurrentPlan {
    type Config = bool;
    const LABEL: &'static str = "current and the force that holds it";
    const EXAMPLE: &'static str = "current = true";

    fn verify(config: &bool, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        require_true(*config, key, scene)?;
        match scene.has_current() {
            true => Ok(()),
            false => {
                let help = "write  current = { along = \"x\", discharge = 0.1 }  at the top of the scene";
                Err(scene.error_with_help(key, "the scene holds no current", help))
            }
        }
    }

    fn from_config(_: &bool) -> Self {
        Self
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        match &system.driving().current {
            Some(current) => Ok(Box::new(CurrentProbe { axis: current.axis })),
            None => Err(Error::new(ErrorKind::Usage, "the setup holds no current")),
        }
    }
}

/// Measures the discharge along the axis of the current, and the acceleration by the body force that maintains it.
pub struct CurrentProbe {
    axis: usize,
}

impl<const D: usize> Probe<D> for CurrentProbe {
    fn columns(&self) -> Vec<String> {
        let discharge = if D == 2 { "discharge_m2ps" } else { "discharge_m3ps" };
        vec![discharge.into(), "acceleration_mps2".into()]
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        let system = sim.system();
        vec![system.discharge(self.axis).unwrap_or(f64::NAN), system.current_acceleration()]
    }
}
