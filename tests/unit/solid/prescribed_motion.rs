//! Unit tests of `src/solid/prescribed_motion.rs`.

use std::f64::consts::PI;

use super::*;

fn formula(text: &str) -> TimeFunction {
    TimeFunction::Formula(Formula::parse(text).unwrap())
}

#[test]
fn a_slide_starts_at_the_value_of_its_law_and_moves_at_its_rate() {
    let table = TimeSeries::new([0.0, 0.5, 1.0, 2.0], [0.1, 0.2, 0.15, 0.3]).unwrap();
    let motion = PrescribedMotion::slide(Vector::from([2.0, 0.0]), TimeFunction::Table(table));
    let start = Pose::at(Vector::from([1.0, 1.0]));
    assert_eq!(motion.kinematics(&start, 0.0).pose.position, Vector::from([1.1, 1.0]));
    let (t, step) = (0.8, 1e-6);
    let (a, b) = (motion.kinematics(&start, t - step), motion.kinematics(&start, t + step));
    let difference = (b.pose.position - a.pose.position) / (2.0 * step);
    // Central difference: truncation step² times the third derivative, round-off 1e-16/step.
    assert!((difference - motion.kinematics(&start, t).velocity).norm() < 1e-9);
}

#[test]
fn a_hinge_keeps_its_centre_and_rotates_at_the_rate_of_its_law() {
    let centre = Vector::from([0.2, 0.0, -0.1]);
    let motion = PrescribedMotion::hinge(centre, &[0.0, 3.0, 4.0], formula("0.3*sin(2*t)"));
    let start = Pose::rotated(Vector::from([0.2, 0.5, 0.3]), &[0.1, 0.2, 0.3]);
    let (t, step) = (0.6, 1e-6);
    let now = motion.kinematics(&start, t);
    let (a, b) = (motion.kinematics(&start, t - step), motion.kinematics(&start, t + step));
    let local = Vector::from([0.05, -0.4, 0.7]);
    let difference = (b.pose.point(&local) - a.pose.point(&local)) / (2.0 * step);
    let velocity = now.velocity + now.spin.velocity_at(&(now.pose.point(&local) - now.centre));
    assert!((difference - velocity).norm() < 1e-9);
    let hinge = start.local(&centre);
    assert!((now.pose.point(&hinge) - centre).norm() < 1e-15);
    // Axis (0, 3, 4)/5, rate 0.6 cos 1.2.
    assert!((now.spin.axial()[2] - 0.8 * 0.6 * 1.2_f64.cos()).abs() < 1e-15);
}

#[test]
fn a_positive_angle_is_counter_clockwise_in_two_dimensions() {
    let motion = PrescribedMotion::hinge(Vector::zeros(), &[1.0], formula("t"));
    let now = motion.kinematics(&Pose::at(Vector::from([1.0, 0.0])), 0.5);
    assert!(now.pose.position[1] > 0.4 && now.spin.axial()[0] == 1.0);
}

/// The largest difference (m/s) of the velocities of some points from the central difference of their positions.
fn velocity_error<const D: usize>(motion: &PrescribedMotion<D>, start: &Pose<D>, t: f64) -> f64 {
    let step = 1e-6;
    let [a, now, b] = [t - step, t, t + step].map(|t| motion.kinematics(start, t));
    let point = |i: usize| {
        let local = Vector::from_fn(|k, _| if k == i { 0.7 } else { -0.2 });
        let difference = (b.pose.point(&local) - a.pose.point(&local)) / (2.0 * step);
        (now.velocity + now.spin.velocity_at(&(now.pose.point(&local) - now.centre)) - difference).norm()
    };
    (0..D).map(point).fold(0.0, f64::max)
}

