//! Free bodies that stand on the deck of another free body by contact alone. They count in its equilibrium as if they were bolted
//! to it.

use super::{Constraints, JointKind, JointSpec, Role, SolidSpec};
use crate::{geometry::Shape, math::Pose};

/// Distance (dp) between a body and a deck up to which it stands there.
const REACH: f64 = 0.5;

/// Number of columns along each horizontal axis in which the distance between two solids is found, in 2-D and 3-D.
const COLUMNS: [usize; 2] = [64, 12];

/// Distance over `REACH` at which a column meets a surface.
const MEETS: f64 = 1e-3;

/// Most steps along a column.
const STEPS: usize = 200;

/// Returns whether nothing but a deck can carry a free solid: it has no tie at the start, and no lock.
pub(crate) fn may_stand<const D: usize>(spec: &SolidSpec<D>, i: usize, constraints: &Constraints<D>) -> bool {
    let Role::Free(body) = &spec.role else { return false };
    let locked = body.locked_translations.contains(&true) || body.locked_rotations.contains(&true);
    !locked && constraints.constraint_on(i, 0.0).is_none()
}

/// Returns the free solid on which solid number `i` stands with the solids at these poses; `None` if it stands on nothing, on several
/// solids or on one that is not free.
pub(crate) fn deck_of<const D: usize>(
    specs: &[&SolidSpec<D>],
    poses: &[Pose<D>],
    constraints: &Constraints<D>,
    i: usize,
    dp: f64,
) -> Option<usize> {
    let mut supports = supports_of(specs, poses, constraints, i, dp);
    let (deck, None) = (supports.next()?, supports.next()) else { return None };
    matches!(specs[deck].role, Role::Free(_)).then_some(deck)
}

/// Returns the solids on which solid number `i` stands with the solids at these poses.
pub(crate) fn supports_of<const D: usize>(
    specs: &[&SolidSpec<D>],
    poses: &[Pose<D>],
    constraints: &Constraints<D>,
    i: usize,
    dp: f64,
) -> impl Iterator<Item = usize> {
    let solid = |k: usize| (&specs[k].shape, &poses[k]);
    let below = move |j: &usize| *j != i && constraints.can_touch(i, *j) && stands_on(solid(i), solid(*j), REACH * dp);
    (0..specs.len()).filter(below)
}

/// Returns the joint that takes the place of the contact of solid number `upper` with its deck.
pub(crate) fn standing_joint<const D: usize>(specs: &[&SolidSpec<D>], [upper, deck]: [usize; 2]) -> JointSpec<D> {
    let at = specs[upper].initial_kinematics().centre;
    JointSpec::new(&specs[upper].name, JointKind::Fixed, [Some(deck), Some(upper)], at, nalgebra::zero())
}

/// Returns whether the lower side of `upper` is within `reach` (m) of a surface of `lower` below it.
fn stands_on<const D: usize>(upper: (&Shape<D>, &Pose<D>), lower: (&Shape<D>, &Pose<D>), reach: f64) -> bool {
    let [own, other] = [upper, lower].map(|(shape, pose)| shape.bounds_at(pose));
    let (min, max) = (own.min.sup(&other.min), own.max.inf(&other.max));
    let meets = MEETS * reach;
    if (0..D - 1).any(|axis| max[axis] - min[axis] < meets) || other.min[D - 1] > own.min[D - 1] {
        return false;
    }
    let columns = COLUMNS[D - 2];
    // Follows a column from the height `from` (m) to the surface of a solid: upwards, or downwards.
    let surface = |(shape, pose): (&Shape<D>, &Pose<D>), column: usize, from: f64, way: f64, end: f64| {
        let place = |axis: usize| ((column / columns.pow(axis as u32) % columns) as f64 + 0.5) / columns as f64;
        let mut x = min.zip_map(&max, |a, b| b - a);
        (0..D - 1).for_each(|axis| x[axis] = min[axis] + place(axis) * x[axis]);
        x[D - 1] = from;
        for _ in 0..STEPS {
            let distance = shape.signed_distance(&pose.local(&x));
            if distance < meets {
                return Some((x[D - 1], distance));
            }
            x[D - 1] += way * distance;
            if (x[D - 1] - end) * way > 0.0 {
                return None;
            }
        }
        None
    };
    let gap = |column: usize| {
        let (foot, _) = surface(upper, column, own.min[D - 1], 1.0, own.max[D - 1])?;
        let from = foot + reach;
        let (top, distance) = surface(lower, column, from, -1.0, other.min[D - 1])?;
        // A column that starts in the solid has no distance.
        Some(if top == from && distance < -meets { f64::NEG_INFINITY } else { foot - top })
    };
    let least = (0..columns.pow(D as u32 - 1)).filter_map(gap).fold(f64::INFINITY, f64::min);
    least.abs() <= reach
}

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../tests/unit/solid/decks.rs"]
mod tests;
