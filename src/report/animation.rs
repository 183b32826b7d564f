//! The frames of a run as the page's player takes them: thinned to a budget, rounded to whole numbers, each frame as
//! its difference from the one before.

use std::collections::HashSet;

use serde::Serialize;

use super::{
    encoding::{BinaryData, zigzag},
    placement::Placement,
    run_data::{RunData, SceneGeometry},
};
use crate::{
    error::Result,
    output::{FramePoints, FrameSequence},
};

/// Places are told to this part of dp.
const PLACES: f32 = 1.0 / 48.0;

/// Values are told to this part of their usual range.
const VALUES: f32 = 1.0 / 600.0;

/// Most frames, and the least that are kept before particles are left out.
const FRAMES: [usize; 2] = [600, 60];

/// Most bytes of frames that are read: some seconds.
const MOST_READ: u64 = 1 << 30;

/// What the page says of a film; numbers are places in the blob.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Animation {
    /// Times of the kept frames, s.
    pub times: Vec<f64>,
    /// Particles in each.
    pub counts: Vec<usize>,
    /// Whether each stands for itself, not as a difference from the one before.
    pub alone: Vec<bool>,
    /// Where the first begins.
    pub offset: usize,
    /// The places, then the fields.
    pub channels: Vec<QuantisedChannel>,
    /// Particle spacing, m.
    pub dp: f32,
    /// Distance of the shown particles over dp: more than 1 where some are left out.
    pub apart: usize,
    /// Frames and water particles of the run.
    pub of: [usize; 2],
    /// Boundary particles of all solids, in the frames of their solids.
    pub skins: BoundaryAnimation,
    /// The usual range of each field that can be shown.
    pub ranges: Vec<(&'static str, [f64; 2])>,
}

/// A number that every particle has: value = min + step × whole number.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct QuantisedChannel {
    /// Its name.
    pub name: &'static str,
    /// Value of 0.
    pub min: f32,
    /// From one whole number to the next.
    pub step: f32,
}

/// The boundary particles, and the way of their solids.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct BoundaryAnimation {
    /// The local coordinates of all.
    pub channels: Vec<QuantisedChannel>,
    /// Where each coordinate begins.
    pub offsets: Vec<usize>,
    /// How many each solid has, one solid after the other.
    pub counts: Vec<usize>,
    /// Where the poses begin: for each frame and solid 3 coordinates and 9 entries of a matrix, row by row.
    pub poses: usize,
}

/// A frame with what is shown of it.
struct FrameSamples {
    t: f64,
    id: Vec<u32>,
    /// As many numbers for each channel as there are particles.
    x: Vec<Vec<f32>>,
}

