//! `[model]` and `[time]`: the equations of the water and the time scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::water::StillWaterLevel;
use crate::{
    error::Result,
    model::{
        BODIES_IN_WAVES_H_OVER_DP, C0_FACTOR, Diffusion, KernelKind, Model, PairLoopKind, PressureGradient, Shifting,
        Slip, TimeScheme, Viscosity, WAVES_H_OVER_DP, Walls,
    },
    scene::context::{Context, Defaults},
    sph::viscosity::Artificial,
};

/// Largest Courant number: still water around a float is at rest at 0.8. It is unstable at 1.0, although no other check fails.
const CFL_MAX: f64 = 0.8;

/// The same with corrected gradients: still water is at rest at 0.6 and unstable at 0.8.
const CORRECTED_CFL_MAX: f64 = 0.6;

/// Least stiffness μ of the lattice, –. Below it, still water around a float reached speeds of 0.07 to 0.13 √(g depth) within a
/// second; above it, at most 0.08 √(g depth) (docs/explanation/stability.md).
const MIN_LATTICE_STIFFNESS: f64 = -0.07;

/// Least depth of still water over the radius of the kernel, –: at 0.67 the water rises by some per cent of dp, at 0.75 not
/// at all (docs/explanation/stability.md).
const MIN_DEPTH_RATIO: f64 = 0.75;

/// The chosen laws.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct ModelConfig {
    /// Kernel.
    pub kernel: Option<KernelKind>,
    /// Smoothing length over particle spacing, –.
    pub h_over_dp: Option<f64>,
    /// Smoothing length over the spacing's diagonal √D·dp, –.
    pub c_h: Option<f64>,
    /// The pressure's gradient.
    pub gradient: Option<PressureGradient>,
    /// Viscosity.
    pub viscosity: Option<Viscosity>,
    /// Density diffusion.
    pub diffusion: Option<Diffusion>,
    /// Particle shifting.
    pub shifting: Option<Shifting>,
    /// Walls.
    pub walls: Option<Walls>,
    /// How water slips along solids.
    pub slip: Option<Slip>,
    /// The pair loop.
    pub sweep: Option<PairLoopKind>,
    /// The device that computes the water: `cpu`, `gpu`, the number of an adapter or part of its name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// Speed of sound, m/s.
    pub c0: Option<f64>,
    /// Speed of sound over √(g · depth), –.
    pub c0_factor: Option<f64>,
    /// Reference density, kg/m³.
    pub rho0: Option<f64>,
    /// Exponent of the equation of state, –.
    pub gamma: Option<f64>,
}

/// The time scheme.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct TimeSteppingConfig {
    /// Scheme.
    pub scheme: Option<TimeScheme>,
    /// Courant number, –.
    pub cfl: Option<f64>,
    /// Longest step, s.
    pub dt_max: Option<f64>,
}

