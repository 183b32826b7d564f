//! Periodic sides: images of the water, walls beyond the sides, and solids that pass through them.

use std::{f64::consts::TAU, path::Path};

use pontoon::{
    geometry::Shape,
    math::{Vector, expression::Formula},
    model::{Model, PressureGradient, Shifting, Slip, TimeScheme},
    scene::Scene,
    simulation::{Current, Setup, Simulation},
    solid::{FreeBody, PrescribedMotion, SolidSpec, TimeFunction},
    sph::{
        particle_shifting::Shift,
        viscosity::{Laminar, Sps},
    },
};

use super::{
    KernelKind, PairLoopKind, Viscosity, assert_rates_agree, beside,
    coupled::{assert_repeats_and_resumes, setup_of, solids_apart},
    device, distances, run,
    symmetry::assert_bodies_agree,
    under,
};

const DP: f64 = 0.05;

fn model() -> Model {
    let mut model = Model::water(2, DP, 1.0).viscosity(Viscosity::Laminar(Laminar { nu0: 0.01 }));
    (model.c0, model.gravity) = (20.0, vec![0.0, 0.0]);
    model
}

/// A square of swirling water of `length` (m) that drifts, periodic along both axes, around bodies.
fn swirl(model: Model, length: f64, bodies: impl IntoIterator<Item = SolidSpec<2>>) -> Setup<2> {
    let k = TAU / length;
    let field = |r: &Vector<2>| Vector::from([2.0 - (k * r[1]).sin(), 3.0 + (k * r[0]).sin()]);
    let setup = bodies.into_iter().fold(Setup::new(model), Setup::solid);
    let setup = setup.fill_box([0.0, 0.0], [length, length]).unwrap();
    let setup = setup.velocity(field).pressure(|r| 3000.0 + 300.0 * (k * r[0]).cos());
    setup.periodic(0, 0.0, length).periodic(1, 0.0, length)
}

#[test]
fn swirling_water_between_periodic_sides_agrees_with_the_reference() {
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    let tensile = KernelKind::Cubic { tensile: true };
    // At a fifth of the speed of sound, shifting would amplify rounding a hundredfold.
    let model = || {
        let mut model = model();
        model.c0 = 60.0;
        model
    };
    for (name, model) in [
        ("laminar", model()),
        ("Verlet", model().scheme(verlet).cfl(0.2)),
        ("shifting", model().shifting(Shifting::Everywhere(Shift::default()))),
        ("sps", model().viscosity(Viscosity::Sps(Sps::default()))),
        ("tensile", model().kernel(tensile)),
        ("corrected", model().gradient(PressureGradient::Corrected)),
    ] {
        let setup = swirl(model, 1.0, []);
        // Gradients are corrected for the places of the lists, which are new at the start.
        let until = if setup.model.gradient == PressureGradient::Plain { 0.1 } else { 0.0 };
        assert_rates_agree(name, &setup, &run(&setup, until));
        let [on_device, reference] = beside(&setup, 0.02, 150);
        let [r, v] = distances(&on_device, &reference);
        println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0, after {} s", reference.time());
        assert!(reference.time() * 3.0 > 2.0 * DP, "two rows cross the upper side: {} s", reference.time());
        // The bounds of a dam break; corrections are made anew at each list and every 20th pass, which both count from other lists.
        let bound = if name == "corrected" { 2e-3 } else { 2e-4 };
        assert!(r < bound, "{name}: positions {r} dp off");
        // What a probe finds at the corner is the water at all four corners.
        let [here, there] = [&on_device, &reference].map(|sim| {
            let mut sum = 0.0;
            sim.system().visit_fluid_near(&Vector::zeros(), &mut |_, _, w| sum += w * DP * DP);
            sum
        });
        assert!(there > 0.95 && (here - there).abs() < bound, "{name}: weights {here} and {there}");
    }
    assert_repeats_and_resumes("swirl", &swirl(model(), 1.0, []), 200, 2e-4);
}

#[test]
fn a_period_shorter_than_twice_the_width_of_images_agrees_with_the_reference() {
    // 3 supports: most particles have images on both sides.
    let mut short = model();
    short.h = 1.25 * DP;
    let setup = swirl(short, 8.0 * DP, []);
    assert_rates_agree("short", &setup, &run(&setup, 0.02));
    let [on_device, reference] = beside(&setup, 0.0, 100);
    let [r, v] = distances(&on_device, &reference);
    println!("short: positions {r:.1e} dp, velocities {v:.1e} c0");
    // The bound of a dam break.
    assert!(r < 2e-4, "positions {r} dp off");
}

