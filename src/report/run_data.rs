//! What stands in a run's folder, read for a page. Whatever is missing there is missing here, with a remark.

use std::{
    fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::{
    outline::{Outline, outlines},
    placement::Placement,
};
use crate::{
    analysis::{CheckCurves, ReferenceCheck},
    error::{Error, Result},
    output::{FrameSequence, Manifest, SeriesTable},
    plan::Plan,
    probe::ProbeLocation,
    run::{self, RunStatistics, StatisticsFilter, outputs, run_folder},
    scene::{Scene, SceneLayout},
    solid::Role,
};

/// A run's folder.
pub(crate) struct RunData {
    /// The folder.
    pub folder: PathBuf,
    /// A short name, told apart from those of the runs beside it.
    pub name: String,
    /// Its manifest.
    pub manifest: Manifest,
    /// When the manifest was written last.
    pub written: Option<SystemTime>,
    /// The words of the scene as the user wrote them.
    pub scene_text: String,
    /// What was watched and what stands around the water; none if the kept scene cannot be built again.
    pub geometry: Option<SceneGeometry>,
    /// Its frames.
    pub frames: Option<FrameSequence>,
    /// Its tables.
    pub tables: Vec<ProbeTable>,
    /// What is said of its series.
    pub statistics: RunStatistics,
    /// Its checks with their curves; as many as the manifest has verdicts if the run has finished.
    pub checks: Vec<(ReferenceCheck, Option<CheckCurves>)>,
    /// What could not be read, and why.
    pub remarks: Vec<String>,
}

/// What stands around the water.
pub(crate) struct SceneGeometry {
    /// 2 or 3.
    pub dimension: usize,
    /// Particle spacing, m.
    pub dp: f64,
    /// Level of the still water, m.
    pub level: f64,
    /// Density at rest, kg/m³.
    pub rho0: f64,
    /// Weight of a mass down the last axis, m/s²; 0 where gravity is otherwise.
    pub g: f64,
    /// The solids at the start.
    pub solids: Vec<DrawnSolid>,
    /// What is watched, judged and kept.
    pub plan: Plan,
}

/// A solid as it is drawn.
pub(crate) struct DrawnSolid {
    /// Its name.
    pub name: String,
    /// `fixed`, `driven` or `free`.
    pub role: &'static str,
    /// Its lines, in its own frame.
    pub lines: Vec<Outline>,
    /// Pose of that frame at the start.
    pub start: Placement,
}

/// A table of a probe.
pub(crate) struct ProbeTable {
    /// Name of the probe.
    pub name: String,
    /// What it watches, in a word.
    pub what: &'static str,
    /// Names of the columns after the time.
    pub columns: Vec<String>,
    /// Times, s.
    pub times: Vec<f64>,
    /// A row of numbers for each column; NaN where there was nothing to measure.
    pub values: Vec<Vec<f64>>,
}

impl RunData {
    /// The run in `folder`.
    ///
    /// # Errors
    /// `Restart` if it holds no run. All else that cannot be read is left out with a remark.
    pub(crate) fn read(folder: &Path) -> Result<Self> {
        let manifest = Manifest::read(folder)?;
        let file = run_folder::scene_file(&folder.join("scene"));
        let mut remarks = Vec::new();
        let mut noted = |what: &str, why: Error| remarks.push(format!("{what}: {}", why.message));
        let sets: Vec<(String, String)> = manifest.set.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
        let set = Scene::read(&file, &sets).and_then(|scene| SceneGeometry::from_scene(&scene));
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
        let told = plan.map_or_else(RunStatistics::default, |plan| {
            run::statistics::run_statistics(folder, plan, &StatisticsFilter::default())
        });
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

    /// The runs in `folders`, with names that differ.
    ///
    /// # Errors
    /// As [`Kept::read`], for the first that is none.
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

/// The tables in the folder `series`: first those of the plan, in its order.
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
    fn from_scene(scene: &Scene) -> Result<Self> {
        match scene.dimension {
            2 => Self::from_scene_in::<2>(scene),
            _ => Self::from_scene_in::<3>(scene),
        }
    }

    fn from_scene_in<const D: usize>(scene: &Scene) -> Result<Self> {
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
        let solids = solids.collect();
        let (down, beside) =
            model.gravity.split_last().map_or((0.0, false), |(g, rest)| (-g, rest.iter().any(|x| *x != 0.0)));
        let g = if beside || scene.periodic.is_some() { 0.0 } else { down };
        Ok(Self { dimension: D, dp: scene.dp, level: still_water.level, rho0: model.rho0, g, solids, plan })
    }

    /// Where gauges stand: the name of each, what it measures, and its place (m) with as many coordinates as it has.
    pub(crate) fn gauges(&self) -> impl Iterator<Item = (&str, &'static str, &[f64])> {
        self.plan.probes.iter().flat_map(|probe| {
            let (what, places) = match probe.kind.location() {
                Some(ProbeLocation::Points(places) | ProbeLocation::Columns(places)) => (probe.kind.key(), places),
                _ => ("", &[][..]),
            };
            // A row bears its name once.
            let name = move |i: usize| if i == 0 { probe.name.as_str() } else { "" };
            places.iter().enumerate().map(move |(i, at)| (name(i), what, &at[..]))
        })
    }
}

impl ProbeTable {
    /// Whether it is a budget or a balance: an entry for each kind, most of which a run does not have.
    pub(crate) fn is_breakdown(&self) -> bool {
        matches!(self.what, "energy budget" | "loads by kind")
    }

    /// Whether a column was measured and is 0 throughout.
    pub(crate) fn is_zero(&self, column: usize) -> bool {
        let mut known = self.values[column].iter().filter(|x| x.is_finite()).peekable();
        known.peek().is_some() && known.all(|x| *x == 0.0)
    }

    fn read(series: &Path, name: &str, plan: Option<&Plan>) -> Result<Self> {
        let SeriesTable { columns, times, values } = SeriesTable::read(&series.join(format!("{name}.csv")))?;
        let probe = plan.and_then(|plan| plan.probes.iter().find(|probe| probe.name == name));
        let what = probe.map_or("table", |probe| probe.kind.label());
        Ok(Self { name: name.into(), what, columns, times, values })
    }
}
