//! Panels of balls, cylinders, boxes and compounds: area, volume, number and cut at the still water.

use std::f64::consts::PI;

use super::*;

fn panels(shape: &Shape<3>, pose: Pose<3>, size: f64) -> Vec<Facet<3>> {
    wetted_panels(shape, &pose, 0.0, size, |_| true)
}

/// Longest edge of any panel, m.
fn longest(panels: &[Facet<3>]) -> f64 {
    let edges = panels.iter().flat_map(|panel| (0..3).map(|i| (panel[(i + 1) % 3] - panel[i]).norm()));
    edges.fold(0.0, f64::max)
}

#[test]
fn round_shapes_keep_their_volume() {
    let (radius, length) = (0.2, 0.5);
    let ball = Shape::Ball { radius };
    let capsule = Shape::Capsule { length, radius, axis: 0 };
    let cylinder = Shape::Cylinder { length, radius, axis: 2 };
    let (sphere, tube) = (4.0 / 3.0 * PI * radius.powi(3), PI * radius * radius * length);
    for (shape, volume) in [(ball, sphere), (capsule, sphere + tube), (cylinder, tube)] {
        // Half under water.
        let half = panels(&shape, Pose::identity(), 0.04);
        assert!((panel_volume(&half, 0.0) / (0.5 * volume) - 1.0).abs() < 1e-9, "{shape:?}");
        assert!(longest(&half) < 1.6 * 0.04, "{shape:?}: {}", longest(&half));
        assert!(half.iter().flatten().all(|x| x[2] <= 0.0));
        // All of it.
        let whole = panels(&shape, Pose::at(Vector::from([1.0, 2.0, -3.0])), 0.04);
        assert!((panel_volume(&whole, 0.0) / volume - 1.0).abs() < 1e-9, "{shape:?}");
        let exact = 4.0 * PI * radius * radius;
        // Chords of 0.04 m in a circle of 0.2 m: 1 - (0.2)²/24 in each direction, and the scale to the volume.
        if matches!(shape, Shape::Ball { .. }) {
            assert!((panel_area(&whole) / exact - 1.0).abs() < 0.01);
            // Two panels in each square, and narrower ones towards the poles.
            assert!((1.0..2.0).contains(&(whole.len() as f64 / (2.0 * exact / 0.0016))), "{} panels", whole.len());
        }
    }
}

#[test]
fn flat_faces_are_halved_and_cut_exactly() {
    let shape = Shape::Box { size: Vector::from([0.4, 0.3, 0.2]) };
    let flat = panels(&shape, Pose::identity(), 0.05);
    assert!((panel_volume(&flat, 0.0) - 0.4 * 0.3 * 0.1).abs() < 1e-14);
    assert!((panel_area(&flat) - (0.4 * 0.3 + 1.4 * 0.1)).abs() < 1e-12);
    assert!(longest(&flat) < 1.6 * 0.05);
    // Heeled by 20 degrees about x, the water halves it.
    let heeled = panels(&shape, Pose::rotated(Vector::zeros(), &[20f64.to_radians(), 0.0, 0.0]), 0.05);
    assert!((panel_volume(&heeled, 0.0) - 0.5 * 0.4 * 0.3 * 0.2).abs() < 1e-6);
    let dry = panels(&shape, Pose::at(Vector::from([0.0, 0.0, 0.1])), 0.05);
    assert!(dry.is_empty(), "its bottom lies on the water");
}

#[test]
fn touching_parts_have_no_panels_between_them() {
    let part = |x: f64| (Pose::at(Vector::from([x, 0.0, 0.0])), Shape::Box { size: Vector::from([0.2, 0.3, 0.2]) });
    let two = Shape::Compound(vec![part(-0.1), part(0.1)]);
    let panels = panels(&two, Pose::identity(), 0.05);
    assert!((panel_area(&panels) - (0.4 * 0.3 + 1.4 * 0.1)).abs() < 1e-12);
    assert!((panel_volume(&panels, 0.0) - 0.4 * 0.3 * 0.1).abs() < 1e-14);
}

#[test]
fn faces_that_are_not_in_the_water_around_have_no_panels() {
    let tank = Shape::Tank { size: Vector::from([0.4, 0.3, 0.2]), thickness: 0.02 };
    let pose = Pose::at(Vector::from([0.0, 0.0, -0.1]));
    // The inside is dry: a box of 0.44 m × 0.34 m × 0.12 m is left.
    let inside = |x: &Vector<3>| (0..3).all(|i| x[i] > 0.0) && x[0] < 0.4 && x[1] < 0.3;
    let outer = wetted_panels(&tank, &pose, 0.0, 0.05, |x| !inside(x));
    assert!((panel_volume(&outer, 0.0) - 0.44 * 0.34 * 0.12).abs() < 1e-12);
    assert!((panel_area(&outer) - (0.44 * 0.34 + 2.0 * 0.78 * 0.12)).abs() < 1e-12);
}

#[test]
fn a_face_that_another_part_covers_in_part_has_panels_beside_it() {
    // A fender on the middle of a side, smaller than most panels and off their edges.
    let part = |at: [f64; 3], size: [f64; 3]| (Pose::at(Vector::from(at)), Shape::Box { size: Vector::from(size) });
    for size in [0.05, 0.2] {
        let hull =
            Shape::Compound(vec![part([0.0; 3], [0.4, 0.3, 0.2]), part([0.22, 0.01, -0.05], [0.04, 0.06, 0.06])]);
        let panels = panels(&hull, Pose::identity(), size);
        let (area, volume) = (0.4 * 0.3 + 1.4 * 0.1 + 4.0 * 0.04 * 0.06, 0.4 * 0.3 * 0.1 + 0.04 * 0.0036);
        // Straight cuts miss the corners of the fender by a part of a panel that was halved six times.
        assert!((panel_area(&panels) / area - 1.0).abs() < 2e-3, "{size}: area {} for {area}", panel_area(&panels));
        assert!((panel_volume(&panels, 0.0) / volume - 1.0).abs() < 2e-3, "{size}: {}", panel_volume(&panels, 0.0));
    }
}
