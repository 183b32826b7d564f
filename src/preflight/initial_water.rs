//! Bodies of water whose initial state is probably a mistake: off the lattice, in the air, without walls, on one another, or not as
//! long as a period.

use std::collections::HashMap;

use super::{Finding, PreflightContext};
use crate::math::{
    Bounds, Vector,
    format::{coordinates, three_digits},
};

/// Largest accepted difference between the level and the top of the highest row of particles, dp. It is half a dp for a level
/// midway between two rows.
pub(super) const OFF_LATTICE: f64 = 0.2;

/// Depth below a particle of the lowest row within which something carries it, dp.
const CARRIED: f64 = 1.5;

/// Share of the hydrostatic pressure of a sideways gravity below which the water at the start counts as without it, –.
const MISSING: f64 = 0.5;

/// Adds a note if gravity points to a side without an opening and the water starts without the pressure that belongs to it.
fn check_sideways<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, gravity) = (context.system, context.system.gravity());
    let Some(axis) = (0..D - 1).max_by(|a, b| gravity[*a].abs().total_cmp(&gravity[*b].abs())) else { return };
    let (pull, water, rho0) = (gravity[axis], system.fluid(), system.properties().rho0);
    if gravity[D - 1].abs() > 0.9 * gravity.norm() || pull == 0.0 || system.is_open(axis) {
        return;
    }
    let bounds = Bounds::around(water.r).grown(0.5 * context.dp());
    let hydrostatic = rho0 * pull.abs() * bounds.size()[axis];
    let most = water.rho.iter().map(|rho| system.pressure(*rho)).fold(0.0, f64::max);
    if most >= MISSING * hydrostatic {
        return;
    }
    let letter = ["x", "y", "z"][axis];
    let slope = three_digits(rho0 * pull);
    let from = if pull > 0.0 { bounds.min[axis] } else { bounds.max[axis] };
    let way = match three_digits(from.abs()) {
        _ if from.abs() < 1e-9 * context.dp() => letter.into(),
        shown if from < 0.0 => format!("{letter} + {shown}"),
        shown => format!("{letter} - {shown}"),
    };
    let what = format!(
        "gravity points along {letter}, and the water starts without its pressure of up to {} Pa: it starts with a pressure wave",
        three_digits(hydrostatic)
    );
    findings.push(Finding::note(
        "sideways_gravity",
        what,
        format!("give the [[water]]  pressure = \"{slope}*({way})\""),
    ));
}

/// Adds findings about the open bodies of water.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let boxes = &context.open_water;
    check_periods(context, boxes, findings);
    let gravity = context.system.gravity();
    if gravity[D - 1] > 0.9 * gravity.norm() {
        let list = |values: Vec<f64>| format!("{values:?}");
        let down = gravity.iter().map(|g| if *g == 0.0 { 0.0 } else { -g }).collect();
        let what = format!("gravity is {} m/s²: it points upwards", list(gravity.iter().copied().collect()));
        findings.push(Finding::warning("gravity_direction", what, format!("write  gravity = {}", list(down))));
    }
    check_sideways(context, findings);
    if context.g <= 0.0 {
        return;
    }
    check_walls(context, findings);
    check_surface(context, findings);
    for (i, own) in boxes.iter().enumerate() {
        check_support(context, i, own, findings);
        for (j, other) in boxes.iter().enumerate() {
            check_stack(context, (i, own), (j, other), findings);
        }
    }
}

