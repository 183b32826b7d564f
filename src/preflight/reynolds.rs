//! The effective viscosity of the water and the Reynolds number U L/ν of each moving body.
//!
//! ν is ν₀ of a laminar viscosity; of an artificial one ν = α c₀ h/(4 (D + 2)), half of the value of Monaghan (2005) because the
//! term acts between approaching particles only @monaghan2005. The viscosity of the Riemann dissipation is that at a shear of
//! U/L. L is the D-th root of the body's volume. For a driven body, U is its largest speed across its faces. For a free body, U
//! is the largest of three speeds: √(|1 − s| g L), where s is its density over that of the water; its speed at the start; and the
//! orbital speed π H/T of the waves.

use serde::Serialize;

use super::{Finding, PreflightContext};
use crate::{
    math::format::{three_digits, two_digits_down},
    preflight::GeneratedWave,
    solid::{Role, Solid},
    sph::viscosity::Viscosity,
};

/// Least Reynolds number without a finding. The viscous drag of a disc in potential flow, 8 π ρ ν U, takes the share 16/Re of the
/// momentum of the disc and its added mass, ½ π ρ L² U, in the time L/U: at this number the disc loses 1 − e^(−16/30) = 0.41 of its
/// speed in that time.
const LEAST: f64 = 30.0;

/// The flow about a moving body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyFlow {
    /// Name of the body.
    pub name: String,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Origin of the speed: `buoyancy`, `start`, `waves` or `motion`.
    pub speed_from: &'static str,
    /// Size, m: the cube root of the volume, in 2-D the square root of the area.
    pub size_m: f64,
    /// Effective kinematic viscosity of the water, m²/s.
    pub viscosity_m2ps: f64,
    /// Reynolds number, –; absent without a viscosity.
    pub reynolds: Option<f64>,
}

/// Returns the flow about each moving body, and adds findings where viscosity governs it.
pub(super) fn body_flows<const D: usize>(
    context: &PreflightContext<D>,
    waves: &[GeneratedWave],
    findings: &mut Vec<Finding>,
) -> Vec<BodyFlow> {
    let model = context.system.model();
    let flows: Vec<BodyFlow> =
        context.solids().iter().enumerate().filter_map(|(i, s)| body_flow(context, i, s, waves)).collect();
    for flow in &flows {
        let Some(reynolds) = flow.reynolds.filter(|re| *re < LEAST) else { continue };
        // A laminar viscosity is the scene's own.
        let Viscosity::Artificial(law) = model.viscosity else { continue };
        let what = format!(
            "\"{}\" moves at {} m/s in water whose effective viscosity is {} m²/s: its Reynolds number is {}, and viscosity \
             slows it",
            flow.name,
            three_digits(flow.speed_mps),
            three_digits(flow.viscosity_m2ps),
            three_digits(reynolds)
        );
        let alpha = two_digits_down(law.alpha * reynolds / LEAST);
        let mend =
            format!("{LEAST} needs  viscosity = {{ artificial = {{ alpha = {alpha} }} }}  in [model], or a smaller dp");
        findings.push(Finding::warning("viscous_body", what, mend));
    }
    flows
}

fn body_flow<const D: usize>(
    context: &PreflightContext<D>,
    i: usize,
    solid: &Solid<D>,
    waves: &[GeneratedWave],
) -> Option<BodyFlow> {
    let volume = solid.spec.shape.volume_properties().volume;
    let size_m = volume.powf(1.0 / D as f64);
    let (speed_mps, speed_from) = match &solid.spec.role {
        Role::Fixed => return None,
        Role::Driven(_) => (context.driven_speed(i), "motion"),
        Role::Free(_) => {
            let ratio = solid.body.map_or(0.0, |body| body.mass) / (context.system.model().rho0 * volume);
            let orbital = waves.iter().filter_map(|w| Some(std::f64::consts::PI * w.height_m / w.period_s?));
            let speeds = [
                (((1.0 - ratio).abs() * context.g * size_m).sqrt(), "buoyancy"),
                (solid.kinematics.velocity.norm(), "start"),
                (orbital.fold(0.0, f64::max), "waves"),
            ];
            speeds.into_iter().fold((0.0, "buoyancy"), |most, x| if x.0 > most.0 { x } else { most })
        }
    };
    let known = speed_mps > 0.0 && size_m.is_finite();
    let model = context.system.model();
    let nu = model.viscosity.effective(model.c0, model.h, D, speed_mps / size_m);
    let reynolds = (nu > 0.0).then(|| speed_mps * size_m / nu);
    let name = solid.spec.name.clone();
    known.then_some(BodyFlow { name, speed_mps, speed_from, size_m, viscosity_m2ps: nu, reynolds })
}
