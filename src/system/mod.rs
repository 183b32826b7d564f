//! The system of water and solids at one instant, and its rates on one page: neighbours, sweep, loads.
//! It does not know the time step.

mod guard;
mod kept;
mod view;

pub(crate) use kept::SystemState;

use rayon::prelude::*;

use crate::{
    error::{Error, Result},
    law::{Extra, Medium, state::State, wall::Dbc},
    model::{Model, Shifting, Viscosity},
    near::{CHUNK, Near},
    particles::{PER_TASK, Particles},
    solid::{Load, Role, Solid, SolidSpec, skin},
    space::{Bounds, Matrix, Vector, Wedge},
    sweep::{self, Input, Node, Sums, Sweep},
};

/// Water and solids at one instant.
pub struct System<const D: usize> {
    model: Model,
    medium: Medium<D>,
    state: State,
    sweep: Box<dyn Sweep<D>>,
    near: Near<D>,
    pub(crate) fluid: Particles<D>,
    pub(crate) skin: Particles<D>,
    /// Places of the boundary particles in their solids' frames, m.
    local: Vec<Vector<D>>,
    pub(crate) solids: Vec<Solid<D>>,
    domain: Bounds<D>,
    /// Stress of the water from the last pass, m²/s²; empty unless the viscosity has one.
    stress: Vec<Matrix<D>>,
    nodes: (Vec<Node<D>>, Vec<Node<D>>),
    pub(crate) sums: Vec<Sums<D>>,
    pub(crate) skin_sums: Vec<Sums<D>>,
    extra: Vec<Extra<f64, D>>,
    passes: u64,
}

/// The largest values that limit a time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// Largest acceleration of a water particle, m/s².
    pub acceleration: f64,
    /// Largest |v_ab·r_ab|/(r² + η²), 1/s.
    pub closing: f64,
}

impl<const D: usize> System<D> {
    /// Puts water at the places `water` (m), still below the levels `levels` (height of the surface above
    /// each particle, m), and the solids with their skins.
    pub(crate) fn new(
        model: Model,
        water: &[Vector<D>],
        levels: &[f64],
        specs: Vec<SolidSpec<D>>,
        domain: Option<Bounds<D>>,
    ) -> Result<Self> {
        let medium = model.medium::<D>();
        let state = State::new(medium.c0, medium.gamma);
        let mut fluid = Particles::default();
        for (r, level) in water.iter().zip(levels) {
            // Depth along g: the level is a height on the last axis.
            let depth = (level - r[D - 1]).max(0.0) * -medium.gravity[D - 1];
            fluid.push(*r, medium.rho0 * (1.0 + state.excess(depth.max(0.0))));
        }
        let (mut skin, mut local, mut solids) = (Particles::default(), Vec::new(), Vec::new());
        for spec in specs {
            let kinematics = spec.start();
            let first = skin.len();
            for point in spec.shape.skin(model.dp, model.layers()) {
                skin.push(kinematics.pose.point(&point.r), medium.rho0);
                local.push(point.r);
            }
            if skin.len() == first {
                return Err(Error::scene(format!("solid {:?} is too small for a single boundary particle", spec.name))
                    .help("make it larger or dp smaller"));
            }
            let load = Load { force: Vector::zeros(), torque: Wedge::zero() };
            solids.push(Solid { spec, kinematics, skin: first..skin.len(), load });
        }
        let everything = Bounds::around(&fluid.r).union(&Bounds::around(&skin.r));
        let domain = domain.unwrap_or_else(|| everything.grown(everything.size().max() + model.reach()));
        let mut system = Self {
            sweep: model.sweep(),
            near: Near::new(model.reach()),
            stress: if matches!(model.viscosity, Viscosity::Sps(_)) {
                vec![Matrix::zeros(); fluid.len()]
            } else {
                Vec::new()
            },
            nodes: (Vec::new(), Vec::new()),
            sums: vec![Sums::zero(); fluid.len()],
            skin_sums: vec![Sums::zero(); skin.len()],
            extra: Vec::new(),
            passes: 0,
            model,
            medium,
            state,
            fluid,
            skin,
            local,
            solids,
            domain,
        };
        system.place_all();
        system.renew();
        system.still_skin();
        system.rates();
        Ok(system)
    }

