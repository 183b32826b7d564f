//! Validity checks of a shape: finite, positive sizes, a valid axis, and outlines that do not cross themselves.

use super::{
    Shape,
    wall::{far_corners, is_closed},
};
use crate::{
    error::{Error, Result},
    math::Vector,
};

/// Largest number of points of an outline: the check compares all pairs of edges, and every particle near the outline
/// searches all edges.
const MOST_POINTS: usize = 10_000;

impl<const D: usize> Shape<D> {
    /// Checks that the shape is valid in `D` dimensions.
    ///
    /// # Errors
    /// A scene error for a size that is not a positive number, an axis that does not exist, a shape of the other
    /// dimension, an outline that crosses itself, repeats a point or runs clockwise, or an empty compound.
    pub(crate) fn check(&self) -> Result<()> {
        match self {
            Shape::Box { size } => sizes("the size of a box", size),
            Shape::Ball { radius } => positive("the radius of a ball", *radius),
            Shape::Capsule { length, radius, axis } => rod("capsule", D, *length, *radius, *axis),
            Shape::Cylinder { length, radius, axis } => {
                if D == 2 {
                    return Err(Error::scene("a cylinder is a 3-D shape").help("in 2-D use a ball (a disc) or a box"));
                }
                rod("cylinder", D, *length, *radius, *axis)
            }
            Shape::Polygon { points } => polygon(points),
            Shape::Polyline { points, thickness } => {
                positive("the thickness of a polyline wall", *thickness)?;
                match is_closed(points) {
                    true => ring(points, *thickness),
                    false => outline("polyline", points, 2, false),
                }
            }
            Shape::Tank { size, thickness } => {
                sizes("the size of a tank", size)?;
                positive("the thickness of a tank's walls", *thickness)
            }
            Shape::Mesh { .. } if D == 3 => Ok(()), // was checked when it was made
            Shape::Mesh { .. } => Err(Error::scene("a mesh is a 3-D shape").help("in 2-D use a polygon")),
            Shape::Compound(parts) => compound(parts),
        }
    }
}

fn positive(what: &str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::scene(format!("{what} is {value}")).help("give a length above zero, in metres"))
}

fn sizes<const D: usize>(what: &str, size: &Vector<D>) -> Result<()> {
    size.iter().try_for_each(|&s| positive(what, s))
}

fn rod(name: &str, dimension: usize, length: f64, radius: f64, axis: usize) -> Result<()> {
    positive(&format!("the length of a {name}"), length)?;
    positive(&format!("the radius of a {name}"), radius)?;
    if axis < dimension {
        return Ok(());
    }
    let known = if dimension == 2 { "0 (along) or 1 (up)" } else { "0, 1 or 2 (up)" };
    Err(Error::scene(format!("a {name} in {dimension}-D has no axis {axis}")).help(format!("axis is {known}")))
}

fn polygon<const D: usize>(points: &[Vector<D>]) -> Result<()> {
    outline("polygon", points, 3, true)?;
    if doubled_area(points) > 0.0 {
        return Ok(());
    }
    Err(Error::scene("the points of a polygon run clockwise").help("reverse the points: counter-clockwise"))
}

/// Checks a closed polyline. The far side of a wall inside the line encloses less space; it must enclose some.
fn ring<const D: usize>(points: &[Vector<D>], thickness: f64) -> Result<()> {
    outline("polyline", &points[..points.len() - 1], 3, true)?;
    let far = far_corners(points, thickness);
    let along = |(near, far): (&[Vector<D>], &[Vec<Vector<D>>])| {
        let [from, to] = [far[0].last(), far[1].first()].map(|corner| corner.copied().unwrap_or_else(Vector::zeros));
        (near[1] - near[0]).normalize().dot(&(to - from))
    };
    let length: f64 = points.windows(2).zip(far.windows(2)).map(along).sum();
    if length > 0.0 && doubled_area(points) * doubled_area(&far[1..].concat()) > 0.0 {
        return Ok(());
    }
    Err(Error::scene(format!("a closed polyline whose wall, {thickness} m thick, leaves no space inside"))
        .help("make the wall thinner, or write a polygon, which is solid"))
}

