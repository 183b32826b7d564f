//! Wave spectra of seas, and their division into components.
//!
//!   S(f) ∝ f⁻⁵ exp(−¼·5 (f_p/f)⁴) γ^exp(−(f/f_p − 1)²/2σ²),   σ = 0.07 below f_p, 0.09 above
//!
//! This is the JONSWAP spectrum @hasselmann1973. γ = 1 gives Bretschneider's two-parameter spectrum @bretschneider1959.
//! If the peak frequency also matches the height of a fully developed sea, the spectrum is that of @pierson1964.
//!
//! The module divides the band from ½ to 3 f_p into parts of equal energy. Each part has a single component, at the
//! frequency that halves the part's energy. No two frequencies have a simple ratio, so the sea does not repeat. 4 √m₀
//! equals the significant height to round-off.

use std::f64::consts::TAU;

/// Frequency band over f_p. 0.03 % (γ = 3.3: 0.7 %) to 1.5 % of the energy lies outside; the components inside the band
/// carry that energy too.
const BAND: (f64, f64) = (0.5, 3.0);

/// Number of points for the integration of the spectrum.
const POINTS: usize = 20_000;

/// Phillips' constant of the fully developed sea, –.
const ALPHA: f64 = 0.0081;

/// Shape of a spectrum, without its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaveSpectrum {
    /// 1/f_p, s.
    pub peak_period: f64,
    /// γ, –.
    pub gamma: f64,
}

impl WaveSpectrum {
    /// Returns the JONSWAP spectrum.
    pub(crate) fn jonswap(peak_period: f64, gamma: f64) -> Self {
        Self { peak_period, gamma }
    }

    /// Returns Bretschneider's spectrum.
    pub(crate) fn bretschneider(peak_period: f64) -> Self {
        Self { peak_period, gamma: 1.0 }
    }

    /// Returns the Pierson–Moskowitz spectrum, of a fully developed sea of significant `height` (m): α g²/5ω_p⁴ =
    /// (H/4)².
    pub(crate) fn pierson_moskowitz(height: f64, g: f64) -> Self {
        let omega = (16.0 * ALPHA * g * g / (5.0 * height * height)).powf(0.25);
        Self::bretschneider(TAU / omega)
    }

    /// Returns S at f = `x` f_p, in arbitrary units.
    pub(crate) fn density(&self, x: f64) -> f64 {
        let sigma = if x < 1.0 { 0.07 } else { 0.09 };
        let peak = (-0.5 * ((x - 1.0) / sigma).powi(2)).exp();
        x.powi(-5) * (-1.25 * x.powi(-4)).exp() * self.gamma.powf(peak)
    }

    /// Returns the angular frequencies (rad/s) of `count` components of equal energy.
    pub(super) fn equal_energy_frequencies(&self, count: usize) -> Vec<f64> {
        let step = (BAND.1 - BAND.0) / POINTS as f64;
        let mut energy = vec![0.0];
        for i in 0..POINTS {
            let x = BAND.0 + step * i as f64;
            energy.push(energy[i] + 0.5 * step * (self.density(x) + self.density(x + step)));
        }
        let all = energy[POINTS];
        let at = |part: f64| {
            let i = energy.partition_point(|e| *e < part * all).clamp(1, POINTS);
            let within = (part * all - energy[i - 1]) / (energy[i] - energy[i - 1]);
            BAND.0 + step * ((i - 1) as f64 + within)
        };
        (0..count).map(|n| TAU / self.peak_period * at((n as f64 + 0.5) / count as f64)).collect()
    }
}

/// Returns an endless iterator of random phases (rad), from the generator splitmix64 @steele2014 with seed `seed`.
pub(super) fn random_phases(seed: u64) -> impl Iterator<Item = f64> {
    (1u64..).map(move |n| {
        let mut z = seed.wrapping_add(n.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        TAU * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    })
}
