//! Whole steps on a graphics card (feature `gpu`): the state stays on the card, and the host fetches it when an output is due.
//!
//! The pair loop's terms are traced ([`crate::sph::trace`]) and written as WGSL between hand-written shaders: sorting into cells,
//! neighbour lists, time step, schemes, boundary particles and loads. Places are whole numbers of 64 bits, excess densities of
//! 32; velocities are in single precision. Sums over the particles of a body are added in a fixed tree. All other values that
//! particles share are the largest or smallest of whole numbers. The order in a cell is that of the host. Therefore the same
//! device and driver give the same bits.
//!
//! Solids stay with the host, in double precision. In a scene whose solids are fixed the device makes many steps on its own.

mod buffers;
mod film_reads;
mod gpu;
mod layout;
mod near;
mod passes;
mod periodic;
mod powers;
mod shaders;
mod solids;
mod sponge;
mod text;
mod wall_shaders;

pub use gpu::{Adapter, adapters};
pub use shaders::ShaderTexts;

use buffers::{Buffers, Clock, Control, Counts, WORDS};
use film_reads::FilmReads;
use gpu::Gpu;
use layout::Layout;
use near::{Answer, Near};
use passes::{Passes, Shaders};
use periodic::Sides;
use powers::Powers;
use shaders::{ShaderInput, TICKS, entries};
use solids::SolidChunks;
use sponge::sponge_statements;

use crate::{
    coupling::{DevicePass, pressure_models},
    error::{Error, ErrorCode, ErrorKind, Result},
    interaction::{PairSums, StepLimits},
    math::{Bounds, Matrix, Vector},
    model::{Model, TimeScheme, Walls},
    sph::Units,
    system::{
        System,
        device_state::{self, NearParticle, WaterLoads},
        reflected,
    },
    time_integration::{Stepper, VerletHistory},
};

/// How far the lists reach beyond the kernel's support, over the support.
const MARGIN: f64 = 0.1;

/// Number of steps of a submission: of the first one, and the largest.
const FIRST_STEPS: usize = 4;
const MOST_STEPS: usize = 64;

/// How long a submission should take, s: the run can be stopped between two.
const SUBMISSION: f64 = 0.1;

/// The water and the boundary particles of a simulation on a device.
pub(crate) struct Device<const D: usize> {
    gpu: Gpu,
    layout: Layout,
    sides: Sides<D>,
    units: Units,
    shaders: Shaders,
    rows: RowCounts,
    counts: Counts,
    chunks: SolidChunks,
    buffers: Buffers,
    passes: Passes,
    /// The arrays and passes with which the host reads water between two outputs, if it does.
    near: Option<Near>,
    /// Those with which it reads the boundary particles of films, if there may be films.
    films: Option<FilmReads>,
    /// The arrays and passes with which powers are measured, if they are.
    powers: Option<Powers>,
    clock: Clock,
    /// Steps of the next submission.
    steps: usize,
}

/// Rows of additional inputs of the pair loop, and the first of them with the stress of the water, if it is kept.
#[derive(Clone, Copy, Debug)]
struct RowCounts {
    inputs: usize,
    stress: Option<usize>,
}

/// What limits the steps of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepRequest {
    /// Longest step, s.
    pub(crate) longest: f64,
    /// Factor on the step that the water allows, –.
    pub(crate) factor: f64,
    /// Time at which the device pauses, s.
    pub(crate) pause: f64,
    /// Time that it does not pass, s.
    pub(crate) end: f64,
}

impl StepRequest {
    /// No limit.
    const NONE: Self = Self { longest: f64::INFINITY, factor: 1.0, pause: f64::INFINITY, end: f64::INFINITY };
}

/// What a device has done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DeviceSteps {
    /// Steps made.
    pub(crate) steps: u64,
    /// Force passes made.
    pub(crate) passes: u64,
    /// Time at the end, s.
    pub(crate) time: f64,
    /// Length of the last step, s.
    pub(crate) dt: f64,
    /// Factor of the loads of the last force pass on bodies, –.
    pub(crate) weight: f64,
    /// Why it stopped.
    pub(crate) end: StepsEnd,
}

