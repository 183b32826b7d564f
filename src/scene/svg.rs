//! Outlines from a drawing in SVG: one closed path, its curves drawn by straight lines.

use std::path::Path;

use kurbo::{Affine, BezPath, PathEl, Point};

use super::mesh;
use crate::error::{Error, Result};

/// Most elements of a drawing.
const MOST_NODES: u32 = 100_000;
/// Most points of an outline: more than a polygon may have.
const MOST_POINTS: usize = 100_000;
/// Size of the largest outline, in tolerances: larger coordinates are mistakes.
const LARGEST: f64 = 1e9;

/// The points of the outline in the drawing at `path`, the one called `id` if there are several: times `unit` (m per
/// unit of the drawing), y upwards, counter-clockwise. Straight lines leave a curve by no more than `tolerance` (m).
///
/// # Errors
/// `File` if it cannot be read; `Scene` if it is no SVG, or has not one such outline.
pub(crate) fn outline(path: &Path, id: Option<&str>, unit: f64, tolerance: f64) -> Result<Vec<[f64; 2]>> {
    let refuse = |what: String, help: &str| Error::scene(format!("{}: {what}", path.display())).help(help);
    let text =
        String::from_utf8(mesh::bytes(path)?).map_err(|_| refuse("this is no text".into(), "give an SVG file"))?;
    let options = roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..Default::default() };
    let drawing = roxmltree::Document::parse_with_options(&text, options)
        .map_err(|why| refuse(format!("this is no SVG: {why}"), "give an SVG file"))?;
    let hidden = ["defs", "clipPath", "mask", "marker", "pattern", "symbol"];
    let seen = |node: &roxmltree::Node| node.ancestors().all(|above| !hidden.contains(&above.tag_name().name()));
    let drawn = drawing.descendants().filter(|node| matches!(node.tag_name().name(), "path" | "polygon")).filter(seen);
    let found: Vec<_> = drawn.filter(|node| id.is_none_or(|id| node.attribute("id") == Some(id))).collect();
    let [node] = found[..] else {
        let what = match (found.len(), id) {
            (0, Some(id)) => format!("there is no path with the id \"{id}\""),
            (0, None) => "there is no path in this drawing".into(),
            (n, _) => format!("there are {n} paths in this drawing"),
        };
        let help = "draw one path or polygon (other objects: \"convert to path\"), or name one:  id = \"hull\"";
        return Err(refuse(what, help));
    };
    let bad = |why: String| {
        refuse(format!("the path cannot be read: {why}"), "draw one closed path, and export it as plain SVG")
    };
    let turn = full_transform(&node).map_err(bad)?;
    let path = turn * element_path(&node).map_err(bad)?;
    let size = path.control_box();
    let finest = tolerance / unit;
    if !path.is_finite() || size.width().max(size.height()) > LARGEST * finest {
        return Err(bad("its coordinates are not finite, or far too large for dp".into()));
    }
    let mut points = flattened(&path, finest).map_err(bad)?;
    points.iter_mut().for_each(|p| *p = [p[0] * unit, -p[1] * unit]);
    let n = points.len();
    let twice: f64 = (0..n).map(|i| (points[i], points[(i + 1) % n])).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
    if twice < 0.0 {
        points.reverse();
    }
    Ok(points)
}

/// The product of the transforms of the element and of its ancestors.
fn full_transform(node: &roxmltree::Node) -> std::result::Result<Affine, String> {
    let mut all = Affine::IDENTITY;
    for transform in node.ancestors().filter_map(|above| above.attribute("transform")) {
        let t: svgtypes::Transform = transform.parse().map_err(|why: svgtypes::Error| why.to_string())?;
        all = Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]) * all;
    }
    Ok(all)
}

/// The path of the element.
fn element_path(node: &roxmltree::Node) -> std::result::Result<BezPath, String> {
    if let Some(points) = node.attribute("points") {
        let mut path = BezPath::new();
        for (i, (x, y)) in svgtypes::PointsParser::from(points).enumerate() {
            path.push(if i == 0 { PathEl::MoveTo(Point::new(x, y)) } else { PathEl::LineTo(Point::new(x, y)) });
        }
        path.push(PathEl::ClosePath);
        return Ok(path);
    }
    BezPath::from_svg(node.attribute("d").unwrap_or("")).map_err(|why| why.to_string())
}

/// The corners of the closed path within `tolerance`, without repeated points.
fn flattened(path: &BezPath, tolerance: f64) -> std::result::Result<Vec<[f64; 2]>, String> {
    let (mut points, mut starts, mut closed) = (Vec::new(), 0, false);
    kurbo::flatten(path, tolerance, |element| match element {
        PathEl::MoveTo(p) => {
            starts += 1;
            points.push(p);
        }
        PathEl::LineTo(p) if points.len() < MOST_POINTS => points.push(p),
        PathEl::ClosePath => closed = true,
        _ => {}
    });
    let near = |a: &Point, b: &Point| a.distance(*b) < 1e-3 * tolerance;
    points.dedup_by(|a, b| near(a, b));
    let meets = points.len() > 1 && near(&points[0], &points[points.len() - 1]);
    if meets {
        points.pop();
    }
    match (starts, closed || meets) {
        (1, true) => Ok(points.into_iter().map(|p| [p.x, p.y]).collect()),
        (1, false) => Err("it is not closed".into()),
        (n, _) => Err(format!("it has {n} outlines; a polygon is one, without holes")),
    }
}
