//! Unit tests of `src/scene/build.rs`: the largest number of particles.

use std::path::Path;

use crate::scene::Scene;

/// The message of a tank of water, 1 m × 1 m, at this `dp` for so many processes; empty without an error. No particle is created.
fn message(dp: f64, processes: usize) -> String {
    let text = format!(
        "dimension = 2\ndp = {dp:e}\nuntil = 1.0\n[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 1.0] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.0, 1.5] }} }}\n"
    );
    let parts = Scene::parse(&text, Path::new(""), &[]).unwrap().parts::<2>(processes);
    parts.map_or_else(|e| e.to_string(), |_| String::new())
}

/// 2.5e8 particles of water are more than a process takes, and fewer than two take; 5e9 have no numbers of 32 bits.
#[test]
fn processes_share_the_largest_number_of_particles() {
    let dp = 1.0 / 2.5e8f64.sqrt();
    assert!(message(dp, 1).contains("the scene asks for 2.5e8 particles"), "{}", message(dp, 1));
    assert_eq!(message(dp, 2), "");
    assert!(message(1.0 / 5e9f64.sqrt(), 100).contains("the most is 2e8 a process"));
}