/// Why a device stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StepsEnd {
    /// It made all steps that it was asked for.
    Steps,
    /// It reached the time at which it was to pause, or the end.
    Time,
    /// The water particle of this index left the valid range.
    Fault(usize),
    /// There is no time step.
    NoStep,
    /// Water has left the domain, and is to be removed.
    Escape,
}

/// The powers that a step measures in its force pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeasuredPowers {
    None,
    /// The power on the water.
    Total,
    /// The same, and what the pressure alone does.
    Breakdown,
}

/// What the host reads of the water between two outputs.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct WaterReads {
    /// Whether it reads the water near some places.
    pub(crate) near: bool,
    /// The boundary particles for which it reads the weight of the surrounding water, in ascending order.
    pub(crate) watched: Vec<u32>,
    /// Axes along which it reads where that water is: all, or none.
    pub(crate) offset_rows: usize,
    /// Whether it measures powers.
    pub(crate) powers: bool,
}

/// A step up to its middle.
pub(crate) struct FirstHalf<const D: usize> {
    /// Length of the step, s.
    pub(crate) dt: f64,
    /// The water near the requested places at the start of the step.
    pub(crate) near: Vec<NearParticle<D>>,
}

/// The rest of a step.
pub(crate) struct SecondHalf<const D: usize> {
    pub(crate) done: DeviceSteps,
    pub(crate) loads: WaterLoads<D>,
    /// The powers, if the step measured them.
    pub(crate) powers: Option<DevicePass<D>>,
    /// The water near the requested places at the end of the step.
    pub(crate) near: Vec<NearParticle<D>>,
}

/// The refusal of `what` on a device.
pub(crate) fn refused(what: &str) -> Error {
    Error::new(ErrorKind::Usage, format!("a device does not compute {what} yet"))
        .with_code(ErrorCode::NoDevice)
        .help("leave --device (model.device) out: the processor computes all of this scene")
}

/// The texts of the shaders for `system`, without a device. If `reads` is true, they include those with which the host reads
/// water and measures powers.
///
/// # Errors
/// `Usage` if no device computes the system yet.
#[doc(hidden)]
pub fn shaders_of<const D: usize>(system: &System<D>, reads: bool) -> Result<ShaderTexts> {
    let watched = if reads { vec![0] } else { Vec::new() };
    let reads = WaterReads { near: reads, watched, offset_rows: if reads { D } else { 0 }, powers: reads };
    let layout = Layout::new::<D>(system.model());
    shader_texts(system, (&layout, &Sides::new(system, &layout)), &SolidChunks::new(system), &reads)
}

/// The texts of the shaders for the present state of `system`.
fn shader_texts<const D: usize>(
    system: &System<D>,
    (layout, sides): (&Layout, &Sides<D>),
    chunks: &SolidChunks,
    reads: &WaterReads,
) -> Result<ShaderTexts> {
    if let Some(what) = device_state::unsupported_on_device(system) {
        return Err(refused(what));
    }
    let model = system.model();
    let gravity_changes = device_state::gravity_changes(system);
    let (traces, units) = model.pair_traces::<D>(gravity_changes).ok_or_else(|| refused("this pair loop"))?;
    let mut pressure = Vec::new();
    if reads.powers {
        let (alone, plain) = pressure_models(model);
        let traced = |model: &Model| model.pair_traces::<D>(gravity_changes).map(|(traces, _)| traces);
        pressure.extend(std::iter::once(&alone).chain(&plain).filter_map(traced));
    }
    let domain = system.domain();
    let input = ShaderInput::<D> {
        model,
        traces: &traces,
        units,
        limits: device_state::particle_limits(system),
        domain: [
            std::array::from_fn(|k| layout.coarse(domain.min[k], f64::floor)),
            std::array::from_fn(|k| layout.coarse(domain.max[k], f64::ceil)),
        ],
        sides: *sides,
        margin: MARGIN,
        chunks: [chunks.moving, chunks.owners.len()],
        near: reads.near || !reads.watched.is_empty(),
        weighs: !reads.watched.is_empty(),
        offsets: reads.offset_rows > 0 && model.walls == Walls::RelaxedAdami,
        gravity_changes,
        sponge: sponge_statements(system, layout, &units)?,
        gaps: device_state::has_free_solids(system) && model.walls == Walls::RelaxedAdami,
        pressure: &pressure,
    };
    input.texts().ok_or_else(|| refused("numbers of this size in single precision"))
}

