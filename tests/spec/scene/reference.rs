//! The pages of `docs/reference` against the program: keys, defaults and fragments of scenes, files, columns and quantities of a run,
//! commands and options. Each page is complete; `scene.md` and `command-line.md` contain no other names. `schema` checks that
//! `scene.md` names every key and choice.

use std::{collections::BTreeSet, fs, path::Path, process::Command};

use pontoon::{
    error::ErrorCode,
    scene::{Scene, schema},
};
use serde_json::Value;

use super::schema::collect_names;
use crate::common::TestFolder;

/// The text of a page of the reference.
pub fn page(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/reference").join(name)).unwrap()
}

/// The parts of a text between back-quotes.
pub fn code(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// The names within the code of a page: letters, digits and underscores.
pub fn code_names(text: &str) -> BTreeSet<&str> {
    code(text).flat_map(|code| code.split(|c: char| !c.is_alphanumeric() && c != '_')).collect()
}

/// The names in a piece of code outside quotation marks.
fn unquoted_names(code: &str) -> Vec<&str> {
    let open = code.split('"').step_by(2);
    let names = open.flat_map(|part| part.split(|c: char| !c.is_alphanumeric() && c != '_'));
    names.filter(|name| name.starts_with(|c: char| c.is_alphabetic())).collect()
}

/// An item of the scene reference that describes keys: "- `key`, `key` (unit; default): meaning", or without the bracket.
struct Item {
    /// Heading of its section.
    section: String,
    /// Its first key.
    key: String,
    /// All its keys.
    names: Vec<String>,
    /// Its unit and default: the text in the bracket.
    default: String,
    /// The whole item.
    line: String,
}

impl Item {
    /// The item of a line, if it describes keys.
    fn of(line: &str, section: &str) -> Option<Self> {
        let item = line.trim_start().strip_prefix("- ")?;
        let end = [" (", "`: "].iter().filter_map(|end| item.find(end)).min().map_or(item.len(), |end| end + 1);
        let keys = item[..end].trim().strip_prefix('`')?.strip_suffix('`')?;
        if !keys.split("`, `").all(|key| !key.contains(['`', ':'])) {
            return None;
        }
        // Without a bracket the code may be a choice, as in `dry = true`.
        let is_key = |key: &str| key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '.');
        let bracket = item[end..].trim_start().strip_prefix('(');
        if bracket.is_none() && !keys.split("`, `").all(is_key) {
            return None;
        }
        let mut depth = 1;
        let inside = |c: &char| {
            depth += i32::from(*c == '(') - i32::from(*c == ')');
            depth > 0
        };
        let first = keys.split(|c: char| !is_key(&c.to_string())).next()?;
        Some(Self {
            section: section.into(),
            key: first.into(),
            names: unquoted_names(&keys.replace('`', " ")).into_iter().map(String::from).collect(),
            default: bracket.unwrap_or_default().chars().take_while(inside).collect(),
            line: item.into(),
        })
    }
}

/// The items that describe keys.
fn items() -> Vec<Item> {
    let (mut items, mut section) = (Vec::new(), String::new());
    for line in page("scene.md").lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            section = heading.to_string();
        }
        items.extend(Item::of(line, &section));
    }
    items
}

#[test]
fn every_key_of_the_scene_reference_is_a_key_of_a_scene() {
    let mut keys = BTreeSet::new();
    collect_names(&schema(), &mut keys);
    let items = items();
    assert!(items.len() > 200, "{} items were found", items.len());
    for item in items {
        for name in item.names {
            assert!(keys.contains(name.as_str()), "{name}, in section {}, is not a key of a scene", item.section);
        }
    }
}

