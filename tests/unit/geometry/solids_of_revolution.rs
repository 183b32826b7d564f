use std::f64::consts::PI;

use super::*;

const TOLERANCE: f64 = 1e-4;

/// Volume, centroid and the diagonal of the second moment against their exact values. Facets within `TOLERANCE` of a surface of
/// size 0.1 to 0.3 m change second moments by less than five times their ratio.
fn assert_moments(mesh: &Mesh, volume: f64, centroid: [f64; 3], second: [f64; 3]) {
    let found = mesh.volume_properties();
    assert!((found.volume / volume - 1.0).abs() < 1e-9, "{} for {volume}", found.volume);
    for i in 0..3 {
        assert!((found.centroid[i] - centroid[i]).abs() < 1e-9, "{:?}", found.centroid);
        let error = found.second_moment[(i, i)] / second[i] - 1.0;
        assert!(error.abs() < 5e-3, "axis {i}: {error:.1e}");
    }
}

#[test]
fn an_ellipsoid_has_its_volume_second_moment_and_distance() {
    let r = Vector::<3>::new(0.3, 0.2, 0.1);
    let mesh = ellipsoid(r, TOLERANCE).unwrap();
    let v = 4.0 / 3.0 * PI * r.product();
    assert_moments(&mesh, v, [0.0; 3], [0, 1, 2].map(|i| v * r[i] * r[i] / 5.0));
    for i in 0..3 {
        let mut x = Vector::<3>::zeros();
        x[i] = r[i] + 0.05;
        // chords and the scaling to the volume: twice the tolerance
        assert!((mesh.distance_and_normal(&x).0 - 0.05).abs() < 2.0 * TOLERANCE);
    }
}

#[test]
fn a_cone_and_a_frustum_have_their_volume_along_any_axis() {
    for axis in 0..3 {
        let mesh = frustum(0.1, 0.0, 0.3, axis, TOLERANCE).unwrap();
        let v = PI * 0.01 * 0.3 / 3.0;
        let mut centre = [0.0; 3];
        centre[axis] = -0.075; // a quarter of the length above the base
        let mut second = [v * 3.0 / 20.0 * 0.01; 3];
        second[axis] = v * 3.0 / 80.0 * 0.09;
        assert_moments(&mesh, v, centre, second);
        let (a, b, l) = (0.1, 0.05, 0.2);
        let v = PI * l / 3.0 * (a * a + a * b + b * b);
        let found = frustum(a, b, l, axis, TOLERANCE).unwrap().volume_properties().volume;
        assert!((found / v - 1.0).abs() < 1e-12);
        let turned_over = frustum(b, a, l, axis, TOLERANCE).unwrap().volume_properties().volume;
        assert!((turned_over / v - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_torus_has_its_volume_and_a_hole() {
    let (radius, tube) = (0.3, 0.1);
    let v = 2.0 * PI * PI * radius * tube * tube;
    let axial = v * tube * tube / 4.0;
    let across = v * (0.5 * radius * radius + 3.0 / 8.0 * tube * tube);
    for axis in 0..3 {
        let mesh = torus(radius, tube, axis, TOLERANCE).unwrap();
        let mut second = [across; 3];
        second[axis] = axial;
        assert_moments(&mesh, v, [0.0; 3], second);
        let hole = mesh.distance_and_normal(&Vector::zeros()).0;
        assert!((hole - 0.2).abs() < 2.0 * TOLERANCE, "{hole}");
        // Polygons of equal area: the fourth power of their angle, TAU / 72, over 180, is 3e-7.
        let found = mesh.volume_properties().second_moment;
        (0..3).for_each(|i| assert!((found[(i, i)] / second[i] - 1.0).abs() < 1e-6, "axis {i}: {found}"));
    }
    // Hardly a hole.
    let narrow = torus(0.1, 0.0999, 2, 1e-3).unwrap().volume_properties().volume;
    assert!((narrow / (2.0 * PI * PI * 0.1 * 0.0999 * 0.0999) - 1.0).abs() < 1e-9, "{narrow}");
}

#[test]
fn a_prism_over_a_concave_outline_has_its_volume_in_either_sense() {
    // An L of area 0.05, with a point on an edge.
    let l = [[0.0, 0.0], [0.2, 0.0], [0.3, 0.0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.3], [0.0, 0.3]];
    let mut reversed = l;
    reversed.reverse();
    for axis in 0..3 {
        for outline in [l, reversed] {
            let found = prism(&outline, 0.4, axis).unwrap().volume_properties();
            // exact to round-off
            assert!((found.volume - 0.02).abs() < 1e-15);
            assert!(found.centroid[axis].abs() < 1e-15);
        }
    }
    let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert!(prism(&bow_tie, 1.0, 2).is_err());
    assert!(prism(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], 1.0, 2).is_err());
}

#[test]
fn chords_lie_within_the_tolerance_of_the_circle() {
    for radius in [0.01, 0.125, 1.0] {
        let n = segments(radius, 1e-3 * radius);
        assert!(radius * (1.0 - (PI / n as f64).cos()) <= 1e-3 * radius && n <= 320);
    }
}
