//! The powers on the water that the energy budget and the load breakdown read: `coupling/power_breakdown.rs`.
//!
//! The device adds up what 128 water particles contribute, in a fixed tree; the host adds up these sums, in order and in double
//! precision.

use std::sync::Arc;

use super::{
    Device, MeasuredPowers,
    buffers::{Buffers, Counts},
    gpu::{Gpu, Pass, Shader},
    passes::{Maker, Shaders, gap_bindings, solid_bindings, sweep_bindings},
    shaders::{GROUP, ShaderTexts},
    solids::SolidChunks,
};
use crate::{
    coupling::{DevicePass, PressurePass},
    error::Result,
    math::Vector,
    system::System,
};

/// The shaders, arrays and passes that measure powers.
pub(super) struct Powers {
    shader: Shader,
    pressure: Vec<PressureSums>,
    /// What each chunk of the water contributes: gains, velocities, displacements by shifting, absorbed energy, places.
    parts: [wgpu::Buffer; 5],
    passes: PowerPasses,
}

/// The sums over pairs of the pressure alone, and what follows from them.
struct PressureSums {
    sweep: Shader,
    sums: wgpu::Buffer,
    loads: wgpu::Buffer,
    gains: wgpu::Buffer,
}

/// The passes.
struct PowerPasses {
    /// In each force pass.
    total: Vec<Arc<Pass>>,
    /// In those with a power breakdown.
    breakdown: Vec<Arc<Pass>>,
    absorbed: Arc<Pass>,
    places: Arc<Pass>,
}

/// Functions of the shader.
const ENTRIES: [&str; 6] = ["clear_sums", "add_gains", "add_flow", "add_shifts", "add_absorbed", "add_places"];

impl PowerPasses {
    fn new(
        gpu: &Gpu,
        shader: &Shader,
        (pressure, parts): (&[PressureSums], &[wgpu::Buffer; 5]),
        shaders: &Shaders,
        (counts, chunks): (&Counts, &SolidChunks),
        buffers: &Buffers,
    ) -> Result<Self> {
        let (params, b) = (gpu.uniform(&counts.words()), &buffers.pairs);
        let maker = |sums, parts| {
            let state = [&params, &buffers.control, &buffers.places, &buffers.motion, &b.positions, &b.velocities];
            Maker::new(gpu, shader, state.into_iter().chain([sums, parts]).collect())
        };
        let add = |entry: &str, sums, parts| maker(sums, parts).pass(entry, counts.water);
        let [gains, flow, shifts, absorbed, places] = parts;
        let total = [("add_gains", gains), ("add_flow", flow), ("add_shifts", shifts)];
        let total = total.map(|(entry, of)| add(entry, &b.sums, of)).into_iter().collect::<Result<_>>()?;
        let mut breakdown = Vec::new();
        for own in pressure {
            breakdown.push(maker(&own.sums, &own.gains).pass("clear_sums", counts.n)?);
            for (part, list) in buffers.lists(counts) {
                let first = gpu.uniform(&part.words());
                let sweep = Maker::new(gpu, &own.sweep, sweep_bindings(&params, buffers, [&first, list], &own.sums));
                let entry = if part.is_water { "sweep_water" } else { "sweep_boundary" };
                breakdown.push(sweep.pass(entry, part.count)?);
            }
            if let Some(text) = &shaders.gaps {
                let gaps = Maker::new(gpu, text, gap_bindings(&params, buffers, &own.sums));
                breakdown.push(gaps.pass("add_gaps", counts.n - counts.water)?);
            }
            breakdown.push(add("add_gains", &own.sums, &own.gains)?);
            let solids = solid_bindings(&params, buffers, [&own.sums, &own.loads]);
            let solids = Maker::new(gpu, &shaders.solids, solids);
            breakdown.push(solids.pass("add_loads", chunks.owners.len() * GROUP)?);
        }
        let [absorbed, places] = [add("add_absorbed", &b.sums, absorbed)?, add("add_places", &b.sums, places)?];
        Ok(Self { total, breakdown, absorbed, places })
    }
}

impl Powers {
    /// For the shaders of `texts`, if they measure powers.
    pub(super) fn new(
        gpu: &Gpu,
        texts: &ShaderTexts,
        shaders: &Shaders,
        (counts, chunks): (&Counts, &SolidChunks),
        buffers: &Buffers,
    ) -> Result<Option<Self>> {
        let Some((text, sweeps)) = texts.powers.split_first() else { return Ok(None) };
        let shader = gpu.shader(text, &ENTRIES)?;
        let of_chunks = || gpu.buffer(16 * counts.water.div_ceil(GROUP));
        let pressure_sums = |text: &String| {
            Ok(PressureSums {
                sweep: gpu.shader(text, &["sweep_water", "sweep_boundary"])?,
                sums: gpu.buffer(buffers.pairs.sums.size() as usize)?,
                loads: gpu.buffer(buffers.loads.size() as usize)?,
                gains: of_chunks()?,
            })
        };
        let pressure = sweeps.iter().map(pressure_sums).collect::<Result<Vec<_>>>()?;
        let parts = [of_chunks()?, of_chunks()?, of_chunks()?, of_chunks()?, of_chunks()?];
        let passes = PowerPasses::new(gpu, &shader, (&pressure, &parts), shaders, (counts, chunks), buffers)?;
        Ok(Some(Self { shader, pressure, parts, passes }))
    }

