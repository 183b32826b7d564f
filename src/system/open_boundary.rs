//! Open boundaries: vertical faces through which water enters and leaves, with buffer particles @tafuni2018.
//!
//! Beyond a face lies a buffer, some supports of the kernel long. Its particles stand in the arrays after the water and before
//! the images. They take part in all pair sums, but their velocity and density are prescribed, and their own sums do not move
//! them. When the lists are rebuilt, a buffer particle that has crossed the face becomes water, and a new one takes its place
//! at the far end, one length of the buffer behind it. Water that has crossed the face becomes a buffer particle, and leaves at the
//! far end.
//!
//! Let x be the compression of the water beside the face less that at rest below the level of the face, a kernel average at the
//! height of the buffer particle. The outward velocity u of the buffer particle and its compression x_b are
//!
//!   u = U,               x_b = x_rest + x     where the velocity U is prescribed,
//!   u = U + c₀² x/c,     x_b = x_rest + x     where the face absorbs waves of speed c,
//!   u = that of the water, x_b = x_rest       where the level alone is prescribed,
//!   u = mean of that of the water + c₀² x/c, x_b = x_rest    where the level alone is prescribed, and moves,
//!   u = that of the water, x_b = x_rest + x   where neither is prescribed.
//!
//! The second line is the relation of velocity and pressure in a linear wave that moves out, at every depth @dean1991; for long
//! waves it is that of @flather1976. Waves that enter add their velocity to U and their pressure to x_rest.
//!
//! At a face whose level or velocity changes in time, the buffer holds water that has left when the flow turns inwards. This
//! water stands at its former level, and no longer has one particle to each dpᴰ where rows moved apart or together. Such a face
//! keeps rows: see [`rows`].

mod buffer;
mod check;
mod rows;
mod water_beside;

pub use buffer::FaceExchange;
pub(super) use buffer::{Buffer, BufferTag, exchange_at_faces, name_created, needs_exchange, start_buffers};
pub(crate) use buffer::{MOST_FACES, set_buffer_time};
pub(crate) use check::check;

use rayon::prelude::*;

use super::{Fluid, FluidDomain, System, periodic::WIDTH, reflected};
use crate::{
    geometry::world_bounds,
    math::{Bounds, Pose, Vector, expression::UnsteadyField},
    model::Model,
    particles::Particles,
    solid::{Role, TimeFunction},
    wavemaker::{IncidentWaves, Orbit},
};

/// Distance from the face at which the water is observed, over h: there most of the kernel lies in the water.
const OBSERVATION: f64 = 1.0;

/// Least sum of V W with which water counts as beside the face; in water it is 1.
const BESIDE: f64 = 0.05;

/// Time in which the velocity of an absorbing face follows the water, over h/c: a wave of speed c moves by that part of h.
const RESPONSE: f64 = 0.5;

/// A vertical face that bounds the water, and the flow through it.
///
/// ```
/// use pontoon::{math::expression::UnsteadyField, prelude::*, simulation::OpenBoundary};
///
/// let profile = UnsteadyField::parse("0.3*y")?;
/// let face = OpenBoundary::<2>::inflow("inlet", 0, 1.5, profile).level(0.4);
/// assert_eq!(face.name, "inlet");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct OpenBoundary<const D: usize> {
    /// Its name in messages and books.
    pub name: String,
    /// Number of the axis normal to the face; not the last, which is vertical.
    pub axis: usize,
    /// Coordinate of the face along that axis, m.
    pub at: f64,
    /// Whether the water lies at greater coordinates.
    pub is_lower: bool,
    /// Whether the prescribed velocity is that of water that enters.
    pub is_inflow: bool,
    /// Velocity normal to the face (m/s), positive in the sense of the flow. `None`: the velocity of the water beside the face.
    pub velocity: Option<UnsteadyField<D>>,
    /// Factor on the velocity as a function of time, –.
    pub factor: Option<TimeFunction>,
    /// Height of the surface at rest (m) as a function of time. `None`: the pressure is that of the water beside the face.
    pub level: Option<TimeFunction>,
    /// Speed of waves that leave through the face (m/s). `None`: a velocity is kept exactly, and the water follows a moving level
    /// late.
    pub absorbed_speed: Option<f64>,
    /// Waves that enter through the face, along its normal and on its current.
    pub waves: Option<IncidentWaves>,
}

