//! Unit tests of `src/sph/equation_of_state.rs`.

use super::*;

#[test]
fn pressure_and_compression_are_inverse_and_the_slope_is_the_square_of_the_sound_speed() {
    let state = EquationOfState::new(20.0, 7.0);
    for x in [-0.01, 1e-9, 1e-4, 0.003, 0.05] {
        // The inverse takes a logarithm and an exponential: a few ulp.
        assert!((state.compression(state.pressure(x)) - x).abs() < 1e-15);
    }
    let slope = (state.pressure(1e-6) - state.pressure(-1e-6)) / 2e-6;
    assert!((slope / 400.0 - 1.0).abs() < 1e-9);
    let general = EquationOfState::new(20.0, 7.0 + 1e-12);
    assert!((general.pressure(0.01) / state.pressure(0.01) - 1.0).abs() < 1e-9);
}

#[test]
fn the_lattice_pressure_of_hydrostatic_compression_equals_the_head() {
    // The error is of third order in x: for 1 % of compression it is 1e-4 times a factor of a few.
    let state = EquationOfState::new(20.0, 7.0);
    for head in [0.0, 0.04, 0.4, 4.0] {
        let acting = state.lattice_pressure(state.hydrostatic_compression(head));
        assert!((acting - head).abs() <= 10.0 * head * (head / 400.0).powi(2), "{head}: {acting}");
    }
}

#[test]
fn compression_energy_is_the_integral_of_pressure() {
    for (gamma, x) in [7.0, 1.0].into_iter().flat_map(|gamma| [-0.02, 5e-4, 0.002, 0.05].map(|x| (gamma, x))) {
        let state = EquationOfState::new(20.0, gamma);
        let n = 20_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let y = x * (i as f64 + 0.5) / n as f64;
                state.pressure(y) / (1.0 + y).powi(2) * x / n as f64
            })
            .sum();
        // The error is of third order in x: the next term of the series is 1e-6 of the first at |x| = 1e-3.
        let energy = state.compression_energy(x);
        assert!((energy / sum - 1.0).abs() < 1e-5, "γ = {gamma}, {x}: {energy} {sum}");
    }
}
