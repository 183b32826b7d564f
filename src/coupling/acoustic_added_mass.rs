//! Acoustic added mass: the inertia of the water that acoustic waves accelerate together with a light body.
//!
//! A boundary particle of the outer layer near water acts as a spring of stiffness k = ρ₀ c₀² dpᴰ⁻² along its normal n: a column
//! of water dp long on a face dpᴰ⁻¹. Together these springs have the stiffness K = Σ k J Jᵀ with J = (n, arm ∧ n). On them, a
//! body of mass matrix M oscillates with ω_b² = max eig(M⁻¹K) and radiates sound. Particles carry no sound above 1.14 c₀/h
//! (Wendland kernel), so a body with a higher ω_b cannot radiate: each time step adds the share λ/4, λ = Δt² ω_b², to the energy
//! of that mode, and the oscillation persists or grows. Such a body gets the inertia Z = θ T² K of the water that sound reaches
//! in T = h/c₀, with θ = 1/Λ − 1/(T ω_b)² and Λ = 1.3:
//!
//!   (M + Z) Δv = Δt (W + C) + s S,      S ← S + Δt (W + C) − M Δv,      s = 1 − exp(−Δt/τ),  τ = 10 h/c₀
//!
//! W is the load of water, weight and pushes. C is the load of contacts and joints, as a mean over τ. S is the pending impulse,
//! which the body receives within τ. Slow motions are therefore free of Z: M Δv = Δt (W + C). At a frequency ω the error is
//! ω τ Z/M, which falls with h². Momentum is conserved: the body has received, or will receive, each impulse of the water. A body
//! with (T ω_b)² ≤ Λ is unchanged.
//!
//! When Z grows by ΔZ, water of velocity v_w begins to move with the body. This inelastic collision gives the body the impulse
//! M Δv = −M (M + Z)⁻¹ ΔZ (v − v_w) at once, and the water next to it the opposite impulse. Without this exchange a light body
//! would strike water with the inertia M + Z instead of M, and would gain energy.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::{
    geometry::{Shape, thin::thin_place},
    math::{Bivector, Matrix, Vector, rotated_tensor},
    model::TimeScheme,
    solid::{FreeBody, Kinematics, Load, Role, Solid},
    sph::FluidProperties,
    system::System,
};

/// Λ, the largest (ω_b h/c₀)² of a body without added mass, –. At this value ω_b is the highest frequency of sound that
/// the particles can carry.
const STIFFEST: f64 = 1.3;

/// τ over h/c₀, –.
const TIME: f64 = 10.0;

/// Least Σ V_f W of a boundary particle that counts as fully wet, –. On a submerged face the sum is larger.
const FULL: f64 = 0.25;

/// Translations along the axes, then turns about them; the last three stay 0 in 2-D.
type Six = SVector<f64, 6>;
type Square = SMatrix<f64, 6, 6>;

/// The acoustic added mass of a free body.
pub(crate) struct AcousticAddedMass<const D: usize> {
    /// Index of the body among the solids.
    pub(super) solid: usize,
    /// Indices of the outer boundary particles of the body, in ascending order, and their faces.
    outer: Vec<(u32, Face<D>)>,
    state: AddedMassState,
    /// Load (N, N m) of the present step, without contacts and joints.
    given: Six,
}

/// The face at an outer boundary particle, or both faces of a part about one dp thick with the particle in its middle.
struct Face<const D: usize> {
    /// Outward unit normal (of one of two faces), in the frame of the body.
    normal: Vector<D>,
    /// Number of faces: 1 or 2.
    count: f64,
}

impl<const D: usize> Face<D> {
    /// At the boundary particle `r` (m) of `shape`.
    fn at(shape: &Shape<D>, r: &Vector<D>, dp: f64) -> Self {
        let step = 0.05 * dp;
        match thin_place(shape, r, 1.5 * dp, step).filter(|place| (place.middle - r).norm() < 0.25 * dp) {
            Some(place) => Self { normal: place.normal, count: 2.0 },
            None => Self { normal: shape.outward_normal(r, step), count: 1.0 },
        }
    }
}

/// The state of an [`AcousticAddedMass`] in a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct AddedMassState {
    /// Pending impulse, S (N s, N m s).
    pending: Six,
    /// Load of contacts and joints, C (N, N m).
    contacts: Six,
    /// Trace of the translational part of K, N/m.
    stiffness_sum: f64,
}

impl<const D: usize> AcousticAddedMass<D> {
    /// Returns the added masses of all free solids that need an added mass when they are submerged.
    pub(crate) fn find_all(system: &mut System<D>) -> Vec<Self> {
        (0..system.solids().len()).filter_map(|i| Self::for_solid(system, i)).collect()
    }

