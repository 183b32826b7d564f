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
    assert_eq!(points.iter().filter(|p| p.layer == 0).count(), 12 + 2 * 5);
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
    let tank = Shape::Tank { size: Vector::from([1e5, 1e5]), thickness: 2.0 };
    assert_eq!(tank.boundary_points(1.0, 1).len(), 300_002);
}

#[test]
fn the_joint_of_a_compound_has_no_double_points_and_no_gap() {
    let half = Shape::Box { size: Vector::from([0.5, 0.4]) };
    let at = |x: f64| Pose::at(Vector::from([x, 0.0]));
    let joined = Shape::Compound(vec![(at(0.0), half.clone()), (at(0.5), half)]);
    assert_eq!(joined.boundary_points(0.1, 9).len(), 40);
}
