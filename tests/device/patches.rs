//! Forces and pressures on parts of faces: the host reads the sums of the boundary particles where a probe is due.

use pontoon::{
    model::{Model, PairLoopKind, TimeScheme, Walls},
    probe::{PatchProbe, Probe as _},
    simulation::{Dimension, Setup, Simulation},
    solid::{Dim, PrescribedMotion, SolidSpec},
};

use super::{Shape, beside, dam, dam_with, device, forces::law, run, symmetry::floating, under};

/// Readings of the part of `solid` between `min` and `max` (m) on the device, and of the reference.
fn readings<const D: usize>(
    sims: [&Simulation<D>; 2],
    setup: &Setup<D>,
    (solid, min, max): (&str, [f64; D], [f64; D]),
) -> [Vec<f64>; 2]
where
    Dim<D>: Dimension<D>,
{
    // The part is that of the start.
    let start = Simulation::new(setup.clone()).expect("a sound setup");
    let probe = PatchProbe::new(start.system(), solid, &min, &max).expect("a part of a face");
    sims.map(|sim| probe.sample(sim))
}

/// Asserts that a patch has the force and the pressures of the reference: in a force pass on one state after `start` (s), and after
/// `steps` steps.
fn assert_patches_agree<const D: usize>(
    name: &str,
    setup: &Setup<D>,
    (start, steps): (f64, usize),
    patch: (&str, [f64; D], [f64; D]),
) where
    Dim<D>: Dimension<D>,
{
    let state = run(setup, start);
    let reference = under(setup, PairLoopKind::Reference, &state);
    let mut on_device = Simulation::new(setup.clone()).unwrap();
    on_device.restore(&state).unwrap();
    let mut on_device = on_device.on_device(&device()).expect("a device");
    on_device.device_rates().unwrap();
    on_device.fetch_from_device().unwrap();
    let weight = reference.system().fluid().len() as f64 * reference.system().particle_mass() * 9.81;
    let check = |what: &str, sims: [&Simulation<D>; 2], bound: f64| {
        let [here, there] = readings(sims, setup, patch);
        let off = (0..D).map(|k| (here[k] - there[k]).abs()).fold(0.0, f64::max) / weight;
        let size = (0..D).map(|k| there[k].abs()).fold(0.0, f64::max) / weight;
        let pressure = (D..D + 2).map(|k| (here[k] / there[k] - 1.0).abs()).fold(0.0, f64::max);
        println!("{name}, {what}: force {size:.2e} of the weight, {off:.1e} off; pressures {pressure:.1e} off");
        assert!(off < bound, "{name}, {what}: {here:?} and {there:?}, of a weight of {weight} N");
        assert!(pressure < 1e-3, "{name}, {what}: {here:?} and {there:?}");
        assert!(size > 10.0 * bound, "{name}, {what}: a force of {size} of the weight tells nothing");
    };
    // Sums over pairs are in single precision; the bound of films.
    check("one pass", [&on_device, &reference], 1e-5);
    let [on_device, reference] = beside(setup, start, steps);
    // The bound of the load on a driven solid.
    check("steps", [&on_device, &reference], 1e-3);
}

#[test]
fn forces_on_patches_agree_with_the_reference() {
    let water = || Model::water(2, 0.02, 0.3);
    let bed = ("tank", [-0.01, -0.01], [0.2, 0.01]);
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    for (name, model) in [
        ("symplectic", water()),
        ("Verlet", water().scheme(verlet).cfl(0.2)),
        ("dynamic walls", water().walls(Walls::Dynamic)),
    ] {
        assert_patches_agree(name, &dam(model, [0.8, 0.3]), (0.1, 100), bed);
    }
    let wall = ("tank", [-0.01, -0.01, -0.01], [0.01, 0.17, 0.33]);
    assert_patches_agree("in space", &dam(Model::water(3, 0.04, 0.3), [0.6, 0.16, 0.32]), (0.05, 30), wall);
}

#[test]
fn forces_on_patches_of_moving_solids_agree_with_the_reference() {
    let law = law("0.05 * (1 - cos(6 * t))");
    let motion = PrescribedMotion::slide([1.0, 0.0].into(), law);
    let paddle = SolidSpec::driven("paddle", Shape::Box { size: [0.08, 0.5].into() }, motion).at([0.38, 0.28]);
    let setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]).solid(paddle);
    assert_patches_agree("paddle", &setup, (0.1, 100), ("paddle", [0.33, 0.04], [0.35, 0.4]));
    let hull = Shape::Box { size: [0.2, 0.2].into() };
    let body = SolidSpec::free("box", hull, 500.0).at([0.14, 0.32]);
    let setup = dam_with(Model::water(2, 0.02, 0.3).for_free_bodies(), [0.8, 0.3], [body]);
    assert_patches_agree("box", &setup, (0.05, 100), ("box", [0.03, 0.21], [0.25, 0.23]));
    // A body that a plane cuts: the patch is on both sides.
    let setup = floating("{ box = { size = [0.18, 0.1] } }", 500.0);
    assert_patches_agree("on a plane", &setup, (0.02, 100), ("box", [0.3, 0.2], [0.5, 0.34]));
}

#[test]
fn forces_on_a_whole_solid_add_up_to_its_load() {
    let setup = dam(Model::water(2, 0.02, 0.3), [0.8, 0.3]);
    let mut sim = Simulation::new(setup).unwrap().on_device(&device()).unwrap();
    let probe = PatchProbe::new(sim.system(), "tank", &[-0.1, -0.1], &[0.9, 0.6]).unwrap();
    (0..60).for_each(|_| sim.step().unwrap());
    let (row, load) = (probe.sample(&sim), sim.system().solids()[0].load.force);
    let off = (0..2).map(|k| (row[k] - load[k]).abs()).fold(0.0, f64::max);
    // The device adds up single precision in a tree of 128, the probe double precision.
    assert!(off < 1e-6 * load.norm(), "{row:?} and {load}");
    assert!(load.norm() > 100.0, "{load}");
}
