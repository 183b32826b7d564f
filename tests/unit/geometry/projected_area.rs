//! Projected areas of boxes, balls and compounds, whole and above a level.

use super::*;

fn area<const D: usize>(shape: &Shape<D>, pose: Pose<D>, level: f64, way: [f64; D]) -> (f64, Vector<D>) {
    Silhouette::new(shape).projected_area(&pose, level, &Vector::from(way).normalize())
}

#[test]
fn a_box_shows_its_side_above_the_level() {
    let flat = Shape::Box { size: Vector::from([0.4, 0.3]) };
    let (whole, centre) = area(&flat, Pose::identity(), -1.0, [1.0, 0.0]);
    assert!((whole - 0.3).abs() < 1e-15 && centre[1].abs() < 1e-15 && (centre[0] + 0.2).abs() < 1e-15);
    let (dry, centre) = area(&flat, Pose::identity(), 0.05, [-1.0, 0.0]);
    assert!((dry - 0.1).abs() < 1e-15 && (centre[1] - 0.1).abs() < 1e-15, "{dry} at {centre}");
    // Turned by 30 degrees: 0.4 sin 30° + 0.3 cos 30°.
    let turned = Pose::rotated(Vector::zeros(), &[30f64.to_radians()]);
    assert!((area(&flat, turned, -1.0, [1.0, 0.0]).0 - (0.2 + 0.3 * 0.75f64.sqrt())).abs() < 1e-14);
    let solid = Shape::Box { size: Vector::from([0.4, 0.5, 0.3]) };
    assert!((area(&solid, Pose::identity(), 0.05, [1.0, 0.0, 0.0]).0 - 0.05).abs() < 1e-15);
    // Across a corner: (0.5 + 0.4)/√2 times the height.
    assert!((area(&solid, Pose::identity(), -1.0, [1.0, 1.0, 0.0]).0 - 0.3 * 0.9 / 2f64.sqrt()).abs() < 1e-14);
    assert_eq!(area(&solid, Pose::identity(), 0.15, [1.0, 0.0, 0.0]).0, 0.0);
}

#[test]
fn a_ball_shows_a_disc_and_half_of_it_above_its_middle() {
    let ball = Shape::<3>::Ball { radius: 0.2 };
    let disc = std::f64::consts::PI * 0.04;
    // 256 edges a circle: relative error (2π/256)²/6.
    assert!((area(&ball, Pose::identity(), -1.0, [1.0, 0.0, 0.0]).0 / disc - 1.0).abs() < 2e-4);
    let (half, centre) = area(&ball, Pose::identity(), 0.0, [1.0, 0.0, 0.0]);
    assert!((half / (0.5 * disc) - 1.0).abs() < 2e-4);
    assert!((centre[2] / (0.2 * 4.0 / (3.0 * std::f64::consts::PI)) - 1.0).abs() < 1e-3, "centroid of a half disc");
    assert!((area(&Shape::<2>::Ball { radius: 0.2 }, Pose::identity(), -1.0, [1.0, 0.0]).0 - 0.4).abs() < 1e-4);
}

#[test]
fn touching_parts_of_a_compound_do_not_show_their_common_face() {
    let part = |x: f64| (Pose::at(Vector::from([x, 0.0])), Shape::Box { size: Vector::from([0.2, 0.3]) });
    let pair = Shape::Compound(vec![part(0.0), part(0.2)]);
    assert!((area(&pair, Pose::identity(), -1.0, [1.0, 0.0]).0 - 0.3).abs() < 1e-15);
}

#[test]
fn a_part_in_the_lee_of_another_counts_once_in_2d() {
    // Two masts, 0.3 m high and 0.8 m apart, on a deck 0.2 m high: the union of intervals is exact.
    let part =
        |x: f64, y: f64, size: [f64; 2]| (Pose::at(Vector::from([x, y])), Shape::Box { size: Vector::from(size) });
    let masts = vec![part(0.0, 0.0, [1.0, 0.2]), part(-0.4, 0.25, [0.1, 0.3]), part(0.4, 0.25, [0.1, 0.3])];
    let ship = Shape::Compound(masts);
    for way in [[1.0, 0.0], [-1.0, 0.0]] {
        let (whole, centre) = area(&ship, Pose::identity(), 0.0, way);
        assert!((whole - 0.4).abs() < 1e-13 && (centre[1] - 0.2).abs() < 1e-13, "{whole} at {centre}");
    }
    // Along the diagonal, from the foot of the deck to the top of the leeward mast: nothing shows between them but the deck.
    let (across, _) = area(&ship, Pose::identity(), -1.0, [1.0, -1.0]);
    let line = |x: f64, y: f64| (x + y) / 2f64.sqrt();
    assert!((across - (line(0.45, 0.4) - line(-0.5, -0.1))).abs() < 1e-13, "{across}");
    // An open boat: its walls hide each other and the floor between them.
    let boat = Shape::Polygon {
        points: [[0.0, 0.0], [0.8, 0.0], [0.8, 0.4], [0.7, 0.4], [0.7, 0.1], [0.1, 0.1], [0.1, 0.4], [0.0, 0.4]]
            .map(Vector::from)
            .to_vec(),
    };
    assert!((area(&boat, Pose::identity(), 0.15, [1.0, 0.0]).0 - 0.25).abs() < 1e-13);
}