/// Adds the film of `run` to `blob`: about `samples` times a particle in a frame.
///
/// # Errors
/// `File` if a frame cannot be read.
pub(crate) fn encode_animation(
    run: &RunData,
    film: &FrameSequence,
    samples: usize,
    blob: &mut BinaryData,
) -> Result<Animation> {
    let set = run.geometry.as_ref();
    let dimension = run.manifest.numeric_value("dimension").map_or(3, |x| x as usize).clamp(2, 3);
    let dp = run.manifest.numeric_value("dp").unwrap_or(0.0) as f32;
    let first = film.water(0)?;
    let all = first.position.len().max(1);
    let frames = film.times().len();
    // Whole multiples of dp: of a lattice a lattice is left, without gaps.
    let left = |apart: usize| (all / apart.pow(dimension as u32)).max(1);
    let fits = |apart: &usize| left(*apart) * FRAMES[1].min(frames) <= samples;
    let apart = if dp > 0.0 { (1..64).find(fits).unwrap_or(64) } else { 1 };
    let readable = (MOST_READ / film.bytes(frames / 2).max(1)) as usize;
    let most = (samples / left(apart)).clamp(2, FRAMES[0]).min(readable.max(2)).min(frames);
    let kept: Vec<usize> = (0..most).map(|k| (k * (frames - 1)).checked_div(most - 1).unwrap_or(0)).collect();
    let distance = (apart > 1).then_some((apart as f32, dp));
    // Into a cropped film come particles that were not there at first.
    let cropped = set.is_some_and(|set| set.plan.frames.as_ref().is_some_and(|frames| frames.crop.is_some()));
    let chosen: HashSet<u32> =
        subsample(&first, distance).into_iter().filter_map(|i| first.id.get(i).copied()).collect();
    let mut shown = Vec::new();
    for &number in &kept {
        let cloud = film.water(number)?;
        let order = match cloud.id.is_empty() || (cropped && apart > 1) {
            true => subsample(&cloud, distance),
            false => sorted_by_id(&cloud, |id| cropped || chosen.contains(id)),
        };
        shown.push(sample_frame(&cloud, film.times()[number], dimension, &order));
    }
    let channels = channels(&shown, &first, dimension, dp);
    let offset = blob.len();
    let alone = encode_frames(&shown, &channels, blob);
    let ranges = field_ranges(&shown, &channels, set);
    let skins = encode_boundaries(film, &kept, set, dimension, dp, blob)?;
    let counts = shown.iter().map(|frame| frame.id.len()).collect();
    let times = shown.iter().map(|frame| frame.t).collect();
    Ok(Animation { times, counts, alone, offset, channels, dp, apart, of: [frames, all], skins, ranges })
}

/// Particles about so many dp apart: the first in each cell of that size; all of them without a distance. Cells begin a
/// quarter of dp beside the places of a lattice.
fn subsample(cloud: &FramePoints, distance: Option<(f32, f32)>) -> Vec<usize> {
    let finite = |i: &usize| cloud.position[*i].iter().all(|x| x.is_finite());
    let all = (0..cloud.position.len()).filter(finite);
    let Some((apart, dp)) = distance else { return all.collect() };
    let mut cells = HashSet::new();
    let cell = |r: &[f32; 3]| r.map(|x| ((x / dp + 0.25) / apart).floor() as i64);
    all.filter(|&i| cells.insert(cell(&cloud.position[i]))).collect()
}

/// The `chosen` particles in the order of their numbers.
fn sorted_by_id(cloud: &FramePoints, chosen: impl Fn(&u32) -> bool) -> Vec<usize> {
    let finite = |i: usize| cloud.position[i].iter().all(|x| x.is_finite());
    let mut order: Vec<usize> = (0..cloud.position.len()).filter(|&i| chosen(&cloud.id[i]) && finite(i)).collect();
    order.sort_by_key(|&i| cloud.id[i]);
    order
}

/// What is shown of a frame, in the given `order`.
fn sample_frame(cloud: &FramePoints, t: f64, dimension: usize, order: &[usize]) -> FrameSamples {
    let take = |of: &dyn Fn(usize) -> f32| order.iter().map(|&i| of(i)).collect::<Vec<f32>>();
    let mut x: Vec<Vec<f32>> = (0..dimension).map(|c| take(&|i| cloud.position[i][c])).collect();
    if !cloud.pressure.is_empty() {
        x.push(take(&|i| cloud.pressure[i]));
    }
    if !cloud.velocity.is_empty() {
        x.push(take(&|i| cloud.velocity[i].iter().map(|v| v * v).sum::<f32>().sqrt()));
    }
    let id = if cloud.id.is_empty() { vec![0; order.len()] } else { order.iter().map(|&i| cloud.id[i]).collect() };
    FrameSamples { t, id, x }
}

