//! Taut mooring lines against exact solutions: strong damping, and rest without gravity.

use pontoon::Result;

use crate::common::{run_to, scene_simulation};

/// A ball of 50 kg on a line from a point 2 m above it, far from the water.
fn hung(gravity: f64, line: &str, length: f64, more: &str) -> String {
    format!(
        "dimension = 2\ndp = 0.05\nuntil = 1.0\ngravity = [0.0, {gravity:?}]\ntime = {{ dt_max = 0.0005 }}\nmodel = {{ c0 = 30.0 }}\n\
         water = [{{ fill = {{ box = {{ min = [-20.0, 0.0], max = [-19.6, 0.3] }} }} }}]\n\
         domain = {{ min = [-100.0, -100.0], max = [100.0, 100.0] }}\n\
         [[solid]]\nname = \"ball\"\nshape = {{ ball = {{ radius = 0.3 }} }}\nat = [8.0, 5.0]\n\
         free = {{ mass = 50.0{more} }}\n\
         [[line_type]]\nname = \"wire\"\ndiameter = 0.001\nmass_per_length = 0.1\nstiffness = 5e3\ndrag = 0.0\n{line}\n\
         [[mooring]]\nname = \"m\"\nbetween = [\"ball\"]\nfrom = [8.0, 5.0]\nto = [8.0, 7.0]\nlength = {length:?}\n\
         line = \"wire\"\n"
    )
}

/// 50 ẍ = T − 50 g with T = EA (l/L − 1) + BA l̇/L: velocity (m/s) along y after 1 s.
fn exact_velocity(damping: f64, length: f64) -> f64 {
    let steps = 100_000;
    let (h, mut y, mut v) = (1.0 / f64::from(steps), 0.0, -0.5);
    let acceleration = |y: f64, v: f64| (5e3 * ((2.0 - y) / length - 1.0) - damping * v / length) / 50.0 - 9.81;
    for _ in 0..steps {
        let middle = (y + 0.5 * h * v, v + 0.5 * h * acceleration(y, v));
        (y, v) = (y + h * middle.1, v + h * acceleration(middle.0, middle.1));
    }
    v
}

#[test]
fn the_damping_of_a_line_does_not_depend_on_its_segments() -> Result<()> {
    let length = 1.8213277;
    for damping in [100.0, 200.0, 400.0] {
        let exact = exact_velocity(damping, length);
        for segments in [1, 10, 40] {
            let line = format!("damping = {damping:?}");
            let text = hung(-9.81, &line, length, ", velocity = [0.0, -0.5]") + &format!("segments = {segments}\n");
            let mut sim = scene_simulation::<2>(&text)?;
            run_to(&mut sim, 1.0)?;
            let velocity = sim.system().solids()[0].kinematics.velocity[1];
            // A third of the mass of the line, 0.1 % of that of the ball, moves with it, and the line takes part in the first impact:
            // 4 mm/s.
            assert!(
                (velocity - exact).abs() < 4e-3,
                "BA = {damping} N s, {segments} segments: {velocity} of {exact} m/s"
            );
        }
    }
    Ok(())
}

#[test]
fn a_taut_line_without_gravity_is_straight_and_has_the_tension_of_its_stretch() -> Result<()> {
    for (gravity, length) in [(0.0, 1.9), (-1e-6, 1.9), (0.0, 2.0)] {
        let sim = scene_simulation::<2>(&hung(gravity, "", length, ""))?;
        let now = sim.mooring_reading(0);
        let (exact, found) = (5e3 * (2.0 / length - 1.0), now.end_forces[0].norm());
        // Half of the weight, 1e-7 N, stretches the lower part less; the rest is round-off of the stiffness.
        assert!((found - exact).abs() < 2e-7, "gravity {gravity}: {found} of {exact} N");
        let off = now.nodes.iter().map(|x| (x[0] - 8.0).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "gravity {gravity}: {off} m from straight");
    }
    Ok(())
}

/// Without gravity a slack line is at rest in any shape: it starts straight, and pulls on nothing.
#[test]
fn a_slack_line_without_gravity_stays_at_rest() -> Result<()> {
    // With little gravity it hangs in its catenary.
    scene_simulation::<2>(&hung(-1e-6, "", 2.5, ""))?;
    let mut sim = scene_simulation::<2>(&hung(0.0, "", 2.5, ""))?;
    run_to(&mut sim, 0.05)?;
    let (now, ball) = (sim.mooring_reading(0), sim.system().solids()[0].kinematics);
    assert!(now.end_forces.iter().all(|force| force.norm() < 1e-9), "{:?}", now.end_forces);
    assert!(ball.velocity.norm() < 1e-12, "{}", ball.velocity);
    Ok(())
}
