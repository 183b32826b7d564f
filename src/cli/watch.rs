//! `pontoon watch`: how far a run is, the last readings of its series and their curves, in the terminal.

use std::{
    io::{IsTerminal, Write, stdout},
    path::{Path, PathBuf},
    time::Duration,
};

use crate::{
    error::{Error, ErrorCode, ErrorKind, Result, nearest_name},
    math::format::{duration, three_digits, unit, without_control},
    output::{Manifest, SeriesTable, manifest::RunStatus},
    run::{self, EnergyDrift},
};
use clap::Args;
use crossterm::{
    cursor::{Hide, MoveTo, Show},
    event::{Event, KeyCode, KeyEvent, KeyModifiers, poll, read},
    execute,
    terminal::{Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode, size},
};
use textplots::{Chart, LabelBuilder, LabelFormat, Plot, Shape};

use super::{
    console_text::{table, warnings},
    print_output,
};

/// Which run, and which of its series.
#[derive(Args)]
pub struct WatchArgs {
    /// Folder of the run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Series to plot, as in buoy.heave_m; may be given several times [default: the first one or two]
    #[arg(long, value_name = "NAME.COLUMN")]
    series: Vec<String>,
    /// Print once and end
    #[arg(long)]
    once: bool,
    /// From one look to the next, s
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0)]
    every: f64,
}

/// Columns that are plotted where nobody says which, the most telling first.
const PREFERRED_COLUMNS: [&str; 8] = ["heave_m", "eta", "fx_N", "p_", "front_m", "total_J", "angle_deg", "tension_N"];

/// Lines that a plot, or the table, has at least.
const LEAST_LINES: usize = 6;

/// Watches until the run ends or somebody leaves with q or Ctrl-C; prints once where nobody sits.
pub fn watch(args: &WatchArgs) -> Result<u8> {
    if !(args.every > 0.0 && args.every.is_finite()) {
        return Err(Error::new(ErrorKind::Usage, format!("--every {} is no time", args.every)).help("give seconds"));
    }
    let seen = RunSnapshot::read(&args.folder)?;
    seen.check(&args.series)?;
    if args.once || !stdout().is_terminal() {
        return print_output(&seen.screen_text(&args.series, (80, 24))).map(|()| 0);
    }
    let screen = AlternateScreen::open()?;
    let left = watch_live(args);
    drop(screen);
    left?;
    // What was seen last stays to be read.
    print_output(&RunSnapshot::read(&args.folder)?.screen_text(&args.series, size().unwrap_or((80, 24)))).map(|()| 0)
}

fn watch_live(args: &WatchArgs) -> Result<()> {
    loop {
        let seen = RunSnapshot::read(&args.folder)?;
        let text = seen.screen_text(&args.series, size().unwrap_or((80, 24))) + "q leaves\n";
        let _ = execute!(stdout(), MoveTo(0, 0), Clear(ClearType::All));
        // A raw terminal does not go back to the first column by itself.
        let _ = stdout().write_all(text.replace('\n', "\r\n").as_bytes());
        let _ = stdout().flush();
        if seen.manifest.status != RunStatus::Running || quit_requested(Duration::from_secs_f64(args.every)) {
            return Ok(());
        }
    }
}

/// Waits so long; whether somebody leaves meanwhile.
fn quit_requested(wait: Duration) -> bool {
    if !poll(wait).unwrap_or(true) {
        return false;
    }
    let ctrl_c = |key: &KeyEvent| key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL);
    match read() {
        Ok(Event::Key(key)) => ctrl_c(&key) || matches!(key.code, KeyCode::Char('q') | KeyCode::Esc),
        Ok(_) => false,
        Err(_) => true,
    }
}

/// The process that the lock in `folder` names, and whether it lives, where the system keeps /proc.
fn lock_process(folder: &Path) -> Option<(u32, Option<bool>)> {
    let id = run::lock_owner(folder)?;
    let all = Path::new("/proc");
    Some((id, all.join("self").exists().then(|| all.join(id.to_string()).exists())))
}

