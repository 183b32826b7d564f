//! The text of the shaders: hand-written files for search, lists and steps, and the traces of the equations in between.

use super::text::{indented, statements};
use crate::{
    interaction::PairTraces,
    model::{Model, TimeScheme, Walls},
    sph::{
        FluidProperties, Units,
        boundary::{Cover, WallExtrapolation, WallTarget},
        equation_of_state::EquationOfState,
        trace::{Trace, Traced},
    },
    system::ParticleLimits,
    time_integration::FOLDINGS,
};

/// Threads of a workgroup.
pub(super) const GROUP: usize = 128;

/// Workgroups in a row.
pub(super) const ROW: usize = 32768;

/// Ticks in the unit of time, h/c₀.
pub(super) const TICKS: f64 = (1 << 24) as f64;

/// Unit of the excess density.
pub(super) const EXCESS: f64 = 1.0 / (1u64 << 31) as f64;

const COMMON: &str = include_str!("shaders/common.wgsl");

/// What the shaders are made for.
pub(super) struct ShaderInput<'a, const D: usize> {
    pub(super) model: &'a Model,
    pub(super) traces: &'a PairTraces,
    pub(super) units: Units,
    pub(super) limits: ParticleLimits,
    /// The domain in 2⁻⁸ of the support.
    pub(super) domain: [[i32; D]; 2],
    /// How far the lists reach beyond the support, over the support.
    pub(super) margin: f64,
    /// Boundary particles of moving solids, in whole chunks; all chunks.
    pub(super) chunks: [usize; 2],
}

/// The texts.
#[derive(Debug, Clone)]
pub struct ShaderTexts {
    /// Sorting.
    pub search: String,
    /// Neighbour lists.
    pub lists: String,
    /// Sums over pairs.
    pub sweep: String,
    /// Time step and schemes.
    pub step: String,
    /// Solids.
    pub solids: String,
    /// Rows of sums.
    pub rows: usize,
    /// Whether walls relax.
    pub relaxed: bool,
}

fn float(x: f64) -> String {
    format!("{:?}f", x as f32)
}

fn vector<const D: usize>(x: impl Fn(usize) -> String, none: &str) -> String {
    (0..3).map(|k| if k < D { x(k) } else { none.into() }).collect::<Vec<_>>().join(", ")
}

