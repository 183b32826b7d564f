//! `pontoon inspect`: what a scene would run and what looks wrong with it, on a page or as JSON.

use std::fmt::Write;

use crate::{
    error::{Error, ErrorKind, Result},
    math::format::{bytes, duration, metric_prefix, three_digits, without_control},
    preflight::{
        AbsorberSummary, BodyFlow, BodySummary, DiskUse, FaceWave, Finding, GeneratedWave, Preflight, Severity,
    },
    run::{self, CostEstimate, InspectOptions, InspectReport, Inspection, LARGE},
};
use clap::Args;

use super::{
    SceneArgs,
    console_text::{table, threads},
    scene_lookup,
};

/// What is inspected, and how it is said.
#[derive(Args)]
pub struct InspectArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Threads of the timing [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = super::thread_count)]
    threads: Option<usize>,
    /// Leave out the second of stepping that tells how long a run takes on this machine
    #[arg(long)]
    no_timing: bool,
    /// Print everything as JSON
    #[arg(long)]
    json: bool,
}

/// The page, or the JSON.
pub fn inspect(args: &InspectArgs) -> Result<String> {
    let found = scene_lookup::find_scene(&args.scene.scene)?;
    let overrides = args.scene.given_keys().overrides()?;
    let asked = InspectOptions { overrides, threads: args.threads, timing: !args.no_timing };
    let report = found.with_scene_name(run::inspect(found.path(), &asked))?;
    if args.json {
        let text =
            serde_json::to_string_pretty(&report).map_err(|why| Error::new(ErrorKind::Usage, why.to_string()))?;
        return Ok(text + "\n");
    }
    Ok(match &report {
        Inspection::Report(report) => report_text(report),
        Inspection::Estimate(size) => estimate_text(size),
    })
}

/// What `inspect` prints about a scene whose particles it does not create.
fn estimate_text(size: &CostEstimate) -> String {
    let row = |name: &str, text: String| vec![name.to_string(), text];
    let rows = [
        row("dimension", format!("{}-D", size.dimension)),
        row("water", format!("about {} particles", metric_prefix(size.fluid))),
        row("boundary", format!("about {} particles", metric_prefix(size.boundary))),
        row("memory", format!("about {}", bytes(size.memory_bytes))),
        row("time step", format!("at most {:.3e} s, by sound", size.dt_s)),
        row("steps", format!("{} or more to {} s", metric_prefix(size.steps), size.until_s)),
        row("run time", format!("about {} on one thread", duration(size.thread_seconds))),
    ];
    let note = format!(
        "note: an estimate from areas and volumes: the scene has more than {} million particles, and inspect creates none\n  \
         a run reports its warnings at the start; a larger dp shows them here\n",
        LARGE / 1e6
    );
    format!("{}\n{note}{}", without_control(&size.title), table(&rows))
}

/// What `inspect` prints.
fn report_text(report: &InspectReport) -> String {
    let mut text = format!("{}\n", without_control(&report.title));
    text += &findings(&report.preflight.brief());
    text += &table(&facts(report));
    if !report.preflight.bodies.is_empty() {
        let _ = write!(text, "\n{}", bodies(&report.preflight.bodies, report.preflight.size.dimension));
    }
    text += &moorings(&report.preflight);
    text += &flows(&report.preflight.flows);
    if !report.solids.is_empty() {
        let mut rows = vec![["solid", "role", "particles"].map(String::from).to_vec()];
        rows.extend(report.solids.iter().map(|s| vec![s.name.clone(), s.role.into(), s.particles.to_string()]));
        let _ = write!(text, "\n{}", table(&rows));
    }
    text += &meshes(report);
    if !report.series.is_empty() {
        let mut rows = vec![["series", "columns"].map(String::from).to_vec()];
        rows.extend(report.series.iter().flat_map(|s| {
            let named = |(i, line): (usize, String)| vec![if i == 0 { s.name.clone() } else { String::new() }, line];
            lines(&s.columns).into_iter().enumerate().map(named).collect::<Vec<_>>()
        }));
        let _ = write!(text, "\n{}", table(&rows));
    }
    let mut rows = vec![["key", "value", "source"].map(String::from).to_vec()];
    rows.extend(report.values.iter().map(|v| vec![v.key.clone(), v.value.clone(), v.source.clone()]));
    let _ = write!(text, "\n{}", table(&rows));
    text
}

