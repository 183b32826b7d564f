//! The book: its scenes are run and its commands are typed, in the order in which a reader would. Its programs are compiled and
//! run by `cargo test` as tests of the documentation (src/lib.rs).

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

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

fn pontoon(words: &[&str], folder: &Path) {
    let output = Command::new(env!("CARGO_BIN_EXE_pontoon")).args(words).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "pontoon {}: {}", words.join(" "), String::from_utf8_lossy(&output.stderr));
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
    let page = read("docs/choosing.md");
    for plot in choosing_plots::Sheet::read().unwrap().plot {
        let (file, source) = (format!("plots/{}", plot.file), read(&format!("docs/{}", plot.source)));
        assert!(page.contains(&format!("({file})")), "docs/choosing.md does not show {file}");
        assert!(
            read(&format!("docs/{file}")) == plot.svg().unwrap(),
            "{file} is old: cargo run --release --example choosing_plots"
        );
        for line in &plot.lines {
            assert!(page.contains(&line.name), "docs/choosing.md does not say which line of {file} is {:?}", line.name);
            // A value is written in its source as it is here, but for zeros at its end.
            for (x, y) in &line.points {
                assert!(source.contains(&y.abs().to_string()), "{file}: {y} at {x} is not in docs/{}", plot.source);
            }
        }
    }
}
