//! The rows of a buffer whose level or velocity changes in time.
//!
//! A row is a line of particles normal to the face, dp apart, which move along it with one velocity. While water leaves, the rows
//! give way to it. When the flow turns inwards and at least one column of that water lies in the buffer, rows up to the present
//! level replace this water. They have one particle to each dpᴰ, the first of them dp from the water. While water enters, a
//! particle that came from the water returns without a successor. A row whose far end has moved in by dp gets a new particle
//! there. A column gets a row on top when the level rises past the middle of that row, and loses its top row when the level falls
//! below it.
//!
//! Water that has left is not in rows. Where the velocity differs from height to height, its particles could come arbitrarily
//! near to each other, because nothing in a buffer repels them. Particles nearer than a part of dp therefore move apart at each
//! rebuild of the lists.

use std::collections::{BTreeMap, BTreeSet};

use super::{BufferTag, OpenBoundary, buffer_length};
use crate::{math::Vector, solid::Role, system::System};

/// Height of the middle of a row above the level beyond which the row is removed, over dp. A new row is placed if its middle is
/// not above the level.
const REMOVED: f64 = 0.25;

/// Height above the level beyond which water in the buffer of a face that holds the pressure is removed, over dp.
const WATER_REMOVED: f64 = 1.0;

/// Least distance of a particle on top of a column from water in the buffer, over dp.
const CLEARANCE: f64 = 0.75;

/// Distance below which water in the buffer moves away from another particle, over dp.
const NEAREST: f64 = 0.85;

/// Farthest that water in the buffer moves away at a rebuild of the lists, over dp; a jump would be a blow to the water beside it.
const FARTHEST: f64 = 0.1;

/// Part of dp by which places that should be equal may differ.
const ROUNDING: f64 = 1e-6;

/// A new particle of a buffer.
pub(in crate::system) struct Created<const D: usize> {
    /// The particle that it is a copy of.
    pub(in crate::system) source: u32,
    /// Number of its face.
    pub(in crate::system) face: usize,
    /// Its place, m.
    pub(in crate::system) r: Vector<D>,
    /// Its velocity, m/s.
    pub(in crate::system) v: Vector<D>,
}

/// The coordinates of a row across the face in dp from those of another, the height last.
type Row = Vec<i64>;

/// The row of the particle at `x` (m) beyond `face`, in spacings `dp` (m) from that at `origin` (m).
fn row<const D: usize>(face: &OpenBoundary<D>, (origin, dp): (&Vector<D>, f64), x: &Vector<D>) -> Row {
    (0..D).filter(|axis| *axis != face.axis).map(|axis| ((x[axis] - origin[axis]) / dp).round() as i64).collect()
}

/// One position (m) in the face for each row of the particles at `r` (m), with rows `dp` (m) apart.
pub(super) fn places<'a, const D: usize>(
    face: &OpenBoundary<D>,
    dp: f64,
    r: impl Iterator<Item = &'a Vector<D>>,
) -> Vec<Vector<D>> {
    let (mut rows, mut origin) = (BTreeMap::<Row, Vector<D>>::new(), None);
    for x in r {
        let origin = origin.get_or_insert(*x);
        let mut place = *x;
        place[face.axis] = face.at;
        rows.entry(row(face, (origin, dp), x)).or_insert(place);
    }
    rows.into_values().collect()
}

/// The row of the particle at `x` (m) beyond face number `number`; of a column all but the last number are the same.
fn row_of<const D: usize>(system: &System<D>, number: usize, x: &Vector<D>) -> Row {
    let origin = system.fluid.buffer.rows[number].first().unwrap_or(x);
    row(&system.fluid_domain.open_boundaries[number], (origin, system.model.dp), x)
}

/// Whether a new particle replaces water that has left through face number `number` and returns. A face that keeps rows continues
/// only the rows while water enters.
pub(super) fn replaces_water<const D: usize>(system: &System<D>, number: usize) -> bool {
    let face = &system.fluid_domain.open_boundaries[number];
    !face.keeps_rows() || prescribed_outward(system, number).is_some_and(|outward| outward >= 0.0)
}

