//! What comes and what goes back, from gauges in a row.
//!
//!   η(x, t) = Re [ I e^{i(ωt − kx)} + R e^{i(ωt + kx)} ],   ω² = g k tanh kd
//!
//! I and R by least squares over the gauges, of three or more (@mansard1980; two will do where they are not half a wave
//! length apart).

use std::f64::consts::TAU;

use realfft::num_complex::Complex;

use super::{complex_amplitudes, harmonic, spectrum};
use crate::{math::time_series::TimeSeries, wavemaker::wave_number};

/// Least determinant of the least squares over the square of the number of gauges, –: below, the gauges stand so that
/// both waves look alike.
const LEAST: f64 = 0.05;

/// Frequencies that count, over the peak's.
const BAND: [f64; 2] = [0.5, 2.0];

/// Waves to and fro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reflection {
    /// Height of the waves that come, in the unit of the series: H of regular waves, H_m0 of irregular ones.
    pub incident: f64,
    /// Height of those that go back.
    pub reflected: f64,
}

impl Reflection {
    /// Reflection coefficient, –.
    pub(crate) fn coefficient(&self) -> f64 {
        self.reflected / self.incident
    }
}

/// The waves at `gauges`, each its place (m) along the way of the waves that come and its elevation, in water `depth` (m) deep
/// under `g` (m/s²).
///
/// With a `period` (s) those of this period, by a fit of the harmonic at each gauge; without one all from half to twice the
/// peak frequency, line by line of the spectra, but for lines to which the gauges are blind.
///
/// None if there are fewer than two gauges, they cannot tell the two apart, or the series are too short.
pub(crate) fn reflection(gauges: &[(f64, &TimeSeries)], depth: f64, g: f64, period: Option<f64>) -> Option<Reflection> {
    let places: Vec<f64> = gauges.iter().map(|(x, _)| *x).collect();
    if places.len() < 2 {
        return None;
    }
    match period {
        Some(period) => {
            let omega = TAU / period;
            let fits: Option<Vec<_>> = gauges.iter().map(|(_, series)| harmonic(series, omega)).collect();
            let amplitudes: Vec<_> = fits?.iter().map(|h| Complex::from_polar(h.amplitude, h.phase)).collect();
            let (i, r) = separate_waves(&places, &amplitudes, wave_number(omega, depth, g))?;
            Some(Reflection { incident: 2.0 * i.norm(), reflected: 2.0 * r.norm() })
        }
        None => irregular_reflection(gauges, &places, depth, g),
    }
}

fn irregular_reflection(gauges: &[(f64, &TimeSeries)], places: &[f64], depth: f64, g: f64) -> Option<Reflection> {
    let all: Vec<&TimeSeries> = gauges.iter().map(|(_, series)| *series).collect();
    let first = spectrum(all[0])?;
    let [from, until] = BAND.map(|part| part * first.peak_frequency());
    let (step, lines) = complex_amplitudes(&all)?;
    let (mut comes, mut goes, mut seen) = (0.0, 0.0, 0.0);
    for j in (1..lines[0].len()).filter(|&j| (from..=until).contains(&(j as f64 * step))) {
        let amplitudes: Vec<_> = lines.iter().map(|of| of[j]).collect();
        let k = wave_number(TAU * j as f64 * step, depth, g);
        if let Some((i, r)) = separate_waves(places, &amplitudes, k) {
            comes += i.norm_sqr();
            goes += r.norm_sqr();
            seen += lines[0][j].norm_sqr();
        }
    }
    // The lines have a common factor, which the variance at the first gauge gives.
    let scale = first.moment(0, from, until) / seen;
    (seen > 0.0).then(|| Reflection { incident: 4.0 * (comes * scale).sqrt(), reflected: 4.0 * (goes * scale).sqrt() })
}

/// Amplitudes of the waves of number `k` (1/m) that come and that go back, from those at `places` (m).
fn separate_waves(places: &[f64], amplitudes: &[Complex<f64>], k: f64) -> Option<(Complex<f64>, Complex<f64>)> {
    let n = places.len() as f64;
    let turn = |x: &f64| Complex::from_polar(1.0, k * x);
    let twice: Complex<f64> = places.iter().map(|x| turn(&(2.0 * x))).sum();
    let with: Complex<f64> = places.iter().zip(amplitudes).map(|(x, a)| a * turn(x)).sum();
    let against: Complex<f64> = places.iter().zip(amplitudes).map(|(x, a)| a * turn(x).conj()).sum();
    let determinant = n * n - twice.norm_sqr();
    if determinant < LEAST * n * n {
        return None;
    }
    Some(((with * n - twice * against) / determinant, (against * n - twice.conj() * with) / determinant))
}

#[cfg(test)]
#[path = "../../tests/unit/analysis/reflection.rs"]
mod tests;
