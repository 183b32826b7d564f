//! Steps on a device beside the reference. Without a graphics card a software driver does them: Mesa's lavapipe (Debian package
//! `mesa-vulkan-drivers`). `PONTOON_DEVICE` names another device.

#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

use std::path::Path;

use pontoon::{
    geometry::Shape,
    math::{Bivector, Matrix, Vector, expression::Formula},
    model::{
        Diffusion, KernelKind, Model, PairLoopKind, PressureGradient, Shifting, Slip, TimeScheme, Viscosity, Walls,
    },
    scene::Scene,
    simulation::{Dimension, Setup, Simulation},
    solid::{Dim, FreeBody, PrescribedMotion, SolidSpec, TimeFunction},
    sph::{
        continuity::Continuity,
        density_diffusion::Molteni,
        particle_shifting::Shift,
        trace::Trace,
        viscosity::{Artificial, Laminar, Riemann, Sps},
    },
    system::SpongeLayer,
};

#[path = "spec/water/beside_reference.rs"]
mod beside_reference;
use beside_reference::{run, sizes, under};
#[path = "device/budget.rs"]
mod budget;
#[path = "device/coupled.rs"]
mod coupled;
#[path = "device/films.rs"]
mod films;
use coupled::assert_repeats_and_resumes;
#[path = "device/forces.rs"]
mod forces;
#[path = "device/patches.rs"]
mod patches;
#[path = "device/periodic.rs"]
mod periodic;
#[path = "device/runs.rs"]
mod runs;
#[path = "device/solids.rs"]
mod solids;
#[path = "device/symmetry.rs"]
mod symmetry;
#[path = "device/thin_parts.rs"]
mod thin_parts;

fn device() -> String {
    std::env::var("PONTOON_DEVICE").unwrap_or_else(|_| "llvmpipe".into())
}

/// The same setup with the reference pair loop.
trait WithReference {
    fn with_reference(self) -> Self;
}

impl<const D: usize> WithReference for Setup<D> {
    fn with_reference(mut self) -> Self {
        self.model.pair_loop = PairLoopKind::Reference;
        self
    }
}

/// A dam break in a tank.
fn dam<const D: usize>(model: Model, size: [f64; D]) -> Setup<D> {
    dam_with(model, size, [])
}

/// The same with bodies, which displace water.
fn dam_with<const D: usize>(model: Model, size: [f64; D], bodies: impl IntoIterator<Item = SolidSpec<D>>) -> Setup<D> {
    let dp = model.dp;
    let tank: [f64; D] = std::array::from_fn(|i| if i == D - 1 { 1.6 * size[i] } else { size[i] });
    let column: [f64; D] = std::array::from_fn(|i| if i == 0 { 0.4 * size[0] } else { size[i] });
    let walls = SolidSpec::fixed("tank", Shape::Tank { size: tank.into(), thickness: 4.0 * dp });
    let setup = bodies.into_iter().fold(Setup::new(model).solid(walls), Setup::solid);
    setup.fill_box([0.0; D], column).expect("water")
}

