//! Poles of functions of one variable: places at which the value grows without bound.

/// Number of equal intervals at whose ends a function is first evaluated.
const INTERVALS: u32 = 1000;

/// Parts into which an interval is divided to narrow it down.
const PARTS: u32 = 10;

/// Number of times that an interval is narrowed down, each to two of its parts: to 1e-12 of the range.
const NARROWINGS: u32 = 13;

/// Distance from the largest value at which growth is measured, over the range, and how much farther the other value is taken.
const NEAR: f64 = 1e-10;
const FARTHER: f64 = 8.0;

/// Least growth from the farther distance to the nearer one: 8 at 1/x, 2.8 at 1/√x, 1 at a finite peak.
const GROWTH: f64 = 2.0;

/// The place of a pole of `f` between `from` and `to`, ends included. A single place without a value is none, as that of
/// sin(x)/x, and neither is a finite peak.
pub(crate) fn find_pole(f: impl Fn(f64) -> f64, [from, to]: [f64; 2]) -> Option<f64> {
    let size = |x: f64| match f(x).abs() {
        value if value.is_nan() => f64::INFINITY,
        value => value,
    };
    let place = |i: u32| from + (to - from) * f64::from(i) / f64::from(INTERVALS);
    let sizes: Vec<f64> = (0..=INTERVALS).map(|i| size(place(i))).collect();
    let is_peak = |i: usize| {
        let beside = [i.checked_sub(1), Some(i + 1)].into_iter().flatten().filter_map(|k| sizes.get(k));
        beside.clone().all(|other| *other <= sizes[i]) && beside.copied().any(|other| other < sizes[i])
    };
    let largest_near = |i: u32| {
        let [mut low, mut high] = [place(i.saturating_sub(1)), place((i + 1).min(INTERVALS))];
        let mut largest = place(i);
        for _ in 0..NARROWINGS {
            let part = (high - low) / f64::from(PARTS);
            let inner = (0..=PARTS).map(|k| low + part * f64::from(k)).chain([largest]);
            largest = inner.max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(largest);
            [low, high] = [(largest - part).max(from), (largest + part).min(to)];
        }
        largest
    };
    let grows_without_bound = |x: &f64| {
        let size_at = |distance: f64| {
            let beside = [x - distance, x + distance].into_iter().filter(|x| (from..=to).contains(x));
            beside.map(|x| f(x).abs()).fold(0.0, f64::max)
        };
        let near = NEAR * (to - from);
        size_at(near) > GROWTH * size_at(FARTHER * near)
    };
    let peaks = (0..=INTERVALS).filter(|&i| is_peak(i as usize));
    peaks.map(largest_near).find(grows_without_bound)
}

#[cfg(test)]
#[path = "../../tests/unit/math/poles.rs"]
mod tests;