/// A scene with almost all keys at their defaults.
const SCENE: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
[[water]]
fill = { box = { min = [0.0, 0.0], max = [3.0, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [3.2, 0.8] } }
at = { x = -0.2 }
[[solid]]
name = "paddle"
shape = { box = { size = [0.1, 0.8] } }
at = { x = -0.05, bottom = 0.0 }
driven = { along = [1.0, 0.0], wave = { WAVE } }
[[damping]]
from = [2.0, 0.0]
to = [3.0, 0.0]
[[solid]]
name = "buoy"
shape = { box = { size = [0.4, 0.2] } }
at = { x = 1.0, bottom = 0.3 }
free = { density = 500.0 }
[[spring]]
name = "line"
between = ["buoy"]
from = [1.0, 0.3]
to = [1.0, 0.0]
stiffness = 10.0
[[probe]]
motion = "buoy"
"#;

/// A wave for `WAVE` in [`SCENE`].
const REGULAR: &str = "regular = { height = 0.06, period = 1.2 }";

/// Section of the page, prefix of its keys in the list of values, whether each of these keys needs an item.
const SECTIONS: [(&str, &str, bool); 8] = [
    ("`[model]`", "model.", true),
    ("`[time]`", "time.", true),
    ("`[guard]`", "guard.", true),
    ("`[[damping]]`", "damping.0.", true),
    ("`[frames]`", "", false),
    ("`[[solid]]`", "solid.paddle.driven.wave.", false),
    ("`[[solid]]`", "solid.buoy.", false),
    ("`[[joint]]`", "spring.line.", false),
];

/// Defaults that follow from other values: the page has a formula instead of a number.
const DERIVED: [&str; 6] = [
    "model.h",
    "model.c0",
    "damping.0.strength",
    "frames.every",
    "solid.paddle.driven.wave.ramp",
    "spring.line.length",
];

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    let parts = text.split(|c: char| !c.is_ascii_digit() && c != '.');
    parts.filter_map(|part| part.trim_end_matches('.').parse().ok()).collect()
}

#[test]
fn every_default_of_the_scene_reference_is_the_default_of_a_scene() {
    let (items, mut count) = (items(), 0);
    for wave in [REGULAR, "jonswap = { height = 0.06, peak_period = 1.2 }", "solitary = { height = 0.06 }"] {
        let scene = Scene::parse(&SCENE.replace("WAVE", wave), Path::new(""), &[]).unwrap();
        for value in scene.resolve().unwrap() {
            if !value.source.to_string().starts_with("default") || DERIVED.contains(&value.key.as_str()) {
                continue;
            }
            for (section, prefix, complete) in SECTIONS {
                let Some(key) = value.key.strip_prefix(prefix) else { continue };
                let matches = |item: &&Item| {
                    let is_key = item.key == key || key.starts_with(&format!("{}.", item.key));
                    item.section.starts_with(section) && is_key
                };
                let Some(Item { line, default, .. }) = items.iter().find(matches) else {
                    assert!(!complete, "{} has no item in section {section}", value.key);
                    continue;
                };
                count += 1;
                let given = numbers(default);
                let same_numbers = numbers(&value.value).iter().all(|x| given.contains(x));
                let same_names =
                    unquoted_names(&value.value.replace('"', " ")).into_iter().all(|name| default.contains(name));
                let named = key.split('.').all(|part| line.contains(part));
                assert!(same_numbers && same_names && named, "{value}, but the page has: {line}");
            }
        }
    }
    assert!(count > 50, "{count} defaults were compared");
}

#[test]
fn every_fragment_of_the_scene_reference_is_read() {
    let page = page("scene.md");
    let blocks = page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    // Each fragment begins with `driven` at the start of a line, or is a `free` of its own.
    let (free, driven): (Vec<&str>, Vec<&str>) = blocks.partition(|block| block.starts_with("free"));
    let fragments: Vec<String> = driven
        .into_iter()
        .flat_map(|block| block.split("\ndriven"))
        .map(|part| format!("driven{}", part.trim_start_matches("driven")))
        .collect();
    assert!(fragments.len() >= 3, "{fragments:?}");
    for fragment in fragments {
        let driven = "driven = { along = [1.0, 0.0], wave = { WAVE } }";
        let text = SCENE.replace(driven, &fragment);
        let error = Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.resolve()).err();
        assert!(error.is_none(), "{fragment}: {}", error.unwrap());
    }
    assert_eq!(free.len(), 1);
    for fragment in free {
        let text = SCENE.replace("WAVE", REGULAR).replace("free = { density = 500.0 }", fragment);
        let error = Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.resolve()).err();
        assert!(error.is_none(), "{fragment}: {}", error.unwrap());
    }
}

#[test]
fn former_names_of_the_scene_reference_are_still_read() {
    let values = |old: bool| {
        let choose = |former: &'static str, name: &'static str| if old { former } else { name };
        let jitter = choose("scatter = 1e-7", "jitter = 1e-7");
        let skin = choose("skin = 0.005", "contact_skin = 0.005");
        let walls = choose("walls = \"settling\"", "walls = \"relaxed_adami\"");
        let text = SCENE.replace("WAVE", REGULAR).replace("name = \"buoy\"", &format!("name = \"buoy\"\n{skin}"));
        let scene = Scene::parse(&format!("{jitter}\n{text}\n[model]\n{walls}\n"), Path::new(""), &[]).unwrap();
        let values = scene.resolve().unwrap().into_iter().map(|value| (value.key, value.value));
        values.collect::<Vec<_>>()
    };
    assert_eq!(values(true), values(false));
}

