//! Draws text in pictures. The glyph outlines come from an embedded font and are filled like any other path.

use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Transform};
use ttf_parser::{Face, OutlineBuilder};

use crate::error::{Error, ErrorKind, Result};

/// A subset of Inter Regular (Latin, Greek, symbols), under the SIL Open Font License: `assets/LICENSE-inter.txt`.
const FONT: &[u8] = include_bytes!("assets/inter.otf");

/// Draws text with the embedded font.
pub(crate) struct TextRenderer {
    face: Face<'static>,
}

/// The alignment of a text relative to its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The text begins at the position.
    Start,
    /// The middle of the text is at the position.
    Middle,
    /// The text ends at the position.
    End,
}

impl TextRenderer {
    /// Loads the embedded font.
    ///
    /// # Errors
    /// `File` if the font is damaged; a test excludes this error.
    pub(crate) fn new() -> Result<Self> {
        let face =
            Face::parse(FONT, 0).map_err(|why| Error::new(ErrorKind::File, format!("the embedded font: {why}")))?;
        Ok(Self { face })
    }

    /// Returns the width of `text` at font size `size`, both in pixels.
    pub(crate) fn width(&self, text: &str, size: f32) -> f32 {
        let advance = |c: char| self.face.glyph_index(c).and_then(|g| self.face.glyph_hor_advance(g)).unwrap_or(0);
        text.chars().map(|c| f32::from(advance(c))).sum::<f32>() * self.scale(size)
    }

    /// Draws `text` at font size `size` with its baseline at (`x`, `y`), in pixels.
    pub(crate) fn write(
        &self,
        on: &mut Pixmap,
        text: &str,
        (x, y): (f32, f32),
        size: f32,
        anchor: Anchor,
        colour: [u8; 3],
    ) {
        let share = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let scale = self.scale(size);
        let mut pen = GlyphOutline { path: PathBuilder::new(), x: x - share * self.width(text, size), y, scale };
        for glyph in text.chars().filter_map(|c| self.face.glyph_index(c)) {
            self.face.outline_glyph(glyph, &mut pen);
            pen.x += f32::from(self.face.glyph_hor_advance(glyph).unwrap_or(0)) * scale;
        }
        if let Some(path) = pen.path.finish() {
            fill_path(on, &path, colour, 255);
        }
    }

    fn scale(&self, size: f32) -> f32 {
        size / f32::from(self.face.units_per_em())
    }
}

/// Fills `path` with `colour` at opacity `cover` (0 … 255).
pub(crate) fn fill_path(on: &mut Pixmap, path: &Path, colour: [u8; 3], cover: u8) {
    on.fill_path(path, &solid_paint(colour, cover), FillRule::Winding, Transform::identity(), None);
}

/// Returns a paint of `colour` at opacity `cover` (0 … 255).
pub(crate) fn solid_paint(colour: [u8; 3], cover: u8) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(Color::from_rgba8(colour[0], colour[1], colour[2], cover));
    paint
}

/// Converts glyph outlines to a path.
struct GlyphOutline {
    path: PathBuilder,
    x: f32,
    y: f32,
    scale: f32,
}

impl GlyphOutline {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.x + x * self.scale, self.y - y * self.scale)
    }
}

impl OutlineBuilder for GlyphOutline {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_sign_that_pictures_use() -> Result<()> {
        let ink = TextRenderer::new()?;
        for c in "t = 0.50 s, pressure − still water (Pa) m/s ² ³ δ ρ · ° é".chars() {
            assert!(ink.face.glyph_index(c).is_some(), "{c:?} is missing");
        }
        assert!(ink.width("wide", 20.0) > ink.width("thin", 20.0));
        Ok(())
    }
}
