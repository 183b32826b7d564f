//! Draws pictures of frames without a browser: runs side by side and times one below another, at equal scales.

use std::path::{Path, PathBuf};

use tiny_skia::{Color, Pixmap};

use super::{
    animation::{points_of_solid, solid_placement},
    canvas::{PanelView, TITLE_COLOUR, draw_colour_bar},
    colour::{ColourMap, FIELD_COLOUR_MAPS},
    run_data::{DrawnSolid, RunData, SceneGeometry},
    text::{Anchor, TextRenderer},
};
use crate::{
    error::{Error, ErrorKind, Result},
    output::{FramePoints, FrameSequence, require_parent_folder, write_atomically},
};

/// The field that determines the colour of the particles in a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourField {
    /// The pressure, Pa.
    #[default]
    Pressure,
    /// The excess over the hydrostatic pressure at the same position, Pa.
    ExcessPressure,
    /// The speed, m/s.
    Speed,
}

/// The content of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOptions {
    /// The times, s; the picture shows the nearest frame to each time. An empty list selects the last frame.
    pub times: Vec<f64>,
    /// The field that determines the colour of the particles.
    pub field: ColourField,
    /// The values at the two ends of the colour scale; the default is the usual range of all shown values.
    pub range: Option<[f64; 2]>,
    /// The width of the picture, pixels.
    pub width: u32,
    /// The titles of the columns, one for each run; an empty list selects the names of the run folders.
    pub column_titles: Vec<String>,
}

/// The nearness of a point to the viewer, its position in the picture plane (m), and its value.
type DepthPoint = (f64, [f64; 2], Option<f64>);

/// The lines of a solid in the picture plane.
pub(crate) struct SolidLines {
    /// The points of each line, m, and whether the line is closed.
    pub lines: Vec<(Vec<[f64; 2]>, bool)>,
    /// Whether the solid moves.
    pub moves: bool,
}

/// A frame of a run, prepared for drawing.
pub(crate) struct Panel<'a> {
    /// The geometry of the scene.
    pub geometry: &'a SceneGeometry,
    /// The time of the frame, s.
    pub t: f64,
    /// The points in the picture plane (m) from back to front, with their values; points of bodies have no value.
    pub points: Vec<([f64; 2], Option<f64>)>,
    /// The lines of the solids.
    pub solids: Vec<SolidLines>,
}

impl ColourField {
    /// Returns the colour map of the field.
    pub(crate) fn colour_map(self) -> ColourMap {
        match self {
            Self::Pressure => FIELD_COLOUR_MAPS.pressure,
            Self::ExcessPressure => FIELD_COLOUR_MAPS.excess,
            Self::Speed => FIELD_COLOUR_MAPS.speed,
        }
    }

    /// Returns the title of the colour bar.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Pressure => "pressure, Pa",
            Self::ExcessPressure => "pressure − that of still water, Pa",
            Self::Speed => "speed, m/s",
        }
    }

    /// Returns the value of the field at particle `i` of `water`.
    fn value(self, water: &FramePoints, i: usize, set: &SceneGeometry) -> f64 {
        let pressure = || f64::from(water.pressure[i]);
        match self {
            Self::Pressure => pressure(),
            Self::ExcessPressure => {
                let depth = set.level - f64::from(water.position[i][set.dimension - 1]);
                pressure() - set.rho0 * set.g * depth.max(0.0)
            }
            Self::Speed => water.velocity[i].iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt(),
        }
    }

    fn is_available(self, water: &FramePoints) -> bool {
        match self {
            Self::Speed => !water.velocity.is_empty(),
            Self::Pressure | Self::ExcessPressure => !water.pressure.is_empty(),
        }
    }
}

/// Draws the runs in `folders` side by side and the times of `shot` one below another, to the PNG file `out`. Returns
/// the size of the picture in pixels.
///
/// # Errors
/// `Restart` if a folder contains no run; `Usage` if a run has no frames, its frames lack the field, or the picture is
/// too large; `File` if a frame cannot be read or `out` cannot be written.
pub fn write_picture(folders: &[PathBuf], shot: &PictureOptions, out: &Path) -> Result<(u32, u32)> {
    require_parent_folder(out)?;
    let runs = RunData::read_all(folders)?;
    let mut rows: Vec<Vec<Panel>> = Vec::new();
    let last = [f64::INFINITY];
    let times = if shot.times.is_empty() { &last[..] } else { &shot.times };
    for &t in times {
        rows.push(runs.iter().map(|run| read_panel(run, t, shot.field)).collect::<Result<_>>()?);
    }
    let range = shot.range.unwrap_or_else(|| range(&rows, shot.field));
    let own = shot.column_titles.len() == runs.len();
    let names: Vec<&str> =
        runs.iter().enumerate().map(|(i, run)| if own { &shot.column_titles[i] } else { &run.name }.as_str()).collect();
    let sheet = render(&names, &rows, shot, range)?;
    let png = sheet.encode_png().map_err(|why| Error::file(out, why))?;
    write_atomically(out, &png)?;
    Ok((sheet.width(), sheet.height()))
}