    /// Gives each boundary particle beside water the density of still water at its depth.
    fn still_skin(&mut self) {
        let up = D - 1;
        let g = -self.medium.gravity[up];
        let mut still = self.skin.rho.clone();
        for (i, x) in self.skin.r.iter().enumerate() {
            let mut nearest = (f64::INFINITY, 0.0);
            self.near.water_around(x, &mut |j| {
                let d = (self.fluid.r[j] - x).norm_squared();
                if d < nearest.0 {
                    let head = self.state.pressure(self.fluid.rho[j] / self.medium.rho0 - 1.0);
                    nearest = (d, head + g * (self.fluid.r[j][up] - x[up]));
                }
            });
            still[i] = self.medium.rho0 * (1.0 + self.state.excess(nearest.1.max(0.0)));
        }
        self.skin.rho = still;
    }

    /// Sorts the water along the cells and makes new neighbour lists, if they are due; returns the order
    /// (`order[new] = old`) by which whoever keeps arrays of the water must follow.
    pub(crate) fn renew(&mut self) -> Option<Vec<u32>> {
        if !self.near.due(&self.fluid.r, &self.skin.r) {
            return None;
        }
        let order = self.near.order(&self.fluid.r);
        permute(&mut self.fluid.r, &order);
        permute(&mut self.fluid.v, &order);
        permute(&mut self.fluid.rho, &order);
        permute(&mut self.fluid.id, &order);
        permute(&mut self.stress, &order);
        self.lists();
        Some(order)
    }

    fn lists(&mut self) {
        self.near.build(&self.fluid.r, &self.skin.r);
        self.dry();
    }

    /// A boundary particle that has lost all its water forgets its pressure.
    fn dry(&mut self) {
        let spans = self.near.lists().skin.iter().flat_map(|chunk| &chunk.spans);
        for (rho, span) in self.skin.rho.iter_mut().zip(spans) {
            if span.start == span.end {
                *rho = self.medium.rho0;
            }
        }
    }

    /// Makes new lists within a step if they are due, the water left in its order.
    pub(crate) fn relist(&mut self) {
        if self.near.due(&self.fluid.r, &self.skin.r) {
            self.lists();
        }
    }

    /// Rates of the water and loads on the solids at the present places, velocities and densities; the lists
    /// must hold.
    pub(crate) fn rates(&mut self) {
        self.nodes.0 = self.pack(&self.fluid);
        self.nodes.1 = self.pack(&self.skin);
        let input = Input { lists: self.near.lists(), water: &self.nodes.0, skin: &self.nodes.1, stress: &self.stress };
        if self.sweep.extra() {
            self.extra.resize(self.fluid.len(), Extra::zero());
        }
        sweep::all(self.sweep.as_ref(), &input, &mut self.sums, &mut self.skin_sums, &mut self.extra);
        if let Viscosity::Sps(sps) = self.model.viscosity {
            let (medium, nodes, extra) = (&self.medium, &self.nodes.0, &self.extra);
            self.stress.par_iter_mut().enumerate().for_each(|(i, stress)| {
                let rows = sps.close(&extra[i].strain, nodes[i].s, medium);
                *stress = Matrix::from_fn(|i, j| rows[i][j]);
            });
        }
        let gravity = self.medium.gravity;
        self.sums.par_iter_mut().with_min_len(PER_TASK).for_each(|s| s.dv += gravity);
        self.load();
        self.passes += 1;
    }