/// Asserts that a force pass on the device agrees with the reference on one state, by the bounds of the SIMD pair loop.
fn assert_rates_agree<const D: usize>(name: &str, setup: &Setup<D>, state: &[u8])
where
    Dim<D>: Dimension<D>,
{
    let reference = under(setup, PairLoopKind::Reference, state);
    let expected = reference.system();
    let n = expected.fluid().len();
    let sizes: Vec<(f64, f64)> = (0..n).map(|i| sizes(&reference, i)).collect();
    let most = sizes.iter().fold((0.0f64, 0.0f64), |m, s| (m.0.max(s.0), m.1.max(s.1)));
    let all_forces: f64 = sizes.iter().map(|s| s.0).sum::<f64>() * expected.particle_mass();
    // The stress that acts is that of the pass before: no pass comes between.
    let mut on_device = Simulation::new(setup.clone()).expect("a sound setup");
    on_device.restore(state).expect("the same scene");
    let mut on_device = on_device.on_device(&device()).expect("a device");
    let (rates, limits) = on_device.device_rates().expect("rates").expect("a device");
    let (mut worst, mut worst_rate) = (0.0f64, 0.0f64);
    for (i, size) in sizes.iter().enumerate() {
        // A particle beyond a symmetry plane is its image on the device, which has new lists.
        let r = expected.fluid().r[i];
        let is_image = |k: usize| setup.symmetry[k].is_some() && expected.wrapped(&r)[k] != r[k];
        let of_device = Vector::from_fn(|k, _| rates[i].acceleration[k] * if is_image(k) { -1.0 } else { 1.0 });
        let dv = (of_device - expected.fluid_acceleration(i)).norm();
        let drho = (rates[i].compression_rate * expected.model().rho0 - expected.fluid_density_rate(i)).abs();
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
            ("no slip", base().viscosity(Viscosity::Laminar(Laminar { nu0: 1e-3 })).slip(Slip::None)),
            ("cubic", base().kernel(KernelKind::Cubic { tensile: false })),
            ("dynamic walls", base().walls(Walls::Dynamic)),
            ("tensile", base().kernel(KernelKind::Cubic { tensile: true })),
            ("sps", base().viscosity(Viscosity::Sps(Sps::default()))),
            ("shifting", base().shifting(Shifting::AwayFromSolids(Shift::default()))),
            (
                "sps, shifting",
                base().viscosity(Viscosity::Sps(Sps::default())).shifting(Shifting::Everywhere(Shift::default())),
            ),
            ("corrected", base().gradient(PressureGradient::Corrected)),
            ("near surface", base().for_waves()),
        ];
        for (name, model) in cases {
            let setup = dam(model, size);
            // Gradients are corrected for the places of the lists, which are new at the start.
            let until = if setup.model.gradient == PressureGradient::Plain { 0.05 } else { 0.0 };
            assert_rates_agree(&format!("{D}-D, {name}"), &setup, &run(&setup, until));
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
    let (fluid_a, fluid_b, reference) = (a.system().fluid(), b.system().fluid(), b.system());
    let mut sums = [0.0; 2];
    // Across a periodic side a particle may be a period away: not both it and the same place ten rows on lie at a side.
    let way = |a: &Vector<D>, b: &Vector<D>, on: f64| {
        let [a, b] = [a, b].map(|x| reference.wrapped(&(x + Vector::repeat(on))));
        a - b
    };
    let apart = |a: &Vector<D>, b: &Vector<D>| {
        let ways = [0.0, 10.0 * model.dp].map(|on| way(a, b, on));
        Vector::<D>::from_fn(|k, _| if ways[0][k].abs() < ways[1][k].abs() { ways[0][k] } else { ways[1][k] })
    };
    for (i, j) in in_a.into_iter().zip(in_b) {
        sums[0] += (apart(&fluid_a.r[i], &fluid_b.r[j]) / model.dp).norm_squared();
        sums[1] += ((fluid_a.v[i] - fluid_b.v[j]) / model.c0).norm_squared();
    }
    sums.map(|sum| (sum / n as f64).sqrt())
}

/// Steps of the device and of the reference from `start` (s) on.
fn beside<const D: usize>(setup: &Setup<D>, start: f64, steps: usize) -> [Simulation<D>; 2]
where
    Dim<D>: Dimension<D>,
{
    beside_with(setup, start, steps, |_, _| {})
}

/// The same, with a look at both after each step.
fn beside_with<const D: usize>(
    setup: &Setup<D>,
    start: f64,
    steps: usize,
    mut look: impl FnMut(&Simulation<D>, &Simulation<D>),
) -> [Simulation<D>; 2]
where
    Dim<D>: Dimension<D>,
{
    let state = run(setup, start);
    let mut reference = under(setup, PairLoopKind::Reference, &state);
    let mut on_device = under(setup, PairLoopKind::Fast, &state).on_device(&device()).expect("a device");
    for _ in 0..steps {
        reference.step().expect("a sound run");
        on_device.step().expect("a sound run");
        look(&on_device, &reference);
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
        assert!(time.abs() < 1e-5, "{scheme:?}: time {time} off");
    }
    let setup = dam(Model::water(3, 0.04, 0.3), [0.6, 0.16, 0.32]);
    let [on_device, reference] = beside(&setup, 0.05, 60);
    let [r, v] = distances(&on_device, &reference);
    println!("3-D: positions {r:.1e} dp, velocities {v:.1e} c0");
    assert!(r < 1e-5, "3-D: positions {r} dp off");
}

#[test]
fn stress_shifting_corrections_and_sponge_layers_step_as_the_reference_does() {
    let dp = 0.02;
    let base = || Model::water(2, dp, 0.3);
    let cases = [
        ("sps", base().viscosity(Viscosity::Sps(Sps::default()))),
        ("shifting", base().shifting(Shifting::AwayFromSolids(Shift::default()))),
        ("corrected near the surface", base().gradient(PressureGradient::NearSurface)),
    ];
    let layer = SpongeLayer { from: [0.2, 0.0].into(), to: [0.6, 0.0].into(), strength: 5.0, power: 2.0 };
    for (name, model) in cases {
        let mut setup = dam(model, [0.8, 0.3]);
        setup.sponge_layers.push(layer);
        let [on_device, reference] = beside(&setup, 0.02, 100);
        let [r, v] = distances(&on_device, &reference);
        println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0");
        // Corrections are made anew at each list and every 20th pass, which both count from other lists.
        let bound = if name.starts_with("corrected") { 2e-3 } else { 1e-4 };
        assert!(r < bound, "{name}: positions {r} dp off");
    }
}

#[test]
fn a_driven_solid_agrees_with_the_reference() {
    let dp = 0.02;
    let model = Model::water(2, dp, 0.3);
    let paddle = Shape::Box { size: [4.0 * dp, 0.5].into() };
    let law = "0.05 * (1 - cos(6 * t))";
    let motion = PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::Formula(Formula::parse(law).unwrap()));
    let setup = dam(model, [0.8, 0.3]).solid(SolidSpec::driven("paddle", paddle, motion).at([0.38, 0.28]));
    let [on_device, reference] = beside(&setup, 0.02, 200);
    let [r, v] = distances(&on_device, &reference);
    println!("paddle: positions {r:.1e} dp, velocities {v:.1e} c0");
    assert!(r < 2e-4, "positions {r} dp off");
    let loads = [&on_device, &reference].map(|sim| sim.system().solids()[1].load.force);
    assert!((loads[0] - loads[1]).norm() < 1e-3 * loads[1].norm(), "loads {loads:?}");
}

