//! The text of the shaders: hand-written files for search, lists and steps, and the traces of the equations in between.

use super::{
    periodic::Sides,
    text::{indented, statements},
    wall_shaders::{wall_change, wall_input, wall_target},
};
use crate::{
    interaction::PairTraces,
    model::{Model, PressureGradient, TimeScheme, Walls},
    sph::{
        AuxiliarySums, FluidProperties, Units,
        boundary::RELAXATION_TIME,
        equation_of_state::EquationOfState,
        gradient_correction,
        pressure::repulsion,
        trace::{Recorder, Trace, Traced},
    },
    system::{Escape, ParticleLimits},
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

/// The data from which the texts of the shaders are written.
pub(super) struct ShaderInput<'a, const D: usize> {
    pub(super) model: &'a Model,
    pub(super) traces: &'a PairTraces,
    pub(super) units: Units,
    pub(super) limits: ParticleLimits,
    /// The domain in 2⁻⁸ of the support.
    pub(super) domain: [[i32; D]; 2],
    pub(super) sides: Sides<D>,
    /// How far the lists reach beyond the support, over the support.
    pub(super) margin: f64,
    /// Boundary particles of moving solids, in whole chunks; all chunks.
    pub(super) chunks: [usize; 2],
    /// Whether there may be narrow gaps beside free solids.
    pub(super) gaps: bool,
    /// Whether the host reads the water between outputs.
    pub(super) near: bool,
    /// Whether the host reads the weights of the water around boundary particles.
    pub(super) weighs: bool,
    /// Whether it also reads where that water is.
    pub(super) offsets: bool,
    /// Whether gravity changes with time.
    pub(super) gravity_changes: bool,
    /// Statements that add the rates of the sponge layers at `place` to `rate`.
    pub(super) sponge: String,
    /// Traces of the pressure alone, if powers are measured; then with uncorrected gradients, if the model corrects them.
    pub(super) pressure: &'a [PairTraces],
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
    /// Images across periodic sides, if there are such sides.
    pub images: Option<String>,
    /// Pressure across gaps, if there may be any.
    pub gaps: Option<String>,
    /// Boundary particles of films, if there may be any.
    pub films: Option<String>,
    /// Additional inputs of the pair loop, if terms read any.
    pub inputs: Option<String>,
    /// Moments of the neighbours, if gradients are corrected.
    pub moments: Option<String>,
    /// Water near places of the host, if it reads any.
    pub near: Option<String>,
    /// Velocities with which boundary particles act, if water sticks to faces.
    pub sticks: Option<String>,
    /// Powers, if they are measured; then the sums over pairs of the pressure alone.
    pub powers: Vec<String>,
    /// Numbers of rows: of sums, of additional inputs, and of the inputs that are kept from pass to pass.
    pub rows: [usize; 3],
    /// The first row of the stress of the water, if it is kept.
    pub stress: Option<usize>,
}

/// Width of a cell in 2⁻⁸ of the support: two cells span the reach of the lists, which is `margin` beyond the support.
pub(super) fn cell_width(margin: f64) -> i32 {
    (128.0 * (1.0 + margin)).ceil() as i32
}

fn float(x: f64) -> String {
    format!("{:?}f", x as f32)
}

fn vector<const D: usize>(x: impl Fn(usize) -> String, none: &str) -> String {
    (0..3).map(|k| if k < D { x(k) } else { none.into() }).collect::<Vec<_>>().join(", ")
}

