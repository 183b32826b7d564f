//! `[current]` and `[towed]`: what drives water and bodies beside gravity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{domain::PeriodicConfig, shape::AxisName};
use crate::{
    error::{ErrorCode, Result},
    scene::{
        context::{Context, Defaults},
        untagged::{CoordinateUnit, TimeValueConfig},
    },
    simulation::{Current, TowedFrame},
};

/// Response time of a current over the time in which it passes the period, –.
const RESPONSE: f64 = 0.1;

/// `[current]`: a current along a periodic axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct CurrentConfig {
    /// The axis, which is periodic.
    pub along: AxisName,
    /// Discharge in the sense of the axis, m³/s (m²/s in 2-D).
    pub discharge: f64,
    /// Time in which the flow follows, s.
    pub response: Option<f64>,
}

impl CurrentConfig {
    /// Refuses a current along an axis that is not periodic or that has no horizontal direction.
    pub(crate) fn verify(&self, ctx: &Context, periodic: Option<&PeriodicConfig>) -> Result<()> {
        let axis = self.along as usize;
        if axis + 1 >= ctx.dimension {
            let what = "a current is along a horizontal axis";
            return Err(ctx.error_with_help("current.along", what, "write  along = \"x\""));
        }
        if self.period(periodic).is_none() {
            let along = ["x", "y", "z"][axis];
            let what = format!("the scene is not periodic along {along}: this water would leave");
            let help = format!("write  periodic = {{ {along} = [0.0, 4.0] }}, or use [[inflow]] and [[outflow]]");
            return Err(ctx.error_with_help("current.along", what, help).with_code(ErrorCode::ConflictingKeys));
        }
        ctx.require_positive("current.response", self.response)?;
        match self.discharge.is_finite() {
            true => Ok(()),
            false => Err(ctx.error_at("current.discharge", format!("a discharge of {}", self.discharge))),
        }
    }

    fn period(&self, periodic: Option<&PeriodicConfig>) -> Option<[f64; 2]> {
        let sides = periodic.map_or([None; 3], |sides| [sides.x, sides.y, sides.z]);
        sides[self.along as usize]
    }

    /// Fills in the response time for this much water (m³; m² in 2-D).
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, periodic: Option<&PeriodicConfig>, volume: f64) {
        let length = self.period(periodic).map_or(1.0, |[from, to]| to - from);
        let passage = volume / self.discharge.abs();
        let (response, why) = match passage.is_finite() && passage > 0.0 {
            true => (RESPONSE * passage, "a tenth of the time in which the water passes the period, s"),
            false => (length, "as many seconds as the period has metres"),
        };
        defaults.fill("current.response", &mut self.response, response, why);
    }

    /// The current.
    pub(crate) fn build(&self) -> Current {
        Current::new(self.along as usize, self.discharge, self.response.unwrap_or(1.0))
    }
}

/// `[towed]`: the scene moves with a carriage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct TowedConfig {
    /// The axis along which the carriage moves.
    pub along: AxisName,
    /// Velocity of the carriage, m/s: a number, a formula in t or a table.
    pub velocity: TimeValueConfig,
}

impl TowedConfig {
    /// Refuses a velocity that cannot be read, and one that changes while something makes waves: their water is not at rest then.
    pub(crate) fn verify(&self, ctx: &Context, makes_waves: bool) -> Result<()> {
        if self.along as usize + 1 >= ctx.dimension {
            let what = "a carriage moves along a horizontal axis";
            return Err(ctx.error_with_help("towed.along", what, "write  along = \"x\""));
        }
        self.velocity.verify(ctx, "towed.velocity")?;
        let law = self.velocity.0.read(ctx, "towed.velocity", CoordinateUnit::Si("m/s"))?;
        if makes_waves && law.steady_value().is_none() {
            let what = "waves need a carriage of constant velocity: a change of it sets all water in motion";
            let help = "write  velocity = 0.5,  or leave [towed] or the waves out";
            return Err(ctx.error_with_help("towed.velocity", what, help).with_code(ErrorCode::ConflictingKeys));
        }
        Ok(())
    }

    /// The moving frame.
    pub(crate) fn build(&self, ctx: &Context) -> Result<TowedFrame> {
        let velocity = self.velocity.0.build(ctx, "towed.velocity", CoordinateUnit::Si("m/s"))?;
        Ok(TowedFrame::new(self.along as usize, velocity))
    }
}
