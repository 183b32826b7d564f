//! How long waves are: ω² = g k tanh kd.

/// k (1/m) of a wave of angular frequency `omega` (1/s) in water `depth` (m) deep under `g` (m/s²), by Newton.
pub(super) fn wave_number(omega: f64, depth: f64, g: f64) -> f64 {
    let deep = omega * omega * depth / g;
    let mut kd = deep.max(deep.sqrt());
    for _ in 0..50 {
        let tanh = kd.tanh();
        kd -= (kd * tanh - deep) / (tanh + kd * (1.0 - tanh * tanh));
    }
    kd / depth
}

#[cfg(test)]
mod tests {
    use super::wave_number;

    #[test]
    fn a_wave_obeys_the_dispersion_relation_in_any_depth() {
        for (omega, depth) in [(0.1, 0.4), (2.0, 0.4), (20.0, 5.0)] {
            let k = wave_number(omega, depth, 9.81);
            let off = 9.81 * k * (k * depth).tanh() / (omega * omega) - 1.0;
            assert!(off.abs() < 1e-12, "Newton ends at round-off; off by {off:e}");
        }
    }
}
