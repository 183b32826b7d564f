//! The words of damping zones.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scene, build::StillWaterLevel, geometry::vector, resolve::Defaults};
use crate::{error::Result, math::Vector, system::SpongeLayer};

/// β ℓ/((n + 1) √(gd)) where nobody says β: what goes through the zone and back with the speed of long waves has e⁻⁴ = 2 % left.
const PASSES: f64 = 4.0;

/// n where nobody says it.
const POWER: f64 = 2.0;

/// One `[[damping]]`: from one plane to another, and beyond.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingConfig {
    /// A point of the plane on which it begins, m.
    pub from: Vec<f64>,
    /// A point of the plane from which on it is full, m.
    pub to: Vec<f64>,
    /// What part of its velocity the water loses in a second where it is full, 1/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
    /// How that grows on the way from `from` to `to`, as a power of the way: 1 is even, more is gentler at first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub power: Option<f64>,
}

impl DampingConfig {
    /// The zone that begins at `from` and is full at `to` (m).
    pub fn between(from: impl Into<Vec<f64>>, to: impl Into<Vec<f64>>) -> Self {
        Self { from: from.into(), to: to.into(), strength: None, power: None }
    }
}

impl Scene {
    /// The same scene with a damping zone more.
    pub fn with_damping(mut self, zone: DampingConfig) -> Self {
        self.damping.push(zone);
        self
    }

    pub(super) fn verify_damping(&self) -> Result<()> {
        for (i, words) in self.damping.iter().enumerate() {
            let key = format!("damping.{i}");
            self.require_dimension(&format!("{key}.from"), &words.from)?;
            self.require_dimension(&format!("{key}.to"), &words.to)?;
            self.require_positive(&format!("{key}.strength"), words.strength)?;
            self.require_positive(&format!("{key}.power"), words.power)?;
            let way: Vec<f64> = words.to.iter().zip(&words.from).map(|(to, from)| to - from).collect();
            if way.iter().all(|x| x.abs() < self.dp) {
                let help = "the water loses its motion from `from` on, and fully at `to`, a wave length further";
                return Err(self.error_with_help(&format!("{key}.to"), "the zone is shorter than dp", help));
            }
            let sides = self.periodic.iter().flat_map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>();
            if way.iter().zip(&sides).any(|(x, side)| *x != 0.0 && side.is_some()) {
                let what = "the zone goes along a periodic axis, on which it has neither beginning nor end";
                return Err(self.error_with_help(&key, what, "make it across the period"));
            }
            if words.strength.is_none() && self.gravity.iter().flatten().all(|g| *g == 0.0) && self.gravity.is_some() {
                let what = "without gravity nothing says how strong the zone is";
                return Err(self.error_with_help(
                    &format!("{key}.strength"),
                    what,
                    "write  strength = 5.0        # 1/s",
                ));
            }
        }
        Ok(())
    }

    pub(super) fn fill_damping_defaults(&mut self, filler: &mut Defaults) {
        for (i, words) in self.damping.iter_mut().enumerate() {
            let why = "gentle at first, so that little is thrown back";
            filler.fill(format!("damping.{i}.power"), &mut words.power, POWER, why);
        }
    }

    /// The zones; of those without a strength it follows from their length and the depth.
    pub(super) fn sponge_layers<const D: usize>(&self, still: &StillWaterLevel) -> Vec<SpongeLayer<D>> {
        let g = self.gravity.iter().flatten().map(|g| g * g).sum::<f64>().sqrt();
        let zone = |words: &DampingConfig| {
            let (from, to): (Vector<D>, Vector<D>) = (vector(&words.from), vector(&words.to));
            let power = words.power.unwrap_or(POWER);
            let usual = PASSES * (power + 1.0) * (g * still.depth).sqrt() / (to - from).norm();
            SpongeLayer { from, to, strength: words.strength.unwrap_or(usual), power }
        };
        self.damping.iter().map(zone).collect()
    }

    /// The strengths that nobody says: the key of the zone, with its point, and the strength (1/s).
    ///
    /// # Errors
    /// `Scene` if there is no such water; `File` if a file that gives its shape cannot be read.
    pub(super) fn default_strengths(&self) -> Result<Vec<(String, f64)>> {
        if self.damping.iter().all(|words| words.strength.is_some()) {
            return Ok(vec![]);
        }
        let zones: Vec<f64> = match self.dimension {
            2 => {
                self.sponge_layers(&StillWaterLevel::of(&self.water_bodies::<2>()?)).iter().map(strength::<2>).collect()
            }
            _ => {
                self.sponge_layers(&StillWaterLevel::of(&self.water_bodies::<3>()?)).iter().map(strength::<3>).collect()
            }
        };
        let unsaid = self.damping.iter().zip(zones).enumerate().filter(|(_, (words, _))| words.strength.is_none());
        Ok(unsaid.map(|(i, (_, strength))| (format!("damping.{i}."), strength)).collect())
    }
}

fn strength<const D: usize>(zone: &SpongeLayer<D>) -> f64 {
    zone.strength
}