/// The terminal in its other screen; as it was when this is dropped.
struct AlternateScreen;

impl AlternateScreen {
    fn open() -> Result<Self> {
        enable_raw_mode()
            .map_err(|why| Error::new(ErrorKind::Usage, format!("the terminal cannot be watched: {why}")))?;
        let _ = execute!(stdout(), EnterAlternateScreen, Hide);
        Ok(Self)
    }
}

impl Drop for AlternateScreen {
    fn drop(&mut self) {
        let _ = execute!(stdout(), Show, LeaveAlternateScreen);
        let _ = disable_raw_mode();
    }
}

/// A run as it stands.
struct RunSnapshot {
    manifest: Manifest,
    /// The process that writes here, if one is named, and whether it lives, if the system tells.
    process: Option<(u32, Option<bool>)>,
    tables: Vec<(String, SeriesTable)>,
}

impl RunSnapshot {
    fn read(folder: &Path) -> Result<Self> {
        let manifest = Manifest::read(folder)?;
        let files = manifest.files.iter().filter_map(|file| file.strip_prefix("series/")?.strip_suffix(".csv"));
        let read = |name: &str| {
            let path = folder.join("series").join(format!("{name}.csv"));
            Some((name.to_string(), SeriesTable::read(&path).ok()?))
        };
        Ok(Self { tables: files.filter_map(read).collect(), process: lock_process(folder), manifest })
    }

    /// All series.
    fn names(&self) -> impl Iterator<Item = String> {
        self.tables.iter().flat_map(|(name, of)| of.columns.iter().map(move |column| format!("{name}.{column}")))
    }

    /// Refuses series that are none.
    fn check(&self, series: &[String]) -> Result<()> {
        let names: Vec<String> = self.names().collect();
        match series.iter().find(|series| !names.contains(series)) {
            Some(series) => {
                let help = match nearest_name(series, names.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean {near:?}?"),
                    None => format!("the series are: {}", names.join(", ")),
                };
                Err(Error::new(ErrorKind::Usage, format!("the run has no series {series:?}"))
                    .with_code(ErrorCode::UnknownName)
                    .help(help))
            }
            None => Ok(()),
        }
    }

    /// The times and numbers of a series.
    fn curve(&self, series: &str) -> Option<(&[f64], &[f64])> {
        let (name, column) = series.split_once('.')?;
        let (_, of) = self.tables.iter().find(|(known, _)| known == name)?;
        Some((&of.times, &of.values[of.columns.iter().position(|known| known == column)?]))
    }

    /// What a terminal of so many columns and lines shows.
    fn screen_text(&self, series: &[String], (wide, high): (u16, u16)) -> String {
        let mut text = format!("{}\n{}\n", without_control(&self.manifest.title), self.status());
        let telling = PREFERRED_COLUMNS.iter().filter_map(|word| self.names().find(|name| name.contains(word)));
        let mut plots: Vec<String> = match series.is_empty() {
            true => telling.chain(self.names().next()).take(2).collect(),
            false => series.to_vec(),
        };
        plots.dedup();
        let room = usize::from(high.max(24)) - 5;
        let lines = (room / 2).checked_div(plots.len()).unwrap_or(0).max(LEAST_LINES);
        let rows = room.saturating_sub(plots.len() * lines).max(LEAST_LINES);
        for damage in self.tables.iter().filter_map(|(name, table)| table.damage(name)) {
            text += &format!("warning: {damage}\n");
        }
        text += &self.latest_readings(rows);
        for name in &plots {
            text += &self.plot(name, wide, lines);
        }
        text
    }

