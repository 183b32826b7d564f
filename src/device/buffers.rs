//! The arrays on a device, their sizes, and the control words that a device and the host exchange.

use super::{
    gpu::{Adapter, Gpu},
    layout::Layout,
    periodic::Sides,
    shaders::{GROUP, ShaderTexts, cell_width},
    solids::{SOLID_WORDS, SolidChunks},
};
use crate::{
    error::{Error, ErrorCode, ErrorKind, Result},
    system::System,
};

/// Control words.
pub(super) const WORDS: usize = 36;

/// The time that the water has reached: that of tick 0, s, and the ticks since.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    pub(super) start: f64,
    pub(super) ticks: u64,
}

/// The control words: `Control` of `shaders/common.wgsl`.
pub(super) struct Control(pub(super) [u32; WORDS]);

impl Control {
    pub(super) const HALT: usize = 0;
    const DT: usize = 2;
    const SPAN: usize = 3;
    const EULER: usize = 5;
    const TIME: usize = 6;
    pub(super) const END: usize = 8;
    const STEPS: usize = 13;
    const SINCE_EULER: usize = 14;
    const FOLDINGS: usize = 15;
    const DT_BEFORE: usize = 16;
    pub(super) const PASSES: usize = 17;
    const STARTED: usize = 18;
    pub(super) const MOVED: usize = 19;
    const FORCE: usize = 20;
    const APPROACH: usize = 21;
    pub(super) const FAULT: usize = 22;
    pub(super) const LONGEST: usize = 23;
    pub(super) const LONGEST_OF_BOUNDARY: usize = 30;
    pub(super) const FACTOR: usize = 26;
    pub(super) const FOUND: usize = 27;
    pub(super) const GRAVITY: usize = 32;

    /// A displacement that asks for new lists.
    pub(super) const FAR: u32 = 0x7f00_0000;

    /// At tick 0, halted, without lists.
    pub(super) fn start() -> Self {
        let mut words = [0; WORDS];
        (words[Self::HALT], words[Self::MOVED], words[Self::FAULT]) = (1, Self::FAR, u32::MAX);
        Self(words)
    }

    pub(super) fn from_words(words: &[u32]) -> Self {
        Self(std::array::from_fn(|i| words[i]))
    }

    /// Sets the step before of a Verlet step.
    pub(super) fn set_history(&mut self, since_euler: u32, foldings: f64, dt: f64) {
        self.0[Self::SINCE_EULER] = since_euler;
        self.0[Self::FOLDINGS] = (foldings as f32).to_bits();
        self.0[Self::DT_BEFORE] = (dt as f32).to_bits();
        self.0[Self::STARTED] = 1;
    }

    pub(super) fn halt(&self) -> u32 {
        self.0[Self::HALT]
    }

    pub(super) fn dt(&self) -> f32 {
        f32::from_bits(self.0[Self::DT])
    }

    pub(super) fn time(&self) -> u64 {
        u64::from(self.0[Self::TIME]) | (u64::from(self.0[Self::TIME + 1]) << 32)
    }

    pub(super) fn steps(&self) -> u32 {
        self.0[Self::STEPS]
    }

    pub(super) fn passes(&self) -> u32 {
        self.0[Self::PASSES]
    }

    pub(super) fn fault(&self) -> u32 {
        self.0[Self::FAULT]
    }

    pub(super) fn found(&self) -> u32 {
        self.0[Self::FOUND]
    }

    /// Entries of the longest list of a water and of a boundary particle.
    pub(super) fn longest(&self) -> [usize; 2] {
        [Self::LONGEST, Self::LONGEST_OF_BOUNDARY].map(|at| self.0[at] as usize)
    }

    /// Factor on the loads on bodies, –: 1 in an Euler step; in a Verlet step, half of the time over which it integrates, divided
    /// by the length of the step.
    pub(super) fn weight(&self, verlet: bool) -> f64 {
        if !verlet || self.0[Self::EULER] != 0 {
            return 1.0;
        }
        0.5 * f64::from(f32::from_bits(self.0[Self::SPAN])) / f64::from(self.dt())
    }

    /// The largest acceleration, and the largest rate of approach.
    pub(super) fn force(&self) -> f32 {
        f32::from_bits(self.0[Self::FORCE]).sqrt()
    }

    pub(super) fn approach(&self) -> f32 {
        f32::from_bits(self.0[Self::APPROACH])
    }

    pub(super) fn has_history(&self) -> bool {
        self.0[Self::STARTED] != 0
    }

    pub(super) fn since_euler(&self) -> u32 {
        self.0[Self::SINCE_EULER]
    }

    pub(super) fn foldings(&self) -> f32 {
        f32::from_bits(self.0[Self::FOLDINGS])
    }

    pub(super) fn dt_before(&self) -> f32 {
        f32::from_bits(self.0[Self::DT_BEFORE])
    }
}

