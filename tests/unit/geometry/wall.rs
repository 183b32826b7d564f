//! Unit tests of `src/geometry/wall.rs`.

use super::*;
use crate::geometry::Shape;

fn v(x: [f64; 2]) -> Vector<2> {
    Vector::from(x)
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} differs from {b}");
}

fn wall(points: &[[f64; 2]], thickness: f64) -> Shape<2> {
    Shape::Polyline { points: points.iter().map(|&x| v(x)).collect(), thickness }
}

#[test]
fn the_outer_corner_of_a_wall_is_solid_up_to_its_mitre() {
    let hook = wall(&[[0.0, 1.0], [0.0, 0.0], [2.0, 0.0]], 0.4);
    // The corner of the outline is (−0.4, −0.4); by the distance from the line alone the first point would be dry.
    near(hook.signed_distance(&v([-0.35, -0.35])), -0.05);
    near(hook.signed_distance(&v([-0.43, -0.44])), 0.05);
    near(hook.signed_distance(&v([-0.1, -0.5])), 0.1);
}

/// A square ring with an inner edge of 1 m and an outer edge of 1.4 m, given by its inner (counter-clockwise) and by its
/// outer line (clockwise).
fn square_rings() -> [Shape<2>; 2] {
    let inner = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    let outer = [[-0.2, -0.2], [-0.2, 1.2], [1.2, 1.2], [1.2, -0.2], [-0.2, -0.2]];
    [wall(&inner, 0.2), wall(&outer, 0.2)]
}

#[test]
fn a_closed_wall_has_the_volume_and_the_distances_of_a_ring() {
    for ring in square_rings() {
        assert_eq!(ring.check(), Ok(()));
        let properties = ring.volume_properties();
        near(properties.volume, 1.96 - 1.0);
        near((properties.centroid - v([0.5, 0.5])).norm(), 0.0);
        // ∫ x² of two squares about their centre: (1.4⁴ − 1⁴)/12.
        near(properties.second_moment[(0, 0)], (1.4_f64.powi(4) - 1.0) / 12.0);
        near(ring.surface_area(), 4.0 * 1.4 + 4.0);
        near((ring.bounds().max - v([1.2, 1.2])).norm(), 0.0);
        near(ring.signed_distance(&v([0.5, 0.3])), 0.3);
        near(ring.signed_distance(&v([0.5, -0.05])), -0.05);
        near(ring.signed_distance(&v([0.5, -0.5])), 0.3);
        near(ring.signed_distance(&v([-0.15, -0.15])), -0.05);
        // Half submerged up to the middle: the lower half of the ring.
        near(ring.submerged_volume(&crate::math::Pose::identity(), 0.5).0, 0.48);
    }
}

#[test]
fn a_closed_wall_has_layers_all_round() {
    for ring in square_rings() {
        // Four cells across: every cell of 28 × 28 but for the 20 × 20 of the hollow.
        let points = ring.boundary_points(0.05, 4);
        assert_eq!(points.len(), 28 * 28 - 20 * 20);
        for p in &points {
            let depth = -ring.signed_distance(&p.r) / 0.05;
            assert!(depth > 0.5 - 1e-6 && p.layer == if depth > 1.0 { 1 } else { 0 }, "{p:?} at {depth} dp");
        }
        // One layer from each face.
        assert_eq!(ring.boundary_points(0.05, 1).len(), 28 * 4 - 4 + 22 * 4 - 4);
    }
}

#[test]
fn a_ring_without_a_hollow_is_refused() {
    let clockwise = wall(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], 0.6);
    let refusal = clockwise.check().map_err(|e| e.to_string());
    assert!(refusal.as_ref().is_err_and(|text| text.contains("leaves no space inside")), "{refusal:?}");
    let crossed = wall(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0]], 0.1);
    assert!(crossed.check().is_err());
}

#[test]
fn the_legs_of_a_sharp_corner_keep_their_thickness() {
    let (length, thickness) = (0.4, 0.06);
    for degrees in [5.0_f64, 10.0, 20.0, 30.0, 36.0] {
        // The far side is outside: two legs and a rounded tip.
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let end = [length - length * cosine, length * sine];
        let outside = wall(&[[0.0, 0.0], [length, 0.0], end], thickness);
        let tip = 0.5 * thickness * thickness * (std::f64::consts::PI - degrees.to_radians());
        let volume = outside.volume_properties().volume;
        // The tip is a polygon of chords of 8.6°, which have 0.4 % less.
        assert!((volume - 2.0 * length * thickness - tip).abs() < 0.005 * tip, "{degrees}°: {volume} m²");
        near(outside.signed_distance(&v([length + 0.05, 0.0])), -0.01);
        near(outside.signed_distance(&v([length + 0.07, 0.0])), 0.01);
    }
    // The far side is inside: both legs share what lies between them up to the mitre.
    let (length, degrees) = (1.0, 30.0_f64);
    let end = [length - length * degrees.to_radians().cos(), length * degrees.to_radians().sin()];
    let inside = wall(&[end, [length, 0.0], [0.0, 0.0]], thickness);
    let mitre = thickness * thickness / (0.5 * degrees.to_radians()).tan();
    near(inside.volume_properties().volume, 2.0 * length * thickness - mitre);
}