fn channels(shown: &[FrameSamples], first: &FramePoints, dimension: usize, dp: f32) -> Vec<QuantisedChannel> {
    let mut names = ["x", "y", "z"][..dimension].to_vec();
    names.extend((!first.pressure.is_empty()).then_some("pressure"));
    names.extend((!first.velocity.is_empty()).then_some("speed"));
    let channel = |(c, name): (usize, &'static str)| {
        let all = || shown.iter().flat_map(|frame| frame.x[c].iter().copied()).filter(|x| x.is_finite());
        let (min, max) = (all().fold(f32::INFINITY, f32::min), all().fold(f32::NEG_INFINITY, f32::max));
        if min >= max || !min.is_finite() {
            return QuantisedChannel { name, min: if min.is_finite() { min } else { 0.0 }, step: 1.0 };
        }
        let wished = if c < dimension { PLACES * dp } else { VALUES * trimmed_range(all().collect(), 0.01) };
        QuantisedChannel { name, min, step: wished.max((max - min) / 65_000.0) }
    };
    names.into_iter().enumerate().map(channel).collect()
}

/// The range of the middle of `numbers`, without the share `cut` at either end.
fn trimmed_range(mut numbers: Vec<f32>, cut: f64) -> f32 {
    let [low, high] = quantiles(&mut numbers, [cut, 1.0 - cut]);
    high - low
}

fn quantiles(numbers: &mut [f32], shares: [f64; 2]) -> [f32; 2] {
    if numbers.is_empty() {
        return [0.0; 2];
    }
    let last = numbers.len() - 1;
    shares.map(|share| *numbers.select_nth_unstable_by((share * last as f64) as usize, f32::total_cmp).1)
}

fn encode_frames(shown: &[FrameSamples], channels: &[QuantisedChannel], blob: &mut BinaryData) -> Vec<bool> {
    let mut alone = Vec::new();
    let mut before: Option<(&[u32], Vec<Vec<u16>>)> = None;
    for frame in shown {
        let rounded: Vec<Vec<u16>> = channels.iter().zip(&frame.x).map(|(channel, x)| quantise(channel, x)).collect();
        let same = before.take().filter(|(id, _)| *id == frame.id);
        alone.push(same.is_none());
        for (c, now) in rounded.iter().enumerate() {
            match &same {
                Some((_, then)) => {
                    let steps: Vec<u16> = now.iter().zip(&then[c]).map(|(a, b)| zigzag(*a, *b)).collect();
                    blob.push_byte_planes(&steps);
                }
                None => {
                    blob.push_byte_planes(now);
                }
            }
        }
        // Particles without numbers are in another order in every frame.
        before = (frame.id.len() < 2 || frame.id[0] != frame.id[1]).then_some((&frame.id[..], rounded));
    }
    alone
}

fn quantise(channel: &QuantisedChannel, x: &[f32]) -> Vec<u16> {
    x.iter().map(|x| ((x - channel.min) / channel.step).round() as u16).collect()
}

/// The usual range of each field: of the pressure and the speed from 0, of what the pressure is more than that of
/// still water to both sides.
fn field_ranges(
    shown: &[FrameSamples],
    channels: &[QuantisedChannel],
    set: Option<&SceneGeometry>,
) -> Vec<(&'static str, [f64; 2])> {
    let find = |name: &str| channels.iter().position(|channel| channel.name == name);
    let gather = |c: usize| shown.iter().flat_map(|frame| frame.x[c].iter().copied()).collect::<Vec<f32>>();
    let mut ranges = Vec::new();
    if let Some(c) = find("pressure") {
        let [low, high] = quantiles(&mut gather(c), [0.02, 0.995]);
        let low = if low < -0.5 * high { f64::from(low) } else { 0.0 };
        ranges.push(("pressure", rounded_range(low, f64::from(high))));
        if let Some(set) = set.filter(|set| set.g > 0.0) {
            let up = set.dimension - 1;
            let still = |z: f32| set.rho0 * set.g * (set.level - f64::from(z)).max(0.0);
            let pairs = shown.iter().flat_map(|frame| frame.x[c].iter().zip(&frame.x[up]));
            let mut excess: Vec<f32> = pairs.map(|(p, z)| (f64::from(*p) - still(*z)).abs() as f32).collect();
            let [_, high] = quantiles(&mut excess, [0.0, 0.98]);
            let [_, high] = rounded_range(0.0, f64::from(high));
            ranges.push(("excess", [-high, high]));
        }
    }
    if let Some(c) = find("speed") {
        let [_, high] = quantiles(&mut gather(c), [0.0, 0.995]);
        ranges.push(("speed", rounded_range(0.0, f64::from(high))));
    }
    ranges
}