impl<const D: usize> ShaderInput<'_, D> {
    /// The texts; `None` if a constant of the model overflows single precision, or γ is above 7.
    pub(super) fn texts(&self) -> Option<ShaderTexts> {
        let properties = self.model.fluid_properties::<D>().in_units(&self.units);
        let head = format!("{COMMON}{}{}", self.sides.text(), self.constants(&properties));
        let with_head = |text: &str| format!("{head}{text}");
        let sum = |k: usize| format!("sums[{k}u * params.n + k]");
        let force = vector::<D>(sum, "0.0f");
        let eos = EquationOfState::new(properties.c0, properties.gamma);
        let coefficients = eos.coefficients()?;
        let pressure = Trace::record(&mut |recorder| {
            recorder.result("pressure", eos.binomial_pressure(&coefficients, recorder.input("x")));
        });
        let step = include_str!("shaders/step.wgsl")
            .replace("{{PRESSURE}}", &indented(&statements(&pressure, "t", str::to_string)?, 4))
            .replace("{{CHANGE}}", &indented(&statements(&wall_change(), "t", wall_input)?, 4))
            .replace("{{FORCE}}", &force);
        let step = self.with_changes(&step, &properties)?;
        let apart = if self.sides.has_planes() { "solids[a].centre.hi.w != solids[b].centre.hi.w" } else { "a != b" };
        let gaps = include_str!("shaders/gaps.wgsl")
            .replace("{{APART}}", apart)
            .replace("{{SLOPE}}", &indented(&statements(&self.traces.slope, "t", str::to_string)?, 4))
            .replace(
                "{{ADD}}",
                &(0..D)
                    .map(|k| format!("    sums[{k}u * params.n + k] += sum.{};\n", axis(&k.to_string())))
                    .collect::<String>(),
            );
        Some(ShaderTexts {
            gaps: self.gaps.then(|| with_head(&gaps)),
            films: self.gaps.then(|| with_head(&include_str!("shaders/films.wgsl").replace("{{FORCE}}", &force))),
            search: with_head(include_str!("shaders/search.wgsl")),
            lists: with_head(include_str!("shaders/lists.wgsl")),
            sticks: if self.sticks() { Some(with_head(&self.slips()?)) } else { None },
            powers: self.powers(&properties, &force)?.iter().map(|text| with_head(text)).collect(),
            sweep: with_head(&self.sweep(&properties, &eos, &coefficients)?),
            step: with_head(&step),
            inputs: (self.traces.rows[0] > 0)
                .then(|| self.input_rows(&properties))
                .flatten()
                .map(|text| with_head(&text)),
            near: self.near.then(|| with_head(&self.near_text())),
            moments: self.moments(&properties).map(|text| with_head(&text)),
            images: (self.sides.kinds() > 2).then(|| with_head(&self.images())),
            rows: [self.traces.rows[1] + self.offset_rows(), self.traces.rows[0], self.kept_rows()],
            stress: self.traces.layout.stress,
            solids: with_head(&include_str!("shaders/solids.wgsl").replace("{{FORCE}}", &self.counted(&force))),
        })
    }

    /// `text` with the functions that shift and damp the water, and with the row of the rate of density.
    fn with_changes(&self, text: &str, properties: &FluidProperties<D>) -> Option<String> {
        let text = text.replace("{{SHIFT}}", &self.shift(properties)?).replace("{{SPONGE}}", &self.sponge);
        Some(text.replace("{{RATE}}", &D.to_string()))
    }

    /// The shader that measures powers, and the sums over pairs of the pressure alone; none unless powers are measured.
    fn powers(&self, properties: &FluidProperties<D>, force: &str) -> Option<Vec<String>> {
        if self.pressure.is_empty() {
            return Some(Vec::new());
        }
        let text = include_str!("shaders/powers.wgsl").replace("{{FORCE}}", force);
        let mut texts = vec![self.with_changes(&text, properties)?];
        for traces in self.pressure {
            let read = |name: &str| pressure_input(name, [traces, self.traces]);
            let fluid = body_read(&traces.fluid, "t", read)?;
            let [wall, beside] = self.wall_bodies(&traces.wall, read)?;
            texts.push(self.with_slips(sweep_text::<D>(traces.rows[1], [&fluid, &wall, &beside], (0, ""))));
        }
        Some(texts)
    }

    fn constants(&self, properties: &FluidProperties<D>) -> String {
        let Self { model, units, limits, domain, margin, chunks, .. } = self;
        let support = model.support_radius() / units.length;
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
            format!("const LAYERS: i32 = {};", if D == 3 { 2 } else { 0 }),
            format!("const CELL: i32 = {};", cell_width(*margin)),
            format!("const GAPS: bool = {};", self.gaps),
            format!("const WEIGHS: bool = {};", self.weighs),
            format!("const REMOVES: bool = {};", limits.escape == Escape::Remove),
            format!("const SUMS: u32 = {}u;", self.traces.rows[1]),
            format!("const REACH2: f32 = {};", float(support.powi(2))),
            format!("const LOOK2: f32 = {};", float((support * (1.0 + margin)).powi(2))),
            // Two particles that approach by half the margin each.
            format!("const MARGIN2: u32 = {}u;", ((0.5 * margin * support * 0.999).powi(2) as f32).to_bits()),
            format!("const KEPT_ROWS: u32 = {}u;", self.kept_rows()),
            format!("const ROWS: u32 = {}u;", self.traces.rows[0]),
            format!("const CORRECT_EVERY: u32 = {}u;", gradient_correction::PASSES),
            format!("const MOVING: u32 = {}u;", chunks[0] * GROUP),
            format!("const CHUNKS: u32 = {}u;", chunks[1]),
            self.gravity(properties),
            self.row_sign(),
            format!("const SMOOTHING: f32 = {};", float(properties.h)),
            format!("const SOUND: f32 = {};", float(properties.c0)),
            format!("const COURANT: f32 = {};", float(model.cfl)),
            format!("const LONGEST: f32 = {};", float(longest.min(0.9))),
            format!("const RELAXATION_TIME: f32 = {};", float(RELAXATION_TIME)),
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

    /// The function for the sign that an additional input of an image has: entries of tensors are reflected.
    fn row_sign(&self) -> String {
        let layout = self.traces.layout;
        let mut odd = String::new();
        for first in [layout.stress, layout.correction].into_iter().flatten().filter(|_| self.sides.has_planes()) {
            for (n, (i, j)) in entries(D).enumerate().filter(|(_, (i, j))| i != j) {
                let [i, j] = [i, j].map(|k| axis(&k.to_string()));
                odd += &format!(
                    "    if (row == {}u && flips(way).{i} != flips(way).{j}) {{ return -1.0f; }}\n",
                    first + n
                );
            }
        }
        format!("fn row_sign(row: u32, way: u32) -> f32 {{\n{odd}    return 1.0f;\n}}")
    }

    /// The functions for gravity, and for the slope g/c₀² of the excess density in water at rest.
    fn gravity(&self, properties: &FluidProperties<D>) -> String {
        let c2 = properties.c0.powi(2);
        let constant = |of: f64| format!("vec3<f32>({})", vector::<D>(|k| float(properties.gravity[k] / of), "0.0f"));
        let [gravity, slope] = match self.gravity_changes {
            true => ["control.gravity.xyz".into(), format!("control.gravity.xyz * {}", float(1.0 / c2))],
            false => [1.0, c2].map(constant),
        };
        format!(
            "fn gravity() -> vec3<f32> {{ return {gravity}; }}\nfn density_slope() -> vec3<f32> {{ return {slope}; }}"
        )
    }

    /// The sums over pairs: one kernel for the water, one for the boundary particles.
    fn sweep(&self, properties: &FluidProperties<D>, eos: &EquationOfState, coefficients: &[f64]) -> Option<String> {
        let [_, sums] = self.traces.rows;
        let relaxed = self.model.walls == Walls::RelaxedAdami;
        let fluid = pair_body(&self.traces.fluid, "t")?;
        let [wall, mut beside] = self.wall_bodies(&self.traces.wall, pair_input)?;
        let (mut fit_rows, mut target) = (0, String::new());
        if relaxed || self.weighs {
            let mut trace = self.traces.extrapolation.clone();
            // Walls that do not relax have no use for more than the weight.
            trace.results.retain(|(name, _)| relaxed || name == "sum0");
            let read = |other: fn(&str) -> String| {
                move |name: &str| name.strip_prefix("sum").map_or_else(|| other(name), |row| format!("fit{row}"))
            };
            let mut fit = statements(&trace, "f", read(extrapolation_input))?;
            fit_rows = trace.results.len();
            (0..fit_rows).for_each(|row| fit += &format!("fit{row} = out_sum{row};\n"));
            // The results of the extrapolation have the names of those of the pair.
            beside = format!("{{\n{beside}}}\n{{\n{fit}}}\n");
            target = if relaxed {
                let equations = statements(&wall_target(properties, eos, coefficients), "w", read(wall_input))?;
                let offset = |k: usize| format!("\nsums[{}u * params.n + k] = fit{};", sums + k, 2 + k);
                let offsets: String = (0..self.offset_rows()).map(offset).collect();
                include_str!("shaders/wall_target.wgsl").replace("{{TARGET}}", &equations) + &offsets
            } else {
                "aways[k - params.water] = vec4<f32>(0.0f, 0.0f, 0.0f, fit0);\n".into()
            };
        }
        let text = sweep_text::<D>(sums, [&fluid, &wall, &beside], (fit_rows, &target));
        Some(self.with_slips(text))
    }

    /// The components of the `force` on a boundary particle, as they count for the load: half on a plane that cuts its solid.
    fn counted(&self, force: &str) -> String {
        if !self.sides.has_planes() {
            return force.into();
        }
        force.split(", ").map(|x| format!("{x} * local_positions[b].w")).collect::<Vec<_>>().join(", ")
    }

    /// The shader for images across periodic sides and symmetry planes.
    fn images(&self) -> String {
        let mut text: String = include_str!("shaders/images.wgsl").into();
        let slips = ["slips[j - params.water]", "slips[k - params.water]"];
        let (mut copy, mut image) = (String::new(), String::new());
        if self.sticks() {
            text += "@group(0) @binding(12) var<storage, read_write> slips: array<vec4<f32>>;\n";
            copy = format!("            {} = {};\n", slips[0], slips[1]);
            image = format!("        {} = vec4<f32>(reflected({}.xyz, own.z), 0.0f);\n", slips[0], slips[1]);
        }
        text.replace("{{SLIP}}", &copy).replace("{{MIRRORED_SLIP}}", &image)
    }
}

