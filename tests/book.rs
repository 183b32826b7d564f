//! The book: its scenes are run and its commands are typed, in the order in which a reader would. Its programs are compiled and
//! run by `cargo test` as tests of the documentation (src/lib.rs).

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use pontoon::scene::{Scene, bundled_scenes};

#[path = "../examples/choosing_plots.rs"]
#[allow(dead_code, reason = "its main is for who draws the plots anew")]
mod choosing_plots;

/// Chapters that a reader follows with the program at hand.
const CHAPTERS: [&str; 5] = ["README.md", "docs/first-run.md", "docs/own-scene.md", "docs/waves.md", "docs/bodies.md"];

/// Further pages with whole scenes.
const PAGES: [&str; 2] = ["docs/validation.md", "docs/stability.md"];

/// An empty folder of that name.
fn desk(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pontoon-book-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The blocks of a chapter that are fenced as `kind`.
fn blocks(chapter: &str, kind: &str) -> Vec<String> {
    let text = read(chapter);
    let fence = format!("```{kind}\n");
    text.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().trim_start().to_string()).collect()
}

/// The whole scenes of a chapter; words that a reader is told to append make another of the scene before them.
fn scenes(chapter: &str) -> Vec<String> {
    let mut scenes: Vec<String> = Vec::new();
    for block in blocks(chapter, "toml") {
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

/// The text of a file of the source.
fn read(file: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

/// The pages of docs/, from the source's folder.
fn pages() -> Vec<String> {
    let folder = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")).unwrap();
    let names = folder.flatten().map(|entry| entry.file_name().into_string().unwrap());
    names.filter(|name| name.ends_with(".md")).map(|name| format!("docs/{name}")).collect()
}

/// What the program prints for these words.
fn pontoon(words: &[&str], folder: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pontoon")).args(words).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "pontoon {}: {}", words.join(" "), String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// A line as a shell takes it apart: what is quoted is one word, and a remark is none.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut quote) = (vec![String::new()], None);
    for sign in line.split(" #").next().unwrap().chars() {
        match quote {
            Some(end) if sign == end => quote = None,
            None if sign == '\'' || sign == '"' => quote = Some(sign),
            None if sign.is_whitespace() => words.push(String::new()),
            _ => words.last_mut().unwrap().push(sign),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The keys that the arguments of a command change; of several values of one the first.
fn sets(words: &[String]) -> Vec<(String, String)> {
    let first = |values: &str| values.split(',').next().unwrap().to_string();
    let pair = |text: &str| text.split_once('=').map(|(key, value)| (key.to_string(), value.to_string())).unwrap();
    let known = words.windows(2).filter_map(|two| match two[0].as_str() {
        "--set" => Some(pair(&two[1])),
        "--vary" => Some(pair(&two[1])).map(|(key, values)| (key, first(&values))),
        "--dp" | "--until" => Some((two[0][2..].to_string(), first(&two[1]))),
        _ => None,
    });
    known.collect()
}

/// A page in pieces: a line of a shell, what stands in back-quotes, a block of TOML.
enum Piece {
    Line(String),
    Code(String),
    Toml(String),
}

/// The pieces of a page, in their order.
fn pieces(page: &str) -> Vec<Piece> {
    let text = read(page);
    let of = |(i, part): (usize, &str)| -> Vec<Piece> {
        match (i % 2, part.split_once('\n')) {
            (0, _) => part.split('`').skip(1).step_by(2).map(|code| Piece::Code(code.to_string())).collect(),
            (_, Some(("sh" | "console", block))) => {
                block.replace("\\\n", " ").lines().map(|line| Piece::Line(line.trim().to_string())).collect()
            }
            (_, Some(("toml", block))) => vec![Piece::Toml(block.to_string())],
            _ => vec![],
        }
    };
    text.split("```").enumerate().flat_map(of).collect()
}

#[test]
fn every_scene_of_the_book_runs() {
    let folder = desk("scenes");
    let mut count = 0;
    for chapter in CHAPTERS.into_iter().chain(PAGES) {
        for scene in scenes(chapter) {
            count += 1;
            let file = folder.join(format!("scene-{count}.toml"));
            fs::write(&file, scene).unwrap();
            let out = format!("run-{count}");
            pontoon(&["run", file.to_str().unwrap(), "--until", "0.02", "--out", &out, "--quiet"], &folder);
        }
    }
    assert!(count >= 8, "README, the chapters and the pages have a scene or two each, but {count} were found");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_command_of_the_book_does_what_it_says() {
    let mut count = 0;
    for chapter in &CHAPTERS[1..] {
        let folder = desk("commands");
        for scene in scenes(chapter) {
            fs::write(folder.join("scene.toml"), scene).unwrap();
        }
        for line in blocks(chapter, "sh").iter().flat_map(|block| block.lines()) {
            let words: Vec<&str> = line.split_whitespace().collect();
            assert_eq!(words[0], "pontoon", "{chapter}: {line}");
            pontoon(&words[1..], &folder);
            count += 1;
        }
        fs::remove_dir_all(folder).unwrap();
    }
    assert!(count >= 5, "{count} commands were found");
}

/// What the program knows: its subcommands with the words of their help, and the cases of `validate` and `stress`.
#[derive(Default)]
struct Known {
    help: BTreeMap<String, BTreeSet<String>>,
    cases: BTreeMap<String, BTreeSet<String>>,
}

impl Known {
    /// Holds a command of a page to what there is, without running it.
    fn check(&mut self, page: &str, words: &[String]) {
        let (line, here) = (words.join(" "), Path::new(env!("CARGO_MANIFEST_DIR")));
        let tokens = |text: String, apart: &[char]| -> BTreeSet<String> {
            text.split(|c: char| c.is_whitespace() || apart.contains(&c)).map(String::from).collect()
        };
        let command = words[1].as_str();
        let said = || tokens(pontoon(&[command, "--help"], here), &[',', '[', ']', '<', '>', '|', '=']);
        let help = self.help.entry(command.into()).or_insert_with(said);
        for flag in words[2..].iter().filter(|word| word.starts_with("--")) {
            assert!(help.contains(flag.as_str()), "{page}: {line}: {flag} is none of {command}");
        }
        let plain: Vec<&String> = words[2..].iter().take_while(|word| !word.starts_with('-')).collect();
        if matches!(command, "validate" | "stress") {
            let said = || tokens(pontoon(&[command, "--list"], here), &[',', ':']);
            let cases = self.cases.entry(command.into()).or_insert_with(said);
            for case in plain.iter().filter(|case| **case != "…") {
                assert!(cases.contains(case.as_str()), "{page}: {line}: there is no {case}");
            }
        }
        let Some(scene) = plain.first().filter(|_| matches!(command, "run" | "inspect" | "study")) else { return };
        let name = scene.trim_start_matches("scenes/");
        if !name.contains(|c: char| c.is_uppercase() || c == '/' || c == '.') {
            assert!(bundled_scenes().iter().any(|(known, ..)| *known == name), "{page}: {line}: there is no {name}");
            let scene = Scene::read(&here.join("scenes").join(name).join("scene.toml"), &sets(words));
            let why = scene.and_then(|scene| scene.plan()).err();
            assert!(why.is_none(), "{page}: {line}: {}", why.unwrap());
        }
    }
}

#[test]
fn every_command_that_a_page_names_is_one_that_the_program_knows() {
    let (mut known, mut count) = (Known::default(), 0);
    for page in ["README.md".to_string(), "CHANGELOG.md".into()].into_iter().chain(pages()) {
        for piece in pieces(&page) {
            let (Piece::Line(line) | Piece::Code(line)) = piece else { continue };
            let words = words(&line.replace("DIR…", "DIR"));
            if words.len() > 1 && words[0] == "pontoon" {
                known.check(&page, &words);
                count += 1;
            }
        }
    }
    assert!(count > 100, "{count} commands were found");
}

#[test]
fn every_change_that_a_page_shows_of_its_scene_can_be_made() {
    let mut count = 0;
    let mut made = |page: &str, words: &[String], scene: pontoon::Result<Scene>| {
        let why = scene.and_then(|scene| scene.plan()).err();
        assert!(why.is_none(), "{page}: {}: {}", words.join(" "), why.unwrap());
        count += 1;
    };
    let changes = |code: &str| ["--set ", "--dp "].iter().any(|word| code.starts_with(word));
    for (name, ..) in bundled_scenes() {
        let page = format!("scenes/{name}/README.md");
        for piece in pieces(&page) {
            let Piece::Code(code) = piece else { continue };
            if changes(&code) {
                let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}/scene.toml"));
                let words = words(&code);
                made(&page, &words, Scene::read(&file, &sets(&words)));
            }
        }
    }
    for page in CHAPTERS {
        let mut scene: Option<String> = None;
        for piece in pieces(page) {
            match (piece, &mut scene) {
                (Piece::Toml(block), before) if block.starts_with("title") => *before = Some(block),
                (Piece::Toml(block), Some(before)) if block.starts_with("[[") => *before += &block,
                (Piece::Code(code), Some(text)) if changes(&code) => {
                    let words = words(&code);
                    made(page, &words, Scene::parse(text, Path::new(""), &sets(&words)));
                }
                _ => {}
            }
        }
    }
    assert!(count > 20, "{count} changes were found");
}

#[test]
fn every_map_of_the_book_runs() {
    let folder = desk("maps");
    let maps: Vec<String> =
        blocks("docs/stability.md", "toml").into_iter().filter(|block| block.starts_with("[[map]]")).collect();
    assert!(!maps.is_empty(), "docs/stability.md shows how a map is written");
    for (i, map) in maps.iter().enumerate() {
        let (file, out) = (format!("maps-{i}.toml"), format!("stress-{i}"));
        fs::write(folder.join(&file), map).unwrap();
        pontoon(&["stress", "--maps", &file, "--out", &out], &folder);
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_program_of_the_book_is_compiled_and_run() {
    // `cargo test` does it with the pages that the library names, so no page with a program may be missing there.
    let library = read("src/lib.rs");
    let programs: Vec<String> = pages().into_iter().filter(|page| read(page).contains("```rust")).collect();
    assert!(!programs.is_empty(), "docs/coupling.md has programs");
    for page in programs {
        assert!(library.contains(&format!("include_str!(\"../{page}\")")), "{page} is not named in src/lib.rs");
    }
}

#[test]
fn the_plots_of_choosing_are_those_of_their_table_and_its_figures_are_measured_ones() {
    for plot in choosing_plots::Sheet::read().unwrap().plot {
        let (file, source) = (format!("plots/{}", plot.file), read(&format!("docs/{}", plot.source)));
        let page = read(&format!("docs/{}", plot.page));
        assert!(page.contains(&format!("({file})")), "docs/{} does not show {file}", plot.page);
        assert!(
            read(&format!("docs/{file}")) == plot.svg().unwrap(),
            "{file} is old: cargo run --release --example choosing_plots"
        );
        for line in &plot.lines {
            assert!(
                page.contains(&line.name),
                "docs/{} does not say which line of {file} is {:?}",
                plot.page,
                line.name
            );
            // A value is written in its source as it is here, but for zeros at its end.
            for (x, y) in &line.points {
                assert!(source.contains(&y.abs().to_string()), "{file}: {y} at {x} is not in docs/{}", plot.source);
            }
        }
    }
}
