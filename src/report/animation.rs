//! Converts the frames of a run for the player of the page: limits the total size, rounds the values to integers and
//! stores the differences between successive frames.

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

/// The resolution of positions, as a fraction of dp.
const PLACES: f32 = 1.0 / 48.0;

/// The resolution of field values, as a fraction of their usual range.
const VALUES: f32 = 1.0 / 600.0;

/// The names of the coordinates.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The largest number of frames, and the smallest number of frames before the program omits particles.
const FRAMES: [usize; 2] = [600, 60];

/// The largest total size of the frames to read, bytes; reading this size takes several seconds.
const MOST_READ: u64 = 1 << 30;

/// The description of an animation for the page. The position fields are positions in the binary data.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Animation {
    /// The times of the kept frames, s.
    pub times: Vec<f64>,
    /// The number of particles in each frame.
    pub counts: Vec<usize>,
    /// Whether each frame contains full values instead of differences from the previous frame.
    pub alone: Vec<bool>,
    /// How the particles of each frame differ from those of the previous frame, if they do and are mostly the same.
    pub changes: Vec<Option<ParticleChange>>,
    /// The position of the first frame.
    pub offset: usize,
    /// The channels: the coordinates, then the fields.
    pub channels: Vec<QuantisedChannel>,
    /// The particle spacing, m.
    pub dp: f32,
    /// The spacing of the shown particles divided by dp; values above 1 mean that the page omits particles.
    pub apart: usize,
    /// The numbers of frames and water particles of the run.
    pub of: [usize; 2],
    /// The boundary particles of all solids, each in the local frame of its solid.
    pub skins: BoundaryAnimation,
    /// The mooring lines, if the frames contain any.
    pub lines: Option<LineAnimation>,
    /// The usual range of each field that the page can show.
    pub ranges: Vec<(&'static str, [f64; 2])>,
}

/// The particles that are in one of two successive frames only.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct ParticleChange {
    /// The position of the numbers, in the earlier frame, of the particles that have gone. The numbers, in the later frame, of
    /// the new particles follow.
    pub at: usize,
    /// The number of particles that have gone.
    pub gone: usize,
    /// The number of new particles.
    pub new: usize,
}

/// A quantity of each particle, stored as integers: value = min + step × integer.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct QuantisedChannel {
    /// The name of the quantity.
    pub name: &'static str,
    /// The value of the integer 0.
    pub min: f32,
    /// The difference in value between successive integers.
    pub step: f32,
}

/// The boundary particles and the motion of their solids.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct BoundaryAnimation {
    /// The local coordinates of all boundary particles.
    pub channels: Vec<QuantisedChannel>,
    /// The position of the first value of each coordinate.
    pub offsets: Vec<usize>,
    /// The number of boundary particles of each solid, in the order of the solids.
    pub counts: Vec<usize>,
    /// The position of the first pose. A pose has 3 coordinates and 9 matrix entries, row by row, for each frame and
    /// solid.
    pub poses: usize,
}

/// The nodes of the mooring lines, stored as the particles are.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct LineAnimation {
    /// The number of nodes in each frame.
    pub counts: Vec<usize>,
    /// Whether each frame contains full values instead of differences from the previous frame.
    pub alone: Vec<bool>,
    /// How the nodes of each frame differ from those of the previous frame.
    pub changes: Vec<Option<ParticleChange>>,
    /// The position of the first frame.
    pub offset: usize,
    /// The coordinates.
    pub channels: Vec<QuantisedChannel>,
    /// The number of nodes of each line in each frame. A line that does not act is absent; a broken one counts twice.
    pub nodes: Vec<Vec<usize>>,
}

/// A frame, reduced to the shown particles and fields.
struct FrameSamples {
    t: f64,
    id: Vec<u32>,
    /// The values of each channel, with one value for each particle.
    x: Vec<Vec<f32>>,
}

/// The particles that an animation shows of a run, in all frames alike.
pub(crate) struct ShownParticles {
    dimension: usize,
    /// The particle spacing, m.
    dp: f32,
    /// The names of the channels.
    names: Vec<&'static str>,
    /// The spacing of the shown particles divided by dp.
    apart: usize,
    /// The number of water particles in the first frame.
    all: usize,
    /// The identifiers of all particles of the first frame, and of the chosen ones, if particles are omitted.
    known: HashSet<u32>,
    chosen: HashSet<u32>,
}