/// Adds a finding about a level between two rows of particles.
fn check_surface<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (dp, level) = (context.dp(), context.still_water.level);
    // The highest particle of each column of one dp. Those beside bodies and beaches are packed, and may stand above their row.
    let mut tops: HashMap<[i64; D], f64> = HashMap::new();
    for x in context.system.fluid().r {
        let column = std::array::from_fn(|i| if i + 1 < D { (x[i] / dp).floor() as i64 } else { 0 });
        let top = tops.entry(column).or_insert(f64::NEG_INFINITY);
        *top = top.max(x[D - 1]);
    }
    let mut row: Vec<f64> = tops.into_values().filter(|top| (top + 0.5 * dp - level).abs() <= dp).collect();
    row.sort_by(f64::total_cmp);
    let Some(&highest) = row.get(row.len() / 2) else { return };
    let off = highest + 0.5 * dp - level;
    // Round regions are packed without rows.
    let in_row = row.iter().filter(|top| (*top - highest).abs() < OFF_LATTICE * dp).count();
    if off.abs() <= OFF_LATTICE * dp || 2 * in_row < row.len() {
        return;
    }
    let what = format!(
        "the particles of the water reach {} m, and its level is {} m: the depth that they give is {} dp {}",
        three_digits(highest + 0.5 * dp),
        three_digits(level),
        three_digits(off.abs() / dp),
        if off > 0.0 { "more" } else { "less" }
    );
    let mend = "choose level and bottom a whole number of dp apart".to_string();
    findings.push(Finding::note("surface_off_lattice", what, mend));
}

/// Adds a finding about water if nothing carries its lowest row.
fn check_support<const D: usize>(
    context: &PreflightContext<D>,
    number: usize,
    own: &Bounds<D>,
    findings: &mut Vec<Finding>,
) {
    let dp = context.dp();
    let fluid = context.system.fluid().r;
    let lowest = fluid.iter().filter(|x| own.contains(x)).map(|x| x[D - 1]).fold(f64::INFINITY, f64::min);
    let row: Vec<&Vector<D>> = fluid.iter().filter(|x| own.contains(x) && x[D - 1] < lowest + 0.5 * dp).collect();
    let is_carried = |x: &&Vector<D>| {
        // Both places, because a thin floor lies between them.
        let below = [0.5, CARRIED].map(|rows| Vector::from_fn(|i, _| x[i] - if i == D - 1 { rows * dp } else { 0.0 }));
        let is_near = |y: &Vector<D>| context.solids().iter().any(|solid| solid.distance(y) < 0.5 * dp);
        let by_solid = below.iter().any(is_near);
        let mut by_water = false;
        context.system.visit_fluid_near(x, &mut |_, y, _| by_water |= y[D - 1] < x[D - 1] - 0.5 * dp);
        by_solid || by_water
    };
    // Particles beside a wall count as carried by it, so half of the row decides.
    if row.is_empty() || 2 * row.iter().filter(|x| is_carried(x)).count() >= row.len() {
        return;
    }
    let what = format!(
        "water.{} begins at {} m, and nothing is under it: it falls at the start",
        context.open_numbers[number],
        three_digits(lowest - 0.5 * dp)
    );
    let mend = format!("let it begin on the floor, or put one under it, as at {}", coordinates(&own.min));
    findings.push(Finding::note("water_in_air", what, mend));
}

/// Adds a finding about the side to which most rows of water have no solid and no face before them: the water runs out.
fn check_walls<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, dp) = (context.system, context.dp());
    let mut worst: Option<(usize, String)> = None;
    for axis in 0..D - 1 {
        // The place of a particle across the axis, in cells of dp, and how far out the outermost ones are there on both sides.
        let cell = |x: &Vector<D>| -> [i64; D] {
            std::array::from_fn(|i| if i == axis { 0 } else { (x[i] / dp).floor() as i64 })
        };
        let outermost = |all: &[Vector<D>]| {
            let mut ends: HashMap<[i64; D], [f64; 2]> = HashMap::new();
            for x in all {
                let [low, high] = ends.entry(cell(x)).or_insert([f64::NEG_INFINITY; 2]);
                (*low, *high) = (low.max(-x[axis]), high.max(x[axis]));
            }
            ends
        };
        let is_held = |sense: f64| {
            let plane = system.symmetry_planes().0[axis].is_some_and(|plane| plane.is_upper == (sense < 0.0));
            plane || system.open_boundaries().iter().any(|face| face.axis == axis && face.outward() == sense)
        };
        let senses: Vec<_> = [-1.0, 1.0].into_iter().enumerate().filter(|(_, sense)| !is_held(*sense)).collect();
        if senses.is_empty() || system.periodic()[axis].is_some() {
            continue;
        }
        let (water, walls) = (outermost(system.fluid().r), outermost(system.boundary().r));
        for (side, sense) in senses {
            let is_open = |(at, ends): &(&[i64; D], &[f64; 2])| {
                let near = (0..3usize.pow(D as u32)).map(|k| -> [i64; D] {
                    std::array::from_fn(
                        |i| if i == axis { 0 } else { at[i] + (k / 3usize.pow(i as u32) % 3) as i64 - 1 },
                    )
                });
                near.filter_map(|cell| walls.get(&cell)).all(|wall| wall[side] < ends[side])
            };
            let open: Vec<_> = water.iter().filter(is_open).collect();
            let heights = || open.iter().map(|(at, _)| at[D - 1]);
            let (Some(low), Some(high)) = (heights().min(), heights().max()) else { continue };
            if worst.as_ref().is_none_or(|(most, _)| open.len() > *most) {
                let end = open.iter().map(|(_, ends)| ends[side]).fold(f64::NEG_INFINITY, f64::max);
                let what = format!(
                    "no wall and no face holds the water at {} = {} m, {} to {} m high: it runs out",
                    ["x", "y"][axis],
                    three_digits(sense * (end + 0.5 * dp)),
                    three_digits(low as f64 * dp),
                    three_digits((high + 1) as f64 * dp)
                );
                worst = Some((open.len(), what));
            }
        }
    }
    findings.extend(worst.map(|(_, what)| {
        Finding::warning(
            "open_side",
            what,
            "make the walls higher, or put one, an [[inflow]] or an [[outflow]] there".into(),
        )
    }));
}

