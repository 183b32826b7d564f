//! `pontoon export`: a run in forms that other programs read.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use crate::{
    error::{Error, ErrorKind, Result},
    output::{Manifest, SeriesTable, npz},
    run,
};
use clap::{ArgGroup, Args};
use serde::{Deserialize, de::DeserializeOwned};

/// Which run, what of it, and where to.
#[derive(Args)]
#[command(group(ArgGroup::new("what").required(true).multiple(true)))]
pub struct ExportArgs {
    /// Folder of the run
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// All series, spectra and RAOs as NumPy arrays in one file [default: DIR/series.npz]
    #[arg(long, value_name = "FILE", num_args = 0..=1, group = "what")]
    npz: Option<Option<PathBuf>>,
    /// The free surface in each frame of a 3-D run as a mesh for ParaView: DIR/surface.pvd
    #[arg(long, group = "what")]
    surface: bool,
}

/// Writes the files; says where.
pub fn export(args: &ExportArgs) -> Result<String> {
    let mut said = String::new();
    if let Some(out) = &args.npz {
        said += &series(&args.folder, out.clone().unwrap_or_else(|| args.folder.join("series.npz")))?;
    }
    if args.surface {
        said += &surface(&args.folder)?;
    }
    Ok(said)
}

fn series(folder: &Path, out: PathBuf) -> Result<String> {
    let manifest = Manifest::read(folder)?;
    let names = manifest.files.iter().filter_map(|file| file.strip_prefix("series/")?.strip_suffix(".csv"));
    let read = |name| Ok((name, SeriesTable::read(&folder.join(format!("series/{name}.csv")))?));
    let tables: Vec<(&str, SeriesTable)> = names.map(read).collect::<Result<_>>()?;
    if tables.is_empty() {
        let what = format!("the run in {} has no series", folder.display());
        return Err(Error::new(ErrorKind::Usage, what).help("a [[probe]] in its scene would write some"));
    }
    let (spectra, answers) = (spectra(folder)?, rao_arrays(folder)?);
    let all = tables.iter().flat_map(|(name, of)| {
        let columns = of.columns.iter().zip(&of.values).map(move |(column, x)| (format!("{name}.{column}"), &x[..]));
        [(format!("{name}.t_s"), &of.times[..])].into_iter().chain(columns)
    });
    let told = spectra.iter().chain(&answers).map(|(name, x)| (name.clone(), &x[..]));
    npz::write(&out, all.chain(told))?;
    let counts = (tables.len(), spectra.len() / 2, answers.len() / COLUMNS.len());
    Ok(format!("{}: {} tables, {} spectra, {} RAOs\n", out.display(), counts.0, counts.1, counts.2))
}

/// The rows of a table of the run; none if it has not written it.
fn read_rows<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    if !path.exists() {
        return Ok(vec![]);
    }
    let broken = |why: csv::Error| Error::file(path, why);
    let rows = csv::Reader::from_path(path).map_err(broken)?.into_deserialize();
    rows.collect::<std::result::Result<_, _>>().map_err(broken)
}

/// Frequencies (Hz) and densities of every spectrum of the run, if it wrote some.
fn spectra(folder: &Path) -> Result<Vec<(String, Vec<f64>)>> {
    let rows: Vec<(String, f64, f64, String)> = read_rows(&folder.join(run::SPECTRA_FILE))?;
    let of = |rows: &[(String, f64, f64, String)]| {
        let name = &rows[0].0;
        let (f, s) = rows.iter().map(|row| (row.1, row.2)).unzip();
        [(format!("spectra.{name}.f_Hz"), f), (format!("spectra.{name}.S"), s)]
    };
    Ok(rows.chunk_by(|a, b| a.0 == b.0).flat_map(of).collect())
}

/// How a motion answers at a frequency, by the columns of `rao.csv`.
#[derive(Deserialize)]
struct RaoRecord {
    name: String,
    series: String,
    frequency_hz: f64,
    period_s: f64,
    rao: f64,
    phase_deg: f64,
    coherence: f64,
}

/// A column that becomes an array, and its number in a row.
type RaoColumn = (&'static str, fn(&RaoRecord) -> f64);

const COLUMNS: [RaoColumn; 5] = [
    ("frequency_hz", |row| row.frequency_hz),
    ("period_s", |row| row.period_s),
    ("rao", |row| row.rao),
    ("phase_deg", |row| row.phase_deg),
    ("coherence", |row| row.coherence),
];

/// The columns of every RAO over frequency of the run, if it wrote some.
fn rao_arrays(folder: &Path) -> Result<Vec<(String, Vec<f64>)>> {
    let rows: Vec<RaoRecord> = read_rows(&folder.join(run::RAO_FILE))?;
    let (mut arrays, mut seen) = (Vec::new(), BTreeSet::new());
    // Two statistics may have the same name: with the next one frequencies begin anew.
    let one =
        |a: &RaoRecord, b: &RaoRecord| (&a.name, &a.series) == (&b.name, &b.series) && a.frequency_hz < b.frequency_hz;
    for rows in rows.chunk_by(one) {
        let RaoRecord { name, series, .. } = &rows[0];
        let numbered = |n: usize| if n == 1 { format!("{name}.{series}") } else { format!("{name}_{n}.{series}") };
        let own = (1..).map(numbered).find(|own| seen.insert(own.clone())).unwrap_or_default();
        let array =
            |(column, of): &RaoColumn| (format!("rao.{own}.{column}"), rows.iter().map(of).collect::<Vec<f64>>());
        arrays.extend(COLUMNS.iter().map(array));
    }
    Ok(arrays)
}

#[cfg(not(feature = "surface"))]
fn surface(_: &Path) -> Result<String> {
    let what = "this program was built without meshes of the free surface";
    Err(Error::new(ErrorKind::Usage, what).help("install it with them: cargo install --path . --features surface"))
}

#[cfg(feature = "surface")]
fn surface(folder: &Path) -> Result<String> {
    use crate::output::{FrameSequence, free_surface_mesh};

    let (manifest, run) = (Manifest::read(folder)?, || folder.display());
    let Some((dimension, dp)) = manifest.numeric_value("dimension").zip(manifest.numeric_value("dp")) else {
        return Err(Error::new(ErrorKind::Usage, format!("the manifest in {} does not tell dimension and dp", run())));
    };
    if dimension < 3.0 {
        let what = format!("the run in {} is 2-D: its water has a line for a surface, not a mesh", run());
        return Err(Error::new(ErrorKind::Usage, what).help("`pontoon report` draws it, an elevation probe reads it"));
    }
    let Some(film) = FrameSequence::open(folder)? else {
        let what = format!("the run in {} has no frames to make a surface of", run());
        return Err(Error::new(ErrorKind::Usage, what).help("run it without `frames = \"off\"`"));
    };
    let count = free_surface_mesh::write(folder, &film, dp)?;
    Ok(format!("{}: {count} meshes\n", folder.join("surface.pvd").display()))
}