impl<const D: usize> Device<D> {
    /// Puts the particles of `system` on the device `name`, at `time` (s); `reads` is what the host reads of the water between two
    /// outputs.
    pub(crate) fn new(
        name: &str,
        system: &System<D>,
        stepper: &Stepper<D>,
        time: f64,
        reads: WaterReads,
    ) -> Result<Self> {
        let (model, chunks) = (system.model(), SolidChunks::new(system));
        let layout = Layout::new::<D>(model);
        let sides = Sides::new(system, &layout);
        let texts = shader_texts(system, (&layout, &sides), &chunks, &reads)?;
        if !system.fluid().r.iter().chain(system.boundary().r).all(|r| layout.reaches(r)) {
            return Err(refused("places a million kernel supports from the origin"));
        }
        let gpu = Gpu::open(name)?;
        let counts = Counts::new(system, (&layout, &sides), &gpu.adapter, MARGIN)?;
        let verlet = matches!(model.scheme, TimeScheme::Verlet { .. });
        let shaders = Shaders::new(&gpu, &texts, verlet)?;
        let buffers = Buffers::new(&gpu, &counts, &chunks, &texts, verlet)?;
        let passes = Passes::new(&gpu, &shaders, &counts, &chunks, &buffers)?;
        let near = Near::new(&gpu, &texts, &counts, &buffers, reads)?;
        let films = FilmReads::new(&gpu, &texts, &counts, &buffers)?;
        let powers = Powers::new(&gpu, &texts, &shaders, (&counts, &chunks), &buffers)?;
        let (units, rows) =
            (model.single_precision_units::<D>(), RowCounts { stress: texts.stress, inputs: texts.rows[1] });
        let (clock, steps) = (Clock { start: time, ticks: 0 }, FIRST_STEPS);
        let mut device = Self {
            gpu,
            layout,
            sides,
            units,
            shaders,
            rows,
            counts,
            chunks,
            buffers,
            passes,
            near,
            films,
            powers,
            clock,
            steps,
        };
        device.load(system, stepper, time)?;
        Ok(device)
    }

    /// The adapter that computes, for a message.
    pub(crate) fn adapter(&self) -> &Adapter {
        &self.gpu.adapter
    }

    /// Memory of the arrays, B: all, and of these the neighbour lists.
    pub(crate) fn memory_bytes(&self) -> [u64; 2] {
        let near = self.near.as_ref().map_or(0, Near::bytes) + self.films.as_ref().map_or(0, FilmReads::bytes);
        let others = near + self.powers.as_ref().map_or(0, Powers::bytes);
        [self.buffers.bytes() + others, self.buffers.list_bytes()]
    }

