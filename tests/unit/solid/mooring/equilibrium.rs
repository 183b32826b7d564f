use super::*;
use crate::solid::mooring::{
    forces::{BedPlane, LineMaterial, NodeSurroundings},
    sample::{self, GRAVITY, air, down},
};

/// A chain that stretches, on a stiff bed.
fn material() -> LineMaterial {
    LineMaterial { stiffness: 200.0, bed_stiffness: 3e6, bed_damping: 3e5, ..sample::material() }
}

fn bed<const D: usize>(x: &Vector<D>) -> NodeSurroundings<D> {
    let normal = -down::<D>() / GRAVITY;
    let point = Vector::from_fn(|i, _| if i == D - 1 { 0.0 } else { x[i] });
    NodeSurroundings { bed: Some(BedPlane { point, normal }), ..NodeSurroundings::air() }
}

/// Largest error of the tension at the ends over the exact one, of a hanging line of `segments` segments.
fn hanging_error<const D: usize>(segments: usize, ends: [Vector<D>; 2]) -> f64 {
    let mut line = MooringLine::straight(material(), 2.0, segments, ends);
    let left = line.find_rest(&air, &down());
    assert!(left < 1e-8, "{segments} segments: {left} of a node's weight remains");
    let (exact, _, _) = line.catenary(&air, &down()).unwrap();
    let own = line.state.end_forces.map(|force| force.norm());
    let errors = [(own[1], 2.0), (own[0], 0.0)].map(|(own, s)| (own / exact.tension(s) - 1.0).abs());
    errors[0].max(errors[1])
}

/// The error of 40 segments is below 1e-6 (found: 4.4e-8), and falls with the fourth power of their length.
#[test]
fn a_hanging_line_converges_to_the_elastic_catenary() {
    let ends = [[0.0, 0.0].into(), [1.5, 0.6].into()];
    let errors = [10, 20, 40, 80].map(|n| hanging_error::<2>(n, ends));
    println!("hanging: {errors:?}");
    assert!(errors[2] < 1e-6, "40 segments: {}", errors[2]);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((3.8..4.2).contains(&order), "order {order}");
    }
    let in_space = hanging_error::<3>(40, [[0.0, 0.0, 0.0].into(), [0.9, 1.2, 0.6].into()]);
    assert!((in_space / errors[2] - 1.0).abs() < 1e-3, "3-D has the error {in_space}");
}

/// The error of 40 segments is below 1e-5 here too (found: 1.7e-6; the bed yields by 1e-7 m), and of 10 and 20 of third order or higher,
/// wherever in a segment the line leaves the bed.
#[test]
fn a_line_partly_on_the_bed_converges_to_the_elastic_catenary() {
    let error = |segments: usize| {
        let ends = [[0.0, 0.0].into(), [1.75, 0.6].into()];
        let stiff = LineMaterial { bed_stiffness: 1e9, ..material() };
        let mut line = MooringLine::<2>::straight(stiff, 2.0, segments, ends);
        let left = line.find_rest(&bed, &down());
        assert!(left < 1e-8, "{segments} segments: {left} of a node's weight remains");
        let (exact, _, _) = line.catenary(&bed, &down()).unwrap();
        assert!(exact.lying() > 0.3, "{} m lie", exact.lying());
        let own = line.state.end_forces.map(|force| force.norm());
        [(own[1], 2.0), (own[0], 0.0)]
            .map(|(own, s)| (own / exact.tension(s) - 1.0).abs())
            .into_iter()
            .fold(0.0, f64::max)
    };
    let errors = [10, 20, 40].map(error);
    println!("on the bed: {errors:?}");
    let order = (errors[0] / errors[1]).log2();
    assert!(errors[2] < 1e-5 && order > 3.0, "{errors:?}, order {order}");
}

#[test]
fn a_slack_line_lies_down_and_a_buoyant_one_rises() {
    let mut line = MooringLine::<2>::straight(material(), 2.0, 40, [[0.0, 0.0].into(), [0.5, 1.0].into()]);
    assert!(line.find_rest(&bed, &down()) < 1e-8);
    let [anchor, fairlead] = line.state.end_forces;
    // The foot of the hanging part and the anchor bear their nodes to half a segment.
    assert!(
        anchor.norm() < 1.01 * 0.025 * 0.1 * GRAVITY && (fairlead[1] / (-0.1 * GRAVITY) - 1.0).abs() < 0.05,
        "{anchor} {fairlead}"
    );

    let light = LineMaterial { mass: 0.006, ..material() };
    let water = |_: &Vector<2>| NodeSurroundings { wet: 1.0, ..NodeSurroundings::air() };
    let mut line = MooringLine::<2>::straight(light, 2.0, 40, [[0.0, 0.0].into(), [1.0, 0.0].into()]);
    assert!(line.find_rest(&water, &down()) < 1e-8);
    assert!(line.state.x[20][1] > 0.5, "its middle rises to {} m", line.state.x[20][1]);
}

