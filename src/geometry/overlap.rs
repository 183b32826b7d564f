//! Where two shapes overlap, and whether the parts of a compound do.

use super::Shape;
use crate::{
    error::{Error, Result},
    math::{Pose, Vector},
};

/// How deep in both a place of two parts may be, over the least extent of the smaller: the round-off of numbers written
/// with a few digits.
const DEEPEST: f64 = 1e-3;

/// Most boxes that are searched at once: along faces that touch aslant they become ever more.
const MOST_BOXES: usize = 10_000;

impl<const D: usize> Shape<D> {
    /// Whether the parts of a compound touch one another at most: what overlaps would weigh and displace twice.
    ///
    /// # Errors
    /// A scene error that names two parts, counted from 1, where they overlap (m, in the compound's frame), and how much.
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

/// A place (m) more than `deeper` (m, above zero) inside both posed shapes, and how deep it is (m): looked for in boxes
/// that are halved as long as they may hold one.
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
mod tests {
    use super::*;

    fn refusal<const D: usize>(parts: Vec<(Pose<D>, Shape<D>)>) -> String {
        Shape::Compound(parts).check_no_overlap().err().map(|e| e.to_string()).unwrap_or_default()
    }

    fn bar(at: [f64; 3], turn: f64) -> (Pose<3>, Shape<3>) {
        (Pose::rotated(at.into(), &[0.0, 0.0, turn]), Shape::Box { size: [1.0, 0.02, 0.02].into() })
    }

    #[test]
    fn parts_that_overlap_are_named_with_the_place() {
        let block = |x: f64| (Pose::at([x, 0.0].into()), Shape::<2>::Box { size: [0.5, 0.4].into() });
        let message = refusal(vec![block(0.0), block(2.0), block(0.45)]);
        assert!(message.contains("parts 1 and 3") && message.contains("5.00e-2 m about (0.2250, 0.0000)"), "{message}");
        let inner = (Pose::identity(), Shape::Compound(vec![block(0.0), block(0.1)]));
        assert!(refusal(vec![block(3.0), inner]).contains("parts 1 and 2"));
        // Thin bars that cross far from the middle of the box around both.
        assert!(refusal(vec![bar([0.0; 3], 0.3), bar([0.3, 0.1, 0.0], -0.9)]).contains("overlap"));
        assert_eq!(refusal(vec![bar([0.0; 3], 0.3), bar([0.3, 0.1, 0.021], -0.9)]), "");
    }

    #[test]
    fn parts_that_touch_pass() {
        let block = |at: [f64; 3], turn: f64| {
            (Pose::rotated(at.into(), &[0.0, turn, 0.0]), Shape::Box { size: [0.5, 0.4, 0.3].into() })
        };
        assert_eq!(refusal(vec![block([0.0; 3], 0.0), block([0.5, 0.1, 0.0], 0.0)]), "");
        let (up, along) = 0.7f64.sin_cos();
        // Side by side along the turned edges, to the fourth digit.
        let beside = [0.5 * along, 0.0, -0.5 * up].map(|x| (1e4 * x).round() * 1e-4);
        assert_eq!(refusal(vec![block([0.0; 3], 0.7), block(beside, 0.7)]), "");
        let ball = |x: f64| (Pose::at([x, 0.0, 0.0].into()), Shape::Ball { radius: 0.1 });
        assert_eq!(refusal(vec![block([0.0; 3], 0.0), ball(0.35), ball(-0.35)]), "");
        let tank = (Pose::identity(), Shape::<3>::Tank { size: [0.5, 0.4, 0.3].into(), thickness: 0.1 });
        assert_eq!(refusal(vec![tank, block([0.25, 0.2, 0.15], 0.0)]), "", "in its hollow");
    }
}
