//! Draws the parts of a picture: panels with particles and solids, axes in metres, and the colour bar.

use tiny_skia::{Path, PathBuilder, Pixmap, PixmapPaint, Rect, Stroke, Transform};

use super::{
    colour::{self, ColourMap},
    picture::{ColourField, Panel, SolidLines},
    plot::round_step,
    text::{Anchor, TextRenderer, fill_path, solid_paint},
};
use crate::math::format::{decimals, with_minus_sign};

/// The colour of titles.
pub(crate) const TITLE_COLOUR: [u8; 3] = [40, 46, 52];
const QUIET: [u8; 3] = [110, 118, 126];
const BODY: [u8; 3] = [203, 196, 186];
const WALL: [u8; 3] = [226, 228, 230];
const EDGE: [u8; 3] = [70, 66, 60];

/// The position and scale of a panel in the picture.
pub(crate) struct PanelView {
    /// The low corner of the shown part of the picture plane, m.
    pub low: [f64; 2],
    /// The high corner, m.
    pub high: [f64; 2],
    /// The scale, pixels per metre.
    pub scale: f64,
    /// The upper left corner of the panel, pixels.
    pub corner: (f32, f32),
    /// The width and height of the panel, pixels.
    pub size: (f32, f32),
    /// The text size, pixels.
    pub em: f32,
}

impl PanelView {
    fn to_pixel(&self, x: &[f64; 2]) -> (f32, f32) {
        let across = (self.scale * (x[0] - self.low[0])) as f32;
        (self.corner.0 + across, self.corner.1 + (self.scale * (self.high[1] - x[1])) as f32)
    }