/// A line that hangs straight down with a weight on its end stretches by its table: two slopes, linear between and beyond the rows.
#[test]
fn a_table_gives_the_tension() {
    let rows: [[f64; 2]; 3] = [[0.0, 0.0], [0.1, 1.0], [0.2, 5.0]];
    let line = LineMaterial { stiffness: 40.0, table: Some(rows.into()), mass: 1e-6, ..material() };
    for (weight, strain) in [(0.5, 0.05), (1.0, 0.1), (3.0, 0.15), (9.0, 0.3)] {
        let mut hung = MooringLine::<2>::straight(line.clone(), 2.0, 8, [[0.0, 0.0].into(), [0.0, -2.5].into()]);
        hung.bodies[4].mass = weight / GRAVITY;
        // The lower half is slack: its end is as high as the weight.
        hung.state.x[8] = [0.0, -1.0].into();
        hung.find_rest(&air, &down());
        let length = -hung.state.x[4][1];
        assert!((length - (1.0 + strain)).abs() < 1e-4, "{weight} N: {length} m");
    }
}

/// Water 0.8 m deep over a floor as thick as a tank's, below which there is nothing. The wet share grows over 0.04 m.
fn sea<const D: usize>(x: &Vector<D>) -> NodeSurroundings<D> {
    let z = x[D - 1];
    let near = (-0.12..0.15).contains(&z);
    let wet = if z < -0.02 { 0.0 } else { ((0.8 - z) / 0.04 + 0.5).clamp(0.0, 1.0) };
    NodeSurroundings { wet, bed: bed(x).bed.filter(|_| near), ..NodeSurroundings::air() }
}

#[test]
fn a_float_in_the_middle_of_a_chain_rises_to_the_surface() {
    let chain = LineMaterial { mass: 0.8, diameter: 0.01, stiffness: 1e4, ..sample::material() };
    for segments in [20, 40] {
        let mut line = MooringLine::<2>::straight(chain.clone(), 2.0, segments, [[2.3, 0.8].into(), [0.9, 0.0].into()]);
        line.bodies[segments / 2].mass = 0.2;
        line.bodies[segments / 2].volume = 2e-3;
        assert!(line.find_rest(&sea, &down()) < 1e-6);
        let lowest = line.state.x.iter().map(|x| x[1]).fold(f64::INFINITY, f64::min);
        assert!(lowest > -1e-3, "a node at {lowest} m, below the floor");
        // It bears 1.8 kg at most and has at most 2 m of chain of 0.72 kg/m to bear: it floats, partly out of the water.
        let float = line.state.x[segments / 2][1];
        assert!((0.77..0.83).contains(&float), "the float is at {float} m");
        // Two halves of 1 m between the surface, the fairlead beside it and the anchor: the fairlead bears half of the 0.72 kg/m of the
        // chain between it and the float.
        let pull = line.state.end_forces[0];
        assert!((pull[1] / (-0.5 * 0.7215 * GRAVITY) - 1.0).abs() < 0.1, "the fairlead bears {pull} N");
    }
}

#[test]
fn a_buoyant_line_that_reaches_the_surface_lies_on_it() {
    let line = LineMaterial { mass: 0.8, diameter: 0.05, stiffness: 1e4, ..sample::material() };
    let mut line = MooringLine::<2>::straight(line, 1.75, 20, [[2.3, 0.8].into(), [0.9, 0.0].into()]);
    assert!(line.find_rest(&sea, &down()) < 1e-6);
    let highest = line.state.x.iter().map(|x| x[1]).fold(0.0, f64::max);
    assert!((0.78..0.83).contains(&highest), "a node at {highest} m, the surface is at 0.8 m");
    // Buoyancy less weight, 1.163 kg/m g, over the depth of 0.8 m: so much more is the tension at the anchor.
    let [fairlead, anchor] = line.state.end_forces.map(|force| force.norm());
    assert!((anchor - fairlead - 9.13).abs() < 0.5, "fairlead {fairlead} N, anchor {anchor} N");
}

/// Loops of a buoyant line between ends 0.2 m apart and 0.27 m above the water: all are longer than the way to the surface and
/// back.
#[test]
fn loops_of_buoyant_line_that_hang_into_the_water_float_on_it() {
    let material = LineMaterial { mass: 1.0, diameter: 0.04, stiffness: 2e3, ..sample::material() };
    let water = |x: &Vector<2>| sea(&(x + Vector::from([0.0, 0.5])));
    for (length, segments) in [(0.85, 20), (0.85, 30), (1.0, 20), (1.0, 30), (1.1, 20), (1.25, 30), (1.4, 20)] {
        let ends = [[0.5, 0.57].into(), [0.7, 0.57].into()];
        let mut line = MooringLine::<2>::straight(material.clone(), length, segments, ends);
        let left = line.find_rest(&water, &down());
        // Of the many shapes of a slack line on the water none is exactly at rest, until it folds.
        assert!(left < if length < 0.9 { SETTLED } else { 2.0 }, "{length} m: {left} of a node's weight remains");
        let lowest = line.state.x.iter().map(|x| x[1]).fold(1.0, f64::min);
        assert!((0.28..0.31).contains(&lowest), "{length} m: the lowest node is at {lowest} m, the surface at 0.3 m");
        // Each side bears what hangs above the water, some 0.27 m of 1 kg/m.
        let [first, _] = line.state.end_forces;
        assert!((-first[1] / (0.27 * GRAVITY) - 1.0).abs() < 0.2, "{length} m: {first} N");
    }
}