    /// Takes the state of `system` at `time` (s).
    pub(crate) fn load(&mut self, system: &System<D>, stepper: &Stepper<D>, time: f64) -> Result<()> {
        self.fit(system)?;
        let (gpu, layout, buffers) = (&self.gpu, self.layout, &self.buffers);
        let (water, boundary) = (system.fluid(), system.boundary());
        let count = water.len();
        let of_water = (0..count).map(|i| (water.r[i], water.v[i], water.rho[i], u32::MAX));
        let of_boundary = (0..boundary.len())
            .zip(self.chunks.set_of_each())
            .map(|(i, set)| (boundary.r[i], boundary.v[i], boundary.rho[i], set));
        let all: Vec<_> = of_water.chain(of_boundary).collect();
        let places: Vec<_> =
            all.iter().enumerate().map(|(i, (r, _, _, solid))| layout.place(r, i as u32, *solid)).collect();
        let motion: Vec<_> = all.iter().map(|(_, v, rho, _)| layout.motion(v, *rho)).collect();
        gpu.write(&buffers.places, 0, &places);
        gpu.write(&buffers.motion, 0, &motion);
        if let (Some(row), Some(stress)) = (self.rows.stress, device_state::fluid_stress(system)) {
            let scale = (self.units.time / self.units.length).powi(2);
            for (row, (i, j)) in (row..).zip(entries(D)) {
                let values: Vec<f32> = stress.iter().map(|stress| (stress[(i, j)] * scale) as f32).collect();
                gpu.write(&buffers.pairs.rows, 4 * row * self.counts.slots(), &values);
            }
        }
        let mut control = Control::start();
        if let Stepper::Verlet(verlet) = stepper {
            let history = verlet.history();
            if !history.velocity.is_empty() || !history.boundary_density.is_empty() {
                let rho = history.density.iter().take(count).chain(&history.boundary_density);
                let v = history.velocity.iter().take(count).chain(boundary.v);
                let before: Vec<_> = v.zip(rho).map(|(v, rho)| layout.motion(v, *rho)).collect();
                gpu.write(&buffers.before, 0, &before);
                control.set_history(history.steps, history.foldings, history.dt / self.units.time);
            }
        }
        gpu.write(&buffers.control, 0, &control.0);
        self.write_gravity(system);
        self.clock = Clock { start: time, ticks: 0 };
        self.write_solids(system);
        let constants: Vec<[f32; 2]> = device_state::wall_constants(system)
            .into_iter()
            .map(|[depth, weight]| [(depth / self.units.length) as f32, weight as f32])
            .collect();
        self.gpu.write(&self.buffers.depths, 0, &constants);
        if let Some(normals) = device_state::wall_normals(system) {
            let words = |normal: &Vector<D>| std::array::from_fn(|k| if k < D { normal[k] as f32 } else { 0.0 });
            let normals: Vec<[f32; 4]> = normals.iter().map(words).collect();
            self.gpu.write(&self.buffers.pairs.normals, 0, &normals);
        }
        self.gpu.run(&[], [self.passes.derive.as_ref()]);
        self.gpu.check()
    }

    /// Gives the device the gravity of the next force pass.
    pub(crate) fn write_gravity(&self, system: &System<D>) {
        let gravity = system.gravity() * (self.units.time * self.units.time / self.units.length);
        let words: Vec<f32> = gravity.iter().map(|x| *x as f32).collect();
        self.gpu.write(&self.buffers.control, Control::GRAVITY * 4, &words);
    }

    /// Gives the device the kinematics of the solids.
    fn write_solids(&mut self, system: &System<D>) {
        let solids = self.chunks.solids(system, (&self.layout, &self.sides), &self.units);
        self.gpu.write(&self.buffers.solids, 0, &solids);
    }

    /// The ticks from tick 0 to `time` (s).
    fn ticks_at(&self, time: f64) -> u64 {
        let ticks = (time - self.clock.start) / self.units.time * TICKS;
        if ticks < 9e18 { ticks.round().max(0.0) as u64 } else { u64::MAX / 2 }
    }

    /// The longest step `dt` (s) in ticks, rounded up, so that a step to the beginning of a constraint does not end before it.
    fn limit(&self, dt: f64) -> u32 {
        (dt / self.units.time * TICKS).ceil().min(1e9) as u32
    }

