//! Steps on a device beside the reference. Without a graphics card a software driver does them: Mesa's lavapipe (Debian package
//! `mesa-vulkan-drivers`). `PONTOON_DEVICE` names another device.

#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use pontoon::{
    geometry::Shape,
    math::{Vector, expression::Formula},
    model::{Diffusion, Dimension, KernelKind, Model, PairLoopKind, Slip, TimeScheme, Viscosity, Walls},
    simulation::{Setup, Simulation},
    solid::{Dim, PrescribedMotion, SolidSpec, TimeFunction},
    sph::{
        density_diffusion::Molteni,
        viscosity::{Artificial, Laminar},
    },
};

fn device() -> String {
    std::env::var("PONTOON_DEVICE").unwrap_or_else(|_| "llvmpipe".into())
}

/// A dam break in a tank.
fn dam<const D: usize>(model: Model, size: [f64; D]) -> Setup<D> {
    let dp = model.dp;
    let tank: [f64; D] = std::array::from_fn(|i| if i == D - 1 { 1.6 * size[i] } else { size[i] });
    let column: [f64; D] = std::array::from_fn(|i| if i == 0 { 0.4 * size[0] } else { size[i] });
    let walls = SolidSpec::fixed("tank", Shape::Tank { size: tank.into(), thickness: 4.0 * dp });
    Setup::new(model).solid(walls).fill_box([0.0; D], column).expect("water")
}

/// The simulation of `setup` with this pair loop, in `state` if there is one.
fn under<const D: usize>(setup: &Setup<D>, pair_loop: PairLoopKind, state: Option<&[u8]>) -> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    let mut setup = setup.clone();
    setup.model.pair_loop = pair_loop;
    let mut sim = Simulation::new(setup).expect("a sound setup");
    state.into_iter().for_each(|state| sim.restore(state).expect("the same scene"));
    sim.update_rates();
    sim
}

fn run<const D: usize>(setup: &Setup<D>, until: f64) -> Vec<u8>
where
    Dim<D>: Dimension<D>,
{
    let mut sim = Simulation::new(setup.clone()).expect("a sound setup");
    while sim.time() < until {
        sim.step().expect("a sound run");
    }
    sim.save().expect("a state")
}

/// Sums of the magnitudes of all terms of a water particle: of its acceleration and of its density rate.
fn sizes<const D: usize>(sim: &Simulation<D>, a: usize) -> (f64, f64) {
    let system = sim.system();
    let (h, c0, rho0, dp) = (system.model().h, system.model().c0, system.model().rho0, system.model().dp);
    let (fluid, boundary) = (system.fluid(), system.boundary());
    let (mut force, mut rate) = (0.0, 0.0);
    let mut meet = |r: &Vector<D>, v: &Vector<D>, rho: f64| {
        let (r, v) = (fluid.r[a] - r, fluid.v[a] - v);
        let q = r.norm() / h;
        let alpha = if D == 2 { 7.0 / (4.0 * std::f64::consts::PI) } else { 21.0 / (16.0 * std::f64::consts::PI) };
        let grad = 5.0 * alpha / h.powi(D as i32 + 1) * q * (1.0 - 0.5 * q).powi(3) * dp.powi(D as i32);
        let pressure = (system.pressure(fluid.rho[a]).abs() + system.pressure(rho).abs()) / rho0;
        let viscous = 0.02 * c0 * h * v.norm() / r.norm().max(0.1 * h);
        force += (pressure + viscous) * grad;
        let differences = (rho - fluid.rho[a]).abs() / rho0 + system.gravity().dot(&r).abs() / (c0 * c0);
        rate += (v.norm() + 0.2 * c0 * h * differences / r.norm().max(0.1 * h)) * grad;
    };
    system.visit_fluid_near(&fluid.r[a], &mut |b, _, _| {
        if b != a {
            meet(&fluid.r[b], &fluid.v[b], fluid.rho[b]);
        }
    });
    system.visit_boundary_near(&fluid.r[a], &mut |b, _, _| meet(&boundary.r[b], &boundary.v[b], boundary.rho[b]));
    (force, rate)
}