/// The sum over the rows of the prescribed velocity (m/s) out of the water, if the face has one.
fn prescribed_outward<const D: usize>(system: &System<D>, number: usize) -> Option<f64> {
    let buffer = &system.fluid.buffer;
    let face = &system.fluid_domain.open_boundaries[number];
    face.velocity.as_ref()?;
    Some(buffer.rows[number].iter().filter_map(|x| face.outward_velocity(x, buffer.time)).sum())
}

/// Updates the rows of face number `number`: the tagged particles of the buffer, and the newly created particles. `inside` is the
/// water.
pub(super) fn keep<const D: usize>(
    system: &System<D>,
    number: usize,
    inside: &[u32],
    (buffer, created): (&mut Vec<(u32, BufferTag)>, &mut Vec<Created<D>>),
) {
    let face = &system.fluid_domain.open_boundaries[number];
    let particles = &system.fluid.particles;
    let own = || buffer.iter().filter(|(_, tag)| tag.face() == number);
    let outward = own().map(|(i, _)| face.outward() * particles.v[*i as usize][face.axis]).sum::<f64>();
    let enters = outward < 0.0 && prescribed_outward(system, number).is_none_or(|outward| outward < 0.0);
    let rows = rows_at_level(system, number);
    if enters && own().filter(|(_, tag)| tag.is_from_water()).count() >= rows.len() {
        let old: Vec<u32> = own().map(|(i, _)| *i).collect();
        buffer.retain(|(_, tag)| tag.face() != number);
        created.retain(|new| new.face != number);
        created.extend(new_rows(system, number, &rows, (&old, inside)));
        return;
    }
    complete(system, number, (buffer, created));
    if face.has_moving_level() {
        follow_level(system, number, (buffer, created));
    }
}

/// Returns index and new position (m) of each particle of water that has left through face number `number` and is too near to
/// another in the buffer. It moves away by half of the missing distance from other such water, and by the whole of it from a row,
/// but not out of the buffer or into a solid.
pub(super) fn spread<const D: usize>(system: &System<D>, number: usize) -> Vec<(usize, Vector<D>)> {
    let face = &system.fluid_domain.open_boundaries[number];
    let (buffer, water) = (&system.fluid.buffer, system.particle_count());
    let r = &system.fluid.particles.r;
    let [nearest, farthest] = [NEAREST, FARTHEST].map(|part| part * system.model.dp);
    let mut own: Vec<(usize, BufferTag)> =
        (water..).zip(buffer.tags.iter().copied()).filter(|(_, tag)| tag.face() == number).collect();
    if own.iter().all(|(_, tag)| !tag.is_from_water()) {
        return Vec::new();
    }
    own.sort_by(|(a, _), (b, _)| r[*a][face.axis].total_cmp(&r[*b][face.axis]).then(a.cmp(b)));
    let rows: BTreeSet<Row> = rows_at_level(system, number).iter().map(|x| row_of(system, number, x)).collect();
    let push = |(k, (i, tag)): (usize, &(usize, BufferTag))| {
        let near = |(j, _): &&(usize, BufferTag)| (r[*j][face.axis] - r[*i][face.axis]).abs() < nearest;
        let others = own[..k].iter().rev().take_while(near).chain(own[k + 1..].iter().take_while(near));
        let mut way = Vector::<D>::zeros();
        for (j, other) in others.filter(|_| tag.is_from_water()) {
            let away = r[*i] - r[*j];
            let distance = away.norm();
            if distance < nearest && distance > 0.0 {
                let part = if other.is_from_water() { 0.5 } else { 1.0 };
                way += away * (part * (nearest - distance) / distance);
            }
        }
        let place = r[*i] + way * (farthest / way.norm().max(farthest));
        let mut row = row_of(system, number, &place);
        let is_beside_row = rows.contains(&row) || {
            // The surface of the water that leaves may be above the level, but a wall may also be there.
            row[D - 2] -= 1;
            rows.contains(&row) && !is_in_wall(system, &place)
        };
        (way.norm() > 0.0 && is_beside_row && face.beyond(&place) > 0.0).then_some((*i, place))
    };
    own.iter().enumerate().filter_map(push).collect()
}

