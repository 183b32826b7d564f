//! Computes the convergence of an error with the particle spacing: observed order and grid-convergence index.

use serde::Serialize;

/// The safety factor of the index for three or more grids, –.
const FACTOR: f64 = 1.25;

/// The convergence of a metric over three particle spacings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// The observed order, –.
    pub order: f64,
    /// The grid-convergence index of the finest spacing, relative to the value at that spacing, –.
    pub index: f64,
}

/// Returns the observed order q of e ∝ dp^q: the least-squares slope of log e over log dp.
///
/// `points` contains the spacing (m) and the error (any unit, above 0). Returns `None` for fewer than two spacings.
///
/// ```
/// # use pontoon::study::least_squares;
/// let points = [0.04, 0.02, 0.01].map(|dp| (dp, 3.0 * dp * dp));
/// assert!((least_squares(&points).unwrap() - 2.0).abs() < 1e-12);
/// ```
pub fn least_squares(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> =
        points.iter().filter(|(dp, e)| *dp > 0.0 && *e > 0.0).map(|(dp, e)| (dp.ln(), e.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / n, sum.1 + p.1 / n));
    let across: f64 = logs.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    let both: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (logs.len() >= 2 && across > 0.0).then(|| both / across)
}

/// Returns the order and index from the three finest of `points`, each with the spacing (m) and the value f:
///
///   (f₃ − f₂)/(f₂ − f₁) = r₂₁^q (r₃₂^q − 1)/(r₂₁^q − 1),   r_ij = dp_i/dp_j, finest first
///   GCI = 1.25 |f₂ − f₁| / (|f₁| (r₂₁^q − 1))
///
/// Returns `None` for fewer than three spacings, or if f does not converge monotonically and so has no order.
///
/// Source: @roache1994.
/// ```
/// # use pontoon::study::convergence;
/// let points = [0.04, 0.02, 0.01].map(|dp| (dp, 0.2 + 3.0 * dp));
/// let found = convergence(&points).unwrap();
/// assert!((found.order - 1.0).abs() < 1e-9);
/// assert!((found.index - 1.25 * 0.03 / 0.23).abs() < 1e-9);
/// ```
pub fn convergence(points: &[(f64, f64)]) -> Option<Convergence> {
    let mut finest = points.to_vec();
    finest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(h1, f1), (h2, f2), (h3, f3), ..] = finest[..] else { return None };
    let (r21, r32) = (h2 / h1, h3 / h2);
    let ratio = (f3 - f2) / (f2 - f1);
    // For q between 0 and 20 the right-hand side increases, starting from ln r₃₂/ln r₂₁.
    let right = |q: f64| r21.powf(q) * (r32.powf(q) - 1.0) / (r21.powf(q) - 1.0);
    let (mut low, mut high) = (1e-6, 20.0);
    if !(ratio > right(low) && ratio < right(high) && r21 > 1.0 && r32 > 1.0) {
        return None;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if right(middle) < ratio { low = middle } else { high = middle }
    }
    let order = 0.5 * (low + high);
    Some(Convergence { order, index: FACTOR * (f2 - f1).abs() / (f1.abs() * (r21.powf(order) - 1.0)) })
}

#[cfg(test)]
#[path = "../../tests/unit/study/convergence.rs"]
mod tests;