#[test]
fn water_that_sticks_to_faces_steps_as_the_reference_does() {
    // A box that turns as it falls drags the water around it along.
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    let base = || Model::water(2, 0.02, 0.3).viscosity(Viscosity::Laminar(Laminar { nu0: 2e-3 })).for_free_bodies();
    let setup = |model: Model| {
        let mut body = FreeBody::from_density(&Shape::Box { size: [0.2, 0.2].into() }, 900.0);
        body.spin = Bivector::from_axial(&[6.0]);
        let body = SolidSpec::with_body("box", Shape::Box { size: [0.2, 0.2].into() }, body).at([0.15, 0.3]);
        dam_with(model, [0.8, 0.3], [body])
    };
    for (name, model) in [
        ("symplectic", base()),
        ("Verlet", base().scheme(verlet).cfl(0.2)),
        ("dynamic walls", base().walls(Walls::Dynamic)),
    ] {
        let setup_of = |slip| setup(model.clone().slip(slip));
        let [on_device, reference] = beside(&setup_of(Slip::None), 0.02, 200);
        let [r, v] = distances(&on_device, &reference);
        let [_, partial] = beside(&setup_of(Slip::Partial), 0.02, 200);
        let [away, _] = distances(&partial, &reference);
        println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0; {away:.1e} dp from partial slip");
        // The bound of free bodies.
        assert!(r < 1e-3 && away > 1e-2, "{name}: positions {r} dp off, and {away} dp from partial slip");
    }
    assert_repeats_and_resumes("no slip", &setup(base().slip(Slip::None)), 200, 1e-3);
}

/// Bodies that fall into water and onto each other, beside a wall.
fn falling_boxes(walls: Walls) -> Setup<2> {
    let dp = 0.02;
    let model = Model::water(2, dp, 0.3).for_free_bodies().walls(walls);
    // Ten rows: smaller bodies are light.
    let hull = || Shape::Box { size: [0.2, 0.2].into() };
    let lower = SolidSpec::free("lower", hull(), 900.0).at([0.14, 0.42]);
    dam_with(model, [0.8, 0.3], [lower, SolidSpec::free("upper", hull(), 900.0).at([0.17, 0.64])])
}

#[test]
fn free_bodies_agree_with_the_reference() {
    for walls in [Walls::Dynamic, Walls::RelaxedAdami] {
        let setup = falling_boxes(walls);
        let [on_device, reference] = beside(&setup, 0.02, 400);
        let [r, v] = distances(&on_device, &reference);
        let centres = [&on_device, &reference].map(|sim| sim.system().solids()[1].kinematics.centre);
        let off = (centres[0] - centres[1]).norm() / 0.02;
        println!("{walls:?}: positions {r:.1e} dp, velocities {v:.1e} c0, body {off:.1e} dp, at {:?}", centres[1]);
        // Contacts of the engine make the motion as sensitive as the water.
        assert!(r < 1e-3 && off < 1e-3, "{walls:?}: water {r} dp, body {off} dp off");
    }
}