impl<const D: usize> OpenBoundary<D> {
    fn new(name: &str, axis: usize, at: f64, is_inflow: bool, velocity: Option<UnsteadyField<D>>) -> Self {
        let name = name.into();
        Self {
            name,
            axis,
            at,
            is_lower: is_inflow,
            is_inflow,
            velocity,
            factor: None,
            level: None,
            absorbed_speed: None,
            waves: None,
        }
    }

    /// A face normal to axis number `axis` at the coordinate `at` (m), through which water enters in the sense of the axis with this
    /// `velocity` (m/s).
    pub fn inflow(name: &str, axis: usize, at: f64, velocity: UnsteadyField<D>) -> Self {
        Self::new(name, axis, at, true, Some(velocity))
    }

    /// A face normal to axis number `axis` at the coordinate `at` (m), through which water leaves in the sense of the axis.
    pub fn outflow(name: &str, axis: usize, at: f64, velocity: Option<UnsteadyField<D>>) -> Self {
        Self::new(name, axis, at, false, velocity)
    }

    /// The same face with the water on the other side: the flow is against the axis.
    pub fn reversed(self) -> Self {
        Self { is_lower: !self.is_lower, ..self }
    }

    /// The same face with a surface at rest at the height `level` (m).
    pub fn level(self, level: impl Into<TimeFunction>) -> Self {
        Self { level: Some(level.into()), ..self }
    }

    /// The same face, which absorbs waves of this `speed` (m/s).
    pub fn absorbing(self, speed: f64) -> Self {
        Self { absorbed_speed: Some(speed), ..self }
    }

    /// The same face, through which these waves enter; their current is its velocity into the water.
    pub fn waves(self, waves: IncidentWaves) -> Self {
        Self { waves: Some(waves), ..self }
    }

    /// The same face with this factor (–) on its velocity.
    pub fn factor(self, factor: impl Into<TimeFunction>) -> Self {
        Self { factor: Some(factor.into()), ..self }
    }

    /// Distance (m) of `x` (m) beyond the face, positive outside the water.
    pub(crate) fn beyond(&self, x: &Vector<D>) -> f64 {
        if self.is_lower { self.at - x[self.axis] } else { x[self.axis] - self.at }
    }

    /// The sense of the axis out of the water, –.
    pub(crate) fn outward(&self) -> f64 {
        if self.is_lower { -1.0 } else { 1.0 }
    }

    /// The height (m) of the surface at rest at time `t` (s), if the face has one.
    pub(crate) fn level_at(&self, t: f64) -> Option<f64> {
        self.level.as_ref().map(|level| level.value_and_rate(t).0)
    }

    /// Whether the level changes in time.
    pub(crate) fn has_moving_level(&self) -> bool {
        self.level.as_ref().is_some_and(|level| level.steady_value().is_none())
    }

    /// Whether the buffer is kept in rows: the level or the velocity changes in time.
    fn keeps_rows(&self) -> bool {
        let changes = |velocity: &UnsteadyField<D>| {
            velocity.changes_in_time() || self.factor.as_ref().is_some_and(|factor| factor.steady_value().is_none())
        };
        self.waves.is_none() && (self.has_moving_level() || self.velocity.as_ref().is_some_and(changes))
    }

    /// The orbit in the waves that enter, at time `t` (s), of the particle at `x` (m), with its velocity as a vector (m/s).
    fn orbit(&self, x: &Vector<D>, t: f64) -> Option<(Orbit, Vector<D>)> {
        let (orbit, _) = self.waves.as_ref()?.orbit(-self.beyond(x), x[D - 1] - self.level_at(t).unwrap_or(0.0), t);
        Some((orbit, self.along_waves(orbit.velocity)))
    }

