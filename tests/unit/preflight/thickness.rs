//! Unit tests of `src/preflight/thickness.rs`.

use super::*;

fn thin<const D: usize>(shape: Shape<D>) -> f64 {
    thinnest_part(&shape, &surface_samples::of_shape(&shape, 0.01), 0.01).unwrap_or(f64::NAN)
}

#[test]
fn the_thickness_of_a_shape_is_that_of_its_thinnest_part() {
    // The bound is a twentieth of dp, the smallest inward step.
    let near = |a: f64, b: f64| assert!((a - b).abs() < 5e-4, "{a} differs from {b}");
    near(thin(Shape::Box { size: Vector::from([0.3, 0.04]) }), 0.04);
    near(thin(Shape::<2>::Ball { radius: 0.1 }), 0.2);
    near(thin(Shape::<3>::Cylinder { length: 0.3, radius: 0.05, axis: 2 }), 0.1);
    // The joint of a compound is not a face.
    let half = Shape::Box { size: Vector::from([0.1, 0.2]) };
    let at = |x: f64| Pose::at(Vector::from([x, 0.0]));
    near(thin(Shape::Compound(vec![(at(0.0), half.clone()), (at(0.1), half)])), 0.2);
    let hull = [[-0.05, -0.03], [0.05, -0.03], [0.08, 0.03], [-0.08, 0.03]].map(Vector::from).to_vec();
    let boat = thin(Shape::Polygon { points: hull });
    assert!((0.03..=0.0601).contains(&boat), "{boat}");
}

/// `system::thin_sides` gives the two sides of a part thinner than dp pressures of their own in 2-D, and of no other part.
#[test]
fn only_parts_thinner_than_dp_in_2d_have_a_pressure_for_each_side() {
    let of_each_side = |text: &str| text.contains("the pressure of each side");
    assert!(of_each_side(effect_on_sides::<2>(0.3)));
    for text in [effect_on_sides::<2>(1.0), effect_on_sides::<2>(2.5), effect_on_sides::<3>(0.3)] {
        assert!(!of_each_side(text) && text.contains("one pressure for both"), "{text}");
    }
}

/// The errors were measured in still water; the thicknesses between are those of parts that are no whole number of dp.
#[test]
fn only_plates_of_no_whole_number_of_dp_have_an_error_of_buoyancy() {
    assert!([0.5, 1.0, 1.05, 2.0, 3.0, 4.5].iter().all(|&x| buoyancy_error(x).is_empty()));
    assert!(buoyancy_error(1.5).contains("15 %") && buoyancy_error(2.5).contains("6 %"));
}
