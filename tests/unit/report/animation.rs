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

#[test]
fn particles_that_come_and_go_keep_the_others_together() {
    let found = exchange(&[1, 3, 4, 7, 9], &[3, 4, 8, 9, 10]).unwrap();
    assert_eq!(found, ParticleExchange { gone: vec![0, 3], new: vec![2, 4] });
    assert_eq!(found.carry(&[10, 30, 40, 70, 90], 5), [30, 40, 0, 90, 0]);
    assert_eq!(exchange(&[1, 2], &[1, 2]), Some(ParticleExchange { gone: vec![], new: vec![] }));
    assert_eq!(exchange(&[2, 1], &[2, 1]), Some(ParticleExchange { gone: vec![], new: vec![] }));
    assert_eq!(exchange(&[2, 1], &[1, 3]), None, "not in order");
    assert_eq!(exchange(&[0, 0, 0], &[0, 0, 0]), None, "without identifiers the order differs from frame to frame");
    assert_eq!(exchange(&[1, 2, 3], &[3, 4, 5]), None, "most are others");
}