    /// The vector with the part `along` into the water and the part `up`.
    fn along_waves(&self, [along, up]: [f64; 2]) -> Vector<D> {
        let mut vector = Vector::zeros();
        (vector[self.axis], vector[D - 1]) = (-self.outward() * along, up);
        vector
    }

    /// Whether the particle at `x` (m) is beyond the far end of the buffer of this `length` (m) at time `t` (s). In waves its
    /// position at rest decides. A particle that crosses the face, and its successor, may rest further out by the excursion.
    fn is_beyond_buffer(&self, x: &Vector<D>, length: f64, t: f64) -> bool {
        let moved = self.orbit(x, t).map_or(0.0, |(orbit, _)| orbit.displacement[0]);
        self.beyond(x) + moved > length + self.excursion()
    }

    /// The greatest displacement (m) normal to the face by waves that enter.
    fn excursion(&self) -> f64 {
        self.waves.as_ref().map_or(0.0, IncidentWaves::excursion)
    }

    /// The displacement (m) at time `t` (s) from a particle at `x` (m) to the particle that without waves rests `length` (m)
    /// further out, and the difference of their velocities (m/s).
    fn way_out(&self, x: &Vector<D>, length: f64, t: f64) -> (Vector<D>, Vector<D>) {
        let (mut way, mut velocity_change) = (Vector::zeros(), Vector::zeros());
        way[self.axis] = self.outward() * length;
        if let Some(waves) = &self.waves {
            let along = -self.beyond(x);
            let (here, height) = waves.orbit(along, x[D - 1] - self.level_at(t).unwrap_or(0.0), t);
            let there = waves.orbit_of([along - here.displacement[0] - length, height], t);
            way += self.along_waves([0, 1].map(|k| there.displacement[k] - here.displacement[k]));
            velocity_change = self.along_waves([0, 1].map(|k| there.velocity[k] - here.velocity[k]));
        }
        (way, velocity_change)
    }

    /// Whether a solid of this `role` with these `bounds` (m) has an end in a buffer of this `length` (m); `dp` (m) is the
    /// particle spacing. For a free solid, an end beyond the buffer counts too.
    fn has_end_in_buffer(&self, role: &Role<D>, bounds: &Bounds<D>, length: f64, dp: f64) -> bool {
        let ends = [&bounds.min, &bounds.max].map(|x| self.beyond(x));
        let is_free = matches!(role, Role::Free(_));
        ends.iter().any(|beyond| *beyond > 1e-6 * dp && (is_free || *beyond < length * (1.0 - 1e-9)))
    }

    /// The prescribed velocity (m/s) into the water, if it is the same everywhere at all times.
    pub(crate) fn steady_current(&self) -> Option<f64> {
        let steady = self.factor.is_none() && self.velocity.as_ref().is_some_and(UnsteadyField::is_constant);
        self.outward_velocity(&Vector::zeros(), 0.0).filter(|_| steady).map(|speed| -speed)
    }

    /// The prescribed velocity (m/s) out of the water at `x` (m) and time `t` (s).
    pub(crate) fn outward_velocity(&self, x: &Vector<D>, t: f64) -> Option<f64> {
        let sense = if self.is_inflow { -1.0 } else { 1.0 };
        let factor = self.factor.as_ref().map_or(1.0, |factor| factor.value_and_rate(t).0);
        self.velocity.as_ref().map(|velocity| sense * factor * velocity.value_at(x, t))
    }
}

/// Length (m) of the buffers of a model: a whole number of dp, as far as images reach beyond a periodic side.
pub(crate) fn buffer_length(model: &Model) -> f64 {
    (WIDTH * model.support_radius() / model.dp - 1e-9).ceil() * model.dp
}

