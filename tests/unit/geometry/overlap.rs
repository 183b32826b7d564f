//! Unit tests of `src/geometry/overlap.rs`.

use super::*;

fn refusal<const D: usize>(parts: Vec<(Pose<D>, Shape<D>)>) -> String {
    Shape::Compound(parts).check_no_overlap().err().map(|e| e.to_string()).unwrap_or_default()
}

fn bar(at: [f64; 3], turn: f64) -> (Pose<3>, Shape<3>) {
    (Pose::rotated(at.into(), &[0.0, 0.0, turn]), Shape::Box { size: [1.0, 0.02, 0.02].into() })
}

#[test]
fn overlapping_parts_are_named_with_the_position() {
    let block = |x: f64| (Pose::at([x, 0.0].into()), Shape::<2>::Box { size: [0.5, 0.4].into() });
    let message = refusal(vec![block(0.0), block(2.0), block(0.45)]);
    assert!(message.contains("parts 1 and 3") && message.contains("5.00e-2 m about (0.2250, 0.0000)"), "{message}");
    let inner = (Pose::identity(), Shape::Compound(vec![block(0.0), block(0.1)]));
    assert!(refusal(vec![block(3.0), inner]).contains("parts 1 and 2"));
    // Thin bars that cross far from the middle of the box around both.
    assert!(refusal(vec![bar([0.0; 3], 0.3), bar([0.3, 0.1, 0.0], -0.9)]).contains("overlap"));
    assert_eq!(refusal(vec![bar([0.0; 3], 0.3), bar([0.3, 0.1, 0.021], -0.9)]), "");
}

#[test]
fn touching_parts_are_accepted() {
    let block = |at: [f64; 3], turn: f64| {
        (Pose::rotated(at.into(), &[0.0, turn, 0.0]), Shape::Box { size: [0.5, 0.4, 0.3].into() })
    };
    assert_eq!(refusal(vec![block([0.0; 3], 0.0), block([0.5, 0.1, 0.0], 0.0)]), "");
    let (up, along) = 0.7f64.sin_cos();
    // Side by side along the turned edges, to the fourth digit.
    let beside = [0.5 * along, 0.0, -0.5 * up].map(|x| (1e4 * x).round() * 1e-4);
    assert_eq!(refusal(vec![block([0.0; 3], 0.7), block(beside, 0.7)]), "");
    let ball = |x: f64| (Pose::at([x, 0.0, 0.0].into()), Shape::Ball { radius: 0.1 });
    assert_eq!(refusal(vec![block([0.0; 3], 0.0), ball(0.35), ball(-0.35)]), "");
    let tank = (Pose::identity(), Shape::<3>::Tank { size: [0.5, 0.4, 0.3].into(), thickness: 0.1 });
    assert_eq!(refusal(vec![tank, block([0.25, 0.2, 0.15], 0.0)]), "", "inside the tank");
}

#[test]
fn a_wall_that_meets_itself_is_refused_with_the_area_that_counts_twice() {
    let refusal = |points: &[[f64; 2]]| {
        let points: Vec<Vector<2>> = points.iter().map(|x| Vector::from(*x)).collect();
        let wall = Shape::Polyline { points, thickness: 0.1 };
        (wall.volume_properties().volume, wall.check_no_overlap().err().map(|e| e.to_string()).unwrap_or_default())
    };
    // A box of 1 m by 1 m, open by 0.02 m at its first corner: there its walls overlap by 0.08 m times 0.1 m.
    let (volume, message) = refusal(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.02, 0.0]]);
    assert!((volume - (1.0 - 0.8 * 0.8) - 0.008).abs() < 1e-12, "{volume}");
    assert!(message.contains("8.00e-3 m² of its 3.68e-1 m² count twice"), "{message}");
    // A T: the foot ends at the far side of the bar, or reaches into it by half its thickness.
    for (foot, twice) in [(-0.1, false), (-0.05, true), (-0.1 + 1e-5, false)] {
        let tee = [[0.0, 0.0], [1.0, 0.0], [1.0, -0.5], [0.5, -0.5], [0.5, foot]];
        let (_, message) = refusal(&tee);
        assert_eq!(message.contains("count twice"), twice, "{foot}: {message}");
    }
    // Corners are no overlap, nor is a closed ring.
    assert_eq!(refusal(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]).1, "");
    assert_eq!(refusal(&[[0.0, 0.5], [0.0, 0.0], [1.0, 0.0], [1.0, 0.5]]).1, "");
}
