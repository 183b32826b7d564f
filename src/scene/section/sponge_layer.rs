//! `[[damping]]`: sponge layers, which damp the motion of the water.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::domain::PeriodicConfig;
use crate::{
    error::Result,
    math::Vector,
    scene::context::{Context, Defaults},
    system::SpongeLayer,
};

use super::{shape::vector, water::StillWaterLevel};

/// β ℓ/((n + 1) √(gd)) of a layer without `strength`: a long wave that crosses the layer and returns keeps e⁻⁴ = 2 % of its height.
const CROSSING_LOSS: f64 = 4.0;

/// n of a layer without `power`.
const POWER: f64 = 2.0;

/// One `[[damping]]`: a sponge layer that begins at one plane, reaches full strength at another and goes on beyond.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SpongeLayerConfig {
    /// A point of the plane where the layer begins, m.
    pub from: Vec<f64>,
    /// A point of the plane where the layer reaches full strength, m.
    pub to: Vec<f64>,
    /// Damping rate at full strength, 1/s.
    pub strength: Option<f64>,
    /// Growth of the damping rate from `from` to `to`, as a power of the distance: 1 is linear, a larger power is gentler at first.
    pub power: Option<f64>,
}

impl SpongeLayerConfig {
    /// The layer that begins at `from` and reaches full strength at `to` (m).
    pub fn between(from: impl Into<Vec<f64>>, to: impl Into<Vec<f64>>) -> Self {
        Self { from: from.into(), to: to.into(), strength: None, power: None }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        let why = "gentle at first, so that little is reflected";
        defaults.fill(format!("{key}.power"), &mut self.power, POWER, why);
    }

    /// Refuses a layer of no thickness, along a periodic axis, or whose strength nothing determines.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, periodic: Option<&PeriodicConfig>) -> Result<()> {
        ctx.require_dimension(&format!("{key}.from"), &self.from)?;
        ctx.require_dimension(&format!("{key}.to"), &self.to)?;
        ctx.require_positive(&format!("{key}.strength"), self.strength)?;
        ctx.require_positive(&format!("{key}.power"), self.power)?;
        let way: Vec<f64> = self.to.iter().zip(&self.from).map(|(to, from)| to - from).collect();
        if way.iter().all(|x| x.abs() < ctx.dp) {
            let help = "the water loses its motion from `from` on, and fully at `to`, a wave length further";
            return Err(ctx.error_with_help(&format!("{key}.to"), "the zone is shorter than dp", help));
        }
        let sides = periodic.into_iter().flat_map(|p| [p.x, p.y, p.z]);
        if way.iter().zip(sides).any(|(x, side)| *x != 0.0 && side.is_some()) {
            let what = "the zone goes along a periodic axis, on which it has neither beginning nor end";
            return Err(ctx.error_with_help(key, what, "make it across the period"));
        }
        if self.strength.is_none() && ctx.gravity.is_some() && !ctx.has_gravity() {
            let what = "without gravity nothing says how strong the zone is";
            return Err(ctx.error_with_help(&format!("{key}.strength"), what, "write  strength = 5.0        # 1/s"));
        }
        Ok(())
    }

    /// The layer over water at rest; without `strength` that follows from the length of the layer and the depth.
    pub(crate) fn build<const D: usize>(&self, ctx: &Context, still: &StillWaterLevel) -> SpongeLayer<D> {
        let (from, to): (Vector<D>, Vector<D>) = (vector(&self.from), vector(&self.to));
        let power = self.power.unwrap_or(POWER);
        let usual = CROSSING_LOSS * (power + 1.0) * (ctx.gravity_norm() * still.depth).sqrt() / (to - from).norm();
        SpongeLayer { from, to, strength: self.strength.unwrap_or(usual), power }
    }
}