#[test]
fn gaps_beside_free_bodies_carry_the_same_pressure() {
    // A box one to two rows above the bed, where there is no film: without the pressure across the gap it would sink.
    let dp = 0.02;
    let model = Model::water(2, dp, 0.3).for_free_bodies();
    let body = SolidSpec::free("box", Shape::Box { size: [0.2, 0.2].into() }, 950.0).at([0.15, 0.13]);
    let setup = dam_with(model, [0.8, 0.3], [body]);
    let [on_device, reference] = beside(&setup, 0.02, 70);
    let heights = [&on_device, &reference].map(|sim| sim.system().solids()[1].kinematics.centre[1]);
    println!("heights {heights:?}");
    assert!(heights.iter().all(|height| height - 0.1 > dp), "the gap has a row: {heights:?}");
    assert!((heights[0] - heights[1]).abs() < 1e-3 * dp, "{heights:?}");
}

#[test]
fn lists_that_are_too_short_are_made_longer() {
    // Particles nine tenths of dp apart have a quarter more neighbours than the lists have room for at first.
    let dp = 0.02;
    let model = Model::water(2, dp, 0.3).for_free_bodies();
    let spacing = 0.9 * dp;
    let places =
        (0..16).flat_map(|i| (0..14).map(move |j| Vector::from([f64::from(i) + 0.5, f64::from(j) + 0.5]) * spacing));
    let walls = SolidSpec::fixed("tank", Shape::Tank { size: [0.8, 0.5].into(), thickness: 4.0 * dp });
    let body = SolidSpec::free("box", Shape::Box { size: [0.2, 0.2].into() }, 900.0).at([0.5, 0.12]);
    let setup = Setup::new(model).solid(walls).solid(body).water(places, 0.26);
    let [on_device, reference] = beside(&setup, 0.0, 30);
    let [r, v] = distances(&on_device, &reference);
    println!("positions {r:.1e} dp, velocities {v:.1e} c0");
    assert!(r < 1e-4, "{r} dp off");
}

#[test]
fn an_alarm_goes_back_and_halves_the_step() {
    // The water of a dam break passes 0.06 c0 in any case: the second alarm, with half the step, ends the run.
    let mut setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]);
    setup.limits = setup.limits.speed(0.06);
    let last = |mut sim: Simulation<2>| {
        let error = (0..2000).find_map(|_| sim.step().err()).expect("an alarm");
        (error.fault.expect("a fault").time, sim.steps(), sim.rollbacks().len())
    };
    let reference = last(Simulation::new(setup.clone().with_reference()).unwrap());
    let found = last(Simulation::new(setup).unwrap().on_device(&device()).unwrap());
    println!("{found:?}, reference {reference:?}");
    assert_eq!(found.2, 1, "one rollback");
    assert!((found.0 / reference.0 - 1.0).abs() < 1e-3, "{found:?} against {reference:?}");
    // Both go back to the start, and take half steps from there to the alarm.
    assert!(found.1.abs_diff(reference.1) <= 2, "{found:?} against {reference:?}");
}

#[test]
fn what_no_device_computes_is_refused_with_the_remedy() {
    let refused_setup = |setup: Setup<2>| {
        let error = Simulation::new(setup).unwrap().on_device(&device()).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("leave --device (model.device) out"), "{error}");
        error.message
    };
    let water = || Model::water(2, 0.05, 0.3);
    let tank_of = |model: Model| dam(model, [0.8, 0.3]);
    let dam = || tank_of(water());
    assert!(refused_setup(tank_of(water().gamma(8.0))).contains("gamma"));
    let mut fast = dam();
    fast.limits = fast.limits.density(0.4, 1.2);
    assert!(refused_setup(fast).contains("density limits"));
    assert!(refused_setup(dam().with_reference()).contains("double precision"));
    let shelf = SolidSpec::fixed("shelf", Shape::Box { size: [0.16, 0.01].into() }).at([0.16, 0.09]);
    assert!(refused_setup(dam_with(water(), [0.8, 0.3], [shelf])).contains("thinner than dp"));
    let stream = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec/run/restart/stream.toml");
    assert!(refused_setup(Scene::read(&stream, &[]).unwrap().build().unwrap().setup).contains("[[outflow]]"));
    let error = Simulation::new(dam()).unwrap().on_device("no such card").map(|_| ()).unwrap_err();
    assert!(error.message.contains("no such card"), "{error}");
}

