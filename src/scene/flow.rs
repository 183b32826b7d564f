//! Which sides are periodic, and how the water moves at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scene, WaterConfig, flexible::FieldFormulaConfig};
use crate::{error::Result, math::Vector, math::expression::ScalarField, system::Periodic};

/// Where a period begins and ends along each axis that has one, m.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PeriodicConfig {
    /// m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<[f64; 2]>,
    /// m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<[f64; 2]>,
    /// m; 3-D only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<[f64; 2]>,
}

impl Scene {
    /// Refuses periods that are none.
    pub(super) fn verify_periodic(&self) -> Result<()> {
        let Some(words) = &self.periodic else { return Ok(()) };
        for (axis, side) in ["x", "y", "z"].into_iter().zip([words.x, words.y, words.z]) {
            let Some([from, to]) = side else { continue };
            let key = format!("periodic.{axis}");
            if axis == "z" && self.dimension == 2 {
                return Err(self.error_with_help(&key, "a 2-D scene has no z", "its axes are x and y"));
            }
            if !(from < to && from.is_finite() && to.is_finite()) {
                return Err(self.error_at(&key, format!("{axis} goes from {from} to {to}: nothing lies between")));
            }
        }
        Ok(())
    }

    /// Periodic sides.
    pub(super) fn periods<const D: usize>(&self) -> Periodic<D> {
        let words = self.periodic.clone().unwrap_or_default();
        let sides = [words.x, words.y, words.z];
        std::array::from_fn(|axis| sides[axis])
    }

    /// Refuses what cannot be read of the motion of the water `water` at `key`.
    pub(super) fn verify_flow(&self, key: &str, water: &WaterConfig) -> Result<()> {
        match self.dimension {
            2 => self.initial_flow::<2>(key, water).map(|_| ()),
            _ => self.initial_flow::<3>(key, water).map(|_| ()),
        }
    }

    /// How the water `water` at `key` moves at the start.
    pub(super) fn initial_flow<const D: usize>(&self, key: &str, water: &WaterConfig) -> Result<InitialFlow<D>> {
        let field = |key: &str, words: &FieldFormulaConfig| {
            ScalarField::parse(&words.0).map_err(|e| self.origin.with_location(e, key))
        };
        let mut flow = InitialFlow { velocity: Vec::new(), pressure: None };
        if let Some(words) = &water.velocity {
            let key = format!("{key}.velocity");
            if words.len() != D {
                return Err(self.error_at(&key, format!("velocity has {} entries, not {D}", words.len())));
            }
            flow.velocity = words.iter().map(|words| field(&key, words)).collect::<Result<_>>()?;
        }
        if let Some(words) = &water.pressure {
            flow.pressure = Some(field(&format!("{key}.pressure"), words)?);
        }
        Ok(flow)
    }
}

/// How a body of water moves at the start.
pub(super) struct InitialFlow<const D: usize> {
    velocity: Vec<ScalarField<D>>,
    pressure: Option<ScalarField<D>>,
}

impl<const D: usize> InitialFlow<D> {
    /// Velocity (m/s) and pressure beyond that of water at rest (Pa) at `r` (m).
    pub(super) fn at(&self, r: &Vector<D>) -> (Vector<D>, f64) {
        let velocity = Vector::from_fn(|i, _| self.velocity.get(i).map_or(0.0, |field| field.value_at(r)));
        (velocity, self.pressure.as_ref().map_or(0.0, |field| field.value_at(r)))
    }
}