impl ModelConfig {
    /// Refuses numbers out of range and keys that contradict each other.
    pub(crate) fn verify(&self, ctx: &Context) -> Result<()> {
        let numbers = [
            ("model.h_over_dp", self.h_over_dp),
            ("model.c_h", self.c_h),
            ("model.c0", self.c0),
            ("model.c0_factor", self.c0_factor),
            ("model.rho0", self.rho0),
            ("model.gamma", self.gamma),
        ];
        numbers.into_iter().try_for_each(|(key, x)| ctx.require_positive(key, x))?;
        let (viscosity, diffusion, shifting) = (self.viscosity, self.diffusion, self.shifting);
        let constants = match viscosity {
            Some(Viscosity::Artificial(law)) => vec![("viscosity.artificial.alpha", law.alpha)],
            Some(Viscosity::Riemann(law)) => {
                let threshold = law.threshold.map(|threshold| ("viscosity.riemann.threshold", threshold));
                [("viscosity.riemann.eta", law.eta)].into_iter().chain(threshold).collect()
            }
            Some(Viscosity::Laminar(law)) => vec![("viscosity.laminar.nu0", law.nu0)],
            Some(Viscosity::Sps(law)) => vec![
                ("viscosity.sps.nu0", law.nu0),
                ("viscosity.sps.smagorinsky", law.smagorinsky),
                ("viscosity.sps.isotropic", law.isotropic),
            ],
            None | Some(Viscosity::None) => vec![],
        };
        let delta = match diffusion {
            Some(Diffusion::Molteni(law)) => Some(("diffusion.molteni.delta", law.delta)),
            Some(Diffusion::Fourtakas(law)) => Some(("diffusion.fourtakas.delta", law.delta)),
            None | Some(Diffusion::None) => None,
        };
        let a = match shifting {
            Some(Shifting::AwayFromSolids(law)) => Some(("shifting.away_from_solids.a", law.a)),
            Some(Shifting::AwayFromFixed(law)) => Some(("shifting.away_from_fixed.a", law.a)),
            Some(Shifting::Everywhere(law)) => Some(("shifting.everywhere.a", law.a)),
            None | Some(Shifting::None) => None,
        };
        for (key, x) in constants.into_iter().chain(delta).chain(a) {
            ctx.require_not_negative(&format!("model.{key}"), x)?;
        }
        let both = |a: &str, b: &str, help: &str| {
            Err(ctx.error_with_help(&format!("model.{b}"), format!("{a} and {b} say the same thing twice"), help))
        };
        if self.h_over_dp.is_some() && self.c_h.is_some() {
            return both("h_over_dp", "c_h", "give one: h = h_over_dp · dp = c_h · √dimension · dp");
        }
        if self.c0.is_some() && self.c0_factor.is_some() {
            return both("c0", "c0_factor", "give one: c0 = c0_factor · √(g · depth)");
        }
        let reach = 2.0 * ctx.h / ctx.dp;
        if !(1.9..=12.0).contains(&reach) {
            let what = format!("the kernel would reach {reach:.2} dp; sums over neighbours need 1.9 to 12");
            return Err(ctx.error_with_help(self.smoothing_key(), what, "write  h_over_dp = 1.7"));
        }
        Ok(())
    }

    /// Whether the kernel and the shifting of the scene allow corrected gradients.
    pub(crate) fn allows_corrected_gradients(&self) -> bool {
        matches!(self.kernel, None | Some(KernelKind::Wendland)) && matches!(self.shifting, None | Some(Shifting::None))
    }

