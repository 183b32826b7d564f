//! Solids that differ between the two periodic sides of an axis: water that crosses a side there enters a solid or falls off it.

use super::{Finding, PreflightContext};
use crate::{
    geometry::cells::PointCells,
    math::{Vector, format::coordinates},
    solid::Solid,
};

/// Largest distance of a boundary particle from its counterpart a period away, dp: of two lattices of any position.
const APART: f64 = 1.2;

/// Adds a finding for each periodic axis at whose sides boundary particles beside water have no counterpart.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, dp) = (context.system, context.dp());
    if system.periodic().iter().all(Option::is_none) {
        return;
    }
    let stays = |solid: &&Solid<D>| solid.copied_axes == 0;
    let ranges: Vec<_> = context.solids().iter().filter(stays).map(|solid| solid.boundary.clone()).collect();
    let all = system.boundary().r;
    let places: Vec<Vector<D>> = ranges.iter().flat_map(|range| all[range.clone()].iter().copied()).collect();
    let cells = PointCells::new(&places, APART * dp);
    let is_lone = |x: &Vector<D>| {
        let mut lone = true;
        cells.visit_near(x, APART * dp, |_, y| lone &= (x - y).norm() > APART * dp);
        lone
    };
    let wet: Vec<&Vector<D>> = system
        .neighbours
        .boundary_near_fluid()
        .iter()
        .filter(|&&i| ranges.iter().any(|range| range.contains(&(i as usize))))
        .map(|&i| &all[i as usize])
        .collect();
    for (axis, [from, to]) in system.periodic().iter().enumerate().filter_map(|(axis, side)| Some((axis, (*side)?))) {
        let counterpart = |x: &Vector<D>, way: f64| {
            let mut x = *x;
            x[axis] += way;
            x
        };
        let near = |x: f64, side: f64| (x - side).abs() <= 0.5 * dp;
        let at = |side: f64, way: f64| {
            let beside = wet.iter().filter(move |x| near(x[axis], side));
            beside.filter(move |x| is_lone(&counterpart(x, way))).collect::<Vec<_>>()
        };
        let lone = [at(from, to - from), at(to, from - to)].concat();
        let Some(one) = lone.first() else { continue };
        let name = ["x", "y", "z"][axis];
        let what = format!(
            "the walls differ at the periodic sides {name} = {from} and {to} m: {} boundary particles beside water have none \
             a period away, the first at {}",
            lone.len(),
            coordinates(one.iter())
        );
        let mend = format!(
            "give the solids the same section at both sides, or put the sides of  periodic.{name}  where they have"
        );
        findings.push(Finding::warning("unequal_sides", what, mend));
    }
}
