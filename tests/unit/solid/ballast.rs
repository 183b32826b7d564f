use super::*;
use crate::{
    geometry::Shape,
    math::{Bivector, expression::Formula, time_series::TimeSeries},
};

fn formula(text: &str) -> TimeFunction {
    Formula::parse(text).expect("a formula").into()
}

/// Two halves of a plate are the plate: a half of 1 kg with a point mass of 1 kg is compared with sums over points.
#[test]
fn a_point_mass_shifts_centre_and_inertia() {
    let body = FreeBody::<2>::from_mass(&Shape::Box { size: [0.4, 0.2].into() }, 3.0);
    let loaded = body.with_point_mass(&[0.2, 0.1].into(), 1.0);
    // Σ m x / Σ m; about that centre, each part's own inertia plus m d²: 3 (0.4² + 0.2²)/12 + 3 (0.05² + 0.025²) +
    // (0.15² + 0.075²).
    assert!((loaded.centre - Vector::<2>::new(0.05, 0.025)).norm() < 1e-15);
    let inertia = 3.0 * 0.2 / 12.0 + 3.0 * (0.0025 + 0.000625) + 0.0225 + 0.005625;
    assert!((loaded.inertia[(0, 0)] - inertia).abs() < 1e-15, "{inertia}");
    assert_eq!(loaded.mass, 4.0);
    assert_eq!(body.with_point_mass(&[0.2, 0.1].into(), 0.0), body, "no mass changes no bit");
}

/// In 3-D the energy of a turning body is that of its parts, at any spin.
#[test]
fn the_energy_of_a_loaded_body_is_the_sum_of_its_parts() {
    let body = FreeBody::<3>::from_mass(&Shape::Box { size: [0.4, 0.3, 0.2].into() }, 5.0);
    let at = Vector::<3>::new(0.1, -0.2, 0.3);
    let loaded = body.with_point_mass(&at, 2.0);
    let spin = Bivector::<3>::from_axial(&[0.7, -1.1, 0.4]);
    let axial = Vector::<3>::new(0.7, -1.1, 0.4);
    let turning = |body: &FreeBody<3>| {
        body.mass * spin.velocity_at(&body.centre).norm_squared() + axial.dot(&(body.inertia * axial))
    };
    let parts = turning(&body) + 2.0 * spin.velocity_at(&at).norm_squared();
    assert!((turning(&loaded) - parts).abs() < 1e-13 * parts, "{} and {parts}", turning(&loaded));
}

#[test]
fn laws_that_fall_below_zero_are_found() {
    let of = |mass: TimeFunction| BallastSpec::<2>::new([0.0, 0.0], mass).first_invalid(10.0);
    assert_eq!(of(formula("2 - 0.2*t")), None, "it ends at 0, up to round-off");
    let (t, mass) = of(formula("2 - 0.4*t")).expect("negative from 5 s on");
    assert!(t > 5.0 && t < 5.02 && mass < 0.0, "{t} s, {mass} kg");
    assert!(of(formula("1/(t - 5)")).is_some());
    let table = |x: [f64; 3]| TimeFunction::Table(TimeSeries::new([0.0, 20.0, 30.0], x).expect("a series"));
    assert_eq!(of(table([0.0, 3.0, 3.0])), None);
    assert_eq!(of(table([3.0, 1.0, -1.0])), Some((30.0, -1.0)), "a sample beyond the run counts, too");
}

#[test]
fn the_largest_mass_is_that_of_all_ballast_together() {
    let solid = SolidSpec::<2>::free("box", Shape::Box { size: [0.1, 0.1].into() }, 1000.0);
    assert_eq!(solid.largest_mass(10.0), None);
    let peak = TimeSeries::new([0.0, 4.99999, 5.0, 5.00001], [0.0, 0.0, 3.0, 0.0]).expect("a series");
    let loaded = solid.ballast(BallastSpec::new([0.0, 0.0], TimeFunction::Table(peak)));
    let loaded = loaded.ballast(BallastSpec::new([0.0, 0.0], 1.0));
    let largest = loaded.largest_mass(10.0).expect("it has ballast");
    assert!((largest - 14.0).abs() < 1e-12, "a peak between the even times counts: {largest}");
    assert_eq!(loaded.ballast[0].mass_at(7.0), 0.0);
}
