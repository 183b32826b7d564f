//! The passes of a step, in their order.

use std::sync::Arc;

use super::{
    buffers::{Buffers, Counts},
    gpu::{Gpu, Pass, Shader},
    shaders::{GROUP, ShaderTexts},
    solids::SolidChunks,
};
use crate::error::Result;

/// The passes.
pub(super) struct Passes {
    /// Derives the input of the pair loop from the state.
    pub(super) derive: Arc<Pass>,
    /// A force pass.
    pub(super) rates: Vec<Arc<Pass>>,
    /// A whole step between fixed solids.
    pub(super) step: Vec<Arc<Pass>>,
    /// A step up to its middle, where the host moves the solids.
    pub(super) first: Vec<Arc<Pass>>,
    /// The rest of that step: its force pass, if it has one, and what follows from the sums.
    pub(super) second: [Vec<Arc<Pass>>; 2],
    /// Places the boundary particles of moving solids.
    pub(super) place: Arc<Pass>,
    /// Adds up the loads.
    pub(super) loads: Arc<Pass>,
    /// Adds up the velocities of the water, if there are periodic sides.
    pub(super) velocities: Option<Arc<Pass>>,
}

/// The shaders of a scene.
pub(super) struct Shaders {
    search: Shader,
    lists: Shader,
    sweep: Shader,
    step: Shader,
    pub(super) solids: Shader,
    pub(super) gaps: Option<Shader>,
    inputs: Option<Shader>,
    moments: Option<Shader>,
    images: Option<Shader>,
    sticks: Option<Shader>,
    /// Whether the stress of the water is kept.
    stress: bool,
    /// Whether steps are Verlet's, and not symplectic.
    pub(super) verlet: bool,
}

const SEARCH: [&str; 10] =
    ["decide", "clear", "tally", "scan", "scan_blocks", "scan_add", "scatter", "settle", "gather", "put_back"];

impl Shaders {
    /// Compiles the functions that the scene needs, for steps of Verlet's scheme or the symplectic one.
    pub(super) fn new(gpu: &Gpu, texts: &ShaderTexts, verlet: bool) -> Result<Self> {
        let schemes: &[&'static str] = if verlet {
            &["limit", "finish", "derive", "verlet"]
        } else {
            &["limit", "finish", "derive", "first_half", "whole_step"]
        };
        let optional = |text: &Option<String>, entries: &[&'static str]| {
            text.as_ref().map(|text| gpu.shader(text, entries)).transpose()
        };
        Ok(Self {
            search: gpu.shader(&texts.search, &SEARCH)?,
            lists: gpu.shader(&texts.lists, &["list_pairs"])?,
            sweep: gpu.shader(&texts.sweep, &["sweep_water", "sweep_boundary"])?,
            step: gpu.shader(&texts.step, schemes)?,
            solids: gpu.shader(&texts.solids, &["place_moving", "add_loads"])?,
            gaps: optional(&texts.gaps, &["find_gaps", "add_gaps"])?,
            inputs: optional(&texts.inputs, &["fill_rows", "close_stress"])?,
            moments: optional(&texts.moments, &["sweep_moments"])?,
            images: optional(&texts.images, &["place_images", "copy_rows", "update_copies", "add_velocities"])?,
            sticks: optional(&texts.sticks, &["find_slips"])?,
            stress: texts.stress.is_some(),
            verlet,
        })
    }
}

/// Makes passes of one shader with its buffers.
pub(super) struct Maker<'a> {
    gpu: &'a Gpu,
    shader: &'a Shader,
    /// All buffers of the shader, by their bindings.
    buffers: Vec<&'a wgpu::Buffer>,
}

impl<'a> Maker<'a> {
    pub(super) fn new(gpu: &'a Gpu, shader: &'a Shader, buffers: Vec<&'a wgpu::Buffer>) -> Self {
        Self { gpu, shader, buffers }
    }

    /// The pass by the function `entry`.
    pub(super) fn pass(&self, entry: &str, threads: usize) -> Result<Arc<Pass>> {
        Ok(Arc::new(self.gpu.pass(self.shader, entry, threads, &self.buffers)?))
    }
}

/// The buffers of the sums over pairs, which go to `sums`, for the particles that share a `list`, beginning with the `first`.
pub(super) fn sweep_bindings<'a>(
    params: &'a wgpu::Buffer,
    buffers: &'a Buffers,
    [first, list]: [&'a wgpu::Buffer; 2],
    sums: &'a wgpu::Buffer,
) -> Vec<&'a wgpu::Buffer> {
    let b = &buffers.pairs;
    vec![
        params,
        &buffers.control,
        first,
        &b.positions,
        &b.velocities,
        list,
        &b.spans,
        sums,
        &b.walls,
        &buffers.places,
        &buffers.solids,
        &buffers.depths,
        &b.aways,
        &b.rows,
        &b.slips,
    ]
}

