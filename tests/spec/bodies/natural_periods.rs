//! The natural period of heave, compared with a run at higher resolution (docs/explanation/validation.md, *Heave and roll*).

use pontoon::{Result, simulation::Simulation};

use crate::common;

/// A scene with a released box of 0.2 m × 0.1 m in a tank; `more` holds its other keys.
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

/// Times (s) of the first `count` zero crossings of `sample`.
fn zero_crossings(scene: &str, count: usize, sample: impl Fn(&Simulation<2>) -> f64) -> Result<Vec<f64>> {
    let mut sim = common::scene_simulation::<2>(scene)?;
    let (mut times, mut before) = (Vec::new(), sample(&sim));
    while times.len() < count && sim.time() < 2.0 {
        let t = sim.time();
        sim.step_to(2.0)?;
        let now = sample(&sim);
        if before * now < 0.0 {
            times.push(t + (sim.time() - t) * before / (before - now));
        }
        before = now;
    }
    assert_eq!(times.len(), count, "zero crossings in 2 s");
    Ok(times)
}

#[test]
fn the_heave_period_of_a_box_of_ten_rows_agrees_with_four_times_the_resolution() -> Result<()> {
    let body = "at = { x = 0.4, bottom = 0.13 }\nfree = { density = 500.0, locked = [\"x\", \"turn\"] }\n";
    let found =
        zero_crossings(&scene(0.01, [0.8, 0.2], body), 2, |sim| sim.system().solids()[1].kinematics.centre[1] - 0.2)?;
    // With dp = 2.5 mm the first quarter of a period is 0.235 s and the next half 0.277 s. The bound is that of the project.
    for (what, found, fine) in [("quarter", found[0], 0.235), ("half", found[1] - found[0], 0.277)] {
        assert!((found / fine - 1.0).abs() < 0.05, "a {what} of a period is {found} s, {fine} s with finer particles");
    }
    Ok(())
}