/// Reads the frame of `run` nearest to time `t` (s).
fn read_panel(run: &RunData, t: f64, field: ColourField) -> Result<Panel<'_>> {
    let refused = |what: &str| Error::new(ErrorKind::Usage, format!("{}: {what}", run.folder.display()));
    let film = run.frames.as_ref().ok_or_else(|| {
        refused("the run has no frames")
            .help("write [frames] in its scene, with every = … in seconds, and run it again")
    })?;
    let set = run.geometry.as_ref().ok_or_else(|| refused(run.remarks.first().map_or("its scene is lost", |x| x)))?;
    let number = if t.is_finite() { film.nearest_index(t) } else { film.times().len() - 1 };
    let water = film.water(number)?;
    if water.position.is_empty() {
        let help = "draw other times with --time, or run the scene again with a larger frames.box";
        return Err(refused(&format!("its frame at t = {} s holds no water", film.times()[number])).help(help));
    }
    if !field.is_available(&water) {
        return Err(refused("its frames lack what the picture is coloured by")
            .help("name pressure and velocity under fields of [frames] in its scene"));
    }
    let flat = set.dimension == 2;
    let mut points: Vec<DepthPoint> = (0..water.position.len())
        .map(|i| {
            let (on, depth) = project(&water.position[i].map(f64::from), flat);
            (depth, on, Some(field.value(&water, i, set)))
        })
        .collect();
    if !flat {
        points.extend(solid_points(film, number, set)?);
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let points = points.into_iter().map(|(_, on, value)| (on, value)).collect();
    let solids = solid_lines(film, number, set, flat)?;
    Ok(Panel { geometry: set, t: film.times()[number], points, solids })
}

/// Returns the depth and position in the picture plane of the boundary particles of moving solids, in frame `number` of
/// a 3-D run.
fn solid_points(film: &FrameSequence, number: usize, set: &SceneGeometry) -> Result<Vec<DepthPoint>> {
    let cloud = film.solids(number)?;
    let moves = |k: usize| set.solids.get(cloud.solid_index[k] as usize).is_some_and(|solid| solid.role != "fixed");
    let own =
        (0..cloud.solid_index.len()).filter(|&k| moves(k)).map(|k| project(&cloud.position[k].map(f64::from), false));
    Ok(own.map(|(on, depth)| (depth, on, None)).collect())
}

/// Returns the lines of all solids, and the springs, ropes and mooring lines in frame `number`.
fn solid_lines(film: &FrameSequence, number: usize, set: &SceneGeometry, flat: bool) -> Result<Vec<SolidLines>> {
    let (first, now) = (film.solids(0)?, film.solids(number)?);
    let drawn = |(i, solid): (usize, &DrawnSolid)| {
        let own = points_of_solid(&first, i);
        let fixed = solid.role == "fixed";
        let pose = solid_placement(fixed, &solid.start, &own, &first, &now);
        let on_plane = |x: &[f64; 3]| project(&pose.to_world(x), flat).0;
        let lines = solid.lines.iter().map(|line| (line.points.iter().map(on_plane).collect(), line.closed)).collect();
        SolidLines { lines, moves: !fixed }
    };
    let mut all: Vec<SolidLines> = set.solids.iter().enumerate().map(drawn).collect();
    let t = film.times()[number];
    let placed = |x: &[f64; 3], solid: Option<usize>| match solid.and_then(|i| Some((i, set.solids.get(i)?))) {
        None => *x,
        Some((i, solid)) => {
            let own = points_of_solid(&first, i);
            solid_placement(solid.role == "fixed", &solid.start, &own, &first, &now).to_world(x)
        }
    };
    let ties = set.ties.iter().filter(|tie| tie.acts_at(t));
    let ties = ties.map(|tie| [0, 1].map(|k| placed(&tie.ends[k], tie.solids[k]).map(|x| x as f32)).to_vec());
    // A line that runs there and back encloses no area.
    let there_and_back = |nodes: Vec<[f32; 3]>| {
        let on_plane = |x: &[f32; 3]| project(&x.map(f64::from), flat).0;
        let nodes: Vec<[f64; 2]> = nodes.iter().map(on_plane).collect();
        (nodes.iter().chain(nodes.iter().rev()).copied().collect(), false)
    };
    let lines: Vec<_> = ties.chain(film.moorings(number)?).map(there_and_back).collect();
    if !lines.is_empty() {
        all.push(SolidLines { lines, moves: true });
    }
    Ok(all)
}

