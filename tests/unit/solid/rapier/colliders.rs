//! Unit tests of `src/solid/rapier/colliders.rs`.

use super::*;
use crate::solid::FreeBody;

/// The error message for a free box of this length and height (m) with its centre at height `at` (m), in a tank or a polyline basin
/// one metre long.
fn refusal(length: f64, height: f64, at: f64, basin: bool) -> String {
    let mut size = Vector::repeat(0.2);
    (size[0], size[D - 1]) = (length, height);
    let shape = Shape::Box { size };
    let role = Role::Free(FreeBody::from_density(&shape, 500.0));
    let solid = |name: &str, shape: Shape<D>, at: Vector<D>, role: Role<D>| {
        let (name, pose) = (name.into(), Pose::at(at));
        SolidSpec {
            name,
            shape,
            pose,
            role,
            friction: 0.0,
            restitution: 0.0,
            contact_skin: 0.0,
            dry: None,
            ballast: Vec::new(),
        }
    };
    let point = |x: f64, up: f64| {
        Vector::from_fn(|i, _| {
            if i == 0 {
                x
            } else if i == D - 1 {
                up
            } else {
                0.5
            }
        })
    };
    let points = vec![point(0.0, 1.0), point(0.0, 0.0), point(1.0, 0.0), point(1.0, 1.0)];
    let tank = Shape::Tank { size: Vector::repeat(1.0), thickness: 0.1 };
    let outer = if basin { Shape::Polyline { points, thickness: 0.1 } } else { tank };
    let solids = [solid("tank", outer, Vector::zeros(), Role::Fixed), solid("box", shape, point(0.5, at), role)];
    let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
    let parts: Vec<ConvexParts> = solids
        .iter()
        .map(|solid| {
            let mut parts = ConvexParts::new();
            collect_parts(&solid.shape, &Pose::identity(), true, &mut parts).map(|()| parts).unwrap_or_default()
        })
        .collect();
    let refused = check_overlap(&solids, &start, &parts, &Constraints::default(), 0.001);
    refused.err().map(|e| e.to_string()).unwrap_or_default()
}

#[test]
fn a_body_larger_than_its_tank_is_refused_with_both_sizes() {
    for basin in [false, true] {
        if basin && D == 3 {
            continue; // a polyline is 2-D
        }
        assert_eq!(refusal(0.9, 0.3, 0.5, basin), "");
        let long = refusal(1.05, 0.3, 0.5, basin);
        assert!(long.contains("is 1.0500 m long along x and \"tank\" has room for 1.0000 m"), "{long}");
        let high = refusal(0.9, 0.3, 0.1, basin);
        assert!(high.contains("is 0.3000 m high and reaches 0.0500 m below the floor of \"tank\""), "{high}");
    }
}
