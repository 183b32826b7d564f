//! A regular wave of small height over a level bed: its length, its speeds, and the wave theory valid for its height.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

/// Largest ratio of wave height to depth @mccowan1894.
pub(crate) const MCCOWAN_LIMIT: f64 = 0.78;

/// Largest ratio of wave height to wavelength in deep water @miche1944.
const MICHE: f64 = 0.142;

/// The Ursell number H L²/d³ above which waves are cnoidal, on the chart of @lemehaute1976.
const URSELL: f64 = 26.0;

/// A regular wave of small height (linear theory).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinearWave {
    /// Depth, m.
    pub depth: f64,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// ω, rad/s.
    pub omega: f64,
    /// k, 1/m.
    pub k: f64,
}

/// Depth regime of a wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DepthRegime {
    /// kd > π.
    Deep,
    /// Between deep and shallow: π/10 ≤ kd ≤ π.
    Intermediate,
    /// kd < π/10.
    Shallow,
}

/// Region of a wave on the chart of @lemehaute1976.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum TheoryRegion {
    /// The second Stokes term is less than a hundredth of the first.
    Airy,
    /// The wave height is below a quarter of the breaking height.
    #[serde(rename = "Stokes 2")]
    Stokes2,
    /// The wave is too high for second-order Stokes theory but does not break.
    #[serde(rename = "Stokes 3 to 5")]
    Stokes5,
    /// H L²/d³ > 26.
    #[serde(rename = "cnoidal")]
    Cnoidal,
    /// A solitary wave, which has a single crest.
    #[serde(rename = "solitary")]
    Solitary,
    /// The wave height is above the breaking height.
    #[serde(rename = "breaking")]
    Breaking,
}

impl DepthRegime {
    /// Returns the name of the regime.
    pub fn name(self) -> &'static str {
        match self {
            Self::Deep => "deep",
            Self::Intermediate => "intermediate",
            Self::Shallow => "shallow",
        }
    }
}

impl TheoryRegion {
    /// Returns the name of the region.
    pub fn name(self) -> &'static str {
        match self {
            Self::Airy => "Airy",
            Self::Stokes2 => "Stokes 2",
            Self::Stokes5 => "Stokes 3 to 5",
            Self::Cnoidal => "cnoidal",
            Self::Solitary => "solitary",
            Self::Breaking => "breaking",
        }
    }
}

impl LinearWave {
    /// Returns the wave of angular frequency `omega` (rad/s) in water of depth `depth` (m).
    pub(crate) fn new(omega: f64, depth: f64, g: f64) -> Self {
        Self { depth, g, omega, k: wave_number(omega, depth, g) }
    }

    /// Returns the period, s.
    pub(crate) fn period(&self) -> f64 {
        TAU / self.omega
    }

    /// Returns the wavelength, m.
    pub(crate) fn wavelength(&self) -> f64 {
        TAU / self.k
    }

    /// Returns kd, –.
    pub(crate) fn kd(&self) -> f64 {
        self.k * self.depth
    }

    /// Returns the phase velocity, m/s.
    pub(crate) fn celerity(&self) -> f64 {
        self.omega / self.k
    }

    /// Returns the group velocity, m/s: ½ (1 + 2kd/sinh 2kd) ω/k.
    pub(crate) fn group_velocity(&self) -> f64 {
        let x = 2.0 * self.kd();
        0.5 * (1.0 + if x > 600.0 { 0.0 } else { x / x.sinh() }) * self.celerity()
    }

    /// Returns the depth regime of the wave.
    pub(crate) fn depth_regime(&self) -> DepthRegime {
        match self.kd() {
            kd if kd > PI => DepthRegime::Deep,
            kd if kd < 0.1 * PI => DepthRegime::Shallow,
            _ => DepthRegime::Intermediate,
        }
    }

    /// Returns the breaking height (m) of a wave of this length: the lesser of 0.142 L tanh kd and 0.78 d.
    pub(crate) fn breaking_height(&self) -> f64 {
        (MICHE * self.wavelength() * self.kd().tanh()).min(MCCOWAN_LIMIT * self.depth)
    }

    /// Returns the Ursell number H L²/d³ of a wave of `height` (m), –.
    pub(crate) fn ursell(&self, height: f64) -> f64 {
        height * self.wavelength().powi(2) / self.depth.powi(3)
    }

    /// Returns the greatest height (m) for which second-order Stokes theory is valid: H L²/d³ = 26.
    pub(crate) fn stokes_height_max(&self) -> f64 {
        URSELL / self.ursell(1.0)
    }

    /// Returns the longest period (s) for which second-order Stokes theory is valid, for a wave of `height` (m) in this
    /// depth. Returns `None` if the wave would break.
    pub(crate) fn stokes_period_max(&self, height: f64) -> Option<f64> {
        let k = TAU / (URSELL * self.depth.powi(3) / height).sqrt();
        let own = Self { k, omega: (self.g * k * (k * self.depth).tanh()).sqrt(), ..*self };
        (height < own.breaking_height()).then(|| own.period())
    }

    /// Returns the region of the theory that is valid for a wave of `height` (m).
    pub(crate) fn theory_region(&self, height: f64) -> TheoryRegion {
        match height {
            h if h >= self.breaking_height() => TheoryRegion::Breaking,
            h if self.second_order_ratio(h) < 0.01 => TheoryRegion::Airy,
            h if self.ursell(h) > URSELL => TheoryRegion::Cnoidal,
            h if h < 0.25 * self.breaking_height() => TheoryRegion::Stokes2,
            _ => TheoryRegion::Stokes5,
        }
    }

    /// Returns the ratio of the second Stokes term to the first: (πH/4L) cosh kd (2 + cosh 2kd)/sinh³ kd.
    pub(crate) fn second_order_ratio(&self, height: f64) -> f64 {
        let kd = self.kd().min(100.0);
        0.25 * PI * height / self.wavelength() * kd.cosh() * (2.0 + (2.0 * kd).cosh()) / kd.sinh().powi(3)
    }
}

/// Returns the wave number k (1/m) for angular frequency `omega` (rad/s) in water of depth `depth` (m). Newton's method
/// solves ω² = g k tanh kd.
pub fn wave_number(omega: f64, depth: f64, g: f64) -> f64 {
    let deep = omega * omega * depth / g;
    let mut kd = deep.max(deep.sqrt());
    for _ in 0..50 {
        let tanh = kd.tanh();
        kd -= (kd * tanh - deep) / (tanh + kd * (1.0 - tanh * tanh));
    }
    kd / depth
}

/// Returns the first `count` solutions κ (1/m) of ω² = −g κ tan κd: the evanescent modes, which decay away from the
/// paddle.
pub(super) fn evanescent_wave_numbers(omega: f64, depth: f64, g: f64, count: usize) -> Vec<f64> {
    let deep = omega * omega * depth / g;
    let root = |j: usize| {
        let (mut low, mut high) = ((j as f64 - 0.5) * PI, j as f64 * PI);
        // κd tan κd rises from −∞ to 0; sixty bisections determine the root to the last bit.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if middle * middle.tan() < -deep { low = middle } else { high = middle }
        }
        0.5 * (low + high) / depth
    };
    (1..=count).map(root).collect()
}
