//! Samples of the faces of a solid, at the places of its outermost boundary particles.

use crate::{
    geometry::{Shape, thin::thin_place},
    math::Vector,
    solid::{Role, Solid},
};

/// Number of heights at which the walls of a tank are sampled.
const HEIGHTS: usize = 10;

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

/// Samples of the faces inside a tank or along a polyline, dp (m) apart or, of a tank, on one of two opposite walls; none of other shapes.
pub(super) fn of_inner_faces<const D: usize>(shape: &Shape<D>, dp: f64) -> Vec<SurfaceSample<D>> {
    let on_wall = |(axis, part): (usize, f64), size: &Vector<D>| {
        let x = Vector::from_fn(|i, _| {
            if i == axis {
                0.0
            } else if i + 1 < D {
                0.5 * size[i]
            } else {
                part * size[i]
            }
        });
        SurfaceSample { x, n: Vector::from_fn(|i, _| f64::from(i == axis)) }
    };
    match shape {
        Shape::Tank { size, .. } => {
            let places =
                (0..D - 1).flat_map(|axis| (0..HEIGHTS).map(move |k| (axis, (k as f64 + 0.5) / HEIGHTS as f64)));
            places.map(|place| on_wall(place, size)).collect()
        }
        Shape::Polyline { points, .. } => {
            let along = |ab: &[Vector<D>]| {
                let (start, way) = (ab[0], ab[1] - ab[0]);
                let n = Vector::<D>::from_fn(|i, _| if i == 0 { -way[1] } else { way[0] }).normalize();
                let count = (way.norm() / dp).ceil().max(1.0);
                (0..count as usize).map(move |k| SurfaceSample { x: start + way * ((k as f64 + 0.5) / count), n })
            };
            points.windows(2).flat_map(along).collect()
        }
        _ => Vec::new(),
    }
}

/// Samples of the faces of `shape`, dp (m) apart, without the faces at which parts of a compound join.
pub(crate) fn of_shape<const D: usize>(shape: &Shape<D>, dp: f64) -> Vec<SurfaceSample<D>> {
    of_shape_beyond(shape, dp, 0.5)
}

/// As [`of_shape`], but only faces nearer to one another than `join` dp count as joined.
pub(super) fn of_shape_beyond<const D: usize>(shape: &Shape<D>, dp: f64, join: f64) -> Vec<SurfaceSample<D>> {
    let free =
        |face: &SurfaceSample<D>| face.n.norm() > 0.5 && shape.signed_distance(&(face.x + face.n * (join * dp))) > 0.0;
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