    /// Makes up to `most` steps of a system whose solids are fixed, until the water has reached the time of the pause.
    pub(crate) fn run(&mut self, most: u64, request: &StepRequest) -> Result<DeviceSteps> {
        let started = std::time::Instant::now();
        let count = most.min(self.steps as u64) as usize;
        loop {
            self.begin(request);
            let saved = self.buffers.backups();
            let steps = std::iter::repeat_n(&self.passes.step, count).flatten();
            self.gpu.run(&saved, steps.map(AsRef::as_ref));
            let control = self.control()?;
            if !self.grow_lists(&control)? {
                let taken = started.elapsed().as_secs_f64();
                let wanted = count as f64 * SUBMISSION / taken.max(1e-6);
                self.steps = (wanted as usize).clamp(1, MOST_STEPS).min(4 * self.steps);
                return Ok(self.outcome(&control, request.end));
            }
        }
    }

    /// Lets the device go on, from where it halted.
    fn begin(&self, request: &StepRequest) {
        let StepRequest { longest, factor, pause, end } = *request;
        let two = |ticks: u64| [ticks as u32, (ticks >> 32) as u32];
        let ([e0, e1], [p0, p1]) = (two(self.ticks_at(end)), two(self.ticks_at(pause)));
        self.gpu.write(&self.buffers.control, Control::HALT * 4, &[0u32]);
        self.gpu.write(&self.buffers.control, Control::END * 4, &[e0, e1, p0, p1, self.limit(longest), 0]);
        self.gpu.write(&self.buffers.control, Control::PASSES * 4, &[0u32]);
        self.gpu.write(&self.buffers.control, Control::FACTOR * 4, &[factor as f32]);
        self.gpu.write(&self.buffers.control, Control::FAULT * 4, &[u32::MAX]);
    }

    /// The control words, after all passes.
    fn control(&self) -> Result<Control> {
        let [words] = self.gpu.read([(&self.buffers.control, WORDS)])?;
        Ok(Control::from_words(&words))
    }

    /// If a list was too short, makes longer lists and returns to the state before the submission.
    fn grow_lists(&mut self, control: &Control) -> Result<bool> {
        if !self.counts.grow_lists(control.longest(), &self.gpu.adapter) {
            return Ok(false);
        }
        self.buffers.make_lists(&self.gpu, &self.counts)?;
        self.make_passes()?;
        self.go_back();
        Ok(true)
    }

    /// Makes the passes for the present arrays and numbers of particles.
    fn make_passes(&mut self) -> Result<()> {
        self.passes = Passes::new(&self.gpu, &self.shaders, &self.counts, &self.chunks, &self.buffers)?;
        if let Some(films) = &mut self.films {
            films.make_pass(&self.gpu, &self.counts, &self.buffers)?;
        }
        if let Some(near) = &mut self.near {
            near.make_passes(&self.gpu, &self.counts, &self.buffers)?;
        }
        match &mut self.powers {
            Some(powers) => powers.make_passes(&self.gpu, &self.shaders, (&self.counts, &self.chunks), &self.buffers),
            None => Ok(()),
        }
    }

    /// Goes back to the state before the submission.
    fn go_back(&self) {
        let copies = self.buffers.restores();
        self.gpu.run(&copies, [self.passes.derive.as_ref()]);
        self.gpu.write(&self.buffers.control, Control::MOVED * 4, &[Control::FAR]);
        for longest in [Control::LONGEST, Control::LONGEST_OF_BOUNDARY] {
            self.gpu.write(&self.buffers.control, longest * 4, &[0u32]);
        }
    }

    /// What the control words say of the steps since the last call.
    fn outcome(&mut self, control: &Control, end: f64) -> DeviceSteps {
        self.clock.ticks = control.time();
        let time = if self.clock.ticks >= self.ticks_at(end) {
            end
        } else {
            self.clock.start + self.clock.ticks as f64 / TICKS * self.units.time
        };
        let end = match control.halt() {
            0 => StepsEnd::Steps,
            2 => StepsEnd::Fault(control.fault() as usize),
            3 => StepsEnd::NoStep,
            5 => StepsEnd::Escape,
            _ => StepsEnd::Time,
        };
        let dt = f64::from(control.dt()) * self.units.time;
        let weight = control.weight(self.shaders.verlet);
        DeviceSteps { steps: u64::from(control.steps()), passes: u64::from(control.passes()), time, dt, weight, end }
    }