/// Returns the position of a point in the picture plane (m) and its nearness to the viewer. A 3-D view is from the
/// front, rotated and from above.
fn project(x: &[f64; 3], flat: bool) -> ([f64; 2], f64) {
    if flat {
        return ([x[0], x[1]], 0.0);
    }
    let ((sy, cy), (sp, cp)) = (0.5_f64.sin_cos(), 0.4_f64.sin_cos());
    let (right, back) = (cy * x[0] + sy * x[1], -sy * x[0] + cy * x[1]);
    ([right, sp * back + cp * x[2]], sp * x[2] - cp * back)
}

/// Returns the usual range of the values in `rows`, rounded; the range starts at 0 or is symmetric about 0.
fn range(rows: &[Vec<Panel>], field: ColourField) -> [f64; 2] {
    let all = rows.iter().flatten().flat_map(|panel| panel.points.iter().filter_map(|(_, x)| Some(x.as_ref()?.abs())));
    let mut all: Vec<f64> = all.filter(|x| x.is_finite()).collect();
    if all.is_empty() {
        return [0.0, 1.0];
    }
    let place = (0.99 * (all.len() - 1) as f64) as usize;
    let high = *all.select_nth_unstable_by(place, f64::total_cmp).1;
    let unit = 10f64.powf(high.max(1e-12).log10().floor() - 1.0);
    let high = (high.max(1e-12) / unit).ceil() * unit;
    if field == ColourField::ExcessPressure { [-high, high] } else { [0.0, high] }
}

/// Returns the part of the picture plane that every panel shows, as its low and high corner, m.
fn bounds(rows: &[Vec<Panel>]) -> [[f64; 2]; 2] {
    let mut around = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let mut dp = 0.0_f64;
    let mut take = |x: &[f64; 2]| {
        for i in 0..2 {
            around[0][i] = around[0][i].min(x[i]);
            around[1][i] = around[1][i].max(x[i]);
        }
    };
    for panel in rows.iter().flatten() {
        dp = dp.max(panel.geometry.dp);
        panel.points.iter().for_each(|(x, _)| take(x));
        let moving = panel.solids.iter().filter(|solid| solid.moves || panel.geometry.dimension == 3);
        moving.flat_map(|solid| &solid.lines).flat_map(|(points, _)| points).for_each(&mut take);
    }
    if around[0][0] > around[1][0] {
        return [[0.0; 2], [1.0; 2]];
    }
    [around[0].map(|x| x - 4.0 * dp), around[1].map(|x| x + 4.0 * dp)]
}

fn render(names: &[&str], rows: &[Vec<Panel>], shot: &PictureOptions, range: [f64; 2]) -> Result<Pixmap> {
    let ink = TextRenderer::new()?;
    let [low, high] = bounds(rows);
    let columns = names.len() as f32;
    let width = shot.width.clamp(200, 16_000) as f32;
    let em = (width / columns / 36.0).clamp(11.0, 28.0);
    let (left, gap) = (4.0 * em, 1.2 * em);
    let wide = ((width - left - gap) / columns - gap).max(20.0);
    let scale = f64::from(wide) / (high[0] - low[0]);
    let tall = (scale * (high[1] - low[1])) as f32;
    let (head, foot) = (2.2 * em, 5.0 * em);
    let step = tall + 3.6 * em;
    let height = head + step * rows.len() as f32 + foot;
    let sheet = (height.is_finite() && height < 32_000.0).then(|| Pixmap::new(width as u32, height.ceil() as u32));
    let Some(mut on) = sheet.flatten() else {
        return Err(Error::new(ErrorKind::Usage, format!("a picture {width} pixels wide would be {height} high"))
            .help("ask for fewer times, or a smaller --width"));
    };
    on.fill(Color::WHITE);
    for (r, row) in rows.iter().enumerate() {
        for (c, panel) in row.iter().enumerate() {
            let corner = ((left + (wide + gap) * c as f32).floor(), (head + step * r as f32).floor());
            let place = PanelView { low, high, scale, corner, size: (wide, tall), em };
            place.draw_panel(&mut on, panel, shot.field.colour_map(), range);
            if panel.geometry.dimension == 2 {
                place.draw_ticks(&mut on, &ink, c == 0);
            }
            let title = format!(
                "{}t = {:.3} s",
                if names.len() > 1 { format!("{}, ", names[c]) } else { String::new() },
                panel.t
            );
            ink.write(&mut on, &title, (corner.0, corner.1 - 0.5 * em), em, Anchor::Start, TITLE_COLOUR);
        }
    }
    let bar = (left.floor(), (height - foot + 0.6 * em).floor(), width - left - 2.0 * gap, 0.9 * em);
    draw_colour_bar(&mut on, &ink, bar, em, shot.field, range);
    Ok(on)
}
