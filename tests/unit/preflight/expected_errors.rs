use super::*;

/// The measured values at the measured lengths, half way in between at the geometric mean of two, and those of the nearest measured
/// length beyond.
#[test]
fn expected_amplitudes_are_those_measured() {
    for waves in &WAVES {
        for &[length, start, loss] in waves {
            assert!((resolved_share(waves, length, 0.5) - start).abs() < 1e-12);
            assert!((resolved_share(waves, length, 2.5) - start * (1.0 - loss).powi(2)).abs() < 1e-12);
        }
        for pair in waves.windows(2) {
            let [[a, low, _], [b, high, _]] = [pair[0], pair[1]];
            let middle = resolved_share(waves, (a * b).sqrt(), 0.5);
            assert!((middle - 0.5 * (low + high)).abs() < 1e-12, "{middle}");
        }
        let [first, last] = [waves[0][0], waves[waves.len() - 1][0]].map(|length| resolved_share(waves, length, 1.0));
        assert_eq!([resolved_share(waves, 20.0, 1.0), resolved_share(waves, 500.0, 1.0)], [first, last]);
    }
}

/// The five waves that were measured: 0.2 m deep, 0.04 m high, dp 8 mm, h = 2 dp; their amplitudes over 0.02 m at half a wavelength and at
/// two wavelengths from the paddle (`docs/measurements/wave-resolution.csv`). Single gauges scatter by 0.007 about the fit.
#[test]
fn steep_waves_have_less_than_the_specified_height() {
    let measured =
        [(0.7, 0.989, 0.977), (1.0, 0.994, 0.980), (1.4, 0.992, 0.964), (2.0, 0.977, 0.947), (2.5, 0.948, 0.898)];
    for (kd, near, far) in measured {
        let (k, height) = (kd / 0.2, 0.04);
        let length_dp = std::f64::consts::TAU / k / 0.008;
        for (distance, measured) in [(0.5, near), (2.0, far)] {
            let share = amplitude_share(kd, 0.5 * k * height) * resolved_share(&WAVES[0], length_dp, distance);
            assert!((share - measured).abs() < 0.007, "kd {kd}, {distance} lengths: {share}, measured {measured}");
        }
    }
    // A wave of kd 2.5 of half the height lacks a quarter of the share; at any dp.
    let [low, high] = [0.125, 0.25].map(|steepness| 1.0 - amplitude_share(2.5, steepness));
    assert!((high / low - 4.0).abs() < 1e-12 && (high - 0.0875).abs() < 1e-12, "{high}");
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