#[test]
fn without_a_driver_the_error_says_what_to_install() {
    let this = "without_a_driver_the_error_says_what_to_install";
    let setup = dam(Model::water(2, 0.05, 0.3), [0.8, 0.3]);
    let error = || Simulation::new(setup).unwrap().on_device("gpu").map(|_| ()).unwrap_err();
    if std::env::var_os("PONTOON_NO_DRIVER").is_some() {
        let error = error();
        assert!(error.message.contains("no graphics card was found"), "{error}");
        assert!(error.to_string().contains("libvulkan1") && error.to_string().contains("Without --device"), "{error}");
        return;
    }
    // A process finds its drivers once: another one finds none.
    let mut other = std::process::Command::new(std::env::current_exe().unwrap());
    other.args([this, "--exact"]).env("PONTOON_NO_DRIVER", "1");
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        other.env(variable, "/no/driver");
    }
    let told = other.output().unwrap();
    assert!(
        told.status.success(),
        "{}{}",
        String::from_utf8_lossy(&told.stdout),
        String::from_utf8_lossy(&told.stderr)
    );
    // A software driver is no graphics card, unless it is named.
    if pontoon::device::adapters().iter().all(|adapter| adapter.is_software) {
        let error = error();
        assert!(error.message.contains("there is no device \"gpu\"") && error.to_string().contains("0: "), "{error}");
    }
}

#[test]
fn what_is_set_by_hand_reaches_the_device_and_hooks_are_called() {
    let setup = dam(Model::water(2, 0.04, 0.3), [0.8, 0.28]);
    let mut on_device = Simulation::new(setup.clone()).unwrap().on_device(&device()).unwrap();
    let mut reference = Simulation::new(setup.with_reference()).unwrap();
    let mut calls = 0;
    for sim in [&mut on_device, &mut reference] {
        sim.step().unwrap();
        sim.set_water_velocity(|r| Vector::from([0.2 * r[1], 0.0]));
        let end = sim.time() + 1.0;
        sim.step_with(end, |step| {
            calls += 1;
            assert!(step.loads()[0].force.norm() > 0.0);
            Ok(())
        })
        .unwrap();
        sim.step().unwrap();
    }
    assert_eq!(calls, 2, "one call a simulation");
    let [r, v] = distances(&on_device, &reference);
    assert!(r < 1e-6 && v < 1e-6, "{r} dp, {v} c0 off");
}

#[test]
fn pair_terms_of_your_own_are_refused() {
    let setup = dam(Model::water(2, 0.05, 0.3), [0.8, 0.3]);
    let own = setup.model.custom_pair_loop::<_, _, 2>(|_, _| (Continuity, Continuity));
    let sim = Simulation::with_pair_loop(setup, own).unwrap();
    let error = sim.on_device(&device()).map(|_| ()).unwrap_err();
    assert!(error.message.contains("pair terms of your own"), "{error}");
}

#[test]
fn a_checkpoint_goes_from_a_device_to_the_processor_and_back() {
    let setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]);
    let mut on_device = Simulation::new(setup.clone()).unwrap().on_device(&device()).unwrap();
    (0..60).for_each(|_| on_device.step().unwrap());
    let state = on_device.save().unwrap();
    let mut on_processor = Simulation::new(setup.clone()).unwrap();
    on_processor.restore(&state).unwrap();
    let mut resumed = Simulation::new(setup).unwrap();
    resumed.restore(&on_processor.save().unwrap()).unwrap();
    let mut resumed = resumed.on_device(&device()).unwrap();
    for _ in 0..60 {
        [&mut on_device, &mut on_processor, &mut resumed].into_iter().for_each(|sim| sim.step().unwrap());
    }
    for other in [&on_processor, &resumed] {
        let [r, v] = distances(&on_device, other);
        println!("positions {r:.1e} dp, velocities {v:.1e} c0");
        assert!(r < 1e-5, "{r} dp off");
        assert!((on_device.time() / other.time() - 1.0).abs() < 1e-6);
    }
}

/// All choices of laws.
fn every_choice<const D: usize>(dp: f64) -> Vec<Model> {
    let base = Model::water(D, dp, 0.3);
    let kernels = [KernelKind::Wendland, KernelKind::Cubic { tensile: false }, KernelKind::Cubic { tensile: true }];
    let viscosities = [
        Viscosity::None,
        Viscosity::Artificial(Artificial::default()),
        Viscosity::Riemann(Riemann { threshold: Some(0.05), ..Riemann::default() }),
        Viscosity::Laminar(Laminar { nu0: 1e-4 }),
        Viscosity::Sps(Sps::default()),
    ];
    let diffusions = [Diffusion::None, Diffusion::Molteni(Molteni { delta: 0.1 }), base.diffusion];
    let mut all = Vec::new();
    for kernel in kernels {
        for viscosity in viscosities {
            for diffusion in diffusions {
                let model = base.clone().kernel(kernel).viscosity(viscosity).diffusion(diffusion);
                all.push(model.clone().slip(Slip::Partial));
                all.push(model.clone().shifting(Shifting::Everywhere(Shift::default())));
                if kernel == KernelKind::Wendland {
                    all.push(model.clone().gradient(PressureGradient::Corrected));
                }
                all.push(model);
            }
        }
    }
    all
}

