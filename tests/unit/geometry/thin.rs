//! Unit tests of `src/geometry/thin.rs`.

use super::*;
use crate::geometry::{ContactGeometry, Mesh};

fn polygon(points: &[[f64; 2]]) -> Shape<2> {
    Shape::Polygon { points: points.iter().map(|&x| Vector::from(x)).collect() }
}

/// A box from the origin to `max` as a mesh.
fn plate(max: [f64; 3]) -> Shape<3> {
    let corners: Vec<_> = (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 1 { max[k] } else { 0.0 })).collect();
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets: Vec<_> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Shape::Mesh { mesh: Mesh::new(&corners, &facets).unwrap().into(), contact: ContactGeometry::default() }
}

#[test]
fn a_thin_keel_has_one_layer_in_its_middle() {
    // 0.4 dp thick and 20 dp deep below a hull: 20 particles, one for each dp of depth.
    let dp = 0.01;
    for (thick, turn) in [(0.004, 0.0), (0.0007, 0.3_f64)] {
        let (w, (sin, cos)) = (0.5 * thick, turn.sin_cos());
        let hull = [[-0.15, 0.0], [-w, 0.0], [-w, -0.2], [w, -0.2], [w, 0.0], [0.15, 0.0], [0.15, 0.1], [-0.15, 0.1]];
        let hull = hull.map(|[x, y]| [x * cos - y * sin, x * sin + y * cos]);
        let points = polygon(&hull).boundary_points(dp, 4);
        let mut depths: Vec<f64> = Vec::new();
        for r in points.iter().map(|p| p.r) {
            let (x, y) = (r[0] * cos + r[1] * sin, r[1] * cos - r[0] * sin);
            if y < -1e-6 {
                assert!(x.abs() < 1e-6, "{x} m from the middle at {y}");
                depths.push(-y / dp);
            }
        }
        depths.sort_by(f64::total_cmp);
        assert_eq!(depths.len(), 20, "{thick}: {depths:?}");
        assert!((depths[19] - 19.5).abs() < 0.2, "{depths:?}");
        // The spacing bounds are those of the other shapes.
        assert!(depths.windows(2).all(|d| (0.7..1.2).contains(&(d[1] - d[0]))), "{depths:?}");
    }
}

#[test]
fn a_thin_mesh_has_one_layer_in_its_middle() {
    let dp = 0.05;
    for thick in [0.9, 0.4, 0.1] {
        let sheet = plate([0.8, 0.6, thick * dp]);
        let points = sheet.boundary_points(dp, 4);
        assert!((points.len() as f64 - 16.0 * 12.0).abs() <= 4.0, "{thick} dp: {} points", points.len());
        assert!(points.iter().all(|p| (p.r[2] - 0.5 * thick * dp).abs() < 1e-6 * dp));
        // Half the diagonal of a cell is 0.71 dp; disorder adds a third. Rows at the rim are half a dp inside it.
        for i in 0..60 * 44 {
            let x = Vector::from([(i % 60) as f64 * 0.0125 + 0.03125, (i / 60) as f64 * 0.0125 + 0.03125, 0.0]);
            let nearest = points.iter().map(|p| (p.r - x).xy().norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.95 * dp, "a gap of {} dp at {x}", nearest / dp);
        }
    }
}

#[test]
fn thick_shapes_and_blunt_tips_have_no_thin_parts() {
    let dp = 0.05;
    assert!(!has_thin_parts(&polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.2], [0.0, 0.2]]), dp, dp));
    // A wedge of 25 degrees.
    assert!(!has_thin_parts(&polygon(&[[0.0, 0.0], [1.0, -0.2217], [1.0, 0.2217]]), dp, dp));
    assert!(!has_thin_parts(&plate([0.5, 0.5, 0.2]), dp, dp));
}