    /// The key that gives the smoothing length.
    fn smoothing_key(&self) -> &'static str {
        if self.c_h.is_some() { "model.c_h" } else { "model.h_over_dp" }
    }

    /// Smoothing length h (m) for the particle spacing `dp` (m).
    pub(crate) fn smoothing_length(&self, dimension: usize, dp: f64) -> f64 {
        match (self.h_over_dp, self.c_h) {
            (Some(ratio), _) => ratio * dp,
            (None, Some(c_h)) => c_h * (dimension as f64).sqrt() * dp,
            (None, None) => default_h_over_dp(dimension) * dp,
        }
    }

    /// Fills in the smoothing length, from which other defaults follow.
    pub(crate) fn fill_smoothing(&mut self, defaults: &mut Defaults, usual: &Model) {
        if self.c_h.is_none() {
            let ratio = usual.h / usual.dp;
            let dimension = usual.gravity.len();
            let why = match dimension {
                3 if ratio == WAVES_H_OVER_DP[1] => "waves keep most height; about 190 neighbours",
                3 => "waves lose height below 1.5 dp; about 110 neighbours",
                _ if ratio == WAVES_H_OVER_DP[0] => "waves keep their height; about 72 neighbours",
                _ if ratio == BODIES_IN_WAVES_H_OVER_DP => {
                    "waves keep most height, and bodies move as in theory; about 50 neighbours"
                }
                _ if ratio > default_h_over_dp(dimension) => {
                    "free bodies in water deeper than 100 dp: below, the pressure's errors slow them; about 55 neighbours"
                }
                _ => "waves lose height below 1.7 dp; about 36 neighbours",
            };
            defaults.fill("model.h_over_dp", &mut self.h_over_dp, ratio, why);
        }
    }

    /// Fills in the other defaults; `usual` are the values of water.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, usual: &Model) {
        let wendland = "no pairing of particles and less noise than the cubic spline, at the same cost";
        defaults.fill("model.kernel", &mut self.kernel, usual.kernel, wendland);
        let why = match usual.gradient {
            PressureGradient::Plain if !self.allows_corrected_gradients() => {
                "others are made for the Wendland kernel without shifting"
            }
            PressureGradient::Plain => "no paddle makes waves by name",
            _ => "waves keep their height",
        };
        defaults.fill("model.gradient", &mut self.gradient, usual.gradient, why);
        let why = match usual.viscosity {
            Viscosity::Artificial(law) if law != Artificial::default() => {
                "α = 0.02 √(10 dp/depth), a free body in water deeper than 100 dp: the viscosity does not grow with the depth"
            }
            Viscosity::Artificial(_) => "a body is free: boxes roll as in theory; α = 0.02 as in the method",
            _ => "stops impacts and hardly damps waves; it does not grow with the depth",
        };
        defaults.fill("model.viscosity", &mut self.viscosity, usual.viscosity, why);
        if let Some(Viscosity::Riemann(law)) = &mut self.viscosity {
            let of_waves = if let Viscosity::Riemann(usual) = usual.viscosity { usual.threshold } else { None };
            let why = if of_waves.is_some() { "waves keep their height" } else { "still water comes to rest" };
            defaults.fill("model.viscosity.riemann.threshold", &mut law.threshold, of_waves.unwrap_or(0.0), why);
        }
        let why = "damps the density's noise and keeps still water still; δ = 0.1 as in the method";
        defaults.fill("model.diffusion", &mut self.diffusion, usual.diffusion, why);
        defaults.fill("model.shifting", &mut self.shifting, usual.shifting, "shifting slowly inflates the water");
        defaults.fill(
            "model.walls",
            &mut self.walls,
            usual.walls,
            "no gap between water and wall; bodies rest at their draft",
        );
        let why = "no particle resolves the boundary layer, and artificial viscosity would make one many dp thick";
        defaults.fill("model.slip", &mut self.slip, usual.slip, why);
        let why = "single precision where it is harmless; \"reference\" is double precision throughout";
        defaults.fill("model.sweep", &mut self.sweep, usual.pair_loop, why);
        if self.c0.is_none() {
            let why =
                "density varies by 1 %, a few in an impact; the depth is from the lowest water to the highest level";
            defaults.fill("model.c0_factor", &mut self.c0_factor, C0_FACTOR, why);
        }
        defaults.fill("model.rho0", &mut self.rho0, usual.rho0, "fresh water, kg/m³");
        defaults.fill("model.gamma", &mut self.gamma, usual.gamma, "water");
    }

    /// The laws and constants of a scene over `still` water.
    pub(crate) fn build(&self, ctx: &Context, time: &TimeSteppingConfig, still: &StillWaterLevel) -> Result<Model> {
        let gravity = ctx.gravity.as_ref().map_or_else(|| vec![0.0; ctx.dimension], |gravity| gravity.initial.clone());
        let g = ctx.gravity_norm();
        let c0 = self.c0.unwrap_or(self.c0_factor.unwrap_or_default() * (g * still.depth).sqrt());
        if !(c0.is_finite() && c0 > 0.0) {
            let help = "write  c0 = ...  in [model]: 10 to 20 times the largest speed expected, m/s";
            let what = match g == 0.0 {
                true => "without gravity the depth gives no speed of sound".into(),
                false => format!("a depth of {} m gives no speed of sound", still.depth),
            };
            return Err(ctx.error_with_help("model.c0", what, help));
        }
        let missing = |key: &str| ctx.error_at(key, "this law has no value");
        Ok(Model {
            kernel: self.kernel.ok_or_else(|| missing("model.kernel"))?,
            h: ctx.h,
            dp: ctx.dp,
            rho0: self.rho0.ok_or_else(|| missing("model.rho0"))?,
            c0,
            gamma: self.gamma.ok_or_else(|| missing("model.gamma"))?,
            gravity,
            gradient: self.gradient.ok_or_else(|| missing("model.gradient"))?,
            viscosity: self.viscosity.ok_or_else(|| missing("model.viscosity"))?,
            diffusion: self.diffusion.ok_or_else(|| missing("model.diffusion"))?,
            shifting: self.shifting.ok_or_else(|| missing("model.shifting"))?,
            walls: self.walls.ok_or_else(|| missing("model.walls"))?,
            slip: self.slip.ok_or_else(|| missing("model.slip"))?,
            pair_loop: self.sweep.unwrap_or_default(),
            scheme: time.scheme.ok_or_else(|| missing("time.scheme"))?,
            cfl: time.cfl.ok_or_else(|| missing("time.cfl"))?,
            dt_max: time.dt_max.unwrap_or(f64::INFINITY),
        })
    }

    /// Refuses laws that exclude each other or the Courant number, and a kernel with which the initial lattice is unstable under its own pressure.
    pub(crate) fn require_stable_lattice<const D: usize>(&self, ctx: &Context, model: &Model) -> Result<()> {
        if let Some(what) = model.conflict() {
            let help = "write  kernel = \"wendland\"  and  shifting = \"none\", or  gradient = \"plain\"";
            return Err(ctx.error_with_help("model.gradient", what, help));
        }
        if model.gradient != PressureGradient::Plain && model.cfl > CORRECTED_CFL_MAX {
            let what = format!(
                "a Courant number of {}: with corrected gradients water boils above {CORRECTED_CFL_MAX}, often without another sign",
                model.cfl
            );
            return Err(ctx.error_with_help("time.cfl", what, "write  cfl = 0.4, or  model.gradient = \"plain\""));
        }
        if !ctx.has_gravity() {
            return Ok(());
        }
        let (h, stiffness) = (model.h / model.dp, model.lattice_stiffness::<D>());
        if stiffness > MIN_LATTICE_STIFFNESS {
            return Ok(());
        }
        let key = self.smoothing_key();
        let what = format!(
            "h = {h:.2} dp is unstable with this kernel: the initial particle lattice has a shear instability, and still water does \
             not stay still (its stiffness over its pressure is {stiffness:.3}, and {MIN_LATTICE_STIFFNESS} the least)"
        );
        Err(ctx.error_with_help(key, what, "write  h_over_dp = 1.7  and  kernel = \"wendland\""))
    }
}

