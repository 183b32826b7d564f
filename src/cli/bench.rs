//! `pontoon bench`: which cases are timed, and the tables.

use crate::{
    Result,
    bench::{self, BenchCase, BenchTiming, DefaultViscosity},
    error::{Error, ErrorKind},
    math::format::{metric_prefix, three_digits},
    output::manifest::Machine,
};
use clap::Args;
use serde::Serialize;

use super::console_text::table;

/// Water particles up to which the reference is timed beside the fast sweep.
const MAX_REFERENCE_PARTICLES: usize = 200_000;

/// What is timed.
#[derive(Args)]
pub struct BenchArgs {
    /// Water particles of each case, separated by commas
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "50000")]
    size: Vec<usize>,
    /// Threads besides 1 [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    /// What each term of the equations, a body and dry walls add, instead of the standard cases
    #[arg(long)]
    terms: bool,
    /// Time the cases in developed flow, after the water has hit the far wall: takes minutes
    #[arg(long)]
    developed: bool,
    /// List the devices that can compute the water (feature gpu)
    #[arg(long)]
    devices: bool,
    /// Time whole steps on this device: a number of --devices, gpu, or part of a name (feature gpu)
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    /// Fail if the speed of the fast sweep over that of the reference is below this
    #[arg(long, value_name = "RATIO", hide = true)]
    floor: Option<f64>,
    /// Print JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Only make so many steps of a small work, for a tool that counts instructions
    #[arg(long, value_name = "STEPS", hide = true)]
    fixed: Option<usize>,
    /// Which of the cases of --terms that is
    #[arg(long, value_name = "NAME", hide = true, default_value = "wendland")]
    work: String,
}

/// All that was measured.
#[derive(Serialize)]
struct BenchReport {
    version: &'static str,
    machine: Machine,
    standard: Vec<BenchTiming>,
    reference: Vec<BenchTiming>,
    terms: Vec<BenchTiming>,
    /// Time of a pair by the reference over that by the fast sweep, of each case.
    fast_over_reference: Vec<f64>,
    /// Viscosity of the shipped default in the water of the cases.
    default_viscosity: Vec<DefaultViscosity>,
}

/// Times and gives the text to print.
pub fn bench(args: &BenchArgs) -> Result<String> {
    if let Some(steps) = args.fixed {
        bench::run_fixed_steps(steps, &args.work)?;
        return Ok(String::new());
    }
    if args.size.iter().any(|&n| !(100..=50_000_000).contains(&n)) {
        return Err(Error::new(ErrorKind::Usage, "sizes are from 100 to 50 million particles"));
    }
    if args.devices || args.device.is_some() {
        return on_devices(args);
    }
    let machine = Machine::current();
    let threads = args.threads.unwrap_or(machine.cpus);
    let mut tables = BenchReport {
        version: env!("CARGO_PKG_VERSION"),
        machine,
        standard: Vec::new(),
        reference: Vec::new(),
        terms: Vec::new(),
        fast_over_reference: Vec::new(),
        default_viscosity: Vec::new(),
    };
    for &water in &args.size {
        for dimension in [3, 2] {
            tables.default_viscosity.push(bench::default_viscosity(dimension, water)?);
        }
        if args.terms {
            for dimension in [3, 2] {
                tables.terms.extend(bench::time(&bench::term_cases(dimension, water), &[1], 5)?);
            }
            continue;
        }
        for dimension in [3, 2] {
            let mut work = BenchCase::standard(dimension, water);
            if args.developed {
                // 2.2 √(depth/g) after its release the water has run up the far wall.
                work = BenchCase { name: "wendland, developed".into(), spin_up: 4.0, ..work };
            }
            let cubic = [("model.kernel", "cubic")];
            let works = if args.developed {
                vec![work]
            } else {
                vec![work.clone(), work.with_overrides("cubic, tensile", &cubic)]
            };
            let counts = if threads > 1 { vec![1, threads] } else { vec![1] };
            for work in works {
                // One after the other, so that the peak of memory is that of one.
                tables.standard.extend(bench::time(std::slice::from_ref(&work), &counts, 3)?);
                // The reference takes a minute and more for a larger case, with the same result.
                if !args.developed && water <= MAX_REFERENCE_PARTICLES {
                    let sets = [&work.overrides[..], &[("model.sweep", "reference")]].concat();
                    tables.reference.extend(bench::time(&[work.with_overrides(&work.name, &sets)], &[1], 2)?);
                }
            }
        }
    }
    for reference in &tables.reference {
        let same = |t: &&BenchTiming| {
            (t.threads, t.dimension, t.water, &t.work) == (1, reference.dimension, reference.water, &reference.work)
        };
        tables.fast_over_reference.extend(tables.standard.iter().find(same).map(|t| reference.pair_ns / t.pair_ns));
    }
    if let Some(low) = tables.fast_over_reference.iter().find(|&&r| r < args.floor.unwrap_or(0.0)) {
        let help = "something in the sweep has become slower: compare `perf` of both versions";
        return Err(Error::new(
            ErrorKind::Usage,
            format!("the fast sweep is only {low:.1} times as fast as the reference"),
        )
        .help(help));
    }
    if args.json {
        let text = serde_json::to_string_pretty(&tables);
        return text.map(|t| t + "\n").map_err(|e| Error::new(ErrorKind::Usage, format!("no JSON: {e}")));
    }
    Ok(text(&tables))
}

