//! Unit tests of `src/report/contact_skin.rs`.

use super::*;
use crate::math::Pose;

fn flat(x: [f64; 2]) -> Vector<2> {
    Vector::from(x)
}

/// Errors (m) of the distances of the outline points of a skin 0.02 m thick from `shape`.
fn off<const D: usize>(shape: &Shape<D>) -> Vec<f64> {
    let ContactSkinOutline { lines, dots } = ContactSkinOutline::of_shape(shape, 0.02, 0.05);
    let points = lines.iter().flat_map(|line| &line.points).chain(&dots);
    points.map(|x| shape.signed_distance(&Vector::from_fn(|i, _| x[i])) - 0.02).collect()
}

#[test]
fn every_outline_point_of_a_skin_is_at_the_skin_thickness_from_the_shape() {
    let block = |at: [f64; 2]| (Pose::at(flat(at)), Shape::Box { size: flat([0.2, 0.1]) });
    let flat_ones = [
        Shape::Box { size: flat([0.4, 0.2]) },
        Shape::Ball { radius: 0.1 },
        Shape::Capsule { length: 0.3, radius: 0.1, axis: 0 },
        Shape::Tank { size: flat([1.0, 0.5]), thickness: 0.1 },
        // A polygon with a reentrant corner.
        Shape::Polygon { points: [[0.0, 0.0], [0.5, 0.0], [0.2, 0.2], [0.0, 0.5]].map(flat).to_vec() },
        // Two touching boxes: the part of each outline within the skin of the other is omitted.
        Shape::Compound(vec![block([0.0, 0.0]), block([0.15, 0.1])]),
    ];
    for shape in flat_ones {
        let off = off(&shape);
        // Circles have 48 corners: 0.04 mm. A cut line may end in the other skin by 2 % of its thickness, 0.4 mm.
        assert!(off.len() > 8 && off.iter().all(|x| (-5e-4..1e-9).contains(x)), "{shape:?}: {off:?}");
    }
    let cube = |at: [f64; 3]| (Pose::at(Vector::from(at)), Shape::Box { size: Vector::from([0.2, 0.2, 0.1]) });
    let deep = [
        Shape::Box { size: Vector::<3>::from([0.4, 0.2, 0.3]) },
        Shape::Ball { radius: 0.2 },
        Shape::Cylinder { length: 0.3, radius: 0.2, axis: 0 },
        Shape::Tank { size: Vector::from([0.5, 0.5, 0.4]), thickness: 0.1 },
        Shape::Compound(vec![cube([0.0, 0.0, 0.0]), cube([0.15, 0.0, 0.05])]),
    ];
    for shape in deep {
        let off = off(&shape);
        // Dots and lines are rounded to a thousandth of dp.
        assert!(off.len() > 50 && off.iter().all(|x| x.abs() < 1e-4), "{shape:?}: {off:?}");
    }
    assert_eq!(
        ContactSkinOutline::of_shape(&Shape::<2>::Ball { radius: 0.1 }, 0.0, 0.05),
        ContactSkinOutline::default()
    );
}

#[test]
fn the_skin_outline_of_a_box_is_one_closed_line_and_that_of_a_compound_is_cut_at_its_joints() {
    let block = |at: [f64; 2]| (Pose::at(flat(at)), Shape::Box { size: flat([0.2, 0.1]) });
    let lines = |shape: &Shape<2>| ContactSkinOutline::of_shape(shape, 0.02, 0.05).lines;
    let single = lines(&Shape::Box { size: flat([0.2, 0.1]) });
    assert!(single.len() == 1 && single[0].closed, "{single:?}");
    let pile = lines(&Shape::Compound(vec![block([0.0, 0.0]), block([0.15, 0.1])]));
    assert!(pile.len() == 2 && pile.iter().all(|line| !line.closed), "{pile:?}");
}

#[test]
fn the_skin_outline_of_a_3d_box_follows_its_edges_midway_between_the_face_normals() {
    let size = Vector::<3>::from([0.4, 0.2, 0.3]);
    let lines = ContactSkinOutline::of_shape(&Shape::Box { size }, 0.02, 0.05).lines;
    assert_eq!(lines.len(), 6, "two rings and four vertical lines, uncut: {lines:?}");
    for x in lines.iter().flat_map(|line| &line.points) {
        let beyond = (0..3).filter(|&i| x[i].abs() - 0.5 * size[i] > 0.01).count();
        // The points are beyond two faces by 0.02 m/√2, at corners beyond three by 0.02 m/√3.
        assert!(beyond >= 2, "{x:?} is beyond {beyond} faces");
    }
    let corners = lines.iter().flat_map(|line| &line.points).filter(|x| (0..3).all(|i| x[i].abs() > 0.5 * size[i]));
    assert_eq!(corners.count(), 4 + 4 + 4 * 2, "rings and vertical lines meet");
}

#[cfg(feature = "dim3")]
#[test]
fn the_skin_outline_of_a_mesh_box_equals_that_of_the_box() -> crate::error::Result<()> {
    use std::collections::BTreeSet;

    use crate::geometry::{ContactGeometry, Mesh};

    let size = Vector::<3>::from([0.4, 0.2, 0.3]);
    let corner = |i: u32| Vector::from_fn(|axis, _| (f64::from(i >> axis & 1) - 0.5) * size[axis]);
    let points: Vec<Vector<3>> = (0..8).map(corner).collect();
    let facets =
        [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5];
    let mesh = std::sync::Arc::new(Mesh::new(&points, facets.as_chunks::<3>().0)?);
    // Points are rounded to a thousandth of dp.
    let places = |shape: &Shape<3>| -> BTreeSet<[i64; 3]> {
        let lines = ContactSkinOutline::of_shape(shape, 0.02, 0.05).lines;
        lines.iter().flat_map(|line| &line.points).map(|x| x.map(|x| (x / 5e-5).round() as i64)).collect()
    };
    let drawn = places(&Shape::Mesh { mesh, contact: ContactGeometry::default() });
    assert!(drawn.len() > 50 && drawn == places(&Shape::Box { size }), "{drawn:?}");
    Ok(())
}
