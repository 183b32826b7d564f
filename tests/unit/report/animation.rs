//! Unit tests of `src/report/animation.rs`.

use super::*;

#[test]
fn a_subsample_of_a_lattice_is_a_lattice_for_any_origin() {
    for begin in [0.0, 0.005, 0.0025, -0.3] {
        let r = (0..400).map(|k| [begin + 0.01 * (k % 20) as f32, 0.005 + 0.01 * (k / 20) as f32, 0.0]).collect();
        let cloud = FramePoints { position: r, ..FramePoints::default() };
        let left = subsample(&cloud, Some((2.0, 0.01)));
        let row: Vec<f32> = left.iter().map(|&i| cloud.position[i]).filter(|x| x[1] < 0.01).map(|x| x[0]).collect();
        let even = row[1..].windows(2).all(|w| (w[1] - w[0] - 0.02).abs() < 1e-5);
        assert!(even && (100..=121).contains(&left.len()), "from {begin} m: {} points, a row {row:?}", left.len());
        assert_eq!(subsample(&cloud, None).len(), 400);
    }
}

#[test]
fn colour_ranges_are_rounded_to_two_digits() {
    assert_eq!([rounded_range(0.0, 2704.0), rounded_range(-0.0123, 0.456)], [[0.0, 2800.0], [-0.02, 0.46]]);
    assert_eq!(rounded_range(0.0, 0.0), [0.0, 1.0]);
}