/// Lists the devices, or times steps on one.
#[cfg(feature = "gpu")]
fn on_devices(args: &BenchArgs) -> Result<String> {
    let Some(name) = &args.device else {
        let mut rows = vec![
            ["", "device", "interface", "kind", "memory, GB", "largest buffer, GB", "binding, GB", "driver"]
                .map(String::from)
                .to_vec(),
        ];
        let gb = |bytes: u64| format!("{:.2}", bytes as f64 / 1e9);
        rows.extend(bench::adapters().into_iter().map(|of| {
            let memory = of.memory_bytes.map_or("–".into(), gb);
            let (buffer, binding) = (gb(of.buffer_bytes), gb(of.binding_bytes));
            vec![of.number.to_string(), of.name, of.backend, of.kind, memory, buffer, binding, of.driver]
        }));
        if rows.len() == 1 {
            return Ok("no device was found: docs/how-to/use-a-graphics-card.md says what to install\n".into());
        }
        return Ok(table(&rows));
    };
    let mut timings = Vec::new();
    for &water in &args.size {
        for dimension in [3, 2] {
            timings.push(bench::time_on_device(&BenchCase::with_defaults(dimension, water), name)?);
            timings.push(bench::time_on_device(&BenchCase::standard(dimension, water), name)?);
        }
    }
    if args.json {
        let text = serde_json::to_string_pretty(&timings);
        return text.map(|t| t + "\n").map_err(|e| Error::new(ErrorKind::Usage, format!("no JSON: {e}")));
    }
    let head = [
        "model",
        "",
        "water",
        "boundary",
        "ms a step",
        "M particle-steps/s",
        "M particle-passes/s",
        "B a particle",
        "with lists",
        "set-up, s",
    ];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(timings.iter().map(|t| {
        vec![
            t.work.clone(),
            format!("{}-D", t.dimension),
            t.water.to_string(),
            t.boundary.to_string(),
            three_digits(t.step_s * 1e3),
            three_digits(t.particle_steps_per_s / 1e6),
            three_digits(t.particle_passes_per_s / 1e6),
            format!("{:.0}", t.bytes[0]),
            format!("{:.0}", t.bytes[1]),
            format!("{:.1} + {:.1}", t.setup_s[0], t.setup_s[1]),
        ]
    }));
    let device = timings.first().map_or("", |t| &t.device);
    Ok(format!("pontoon {}, {device}\n\n{}", env!("CARGO_PKG_VERSION"), table(&rows)))
}

