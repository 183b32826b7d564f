//! The size of a drawing by its own words: width, height, viewBox and preserveAspectRatio of the root element.

use roxmltree::Node;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

/// Metres of an inch.
const INCH: f64 = 0.0254;
/// Metres of a px.
pub(super) const PIXEL: f64 = INCH / 96.0;

/// Returns the length (m) of one drawing unit along x and along y, or `None` if the drawing does not give its size. A
/// drawing gives its size if its width or height has a unit. Without a viewBox, the drawing unit is 1 px, 1/96 inch.
///
/// # Errors
/// The reason why width, height or viewBox is wrong.
pub(super) fn own_unit(root: &Node) -> Result<Option<[f64; 2]>, String> {
    let length = |name: &str| -> Result<Option<Length>, String> {
        let Some(text) = root.attribute(name).map(str::trim).filter(|text| !text.is_empty() && *text != "auto") else {
            return Ok(None);
        };
        let length = text
            .to_ascii_lowercase()
            .parse::<Length>()
            .map_err(|_| format!("its {name} \"{text}\" is not a length"))?;
        Ok(Some(length))
    };
    let (width, height) = (length("width")?, length("height")?);
    let has_unit = |length: &Option<Length>| {
        length.is_some_and(|length| metres(length).is_some() && length.unit != LengthUnit::None)
    };
    if !has_unit(&width) && !has_unit(&height) {
        return Ok(None);
    }
    let Some(text) = root.attribute("viewBox") else { return Ok(Some([PIXEL; 2])) };
    let view: ViewBox = text.parse().map_err(|_| format!("its viewBox \"{text}\" is not four numbers with a size"))?;
    let x = width.and_then(metres).map(|width| width / view.w);
    let y = height.and_then(metres).map(|height| height / view.h);
    let aspect = root.attribute("preserveAspectRatio").and_then(|text| text.parse::<AspectRatio>().ok());
    let unit = match (x, y) {
        (Some(x), Some(y)) => match aspect {
            Some(AspectRatio { align: Align::None, .. }) => [x, y],
            Some(AspectRatio { slice: true, .. }) => [x.max(y); 2],
            _ => [x.min(y); 2],
        },
        (Some(one), None) | (None, Some(one)) => [one; 2],
        (None, None) => return Ok(None),
    };
    match unit.iter().all(|x| *x > 0.0 && x.is_finite()) {
        true => Ok(Some(unit)),
        false => Err("its width or height is not positive".into()),
    }
}

/// Returns the length in metres, or `None` if it is relative. A number without a unit is one in px.
pub(super) fn metres(length: Length) -> Option<f64> {
    let unit = match length.unit {
        LengthUnit::None | LengthUnit::Px => PIXEL,
        LengthUnit::In => INCH,
        LengthUnit::Cm => 0.01,
        LengthUnit::Mm => 0.001,
        LengthUnit::Pt => INCH / 72.0,
        LengthUnit::Pc => INCH / 6.0,
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => return None,
    };
    Some(length.number * unit)
}
