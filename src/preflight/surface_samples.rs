//! Samples of the faces of a solid, at the places of its outermost boundary particles.

use crate::{
    geometry::{Shape, thin::thin_place},
    math::Vector,
    solid::{Role, Solid},
};

/// A place on the true face of a solid, in its own frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceSample<const D: usize> {
    /// The place, m.
    pub x: Vector<D>,
    /// Outward normal, unit length.
    pub n: Vector<D>,
}

/// Samples of the faces of `solid`, dp (m) apart; none of a fixed tank or polyline at least `reach` (m) thick, which is often
/// large and needs no check.
pub(crate) fn of_solid<const D: usize>(solid: &Solid<D>, dp: f64, reach: f64) -> Vec<SurfaceSample<D>> {
    match (&solid.spec.role, &solid.spec.shape) {
        (Role::Fixed, Shape::Tank { thickness, .. } | Shape::Polyline { thickness, .. })
            if *thickness >= reach * (1.0 - 1e-6) =>
        {
            Vec::new()
        }
        (_, shape) => of_shape(shape, dp),
    }
}

/// Samples of the faces of `shape`, dp (m) apart, without the faces at which parts of a compound join.
pub(crate) fn of_shape<const D: usize>(shape: &Shape<D>, dp: f64) -> Vec<SurfaceSample<D>> {
    let free =
        |face: &SurfaceSample<D>| face.n.norm() > 0.5 && shape.signed_distance(&(face.x + face.n * (0.5 * dp))) > 0.0;
    shape
        .boundary_points(dp, 1)
        .into_iter()
        .flat_map(|point| nearest_samples(shape, &point.r, dp))
        .filter(free)
        .collect()
}

/// A sample of the face nearest to `r` (m); one of each face if `r` is midway between two, as in a plate with a single row.
fn nearest_samples<const D: usize>(shape: &Shape<D>, r: &Vector<D>, dp: f64) -> Vec<SurfaceSample<D>> {
    let face = |r: Vector<D>| {
        let n = shape.outward_normal(&r, 0.05 * dp);
        SurfaceSample { x: r - n * shape.signed_distance(&r), n }
    };
    // A mesh has the normal of one face even midway between two.
    let place = thin_place(shape, r, dp, 1e-3 * dp).filter(|place| (place.middle - r).norm() < 0.01 * dp);
    if let Some(place) = place {
        let other = |n: Vector<D>| SurfaceSample { x: place.middle + n * (0.5 * place.thickness), n };
        return vec![other(place.normal), other(-place.normal)];
    }
    let own = face(*r);
    if own.n.norm() > 0.5 {
        return vec![own];
    }
    // Midway, neither face is nearer; a small shift to either side makes one face nearer.
    let aside = |axis: usize| {
        let mut off = Vector::zeros();
        off[axis] = 0.2 * dp;
        [face(r + off), face(r - off)]
    };
    let both = (0..D).map(aside).find(|[one, other]| one.n.dot(&other.n) < -0.5);
    both.into_iter().flatten().collect()
}

/// At most `most` of the `samples`, at equal steps.
pub(crate) fn thinned<const D: usize>(
    samples: &[SurfaceSample<D>],
    most: usize,
) -> impl Iterator<Item = &SurfaceSample<D>> {
    samples.iter().step_by(samples.len().div_ceil(most).max(1))
}