/// Columns of a line of names.
const WIDE: usize = 140;

/// Names in lines that can be read: a balance in 3-D has fifty.
fn lines(names: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for name in names {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + name.len() <= WIDE => {
                line.push(' ');
                line.push_str(name);
            }
            _ => lines.push(name.clone()),
        }
    }
    lines
}

/// Each finding with what mends it.
fn findings(findings: &[Finding]) -> String {
    let mut text = String::new();
    for finding in findings {
        let word = if finding.severity == Severity::Warning { "warning" } else { "note" };
        let _ = writeln!(text, "{word}: {}\n  {}", finding.what, finding.mend.replace('\n', "\n  "));
    }
    text
}

/// What the run will cost, line by line.
fn facts(report: &InspectReport) -> Vec<Vec<String>> {
    let (size, sound, step) = (&report.preflight.size, &report.preflight.sound, &report.preflight.step);
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut row = |name: &str, text: String| rows.push(vec![name.into(), text]);
    row("dimension", format!("{}-D", size.dimension));
    row(
        "water",
        format!("{} particles, {} m deep, {} dp", size.fluid, three_digits(size.depth_m), three_digits(size.depth_dp)),
    );
    row(
        "boundary",
        format!("{} particles in {} layers, {} of them beside water", size.boundary, size.layers, size.wet),
    );
    row("memory", format!("about {}", bytes(size.memory_bytes)));
    let over = sound.over_depth.map_or(String::new(), |x| format!(" = {} √(g·depth)", three_digits(x)));
    let from =
        report.sound_from.as_ref().map_or(String::new(), |v| format!(" ({}, {})", v.key, short_source(&v.source)));
    row("sound", format!("{} m/s{over}{from}", three_digits(sound.c0_mps)));
    if let Some(first) = sound.expected.first() {
        let times = three_digits(sound.c0_mps / first.speed_mps);
        row(
            "fastest",
            format!("{} m/s, {}: sound is {times} times as fast", three_digits(first.speed_mps), first.what),
        );
    }
    row("time step", format!("at most {:.3e} s, by {}", step.dt_s, step.bound_by));
    let passes = if step.passes == 1 { "one force pass" } else { "two force passes" };
    row("steps", format!("{} or more to {} s, {passes} each", metric_prefix(step.steps), report.until_s));
    if let Some(timing) = &report.timing {
        row(
            "run time",
            format!(
                "about {} with {}, outputs on top: {} steps took {:.2e} s each",
                duration(timing.run_s),
                threads(timing.threads),
                timing.steps,
                timing.step_s
            ),
        );
    }
    row("disk", disk(&size.disk));
    for wave in &report.preflight.waves {
        wave_facts(wave).into_iter().for_each(|(name, text)| row(name, text));
    }
    for wave in &report.preflight.face_waves {
        face_wave_facts(wave).into_iter().for_each(|(name, text)| row(name, text));
    }
    for absorber in &report.preflight.absorbers {
        absorber_facts(absorber).into_iter().for_each(|(name, text)| row(name, text));
    }
    rows
}

