//! Unit tests of `src/solid/body.rs`.

use super::*;
use crate::math::Pose;

fn spec(mass: f64, inertia: [f64; 3]) -> SolidSpec<3> {
    let body = FreeBody {
        mass,
        centre: Vector::from([0.1, 0.0, 0.0]),
        inertia: Matrix::from_diagonal(&Vector::from(inertia)),
        velocity: Vector::zeros(),
        spin: Bivector::zero(),
        locked_translations: [false; 3],
        locked_rotations: [false; 3],
    };
    SolidSpec {
        name: "buoy".into(),
        shape: Shape::Ball { radius: 0.1 },
        pose: Pose::rotated(Vector::from([1.0, 0.0, 0.0]), &[0.0, 0.0, std::f64::consts::FRAC_PI_2]),
        role: Role::Free(body),
        friction: 0.3,
        restitution: 0.0,
        contact_skin: 0.0,
        dry: None,
        ballast: Vec::new(),
    }
}

#[test]
fn the_initial_kinematics_of_a_free_solid_refer_to_its_centre_of_mass() {
    let centre = spec(1.0, [1.0; 3]).initial_kinematics().centre;
    assert!((centre - Vector::from([1.0, 0.1, 0.0])).norm() < 1e-15);
}

#[test]
fn impossible_masses_inertias_and_contact_properties_are_refused() {
    assert_eq!(spec(1.0, [1.0, 2.0, 3.0]).check_role(), Ok(()), "a flat plate");
    for (mass, inertia) in
        [(0.0, [1.0; 3]), (f64::NAN, [1.0; 3]), (1.0, [1.0, 1.0, 2.1]), (1.0, [1.0, 1.0, 0.0]), (-1.0, [1.0; 3])]
    {
        let error = spec(mass, inertia).check_role().unwrap_err();
        assert!(error.to_string().contains("solid \"buoy\"") && error.help.is_some(), "{error}");
    }
    let slippery = SolidSpec { friction: -0.1, ..spec(1.0, [1.0; 3]) };
    assert!(slippery.check_role().unwrap_err().to_string().contains("friction is -0.1"));
    let bouncy = SolidSpec { restitution: 1.5, ..spec(1.0, [1.0; 3]) };
    assert!(bouncy.check_role().unwrap_err().to_string().contains("restitution is 1.5"));
    for skin in [-0.01, 0.11, f64::NAN] {
        let padded = SolidSpec { contact_skin: skin, ..spec(1.0, [1.0; 3]) };
        let error = padded.check_role().unwrap_err().to_string();
        assert!(error.contains(&format!("its contact skin is {skin} m")), "a ball of 0.1 m: {error}");
    }
}

#[test]
fn overlapping_parts_of_a_free_solid_are_refused() {
    let part = |x: f64| (Pose::at(Vector::from([x, 0.0, 0.0])), Shape::Ball { radius: 0.1 });
    let shape = |x: f64| Shape::Compound(vec![part(0.0), part(x)]);
    let of = |shape: Shape<3>| SolidSpec { shape, ..spec(1.0, [1.0; 3]) };
    let message = of(shape(0.15)).check().unwrap_err().to_string();
    assert!(message.starts_with("solid \"buoy\": parts 1 and 2 of its compound overlap"), "{message}");
    assert_eq!(of(shape(0.2)).check(), Ok(()));
    assert_eq!(SolidSpec { role: Role::Fixed, ..of(shape(0.15)) }.check(), Ok(()));
}

#[test]
fn a_box_has_the_textbook_inertia() {
    let shape = Shape::Box { size: Vector::from([0.2, 0.3, 0.4]) };
    let body = FreeBody::from_mass(&shape, 12.0);
    let expected = Vector::from([0.3 * 0.3 + 0.4 * 0.4, 0.2 * 0.2 + 0.4 * 0.4, 0.2 * 0.2 + 0.3 * 0.3]);
    assert!((body.inertia - Matrix::from_diagonal(&expected)).norm() < 1e-12);
    let plane = FreeBody::from_mass(&Shape::Box { size: Vector::from([0.3, 0.4]) }, 12.0);
    assert!((plane.inertia[(0, 0)] - 0.25).abs() < 1e-13 && (plane.mass - 12.0).abs() < 1e-12);
}