#[test]
fn water_in_space_between_periodic_sides_agrees_with_the_reference() {
    let dp = 0.1;
    let mut model = Model::water(3, dp, 0.4);
    model.gravity = vec![1.0, 0.0, -9.81];
    let size = Vector::from([6.0, 6.0, 0.4]);
    let bed = SolidSpec::fixed("bed", Shape::Box { size }).at([0.5, 0.5, -0.2]);
    let setup = Setup::new(model).solid(bed).fill_box([0.0; 3], [1.0, 1.0, 0.4]).unwrap();
    let setup = setup.velocity(|r| Vector::from([1.0, -2.0 + 0.5 * (TAU * r[0]).sin(), 0.0]));
    let setup = setup.periodic(0, 0.0, 1.0).periodic(1, 0.0, 1.0);
    assert_rates_agree("in space", &setup, &run(&setup, 0.1));
    let [on_device, reference] = beside(&setup, 0.0, 60);
    let [r, v] = distances(&on_device, &reference);
    println!("in space: positions {r:.1e} dp, velocities {v:.1e} c0, after {} s", reference.time());
    // The bound of 60 steps of a dam break in space.
    assert!(r < 1e-5, "positions {r} dp off");
}

#[test]
fn a_channel_with_a_driven_lid_agrees_with_the_reference() {
    [Slip::Partial, Slip::None].into_iter().for_each(assert_channel_agrees);
}

fn assert_channel_agrees(slip: Slip) {
    // Water between a bed and a lid that drags it along; both reach beyond the sides.
    let slab = || Shape::Box { size: [5.0, 0.2].into() };
    let law = TimeFunction::from(Formula::parse("t").unwrap());
    let lid = SolidSpec::driven("lid", slab(), PrescribedMotion::slide([1.0, 0.0].into(), law)).at([0.5, 0.6]);
    let mut model = model().slip(slip);
    // Without slip images limit the step of the reference, too: at the ends of the boundary they have too little water around.
    model.dt_max = 1e-3;
    model.gravity = vec![0.5, -9.81];
    let setup = Setup::new(model).solid(SolidSpec::fixed("bed", slab()).at([0.5, -0.1])).solid(lid);
    let setup = setup.fill_box([0.0, 0.0], [1.0, 0.5]).unwrap().periodic(0, 0.0, 1.0);
    if slip != Slip::None {
        assert_rates_agree("channel", &setup, &run(&setup, 0.1));
    }
    let [on_device, reference] = beside(&setup, 0.02, 200);
    let [r, v] = distances(&on_device, &reference);
    println!("channel: positions {r:.1e} dp, velocities {v:.1e} c0");
    // The bounds of a driven solid.
    assert!(r < 2e-4, "positions {r} dp off");
    for solid in 0..2 {
        let loads = [&on_device, &reference].map(|sim| sim.system().solids()[solid].load.force);
        // The lid drags water along with some 70 N/m; 0.5 m of water weigh 4.9 kN/m, images not counted.
        assert!(loads[1].norm() > 10.0 && (loads[0] - loads[1]).norm() < 1e-3 * loads[1].norm(), "{loads:?}");
    }
    assert_repeats_and_resumes("channel", &setup, 200, 2e-4);
}

#[test]
fn a_free_body_that_passes_through_both_sides_agrees_with_the_reference() {
    // The heavy one; and one with acoustic added mass, which reads water across the sides.
    for density in [3000.0, 60.0] {
        let shape = Shape::Box { size: [0.4, 0.2].into() };
        let mut body = FreeBody::from_density(&shape, density);
        body.velocity = [2.0, 3.0].into();
        let setup = swirl(model(), 2.0, [SolidSpec::with_body("body", shape, body).at([1.78, 1.85])]);
        let state = run(&setup, 0.0);
        let mut reference = under(&setup, PairLoopKind::Reference, &state);
        let mut on_device = under(&setup, PairLoopKind::Fast, &state).on_device(&device()).unwrap();
        while reference.time() < 0.15 {
            reference.step().unwrap();
            on_device.step().unwrap();
        }
        let ([r, v], apart) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
        let at = reference.system().solids()[0].kinematics.centre;
        let loads = [&on_device, &reference].map(|sim: &Simulation<2>| sim.system().solids()[0].load.force);
        println!("{density} kg/m³: water {r:.1e} dp, {v:.1e} c0, body {apart:.1e} dp at {at:?}, loads {loads:?}");
        assert!(at[0] > 2.0 && at[1] > 2.0, "its middle has passed both sides: {at:?}");
        // The bound of free bodies.
        assert!(r < 1e-3 && apart < 1e-3, "{density} kg/m³: water {r} dp, body {apart} dp off");
        assert_repeats_and_resumes("body", &setup, 200, 1e-3);
    }
}

/// A box on a line that acts on the water, in a current, at the side of a channel.
const MOORED: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
periodic = { x = [0.0, 1.2] }
[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.2, 0.3] } }
velocity = ["1", "0"]
[[solid]]
name = "bed"
fixed = true
shape = { box = { size = [2.4, 0.12] } }
at = { x = 0.6, y = -0.06 }
[[solid]]
name = "box"
shape = { box = { size = [0.2, 0.1] } }
at = { x = 1.09, draft = 0.04 }
free = { density = 450.0, velocity = [1.0, 0.0] }
[[contact]]
between = ["box"]
touch = false
[[line_type]]
name = "chain"
diameter = 0.008
mass_per_length = 0.3
stiffness = 2e3
[[mooring]]
name = "line"
between = ["box"]
from = [1.0, 0.3]
to = [0.5, 0.0]
length = 0.75
line = "chain"
acts_on_water = true
"#;

