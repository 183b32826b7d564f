//! Flow and volume through a section, as in wave overtopping.
//!
//!   q = Σ V_b v_b·n w(s_b),   w(s) = (1 − |s|/a)/a  for |s| < a = 2 dp
//!
//! The sum is over the particles whose projection lies on the section; s is their distance from it. For rows of particles dp
//! apart, the weights times dp sum to 1 wherever the section lies between them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Probe, ProbeDefinition, ProbeLocation, ProbeScope};
use crate::{
    error::{Error, ErrorKind, Result},
    math::Vector,
    simulation::Simulation,
    system::System,
};

/// A section that water flows through: a segment in 2-D, a rectangle perpendicular to an axis in 3-D.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SectionConfig {
    /// One end or corner, m.
    pub from: Vec<f64>,
    /// The opposite end or corner, m.
    pub to: Vec<f64>,
}

/// Plan of a probe of the flow through a section.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FlowPlan {
    /// One end or corner, m.
    pub from: Vec<f64>,
    /// The opposite end or corner, m.
    pub to: Vec<f64>,
}

impl ProbeDefinition for FlowPlan {
    type Config = SectionConfig;
    const LABEL: &'static str = "flow through a section";
    const EXAMPLE: &'static str =
        "flow = { from = [1.0, 0.3], to = [1.0, 0.6] }        # positive to the right: along x, if upwards";

    fn verify(SectionConfig { from, to }: &SectionConfig, key: &str, scene: &dyn ProbeScope) -> Result<()> {
        scene.require_vector(&format!("{key}.from"), from)?;
        scene.require_vector(&format!("{key}.to"), to)?;
        let flat = from.iter().zip(to).filter(|(a, b)| a == b).count();
        match scene.dimension() {
            2 if flat == 2 => Err(scene.error_at(key, "a section from a point to itself has no length")),
            3 if flat != 1 => {
                let help = "write  flow = { from = [1.0, 0.0, 0.3], to = [1.0, 0.5, 0.6] }";
                Err(scene.error_with_help(key, NO_RECTANGLE, help))
            }
            _ => Ok(()),
        }
    }

    fn from_config(SectionConfig { from, to }: &SectionConfig) -> Self {
        Self { from: from.clone(), to: to.clone() }
    }

    fn location(&self) -> Option<ProbeLocation<'_>> {
        Some(ProbeLocation::Section([&self.from, &self.to]))
    }

    fn is_cumulative(&self, column: &str) -> bool {
        column.starts_with("volume_")
    }

    fn build<const D: usize>(&self, _: &System<D>) -> Result<Box<dyn Probe<D>>> {
        Ok(Box::new(FlowProbe::new(&self.from, &self.to)?))
    }
}

/// Half the thickness of the layer over which the flow is averaged, a/dp.
const HALF_THICKNESS: f64 = 2.0;

const NO_RECTANGLE: &str = "a section in 3-D is a rectangle: its corners have one coordinate in common, and only one";

/// Measures the flow through a section (m³/s; m²/s in 2-D) and the net volume (m³; m²) since the start.
pub struct FlowProbe<const D: usize> {
    middle: Vector<D>,
    normal: Vector<D>,
    /// Directions of the section's sides and half their lengths, m.
    sides: Vec<(Vector<D>, f64)>,
}

impl<const D: usize> FlowProbe<D> {
    /// Creates the probe of the flow through the segment between two points (m) in 2-D. Flow to the right of the
    /// direction from `from` to `to` is positive: along x if that direction points up. In 3-D the points are opposite
    /// corners of a rectangle, and flow along its normal axis is positive.
    ///
    /// # Errors
    /// `Usage` if there is no such section.
    pub fn new(from: &[f64], to: &[f64]) -> Result<Self> {
        let (from, to) = (super::point::<D>(from, D)?, super::point::<D>(to, D)?);
        let (middle, across) = (0.5 * (from + to), to - from);
        let axis = |i: usize| Vector::<D>::from_fn(|k, _| f64::from(u8::from(k == i)));
        let flat: Vec<usize> = (0..D).filter(|&i| across[i] == 0.0).collect();
        if D == 2 && across.norm() > 0.0 {
            let along = across / across.norm();
            let normal = Vector::from_fn(|i, _| if i == 0 { along[1] } else { -along[0] });
            return Ok(Self { middle, normal, sides: vec![(along, 0.5 * across.norm())] });
        }
        if D == 3 && flat.len() == 1 {
            let sides = (0..D).filter(|i| *i != flat[0]).map(|i| (axis(i), 0.5 * across[i].abs()));
            return Ok(Self { middle, normal: axis(flat[0]), sides: sides.collect() });
        }
        Err(Error::new(ErrorKind::Usage, if D == 2 { "a section of no length" } else { NO_RECTANGLE }))
    }

    /// Returns the present flow.
    fn flow(&self, system: &System<D>) -> f64 {
        let (fluid, half) = (system.water_and_buffers(), HALF_THICKNESS * system.model().dp);
        let mut sum = 0.0;
        for ((r, v), rho) in fluid.r.iter().zip(fluid.v).zip(fluid.rho) {
            let off = minimum_image(r - self.middle, system);
            let s = off.dot(&self.normal).abs();
            if s < half && self.sides.iter().all(|(along, length)| off.dot(along).abs() <= *length) {
                sum += system.particle_mass() / rho * v.dot(&self.normal) * (1.0 - s / half) / half;
            }
        }
        sum
    }
}

/// Returns the shortest vector equivalent to `off` (m) across periodic sides.
fn minimum_image<const D: usize>(mut off: Vector<D>, system: &System<D>) -> Vector<D> {
    for (x, side) in off.iter_mut().zip(system.periodic()) {
        if let Some([from, to]) = side {
            *x -= (to - from) * (*x / (to - from)).round();
        }
    }
    off
}

impl<const D: usize> Probe<D> for FlowProbe<D> {
    fn columns(&self) -> Vec<String> {
        let names = if D == 2 { ["flow_m2ps", "volume_m2"] } else { ["flow_m3ps", "volume_m3"] };
        names.map(String::from).to_vec()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        vec![self.flow(sim.system()), 0.0]
    }

    fn continue_from(&self, before: &[f64], now: &mut [f64], dt: f64) {
        now[1] = before[1] + 0.5 * dt * (before[0] + now[0]);
    }
}
