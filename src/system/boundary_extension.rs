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

/// A solid slides along a face if each of its motions sets out at more than 60° from the face's normal: what rises from its bed, as a
/// gate, opens.
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
mod tests {
    use super::*;
    use crate::{
        geometry::Shape,
        math::Pose,
        solid::{PrescribedMotion, TimeFunction},
    };

    /// A bed, its face at y = 0, and on it at dp = 0.1 a paddle 0.4 m thick, its foot at `foot` (m), that moves so.
    fn paddle(foot: f64, motion: PrescribedMotion<2>) -> Vec<ExtensionParticle<2>> {
        let solid = |name: &str, size: [f64; 2], y: f64, role| SolidSpec {
            name: name.into(),
            shape: Shape::Box { size: Vector::from(size) },
            pose: Pose { position: Vector::from([0.0, y]), ..Pose::identity() },
            role,
            friction: 0.0,
            restitution: 0.0,
            contact_skin: 0.0,
        };
        let specs = [
            solid("bed", [10.0, 1.0], -0.5, Role::Fixed),
            solid("paddle", [0.4, 2.0], foot + 1.0, Role::Driven(motion)),
        ];
        let model = Model::water(2, 0.1, 1.0);
        assert!(extension_particles(0, &specs, &model).is_empty(), "a bed has none");
        extension_particles(1, &specs, &model)
    }

    fn along(direction: [f64; 2]) -> PrescribedMotion<2> {
        PrescribedMotion::slide(Vector::from(direction), TimeFunction::constant(0.0))
    }

    #[test]
    fn a_piston_on_its_bed_is_carried_on_into_it_as_far_as_the_kernel_reaches() {
        let extension = paddle(0.0, along([1.0, 0.0]));
        let layers = Model::water(2, 0.1, 1.0).boundary_layers();
        // Four columns of a paddle four dp thick, in the lattice that its own rows have.
        assert_eq!(extension.len(), 4 * layers);
        for particle in &extension {
            let row = (particle.r[1] + 1.0) / -0.1 - 0.5;
            assert!((row - row.round()).abs() < 1e-9 && row > -0.1 && row < layers as f64, "{particle:?}");
            assert!((particle.behind_face[0] - particle.r[0]).abs() < 1e-12, "as deep behind the face: {particle:?}");
        }
    }

    #[test]
    fn what_opens_or_stands_apart_or_reaches_into_the_bed_has_none() {
        assert!(paddle(0.0, along([0.0, 1.0])).is_empty(), "a gate that is lifted");
        let about = |y: f64| PrescribedMotion::hinge(Vector::from([0.0, y]), &[1.0], TimeFunction::constant(0.0));
        assert!(paddle(0.0, about(0.0)).is_empty(), "a flap hinged at the bed turns there");
        assert!(!paddle(0.0, about(-1.0)).is_empty(), "one hinged far below slides");
        let both = |other: PrescribedMotion<2>| PrescribedMotion::chain([along([1.0, 0.0]), other]);
        assert!(!paddle(0.0, both(about(-1.0))).is_empty(), "one that slides in both its motions");
        assert!(paddle(0.0, both(along([0.0, 1.0]))).is_empty(), "a piston that is lifted, too");
        assert!(paddle(0.3, along([1.0, 0.0])).is_empty(), "a gap of 3 dp");
        assert!(paddle(-0.4, along([1.0, 0.0])).is_empty(), "rows of its own");
    }
}
