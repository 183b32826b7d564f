//! The forces of mooring lines on solids at rest in still water, before there are particles.

use super::{
    forces::{BedPlane, NodeSurroundings},
    line::MooringLine,
    specification::{MooringPointSpec, MooringSpec, junctions},
};
use crate::{
    math::{Matrix, Vector},
    solid::{Role, SolidSpec, statics::WaterAtRest},
};

/// Step (m) of the difference that gives the normal of a surface, over the length of the shortest segment.
const NORMAL_STEP: f64 = 1e-4;

/// Depth below the surface at which a node is all wet, over the length of the shortest segment.
const WET_DEPTH: f64 = 0.1;

/// Half of the displacement that gives a stiffness, over the length of the line.
const STIFFNESS_STEP: f64 = 1e-3;

/// The force (N) on the support of each end of each line between `solids` at the start. Nodes below the surface are wet.
pub(crate) fn forces_at_rest<const D: usize>(
    (moorings, points): (&[MooringSpec<D>], &[MooringPointSpec<D>]),
    solids: &[&SolidSpec<D>],
    water: &WaterAtRest,
) -> Vec<[Vector<D>; 2]> {
    let gravity = Vector::from_fn(|i, _| if i == D - 1 { -water.g } else { 0.0 });
    let segments = moorings.iter().map(|spec| spec.length / spec.segments as f64);
    let shortest = segments.fold(f64::INFINITY, f64::min);
    let around = |x: &Vector<D>| {
        let distance = |solid: &&&SolidSpec<D>| solid.shape.signed_distance(&solid.pose.local(x));
        let fixed = solids.iter().filter(|solid| matches!(solid.role, Role::Fixed));
        let nearest = fixed.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let bed = nearest.map(|solid| {
            let local = solid.pose.local(x);
            let normal = solid.pose.rotation * solid.shape.outward_normal(&local, NORMAL_STEP * shortest);
            BedPlane { point: x - normal * distance(&solid), normal }
        });
        let wet = ((water.level - x[D - 1]) / (WET_DEPTH * shortest)).clamp(0.0, 1.0);
        NodeSurroundings { water_velocity: Vector::zeros(), wet, bed }
    };
    let line = |spec: &MooringSpec<D>| {
        let material = spec.line.material(spec.length / spec.segments as f64, water.rho0);
        let ends = spec.ends.map(|end| end.at);
        let mut line = MooringLine::straight(material, spec.length_at(0.0), spec.segments, ends);
        line.bodies = spec.node_bodies();
        line
    };
    let mut lines: Vec<_> = moorings.iter().map(line).collect();
    let (junctions, bodies) = junctions(points, moorings);
    let mut all: Vec<_> = lines.iter_mut().collect();
    junctions.attach(&mut all, &bodies);
    junctions.bring_to_rest(&mut all, &around, &gravity);
    lines.into_iter().map(|line| line.state.end_forces).collect()
}

/// The force (N/m) against a displacement of end `k` of a line in no mooring point, with the line at rest.
pub(crate) fn end_stiffness_at_rest<const D: usize>(
    spec: &MooringSpec<D>,
    k: usize,
    solids: &[&SolidSpec<D>],
    water: &WaterAtRest,
) -> Matrix<D> {
    let way = STIFFNESS_STEP * spec.length;
    let column = |axis: usize| {
        let force = |way: f64| {
            let mut moved = spec.clone();
            moved.ends[k].at[axis] += way;
            forces_at_rest((&[moved], &[]), solids, water)[0][k]
        };
        (force(-way) - force(way)) / (2.0 * way)
    };
    Matrix::from_columns(&(0..D).map(column).collect::<Vec<_>>())
}
