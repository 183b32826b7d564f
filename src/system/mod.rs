//! The system of water and solids at one instant, and its rates on one page: neighbours, sweep, loads.
//! It does not know the time step.

mod change;
mod damping;
mod guard;
mod hem;
mod kept;
mod level;
mod meter;
pub mod periodic;
mod setup;
mod view;
mod walls;

pub use damping::Damping;
pub(crate) use guard::Seen;
pub use guard::{Escape, Limits, Lost};
use hem::hem;
pub(crate) use kept::SystemState;
use meter::Meter;
pub(crate) use meter::Powers;
use periodic::Images;
pub use periodic::Periodic;
pub use setup::Setup;

pub use crate::sweep::Peaks;

use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::{
    error::{Error, Result},
    law::{Extra, Medium, gradient, state::State, wall::Cover},
    model::{Dimension, Gradient, Model, Viscosity},
    near::{CHUNK, Near},
    particles::{PER_TASK, Particles},
    solid::{Dim, Links, Load, Solid, skin},
    space::{Bounds, Matrix, Pose, Vector},
    sweep::{Input, Output, Sums, Sweep},
};

/// Water and solids at one instant.
pub struct System<const D: usize> {
    model: Model,
    medium: Medium<D>,
    state: State,
    sweep: Box<dyn Sweep<D>>,
    /// Tells the laws apart, if somebody asks.
    meter: Option<Meter<D>>,
    pub(crate) near: Near<D>,
    pub(crate) fluid: Particles<D>,
    pub(crate) skin: Particles<D>,
    /// Places of the boundary particles in their solids' frames, m.
    local: Vec<Vector<D>>,
    /// To which densities (kg/m³) they settle, and with which part to more; empty unless they do.
    goals: Vec<(f64, f64)>,
    /// What tells how far water fills what they see of it.
    cover: Cover,
    /// Whether somebody asks how deep in the water they are.
    pub(crate) feels: bool,
    /// How much of the kernel's support of each wet one is full of water, Σ V_f W, –; empty unless somebody asks.
    pub(crate) immersed: Vec<f64>,
    /// How deep they lie below the face, m; empty unless they settle or water sticks to the face.
    depths: Vec<f64>,
    /// Outward normals in their solids' frames; empty unless water sticks to the face.
    normals: Vec<Vector<D>>,
    /// The velocities (m/s) that they show the water; empty if those are their own.
    shown: Vec<Vector<D>>,
    /// The box around each solid's skin in its own frame, m.
    boxes: Vec<Bounds<D>>,
    /// Where the solids were when the lists were made, if they were.
    built: Option<Vec<Pose<D>>>,
    pub(crate) solids: Vec<Solid<D>>,
    links: Links<D>,
    domain: Bounds<D>,
    limits: Limits,
    damping: Vec<Damping<D>>,
    /// Height of the highest water at the start, m, and number of water particles then.
    top: f64,
    count: usize,
    images: Images<D>,
    /// Stress of the water from the last pass, m²/s²; empty unless the viscosity has one.
    stress: Vec<Matrix<D>>,
    /// B − 1 of the water's corrected gradients from the last pass, –; empty unless they are.
    forms: Vec<Matrix<D>>,
    /// Beside which boundary particles water is not shifted; empty unless water is shifted.
    marks: Vec<bool>,
    pub(crate) sums: Vec<Sums<D>>,
    /// One for each wet boundary particle.
    pub(crate) skin_sums: Vec<Sums<D>>,
    extra: Vec<Extra<f64, D>>,
    peaks: Peaks,
    pub(crate) seen: Seen,
    passes: u64,
    /// Whether solids have come, and with them water may have gone.
    changed: bool,
    /// Which water was given which velocity (m/s) since the water was moved.
    pub(crate) gifts: Vec<(Vec<usize>, Vector<D>)>,
    /// Which water is to go when the lists are made; empty unless a solid takes its place.
    ousted: Vec<bool>,
    /// Time spent on lists and sorting so far.
    listing: Duration,
}

