//! `driven`: prescribed motions of solids.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{shape::vector, wave::WaveConfig};
use crate::{
    error::Result,
    scene::{
        context::{Context, Defaults, quoted_list},
        untagged::{CoordinateUnit, TimeFunctionConfig},
    },
    solid::PrescribedMotion,
};

/// A prescribed motion: `along` with `distance`, or `hinge` with `angle` or `angle_deg`; either with a `wave` instead; or `motions`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct DrivenConfig {
    /// Direction of a translation (its length does not matter).
    pub along: Option<Vec<f64>>,
    /// Distance along it, m.
    pub distance: Option<TimeFunctionConfig>,
    /// World point of a hinge, m.
    pub hinge: Option<Vec<f64>>,
    /// Direction of its axis; 3-D only.
    pub axis: Option<Vec<f64>>,
    /// Angle about it, rad.
    pub angle: Option<TimeFunctionConfig>,
    /// Angle about it, degrees.
    pub angle_deg: Option<TimeFunctionConfig>,
    /// The wave that it is to make.
    pub wave: Option<WaveConfig>,
    /// Several motions at once, in place of all of these, each in the frame that those before it have moved.
    pub motions: Option<Vec<DrivenConfig>>,
}

impl DrivenConfig {
    /// Whether it makes a wave by name.
    pub(crate) fn makes_waves(&self) -> bool {
        self.wave.is_some() || self.motions.iter().flatten().any(Self::makes_waves)
    }

    /// A translation by `formula` (m, of t in s) in the direction `along`.
    pub fn slide(along: impl Into<Vec<f64>>, formula: impl Into<String>) -> Self {
        let distance = TimeFunctionConfig { formula: Some(formula.into()), ..TimeFunctionConfig::default() };
        Self { along: Some(along.into()), distance: Some(distance), ..Self::default() }
    }

    /// A piston that makes `wave` in the direction `along`.
    pub fn piston(along: impl Into<Vec<f64>>, wave: WaveConfig) -> Self {
        Self { along: Some(along.into()), wave: Some(wave), ..Self::default() }
    }

    /// A flap hinged at the world point `hinge` (m) that makes `wave`; 2-D, in 3-D it needs an `axis` too.
    pub fn flap(hinge: impl Into<Vec<f64>>, wave: WaveConfig) -> Self {
        Self { hinge: Some(hinge.into()), wave: Some(wave), ..Self::default() }
    }

    /// The laws that are given, with their keys.
    fn time_values(&self) -> impl Iterator<Item = (&'static str, &TimeFunctionConfig)> {
        let laws = [("distance", &self.distance), ("angle", &self.angle), ("angle_deg", &self.angle_deg)];
        laws.into_iter().filter_map(|(word, law)| Some((word, law.as_ref()?)))
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        if let Some(wave) = &mut self.wave {
            wave.fill(defaults, &format!("{key}.wave"));
        }
        let laws = [("distance", &mut self.distance), ("angle", &mut self.angle), ("angle_deg", &mut self.angle_deg)];
        for (word, law) in laws {
            if let Some(law) = law {
                law.fill(defaults, &format!("{key}.{word}"));
            }
        }
        for (i, motion) in self.motions.iter_mut().flatten().enumerate() {
            motion.fill(defaults, &format!("{key}.motions.{i}"));
        }
    }