/// Numbers of particles, cells and list entries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    pub(super) n: usize,
    pub(super) water: usize,
    /// Cells of one kind of particles, along each axis and in all.
    size: [i32; 4],
    origin: [i32; 4],
    pub(super) cells: usize,
    /// Kinds of particles that are sorted into cells.
    kinds: usize,
    /// Most images of a water particle across periodic sides.
    images_of_each: usize,
    /// Entries of a list of a water and of a boundary particle.
    most: [usize; 2],
    /// Particles of each of both kinds whose lists share a buffer.
    part: [usize; 2],
}

/// Particles of one kind whose lists share a buffer.
#[derive(Clone, Copy, Debug)]
pub(super) struct ListPart {
    /// Index of the first, and number of the particles.
    first: usize,
    pub(super) count: usize,
    /// Particles for which there is room, and entries of a list.
    room: usize,
    most: usize,
    pub(super) is_water: bool,
}

impl ListPart {
    /// The uniform of the shaders.
    pub(super) fn words(&self) -> [u32; 4] {
        [self.first, self.room, self.most, self.first + self.count].map(|x| x as u32)
    }
}

impl Counts {
    /// Those of `system`, for lists that reach `margin` beyond the support.
    pub(super) fn new<const D: usize>(
        system: &System<D>,
        (layout, sides): (&Layout, &Sides<D>),
        adapter: &Adapter,
        margin: f64,
    ) -> Result<Self> {
        let (water, model) = (system.fluid().len(), system.model());
        let n = water + system.boundary().len();
        let (mut low, mut high) = ([0; D], [0; D]);
        for (i, r) in system.fluid().r.iter().chain(system.boundary().r).enumerate() {
            for k in 0..D {
                let c = layout.coarse(r[k], f64::floor);
                (low[k], high[k]) = if i == 0 { (c, c) } else { (c.min(low[k]), c.max(high[k])) };
            }
        }
        for (k, [from, to]) in (0..D).filter_map(|k| Some((k, sides.reach(k)?))) {
            (low[k], high[k]) = (low[k].min(from), high[k].max(to));
        }
        // Two empty cells around all.
        let (width, mut origin, mut size) = (cell_width(margin), [0; 4], [1; 4]);
        for k in 0..D {
            (origin[k], size[k]) = (low[k] - 2 * width, (high[k] - low[k]) / width + 5);
        }
        let cells: f64 = size.iter().map(|&x| f64::from(x)).product();
        if cells > 4e8 {
            return Err(Error::new(
                ErrorKind::Usage,
                format!("the particles are spread over {cells:.1e} cells of half a kernel support"),
            )
            .with_code(ErrorCode::NoDevice)
            .help("start the solids nearer to the water, or leave --device out"));
        }
        let ratio = model.support_radius() * (1.0 + margin) / model.dp;
        let volume = if D == 2 { std::f64::consts::PI * ratio.powi(2) } else { 4.19 * ratio.powi(3) };
        let (kinds, images_of_each) = (sides.kinds(), sides.images_of_each());
        let mut counts =
            Self { n, water, size, origin, cells: cells as usize, kinds, images_of_each, most: [0; 2], part: [0; 2] };
        // Behind a flat face water fills less than half of the reach.
        counts.set_list_lengths([1.08, 0.56].map(|share| (share * volume) as usize + 4), adapter);
        Ok(counts)
    }

    /// Sets the lengths of lists, and so the particles whose lists fit a buffer.
    fn set_list_lengths(&mut self, most: [usize; 2], adapter: &Adapter) {
        let bytes = adapter.binding_bytes.min(adapter.buffer_bytes) as usize;
        let counts = [self.water, self.n - self.water];
        let part = |kind: usize| {
            let fit = (bytes / (4 * most[kind])) / GROUP * GROUP;
            fit.max(GROUP).min(counts[kind].next_multiple_of(GROUP).max(GROUP))
        };
        (self.most, self.part) = (most, [part(0), part(1)]);
    }

    /// Makes the lists long enough for the `longest`; returns whether they were too short.
    pub(super) fn grow_lists(&mut self, longest: [usize; 2], adapter: &Adapter) -> bool {
        let grown = |kind: usize| match longest[kind] > self.most[kind] {
            true => longest[kind] + longest[kind] / 8,
            false => self.most[kind],
        };
        let most = [grown(0), grown(1)];
        let is_longer = most != self.most;
        if is_longer {
            self.set_list_lengths(most, adapter);
        }
        is_longer
    }

    /// The particles whose lists share a buffer: water, and boundary particles.
    pub(super) fn parts(&self) -> [Vec<ListPart>; 2] {
        let of = |kind: usize, from: usize, to: usize| {
            let (room, most, is_water) = (self.part[kind], self.most[kind], kind == 0);
            let part = |first: usize| ListPart { first, count: room.min(to - first), room, most, is_water };
            (from..to).step_by(room).map(part).collect()
        };
        [of(0, 0, self.water), of(1, self.water, self.n)]
    }

