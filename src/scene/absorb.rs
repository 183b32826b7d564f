//! The words of a paddle that absorbs what comes back to it.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{self, MapAccess, Visitor, value::MapAccessDeserializer},
};

use super::{Scene, build_waves::AbsorberSite};
use crate::{
    error::Result,
    math::Vector,
    solid::PrescribedMotion,
    wavemaker::{Absorber, AbsorptionSettings, PaddleMotion, Wavemaker},
};

/// From the paddle's face to its gauge, in smoothing lengths: so far the kernel sees.
const GAUGE: f64 = 2.0;

/// Whether a paddle absorbs: `true`, or how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum AbsorbChoice {
    /// As usual, or not at all.
    Switch(bool),
    /// As these words say.
    Parameters(AbsorptionConfig),
}

/// How a paddle absorbs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AbsorptionConfig {
    /// Period whose waves it takes whole, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub period: Option<f64>,
    /// How far it may go from end to end, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stroke: Option<f64>,
    /// How fast it may go, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
}

impl AbsorbChoice {
    /// How, if at all.
    pub(super) fn parameters(self) -> Option<AbsorptionConfig> {
        match self {
            Self::Switch(absorbs) => absorbs.then(AbsorptionConfig::default),
            Self::Parameters(words) => Some(words),
        }
    }
}

impl<'de> Deserialize<'de> for AbsorbChoice {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> std::result::Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = AbsorbChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "true, or a table with `period`, `stroke`, `speed`")
            }
            fn visit_bool<E: de::Error>(self, absorbs: bool) -> std::result::Result<AbsorbChoice, E> {
                Ok(AbsorbChoice::Switch(absorbs))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<AbsorbChoice, A::Error> {
                AbsorptionConfig::deserialize(MapAccessDeserializer::new(map)).map(AbsorbChoice::Parameters)
            }
        }
        deserializer.deserialize_any(Words)
    }
}

impl Scene {
    /// Whether the words of a paddle that makes `waves` or none can be meant.
    pub(super) fn verify_absorb(&self, key: &str, words: &AbsorptionConfig, waves: bool) -> Result<()> {
        let all = [("period", words.period), ("stroke", words.stroke), ("speed", words.speed)];
        all.into_iter().try_for_each(|(word, x)| self.require_positive(&format!("{key}.{word}"), x))?;
        match waves || words.period.is_some() {
            true => Ok(()),
            false => {
                let what = "a paddle that makes no wave of its own absorbs those of a period, and none is said";
                Err(self.error_with_help(key, what, "write  wave = { absorb = { period = 1.2 } }"))
            }
        }
    }

    /// The `motion` of the paddle of `maker` at this `site`, which absorbs as `words` say.
    pub(super) fn with_absorption<const D: usize>(
        &self,
        key: &str,
        words: &AbsorptionConfig,
        maker: &Wavemaker,
        site: &AbsorberSite<D>,
        motion: PrescribedMotion<D>,
    ) -> Result<PrescribedMotion<D>> {
        let Some(wave) = motion.wave() else { return Ok(motion) };
        let AbsorptionConfig { period, stroke, speed } = *words;
        let tuning = AbsorptionSettings {
            period,
            gauge_distance: GAUGE * self.smoothing_length(),
            water_level: site.level,
            max_stroke: stroke,
            max_speed: speed,
        };
        let absorber = Absorber::new(maker, wave, &tuning).map_err(|e| self.origin.with_location(e, key))?;
        let gauge: Vector<D> = site.face + site.direction * absorber.gauge_distance();
        Ok(motion.with_absorber(absorber, gauge, site.direction))
    }

    /// The still paddle's own wave: none, before those that it absorbs.
    pub(super) fn zero_wave(
        &self,
        key: &str,
        words: Option<AbsorptionConfig>,
        maker: &Wavemaker,
    ) -> Result<PaddleMotion> {
        match words.and_then(|words| words.period) {
            Some(period) => maker.at_rest(period).map_err(|e| self.origin.with_location(e, key)),
            None => Err(self.error_at(key, "which wave?")),
        }
    }
}
