//! Style properties of a drawing that decide whether and where a path is drawn: style attributes and style sheets.

use kurbo::{Affine, Vec2};
use roxmltree::Node;

/// Length of a CSS unit, px (1/96 inch).
const UNITS: [(&str, f64); 6] =
    [("px", 1.0), ("mm", 96.0 / 25.4), ("cm", 96.0 / 2.54), ("in", 96.0), ("pt", 96.0 / 72.0), ("pc", 16.0)];

/// Properties that hide, place or size a shape.
const PROPERTIES: [&str; 18] = [
    "display",
    "visibility",
    "transform",
    "transform-origin",
    "transform-box",
    "translate",
    "rotate",
    "scale",
    "d",
    "x",
    "y",
    "width",
    "height",
    "cx",
    "cy",
    "r",
    "rx",
    "ry",
];

/// The rules of the style sheets of a drawing, weakest first.
#[derive(Default)]
pub(super) struct StyleSheets {
    rules: Vec<Rule>,
    /// The first rule that is not understood although it places or hides paths.
    unread: Option<String>,
}

struct Rule {
    specificity: usize,
    selector: Selector,
    declarations: Vec<Declaration>,
}

/// The value of a property.
#[derive(Clone)]
struct Declaration {
    /// Name of the property, in lower case.
    name: String,
    value: String,
    is_important: bool,
}

/// A selector of one element: each given part has to fit.
#[derive(Default)]
struct Selector {
    tag: Option<String>,
    id: Option<String>,
    classes: Vec<String>,
}

/// The properties of an element, weakest first.
pub(super) struct Style(Vec<Declaration>);

impl StyleSheets {
    pub(super) fn of(drawing: &roxmltree::Document) -> Self {
        let mut sheets = Self::default();
        for node in drawing.descendants().filter(|node| node.tag_name().name() == "style") {
            let text: String = node.descendants().filter_map(|node| node.text().filter(|_| node.is_text())).collect();
            sheets.add(&without_comments(&text));
        }
        sheets.rules.sort_by_key(|rule| rule.specificity);
        sheets
    }

    fn add(&mut self, text: &str) {
        let mut rest = text;
        while let Some((head, tail)) = rest.split_once('{') {
            let (body, after) = tail.split_at(block_length(tail));
            rest = after.strip_prefix('}').unwrap_or(after);
            // Rules within a block, as of @media, apply under a condition.
            let is_nested = body.contains('{');
            let declarations: Vec<_> = body.split(['{', '}']).flat_map(declarations).collect();
            let is_placed = declarations.iter().any(|own| PROPERTIES.contains(&own.name.as_str()));
            // A statement such as @import or @charset ends with a semicolon.
            let head = head.rsplit(';').next().unwrap_or(head);
            for selector in head.split(',').map(str::trim).filter(|_| is_placed) {
                match Selector::parse(selector).filter(|_| !is_nested) {
                    Some(selector) => {
                        let specificity = 100 * usize::from(selector.id.is_some())
                            + 10 * selector.classes.len()
                            + usize::from(selector.tag.is_some());
                        self.rules.push(Rule { specificity, selector, declarations: declarations.clone() });
                    }
                    None => self.unread = self.unread.take().or_else(|| Some(selector.into())),
                }
            }
        }
    }

    /// Returns the properties of the element: those of the rules that fit, and its own, which take precedence; important ones
    /// take precedence over all others.
    pub(super) fn style(&self, node: &Node) -> Style {
        let fitting = self.rules.iter().filter(|rule| rule.selector.fits(node));
        let mut all: Vec<_> = fitting.flat_map(|rule| rule.declarations.iter().cloned()).collect();
        all.extend(declarations(&without_comments(node.attribute("style").unwrap_or(""))));
        all.sort_by_key(|own| own.is_important);
        Style(all)
    }

    /// Returns the rule that is not understood, as a reason to refuse the drawing.
    pub(super) fn unread(&self) -> Option<String> {
        self.unread.as_ref().map(|rule| format!("the style sheet has the rule \"{rule}\", which is not read"))
    }
}