/// Evaluates the traces over all neighbours of some water particles, beside the reference.
fn assert_traces_agree<const D: usize>(dp: f64, size: [f64; D])
where
    Dim<D>: Dimension<D>,
{
    for model in every_choice::<D>(dp) {
        let name = format!(
            "{:?} {:?} {:?} {:?} {:?}",
            model.kernel, model.viscosity, model.diffusion, model.shifting, model.gradient
        );
        let (traces, units) = model.pair_traces::<D>(false).expect("traces");
        // Some steps give the water stress, and gradients their corrections.
        let mut setup = dam(model.clone(), size);
        setup.model.dt_max = 5e-4;
        let sim = under(&setup, PairLoopKind::Reference, &run(&setup, 0.01));
        let system = sim.system();
        let (fluid, boundary) = (system.fluid(), system.boundary());
        let (length, speed) = (units.length, units.length / units.time);
        let compression = |rho: f64| rho / model.rho0 - 1.0;
        let mut worst = 0.0f64;
        for a in (0..fluid.len()).step_by(fluid.len() / 12) {
            let mut sums = vec![0.0; traces.rows[1]];
            let mut approach = 0.0;
            let of_a = system.pair_tensors(a);
            let mut add = |trace: &Trace,
                           (r, v, rho): (&Vector<D>, &Vector<D>, f64),
                           of_b: [Matrix<D>; 2],
                           sums: &mut Vec<f64>| {
                let (x_a, x_b) = (compression(fluid.rho[a]), compression(rho));
                let pressure = |rho: f64| system.pressure(rho) / model.rho0 / speed.powi(2);
                let repulsion = |rho: f64, x: f64| {
                    let p = pressure(rho);
                    (if p < 0.0 { -0.2 } else { 0.01 }) * p / (1.0 + x).powi(2)
                };
                let read = |input: &str| match input {
                    "difference" => x_b - x_a,
                    "approach" => approach,
                    "a_compression" => x_a,
                    "b_compression" => x_b,
                    "a_pressure" => pressure(fluid.rho[a]),
                    "b_pressure" => pressure(rho),
                    "a_volume" => 1.0 / (1.0 + x_a),
                    "b_volume" => 1.0 / (1.0 + x_b),
                    _ if input.starts_with("slope") => {
                        let k: usize = input[5..].parse().unwrap();
                        system.gravity()[k] / model.c0.powi(2) * length
                    }
                    _ if input.starts_with("sum") => sums[input[3..].parse::<usize>().unwrap()],
                    _ if input.contains("_row") => {
                        let (row, of_own) = (input[5..].parse::<usize>().unwrap(), input.starts_with('a'));
                        let [stress, correction] = if of_own { of_a } else { of_b };
                        let entry = |first: Option<usize>, tensor: Matrix<D>| {
                            let n = row.checked_sub(first?)?;
                            let mut entries = (0..D).flat_map(|i| (0..=i).map(move |j| (i, j)));
                            entries.nth(n).map(|at| tensor[at])
                        };
                        let layout = &traces.layout;
                        match layout.repulsion == Some(row) {
                            true if of_own => repulsion(fluid.rho[a], x_a),
                            true => repulsion(rho, x_b),
                            // Else it is a mark, which suppresses shifting.
                            false => entry(layout.correction, correction)
                                .or_else(|| entry(layout.stress, stress / speed.powi(2)))
                                .unwrap_or(0.0),
                        }
                    }
                    _ => {
                        let k: usize = input[1..].parse().unwrap();
                        if input.starts_with('r') {
                            (fluid.r[a][k] - r[k]) / length
                        } else {
                            (fluid.v[a][k] - v[k]) / speed
                        }
                    }
                };
                let results = trace.evaluate(read);
                for (name, x) in results {
                    match name.strip_prefix("sum") {
                        Some(row) => sums[row.parse::<usize>().unwrap()] = x,
                        None => approach = x,
                    }
                }
            };
            system.visit_fluid_near(&fluid.r[a], &mut |b, r, _| {
                if b != a {
                    add(&traces.fluid, (r, &fluid.v[b], fluid.rho[b]), system.pair_tensors(b), &mut sums);
                }
            });
            system.visit_boundary_near(&fluid.r[a], &mut |b, r, _| {
                add(&traces.wall, (r, &boundary.v[b], boundary.rho[b]), [Matrix::zeros(); 2], &mut sums)
            });
            let acceleration = Vector::<D>::from_fn(|k, _| sums[k] * speed / units.time) + system.gravity();
            // Corrections make the terms of a gradient larger.
            let (force, rate) = sizes(&sim, a);
            let force = force * (1.0 + of_a[1].norm());
            let off = (acceleration - sim.system().fluid_acceleration(a)).norm() / force.max(1.0);
            let off_rate =
                (sums[D] / units.time - sim.system().fluid_density_rate(a) / model.rho0).abs() / rate.max(1e-3);
            worst = worst.max(off).max(off_rate);
        }
        // Double precision; the constants of both are rounded in other units.
        assert!(worst < 1e-6, "{name}: {worst:.1e} off");
    }
}

