//! Lines and outlines of shapes: points, a table of points, or a drawing.

use super::shape::vector;
use crate::{
    error::Result,
    math::Vector,
    scene::{
        context::{Context, last_part},
        files, svg,
        untagged::PolylineConfig,
    },
};

/// Largest distance of the straight segments from the curves of a drawing, dp.
const CURVE_TOLERANCE: f64 = 0.01;

/// Refuses a line that gives neither points nor a file, or both.
pub(super) fn verify_line(ctx: &Context, key: &str, config: &PolylineConfig) -> Result<()> {
    ctx.require_positive(&format!("{key}.thickness"), config.thickness)?;
    match (&config.points, &config.file) {
        (Some(points), None) => points.iter().try_for_each(|p| ctx.require_dimension(key, p)),
        (None, Some(_)) => Ok(()),
        _ => Err(ctx.error_at(key, format!("a {} has either points or a file of points", last_part(key)))),
    }
}

/// Refuses an outline that gives neither points nor a file, or both, or points of another dimension than 2.
pub(super) fn verify_outline(ctx: &Context, key: &str, config: &PolylineConfig) -> Result<()> {
    let flat = Context { dimension: 2, ..*ctx };
    verify_line(&flat, key, config)?;
    verify_drawing(ctx, key, config)
}

/// Refuses keys of a drawing where there is none.
pub(super) fn verify_drawing(ctx: &Context, key: &str, config: &PolylineConfig) -> Result<()> {
    ctx.require_positive(&format!("{key}.scale"), config.scale)?;
    let words_of_one =
        [("id", config.id.is_some()), ("scale", config.scale.is_some()), ("unit", config.unit.is_some())];
    match words_of_one.iter().find(|(_, given)| *given && !config.is_drawing()) {
        Some((word, _)) => Err(ctx.error_at(&format!("{key}.{word}"), format!("{word} belongs to a drawing (.svg)"))),
        None => Ok(()),
    }
}

/// The points of a line or outline, m; opens the file that it names.
pub(super) fn outline_points<const D: usize>(ctx: &Context, config: &PolylineConfig) -> Result<Vec<Vector<D>>> {
    if let Some(points) = &config.points {
        return Ok(points.iter().map(|p| vector(p)).collect());
    }
    let file = config.file.as_deref().unwrap_or("");
    if config.is_drawing() {
        let path = files::path_beside(ctx.folder(), file)?;
        let unit = config.scale.unwrap_or(1.0) * config.unit.unwrap_or_default().metres();
        let points = svg::outline(&path, config.id.as_deref(), unit, CURVE_TOLERANCE * ctx.dp)?;
        return Ok(points.iter().map(|p| vector(p)).collect());
    }
    let [x, y] = files::open_table(ctx.folder(), file)?.columns(["x_m", "y_m"]).map_err(files::with_line_in_message)?;
    Ok(x.into_iter().zip(y).map(|(x, y)| vector(&[x, y])).collect())
}
