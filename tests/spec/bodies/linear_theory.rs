//! Motions of bodies at the waterline against linear theory: forced heave, free decay of heave, and roll.

use std::f64::consts::PI;

use pontoon::{Result, simulation::Simulation};

use crate::common;

/// A disc of 0.3 m in a tank `length` m long with 0.6 m of water; `more` holds its other keys.
fn disc(dp: f64, length: f64, until: f64, more: &str) -> String {
    format!(
        r#"dimension = 2
dp = {dp}
until = {until}
gravity = [0.0, -9.82]

[[water]]
fill = {{ box = {{ min = [{left}, 0.0], max = [{right}, 0.6] }} }}

[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [{length}, 0.9] }} }}
at = {{ x = {left} }}

[[solid]]
name = "disc"
shape = {{ ball = {{ radius = 0.15 }} }}
{more}

[model]
rho0 = 998.2
"#,
        left = -0.5 * length,
        right = 0.5 * length,
    )
}

/// Solves the normal equations of a least-squares fit of `samples` by `basis`.
fn fit<const N: usize>(samples: &[(f64, f64)], basis: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    let (mut matrix, mut right) = (vec![[0.0; N]; N], [0.0; N]);
    for &(t, x) in samples {
        let row = basis(t);
        for i in 0..N {
            right[i] += row[i] * x;
            for j in 0..N {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    let matrix = nalgebra::DMatrix::from_fn(N, N, |i, j| matrix[i][j]);
    let solved = matrix.lu().solve(&nalgebra::DVector::from_row_slice(&right)).expect("independent functions");
    std::array::from_fn(|i| solved[i])
}

#[test]
fn a_disc_that_is_driven_in_heave_meets_the_damping_of_linear_theory() -> Result<()> {
    let (amplitude, omega): (f64, f64) = (0.03, 7.2);
    let law = format!(
        "at = {{ y = 0.6 }}\ndriven = {{ along = [0.0, 1.0], distance = {{ formula = \"{amplitude}*min(t/1.0,1)*sin({omega}*t)\" }} }}"
    );
    let mut sim = common::scene_simulation::<2>(&disc(0.03, 6.0, 5.0, &law))?;
    let mut samples = Vec::new();
    while sim.time() < 5.0 {
        sim.step_to(5.0)?;
        samples.push((sim.time(), sim.system().solids()[1].load.force[1]));
    }
    // Four whole periods; the first wave that the walls reflect is back at about 8 s.
    samples.retain(|&(t, _)| t > 5.0 - 4.0 * 2.0 * PI / omega);
    let phases = |t: f64| {
        let a = omega * t;
        [1.0, a.sin(), a.cos(), (2.0 * a).sin(), (2.0 * a).cos()]
    };
    let [mean, sine, cosine, ..] = fit(&samples, phases);
    let (stiffness, buoyancy) = (998.2 * 9.82 * 0.3, 998.2 * 9.82 * PI * 0.3 * 0.3 / 8.0);
    let added_mass = (sine / amplitude + stiffness) / (omega * omega);
    let damping = -cosine / (omega * amplitude);
    let lift = (mean - buoyancy) / (stiffness * amplitude);
    // Linear potential flow, constant-panel boundary elements (1 % in B): A 20.45 kg/m, B 134.15 kg/(m s), no mean force.
    // Walls with a memory have B 202 and a lift of 0.163.
    assert!((damping / 134.15 - 1.0).abs() < 0.08, "damping {damping} kg/(m s)");
    assert!((added_mass / 20.45 - 1.0).abs() < 0.15, "added mass {added_mass} kg/m");
    assert!(lift.abs() < 0.03, "mean lift {lift} of the restoring force");
    Ok(())
}

#[test]
fn a_disc_that_is_lifted_and_released_swings_through_its_rest_as_in_linear_theory() -> Result<()> {
    let more = "at = { y = 0.63 }\nfree = { density = 499.1, centre_offset = [0.0, -0.0348] }";
    let mut sim = common::scene_simulation::<2>(&disc(0.03, 2.4, 0.7, more))?;
    let height = |sim: &Simulation<2>| sim.system().solids()[1].kinematics.pose.position[1] - 0.6;
    let mut trough = f64::INFINITY;
    while sim.time() < 0.7 {
        sim.step_to(0.7)?;
        trough = f64::min(trough, height(&sim) / 0.03);
    }
    // Kotik and Lurye 1964, by boundary elements: -0.58 of the lift. Walls with a memory have -0.28 at this spacing.
    assert!((-0.60..-0.51).contains(&trough), "the first trough is at {trough} of the lift");
    Ok(())
}
