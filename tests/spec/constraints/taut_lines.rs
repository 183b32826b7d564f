//! Taut mooring lines against exact solutions: strong damping.

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
