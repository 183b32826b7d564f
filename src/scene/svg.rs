//! Outlines from a drawing in SVG: one closed path or basic shape, its curves drawn by straight lines.

mod arcs;
mod element;
mod size;
mod style;

use std::path::Path;

use kurbo::{Affine, BezPath, PathEl, Point};
use roxmltree::Node;

use super::{
    context::FileNote,
    file_content::{self, Text},
    mesh,
    untagged::LengthUnit,
};
use crate::error::{Error, Result, suggestion};
use element::{DRAWN, element_path};
use style::StyleSheets;

/// Most elements of a drawing, and most paths that references draw.
const MOST_NODES: u32 = 100_000;
/// Most levels of groups and references.
const MOST_LEVELS: usize = 100;
/// Most points of an outline: more than a polygon may have.
const MOST_POINTS: usize = 100_000;
/// Size of the largest outline, in tolerances: larger coordinates are mistakes.
const LARGEST: f64 = 1e9;
/// Largest relative difference of two units that agree.
const AGREES: f64 = 1e-3;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";

/// Elements whose content is not drawn where it stands.
const DEFINITIONS: [&str; 12] = [
    "defs",
    "clipPath",
    "mask",
    "marker",
    "pattern",
    "symbol",
    "linearGradient",
    "radialGradient",
    "filter",
    "font",
    "foreignObject",
    "metadata",
];

/// The interpretation of a drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawingOptions<'a> {
    /// The id of the path, if the drawing has several.
    pub(crate) id: Option<&'a str>,
    /// Factor on lengths, –.
    pub(crate) scale: f64,
    /// Unit of a drawing that does not give its size; `None` stands for metres.
    pub(crate) unit: Option<LengthUnit>,
    /// Largest distance (m) of the straight lines from a curve.
    pub(crate) tolerance: f64,
}

/// The points (m) of the outline in the drawing at `path`, y upwards, counter-clockwise, and notes about its size.
///
/// # Errors
/// `File` if it cannot be read; `Scene` if it is no SVG, or has no single such outline.
pub(crate) fn outline(path: &Path, options: &DrawingOptions) -> Result<(Vec<[f64; 2]>, Vec<FileNote>)> {
    let refuse = |what: String, help: &str| Error::scene(format!("{}: {what}", path.display())).help(help);
    let bytes = mesh::bytes(path)?;
    file_content::check(path, &bytes, "SVG")?;
    let Text { text, .. } = file_content::decode(&bytes);
    let limits = roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..Default::default() };
    let drawing = roxmltree::Document::parse_with_options(&text, limits)
        .map_err(|why| refuse(format!("this is no SVG: {why}"), "give an SVG file"))?;
    let root = drawing.root_element();
    if root.tag_name().name() != "svg" {
        return Err(refuse(format!("this is no SVG: its root is <{}>", root.tag_name().name()), "give an SVG file"));
    }
    let bad = |why: String| {
        refuse(format!("the outline cannot be read: {why}"), "draw one closed path, and export it as plain SVG")
    };
    let sheets = StyleSheets::of(&drawing);
    let mut search = Search { drawing: &drawing, sheets: &sheets, found: Vec::new() };
    search.visit(root, &Place { unread: sheets.unread(), ..Place::default() }).map_err(bad)?;
    let chosen = chosen(&search.found, options.id);
    let [drawn] = chosen[..] else {
        let exists = |id: &str| drawing.descendants().any(|node| node.attribute("id") == Some(id));
        let what = match (chosen.len(), options.id) {
            (0, Some(id)) if exists(id) => {
                format!("the element with the id \"{id}\" is hidden, a definition, or neither a path nor a basic shape")
            }
            (0, Some(id)) => {
                let ids = search.found.iter().filter_map(|drawn| drawn.node.attribute("id"));
                format!("there is no path or basic shape with the id \"{id}\"{}", suggestion(id, ids))
            }
            (0, None) => "there is no path or basic shape in this drawing".into(),
            (n, _) => {
                let names: Vec<&str> = chosen.iter().map(|drawn| drawn.node.tag_name().name()).collect();
                let count = |name: &&str| names.iter().filter(|own| *own == name).count();
                let kinds: Vec<String> = DRAWN
                    .iter()
                    .map(|name| (count(name), name))
                    .filter(|(n, _)| *n > 0)
                    .map(|(n, name)| format!("{n} <{name}>"))
                    .collect();
                format!("there are {n} paths and basic shapes in this drawing: {}", kinds.join(", "))
            }
        };
        let help = "draw one path or basic shape (other objects: \"convert to path\"), or name one:  id = \"hull\"";
        return Err(refuse(what, help));
    };
    if let Some(why) = &drawn.place.unread {
        return Err(bad(why.clone()));
    }
    let (unit, notes) =
        unit(path, &root, options).map_err(|why| refuse(why, "give width and height as in  width=\"540mm\""))?;
    let to_metres = Affine::scale_non_uniform(unit[0] * options.scale, -unit[1] * options.scale);
    let curve =
        to_metres * drawn.place.transform * element_path(&drawn.node, &sheets.style(&drawn.node)).map_err(bad)?;
    let size = curve.control_box();
    if !curve.is_finite() || size.width().max(size.height()) > LARGEST * options.tolerance {
        return Err(bad("its coordinates are not finite, or far too large for dp".into()));
    }
    let mut points = flattened(&curve, options.tolerance).map_err(bad)?;
    let n = points.len();
    let twice: f64 = (0..n).map(|i| (points[i], points[(i + 1) % n])).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
    if twice < 0.0 {
        points.reverse();
    }
    Ok((points, notes))
}

