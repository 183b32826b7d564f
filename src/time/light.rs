//! Bodies lighter than the water that sound sets moving while it crosses a kernel.
//!
//! A wet boundary particle of the outer layer is a spring of stiffness k = ρ₀ c₀² dpᴰ⁻² along its normal n (a column of
//! water dp long on a face dpᴰ⁻¹). A body of mass matrix M on all of them, K = Σ k J Jᵀ with J = (n, arm ∧ n), swings with ω_b,
//! ω_b² = max eig(M⁻¹K), and gives that up to the water as sound. But particles carry no sound faster than 1.14 c₀/h (Wendland's
//! kernel; shorter waves are slower): a body that swings faster rings, trapped, and as a step gives it λ/4 of the energy of that
//! mode, λ = Δt² ω_b², it rings for ever or blows up. So that it never swings faster, it answers with the inertia of the water
//! that sound sets moving with it in T = h/c₀, Z = θ T² K, θ = 1/Λ − 1/(T ω_b)², Λ = 1.3:
//!
//!   (M + Z) Δv = Δt (W + C) + s S,      S ← S + Δt (W + C) − M Δv,      s = 1 − exp(−Δt/τ),  τ = 10 h/c₀
//!
//! W is the load of water, weight and pushes, C that of contacts and joints (a mean over τ), S the impulse withheld so far. It is
//! handed on within τ, so that in motions slower than sound Z has no part, M Δv = Δt (W + C): at a frequency ω it is off by
//! ω τ Z/M, which falls with the square of h; and momentum is kept: what the water lost the body has, or will have. A body with
//! (T ω_b)² < Λ is left as it is.
//!
//! Water that gets hold of more of the body, by ΔZ, moves with v_w until then, and with the body from then on: an inelastic join
//! gives the body M Δv = −M (M + Z)⁻¹ ΔZ (v − v_w) at once, and the water next to it as much less. Without it a light body that
//! strikes water meets it as heavy as with all of Z, and leaves with energy that it never had.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use super::limit;
use crate::{
    solid::{FreeBody, Kinematics, Load, Role, Solid},
    space::{Matrix, Vector, Wedge},
    system::System,
};

/// Λ, the largest (ω_b h/c₀)² that a body is left with, –: that of the fastest sound that particles carry.
const STIFFEST: f64 = 1.3;

/// τ over h/c₀, –.
const TIME: f64 = 10.0;

/// Σ V_f W from which on a boundary particle is held by the water as under its surface, –: a face under water has more.
const FULL: f64 = 0.25;

/// Translations along the axes, then turns about them; the last three stay 0 in 2-D.
type Six = SVector<f64, 6>;
type Square = SMatrix<f64, 6, 6>;

/// A free body that may need the inertia of the water around it.
pub struct Light<const D: usize> {
    /// Its number among the solids.
    pub(super) solid: usize,
    /// Its outer boundary particles, in order, and their normals in its frame.
    outer: Vec<(u32, Vector<D>)>,
    held: Held,
    /// Load (N, N m) of the present step but for contacts and joints.
    given: Six,
}

/// What of it must be kept to go on to the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// Impulse withheld, S (N s, N m s).
    withheld: Six,
    /// Load of contacts and joints, C (N, N m).
    contacts: Six,
    /// How much water holds the body, the trace of K, N/m.
    grip: f64,
}

impl<const D: usize> Light<D> {
    /// The free solids that would swing faster than sound crosses a kernel, were they wet all around.
    pub(crate) fn find(system: &mut System<D>) -> Vec<Self> {
        (0..system.solids().len()).filter_map(|i| Self::of(system, i)).collect()
    }

    /// The free solid number `i`, if it would swing so fast, were it wet all around.
    pub(crate) fn of(system: &mut System<D>, i: usize) -> Option<Self> {
        let found = Self::one(system, i);
        system.feels |= found.is_some();
        found
    }

    fn one(system: &System<D>, i: usize) -> Option<Self> {
        let (medium, solid) = (system.medium(), &system.solids()[i]);
        let (pose, shape) = (solid.kinematics.pose, &solid.spec.shape);
        let Role::Free(body) = &solid.spec.role else { return None };
        if (limit::stiffest(shape, body, medium) * medium.h / medium.c0).powi(2) <= STIFFEST {
            return None;
        }
        let of = |i: usize| (i as u32, pose.local(&system.skin().r[i]));
        let near_face = |(_, r): &(u32, Vector<D>)| -shape.signed_distance(r) < 0.75 * medium.dp;
        let all = solid.skin.clone().map(of).filter(near_face);
        let outer = all.map(|(i, r)| (i, shape.outward(&r, 0.05 * medium.dp))).collect();
        let held = Held { withheld: Six::zeros(), contacts: Six::zeros(), grip: 0.0 };
        Some(Self { solid: i, outer, held, given: Six::zeros() })
    }

