//! The words of a paddle that absorbs what comes back to it.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{self, MapAccess, Visitor, value::MapAccessDeserializer},
};

use super::{Scene, build_waves::Site};
use crate::{
    error::Result,
    math::Vector,
    solid::Motion,
    wavemaker::{Absorber, Tuning, Wave, Wavemaker},
};

/// From the paddle's face to its gauge, in smoothing lengths: so far the kernel sees.
const GAUGE: f64 = 2.0;

/// Whether a paddle absorbs: `true`, or how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Absorb {
    /// As usual, or not at all.
    Plainly(bool),
    /// As these words say.
    As(AbsorbWords),
}

/// How a paddle absorbs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AbsorbWords {
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

impl Absorb {
    /// How, if at all.
    pub(super) fn words(self) -> Option<AbsorbWords> {
        match self {
            Self::Plainly(absorbs) => absorbs.then(AbsorbWords::default),
            Self::As(words) => Some(words),
        }
    }
}

impl<'de> Deserialize<'de> for Absorb {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> std::result::Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = Absorb;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "true, or a table with `period`, `stroke`, `speed`")
            }
            fn visit_bool<E: de::Error>(self, absorbs: bool) -> std::result::Result<Absorb, E> {
                Ok(Absorb::Plainly(absorbs))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<Absorb, A::Error> {
                AbsorbWords::deserialize(MapAccessDeserializer::new(map)).map(Absorb::As)
            }
        }
        deserializer.deserialize_any(Words)
    }
}

impl Scene {
    /// Whether the words of a paddle that makes `waves` or none can be meant.
    pub(super) fn verify_absorb(&self, key: &str, words: &AbsorbWords, waves: bool) -> Result<()> {
        let all = [("period", words.period), ("stroke", words.stroke), ("speed", words.speed)];
        all.into_iter().try_for_each(|(word, x)| self.positive(&format!("{key}.{word}"), x))?;
        match waves || words.period.is_some() {
            true => Ok(()),
            false => {
                let what = "a paddle that makes no wave of its own absorbs those of a period, and none is said";
                Err(self.wrong_with(key, what, "write  wave = { absorb = { period = 1.2 } }"))
            }
        }
    }

    /// The `motion` of the paddle of `maker` at this `site`, which absorbs as `words` say.
    pub(super) fn absorbing<const D: usize>(
        &self,
        key: &str,
        words: &AbsorbWords,
        maker: &Wavemaker,
        site: &Site<D>,
        motion: Motion<D>,
    ) -> Result<Motion<D>> {
        let Some(wave) = motion.wave() else { return Ok(motion) };
        let AbsorbWords { period, stroke, speed } = *words;
        let tuning = Tuning { period, gauge: GAUGE * self.h(), level: site.level, stroke, speed };
        let absorber = Absorber::new(maker, wave, &tuning).map_err(|e| self.origin.place(e, key))?;
        let gauge: Vector<D> = site.face + site.way * absorber.gauge();
        Ok(motion.absorbing(absorber, gauge, site.way))
    }

    /// The still paddle's own wave: none, before those that it absorbs.
    pub(super) fn silence(&self, key: &str, words: Option<AbsorbWords>, maker: &Wavemaker) -> Result<Wave> {
        match words.and_then(|words| words.period) {
            Some(period) => maker.silent(period).map_err(|e| self.origin.place(e, key)),
            None => Err(self.wrong(key, "which wave?")),
        }
    }
}
