//! Gravity, stiffness and mass that differ from those of most scenes: gravity that changes with time, other exponents of the equation
//! of state, and ballast.

use pontoon::{
    math::expression::Formula,
    model::{Model, TimeScheme, Walls},
    simulation::{Setup, TowedFrame},
    solid::{BallastSpec, SolidSpec, TimeFunction},
};

use super::{
    Shape, assert_rates_agree, beside,
    coupled::{assert_repeats_and_resumes, solids_apart},
    dam, dam_with, distances, run,
};

pub fn law(text: &str) -> TimeFunction {
    TimeFunction::from(Formula::parse(text).unwrap())
}

/// The same setup in a tank that is shaken along x.
pub fn shaken(setup: Setup<2>) -> Setup<2> {
    setup.gravity_law([law("4*sin(20*t)"), law("-9.81 + 3*sin(15*t)")])
}

#[test]
fn gravity_that_changes_with_time_agrees_with_the_reference() {
    let base = || Model::water(2, 0.02, 0.3);
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    for (name, model) in [
        ("relaxed walls", base()),
        ("dynamic walls", base().walls(Walls::Dynamic)),
        ("Verlet", base().scheme(verlet).cfl(0.2)),
    ] {
        let setup = shaken(dam(model, [0.8, 0.3]));
        assert_rates_agree(name, &setup, &run(&setup, 0.05));
        let [on_device, reference] = beside(&setup, 0.02, 200);
        let [r, v] = distances(&on_device, &reference);
        let constant = beside(&dam(setup.model.clone(), [0.8, 0.3]), 0.02, 200);
        let [away, _] = distances(&constant[1], &reference);
        println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0; {away:.1e} dp from constant gravity");
        // The bound of 500 steps of a dam break.
        assert!(r < 2e-4 && away > 0.1, "{name}: positions {r} dp off, and {away} dp from constant gravity");
        let gravity = [&on_device, &reference].map(|sim| sim.system().gravity());
        // It changes by up to 90 m/s³, and the times agree to 1e-6 s.
        assert!((gravity[0] - gravity[1]).norm() < 1e-4, "{name}: {gravity:?}");
    }
}

#[test]
fn gradients_corrected_near_the_surface_follow_gravity_that_changes() {
    let setup = dam(Model::water(2, 0.02, 0.3).for_waves(), [0.8, 0.3]);
    // Gravity that is not the model's, and so another weight of a row of water, from the start.
    let heavy = setup.clone().gravity_law([law("0"), law("-30")]);
    assert_rates_agree("near the surface", &heavy, &run(&heavy, 0.0));
    // Gravity grows fourfold within the steps.
    let [on_device, reference] = beside(&setup.clone().gravity_law([law("0"), law("-9.81*(1 + 35*t)")]), 0.0, 100);
    let [r, v] = distances(&on_device, &reference);
    println!("near the surface: positions {r:.1e} dp, velocities {v:.1e} c0, after {} s", reference.time());
    // Corrections are made anew at each list and every 20th pass, which both count from other lists.
    assert!(r < 2e-3, "positions {r} dp off");
}

#[test]
fn a_body_in_a_towed_frame_under_changing_gravity_agrees_with_the_reference() {
    let body = SolidSpec::free("box", Shape::Box { size: [0.2, 0.2].into() }, 500.0).at([0.14, 0.32]);
    let setup = shaken(dam_with(Model::water(2, 0.02, 0.3).for_free_bodies(), [0.8, 0.3], [body]));
    let setup = setup.towed(TowedFrame::new(0, law("0.3*t^2")));
    let [on_device, reference] = beside(&setup, 0.02, 200);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("water {r:.1e} dp, {v:.1e} c0, box {body:.1e} dp");
    // The bound of free bodies.
    assert!(r < 1e-3 && body < 1e-3, "water {r} dp, box {body} dp off");
    assert_repeats_and_resumes("shaken", &setup, 200, 1e-3);
}

#[test]
fn other_exponents_of_the_equation_of_state_agree_with_the_reference() {
    for gamma in [0.8, 1.0, 1.4, 2.0, 5.0, 6.5] {
        let setup = dam(Model::water(2, 0.02, 0.3).gamma(gamma), [0.8, 0.3]);
        assert_rates_agree(&format!("exponent {gamma}"), &setup, &run(&setup, 0.2));
        let [on_device, reference] = beside(&setup, 0.02, 200);
        let [r, v] = distances(&on_device, &reference);
        println!("exponent {gamma}: positions {r:.1e} dp, velocities {v:.1e} c0");
        // The bound of 500 steps of a dam break.
        assert!(r < 2e-4, "exponent {gamma}: positions {r} dp off");
    }
}

#[test]
fn ballast_that_changes_agrees_with_the_reference() {
    // A box that floats takes 16 kg/m on one side within 0.1 s: it sinks and heels.
    let ballast = BallastSpec::new([0.05, -0.04], law("160*min(t, 0.1)"));
    let hull = Shape::Box { size: [0.2, 0.2].into() };
    let setup = |ballast: Option<BallastSpec<2>>| {
        let body = SolidSpec::free("box", hull.clone(), 400.0).at([0.16, 0.32]);
        let body = ballast.into_iter().fold(body, SolidSpec::ballast);
        dam_with(Model::water(2, 0.02, 0.3).for_free_bodies(), [0.8, 0.3], [body])
    };
    let loaded = setup(Some(ballast));
    let [on_device, reference] = beside(&loaded, 0.02, 300);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    let [here, there] = [&on_device, &reference].map(|sim| sim.system().solids()[1].body.unwrap().mass);
    let without = beside(&setup(None), 0.02, 300);
    let away = solids_apart(&without[1], &reference);
    println!("water {r:.1e} dp, {v:.1e} c0, box {body:.1e} dp of {away:.1} dp; mass {here} and {there} kg/m");
    assert!(away > 0.2 && (here - there).abs() < 1e-4 * there, "{away} dp; {here} and {there} kg/m");
    // The bound of free bodies.
    assert!(r < 1e-3 && body < 1e-3, "water {r} dp, box {body} dp off");
    assert_repeats_and_resumes("ballast", &loaded, 200, 1e-3);
}
