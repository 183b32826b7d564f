//! Unit tests of `src/geometry/boundary_points.rs`.

use super::*;

/// Smallest distance between two points, and largest from a point to its nearest neighbour.
fn spacing<const D: usize>(points: &[BoundaryPoint<D>]) -> (f64, f64) {
    let nearest = |i: usize| {
        let others = points.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, p)| (p.r - points[i].r).norm()).fold(f64::INFINITY, f64::min)
    };
    (0..points.len()).map(nearest).fold((f64::INFINITY, 0.0), |(a, b), d| (a.min(d), b.max(d)))
}

fn first_layer_depth<const D: usize>(shape: &Shape<D>, dp: f64) {
    for p in shape.boundary_points(dp, 3) {
        let depth = -shape.signed_distance(&p.r) / dp;
        assert!((depth - (p.layer as f64 + 0.5)).abs() < 1e-6, "{shape:?}: layer {} at {depth} dp", p.layer);
    }
}

#[test]
fn the_boundary_points_of_a_box_of_ten_by_ten_dp_are_on_the_lattice() {
    let block = Shape::Box { size: Vector::from([1.0, 1.0]) };
    let points = block.boundary_points(0.1, 1);
    assert_eq!(points.len(), 36);
    for p in &points {
        for x in p.r.iter() {
            let cell = (x + 0.5) / 0.1 - 0.5;
            assert!((cell - cell.round()).abs() < 1e-12);
        }
    }
    assert_eq!(block.boundary_points(0.1, 9).len(), 100);
    first_layer_depth(&block, 0.1);
    first_layer_depth(&Shape::Box { size: Vector::from([0.6, 0.4, 0.5]) }, 0.1);
}

#[test]
fn discs_and_balls_have_one_boundary_point_per_cell_of_surface() {
    let (dp, radius): (f64, f64) = (0.1, 1.03);
    let disc = Shape::<2>::Ball { radius };
    assert_eq!(disc.boundary_points(dp, 1).len(), (TAU * (radius - 0.05) / dp).round() as usize);
    let ball = Shape::<3>::Ball { radius };
    assert_eq!(ball.boundary_points(dp, 1).len(), (4.0 * PI * (radius - 0.05).powi(2) / (dp * dp)).round() as usize);
    first_layer_depth(&disc, dp);
    first_layer_depth(&ball, dp);
    first_layer_depth(&Shape::<2>::Capsule { length: 1.0, radius: 0.4, axis: 1 }, dp);
    first_layer_depth(&Shape::<3>::Capsule { length: 1.0, radius: 0.4, axis: 0 }, dp);
    first_layer_depth(&Shape::<3>::Cylinder { length: 1.0, radius: 0.4, axis: 0 }, dp);
}

#[test]
fn boundary_points_are_evenly_spaced() {
    let dp = 0.1;
    for radius in [0.05, 0.1, 0.23, 0.5, 0.97] {
        let flat = [Shape::<2>::Ball { radius }, Shape::Capsule { length: 0.7, radius, axis: 0 }];
        let solid = [
            Shape::<3>::Ball { radius },
            Shape::Capsule { length: 0.7, radius, axis: 1 },
            Shape::Cylinder { length: 0.7, radius, axis: 2 },
        ];
        let all = flat.iter().map(|s| s.boundary_points(dp, 4)).map(|s| (s.len(), spacing(&s)));
        for (n, (least, most)) in
            all.chain(solid.iter().map(|s| s.boundary_points(dp, 4)).map(|s| (s.len(), spacing(&s))))
        {
            assert!(n > 0 && least >= MIN_SPACING * dp, "radius {radius}: {n} points, {least}");
            assert!(n == 1 || most <= 1.2 * dp, "radius {radius}: {most}");
        }
    }
}

#[test]
fn the_boundary_points_of_a_tank_continue_the_lattice_of_the_water() {
    let points = Shape::Tank { size: Vector::from([1.0, 0.5]), thickness: 0.3 }.boundary_points(0.1, 3);
    assert_eq!(points.len(), 16 * 3 + 2 * 3 * 5);
    // Layers count from the nearest face: the middle one of three has 14 cells in the bottom and 5 in each side.
    assert_eq!(points.iter().filter(|p| p.layer == 1).count(), 14 + 2 * 5);
    assert_eq!(points.iter().filter(|p| p.layer == 2).count(), 0);
}