/// How arrays of particles must change when new lists are made.
pub(crate) struct Renewal<const D: usize> {
    /// New order of the water: `order[new] = old`.
    pub(crate) order: Vec<u32>,
    /// Boundary particles that have lost all their water.
    pub(crate) dried: Vec<u32>,
    /// Particles that were taken out.
    pub(crate) lost: Vec<Lost<D>>,
}

impl<const D: usize> System<D> {
    /// Puts water at the places `water` (m), still below the levels `levels` (height of the surface above
    /// each particle, m), and the solids with their skins.
    pub(crate) fn new(setup: Setup<D>) -> Result<Self>
    where
        Dim<D>: Dimension<D>,
    {
        let Setup { model, water, levels, velocity, pressure, solids: specs, links, domain, periodic, limits, damping } =
            setup;
        if let Some(what) = model.clash() {
            return Err(Error::scene(what));
        }
        let (medium, reach) = (model.medium::<D>(), model.reach());
        let state = State::new(medium.c0, medium.gamma);
        // Depth along g: the level is a height on the last axis.
        let depth = |(r, level): (&Vector<D>, &f64)| (level - r[D - 1]).max(0.0) * -medium.gravity[D - 1];
        let more = pressure.into_iter().chain(std::iter::repeat(0.0));
        let head = water.iter().zip(&levels).map(depth).zip(more).map(|(head, p)| head + p / medium.rho0);
        let rho = head.map(|head| medium.rho0 * (1.0 + state.still(head))).collect();
        drop(levels);
        let mut v = velocity;
        v.resize(water.len(), Vector::zeros());
        let id = (0..water.len() as u32).collect();
        let fluid = Particles { r: water, v, rho, id };
        let (top, count) = (fluid.r.iter().map(|r| r[D - 1]).fold(f64::NEG_INFINITY, f64::max), fluid.len());
        let cover = Cover::new(|r2| model.kernel_value(r2, D) * medium.volume0(), model.dp, reach, D);
        let zeros = |needed: bool| if needed { vec![Matrix::zeros(); fluid.len()] } else { Vec::new() };
        let mut system = Self {
            sweep: Dim::<D>::sweep(&model),
            meter: None,
            near: Near::new(reach, model.dp, model.sweep.level()),
            stress: zeros(matches!(model.viscosity, Viscosity::Sps(_))),
            forms: zeros(model.gradient == Gradient::Corrected),
            marks: Vec::new(),
            sums: vec![Sums::zero(); fluid.len()],
            skin_sums: Vec::new(),
            extra: Vec::new(),
            peaks: Peaks { acceleration: 0.0, closing: 0.0 },
            seen: Seen::NOTHING,
            passes: 0,
            listing: Duration::ZERO,
            built: None,
            model,
            medium,
            state,
            fluid,
            skin: Particles::default(),
            local: Vec::new(),
            goals: Vec::new(),
            cover,
            feels: false,
            immersed: Vec::new(),
            depths: Vec::new(),
            normals: Vec::new(),
            shown: Vec::new(),
            boxes: Vec::new(),
            solids: Vec::new(),
            links,
            domain: domain.unwrap_or_else(Bounds::empty),
            limits,
            damping,
            top,
            count,
            images: Images::new(periodic, reach),
            changed: false,
            gifts: Vec::new(),
            ousted: Vec::new(),
        };
        let hems: Vec<_> = (0..specs.len()).map(|i| hem(i, &specs, &system.model)).collect();
        for (spec, hem) in specs.into_iter().zip(&hems) {
            let kinematics = spec.start();
            system.join(spec, kinematics, hem)?;
        }
        system.mark();
        if domain.is_none() {
            let everything = Bounds::around(&system.fluid.r).union(&Bounds::around(&system.skin.r));
            system.domain = everything.grown(everything.size().max() + reach);
        }
        system.place_all();
        system.renew();
        system.look();
        system.still_skin(0..system.skin.len());
        system.rates();
        Ok(system)
    }

