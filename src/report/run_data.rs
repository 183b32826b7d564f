//! Reads the folder of a run for a page. Missing or unreadable parts are omitted, with a remark.

use std::{
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::{
    outline::{Outline, outlines},
    placement::Placement,
    ties::{Tie, ties},
};
use crate::{
    analysis::{CheckCurves, ReferenceCheck},
    error::{Error, Result},
    math::readings::Readings,
    output::{FrameSequence, Manifest, SeriesTable},
    plan::Plan,
    probe::ProbeLocation,
    run::{self, RunStatistics, outputs, run_folder},
    scene::{OpenBoundaryConfig, Scene, SceneLayout},
    solid::Role,
};

/// The contents of the folder of a run.
pub(crate) struct RunData {
    /// The path of the folder.
    pub folder: PathBuf,
    /// A short name that differs from the names of the other runs on the page.
    pub name: String,
    /// The manifest of the run.
    pub manifest: Manifest,
    /// The time of the last change to the manifest.
    pub written: Option<SystemTime>,
    /// The text of the scene as the user wrote it.
    pub scene_text: String,
    /// The probes and the solids, or `None` if the saved scene cannot be rebuilt.
    pub geometry: Option<SceneGeometry>,
    /// The frames of the run.
    pub frames: Option<FrameSequence>,
    /// The tables of the run.
    pub tables: Vec<ProbeTable>,
    /// The statistics of the series.
    pub statistics: RunStatistics,
    /// The checks with their curves. A finished run has as many checks as its manifest has verdicts.
    pub checks: Vec<(ReferenceCheck, Option<CheckCurves>)>,
    /// The parts that could not be read, with the reasons.
    pub remarks: Vec<String>,
}

/// The geometry around the water.
pub(crate) struct SceneGeometry {
    /// The dimension, 2 or 3.
    pub dimension: usize,
    /// Particle spacing, m.
    pub dp: f64,
    /// The still-water level, m.
    pub level: f64,
    /// The reference density, kg/m³.
    pub rho0: f64,
    /// The gravitational acceleration along the negative last axis, m/s²; 0 if gravity has another direction.
    pub g: f64,
    /// Where the water ends without a surface or a wall: axis and coordinate (m) of faces, periodic sides and symmetry planes.
    pub ends: Vec<(usize, f64)>,
    /// The solids at the start.
    pub solids: Vec<DrawnSolid>,
    /// The springs and the ropes.
    pub ties: Vec<Tie>,
    /// The probes, the checks and the output settings.
    pub plan: Plan,
}

/// A solid, prepared for drawing.
pub(crate) struct DrawnSolid {
    /// The name of the solid.
    pub name: String,
    /// The role: `fixed`, `driven` or `free`.
    pub role: &'static str,
    /// The outlines of the solid, in its local frame.
    pub lines: Vec<Outline>,
    /// The pose of the local frame at the start.
    pub start: Placement,
}

/// A table of a probe.
pub(crate) struct ProbeTable {
    /// The name of the probe.
    pub name: String,
    /// The measured quantity, as a short text.
    pub what: &'static str,
    /// The names of the columns after the time column.
    pub columns: Vec<String>,
    /// The times, s.
    pub times: Vec<f64>,
    /// The values of each column; NaN if the probe had nothing to measure.
    pub values: Vec<Vec<f64>>,
    /// Whether the readings of each column are means since the previous row.
    pub are_means: Vec<bool>,
}

impl RunData {
    /// Reads the run in `folder`.
    ///
    /// # Errors
    /// `Restart` if the folder contains no run. Other unreadable parts are omitted with a remark.
    pub(crate) fn read(folder: &Path) -> Result<Self> {
        let manifest = Manifest::read(folder)?;
        let file = run_folder::scene_file(&folder.join("scene"));
        let mut remarks = Vec::new();
        let mut noted = |what: &str, why: Error| remarks.push(format!("{what}: {}", why.message));
        let sets: Vec<(String, String)> = manifest.set.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
        let set = Scene::read(&file, &sets).and_then(|scene| SceneGeometry::new(&scene, &manifest.events));
        let set = set.map_err(|why| noted("bodies and gauges are not drawn, for the scene cannot be built", why)).ok();
        let film = FrameSequence::open(folder).unwrap_or_else(|why| {
            noted("there is no player, for the frames cannot be read", why);
            None
        });
        let plan = set.as_ref().map(|set| &set.plan);
        let series = outputs::series_folder(folder);
        let mut tables = Vec::new();
        for name in names(&series, plan) {
            match ProbeTable::read(&series, &name, plan) {
                Ok(table) => tables.push(table),
                Err(why) => noted("a table is left out", why),
            }
        }
        let mut checks = Vec::new();
        for words in plan.iter().flat_map(|plan| &plan.checks) {
            match ReferenceCheck::new(words, &folder.join("scene")) {
                Ok(check) => checks.push((check.curves(&series).ok(), check)),
                Err(why) => noted("a reference is not drawn", why),
            }
        }
        let checks = checks.into_iter().map(|(curves, check)| (check, curves)).collect();
        let (told, damages) = plan.map_or_else(Default::default, |plan| run::statistics::run_statistics(folder, plan));
        remarks.extend(damages);
        Ok(Self {
            name: folder
                .canonicalize()
                .ok()
                .and_then(|f| Some(f.file_name()?.to_string_lossy().into_owned()))
                .unwrap_or_default(),
            written: fs::metadata(folder.join("manifest.json")).and_then(|file| file.modified()).ok(),
            scene_text: fs::read_to_string(&file).unwrap_or_else(|_| manifest.scene.clone()),
            folder: folder.to_owned(),
            manifest,
            geometry: set,
            frames: film,
            tables,
            statistics: told,
            checks,
            remarks,
        })
    }

    /// Reads the runs in `folders` and gives each run a distinct name.
    ///
    /// # Errors
    /// The errors of [`RunData::read`], for the first folder without a run.
    pub(crate) fn read_all(folders: &[PathBuf]) -> Result<Vec<Self>> {
        let mut runs = folders.iter().map(|folder| Self::read(folder)).collect::<Result<Vec<_>>>()?;
        let names: Vec<String> = runs.iter().map(|run| run.name.clone()).collect();
        for run in &mut runs {
            if names.iter().filter(|name| **name == run.name).count() > 1 {
                run.name = run.folder.display().to_string();
            }
        }
        Ok(runs)
    }
}

/// Returns the names of the tables in the folder `series`. The tables of the plan come first, in the order of the plan.
fn names(series: &Path, plan: Option<&Plan>) -> Vec<String> {
    let mut names: Vec<String> = plan.iter().flat_map(|p| &p.probes).map(|probe| probe.name.clone()).collect();
    names.retain(|name| series.join(format!("{name}.csv")).is_file());
    let entries = fs::read_dir(series).into_iter().flatten().flatten().map(|entry| entry.path());
    let tables = entries.filter(|path| path.extension().is_some_and(|end| end == "csv"));
    let mut others: Vec<String> = tables.filter_map(|p| Some(p.file_stem()?.to_string_lossy().into_owned())).collect();
    others.sort();
    others.retain(|name| !names.contains(name));
    names.extend(others);
    names
}

impl SceneGeometry {
    /// Returns the geometry of `scene`, of a run with these `events`.
    fn new(scene: &Scene, events: &[String]) -> Result<Self> {
        match scene.dimension {
            2 => Self::in_dimension::<2>(scene, events),
            _ => Self::in_dimension::<3>(scene, events),
        }
    }

    fn in_dimension<const D: usize>(scene: &Scene, events: &[String]) -> Result<Self> {
        let SceneLayout { solids, model, still_water } = scene.layout::<D>()?;
        let plan = scene.plan()?;
        let solids = solids.iter().map(|spec| DrawnSolid {
            name: spec.name.clone(),
            role: match spec.role {
                Role::Fixed => "fixed",
                Role::Driven(_) => "driven",
                Role::Free(_) => "free",
            },
            lines: outlines(&spec.shape),
            start: Placement::from_pose(&spec.initial_kinematics().pose),
        });
        let solids: Vec<_> = solids.collect();
        let ties = ties::<D>(scene, &solids, events);
        let (down, beside) =
            model.gravity.split_last().map_or((0.0, false), |(g, rest)| (-g, rest.iter().any(|x| *x != 0.0)));
        let periodic = scene.periodic.clone().unwrap_or_default().build::<D>();
        let g = if beside || periodic[D - 1].is_some() { 0.0 } else { down };
        let sides =
            periodic.iter().enumerate().flat_map(|(axis, side)| side.iter().flatten().map(move |at| (axis, *at)));
        let planes = scene.symmetry.clone().unwrap_or_default().build::<D>();
        let planes = planes.into_iter().enumerate().filter_map(|(axis, plane)| Some((axis, plane?)));
        let faces = scene.inflow.iter().chain(&scene.outflow).filter_map(OpenBoundaryConfig::place);
        let ends = sides.chain(planes).chain(faces).collect();
        let (dp, level, rho0) = (scene.dp, still_water.level, model.rho0);
        Ok(Self { dimension: D, dp, level, rho0, g, ends, solids, ties, plan })
    }

    /// Returns the gauges: the name of each gauge, its measured quantity, and its position (m) with as many coordinates
    /// as the gauge has.
    pub(crate) fn gauges(&self) -> impl Iterator<Item = (&str, &'static str, &[f64])> {
        self.plan.probes.iter().flat_map(|probe| {
            let (what, places) = match probe.kind.location() {
                Some(ProbeLocation::Points(places, None) | ProbeLocation::Columns(places, None)) => {
                    (probe.kind.key(), places)
                }
                _ => ("", &[][..]),
            };
            // Only the first gauge of an array carries the name.
            let name = move |i: usize| if i == 0 { probe.name.as_str() } else { "" };
            places.iter().enumerate().map(move |(i, at)| (name(i), what, &at[..]))
        })
    }
}

impl ProbeTable {
    /// Returns whether the table is a budget or a balance. Such a table has an entry for each kind, and most kinds are
    /// absent from a run.
    pub(crate) fn is_breakdown(&self) -> bool {
        matches!(self.what, "energy budget" | "loads by kind")
    }

    /// Returns whether a column has values and all are 0.
    pub(crate) fn is_zero(&self, column: usize) -> bool {
        let mut known = self.values[column].iter().filter(|x| x.is_finite()).peekable();
        known.peek().is_some() && known.all(|x| *x == 0.0)
    }

    fn read(series: &Path, name: &str, plan: Option<&Plan>) -> Result<Self> {
        let SeriesTable { columns, times, values, .. } = SeriesTable::read(&series.join(format!("{name}.csv")))?;
        let probe = plan.and_then(|plan| plan.probes.iter().find(|probe| probe.name == name));
        let what = probe.map_or("table", |probe| probe.kind.label());
        let is_mean = |column: &String| probe.is_some_and(|probe| probe.is_mean(column));
        let are_means = columns.iter().map(is_mean).collect();
        Ok(Self { name: name.into(), what, columns, times, values, are_means })
    }

    /// Returns the readings of a column, or `None` if it has fewer than two.
    pub(crate) fn readings(&self, column: usize) -> Option<Readings> {
        let are_means = self.are_means[column];
        Readings::new(&self.times, &self.values[column], are_means, [f64::NEG_INFINITY, f64::INFINITY])
    }
}
