//! Prescribed motions: their words held against one another, filled in, and made.

use super::{
    DrivenConfig, Scene, TimeFunctionConfig,
    build_solids::CoordinateUnit,
    geometry::vector,
    resolve::{Defaults, fill_time_function},
    verify::quoted_list,
};
use crate::{error::Result, solid::PrescribedMotion};

impl DrivenConfig {
    /// Its laws with their words, as far as they are given.
    fn time_functions(&self) -> impl Iterator<Item = (&'static str, &TimeFunctionConfig)> {
        let laws = [("distance", &self.distance), ("angle", &self.angle), ("angle_deg", &self.angle_deg)];
        laws.into_iter().filter_map(|(word, law)| Some((word, law.as_ref()?)))
    }

    /// Fills in its defaults.
    pub(super) fn fill(&mut self, filler: &mut Defaults, key: &str) {
        if let Some(wave) = &mut self.wave {
            wave.fill_defaults(filler, &format!("{key}.wave"));
        }
        let laws = [("distance", &mut self.distance), ("angle", &mut self.angle), ("angle_deg", &mut self.angle_deg)];
        for (word, law) in laws {
            if let Some(law) = law {
                fill_time_function(filler, &format!("{key}.{word}"), law);
            }
        }
        for (i, motion) in self.motions.iter_mut().flatten().enumerate() {
            motion.fill(filler, &format!("{key}.motions.{i}"));
        }
    }

    /// What is said beside a list of motions.
    fn keys_beside_motions(&self) -> Vec<&'static str> {
        let vectors = [("along", &self.along), ("hinge", &self.hinge), ("axis", &self.axis)];
        let vectors = vectors.into_iter().filter(|(_, vector)| vector.is_some()).map(|(word, _)| word);
        vectors.chain(self.time_functions().map(|(word, _)| word)).chain(self.wave.as_ref().map(|_| "wave")).collect()
    }
}

impl Scene {
    /// Refuses words of a prescribed motion that do not say one, or one list of them.
    pub(super) fn verify_driven(&self, key: &str, words: &DrivenConfig) -> Result<()> {
        let Some(motions) = &words.motions else { return self.one_motion(key, words) };
        let beside = words.keys_beside_motions();
        if let Some(word) = beside.first() {
            let what = format!("{} stands beside motions, which stands alone", quoted_list(&beside));
            return Err(self.error_with_help(
                &format!("{key}.{word}"),
                what,
                "write it as an entry of motions, in its order",
            ));
        }
        if motions.is_empty() {
            return Err(
                self.error_at(&format!("{key}.motions"), "the list of motions is empty: nothing says how it moves")
            );
        }
        motions.iter().enumerate().try_for_each(|(i, motion)| {
            let key = format!("{key}.motions.{i}");
            if motion.wave.is_some() {
                let help = "driven = { along or hinge, wave = .. } makes waves; here a law takes its place, as in\n  { along = \
                            [1.0, 0.0], distance = { formula = \"0.05*sin(2*pi*t)\" } }";
                let what = "a paddle that makes a wave has no other motion beside it";
                return Err(self.error_with_help(&format!("{key}.wave"), what, help));
            }
            if motion.motions.is_some() {
                let help = "write them in one list: each goes in the frame that those before it have moved";
                return Err(self.error_with_help(&format!("{key}.motions"), "a list of motions within another", help));
            }
            self.one_motion(&key, motion)
        })
    }

    fn one_motion(&self, key: &str, words: &DrivenConfig) -> Result<()> {
        let laws: Vec<(&str, &TimeFunctionConfig)> = words.time_functions().collect();
        let fits = match (&words.along, &words.hinge, &laws[..], &words.wave) {
            (Some(_), None, [("distance", _)], None) | (Some(_), None, [], Some(_)) => words.axis.is_none(),
            (None, Some(_), [("angle" | "angle_deg", _)], None) | (None, Some(_), [], Some(_)) => {
                words.axis.is_some() == (self.dimension == 3)
            }
            _ => {
                let help = "either  along with distance, or  hinge (in 3-D with axis) with angle or angle_deg; \
                            either with wave instead; several at once are a list,  motions = [{ .. }, { .. }]";
                return Err(self.error_with_help(key, "this does not say one motion", help));
            }
        };
        if !fits {
            let help =
                "in 3-D a hinge has an axis, as in axis = [0.0, 1.0, 0.0]; in 2-D, and along a line, there is none";
            return Err(self.error_with_help(key, "axis is missing, or has no meaning here", help));
        }
        for (word, vector) in [("along", &words.along), ("hinge", &words.hinge), ("axis", &words.axis)] {
            let Some(vector) = vector else { continue };
            let key = format!("{key}.{word}");
            self.require_dimension(&key, vector)?;
            if word != "hinge" && vector.iter().all(|x| x.abs() < 1e-12) {
                return Err(self.error_at(&key, format!("{word} points nowhere")));
            }
        }
        if let Some(wave) = &words.wave {
            return self.verify_wave(&format!("{key}.wave"), wave);
        }
        laws.iter().try_for_each(|(word, law)| self.verify_time_function(&format!("{key}.{word}"), law))
    }

    /// The motion that `words` say without a wave.
    pub(super) fn motion<const D: usize>(&self, key: &str, words: &DrivenConfig) -> Result<PrescribedMotion<D>> {
        if let Some(motions) = &words.motions {
            let made = motions.iter().enumerate().map(|(i, words)| self.motion(&format!("{key}.motions.{i}"), words));
            return Ok(PrescribedMotion::chain(made.collect::<Result<Vec<_>>>()?));
        }
        let unit = |x: &[f64]| vector::<D>(x).normalize();
        if let (Some(along), Some(distance)) = (&words.along, &words.distance) {
            return Ok(PrescribedMotion::slide(
                unit(along),
                self.time_function(&format!("{key}.distance"), distance, CoordinateUnit::Metres)?,
            ));
        }
        let centre = vector(words.hinge.as_deref().unwrap_or(&[]));
        let axis = words.axis.as_ref().map_or_else(|| vec![1.0], |axis| unit(axis).iter().copied().collect());
        let law = match (&words.angle, &words.angle_deg) {
            (Some(law), _) => self.time_function(&format!("{key}.angle"), law, CoordinateUnit::Radians)?,
            (None, Some(law)) => self.time_function(&format!("{key}.angle_deg"), law, CoordinateUnit::Degrees)?,
            (None, None) => return Err(self.error_at(key, "this does not say one motion")),
        };
        Ok(PrescribedMotion::hinge(centre, &axis, law))
    }
}
