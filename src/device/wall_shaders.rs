//! The text of the shaders: boundary particles, their densities and the velocities with which they act.

use super::{
    shaders::{ShaderInput, axis, body_read, extrapolation_input},
    text::{indented, statements},
};
use crate::{
    model::Slip,
    sph::{
        FluidProperties, Num as _,
        boundary::{Cover, WallExtrapolation, WallTarget, no_slip_difference},
        equation_of_state::EquationOfState,
        trace::{Trace, Traced},
    },
};

impl<const D: usize> ShaderInput<'_, D> {
    /// Whether water sticks to faces.
    pub(super) fn sticks(&self) -> bool {
        self.model.slip == Slip::None
    }

    /// The shader that sums over pairs, `text`, with the array of slips if water sticks to faces.
    pub(super) fn with_slips(&self, mut text: String) -> String {
        if self.sticks() {
            text.push_str("@group(0) @binding(14) var<storage, read> slips: array<vec4<f32>>;\n");
        }
        text
    }

    /// The bodies of the loops of a water particle over boundary particles, and of a boundary particle over water, by the trace of a
    /// pair of both, whose inputs are as `read` says. If water sticks to faces, the boundary particle acts with a velocity of its own,
    /// which does not compress the water: `system/slip_rates.rs`.
    pub(super) fn wall_bodies(&self, trace: &Trace, read: impl Fn(&str) -> String) -> Option<[String; 2]> {
        if !self.sticks() {
            let body = body_read(trace, "u", read)?;
            return Some([body.clone(), body]);
        }
        let acting = |name: &str| match name.strip_prefix('v') {
            Some(k) if k.len() == 1 => format!("acting.{}", axis(k)),
            _ => read(name),
        };
        let slope = statements(&self.traces.slope, "s", |_| "dot(r, r)".into())?;
        let body = body_read(trace, "u", acting)?;
        let rate = format!("sum{D} += out_slope * dot(slip, r) * b_volume / a_volume;\n");
        // The slip is that of the second particle beside a water particle, and that of the first beside a boundary particle.
        let of = |owner: &str, sign: &str| {
            let slip = format!("let slip = {sign}slips[{owner} - params.water].xyz;\nlet acting = v - slip;\n");
            format!("{slip}{body}{slope}{rate}")
        };
        Some([of("j", ""), of("k", "-")])
    }

    /// The shader that finds the velocities with which boundary particles act.
    pub(super) fn slips(&self) -> Option<String> {
        let mut fit = self.traces.extrapolation.clone();
        // The pressure is not needed here.
        fit.results.retain(|(name, _)| name != "sum1");
        let read = |other: fn(&str) -> String| {
            move |name: &str| name.strip_prefix("sum").map_or_else(|| other(name), |row| format!("fit{row}"))
        };
        let mut sums = statements(&fit, "f", read(extrapolation_input))?;
        let mut zeros = String::new();
        for row in fit.results.iter().filter_map(|(name, _)| name.strip_prefix("sum")) {
            sums += &format!("fit{row} = out_sum{row};\n");
            zeros += &format!("var fit{row} = 0.0f;\n");
        }
        let slip = Trace::record(&mut |recorder| {
            let each = |name: &str| -> [Traced; D] { std::array::from_fn(|k| recorder.input(&format!("{name}{k}"))) };
            let sum = |row: usize| recorder.input(&format!("sum{row}"));
            let fit = WallExtrapolation {
                weight_sum: sum(0),
                pressure_sum: recorder.constant(0.0),
                offset_sum: std::array::from_fn(|k| sum(2 + k)),
                velocity_sum: std::array::from_fn(|k| sum(2 + D + k)),
            };
            let past = no_slip_difference(&fit, &each("v"), &each("normal"), recorder.input("depth"));
            (0..3).for_each(|k| {
                recorder.result(&format!("past{k}"), past.get(k).copied().unwrap_or(recorder.constant(0.0)));
            });
        });
        let slip = statements(
            &slip,
            "w",
            read(|name| match name.strip_prefix("normal") {
                Some(k) => format!("normal.{}", axis(k)),
                None => wall_input(name),
            }),
        )?;
        let text = include_str!("shaders/sticks.wgsl").replace("{{ZERO_FIT}}", &indented(&zeros, 4));
        Some(text.replace("{{FIT}}", &indented(&sums, 8)).replace("{{SLIP}}", &indented(&slip, 4)))
    }
}

/// How the inputs of the equations of a wall are read.
pub(super) fn wall_input(name: &str) -> String {
    let component = |of: &str, k: &str| format!("{of}.{}", axis(k));
    match name {
        "density" => "wall.x".into(),
        "increase" => "wall.y".into(),
        "prompt_decrease" => "wall.z".into(),
        "prompt_increase" => "wall.w".into(),
        _ => match (name.strip_prefix("pull"), name.strip_prefix("g"), name.strip_prefix("v")) {
            (Some(k), ..) => component("pull", k),
            (_, Some(k), _) => component("gravity()", k),
            (.., Some(k)) => component("velocity", k),
            _ => name.into(),
        },
    }
}

/// The target of a boundary particle, its density as excess density: inputs `sum0`… of the extrapolation, `pull0`…, `g0`…, `v0`…,
/// `depth`, `own`, `full_weight` and `promptness`.
pub(super) fn wall_target<const D: usize>(
    properties: &FluidProperties<D>,
    eos: &EquationOfState,
    coefficients: &[f64],
) -> Trace {
    Trace::record(&mut |recorder| {
        let each = |name: &str| -> [Traced; D] { std::array::from_fn(|k| recorder.input(&format!("{name}{k}"))) };
        let sum = |row: usize| recorder.input(&format!("sum{row}"));
        let fit = WallExtrapolation {
            weight_sum: sum(0),
            pressure_sum: sum(1),
            offset_sum: std::array::from_fn(|k| sum(2 + k)),
            velocity_sum: std::array::from_fn(|k| sum(2 + D + k)),
        };
        let pressure = fit.pressure(&each("pull"), &each("g"), recorder.input("depth"));
        let cover = Cover { share: fit.weight_sum / recorder.input("full_weight") };
        let density = eos.binomial_compression(coefficients, pressure);
        let (own, promptness) = (recorder.input("own"), recorder.input("promptness"));
        let target = WallTarget::new(density, own, fit.approach(&each("v")), cover, promptness, [1.0, properties.c0]);
        recorder.result("density", target.density);
        recorder.result("increase", target.increase);
        recorder.result("prompt_decrease", target.prompt_decrease);
        recorder.result("prompt_increase", target.prompt_increase);
        let away = fit.direction();
        let none = recorder.constant(0.0);
        (0..3).for_each(|k| {
            let of = away.get(k).copied().unwrap_or(none);
            recorder.result(&format!("away{k}"), fit.weight_sum.select_below(recorder.constant(1e-9), none, of));
        });
    })
}

/// The change of density by which a boundary particle relaxes to its target.
pub(super) fn wall_change() -> Trace {
    Trace::record(&mut |recorder| {
        let input = |name: &str| recorder.input(name);
        let target = WallTarget {
            density: input("density"),
            increase: input("increase"),
            prompt_decrease: input("prompt_decrease"),
            prompt_increase: input("prompt_increase"),
        };
        recorder.result("change", target.change(input("own"), input("relaxation")));
    })
}
