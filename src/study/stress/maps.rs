//! Reads the maps of `pontoon stress` from the built-in file `scenes/stress.toml` or from a file of the user.
//!
//! A map is a scene with placeholders, `${…}`, and one or two axes that supply their values. A placeholder is a formula
//! of the axis values `x` and `y`, a text value such as `${x}`, or the name of a text in `[part]`.

use std::{collections::BTreeMap, path::Path};

use serde::Deserialize;

use super::criteria::{Bound, Criteria, MotionBound, SolidBound};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result, nearest_name},
    math::expression::ScalarField,
    output::checkpoint::fnv1a,
    scene::Scene,
};

const TEXT: &str = include_str!("../../../scenes/stress.toml");
const NAME: &str = "stress.toml";

/// The largest nesting depth of parts.
const DEEPEST: usize = 8;

/// A family of cases along one or two axes.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StressMap {
    /// The name of the map.
    pub name: String,
    /// The purpose of the map, in a sentence.
    pub about: String,
    /// The parameter that varies along the columns of the chart.
    pub x: MapAxis,
    /// The parameter that varies along the rows of the chart.
    pub y: Option<MapAxis>,
    scene: String,
    #[serde(default)]
    judge: Criteria,
    /// Whether `--quick` omits the map, because its cases take too long.
    #[serde(default)]
    slow: bool,
    #[serde(skip)]
    parts: BTreeMap<String, String>,
    #[serde(skip)]
    default_criteria: Criteria,
    /// The file of the map, for error messages.
    #[serde(skip)]
    file: String,
}

/// A varied parameter and its values.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapAxis {
    /// The label of the parameter.
    pub label: String,
    /// The unit of the parameter.
    pub unit: String,
    /// The values, which are numbers or texts.
    values: Vec<toml::Value>,
}

/// One case of a map.
#[derive(Clone, Debug)]
pub struct StressCase {
    /// The name of the map.
    pub map: String,
    /// The column and row of the case.
    pub cell: [usize; 2],
    /// The axis values, as text.
    pub values: Vec<String>,
    /// The scene with all placeholders replaced.
    pub scene: Scene,
    /// The criteria of the case.
    pub criteria: Criteria,
    /// A key that distinguishes this case and program version from all others. The program does not rerun a case with a
    /// known key.
    pub key: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MapsFile {
    #[serde(default)]
    judge: Criteria,
    #[serde(default)]
    part: BTreeMap<String, String>,
    map: Vec<StressMap>,
}

/// Returns all maps of `file`, or the built-in maps without a file.
///
/// # Errors
/// `File` if the file cannot be read; `Scene` if the file is not a list of maps.
pub fn maps(file: Option<&Path>) -> Result<Vec<StressMap>> {
    let Some(path) = file else { return read(TEXT, NAME) };
    let text = std::fs::read_to_string(path).map_err(|why| {
        Error::read(path, &why).help("name a file of [[map]] entries; docs/explanation/stability.md shows one")
    })?;
    read(&text, &path.display().to_string())
}

fn read(text: &str, name: &str) -> Result<Vec<StressMap>> {
    let MapsFile { judge, part, map } = toml::from_str(text).map_err(|e| {
        let line = e.span().map(|span| text[..span.start].matches('\n').count() + 1);
        Error::scene(e.message().to_string()).at(name, line.map(|line| (line, 1)), "")
    })?;
    let whole =
        |map: StressMap| StressMap { parts: part.clone(), default_criteria: judge.clone(), file: name.into(), ..map };
    let all: Vec<StressMap> = map.into_iter().map(whole).collect();
    for map in &all {
        let axes = std::iter::once(("x", &map.x)).chain(map.y.as_ref().map(|y| ("y", y)));
        if let Some((axis, _)) = axes.into_iter().find(|(_, axis)| axis.values.is_empty()) {
            let what = format!("the map {:?} has no value along {axis}: it has no cases", map.name);
            return Err(Error::scene(what)
                .at(name, None, format!("map.{axis}.values"))
                .help("write  values = [0.1, 0.2]"));
        }
    }
    match (0..all.len()).find(|&i| all[..i].iter().any(|map| map.name == all[i].name)) {
        Some(i) => Err(Error::scene(format!("two maps are called {:?}", all[i].name)).at(name, None, "map.name")),
        None => Ok(all),
    }
}

/// Returns the maps of `all` with the given `names`, or all maps without names. `quick` omits the slow maps if no name
/// is given.
///
/// # Errors
/// `Usage` if a map does not exist; the message contains the most similar name.
pub fn select_maps(all: Vec<StressMap>, names: &[String], quick: bool) -> Result<Vec<StressMap>> {
    if names.is_empty() {
        return Ok(all.into_iter().filter(|map| !(quick && map.slow)).collect());
    }
    let map = |name: &String| {
        all.iter().find(|map| map.name == *name).cloned().ok_or_else(|| {
            let list = "`pontoon stress --list` lists all";
            let help = match nearest_name(name, all.iter().map(|map| map.name.as_str())) {
                Some(near) => format!("did you mean {near:?}? {list}"),
                None => list.into(),
            };
            Error::new(ErrorKind::Usage, format!("there is no map {name:?}"))
                .with_code(ErrorCode::UnknownName)
                .help(help)
        })
    };
    names.iter().map(map).collect()
}

impl MapAxis {
    /// Returns the values of the axis as text.
    pub(crate) fn value_labels(&self) -> Vec<String> {
        self.values.iter().map(word).collect()
    }
}

impl StressMap {
    /// Returns the number of cases.
    pub fn count(&self) -> usize {
        self.x.values.len() * self.y.as_ref().map_or(1, |y| y.values.len())
    }

