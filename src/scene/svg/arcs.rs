//! Paths with elliptical arcs.

use kurbo::{Arc, BezPath, Point, SvgArc, Vec2};
use svgtypes::{PathParser, PathSegment};

/// Returns the path of the data `text`, with curves in place of arcs at a distance of at most `tolerance`, relative to the smaller radius.
///
/// # Errors
/// The reason why it cannot be read.
pub(super) fn path_with_arcs(text: &str, tolerance: f64) -> Result<BezPath, String> {
    let mut path = BezPath::new();
    // The point before each segment and the beginning of its subpath, and the last control point of a curve, which is cubic or not.
    let (mut at, mut start, mut last) = (Point::ORIGIN, Point::ORIGIN, None::<(bool, Point)>);
    let mut is_closed = false;
    for segment in PathParser::from(text) {
        let segment = segment.map_err(|why| why.to_string())?;
        let origin = if segment.is_abs() { Vec2::ZERO } else { at.to_vec2() };
        let point = |x: f64, y: f64| Point::new(x, y) + origin;
        let mirrored = |cubic: bool| last.filter(|own| own.0 == cubic).map_or(at, |own| at + (at - own.1));
        let mut control = None;
        if is_closed && !matches!(segment, PathSegment::MoveTo { .. } | PathSegment::ClosePath { .. }) {
            path.move_to(start);
        }
        is_closed = false;
        let end = match segment {
            PathSegment::MoveTo { x, y, .. } => {
                start = point(x, y);
                path.move_to(start);
                start
            }
            PathSegment::ClosePath { .. } => {
                path.close_path();
                is_closed = true;
                start
            }
            PathSegment::LineTo { x, y, .. } => line(&mut path, point(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => line(&mut path, Point::new(x + origin.x, at.y)),
            PathSegment::VerticalLineTo { y, .. } => line(&mut path, Point::new(at.x, y + origin.y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                control = Some((true, point(x2, y2)));
                path.curve_to(point(x1, y1), point(x2, y2), point(x, y));
                point(x, y)
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                control = Some((true, point(x2, y2)));
                path.curve_to(mirrored(true), point(x2, y2), point(x, y));
                point(x, y)
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => {
                control = Some((false, point(x1, y1)));
                path.quad_to(point(x1, y1), point(x, y));
                point(x, y)
            }
            PathSegment::SmoothQuadratic { x, y, .. } => {
                control = Some((false, mirrored(false)));
                path.quad_to(mirrored(false), point(x, y));
                point(x, y)
            }
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                let (to, x_rotation) = (point(x, y), x_axis_rotation.to_radians());
                let arc = SvgArc { from: at, to, radii: Vec2::new(rx, ry), x_rotation, large_arc, sweep };
                match Arc::from_svg_arc(&arc) {
                    Some(arc) => {
                        let tolerance = tolerance * arc.radii.x.abs().min(arc.radii.y.abs());
                        arc.to_cubic_beziers(tolerance, |first, second, end| path.curve_to(first, second, end));
                    }
                    None => path.line_to(to),
                }
                to
            }
        };
        (at, last) = (end, control);
    }
    Ok(path)
}

/// Adds a line to `end`, which is returned.
fn line(path: &mut BezPath, end: Point) -> Point {
    path.line_to(end);
    end
}