/// Asserts that a force pass on the device agrees with the reference on one state, by the bounds of the SIMD pair loop.
fn assert_rates_agree<const D: usize>(name: &str, setup: &Setup<D>, state: &[u8])
where
    Dim<D>: Dimension<D>,
{
    let reference = under(setup, PairLoopKind::Reference, Some(state));
    let expected = reference.system();
    let n = expected.fluid().len();
    let sizes: Vec<(f64, f64)> = (0..n).map(|i| sizes(&reference, i)).collect();
    let most = sizes.iter().fold((0.0f64, 0.0f64), |m, s| (m.0.max(s.0), m.1.max(s.1)));
    let all_forces: f64 = sizes.iter().map(|s| s.0).sum::<f64>() * expected.particle_mass();
    let mut on_device = under(setup, PairLoopKind::Fast, Some(state)).on_device(&device()).expect("a device");
    let (rates, limits) = on_device.device_rates().expect("rates").expect("a device");
    let (mut worst, mut worst_rate) = (0.0f64, 0.0f64);
    for (i, size) in sizes.iter().enumerate() {
        let dv = (rates[i].acceleration - expected.fluid_acceleration(i)).norm();
        let drho = (rates[i].compression_rate - expected.fluid_density_rate(i) / expected.model().rho0).abs();
        worst = worst.max(dv / (2e-5 * size.0 + 2e-6 * most.0));
        worst_rate = worst_rate.max(drho / (2e-5 * size.1 + 2e-6 * most.1));
    }
    println!("{name}: acceleration and rate over their bounds {worst:.4}, {worst_rate:.4}");
    assert!(worst <= 1.0 && worst_rate <= 1.0, "{name}: {worst} and {worst_rate} of the bounds");
    for (a, b) in on_device.system().solids().iter().zip(expected.solids()) {
        let off = (a.load.force - b.load.force).norm();
        assert!(off < 1e-6 * all_forces, "{name}: load on {} off by {off} N", a.spec.name);
    }
    let peaks = expected.step_limits();
    assert!((limits.acceleration / peaks.acceleration - 1.0).abs() < 1e-4, "{name}: {limits:?} {peaks:?}");
    assert!((limits.approach_rate - peaks.approach_rate).abs() <= 1e-4 * peaks.approach_rate + 1e-6, "{name}");
}

#[test]
fn a_force_pass_agrees_with_the_reference_after_an_impact() {
    let setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]);
    assert_rates_agree("2-D", &setup, &run(&setup, 0.35));
    let setup = dam(Model::water(3, 0.04, 0.3), [0.6, 0.16, 0.32]);
    assert_rates_agree("3-D", &setup, &run(&setup, 0.3));
}

#[test]
fn every_law_agrees_with_the_reference() {
    fn check<const D: usize>(dp: f64, size: [f64; D])
    where
        Dim<D>: Dimension<D>,
    {
        let base = || Model::water(D, dp, 0.3);
        let cases = [
            ("artificial", base().viscosity(Viscosity::Artificial(Artificial { alpha: 0.1 }))),
            ("laminar", base().viscosity(Viscosity::Laminar(Laminar { nu0: 1e-4 }))),
            ("no viscosity or diffusion", base().viscosity(Viscosity::None).diffusion(Diffusion::None)),
            ("molteni", base().diffusion(Diffusion::Molteni(Molteni { delta: 0.1 }))),
            ("partial slip", base().slip(Slip::Partial)),
            ("cubic", base().kernel(KernelKind::Cubic { tensile: false })),
            ("dynamic walls", base().walls(Walls::Dynamic)),
        ];
        for (name, model) in cases {
            let setup = dam(model, size);
            assert_rates_agree(&format!("{D}-D, {name}"), &setup, &run(&setup, 0.05));
        }
    }
    check(0.03, [0.8, 0.3]);
    check(0.06, [0.6, 0.18, 0.3]);
}

/// Root-mean-square distances of the water from that of the reference: positions (dp), velocities (c₀).
fn distances<const D: usize>(a: &Simulation<D>, b: &Simulation<D>) -> [f64; 2] {
    let (model, n) = (a.system().model(), a.system().fluid().len());
    let place = |sim: &Simulation<D>| {
        let mut place = vec![0; n];
        sim.system().fluid().id.iter().enumerate().for_each(|(i, id)| place[*id as usize] = i);
        place
    };
    let (in_a, in_b) = (place(a), place(b));
    let (fluid_a, fluid_b) = (a.system().fluid(), b.system().fluid());
    let mut sums = [0.0; 2];
    for (i, j) in in_a.into_iter().zip(in_b) {
        sums[0] += ((fluid_a.r[i] - fluid_b.r[j]) / model.dp).norm_squared();
        sums[1] += ((fluid_a.v[i] - fluid_b.v[j]) / model.c0).norm_squared();
    }
    sums.map(|sum| (sum / n as f64).sqrt())
}