/// The sums over pairs in `sums` rows, from the bodies of the loops over water and boundary particles beside water, and over water
/// beside boundary particles. For those there are the rows of an extrapolation, too, and statements that follow from it.
fn sweep_text<const D: usize>(
    sums: usize,
    [fluid, wall, beside]: [&str; 3],
    (fit_rows, target): (usize, &str),
) -> String {
    let zeros = |name: &str, rows: usize| (0..rows).map(|row| format!("var {name}{row} = 0.0f;\n")).collect::<String>();
    let store: String = (0..sums).map(|row| format!("sums[{row}u * params.n + k] = sum{row};\n")).collect();
    include_str!("shaders/sweep.wgsl")
        .replace("{{ZERO_SUMS}}", &indented(&zeros("sum", sums), 8))
        .replace("{{ZERO_FIT}}", &indented(&zeros("fit", fit_rows), 8))
        .replace("{{NEIGHBOUR}}", &indented(include_str!("shaders/neighbour.wgsl"), 12))
        .replace("{{FLUID}}", &indented(fluid, 12))
        .replace("{{WALL}}", &indented(wall, 12))
        .replace("{{BESIDE}}", &indented(beside, 12))
        .replace("{{STORE}}", &indented(&store, 8))
        .replace("{{TARGET}}", &indented(target, 8))
        .replace("{{FORCE}}", &vector::<D>(|k| format!("sum{k}"), "0.0f"))
}

