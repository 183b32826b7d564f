//! What the host reads of the boundary particles of films: their accelerations and the pressure of the water near them.

use super::{
    buffers::{Buffers, Counts},
    gpu::{Gpu, Pass, Shader},
    shaders::{GROUP, ShaderTexts},
};
use crate::{error::Result, math::Vector, sph::Units, system::device_films::BoundaryWater};

/// Words of a [`BoundaryWater`] on the device.
const WORDS: usize = 8;

/// No boundary particle.
const NONE: u32 = u32::MAX;

/// The arrays and the pass with which the host reads boundary particles.
pub(super) struct FilmReads {
    shader: Shader,
    /// The particles, in ascending order.
    particles: Vec<u32>,
    on_device: wgpu::Buffer,
    readings: wgpu::Buffer,
    pass: Pass,
}

impl FilmReads {
    /// For the shader of `texts`, if there may be films.
    pub(super) fn new(gpu: &Gpu, texts: &ShaderTexts, counts: &Counts, buffers: &Buffers) -> Result<Option<Self>> {
        let Some(text) = &texts.films else { return Ok(None) };
        let shader = gpu.shader(text, &["read_boundary"])?;
        let [on_device, readings] = [4, 4 * WORDS].map(|bytes| gpu.buffer(GROUP * bytes));
        let (on_device, readings, particles) = (on_device?, readings?, Vec::new());
        let pass = make_pass(gpu, &shader, counts, buffers, [&on_device, &readings])?;
        Ok(Some(Self { shader, particles, on_device, readings, pass }))
    }

    /// Lets each force pass from now on read these `particles`, in ascending order.
    pub(super) fn set_particles(
        &mut self,
        gpu: &Gpu,
        counts: &Counts,
        buffers: &Buffers,
        particles: Vec<u32>,
    ) -> Result<()> {
        let mut padded = particles.clone();
        if 4 * padded.len() > self.on_device.size() as usize {
            let room = (padded.len() + padded.len() / 4).next_multiple_of(GROUP);
            (self.on_device, self.readings) = (gpu.buffer(4 * room)?, gpu.buffer(4 * WORDS * room)?);
            self.make_pass(gpu, counts, buffers)?;
        }
        padded.resize(self.on_device.size() as usize / 4, NONE);
        gpu.write(&self.on_device, 0, &padded);
        self.particles = particles;
        Ok(())
    }

    /// The pass that reads them, if there are any.
    pub(super) fn pass(&self) -> Option<&Pass> {
        (!self.particles.is_empty()).then_some(&self.pass)
    }

    /// The buffer with their words, and how many there are.
    pub(super) fn words(&self) -> (&wgpu::Buffer, usize) {
        (&self.readings, WORDS * self.particles.len())
    }

    /// What these `words` say of the particles that have water near them.
    pub(super) fn water<const D: usize>(&self, words: &[u32], units: &Units) -> Vec<(u32, BoundaryWater<D>)> {
        let scale = units.length / units.time.powi(2);
        let of = |(i, words): (&u32, &[u32])| {
            let number = |k: usize| f64::from(f32::from_bits(words[k]));
            let acceleration = Vector::from_fn(|k, _| number(k) * scale);
            let away = Vector::from_fn(|k, _| number(4 + k));
            (number(7) > 0.0).then(|| (*i, BoundaryWater { acceleration, compression: number(3), away }))
        };
        self.particles.iter().zip(words.chunks_exact(WORDS)).filter_map(of).collect()
    }

    /// Makes the pass anew, for other numbers of particles or other arrays.
    pub(super) fn make_pass(&mut self, gpu: &Gpu, counts: &Counts, buffers: &Buffers) -> Result<()> {
        self.pass = make_pass(gpu, &self.shader, counts, buffers, [&self.on_device, &self.readings])?;
        Ok(())
    }

    /// Memory, B.
    pub(super) fn bytes(&self) -> u64 {
        self.on_device.size() + self.readings.size()
    }
}

/// The pass that reads the particles in the first of the buffers `own` into the second.
fn make_pass(gpu: &Gpu, shader: &Shader, counts: &Counts, buffers: &Buffers, own: [&wgpu::Buffer; 2]) -> Result<Pass> {
    let (params, b) = (gpu.uniform(&counts.words()), &buffers.pairs);
    let all = [&params, &buffers.control, &buffers.slot, &b.spans, &b.sums, &b.walls, &b.aways, own[0], own[1]];
    gpu.pass(shader, "read_boundary", own[0].size() as usize / 4, &all)
}