/// Returns the lengths (m) of a unit of the drawing along x and y, and notes about their source. The size that the
/// drawing gives takes precedence over `options.unit`.
fn unit(path: &Path, root: &Node, options: &DrawingOptions) -> std::result::Result<([f64; 2], Vec<FileNote>), String> {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let asked = options.unit.map(LengthUnit::metres);
    let note = |what: String, mend: &str| vec![FileNote::note("drawing_size", format!("{name}: {what}"), mend.into())];
    let Some(own) = size::own_unit(root)? else {
        let notes = match asked {
            Some(_) => Vec::new(),
            None => note(
                "the drawing does not give its size; one of its units counts as 1 m".into(),
                "write  unit = \"mm\"  or  unit = \"m\"  beside the file's name",
            ),
        };
        return Ok(([asked.unwrap_or(1.0); 2], notes));
    };
    let sizes = if own[0] == own[1] { format!("{:.5e}", own[0]) } else { format!("{:.5e} by {:.5e}", own[0], own[1]) };
    let notes = match asked {
        Some(asked) if own.iter().all(|own| (own / asked - 1.0).abs() < AGREES) => Vec::new(),
        Some(asked) => note(
            format!(
                "the drawing gives its size: one of its units is {sizes} m, not {asked} m as unit says; its own size counts"
            ),
            "leave unit out; for another size use scale, or remove width and height from the drawing",
        ),
        None => note(
            format!("the drawing gives its size: one of its units is {sizes} m"),
            "for another size use scale, or remove width and height from the drawing and write unit",
        ),
    };
    Ok((own, notes))
}

/// The place of an element in the drawing.
#[derive(Clone, Default)]
struct Place {
    /// From the element's coordinates to those of the drawing.
    transform: Affine,
    is_hidden: bool,
    levels: usize,
    /// The id of the outermost reference through which the element is drawn, empty if it has none.
    reference: Option<String>,
    /// The first property of the element or its ancestors that is not understood.
    unread: Option<String>,
}

/// A path or basic shape that is drawn.
struct Drawn<'a, 'i> {
    node: Node<'a, 'i>,
    place: Place,
}

/// Collects the paths and basic shapes that are drawn.
struct Search<'a, 'i> {
    drawing: &'a roxmltree::Document<'i>,
    sheets: &'a StyleSheets,
    found: Vec<Drawn<'a, 'i>>,
}

impl<'a, 'i> Search<'a, 'i> {
    fn visit(&mut self, node: Node<'a, 'i>, above: &Place) -> std::result::Result<(), String> {
        let tag = node.tag_name();
        let foreign = tag.namespace().is_some_and(|space| space != SVG);
        if !node.is_element() || foreign || DEFINITIONS.contains(&tag.name()) {
            return Ok(());
        }
        self.draw(node, above)
    }