impl<const D: usize> ShaderInput<'_, D> {
    /// The texts; `None` if a constant of the model overflows single precision, or γ is not 7.
    pub(super) fn texts(&self) -> Option<ShaderTexts> {
        let properties = self.model.fluid_properties::<D>().in_units(&self.units);
        let head = format!("{COMMON}{}", self.constants(&properties));
        let with_head = |text: &str| format!("{head}{text}");
        let sum = |k: usize| format!("sums[{k}u * params.n + k]");
        let force = vector::<D>(sum, "0.0f");
        let eos = EquationOfState::new(properties.c0, properties.gamma);
        eos.binomial_pressure(0.0)?;
        let pressure = Trace::record(&mut |recorder| {
            let p = eos.binomial_pressure(recorder.input("x")).unwrap_or_else(|| recorder.constant(0.0));
            recorder.result("pressure", p);
        });
        let step = include_str!("shaders/step.wgsl")
            .replace("{{PRESSURE}}", &indented(&statements(&pressure, "t", str::to_string)?, 4))
            .replace("{{CHANGE}}", &indented(&statements(&wall_change(), "t", wall_input)?, 4))
            .replace("{{FORCE}}", &force)
            .replace("{{RATE}}", &D.to_string());
        Some(ShaderTexts {
            search: with_head(include_str!("shaders/search.wgsl")),
            lists: with_head(include_str!("shaders/lists.wgsl")),
            sweep: with_head(&self.sweep(&properties, &eos)?),
            step: with_head(&step),
            rows: self.traces.rows[1],
            relaxed: self.model.walls == Walls::RelaxedAdami,
            solids: with_head(&include_str!("shaders/solids.wgsl").replace("{{FORCE}}", &force)),
        })
    }

    fn constants(&self, properties: &FluidProperties<D>) -> String {
        let Self { model, units, limits, domain, margin, chunks, .. } = self;
        let support = model.support_radius() / units.length;
        let crossing = model.h / model.c0;
        let (euler_every, growth) = match model.scheme {
            TimeScheme::Verlet { euler_every } => {
                (euler_every, (model.diffusion.damping() + model.viscosity.damping()) * model.c0 / model.h * units.time)
            }
            TimeScheme::Symplectic => (1, 0.0),
        };
        let longest = model.viscosity.step_limit(model.h).min(model.dt_max) / units.time;
        let excess = |ratio: f64| ((ratio - 1.0) / EXCESS).clamp(-1.9e9, 1.9e9) as i32;
        let lines = [
            format!("const VERLET: bool = {};", matches!(model.scheme, TimeScheme::Verlet { .. })),
            format!("const RELAXED: bool = {};", model.walls == Walls::RelaxedAdami),
            format!("const LAYERS: i32 = {};", if D == 3 { 1 } else { 0 }),
            format!("const SUMS: u32 = {}u;", self.traces.rows[1]),
            format!("const LOOK2: f32 = {};", float((support * (1.0 + margin)).powi(2))),
            // Two particles that approach by half the margin each.
            format!("const MARGIN2: u32 = {}u;", ((0.5 * margin * support * 0.999).powi(2) as f32).to_bits()),
            format!("const MOVING: u32 = {}u;", chunks[0] * GROUP),
            format!("const CHUNKS: u32 = {}u;", chunks[1]),
            format!("const GRAVITY: vec3<f32> = vec3<f32>({});", vector::<D>(|k| float(properties.gravity[k]), "0.0f")),
            format!("const SMOOTHING: f32 = {};", float(properties.h)),
            format!("const SOUND: f32 = {};", float(properties.c0)),
            format!("const COURANT: f32 = {};", float(model.cfl)),
            format!("const LONGEST: f32 = {};", float(longest.min(0.9))),
            format!("const PER_CROSSING: f32 = {};", float(units.time / crossing)),
            format!("const EULER_EVERY: u32 = {}u;", euler_every.max(1)),
            format!("const FOLDINGS: f32 = {};", float(FOLDINGS)),
            format!("const GROWTH: f32 = {};", float(growth)),
            format!("const FASTEST2: u32 = {}u;", ((limits.speed * properties.c0).powi(2) as f32).to_bits()),
            format!("const LEAST: i32 = {};", excess(limits.density[0])),
            format!("const MOST: i32 = {};", excess(limits.density[1])),
            format!("const DOMAIN_MIN: vec3<i32> = vec3<i32>({});", vector::<D>(|k| domain[0][k].to_string(), "0")),
            format!("const DOMAIN_MAX: vec3<i32> = vec3<i32>({});", vector::<D>(|k| domain[1][k].to_string(), "0")),
        ];
        lines.join("\n") + "\n"
    }

    /// The sums over pairs: one kernel for the water, one for the boundary particles.
    fn sweep(&self, properties: &FluidProperties<D>, eos: &EquationOfState) -> Option<String> {
        let [_, sums] = self.traces.rows;
        let relaxed = self.model.walls == Walls::RelaxedAdami;
        let fluid = pair_body(&self.traces.fluid, "t")?;
        let wall = pair_body(&self.traces.wall, "u")?;
        let fit = statements(&self.traces.extrapolation, "f", |name| match name.strip_prefix("sum") {
            Some(row) => format!("fit{row}"),
            None => extrapolation_input(name),
        })?;
        let fit_rows = self.traces.extrapolation.results.len();
        let mut beside = wall.clone();
        if relaxed {
            beside += &fit;
            for (name, _) in &self.traces.extrapolation.results {
                let row = name.trim_start_matches("sum");
                beside += &format!("fit{row} = out_sum{row};\n");
            }
            // The results of the fit have the names of those of the pair.
            beside = format!("{{\n{wall}}}\n{{\n{}}}\n", &beside[wall.len()..]);
        }
        let zeros = |name: &str, rows: usize| (0..rows).map(|row| format!("var {name}{row} = 0.0f;\n")).collect::<String>();
        let store = |rows: usize| {
            (0..rows).map(|row| format!("sums[{row}u * params.n + k] = sum{row};\n")).collect::<String>()
        };
        let target = statements(&wall_target(properties, eos), "w", |name| match name.strip_prefix("sum") {
            Some(row) => format!("fit{row}"),
            None => wall_input(name),
        })?;
        let target = if relaxed { include_str!("shaders/wall_target.wgsl").replace("{{TARGET}}", &target) } else { String::new() };
        let text = include_str!("shaders/sweep.wgsl")
            .replace("{{ZERO_SUMS}}", &indented(&zeros("sum", sums), 8))
            .replace("{{ZERO_FIT}}", &indented(&zeros("fit", if relaxed { fit_rows } else { 0 }), 8))
            .replace("{{FLUID}}", &indented(&fluid, 12))
            .replace("{{WALL}}", &indented(&wall, 12))
            .replace("{{BESIDE}}", &indented(&beside, 12))
            .replace("{{STORE}}", &indented(&store(sums), 8))
            .replace("{{TARGET}}", &indented(&target, 8))
            .replace("{{FORCE}}", &vector::<D>(|k| format!("sum{k}"), "0.0f"));
        Some(text)
    }
}