    /// Follows the boundary particles when `gone` of them, of solid number `solid`, are taken out.
    pub(super) fn shift(&mut self, solid: usize, gone: u32) {
        if self.solid > solid {
            self.outer.iter_mut().for_each(|(i, _)| *i -= gone);
        }
    }

    /// What must be kept to go on to the same bits.
    pub(crate) fn held(&self) -> Held {
        self.held
    }

    /// Impulse that it has yet to get, N s.
    pub(super) fn withheld(&self) -> Vector<D> {
        linear(&self.held.withheld)
    }

    /// Goes back to what was kept.
    pub(crate) fn restore(&mut self, held: Held) {
        self.held = held;
    }

    /// What is withheld from a body that leaves the water is that water's: returns the share of it, N s, and forgets it.
    fn leave(&mut self, grip: f64) -> Vector<D> {
        let stays = if grip < self.held.grip { grip / self.held.grip } else { 1.0 };
        let left = self.held.withheld * (1.0 - stays);
        self.held.grip = grip;
        self.held.withheld -= left;
        linear(&left)
    }

    /// Replaces `load`, that of the water, weighed, in a step `dt` (s), by what the body is to be given; the engine adds
    /// weight and `push`.
    pub(super) fn share(&mut self, system: &System<D>, dt: f64, push: &Load<D>, load: &mut Load<D>) -> Vector<D> {
        let solid = &system.solids()[self.solid];
        let Role::Free(body) = &solid.spec.role else { return Vector::zeros() };
        let added = Load { force: push.force + system.gravity() * body.mass, torque: push.torque };
        let mut whole = six(load) + six(&added);
        lock(body, |i| whole[i] = 0.0);
        let springs = self.springs(system, body);
        let grip = (0..D).map(|i| springs[(i, i)]).sum();
        let fresh = if grip > self.held.grip { 1.0 - self.held.grip / grip } else { 0.0 };
        let left = self.leave(grip);
        let time2 = (system.medium().h / system.medium().c0).powi(2);
        let (mass, water) = (mass(solid, body), springs * time2);
        let theta = theta(&mass, &water);
        let both = (mass + water * theta).cholesky();
        let answer = |impulse: Six| both.as_ref().map(|both| mass * both.solve(&impulse));
        let share = settled(system, dt);
        let (total, withheld) = (whole + self.held.contacts, self.held.withheld);
        let impulse = answer(total * dt + withheld * share).unwrap_or(total * dt);
        let mut join = Six::zeros();
        if theta * fresh > 0.0 {
            let motion = six(&Load { force: solid.kinematics.velocity, torque: solid.kinematics.spin });
            let closing = water * motion - self.flow(system, body) * time2;
            join = answer(closing * (-theta * fresh)).unwrap_or(join);
            lock(body, |i| join[i] = 0.0);
        }
        self.held.withheld += total * dt - impulse;
        // Momentum withheld is carried along: its moment about the origin must not change.
        let carried = Wedge::torque(&solid.kinematics.velocity, &linear(&withheld)) * -dt;
        self.held.withheld += six(&Load { force: Vector::zeros(), torque: carried });
        lock(body, |i| self.held.withheld[i] = 0.0);
        self.given = (impulse + join) / dt - self.held.contacts;
        let given = self.given - six(&added);
        *load = Load { force: linear(&given), torque: angular::<D>(&given) };
        left - linear::<D>(&join)
    }

    /// Learns from the motion over the step that began as `before` what contacts and joints did.
    pub(super) fn learn(&mut self, system: &System<D>, dt: f64, before: &Kinematics<D>, after: &Kinematics<D>) {
        let solid = &system.solids()[self.solid];
        let Role::Free(body) = &solid.spec.role else { return };
        let change = Load {
            force: (after.velocity - before.velocity) / dt,
            torque: (after.spin + before.spin * -1.0) * (1.0 / dt),
        };
        let mut contacts = mass(solid, body) * six(&change) - self.given;
        lock(body, |i| contacts[i] = 0.0);
        self.held.contacts += (contacts - self.held.contacts) * settled(system, dt);
    }

