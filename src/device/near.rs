//! The exchange of the host with a device between two outputs. The host reads the water near some places and the weights of the
//! water around some boundary particles, and it changes velocities.

use super::{
    Device, WaterReads,
    buffers::{Buffers, Control, Counts, WORDS},
    film_reads::FilmReads,
    gpu::{Gpu, Pass, Shader},
    layout::Layout,
    shaders::{GROUP, ShaderTexts},
};
use crate::{
    error::Result,
    interaction::PairSums,
    math::{Bounds, Vector},
    system::{
        System,
        device_state::{NearParticle, WaterLoads},
    },
};

/// Words of a [`NearParticle`] on the device.
const PARTICLE: usize = 12;

/// Particles for which there is room at first.
const ROOM: usize = 2048;

/// No particle.
const NONE: u32 = u32::MAX;

/// The arrays and passes by which the host reads water.
pub(super) struct Near {
    shader: Shader,
    /// Boundary particles that the host watches, in ascending order.
    watched: Vec<u32>,
    ranges: wgpu::Buffer,
    found: wgpu::Buffer,
    watched_on_device: wgpu::Buffer,
    weights: wgpu::Buffer,
    changes: wgpu::Buffer,
    /// Number of particles for which there is room; then the number that is read at once, somewhat more than the last time.
    room: usize,
    expected: usize,
    passes: NearPasses,
}

/// The passes that do not depend on a number of changes.
struct NearPasses {
    params: wgpu::Buffer,
    find: Pass,
    weigh: Pass,
}

/// The buffers of the shader by their bindings.
fn bindings<'a>(
    params: &'a wgpu::Buffer,
    buffers: &'a Buffers,
    [ranges, found, watched, weights, changes]: [&'a wgpu::Buffer; 5],
) -> Vec<&'a wgpu::Buffer> {
    let b = &buffers.pairs;
    let state = [params, &buffers.control, &buffers.places, &buffers.motion, &buffers.before, &b.velocities];
    let read = [&buffers.slot, &b.spans, &b.aways, ranges, found, watched, weights, changes, &b.sums];
    state.into_iter().chain(read).collect()
}

impl NearPasses {
    fn new(gpu: &Gpu, shader: &Shader, counts: &Counts, buffers: &Buffers, own: [&wgpu::Buffer; 5]) -> Result<Self> {
        let params = gpu.uniform(&counts.words());
        let all = bindings(&params, buffers, own);
        let find = gpu.pass(shader, "find_near", counts.water, &all)?;
        let weigh = gpu.pass(shader, "weigh", own[2].size() as usize / 4, &all)?;
        Ok(Self { params, find, weigh })
    }
}

impl Near {
    /// For the shader of `texts`, if the host reads water.
    pub(super) fn new(
        gpu: &Gpu,
        texts: &ShaderTexts,
        counts: &Counts,
        buffers: &Buffers,
        WaterReads { watched, offset_rows, .. }: WaterReads,
    ) -> Result<Option<Self>> {
        let Some(text) = &texts.near else { return Ok(None) };
        let shader = gpu.shader(text, &["find_near", "weigh", "change_velocities"])?;
        let mut padded = watched.clone();
        padded.resize(watched.len().next_multiple_of(GROUP).max(GROUP), NONE);
        let (ranges, changes) = (gpu.buffer(64)?, gpu.buffer(16)?);
        let (on_device, weights) = (gpu.buffer(4 * padded.len())?, gpu.buffer(4 * (1 + offset_rows) * padded.len())?);
        gpu.write(&on_device, 0, &padded);
        let room = ROOM.min(counts.water.max(1));
        let found = gpu.buffer(4 * PARTICLE * room)?;
        let own = [&ranges, &found, &on_device, &weights, &changes];
        let passes = NearPasses::new(gpu, &shader, counts, buffers, own)?;
        let watched_on_device = on_device;
        Ok(Some(Self {
            shader,
            watched,
            ranges,
            found,
            watched_on_device,
            weights,
            changes,
            room,
            expected: ROOM.min(room),
            passes,
        }))
    }

    /// Makes the passes anew, for other numbers of particles or other arrays.
    pub(super) fn make_passes(&mut self, gpu: &Gpu, counts: &Counts, buffers: &Buffers) -> Result<()> {
        let own = [&self.ranges, &self.found, &self.watched_on_device, &self.weights, &self.changes];
        self.passes = NearPasses::new(gpu, &self.shader, counts, buffers, own)?;
        Ok(())
    }

    /// Memory, B.
    pub(super) fn bytes(&self) -> u64 {
        let all = [&self.ranges, &self.found, &self.watched_on_device, &self.weights, &self.changes];
        all.map(wgpu::Buffer::size).iter().sum()
    }

    /// The pass that weighs the water, if boundary particles are watched.
    pub(super) fn weigh(&self) -> Option<&Pass> {
        (!self.watched.is_empty()).then_some(&self.passes.weigh)
    }

