//! Wind on the dry part of a float, as a scene says it.

use std::path::Path;

use pontoon::{Result, scene::Scene};

use crate::common::{run_to, scene_simulation};

const SCENE: &str = r#"
dimension = 2
dp = 0.02
until = 0.2
water = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.6] } }
[[solid]]
name = "float"
shape = { box = { size = [0.2, 0.2] } }
at = { x = 0.5, draft = "equilibrium" }
free = { density = 500.0 }
[[wind]]
velocity = ["10*t/0.05", 0.0]
drag = 1.2
on = ["float"]
"#;

#[test]
fn the_wind_of_a_scene_acts_on_the_dry_half_of_a_float() -> Result<()> {
    let mut sim = scene_simulation::<2>(SCENE)?;
    sim.enable_load_breakdown();
    run_to(&mut sim, 0.05)?;
    let wind = 10.0 * (1.0 - 0.5 * sim.dt() / 0.05);
    let expected = 0.5 * 1.225 * 1.2 * 0.1 * wind * wind;
    let load = sim.load_breakdown(1).unwrap().forces;
    // The float moves by less than 0.1 mm and 0.02 m/s: 0.4 %.
    assert!((load.force[0] / expected - 1.0).abs() < 0.005, "{} of {expected} N/m", load.force[0]);
    // The middle of the dry half lies 0.05 m above the centre: clockwise.
    let torque = load.torque.axial()[0];
    assert!((torque / (-0.05 * expected) - 1.0).abs() < 0.02, "{torque} N m/m");
    Ok(())
}

#[test]
fn walls_in_the_lee_and_the_inside_of_a_sealed_hollow_do_not_count() -> Result<()> {
    // An open boat, 0.14 m² of 800 kg/m³ over 0.8 m, floats 0.14 m deep and is 0.4 m high. A sealed ring around 0.6 m × 0.4 m,
    // 0.1 m thick, has 0.24 m² of 700 kg/m³ over 0.8 m: 0.21 m of 0.6 m.
    let boat =
        "polygon = [[0.0, 0.0], [0.8, 0.0], [0.8, 0.4], [0.7, 0.4], [0.7, 0.1], [0.1, 0.1], [0.1, 0.4], [0.0, 0.4]]";
    let ring =
        "polyline = { points = [[-0.3, -0.2], [0.3, -0.2], [0.3, 0.2], [-0.3, 0.2]], thickness = 0.1, closed = true }";
    for (shape, x, density, dry) in [(boat, 0.6, 800.0, 0.26), (ring, 1.0, 700.0, 0.39)] {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 0.1\nwater = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 0.6] }} }} }}]\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [2.0, 1.0] }} }}\n\
             [[solid]]\nname = \"float\"\nshape = {{ {shape} }}\nat = {{ x = {x}, draft = \"equilibrium\" }}\ndry = true\n\
             free = {{ density = {density}, locked = [\"x\", \"turn\"] }}\n\
             [[wind]]\nvelocity = [10.0, 0.0]\non = [\"float\"]\n"
        );
        let mut sim = scene_simulation::<2>(&text)?;
        sim.enable_load_breakdown();
        sim.step()?;
        let (load, expected) = (sim.load_breakdown(1).unwrap().forces.force[0], 0.5 * 1.225 * 100.0 * dry);
        // The first step begins at rest and afloat; the draft is found to 1e-9.
        assert!((load / expected - 1.0).abs() < 1e-6, "{load} of {expected} N/m");
    }
    Ok(())
}

#[test]
fn a_wind_that_cannot_be_meant_is_refused() {
    for (from, to, what) in [
        ("on = [\"float\"]", "on = []", "acts on nothing"),
        ("on = [\"float\"]", "on = [\"tank\"]", "is not free"),
        ("on = [\"float\"]", "on = [\"flot\"]", "no solid is called \"flot\""),
        ("drag = 1.2", "drag = -1.2", "drag must be a positive number"),
        ("[\"10*t/0.05\", 0.0]", "10.0", "the wind has 1 components"),
        ("[\"10*t/0.05\", 0.0]", "[{ file = \"gust.csv\", column = \"u\" }, 0.0]", "gust.csv"),
    ] {
        let scene = Scene::parse(&SCENE.replace(from, to), Path::new(""), &[]);
        let message = scene.and_then(|scene| scene.build::<2>()).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(what), "{to}: {message}");
    }
}

/// A float that starts beside the water has no still water around it: the wind blows on the whole of it.
#[test]
fn the_wind_blows_on_a_body_that_starts_beside_the_water() -> Result<()> {
    let held = SCENE.replace("density = 500.0", "density = 500.0, locked = [\"y\", \"turn\"]");
    let mut sim = scene_simulation::<2>(&held.replace("{ x = 0.5, draft = \"equilibrium\" }", "[2.0, 1.0]"))?;
    sim.enable_load_breakdown();
    run_to(&mut sim, 0.05)?;
    let wind = 10.0 * (1.0 - 0.5 * sim.dt() / 0.05);
    // It is 0.2 m high, and moves by less than 0.02 m/s: 0.4 %.
    let expected = 0.5 * 1.225 * 1.2 * 0.2 * wind * wind;
    let load = sim.load_breakdown(1).unwrap().forces;
    assert!((load.force[0] / expected - 1.0).abs() < 0.005, "{} of {expected} N/m", load.force[0]);
    Ok(())
}
