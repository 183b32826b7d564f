//! Groups of solids that joints tie together.

use super::{Constraints, Role, SolidSpec};
use crate::math::Vector;

/// The bodies that joints tie together, as numbers that they share.
pub(crate) struct JointGroups {
    /// Of each solid: a number that solids share which rise together.
    pub(crate) rising: Vec<usize>,
    /// Of each solid: a number that solids share between which there are joints.
    pub(crate) jointed: Vec<usize>,
    /// Whether a joint to a solid that is not free, or a lock, holds the height of each solid.
    pub(crate) held: Vec<bool>,
}

impl JointGroups {
    /// The groups of `solids`. A number is that of the first solid of its group.
    pub(crate) fn of<const D: usize>(solids: &[&SolidSpec<D>], constraints: &Constraints<D>) -> Self {
        let n = solids.len();
        let free = |i: usize| matches!(solids[i].role, Role::Free(_));
        let (mut rising, mut jointed): (Vec<usize>, Vec<usize>) = ((0..n).collect(), (0..n).collect());
        let locked = |i: usize| matches!(&solids[i].role, Role::Free(body) if body.locked_translations[D - 1]);
        let mut held: Vec<bool> = (0..n).map(locked).collect();
        let up = Vector::from_fn(|i, _| if i == D - 1 { 1.0 } else { 0.0 });
        for joint in &constraints.joints {
            let rises_alone = joint.frees_translation(&up);
            match joint.between {
                [Some(a), Some(b)] if free(a) && free(b) => {
                    merge(&mut jointed, a, b);
                    if !rises_alone {
                        merge(&mut rising, a, b);
                    }
                }
                ends => ends.into_iter().flatten().filter(|i| free(*i)).for_each(|i| held[i] |= !rises_alone),
            }
        }
        for i in 0..n {
            let own = (0..n).any(|j| rising[j] == rising[i] && held[j]);
            held[i] |= own;
        }
        Self { rising, jointed, held }
    }
}

/// Unites the groups of `a` and `b`.
pub(super) fn merge(group: &mut [usize], a: usize, b: usize) {
    let (first, other) = (group[a].min(group[b]), group[a].max(group[b]));
    group.iter_mut().filter(|number| **number == other).for_each(|number| *number = first);
}
