//! The documents against the program: their scenes and commands run, and their links and plots are right.
//! Their Rust programs are compiled and run by `cargo test` as documentation tests (src/lib.rs).

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Component, Path, PathBuf},
    process::Command,
};

use pontoon::scene::{Scene, bundled_scenes};

#[path = "../examples/choosing_plots.rs"]
#[allow(dead_code, reason = "its main function draws the plots")]
mod choosing_plots;

/// Pages whose `sh` blocks are executed and whose changes of keys apply to their own scene.
const EXECUTED: [&str; 4] = [
    "docs/tutorial/first-run.md",
    "docs/tutorial/own-scene.md",
    "docs/how-to/waves.md",
    "docs/how-to/bodies-and-joints.md",
];

/// The folder of the project.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The text of a file of the project.
fn read(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|why| panic!("{file}: {why}"))
}

/// An empty folder of this name.
fn empty_folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pontoon-documents-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The Markdown files in `folder` and its subfolders, sorted, as paths from the root of the project.
fn markdown_files(folder: &str) -> Vec<String> {
    let mut files = Vec::new();
    for entry in fs::read_dir(root().join(folder)).unwrap().flatten() {
        let path = format!("{folder}/{}", entry.file_name().into_string().unwrap());
        if entry.path().is_dir() {
            files.extend(markdown_files(&path));
        } else if path.ends_with(".md") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// The pages of `docs/`.
fn pages() -> Vec<String> {
    markdown_files("docs")
}

/// The pages of `docs/`, the README and the changelog.
fn documents() -> Vec<String> {
    ["README.md", "CHANGELOG.md"].map(String::from).into_iter().chain(pages()).collect()
}

/// The READMEs of the bundled scenes.
fn scene_readmes() -> Vec<String> {
    bundled_scenes().iter().map(|(name, ..)| format!("scenes/{name}/README.md")).collect()
}

/// The blocks of a page that are fenced as `kind`.
fn blocks(page: &str, kind: &str) -> Vec<String> {
    let text = read(page);
    let fence = format!("```{kind}\n");
    text.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().trim_start().to_string()).collect()
}

/// The complete scenes of a page. A block of further entries makes another scene of the one before it.
fn scenes(page: &str) -> Vec<String> {
    let mut scenes: Vec<String> = Vec::new();
    for block in blocks(page, "toml") {
        match scenes.last() {
            _ if block.starts_with("title") => scenes.push(block),
            Some(before) if block.starts_with("[[") && !block.starts_with("[[map]]") => {
                scenes.push(format!("{before}\n{block}"));
            }
            _ => {}
        }
    }
    scenes
}

/// The output of the program for these arguments.
fn pontoon(arguments: &[&str], folder: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pontoon")).args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "pontoon {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The arguments of a line as a shell splits it, without quotation marks and comments.
fn arguments(line: &str) -> Vec<String> {
    let (mut arguments, mut quote) = (vec![String::new()], None);
    for sign in line.split(" #").next().unwrap().chars() {
        match quote {
            Some(end) if sign == end => quote = None,
            None if sign == '\'' || sign == '"' => quote = Some(sign),
            None if sign.is_whitespace() => arguments.push(String::new()),
            _ => arguments.last_mut().unwrap().push(sign),
        }
    }
    arguments.retain(|argument| !argument.is_empty());
    arguments
}

/// The keys that the arguments of a command change, each with its first value.
fn overrides(arguments: &[String]) -> Vec<(String, String)> {
    let first = |values: &str| values.split(',').next().unwrap().to_string();
    let pair = |text: &str| text.split_once('=').map(|(key, value)| (key.to_string(), value.to_string())).unwrap();
    let known = arguments.windows(2).filter_map(|two| match two[0].as_str() {
        "--set" => Some(pair(&two[1])),
        "--vary" => Some(pair(&two[1])).map(|(key, values)| (key, first(&values))),
        "--dp" | "--until" => Some((two[0][2..].to_string(), first(&two[1]))),
        _ => None,
    });
    known.collect()
}

/// A part of a page: a line of a shell, code between back-quotes, or a block of TOML.
enum Part {
    ShellLine(String),
    Code(String),
    Toml(String),
}

/// The parts of a page in their order.
fn parts(page: &str) -> Vec<Part> {
    let text = read(page);
    let split = |(i, part): (usize, &str)| -> Vec<Part> {
        match (i % 2, part.split_once('\n')) {
            (0, _) => part.split('`').skip(1).step_by(2).map(|code| Part::Code(code.to_string())).collect(),
            (_, Some(("sh" | "console", block))) => {
                block.replace("\\\n", " ").lines().map(|line| Part::ShellLine(line.trim().to_string())).collect()
            }
            (_, Some(("toml", block))) => vec![Part::Toml(block.to_string())],
            _ => vec![],
        }
    };
    text.split("```").enumerate().flat_map(split).collect()
}

#[test]
fn every_complete_scene_of_a_document_and_of_a_measurement_runs() {
    let folder = empty_folder("scenes");
    let mut count = 0;
    let files = fs::read_dir(root().join("docs/measurements")).unwrap().flatten().map(|entry| entry.path());
    let measured = files.filter(|file| file.extension().is_some_and(|end| end == "toml"));
    let measured = measured.map(|file| fs::read_to_string(file).unwrap());
    for scene in documents().iter().flat_map(|page| scenes(page)).chain(measured) {
        count += 1;
        let file = folder.join(format!("scene-{count}.toml"));
        fs::write(&file, scene).unwrap();
        let out = format!("run-{count}");
        pontoon(&["run", file.to_str().unwrap(), "--until", "0.02", "--out", &out, "--quiet"], &folder);
    }
    assert!(count >= 7, "{count} scenes were found");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_command_in_an_sh_block_runs() {
    let mut count = 0;
    for page in EXECUTED {
        let folder = empty_folder("commands");
        for scene in scenes(page) {
            fs::write(folder.join("scene.toml"), scene).unwrap();
        }
        for line in blocks(page, "sh").iter().flat_map(|block| block.lines()) {
            let arguments: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(arguments[0], "pontoon", "{page}: {line}");
            pontoon(&arguments[1..], &folder);
            count += 1;
        }
        fs::remove_dir_all(folder).unwrap();
    }
    assert!(count >= 10, "{count} commands were found");
}

/// The subcommands of the program with the tokens of their help, and the cases of `validate` and `stress`.
#[derive(Default)]
struct Program {
    help: BTreeMap<String, BTreeSet<String>>,
    cases: BTreeMap<String, BTreeSet<String>>,
}

impl Program {
    /// Checks options, cases, scene and keys of a command without running it.
    fn check(&mut self, page: &str, arguments: &[String]) {
        let line = arguments.join(" ");
        let tokens = |text: String, separators: &[char]| -> BTreeSet<String> {
            text.split(|c: char| c.is_whitespace() || separators.contains(&c)).map(String::from).collect()
        };
        let command = arguments[1].as_str();
        let read_help = || tokens(pontoon(&[command, "--help"], root()), &[',', '[', ']', '<', '>', '|', '=']);
        let help = self.help.entry(command.into()).or_insert_with(read_help);
        for option in arguments[2..].iter().filter(|argument| argument.starts_with("--")) {
            assert!(help.contains(option.as_str()), "{page}: {line}: {command} has no option {option}");
        }
        let names: Vec<&String> = arguments[2..].iter().take_while(|argument| !argument.starts_with('-')).collect();
        if matches!(command, "validate" | "stress") {
            let read_list = || tokens(pontoon(&[command, "--list"], root()), &[',', ':']);
            let cases = self.cases.entry(command.into()).or_insert_with(read_list);
            for case in names.iter().filter(|case| **case != "…") {
                assert!(cases.contains(case.as_str()), "{page}: {line}: there is no case {case}");
            }
        }
        let Some(scene) = names.first().filter(|_| matches!(command, "run" | "inspect" | "study")) else { return };
        let name = scene.trim_start_matches("scenes/");
        if !name.contains(|c: char| c.is_uppercase() || c == '/' || c == '.') {
            let known = bundled_scenes().iter().any(|(known, ..)| *known == name);
            assert!(known, "{page}: {line}: there is no scene {name}");
            let scene = Scene::read(&root().join("scenes").join(name).join("scene.toml"), &overrides(arguments));
            let error = scene.and_then(|scene| scene.plan()).err();
            assert!(error.is_none(), "{page}: {line}: {}", error.unwrap());
        }
    }
}

#[test]
fn every_command_in_a_document_is_valid() {
    let (mut program, mut count) = (Program::default(), 0);
    for page in documents().into_iter().chain(scene_readmes()) {
        for part in parts(&page) {
            let (Part::ShellLine(line) | Part::Code(line)) = part else { continue };
            let arguments = arguments(&line.replace("DIR…", "DIR"));
            if arguments.len() > 1 && arguments[0] == "pontoon" {
                program.check(&page, &arguments);
                count += 1;
            }
        }
    }
    assert!(count > 80, "{count} commands were found");
}

#[test]
fn every_change_of_keys_in_a_document_is_valid_for_its_scene() {
    let mut count = 0;
    let mut check = |page: &str, arguments: &[String], scene: pontoon::Result<Scene>| {
        let error = scene.and_then(|scene| scene.plan()).err();
        assert!(error.is_none(), "{page}: {}: {}", arguments.join(" "), error.unwrap());
        count += 1;
    };
    let is_change = |code: &str| ["--set ", "--dp "].iter().any(|option| code.starts_with(option));
    for page in scene_readmes() {
        let file = root().join(page.replace("README.md", "scene.toml"));
        for part in parts(&page) {
            let Part::Code(code) = part else { continue };
            if is_change(&code) {
                let arguments = arguments(&code);
                check(&page, &arguments, Scene::read(&file, &overrides(&arguments)));
            }
        }
    }
    for page in ["README.md"].into_iter().chain(EXECUTED) {
        let mut scene: Option<String> = None;
        for part in parts(page) {
            match (part, &mut scene) {
                (Part::Toml(block), before) if block.starts_with("title") => *before = Some(block),
                (Part::Toml(block), Some(before)) if block.starts_with("[[") => *before += &block,
                (Part::Code(code), Some(text)) if is_change(&code) => {
                    let arguments = arguments(&code);
                    check(page, &arguments, Scene::parse(text, Path::new(""), &overrides(&arguments)));
                }
                _ => {}
            }
        }
    }
    assert!(count > 20, "{count} changes were found");
}

#[test]
fn every_stress_map_of_a_page_runs() {
    let folder = empty_folder("maps");
    let is_map = |block: &String| block.starts_with("[[map]]");
    let maps: Vec<String> = pages().iter().flat_map(|page| blocks(page, "toml")).filter(is_map).collect();
    assert!(!maps.is_empty(), "docs/explanation/stability.md shows a map");
    for (i, map) in maps.iter().enumerate() {
        let (file, out) = (format!("maps-{i}.toml"), format!("stress-{i}"));
        fs::write(folder.join(&file), map).unwrap();
        pontoon(&["stress", "--maps", &file, "--out", &out], &folder);
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_page_with_a_rust_program_is_a_documentation_test() {
    let library = read("src/lib.rs");
    let programs: Vec<String> = pages().into_iter().filter(|page| read(page).contains("```rust")).collect();
    assert!(!programs.is_empty(), "docs/how-to/use-from-rust.md has programs");
    for page in programs {
        assert!(library.contains(&format!("include_str!(\"../{page}\")")), "src/lib.rs does not include {page}");
    }
}

#[test]
fn every_plot_equals_its_table_and_its_values_are_in_their_source() {
    for plot in choosing_plots::Sheet::read().unwrap().plot {
        let (file, source) = (format!("docs/plots/{}", plot.file), read(&format!("docs/{}", plot.source)));
        let page = read(&format!("docs/{}", plot.page));
        assert!(page.contains(&format!("plots/{})", plot.file)), "docs/{} does not show {file}", plot.page);
        assert!(
            read(&file) == plot.svg(),
            "{file} differs from its table: cargo run --release --example choosing_plots"
        );
        for line in &plot.lines {
            assert!(page.contains(&line.name), "docs/{} does not name the line {:?} of {file}", plot.page, line.name);
            // Zeros at the end of a value may differ between table and source.
            for (x, y) in &line.points {
                assert!(source.contains(&y.abs().to_string()), "{file}: {y} at {x} is not in docs/{}", plot.source);
            }
        }
    }
}

/// The text of a page without its blocks of code.
fn without_blocks(page: &str) -> String {
    read(page).split("```").step_by(2).collect::<Vec<_>>().join("\n")
}

/// The anchors of the headings of a page, as GitHub and mdBook form them.
fn anchors(page: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    for line in without_blocks(page).lines().filter(|line| line.starts_with('#')) {
        let heading = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        let is_kept = |c: &char| c.is_alphabetic() || c.is_ascii_digit() || ['-', '_'].contains(c);
        let anchor: String = heading.chars().filter(is_kept).collect();
        let numbered = (1..).map(|i| format!("{anchor}-{i}"));
        let anchor = std::iter::once(anchor.clone()).chain(numbered).find(|a| !anchors.contains(a)).unwrap();
        anchors.insert(anchor);
    }
    anchors
}

/// The relative links and images of a page: file, from the root of the project, and anchor.
fn links(page: &str) -> Vec<(String, Option<String>)> {
    let prose: String = without_blocks(page).split('`').step_by(2).collect();
    let targets = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let relative = targets.filter(|target| !target.contains("://") && !target.starts_with("mailto:"));
    let resolve = |target: &str| {
        let (file, anchor) = target.split_once('#').map_or((target, None), |(file, a)| (file, Some(a.to_string())));
        if file.is_empty() {
            return (page.to_string(), anchor);
        }
        let mut path = PathBuf::new();
        for part in Path::new(page).parent().unwrap().join(file).components() {
            match part {
                Component::ParentDir => assert!(path.pop(), "{page}: {target} leads out of the project"),
                part => path.push(part),
            }
        }
        (path.to_str().unwrap().replace('\\', "/"), anchor)
    };
    relative.map(resolve).collect()
}

#[test]
fn every_relative_link_leads_to_a_file_and_a_heading() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for page in documents().into_iter().chain(scene_readmes()) {
        for (file, anchor) in links(&page) {
            count += 1;
            if !root().join(&file).exists() {
                wrong.push(format!("{page}: there is no {file}"));
            } else if let Some(anchor) = anchor.filter(|anchor| !anchors(&file).contains(anchor)) {
                wrong.push(format!("{page}: {file} has no heading #{anchor}"));
            }
            // mdBook cannot follow links out of docs/.
            if page.starts_with("docs/") && !file.starts_with("docs/") {
                wrong.push(format!("{page}: {file} is outside docs/"));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(count > 100, "{count} links were found");
}

#[test]
fn the_summary_lists_every_page() {
    let listed: BTreeSet<String> = links("docs/SUMMARY.md").into_iter().map(|(file, _)| file).collect();
    let missing: Vec<String> =
        pages().into_iter().filter(|page| page != "docs/SUMMARY.md" && !listed.contains(page)).collect();
    assert!(missing.is_empty(), "docs/SUMMARY.md does not list {missing:?}");
}

#[test]
fn the_list_of_the_validation_equals_its_results() {
    let results: toml::Table = toml::from_str(&read("docs/explanation/validation/results.toml")).unwrap();
    let (mut list, mut previous) = (String::new(), String::new());
    for result in results["result"].as_array().unwrap() {
        let text = |key: &str| result[key].as_str().unwrap();
        let case = format!("- `{}`, {}", text("case"), text("reference"));
        let error =
            if result["pass"].as_bool().unwrap() { text("error").into() } else { format!("**{}**", text("error")) };
        let bound = if text("bound") == "–" { String::new() } else { format!(" ({})", text("bound")) };
        // A case has its figures in one item.
        let before = if case == previous { ";".into() } else { format!("\n{case}:") };
        list += &format!("{before} {}: {error}{bound}", text("quantity"));
        previous = case;
    }
    let page = read("docs/explanation/validation.md");
    let shown =
        page.split("<!-- list: results.toml -->\n").nth(1).and_then(|rest| rest.split("<!-- end of list -->").next());
    assert_eq!(shown.unwrap().trim(), list.trim(), "docs/explanation/validation.md");
}