    /// Visits an element although it may be a definition.
    fn draw(&mut self, node: Node<'a, 'i>, above: &Place) -> std::result::Result<(), String> {
        if above.levels > MOST_LEVELS || self.found.len() > MOST_NODES as usize {
            return Err("its groups or references are too many or too deep".into());
        }
        let style = self.sheets.style(&node);
        if style.get(&node, "display") == Some("none") {
            return Ok(());
        }
        let mut place = Place { levels: above.levels + 1, ..above.clone() };
        match style.get(&node, "visibility") {
            Some("hidden" | "collapse") => place.is_hidden = true,
            Some("visible") => place.is_hidden = false,
            _ => {}
        }
        for name in ["clip-path", "mask"] {
            if let Some(value) = style.get(&node, name).filter(|value| value.trim() != "none") {
                let tag = node.tag_name().name();
                let why = format!("the {name} \"{value}\" of its <{tag}> hides a part of it, and is not applied");
                place.unread = place.unread.or(Some(why));
            }
        }
        match style.transform(&node) {
            Ok(transform) => place.transform *= transform,
            Err(why) => place.unread = place.unread.or(Some(why)),
        }
        match node.tag_name().name() {
            name if DRAWN.contains(&name) => {
                if !place.is_hidden {
                    self.found.push(Drawn { node, place });
                }
            }
            "use" => self.follow(node, place)?,
            name => {
                let own_view = ["x", "y", "width", "height", "viewBox"].iter().any(|key| node.has_attribute(*key));
                if own_view && (name == "symbol" || name == "svg" && above.levels > 0) {
                    place.unread = place.unread.or(Some(format!("it lies in a <{name}> with its own size")));
                }
                for child in node.children() {
                    self.visit(child, &place)?;
                }
            }
        }
        Ok(())
    }

    /// Visits the element to which a `use` refers.
    fn follow(&mut self, node: Node<'a, 'i>, mut place: Place) -> std::result::Result<(), String> {
        let mut number = |name: &str| match node.attribute(name).map(element::length) {
            Some(Some(number)) => number,
            Some(None) => {
                place.unread = place.unread.take().or(Some(format!("the {name} of a <use> is no number or length")));
                0.0
            }
            None => 0.0,
        };
        let at = (number("x"), number("y"));
        place.transform *= Affine::translate(at);
        place.reference = place.reference.or(Some(node.attribute("id").unwrap_or("").into()));
        let link = node.attribute("href").or_else(|| node.attribute((XLINK, "href"))).unwrap_or("");
        let Some(id) = link.strip_prefix('#') else {
            return Err(format!("a <use> refers to \"{link}\", which is not in this drawing"));
        };
        match self.drawing.descendants().find(|other| other.attribute("id") == Some(id)) {
            Some(other) => self.draw(other, &place),
            None => Err(format!("a <use> refers to \"{id}\", which is not in this drawing")),
        }
    }
}

/// Returns the path with this id that no reference draws, else the paths that a reference with this id draws, else those with
/// this id that a reference draws. Without an id, returns all paths.
fn chosen<'s, 'a, 'i>(found: &'s [Drawn<'a, 'i>], id: Option<&str>) -> Vec<&'s Drawn<'a, 'i>> {
    let Some(id) = id else { return found.iter().collect() };
    let own = |drawn: &Drawn| drawn.node.attribute("id") == Some(id);
    let direct = |drawn: &Drawn| own(drawn) && drawn.place.reference.is_none();
    let referred = |drawn: &Drawn| drawn.place.reference.as_deref() == Some(id);
    let ways: [&dyn Fn(&Drawn) -> bool; 3] = [&direct, &referred, &own];
    let by = |way: &dyn Fn(&Drawn) -> bool| found.iter().filter(|drawn| way(drawn)).collect::<Vec<_>>();
    ways.into_iter().map(by).find(|chosen| !chosen.is_empty()).unwrap_or_default()
}

/// The corners of the closed path within `tolerance`, without repeated points.
fn flattened(path: &BezPath, tolerance: f64) -> std::result::Result<Vec<[f64; 2]>, String> {
    let (mut points, mut outlines, mut closed, mut start) = (Vec::new(), 0, false, None);
    kurbo::flatten(path, tolerance, |element| match element {
        // A start without a line draws nothing.
        PathEl::MoveTo(p) => start = Some(p),
        PathEl::LineTo(p) if points.len() < MOST_POINTS => {
            outlines += usize::from(start.is_some());
            points.extend(start.take());
            points.push(p);
        }
        PathEl::ClosePath => closed |= start.is_none(),
        _ => {}
    });
    let near = |a: &Point, b: &Point| a.distance(*b) < 1e-3 * tolerance;
    points.dedup_by(|a, b| near(a, b));
    let meets = points.len() > 1 && near(&points[0], &points[points.len() - 1]);
    if meets {
        points.pop();
    }
    match (outlines, closed || meets) {
        (0, _) => Err("it draws no line".into()),
        (1, true) => Ok(points.into_iter().map(|p| [p.x, p.y]).collect()),
        (1, false) => Err("it is not closed".into()),
        (n, _) => Err(format!("it has {n} outlines; a polygon is one, without holes")),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/scene/svg.rs"]
mod tests;