#[test]
fn a_part_in_the_lee_of_another_counts_once_in_3d() {
    let part =
        |x: f64, y: f64, size: [f64; 3]| (Pose::at(Vector::from([x, y, 0.0])), Shape::Box { size: Vector::from(size) });
    // The second hides half of the first along x, and none of it along y; no line lies across an edge, so that the sum is exact.
    let pair = Shape::Compound(vec![part(0.0, 0.0, [0.2, 0.2, 0.3]), part(0.5, 0.1, [0.2, 0.2, 0.3])]);
    let (along, centre) = area(&pair, Pose::identity(), 0.0, [1.0, 0.0, 0.0]);
    assert!((along - 0.3 * 0.15).abs() < 1e-13, "{along}");
    assert!((centre[1] - 0.05).abs() < 1e-13 && (centre[2] - 0.075).abs() < 1e-13, "{centre}");
    assert!((area(&pair, Pose::identity(), 0.0, [0.0, 1.0, 0.0]).0 - 0.4 * 0.15).abs() < 1e-13);
    assert!((area(&pair, Pose::identity(), -1.0, [0.0, 0.0, 1.0]).0 - 0.08).abs() < 1e-13, "from below");
    // Two balls in a row show one disc. Facets take 1e-4 of it, and 128 lines across a round outline 3e-4.
    let ball = |x: f64| (Pose::at(Vector::from([x, 0.0, 0.0])), Shape::Ball { radius: 0.2 });
    let row = Shape::Compound(vec![ball(0.0), ball(1.0)]);
    let disc = std::f64::consts::PI * 0.04;
    let seen = area(&row, Pose::identity(), -1.0, [1.0, 0.0, 0.0]).0;
    assert!((seen / disc - 1.0).abs() < 1e-3, "{seen} of {disc}");
}

#[test]
fn a_face_with_a_small_part_on_its_middle_shows_whole() {
    let part = |x: f64, size: [f64; 2]| (Pose::at(Vector::from([x, 0.0])), Shape::Box { size: Vector::from(size) });
    let hull = Shape::Compound(vec![part(0.0, [0.8, 0.3]), part(-0.42, [0.04, 0.04])]);
    for way in [[1.0, 0.0], [-1.0, 0.0]] {
        let (whole, centre) = area(&hull, Pose::identity(), -1.0, way);
        assert!((whole - 0.3).abs() < 1e-14 && centre[1].abs() < 1e-14, "{whole} at {centre}");
    }
    let part =
        |x: f64, size: [f64; 3]| (Pose::at(Vector::from([x, 0.0, 0.0])), Shape::Box { size: Vector::from(size) });
    let hull = Shape::Compound(vec![part(0.0, [0.8, 0.6, 0.3]), part(-0.42, [0.04, 0.1, 0.04])]);
    for (way, exact) in [([1.0, 0.0, 0.0], 0.18), ([-1.0, 0.0, 0.0], 0.18), ([0.0, 1.0, 0.0], 0.24 + 0.0016)] {
        let (whole, _) = area(&hull, Pose::identity(), -1.0, way);
        assert!((whole - exact).abs() < 1e-12, "{way:?}: {whole}");
    }
}

#[test]
fn faces_that_several_parts_cover_together_do_not_show() {
    // A wall before two boxes that stand on each other: together they are one box, whose faces alone remain.
    let part =
        |[x, y]: [f64; 2], size: [f64; 2]| (Pose::at(Vector::from([x, y])), Shape::Box { size: Vector::from(size) });
    let block = Shape::Compound(vec![
        part([0.0, 0.0], [0.2, 0.4]),
        part([0.2, 0.085], [0.2, 0.23]),
        part([0.2, -0.115], [0.2, 0.17]),
    ]);
    assert!(Silhouette::new(&block).is_convex);
    assert!((area(&block, Pose::identity(), -1.0, [-1.0, 0.0]).0 - 0.4).abs() < 1e-15);
}
