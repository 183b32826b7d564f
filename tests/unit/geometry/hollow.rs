//! Unit tests of `src/geometry/hollow.rs`.

use std::sync::Arc;

use super::*;
use crate::geometry::{ContactGeometry, Mesh};

/// An open barge, 1 m × 0.5 m, with walls of 0.1 m.
fn barge() -> Shape<2> {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.9, 0.5], [0.9, 0.1], [0.1, 0.1], [0.1, 0.5], [0.0, 0.5]];
    Shape::Polygon { points: points.map(Vector::from).to_vec() }
}

fn enclosure<const D: usize>(shape: &Shape<D>, dp: f64) -> Option<Enclosure<D>> {
    Enclosure::of(shape, &Matrix::identity(), dp)
}

/// Volume of a whole hollow that begins and ends within 10 m of the frame's origin.
fn volume<const D: usize>(hollow: &Hollow<D>) -> f64 {
    hollow.volume_and_moment_below(&Pose::identity(), 10.0).0
}

/// Boxes (size, centre) as one solid.
fn compound<const D: usize>(boxes: &[([f64; D], [f64; D])]) -> Shape<D> {
    let part =
        |(size, at): &([f64; D], [f64; D])| (Pose::at(Vector::from(*at)), Shape::Box { size: Vector::from(*size) });
    Shape::Compound(boxes.iter().map(part).collect())
}

#[test]
fn the_space_in_an_open_barge_is_exact_at_every_level() {
    for dp in [0.02, 0.013] {
        let found = enclosure(&barge(), dp).unwrap();
        let [hollow] = &found.hollows[..] else { panic!("{} hollows", found.hollows.len()) };
        let pose = Pose::at(Vector::from([2.0, -0.1]));
        // The rim is the top of the wall; the grid resolves it to a part of a cell.
        assert!((hollow.rim_height(&pose) - 0.4).abs() < 0.1 * dp, "rim {}", hollow.rim_height(&pose));
        for level in [0.044, 0.15, 0.3] {
            let (volume, first) = hollow.volume_and_moment_below(&pose, level);
            // A grid that does not fit the walls errs in the two corners, by less than a cell each.
            let error = 0.5 * dp * dp;
            assert!((volume - 0.8 * level).abs() < error, "dp {dp}, level {level}: {volume}");
            let centre = first / volume;
            assert!((hollow.level_of(&pose, volume) - level).abs() < 1e-9);
            assert!((centre[0] - 2.5).abs() < 1e-3 && (centre[1] - 0.5 * level).abs() < 0.02 * dp, "{centre}");
        }
    }
}

#[test]
fn a_turned_barge_holds_less_and_an_upturned_one_nothing() {
    // Heeled by φ the rim is the lower wall's top; below it the hollow holds A = b d − ½ b² tan φ of its section b × d,
    // with the inner edge of the wall at the rim.
    let turn = Pose::<2>::rotated(Vector::zeros(), &[0.1]);
    let found = Enclosure::of(&barge(), &turn.rotation, 0.01).unwrap();
    let hollow = &found.hollows[0];
    let rim = turn.point(&Vector::from([0.1, 0.5]))[1];
    // The highest point of the lower wall's top is its inner edge.
    assert!((hollow.rim_height(&turn) - rim).abs() < 0.006, "{} for {rim}", hollow.rim_height(&turn));
    let (volume, _) = hollow.volume_and_moment_below(&turn, rim - 0.05);
    let depth = |x: f64| rim - 0.05 - turn.point(&Vector::from([x, 0.1]))[1];
    let exact = 0.5 * (depth(0.1) + depth(0.9)) * 0.8 / 0.1f64.cos() * 0.1f64.cos().powi(2);
    // Two walls of 0.4 m that cut cells of 5 mm: each errs by a small part of a cell's width.
    assert!((volume / exact - 1.0).abs() < 0.02, "{volume}, exact {exact}");
    let over = Pose::<2>::rotated(Vector::zeros(), &[std::f64::consts::PI]);
    assert!(Enclosure::of(&barge(), &over.rotation, 0.02).is_none(), "water stands under it as high as outside");
}