/// The entries of a symmetric tensor that are kept, by row and column.
pub(super) fn entries(dimension: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..dimension).flat_map(|i| (0..=i).map(move |j| (i, j)))
}

/// A symmetric tensor of the inputs `name0`….
fn tensor<'a, const D: usize>(recorder: &'a Recorder, name: &str) -> [[Traced<'a>; D]; D] {
    let mut tensor = [[recorder.constant(0.0); D]; D];
    for (n, (i, j)) in entries(D).enumerate() {
        tensor[i][j] = recorder.input(&format!("{name}{n}"));
        tensor[j][i] = tensor[i][j];
    }
    tensor
}

impl<const D: usize> ShaderInput<'_, D> {
    /// Rows of additional inputs that the next pass reads although it does not make them.
    fn kept_rows(&self) -> usize {
        if self.traces.layout.stress.is_some() { self.traces.rows[0] } else { 0 }
    }

    /// Rows of sums with the ways from the water to boundary particles, if the host reads them.
    fn offset_rows(&self) -> usize {
        if self.offsets { D } else { 0 }
    }

    /// The shader by which the host reads water.
    fn near_text(&self) -> String {
        let row = |k: usize| {
            let sum = format!("sums[{}u * params.n + k]", self.traces.rows[1] + k);
            format!("    weights[{}u * arrayLength(&watched) + i] = {sum};\n", k + 1)
        };
        let binding = "@group(0) @binding(14) var<storage, read> sums: array<f32>;\n";
        include_str!("shaders/near.wgsl")
            .replace("{{SUMS}}", if self.offsets { binding } else { "" })
            .replace("{{OFFSETS}}", &(0..self.offset_rows()).map(row).collect::<String>())
    }

    /// The shader that makes the additional inputs.
    fn input_rows(&self, properties: &FluidProperties<D>) -> Option<String> {
        let layout = self.traces.layout;
        let mut fill = String::new();
        if let Some(row) = layout.mark {
            fill += "if (k >= params.water) {\n";
            fill += &format!("    rows[{row}u * params.slots + k] = f32(solids[places[k].lo.w].origin.hi.w);\n}}\n");
        }
        if let Some(row) = layout.repulsion {
            let trace = Trace::record(&mut |recorder| {
                recorder.result("repulsion", repulsion(recorder.input("p"), recorder.input("volume")));
            });
            fill += &statements(&trace, "t", str::to_string)?;
            fill += &format!("rows[{row}u * params.slots + k] = out_repulsion;\n");
        }
        let mut stress = String::new();
        if let (Some(row), Some(strain), Some(law)) = (layout.stress, layout.strain, self.model.viscosity.stress()) {
            let trace = Trace::record(&mut |recorder| {
                let tensor = law.stress(&tensor::<D>(recorder, "strain"), recorder.input("volume"), properties);
                entries(D).enumerate().for_each(|(n, (i, j))| recorder.result(&format!("stress{n}"), tensor[i][j]));
            });
            stress += &statements(&trace, "t", |name| match name.strip_prefix("strain") {
                Some(n) => format!("sums[{}u * params.n + k]", strain + n.parse::<usize>().unwrap_or(0)),
                None => name.into(),
            })?;
            for n in 0..entries(D).count() {
                stress += &format!("rows[{}u * params.slots + k] = out_stress{n};\n", row + n);
            }
        }
        let text = include_str!("shaders/rows.wgsl");
        Some(text.replace("{{FILL}}", &indented(&fill, 4)).replace("{{STRESS}}", &indented(&stress, 4)))
    }

    /// The shader that corrects the gradients, if they are corrected.
    fn moments(&self, properties: &FluidProperties<D>) -> Option<String> {
        let (row, [trace, _]) = (self.traces.layout.correction?, self.traces.moments.as_ref()?);
        let (first, count) = (D + 1, entries(D).count());
        let mut trace = trace.clone();
        trace.results.retain(|(name, _)| (first..first + count).any(|row| *name == format!("sum{row}")));
        let moment = pair_body(&trace, "t")?;
        let everywhere = self.model.gradient == PressureGradient::Corrected;
        let close = Trace::record(&mut |recorder| {
            let p = recorder.input("p");
            let weight = match self.gravity_changes {
                true => recorder.input("weight"),
                false => recorder.constant(properties.gravity.norm() * properties.dp),
            };
            let share = if everywhere { recorder.constant(1.0) } else { gradient_correction::near_surface(p, weight) };
            let correction = gradient_correction::correction(&tensor::<D>(recorder, "moment"));
            entries(D)
                .enumerate()
                .for_each(|(n, (i, j))| recorder.result(&format!("correction{n}"), share * correction[i][j]));
        });
        let mut text = statements(&close, "w", |name| match (name.strip_prefix("moment"), name) {
            (Some(n), _) => format!("sum{}", first + n.parse::<usize>().unwrap_or(0)),
            (_, "weight") => format!("(length(gravity()) * {})", float(properties.dp)),
            _ => name.into(),
        })?;
        for n in 0..count {
            text += &format!("rows[{}u * params.slots + k] = out_correction{n};\n", row + n);
        }
        let zeros: String = (first..first + count).map(|row| format!("var sum{row} = 0.0f;\n")).collect();
        let shader = include_str!("shaders/moments.wgsl");
        Some(
            shader
                .replace("{{ZERO_SUMS}}", &indented(&zeros, 4))
                .replace("{{MOMENT}}", &indented(&moment, 8))
                .replace("{{CLOSE}}", &indented(&text, 4)),
        )
    }

    /// The body of the function that shifts a particle.
    fn shift(&self, properties: &FluidProperties<D>) -> Option<String> {
        let (Some(law), Some(row)) = (self.model.shift(), self.traces.layout.shift) else {
            return Some("    return vec3<f32>(0.0f);\n".into());
        };
        let trace = Trace::record(&mut |recorder| {
            let sum = |n: usize| recorder.input(&format!("sum{n}"));
            let mut sums = AuxiliarySums::filled_with(recorder.constant(0.0));
            sums.concentration_gradient = std::array::from_fn(sum);
            sums.position_divergence = sum(D);
            let way: [Traced; D] = law.displacement(&sums, recorder.input("speed"), recorder.input("dt"), properties);
            (0..D).for_each(|k| recorder.result(&format!("way{k}"), way[k]));
        });
        let read = |name: &str| match name.strip_prefix("sum") {
            Some(n) => format!("sums[{}u * params.n + k]", row + n.parse::<usize>().unwrap_or(0)),
            None => name.into(),
        };
        let mut text = String::new();
        if let Some(suppression) = self.traces.layout.suppression {
            text += &format!("if (sums[{suppression}u * params.n + k] > 0.0f) {{ return vec3<f32>(0.0f); }}\n");
        }
        text += &statements(&trace, "t", read)?;
        text += &format!("return vec3<f32>({});\n", vector::<D>(|k| format!("out_way{k}"), "0.0f"));
        Some(indented(&text, 4))
    }
}