/// The output of the program for these arguments.
fn pontoon(arguments: &[&str], folder: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pontoon")).args(arguments).current_dir(folder).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "pontoon {}: {errors}", arguments.join(" "));
    String::from_utf8(output.stdout).unwrap()
}

/// Solids, constraints and probes of every kind, in addition to [`SCENE`].
const PROBES: &str = r#"
[[solid]]
name = "raft"
shape = { box = { size = [0.4, 0.2] } }
at = { x = 1.6, bottom = 0.3 }
free = { density = 500.0, locked = ["x"] }
[[solid]]
name = "crate"
shape = { box = { size = [0.1, 0.1] } }
at = { x = 1.6, bottom = 0.5 }
free = { density = 500.0 }
[[solid]]
name = "post"
shape = { box = { size = [0.1, 0.1] } }
at = { x = 1.0, bottom = 0.6 }
free = { density = 500.0 }
[[joint]]
name = "hinge"
kind = "hinge"
between = ["buoy"]
at = [1.0, 0.4]
motor = { damping = 1.0 }
[[joint]]
name = "slider"
kind = "slider"
between = ["crate"]
along = [0.0, 1.0]
at = [1.6, 0.5]
[[joint]]
name = "generic"
kind = "generic"
between = ["post"]
free = ["x", "y", "turn"]
at = [1.0, 0.6]
[[rope]]
name = "rope"
between = ["raft"]
from = [1.6, 0.3]
to = [1.6, 0.0]
[[line_type]]
name = "chain"
diameter = 0.004
mass_per_length = 0.06
stiffness = 1e3
[[mooring]]
name = "moor"
between = ["raft"]
from = [1.6, 0.3]
to = [1.2, 0.0]
length = 0.52
line = "chain"
segments = 8
[[mooring_point]]
name = "joint"
at = [1.4, 0.15]
[[mooring]]
name = "upper"
between = ["raft", "joint"]
from = [1.6, 0.3]
length = 0.3
line = "chain"
segments = 4
[[mooring]]
name = "lower"
between = ["joint"]
to = [1.2, 0.0]
length = 0.3
line = "chain"
segments = 4
[[force]]
name = "wind"
on = "raft"
force = [1.0, 0.0]
[[check]]
series = "buoy.heave_m"
formula = "0"
bound = { off = 1.0 }
"#;

/// The quantities of a run with every kind of probe.
const MEASURED: [&str; 20] = [
    "force = \"buoy\"",
    "balance = \"raft\"",
    "contact = [\"raft\", \"crate\"]",
    "contacts = true",
    "joint = \"hinge\"",
    "joint = \"slider\"",
    "joint = \"generic\"",
    "spring = \"line\"",
    "rope = \"rope\"",
    "mooring = \"moor\"",
    "elevation = { x = 0.5, surface = \"all\" }",
    "elevation = { from = 0.5, to = 0.7, count = 2 }",
    "velocity = [0.5, 0.2]",
    "pressure = { from = [0.5, 0.1], to = [0.5, 0.2], count = 2 }",
    "flow = { from = [0.5, 0.1], to = [0.5, 0.2] }",
    "runup = \"paddle\"",
    "patch = { solid = \"paddle\", box = { min = [-0.1, 0.0], max = [0.1, 0.2] } }",
    "front = true",
    "energy = true",
    "budget = true",
];

/// The name of a column in the reference: with the unit of 3-D, without the place, and without kind or unit where the page combines names.
fn documented(table: &str, column: &str) -> String {
    let column = column.strip_suffix("_per_m").unwrap_or(column);
    let unit = column.rsplit('_').next().unwrap();
    let column = column.split_once("_at_").map_or(column.to_string(), |(name, _)| format!("{name}_{unit}"));
    match table {
        "energy" | "budget" => column.trim_end_matches("_J").to_string(),
        _ if table.ends_with("_balance") && column != "t_s" => {
            column.split_once('_').map_or(column.clone(), |(_, load)| load.to_string())
        }
        _ => column,
    }
}

/// The keys of a JSON value at every depth.
fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(entries) => {
            for (key, inner) in entries {
                found.insert(key.clone());
                keys(inner, found);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| keys(item, found)),
        _ => {}
    }
}

