//! Incident and reflected waves from wave gauges in a row.
//!
//!   η(x, t) = Re [ I e^{i(ωt − kx)} + R e^{i(ωt + kx)} ],   ω² = g k tanh kd
//!
//! I and R result from least squares over three or more gauges (@mansard1980). Two gauges suffice where their distance
//! is not half a wavelength.

use std::f64::consts::TAU;

use realfft::num_complex::Complex;

use super::{complex_amplitudes, harmonic, spectrum};
use crate::{math::time_series::TimeSeries, wavemaker::wave_number};

/// Smallest determinant of the least squares, divided by the square of the number of gauges, –. Below this value, the
/// gauge positions do not separate the two waves.
const LEAST: f64 = 0.05;

/// Range of the frequencies in the analysis, relative to the peak frequency.
const BAND: [f64; 2] = [0.5, 2.0];

/// Incident and reflected waves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reflection {
    /// Height of the incident waves, in the unit of the series: H of regular waves, H_m0 of irregular waves.
    pub incident: f64,
    /// Height of the reflected waves, in the unit of the series.
    pub reflected: f64,
}

impl Reflection {
    /// Returns the reflection coefficient, –.
    pub(crate) fn coefficient(&self) -> f64 {
        self.reflected / self.incident
    }
}

/// Returns the incident and reflected waves at `gauges`, in water of depth `depth` (m) under `g` (m/s²). Each gauge has
/// a position (m) in the direction of the incident waves, and an elevation series.
///
/// With a `period` (s), the function fits the harmonic of this period at each gauge. Without a period, it analyses all
/// spectral lines from half to twice the peak frequency, except lines at which the gauges do not separate the waves.
///
/// Returns `None` if there are fewer than two gauges, they cannot separate the two waves, or the series are too short.
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
    // The amplitudes of all lines have a common factor; the variance at the first gauge determines it.
    let scale = first.moment(0, from, until) / seen;
    (seen > 0.0).then(|| Reflection { incident: 4.0 * (comes * scale).sqrt(), reflected: 4.0 * (goes * scale).sqrt() })
}

/// Returns the amplitudes of the incident and reflected waves with wave number `k` (1/m), from the amplitudes at
/// `places` (m).
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