    /// The weights among `words`, with the boundary particles that have water, and the sums of ways to these (in units of the pair loop),
    /// if they are read.
    fn weights<const D: usize>(&self, words: &[u32]) -> (Vec<(u32, f64)>, Vec<Vector<D>>) {
        let rows: Vec<&[u32]> = words.chunks_exact(self.watched_on_device.size() as usize / 4).collect();
        let number = |row: usize, k: usize| f64::from(f32::from_bits(rows[row][k]));
        let wet: Vec<usize> = (0..self.watched.len()).filter(|k| number(0, *k) > 0.0).collect();
        let weights = wet.iter().map(|&k| (self.watched[k], number(0, k))).collect();
        let offset = |k: &usize| Vector::from_fn(|axis, _| number(1 + axis, *k));
        (weights, if rows.len() > 1 { wet.iter().map(offset).collect() } else { Vec::new() })
    }
}

/// The answer of a device: control words, the words of loads, weights and films, and water particles.
pub(super) struct Answer<const D: usize> {
    pub(super) control: Control,
    pub(super) loads: [Vec<u32>; 3],
    pub(super) near: Vec<NearParticle<D>>,
    /// Whether there was room for all particles near the places.
    pub(super) has_all: bool,
}

impl<const D: usize> Device<D> {
    /// Lets the next submission find the water in these `ranges` (m).
    pub(super) fn prepare_find(&mut self, ranges: &[Bounds<D>]) -> Result<()> {
        let (layout, Some(near), false) = (self.layout, &mut self.near, ranges.is_empty()) else { return Ok(()) };
        let all = ranges.iter().fold(Bounds::empty(), |all, range| all.union(range));
        let mut words: Vec<[i32; 8]> = std::iter::once(&all).chain(ranges).map(|range| words(&layout, range)).collect();
        words[0][3] = ranges.len() as i32;
        let bytes = size_of_val(&words[..]);
        if bytes > near.ranges.size() as usize {
            near.ranges = self.gpu.buffer(2 * bytes)?;
            near.make_passes(&self.gpu, &self.counts, &self.buffers)?;
        }
        self.gpu.write(&near.ranges, 0, &words);
        self.gpu.write(&self.buffers.control, Control::FOUND * 4, &[0u32]);
        Ok(())
    }

    /// The pass that finds the water in `ranges`, if there are any.
    pub(super) fn find(&self, ranges: &[Bounds<D>]) -> Option<&Pass> {
        self.near.as_ref().filter(|_| !ranges.is_empty()).map(|near| &near.passes.find)
    }

    /// The passes that weigh the water around watched boundary particles, and that read those of films, if there are any.
    pub(super) fn read_boundary(&self) -> impl Iterator<Item = &Pass> {
        let weigh = self.near.as_ref().and_then(Near::weigh);
        weigh.into_iter().chain(self.films.as_ref().and_then(FilmReads::pass))
    }

    /// Lets each force pass from now on read these boundary particles of films, in ascending order.
    pub(crate) fn set_film_particles(&mut self, particles: Vec<u32>) -> Result<()> {
        match &mut self.films {
            Some(films) => films.set_particles(&self.gpu, &self.counts, &self.buffers, particles),
            None => Ok(()),
        }
    }

    /// The buffers with the words of loads, weights and films, and their numbers of words.
    pub(super) fn load_words(&self) -> [(&wgpu::Buffer, usize); 3] {
        let (loads, near) = (&self.buffers.loads, self.near.as_ref().filter(|near| !near.watched.is_empty()));
        let weights = near.map_or((loads, 0), |near| (&near.weights, near.weights.size() as usize / 4));
        let films = self.films.as_ref().map_or((loads, 0), FilmReads::words);
        [(loads, 8 * self.chunks.owners.len()), weights, films]
    }

    /// The boundary particles that have water near them, in ascending order, and their sums in the last force pass: the accelerations alone.
    pub(crate) fn boundary_sums(&self) -> Result<(Vec<u32>, Vec<PairSums<D>>)> {
        let Counts { n, water, .. } = self.counts;
        let Buffers { slot, pairs, .. } = &self.buffers;
        let rows: [Vec<f32>; D] =
            self.gpu.read_ranges(std::array::from_fn(|k| (&pairs.sums, k * n + water..(k + 1) * n)))?;
        let [slot, spans]: [Vec<u32>; 2] =
            self.gpu.read_ranges([(slot, water..n), (&pairs.spans, 2 * water..2 * n)])?;
        let scale = self.units.length / self.units.time.powi(2);
        let of = |(i, slot): (u32, u32)| {
            let k = slot as usize - water;
            let acceleration = Vector::from_fn(|axis, _| f64::from(rows[axis][k]) * scale);
            (spans[2 * k] > 0).then_some((i, PairSums { acceleration, compression_rate: 0.0 }))
        };
        Ok((0u32..).zip(slot).filter_map(of).unzip())
    }

    /// How often the host has waited for the device.
    pub(crate) fn waits(&self) -> u64 {
        self.gpu.waits()
    }