/// Whether `x` (m) is inside a fixed solid.
fn is_in_wall<const D: usize>(system: &System<D>, x: &Vector<D>) -> bool {
    let mut fixed = system.solids.iter().filter(|solid| matches!(solid.spec.role, Role::Fixed));
    fixed.any(|solid| solid.distance(x) < 0.0)
}

/// The positions (m) of the rows of face number `number` at the present level: the initial rows below it and, above each column
/// that ended at the surface at the start, one more row for each dp up to the level.
fn rows_at_level<const D: usize>(system: &System<D>, number: usize) -> Vec<Vector<D>> {
    let (buffer, dp) = (&system.fluid.buffer, system.model.dp);
    let face = &system.fluid_domain.open_boundaries[number];
    let Some(level) = face.level_at(buffer.time).filter(|_| face.has_moving_level()) else {
        return buffer.rows[number].clone();
    };
    let mut rows: Vec<_> = buffer.rows[number].iter().filter(|x| x[D - 1] <= level).copied().collect();
    for mut top in tops_at_surface(system, number).into_values() {
        top[D - 1] += dp;
        while top[D - 1] <= level {
            rows.push(top);
            top[D - 1] += dp;
        }
    }
    rows
}

/// The highest initial position (m) in each column of face number `number` that ended at the surface at the start, not under a
/// solid.
fn tops_at_surface<const D: usize>(system: &System<D>, number: usize) -> BTreeMap<Row, Vector<D>> {
    let mut tops = BTreeMap::<Row, Vector<D>>::new();
    for x in &system.fluid.buffer.rows[number] {
        let mut column = row_of(system, number, x);
        column.pop();
        let top = tops.entry(column).or_insert(*x);
        if x[D - 1] > top[D - 1] {
            *top = *x;
        }
    }
    let start = system.fluid_domain.open_boundaries[number].level_at(0.0).unwrap_or(f64::INFINITY);
    tops.retain(|_, top| top[D - 1] > start - (1.0 + ROUNDING) * system.model.dp);
    tops
}

/// Makes particles for all of the `rows` of face number `number`, with the velocities of the buffer particles `old` at their
/// heights. The first particle of a row is dp from the water `inside`, as a mean over the rows.
fn new_rows<const D: usize>(
    system: &System<D>,
    number: usize,
    rows: &[Vector<D>],
    (old, inside): (&[u32], &[u32]),
) -> Vec<Created<D>> {
    let face = &system.fluid_domain.open_boundaries[number];
    let (dp, particles) = (system.model.dp, &system.fluid.particles);
    let height = |i: u32| particles.r[i as usize][D - 1];
    let mut by_height = old.to_vec();
    by_height.sort_by(|a, b| height(*a).total_cmp(&height(*b)).then(a.cmp(b)));
    let first = dp - mean_distance(system, number, rows, inside);
    let columns = (buffer_length(&system.model) / dp).round() as u32;
    let mut created = Vec::new();
    for x in rows {
        let above = by_height.partition_point(|i| height(*i) < x[D - 1]);
        let nearest = by_height[above.saturating_sub(1)..by_height.len().min(above + 1)].iter();
        let Some(&source) = nearest.min_by(|a, b| {
            let [a, b] = [a, b].map(|i| (height(**i) - x[D - 1]).abs());
            a.total_cmp(&b)
        }) else {
            continue;
        };
        for k in 0..columns {
            let mut r = *x;
            r[face.axis] = face.at + face.outward() * (first + f64::from(k) * dp);
            created.push(Created { source, face: number, r, v: particles.v[source as usize] });
        }
    }
    created
}

/// The mean distance (m) from face number `number` to the nearest particle of the water `inside` in each of the `rows`. Rows
/// without a particle within dp do not count; without any such row it is half of dp.
fn mean_distance<const D: usize>(system: &System<D>, number: usize, rows: &[Vector<D>], inside: &[u32]) -> f64 {
    let face = &system.fluid_domain.open_boundaries[number];
    let dp = system.model.dp;
    let mut nearest = BTreeMap::<Row, f64>::new();
    for x in inside.iter().map(|&i| &system.fluid.particles.r[i as usize]) {
        let distance = -face.beyond(x);
        if distance <= dp {
            let own = nearest.entry(row_of(system, number, x)).or_insert(distance);
            *own = own.min(distance);
        }
    }
    let distances: Vec<f64> = rows.iter().filter_map(|x| nearest.get(&row_of(system, number, x)).copied()).collect();
    if distances.is_empty() { 0.5 * dp } else { distances.iter().sum::<f64>() / distances.len() as f64 }
}

