//! Films of water between a body and what it touches: the host computes their pressure from what it reads of boundary particles.

use pontoon::{
    model::{PairLoopKind, TimeScheme, Walls},
    scene::Scene,
    simulation::{Dimension, Setup, Simulation},
    solid::Dim,
};

use super::{
    assert_rates_agree, beside,
    coupled::{assert_repeats_and_resumes, setup_of, solids_apart},
    device, distances, run, under,
};

/// Water 0.3 m deep in a tank, and a body of `shape` with these words of `free`, at `at`; dp = 20 mm.
fn touching(shape: &str, at: &str, free: &str) -> String {
    format!(
        r#"dimension = 2
dp = 0.02
until = 1.0
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [0.8, 0.3] }} }}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.8, 0.6] }} }}
[[solid]]
name = "body"
shape = {{ {shape} }}
at = {{ {at} }}
free = {{ {free} }}
"#
    )
}

/// Asserts that the load on solid 1 on the device is that of the reference in a force pass on one state, within 10⁻⁵ of the `lift` (N;
/// N/m in 2-D) by Archimedes: sums over pairs are in single precision. Returns the upward force.
pub fn loads_agree<const D: usize>(name: &str, setup: &Setup<D>, lift: f64) -> f64
where
    Dim<D>: Dimension<D>,
{
    let state = run(setup, 0.1);
    assert_rates_agree(name, setup, &state);
    let reference = under(setup, PairLoopKind::Reference, &state);
    let mut on_device = Simulation::new(setup.clone()).unwrap();
    on_device.restore(&state).unwrap();
    let mut on_device = on_device.on_device(&device()).unwrap();
    on_device.device_rates().unwrap();
    let [here, there] = [&on_device, &reference].map(|sim| sim.system().solids()[1].load);
    let off = (here.force - there.force).norm();
    println!("{name}: {} and {} upwards, {off:.1e} off; Archimedes {lift}", here.force[D - 1], there.force[D - 1]);
    assert!(off < 1e-5 * lift, "{name}: {} and {}, off by {off}", here.force, there.force);
    there.force[D - 1]
}

#[test]
fn a_body_on_the_bed_has_the_lift_of_the_reference() {
    let held = r#"density = 600, locked = ["x", "y", "turn"]"#;
    let cases = [
        ("box", "box = { size = [0.2, 0.2] }", "x = 0.4, bottom = 0.0", 0.04),
        ("disc", "ball = { radius = 0.1 }", "x = 0.407, bottom = 0.0", 0.0314),
        ("box above the bed", "box = { size = [0.2, 0.2] }", "x = 0.4, bottom = 0.006", 0.04),
        // Water above it acts on the bed through it.
        ("plate", "box = { size = [0.2, 0.04] }", "x = 0.4, bottom = 0.0", 0.008),
    ];
    for (name, shape, at, area) in cases {
        let lift = 9810.0 * area;
        let found = loads_agree(name, &setup_of(&touching(shape, at, held)), lift);
        // Without a film the water presses it onto the bed.
        assert!(found > 0.5 * lift, "{name}: {found} N/m of {lift} N/m");
    }
    let mut verlet = setup_of(&touching("box = { size = [0.2, 0.2] }", "x = 0.4, bottom = 0.0", held));
    verlet.model = verlet.model.scheme(TimeScheme::Verlet { euler_every: 40 }).cfl(0.2);
    loads_agree("Verlet", &verlet, 392.0);
}

#[test]
fn a_body_on_the_bed_has_the_lift_of_the_reference_in_space() {
    let text = r#"dimension = 3
dp = 0.04
until = 0.6
[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [0.48, 0.48, 0.32] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.48, 0.48, 0.6] } }
[[solid]]
name = "body"
shape = { box = { size = [0.2, 0.2, 0.2] } }
at = { x = 0.24, y = 0.24, bottom = 0.0 }
free = { density = 1800, locked = ["x", "y", "z", "turn_x", "turn_y", "turn_z"] }
"#;
    let setup = Scene::parse(text, std::path::Path::new(""), &[]).unwrap().build::<3>().unwrap().setup;
    let found = loads_agree("3-D", &setup, 9810.0 * 0.008);
    assert!(found > 0.5 * 9810.0 * 0.008, "{found} N");
}

#[test]
fn a_body_across_a_periodic_side_has_the_lift_of_the_reference() {
    let text = r#"dimension = 2
dp = 0.02
until = 1.0
periodic = { x = [0.0, 0.8] }
[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.8, 0.3] } }
[[solid]]
name = "bed"
fixed = true
shape = { box = { size = [1.6, 0.08] } }
at = { x = 0.4, bottom = -0.08 }
[[solid]]
name = "body"
shape = { box = { size = [0.2, 0.2] } }
at = { x = 0.105, bottom = 0.0 }
free = { density = 6000, velocity = [-1.0, 0.0], locked = ["y", "turn"] }
[[contact]]
between = ["body"]
touch = false
"#;
    let setup = setup_of(text);
    let [moved, _] = beside(&setup, 0.1, 0);
    let x = moved.system().solids()[1].kinematics.centre[0];
    assert!(x < 0.05, "it is half across the side: {x} m");
    let lift = loads_agree("across a side", &setup, 392.4);
    assert!(lift > 0.5 * 392.4, "{lift} N/m");
}

#[test]
fn a_body_that_rises_from_the_bed_agrees_with_the_reference() {
    // A box of ten rows, half as heavy as water: the film lets it rise, and fades as the gap opens. Without it the box stays.
    let text = touching("box = { size = [0.2, 0.2] }", "x = 0.4, bottom = 0.0", "density = 500");
    let setup = setup_of(&text);
    let [on_device, reference] = beside(&setup, 0.0, 400);
    let heights = [&on_device, &reference].map(|sim| sim.system().solids()[1].kinematics.centre[1] - 0.1);
    let ([r, v], body) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
    println!("water {r:.1e} dp, {v:.1e} c0, box {body:.1e} dp, at heights {heights:?}");
    assert!(heights[1] > 0.02, "it rises by a dp: {heights:?}");
    // The bound of free bodies.
    assert!(r < 1e-3 && body < 1e-3, "water {r} dp, box {body} dp off");
    assert_repeats_and_resumes("films", &setup, 200, 1e-3);
}

#[test]
fn dynamic_walls_have_no_films() {
    // As on the processor: no shader reads boundary particles, and the water presses the body onto the bed.
    let mut setup = setup_of(&touching("box = { size = [0.2, 0.2] }", "x = 0.4, bottom = 0.0", "density = 500"));
    let reads = |setup: &Setup<2>| {
        let sim = Simulation::new(setup.clone()).unwrap();
        pontoon::device::shaders_of(sim.system(), false).unwrap().films.is_some()
    };
    assert!(reads(&setup), "films beside a free body");
    setup.model = setup.model.walls(Walls::Dynamic);
    assert!(!reads(&setup), "no films of dynamic walls");
}
