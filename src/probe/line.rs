//! Length and tension of a spring or a rope.

use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeReads, ProbeScope};
use crate::{
    error::Result,
    simulation::{Simulation, find_by_name},
    system::System,
};

/// Plan of a probe of the length and tension of a spring.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SpringPlan {
    /// The spring's name.
    pub spring: String,
}

impl ProbeDefinition for SpringPlan {
    type Config = String;
    const LABEL: &'static str = "spring";
    const EXAMPLE: &'static str = "spring = \"line\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_constraint(key, "spring", config)
    }

    fn from_config(config: &String) -> Self {
        Self { spring: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(config.clone())
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(LineProbe::spring(system, &self.spring)?))
    }
}

/// Plan of a probe of the length and tension of a rope.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RopePlan {
    /// The rope's name.
    pub rope: String,
}

impl ProbeDefinition for RopePlan {
    type Config = String;
    const LABEL: &'static str = "rope";
    const EXAMPLE: &'static str = "rope = \"rope\"";

    fn verify(config: &String, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_constraint(key, "rope", config)
    }

    fn from_config(config: &String) -> Self {
        Self { rope: config.clone() }
    }

    fn default_name(config: &String) -> Option<String> {
        Some(config.clone())
    }

    fn build<const D: usize>(&self, system: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(LineProbe::rope(system, &self.rope)?))
    }
}

/// Measures the length (m) of a spring, mooring line or rope and its tension (N; N/m in 2-D). The tension of a spring
/// in compression is negative. The tension of a rope that acts is NaN before the first step.
pub struct LineProbe {
    line: usize,
    rope: bool,
}

impl LineProbe {
    /// Creates the probe of the spring called `name`.
    ///
    /// # Errors
    /// `Scene` if there is no such spring.
    pub fn spring<const D: usize>(system: &System<D>, name: &str) -> Result<Self> {
        let springs = system.constraints().springs.iter();
        Ok(Self { line: find_by_name("spring", name, springs.map(|spring| spring.name.as_str()))?, rope: false })
    }

    /// Creates the probe of the rope called `name`.
    ///
    /// # Errors
    /// `Scene` if there is no such rope.
    pub(crate) fn rope<const D: usize>(system: &System<D>, name: &str) -> Result<Self> {
        let ropes = system.constraints().ropes.iter();
        Ok(Self { line: find_by_name("rope", name, ropes.map(|rope| rope.name.as_str()))?, rope: true })
    }
}

impl<const D: usize> Probe<D> for LineProbe {
    fn reads(&self) -> ProbeReads {
        ProbeReads::Solids
    }

    fn columns(&self) -> Vec<String> {
        vec!["length_m".into(), if D == 2 { "tension_N_per_m" } else { "tension_N" }.into()]
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        if !self.rope {
            let now = sim.spring_reading(self.line);
            return vec![now.length, now.tension];
        }
        let (now, is_unknown) = (sim.rope_reading(self.line), sim.steps() == 0 && sim.rope_acts(self.line));
        vec![now.length, if is_unknown { f64::NAN } else { now.tension }]
    }
}