    /// Returns the cases, row by row. `quick` selects only the cases at the ends of the axes.
    ///
    /// # Errors
    /// `Scene` if a placeholder cannot be replaced or the scene is invalid; the message contains the map and the
    /// values.
    pub(crate) fn cases(&self, quick: bool) -> Result<Vec<StressCase>> {
        let ends = |n: usize| (0..n).filter(|&i| !quick || i == 0 || i + 1 == n).collect::<Vec<_>>();
        let rows = self.y.as_ref().map_or(1, |y| y.values.len());
        let places = ends(rows).into_iter().flat_map(|j| ends(self.x.values.len()).into_iter().map(move |i| [i, j]));
        places.map(|place| self.case(place)).collect()
    }

    fn case(&self, place: [usize; 2]) -> Result<StressCase> {
        let y = self.y.as_ref().map(|y| &y.values[place[1]]);
        let values: Vec<&toml::Value> = std::iter::once(&self.x.values[place[0]]).chain(y).collect();
        let words: Vec<String> = values.iter().map(|value| word(value)).collect();
        let here = |error: Error| error.at(self.file.clone(), None, format!("{} at {}", self.name, words.join(", ")));
        let fill = |text: &str| self.substituted(text, &values, 0).map_err(here);
        let scene = Scene::parse(&fill(&self.scene)?, Path::new(""), &[]).map_err(|mut error| {
            error.message = format!("map {} at {}: {}", self.name, words.join(", "), error.message);
            error
        })?;
        let judge = self.judge.clone().with_defaults(&self.default_criteria);
        let course = |course: MotionBound| Ok(MotionBound { formula: fill(&course.formula)?, ..course });
        let judge = Criteria { motion: judge.motion.into_iter().map(course).collect::<Result<_>>()?, ..judge };
        let text = format!("{}\n{}\n{}", scene.to_toml()?, judge.required_figures(), env!("CARGO_PKG_VERSION"));
        let key = format!("{:016x}", fnv1a(text.as_bytes()));
        Ok(StressCase { map: self.name.clone(), cell: place, values: words, scene, criteria: judge, key })
    }

    /// Returns `text` with its placeholders replaced.
    fn substituted(&self, text: &str, values: &[&toml::Value], depth: usize) -> Result<String> {
        if depth > DEEPEST {
            return Err(Error::scene("a part holds itself"));
        }
        let mut whole = String::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once("${") {
            let Some((hole, after)) = after.split_once('}') else {
                return Err(Error::scene("a hole \"${\" is not closed").help("write  ${2*x}"));
            };
            whole += before;
            whole += &self.placeholder_value(hole.trim(), values, depth)?;
            rest = after;
        }
        Ok(whole + rest)
    }

    fn placeholder_value(&self, hole: &str, values: &[&toml::Value], depth: usize) -> Result<String> {
        let named = ["x", "y"].iter().position(|name| *name == hole).and_then(|i| values.get(i));
        if let Some(toml::Value::String(word)) = named {
            return Ok(word.clone());
        }
        if let Some(part) = self.parts.get(hole) {
            return self.substituted(part, values, depth + 1);
        }
        let number = |i: usize| values.get(i).and_then(|value| number(value)).unwrap_or(f64::NAN);
        let value = ScalarField::<2>::parse(hole)?.value_at(&[number(0), number(1)].into());
        if !value.is_finite() {
            let help = "a formula of x and y, the numbers along the axes, or the name of a part";
            return Err(Error::scene(format!("the hole \"{hole}\" is {value}")).help(help));
        }
        // Rounding prevents the round-off of decimal products from affecting the particle lattice.
        Ok(format!("{:?}", format!("{value:.12e}").parse::<f64>().unwrap_or(value)))
    }
}

impl Criteria {
    /// Returns these criteria, with missing entries taken from `other`.
    fn with_defaults(self, other: &Self) -> Self {
        let bound = |own: Option<Bound>, other: &Option<Bound>| own.or_else(|| other.clone());
        let list = |own: Vec<SolidBound>, other: &Vec<SolidBound>| if own.is_empty() { other.clone() } else { own };
        Self {
            energy: bound(self.energy, &other.energy),
            walls: bound(self.walls, &other.walls),
            quiet: bound(self.quiet, &other.quiet),
            momentum: bound(self.momentum, &other.momentum),
            draft: list(self.draft, &other.draft),
            motion: if self.motion.is_empty() { other.motion.clone() } else { self.motion },
        }
    }
}

fn word(value: &toml::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), String::from)
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}

#[cfg(test)]
#[path = "../../../tests/unit/study/stress/maps.rs"]
mod tests;