#[test]
fn traces_evaluate_to_the_sums_of_the_reference() {
    assert_traces_agree(0.04, [0.8, 0.28]);
    assert_traces_agree(0.08, [0.64, 0.16, 0.32]);
}

#[test]
fn a_pair_takes_no_more_operations_than_before() {
    // Arithmetic of a pair in gather form after the differences, by the trace; these may only fall.
    let count = |model: Model, dimension: usize| {
        let traces = if dimension == 2 {
            model.pair_traces::<2>(false).unwrap().0
        } else {
            model.pair_traces::<3>(false).unwrap().0
        };
        [traces.fluid.count(), traces.wall.count(), traces.extrapolation.count()]
    };
    let of = |dimension| {
        let base = || Model::water(dimension, 0.02, 0.3);
        let sps = || base().viscosity(Viscosity::Sps(Sps::default()));
        [
            base(),
            base().for_free_bodies(),
            base().viscosity(Viscosity::Artificial(Artificial::default())),
            base().viscosity(Viscosity::Laminar(Laminar { nu0: 1e-4 })).slip(Slip::Partial),
            sps(),
            sps().shifting(Shifting::Everywhere(Shift::default())),
            base().kernel(KernelKind::Cubic { tensile: false }),
            base().kernel(KernelKind::Cubic { tensile: true }),
            base().gradient(PressureGradient::Corrected),
        ]
        .map(|model| count(model, dimension))
    };
    let counts = [of(2), of(3)];
    println!("operations of a pair of water, of water and wall, and of an extrapolation: {counts:?}");
    let most = COUNTS;
    for (found, most) in counts.as_flattened().as_flattened().iter().zip(most.as_flattened().as_flattened()) {
        assert!(found <= most, "{counts:?} against {most:?}");
    }
}

/// Operations in 2-D and in 3-D of the defaults, with free bodies, artificial viscosity, laminar viscosity and partial slip, sub-particle
/// stress, the same with shifting, the cubic kernel, the same with tensile correction, and corrected gradients.
const COUNTS: [[[usize; 3]; 9]; 2] = [
    [
        [43, 36, 17],
        [41, 36, 17],
        [41, 36, 17],
        [43, 42, 17],
        [62, 55, 17],
        [66, 60, 17],
        [48, 41, 23],
        [59, 52, 23],
        [60, 36, 17],
    ],
    [
        [47, 40, 20],
        [45, 40, 20],
        [45, 40, 20],
        [48, 47, 20],
        [85, 77, 20],
        [90, 83, 20],
        [52, 45, 26],
        [63, 56, 26],
        [79, 40, 20],
    ],
];

#[test]
fn the_traced_equations_are_the_recorded_ones() {
    let base = || Model::water(3, 0.05, 0.3);
    let stress = base().viscosity(Viscosity::Sps(Sps::default())).shifting(Shifting::Everywhere(Shift::default()));
    for (name, model) in [
        ("traces-3d.wgsl", base()),
        ("traces-3d-sps-shifting.wgsl", stress),
        ("traces-3d-corrected.wgsl", base().gradient(PressureGradient::Corrected)),
    ] {
        let setup = dam(model, [0.6, 0.2, 0.3]);
        let shader = pontoon::device::shaders_of(Simulation::new(setup).unwrap().system(), false).unwrap().sweep;
        // Only traces have names of a letter and a number.
        let is_traced = |line: &&str| {
            let name = line.strip_prefix("let ").and_then(|rest| rest.split(' ').next()).unwrap_or("");
            name.starts_with("out_") || name.len() > 1 && name[1..].bytes().all(|c| c.is_ascii_digit())
        };
        let text: String = shader.lines().map(str::trim).filter(is_traced).map(|line| format!("{line}\n")).collect();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        let recorded = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(text == recorded, "{name}: the equations have changed: UPDATE_GOLDEN=1 records them");
    }
}