/// The buffers of the pressure across gaps, which is added to `sums`.
pub(super) fn gap_bindings<'a>(
    params: &'a wgpu::Buffer,
    buffers: &'a Buffers,
    sums: &'a wgpu::Buffer,
) -> Vec<&'a wgpu::Buffer> {
    let b = &buffers.pairs;
    vec![
        params,
        &buffers.control,
        &buffers.places,
        &b.positions,
        &b.velocities,
        &buffers.search.start,
        &b.spans,
        &buffers.solids,
        &b.gaps,
        &b.aways,
        sums,
        &b.built,
    ]
}

/// The buffers of the solids, whose `loads` follow from `sums`.
pub(super) fn solid_bindings<'a>(
    params: &'a wgpu::Buffer,
    buffers: &'a Buffers,
    [sums, loads]: [&'a wgpu::Buffer; 2],
) -> Vec<&'a wgpu::Buffer> {
    let b = &buffers.pairs;
    vec![
        params,
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
        sums,
        loads,
    ]
}

impl Passes {
    pub(super) fn new(
        gpu: &Gpu,
        shaders: &Shaders,
        counts: &Counts,
        chunks: &SolidChunks,
        buffers: &Buffers,
    ) -> Result<Self> {
        let params = gpu.uniform(&counts.words());
        let images = images(gpu, shaders, (counts, chunks), buffers, &params)?;
        let velocities = images.add_velocities.clone();
        let [rates, close_stress] = rates(gpu, shaders, counts, buffers, &params, images)?;
        let n = counts.n;
        let b = &buffers.pairs;
        let solids = Maker::new(gpu, &shaders.solids, solid_bindings(&params, buffers, [&b.sums, &buffers.loads]));
        let place = solids.pass("place_moving", chunks.moving * GROUP)?;
        let loads = solids.pass("add_loads", chunks.owners.len() * GROUP)?;
        let step = Maker::new(
            gpu,
            &shaders.step,
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
                &buffers.slot,
            ],
        );
        let limit = step.pass("limit", 1)?;
        let finish = step.pass("finish", 1)?;
        let derive = step.pass("derive", n)?;
        let (whole, first, second);
        if shaders.verlet {
            let verlet = step.pass("verlet", n)?;
            let all = [&rates[..], &close_stress].concat();
            whole = [&all[..], &[limit.clone(), verlet.clone(), finish.clone()]].concat();
            first = [&all[..], &[limit, loads.clone()]].concat();
            second = [Vec::new(), vec![verlet, finish]];
        } else {
            let first_half = step.pass("first_half", n)?;
            let rest = step.pass("whole_step", n)?;
            first = [&rates[..], &[limit, first_half]].concat();
            whole = [&first[..], &rates, &close_stress, &[rest.clone(), finish.clone()]].concat();
            let forces = [std::slice::from_ref(&place), &rates, &close_stress, std::slice::from_ref(&loads)].concat();
            second = [forces, vec![rest, finish]];
        }
        Ok(Self { derive, rates, step: whole, first, second, place, loads, velocities })
    }
}