impl ShownParticles {
    /// Chooses the particles so that `frames` frames have about `samples` particles in total.
    ///
    /// # Errors
    /// `File` if the first frame cannot be read.
    pub(crate) fn choose(run: &RunData, film: &FrameSequence, samples: usize, frames: usize) -> Result<Self> {
        let dimension = run.manifest.numeric_value("dimension").map_or(3, |x| x as usize).clamp(2, 3);
        let dp = run.manifest.numeric_value("dp").unwrap_or(0.0) as f32;
        let first = film.water(0)?;
        let all = first.position.len().max(1);
        // The sampling distance is a whole multiple of dp, so that a sampled lattice is again a lattice without gaps.
        let fits = |apart: &usize| (all / apart.pow(dimension as u32)).max(1) * FRAMES[1].min(frames) <= samples;
        let apart = if dp > 0.0 { (1..64).find(fits).unwrap_or(64) } else { 1 };
        let names = channel_names(&first, dimension);
        let mut shown = Self { dimension, dp, names, apart, all, known: HashSet::new(), chosen: HashSet::new() };
        if let Some(distance) = shown.distance() {
            // In cropped frames and beside inflows, particles appear that are absent from the first frame.
            shown.known = first.id.iter().copied().collect();
            let chosen = subsample(&first, Some(distance));
            shown.chosen = chosen.into_iter().filter_map(|i| first.id.get(i).copied()).collect();
        }
        Ok(shown)
    }

    /// The number of particles that are shown in a frame, roughly.
    pub(crate) fn count(&self) -> usize {
        (self.all / self.apart.pow(self.dimension as u32)).max(1)
    }

    /// The spacing of the shown particles in multiples of dp, and dp (m), if particles are omitted.
    fn distance(&self) -> Option<(f32, f32)> {
        (self.apart > 1).then_some((self.apart as f32, self.dp))
    }

    /// Reads the shown particles of frame `number`.
    fn read(&self, film: &FrameSequence, number: usize) -> Result<FrameSamples> {
        let cloud = film.water(number)?;
        let order = if self.apart == 1 && !cloud.id.is_empty() {
            sorted_by_id(&cloud, |_| true)
        } else if cloud.id.is_empty() || cloud.id.iter().any(|id| !self.known.contains(id)) {
            subsample(&cloud, self.distance())
        } else {
            sorted_by_id(&cloud, |id| self.chosen.contains(id))
        };
        Ok(sample_frame(&cloud, film.times()[number], self.dimension, &order))
    }

    /// Adds the animation of the frames `numbers` to `blob`, and returns its description; without the boundary particles
    /// unless `with_boundaries`.
    ///
    /// # Errors
    /// `File` if a frame cannot be read.
    pub(crate) fn encode(
        &self,
        film: &FrameSequence,
        numbers: &[usize],
        set: Option<&SceneGeometry>,
        with_boundaries: bool,
        blob: &mut BinaryData,
    ) -> Result<Animation> {
        let Self { dimension, dp, apart, all, .. } = *self;
        let shown = numbers.iter().map(|&number| self.read(film, number)).collect::<Result<Vec<_>>>()?;
        let channels = channels(&shown, self.names.clone(), dimension, dp);
        let offset = blob.len();
        let (alone, changes) = encode_frames(&shown, &channels, blob);
        let ranges = field_ranges(&shown, &channels, set);
        let skins = encode_boundaries(film, numbers, set, with_boundaries.then_some((dimension, dp)), blob)?;
        let lines = encode_lines(film, numbers, dimension, dp, blob)?;
        let counts = shown.iter().map(|frame| frame.id.len()).collect();
        let times = shown.iter().map(|frame| frame.t).collect();
        Ok(Animation {
            times,
            counts,
            alone,
            changes,
            offset,
            channels,
            dp,
            apart,
            of: [film.times().len(), all],
            skins,
            lines,
            ranges,
        })
    }
}

