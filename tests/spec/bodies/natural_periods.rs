//! Periods of heave and roll, against runs with finer particles (docs/explanation/validation.md, *Heave and roll*).

use std::path::Path;

use pontoon::{Result, scene::Scene, simulation::Simulation};

/// A box half as heavy as water, 0.2 m × 0.1 m, that is let go.
fn scene(dp: f64, water: [f64; 2], more: &str) -> String {
    let [width, depth] = water;
    format!(
        r#"dimension = 2
dp = {dp}
until = 2.0

[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [{width}, {depth}] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [{width}, {}] }} }}

[[solid]]
name = "box"
shape = {{ box = {{ size = [0.2, 0.1] }} }}
{more}"#,
        depth + 0.2
    )
}

/// Times (s) of the first `count` passages of zero of what `look` sees.
fn passages(scene: &str, count: usize, look: impl Fn(&Simulation<2>) -> f64) -> Result<Vec<f64>> {
    let mut sim = Simulation::new(Scene::parse(scene, Path::new(""), &[])?.build::<2>()?.setup)?;
    let (mut times, mut before) = (Vec::new(), look(&sim));
    while times.len() < count && sim.time() < 2.0 {
        let t = sim.time();
        sim.step_to(2.0)?;
        let now = look(&sim);
        if before * now < 0.0 {
            times.push(t + (sim.time() - t) * before / (before - now));
        }
        before = now;
    }
    assert_eq!(times.len(), count, "it passes its place at rest so often in 2 s");
    Ok(times)
}

#[test]
fn a_box_of_ten_rows_heaves_as_in_a_run_four_times_finer() -> Result<()> {
    let body = "at = { x = 0.4, bottom = 0.13 }\nfree = { density = 500.0, locked = [\"x\", \"turn\"] }\n";
    let found = passages(&scene(0.01, [0.8, 0.2], body), 2, |sim| sim.system().solids()[1].kinematics.centre[1] - 0.2)?;
    // dp = 2.5 mm: a quarter of a period of 0.235 s, then a half of 0.277 s. The project's bound.
    for (what, found, fine) in [("quarter", found[0], 0.235), ("half", found[1] - found[0], 0.277)] {
        assert!((found / fine - 1.0).abs() < 0.05, "a {what} of a period is {found} s, {fine} s in finer water");
    }
    Ok(())
}

#[test]
fn a_box_of_twenty_rows_rolls_as_in_a_run_twice_as_fine() -> Result<()> {
    let beaches =
        "[[damping]]\nfrom = [0.3, 0.0]\nto = [0.0, 0.0]\n\n[[damping]]\nfrom = [0.9, 0.0]\nto = [1.2, 0.0]\n";
    let body = format!("at = {{ x = 0.6, y = 0.3, angle_deg = 8.0 }}\nfree = {{ density = 500.0 }}\n\n{beaches}");
    let heel = |sim: &Simulation<2>| {
        let turned = &sim.system().solids()[1].kinematics.pose.rotation;
        turned[(1, 0)].atan2(turned[(0, 0)])
    };
    let found = passages(&scene(0.005, [1.2, 0.3], &body), 4, heel)?;
    // Three halves of 0.765 s with dp = 2.5 mm. The project's bound; with ten rows it is 0.664 s.
    let period = (found[3] - found[0]) / 1.5;
    assert!((period / 0.765 - 1.0).abs() < 0.05, "the period is {period} s");
    Ok(())
}
