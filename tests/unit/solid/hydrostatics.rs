//! Unit tests of `src/solid/hydrostatics.rs`.

use super::*;

/// A box of width 0.2 m and height 0.1 m, 500 kg/m³: half submerged.
fn raft() -> (Shape<2>, FreeBody<2>) {
    let shape = Shape::Box { size: Vector::from([0.2, 0.1]) };
    let body = FreeBody::from_density(&shape, 500.0);
    (shape, body)
}

#[test]
fn a_box_floats_at_the_draft_of_archimedes() {
    let (shape, body) = raft();
    let pose = Pose::at(Vector::from([3.0, 7.0]));
    let lift = equilibrium_height(&shape, &pose, body.mass, 1000.0, 0.4).unwrap();
    // Half of the box is under water, so its centre is in the surface. The bound is that of the bisection.
    assert!((7.0 + lift - 0.4).abs() < 1e-12);
    let sinks = equilibrium_height(&shape, &pose, 2.5 * 20.0, 1000.0, 0.4).unwrap_err();
    assert!(sinks.to_string().contains("sinks") && sinks.to_string().contains("2.500"));
}

#[test]
fn the_metacentric_height_of_a_box_agrees_with_the_textbook() {
    let (shape, mut body) = raft();
    let pose = Pose::at(Vector::zeros());
    let (breadth, draft) = (0.2, 0.05);
    let expected = breadth * breadth / (12.0 * draft) - 0.5 * draft;
    let gm = |body: &FreeBody<2>| metacentric_height(&shape, &pose, body, 1000.0, 0.0, &[1.0]).unwrap();
    // The difference over ±1e-4 rad has a relative error of (1e-4)²; round-off is 1e-14/1e-4.
    assert!((gm(&body) - expected).abs() < 1e-7);
    body.centre[1] += 0.06;
    assert!((gm(&body) - (expected - 0.06)).abs() < 1e-7, "a top-heavy box capsizes");
}

#[test]
fn the_stiffness_of_a_box_is_that_of_its_waterplane() {
    // Half of 0.2 m under water, off the reference point by 0.03 m along x.
    let (length, breadth, draft, offset) = (0.4, 0.3, 0.1, 0.03);
    let shape = Shape::Box { size: Vector::from([length, breadth, 0.2]) };
    let reference = Vector::from([-offset, 0.0, 0.0]);
    let stiffness = Hull::new(&shape).stiffness(&Pose::identity(), &reference, 0.0);
    let (area, volume) = (length * breadth, length * breadth * draft);
    let below = -0.5 * draft * volume;
    let exact = [
        (2, 2, area),
        (2, 4, -area * offset),
        (4, 2, -area * offset),
        (3, 3, area * breadth * breadth / 12.0 + below),
        (4, 4, area * (length * length / 12.0 + offset * offset) + below),
        (3, 5, -volume * offset),
        (2, 3, 0.0),
        (3, 4, 0.0),
        (4, 5, 0.0),
    ];
    // The difference over ±1e-4 has a relative error of (1e-4)²; round-off is 1e-14/1e-4.
    for (load, motion, value) in exact {
        assert!(
            (stiffness[load][motion] - value).abs() < 1e-7,
            "{load}, {motion}: {}, exact {value}",
            stiffness[load][motion]
        );
    }
    let still = [0, 1, 5].into_iter().all(|i| stiffness[i].iter().all(|x| *x == 0.0));
    assert!(still && (0..6).all(|i| stiffness[i][0] == 0.0 && stiffness[i][1] == 0.0));
}