    /// Draws `panel` on a separate image, which clips parts outside the panel, and copies the image to the picture
    /// `on`.
    pub(crate) fn draw_panel(&self, on: &mut Pixmap, panel: &Panel, map: ColourMap, range: [f64; 2]) {
        let Some(mut own) = Pixmap::new(self.size.0.ceil() as u32, self.size.1.ceil() as u32) else { return };
        let flat = panel.geometry.dimension == 2;
        let here = PanelView { corner: (0.0, 0.0), ..*self };
        for solid in panel.solids.iter().filter(|solid| !solid.moves || !flat) {
            here.draw_solid(&mut own, solid, (flat && !solid.moves).then_some(WALL), 0.06);
        }
        let radius = (0.58 * panel.geometry.dp * self.scale) as f32;
        for (x, value) in &panel.points {
            let share = |value: &f64| colour::colour_at(map, (value - range[0]) / (range[1] - range[0]));
            draw_particle(&mut own, here.to_pixel(x), radius, value.as_ref().map_or(BODY, share), !flat);
        }
        for solid in panel.solids.iter().filter(|solid| solid.moves && flat) {
            here.draw_solid(&mut own, solid, Some(BODY), 0.12);
        }
        let (x, y) = (self.corner.0 as i32, self.corner.1 as i32);
        on.draw_pixmap(x, y, own.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
    }

    /// Returns the lines of a solid as one path.
    fn path(&self, solid: &SolidLines) -> Option<Path> {
        let mut path = PathBuilder::new();
        for (points, closed) in &solid.lines {
            for (i, x) in points.iter().enumerate() {
                let (x, y) = self.to_pixel(x);
                if i == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
            }
            if *closed {
                path.close();
            }
        }
        path.finish()
    }

    /// Draws the lines of a solid, of width `thick` in em.
    fn draw_solid(&self, on: &mut Pixmap, solid: &SolidLines, inside: Option<[u8; 3]>, thick: f32) {
        let Some(path) = self.path(solid) else { return };
        if let Some(colour) = inside {
            fill_path(on, &path, colour, 255);
        }
        let stroke = Stroke { width: (thick * self.em).max(1.0), ..Stroke::default() };
        let cover = if inside.is_some() { 255 } else { 110 };
        on.stroke_path(&path, &solid_paint(EDGE, cover), &stroke, Transform::identity(), None);
    }

    /// Draws the scale in metres along the lower edge, and along the left edge of the `first` panel of a row.
    pub(crate) fn draw_ticks(&self, on: &mut Pixmap, ink: &TextRenderer, first: bool) {
        let (em, small) = (self.em, 0.8 * self.em);
        let bottom = self.corner.1 + self.size.1;
        for x in tick_values(self.low[0], self.high[0], 6.0) {
            let (px, _) = self.to_pixel(&[x, self.low[1]]);
            self.draw_tick(on, (px, bottom), (px, bottom + 0.3 * em));
            ink.write(on, &tick_label(x), (px, bottom + 1.2 * em), small, Anchor::Middle, QUIET);
        }
        let count = (6.0 * self.size.1 / self.size.0).max(2.0);
        for y in tick_values(self.low[1], self.high[1], f64::from(count)) {
            let (_, py) = self.to_pixel(&[self.low[0], y]);
            self.draw_tick(on, (self.corner.0 - 0.3 * em, py), (self.corner.0, py));
            if first {
                let at = (self.corner.0 - 0.5 * em, py + 0.3 * em);
                ink.write(on, &tick_label(y), at, small, Anchor::End, QUIET);
            }
        }
        if first {
            ink.write(on, "m", (self.corner.0 - 0.5 * em, bottom + 1.2 * em), small, Anchor::End, QUIET);
        }
    }

    fn draw_tick(&self, on: &mut Pixmap, from: (f32, f32), to: (f32, f32)) {
        let mut path = PathBuilder::new();
        path.move_to(from.0, from.1);
        path.line_to(to.0, to.1);
        if let Some(path) = path.finish() {
            let stroke = Stroke { width: (0.06 * self.em).max(1.0), ..Stroke::default() };
            on.stroke_path(&path, &solid_paint(QUIET, 255), &stroke, Transform::identity(), None);
        }
    }
}

/// Draws a particle as a disc, as a square if it is only a few pixels wide, or as a shaded sphere if `ball` is true.
fn draw_particle(on: &mut Pixmap, (x, y): (f32, f32), radius: f32, colour: [u8; 3], ball: bool) {
    if radius < 1.5 {
        let side = (2.0 * radius).max(0.5);
        if let Some(square) = Rect::from_xywh(x - radius, y - radius, side, side) {
            on.fill_rect(square, &solid_paint(colour, 255), Transform::identity(), None);
        }
        return;
    }
    let mut disc = |x: f32, y: f32, radius: f32, colour: [u8; 3]| {
        if let Some(path) = PathBuilder::from_circle(x, y, radius) {
            fill_path(on, &path, colour, 255);
        }
    };
    if ball {
        disc(x, y, radius, colour.map(|c| (0.72 * f32::from(c)) as u8));
        disc(x - 0.12 * radius, y - 0.16 * radius, 0.8 * radius, colour);
    } else {
        disc(x, y, radius, colour);
    }
}

/// Draws the colour bar over the range, with ticks.
pub(crate) fn draw_colour_bar(
    on: &mut Pixmap,
    ink: &TextRenderer,
    bar: (f32, f32, f32, f32),
    em: f32,
    field: ColourField,
    range: [f64; 2],
) {
    let wide = bar.2.min(40.0 * em).floor();
    for i in 0..wide as u32 {
        let colour = colour::colour_at(field.colour_map(), f64::from(i) / f64::from(wide));
        if let Some(strip) = Rect::from_xywh(bar.0 + i as f32, bar.1, 1.0, bar.3) {
            on.fill_rect(strip, &solid_paint(colour, 255), Transform::identity(), None);
        }
    }
    for x in bar_values(range) {
        let at = bar.0 + wide * ((x - range[0]) / (range[1] - range[0])) as f32;
        ink.write(on, &tick_label(x), (at, bar.1 + bar.3 + 1.2 * em), 0.8 * em, Anchor::Middle, TITLE_COLOUR);
    }
    ink.write(on, field.title(), (bar.0, bar.1 + bar.3 + 2.7 * em), em, Anchor::Start, TITLE_COLOUR);
}

/// Returns about `count` round numbers between `low` and `high`.
fn tick_values(low: f64, high: f64, count: f64) -> Vec<f64> {
    let step = round_step(((high - low) / count).max(1e-300));
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Returns the values that a colour bar over `range` shows: both ends, and the round numbers that are at least half a step from them.
fn bar_values([low, high]: [f64; 2]) -> Vec<f64> {
    let round = tick_values(low, high, 6.0);
    let apart = round.get(1).map_or(0.0, |next| 0.5 * (next - round[0]));
    let inner = round.into_iter().filter(|x| (x - low).min(high - x) >= apart && *x > low && *x < high);
    std::iter::once(low).chain(inner).chain([high]).collect()
}

/// Returns the label of a tick, without round-off from the multiple of the step.
fn tick_label(x: f64) -> String {
    with_minus_sign(&decimals(x, 9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_within() {
        assert_eq!(tick_values(-0.1, 1.05, 6.0), [0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0]);
        assert_eq!(tick_label(tick_values(0.0, 1.0, 6.0)[3]), "0.6");
        assert_eq!(tick_values(0.0, 3000.0, 6.0).last(), Some(&3000.0));
    }

    #[test]
    fn a_colour_bar_has_the_numbers_of_both_ends() {
        let labels = |range| bar_values(range).into_iter().map(tick_label).collect::<Vec<_>>();
        assert_eq!(labels([0.0, 0.41]), ["0", "0.1", "0.2", "0.3", "0.41"], "0.4 would lie on 0.41");
        assert_eq!(labels([0.0, 0.36]), ["0", "0.1", "0.2", "0.3", "0.36"]);
        assert_eq!(
            labels([-600.0, 600.0]),
            ["−600", "−400", "−200", "0", "200", "400", "600"],
            "round ends stand once"
        );
    }
}
