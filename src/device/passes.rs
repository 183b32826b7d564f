//! The passes of a step, in their order.

use std::sync::Arc;

use super::{
    buffers::{Buffers, Counts},
    gpu::{Gpu, Module, Pass},
    shaders::{GROUP, ShaderTexts},
    solids::SolidChunks,
};
use crate::error::Result;

/// The passes.
pub(super) struct Passes {
    /// Makes what the pair loop reads of the state.
    pub(super) derive: Arc<Pass>,
    /// A force pass.
    pub(super) rates: Vec<Arc<Pass>>,
    /// A whole step between fixed solids.
    pub(super) step: Vec<Arc<Pass>>,
    /// A step up to its middle, where the host moves the solids.
    pub(super) first: Vec<Arc<Pass>>,
    /// The rest of that step.
    pub(super) second: Vec<Arc<Pass>>,
    /// Places the boundary particles of moving solids.
    pub(super) place: Arc<Pass>,
    /// Adds up the loads.
    pub(super) loads: Arc<Pass>,
}

/// Makes passes of one shader.
struct Maker<'a> {
    gpu: &'a Gpu,
    module: Module,
    /// All buffers of the shader, by their bindings.
    buffers: Vec<&'a wgpu::Buffer>,
}

impl<'a> Maker<'a> {
    fn new(gpu: &'a Gpu, text: &str, buffers: Vec<&'a wgpu::Buffer>) -> Result<Self> {
        Ok(Self { gpu, module: gpu.module(text)?, buffers })
    }

    /// The pass by the function `entry`, which uses the buffers of the bindings `uses`.
    fn pass(&self, entry: &str, threads: usize, uses: &[usize]) -> Result<Arc<Pass>> {
        let own: Vec<_> = uses.iter().map(|&binding| (binding as u32, self.buffers[binding])).collect();
        Ok(Arc::new(self.gpu.pass(&self.module, entry, threads, &own)?))
    }
}

impl Passes {
    pub(super) fn new(
        gpu: &Gpu,
        texts: &ShaderTexts,
        counts: &Counts,
        chunks: &SolidChunks,
        buffers: &Buffers,
        verlet: bool,
    ) -> Result<Self> {
        let params = gpu.uniform(&counts.words());
        let rates = rates(gpu, texts, counts, buffers, &params)?;
        let n = counts.n;
        let b = &buffers.inner;
        let solids = Maker::new(
            gpu,
            &texts.solids,
            vec![
                &params,
                &buffers.control,
                &buffers.places,
                &b.positions,
                &b.velocities,
                &buffers.motion,
                &buffers.slot,
                &b.built,
                &buffers.solids,
                &b.local,
                &b.chunks,
                &b.sums,
                &buffers.loads,
            ],
        )?;
        let place = solids.pass("place_moving", chunks.moving * GROUP, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10])?;
        let loads = solids.pass("add_loads", chunks.owners.len() * GROUP, &[0, 2, 6, 8, 10, 11, 12])?;
        let step = Maker::new(
            gpu,
            &texts.step,
            vec![
                &params,
                &buffers.control,
                &buffers.places,
                &buffers.motion,
                &buffers.before,
                &b.positions,
                &b.velocities,
                &b.sums,
                &b.spans,
                &b.walls,
                &b.built,
            ],
        )?;
        let limit = step.pass("limit", 1, &[0, 1])?;
        let finish = step.pass("finish", 1, &[0, 1])?;
        let derive = step.pass("derive", n, &[0, 2, 3, 5, 6, 10])?;
        let (whole, first, second);
        if verlet {
            let verlet = step.pass("verlet", n, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10])?;
            whole = [&rates[..], &[limit.clone(), verlet.clone(), finish.clone()]].concat();
            first = [&rates[..], &[limit, loads.clone()]].concat();
            second = vec![verlet, finish];
        } else {
            let first_half = step.pass("first_half", n, &[0, 1, 2, 3, 5, 6, 7, 8, 9, 10])?;
            let rest = step.pass("whole_step", n, &[0, 1, 2, 3, 5, 6, 7, 8, 9, 10])?;
            first = [&rates[..], &[limit, first_half]].concat();
            whole = [&first[..], &rates, &[rest.clone(), finish.clone()]].concat();
            second = [&[place.clone()], &rates[..], &[loads.clone(), rest, finish]].concat();
        }
        Ok(Self { derive, rates, step: whole, first, second, place, loads })
    }
}

/// A force pass: new lists where they are needed, and the sums over pairs.
fn rates(
    gpu: &Gpu,
    texts: &ShaderTexts,
    counts: &Counts,
    buffers: &Buffers,
    params: &wgpu::Buffer,
) -> Result<Vec<Arc<Pass>>> {
    let (b, n, cells) = (&buffers.inner, counts.n, counts.cells);
    let total = 2 * cells + 1;
    let search = Maker::new(
        gpu,
        &texts.search,
        vec![
            params,
            &buffers.control,
            &buffers.places,
            &buffers.motion,
            &buffers.before,
            &b.positions,
            &b.velocities,
            &b.count,
            &b.start,
            &b.blocks,
            &b.order,
            &buffers.slot,
            &b.spare_places,
            &b.spare,
            &b.built,
        ],
    )?;
    let mut passes = vec![
        search.pass("decide", 1, &[1])?,
        search.pass("clear", total, &[0, 1, 7])?,
        search.pass("tally", n, &[0, 1, 2, 7])?,
        search.pass("scan", total.div_ceil(1024) * GROUP, &[0, 1, 7, 8, 9])?,
        search.pass("scan_blocks", 1, &[0, 1, 9])?,
        search.pass("scan_add", total, &[0, 1, 8, 9])?,
        search.pass("scatter", n, &[0, 1, 2, 7, 8, 10])?,
        search.pass("settle", 2 * cells, &[0, 1, 2, 8, 10])?,
        search.pass("gather", n, &[0, 1, 2, 3, 4, 5, 6, 10, 12, 13])?,
        search.pass("put_back", n, &[0, 1, 2, 3, 4, 5, 6, 11, 12, 13, 14])?,
    ];
    let mut sweeps = Vec::new();
    for (number, list) in buffers.lists.iter().enumerate() {
        let start = number * counts.part;
        let first = gpu.uniform(&[start as u32, counts.part as u32, 0, 0]);
        let lists = Maker::new(
            gpu,
            &texts.lists,
            vec![
                params,
                &buffers.control,
                &first,
                &buffers.places,
                &b.positions,
                &b.start,
                list,
                &b.spans,
                &buffers.motion,
                &b.velocities,
                &b.sums,
                &buffers.before,
            ],
        )?;
        let uses: Vec<usize> = (0..12).collect();
        passes.push(lists.pass("list_pairs", counts.part.min(n - start), &uses)?);
        let sweep = Maker::new(
            gpu,
            &texts.sweep,
            vec![
                params,
                &buffers.control,
                &first,
                &b.positions,
                &b.velocities,
                list,
                &b.spans,
                &b.sums,
                &b.walls,
                &buffers.places,
                &buffers.solids,
                &buffers.depths,
            ],
        )?;
        let threads = counts.part.min(n - start);
        if start < counts.water {
            sweeps.push(sweep.pass("sweep_water", threads.min(counts.water - start), &[0, 1, 2, 3, 4, 5, 6, 7])?);
        }
        if start + threads > counts.water {
            let uses: &[usize] =
                if texts.relaxed { &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11] } else { &[0, 1, 2, 3, 4, 5, 6, 7] };
            sweeps.push(sweep.pass("sweep_boundary", threads, uses)?);
        }
    }
    passes.extend(sweeps);
    Ok(passes)
}