    fn pack(&self, particles: &Particles<D>) -> Vec<Node<D>> {
        let inv_rho0 = 1.0 / self.medium.rho0;
        (0..particles.len())
            .into_par_iter()
            .with_min_len(PER_TASK)
            .map(|i| {
                let x = (particles.rho[i] - self.medium.rho0) * inv_rho0;
                Node {
                    r: particles.r[i].into(),
                    v: particles.v[i].into(),
                    x,
                    p: self.state.pressure(x),
                    s: 1.0 / (1.0 + x),
                }
            })
            .collect()
    }

    /// Adds up each solid's boundary particles in chunks of fixed size, in order.
    fn load(&mut self) {
        let mass = self.particle_mass();
        for solid in &mut self.solids {
            let centre = solid.kinematics.centre;
            let (r, sums) = (&self.skin.r[solid.skin.clone()], &self.skin_sums[solid.skin.clone()]);
            let parts: Vec<Load<D>> = r
                .par_chunks(CHUNK)
                .zip(sums.par_chunks(CHUNK))
                .map(|(r, sums)| {
                    let none = Load { force: Vector::zeros(), torque: Wedge::zero() };
                    r.iter().zip(sums).fold(none, |load, (r, s)| {
                        let force = s.dv * mass;
                        Load { force: load.force + force, torque: load.torque + Wedge::torque(&(r - centre), &force) }
                    })
                })
                .collect();
            solid.load = parts
                .into_iter()
                .reduce(|a, b| Load { force: a.force + b.force, torque: a.torque + b.torque })
                .unwrap_or(solid.load);
        }
    }

    /// The largest values that limit the next step.
    pub fn peaks(&self) -> Peaks {
        let (a2, closing) = self
            .sums
            .par_iter()
            .with_min_len(PER_TASK)
            .map(|s| (s.dv.norm_squared(), s.closing))
            .reduce(|| (0.0, 0.0), |a, b| (f64::max(a.0, b.0), f64::max(a.1, b.1)));
        Peaks { acceleration: a2.sqrt(), closing }
    }

    /// By how much (m) shifting moves each water particle in a step `dt` (s); `None` if nothing shifts.
    pub(crate) fn shifts(&self, dt: f64) -> Option<Vec<Vector<D>>> {
        let shift = self.model.shift()?;
        let held = self.held();
        let reach2 = self.model.reach().powi(2);
        let shifts = (0..self.fluid.len()).into_par_iter().map(|i| {
            let (_, skin) = self.near.lists().water[i / CHUNK].of(i % CHUNK);
            let r = &self.fluid.r[i];
            let sees = |&j: &u32| held[j as usize] && (self.skin.r[j as usize] - r).norm_squared() < reach2;
            if skin.iter().any(sees) {
                return Vector::zeros();
            }
            shift.close(&self.extra[i], self.fluid.v[i].norm(), dt, &self.medium)
        });
        Some(shifts.collect())
    }

    /// Beside which boundary particles the water is not shifted.
    fn held(&self) -> Vec<bool> {
        let mut held = vec![false; self.skin.len()];
        for solid in &self.solids {
            let hold = match self.model.shifting {
                Shifting::AwayFromSolids(_) => true,
                Shifting::AwayFromFixed(_) => matches!(solid.spec.role, Role::Fixed),
                Shifting::None | Shifting::Everywhere(_) => false,
            };
            held[solid.skin.clone()].fill(hold);
        }
        held
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

    /// Lets the density of the boundary particles follow `rho`, never below what the wall law allows.
    pub(crate) fn set_skin_density(&mut self, rho: impl Fn(usize) -> f64 + Sync) {
        let rho0 = self.medium.rho0;
        self.skin
            .rho
            .par_iter_mut()
            .enumerate()
            .with_min_len(PER_TASK)
            .for_each(|(i, out)| *out = Dbc.close(rho(i), rho0));
    }
}

/// Puts `array` into `order`: the new i-th is the old `order[i]`-th. An empty array stays empty.
pub(crate) fn permute<T: Copy + Send + Sync>(array: &mut Vec<T>, order: &[u32]) {
    if !array.is_empty() {
        *array = order.par_iter().with_min_len(PER_TASK).map(|&i| array[i as usize]).collect();
    }
}
