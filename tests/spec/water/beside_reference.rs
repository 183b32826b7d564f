//! States of real runs, and the sizes against which a fast path is held to the reference.

use pontoon::{
    math::Vector,
    model::PairLoopKind,
    simulation::{Dimension, Setup, Simulation},
    solid::Dim,
};

/// The simulation of `setup` in `state` with this pair loop.
pub fn under<const D: usize>(setup: &Setup<D>, pair_loop: PairLoopKind, state: &[u8]) -> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    let mut setup = setup.clone();
    setup.model.pair_loop = pair_loop;
    let mut sim = Simulation::new(setup).expect("a sound setup");
    sim.restore(state).expect("the same scene");
    sim.update_rates();
    sim
}

/// Sums of the magnitudes of all terms of a water particle: of its acceleration (m/s²) and of its density rate (kg/m³/s).
pub fn sizes<const D: usize>(sim: &Simulation<D>, a: usize) -> (f64, f64) {
    let system = sim.system();
    let (h, c0, rho0, dp) = (system.model().h, system.model().c0, system.model().rho0, system.model().dp);
    let (fluid, boundary) = (system.fluid(), system.boundary());
    let (mut force, mut rate) = (0.0, 0.0);
    let mut meet = |r: &Vector<D>, v: &Vector<D>, rho: f64| {
        let (r, v) = (fluid.r[a] - r, fluid.v[a] - v);
        let q = r.norm() / h;
        // |∇W| of the Wendland kernel.
        let alpha = if D == 2 { 7.0 / (4.0 * std::f64::consts::PI) } else { 21.0 / (16.0 * std::f64::consts::PI) };
        let grad = 5.0 * alpha / h.powi(D as i32 + 1) * q * (1.0 - 0.5 * q).powi(3) * dp.powi(D as i32);
        let pressure = (system.pressure(fluid.rho[a]).abs() + system.pressure(rho).abs()) / rho0;
        let viscous = 0.02 * c0 * h * v.norm() / r.norm().max(0.1 * h);
        force += (pressure + viscous) * grad;
        // Diffusion: the difference of densities and, subtracted from it, the hydrostatic one.
        let differences = (rho - fluid.rho[a]).abs() / rho0 + system.gravity().dot(&r).abs() / (c0 * c0);
        rate += (v.norm() + 0.2 * c0 * h * differences / r.norm().max(0.1 * h)) * grad * rho0;
    };
    system.visit_fluid_near(&fluid.r[a], &mut |b, r, _| {
        if b != a {
            meet(r, &fluid.v[b], fluid.rho[b]);
        }
    });
    system.visit_boundary_near(&fluid.r[a], &mut |b, _, _| meet(&boundary.r[b], &boundary.v[b], boundary.rho[b]));
    (force, rate)
}

/// The state of `setup` at time `until` (s).
pub fn run<const D: usize>(setup: &Setup<D>, until: f64) -> Vec<u8>
where
    Dim<D>: Dimension<D>,
{
    let mut sim = Simulation::new(setup.clone()).expect("a sound setup");
    while sim.time() < until {
        sim.step().expect("a sound run");
    }
    sim.save().expect("a state")
}