    /// Sorts the water along the columns and makes new neighbour lists, if they are due; returns what whoever keeps
    /// arrays of particles must follow.
    pub(crate) fn renew(&mut self) -> Option<Renewal<D>> {
        if !self.due() {
            return None;
        }
        let start = Instant::now();
        let (order, lost) = self.reorder();
        self.listing += start.elapsed();
        Some(Renewal { order, dried: self.lists(), lost })
    }

    /// Makes new lists within a step if they are due, the water left in its order.
    pub(crate) fn relist(&mut self) {
        if self.due() {
            self.lists();
        }
    }

    fn due(&self) -> bool {
        let moved = |(solid, (then, box_)): (&Solid<D>, (&Pose<D>, &Bounds<D>))| {
            // A rigid motion moves no point of a box further than its furthest corner.
            let now = &solid.kinematics.pose;
            box_.corners().map(|x| (now.point(&x) - then.point(&x)).norm()).fold(0.0, f64::max)
        };
        let Some(built) = &self.built else { return true };
        let skin = self.solids.iter().zip(built.iter().zip(&self.boxes)).map(moved).fold(0.0, f64::max);
        let moved = self.seen.moved2.sqrt() + skin;
        moved.is_nan() || moved >= self.near.margin()
    }

    /// Makes new lists; a boundary particle that has lost all its water forgets its pressure. Returns which have.
    fn lists(&mut self) -> Vec<u32> {
        let start = Instant::now();
        let before = self.near.wet().to_vec();
        self.near.build(&self.fluid.r, &self.skin.r);
        self.built = Some(self.solids.iter().map(|s| s.kinematics.pose).collect());
        self.seen.moved2 = 0.0;
        self.skin_sums.resize(self.near.wet().len(), Sums::zero());
        let mut wet = self.near.wet().iter().copied().peekable();
        let mut dried = before;
        dried.retain(|&i| {
            while wet.next_if(|&w| w < i).is_some() {}
            wet.peek() != Some(&i)
        });
        for &i in &dried {
            self.skin.rho[i as usize] = self.medium.rho0;
        }
        self.listing += start.elapsed();
        dried
    }

    /// Rates of the water and loads on the solids at the present places, velocities and densities; the lists
    /// must hold.
    pub(crate) fn rates(&mut self) {
        self.aim();
        if self.sweep.extra() {
            self.extra.resize(self.fluid.len(), Extra::all(0.0));
        }
        let Self { sweep, near, fluid, skin, shown, stress, forms, marks, medium, state, .. } = self;
        let shown = if shown.is_empty() { &skin.v } else { shown };
        let input = Input { near, water: fluid, skin, shown, stress, forms, marks, medium, state };
        let mut output = Output { water: &mut self.sums, skin: &mut self.skin_sums, extra: &mut self.extra };
        self.peaks = sweep.rates(&input, &mut output);
        self.reflect();
        if let Viscosity::Sps(sps) = self.model.viscosity {
            let (medium, rho, extra) = (&self.medium, &self.fluid.rho, &self.extra);
            self.stress.par_iter_mut().enumerate().with_min_len(PER_TASK).for_each(|(i, stress)| {
                let rows = sps.close(&extra[i].strain, medium.rho0 / rho[i], medium);
                *stress = Matrix::from_fn(|i, j| rows[i][j]);
            });
        }
        self.forms.par_iter_mut().zip(&self.extra).with_min_len(PER_TASK).for_each(|(form, extra)| {
            let rows = gradient::close(&extra.moment);
            *form = Matrix::from_fn(|i, j| rows[i][j]);
        });
        let loads = self.loads(&self.skin_sums);
        self.solids.iter_mut().zip(loads).for_each(|(solid, load)| solid.load = load);
        self.passes += 1;
    }

