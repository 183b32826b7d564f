//! The lines of a drawn element: of a path and of the basic shapes.

use kurbo::{Affine, BezPath, Ellipse, PathEl, Point, Rect, Shape};
use roxmltree::Node;
use svgtypes::{Length, LengthUnit};

use super::{arcs::path_with_arcs, size, style::Style};

/// The elements that draw lines.
pub(super) const DRAWN: [&str; 7] = ["path", "polygon", "polyline", "line", "rect", "circle", "ellipse"];

/// Largest distance of the curves from arcs, over the radius.
const ARCS: f64 = 1e-6;

/// Returns the lines of the element in its own coordinates.
///
/// # Errors
/// The reason why they cannot be read.
pub(super) fn element_path(node: &Node, style: &Style) -> Result<BezPath, String> {
    let element = Element { node, style };
    match node.tag_name().name() {
        "polygon" => element.through_points(true),
        "polyline" => element.through_points(false),
        "line" => {
            let end = |x: &str, y: &str| Ok::<_, String>(Point::new(element.number(x)?, element.number(y)?));
            let mut path = BezPath::new();
            path.move_to(end("x1", "y1")?);
            path.line_to(end("x2", "y2")?);
            Ok(path)
        }
        "rect" => element.rectangle(),
        "circle" => {
            let radius = element.positive("r")?;
            element.ellipse(radius, radius)
        }
        "ellipse" => {
            let (rx, ry) =
                element.radii()?.filter(|(rx, ry)| *rx > 0.0 && *ry > 0.0).ok_or("its radii are not positive")?;
            element.ellipse(rx, ry)
        }
        _ => {
            let text = node.attribute("d").unwrap_or("");
            let path = BezPath::from_svg(text).map_err(|why| why.to_string())?;
            // Its arcs have an error that does not depend on their size.
            if text.contains(['a', 'A']) { path_with_arcs(text, ARCS) } else { Ok(path) }
        }
    }
}

/// Returns a number or a length in units of the drawing; `None` if the text is neither, or relative to something else.
pub(super) fn length(text: &str) -> Option<f64> {
    let length: Length = text.trim().to_ascii_lowercase().parse().ok()?;
    match length.unit {
        LengthUnit::None | LengthUnit::Px => Some(length.number),
        _ => size::metres(length).map(|x| x / size::PIXEL),
    }
}

struct Element<'a> {
    node: &'a Node<'a, 'a>,
    style: &'a Style,
}

impl Element<'_> {
    /// Returns a length in units of the drawing; `None` if the element does not give it, or leaves it to the viewer.
    fn length(&self, name: &str) -> Result<Option<f64>, String> {
        let Some(text) = self.style.get(self.node, name).map(str::trim).filter(|text| *text != "auto") else {
            return Ok(None);
        };
        length(text).map(Some).ok_or_else(|| format!("its {name} \"{text}\" is not a number or a length"))
    }

    fn number(&self, name: &str) -> Result<f64, String> {
        Ok(self.length(name)?.unwrap_or(0.0))
    }

    fn positive(&self, name: &str) -> Result<f64, String> {
        let x = self.number(name)?;
        if x > 0.0 { Ok(x) } else { Err(format!("its {name} is not positive")) }
    }

    /// Returns rx and ry; one that is not given equals the other.
    fn radii(&self) -> Result<Option<(f64, f64)>, String> {
        let (rx, ry) = (self.length("rx")?, self.length("ry")?);
        match rx.or(ry).zip(ry.or(rx)) {
            Some((rx, ry)) if rx < 0.0 || ry < 0.0 => Err("it has a negative radius".into()),
            radii => Ok(radii),
        }
    }

    /// Returns the line through the points of the element. A viewer draws points up to the first fault, so a fault is refused.
    fn through_points(&self, closed: bool) -> Result<BezPath, String> {
        let name = self.node.tag_name().name();
        let mut numbers = Vec::new();
        for number in svgtypes::NumberListParser::from(self.node.attribute("points").unwrap_or("")) {
            let fault =
                |_| format!("after {} numbers the points of its <{name}> have one that cannot be read", numbers.len());
            numbers.push(number.map_err(fault)?);
        }
        if numbers.len() % 2 == 1 {
            return Err(format!("the points of its <{name}> are {} numbers, an x without a y", numbers.len()));
        }
        let mut path = BezPath::new();
        for (i, pair) in numbers.chunks_exact(2).enumerate() {
            let at = Point::new(pair[0], pair[1]);
            path.push(if i == 0 { PathEl::MoveTo(at) } else { PathEl::LineTo(at) });
        }
        if closed {
            path.push(PathEl::ClosePath);
        }
        Ok(path)
    }

    fn ellipse(&self, rx: f64, ry: f64) -> Result<BezPath, String> {
        let centre = Point::new(self.number("cx")?, self.number("cy")?);
        Ok(Ellipse::new(centre, (rx, ry), 0.0).to_path(ARCS * rx.min(ry)))
    }

    /// Returns a rectangle, with corners rounded by ellipses of radii rx and ry.
    fn rectangle(&self) -> Result<BezPath, String> {
        let (width, height) = (self.positive("width")?, self.positive("height")?);
        let (rx, ry) = self.radii()?.unwrap_or((0.0, 0.0));
        let (rx, ry) = (rx.min(0.5 * width), ry.min(0.5 * height));
        let corner = Point::new(self.number("x")?, self.number("y")?);
        if rx == 0.0 || ry == 0.0 {
            return Ok(Rect::from_origin_size(corner, (width, height)).to_path(0.0));
        }
        // In units of rx and ry the corners are quarters of circles of radius 1.
        let unit = Rect::new(0.0, 0.0, width / rx, height / ry).to_rounded_rect(1.0);
        let place = Affine::translate(corner.to_vec2()) * Affine::scale_non_uniform(rx, ry);
        Ok(place * unit.to_path(ARCS))
    }
}
