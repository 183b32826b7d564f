//! The effective viscosity of the water and the Reynolds number U L/ν of each moving body.
//!
//! ν is ν₀ of a laminar viscosity; of an artificial one ν = α c₀ h/(4 (D + 2)), half of the value of Monaghan (2005) because the
//! term acts between approaching particles only @monaghan2005. The viscosity of the Riemann dissipation is that at a shear of
//! U/L. L is the D-th root of the body's volume. For a driven body, U is its largest speed across its faces. For a free body, U
//! is the largest of three speeds: √(|1 − s| g L), where s is its density over that of the water; its speed at the start; and the
//! orbital speed π H/T of the waves. Of a slow body under water the resistance of the particles governs the motion.

use serde::Serialize;

use super::{Finding, PreflightContext};
use crate::{
    geometry::world_bounds,
    math::{
        Vector,
        format::{three_digits, two_digits_down},
    },
    model::PressureGradient,
    preflight::GeneratedWave,
    solid::{ForceSpec, Role, Solid},
    sph::viscosity::Viscosity,
};

/// Least Reynolds number without a finding. The viscous drag of a disc in potential flow, 8 π ρ ν U, takes the share 16/Re of the
/// momentum of the disc and its added mass, ½ π ρ L² U, in the time L/U: at this number the disc loses 1 − e^(−16/30) = 0.41 of its
/// speed in that time.
const LEAST: f64 = 30.0;

/// Force with which the particles resist slow motion under water, over the pressure there and the size of the body (in 3-D its square), –,
/// in 2-D and in 3-D, with h below 2 dp. In 2-D a disc of ten or twenty rows that swings at 0.026 to 0.08 m/s under 0.2 to 0.5 m of water
/// finds 0.5 to 1 % of pressure times diameter, and hardly less without viscosity. All shares are those of the same two motions
/// (`docs/measurements/slow-disc.toml`, `slow-ball.toml`).
const RESISTANCE: [f64; 2] = [0.006, 0.008];

/// The same with h of 2 dp or more.
const RESISTANCE_WIDE: [f64; 2] = [0.003, 0.003];

/// The same with gradients corrected at every depth as well.
const RESISTANCE_CORRECTED: [f64; 2] = [0.0007, 0.0007];

/// Processor time of a run with these gradients and h = 2 dp over that with the default ones, in 2-D and in 3-D, –, of the same motions.
const COST_CORRECTED: [f64; 2] = [1.2, 1.7];

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
    let mut flows = Vec::new();
    for (i, solid) in context.solids().iter().enumerate() {
        let (speed, size) = (largest_speed(context, i, solid, waves), size(solid));
        let slow = speed.and_then(|(speed, _)| slow_body(context, i, speed, size));
        let is_slow = slow.is_some();
        findings.extend(slow.into_iter().chain(sliding_body(context, i)));
        let Some(flow) = speed.and_then(|speed| body_flow(context, solid, speed, size)) else { continue };
        flows.push((flow, is_slow));
    }
    // Of a slow body the particles govern the motion, not viscosity.
    for flow in flows.iter().filter(|(_, is_slow)| !is_slow).map(|(flow, _)| flow) {
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
    flows.into_iter().map(|(flow, _)| flow).collect()
}

/// Size (m) of a solid: the D-th root of its volume.
fn size<const D: usize>(solid: &Solid<D>) -> f64 {
    solid.spec.shape.volume_properties().volume.powf(1.0 / D as f64)
}

/// The largest speed (m/s) of solid number `i` that is known in advance, and its origin; `None` for a fixed solid. Buoyancy does not
/// drive a body under water that a line holds.
fn largest_speed<const D: usize>(
    context: &PreflightContext<D>,
    i: usize,
    solid: &Solid<D>,
    waves: &[GeneratedWave],
) -> Option<(f64, &'static str)> {
    match &solid.spec.role {
        Role::Fixed => None,
        Role::Driven(_) => Some((context.driven_speed(i), "motion")),
        Role::Free(_) => {
            let volume = solid.spec.shape.volume_properties().volume;
            let ratio = solid.body.map_or(0.0, |body| body.mass) / (context.system.model().rho0 * volume);
            let orbital = waves.iter().filter_map(|w| Some(std::f64::consts::PI * w.height_m / w.period_s?));
            let is_held = is_on_line(context, i) && depth_under_water(context, i).is_some();
            let buoyancy = if is_held { 0.0 } else { ((1.0 - ratio).abs() * context.g * size(solid)).sqrt() };
            let speeds = [
                (buoyancy, "buoyancy"),
                (solid.kinematics.velocity.norm(), "start"),
                (orbital.fold(0.0, f64::max), "waves"),
            ];
            Some(speeds.into_iter().fold((0.0, "buoyancy"), |most, x| if x.0 > most.0 { x } else { most }))
        }
    }
}