impl Selector {
    /// Returns the selector, or `None` if it depends on more than tag, id and classes.
    fn parse(text: &str) -> Option<Self> {
        let is_name = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        if text.is_empty() || !text.chars().all(|c| is_name(c) || matches!(c, '.' | '#' | '*')) {
            return None;
        }
        let mut selector = Self::default();
        let first = text.find(['.', '#']).unwrap_or(text.len());
        let tag = &text[..first];
        selector.tag = (!tag.is_empty() && tag != "*").then(|| tag.to_string());
        let mut rest = &text[first..];
        while let Some(kind) = rest.chars().next() {
            let end = rest[1..].find(['.', '#']).map_or(rest.len(), |i| i + 1);
            let name = rest[1..end].to_string();
            match kind {
                '.' => selector.classes.push(name),
                _ => selector.id = Some(name),
            }
            rest = &rest[end..];
        }
        Some(selector)
    }

    fn fits(&self, node: &Node) -> bool {
        let classes = || node.attribute("class").unwrap_or("").split_ascii_whitespace();
        self.tag.as_deref().is_none_or(|tag| tag == node.tag_name().name())
            && self.id.as_deref().is_none_or(|id| node.attribute("id") == Some(id))
            && self.classes.iter().all(|class| classes().any(|own| own == class))
    }
}

impl Style {
    /// Returns the value of a property, by the style or else by the attribute of this name.
    pub(super) fn get<'a>(&'a self, node: &Node<'a, '_>, name: &str) -> Option<&'a str> {
        self.own(name).or_else(|| node.attribute(name))
    }

    fn own(&self, name: &str) -> Option<&str> {
        self.0.iter().rev().find(|own| own.name == name).map(|own| own.value.as_str())
    }

    /// Returns the transform of the element to the frame of its parent.
    ///
    /// # Errors
    /// The reason why the transform is not understood.
    pub(super) fn transform(&self, node: &Node) -> Result<Affine, String> {
        if let Some(name) = ["translate", "rotate", "scale", "d"]
            .into_iter()
            .find(|name| self.own(name).is_some_and(|value| value != "none"))
        {
            return Err(format!("the style \"{name}\" is not read"));
        }
        let transform = match (self.own("transform"), node.attribute("transform")) {
            (Some(value), _) => css_transform(value)?,
            (None, Some(value)) => match value.parse::<svgtypes::Transform>() {
                Ok(t) => Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]),
                Err(why) => css_transform(value).map_err(|_| why.to_string())?,
            },
            (None, None) => return Ok(Affine::IDENTITY),
        };
        let origin = self.get(node, "transform-origin").unwrap_or("0 0");
        let parts: Vec<&str> = origin.split_ascii_whitespace().collect();
        let number = |word: &str| match word {
            "left" | "top" => Some(0.0),
            word => pixels(word),
        };
        let at = match parts[..] {
            [x, y] | [x, y, _] => number(x).zip(number(y)).map(|(x, y)| Vec2::new(x, y)),
            _ => None,
        };
        // A shift does not depend on its origin.
        let [a, b, c, d, ..] = transform.as_coeffs();
        let is_shift = [a, b, c, d] == [1.0, 0.0, 0.0, 1.0];
        match (at, self.get(node, "transform-box")) {
            _ if is_shift => Ok(transform),
            (_, Some(value)) if value != "view-box" => Err(format!("the transform-box \"{value}\" is not read")),
            (Some(at), _) => Ok(Affine::translate(at) * transform * Affine::translate(-at)),
            (None, _) => Err(format!("the transform-origin \"{origin}\" is not read")),
        }
    }
}

fn without_comments(text: &str) -> String {
    let mut clean = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("/*") {
        clean.push_str(before);
        rest = after.split_once("*/").map_or("", |(_, after)| after);
    }
    clean + rest
}

/// Returns the length of the block at the beginning of `text`, up to the brace that closes it.
fn block_length(text: &str) -> usize {
    let mut open = 0;
    let closes = |c: char| {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            _ => {}
        }
        open < 0
    };
    text.find(closes).unwrap_or(text.len())
}