    /// Returns the added mass of free solid number `i`, or `None` if the solid needs no added mass when it is
    /// submerged.
    pub(crate) fn for_solid(system: &mut System<D>, i: usize) -> Option<Self> {
        let found = Self::if_light(system, i);
        if found.is_some() {
            system.boundary.wetness.get_or_insert_default();
        }
        found
    }

    fn if_light(system: &System<D>, i: usize) -> Option<Self> {
        let (medium, solid) = (system.properties(), &system.solids()[i]);
        let (pose, shape) = (solid.kinematics.pose, &solid.spec.shape);
        // Without its ballast, which it may lose.
        let Role::Free(body) = &solid.spec.role else { return None };
        if (stiffest_frequency(shape, body, medium) * medium.h / medium.c0).powi(2) <= STIFFEST {
            return None;
        }
        let of = |k: usize| (k as u32, pose.local(&system.place_on_solid(i, k)));
        let near_face = |(_, r): &(u32, Vector<D>)| -shape.signed_distance(r) < 0.75 * medium.dp;
        let own = if solid.copied_axes != 0 { solid.boundary.clone() } else { solid.boundary_of_copy(0) };
        let all = own.map(of).filter(near_face);
        let outer = all.map(|(i, r)| (i, Face::at(shape, &r, medium.dp))).collect();
        let state = AddedMassState { pending: Six::zeros(), contacts: Six::zeros(), stiffness_sum: 0.0 };
        Some(Self { solid: i, outer, state, given: Six::zeros() })
    }