#[test]
fn skipping_interior_cells_misses_no_cell_near_a_face() {
    for high in [[0, 0], [3, 9], [7, 2], [9, 11]] {
        let (mut all, mut outer) = (Vec::new(), Vec::new());
        let near = |at: &[i64; 2]| (0..2).any(|i| at[i] < 2 || high[i] - at[i] < 2);
        for_each_index(&[0; 2], &high, |at| all.extend(near(at).then_some(*at)));
        each_outer(&[0; 2], &high, 2, |at| outer.extend(near(at).then_some(*at)));
        assert_eq!(all, outer, "in the same order");
    }
    // 1e10 cells of air, none of which is visited.
    let tank = Shape::Tank { size: Vector::from([1e5, 1e5]), thickness: 1.0 };
    assert_eq!(tank.boundary_points(1.0, 1).len(), 300_002);
}

#[test]
fn the_joint_of_a_compound_has_no_double_points_and_no_gap() {
    let half = Shape::Box { size: Vector::from([0.5, 0.4]) };
    let at = |x: f64| Pose::at(Vector::from([x, 0.0]));
    let joined = Shape::Compound(vec![(at(0.0), half.clone()), (at(0.5), half)]);
    assert_eq!(joined.boundary_points(0.1, 9).len(), 40);
}

/// Checks that each cell of dp that `shape` fills less than `layers` dp below a face has a particle, and that there are
/// no particles but for those and the diagonals of corners.
fn fills_its_walls<const D: usize>(shape: &Shape<D>, dp: f64, layers: usize) {
    let points = shape.boundary_points(dp, layers);
    let depth = |x: &Vector<D>| -shape.signed_distance(x) / dp;
    let deepest = (layers as f64 - 0.5) * (D as f64).sqrt();
    assert!(points.iter().all(|p| depth(&p.r) > 0.5 - 1e-6 && depth(&p.r) < deepest + 1e-6));
    assert!(spacing(&points).0 > 0.99 * dp);
    let bounds = shape.bounds();
    let cells: [i64; D] = std::array::from_fn(|i| (bounds.size()[i] / dp).round() as i64);
    for_each_index(&[0; D], &cells.map(|n| n - 1), |at| {
        let x = bounds.min + Vector::from_fn(|i, _| (at[i] as f64 + 0.5) * dp);
        let has_particle = || points.iter().any(|p| (p.r - x).norm() < 1e-6 * dp);
        assert!(depth(&x) < 0.0 || depth(&x) > layers as f64 || has_particle(), "no particle at {x}");
    });
}

#[test]
fn thick_walls_have_layers_from_every_face() {
    for thickness in [0.1, 0.3, 0.6, 1.0, 1.3] {
        fills_its_walls(&Shape::Tank { size: Vector::from([1.2, 0.8]), thickness }, 0.1, 3);
        let hook = [[0.0, 0.8], [0.0, 0.0], [1.2, 0.0], [1.2, 0.8]].map(Vector::from).to_vec();
        fills_its_walls(&Shape::Polyline { points: hook, thickness }, 0.1, 3);
    }
    fills_its_walls(&Shape::Tank { size: Vector::from([0.5, 0.4, 0.3]), thickness: 0.9 }, 0.1, 2);
    fills_its_walls(&Shape::Tank { size: Vector::from([0.5, 0.4, 0.3]), thickness: 0.2 }, 0.1, 4);
}

#[test]
fn walls_of_any_thickness_have_the_particles_of_their_volume() {
    // Wall cells across are round(thickness/dp), as in a box; the outermost lie half a cell inside the outer face.
    for thickness in [0.04, 0.13, 0.26, 0.44, 0.75, 1.07] {
        let cells = (thickness / 0.1_f64).round().max(1.0);
        let hook = [[0.0, 0.8], [0.0, 0.0], [1.2, 0.0], [1.2, 0.8]].map(Vector::from).to_vec();
        let walls =
            [Shape::Tank { size: Vector::from([1.2, 0.8]), thickness }, Shape::Polyline { points: hook, thickness }];
        for wall in walls {
            let points = wall.boundary_points(0.1, 9);
            let lowest = points.iter().map(|p| p.r[1]).fold(f64::INFINITY, f64::min);
            assert!((lowest + thickness * (1.0 - 0.5 / cells)).abs() < 1e-9, "{wall:?}: {lowest}");
            let expected = cells * (12.0 + 2.0 * cells + 2.0 * 8.0);
            // The curves of a polyline are divided by their own length.
            assert!((points.len() as f64 - expected).abs() <= 3.0 * cells, "{wall:?}: {} for {expected}", points.len());
        }
    }
}