/// Lets particles be as far outside the domain as the buffers reach.
pub(super) fn extend_domain_by_buffers<const D: usize>(system: &mut System<D>) {
    let length = buffer_length(&system.model) + system.model.support_radius();
    let FluidDomain { domain, open_boundaries, .. } = &mut system.fluid_domain;
    for face in open_boundaries.iter() {
        // In waves the far end moves to and fro.
        let end = face.at + face.outward() * (length + 2.0 * face.excursion());
        (domain.min[face.axis], domain.max[face.axis]) =
            (domain.min[face.axis].min(end), domain.max[face.axis].max(end));
    }
}

/// Sets velocities and densities of the buffer particles at time `t` (s), `dt` (s) after they were set before.
pub(crate) fn update_buffer<const D: usize>(system: &mut System<D>, t: f64, dt: f64) {
    let (water, own) = (system.particle_count(), system.own_count());
    if water == own {
        return;
    }
    let states = (water..own).into_par_iter().map(|i| buffer_state(system, i, t, dt));
    let mut states: Vec<(Vector<D>, f64)> = states.collect();
    move_as_one(system, &mut states, dt);
    let Fluid { particles: Particles { v, rho, .. }, images, .. } = &mut system.fluid;
    for (i, (velocity, density)) in (water..own).zip(states) {
        (v[i], rho[i]) = (velocity, density);
    }
    for (k, &original) in images.originals.iter().enumerate().filter(|(_, i)| **i as usize >= water) {
        let original = original as usize;
        let axes = images.reflections.get(k).copied().unwrap_or(0);
        (v[own + k], rho[own + k]) = (reflected(axes, v[original]), rho[original]);
    }
}

/// In a buffer with a moving level and without a prescribed velocity, gives all `states` (velocity, m/s; density, kg/m³) one
/// velocity normal to the face: their mean, which they follow within the step `dt` (s) as at an absorbing face. Rows with
/// velocities of their own would part and cross.
fn move_as_one<const D: usize>(system: &System<D>, states: &mut [(Vector<D>, f64)], dt: f64) {
    let (tags, before) = (&system.fluid.buffer.tags, &system.fluid.particles.v[system.particle_count()..]);
    for (number, face) in system.fluid_domain.open_boundaries.iter().enumerate() {
        if face.velocity.is_some() || !face.has_moving_level() {
            continue;
        }
        let [mut target, mut now, mut count] = [0.0; 3];
        for (k, (v, _)) in states.iter().enumerate().filter(|(k, _)| tags[*k].face() == number) {
            (target, now, count) = (target + v[face.axis], now + before[k][face.axis], count + 1.0);
        }
        let part = face.absorbed_speed.map_or(1.0, |speed| response(system, speed, dt));
        let mut mean = Vector::zeros();
        mean[face.axis] = (now + (target - now) * part) / f64::max(count, 1.0);
        for (_, (v, _)) in states.iter_mut().enumerate().filter(|(k, _)| tags[*k].face() == number) {
            *v = mean;
        }
    }
}

/// The fraction of the difference to its target velocity that a face covers in the step `dt` (s), if waves of this `speed` (m/s)
/// leave through it.
fn response<const D: usize>(system: &System<D>, speed: f64, dt: f64) -> f64 {
    if dt > 0.0 { (dt * speed / (RESPONSE * system.model.h)).min(1.0) } else { 1.0 }
}