/// Adds the animation of `run` to `blob`, and returns its description, with a remark on each frame that is left out because it
/// cannot be read. The total number of particles over all frames is about `samples`; particles are chosen as for at least
/// `expected` frames.
///
/// # Errors
/// `File` if the first frame, to which the poses of the solids refer, cannot be read.
pub(crate) fn encode_animation(
    run: &RunData,
    film: &FrameSequence,
    samples: usize,
    expected: usize,
    blob: &mut BinaryData,
) -> Result<(Animation, Vec<String>)> {
    let frames = film.times().len();
    let shown = ShownParticles::choose(run, film, samples, frames.max(expected))?;
    let readable = (MOST_READ / film.bytes(frames / 2).max(1)) as usize;
    let most = (samples / shown.count()).clamp(2, FRAMES[0]).min(readable.max(2)).min(frames);
    let kept: Vec<usize> = (0..most).map(|k| (k * (frames - 1)).checked_div(most - 1).unwrap_or(0)).collect();
    let begin = blob.len();
    let why = match shown.encode(film, &kept, run.geometry.as_ref(), true, blob) {
        Ok(animation) => return Ok((animation, Vec::new())),
        Err(why) => why,
    };
    blob.truncate(begin);
    let mut remarks = Vec::new();
    let mut is_whole = |number: &usize| {
        let read = film.water(*number).and(film.solids(*number)).map(drop).and(film.moorings(*number).map(drop));
        remarks.extend(read.as_ref().err().map(|why| format!("frame {number} is left out: {}", why.message)));
        read.is_ok()
    };
    let whole: Vec<usize> = kept.into_iter().filter(&mut is_whole).collect();
    if whole.is_empty() {
        return Err(why);
    }
    Ok((shown.encode(film, &whole, run.geometry.as_ref(), true, blob)?, remarks))
}

/// Returns the indices of particles about `distance` apart: the first particle in each cell of that size, or all
/// particles without a distance. Cell edges lie a quarter of dp beside the lattice positions.
fn subsample(cloud: &FramePoints, distance: Option<(f32, f32)>) -> Vec<usize> {
    let finite = |i: &usize| cloud.position[*i].iter().all(|x| x.is_finite());
    let all = (0..cloud.position.len()).filter(finite);
    let Some((apart, dp)) = distance else { return all.collect() };
    let mut cells = HashSet::new();
    let cell = |r: &[f32; 3]| r.map(|x| ((x / dp + 0.25) / apart).floor() as i64);
    all.filter(|&i| cells.insert(cell(&cloud.position[i]))).collect()
}

/// Returns the indices of the `chosen` particles, sorted by particle number.
fn sorted_by_id(cloud: &FramePoints, chosen: impl Fn(&u32) -> bool) -> Vec<usize> {
    let finite = |i: usize| cloud.position[i].iter().all(|x| x.is_finite());
    let mut order: Vec<usize> = (0..cloud.position.len()).filter(|&i| chosen(&cloud.id[i]) && finite(i)).collect();
    order.sort_by_key(|&i| cloud.id[i]);
    order
}

/// Returns the shown values of a frame, in the given `order` of particles.
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

/// Returns the names of the coordinates and of the fields of the `first` frame.
fn channel_names(first: &FramePoints, dimension: usize) -> Vec<&'static str> {
    let mut names = AXES[..dimension].to_vec();
    names.extend((!first.pressure.is_empty()).then_some("pressure"));
    names.extend((!first.velocity.is_empty()).then_some("speed"));
    names
}