/// What the loop over neighbours `j` of particle `k` does with a pair.
fn pair_body(trace: &Trace, prefix: &str) -> Option<String> {
    let mut text = statements(trace, prefix, pair_input)?;
    for (name, _) in &trace.results {
        text += &format!("{name} = out_{name};\n");
    }
    Some(text)
}

fn axis(k: &str) -> &'static str {
    match k {
        "0" => "x",
        "1" => "y",
        _ => "z",
    }
}

/// How the inputs of a pair are read.
fn pair_input(name: &str) -> String {
    match name.split_at(1) {
        ("r", k) if k.len() == 1 => format!("r.{}", axis(k)),
        ("v", k) if k.len() == 1 => format!("v.{}", axis(k)),
        _ => name.into(),
    }
}

/// How the inputs of an extrapolation are read.
fn extrapolation_input(name: &str) -> String {
    match name.split_at(1) {
        ("v", k) if k.len() == 1 => format!("other_velocity.{}", axis(k)),
        _ => pair_input(name),
    }
}

/// How the inputs of the equations of a wall are read.
fn wall_input(name: &str) -> String {
    let component = |of: &str, k: &str| format!("{of}.{}", axis(k));
    match name {
        "density" => "wall.x".into(),
        "increase" => "wall.y".into(),
        "prompt_decrease" => "wall.z".into(),
        "prompt_increase" => "wall.w".into(),
        _ => match (name.strip_prefix("pull"), name.strip_prefix("g"), name.strip_prefix("v")) {
            (Some(k), ..) => component("pull", k),
            (_, Some(k), _) => component("GRAVITY", k),
            (.., Some(k)) => component("velocity", k),
            _ => name.into(),
        },
    }
}

/// The target of a boundary particle, its density as excess density: inputs `sum0`… of the extrapolation, `pull0`…, `g0`…, `v0`…,
/// `depth`, `own`, `full_weight` and `promptness`.
fn wall_target<const D: usize>(properties: &FluidProperties<D>, eos: &EquationOfState) -> Trace {
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
        let density = eos.binomial_compression(pressure);
        let (own, promptness) = (recorder.input("own"), recorder.input("promptness"));
        let target = WallTarget::new(density, own, fit.approach(&each("v")), cover, promptness, [1.0, properties.c0]);
        recorder.result("density", target.density);
        recorder.result("increase", target.increase);
        recorder.result("prompt_decrease", target.prompt_decrease);
        recorder.result("prompt_increase", target.prompt_increase);
    })
}

/// The change of density by which a boundary particle relaxes to its target.
fn wall_change() -> Trace {
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
