//! Unit tests of `src/scene/section/water.rs`: the motion at the start, and basins.

use std::path::Path;

use super::*;
use crate::scene::Scene;

/// The message of the build of a pool 1 m deep with this key of its water, empty without an error.
fn message(key: &str) -> String {
    let text = format!(
        "dimension = 2\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 1.0] }} }}\n{key}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.0, 1.5] }} }}\n"
    );
    let built = Scene::parse(&text, Path::new(""), &[]).unwrap().build::<2>();
    built.map_or_else(|e| e.to_string(), |_| String::new())
}

#[test]
fn a_velocity_without_a_value_or_beyond_sound_is_refused_with_its_key_and_place() {
    // The first column of particles is at 0.025 m.
    let found = message("velocity = [\"1/(x-0.025)\", \"0\"]");
    assert!(found.contains("velocity") && found.contains("scene.toml:6") && found.contains("at [0.025, "), "{found}");
    let found = message("velocity = [\"sqrt(x-0.5)\", \"0\"]");
    assert!(found.contains("velocity") && found.contains("scene.toml:6"), "{found}");
    // Sound goes at 10 √(9.81 · 1) = 31.3 m/s.
    let found = message("velocity = [\"40*x\", \"0\"]");
    assert!(found.contains("31.3 m/s") && found.contains("model.c0"), "{found}");
    assert!(message("pressure = \"1/(x-0.025)\"").contains("pressure"));
    assert_eq!(message("velocity = [\"0.4*x\", \"-0.4*y\"]"), "");
}

/// Two basins with the same level, of which the first has a step in its bed and a fill beside it that is higher by round-off.
#[test]
fn a_basin_has_the_depth_of_its_own_water() {
    let water = |[x, bed]: [f64; 2], [end, level]: [f64; 2]| Bounds {
        min: Vector::from([x, bed]),
        max: Vector::from([end, level]),
    };
    let boxes = [
        water([0.0, 0.1], [2.0, 0.3]),
        water([2.0, 0.0], [4.0, 0.1 + 0.2]),
        water([6.0, -0.5], [8.0, 0.3]),
        water([8.0, -0.9], [9.0, 0.2]),
    ];
    let depth_at = |x: f64| basin(&boxes, &water([x, 0.0], [x + 0.1, 1.0])).unwrap().depth;
    // A wet bed beside lower or separate water has no part in it.
    for (x, depth) in [(0.5, 0.3), (3.0, 0.3), (4.5, 0.3), (5.8, 0.8), (7.0, 0.8), (8.5, 1.1)] {
        assert!((depth_at(x) - depth).abs() < 1e-12, "{} m for {depth} m at {x} m", depth_at(x));
    }
}