    /// Makes the first half of a step: the rates, the step's length and, in the symplectic scheme, the displacement over half a
    /// step. Returns the length with the water in `ranges` (m) at the start, or the reason why there is no step.
    pub(crate) fn first_half(
        &mut self,
        request: &StepRequest,
        ranges: &[Bounds<D>],
    ) -> Result<std::result::Result<FirstHalf<D>, DeviceSteps>> {
        loop {
            self.begin(request);
            self.prepare_find(ranges)?;
            let saved = self.buffers.backups();
            let passes = self.find(ranges).into_iter().chain(self.passes.first.iter().map(AsRef::as_ref));
            self.gpu.run(&saved, passes);
            let Answer { control, near, has_all, .. } = self.answer(ranges, false)?;
            if self.grow_lists(&control)? {
                continue;
            }
            if control.halt() != 0 {
                return Ok(Err(self.outcome(&control, request.end)));
            }
            if has_all {
                return Ok(Ok(FirstHalf { dt: f64::from(control.dt()) * self.units.time, near }));
            }
            self.go_back();
        }
    }

    /// Completes the step with the solids of `system` at their places halfway through the step. Returns the loads on them, with
    /// the powers that are `measured` and the water in `ranges` (m) at the end.
    ///
    /// `None` if a list was too short: then the state is that before the step, and the caller repeats the step.
    pub(crate) fn second_half(
        &mut self,
        system: &System<D>,
        end: f64,
        ranges: &[Bounds<D>],
        measured: MeasuredPowers,
    ) -> Result<Option<SecondHalf<D>>> {
        self.write_solids(system);
        self.prepare_find(ranges)?;
        let [forces, rest] = self.passes.second.each_ref().map(|passes| passes.iter().map(AsRef::as_ref));
        let [during, after] = self.measure(measured);
        let passes = forces.chain(during).chain(rest).chain(after);
        self.gpu.run(&[], passes.chain(self.read_boundary()).chain(self.find(ranges)));
        let mut answer = self.answer(ranges, true)?;
        if self.grow_lists(&answer.control)? {
            return Ok(None);
        }
        if !answer.has_all {
            self.prepare_find(ranges)?;
            self.gpu.run(&[], self.find(ranges));
            answer = self.answer(ranges, true)?;
        }
        let Answer { control, loads, near, .. } = answer;
        let loads = self.water_loads(&loads, system);
        let powers = self.measured(measured, system)?;
        Ok(Some(SecondHalf { done: self.outcome(&control, end), loads, powers, near }))
    }

    /// Gives the device the solids of `system` at the end of a step.
    pub(crate) fn move_solids(&mut self, system: &System<D>) {
        self.write_solids(system);
        self.gpu.run(&[], [self.passes.place.as_ref()]);
    }

    /// The sum of the velocities (m/s) of the water, if there are periodic sides; else zero.
    pub(crate) fn velocity_sum(&self) -> Result<Vector<D>> {
        self.gpu.run(&[], self.passes.velocities.as_deref());
        let [sums] = self.gpu.read::<f32, 1>([(&self.buffers.pairs.flow, 4 * self.counts.flow_chunks())])?;
        Ok(powers::vector_of(&sums) * (self.units.length / self.units.time))
    }

