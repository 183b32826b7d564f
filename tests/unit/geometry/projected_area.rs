//! Projected areas of boxes, balls and compounds, whole and above a level.

use super::*;

fn area<const D: usize>(shape: &Shape<D>, pose: Pose<D>, level: f64, way: [f64; D]) -> (f64, Vector<D>) {
    projected_area(&surface_facets(shape), &pose, level, &Vector::from(way).normalize())
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