/// The range with two digits that count at its ends.
fn rounded_range(low: f64, high: f64) -> [f64; 2] {
    let size = low.abs().max(high.abs());
    if size <= 0.0 || !size.is_finite() {
        return [0.0, 1.0];
    }
    let unit = 10f64.powf(size.log10().floor() - 1.0);
    let clean = |x: f64| if unit < 1.0 { x.round() / (1.0 / unit).round() } else { x.round() * unit };
    [clean((low / unit).floor()), clean((high / unit).ceil())]
}

/// Boundary particles in the frames of their solids, and the poses of these in the `kept` frames.
fn encode_boundaries(
    film: &FrameSequence,
    kept: &[usize],
    set: Option<&SceneGeometry>,
    dimension: usize,
    dp: f32,
    blob: &mut BinaryData,
) -> Result<BoundaryAnimation> {
    let Some(set) = set else { return Ok(BoundaryAnimation::default()) };
    let first = film.solids(0)?;
    let members: Vec<Vec<usize>> = (0..set.solids.len()).map(|i| points_of_solid(&first, i)).collect();
    let local: Vec<[f64; 3]> = members
        .iter()
        .zip(&set.solids)
        .flat_map(|(own, solid)| own.iter().map(|&k| solid.start.to_local(&first.position[k])))
        .collect();
    let (mut channels, mut offsets) = (Vec::new(), Vec::new());
    for (c, name) in ["x", "y", "z"].into_iter().enumerate().take(dimension) {
        let x: Vec<f32> = local.iter().map(|x| x[c] as f32).collect();
        let (min, max) = x.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        let step = (PLACES * dp).max((max - min) / 65_000.0);
        let channel = QuantisedChannel { name, min: if min.is_finite() { min } else { 0.0 }, step };
        offsets.push(blob.push_byte_planes(&quantise(&channel, &x)));
        channels.push(channel);
    }
    let mut poses = Vec::new();
    for &number in kept {
        let now = film.solids(number)?;
        for (own, solid) in members.iter().zip(&set.solids) {
            let pose = solid_placement(solid.role == "fixed", &solid.start, own, &first, &now);
            poses.extend(pose.at.iter().chain(pose.turn.iter().flatten()).map(|x| *x as f32));
        }
    }
    Ok(BoundaryAnimation {
        channels,
        offsets,
        counts: members.iter().map(Vec::len).collect(),
        poses: blob.push_floats(poses),
    })
}

/// The boundary particles of solid `number` among those of all.
pub(crate) fn points_of_solid(all: &FramePoints, number: usize) -> Vec<usize> {
    (0..all.solid_index.len()).filter(|&k| all.solid_index[k] as usize == number).collect()
}

/// Where a solid with the boundary particles `own` is `now`.
pub(crate) fn solid_placement(
    fixed: bool,
    start: &Placement,
    own: &[usize],
    first: &FramePoints,
    now: &FramePoints,
) -> Placement {
    if fixed || own.is_empty() || now.position.len() != first.position.len() {
        return *start;
    }
    // A few hundred points tell a motion as well as all.
    let some = || own.iter().step_by(own.len().div_ceil(400));
    let points = |cloud: &FramePoints| some().map(|&k| cloud.position[k]).collect::<Vec<_>>();
    start.fitted_to(&points(first), &points(now))
}

#[cfg(test)]
#[path = "../../tests/unit/report/animation.rs"]
mod tests;