#[test]
fn the_rim_turns_with_the_hull() {
    // The highest point of the lower wall's top is its inner edge.
    let found = enclosure(&barge(), 0.01).unwrap();
    for angle in [-0.3, 0.1, 0.5] {
        let turn = Pose::<2>::rotated(Vector::zeros(), &[angle]);
        let inner = if angle > 0.0 { 0.1 } else { 0.9 };
        let rim = turn.point(&Vector::from([inner, 0.5]))[1];
        let told = found.hollows[0].rim_height(&turn);
        assert!((told - rim).abs() < 0.006, "turned by {angle}: {told} for {rim}");
    }
    // A hull with a wall of 0.3 m on the left and of 0.5 m on the right.
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.9, 0.5], [0.9, 0.1], [0.1, 0.1], [0.1, 0.3], [0.0, 0.3]];
    let found = enclosure(&Shape::Polygon { points: points.map(Vector::from).to_vec() }, 0.01).unwrap();
    let turn = Pose::<2>::rotated(Vector::zeros(), &[-0.4]);
    let rim = turn.point(&Vector::from([0.9, 0.5]))[1];
    let told = found.hollows[0].rim_height(&turn);
    assert!((told - rim).abs() < 0.006, "{told} for {rim}");
    // Under a deck water comes in through the hole in the left wall alone, at 0.3 m.
    let walls = [([0.1, 0.5], [0.95, 0.25]), ([1.0, 0.1], [0.5, 0.05]), ([0.1, 0.3], [0.05, 0.15])];
    let decked = compound(&[&walls[..], &[([1.0, 0.1], [0.5, 0.45])]].concat());
    let found = enclosure(&decked, 0.01).unwrap();
    let rim = turn.point(&Vector::from([0.1, 0.3]))[1];
    let told = found.hollows[0].rim_height(&turn);
    assert!((told - rim).abs() < 0.006, "{told} for {rim}");
}

#[test]
fn shapes_without_an_inside_enclose_nothing() {
    // Two hulls under a deck, a notch less deep than two particles, a plate turned by 20°.
    let cat = compound(&[([0.16, 0.16], [-0.2, 0.0]), ([0.16, 0.16], [0.2, 0.0]), ([0.56, 0.06], [0.0, 0.11])]);
    assert!(enclosure(&cat, 0.02).is_none());
    let notched = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.6, 0.5], [0.6, 0.47], [0.4, 0.47], [0.4, 0.5], [0.0, 0.5]];
    let notched = Shape::Polygon { points: notched.map(Vector::from).to_vec() };
    assert!(enclosure(&notched, 0.02).is_none());
    let plate = Shape::<2>::Box { size: Vector::from([1.0, 0.06]) };
    assert!(Enclosure::of(&plate, &Pose::<2>::rotated(Vector::zeros(), &[0.35]).rotation, 0.02).is_none());
    assert!(!may_enclose(&plate, true) && may_enclose(&barge(), true) && !may_enclose(&barge(), false));
}

#[test]
fn a_closed_ring_of_boxes_has_a_closed_hollow_and_thin_walls_keep_it_closed() {
    // The wall is thinner than a cell of the grid and lies between its centres.
    for wall in [0.1, 0.004] {
        let (long, high) = (0.6, 0.4);
        let side = 0.5 * (long + wall);
        let lid = 0.5 * (high + wall);
        let ring = compound(&[
            ([long + 2.0 * wall, wall], [0.0, -lid]),
            ([long + 2.0 * wall, wall], [0.0, lid]),
            ([wall, high], [-side, 0.0]),
            ([wall, high], [side, 0.0]),
        ]);
        let found = enclosure(&ring, 0.02).unwrap();
        assert!(found.hollows.len() == 1 && found.hollows[0].is_closed());
        let volume = volume(&found.hollows[0]);
        assert!((volume - long * high).abs() < 0.01 * long * high, "wall {wall}: {volume}");
        let place = |x: [f64; 2]| found.place(&ring, &Vector::from(x));
        assert_eq!(place([0.0, 0.0]), Place::Hollow(0));
        assert_eq!(place([0.0, 0.6]), Place::Outside);
        assert_eq!(place([3.0, 0.0]), Place::Outside);
    }
}