/// Refuses: this program has no devices.
#[cfg(not(feature = "gpu"))]
fn on_devices(_: &BenchArgs) -> Result<String> {
    Err(Error::new(ErrorKind::Usage, "this program was built without devices")
        .help("build it with the feature gpu:  cargo build --release --features gpu"))
}

fn text(tables: &BenchReport) -> String {
    let Machine { processor, cpus, instructions, .. } = &tables.machine;
    let instructions = instructions.as_deref().unwrap_or("no vector instructions: the reference computes everything");
    let mut text = format!("pontoon {}, {processor}, {cpus} processors, {instructions}\n", tables.version);
    if !tables.standard.is_empty() {
        text += "\nA dam break, Verlet, artificial viscosity, diffusion, h = √3 dp:\n";
        text += &table(&rows(&tables.standard));
    }
    if !tables.reference.is_empty() {
        text +=
            "\nThe same by the reference, in double precision, and its time per pair over that of the fast sweep:\n";
        let mut rows = rows(&tables.reference);
        rows[0].push("ratio".into());
        for (row, ratio) in rows[1..].iter_mut().zip(&tables.fast_over_reference) {
            row.push(format!("{ratio:.1}"));
        }
        text += &table(&rows);
    }
    if !tables.terms.is_empty() {
        text += "\nProcessor time per particle and step with each addition, over that of the standard case:\n";
        text += &table(&term_rows(&tables.terms));
    }
    text += "\nEffective kinematic viscosity of the shipped default in this water, at a shear of 1/s:\n";
    text += &table(&viscosity_rows(&tables.default_viscosity));
    text
}

fn viscosity_rows(viscosities: &[DefaultViscosity]) -> Vec<Vec<String>> {
    let heads = ["", "dp (m)", "depth (m)", "c₀ (m/s)", "h (m)", "viscosity (m²/s)"];
    let mut rows = vec![heads.map(String::from).to_vec()];
    for own in viscosities {
        let figures = [own.dp_m, own.depth_m, own.c0_mps, own.h_m, own.viscosity_m2ps].map(three_digits);
        rows.push([format!("{}-D", own.dimension)].into_iter().chain(figures).collect());
    }
    rows
}

fn rows(timings: &[BenchTiming]) -> Vec<Vec<String>> {
    let head = [
        "work",
        "",
        "threads",
        "water",
        "wet",
        "M/s",
        "ms/step",
        "cpu ns",
        "pairs",
        "ns/pair",
        "lists %",
        "pairs %",
        "bodies %",
        "set-up s",
        "B/particle",
    ];
    let mut rows = vec![head.map(String::from).to_vec()];
    for t in timings {
        rows.push(vec![
            t.work.clone(),
            format!("{}-D", t.dimension),
            t.threads.to_string(),
            metric_prefix(t.water as f64),
            metric_prefix(t.wet as f64),
            format!("{:.2}", t.particle_steps_per_s * 1e-6),
            format!("{:.2}", t.step_s * 1e3),
            format!("{:.0}", t.cpu_ns),
            format!("{:.0}", t.pairs),
            format!("{:.2}", t.pair_ns),
            format!("{:.0}", t.lists_percent),
            format!("{:.0}", t.pairs_percent),
            format!("{:.1}", t.bodies_percent),
            format!("{:.2}", t.setup_s),
            format!("{:.0}", t.peak_bytes),
        ]);
    }
    rows
}

fn term_rows(timings: &[BenchTiming]) -> Vec<Vec<String>> {
    let mut rows = vec![["work", "", "cpu ns", "÷ standard", "pairs ÷ standard", "ms/step"].map(String::from).to_vec()];
    for t in timings {
        let Some(base) = timings.iter().find(|b| b.dimension == t.dimension) else { continue };
        rows.push(vec![
            t.work.clone(),
            format!("{}-D", t.dimension),
            format!("{:.0}", t.cpu_ns),
            format!("{:.3}", t.cpu_ns / base.cpu_ns),
            format!("{:.3}", t.pair_ns / base.pair_ns),
            format!("{:.2}", t.step_s * 1e3),
        ]);
    }
    rows
}