fn body_flow<const D: usize>(
    context: &PreflightContext<D>,
    solid: &Solid<D>,
    (speed_mps, speed_from): (f64, &'static str),
    size_m: f64,
) -> Option<BodyFlow> {
    let known = speed_mps > 0.0 && size_m.is_finite();
    let model = context.system.model();
    let nu = model.viscosity.effective(model.c0, model.h, context.g, D, speed_mps / size_m);
    let reynolds = (nu > 0.0).then(|| speed_mps * size_m / nu);
    let name = solid.spec.name.clone();
    known.then_some(BodyFlow { name, speed_mps, speed_from, size_m, viscosity_m2ps: nu, reynolds })
}

/// Returns a warning if solid number `i`, of this `size` (m), moves at most at `speed` (m/s) under water, so that the particles resist
/// it more than its drag, ½ ρ U² Lᴰ⁻¹.
fn slow_body<const D: usize>(context: &PreflightContext<D>, i: usize, speed: f64, size: f64) -> Option<Finding> {
    let depth = depth_under_water(context, i)?;
    let (solid, model) = (&context.solids()[i], context.system.model());
    let is_wide = model.h >= 2.0 * model.dp * (1.0 - 1e-9);
    let is_corrected = model.gradient == PressureGradient::Corrected;
    let share = match (is_wide, is_corrected) {
        (true, true) => RESISTANCE_CORRECTED,
        (true, false) => RESISTANCE_WIDE,
        (false, _) => RESISTANCE,
    }[D - 2];
    let least = (2.0 * share * context.g * depth).sqrt();
    let rests = speed == 0.0 && !(matches!(solid.spec.role, Role::Free(_)) && is_on_line(context, i));
    if rests || speed >= least {
        return None;
    }
    let motion = if speed > 0.0 { format!("moves at {} m/s", three_digits(speed)) } else { "hangs on lines".into() };
    let (unit, face) = if D == 2 { ("N/m", "size") } else { ("N", "size squared") };
    let what = format!(
        "\"{}\" {motion} under {} m of water: there the particles resist slow motion with about {} {unit}, {} % of the pressure times its \
         {face}, more than drag does; its added mass is too small",
        solid.spec.name,
        three_digits(depth),
        three_digits(share * model.rho0 * context.g * depth * size.powi(D as i32 - 1)),
        three_digits(100.0 * share),
    );
    let slower = format!("hardly matters above {} m/s, and a finer dp does not reduce it", three_digits(least));
    let mend = if is_wide && is_corrected {
        format!("it {slower}")
    } else {
        let wider = if is_wide || D == 3 {
            ""
        } else {
            "  h_over_dp = 2.1  in [model] reduces it to a third, at 1.1 times the time of a run (a body on the bed then lacks 13 % of its \
             load, not 7 %);"
        };
        format!(
            "it {slower};{wider}  h_over_dp = 2.0  and  gradient = \"corrected\"  in [model] reduce it to a tenth, at {} times the time of a \
             run; bodies at the surface gain energy by them, and free ones more than 50 dp below it sink",
            COST_CORRECTED[D - 2]
        )
    };
    Some(Finding::warning("slow_body", what, mend))
}

/// Returns a warning if a horizontal force of the scene pushes body number `i` along a fixed solid under it, under water.
fn sliding_body<const D: usize>(context: &PreflightContext<D>, i: usize) -> Option<Finding> {
    depth_under_water(context, i)?;
    let solid = &context.solids()[i];
    let bounds = |solid: &Solid<D>| world_bounds(&solid.spec.shape, &solid.kinematics.pose);
    let (own, dp) = (bounds(solid), context.dp());
    let is_level = |force: &ForceSpec<D>| force.force.iter().take(D - 1).any(|law| law.steady_value() != Some(0.0));
    let force = context.system.constraints().forces.iter().find(|force| force.solid == i && is_level(force))?;
    // The inside of a tank lies within its box.
    let bed = context.solids().iter().find(|bed| {
        let below = Vector::from_fn(|axis, _| {
            if axis == D - 1 { own.min[axis] - 0.5 * dp } else { 0.5 * (own.min[axis] + own.max[axis]) }
        });
        matches!(bed.spec.role, Role::Fixed) && bed.spec.shape.signed_distance(&bed.kinematics.pose.local(&below)) < 0.0
    })?;
    let what = format!(
        "force \"{}\" pushes \"{}\" along \"{}\" under water: the particles at its lower edges hold a body on a bed with about \
         4 % of the pressure on its front",
        force.name, solid.spec.name, bed.spec.name
    );
    let mend = "keep it five dp above the bed by  free.locked , or trust only larger forces".into();
    Some(Finding::warning("sliding_body", what, mend))
}

/// Depth (m) of the middle of solid number `i` under the still level around it; `None` unless it is whole under water.
fn depth_under_water<const D: usize>(context: &PreflightContext<D>, i: usize) -> Option<f64> {
    let solid = &context.solids()[i];
    let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
    let level = context.level_around(i).filter(|level| context.g > 0.0 && bounds.max[D - 1] <= *level)?;
    Some(level - 0.5 * (bounds.min[D - 1] + bounds.max[D - 1]))
}

/// Whether a spring, a rope or a mooring line acts on solid number `i` at the start.
fn is_on_line<const D: usize>(context: &PreflightContext<D>, i: usize) -> bool {
    let mut lines = context.system.constraints().lines();
    lines.any(|(ends, lifetime)| lifetime.contains(0.0) && ends.iter().any(|end| end.solid == Some(i)))
}