/// A wave and the paddle that makes it.
fn wave_facts(wave: &GeneratedWave) -> Vec<(&'static str, String)> {
    let about = if wave.kind.is_some() { "" } else { "about " };
    let kind = wave.kind.map_or("by the motion".into(), |kind| format!("{kind}, order {}", wave.order));
    let period = wave.period_s.map_or(String::new(), |t| format!(", period {} s", three_digits(t)));
    let kd = wave.kd.map_or(String::new(), |kd| format!(", kd {}", three_digits(kd)));
    let high = format!("{about}{} m high, {} dp{period}", three_digits(wave.height_m), three_digits(wave.height_dp));
    let long = format!("{} m long, {} dp", three_digits(wave.length_m), three_digits(wave.length_dp));
    let water =
        format!("{} water{kd}, {} m deep; {}", wave.regime.name(), three_digits(wave.depth_m), wave.region.name());
    let speeds = format!("crests {} m/s, energy {} m/s", three_digits(wave.celerity_mps), three_digits(wave.group_mps));
    let (stroke, speed) = (three_digits(wave.stroke_m), three_digits(wave.paddle_mps));
    let ramp = if wave.ramp_s > 0.0 { format!(", ramp {} s", three_digits(wave.ramp_s)) } else { String::new() };
    let mut facts = vec![
        ("waves", format!("{high}, {long}")),
        ("", format!("{water}; {speeds}")),
        ("", format!("\"{}\", {kind}: stroke {stroke} m, up to {speed} m/s{ramp}", wave.solid)),
        ("", wave.first_reflection()),
    ];
    if !wave.gauges.is_empty() {
        let heights = wave.gauges.iter().map(|at| format!("{} at \"{}\"", three_digits(at.height_share), at.probe));
        let heights: Vec<String> = heights.collect();
        facts.push(("", format!("share of the specified height expected: {}", heights.join(", "))));
    }
    facts
}