impl TimeSteppingConfig {
    /// Refuses numbers out of range.
    pub(crate) fn verify(&self, ctx: &Context) -> Result<()> {
        ctx.require_positive("time.cfl", self.cfl)?;
        ctx.require_positive("time.dt_max", self.dt_max)?;
        match self.cfl {
            Some(cfl) if cfl > CFL_MAX => {
                let what =
                    format!("a Courant number of {cfl}: above {CFL_MAX} water boils, often without another sign");
                Err(ctx.error_with_help("time.cfl", what, "write  cfl = 0.4; with Verlet  cfl = 0.2"))
            }
            _ => Ok(()),
        }
    }

    /// Fills in the defaults; `usual` are the values of water.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, usual: &Model) {
        let why = "second order, without the odd–even mode of Verlet, as exact at the same price";
        defaults.fill("time.scheme", &mut self.scheme, usual.scheme, why);
        let (cfl, why) = match self.scheme {
            Some(TimeScheme::Verlet { .. }) => (0.2, "the method's, for Verlet"),
            _ => (usual.cfl, "impacts, contacts and ropes are worse above; waves and still water take 0.6"),
        };
        defaults.fill("time.cfl", &mut self.cfl, cfl, why);
    }
}

/// Smoothing length over particle spacing in water of moderate depth, where the scene does not give it.
fn default_h_over_dp(dimension: usize) -> f64 {
    let usual = Model::water(dimension.clamp(2, 3), 1.0, 1.0);
    usual.h / usual.dp
}

/// Refuses still water so shallow that no kernel is complete between its surface and its bed.
pub(crate) fn require_depth(ctx: &Context, still: &StillWaterLevel, model: &Model) -> Result<()> {
    let reach = model.support_radius();
    if model.gravity.last().is_none_or(|g| *g == 0.0) || still.depth > 0.999 * MIN_DEPTH_RATIO * reach {
        return Ok(());
    }
    let what = format!(
        "the water is {:.2} dp deep and the kernel reaches {:.2} dp: no sum is complete between bed and surface, and the water would rise",
        still.depth / ctx.dp,
        reach / ctx.dp
    );
    let dp = still.depth * ctx.dp / (MIN_DEPTH_RATIO * reach);
    Err(ctx.error_with_help(
        "water",
        what,
        format!("{MIN_DEPTH_RATIO} of the reach is the least: write  dp = {dp:.2e}  or less"),
    ))
}