/// Adds a finding about water above the level of other water that it touches.
fn check_stack<const D: usize>(
    context: &PreflightContext<D>,
    (i, own): (usize, &Bounds<D>),
    (j, other): (usize, &Bounds<D>),
    findings: &mut Vec<Finding>,
) {
    let dp = context.dp();
    let overlap = |axis: usize| own.max[axis].min(other.max[axis]) - own.min[axis].max(other.min[axis]);
    let over = (0..D - 1).all(|axis| overlap(axis) > dp);
    let (level, above) = (other.max[D - 1], own.max[D - 1]);
    let touches = own.min[D - 1] <= level + 0.5 * dp && other.min[D - 1] <= own.min[D - 1];
    // The first of two overlapping entries has the water of both, so an earlier one stands on a later one that begins below it.
    let stands = i > j || other.min[D - 1] < own.min[D - 1] - 0.5 * dp;
    if i == j || !over || above < level + dp || !touches || !stands {
        return;
    }
    let (i, j) = (context.open_numbers[i], context.open_numbers[j]);
    let what = format!(
        "water.{i} stands to {} m on water.{j}, which starts with the pressure below its own level, {} m",
        three_digits(above),
        three_digits(level)
    );
    let mend = format!("make them one body of water, or write  level = {}  in both", three_digits(above));
    findings.push(Finding::warning("stacked_water", what, mend));
}

/// Adds a finding about water that is not as long as a period.
fn check_periods<const D: usize>(context: &PreflightContext<D>, boxes: &[Bounds<D>], findings: &mut Vec<Finding>) {
    let Some(all) = boxes.iter().copied().reduce(|a, b| a.union(&b)) else { return };
    for (axis, [from, to]) in
        context.system.periodic().iter().enumerate().filter_map(|(axis, side)| Some((axis, (*side)?)))
    {
        let (name, period, length) = (["x", "y", "z"][axis], to - from, all.size()[axis]);
        let ends = format!("from {name} = {} to {} m", three_digits(all.min[axis]), three_digits(all.max[axis]));
        let mend =
            format!("write  periodic.{name} = [{}, {}]", three_digits(all.min[axis]), three_digits(all.max[axis]));
        let period = three_digits(period);
        if length > to - from + 0.5 * context.dp() {
            let what =
                format!("the water is given {ends}, and the period is {period} m: it overlaps its periodic image");
            findings.push(Finding::warning("longer_than_period", what, mend));
        } else if length < to - from - 0.5 * context.dp() {
            let what =
                format!("the water is given {ends}, and the period is {period} m: it does not meet its periodic image");
            findings.push(Finding::note("shorter_than_period", what, mend));
        }
    }
}