/// The shader passes of a force pass: new lists where they are needed, and the sums over pairs. Then the pass that computes the
/// stress from these sums once in each step, if the stress is kept.
fn rates(
    gpu: &Gpu,
    shaders: &Shaders,
    counts: &Counts,
    buffers: &Buffers,
    params: &wgpu::Buffer,
    images: ImagePasses,
) -> Result<[Vec<Arc<Pass>>; 2]> {
    let (b, searched, n, cells) = (&buffers.pairs, &buffers.search, counts.n, counts.all_cells());
    let total = counts.all_cells() + 1;
    let search = Maker::new(
        gpu,
        &shaders.search,
        vec![
            params,
            &buffers.control,
            &buffers.places,
            &buffers.motion,
            &buffers.before,
            &b.positions,
            &b.velocities,
            &searched.count,
            &searched.start,
            &searched.blocks,
            &searched.order,
            &buffers.slot,
            &searched.spare_places,
            &searched.spare,
            &b.built,
            &b.rows,
            &searched.spare_rows,
        ],
    );
    let mut passes = vec![
        search.pass("decide", 1)?,
        search.pass("clear", total)?,
        search.pass("tally", n)?,
        search.pass("scan", total.div_ceil(1024) * GROUP)?,
        search.pass("scan_blocks", 1)?,
        search.pass("scan_add", total)?,
        search.pass("scatter", n)?,
        search.pass("settle", cells)?,
        search.pass("gather", counts.slots())?,
        search.pass("put_back", n)?,
    ];
    passes.extend(images.place);
    let (mut sweeps, mut corrections) = (Vec::new(), Vec::new());
    for (part, list) in buffers.lists(counts) {
        let first = gpu.uniform(&part.words());
        let lists = Maker::new(
            gpu,
            &shaders.lists,
            vec![
                params,
                &buffers.control,
                &first,
                &buffers.places,
                &b.positions,
                &searched.start,
                list,
                &b.spans,
                &buffers.motion,
                &b.velocities,
                &b.sums,
                &buffers.before,
            ],
        );
        passes.push(lists.pass("list_pairs", part.count)?);
        let sweep = Maker::new(gpu, &shaders.sweep, sweep_bindings(params, buffers, [&first, list], &b.sums));
        if part.is_water {
            if let Some(text) = &shaders.moments {
                let buffers =
                    vec![params, &buffers.control, &first, &b.positions, &b.velocities, list, &b.spans, &b.rows];
                corrections.push(Maker::new(gpu, text, buffers).pass("sweep_moments", part.count)?);
            }
            sweeps.push(sweep.pass("sweep_water", part.count)?);
            continue;
        }
        if let Some(text) = &shaders.sticks {
            let own = [&b.spans, &buffers.places, &buffers.solids, &buffers.depths, &b.normals, &b.slips];
            let before = [params, &buffers.control, &first, &b.positions, &b.velocities, list];
            let sticks = Maker::new(gpu, text, before.into_iter().chain(own).collect());
            corrections.push(sticks.pass("find_slips", part.count)?);
        }
        sweeps.push(sweep.pass("sweep_boundary", part.count)?);
    }
    if let Some(text) = &shaders.gaps {
        let gaps = Maker::new(gpu, text, gap_bindings(params, buffers, &b.sums));
        let boundary = n - counts.water;
        passes.push(gaps.pass("find_gaps", boundary)?);
        sweeps.push(gaps.pass("add_gaps", boundary)?);
    }
    let mut close = Vec::new();
    if let Some(text) = &shaders.inputs {
        let inputs = Maker::new(
            gpu,
            text,
            vec![
                params,
                &buffers.control,
                &buffers.places,
                &b.positions,
                &b.velocities,
                &b.rows,
                &b.sums,
                &buffers.solids,
            ],
        );
        passes.push(inputs.pass("fill_rows", n)?);
        if shaders.stress {
            close.push(inputs.pass("close_stress", counts.water)?);
        }
    }
    passes.extend(corrections);
    passes.extend(images.before_sums);
    passes.extend(sweeps);
    Ok([passes, close])
}

/// The passes for images across periodic sides: after the search, before the sums over pairs, and after a step.
#[derive(Default)]
struct ImagePasses {
    place: Option<Arc<Pass>>,
    before_sums: Vec<Arc<Pass>>,
    add_velocities: Option<Arc<Pass>>,
}

/// Those of the scene.
fn images(
    gpu: &Gpu,
    shaders: &Shaders,
    (counts, chunks): (&Counts, &SolidChunks),
    buffers: &Buffers,
    params: &wgpu::Buffer,
) -> Result<ImagePasses> {
    let Some(text) = &shaders.images else { return Ok(ImagePasses::default()) };
    let (b, searched) = (&buffers.pairs, &buffers.search);
    let maker = Maker::new(
        gpu,
        text,
        vec![
            params,
            &buffers.control,
            &buffers.places,
            &buffers.motion,
            &b.positions,
            &b.velocities,
            &searched.start,
            &searched.order,
            &buffers.slot,
            &b.rows,
            &b.copied,
            &b.flow,
            &b.slips,
        ],
    );
    let mut before_sums = Vec::new();
    if shaders.inputs.is_some() {
        before_sums.push(maker.pass("copy_rows", counts.images())?);
    }
    if !chunks.copied.is_empty() {
        before_sums.push(maker.pass("update_copies", chunks.copied.len())?);
    }
    let place = Some(maker.pass("place_images", counts.images())?);
    Ok(ImagePasses { place, before_sums, add_velocities: Some(maker.pass("add_velocities", counts.water)?) })
}
