//! Unit tests of `src/solid/righting.rs`.

use super::*;
use crate::{
    geometry::Shape,
    solid::{Role, SolidSpec},
};

/// Turn (degrees) to rest of a box (width, height) of this density over that of water, which starts turned by `start` degrees,
/// with its centre of mass off by `offset` (m).
fn box_turn(size: [f64; 2], density: f64, start: f64, offset: [f64; 2]) -> f64 {
    let shape = Shape::Box { size: Vector::from(size) };
    let spec = SolidSpec::free("box", shape, 1000.0 * density);
    let Role::Free(mut body) = spec.role else { panic!("a free body") };
    body.centre += Vector::from(offset);
    let hull = Hull::new(&spec.shape);
    let pose = Pose { position: Vector::zeros(), rotation: Bivector::from_axial(&[start.to_radians()]).exp() };
    let floating =
        Floating { hull: &hull, body: &body, pose, rho0: 1000.0, level: 0.0, free: vec![0], neutral: 1e-3 * size[1] };
    match floating.turn().expect("it floats") {
        Turn::Rests(angle) => angle.to_degrees(),
        Turn::Floods(_) => panic!("a box has no rim"),
    }
}

#[track_caller]
fn assert_turns(found: f64, exact: f64) {
    assert!((found - exact).abs() < 0.05, "turns by {found}°, exact {exact}°");
}

#[test]
fn a_square_of_half_the_density_of_water_rests_on_its_edge() {
    // BG is greatest at 0° and least at 45°: GM(45°) = b² √2²/12/… > 0.
    for start in [0.0, 5.0, 30.0, 44.0] {
        assert_turns(box_turn([0.4, 0.4], 0.5, start, [0.0, 0.0]), 45.0 - start);
    }
    assert_turns(box_turn([0.4, 0.4], 0.5, 50.0, [0.0, 0.0]), 5.0);
}

#[test]
fn a_flat_box_comes_back_and_a_high_one_falls_on_its_side() {
    for start in [10.0, 30.0, 60.0, 80.0] {
        assert_turns(box_turn([0.6, 0.2], 0.5, start, [0.0, 0.0]), start);
    }
    assert_turns(box_turn([0.2, 0.6], 0.5, 0.0, [0.0, 0.0]), 90.0);
    // Of four fifths of the density it floats level as well: GM = 0.4²/(12·0.32·0.4) … at 0° is positive for s > 0.789.
    assert_turns(box_turn([0.4, 0.4], 0.8, 10.0, [0.0, 0.0]), 10.0);
}

#[test]
fn a_box_with_its_mass_off_to_a_side_and_high_turns_over() {
    // The 2-D hydrostatics of a polygon, in steps of 0.1°: 166.8°.
    assert_turns(box_turn([0.6, 0.2], 0.4, 0.0, [0.1, 0.1]), 166.8);
}

#[test]
fn a_raft_turned_about_both_axes_comes_back_and_a_ball_stays() {
    let turn = |shape: Shape<3>, axial: [f64; 3], offset: f64| {
        let spec = SolidSpec::free("body", shape, 400.0);
        let Role::Free(mut body) = spec.role else { panic!("a free body") };
        body.centre[2] += offset;
        let hull = Hull::new(&spec.shape);
        let pose = Pose { position: Vector::zeros(), rotation: Bivector::from_axial(&axial).exp() };
        let (size, free) = (hull.shape.bounds().size().min(), vec![0, 1]);
        let floating =
            Floating { hull: &hull, body: &body, pose, rho0: 1000.0, level: 0.0, free, neutral: 1e-3 * size };
        floating.turn()
    };
    let angle = |turn: Option<Turn>| match turn {
        Some(Turn::Rests(angle)) => angle.to_degrees(),
        other => panic!("{other:?}"),
    };
    let raft = || Shape::Box { size: Vector::from([2.0, 0.6, 0.2]) };
    // 20° about x and 10° about y: the vertical is turned by |(0.349, 0.175)| rad.
    assert_turns(angle(turn(raft(), [20f64.to_radians(), 10f64.to_radians(), 0.0], 0.0)), 500f64.sqrt());
    assert_turns(angle(turn(Shape::Ball { radius: 0.3 }, [0.4, 0.0, 0.0], 0.0)), 0.0);
    // With its centre of mass below its middle a ball comes back whatever its start.
    assert_turns(angle(turn(Shape::Ball { radius: 0.3 }, [1.0, 0.0, 0.0], -0.05)), 1f64.to_degrees());
}

#[test]
fn an_open_hull_rests_with_its_rim_above_the_water_or_floods_as_it_turns() {
    // 1 m × 0.5 m with walls of 0.02 m, 0.3 m deep in the water, its centre of mass at half its height and `offset` off the middle.
    // Wall-sided: it rests at tan φ (GM + ½ BM tan² φ) = offset, with BM = 1/(12·0.3) and GM = 0.15 + BM − 0.25. The inner edge of
    // the wall is 0.48 m off the middle: water comes over it at tan φ = 0.2/0.48.
    let w = 0.02;
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [1.0 - w, 0.5], [1.0 - w, w], [w, w], [w, 0.5], [0.0, 0.5]];
    let shape = Shape::Polygon { points: points.map(Vector::from).to_vec() };
    let enclosure = crate::geometry::hollow::Enclosure::of(&shape, &Matrix::identity(), 0.02).unwrap();
    let bm = 1.0 / 3.6;
    let turn = |tangent: f64| {
        let offset = tangent * (bm - 0.1 + 0.5 * bm * tangent * tangent);
        let spec = SolidSpec::free("hull", shape.clone(), 1000.0);
        let Role::Free(mut body) = spec.role else { panic!("a free body") };
        body.mass = 300.0;
        body.centre = Vector::from([0.5 + offset, 0.25]);
        let hull = Hull { dry: enclosure.hollows.iter().collect(), ..Hull::new(&shape) };
        let pose = Pose::identity();
        let floating =
            Floating { hull: &hull, body: &body, pose, rho0: 1000.0, level: 0.0, free: vec![0], neutral: 1e-4 };
        floating.turn()
    };
    let Some(Turn::Rests(angle)) = turn(0.38) else { panic!("{:?}", turn(0.38)) };
    assert_turns(angle.to_degrees(), 0.38f64.atan().to_degrees());
    let Some(Turn::Floods(angle)) = turn(0.45) else { panic!("{:?}", turn(0.45)) };
    let exact = (0.2f64 / 0.48).atan().to_degrees();
    // The grid of 10 mm cells has the rim within half a cell.
    assert!((angle.to_degrees() - exact).abs() < 0.6, "floods at {}°, exact {exact}°", angle.to_degrees());
}