#[test]
fn a_point_in_the_wall_belongs_to_the_hollow_if_that_is_nearer() {
    let found = enclosure(&barge(), 0.02).unwrap();
    let place = |x: f64| found.place(&barge(), &Vector::from([x, 0.3]));
    assert_eq!(place(0.093), Place::Hollow(0));
    assert_eq!(place(0.007), Place::Material);
    assert_eq!(place(-0.003), Place::Outside);
}

#[test]
fn two_holds_with_different_rims_are_two_hollows() {
    let holds = compound(&[
        ([1.0, 0.1], [0.0, 0.05]),
        ([0.1, 0.4], [-0.45, 0.3]),
        ([0.1, 0.3], [0.0, 0.25]),
        ([0.1, 0.2], [0.45, 0.2]),
    ]);
    let found = enclosure(&holds, 0.02).unwrap();
    let mut rims: Vec<f64> = found.hollows.iter().map(|hollow| hollow.rim_height(&Pose::identity())).collect();
    rims.sort_by(f64::total_cmp);
    // The left hold spills over the bulkhead, the right one over the side.
    assert!(rims.len() == 2 && (rims[0] - 0.3).abs() < 0.003 && (rims[1] - 0.4).abs() < 0.003, "{rims:?}");
}

/// A box with a hollow: an outer and an inner shell.
fn hollow_box(outer: [f64; 3], inner: [f64; 3]) -> Shape<3> {
    let shell = |size: [f64; 3], first: u32, inward: bool| {
        let corner = |i: u32| Vector::from_fn(|axis, _| size[axis] * (f64::from(i >> axis & 1) - 0.5));
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let facets = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let turned = facets.map(|[a, b, c]| if inward { [a, c, b] } else { [a, b, c] });
        let points: Vec<Vector<3>> = (0..8).map(corner).collect();
        (points, turned.map(|facet| facet.map(|p| p + first)).collect::<Vec<[u32; 3]>>())
    };
    let ((mut points, mut facets), (more, inside)) = (shell(outer, 0, false), shell(inner, 8, true));
    points.extend(more);
    facets.extend(inside);
    Shape::Mesh { mesh: Arc::new(Mesh::new(&points, &facets).unwrap()), contact: ContactGeometry::default() }
}

#[test]
fn an_inner_shell_of_a_mesh_is_a_closed_hollow() {
    let shape = hollow_box([0.6, 0.5, 0.4], [0.4, 0.3, 0.2]);
    assert!(may_enclose(&shape, false));
    let found = enclosure(&shape, 0.04).unwrap();
    assert!(found.hollows.len() == 1 && found.hollows[0].is_closed());
    // The distance to an edge of the hollow is less than to its two faces: a cell each along 3.6 m of edges.
    let volume = volume(&found.hollows[0]);
    assert!((volume / 0.024 - 1.0).abs() < 0.03, "{volume}");
    let (half, first) = found.hollows[0].volume_and_moment_below(&Pose::identity(), 0.0);
    assert!((half / volume - 0.5).abs() < 1e-6 && (first[2] / half + 0.05).abs() < 0.002, "{half} {first}");
}

#[test]
fn the_open_tank_is_a_hull_in_three_dimensions() {
    let tank = Shape::Tank { size: Vector::from([0.5, 0.4, 0.3]), thickness: 0.05 };
    let found = enclosure(&tank, 0.025).unwrap();
    let hollow = &found.hollows[0];
    assert!((hollow.rim_height(&Pose::identity()) - 0.3).abs() < 0.002);
    let (volume, _) = hollow.volume_and_moment_below(&Pose::identity(), 0.1);
    assert!((volume / 0.02 - 1.0).abs() < 1e-3, "{volume}");
}

