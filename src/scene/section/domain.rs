//! `domain`, `periodic`, `symmetry` and `[guard]`: the region of the water and the valid range of its particles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::{ErrorCode, Result},
    math::BoxConfig,
    scene::context::{Context, Defaults},
    simulation::{Escape, ParticleLimits},
    system::Periodic,
};

impl BoxConfig {
    /// Refuses corners that do not enclose a box.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        ctx.require_dimension(&format!("{key}.min"), &self.min)?;
        ctx.require_dimension(&format!("{key}.max"), &self.max)?;
        match (0..ctx.dimension).find(|&i| self.min[i] >= self.max[i]) {
            Some(i) => {
                let (min, max) = (self.min[i], self.max[i]);
                let axis = ["x", "y", "z"][i];
                let what = format!("{axis} goes from {min} to {max}: nothing lies between");
                Err(ctx.error_with_help(&format!("{key}.max"), what, "max is the corner with the greater coordinates"))
            }
            None => Ok(()),
        }
    }
}

/// First and last coordinate of the period along each periodic axis, m.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct PeriodicConfig {
    /// Along x, m.
    pub x: Option<[f64; 2]>,
    /// Along y, m.
    pub y: Option<[f64; 2]>,
    /// Along z, m; 3-D only.
    pub z: Option<[f64; 2]>,
}

impl PeriodicConfig {
    /// Refuses periods without a length.
    pub(crate) fn verify(&self, ctx: &Context) -> Result<()> {
        for (axis, side) in ["x", "y", "z"].into_iter().zip([self.x, self.y, self.z]) {
            let Some([from, to]) = side else { continue };
            let key = format!("periodic.{axis}");
            if axis == "z" && ctx.dimension == 2 {
                return Err(ctx.error_with_help(&key, "a 2-D scene has no z", "its axes are x and y"));
            }
            if !(from < to && from.is_finite() && to.is_finite()) {
                return Err(ctx.error_at(&key, format!("{axis} goes from {from} to {to}: nothing lies between")));
            }
        }
        Ok(())
    }

    /// The periodic sides.
    pub(crate) fn build<const D: usize>(&self) -> Periodic<D> {
        let sides = [self.x, self.y, self.z];
        std::array::from_fn(|axis| sides[axis])
    }
}

/// Coordinate of the symmetry plane normal to each axis, m.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct SymmetryConfig {
    /// Of the plane normal to x, m.
    pub x: Option<f64>,
    /// Of the plane normal to y, m.
    pub y: Option<f64>,
    /// Of the plane normal to z, m; 3-D only.
    pub z: Option<f64>,
}

impl SymmetryConfig {
    /// Refuses planes that are nowhere, or along an axis that the scene does not have or that is periodic.
    pub(crate) fn verify(&self, ctx: &Context, periodic: Option<&PeriodicConfig>) -> Result<()> {
        let sides = periodic.map_or([None; 3], |sides| [sides.x, sides.y, sides.z]);
        for ((axis, plane), side) in ["x", "y", "z"].into_iter().zip([self.x, self.y, self.z]).zip(sides) {
            let Some(at) = plane else { continue };
            let key = format!("symmetry.{axis}");
            if axis == "z" && ctx.dimension == 2 {
                return Err(ctx.error_with_help(&key, "a 2-D scene has no z", "its axes are x and y"));
            }
            if !at.is_finite() {
                return Err(ctx.error_at(&key, format!("a symmetry plane at {axis} = {at}")));
            }
            if side.is_some() {
                let help = format!("leave  periodic.{axis}  or  symmetry.{axis}  out");
                let what = format!("{axis} is periodic and has a symmetry plane");
                return Err(ctx.error_with_help(&key, what, help).with_code(ErrorCode::ConflictingKeys));
            }
        }
        Ok(())
    }

    /// The coordinate of each plane.
    pub(crate) fn build<const D: usize>(&self) -> [Option<f64>; D] {
        let planes = [self.x, self.y, self.z];
        std::array::from_fn(|axis| planes[axis])
    }
}

/// `[guard]`: the valid range of a water particle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct GuardConfig {
    /// Largest speed of water over c₀, –.
    pub speed: Option<f64>,
    /// Smallest and largest density over ρ₀, –.
    pub density: Option<[f64; 2]>,
    /// What happens to a particle that leaves the domain.
    pub escape: Option<Escape>,
}

impl GuardConfig {
    /// Refuses a range that excludes water at rest or does not limit anything.
    pub(crate) fn verify(&self, ctx: &Context) -> Result<()> {
        if let Some(speed) = self.speed
            && !(speed > 0.0 && speed <= 1.0)
        {
            let help = "write a part of the speed of sound, above 0 and at most 1: speed = 0.5";
            return Err(ctx.error_with_help("guard.speed", format!("a largest speed of {speed} c0"), help));
        }
        if let Some([least, most]) = self.density
            && !(0.0 < least && least < 1.0 && 1.0 < most && most.is_finite())
        {
            let help = "write two parts of ρ₀, one on either side of 1: density = [0.5, 1.5]";
            return Err(ctx.error_with_help("guard.density", format!("densities from {least} to {most} ρ₀"), help));
        }
        Ok(())
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults) {
        let usual = ParticleLimits::default();
        let why = "of c₀: beyond, the water is compressed by an eighth";
        defaults.fill("guard.speed", &mut self.speed, usual.speed, why);
        defaults.fill("guard.density", &mut self.density, usual.density, "of ρ₀: no water is lighter or denser");
        let why = "nothing is lost silently; \"remove\" takes it out and lists it";
        defaults.fill("guard.escape", &mut self.escape, usual.escape, why);
    }

    /// The valid range of a water particle.
    pub(crate) fn build(&self) -> ParticleLimits {
        let usual = ParticleLimits::default();
        ParticleLimits {
            speed: self.speed.unwrap_or(usual.speed),
            density: self.density.unwrap_or(usual.density),
            escape: self.escape.unwrap_or(usual.escape),
        }
    }
}