#[test]
fn every_file_key_column_and_quantity_of_a_run_is_in_the_output_reference() {
    let folder = TestFolder::new("reference-outputs");
    let probes: String = MEASURED.iter().map(|probe| format!("[[probe]]\n{probe}\nevery = 0.001\n")).collect();
    let text = SCENE.replace("until = 1.0", "until = 0.005").replace("WAVE", &format!("{REGULAR}, absorb = true"));
    fs::write(folder.join("scene.toml"), format!("{text}{PROBES}{probes}")).unwrap();
    pontoon(&["run", "scene.toml", "--out", "run", "--quiet"], &folder);
    let (page, mut names) = (page("outputs.md"), BTreeSet::new());
    let read = |file: &Path| fs::read_to_string(file).unwrap();

    for entry in fs::read_dir(folder.join("run")).unwrap().flatten() {
        let name = entry.file_name().into_string().unwrap();
        assert!(page.contains(&format!("`{name}")), "the file {name} is not in outputs.md");
    }
    for entry in ["series", "lists"].iter().flat_map(|name| fs::read_dir(folder.join("run").join(name)).unwrap()) {
        let file = entry.unwrap().path();
        let (table, text) = (file.file_stem().unwrap().to_str().unwrap(), read(&file));
        names.extend(text.lines().next().unwrap().split(',').map(|column| documented(table, column)));
    }
    let statistics = read(&folder.join("run/statistics.csv"));
    names.extend(statistics.lines().next().unwrap().split(',').map(String::from));
    names.extend(statistics.lines().skip(1).map(|line| line.split(',').nth(2).unwrap().to_string()));
    keys(&serde_json::from_str(&read(&folder.join("run/manifest.json"))).unwrap(), &mut names);
    let preflight = pontoon(&["inspect", "scene.toml", "--no-timing", "--json"], &folder);
    keys(&serde_json::from_str(&preflight).unwrap(), &mut names);

    assert!(names.len() > 150, "{} names were found", names.len());
    let known = code_names(&page);
    let missing: Vec<&String> = names.iter().filter(|name| !known.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "not in outputs.md: {missing:?}");
}

/// The subcommands in the help of the program.
fn subcommands() -> Vec<String> {
    let help = pontoon(&["--help"], Path::new(env!("CARGO_MANIFEST_DIR")));
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let first = lines.filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    let names = first.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(String::from).collect()
}

/// The long options in the help of a subcommand.
fn options(subcommand: &str) -> BTreeSet<String> {
    let help = pontoon(&[subcommand, "--help"], Path::new(env!("CARGO_MANIFEST_DIR")));
    let lines = help.split("\nExample").next().unwrap().lines().map(str::trim_start);
    let words = lines.filter(|line| line.starts_with('-')).flat_map(|line| line.split(' ').take(2));
    // A value that may be left out is behind the name, as in `--live[=<PORT>]`.
    let words = words.filter_map(|word| word.split('[').next());
    words.filter(|word| word.starts_with("--") && *word != "--help").map(String::from).collect()
}

#[test]
fn the_command_line_reference_has_every_subcommand_and_option_of_the_program_and_no_other() {
    let page = page("command-line.md");
    let listed: BTreeSet<&str> =
        code(&page).flat_map(str::split_whitespace).filter(|word| word.starts_with("--")).collect();
    let mut known = BTreeSet::from(["--help".to_string(), "--version".into()]);
    let subcommands = subcommands();
    assert!(subcommands.len() > 12, "{subcommands:?}");
    for subcommand in subcommands {
        let item = format!("\n- `{subcommand}");
        assert!(page.contains(&format!("{item}`")) || page.contains(&format!("{item} ")), "{subcommand} is missing");
        known.extend(options(&subcommand));
    }
    let missing: Vec<&String> = known.iter().filter(|option| !listed.contains(option.as_str())).collect();
    assert!(missing.is_empty(), "not in command-line.md: {missing:?}");
    for option in listed {
        assert!(known.contains(option), "{option} is not an option of any subcommand");
    }
}

#[test]
fn the_command_line_reference_has_every_error_code_and_no_other() {
    let page = page("command-line.md");
    let (_, codes) = page.split_once("## Error codes").expect("a list of error codes");
    let listed: Vec<&str> = codes.lines().filter_map(|line| line.strip_prefix("- `")?.split('`').next()).collect();
    let known: Vec<&str> = ErrorCode::ALL.iter().map(|code| code.as_str()).collect();
    assert_eq!(listed, known);
}
