//! Unit tests of `src/report/outline.rs`.

use super::*;

#[test]
fn every_outline_point_is_on_the_face_of_its_shape() {
    let v2 = |x: [f64; 2]| Vector::<2>::from(x);
    let flat = [
        Shape::Box { size: v2([0.4, 0.2]) },
        Shape::Ball { radius: 0.3 },
        Shape::Capsule { length: 0.3, radius: 0.1, axis: 1 },
        Shape::Polygon { points: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(v2).to_vec() },
        Shape::Tank { size: v2([1.0, 0.5]), thickness: 0.1 },
        Shape::Polyline { points: [[0.0, 0.0], [1.0, 0.0], [2.0, 0.5]].map(v2).to_vec(), thickness: 0.1 },
    ];
    for shape in flat {
        for x in outlines(&shape).iter().flat_map(|line| &line.points) {
            let off = shape.signed_distance(&v2([x[0], x[1]]));
            // The far side of a bend in a wall is drawn with a corner, but the wall itself is round there.
            let corner = 0.1 * (1.0 / (0.5 * 0.5_f64.atan()).cos() - 1.0);
            assert!(off.abs() < corner + 1e-9, "{shape:?}: {x:?} is {off} m off");
        }
    }
    let v3 = Vector::<3>::from([0.4, 0.2, 0.3]);
    let solid = [
        Shape::Box { size: v3 },
        Shape::Ball { radius: 0.3 },
        Shape::Capsule { length: 0.3, radius: 0.1, axis: 2 },
        Shape::Cylinder { length: 0.3, radius: 0.1, axis: 0 },
    ];
    for shape in solid {
        for x in outlines(&shape).iter().flat_map(|line| &line.points) {
            let off = shape.signed_distance(&Vector::from(*x));
            assert!(off.abs() < 1e-12, "round-off; {shape:?}: {x:?} is {off} m off");
        }
    }
}

/// How often the closed lines run around `x`, counter-clockwise.
fn winding(lines: &[Outline], x: [f64; 2]) -> i32 {
    let rises = |a: &[f64; 3], b: &[f64; 3]| {
        let right = (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
        match (a[1] <= x[1], b[1] <= x[1]) {
            (true, false) if right > 0.0 => 1,
            (false, true) if right < 0.0 => -1,
            _ => 0,
        }
    };
    let around = |line: &Outline| {
        let n = line.points.len();
        (0..n).map(|k| rises(&line.points[k], &line.points[(k + 1) % n])).sum::<i32>()
    };
    lines.iter().map(around).sum()
}

#[test]
fn closed_lines_wind_once_around_the_solid_and_never_around_its_holes() {
    let v2 = |x: [f64; 2]| Vector::<2>::from(x);
    let ring = |points: [[f64; 2]; 5]| Shape::Polyline { points: points.map(v2).to_vec(), thickness: 0.05 };
    // Water inside the line, and around it.
    let pool = ring([[-0.3, -0.2], [0.3, -0.2], [0.3, 0.2], [-0.3, 0.2], [-0.3, -0.2]]);
    let pier = ring([[-0.3, -0.2], [-0.3, 0.2], [0.3, 0.2], [0.3, -0.2], [-0.3, -0.2]]);
    for (shape, most) in [
        (Shape::Box { size: v2([0.4, 0.2]) }, 1),
        (Shape::Ball { radius: 0.3 }, 1),
        (Shape::Capsule { length: 0.3, radius: 0.1, axis: 0 }, 1),
        (Shape::Capsule { length: 0.3, radius: 0.1, axis: 1 }, 1),
        (Shape::Tank { size: v2([0.5, 0.3]), thickness: 0.1 }, 1),
        (pool.clone(), 1),
        (pier.clone(), 1),
        // Where parts overlap the lines wind twice; a part in the opposite direction would make a hole.
        (
            Shape::Compound(vec![
                (Pose::at(v2([0.05, 0.0])), Shape::Capsule { length: 0.4, radius: 0.05, axis: 1 }),
                (Pose::identity(), pool),
            ]),
            2,
        ),
        (
            Shape::Compound(vec![
                (Pose::at(v2([0.2, 0.1])), Shape::Box { size: v2([0.3, 0.3]) }),
                (Pose::identity(), pier),
            ]),
            2,
        ),
    ] {
        let lines = outlines(&shape);
        for (i, j) in (-60..60).flat_map(|i| (-60..60).map(move |j| (i, j))) {
            let x = [0.01 * (f64::from(i) + 0.31), 0.01 * (f64::from(j) + 0.47)];
            let d = shape.signed_distance(&v2(x));
            // A circle of 48 chords lies within radius · (1 − cos 3.75°) = 0.7 mm of its polygon.
            if d.abs() > 1e-3 {
                let around = winding(&lines, x);
                assert!(
                    if d < 0.0 { (1..=most).contains(&around) } else { around == 0 },
                    "{shape:?}: {around} at {x:?}"
                );
            }
        }
    }
}

#[test]
fn the_wall_of_a_closed_line_has_two_contours_without_a_seam() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]].map(Vector::<2>::from).to_vec();
    let lines = outlines(&Shape::Polyline { points, thickness: 0.1 });
    let corners: Vec<usize> = lines.iter().map(|line| line.points.len()).collect();
    assert_eq!(corners, [4, 4]);
    // Each side of each contour is a face of the wall: a seam would be as long as the wall is thick.
    for line in &lines {
        for k in 0..4 {
            let [a, b] = [k, (k + 1) % 4].map(|k| Vector::from(line.points[k]));
            assert!((b - a).norm() > 0.9, "{line:?}");
        }
    }
}
