//! The system of water and solids at one instant, and its rates on one page: neighbours, sweep, loads.
//! It does not know the time step.

mod damping;
mod guard;
mod kept;
pub mod periodic;
mod setup;
mod view;
mod walls;

pub use damping::Damping;
pub(crate) use guard::Seen;
pub use guard::{Escape, Limits, Lost};
pub(crate) use kept::SystemState;
use periodic::Images;
pub use periodic::Periodic;
pub use setup::Setup;

pub use crate::sweep::Peaks;

use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::{
    error::{Error, Result},
    law::{
        Extra, Medium,
        state::State,
        wall::{Cover, Slip},
    },
    model::{Dimension, Model, Viscosity, Walls},
    near::{CHUNK, Near},
    particles::{PER_TASK, Particles},
    solid::{Dim, Links, Load, Solid, skin},
    space::{Bounds, Matrix, Pose, Vector, Wedge},
    sweep::{Input, Output, Sums, Sweep},
};

/// Water and solids at one instant.
pub struct System<const D: usize> {
    model: Model,
    medium: Medium<D>,
    state: State,
    sweep: Box<dyn Sweep<D>>,
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
    /// Beside which boundary particles water is not shifted; empty unless water is shifted.
    marks: Vec<bool>,
    pub(crate) sums: Vec<Sums<D>>,
    /// One for each wet boundary particle.
    pub(crate) skin_sums: Vec<Sums<D>>,
    extra: Vec<Extra<f64, D>>,
    peaks: Peaks,
    pub(crate) seen: Seen,
    passes: u64,
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
        let (mut skin, mut local, mut solids) = (Particles::default(), Vec::new(), Vec::new());
        let (mut depths, mut normals) = (Vec::new(), Vec::new());
        for spec in specs {
            let kinematics = spec.start();
            let first = skin.len();
            for point in spec.shape.skin(model.dp, model.layers()) {
                skin.push(kinematics.pose.point(&point.r), medium.rho0);
                local.push(point.r);
            }
            if model.slip == Slip::None || model.walls == Walls::Settling {
                depths.par_extend(local[first..].par_iter().map(|r| -spec.shape.signed_distance(r)));
            }
            if model.slip == Slip::None {
                normals.par_extend(local[first..].par_iter().map(|r| spec.shape.outward(r, 0.05 * model.dp)));
            }
            if skin.len() == first {
                return Err(Error::scene(format!("solid {:?} is too small for a single boundary particle", spec.name))
                    .help("make it larger or dp smaller"));
            }
            let load = Load { force: Vector::zeros(), torque: Wedge::zero() };
            let (acceleration, whirl) = (Vector::zeros(), Wedge::zero());
            solids.push(Solid { spec, kinematics, acceleration, whirl, skin: first..skin.len(), load });
        }
        let everything = Bounds::around(&fluid.r).union(&Bounds::around(&skin.r));
        let domain = domain.unwrap_or_else(|| everything.grown(everything.size().max() + reach));
        let boxes = solids.iter().map(|s: &Solid<D>| Bounds::around(&local[s.skin.clone()])).collect();
        let cover = Cover::new(|r2| model.kernel_value(r2, D) * medium.volume0(), model.dp, reach, D);
        let mut system = Self {
            sweep: Dim::<D>::sweep(&model),
            near: Near::new(reach, model.dp, model.sweep.level()),
            stress: if matches!(model.viscosity, Viscosity::Sps(_)) {
                vec![Matrix::zeros(); fluid.len()]
            } else {
                Vec::new()
            },
            marks: walls::marks(&model, &solids, skin.len()),
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
            skin,
            local,
            goals: Vec::new(),
            cover,
            feels: false,
            immersed: Vec::new(),
            depths,
            normals,
            shown: Vec::new(),
            boxes,
            solids,
            links,
            domain,
            limits,
            damping,
            top,
            count,
            images: Images::new(periodic, reach),
        };
        system.place_all();
        system.renew();
        system.look();
        system.still_skin();
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
        let Self { sweep, near, fluid, skin, shown, stress, marks, medium, state, .. } = self;
        let shown = if shown.is_empty() { &skin.v } else { shown };
        let input = Input { near, water: fluid, skin, shown, stress, marks, medium, state };
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
        self.load();
        self.passes += 1;
    }

    /// Adds up each solid's wet boundary particles in chunks of fixed size, in order.
    fn load(&mut self) {
        let mass = self.particle_mass();
        let wet = self.near.wet();
        for solid in &mut self.solids {
            let centre = solid.kinematics.centre;
            let place = |end: usize| wet.partition_point(|&i| (i as usize) < end);
            let own = place(solid.skin.start)..place(solid.skin.end);
            let none = Load { force: Vector::zeros(), torque: Wedge::zero() };
            let parts: Vec<Load<D>> = wet[own.clone()]
                .par_chunks(CHUNK)
                .zip(self.skin_sums[own].par_chunks(CHUNK))
                .map(|(wet, sums)| {
                    // Beyond a periodic side the water is an image, and what it does has been counted.
                    let own = |(i, _): &(&u32, _)| self.images.between(&self.skin.r[**i as usize]);
                    wet.iter().zip(sums).filter(own).fold(none, |load, (&i, s)| {
                        let force = s.dv * mass;
                        let torque = Wedge::torque(&(self.skin.r[i as usize] - centre), &force);
                        Load { force: load.force + force, torque: load.torque + torque }
                    })
                })
                .collect();
            solid.load =
                parts.into_iter().fold(none, |a, b| Load { force: a.force + b.force, torque: a.torque + b.torque });
        }
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

    /// Gives the water nearest to `solid` the `impulse` (N s), in equal shares.
    pub(crate) fn give_back(&mut self, solid: usize, impulse: &Vector<D>) {
        if impulse.norm_squared() == 0.0 {
            return;
        }
        let real = self.real();
        let skin = Bounds::around(&self.skin.r[self.solids[solid].skin.clone()]);
        let mut reach = self.model.reach();
        loop {
            let near = skin.grown(reach);
            let these: Vec<usize> = (0..real).filter(|&i| near.contains(&self.fluid.r[i])).collect();
            if !these.is_empty() {
                let share = impulse / (these.len() as f64 * self.particle_mass());
                these.into_iter().for_each(|i| self.fluid.v[i] += share);
                return;
            }
            reach *= 2.0;
            if !reach.is_finite() {
                return;
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