    fn status(&self) -> String {
        let m = &self.manifest;
        let how = match (m.status, self.process) {
            (RunStatus::Running, Some((id, Some(true)))) => format!("running (process {id})"),
            (RunStatus::Running, Some((id, Some(false)))) => format!("killed (process {id} is gone)"),
            (RunStatus::Running, _) => "running, or killed".into(),
            (RunStatus::Finished, _) => "finished".into(),
            (RunStatus::Interrupted, _) => "interrupted".into(),
            (RunStatus::Failed, _) => "failed".into(),
        };
        let t = self.tables.iter().filter_map(|(_, of)| of.times.last()).copied().fold(m.simulated_s, f64::max);
        let words = self.energy_drift().map(|drift| drift.to_string()).into_iter().chain(warnings(m.warnings.len()));
        let more: String = words.map(|word| format!(", {word}")).collect();
        let text = format!(
            "{how}: t = {t:.3} of {} s, {} of wall time at the last frame{more}",
            m.until_s,
            duration(m.wall_s)
        );
        let cost = m.wall_s / m.simulated_s;
        if m.status == RunStatus::Finished || !(cost > 0.0 && cost.is_finite()) {
            return text;
        }
        format!(
            "{text}\na simulated second takes {}, {} left",
            duration(cost),
            duration(cost * (m.until_s - t).max(0.0))
        )
    }

    /// What became of the energy, if a table tells it.
    fn energy_drift(&self) -> Option<EnergyDrift> {
        let table = |first: &str| self.tables.iter().find(|(_, of)| of.columns.iter().any(|c| c.starts_with(first)));
        let row =
            |of: &SeriesTable, i: usize| of.values.iter().map(|x| x.get(i).copied()).collect::<Option<Vec<f64>>>();
        if let Some((_, of)) = table("residual_J") {
            return EnergyDrift::from_budget(&row(of, of.times.len().checked_sub(1)?)?);
        }
        let (_, of) = table("total_J")?;
        let unit = unit(of.columns.last()?);
        EnergyDrift::from_energy(&row(of, 0)?, &row(of, of.times.len().checked_sub(1)?)?, unit)
    }

    /// The last reading of each series, its least and its largest.
    fn latest_readings(&self, most: usize) -> String {
        let mut rows = vec![["series", "t (s)", "now", "least", "largest"].map(String::from).to_vec()];
        for name in self.names() {
            let Some((t, x)) = self.curve(&name) else { continue };
            let known = || x.iter().copied().filter(|x| x.is_finite());
            let Some((t, x)) = t.iter().zip(x).rev().find(|(_, x)| x.is_finite()) else { continue };
            let ends = [known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max)];
            rows.push(vec![name, format!("{t:.3}"), three_digits(*x), three_digits(ends[0]), three_digits(ends[1])]);
        }
        let left_out = rows.len().saturating_sub(most);
        rows.truncate(most);
        let more = if left_out > 0 { format!("  and {left_out} more series\n") } else { String::new() };
        table(&rows) + &more
    }

    fn plot(&self, name: &str, wide: u16, lines: usize) -> String {
        let Some((t, x)) = self.curve(name) else { return String::new() };
        let points: Vec<(f32, f32)> =
            t.iter().zip(x).filter(|(_, x)| x.is_finite()).map(|(t, x)| (*t as f32, *x as f32)).collect();
        let (Some(first), Some(last)) = (points.first(), points.last().filter(|_| points.len() > 1)) else {
            return format!("{name}: nothing was measured yet\n");
        };
        // A sign is two dots wide and four high.
        let (wide, high) = (2 * u32::from(wide.clamp(60, 200) - 12), 4 * (lines - 3) as u32);
        let mut chart = Chart::new(wide, high, first.0, last.0);
        let shape = Shape::Lines(&points);
        let digits = || LabelFormat::Custom(Box::new(|x| three_digits(f64::from(x))));
        let chart = chart.x_label_format(digits()).y_label_format(digits()).lineplot(&shape);
        chart.axis();
        chart.figures();
        format!("{name}\n{chart}")
    }
}