#[test]
fn a_thick_wall_costs_no_time_for_its_core() {
    let bed = [[0.0, 0.0], [4e3, 0.0]].map(Vector::from).to_vec();
    let points = Shape::Polyline { points: bed, thickness: 50.0 }.boundary_points(1.0, 3);
    assert_eq!(points.len(), 2 * 3 * 4000 + 2 * 3 * (50 - 6));
    let tank = Shape::Tank { size: Vector::from([4e3, 1e3]), thickness: 1e3 };
    // All cells of the walls less those three or more cells below every face: 8·10⁶ − (5994·1994 − 4006·1000).
    assert_eq!(tank.boundary_points(1.0, 3).len(), 53_964);
}

/// Least sum Σ V W (Wendland, h = 1.5 dp) below the upper face of a mesh block of 16 × 12 × `thickness` dp, turned in its
/// file by `turn` (rad) around two axes, at depths of 0.5, 1 and 1.5 dp and up to its edges. Lattices surround the block.
fn least_sum_in_block(thickness: f64, turn: f64) -> f64 {
    use std::sync::Arc;

    use crate::geometry::{ContactGeometry, Mesh};
    let (sin, cos) = turn.sin_cos();
    let about_up = |x: Vector<3>| Vector::from([cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]]);
    let about_first = |x: Vector<3>| Vector::from([x[0], cos * x[1] - sin * x[2], sin * x[1] + cos * x[2]]);
    let turned = |x: Vector<3>| about_first(about_up(x));
    let size = [16.0, 12.0, thickness];
    let corner = |c: usize| turned(Vector::from_fn(|i, _| if c >> i & 1 == 1 { size[i] } else { 0.0 }));
    let corners: Vec<_> = (0..8).map(corner).collect();
    let facets = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]];
    let others = [[2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]];
    let mesh = Mesh::new(&corners, &[facets, others].concat()).expect("a closed block");
    let block = Shape::Mesh { mesh: Arc::new(mesh), contact: ContactGeometry::None };
    let mut all: Vec<Vector<3>> = block.boundary_points(1.0, 3).iter().map(|p| p.r).collect();
    let across = thickness.round().max(1.0);
    for_each_index(&[-3, -3, -3], &[18, 14, 2 + across as i64], |at| {
        let (x, y, z) = (at[0] as f64 + 0.5, at[1] as f64 + 0.5, at[2] as f64 + 0.5);
        let beside = !(0.0..size[0]).contains(&x) || !(0.0..size[1]).contains(&y);
        let height = if z < 0.0 {
            z
        } else if z > across {
            z - across + thickness
        } else {
            z * thickness / across
        };
        if beside || !(0.0..across).contains(&z) {
            all.push(turned(Vector::from([x, y, height])));
        }
    });
    let weight = |r: f64| 21.0 / (16.0 * PI * 1.5_f64.powi(3)) * (1.0 - r / 3.0).max(0.0).powi(4) * (1.0 + r / 0.75);
    let mut least = f64::INFINITY;
    for_each_index(&[0, 0, 1], &[32, 24, 3], |at| {
        let [x, y, depth] = at.map(|n| 0.5 * n as f64);
        if depth < thickness {
            let x = turned(Vector::from([x, y, thickness - depth]));
            least = least.min(all.iter().map(|p| weight((p - x).norm())).sum());
        }
    });
    least
}

#[test]
fn mesh_walls_of_any_thickness_have_no_holes() {
    // Between whole layers the innermost points left holes of 0.70 to 0.83, through which water sank into a bed. A plate of
    // 2.4 dp has no place for its last points, and 0.80.
    let thicknesses = [1.3, 2.0, 2.2, 2.3, 2.5, 2.6, 3.0, 3.2, 3.33, 3.5, 3.6, 4.0, 4.5, 5.3];
    for (thickness, turn) in thicknesses.map(|t| (t, 0.0)).into_iter().chain([(3.2, 0.4), (3.5, 0.4)]) {
        let least = least_sum_in_block(thickness, turn);
        assert!(least > 0.85, "{thickness} dp, turned {turn}: {least}");
    }
}
