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