fn channels(shown: &[FrameSamples], names: Vec<&'static str>, dimension: usize, dp: f32) -> Vec<QuantisedChannel> {
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

/// Returns the width of the range of `numbers` without the fraction `cut` at each end.
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

/// Adds the values of the `shown` frames to `blob`. Returns whether each frame contains full values, and how its particles differ
/// from those of the frame before, if they do.
fn encode_frames(
    shown: &[FrameSamples],
    channels: &[QuantisedChannel],
    blob: &mut BinaryData,
) -> (Vec<bool>, Vec<Option<ParticleChange>>) {
    let (mut alone, mut exchanged) = (Vec::new(), Vec::new());
    let mut before: Option<(&[u32], Vec<Vec<u16>>)> = None;
    for frame in shown {
        let rounded: Vec<Vec<u16>> = channels.iter().zip(&frame.x).map(|(channel, x)| quantise(channel, x)).collect();
        let known = before.take().and_then(|(id, values)| Some((exchange(id, &frame.id)?, values)));
        alone.push(known.is_none());
        for (c, now) in rounded.iter().enumerate() {
            match &known {
                Some((exchange, then)) => {
                    let then = exchange.carry(&then[c], now.len());
                    let steps: Vec<u16> = now.iter().zip(&then).map(|(a, b)| zigzag(*a, *b)).collect();
                    blob.push_byte_planes(&steps);
                }
                None => {
                    blob.push_byte_planes(now);
                }
            }
        }
        exchanged.push(known.map(|(exchange, _)| exchange));
        before = Some((&frame.id[..], rounded));
    }
    let place = |exchange: Option<ParticleExchange>| {
        let ParticleExchange { gone, new } = exchange.filter(|one| !(one.gone.is_empty() && one.new.is_empty()))?;
        let at = blob.push_floats(gone.iter().chain(&new).map(|i| *i as f32));
        Some(ParticleChange { at, gone: gone.len(), new: new.len() })
    };
    let changes = exchanged.into_iter().map(place).collect();
    (alone, changes)
}

/// The particles that are in one of two frames only.
#[derive(Debug, PartialEq)]
struct ParticleExchange {
    /// The numbers of those that have gone, in the earlier frame.
    gone: Vec<usize>,
    /// The numbers of those that are new, in the later frame.
    new: Vec<usize>,
}

impl ParticleExchange {
    /// Returns the values `then` of the earlier frame in the order of the `count` particles of the later one; 0 for new particles.
    fn carry(&self, then: &[u16], count: usize) -> Vec<u16> {
        let mut gone = self.gone.iter().copied().peekable();
        let kept = then.iter().enumerate().filter(|(i, _)| gone.next_if_eq(i).is_none()).map(|(_, x)| *x);
        let (mut kept, mut new) = (kept, self.new.iter().copied().peekable());
        (0..count).map(|k| if new.next_if_eq(&k).is_some() { 0 } else { kept.next().unwrap_or(0) }).collect()
    }
}

/// Returns the difference between the particles of two frames from their identifiers `before` and `now`. Returns `None` if most
/// particles differ, or if they are not in the order of their identifiers, as are particles without identifiers.
fn exchange(before: &[u32], now: &[u32]) -> Option<ParticleExchange> {
    let is_sorted = |id: &[u32]| id.is_sorted_by(|a, b| a < b);
    if before != now && !(is_sorted(before) && is_sorted(now)) || before.len() > 1 && before[0] == before[1] {
        return None;
    }
    let others = |id: &[u32], of: &[u32]| -> Vec<usize> {
        let mut of = of.iter().copied().peekable();
        let mut is_other = |id: u32| {
            while of.next_if(|other| *other < id).is_some() {}
            of.peek() != Some(&id)
        };
        (0..id.len()).filter(|&i| is_other(id[i])).collect()
    };
    if before == now {
        return Some(ParticleExchange { gone: vec![], new: vec![] });
    }
    let exchange = ParticleExchange { gone: others(before, now), new: others(now, before) };
    (2 * exchange.new.len() <= now.len()).then_some(exchange)
}

fn quantise(channel: &QuantisedChannel, x: &[f32]) -> Vec<u16> {
    x.iter().map(|x| ((x - channel.min) / channel.step).round() as u16).collect()
}

/// Returns the usual range of each field. The ranges of pressure and speed start at 0; the range of the excess pressure
/// over hydrostatic pressure is symmetric about 0.
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

/// Returns the range with both ends rounded to two significant digits.
fn rounded_range(low: f64, high: f64) -> [f64; 2] {
    let size = low.abs().max(high.abs());
    if size <= 0.0 || !size.is_finite() {
        return [0.0, 1.0];
    }
    let unit = 10f64.powf(size.log10().floor() - 1.0);
    let clean = |x: f64| if unit < 1.0 { x.round() / (1.0 / unit).round() } else { x.round() * unit };
    [clean((low / unit).floor()), clean((high / unit).ceil())]
}

/// Adds the poses of the solids in the `kept` frames to `blob`, after the boundary particles in the local frames of their
/// solids, if their `lattice` is given: the dimension and dp (m).
fn encode_boundaries(
    film: &FrameSequence,
    kept: &[usize],
    set: Option<&SceneGeometry>,
    lattice: Option<(usize, f32)>,
    blob: &mut BinaryData,
) -> Result<BoundaryAnimation> {
    let Some(set) = set else { return Ok(BoundaryAnimation::default()) };
    let first = film.solids(0)?;
    let members: Vec<Vec<usize>> = (0..set.solids.len()).map(|i| points_of_solid(&first, i)).collect();
    let mut skins = BoundaryAnimation { counts: vec![0; members.len()], ..BoundaryAnimation::default() };
    if let Some((dimension, dp)) = lattice {
        let local: Vec<[f64; 3]> = members
            .iter()
            .zip(&set.solids)
            .flat_map(|(own, solid)| own.iter().map(|&k| solid.start.to_local(&first.position[k])))
            .collect();
        for (c, name) in AXES.into_iter().enumerate().take(dimension) {
            let x: Vec<f32> = local.iter().map(|x| x[c] as f32).collect();
            let (min, max) = x.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
            let step = (PLACES * dp).max((max - min) / 65_000.0);
            let channel = QuantisedChannel { name, min: if min.is_finite() { min } else { 0.0 }, step };
            skins.offsets.push(blob.push_byte_planes(&quantise(&channel, &x)));
            skins.channels.push(channel);
        }
        skins.counts = members.iter().map(Vec::len).collect();
    }
    let mut poses = Vec::new();
    for &number in kept {
        let now = film.solids(number)?;
        for (own, solid) in members.iter().zip(&set.solids) {
            let pose = solid_placement(solid.role == "fixed", &solid.start, own, &first, &now);
            poses.extend(pose.at.iter().chain(pose.turn.iter().flatten()).map(|x| *x as f32));
        }
    }
    skins.poses = blob.push_floats(poses);
    Ok(skins)
}

/// Adds the nodes of the mooring lines in the frames `numbers` to `blob`. Returns `None` if no frame contains a line.
fn encode_lines(
    film: &FrameSequence,
    numbers: &[usize],
    dimension: usize,
    dp: f32,
    blob: &mut BinaryData,
) -> Result<Option<LineAnimation>> {
    let (mut shown, mut nodes) = (Vec::new(), Vec::new());
    for &number in numbers {
        let lines = film.moorings(number)?;
        let x = (0..dimension).map(|c| lines.iter().flatten().map(|x| x[c]).collect()).collect();
        let own: Vec<usize> = lines.iter().map(Vec::len).collect();
        // Nodes are the same in two frames if as many lines have as many nodes each.
        let id = (0u32..).zip(&own).flat_map(|(line, &n)| (0..n as u32).map(move |node| line << 12 | node)).collect();
        shown.push(FrameSamples { t: film.times()[number], id, x });
        nodes.push(own);
    }
    if nodes.iter().all(Vec::is_empty) {
        return Ok(None);
    }
    let channels = channels(&shown, AXES[..dimension].to_vec(), dimension, dp);
    let offset = blob.len();
    let (alone, changes) = encode_frames(&shown, &channels, blob);
    let counts = shown.iter().map(|frame| frame.id.len()).collect();
    Ok(Some(LineAnimation { counts, alone, changes, offset, channels, nodes }))
}

/// Returns the indices of the boundary particles of solid `number` among all boundary particles.
pub(crate) fn points_of_solid(all: &FramePoints, number: usize) -> Vec<usize> {
    (0..all.solid_index.len()).filter(|&k| all.solid_index[k] as usize == number).collect()
}

/// Returns the current placement of a solid, from its boundary particles `own` and their positions `now`.
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
    // A few hundred points determine the motion as accurately as all points.
    let some = || own.iter().step_by(own.len().div_ceil(400));
    let points = |cloud: &FramePoints| some().map(|&k| cloud.position[k]).collect::<Vec<_>>();
    start.fitted_to(&points(first), &points(now))
}

#[cfg(test)]
#[path = "../../tests/unit/report/animation.rs"]
mod tests;