    /// Room for the images across periodic sides.
    pub(super) fn images(&self) -> usize {
        self.water * self.images_of_each
    }

    /// Particles and room for the images.
    pub(super) fn slots(&self) -> usize {
        self.n + self.images()
    }

    /// Chunks in which the velocities of the water are added up, if there are periodic sides.
    pub(super) fn flow_chunks(&self) -> usize {
        if self.images_of_each > 0 { self.water.div_ceil(GROUP) } else { 0 }
    }

    /// Cells of all kinds of particles.
    pub(super) fn all_cells(&self) -> usize {
        self.kinds * self.cells
    }

    pub(super) fn words(&self) -> [u32; 16] {
        let mut words = [0; 16];
        (words[12], words[13]) = (self.slots() as u32, self.most[1] as u32);
        words[..4].copy_from_slice(&[self.n, self.water, self.cells, self.most[0]].map(|x| x as u32));
        for k in 0..4 {
            (words[4 + k], words[8 + k]) = (self.size[k] as u32, self.origin[k] as u32);
        }
        words
    }
}

/// The arrays.
pub(super) struct Buffers {
    pub(super) control: wgpu::Buffer,
    pub(super) places: wgpu::Buffer,
    pub(super) motion: wgpu::Buffer,
    pub(super) before: wgpu::Buffer,
    pub(super) slot: wgpu::Buffer,
    pub(super) solids: wgpu::Buffer,
    pub(super) depths: wgpu::Buffer,
    pub(super) loads: wgpu::Buffer,
    /// The lists of water, and of boundary particles.
    lists: [Vec<wgpu::Buffer>; 2],
    pub(super) pairs: PairBuffers,
    pub(super) search: SearchBuffers,
    /// Copies of the state.
    backup: Vec<wgpu::Buffer>,
    /// Whether rows of additional inputs belong to the state.
    keeps_rows: bool,
    /// Particles for which there is room.
    pub(super) room: usize,
}

/// The arrays that only the passes over pairs use.
pub(super) struct PairBuffers {
    pub(super) positions: wgpu::Buffer,
    pub(super) velocities: wgpu::Buffer,
    pub(super) built: wgpu::Buffer,
    pub(super) sums: wgpu::Buffer,
    pub(super) rows: wgpu::Buffer,
    pub(super) spans: wgpu::Buffer,
    pub(super) walls: wgpu::Buffer,
    pub(super) aways: wgpu::Buffer,
    pub(super) gaps: wgpu::Buffer,
    pub(super) local: wgpu::Buffer,
    pub(super) chunks: wgpu::Buffer,
    pub(super) copied: wgpu::Buffer,
    pub(super) flow: wgpu::Buffer,
    /// If water sticks to faces: their normals, and the velocities past the solids with which boundary particles act.
    pub(super) normals: wgpu::Buffer,
    pub(super) slips: wgpu::Buffer,
}

/// The arrays of the search.
pub(super) struct SearchBuffers {
    pub(super) order: wgpu::Buffer,
    pub(super) count: wgpu::Buffer,
    pub(super) start: wgpu::Buffer,
    pub(super) blocks: wgpu::Buffer,
    pub(super) spare_places: wgpu::Buffer,
    pub(super) spare: wgpu::Buffer,
    pub(super) spare_rows: wgpu::Buffer,
}

