//! Unit tests of `src/system/boundary_extension.rs`.

use super::*;
use crate::{
    geometry::Shape,
    math::Pose,
    solid::{PrescribedMotion, TimeFunction},
};

/// Extension particles of a paddle 0.4 m thick with its foot at `foot` (m) and this motion, on a bed with its face at y = 0, at dp = 0.1.
fn paddle(foot: f64, motion: PrescribedMotion<2>) -> Vec<ExtensionParticle<2>> {
    let solid = |name: &str, size: [f64; 2], y: f64, role| SolidSpec {
        name: name.into(),
        shape: Shape::Box { size: Vector::from(size) },
        pose: Pose { position: Vector::from([0.0, y]), ..Pose::identity() },
        role,
        friction: 0.0,
        restitution: 0.0,
        contact_skin: 0.0,
        dry: None,
        ballast: Vec::new(),
    };
    let specs =
        [solid("bed", [10.0, 1.0], -0.5, Role::Fixed), solid("paddle", [0.4, 2.0], foot + 1.0, Role::Driven(motion))];
    let model = Model::water(2, 0.1, 1.0);
    assert!(extension_particles(0, &specs, &model).is_empty(), "a bed has no extension");
    extension_particles(1, &specs, &model)
}

fn along(direction: [f64; 2]) -> PrescribedMotion<2> {
    PrescribedMotion::slide(Vector::from(direction), TimeFunction::constant(0.0))
}

#[test]
fn a_piston_on_its_bed_is_extended_into_the_bed_by_the_kernel_support() {
    let extension = paddle(0.0, along([1.0, 0.0]));
    let layers = Model::water(2, 0.1, 1.0).boundary_layers();
    // Four columns of a paddle four dp thick, on the lattice of its own rows.
    assert_eq!(extension.len(), 4 * layers);
    for particle in &extension {
        let row = (particle.r[1] + 1.0) / -0.1 - 0.5;
        assert!((row - row.round()).abs() < 1e-9 && row > -0.1 && row < layers as f64, "{particle:?}");
        assert!(
            (particle.behind_face[0] - particle.r[0]).abs() < 1e-12,
            "the same depth behind the face: {particle:?}"
        );
    }
}

#[test]
fn paddles_that_lift_pivot_at_the_bed_leave_a_gap_or_reach_into_it_have_no_extension() {
    assert!(paddle(0.0, along([0.0, 1.0])).is_empty(), "a lifted gate");
    let about = |y: f64| PrescribedMotion::hinge(Vector::from([0.0, y]), &[1.0], TimeFunction::constant(0.0));
    assert!(paddle(0.0, about(0.0)).is_empty(), "a flap hinged at the bed does not slide");
    assert!(!paddle(0.0, about(-1.0)).is_empty(), "a flap hinged far below slides");
    let both = |other: PrescribedMotion<2>| PrescribedMotion::chain([along([1.0, 0.0]), other]);
    assert!(!paddle(0.0, both(about(-1.0))).is_empty(), "both motions slide");
    assert!(paddle(0.0, both(along([0.0, 1.0]))).is_empty(), "the second motion lifts the piston");
    assert!(paddle(0.3, along([1.0, 0.0])).is_empty(), "a gap of 3 dp");
    assert!(paddle(-0.4, along([1.0, 0.0])).is_empty(), "the paddle itself reaches into the bed");
}
