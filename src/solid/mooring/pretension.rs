//! The forces of mooring lines on solids at rest in still water, before there are particles.

use super::{
    forces::{BedPlane, NodeSurroundings},
    line::MooringLine,
    specification::MooringSpec,
};
use crate::{
    math::Vector,
    solid::{Role, SolidSpec, statics::WaterAtRest},
};

/// Step (m) of the difference that gives the normal of a surface, over the length of a segment.
const NORMAL_STEP: f64 = 1e-4;

/// The force (N) on what holds each end of each line between `solids` where the ends start. What is below the surface is wet.
pub(crate) fn forces_at_rest<const D: usize>(
    moorings: &[MooringSpec<D>],
    solids: &[&SolidSpec<D>],
    water: &WaterAtRest,
) -> Vec<[Vector<D>; 2]> {
    let gravity = Vector::from_fn(|i, _| if i == D - 1 { -water.g } else { 0.0 });
    let of_line = |spec: &MooringSpec<D>| {
        let segment = spec.length / spec.segments as f64;
        let around = |x: &Vector<D>| {
            let distance = |solid: &&&SolidSpec<D>| solid.shape.signed_distance(&solid.pose.local(x));
            let fixed = solids.iter().filter(|solid| matches!(solid.role, Role::Fixed));
            let nearest = fixed.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let bed = nearest.map(|solid| {
                let local = solid.pose.local(x);
                let normal = solid.pose.rotation * solid.shape.outward_normal(&local, NORMAL_STEP * segment);
                BedPlane { point: x - normal * distance(&solid), normal }
            });
            let wet = if x[D - 1] < water.level { 1.0 } else { 0.0 };
            NodeSurroundings { water_velocity: Vector::zeros(), wet, bed }
        };
        let material = spec.line.material(segment, water.rho0);
        let mut line = MooringLine::straight(material, spec.length, spec.segments, spec.ends.map(|end| end.at));
        line.bodies = spec.node_bodies();
        line.find_rest(&around, &gravity);
        line.state.end_forces
    };
    moorings.iter().map(of_line).collect()
}
