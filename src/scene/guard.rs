//! What a run's guards let pass.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scene, resolve::Defaults};
use crate::{
    error::Result,
    simulation::{Escape, ParticleLimits},
};

/// What a run's guards let pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GuardConfig {
    /// Largest speed of water over c₀, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Smallest and largest density over ρ₀, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density: Option<[f64; 2]>,
    /// What becomes of a particle that leaves the domain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub escape: Option<Escape>,
}

impl Scene {
    /// Refuses guards that let nothing pass, or everything.
    pub(super) fn verify_guard(&self) -> Result<()> {
        let Some(words) = &self.guard else { return Ok(()) };
        if let Some(speed) = words.speed
            && !(speed > 0.0 && speed <= 1.0)
        {
            let help = "write a part of the speed of sound, above 0 and at most 1: speed = 0.5";
            return Err(self.error_with_help("guard.speed", format!("a largest speed of {speed} c0"), help));
        }
        if let Some([least, most]) = words.density
            && !(0.0 < least && least < 1.0 && 1.0 < most && most.is_finite())
        {
            let help = "write two parts of ρ₀, one on either side of 1: density = [0.5, 1.5]";
            return Err(self.error_with_help("guard.density", format!("densities from {least} to {most} ρ₀"), help));
        }
        Ok(())
    }

    pub(super) fn fill_guard_defaults(&mut self, filler: &mut Defaults) {
        let (words, usual) = (self.guard.get_or_insert_default(), ParticleLimits::default());
        let why = "of c₀: beyond, the water is compressed by an eighth";
        filler.fill("guard.speed", &mut words.speed, usual.speed, why);
        filler.fill("guard.density", &mut words.density, usual.density, "of ρ₀: no water is lighter or denser");
        let why = "nothing is lost silently; \"remove\" takes it out and lists it";
        filler.fill("guard.escape", &mut words.escape, usual.escape, why);
    }

    /// The valid range of a water particle.
    pub(super) fn limits(&self) -> ParticleLimits {
        let (words, usual) = (self.guard.clone().unwrap_or_default(), ParticleLimits::default());
        ParticleLimits {
            speed: words.speed.unwrap_or(usual.speed),
            density: words.density.unwrap_or(usual.density),
            escape: words.escape.unwrap_or(usual.escape),
        }
    }
}