    /// What these words say of the water at the solids.
    pub(super) fn water_loads(&self, [loads, weights, films]: &[Vec<u32>; 3], system: &System<D>) -> WaterLoads<D> {
        let (weights, mut offsets) = self.near.as_ref().map_or_else(Default::default, |near| near.weights(weights));
        offsets.iter_mut().for_each(|offset| *offset *= self.units.length);
        let at_films = self.films.as_ref().map_or_else(Vec::new, |reads| reads.water(films, &self.units));
        WaterLoads { loads: self.chunks.loads(loads, system, &self.units), weights, offsets, at_films }
    }

    /// The answer of the device after all passes, with the water found in `ranges` (m) and, if `loaded`, the loads.
    pub(super) fn answer(&mut self, ranges: &[Bounds<D>], loaded: bool) -> Result<Answer<D>> {
        let expected = self.near.as_ref().filter(|_| !ranges.is_empty()).map_or(0, |near| near.expected);
        let found = self.near.as_ref().map_or(&self.buffers.loads, |near| &near.found);
        let [loads, weights, films] = self.load_words().map(|(of, count)| (of, if loaded { count } else { 0 }));
        let (control, found) = ((&self.buffers.control, WORDS), (found, PARTICLE * expected));
        let [control, loads, weights, films, mut particles] = self.gpu.read([control, loads, weights, films, found])?;
        let (control, loads) = (Control::from_words(&control), [loads, weights, films]);
        let Self { gpu, layout, buffers, near, counts, .. } = self;
        let Some(near) = near else {
            return Ok(Answer { control, loads, near: Vec::new(), has_all: true });
        };
        let count = if ranges.is_empty() { 0 } else { control.found() as usize };
        let has_all = count <= near.room;
        if has_all && count > expected {
            [particles] = gpu.read([(&near.found, PARTICLE * count)])?;
        }
        if !ranges.is_empty() {
            near.expected = (count + count / 8 + 64).min(near.room);
        }
        if !has_all {
            near.room = (count + count / 4).min(counts.water);
            near.found = gpu.buffer(4 * PARTICLE * near.room)?;
            near.make_passes(gpu, counts, buffers)?;
        }
        let of = |words: &[u32]| {
            let (place, motion) = words.split_at(8);
            (place[3], layout.position(place), layout.velocity(motion), layout.density(motion))
        };
        let mut found: Vec<NearParticle<D>> = particles.chunks_exact(PARTICLE).take(count).map(of).collect();
        found.sort_unstable_by_key(|(i, ..)| *i);
        Ok(Answer { control, loads, near: found, has_all })
    }

    /// Adds to the velocities (m/s) of these water particles, of which none comes twice.
    pub(crate) fn change_velocities(&mut self, changes: &[(usize, Vector<D>)]) -> Result<()> {
        let (Some(near), false) = (&mut self.near, changes.is_empty()) else { return Ok(()) };
        let words = |(i, v): &(usize, Vector<D>)| {
            let [x, y, z] = self.layout.velocity_words(v);
            [x, y, z, *i as u32]
        };
        let mut all: Vec<[u32; 4]> = changes.iter().map(words).collect();
        let bytes = size_of_val(&all[..]);
        if bytes > near.changes.size() as usize {
            near.changes = self.gpu.buffer(2 * bytes)?;
            near.make_passes(&self.gpu, &self.counts, &self.buffers)?;
        }
        let threads = near.changes.size() as usize / 16;
        all.resize(threads, [NONE; 4]);
        let own = [&near.ranges, &near.found, &near.watched_on_device, &near.weights, &near.changes];
        let buffers = bindings(&near.passes.params, &self.buffers, own);
        let pass = self.gpu.pass(&near.shader, "change_velocities", threads, &buffers)?;
        self.gpu.write(&near.changes, 0, &all);
        self.gpu.run(&[], [&pass]);
        Ok(())
    }

    /// Adopts the numbers of particles of `system`, if they have changed.
    pub(super) fn fit(&mut self, system: &System<D>) -> Result<()> {
        let (water, boundary) = (system.fluid().len(), system.boundary().len());
        if (water, water + boundary) == (self.counts.water, self.counts.n) {
            return Ok(());
        }
        if water + boundary > self.buffers.room {
            return Err(super::refused("a state with more water than there was when it got the water"));
        }
        (self.counts.water, self.counts.n) = (water, water + boundary);
        self.make_passes()
    }
}

/// The corners of `range` (m) on a device, in 2⁻⁸ of the support.
fn words<const D: usize>(layout: &Layout, range: &Bounds<D>) -> [i32; 8] {
    let [mut low, mut high] = [[i32::MIN; 4], [i32::MAX; 4]];
    for k in 0..D {
        (low[k], high[k]) = (layout.coarse(range.min[k], f64::floor), layout.coarse(range.max[k], f64::ceil));
    }
    (low[3], high[3]) = (0, 0);
    std::array::from_fn(|k| if k < 4 { low[k] } else { high[k - 4] })
}