/// Steps of the device and of the reference from `start` (s) on.
fn beside<const D: usize>(setup: &Setup<D>, start: f64, steps: usize) -> [Simulation<D>; 2]
where
    Dim<D>: Dimension<D>,
{
    let state = run(setup, start);
    let mut reference = under(setup, PairLoopKind::Reference, Some(&state));
    let mut on_device = under(setup, PairLoopKind::Fast, Some(&state)).on_device(&device()).expect("a device");
    for _ in 0..steps {
        reference.step().expect("a sound run");
        on_device.step().expect("a sound run");
    }
    [on_device, reference]
}

#[test]
fn whole_steps_agree_with_the_reference() {
    // 500 steps of a dam break: the water of both drifts apart at the rate at which the flow forgets.
    for scheme in [TimeScheme::Symplectic, TimeScheme::Verlet { euler_every: 50 }] {
        let cfl = if scheme == TimeScheme::Symplectic { 0.4 } else { 0.2 };
        let setup = dam(Model::water(2, 0.01, 0.3).scheme(scheme).cfl(cfl), [0.8, 0.3]);
        let [on_device, reference] = beside(&setup, 0.05, 500);
        let [r, v] = distances(&on_device, &reference);
        let energy = on_device.system().kinetic_energy() / reference.system().kinetic_energy() - 1.0;
        let time = on_device.time() / reference.time() - 1.0;
        println!("{scheme:?}: positions {r:.1e} dp, velocities {v:.1e} c0, energy {energy:.1e}, time {time:.1e}");
        assert!(r < 2e-4, "{scheme:?}: positions {r} dp off");
        assert!(energy.abs() < 1e-5, "{scheme:?}: kinetic energy {energy} off");
        assert!(time.abs() < 1e-6, "{scheme:?}: time {time} off");
    }
    let setup = dam(Model::water(3, 0.04, 0.3), [0.6, 0.16, 0.32]);
    let [on_device, reference] = beside(&setup, 0.05, 60);
    let [r, v] = distances(&on_device, &reference);
    println!("3-D: positions {r:.1e} dp, velocities {v:.1e} c0");
    assert!(r < 1e-5, "3-D: positions {r} dp off");
}

#[test]
fn a_driven_solid_agrees_with_the_reference() {
    let dp = 0.02;
    let model = Model::water(2, dp, 0.3);
    let paddle = Shape::Box { size: [4.0 * dp, 0.5].into() };
    let law = "0.05 * (1 - cos(6 * t))";
    let motion = PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::Formula(Formula::parse(law).unwrap()));
    let setup = dam(model, [0.8, 0.3]).solid(SolidSpec::driven("paddle", paddle, motion).at([0.6, 0.28]));
    let [on_device, reference] = beside(&setup, 0.02, 200);
    let [r, v] = distances(&on_device, &reference);
    println!("paddle: positions {r:.1e} dp, velocities {v:.1e} c0");
    assert!(r < 2e-4, "positions {r} dp off");
    let loads = [&on_device, &reference].map(|sim| sim.system().solids()[1].load.force);
    assert!((loads[0] - loads[1]).norm() < 1e-3 * loads[1].norm(), "loads {loads:?}");
}

#[test]
fn the_same_device_gives_the_same_bits() {
    let setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]);
    let once = || {
        let mut sim = Simulation::new(setup.clone()).unwrap().on_device(&device()).unwrap();
        (0..150).for_each(|_| sim.step().unwrap());
        let fluid = sim.system().fluid();
        let mut bits: Vec<_> = fluid.id.iter().zip(fluid.r).map(|(id, r)| (*id, r.map(f64::to_bits))).collect();
        bits.sort_unstable_by_key(|(id, _)| *id);
        bits
    };
    assert_eq!(once(), once());
}
