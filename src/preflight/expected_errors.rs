//! The errors that measurements lead one to expect at the dp of a scene.
//!
//! A half-immersed disc (2-D) is released off its equilibrium. Half a period later its displacement is less than that of the
//! exact linear solution: by 7.8 % with ten particles in a diameter, by 4.2 % with twenty. So a body loses about 0.8/N of its
//! first swing. N is the lesser of twice the draft and the breadth of the waterplane, over dp; both are the diameter of the disc.
//! In 3-D the breadth is the diameter of a disc with the area of the waterplane.
//!
//! A steep regular wave has less than the height that the second-order theory of its paddle promises: in potential theory without the
//! assumption of small waves the amplitude at its period lacks the share c (kH/2)², where c depends on kd
//! (`tests/references/steep_waves.py`). In runs in 2-D, with gradients corrected near the surface, h of 2 or 2.4 dp and a height of 5 dp,
//! waves have the share s of this amplitude half a wavelength from the paddle. In every wavelength from there on they lose the share e.
//! Both depend on the wavelength over dp; e is known within 0.01 (`docs/explanation/decisions/0106-wave-resolution.md`).

use serde::Serialize;

use super::{GeneratedWave, PreflightContext, generated_waves, wavemaker_site::WavemakerSite};
use crate::{
    math::Vector,
    model::PressureGradient,
    probe::{ProbeLocation, ProbePlan},
};

/// Share of the first swing in heave that is lost, times N, –.
const HEAVE: f64 = 0.8;

/// Smoothing lengths over dp with which the waves were measured, less rounding.
const WAVE_SMOOTHING: [f64; 2] = [2.0 - 1e-9, 2.4 - 1e-9];

/// kd, and the share of the amplitude that a wave lacks over (kH/2)² (c), –.
const STEEPNESS: [[f64; 2]; 6] = [[0.7, 3.3], [1.0, 1.3], [1.4, 0.95], [2.0, 1.2], [2.5, 1.4], [3.0, 1.6]];

/// Wavelength over dp, amplitude at half a wavelength from the paddle over that of potential theory (s), and loss in a wavelength
/// (e), –. The theory's amplitudes are 0.2 % higher than those that the reference prints, which is its error for small waves.
type Waves = [[f64; 3]; 5];

/// The waves for each of [`WAVE_SMOOTHING`].
const WAVES: [Waves; 2] = [
    [[63.0, 1.039, 0.036], [79.0, 1.026, 0.020], [112.0, 1.011, 0.018], [157.0, 1.007, 0.009], [224.0, 1.006, 0.008]],
    [[63.0, 1.024, -0.007], [79.0, 1.020, 0.002], [112.0, 1.013, 0.004], [157.0, 1.007, 0.0], [224.0, 1.012, 0.006]],
];

/// The height of waves that is to be expected at a gauge.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WaveAtGauge {
    /// Name of the probe.
    pub probe: String,
    /// Its distance from the paddle, m.
    pub distance_m: f64,
    /// Twice the amplitude at the period of the wave, over the height asked for, –.
    pub height_share: f64,
}

/// Returns the share of its first swing in heave that a body with this `waterplane` (m²; m in 2-D) and `draft` (m) loses at a spacing
/// `dp` (m).
pub(super) fn heave_error<const D: usize>(waterplane: f64, draft: f64, dp: f64) -> f64 {
    let breadth = if D == 2 { waterplane } else { 2.0 * (waterplane / std::f64::consts::PI).sqrt() };
    (HEAVE * dp / breadth.min(2.0 * draft)).clamp(0.0, 1.0)
}

/// Returns the heights of regular waves of a paddle at `stand` at the gauges before the first reflector and the first damping zone;
/// none in 3-D, for waves below five dp, and with laws that were not measured.
pub(super) fn heights_at_gauges<const D: usize>(
    context: &PreflightContext<D>,
    wave: &GeneratedWave,
    stand: &WavemakerSite<D>,
) -> Vec<WaveAtGauge> {
    let model = context.system.model();
    let spares_waves = model.gradient != PressureGradient::Plain && model.viscosity.spares_waves();
    let measured = WAVE_SMOOTHING.iter().rposition(|ratio| D == 2 && spares_waves && model.h >= ratio * model.dp);
    let Some(smoothing) = measured else { return Vec::new() };
    if wave.kind != Some("regular") || wave.height_dp < generated_waves::LEAST * (1.0 - 1e-9) {
        return Vec::new();
    }
    let reach = wave.damping_m.unwrap_or(f64::INFINITY).min(wave.reach_m);
    let gauge = |probe: &ProbePlan| {
        let Some(ProbeLocation::Columns(places, None)) = probe.kind.location() else { return None };
        let place = places.first()?;
        let at = Vector::from_fn(|i, _| place.get(i).copied().unwrap_or(context.still_water.level));
        let distance_m = stand.distance_ahead(&at).filter(|way| (0.5 * wave.length_m..reach).contains(way))?;
        let steepness = std::f64::consts::PI * wave.height_m / wave.length_m;
        let height_share = amplitude_share(wave.kd?, steepness)
            * resolved_share(&WAVES[smoothing], wave.length_dp, distance_m / wave.length_m);
        Some(WaveAtGauge { probe: probe.name.clone(), distance_m, height_share })
    };
    context.plan.probes.iter().filter_map(gauge).collect()
}

/// Amplitude (–) of waves of this `kd` and `steepness` kH/2 in potential theory, over half of the specified height.
fn amplitude_share(kd: f64, steepness: f64) -> f64 {
    let [_, missing] = interpolated(&STEEPNESS, kd);
    (1.0 - missing * steepness * steepness).max(0.0)
}

/// Amplitude (–) of waves of the length `length_dp` (dp), at the `distance` (wavelengths) from the paddle, over that of potential theory,
/// as `waves` were measured.
fn resolved_share(waves: &Waves, length_dp: f64, distance: f64) -> f64 {
    let [_, start, loss] = interpolated(waves, length_dp);
    start * (1.0 - loss).powf(distance - 0.5)
}

/// The row of `table` at `x` in its first column: linear in the logarithm of `x`, beyond the ends the last row there.
fn interpolated<const N: usize, const ROWS: usize>(table: &[[f64; N]; ROWS], x: f64) -> [f64; N] {
    let x = x.clamp(table[0][0], table[ROWS - 1][0]);
    let i = table.iter().rposition(|row| row[0] <= x).unwrap_or(0).min(ROWS - 2);
    let (a, b) = (table[i], table[i + 1]);
    let t = (x / a[0]).ln() / (b[0] / a[0]).ln();
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

#[cfg(test)]
#[path = "../../tests/unit/preflight/expected_errors.rs"]
mod tests;
