//! The folder of a run: where it is made, and the copy of the scene that it keeps.

use std::{
    fs,
    path::{Component, Path, PathBuf},
};

use crate::{
    error::{Error, ErrorKind, Result},
    output::{Manifest, checkpoint, manifest::RunStatus},
    run::statistics::{RAO_FILE, SPECTRA_FILE},
    scene::{Scene, files},
};

/// The kept scene, in the run's folder.
pub(crate) const SCENE: &str = "scene/scene.toml";

/// The report of a run that could not go on, in its folder.
pub(crate) const FAILURE: &str = "failure.json";

/// The scene file that `path` means: itself, or the `scene.toml` in it.
pub(crate) fn scene_file(path: &Path) -> PathBuf {
    if path.is_dir() { path.join("scene.toml") } else { path.to_owned() }
}

/// A short name for the scene in `file`: its own name, or that of its folder if it is `scene.toml`.
fn scene_name(file: &Path) -> String {
    let whole = fs::canonicalize(file).unwrap_or_else(|_| file.to_owned());
    let own = if whole.file_name().is_some_and(|n| n == "scene.toml") { whole.parent() } else { Some(whole.as_path()) };
    own.and_then(Path::file_stem).map_or_else(|| "run".into(), |n| n.to_string_lossy().into_owned())
}

/// Makes the folder of a run: `out`, which must be new or empty. Without `out`: the first free one of `runs/<scene>`,
/// `runs/<scene>-2`, …
///
/// # Errors
/// `Usage` if `out` is not empty; `File` if the folder cannot be made.
pub(crate) fn create_run_folder(file: &Path, out: Option<&Path>) -> Result<PathBuf> {
    let refused =
        |path: &Path, why: std::io::Error| Error::write(path, "made", &why).help("choose another folder with --out");
    if let Some(out) = out {
        fs::create_dir_all(out).map_err(|why| refused(out, why))?;
        if fs::read_dir(out).map_err(|why| Error::read(out, &why))?.next().is_some() {
            let help = match Manifest::read(out).map(|manifest| manifest.status) {
                Ok(RunStatus::Finished) => "it holds a finished run: choose another folder with --out".into(),
                Ok(_) => {
                    format!(
                        "it holds a run: continue it with `pontoon resume {}`, or choose another folder",
                        out.display()
                    )
                }
                Err(_) => "choose another folder; results are never written over other files".into(),
            };
            return Err(Error::new(ErrorKind::Usage, format!("the folder {} is not empty", out.display())).help(help));
        }
        return Ok(out.to_owned());
    }
    let runs = Path::new("runs");
    fs::create_dir_all(runs).map_err(|why| refused(runs, why))?;
    let name = scene_name(file);
    let mut number = 1;
    loop {
        let folder = runs.join(if number == 1 { name.clone() } else { format!("{name}-{number}") });
        match fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(why) if why.kind() == std::io::ErrorKind::AlreadyExists => number += 1,
            Err(why) => return Err(refused(&folder, why)),
        }
    }
}

/// Removes the failure report, the partial checkpoint, and the spectra and RAOs of an earlier end from the `folder` of a resumed
/// run. The resumed run may write none of these.
///
/// # Errors
/// `File` if one cannot be removed.
pub(crate) fn remove_end_files(folder: &Path) -> Result<()> {
    [FAILURE, checkpoint::PART, SPECTRA_FILE, RAO_FILE].iter().map(|name| folder.join(name)).try_for_each(|path| {
        match fs::remove_file(&path) {
            Err(why) if why.kind() != std::io::ErrorKind::NotFound => Err(Error::write(&path, "removed", &why)),
            _ => Ok(()),
        }
    })
}

/// Copies the scene in `file`, or its replacement `text`, into the run's `folder`. Also copies the files beside it that `words`,
/// the TOML of the effective scene, names. The run can then be resumed wherever its folder is moved.
///
/// # Errors
/// `File` if something cannot be read or written.
pub(crate) fn copy_scene(file: &Path, text: Option<&str>, words: &str, folder: &Path) -> Result<()> {
    let (from, to) = (file.parent().unwrap_or(Path::new("")), folder.join("scene"));
    let copy = |source: &Path, target: &Path| -> Result<()> {
        let parent = target.parent().unwrap_or(&to);
        fs::create_dir_all(parent).map_err(|why| Error::write(parent, "made", &why))?;
        fs::copy(source, target).map(|_| ()).map_err(|why| Error::write(target, "written", &why))
    };
    let target = folder.join(SCENE);
    match text {
        None => copy(file, &target)?,
        Some(text) => {
            fs::create_dir_all(&to).map_err(|why| Error::write(&to, "made", &why))?;
            fs::write(&target, text).map_err(|why| Error::write(&target, "written", &why))?;
        }
    }
    referenced_files(words)
        .iter()
        .filter(|name| from.join(name).is_file() && files::is_within(from, &from.join(name)))
        .try_for_each(|name| copy(&from.join(name), &to.join(name)))
}

/// All strings in the TOML `words`.
pub(super) fn strings(words: &str) -> Vec<String> {
    let mut strings = Vec::new();
    if let Ok(table) = words.parse::<toml::Table>() {
        table.values().for_each(|value| collect_strings(value, &mut strings));
    }
    strings
}

/// All strings in the TOML `words` that could name a file beside it.
pub(crate) fn referenced_files(words: &str) -> Vec<String> {
    let mut names = strings(words);
    let inside = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    names.retain(|name| !name.is_empty() && Path::new(name).components().all(inside));
    names
}

/// Names and hashes of the files in `folder` that a run of `scene` reads. References of checks are read after it.
pub(super) fn file_hashes(scene: &Scene, folder: &Path) -> Result<Vec<(String, u64)>> {
    let mut read = scene.clone();
    (read.title, read.check) = (None, Vec::new());
    let words = read.to_toml()?;
    let mut names = referenced_files(&words);
    names.sort();
    names.dedup();
    let hashed = |name: String| fs::read(folder.join(&name)).ok().map(|bytes| (name, checkpoint::fnv1a(&bytes)));
    Ok(names.into_iter().filter_map(hashed).collect())
}

/// All strings in a TOML value.
fn collect_strings(value: &toml::Value, found: &mut Vec<String>) {
    match value {
        toml::Value::String(word) => found.push(word.clone()),
        toml::Value::Array(items) => items.iter().for_each(|item| collect_strings(item, found)),
        toml::Value::Table(items) => items.values().for_each(|item| collect_strings(item, found)),
        _ => {}
    }
}

#[cfg(test)]
#[path = "../../tests/unit/run/run_folder.rs"]
mod tests;
