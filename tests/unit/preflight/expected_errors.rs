use super::*;

/// The measured values at the measured lengths, half way in between at the geometric mean of two, and those of the nearest measured
/// length beyond.
#[test]
fn expected_heights_are_those_measured() {
    for [length, start, loss] in WAVES {
        assert!((height_share(length, 0.5) - start).abs() < 1e-12);
        assert!((height_share(length, 2.5) - start * (1.0 - loss).powi(2)).abs() < 1e-12);
    }
    for pair in WAVES.windows(2) {
        let [[a, low, _], [b, high, _]] = [pair[0], pair[1]];
        let middle = height_share((a * b).sqrt(), 0.5);
        assert!((middle - 0.5 * (low + high)).abs() < 1e-12, "{middle}");
    }
    let [first, last] = [WAVES[0][0], WAVES[WAVES.len() - 1][0]].map(|length| height_share(length, 1.0));
    assert_eq!([height_share(20.0, 1.0), height_share(500.0, 1.0)], [first, last]);
}

/// A disc of ten rows loses 8 %, as measured; a flat raft as much as a disc of twice its draft; a sphere as the disc of its diameter.
#[test]
fn expected_swings_follow_from_breadth_and_draft() {
    let area = std::f64::consts::PI * 0.25;
    let disc = [heave_error::<2>(1.0, 0.5, 0.1), heave_error::<3>(area, 0.5, 0.1)];
    assert!(disc.iter().all(|error| (error - 0.08).abs() < 1e-12), "{disc:?}");
    assert!((heave_error::<2>(1.0, 0.1, 0.1) - 0.4).abs() < 1e-12);
    assert_eq!(heave_error::<2>(1.0, 0.01, 0.1), 1.0);
}