    /// Makes the passes anew, for other numbers of particles or other arrays.
    pub(super) fn make_passes(
        &mut self,
        gpu: &Gpu,
        shaders: &Shaders,
        counts: (&Counts, &SolidChunks),
        buffers: &Buffers,
    ) -> Result<()> {
        let own = (&self.pressure[..], &self.parts);
        self.passes = PowerPasses::new(gpu, &self.shader, own, shaders, counts, buffers)?;
        Ok(())
    }

    /// Memory, B.
    pub(super) fn bytes(&self) -> u64 {
        let pressure = self.pressure.iter().flat_map(|own| [&own.sums, &own.loads, &own.gains]);
        pressure.chain(&self.parts).map(wgpu::Buffer::size).sum()
    }
}

/// The sum of the vectors at the beginning of each four `words`.
pub(super) fn vector_of<const D: usize>(words: &[f32]) -> Vector<D> {
    let sum = |k: usize| words.chunks_exact(4).map(|chunk| f64::from(chunk[k])).sum::<f64>();
    Vector::from_fn(|k, _| sum(k))
}

impl<const D: usize> Device<D> {
    /// Whether it can measure powers.
    pub(crate) fn measures_powers(&self) -> bool {
        self.powers.is_some()
    }

    /// The passes that measure powers: between a force pass and what follows from it, and after the step.
    pub(super) fn measure(&self, measured: MeasuredPowers) -> [Vec<&Pass>; 2] {
        let Some(powers) = self.powers.as_ref().filter(|_| measured != MeasuredPowers::None) else {
            return [Vec::new(), Vec::new()];
        };
        let PowerPasses { total, breakdown, absorbed, .. } = &powers.passes;
        let breakdown = if measured == MeasuredPowers::Breakdown { &breakdown[..] } else { &[] };
        let during = total.iter().chain(breakdown).map(AsRef::as_ref).collect();
        [during, vec![absorbed.as_ref()]]
    }

    /// The powers in the last force pass, with loads that leave out thin parts, and what the last step adds up over the water.
    pub(super) fn measured(&self, measured: MeasuredPowers, system: &System<D>) -> Result<Option<DevicePass<D>>> {
        let Some(powers) = self.powers.as_ref().filter(|_| measured != MeasuredPowers::None) else { return Ok(None) };
        let (length, time) = (self.units.length, self.units.time);
        let mass = system.particle_mass() * system.water_multiplicity();
        let words = 4 * self.counts.water.div_ceil(GROUP);
        let [gains, flow, shifts, absorbed, _] = &powers.parts;
        let [gains, flow, shifts, absorbed] =
            self.gpu.read::<f32, 4>([gains, flow, shifts, absorbed].map(|of| (of, words)))?;
        let gains_of = |words: &[f32]| {
            let [motion, compression]: [f64; 2] = vector_of::<2>(words).into();
            [motion, compression].map(|sum| sum * mass * length * length / time.powi(3))
        };
        let pressure_pass = |own: &PressureSums| -> Result<PressurePass<D>> {
            let [gains] = self.gpu.read::<f32, 1>([(&own.gains, words)])?;
            let [loads] = self.gpu.read::<u32, 1>([(&own.loads, 8 * self.chunks.owners.len())])?;
            Ok((gains_of(&gains), self.chunks.loads(&loads, system, &self.units)))
        };
        let breakdown = measured == MeasuredPowers::Breakdown;
        let own = |number: usize| powers.pressure.get(number).filter(|_| breakdown).map(pressure_pass).transpose();
        Ok(Some(DevicePass {
            gains: gains_of(&gains),
            pressure: own(0)?,
            plain: own(1)?,
            velocity_sum: vector_of(&flow) * (length / time),
            shift_sum: vector_of(&shifts) * length,
            absorbed: vector_of::<1>(&absorbed)[0] * mass * (length / time).powi(2),
        }))
    }

    /// The sum of the places (m) of the water, if powers can be measured; else zero.
    pub(crate) fn place_sum(&self) -> Result<Vector<D>> {
        let Some(powers) = &self.powers else { return Ok(Vector::zeros()) };
        self.gpu.run(&[], [powers.passes.places.as_ref()]);
        let [.., places] = &powers.parts;
        let [places] = self.gpu.read::<f32, 1>([(places, 4 * self.counts.water.div_ceil(GROUP))])?;
        Ok(vector_of(&places) * self.units.length)
    }
}