#[test]
fn a_moored_box_across_a_side_agrees_with_the_reference() {
    let setup = setup_of(MOORED);
    let [on_device, reference] = beside(&setup, 0.02, 300);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    let at = reference.system().solids()[1].kinematics.centre;
    println!("moored: water {r:.1e} dp, {v:.1e} c0, box {body:.1e} dp at {at:?}");
    assert!(at[0] > 1.11, "it is across the side: {at:?}");
    // The bound of mooring lines.
    assert!(r < 1e-3 && body < 1e-3, "water {r} dp, box {body} dp off");
    let [here, there] = [&on_device, &reference].map(|sim| sim.mooring_reading(0).end_forces[0]);
    assert!(there.norm() > 0.5 && (here - there).norm() < 1e-3 * there.norm(), "{here} and {there}");
}

#[test]
fn a_current_that_is_held_agrees_with_the_reference() {
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    for (name, scheme, cfl) in [("symplectic", TimeScheme::Symplectic, 0.4), ("Verlet", verlet, 0.2)] {
        let bed = SolidSpec::fixed("bed", Shape::Box { size: [5.0, 0.2].into() }).at([0.5, -0.1]);
        let mut model = model().slip(Slip::Partial).scheme(scheme).cfl(cfl);
        model.gravity = vec![0.0, -9.81];
        let setup = Setup::new(model).solid(bed).fill_box([0.0, 0.0], [1.0, 0.5]).unwrap().periodic(0, 0.0, 1.0);
        let setup = setup.velocity(|_| [0.4, 0.0].into()).current(Current::new(0, 0.35, 0.1));
        let [on_device, reference] = beside(&setup, 0.02, 200);
        let [r, v] = distances(&on_device, &reference);
        let [here, there] = [&on_device, &reference].map(|sim| sim.system().current_acceleration());
        println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0; acceleration {here} and {there} m/s²");
        // The bound of a dam break. Where the mean velocities differ by 1e-6 m/s, the accelerations do by 2/τ times that.
        assert!(r < 2e-4, "{name}: positions {r} dp off");
        assert!(there.abs() > 0.1 && (here - there).abs() < 2e-5, "{name}: {here} and {there} m/s²");
        assert_repeats_and_resumes(name, &setup, 200, 2e-4);
    }
}

#[test]
fn symmetry_planes_beside_periodic_sides_agree_with_the_reference() {
    // Half of a swirl under a lid: water crosses the side and the plane, and the corner of both.
    let lid = SolidSpec::fixed("lid", Shape::Box { size: [9.0, 0.4].into() }).at([0.5, 1.2]);
    let mut no_slip = model().slip(Slip::None);
    // Without slip images limit the step of the reference, too.
    no_slip.dt_max = 1e-3;
    for (name, model) in [
        ("laminar", model()),
        ("no slip", no_slip),
        ("Verlet", model().scheme(TimeScheme::Verlet { euler_every: 40 }).cfl(0.2)),
        ("sps", model().viscosity(Viscosity::Sps(Sps::default()))),
    ] {
        let setup = Setup::new(model).solid(lid.clone()).fill_box([0.0, 0.0], [1.0, 1.0]).unwrap();
        let setup = setup.velocity(|r| Vector::from([2.0 - (TAU * r[1]).cos(), (TAU * r[0]).sin() * (1.0 - r[1])]));
        let setup = setup.pressure(|_| 3000.0).periodic(0, 0.0, 1.0).symmetry_plane(1, 0.0);
        assert_rates_agree(name, &setup, &run(&setup, 0.02));
        let [on_device, reference] = beside(&setup, 0.02, 150);
        let [r, v] = distances(&on_device, &reference);
        println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0, after {} s", reference.time());
        // The bound of a dam break.
        assert!(r < 2e-4, "{name}: positions {r} dp off");
        assert_repeats_and_resumes(name, &setup, 100, 2e-4);
    }
}

#[test]
fn a_driven_body_on_a_symmetry_plane_between_periodic_sides_agrees_with_the_reference() {
    let text = r#"
dimension = 3
dp = 0.05
until = 1.0
symmetry = { y = 0.4 }
periodic = { x = [0.0, 1.4] }
water = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [1.4, 0.8, 0.4] } } }]
[[solid]]
name = "channel"
fixed = true
shape = { box = { size = [3.4, 1.2, 0.2] } }
at = { x = 0.7, y = 0.4, bottom = -0.2 }
[[solid]]
name = "wall"
fixed = true
shape = { box = { size = [3.4, 0.2, 0.7] } }
at = { x = 0.7, y = 0.9, bottom = 0.0 }
[[solid]]
name = "box"
shape = { box = { size = [0.3, 0.25, 0.2] } }
at = { x = 0.7, y = 0.4, z = 0.45 }
driven = { along = [0.0, 0.0, 1.0], distance = { formula = "0.05*(1 - cos(20*t))" } }
"#;
    let setup = Scene::parse(text, Path::new(""), &[]).unwrap().build::<3>().unwrap().setup;
    assert_bodies_agree("box in a channel", &setup, 40);
}