/// Other makers' languages.
#[cfg(feature = "shader-check")]
#[test]
fn every_shader_is_valid_and_translates_to_metal_and_hlsl() {
    use naga::{back, front, valid};
    fn check<const D: usize>(dp: f64, size: [f64; D])
    where
        Dim<D>: Dimension<D>,
    {
        let mut checked = 0;
        for model in every_choice::<D>(dp) {
            // Half of them with a free body, the others with a symmetry plane or periodic sides, beyond which the walls end, and with
            // what the host reads of the water.
            let middle = size.map(|x| 0.5 * x);
            let body = || SolidSpec::free("body", Shape::Box { size: middle.into() }, 500.0).at(middle);
            let mut setup = dam_with(model, size, (checked % 2 == 0).then(body));
            if checked % 4 == 1 {
                setup.model.slip = Slip::None;
            }
            if checked % 3 == 2 {
                setup = setup.symmetry_plane(0, 0.5 * size[0]);
            } else if checked % 2 == 1 {
                let width = 4.0 * size[0];
                setup = setup.periodic(0, -width, width);
            }
            let sim = Simulation::new(setup).unwrap();
            let Ok(texts) = pontoon::device::shaders_of(sim.system(), checked % 2 == 1) else { continue };
            checked += 1;
            let all = [&texts.search, &texts.lists, &texts.sweep, &texts.step, &texts.solids];
            let optional = [&texts.images, &texts.gaps, &texts.films];
            for text in all
                .into_iter()
                .chain(optional.into_iter().flatten())
                .chain(&texts.inputs)
                .chain(&texts.moments)
                .chain(&texts.near)
                .chain(&texts.sticks)
                .chain(&texts.powers)
            {
                let module = front::wgsl::parse_str(text).expect("WGSL");
                let mut validator =
                    valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::default());
                let info = validator.validate(&module).expect("a valid shader");
                let options = back::msl::Options::default();
                back::msl::write_string(&module, &info, &options, &back::msl::PipelineOptions::default())
                    .expect("Metal");
                let mut out = String::new();
                let (options, pipeline) = (back::hlsl::Options::default(), back::hlsl::PipelineOptions::default());
                back::hlsl::Writer::new(&mut out, &options, &pipeline).write(&module, &info, None).expect("HLSL");
            }
        }
        assert!(checked >= 24, "{checked} choices of laws");
    }
    check(0.1, [0.8, 0.3]);
    check(0.1, [0.6, 0.2, 0.3]);
}

#[test]
fn the_processor_waits_for_no_step_of_fixed_solids_and_twice_in_a_step_beside_bodies() {
    // A look at the water, the loads and the sums at the end comes beside these.
    let waits = |setup: Setup<2>, end: f64| {
        let mut sim = Simulation::new(setup).unwrap().without_rollback().on_device(&device()).unwrap();
        let (mut calls, before) = (0, sim.device_waits().unwrap());
        while sim.time() < end {
            sim.step_to_pause(end, 1.0).unwrap();
            calls += 1;
        }
        (sim.device_waits().unwrap() - before, calls, sim.steps())
    };
    let (found, calls, steps) = waits(dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]), 0.1);
    println!("fixed solids: {found} waits in {steps} steps");
    assert!(found == calls && 2 * calls < steps, "one at the end of {calls} submissions with {steps} steps: {found}");
    // Ten bodies, some of which touch.
    let hull = || Shape::Box { size: [0.2, 0.2].into() };
    let at = |i: u32| [0.14 + 0.21 * f64::from(i % 5), if i < 5 { 0.42 } else { 0.63 }];
    let boxes = (0..10).map(|i| SolidSpec::free(format!("box {i}"), hull(), 900.0).at(at(i)));
    let (found, calls, steps) = waits(dam_with(Model::water(2, 0.02, 0.3).for_free_bodies(), [2.8, 0.3], boxes), 0.02);
    println!("bodies: {found} waits in {steps} steps");
    assert!(calls == steps && found == 2 * steps, "{found} in {steps} steps");
}

#[test]
fn a_particle_takes_no_more_memory_than_was_allowed() {
    let bytes = |dimension| {
        let case = pontoon::bench::BenchCase::with_defaults(dimension, 30_000);
        pontoon::bench::time_on_device(&case, &device()).unwrap().bytes
    };
    let [flat, space] = [bytes(2), bytes(3)];
    println!("bytes of a particle without and with lists: 2-D {flat:?}, 3-D {space:?}");
    assert!(space[0] <= 320.0 && space[1] <= 950.0, "{space:?}");
    assert!(flat[0] <= 320.0 && flat[1] <= 500.0, "{flat:?}");
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
