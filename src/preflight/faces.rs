//! The faces of a solid, seen at the places of its outermost boundary particles.

use crate::{
    shape::Shape,
    solid::{Role, Solid},
    space::Vector,
};

/// A place on the true face of a solid, in its own frame.
#[derive(Clone, Copy, Debug)]
pub struct Face<const D: usize> {
    /// The place, m.
    pub x: Vector<D>,
    /// Outward normal, unit length.
    pub n: Vector<D>,
}

/// The faces of `solid`, dp (m) apart; none of a fixed tank or polyline, whose skin is as thick as is needed.
pub fn of<const D: usize>(solid: &Solid<D>, dp: f64) -> Vec<Face<D>> {
    match (&solid.spec.role, &solid.spec.shape) {
        (Role::Fixed, Shape::Tank { .. } | Shape::Polyline { .. }) => Vec::new(),
        (_, shape) => of_shape(shape, dp),
    }
}

/// The faces of `shape`, dp (m) apart, but for those at which the parts of a compound join.
pub fn of_shape<const D: usize>(shape: &Shape<D>, dp: f64) -> Vec<Face<D>> {
    let face = |r: Vector<D>| {
        let n = shape.outward(&r, 0.05 * dp);
        Face { x: r - n * shape.signed_distance(&r), n }
    };
    let free = |face: &Face<D>| face.n.norm() > 0.5 && shape.signed_distance(&(face.x + face.n * (0.5 * dp))) > 0.0;
    shape.skin(dp, 1).into_iter().map(|point| face(point.r)).filter(free).collect()
}

/// Every so many-th of `faces`, `most` of them or fewer.
pub fn some<const D: usize>(faces: &[Face<D>], most: usize) -> impl Iterator<Item = &Face<D>> {
    faces.iter().step_by(faces.len().div_ceil(most).max(1))
}