    /// Indices of the outer boundary particles, in ascending order.
    #[cfg(feature = "gpu")]
    pub(crate) fn outer_particles(&self) -> impl Iterator<Item = u32> + '_ {
        self.outer.iter().map(|(i, _)| *i)
    }

    /// Whether springs were wet in the last step.
    #[cfg(feature = "gpu")]
    pub(crate) fn was_wet(&self) -> bool {
        self.state.stiffness_sum > 0.0
    }

    /// Index of the body among the solids.
    #[cfg(feature = "gpu")]
    pub(crate) fn solid(&self) -> usize {
        self.solid
    }

    /// Renumbers the boundary particles after solid number `solid` and its `gone` boundary particles were removed.
    pub(super) fn renumber(&mut self, solid: usize, gone: u32) {
        if self.solid > solid {
            self.outer.iter_mut().for_each(|(i, _)| *i -= gone);
        }
    }

    /// Returns the state for a checkpoint.
    pub(crate) fn state(&self) -> AddedMassState {
        self.state
    }

    /// Returns the linear part of the pending impulse S, N s.
    pub(super) fn pending_impulse(&self) -> Vector<D> {
        linear(&self.state.pending)
    }

    /// Restores a saved state.
    pub(crate) fn restore(&mut self, state: AddedMassState) {
        self.state = state;
    }

    /// Refers the pending impulse and the load of contacts to the centre of mass, which has moved by `shift` (m) within the body.
    pub(super) fn shift_centre(&mut self, shift: &Vector<D>) {
        for load in [&mut self.state.pending, &mut self.state.contacts] {
            let torque = Bivector::torque(shift, &linear(load)) * -1.0;
            *load += to_six(&Load { force: Vector::zeros(), torque });
        }
    }

    /// Removes the share of the pending impulse that belongs to water that the body has left. Returns this share, N s.
    fn release(&mut self, stiffness_sum: f64) -> Vector<D> {
        let stays =
            if stiffness_sum < self.state.stiffness_sum { stiffness_sum / self.state.stiffness_sum } else { 1.0 };
        let left = self.state.pending * (1.0 - stays);
        self.state.stiffness_sum = stiffness_sum;
        self.state.pending -= left;
        linear(&left)
    }

    /// Replaces the `load` of the water in a step `dt` (s) by the load that the body receives; the engine adds weight and
    /// `push`. Returns the impulse (N s) that the water gets back.
    pub(super) fn apply(&mut self, system: &System<D>, dt: f64, push: &Load<D>, load: &mut Load<D>) -> Vector<D> {
        let solid = &system.solids()[self.solid];
        let Some(body) = &solid.body else { return Vector::zeros() };
        let added = Load { force: push.force + system.gravity() * body.mass, torque: push.torque };
        let mut whole = to_six(load) + to_six(&added);
        lock(body, |i| whole[i] = 0.0);
        let (springs, stiffness_sum) = self.springs(system, body);
        let fresh =
            if stiffness_sum > self.state.stiffness_sum { 1.0 - self.state.stiffness_sum / stiffness_sum } else { 0.0 };
        let left = self.release(stiffness_sum);
        let time2 = (system.properties().h / system.properties().c0).powi(2);
        let (mass, water) = (mass(solid, body), springs * time2);
        let theta = theta(&mass, &water);
        let both = (mass + water * theta).cholesky();
        let answer = |impulse: Six| both.as_ref().map(|both| mass * both.solve(&impulse));
        let share = applied_share(system, dt);
        let (total, pending) = (whole + self.state.contacts, self.state.pending);
        let impulse = answer(total * dt + pending * share).unwrap_or(total * dt);
        let mut join = Six::zeros();
        if theta * fresh > 0.0 {
            let motion = to_six(&Load { force: solid.kinematics.velocity, torque: solid.kinematics.spin });
            // The water is at the end of the step, boundary particles are half a step (Verlet: a step) behind.
            let behind = if system.model().scheme == TimeScheme::Symplectic { 0.5 * dt } else { dt };
            let way = solid.kinematics.velocity * behind;
            let closing = water * motion - self.flow(system, body, &way) * time2;
            join = answer(closing * (-theta * fresh)).unwrap_or(join);
            lock(body, |i| join[i] = 0.0);
        }
        self.state.pending += total * dt - impulse;
        // The moment of the pending momentum about the origin must not change while the body moves.
        let carried = Bivector::torque(&solid.kinematics.velocity, &linear(&pending)) * -dt;
        self.state.pending += to_six(&Load { force: Vector::zeros(), torque: carried });
        lock(body, |i| self.state.pending[i] = 0.0);
        self.given = (impulse + join) / dt - self.state.contacts;
        let mut given = self.given - to_six(&added);
        // Locks bear the whole load along locked motions.
        lock(body, |i| given[i] = to_six(load)[i]);
        *load = Load { force: linear(&given), torque: angular::<D>(&given) };
        left - linear::<D>(&join)
    }

    /// Updates the load of contacts and joints from the motion over the step that began as `before`.
    pub(super) fn update_contacts(
        &mut self,
        system: &System<D>,
        dt: f64,
        before: &Kinematics<D>,
        after: &Kinematics<D>,
    ) {
        let solid = &system.solids()[self.solid];
        let Some(body) = &solid.body else { return };
        let change = Load {
            force: (after.velocity - before.velocity) / dt,
            torque: (after.spin + before.spin * -1.0) * (1.0 / dt),
        };
        let mut contacts = mass(solid, body) * to_six(&change) - self.given;
        lock(body, |i| contacts[i] = 0.0);
        self.state.contacts += (contacts - self.state.contacts) * applied_share(system, dt);
    }

    /// Returns the stiffness K (N/m, N and N m) of the wet springs, with zeros for the locked motions, and the trace (N/m) of its
    /// translational part before that.
    fn springs(&self, system: &System<D>, body: &FreeBody<D>) -> (Square, f64) {
        let mut sum = Square::zeros();
        self.for_each_wet(system, |part, _, _, along| sum += along * along.transpose() * part);
        sum *= stiffness(system);
        let trace = (0..D).map(|i| sum[(i, i)]).sum();
        lock(body, |i| {
            sum.row_mut(i).fill(0.0);
            sum.column_mut(i).fill(0.0);
        });
        (sum, trace)
    }

    /// Returns K v_w (N/s and N m/s) of the wet springs. `way` (m) is the distance that the body has moved between the time of
    /// its boundary particles and the time of the water.
    fn flow(&self, system: &System<D>, body: &FreeBody<D>, way: &Vector<D>) -> Six {
        let mut sum = Six::zeros();
        self.for_each_wet(system, |part, x, normal, along| {
            let (mut weight, mut flow) = (0.0, Vector::<D>::zeros());
            system.visit_fluid_near(&(x + way), &mut |i, r, w| {
                (weight, flow) = (weight + w, flow + system.velocity_seen_at(i, r) * w)
            });
            if weight > 0.0 {
                sum += along * (part * normal.dot(&flow) / weight);
            }
        });
        lock(body, |i| sum[i] = 0.0);
        sum * stiffness(system)
    }

    /// Calls `visit` for every wet outer boundary particle with its number of wet faces (0 to 2), position (m), normal n, and J.
    fn for_each_wet(&self, system: &System<D>, mut visit: impl FnMut(f64, &Vector<D>, &Vector<D>, Six)) {
        let solid = &system.solids()[self.solid];
        let turn = &solid.kinematics.pose.rotation;
        let wetness = system.boundary.wetness.as_deref().unwrap_or_default();
        let of_whole = system.symmetry_planes().multiplicity(!solid.division.cut);
        let mut k = wetness.partition_point(|&(i, _)| (i as usize) < solid.boundary.start);
        for (i, face) in &self.outer {
            k += wetness[k..].iter().take_while(|(wet, _)| wet < i).count();
            if let Some((_, weight)) = wetness.get(k).filter(|(wet, _)| wet == i) {
                let (x, normal) = (&system.boundary.particles.r[*i as usize], turn * face.normal);
                if !system.is_between_sides(x) {
                    continue;
                }
                // The springs beyond planes that cut the body act alike along the motions that are free.
                let images = system.computed_share(solid, x) * of_whole;
                let arm = system.place_on_solid(self.solid, *i as usize) - solid.kinematics.centre;
                let torque = Bivector::torque(&arm, &normal);
                visit((weight / FULL).min(face.count) * images, x, &normal, to_six(&Load { force: normal, torque }));
            }
        }
    }
}

