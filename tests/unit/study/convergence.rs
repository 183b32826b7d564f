//! Unit tests of `src/study/convergence.rs`.

use super::*;

#[test]
fn unequal_refinement_ratios_have_the_exact_order_and_divergent_series_have_none() {
    let figure = |dp: f64| 0.1 - 5.0 * dp.powf(1.5);
    let points = [0.05, 0.03, 0.02].map(|dp| (dp, figure(dp)));
    let order = convergence(&points).map(|c| c.order);
    assert!(order.is_some_and(|q| (q - 1.5).abs() < 1e-9), "{order:?}");
    assert_eq!(convergence(&[(0.04, 1.0), (0.02, 2.0), (0.01, 1.5)]), None, "it oscillates");
    assert_eq!(convergence(&[(0.04, 1.0), (0.02, 2.0), (0.01, 4.0)]), None, "it grows");
    assert_eq!(convergence(&points[..2]), None);
    assert_eq!(least_squares(&points[..1]), None);
    assert_eq!(least_squares(&[(0.02, 0.0), (0.01, 0.0)]), None, "zero errors have no logarithm");
}
