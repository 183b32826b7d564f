//! Files beside a scene: their paths, and tables.

use std::path::{Component, Path, PathBuf};

use crate::{
    error::{Error, ErrorCode, Result, suggestion},
    math::table::TableReader,
};

/// Size of the largest table, B.
const MOST_BYTES: u64 = 256 << 20;

/// Returns the path of the file `name` beside the scene in `folder`.
///
/// # Errors
/// `Scene` if the name, or a link, leads out of the folder, or no file is there.
pub fn path_beside(folder: &Path, name: &str) -> Result<PathBuf> {
    let inside = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    let path = Path::new(name);
    if name.is_empty() || name.contains('\\') || !path.components().all(inside) {
        return Err(Error::scene(format!("\"{name}\" leads out of the scene's folder"))
            .help("put the file beside scene.toml and give its name alone"));
    }
    let full = folder.join(path);
    if !is_within(folder, &full) {
        return Err(Error::scene(format!("\"{name}\" is a link that leads out of the scene's folder"))
            .help("copy the file itself there"));
    }
    if !full.is_file() && full.exists() {
        return Err(Error::scene(format!("\"{name}\" beside the scene is no file")).help("it has to be one, no folder"));
    }
    if !full.is_file() {
        let others = neighbours(folder, path);
        let guess = suggestion(name, others.iter().map(String::as_str));
        return Err(Error::scene(format!("there is no file \"{name}\" beside the scene{guess}"))
            .with_code(ErrorCode::FileNotFound)
            .help("files that a scene names are looked for in the folder of the scene"));
    }
    Ok(full)
}

/// Opens the table `name` beside the scene in `folder`.
///
/// # Errors
/// The errors of [`path_beside`]; `Scene` if the table is too large, `File` if it cannot be read.
pub fn open_table(folder: &Path, name: &str) -> Result<TableReader> {
    let path = path_beside(folder, name)?;
    if std::fs::metadata(&path).is_ok_and(|file| file.len() > MOST_BYTES) {
        return Err(Error::scene(format!("{} has more than {} MiB", path.display(), MOST_BYTES >> 20))
            .help("keep the columns and the times that the scene needs"));
    }
    TableReader::open(&path)
}

/// Returns the error of a table with the line of the table in the message, because the location of the error is a key
/// of the scene.
pub fn with_line_in_message(mut error: Error) -> Error {
    if let Some(place) = error.location.take()
        && let Some((line, _)) = place.line_column
    {
        let column = if place.key.is_empty() { String::new() } else { format!(", column \"{}\"", place.key) };
        error.message += &format!(" (line {line} of {}{column})", place.file);
    }
    error
}

/// Returns whether the file at `full` lies in `folder` after resolving links, or true if there is no such file.
pub fn is_within(folder: &Path, full: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (folder.canonicalize(), full.canonicalize()) {
        (Ok(folder), Ok(full)) => full.starts_with(folder),
        _ => true,
    }
}

/// Returns the names of the files in `folder` with the extension of `path`.
fn neighbours(folder: &Path, path: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let alike = entries.filter(|e| e.path().extension() == path.extension());
    let mut names: Vec<String> = alike.filter_map(|e| e.file_name().into_string().ok()).collect();
    names.sort();
    names
}