    /// K of the springs that are wet now, N/m, N and N m.
    fn springs(&self, system: &System<D>, body: &FreeBody<D>) -> Square {
        let mut sum = Square::zeros();
        self.each_wet(system, |part, _, _, along| sum += along * along.transpose() * part);
        lock(body, |i| {
            sum.row_mut(i).fill(0.0);
            sum.column_mut(i).fill(0.0);
        });
        sum * stiffness(system)
    }

    /// K v_w: what the springs feel of the water's own motion, N/s and N m/s.
    fn flow(&self, system: &System<D>, body: &FreeBody<D>) -> Six {
        let mut sum = Six::zeros();
        self.each_wet(system, |part, x, normal, along| {
            let (mut weight, mut flow) = (0.0, Vector::<D>::zeros());
            system.water_near(x, &mut |i, _, w| (weight, flow) = (weight + w, flow + system.fluid().v[i] * w));
            if weight > 0.0 {
                sum += along * (part * normal.dot(&flow) / weight);
            }
        });
        lock(body, |i| sum[i] = 0.0);
        sum * stiffness(system)
    }

    /// Calls `visit` with every outer boundary particle that is wet: the part of it (0 to 1) that the water holds, its place (m), its
    /// normal n, and J.
    fn each_wet(&self, system: &System<D>, mut visit: impl FnMut(f64, &Vector<D>, &Vector<D>, Six)) {
        let solid = &system.solids()[self.solid];
        let turn = &solid.kinematics.pose.rotation;
        let wet = system.near.wet();
        let mut k = wet.partition_point(|&i| (i as usize) < solid.skin.start);
        for (i, normal) in &self.outer {
            k += wet[k..].iter().take_while(|w| *w < i).count();
            if wet.get(k) == Some(i) {
                let (x, normal) = (&system.skin.r[*i as usize], turn * normal);
                let torque = Wedge::torque(&(x - solid.kinematics.centre), &normal);
                visit((system.immersed[k] / FULL).min(1.0), x, &normal, six(&Load { force: normal, torque }));
            }
        }
    }
}

/// k of one spring, N/m.
fn stiffness<const D: usize>(system: &System<D>) -> f64 {
    let medium = system.medium();
    medium.rho0 * medium.c0 * medium.c0 * medium.dp.powi(D as i32 - 2)
}

/// θ: how much of the water's inertia T² K goes with a body of mass matrix M, –.
fn theta(mass: &Square, water: &Square) -> f64 {
    let Some(root) = mass.cholesky().and_then(|c| c.l().try_inverse()) else { return 0.0 };
    let stiffest = (root * water * root.transpose()).symmetric_eigenvalues().max();
    if stiffest > STIFFEST { 1.0 / STIFFEST - 1.0 / stiffest } else { 0.0 }
}

/// The part (–) of what is withheld that a step `dt` (s) hands on.
fn settled<const D: usize>(system: &System<D>, dt: f64) -> f64 {
    let medium = system.medium();
    1.0 - (-dt * medium.c0 / (TIME * medium.h)).exp()
}

/// Mass and inertia in the world's axes.
fn mass<const D: usize>(solid: &Solid<D>, body: &FreeBody<D>) -> Square {
    let mut all = Square::identity();
    let turn = &solid.kinematics.pose.rotation;
    let inertia: Matrix<D> = if D == 2 { body.inertia } else { turn * body.inertia * turn.transpose() };
    for i in 0..D {
        all[(i, i)] = body.mass;
    }
    for i in 0..Wedge::<D>::COMPONENTS {
        for j in 0..Wedge::<D>::COMPONENTS {
            all[(D + i, D + j)] = inertia[(i, j)];
        }
    }
    all
}

/// Calls `visit` with the places of the motions that are locked.
fn lock<const D: usize>(body: &FreeBody<D>, mut visit: impl FnMut(usize)) {
    let turns = body.locked_rotations.iter().take(Wedge::<D>::COMPONENTS);
    body.locked_translations.iter().chain(turns).enumerate().filter(|(_, locked)| **locked).for_each(|(i, _)| visit(i));
}

fn six<const D: usize>(load: &Load<D>) -> Six {
    let both = load.force.iter().copied().chain(load.torque.axial());
    let mut all = Six::zeros();
    all.iter_mut().zip(both).for_each(|(to, x)| *to = x);
    all
}

fn linear<const D: usize>(six: &Six) -> Vector<D> {
    Vector::from_fn(|i, _| six[i])
}

fn angular<const D: usize>(six: &Six) -> Wedge<D> {
    Wedge::from_axial(&six.as_slice()[D..D + Wedge::<D>::COMPONENTS])
}
