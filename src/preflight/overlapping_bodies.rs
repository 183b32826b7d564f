//! Bodies that overlap or stand in dry hollows of one another. The water that both would displace in the same place counts for
//! each of them in drafts, metacentric heights and periods, but only once in the run.

use super::{Finding, PreflightContext, hollows::is_in_dry_hollow};
use crate::{
    math::{Vector, format::three_digits},
    solid::Role,
};

/// Number of cells along each side of the box that two bodies have in common, in 2-D and 3-D.
const CELLS: [usize; 2] = [200, 40];

/// Share of the smaller body below which an overlap does not count: round-off of coordinates.
const LEAST: f64 = 1e-3;

/// Adds a note for each two bodies, one of them free, that displace the same water.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    if context.g == 0.0 {
        return;
    }
    let (solids, constraints) = (context.solids(), context.system.constraints());
    let is_free = |i: usize| matches!(solids[i].spec.role, Role::Free(_));
    let has_dry_hollow = |i: usize| context.hollows[i].as_ref().is_some_and(|own| own.particles.contains(&0));
    for j in 0..solids.len() {
        for i in 0..j {
            let may = !constraints.can_touch(i, j) || has_dry_hollow(i) || has_dry_hollow(j);
            if !(may && (is_free(i) || is_free(j))) {
                continue;
            }
            let common = common_volume(context, i, j);
            let volume = |k: usize| solids[k].spec.shape.volume_properties().volume;
            if common <= LEAST * volume(i).min(volume(j)) {
                continue;
            }
            let [one, other] = [i, j].map(|k| &solids[k].spec.name);
            let what = format!(
                "\"{one}\" and \"{other}\" have {} {} below the still level in common: its {} kg of water count for both in drafts, GM \
                 and periods",
                three_digits(common),
                ["m²", "m³"][D - 2],
                three_digits(common * context.system.model().rho0)
            );
            let mend = "cut one of them off there, or give the heights at which they rest without that water";
            findings.push(Finding::note("overlapping_bodies", what, mend.into()));
        }
    }
}

/// Returns the volume (m³; m² in 2-D) below the still level that is in both solids or their dry hollows, from the middles of cells.
fn common_volume<const D: usize>(context: &PreflightContext<D>, i: usize, j: usize) -> f64 {
    let solids = [i, j].map(|k| &context.solids()[k]);
    let [a, b] = solids.map(|solid| solid.spec.shape.bounds_at(&solid.kinematics.pose));
    // A body without water around it, as in a dry hold, displaces none.
    let [Some(level), Some(other)] = [i, j].map(|k| context.level_around(k)) else { return 0.0 };
    let (low, mut high) = (a.min.sup(&b.min), a.max.inf(&b.max));
    high[D - 1] = high[D - 1].min(level).min(other);
    let (size, cells) = (high - low, CELLS[D - 2]);
    if size.min() <= 0.0 {
        return 0.0;
    }
    let is_inside = |k: usize, x: &Vector<D>| {
        let solid = &context.solids()[k];
        let local = solid.kinematics.pose.local(x);
        solid.spec.shape.signed_distance(&local) < 0.0 || is_in_dry_hollow(context, k, &local)
    };
    let middle = |cell: usize| {
        let place = |axis: usize| ((cell / cells.pow(axis as u32) % cells) as f64 + 0.5) / cells as f64;
        low + Vector::<D>::from_fn(|axis, _| place(axis)).component_mul(&size)
    };
    let all = cells.pow(D as u32);
    let count = (0..all).map(middle).filter(|x| is_inside(i, x) && is_inside(j, x)).count();
    size.product() * count as f64 / all as f64
}
