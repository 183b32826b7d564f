//! Groups of solids that joints tie together.

use super::{Constraints, Role, SolidSpec};
use crate::math::Vector;

/// Upward part of the direction of a guide to a solid that is not free, from which bodies rise along it.
const STEEP: f64 = 0.05;

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
            let is_guided = || joint.guide().is_some_and(|along| along[D - 1].abs() > STEEP);
            match joint.between {
                [Some(a), Some(b)] if free(a) && free(b) => {
                    merge(&mut jointed, a, b);
                    if !rises_alone {
                        merge(&mut rising, a, b);
                    }
                }
                ends => ends
                    .into_iter()
                    .flatten()
                    .filter(|i| free(*i))
                    .for_each(|i| held[i] |= !rises_alone && !is_guided()),
            }
        }
        for i in 0..n {
            let own = (0..n).any(|j| rising[j] == rising[i] && held[j]);
            held[i] |= own;
        }
        Self { rising, jointed, held }
    }
}

/// Returns the displacement of each solid for each metre that it rises: upwards, and for one that an inclined guide ties to a solid that
/// is not free, and for those that rise with it, along the guide.
pub(crate) fn rise_directions<const D: usize>(
    solids: &[&SolidSpec<D>],
    constraints: &Constraints<D>,
    groups: &JointGroups,
) -> Vec<Vector<D>> {
    let free = |i: &usize| matches!(solids[*i].role, Role::Free(_));
    let mut all = vec![Vector::from_fn(|i, _| if i == D - 1 { 1.0 } else { 0.0 }); solids.len()];
    for joint in &constraints.joints {
        let (ends, along) = (joint.between, joint.guide().filter(|along| along[D - 1].abs() > STEEP));
        let mut own = ends.into_iter().flatten().filter(free);
        let (Some(along), Some(i), None) = (along, own.next(), own.next()) else { continue };
        let own = (0..solids.len()).filter(|j| groups.rising[*j] == groups.rising[i]);
        own.for_each(|j| all[j] = along / along[D - 1]);
    }
    all
}

/// Unites the groups of `a` and `b`.
pub(super) fn merge(group: &mut [usize], a: usize, b: usize) {
    let (first, other) = (group[a].min(group[b]), group[a].max(group[b]));
    group.iter_mut().filter(|number| **number == other).for_each(|number| *number = first);
}