    /// Makes a force pass at the present state. Returns the acceleration (m/s²) and the rate of ρ/ρ₀ (1/s) of each water
    /// particle, in the order of `system`, and the largest values that limit a step.
    pub(crate) fn rates(&mut self, system: &System<D>) -> Result<(Vec<PairSums<D>>, StepLimits)> {
        let control = loop {
            self.begin(&StepRequest::NONE);
            self.gpu.run(&self.buffers.backups(), self.passes.rates.iter().map(AsRef::as_ref));
            let control = self.control()?;
            if !self.grow_lists(&control)? {
                break control;
            }
        };
        let (n, water) = (self.counts.n, self.counts.water);
        let [sums] = self.gpu.read::<f32, 1>([(&self.buffers.pairs.sums, (D + 1) * n)])?;
        let [slot] = self.gpu.read::<u32, 1>([(&self.buffers.slot, n)])?;
        let Units { length, time } = self.units;
        let of = |i: usize| {
            let sum = |row: usize| f64::from(sums[row * n + slot[i] as usize]);
            let acceleration = Vector::from_fn(|k, _| sum(k) * length / (time * time)) + system.gravity();
            PairSums { acceleration, compression_rate: sum(D) / time }
        };
        let limits = StepLimits {
            acceleration: f64::from(control.force()) * length / (time * time),
            approach_rate: f64::from(control.approach()) / time,
        };
        Ok(((0..water).map(of).collect(), limits))
    }

    /// The loads on the solids by the last force pass.
    pub(crate) fn loads(&mut self, system: &System<D>) -> Result<WaterLoads<D>> {
        self.gpu.run(&[], std::iter::once(self.passes.loads.as_ref()).chain(self.read_boundary()));
        let words = self.gpu.read(self.load_words())?;
        Ok(self.water_loads(&words, system))
    }

    /// Gives the state back to `system` and `stepper`.
    pub(crate) fn fetch(&mut self, system: &mut System<D>, stepper: &mut Stepper<D>) -> Result<()> {
        let (n, water) = (self.counts.n, self.counts.water);
        let [places, motion] =
            self.gpu.read::<u32, 2>([(&self.buffers.places, 8 * n), (&self.buffers.motion, 4 * n)])?;
        let mut slot = vec![0; n];
        places.chunks_exact(8).enumerate().for_each(|(k, place)| slot[place[3] as usize] = k);
        let layout = self.layout;
        let of = |i: usize| (&places[8 * slot[i]..][..8], &motion[4 * slot[i]..][..4]);
        let of_water = |i: usize| {
            let (place, motion) = of(i);
            (layout.position(place), layout.velocity(motion), layout.density(motion))
        };
        device_state::take_from_device(system, of_water, |i| layout.density(of(water + i).1));
        if let Some(first) = self.rows.stress {
            let slots = self.counts.slots();
            let [rows] = self.gpu.read::<f32, 1>([(&self.buffers.pairs.rows, self.rows.inputs * slots)])?;
            let scale = (self.units.length / self.units.time).powi(2);
            let entry = |i: usize, row: usize, column: usize| {
                let (a, b) = (row.max(column), row.min(column));
                f64::from(rows[(first + a * (a + 1) / 2 + b) * slots + slot[i]]) * scale
            };
            device_state::set_fluid_stress(system, |i| Matrix::from_fn(|row, column| entry(i, row, column)));
        }
        if let Stepper::Verlet(verlet) = stepper {
            let [before] = self.gpu.read::<u32, 1>([(&self.buffers.before, 4 * n)])?;
            let control = self.control()?;
            let of = |i: usize| &before[4 * slot[i]..][..4];
            if control.has_history() {
                let all = || (0..water).map(|i| (i, 0)).chain(device_state::originals(system));
                verlet.set_history(VerletHistory {
                    velocity: all().map(|(i, axes)| reflected(axes, layout.velocity(of(i)))).collect(),
                    density: all().map(|(i, _)| layout.density(of(i))).collect(),
                    boundary_density: (water..n).map(|i| layout.density(of(i))).collect(),
                    dt: f64::from(control.dt_before()) * self.units.time,
                    steps: control.since_euler(),
                    foldings: f64::from(control.foldings()),
                });
            }
        }
        Ok(())
    }
}
