//! Unit tests of `src/geometry/check.rs`.

use super::*;

fn square() -> Vec<Vector<2>> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vector::from).to_vec()
}

fn refusal<const D: usize>(shape: Shape<D>) -> String {
    shape.check().err().map(|e| e.to_string()).unwrap_or_default()
}

#[test]
fn impossible_shapes_are_refused_with_the_reason() {
    assert!(refusal(Shape::Box { size: Vector::from([1.0, -1.0]) }).contains("-1"));
    assert!(refusal(Shape::<3>::Ball { radius: f64::NAN }).contains("NaN"));
    assert!(refusal(Shape::<2>::Capsule { length: 1.0, radius: 1.0, axis: 2 }).contains("axis 2"));
    assert!(refusal(Shape::<2>::Cylinder { length: 1.0, radius: 1.0, axis: 0 }).contains("3-D"));
    assert!(refusal(Shape::<3>::Polygon { points: vec![] }).contains("2-D"));
    assert!(refusal(Shape::<2>::Compound(vec![])).contains("without parts"));
    assert!(refusal(Shape::Polygon { points: square()[..2].to_vec() }).contains("2 points"));
    let reversed = square().into_iter().rev().collect();
    assert!(refusal(Shape::Polygon { points: reversed }).contains("reverse"));
    let mut bow = square();
    bow.swap(1, 2);
    assert!(refusal(Shape::Polygon { points: bow }).contains("crosses itself"));
    let mut spike = square();
    spike.insert(1, Vector::from([2.0, 0.0]));
    assert!(refusal(Shape::Polygon { points: spike }).contains("crosses itself"));
}

#[test]
fn an_outline_of_a_million_points_is_refused() {
    let points = (0..1_000_000).map(|i| Vector::from([f64::from(i), 0.0])).collect();
    assert!(refusal(Shape::<2>::Polyline { points, thickness: 0.1 }).contains("the most is 10000"));
}

#[test]
fn valid_shapes_are_accepted() {
    assert_eq!(Shape::Polygon { points: square() }.check(), Ok(()));
    assert_eq!(Shape::Polyline { points: square(), thickness: 0.1 }.check(), Ok(()));
    assert_eq!(Shape::<3>::Cylinder { length: 1.0, radius: 0.1, axis: 1 }.check(), Ok(()));
}