/// A hull of V shape, 0.4 m high, with sides of slope 0.8 outside and 0.33/0.42 inside.
fn vee() -> Shape<2> {
    let points = [[-0.5, 0.4], [0.0, 0.0], [0.5, 0.4], [0.42, 0.4], [0.0, 0.07], [-0.42, 0.4]];
    Shape::Polygon { points: points.map(Vector::from).to_vec() }
}

#[test]
fn the_space_between_sloping_sides_is_exact_at_every_level_and_heel() {
    for dp in [0.02, 0.031, 0.04] {
        let found = enclosure(&vee(), dp).unwrap();
        let [hollow] = &found.hollows[..] else { panic!("{} hollows", found.hollows.len()) };
        for level in [0.1, 0.2, 0.37] {
            let depth = level - 0.07;
            let exact = depth * depth * 0.42 / 0.33;
            let (volume, first) = hollow.volume_and_moment_below(&Pose::identity(), level);
            assert!((volume / exact - 1.0).abs() < 1e-9, "dp {dp}, level {level}: {volume}, exact {exact}");
            // The centroid of a triangle; the sides are mirror images.
            assert!((first[1] / volume - (0.07 + 2.0 / 3.0 * depth)).abs() < 1e-9 && first[0].abs() < 1e-12);
            assert!((hollow.level_of(&Pose::identity(), exact) - level).abs() < 1e-9);
        }
        // Heeled by φ, the sides have the slopes α + φ and α − φ: half the depth squared times the sum of their cotangents.
        let (angle, slope) = (0.1, (0.33f64 / 0.42).atan());
        let turn = Pose::<2>::rotated(Vector::zeros(), &[angle]);
        let apex = turn.point(&Vector::from([0.0, 0.07]))[1];
        let exact = 0.5 * 0.15 * 0.15 * (1.0 / (slope + angle).tan() + 1.0 / (slope - angle).tan());
        let (volume, _) = hollow.volume_and_moment_below(&turn, apex + 0.15);
        assert!((volume / exact - 1.0).abs() < 1e-9, "{volume}, exact {exact}");
    }
}

#[test]
fn the_space_in_a_hull_of_turned_plates_is_exact() {
    // Two plates 0.05 m thick meet at a right angle over the keel, and overlap there: inside, a V of slope 1.
    let plate = |side: f64| {
        let at = Pose::rotated(Vector::from([side * 0.2, 0.2]), &[side * std::f64::consts::FRAC_PI_4]);
        (at, Shape::<2>::Box { size: Vector::from([0.6, 0.05]) })
    };
    let hull = Shape::Compound(vec![plate(1.0), plate(-1.0)]);
    let found = enclosure(&hull, 0.02).unwrap();
    let keel = 0.025 * 2f64.sqrt();
    let (volume, _) = found.hollows[0].volume_and_moment_below(&Pose::identity(), keel + 0.25);
    assert!((volume / 0.0625 - 1.0).abs() < 1e-9, "{volume}");
}

#[test]
fn the_space_in_a_trough_of_plates_is_exact_in_three_dimensions() {
    // The same V, 0.5 m long, between two end plates; and the V as a mesh.
    let plate = |side: f64| {
        let turn = [0.0, -side * std::f64::consts::FRAC_PI_4, 0.0];
        let at = Pose::<3>::rotated(Vector::from([side * 0.2, 0.0, 0.2]), &turn);
        (at, Shape::Box { size: Vector::from([0.6, 0.7, 0.05]) })
    };
    let end = |y: f64| (Pose::at(Vector::from([0.0, y, 0.2])), Shape::Box { size: Vector::from([0.9, 0.1, 0.5]) });
    let trough = Shape::Compound(vec![plate(1.0), plate(-1.0), end(0.3), end(-0.3)]);
    let found = enclosure(&trough, 0.05).unwrap();
    let keel = 0.025 * 2f64.sqrt();
    let (volume, first) = found.hollows[0].volume_and_moment_below(&Pose::identity(), keel + 0.25);
    assert!((volume / 0.03125 - 1.0).abs() < 1e-9, "{volume}");
    assert!((first[2] / volume - keel - 0.25 * 2.0 / 3.0).abs() < 1e-9 && first[0].abs() < 1e-12, "{first}");
}