/// Velocity (m/s) and density (kg/m³) of buffer particle `i`: see the head of this file.
fn buffer_state<const D: usize>(system: &System<D>, i: usize, t: f64, dt: f64) -> (Vector<D>, f64) {
    let (particles, rho0) = (&system.fluid.particles, system.properties.rho0);
    let face = &system.fluid_domain.open_boundaries[system.fluid.buffer.tags[i - system.particle_count()].face()];
    let (r, before) = (&particles.r[i], &particles.v[i]);
    let level = face.level_at(t).unwrap_or(0.0);
    let at_rest = |x: &Vector<D>| {
        let head = (level - x[D - 1]) * -system.properties.gravity[D - 1];
        system.equation_of_state.hydrostatic_compression(head)
    };
    let mut place = *r;
    place[face.axis] = face.at - face.outward() * OBSERVATION * system.model.h;
    let (mut volume, mut velocity, mut compression) = (0.0, Vector::<D>::zeros(), 0.0);
    system.visit_fluid_near(&place, &mut |b, x, w| {
        let share = w / particles.rho[b];
        volume += share;
        velocity += system.velocity_seen_at(b, x) * share;
        compression += (particles.rho[b] / rho0 - 1.0 - at_rest(x)) * share;
    });
    let beside = volume * system.particle_mass() >= BESIDE;
    // The pressure of the waves as a compression, and their velocity.
    let waves = |x: &Vector<D>, t: f64| match face.orbit(x, t) {
        None => (0.0, Vector::zeros()),
        Some((orbit, velocity)) => {
            let head = (level - x[D - 1] + orbit.head) * -system.properties.gravity[D - 1];
            (system.equation_of_state.hydrostatic_compression(head) - at_rest(x), velocity)
        }
    };
    let (velocity, compression) =
        if beside { (velocity / volume, compression / volume - waves(&place, t).0) } else { (*before, 0.0) };
    let (rise, orbital) = waves(r, t);
    let density = |x: f64| rho0 * (1.0 + at_rest(r) + rise + x);
    let Some(prescribed) = face.outward_velocity(r, t) else {
        let held = face.level.is_some();
        let mut velocity =
            if beside { water_beside::linear_velocity(system, &place, volume, &velocity) } else { velocity };
        if let Some(speed) = face.absorbed_speed.filter(|_| face.has_moving_level()) {
            velocity[face.axis] += face.outward() * system.properties.c0.powi(2) * compression / speed;
        }
        return (velocity, density(if held { 0.0 } else { compression }));
    };
    let mut along = Vector::zeros();
    along[face.axis] = face.outward();
    let outward = match face.absorbed_speed {
        None => prescribed,
        Some(speed) => {
            // What it yields to waves that leave, at first and now.
            let then = face.outward_velocity(r, t - dt).unwrap_or(0.0);
            let yielded = (before - waves(&(r - before * dt), t - dt).1).dot(&along) - then;
            let target = system.properties.c0.powi(2) * compression / speed;
            prescribed + yielded + (target - yielded) * response(system, speed, dt)
        }
    };
    (along * outward + orbital, density(compression))
}

/// The discharge (m³/s; m²/s in 2-D) out of the water that face number `i` prescribes at time `t` (s), over the present buffer.
/// `None` if the face has no velocity.
pub(crate) fn prescribed_discharge<const D: usize>(system: &System<D>, i: usize, t: f64) -> Option<f64> {
    let Fluid { particles, buffer, .. } = &system.fluid;
    let face = &system.fluid_domain.open_boundaries[i];
    face.velocity.as_ref()?;
    let own = buffer.tags.iter().zip(&particles.r[system.particle_count()..]).filter(|(tag, _)| tag.face() == i);
    let speeds = own.filter_map(|(_, r)| face.outward_velocity(r, t)).sum::<f64>();
    Some(speeds * system.properties.particle_volume() * system.water_multiplicity() / buffer_length(&system.model))
}

/// The face in whose buffer moving solid number `i` has an end at `pose`.
pub(crate) fn face_reached<'a, const D: usize>(
    system: &'a System<D>,
    i: usize,
    pose: &Pose<D>,
) -> Option<&'a OpenBoundary<D>> {
    let (faces, spec) = (&system.fluid_domain.open_boundaries, &system.solids[i].spec);
    if faces.is_empty() || matches!(spec.role, Role::Fixed) {
        return None;
    }
    // The smallest box of a mesh takes long: a box around it that ends before the face decides alone.
    let (around, length) = (spec.shape.bounds_at(pose), buffer_length(&system.model));
    let is_near = |face: &&OpenBoundary<D>| face.beyond(&around.min).max(face.beyond(&around.max)) > 0.0;
    let ends = |face: &&OpenBoundary<D>| {
        face.has_end_in_buffer(&spec.role, &world_bounds(&spec.shape, pose), length, system.model.dp)
    };
    faces.iter().filter(is_near).find(ends)
}