    /// The keys that may not stand beside a list of motions.
    fn keys_beside_motions(&self) -> Vec<&'static str> {
        let vectors = [("along", &self.along), ("hinge", &self.hinge), ("axis", &self.axis)];
        let vectors = vectors.into_iter().filter(|(_, vector)| vector.is_some()).map(|(word, _)| word);
        vectors.chain(self.time_values().map(|(word, _)| word)).chain(self.wave.as_ref().map(|_| "wave")).collect()
    }

    /// Refuses a motion that is not complete, or is given twice.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let Some(motions) = &self.motions else { return self.verify_one(ctx, key) };
        let beside = self.keys_beside_motions();
        if let Some(word) = beside.first() {
            let what = format!("{} stands beside motions, which stands alone", quoted_list(&beside));
            return Err(ctx.error_with_help(
                &format!("{key}.{word}"),
                what,
                "write it as an entry of motions, in its order",
            ));
        }
        if motions.is_empty() {
            return Err(
                ctx.error_at(&format!("{key}.motions"), "the list of motions is empty: nothing says how it moves")
            );
        }
        motions.iter().enumerate().try_for_each(|(i, motion)| {
            let key = format!("{key}.motions.{i}");
            if motion.wave.is_some() {
                let help = "driven = { along or hinge, wave = .. } makes waves; here a law takes its place, as in\n  { along = \
                            [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } }";
                let what = "a paddle that makes a wave has no other motion beside it";
                return Err(ctx.error_with_help(&format!("{key}.wave"), what, help));
            }
            if motion.motions.is_some() {
                let help = "write them in one list: each goes in the frame that those before it have moved";
                return Err(ctx.error_with_help(&format!("{key}.motions"), "a list of motions within another", help));
            }
            motion.verify_one(ctx, &key)
        })
    }

    fn verify_one(&self, ctx: &Context, key: &str) -> Result<()> {
        let laws: Vec<(&str, &TimeFunctionConfig)> = self.time_values().collect();
        let fits = match (&self.along, &self.hinge, &laws[..], &self.wave) {
            (Some(_), None, [("distance", _)], None) | (Some(_), None, [], Some(_)) => self.axis.is_none(),
            (None, Some(_), [("angle" | "angle_deg", _)], None) | (None, Some(_), [], Some(_)) => {
                self.axis.is_some() == (ctx.dimension == 3)
            }
            _ => {
                let help = "either  along with distance, or  hinge (in 3-D with axis) with angle or angle_deg; \
                            either with wave instead; several at once are a list,  motions = [{ .. }, { .. }]";
                return Err(ctx.error_with_help(key, "this does not say one motion", help));
            }
        };
        if !fits {
            let help =
                "in 3-D a hinge has an axis, as in axis = [0.0, 1.0, 0.0]; in 2-D, and along a line, there is none";
            return Err(ctx.error_with_help(key, "axis is missing, or has no meaning here", help));
        }
        for (word, vector) in [("along", &self.along), ("hinge", &self.hinge), ("axis", &self.axis)] {
            let Some(vector) = vector else { continue };
            let key = format!("{key}.{word}");
            if word == "hinge" { ctx.require_dimension(&key, vector)? } else { ctx.require_direction(&key, vector)? }
        }
        if let Some(wave) = &self.wave {
            return wave.verify(ctx, &format!("{key}.wave"));
        }
        laws.iter().try_for_each(|(word, law)| law.verify(ctx, &format!("{key}.{word}")))
    }

    /// The motion of a solid that exists until `until` (s), if it makes no wave.
    pub(crate) fn build<const D: usize>(&self, ctx: &Context, key: &str, until: f64) -> Result<PrescribedMotion<D>> {
        if let Some(motions) = &self.motions {
            let made =
                motions.iter().enumerate().map(|(i, motion)| motion.build(ctx, &format!("{key}.motions.{i}"), until));
            return Ok(PrescribedMotion::chain(made.collect::<Result<Vec<_>>>()?));
        }
        let law = |law: &TimeFunctionConfig, word: &str, unit| {
            law.build_during(ctx, &format!("{key}.{word}"), unit, [0.0, until])
        };
        let unit = |x: &[f64]| vector::<D>(x).normalize();
        if let (Some(along), Some(distance)) = (&self.along, &self.distance) {
            return Ok(PrescribedMotion::slide(unit(along), law(distance, "distance", CoordinateUnit::Si("m"))?));
        }
        let centre = vector(self.hinge.as_deref().unwrap_or(&[]));
        let axis = self.axis.as_ref().map_or_else(|| vec![1.0], |axis| unit(axis).iter().copied().collect());
        let angle = match (&self.angle, &self.angle_deg) {
            (Some(angle), _) => law(angle, "angle", CoordinateUnit::Radians)?,
            (None, Some(angle)) => law(angle, "angle_deg", CoordinateUnit::Degrees)?,
            (None, None) => return Err(ctx.error_at(key, "this does not say one motion")),
        };
        Ok(PrescribedMotion::hinge(centre, &axis, angle))
    }
}