#[test]
fn each_motion_of_a_chain_acts_in_the_frame_moved_by_those_before_it() {
    let turn = || PrescribedMotion::hinge(Vector::from([1.0, 0.0]), &[1.0], formula("0.5*pi*t"));
    let slide = || PrescribedMotion::slide(Vector::from([1.0, 0.0]), formula("2*t"));
    let start = Pose::at(Vector::from([1.0, 1.0]));
    let at = |motion: &PrescribedMotion<2>| motion.kinematics(&start, 1.0);
    // A rail on the turntable points up at 1 s; a turntable on the rail has moved by 2 m. Round-off of cos π/2.
    let (railed, carted) = (PrescribedMotion::chain([turn(), slide()]), PrescribedMotion::chain([slide(), turn()]));
    assert!((at(&railed).pose.position - Vector::from([0.0, 2.0])).norm() < 1e-15);
    assert!((at(&carted).pose.position - Vector::from([2.0, 0.0])).norm() < 1e-15);
    assert!((at(&railed).velocity - Vector::from([-PI, 2.0 - 0.5 * PI])).norm() < 1e-14, "{:?}", at(&railed));
    assert!((at(&carted).velocity - Vector::from([2.0, -0.5 * PI])).norm() < 1e-14, "{:?}", at(&carted));
    assert_eq!(at(&carted).centre, at(&carted).pose.position, "the centre is the origin of the frame");
    // Truncation and round-off of the difference, as above.
    assert!(velocity_error(&railed, &start, 0.3) < 1e-8 && velocity_error(&carted, &start, 0.3) < 1e-8);
    let one = PrescribedMotion::chain([turn()]);
    assert_eq!(at(&one), at(&turn()), "a chain of one motion equals the motion");
    assert!(one.hinge_height().is_some() && carted.hinge_height().is_none());
}

#[test]
fn a_chain_of_motions_in_three_dimensions_has_exact_rates() {
    let centre = |x: f64| Vector::from([x, 0.2, -0.1]);
    let motion = PrescribedMotion::chain([
        PrescribedMotion::slide(Vector::from([1.0, 0.0, 0.2]), formula("0.1*sin(3*t)")),
        PrescribedMotion::hinge(centre(0.0), &[0.0, 1.0, 0.0], formula("0.4*sin(2*t)")),
        PrescribedMotion::hinge(centre(0.3), &[0.2, 0.0, 1.0], formula("0.3*t")),
        PrescribedMotion::slide(Vector::from([0.0, 1.0, 0.0]), formula("0.2*cos(t)")),
    ]);
    let start = Pose::rotated(Vector::from([0.2, 0.5, 0.3]), &[0.1, 0.2, 0.3]);
    assert!(velocity_error(&motion, &start, 0.7) < 1e-8);
    let ways = motion.directions_at(&Vector::from([0.4, 0.5, 0.3]));
    assert!(ways.len() == 4 && ways.iter().all(|way| (way.norm() - 1.0).abs() < 1e-14), "{ways:?}");
    assert!((ways[0] - Vector::from([1.0, 0.0, 0.2]).normalize()).norm() < 1e-15);
}

#[test]
fn a_motion_without_direction_is_refused() {
    assert!(PrescribedMotion::slide(Vector::<2>::zeros(), formula("t")).check().is_err());
    assert!(PrescribedMotion::hinge(Vector::<3>::zeros(), &[0.0; 3], formula("t")).check().is_err());
    assert!(PrescribedMotion::slide(Vector::from([1.0, 0.0]), formula("1/t")).check().is_err());
    let slide = |law: &str| PrescribedMotion::slide(Vector::from([1.0, 0.0]), formula(law));
    assert!(slide("t").check().is_ok());
    let second = PrescribedMotion::chain([slide("t"), slide("1/t")]).check().unwrap_err();
    assert!(second.to_string().contains("motion 2: the law of motion gives"), "{second}");
    assert!(PrescribedMotion::<2>::chain([]).check().is_err());
}

#[test]
fn a_law_is_steady_only_if_it_never_changes() {
    assert_eq!(formula("2*9.81").steady_value(), Some(2.0 * 9.81));
    // A pulse between 20.0 and 20.1 s.
    assert_eq!(formula("5*max(0, min(t - 20, 20.1 - t))").steady_value(), None);
    let table = |values: [f64; 3]| TimeFunction::Table(TimeSeries::new([0.0, 1.0, 2.0], values).unwrap());
    assert_eq!(table([3.0; 3]).steady_value(), Some(3.0));
    assert_eq!(table([3.0, 3.0, 4.0]).steady_value(), None);
}