/// What the loop over neighbours `j` of particle `k` does with a pair.
fn pair_body(trace: &Trace, prefix: &str) -> Option<String> {
    body_read(trace, prefix, pair_input)
}

/// The same, with inputs as `read` says.
pub(super) fn body_read(trace: &Trace, prefix: &str, read: impl Fn(&str) -> String) -> Option<String> {
    let mut text = statements(trace, prefix, read)?;
    for (name, _) in &trace.results {
        text += &format!("{name} = out_{name};\n");
    }
    Some(text)
}

pub(super) fn axis(k: &str) -> &'static str {
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
        _ => match (name.strip_prefix("a_row"), name.strip_prefix("b_row"), name.strip_prefix("slope")) {
            (Some(row), ..) => format!("rows[{row}u * params.slots + k]"),
            (_, Some(row), _) => format!("rows[{row}u * params.slots + j]"),
            (.., Some(k)) => format!("slope.{}", axis(k)),
            _ => name.into(),
        },
    }
}

/// How the inputs of a pair under the pressure alone are read: its rows of additional inputs are among those of all terms.
fn pressure_input(name: &str, [own, all]: [&PairTraces; 2]) -> String {
    let Some((who, row)) = name.split_once("_row") else { return pair_input(name) };
    let (own, all, row) = (&own.layout, &all.layout, row.parse::<usize>().unwrap_or(0));
    let firsts = [(own.correction, all.correction), (own.repulsion, all.repulsion)];
    let among = firsts.into_iter().find_map(|(own, all)| Some(row.checked_sub(own?)? + all?));
    pair_input(&format!("{who}_row{}", among.unwrap_or(row)))
}

/// How the inputs of an extrapolation are read.
pub(super) fn extrapolation_input(name: &str) -> String {
    match name.split_at(1) {
        ("v", k) if k.len() == 1 => format!("other_velocity.{}", axis(k)),
        _ => pair_input(name),
    }
}