impl Buffers {
    /// Arrays for `counts` particles and the shaders of `texts`; with the step before if `verlet`.
    pub(super) fn new(
        gpu: &Gpu,
        counts: &Counts,
        chunks: &SolidChunks,
        texts: &ShaderTexts,
        verlet: bool,
    ) -> Result<Self> {
        let ([rows, input_rows, kept_rows], gaps) = (texts.rows, texts.gaps.is_some());
        let (n, boundary) = (counts.n, counts.n - counts.water);
        let history = if verlet { 16 * n } else { 16 };
        let solids = chunks.sets.len().max(1);
        let (slots, total) = (counts.slots(), counts.all_cells() + 1);
        let if_gaps = |bytes: usize| if gaps { bytes } else { 16 };
        let if_sticks = |bytes: usize| if texts.sticks.is_some() { bytes } else { 16 };
        let aways = if gaps || texts.near.is_some() { 16 * boundary } else { 16 };
        let pairs = PairBuffers {
            positions: gpu.buffer(16 * slots)?,
            velocities: gpu.buffer(16 * slots)?,
            built: gpu.buffer(16 * n)?,
            sums: gpu.buffer(4 * rows * n)?,
            rows: gpu.buffer(4 * input_rows * slots)?,
            spans: gpu.buffer(8 * n)?,
            walls: gpu.buffer(16 * boundary)?,
            aways: gpu.buffer(aways)?,
            gaps: gpu.buffer(if_gaps(4 * boundary))?,
            local: gpu.buffer(16 * boundary)?,
            chunks: gpu.buffer(4 * chunks.members.len())?,
            copied: gpu.buffer(16 * chunks.copied.len())?,
            flow: gpu.buffer(16 * counts.flow_chunks())?,
            normals: gpu.buffer(if_sticks(16 * boundary))?,
            slips: gpu.buffer(if_sticks(16 * boundary))?,
        };
        let search = SearchBuffers {
            order: gpu.buffer(4 * slots)?,
            count: gpu.buffer(4 * total)?,
            start: gpu.buffer(4 * total)?,
            blocks: gpu.buffer(4 * total.div_ceil(1024))?,
            spare_places: gpu.buffer(32 * n)?,
            spare: gpu.buffer((if verlet { 64 } else { 48 }) * n)?,
            spare_rows: gpu.buffer(4 * kept_rows * n)?,
        };
        gpu.write(&pairs.local, 0, &chunks.local);
        gpu.write(&pairs.chunks, 0, &chunks.members);
        gpu.write(&pairs.copied, 0, &chunks.copied);
        let mut buffers = Self {
            control: gpu.buffer(4 * WORDS)?,
            places: gpu.buffer(32 * n)?,
            motion: gpu.buffer(16 * n)?,
            before: gpu.buffer(history)?,
            slot: gpu.buffer(4 * n)?,
            solids: gpu.buffer(4 * SOLID_WORDS * solids)?,
            depths: gpu.buffer(8 * boundary)?,
            loads: gpu.buffer(32 * chunks.owners.len().max(1))?,
            lists: Default::default(),
            pairs,
            search,
            backup: Vec::new(),
            keeps_rows: kept_rows > 0,
            room: n,
        };
        buffers.backup = buffers.state().iter().map(|of| gpu.buffer(of.size() as usize)).collect::<Result<_>>()?;
        buffers.make_lists(gpu, counts)?;
        Ok(buffers)
    }

    /// Makes room for the lists.
    pub(super) fn make_lists(&mut self, gpu: &Gpu, counts: &Counts) -> Result<()> {
        self.lists = Default::default();
        for (lists, parts) in self.lists.iter_mut().zip(counts.parts()) {
            for part in parts {
                lists.push(gpu.buffer(4 * part.most * part.room)?);
            }
        }
        Ok(())
    }

    /// The particles whose lists share a buffer, and the lists.
    pub(super) fn lists(&self, counts: &Counts) -> impl Iterator<Item = (ListPart, &wgpu::Buffer)> {
        counts.parts().into_iter().zip(&self.lists).flat_map(|(parts, lists)| parts.into_iter().zip(lists))
    }

    /// The state: control words, places, motion, the step before, and rows that are kept.
    fn state(&self) -> Vec<&wgpu::Buffer> {
        let rows = self.keeps_rows.then_some(&self.pairs.rows);
        [&self.control, &self.places, &self.motion, &self.before].into_iter().chain(rows).collect()
    }

    /// The buffers to copy in order to save the state.
    pub(super) fn backups(&self) -> Vec<(&wgpu::Buffer, &wgpu::Buffer)> {
        self.state().into_iter().zip(&self.backup).collect()
    }

    /// The buffers to copy in order to restore the saved state.
    pub(super) fn restores(&self) -> Vec<(&wgpu::Buffer, &wgpu::Buffer)> {
        self.backup.iter().zip(self.state()).collect()
    }

    /// Memory, B.
    pub(super) fn bytes(&self) -> u64 {
        let PairBuffers {
            positions,
            velocities,
            built,
            sums,
            rows,
            spans,
            walls,
            aways,
            gaps,
            local,
            chunks,
            copied,
            flow,
            normals,
            slips,
        } = &self.pairs;
        let SearchBuffers { order, count, start, blocks, spare_places, spare, spare_rows } = &self.search;
        let pairs = [positions, velocities, built, sums, rows, spans, walls, aways, gaps, local, chunks, copied, flow];
        let pairs = pairs.into_iter().chain([normals, slips]);
        let search = [order, count, start, blocks, spare_places, spare, spare_rows];
        let solids = [&self.slot, &self.solids, &self.depths, &self.loads];
        let all = pairs
            .chain(search)
            .chain(solids)
            .chain(self.state())
            .chain(&self.backup)
            .chain(self.lists.iter().flatten());
        all.map(wgpu::Buffer::size).sum()
    }

    /// Memory of the lists, B.
    pub(super) fn list_bytes(&self) -> u64 {
        self.lists.iter().flatten().map(wgpu::Buffer::size).sum()
    }
}
