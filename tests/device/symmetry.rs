//! Symmetry planes: images of the water and of the solids across them.

use std::path::Path;

use pontoon::{
    model::{Model, PressureGradient, Shifting, Slip, TimeScheme, Viscosity},
    scene::Scene,
    simulation::{Dimension, Setup},
    solid::{Dim, SolidSpec},
    sph::{
        particle_shifting::Shift,
        viscosity::{Laminar, Sps},
    },
};

use super::{
    Shape, assert_rates_agree, beside,
    budget::assert_budgets_agree,
    coupled::{assert_repeats_and_resumes, setup_of, solids_apart},
    distances, run,
};

/// Water that falls apart beside a plane at the middle of a tank: on the side of greater or of smaller coordinates.
fn column(model: Model, is_upper: bool) -> Setup<2> {
    let dp = model.dp;
    let tank = SolidSpec::fixed("tank", Shape::Tank { size: [1.2, 0.6].into(), thickness: 4.0 * dp });
    let setup = Setup::new(model).solid(tank);
    let [min, max] = if is_upper { [0.6, 0.8] } else { [0.4, 0.6] };
    // It moves towards the plane at first, so that particles cross it.
    let towards = if is_upper { -0.3 } else { 0.3 };
    let setup = setup.fill_box([min, 0.0], [max, 0.3]).unwrap().symmetry_plane(0, 0.6);
    setup.velocity(move |r| [towards * (r[0] - 0.6).abs() / 0.2 + towards, 0.0].into())
}

#[test]
fn water_beside_a_symmetry_plane_agrees_with_the_reference() {
    let base = || Model::water(2, 0.02, 0.3);
    let no_slip = base().viscosity(Viscosity::Laminar(Laminar { nu0: 1e-3 })).slip(Slip::None);
    for (name, model) in [
        ("defaults", base()),
        ("Verlet", base().scheme(TimeScheme::Verlet { euler_every: 40 }).cfl(0.2)),
        ("sps", base().viscosity(Viscosity::Sps(Sps::default()))),
        ("shifting", base().shifting(Shifting::Everywhere(Shift::default()))),
        ("corrected", base().gradient(PressureGradient::Corrected)),
        ("no slip", no_slip),
    ] {
        for is_upper in [true, false] {
            let setup = column(model.clone(), is_upper);
            // Gradients are corrected for the places of the lists, which are new at the start.
            let until = if setup.model.gradient == PressureGradient::Plain { 0.05 } else { 0.0 };
            assert_rates_agree(name, &setup, &run(&setup, until));
            let [on_device, reference] = beside(&setup, 0.02, 150);
            let [r, v] = distances(&on_device, &reference);
            println!("{name}: positions {r:.1e} dp, velocities {v:.1e} c0");
            // The bounds of a dam break; corrections are made anew at each list and every 20th pass, which both count from other lists.
            let bound = if name == "corrected" { 2e-3 } else { 2e-4 };
            assert!(r < bound, "{name}: positions {r} dp off");
        }
    }
    assert_repeats_and_resumes("column", &column(base(), true), 200, 2e-4);
}

/// A body that a plane at its middle cuts, let go above its draft.
pub fn floating(shape: &str, density: f64) -> Setup<2> {
    setup_of(&format!(
        r#"
dimension = 2
dp = 0.02
until = 1.0
symmetry = {{ x = 0.4 }}
water = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [0.8, 0.3] }} }} }}]
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.8, 0.6] }} }}
[[solid]]
name = "box"
shape = {shape}
at = {{ x = 0.4, draft = 0.03 }}
free = {{ density = {density:?} }}
"#
    ))
}

pub fn assert_bodies_agree<const D: usize>(name: &str, setup: &Setup<D>, steps: usize)
where
    Dim<D>: Dimension<D>,
{
    assert_rates_agree(name, setup, &run(setup, 0.02));
    let [on_device, reference] = beside(setup, 0.02, steps);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("{name}: water {r:.1e} dp, {v:.1e} c0, body {body:.1e} dp");
    // The bound of free bodies.
    assert!(r < 1e-3 && body < 1e-3, "{name}: water {r} dp, body {body} dp off");
    assert_repeats_and_resumes(name, setup, steps, 1e-3);
}

#[test]
fn bodies_on_a_symmetry_plane_agree_with_the_reference() {
    // Nine rows, one of them on the plane; and a light disc, which has an acoustic added mass and reads the water beyond the plane.
    assert_bodies_agree("box", &floating("{ box = { size = [0.18, 0.1] } }", 500.0), 200);
    assert_bodies_agree("disc", &floating("{ ball = { radius = 0.08 } }", 40.0), 200);
    let quarter = r#"
dimension = 3
dp = 0.05
until = 1.0
symmetry = { x = 0.5, y = 0.4 }
water = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 0.8, 0.4] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.8, 0.7] } }
[[solid]]
name = "box"
shape = { box = { size = [0.3, 0.25, 0.2] } }
at = { x = 0.5, y = 0.4, draft = 0.04 }
free = { density = 500.0 }
"#;
    let quarter = Scene::parse(quarter, Path::new(""), &[]).unwrap().build::<3>().unwrap().setup;
    assert_bodies_agree("quarter", &quarter, 40);
}

#[test]
fn energy_budgets_beside_a_symmetry_plane_agree_with_the_reference() {
    let setup = floating("{ box = { size = [0.18, 0.1] } }", 500.0);
    assert_budgets_agree("symmetric", &setup, (0.02, 100), 1e-4, &["walls"]);
}