/// Returns twice the area inside a closed outline: positive if it runs counter-clockwise.
fn doubled_area<const D: usize>(points: &[Vector<D>]) -> f64 {
    let (n, origin) = (points.len(), points[0]);
    (0..n).map(|i| wedge(&(points[i] - origin), &(points[(i + 1) % n] - origin))).sum()
}

fn compound<const D: usize>(parts: &[(crate::math::Pose<D>, Shape<D>)]) -> Result<()> {
    if parts.is_empty() {
        return Err(Error::scene("a compound without parts").help("give it at least one shape"));
    }
    for (pose, part) in parts {
        let skew = (pose.rotation.transpose() * pose.rotation - crate::math::Matrix::identity()).norm();
        if !pose.position.iter().all(|x| x.is_finite()) || skew.is_nan() || skew > 1e-6 {
            return Err(Error::scene("a part of a compound has a pose that is no pose")
                .help("give finite coordinates and a pure rotation"));
        }
        part.check()?;
    }
    Ok(())
}

/// Checks the properties that polygons and polylines have in common.
fn outline<const D: usize>(name: &str, points: &[Vector<D>], least: usize, closed: bool) -> Result<()> {
    if D != 2 {
        return Err(Error::scene(format!("a {name} is a 2-D shape"))
            .help("in 3-D use boxes, balls, cylinders, capsules, meshes"));
    }
    let n = points.len();
    if n < least {
        return Err(Error::scene(format!("a {name} of {n} points")).help(format!("give at least {least} points")));
    }
    if n > MOST_POINTS {
        return Err(Error::scene(format!("a {name} of {n} points; the most is {MOST_POINTS}"))
            .help("thin it out: what is finer than dp cannot be seen"));
    }
    if let Some(i) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(
            Error::scene(format!("point {} of a {name} is not a number", i + 1)).help("give finite coordinates")
        );
    }
    let edges = if closed { n } else { n - 1 };
    for i in 0..edges {
        if points[i] == points[(i + 1) % n] {
            let (a, b) = (i + 1, (i + 1) % n + 1);
            return Err(Error::scene(format!("points {a} and {b} of a {name} are the same")).help("leave one out"));
        }
    }
    for i in 0..edges {
        for j in i + 1..edges {
            let (a, b, c, d) = (&points[i], &points[(i + 1) % n], &points[j], &points[(j + 1) % n]);
            let crossed = match (j == i + 1, closed && (j + 1) % n == i) {
                (true, _) => folds(a, b, d),
                (_, true) => folds(c, d, b),
                _ => cross(a, b, c, d),
            };
            if crossed {
                let what = format!("a {name} crosses itself: edges {} and {}, counted from 1", i + 1, j + 1);
                return Err(Error::scene(what).help("reorder the points so that the outline never meets itself"));
            }
        }
    }
    Ok(())
}

/// Returns a₀b₁ − a₁b₀.
fn wedge<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns whether the corner a-b-c turns back by 180°.
fn folds<const D: usize>(a: &Vector<D>, b: &Vector<D>, c: &Vector<D>) -> bool {
    let (u, v) = (b - a, c - b);
    u.dot(&v) < 0.0 && wedge(&u, &v).abs() <= 1e-9 * u.norm() * v.norm()
}

/// Returns whether the segments a-b and c-d intersect or touch.
fn cross<const D: usize>(a: &Vector<D>, b: &Vector<D>, c: &Vector<D>, d: &Vector<D>) -> bool {
    let side = |p: &Vector<D>, q: &Vector<D>, x: &Vector<D>| wedge(&(q - p), &(x - p));
    let between = |p: &Vector<D>, q: &Vector<D>, x: &Vector<D>| (x - p).dot(&(x - q)) <= 0.0;
    let (s1, s2, s3, s4) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    s1 * s2 < 0.0 && s3 * s4 < 0.0
        || s1 == 0.0 && between(a, b, c)
        || s2 == 0.0 && between(a, b, d)
        || s3 == 0.0 && between(c, d, a)
        || s4 == 0.0 && between(c, d, b)
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/check.rs"]
mod tests;
