//! Lines and outlines of shapes: points, a table of points, or a drawing.

use super::shape::vector;
use crate::{
    error::{Error, Result},
    math::{
        Bounds, Vector,
        table::{self, ColumnName},
    },
    scene::{
        context::{Context, last_part},
        files, record,
        svg::{self, DrawingOptions},
        untagged::PolylineConfig,
    },
};

/// Largest distance of the straight segments from the curves of a drawing, dp.
const CURVE_TOLERANCE: f64 = 0.01;

/// Refuses a line that gives neither points nor a file, or both.
pub(super) fn verify_line(ctx: &Context, key: &str, config: &PolylineConfig) -> Result<()> {
    ctx.require_positive(&format!("{key}.thickness"), config.thickness)?;
    match (&config.points, &config.file) {
        (Some(points), None) => points.iter().enumerate().try_for_each(|(i, p)| {
            // A list stands at the key itself or, in a table, at its `points`.
            let in_table = format!("{key}.points.{i}");
            let key = if ctx.is_written(&in_table) { in_table } else { format!("{key}.{i}") };
            ctx.require_dimension_of(&key, &format!("point {} of {}", i + 1, points.len()), p)
        }),
        (None, Some(_)) => Ok(()),
        _ => Err(ctx.error_at(key, format!("a {} has either points or a file of points", last_part(key)))),
    }
}

/// Refuses an outline that gives neither points nor a file, or both, or points of another dimension than 2.
pub(super) fn verify_outline(ctx: &Context, key: &str, config: &PolylineConfig) -> Result<()> {
    let flat = Context { dimension: 2, ..ctx.clone() };
    verify_line(&flat, key, config)?;
    verify_drawing(ctx, key, config)
}

/// Refuses keys of a drawing where there is none.
pub(super) fn verify_drawing(ctx: &Context, key: &str, config: &PolylineConfig) -> Result<()> {
    ctx.require_positive(&format!("{key}.scale"), config.scale)?;
    let words_of_one =
        [("id", config.id.is_some()), ("scale", config.scale.is_some()), ("unit", config.unit.is_some())];
    match words_of_one.iter().find(|(_, given)| *given && !config.is_drawing()) {
        Some((word, _)) => {
            let help = format!("remove  {word};  points and tables are in metres, and a table is one outline");
            Err(ctx.error_with_help(&format!("{key}.{word}"), format!("{word} belongs to a drawing (.svg)"), help))
        }
        None => Ok(()),
    }
}

/// The points of a line or outline, m; opens the file that it names.
pub(super) fn outline_points<const D: usize>(ctx: &Context, config: &PolylineConfig) -> Result<Vec<Vector<D>>> {
    if let Some(points) = &config.points {
        return Ok(points.iter().map(|p| vector(p)).collect());
    }
    read_points(ctx, config).map_err(|e| e.in_part("file"))
}

/// The points of the file of a line or outline, m.
fn read_points<const D: usize>(ctx: &Context, config: &PolylineConfig) -> Result<Vec<Vector<D>>> {
    let file = config.file.as_deref().unwrap_or("");
    if config.is_drawing() {
        let path = files::path_beside(ctx.folder(), file)?;
        let options = DrawingOptions {
            id: config.id.as_deref(),
            scale: config.scale.unwrap_or(1.0),
            unit: config.unit,
            tolerance: CURVE_TOLERANCE * ctx.dp,
        };
        let (points, notes) = svg::outline(&path, &options)?;
        ctx.add_file_notes(notes);
        return Ok(points.iter().map(|p| vector(p)).collect());
    }
    let mut table = files::open_table(ctx.folder(), file)?;
    let names = table.point_columns();
    let is_unnamed = table.header().is_empty() && !matches!(names[0], ColumnName::Number(_));
    let [x, y] = table.complete_columns(names.clone()).map_err(|e| match is_unnamed {
        true => e.help("a table of points has two columns, x and y in m, or a first line with the names x_m and y_m"),
        false => files::with_line_in_message(e),
    })?;
    for name in names {
        let unit = table.unit(&name)?.filter(|unit| table::si_factor(unit).is_some());
        if let Some(unit) = unit {
            let what = format!("column \"{name}\" of {file} is in {unit}, and points are in m");
            return Err(Error::scene(what).help("write a table with columns x_m and y_m, in metres"));
        }
    }
    record::note_layout(ctx, "shape", file, &table);
    Ok(x.into_iter().zip(y).map(|(x, y)| vector(&[x, y])).collect())
}

/// Points nearer than this share of the line's size are the same point: tables are rounded.
const SAME_POINT: f64 = 1e-6;

/// The points of a polygon; one that repeats the first at the end is left out.
pub(super) fn polygon_points<const D: usize>(ctx: &Context, config: &PolylineConfig) -> Result<Vec<Vector<D>>> {
    let mut points = outline_points(ctx, config)?;
    if meets(&points) {
        points.pop();
    }
    Ok(points)
}

/// Whether the last point of a line is its first.
fn meets<const D: usize>(line: &[Vector<D>]) -> bool {
    match line {
        [first, .., last] if line.len() > 3 => (last - first).norm() <= SAME_POINT * Bounds::around(line).size().norm(),
        _ => false,
    }
}

/// The points of a wall; the last one equals the first exactly if the wall is closed.
pub(super) fn wall_points<const D: usize>(ctx: &Context, config: &PolylineConfig) -> Result<Vec<Vector<D>>> {
    let mut line = outline_points(ctx, config)?;
    let Some(first) = line.first().copied() else { return Ok(line) };
    let meets = meets(&line);
    match config.closed.unwrap_or(meets) {
        true if line.len() < 3 => {
            let key = format!("a closed polyline of {} points", line.len());
            return Err(Error::scene(key).help("give at least 3 points"));
        }
        true => {
            if meets {
                line.pop();
            }
            line.push(first);
        }
        false if meets => {
            return Err(Error::scene("closed = false, and the last point of the polyline is its first")
                .help("move the last point away from the first, or leave out `closed`"));
        }
        false => {}
    }
    Ok(line)
}
