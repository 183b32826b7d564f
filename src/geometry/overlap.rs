//! Detection of overlaps between two shapes, between the parts of a compound, and of a wall with itself.

use super::{
    Shape,
    wall::{is_closed, wall_parts},
};
use crate::{
    error::{Error, Result},
    math::{Bounds, Pose, Vector},
};

/// Largest accepted depth of overlap of two parts, over the least extent of the smaller part: the rounding of
/// coordinates with few digits. Also the largest accepted part of a wall that counts twice.
const DEEPEST: f64 = 1e-3;

/// Largest number of boxes in a search at a time: along oblique touching faces the number of boxes keeps growing.
const MOST_BOXES: usize = 10_000;

impl<const D: usize> Shape<D> {
    /// Checks that the parts of a compound, and the wall of a polyline away from its corners, at most touch one another: an
    /// overlap would count mass and displacement twice.
    ///
    /// # Errors
    /// A scene error that names two parts, counted from 1, the position of their overlap (m, in the frame of the shape) and its
    /// depth; or the area of a wall that counts twice.
    pub(crate) fn check_no_overlap(&self) -> Result<()> {
        let parts = match self {
            Shape::Compound(parts) => parts,
            Shape::Polyline { points, thickness } => return check_wall(points, *thickness),
            _ => return Ok(()),
        };
        parts.iter().try_for_each(|(_, part)| part.check_no_overlap())?;
        let least = |part: &Shape<D>| part.bounds().size().min();
        for (j, (there, second)) in parts.iter().enumerate() {
            for (i, (here, first)) in parts[..j].iter().enumerate() {
                let deeper = DEEPEST * least(first).min(least(second));
                if let Some((x, depth)) = find_overlap((first, here), (second, there), deeper) {
                    let at: Vec<String> = x.iter().map(|x| format!("{x:.4}")).collect();
                    let (i, j, at) = (i + 1, j + 1, at.join(", "));
                    let what =
                        format!("parts {i} and {j} of its compound overlap by {:.2e} m about ({at}) m", 2.0 * depth);
                    let help =
                        "make one smaller, or move it until they only touch: what overlaps weighs and displaces twice";
                    return Err(Error::scene(what).help(help));
                }
            }
        }
        Ok(())
    }
}

/// Checks that the parts of a wall that do not share a corner at most touch one another.
fn check_wall<const D: usize>(points: &[Vector<D>], thickness: f64) -> Result<()> {
    let (parts, edges) = (wall_parts(points, thickness), points.len() - 1);
    // The fans of rounded corners come after the edges; they overlap what the ends of their edges overlap.
    let sides: Vec<_> = parts[..edges].iter().map(|part| (part, Bounds::around(part))).collect();
    let (mut twice, mut largest) = (0.0, (0.0, Vector::zeros()));
    for (j, (second, there)) in sides.iter().enumerate() {
        for (i, (first, here)) in sides[..j].iter().enumerate() {
            let neighbours = i + 1 == j || (is_closed(points) && i == 0 && j + 1 == edges);
            let apart = (0..D).any(|k| here.min[k] >= there.max[k] || there.min[k] >= here.max[k]);
            if neighbours || apart {
                continue;
            }
            let (area, centre) = common_area(first, second);
            twice += area;
            largest = if area > largest.0 { (area, centre) } else { largest };
        }
    }
    let whole: f64 = parts.iter().map(|part| area_and_centre(part).0).sum();
    if twice <= DEEPEST * whole {
        return Ok(());
    }
    let at: Vec<String> = largest.1.iter().map(|x| format!("{x:.4}")).collect();
    let what = format!(
        "the wall of its polyline meets itself about ({}) m: {twice:.2e} m² of its {whole:.2e} m² count twice",
        at.join(", ")
    );
    let help = "end the line where its wall only touches, or end it at its first point to close it: what overlaps weighs and \
                displaces twice";
    Err(Error::scene(what).help(help))
}

/// Returns the area (m²) that two convex polygons have in common, counter-clockwise, and its centre (m).
fn common_area<const D: usize>(one: &[Vector<D>], other: &[Vector<D>]) -> (f64, Vector<D>) {
    let mut left = one.to_vec();
    for (i, a) in other.iter().enumerate() {
        let along = other[(i + 1) % other.len()] - a;
        let inside = |x: &Vector<D>| cross(&along, &(x - a));
        let mut kept = Vec::new();
        for (k, x) in left.iter().enumerate() {
            let next = &left[(k + 1) % left.len()];
            let (here, there) = (inside(x), inside(next));
            if here >= 0.0 {
                kept.push(*x);
            }
            if here * there < 0.0 {
                kept.push(x + (next - x) * (here / (here - there)));
            }
        }
        left = kept;
    }
    area_and_centre(&left)
}

/// Returns the area (m²) of a polygon, 0 if it runs clockwise, and the mean of its points (m).
fn area_and_centre<const D: usize>(points: &[Vector<D>]) -> (f64, Vector<D>) {
    let Some(first) = points.first() else { return (0.0, Vector::zeros()) };
    let wedges = points.windows(2).map(|ab| 0.5 * cross(&(ab[0] - first), &(ab[1] - first)));
    (wedges.sum::<f64>().max(0.0), points.iter().sum::<Vector<D>>() / points.len() as f64)
}

fn cross<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns a position (m) inside both posed shapes, deeper than `deeper` (m, positive), and its depth (m). The search
/// halves the common bounding box repeatedly, omits parts without such a position, and returns `None` if it finds none.
pub(crate) fn find_overlap<const D: usize>(
    (one, here): (&Shape<D>, &Pose<D>),
    (other, there): (&Shape<D>, &Pose<D>),
    deeper: f64,
) -> Option<(Vector<D>, f64)> {
    let (a, b) = (one.bounds_at(here), other.bounds_at(there));
    let (min, max) = (a.min.sup(&b.min), a.max.inf(&b.max));
    let mut half = (max - min) * 0.5;
    if half.min() <= deeper {
        return None;
    }
    let distance = |x: &Vector<D>| one.signed_distance(&here.local(x)).max(other.signed_distance(&there.local(x)));
    let mut boxes = vec![(min + max) * 0.5];
    while boxes.len() <= MOST_BOXES && half.max() > 0.1 * deeper {
        let judged: Vec<(Vector<D>, f64)> = boxes.iter().map(|x| (*x, distance(x))).collect();
        let (x, least) = *judged.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        if least < -deeper {
            return Some((x, -least));
        }
        let (reach, longest, mut step) = (half.norm(), half.imax(), Vector::zeros());
        half[longest] *= 0.5;
        step[longest] = half[longest];
        boxes = judged.iter().filter(|(_, d)| d - reach < -deeper).flat_map(|(x, _)| [x - step, x + step]).collect();
    }
    None
}

#[cfg(test)]
#[path = "../../tests/unit/geometry/overlap.rs"]
mod tests;
