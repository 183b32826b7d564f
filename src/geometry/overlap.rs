//! Detection of overlaps between two shapes and between the parts of a compound.

use super::Shape;
use crate::{
    error::{Error, Result},
    math::{Pose, Vector},
};

/// Largest accepted depth of overlap of two parts, over the least extent of the smaller part: the rounding of
/// coordinates with few digits.
const DEEPEST: f64 = 1e-3;

/// Largest number of boxes in a search at a time: along oblique touching faces the number of boxes keeps growing.
const MOST_BOXES: usize = 10_000;

impl<const D: usize> Shape<D> {
    /// Checks that the parts of a compound at most touch one another: an overlap would count mass and displacement
    /// twice.
    ///
    /// # Errors
    /// A scene error that names two parts, counted from 1, the position of their overlap (m, in the compound's frame)
    /// and its depth.
    pub(crate) fn check_no_overlap(&self) -> Result<()> {
        let Shape::Compound(parts) = self else { return Ok(()) };
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