    /// The load on each solid by the `sums` of the wet boundary particles, added up in chunks of fixed size, in order.
    fn loads(&self, sums: &[Sums<D>]) -> Vec<Load<D>> {
        let (mass, wet) = (self.particle_mass(), self.near.wet());
        let place = |end: usize| wet.partition_point(|&i| (i as usize) < end);
        let of = |solid: &Solid<D>| {
            let centre = solid.kinematics.centre;
            let own = place(solid.skin.start)..place(solid.skin.end);
            let chunks = wet[own.clone()].par_chunks(CHUNK).zip(sums[own].par_chunks(CHUNK));
            let part = |(wet, sums): (&[u32], &[Sums<D>])| {
                // Beyond a periodic side the water is an image, and what it does has been counted.
                let own =
                    wet.iter().map(|&i| &self.skin.r[i as usize]).zip(sums).filter(|(r, _)| self.images.between(r));
                own.map(|(r, s)| Load::at(&(r - centre), s.dv * mass)).sum()
            };
            let parts: Vec<Load<D>> = chunks.map(part).collect();
            parts.into_iter().sum()
        };
        self.solids.iter().map(of).collect()
    }

    /// The largest values that limit the next step.
    pub fn peaks(&self) -> Peaks {
        self.peaks
    }

    /// By how much (m) shifting moves each water particle in a step `dt` (s); `None` if nothing shifts.
    pub(crate) fn shifts(&self, dt: f64) -> Option<Vec<Vector<D>>> {
        let shift = self.model.shift()?;
        let shifts = self.extra.par_iter().zip(&self.fluid.v).with_min_len(PER_TASK).map(|(extra, v)| {
            if extra.held > 0.0 { Vector::zeros() } else { shift.close(extra, v.norm(), dt, &self.medium) }
        });
        Some(shifts.collect())
    }

    /// Gives the water nearest to `solid` the `impulse` (N s), in equal shares; says what energy (J) that gave.
    pub(crate) fn give_back(&mut self, solid: usize, impulse: &Vector<D>) -> f64 {
        if impulse.norm_squared() == 0.0 {
            return 0.0;
        }
        let real = self.real();
        let skin = Bounds::around(&self.skin.r[self.solids[solid].skin.clone()]);
        let mut reach = self.model.reach();
        loop {
            let near = skin.grown(reach);
            let mut these = self.near.water_within(&near);
            these.retain(|&i| i < real && near.contains(&self.fluid.r[i]));
            if !these.is_empty() {
                let share = impulse / (these.len() as f64 * self.particle_mass());
                let gained: f64 = these.iter().map(|&i| share.dot(&(self.fluid.v[i] + share * 0.5))).sum();
                these.iter().for_each(|&i| self.fluid.v[i] += share);
                self.gifts.push((these, share));
                return gained * self.particle_mass();
            }
            reach *= 2.0;
            if !reach.is_finite() {
                return 0.0;
            }
        }
    }

    /// Places the skins of all solids.
    fn place_all(&mut self) {
        for i in 0..self.solids.len() {
            self.place(i);
        }
    }

    /// Puts the boundary particles of solid `i` where its kinematics say.
    pub(crate) fn place(&mut self, i: usize) {
        let Solid { kinematics, skin: range, .. } = &self.solids[i];
        let range = range.clone();
        skin::place(kinematics, &self.local[range.clone()], &mut self.skin.r[range.clone()], &mut self.skin.v[range]);
    }
}

/// Puts `array` into `order`: the new i-th is the old `order[i]`-th. An empty array stays empty.
pub(crate) fn permute<T: Copy + Send + Sync>(array: &mut Vec<T>, order: &[u32]) {
    if !array.is_empty() {
        *array = order.par_iter().with_min_len(PER_TASK).map(|&i| array[i as usize]).collect();
    }
}
