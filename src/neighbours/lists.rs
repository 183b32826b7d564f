//! Neighbour lists of single particles for the reference, in chunks that one thread builds and reads.

use rayon::prelude::*;

use super::CellGrid;
use crate::math::{Bounds, Vector};

/// Number of particles in a chunk, the unit of parallel work. It is fixed, so that no result depends on the number of threads.
pub const CHUNK: usize = 128;

/// Where in its chunk's `index` a particle's neighbours are.
#[derive(Clone, Copy, Debug, Default)]
pub struct Span {
    /// First neighbour of the first kind.
    pub start: u32,
    /// End of the first kind, start of the second.
    pub middle: u32,
    /// End of the second kind.
    pub end: u32,
}

/// The neighbours of [`CHUNK`] particles.
#[derive(Clone, Debug, Default)]
pub struct ParticleListChunk {
    /// One span a particle.
    pub spans: Vec<Span>,
    /// Neighbours, one particle after the other.
    pub index: Vec<u32>,
}

impl ParticleListChunk {
    /// Neighbours of both kinds of the chunk's `i`-th particle.
    #[inline(always)]
    pub fn neighbours_of(&self, i: usize) -> (&[u32], &[u32]) {
        let s = self.spans[i];
        (&self.index[s.start as usize..s.middle as usize], &self.index[s.middle as usize..s.end as usize])
    }
}

/// The lists of all particles.
#[derive(Clone, Debug, Default)]
pub struct ParticleLists {
    /// Of water particles: first kind water, second kind boundary.
    pub fluid: Vec<ParticleListChunk>,
    /// For the wet boundary particles: first kind water; no second.
    pub boundary: Vec<ParticleListChunk>,
}

impl ParticleLists {
    /// Memory of the lists, B.
    pub(super) fn memory_bytes(&self) -> usize {
        let chunk = |chunk: &ParticleListChunk| 12 * chunk.spans.capacity() + 4 * chunk.index.capacity();
        self.fluid.iter().chain(&self.boundary).map(chunk).sum()
    }

    /// Lists all pairs of a water particle with a water or boundary particle nearer than `reach` (m). Returns those of the
    /// boundary particles `near` that are in a pair.
    pub(super) fn build<const D: usize>(
        &mut self,
        (water, water_r): (&CellGrid<D>, &[Vector<D>]),
        (skin, skin_r): (&CellGrid<D>, &[Vector<D>]),
        near: &[u32],
        reach: f64,
    ) -> Vec<u32> {
        self.fluid.resize_with(water_r.len().div_ceil(CHUNK), ParticleListChunk::default);
        self.fluid.par_iter_mut().enumerate().for_each(|(c, chunk)| {
            chunk.clear();
            for i in c * CHUNK..water_r.len().min((c + 1) * CHUNK) {
                let start = chunk.index.len();
                chunk.append(water, water_r, &water_r[i], i as u32, reach);
                let middle = chunk.index.len();
                chunk.append(skin, skin_r, &water_r[i], u32::MAX, reach);
                chunk.close(start, middle);
            }
        });
        let mut beside = vec![false; skin_r.len()];
        for chunk in &self.fluid {
            for span in &chunk.spans {
                for &j in &chunk.index[span.middle as usize..span.end as usize] {
                    beside[j as usize] = true;
                }
            }
        }
        let wet: Vec<u32> = near.iter().copied().filter(|&i| beside[i as usize]).collect();
        self.boundary.resize_with(wet.len().div_ceil(CHUNK), ParticleListChunk::default);
        self.boundary.par_iter_mut().zip(wet.par_chunks(CHUNK)).for_each(|(chunk, wet)| {
            chunk.clear();
            for &i in wet {
                let start = chunk.index.len();
                chunk.append(water, water_r, &skin_r[i as usize], u32::MAX, reach);
                chunk.close(start, chunk.index.len());
            }
        });
        wet
    }
}

impl ParticleListChunk {
    fn clear(&mut self) {
        self.spans.clear();
        self.index.clear();
    }

    /// Appends the particles of `grid` nearer than `reach` to `x`, without `this` one.
    fn append<const D: usize>(&mut self, grid: &CellGrid<D>, r: &[Vector<D>], x: &Vector<D>, this: u32, reach: f64) {
        let reach2 = reach * reach;
        grid.visit_rows(&Bounds { min: *x, max: *x }.grown(reach), |row| {
            self.index.extend(row.iter().filter(|&&j| j != this && (r[j as usize] - x).norm_squared() < reach2));
        });
    }

    fn close(&mut self, start: usize, middle: usize) {
        self.spans.push(Span { start: start as u32, middle: middle as u32, end: self.index.len() as u32 });
    }
}
