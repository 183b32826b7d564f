//! Boundary extensions: a driven solid that slides along the face of a fixed one, as a paddle on its bed, gets extra rows of
//! boundary particles inside the fixed one.
//!
//! Without them fluid can leak through the sliding joint, which is one dp wide.

use crate::{
    math::Vector,
    model::Model,
    solid::{Role, SolidSpec},
};

/// Faces touch if they are no further apart, dp.
const TOUCH: f64 = 0.1;

/// A solid slides along a face if each of its motions begins at more than 60° from the face's normal. A gate that rises from its
/// bed does not slide along the bed, but opens.
const ALONG: f64 = 0.5;

/// A boundary particle of an extension, in the frame of its solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ExtensionParticle<const D: usize> {
    /// Its position, m.
    pub(super) r: Vector<D>,
    /// A position as deep behind the face that it continues, m.
    pub(super) behind_face: Vector<D>,
}

/// The extension of solid number `i` of `specs`; most have none.
pub(super) fn extension_particles<const D: usize>(
    i: usize,
    specs: &[SolidSpec<D>],
    model: &Model,
) -> Vec<ExtensionParticle<D>> {
    let (spec, pose) = (&specs[i], specs[i].initial_kinematics().pose);
    let Role::Driven(motion) = &spec.role else { return Vec::new() };
    let fixed: Vec<&SolidSpec<D>> = specs.iter().filter(|other| matches!(other.role, Role::Fixed)).collect();
    let (dp, outside) = (model.dp, |r: &Vector<D>| spec.shape.signed_distance(r));
    let mut extension = Vec::new();
    if fixed.is_empty() {
        return extension;
    }
    for point in spec.shape.boundary_points(dp, model.boundary_layers()) {
        let x = pose.point(&point.r);
        for other in &fixed {
            let at = other.initial_kinematics().pose;
            let apart = other.shape.signed_distance(&at.local(&x));
            // Half a dp for a solid that stands on the other.
            if (apart - 0.5 * dp).abs() > 0.25 * dp || (apart + outside(&point.r)).abs() > TOUCH * dp {
                continue;
            }
            let out = at.rotation * other.shape.outward_normal(&at.local(&x), 0.05 * dp);
            if motion.directions_at(&x).iter().any(|way| way.dot(&out).abs() > ALONG) {
                continue;
            }
            let high = pose.local(&(x + out * (model.boundary_layers() as f64 * dp)));
            let behind_face = if outside(&high) < 0.0 { high } else { point.r };
            let rows = (0..model.boundary_layers()).map(|k| x - out * (2.0 * apart + k as f64 * dp));
            let rows = rows.filter(|r| other.shape.signed_distance(&at.local(r)) < 0.0).map(|r| pose.local(&r));
            extension.extend(rows.filter(|r| outside(r) > 0.0).map(|r| ExtensionParticle { r, behind_face }));
        }
    }
    extension
}

#[cfg(test)]
#[path = "../../tests/unit/system/boundary_extension.rs"]
mod tests;