/// Returns the declarations in `text`.
fn declarations(text: &str) -> Vec<Declaration> {
    let pairs = text.split(';').filter_map(|declaration| declaration.split_once(':'));
    let declaration = |(name, text): (&str, &str)| {
        let (value, mark) = text.split_once('!').unwrap_or((text, ""));
        Declaration {
            name: name.trim().to_ascii_lowercase(),
            value: value.trim().into(),
            is_important: mark.trim().eq_ignore_ascii_case("important"),
        }
    };
    pairs.map(declaration).collect()
}

/// Returns a length in px; a number without a unit is one in px.
fn pixels(word: &str) -> Option<f64> {
    let of_unit = UNITS.iter().find_map(|(unit, px)| Some(word.strip_suffix(unit)?.parse::<f64>().ok()? * px));
    of_unit.or_else(|| word.parse().ok())
}

/// Returns an angle in radians; a number without a unit is one in degrees.
fn radians(word: &str) -> Option<f64> {
    let units = [("deg", 1.0), ("grad", 0.9), ("turn", 360.0)];
    let degrees =
        units.iter().find_map(|(unit, degrees)| Some(word.strip_suffix(unit)?.parse::<f64>().ok()? * degrees));
    let radians = || word.strip_suffix("rad")?.parse::<f64>().ok();
    degrees.or_else(|| word.parse().ok()).map(f64::to_radians).or_else(radians)
}

/// Returns the transform that the CSS functions in `text` give together.
fn css_transform(text: &str) -> Result<Affine, String> {
    let mut all = Affine::IDENTITY;
    let mut rest = text.trim();
    if rest == "none" {
        return Ok(all);
    }
    while !rest.is_empty() {
        let unread = || format!("the transform \"{text}\" is not read");
        let (name, after) = rest.split_once('(').ok_or_else(unread)?;
        let (arguments, after) = after.split_once(')').ok_or_else(unread)?;
        let words: Vec<&str> =
            arguments.split(|c: char| c == ',' || c.is_whitespace()).filter(|word| !word.is_empty()).collect();
        all *= css_function(name.trim(), &words).ok_or_else(unread)?;
        rest = after.trim_start_matches(|c: char| c == ',' || c.is_whitespace());
    }
    Ok(all)
}

fn css_function(name: &str, words: &[&str]) -> Option<Affine> {
    let factor = |word: &str| match word.strip_suffix('%') {
        Some(percent) => Some(percent.parse::<f64>().ok()? / 100.0),
        None => word.parse().ok(),
    };
    Some(match (name.to_ascii_lowercase().as_str(), words) {
        ("translate", [x, y]) => Affine::translate((pixels(x)?, pixels(y)?)),
        ("translate" | "translatex", [x]) => Affine::translate((pixels(x)?, 0.0)),
        ("translatey", [y]) => Affine::translate((0.0, pixels(y)?)),
        ("scale", [x, y]) => Affine::scale_non_uniform(factor(x)?, factor(y)?),
        ("scale", [s]) => Affine::scale(factor(s)?),
        ("scalex", [x]) => Affine::scale_non_uniform(factor(x)?, 1.0),
        ("scaley", [y]) => Affine::scale_non_uniform(1.0, factor(y)?),
        ("rotate" | "rotatez", [angle]) => Affine::rotate(radians(angle)?),
        ("rotate", [angle, x, y]) => Affine::rotate_about(radians(angle)?, (pixels(x)?, pixels(y)?)),
        ("skew", [x, y]) => Affine::skew(radians(x)?.tan(), radians(y)?.tan()),
        ("skew" | "skewx", [x]) => Affine::skew(radians(x)?.tan(), 0.0),
        ("skewy", [y]) => Affine::skew(0.0, radians(y)?.tan()),
        ("matrix", [a, b, c, d, e, f]) => {
            let mut numbers = [0.0; 6];
            for (number, word) in numbers.iter_mut().zip([a, b, c, d, e, f]) {
                *number = pixels(word)?;
            }
            Affine::new(numbers)
        }
        _ => return None,
    })
}