/// A particle of a row: its source, place (m) and velocity (m/s).
type Member<const D: usize> = (u32, Vector<D>, Vector<D>);

/// The particles of the rows of face number `number`, those that were just created too.
fn members<const D: usize>(
    system: &System<D>,
    number: usize,
    (buffer, created): (&[(u32, BufferTag)], &[Created<D>]),
) -> Vec<Member<D>> {
    let particles = &system.fluid.particles;
    let placed = buffer.iter().filter(|(_, tag)| tag.face() == number && !tag.is_from_water());
    let placed = placed.map(|(i, _)| (*i, particles.r[*i as usize], particles.v[*i as usize]));
    let new = created.iter().filter(|new| new.face == number).map(|new| (new.source, new.r, new.v));
    placed.chain(new).collect()
}

/// Puts particles at the far ends of rows that have moved in by dp or more.
fn complete<const D: usize>(
    system: &System<D>,
    number: usize,
    (buffer, created): (&[(u32, BufferTag)], &mut Vec<Created<D>>),
) {
    let face = &system.fluid_domain.open_boundaries[number];
    let (dp, length) = (system.model.dp, buffer_length(&system.model));
    let mut farthest = BTreeMap::<Row, Member<D>>::new();
    for member in members(system, number, (buffer, created)) {
        let last = farthest.entry(row_of(system, number, &member.1)).or_insert(member);
        if face.beyond(&member.1) > face.beyond(&last.1) {
            *last = member;
        }
    }
    for (source, mut r, v) in farthest.into_values() {
        while face.beyond(&r) + dp <= length + ROUNDING * dp {
            r[face.axis] += face.outward() * dp;
            created.push(Created { source, face: number, r, v });
        }
    }
}

/// Puts a row on top of each column that ends at the surface if the level has risen past the middle of that row, and removes
/// particles too far above the level.
fn follow_level<const D: usize>(
    system: &System<D>,
    number: usize,
    (buffer, created): (&mut Vec<(u32, BufferTag)>, &mut Vec<Created<D>>),
) {
    let face = &system.fluid_domain.open_boundaries[number];
    let (dp, particles) = (system.model.dp, &system.fluid.particles);
    let Some(level) = face.level_at(system.fluid.buffer.time) else { return };
    let height = |i: u32| particles.r[i as usize][D - 1];
    let highest = |tag: BufferTag| match tag.is_from_water() {
        true if face.velocity.is_some() => f64::INFINITY,
        true => level + WATER_REMOVED * dp,
        false => level + REMOVED * dp,
    };
    buffer.retain(|(i, tag)| tag.face() != number || height(*i) <= highest(*tag));
    created.retain(|new| new.face != number || new.r[D - 1] <= level + REMOVED * dp);
    let at_surface = tops_at_surface(system, number);
    let mut tops = BTreeMap::<Row, (i64, Vec<Member<D>>)>::new();
    for member in members(system, number, (buffer, created)) {
        let mut column = row_of(system, number, &member.1);
        let Some(own) = column.pop().filter(|_| at_surface.contains_key(&column)) else { continue };
        let (top, row) = tops.entry(column).or_insert((own, Vec::new()));
        if own > *top {
            (*top, *row) = (own, Vec::new());
        }
        if own == *top {
            row.push(member);
        }
    }
    let left: Vec<Vector<D>> = (buffer.iter().filter(|(_, tag)| tag.face() == number && tag.is_from_water()))
        .map(|(i, _)| particles.r[*i as usize])
        .collect();
    for (source, mut r, v) in tops.into_values().flat_map(|(_, row)| row) {
        r[D - 1] += dp;
        while r[D - 1] <= level {
            if left.iter().all(|other| (other - r).norm() >= CLEARANCE * dp) {
                created.push(Created { source, face: number, r, v });
            }
            r[D - 1] += dp;
        }
    }
}