/// Returns the stiffness k of one spring, N/m.
fn stiffness<const D: usize>(system: &System<D>) -> f64 {
    let medium = system.properties();
    medium.rho0 * medium.c0 * medium.c0 * medium.dp.powi(D as i32 - 2)
}

/// Returns θ, the share of the water's inertia T² K that is added to a mass matrix M, –.
fn theta(mass: &Square, water: &Square) -> f64 {
    let Some(root) = mass.cholesky().and_then(|c| c.l().try_inverse()) else { return 0.0 };
    let stiffest = (root * water * root.transpose()).symmetric_eigenvalues().max();
    if stiffest > STIFFEST { 1.0 / STIFFEST - 1.0 / stiffest } else { 0.0 }
}

/// Returns the share (–) of the pending impulse that a step of length `dt` (s) applies.
fn applied_share<const D: usize>(system: &System<D>, dt: f64) -> f64 {
    let medium = system.properties();
    1.0 - (-dt * medium.c0 / (TIME * medium.h)).exp()
}

/// Returns the mass matrix of `body`: mass and inertia in the world axes.
fn mass<const D: usize>(solid: &Solid<D>, body: &FreeBody<D>) -> Square {
    let mut all = Square::identity();
    let turn = &solid.kinematics.pose.rotation;
    let inertia: Matrix<D> = if D == 2 { body.inertia } else { rotated_tensor(turn, &body.inertia) };
    for i in 0..D {
        all[(i, i)] = body.mass;
    }
    for i in 0..Bivector::<D>::COMPONENTS {
        for j in 0..Bivector::<D>::COMPONENTS {
            all[(D + i, D + j)] = inertia[(i, j)];
        }
    }
    all
}

/// Calls `visit` with the indices of the locked motions.
fn lock<const D: usize>(body: &FreeBody<D>, mut visit: impl FnMut(usize)) {
    let turns = body.locked_rotations.iter().take(Bivector::<D>::COMPONENTS);
    body.locked_translations.iter().chain(turns).enumerate().filter(|(_, locked)| **locked).for_each(|(i, _)| visit(i));
}

fn to_six<const D: usize>(load: &Load<D>) -> Six {
    let both = load.force.iter().copied().chain(load.torque.axial());
    let mut all = Six::zeros();
    all.iter_mut().zip(both).for_each(|(to, x)| *to = x);
    all
}

fn linear<const D: usize>(six: &Six) -> Vector<D> {
    Vector::from_fn(|i, _| six[i])
}

fn angular<const D: usize>(six: &Six) -> Bivector<D> {
    Bivector::from_axial(&six.as_slice()[D..D + Bivector::<D>::COMPONENTS])
}

/// Returns ω_b (1/s), the highest natural frequency of a fully submerged body with compressible water as its spring. ω_b
/// is the larger of the highest translational and the highest rotational frequency. Every boundary particle of the
/// outer layer is a spring of stiffness ρ₀ c₀² dpᴰ⁻² along its normal: a column of water dp long on a face dpᴰ⁻¹.
pub fn stiffest_frequency<const D: usize>(shape: &Shape<D>, body: &FreeBody<D>, medium: &FluidProperties<D>) -> f64 {
    let spring = medium.rho0 * medium.c0 * medium.c0 * medium.dp.powi(D as i32 - 2);
    let (mut along, mut about) = (Vector::<D>::zeros(), [0.0; 3]);
    for point in shape.boundary_points(medium.dp, 1) {
        let Face { normal, count } = Face::at(shape, &point.r, medium.dp);
        let stiffness = count * spring;
        along += normal.component_mul(&normal) * stiffness;
        for (sum, arm) in about.iter_mut().zip(Bivector::torque(&(point.r - body.centre), &normal).axial()) {
            *sum += arm * arm * stiffness;
        }
    }
    let inertia = |i: usize| if D == 2 { body.inertia[(0, 0)] } else { body.inertia[(i, i)] };
    let turning = (0..Bivector::<D>::COMPONENTS).map(|i| about[i] / inertia(i));
    turning.fold(along.max() / body.mass, f64::max).sqrt()
}
