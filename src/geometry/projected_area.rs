//! Area of the part of a shape above a level, projected along a direction, from the facets that face it.
//!
//! For a flow along the unit vector u it is ∫ max(−n·u, 0) dA over the surface above the level: exact for parts that do not hide
//! one another. If several parts lie behind one another, each of them counts.

use super::{Shape, submerged_volume::Facet};
use crate::math::{Pose, Vector};

/// Offset of a point before a facet, relative to the size of the shape, at which another part hides it.
const OFFSET: f64 = 1e-6;

/// The facets of the surface of `shape` in its own frame. Those of a part whose middle lies on or in another part are left out.
pub(crate) fn surface_facets<const D: usize>(shape: &Shape<D>) -> Vec<Facet<D>> {
    exposed_facets(shape, &|part| match part {
        Shape::Ball { radius } => Shape::Capsule { length: 0.0, radius: *radius, axis: D - 1 }.facets(),
        _ => part.outer_facets(),
    })
}

/// The facets of `shape` in its own frame, where `facets` returns those of a shape that is no compound. Those of a part whose middle
/// lies on or in another part are left out.
pub(super) fn exposed_facets<const D: usize>(
    shape: &Shape<D>,
    facets: &impl Fn(&Shape<D>) -> Vec<Facet<D>>,
) -> Vec<Facet<D>> {
    match shape {
        Shape::Compound(parts) => {
            let offset = OFFSET * shape.bounds().size().max();
            let mut all = Vec::new();
            for (i, (pose, part)) in parts.iter().enumerate() {
                let others = || parts.iter().enumerate().filter(|(j, _)| *j != i);
                let is_hidden = |facet: &Facet<D>| {
                    let normal = area_vector(facet);
                    let before = middle(facet) + normal * (offset / normal.norm().max(f64::MIN_POSITIVE));
                    others().any(|(_, (other, shape))| shape.signed_distance(&other.local(&before)) < 0.0)
                };
                let own = exposed_facets(part, facets).into_iter().map(|facet| facet.map(|x| pose.point(&x)));
                all.extend(own.filter(|facet| !is_hidden(facet)));
            }
            all
        }
        _ => facets(shape),
    }
}

/// The area (m²; m in 2-D) of `facets` at `pose` above the height `level` (m), projected along the unit vector `way` of a flow, and
/// its centroid (m). The centroid of no area is the position of the pose.
pub(crate) fn projected_area<const D: usize>(
    facets: &[Facet<D>],
    pose: &Pose<D>,
    level: f64,
    way: &Vector<D>,
) -> (f64, Vector<D>) {
    let mut sum = (0.0, Vector::zeros());
    for facet in facets {
        add_dry(facet.map(|x| pose.point(&x)), level, way, &mut sum);
    }
    if sum.0 > 0.0 { (sum.0, sum.1 / sum.0) } else { (0.0, pose.position) }
}

/// Adds the part of a facet above the level to area and first moment. It splits a facet that crosses the level.
fn add_dry<const D: usize>(facet: Facet<D>, level: f64, way: &Vector<D>, sum: &mut (f64, Vector<D>)) {
    let height = facet.map(|x| x[D - 1] - level);
    let above = height.iter().position(|z| *z > 0.0);
    let below = height.iter().position(|z| *z < 0.0);
    match (above, below) {
        (Some(i), Some(j)) => {
            let mut cut = facet[i] + (facet[j] - facet[i]) * (height[i] / (height[i] - height[j]));
            cut[D - 1] = level;
            for end in [i, j] {
                let mut part = facet;
                part[end] = cut;
                add_dry(part, level, way, sum);
            }
        }
        (Some(_), None) => {
            let area = (-area_vector(&facet).dot(way)).max(0.0);
            sum.0 += area;
            sum.1 += middle(&facet) * area;
        }
        (None, _) => {}
    }
}

/// Area of a facet times its outward normal.
pub(super) fn area_vector<const D: usize>(facet: &Facet<D>) -> Vector<D> {
    let side = facet[1] - facet[0];
    if D == 2 {
        return Vector::from_fn(|i, _| if i == 0 { side[1] } else { -side[0] });
    }
    let other = facet[2] - facet[0];
    Vector::from_fn(|i, _| {
        let (j, k) = ((i + 1) % D, (i + 2) % D);
        0.5 * (side[j] * other[k] - side[k] * other[j])
    })
}

pub(super) fn middle<const D: usize>(facet: &Facet<D>) -> Vector<D> {
    facet.iter().sum::<Vector<D>>() / D as f64
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/projected_area.rs"]
mod tests;
