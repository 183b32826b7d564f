//! `[[wind]]`: drag of the wind on the dry part of free solids.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::solid::{SolidConfig, require_solid};
use crate::{
    error::{ErrorCode, Result},
    scene::{
        context::{Context, Defaults},
        untagged::{CoordinateUnit, TimeValueConfig, TimeVectorConfig},
    },
    solid::{AIR_DENSITY, Lifetime, SolidSpec, WindSpec},
};

/// A section `[[wind]]`: a wind on free solids, ½ ρ C_d A |U| U with U relative to the solid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct WindConfig {
    /// Its velocity, m/s: one component along each axis.
    pub velocity: TimeVectorConfig,
    /// The free solids on which it acts.
    pub on: Vec<String>,
    /// Drag coefficient C_d, –.
    pub drag: Option<f64>,
    /// Density of the air, kg/m³.
    pub density: Option<f64>,
}

impl WindConfig {
    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        defaults.fill(format!("{key}.drag"), &mut self.drag, 1.0, "a bluff body");
        defaults.fill(format!("{key}.density"), &mut self.density, AIR_DENSITY, "air at 15 °C");
        for value in self.velocity.components_mut() {
            value.0.fill(defaults, &format!("{key}.velocity"));
        }
    }

    /// Refuses a wind on nothing or on solids that are not free, and components that do not fit the dimension.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        let on = format!("{key}.on");
        if self.on.is_empty() {
            return Err(ctx.error_with_help(&on, "the wind acts on nothing", "name the solids:  on = [\"boat\"]"));
        }
        for (i, name) in self.on.iter().enumerate() {
            require_solid(ctx, solids, &on, name)?;
            if self.on[..i].contains(name) {
                return Err(ctx.error_at(&on, format!("\"{name}\" is named twice")));
            }
            if !solids.iter().any(|solid| solid.name == *name && solid.free.is_some()) {
                let what = format!("\"{name}\" is not free: a wind does not move it");
                return Err(ctx.error_with_help(&on, what, "a wind acts on free solids"));
            }
        }
        let velocity = format!("{key}.velocity");
        let values = self.velocity.components();
        if !self.velocity.is_list() || values.len() != ctx.dimension {
            let what =
                format!("the wind has {} components, and a {}-D scene {}", values.len(), ctx.dimension, ctx.dimension);
            let help = if ctx.dimension == 2 { "velocity = [10.0, 0.0]" } else { "velocity = [10.0, 0.0, 0.0]" };
            return Err(ctx.error_with_help(&velocity, what, help).with_code(ErrorCode::WrongType));
        }
        values.iter().try_for_each(|value| value.verify(ctx, &velocity))?;
        ctx.require_positive(&format!("{key}.drag"), self.drag)?;
        ctx.require_positive(&format!("{key}.density"), self.density)
    }

    /// The wind on the `solids`, of which `specs` are the specifications, over still water with the level (m) at the place of each,
    /// if water is there.
    pub(crate) fn build<const D: usize>(
        &self,
        ctx: &Context,
        key: &str,
        solids: &[SolidConfig],
        specs: &[SolidSpec<D>],
        levels: &[Option<f64>],
    ) -> Result<WindSpec<D>> {
        let law = |value: &TimeValueConfig| value.0.build(ctx, &format!("{key}.velocity"), CoordinateUnit::Si("m/s"));
        let velocity = self.velocity.components().iter().map(law).collect::<Result<Vec<_>>>()?;
        let mut wind = WindSpec::new(velocity, f64::NEG_INFINITY).drag(self.drag.unwrap_or(1.0));
        wind.density = self.density.unwrap_or(AIR_DENSITY);
        for (number, ((solid, spec), level)) in solids.iter().zip(specs).zip(levels).enumerate() {
            if self.on.contains(&solid.name) {
                let lifetime = Lifetime::default().until(solid.until.unwrap_or(f64::INFINITY));
                wind.level = level.unwrap_or(f64::NEG_INFINITY);
                wind = wind.during(number, &spec.shape, lifetime);
            }
        }
        Ok(wind)
    }
}
