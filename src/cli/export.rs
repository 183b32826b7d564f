//! `pontoon export`: a run, or the bodies of a scene, in forms that other programs read.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use super::{given_keys::GivenKeys, key_value, print_error, scene_lookup::find_scene};
use crate::{
    error::{Error, ErrorKind, Result},
    output::{Manifest, SeriesTable, npz},
    run,
    scene::{PanelledBody, PanelledScene, Scene},
};
use clap::{ArgGroup, Args};
use serde::{Deserialize, de::DeserializeOwned};

/// Which run, what of it, and where to.
#[derive(Args)]
#[command(group(ArgGroup::new("what").required(true).multiple(true)))]
pub struct ExportArgs {
    /// Folder of the run; with --capytaine it may be a scene
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// All series, spectra and RAOs as NumPy arrays in one file [default: DIR/series.npz]
    #[arg(long, value_name = "FILE", num_args = 0..=1, group = "what")]
    npz: Option<Option<PathBuf>>,
    /// The free surface in each frame of a 3-D run as a mesh for ParaView: DIR/surface.pvd
    #[arg(long, group = "what")]
    surface: bool,
    /// The bodies of the run or scene for Capytaine and other panel methods: a folder with bodies.json and a mesh of each body
    /// below the still water
    #[arg(long, value_name = "OUT", group = "what")]
    capytaine: Option<PathBuf>,
    /// A solid to export, driven and fixed ones too; may be given several times [default: the free solids]
    #[arg(long, value_name = "NAME", requires = "capytaine")]
    solid: Vec<String>,
    /// About so many panels for each body; the time of a panel method grows with their square
    #[arg(long, value_name = "N", default_value_t = PANELS, requires = "capytaine")]
    panels: usize,
    /// Change a key of the scene; may be given several times
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value, requires = "capytaine")]
    set: Vec<(String, String)>,
}

/// Default number of panels of a body: coefficients of a sphere within about 4 %, in a second or so a frequency.
const PANELS: usize = 800;

/// Difference of the volumes of panels and body, relative, above which the export says so.
const VOLUME: f64 = 0.02;

/// The same difference above which nothing is exported: coefficients of such panels are those of another body.
const MOST_VOLUME: f64 = 0.1;

/// Ratio of the numbers of panels and of those asked for, or its inverse, above which the export says so.
const PANEL_RATIO: f64 = 2.0;

/// Difference of displaced and own mass, relative, above which the export says so.
const MASS: f64 = 0.01;

/// Writes the files; says where.
pub fn export(args: &ExportArgs) -> Result<String> {
    let mut said = String::new();
    if let Some(out) = &args.npz {
        said += &series(&args.folder, out.clone().unwrap_or_else(|| args.folder.join("series.npz")))?;
    }
    if args.surface {
        said += &surface(&args.folder)?;
    }
    if let Some(out) = &args.capytaine {
        said += &bodies(args, out)?;
    }
    Ok(said)
}

/// Writes the bodies of a scene for a panel method.
fn bodies(args: &ExportArgs, out: &Path) -> Result<String> {
    let sets = GivenKeys::of_set(&args.set).overrides()?;
    let export = |scene: &Scene| PanelledScene::new(scene, &args.solid, args.panels);
    let exported = if args.folder.join("manifest.json").is_file() {
        // The scene of a run with its changed keys; the files that it names are copied beside it.
        let manifest = Manifest::read(&args.folder)?;
        export(&Scene::parse(&manifest.scene, &args.folder.join("scene"), &sets)?)?
    } else {
        let found = find_scene(&args.folder)?;
        found.with_scene_name(
            Scene::read(&run::run_folder::scene_file(found.path()), &sets).and_then(|scene| export(&scene)),
        )?
    };
    exported.bodies.iter().try_for_each(check_volume)?;
    let path = exported.write(out)?;
    Ok(format!("{}: {}\n{}", path.display(), panel_counts(&exported), remarks(&exported, args.panels)))
}

/// Relative difference of the volumes of panels and body.
fn volume_error(body: &PanelledBody) -> f64 {
    body.panel_volume_m3 / body.displaced_volume_m3 - 1.0
}

/// Refuses panels whose volume is far from that of the body.
fn check_volume(body: &PanelledBody) -> Result<()> {
    let error = volume_error(body);
    if error.abs() <= MOST_VOLUME {
        return Ok(());
    }
    let what = format!(
        "the {} panels of \"{}\" enclose a volume that is {:+.0} % off its displaced volume",
        body.panel_count,
        body.name,
        100.0 * error
    );
    Err(Error::new(ErrorKind::Usage, what).help(format!("take more:  --panels {}", 4 * body.panel_count)))
}

fn panel_counts(exported: &PanelledScene) -> String {
    let body = |body: &PanelledBody| format!("{} with {} panels", body.name, body.panel_count);
    exported.bodies.iter().map(body).collect::<Vec<_>>().join(", ")
}

/// Says where the panels or the place of a body may not be meant.
fn remarks(exported: &PanelledScene, asked: usize) -> String {
    let mut text = String::new();
    for body in &exported.bodies {
        let ratio = body.panel_count as f64 / asked as f64;
        if !(1.0 / PANEL_RATIO..=PANEL_RATIO).contains(&ratio) {
            text += &format!(
                "note: \"{}\" has {} panels in place of about {asked}: round parts have a least number of segments, and small facets \
                 of a mesh stay\n",
                body.name, body.panel_count
            );
        }
        let volume = volume_error(body);
        if volume.abs() > VOLUME {
            text += &format!(
                "note: the volume within the panels of \"{}\" is {:+.1} % off its displaced volume\n  more panels come nearer: \
                 --panels {}\n",
                body.name,
                100.0 * volume,
                4 * body.panel_count
            );
        }
        let displaced = exported.water.density_kg_m3 * body.displaced_volume_m3;
        let carried = body.mass_kg.map(|mass| mass + body.enclosed_water_kg.unwrap_or(0.0));
        let inside = if body.enclosed_water_kg.is_some() { " with the water inside" } else { "" };
        if let Some(mass) = carried.filter(|mass| (displaced / mass - 1.0).abs() > MASS) {
            text += &format!(
                "note: \"{}\" displaces {displaced:.4} kg where it starts and has {mass:.4} kg{inside}: the panels are of its \
                 start, not of its rest\n  at = {{ draft = \"equilibrium\" }} places it at rest\n",
                body.name
            );
        }
    }
    text
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
    for damage in tables.iter().filter_map(|(name, table)| table.damage(name)) {
        print_error(&format!("warning: {damage}\n"));
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
