//! Tables beside a scene: CSV with a header row; lines that begin with `#` are comments.

use std::path::{Component, Path, PathBuf};

use crate::{
    error::{Error, ErrorCode, Result, nearest_name},
    math::time_series::TimeSeries,
};

/// Size of the largest table, B.
const MOST_BYTES: u64 = 256 << 20;

/// The file `name` beside the scene in `folder`.
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
        let guess = nearest_name(name, others.iter().map(String::as_str));
        let guess = guess.map_or(String::new(), |n| format!("; did you mean \"{n}\"?"));
        return Err(Error::scene(format!("there is no file \"{name}\" beside the scene{guess}"))
            .with_code(ErrorCode::FileNotFound)
            .help("files that a scene names are looked for in the folder of the scene"));
    }
    Ok(full)
}

/// Whether the file at `full`, links followed, lies in `folder`; true if there is no such file.
pub fn is_within(folder: &Path, full: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (folder.canonicalize(), full.canonicalize()) {
        (Ok(folder), Ok(full)) => full.starts_with(folder),
        _ => true,
    }
}

/// Names of the files in `folder` with the extension of `path`.
fn neighbours(folder: &Path, path: &Path) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let alike = entries.filter(|e| e.path().extension() == path.extension());
    let mut names: Vec<String> = alike.filter_map(|e| e.file_name().into_string().ok()).collect();
    names.sort();
    names
}

/// The names of the columns of the table at `path`.
///
/// # Errors
/// `File` if it cannot be read; `Scene` if it is too large.
pub fn read_header(path: &Path) -> Result<Vec<String>> {
    let mut reader = reader(path)?;
    let header = reader.headers().map_err(|e| Error::table(path, &e))?;
    Ok(header.iter().map(String::from).collect())
}

fn reader(path: &Path) -> Result<csv::Reader<std::fs::File>> {
    if std::fs::metadata(path).is_ok_and(|file| file.len() > MOST_BYTES) {
        return Err(Error::scene(format!("{} has more than {} MiB", path.display(), MOST_BYTES >> 20))
            .help("keep the columns and the times that the scene needs"));
    }
    let mut builder = csv::ReaderBuilder::new();
    builder.comment(Some(b'#')).trim(csv::Trim::All).from_path(path).map_err(|e| Error::table(path, &e))
}

/// The columns `names` of the table at `path`, one list each; rows with a blank cell among
/// them are skipped.
///
/// # Errors
/// `File` if it cannot be read; `Scene` if it is too large, a column is missing or a cell is not a finite number.
pub fn read_columns(path: &Path, names: &[&str]) -> Result<Vec<Vec<f64>>> {
    let mut reader = reader(path)?;
    let file = path.display().to_string();
    let header = reader.headers().map_err(|e| Error::table(path, &e))?.clone();
    let number = |name: &&str| {
        header.iter().position(|column| column == *name).ok_or_else(|| {
            let guess = nearest_name(name, header.iter());
            let guess = guess.map_or(String::new(), |n| format!("; did you mean \"{n}\"?"));
            let known: Vec<&str> = header.iter().collect();
            Error::scene(format!("{file} has no column \"{name}\"{guess}"))
                .help(format!("its columns: {}", known.join(", ")))
        })
    };
    let numbers: Vec<usize> = names.iter().map(number).collect::<Result<_>>()?;
    let mut columns = vec![Vec::new(); names.len()];
    for record in reader.records() {
        let record = record.map_err(|e| Error::table(path, &e))?;
        let cells: Vec<&str> = numbers.iter().map(|&i| record.get(i).unwrap_or("")).collect();
        if cells.iter().any(|cell| cell.is_empty()) {
            continue;
        }
        for (column, cell) in columns.iter_mut().zip(cells) {
            let x = cell.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
                let line = record.position().map_or(0, csv::Position::line);
                Error::scene(format!("\"{cell}\" in line {line} of {file} is not a number"))
            })?;
            column.push(x);
        }
    }
    Ok(columns)
}

/// The series of `column` over `time` of the table at `path`.
///
/// # Errors
/// As `read_columns`, and as [`TimeSeries::new`].
pub fn read_series(path: &Path, time: &str, column: &str) -> Result<TimeSeries> {
    let mut both = read_columns(path, &[time, column])?;
    let x = both.pop().unwrap_or_default();
    let t = both.pop().unwrap_or_default();
    TimeSeries::new(t, x).map_err(|e| Error::scene(format!("{}, {column}: {}", path.display(), e.message)))
}
