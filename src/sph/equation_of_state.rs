//! Equation of state:  P = b[(ρ/ρ₀)^γ − 1],  b = c₀² ρ₀/γ  (Tait; Monaghan 1994).

use super::Num;

/// Tait's equation in x = ρ/ρ₀ − 1 and P/ρ₀.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationOfState {
    /// b/ρ₀ = c₀²/γ, m²/s².
    stiffness: f64,
    gamma: f64,
}

/// The binomial coefficients of γ = 7, without that of x⁰.
const SEVEN: [f64; 7] = [1.0, 7.0, 21.0, 35.0, 35.0, 21.0, 7.0];

/// Terms of a binomial series: for exponents from 0 to 7 the rest is below 10⁻⁸ of the sum where |x| ≤ 0.5.
#[cfg(feature = "gpu")]
const TERMS: u32 = 20;

/// `stiffness` [(1 + x)^γ − 1], which loses no digit near x = 0, with such coefficients of γ, that of the highest power first.
#[inline(always)]
fn binomial<N: Num>(stiffness: f64, coefficients: &[f64], x: N) -> N {
    let of = |c: f64| x.constant(c);
    let [highest, others @ ..] = coefficients else { return of(0.0) };
    let sum = others.iter().fold(of(*highest), |sum, c| x.fma(sum, of(*c)));
    of(stiffness) * x * sum
}

/// The binomial coefficients of `gamma`, without that of x⁰, the highest power first.
#[cfg(feature = "gpu")]
fn series(gamma: f64) -> Vec<f64> {
    let next = |c: &mut f64, k: u32| {
        *c = *c * (gamma - f64::from(k - 1)) / f64::from(k);
        (*c != 0.0).then_some(*c)
    };
    let mut coefficients: Vec<f64> = (1..=TERMS).scan(1.0, next).collect();
    coefficients.reverse();
    coefficients
}

/// xⁿ.
#[cfg(feature = "gpu")]
fn power<N: Num>(x: N, n: u32) -> N {
    match n {
        0 => x.constant(1.0),
        1 => x,
        _ if n.is_multiple_of(2) => {
            let root = power(x, n / 2);
            root * root
        }
        _ => power(x, n - 1) * x,
    }
}

impl EquationOfState {
    /// The state of water with speed of sound `c0` (m/s) and exponent `gamma` (–).
    pub fn new(c0: f64, gamma: f64) -> Self {
        Self { stiffness: c0 * c0 / gamma, gamma }
    }

    /// P/ρ₀ (m²/s²) at excess density `x` (–). For γ = 7 the binomial in x.
    #[inline(always)]
    pub(crate) fn pressure(&self, x: f64) -> f64 {
        match self.gamma == 7.0 {
            true => binomial(self.stiffness, &SEVEN, x),
            false => self.stiffness * (self.gamma * x.ln_1p()).exp_m1(),
        }
    }

    /// Excess density (–) at P/ρ₀ (m²/s²), the inverse of [`EquationOfState::pressure`].
    pub(crate) fn compression(&self, p: f64) -> f64 {
        ((p / self.stiffness).ln_1p() / self.gamma).exp_m1()
    }

    /// The coefficients of the binomial series in x, as far as they count in single precision for |x| ≤ 0.5, if γ is at most 7.
    #[cfg(feature = "gpu")]
    pub(crate) fn coefficients(&self) -> Option<Vec<f64>> {
        (self.gamma <= 7.0).then(|| series(self.gamma))
    }

    /// P/ρ₀ at excess density `x` with the [`coefficients`](Self::coefficients) of γ, in single precision too.
    #[cfg(feature = "gpu")]
    pub(crate) fn binomial_pressure<N: Num>(&self, coefficients: &[f64], x: N) -> N {
        binomial(self.stiffness, coefficients, x)
    }

    /// Excess density (–) at P/ρ₀ (m²/s²) with the [`coefficients`](Self::coefficients) of γ, by four Newton steps. They suffice in
    /// single precision for P/ρ₀ from −0.1 to 1 times c₀².
    #[cfg(feature = "gpu")]
    pub(crate) fn binomial_compression<N: Num>(&self, coefficients: &[f64], p: N) -> N {
        let of = |c: f64| p.constant(c);
        let q = (p * of(1.0 / (self.gamma * self.stiffness))).max(of(-0.12));
        // (1 + x)^(γ−1)
        let slope = |x: N| match self.gamma.fract() == 0.0 {
            true => power(x + of(1.0), self.gamma as u32 - 1),
            false => binomial(1.0, &series(self.gamma - 1.0), x) + of(1.0),
        };
        // (1 + x)^γ = 1 + γq; the iteration is monotone from x = q, which is above for γ > 1, and below for γ < 1.
        (0..4).fold(q, |x, _| {
            let slope = slope(x);
            x - (binomial(1.0 / self.gamma, coefficients, x) - q) / slope
        })
    }

    /// Excess density (–) of water at rest under `head` = g·depth (m²/s²), its particles dp apart everywhere.
    ///
    /// Deep water is denser, but a metre of it contains as many particles: the volumes m/ρ in the pressure force are too small by
    /// the share x. The pressure P acts as P/(1 + x)², so that at rest P = ρ₀ g·depth (1 + 2x) to second order.
    pub(crate) fn hydrostatic_compression(&self, head: f64) -> f64 {
        self.compression(head * (1.0 + 2.0 * head / (self.stiffness * self.gamma)))
    }

    /// The part of the pressure (P/ρ₀, m²/s²) at excess density `x` (–) that acts where particles lie dp apart.
    pub(crate) fn lattice_pressure(&self, x: f64) -> f64 {
        self.pressure(x) / ((1.0 + x) * (1.0 + x))
    }

    /// Energy of compression per unit of mass (J/kg) from ρ₀ to x: ∫ P/ρ² dρ.
    pub(crate) fn compression_energy(&self, x: f64) -> f64 {
        let (g, s) = (self.gamma, 1.0 / (1.0 + x));
        if x.abs() < 1e-3 {
            // P ≈ c₀² x ρ₀ (1 + (γ−1) x/2): the series to third order, free of cancellation.
            return self.stiffness * g * x * x * (0.5 + x * ((g - 1.0) / 6.0 - 2.0 / 3.0));
        }
        let work = if g == 1.0 { x.ln_1p() } else { ((1.0 + x).powf(g - 1.0) - 1.0) / (g - 1.0) };
        self.stiffness * (work + s - 1.0)
    }
}

#[cfg(test)]
#[path = "../../tests/unit/sph/equation_of_state.rs"]
mod tests;
