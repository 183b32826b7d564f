//! The book: its scenes are run and its commands are typed, in the order in which a reader would.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Chapters that a reader follows with the program at hand.
const CHAPTERS: [&str; 5] = ["README.md", "docs/first-run.md", "docs/own-scene.md", "docs/waves.md", "docs/bodies.md"];

/// An empty folder of that name.
fn desk(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pontoon-book-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The blocks of a chapter that are fenced as `kind`.
fn blocks(chapter: &str, kind: &str) -> Vec<String> {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(chapter)).unwrap();
    let fence = format!("```{kind}\n");
    text.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_string()).collect()
}

fn pontoon(words: &[&str], folder: &Path) {
    let output = Command::new(env!("CARGO_BIN_EXE_pontoon")).args(words).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "pontoon {}: {}", words.join(" "), String::from_utf8_lossy(&output.stderr));
}

#[test]
fn every_scene_of_the_book_runs() {
    let folder = desk("scenes");
    let mut count = 0;
    for chapter in CHAPTERS {
        for scene in blocks(chapter, "toml").iter().filter(|block| block.starts_with("title")) {
            count += 1;
            let file = folder.join(format!("scene-{count}.toml"));
            fs::write(&file, scene).unwrap();
            let out = format!("run-{count}");
            pontoon(&["run", file.to_str().unwrap(), "--until", "0.02", "--out", &out, "--quiet"], &folder);
        }
    }
    assert!(count >= 3, "README and the chapters have a scene each, but {count} were found");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn every_command_of_the_book_does_what_it_says() {
    let mut count = 0;
    for chapter in &CHAPTERS[1..] {
        let folder = desk("commands");
        for scene in blocks(chapter, "toml").iter().filter(|block| block.starts_with("title")) {
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