/// A wave that enters through a face, and the current that it meets.
fn face_wave_facts(wave: &FaceWave) -> [(&'static str, String); 3] {
    let [height, high, period, length, long, depth, kd] =
        [wave.height_m, wave.height_dp, wave.period_s, wave.length_m, wave.length_dp, wave.depth_m, wave.kd]
            .map(three_digits);
    let [crests, energy, orbital, ramp] =
        [wave.celerity_mps, wave.group_mps, wave.orbital_mps, wave.ramp_s].map(three_digits);
    let current = three_digits(wave.current_mps.abs());
    let sense = if wave.current_mps < 0.0 { "against them" } else { "with them" };
    let kind = if wave.components == 1 { "" } else { "sea, significant and at the peak: " };
    [
        ("waves", format!("{kind}{height} m high, {high} dp, period {period} s, {length} m long, {long} dp")),
        ("", format!("kd {kd}, {depth} m deep; crests {crests} m/s, energy {energy} m/s")),
        (
            "",
            format!(
                "through \"{}\", ramp {ramp} s: water at up to {orbital} m/s, on {current} m/s of current {sense}",
                wave.face
            ),
        ),
    ]
}

/// A paddle that absorbs.
fn absorber_facts(own: &AbsorberSummary) -> [(&'static str, String); 2] {
    let [(shorter, less), (longer, more)] =
        own.sends_back.map(|(period, share)| (three_digits(period), three_digits(100.0 * share)));
    let (period, gauge) = (three_digits(own.period_s), three_digits(own.gauge_m));
    let (stroke, speed) = (three_digits(own.stroke_m), three_digits(own.speed_mps));
    [
        ("absorbs", format!("\"{}\", waves of {period} s, by a gauge {gauge} m before its face", own.solid)),
        (
            "",
            format!(
                "stroke to {stroke} m, speed to {speed} m/s; sends back {less} % at {shorter} s, {more} % at {longer} s"
            ),
        ),
    ]
}

/// The meshes among the solids, as their files have them.
fn meshes(report: &InspectReport) -> String {
    let list = |x: &[f64]| x.iter().map(|x| three_digits(*x)).collect::<Vec<_>>().join(", ");
    let mut rows =
        vec![["mesh", "facets", "volume (m³)", "surface (m²)", "size (m)", "centroid (m)"].map(String::from).to_vec()];
    rows.extend(report.solids.iter().filter_map(|s| {
        let mesh = s.mesh.as_ref()?;
        let (volume, surface) = (three_digits(mesh.volume_m3), three_digits(mesh.surface_m2));
        // A centroid in the middle is there to round-off.
        let centroid: Vec<f64> = mesh.centroid_m.iter().map(|x| 1e-9 * (x * 1e9).round() + 0.0).collect();
        Some(vec![s.name.clone(), mesh.facets.to_string(), volume, surface, list(&mesh.size_m), list(&centroid)])
    }));
    if rows.len() > 1 { format!("\n{}", table(&rows)) } else { String::new() }
}

/// The mooring lines at rest, and the surge of the bodies that they hold.
fn moorings(preflight: &Preflight) -> String {
    if preflight.moorings.is_empty() {
        return String::new();
    }
    let [force, stiffness_unit] = if preflight.size.dimension == 2 { ["N/m", "N/m²"] } else { ["N", "N/m"] };
    let heads =
        ["mooring", "length (m)", "fairlead", "anchor", "on bed (m)", "touchdown (m)", "anchor angle", "step (s)"];
    let mut rows = vec![heads.map(String::from).to_vec()];
    rows.extend(preflight.moorings.iter().map(|line| {
        let place = |x: &Vec<f64>| x.iter().map(|x| three_digits(*x)).collect::<Vec<_>>().join(", ");
        vec![
            line.name.clone(),
            three_digits(line.length_m),
            format!("{} {force}", three_digits(line.fairlead_n)),
            format!("{} {force}", three_digits(line.anchor_n)),
            three_digits(line.on_bed_m),
            line.touchdown_m.as_ref().map_or_else(|| "–".into(), place),
            format!("{}°", three_digits(line.anchor_angle_deg)),
            format!("{:.2e}", line.step_s),
        ]
    }));
    let mut text = format!("\n{}", table(&rows));
    for surge in &preflight.moored_surge {
        let period =
            surge.period_s.map_or_else(|| "none".into(), |t| format!("{} s without added mass", three_digits(t)));
        let stiffness = three_digits(surge.stiffness_npm);
        let _ = writeln!(text, "  surge of \"{}\": {stiffness} {stiffness_unit}, natural period {period}", surge.name);
    }
    text
}

/// Who said a value, without the reason of a default.
fn short_source(source: &str) -> &str {
    source.split(':').next().unwrap_or(source)
}

fn disk(disk: &DiskUse) -> String {
    let frames = match disk.frames {
        0 => "no frames".to_string(),
        n => format!("{n} frames {}", bytes(disk.frames_bytes)),
    };
    format!("{frames}, tables {}, a checkpoint {}", bytes(disk.tables_bytes), bytes(disk.checkpoint_bytes))
}

/// How the free bodies float, and whether particles carry them.
fn bodies(bodies: &[BodySummary], dimension: usize) -> String {
    let mass = if dimension == 2 { "mass (kg/m)" } else { "mass (kg)" };
    let heads = ["body", mass, "displaced", "ratio", "draft (m)", "at rest", "GM (m)", "heave (s)", "roll (s)"];
    let mut rows = vec![heads.map(String::from).to_vec()];
    let mut grain = vec![["body", "thinnest (dp)", "least ratio", "first swing"].map(String::from).to_vec()];
    for body in bodies {
        let mut row = vec![
            body.name.clone(),
            three_digits(body.mass_kg),
            three_digits(body.displaced_kg),
            three_digits(body.density_ratio),
        ];
        row.push(three_digits(body.draft_m));
        match &body.afloat {
            Some(afloat) => {
                let gm: Vec<String> = afloat.tilts.iter().map(|t| three_digits(t.gm_m)).collect();
                let roll: Vec<String> =
                    afloat.tilts.iter().map(|t| t.period_s.map_or("–".into(), three_digits)).collect();
                row.extend([
                    three_digits(afloat.draft_m),
                    gm.join(" "),
                    format!("{}–{}", three_digits(afloat.heave_s), three_digits(afloat.heave_with_added_s)),
                    roll.join(" "),
                ]);
            }
            None => row.extend(match body.support {
                "bottom" => Some("sinks".into()),
                "solid" => Some("stands".into()),
                "lines" => Some("hangs".into()),
                "held" | "floods" | "neutral" => Some(body.support.into()),
                _ => None,
            }),
        }
        rows.push(row);
        let swing = body.afloat.as_ref().map(|afloat| format!("−{:.0} %", 100.0 * afloat.first_swing_error));
        grain.push(vec![
            body.name.clone(),
            three_digits(body.thinnest_dp),
            three_digits(body.least_ratio),
            swing.unwrap_or_else(|| "–".into()),
        ]);
    }
    let mut ties = String::new();
    for (i, body) in bodies.iter().enumerate() {
        if let Some(largest) = body.largest_mass_kg {
            let [start, largest] = [body.mass_kg, largest].map(three_digits);
            let _ = writeln!(ties, "  {}: {start} kg at the start, {largest} kg at most with its ballast", body.name);
        }
        if let Some(water) = body.afloat.as_ref().and_then(|afloat| afloat.enclosed_water_kg) {
            let _ = writeln!(
                ties,
                "  {}: {} kg of water inside heave with it; GM is that of both, with the inner free surface; roll is without it",
                body.name,
                three_digits(water)
            );
        }
        // Each assembly once, with its first body.
        if !body.tied_to.is_empty() && !bodies[..i].iter().any(|other| body.tied_to.contains(&other.name)) {
            let _ = writeln!(
                ties,
                "  {} and {} are joined: GM, heave and roll are those of all, as if their joints were rigid",
                body.name,
                body.tied_to.join(", ")
            );
        }
        let free = body.afloat.as_ref().and_then(|afloat| afloat.free_joints.as_ref());
        if let Some(free) = free.filter(|free| free.is_stable) {
            let list = |values: Vec<String>| values.join(", ");
            let names = list(free.turns_deg.iter().map(|(name, _)| name.clone()).collect());
            if !free.periods_s.is_empty() {
                let periods = list(free.periods_s.iter().map(|period| three_digits(*period)).collect());
                let _ = writeln!(ties, "  {names}: with free ties, natural periods of {periods} s, without added mass");
            }
            if !free.tensions_n.is_empty() {
                let pulls = free.tensions_n.iter().map(|(name, n)| format!("{name} {} N", three_digits(*n)));
                let _ = writeln!(ties, "  {names}: tensions at rest {}", list(pulls.collect()));
            }
        }
        if body.load_kg.abs() > 1e-6 * body.mass_kg {
            let (way, load) = (if body.load_kg > 0.0 { "down" } else { "up" }, three_digits(body.load_kg.abs()));
            let _ = writeln!(ties, "  {}: lines and forces pull it {way} with the weight of {load} kg", body.name);
        }
    }
    let said = "  heave: without and with an estimate of the water that heaves along; roll: without any\n";
    let error = "  first swing: what a free decay in heave loses of it at this dp, as measured on a disc\n";
    format!("{}{said}{ties}\n{}{error}", table(&rows), table(&grain))
}

/// The flow about the moving bodies.
fn flows(flows: &[BodyFlow]) -> String {
    if flows.is_empty() {
        return String::new();
    }
    let mut rows =
        vec![["moves", "speed (m/s)", "of", "size (m)", "viscosity (m²/s)", "Reynolds"].map(String::from).to_vec()];
    rows.extend(flows.iter().map(|flow| {
        vec![
            flow.name.clone(),
            three_digits(flow.speed_mps),
            flow.speed_from.into(),
            three_digits(flow.size_m),
            three_digits(flow.viscosity_m2ps),
            flow.reynolds.map_or("–".into(), three_digits),
        ]
    }));
    format!("\n{}", table(&rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_in_lines_and_none_is_lost() {
        let names: Vec<String> = (0..54).map(|i| format!("pressure_fx_{i}_N")).collect();
        let lines = lines(&names);
        assert!(lines.len() > 1 && lines.iter().all(|line| line.len() <= WIDE), "{lines:?}");
        assert_eq!(lines.join(" "), names.join(" "));
    }
}
