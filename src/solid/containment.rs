//! Solids inside others, where contact detection finds nothing.

use crate::{
    geometry::{ContactGeometry, Shape, overlap::find_overlap},
    math::Pose,
    solid::{Role, SolidSpec},
};

/// A solid and its pose.
pub(crate) type PlacedSolid<'a, const D: usize> = (&'a SolidSpec<D>, &'a Pose<D>);

/// The single shapes of a posed shape that others touch.
fn touchable<'a, const D: usize>(shape: &'a Shape<D>, pose: Pose<D>, found: &mut Vec<(&'a Shape<D>, Pose<D>)>) {
    match shape {
        Shape::Compound(parts) => parts.iter().for_each(|(inner, part)| touchable(part, pose.then(inner), found)),
        Shape::Mesh { contact: ContactGeometry::None, .. } => {}
        _ => found.push((shape, pose)),
    }
}

/// Returns the largest depth (m) of one solid inside a mesh of the other, if it exceeds `allowed` (m). Contacts use only the
/// surface of such a mesh, so a solid wholly inside touches nothing.
pub(crate) fn depth_inside_mesh<const D: usize>(
    (one, here): PlacedSolid<D>,
    (other, there): PlacedSolid<D>,
    allowed: f64,
) -> Option<f64> {
    let (mut inner, mut outer) = (Vec::new(), Vec::new());
    touchable(&one.shape, *here, &mut inner);
    touchable(&other.shape, *there, &mut outer);
    let fixed = matches!(other.role, Role::Fixed);
    let surface = |shape: &Shape<D>| match shape {
        Shape::Mesh { contact, .. } => {
            *contact == ContactGeometry::Surface || fixed && *contact == ContactGeometry::Fitting
        }
        _ => false,
    };
    let deep = |(mesh, there): &(&Shape<D>, Pose<D>)| {
        let places = inner.iter().filter_map(|(shape, here)| find_overlap((shape, here), (mesh, there), allowed));
        places.map(|(x, _)| -mesh.signed_distance(&there.local(&x))).reduce(f64::max)
    };
    outer.iter().filter(|(shape, _)| surface(shape)).filter_map(deep).reduce(f64::max)
}
