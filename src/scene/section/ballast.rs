//! `ballast` of `free`: masses at points of a free solid, as functions of time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::shape::vector;
use crate::{
    error::{ErrorCode, Result},
    scene::{
        context::{Context, Defaults},
        untagged::{CoordinateUnit, TimeValueConfig},
    },
    solid::BallastSpec,
};

/// A mass at a point of a free solid: ballast water, payload or fuel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct BallastConfig {
    /// Its point in the solid's frame, m.
    pub at: Vec<f64>,
    /// Its mass, kg (kg/m in 2-D): a number, a formula in t, or a law.
    pub mass: TimeValueConfig,
}

impl BallastConfig {
    /// The mass `mass` (kg; kg/m in 2-D) at the point `at` (m) of the solid's frame.
    pub fn new(at: impl Into<Vec<f64>>, mass: impl Into<TimeValueConfig>) -> Self {
        Self { at: at.into(), mass: mass.into() }
    }

    /// Refuses a point that does not fit the dimension, and a mass that cannot be read.
    pub(super) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        ctx.require_dimension(&format!("{key}.at"), &self.at)?;
        self.mass.verify(ctx, &format!("{key}.mass"))
    }

    /// Fills in the defaults.
    pub(super) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        self.mass.0.fill(defaults, &format!("{key}.mass"));
    }

    /// The ballast.
    ///
    /// # Errors
    /// `Scene` if the mass is negative or not finite at a time of the run, or in a sample of its table.
    pub(super) fn build<const D: usize>(&self, ctx: &Context, key: &str) -> Result<BallastSpec<D>> {
        let key = format!("{key}.mass");
        let ballast = BallastSpec::new(vector(&self.at), self.mass.0.build(ctx, &key, CoordinateUnit::Si("kg"))?);
        match ballast.first_invalid(ctx.until) {
            None => Ok(ballast),
            Some((t, mass)) => {
                let what = format!("the ballast has a mass of {mass} kg at t = {t} s");
                let help = "its mass is 0 or more; a body that becomes lighter has as its own  mass  what remains in the \
                            end, and the rest as ballast that falls to 0";
                Err(ctx.error_with_help(&key, what, help).with_code(ErrorCode::OutOfRange))
            }
        }
    }
}
