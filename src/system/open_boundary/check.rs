//! Checks of open boundaries before a run.

use std::collections::BTreeMap;

use super::{MOST_FACES, OpenBoundary};
use crate::{
    error::{Error, ErrorCode, Result},
    geometry::{cells::PointCells, world_bounds},
    math::{
        Bounds, Vector, find_pole,
        format::{coordinates, three_digits, two_digits_down, two_digits_up},
    },
    solid::{Role, SolidSpec},
    system::Setup,
    wavemaker::IncidentWaves,
};

/// Greatest speed through a face over c₀: the density of water that stops there changes by two per cent.
const FASTEST: f64 = 0.2;

/// Speed through a face over the c₀ that a message proposes: the usual ratio in weakly compressible water @monaghan1994.
const SOUND: f64 = 0.1;

/// Greatest rate of a level over √(g depth), the speed of long waves. The water follows by a wave whose slope is this ratio.
const FASTEST_LEVEL: f64 = 0.1;

/// Least height of a level that changes above the bed, dp: the kernel spans that many rows.
const LEAST_ROWS: f64 = 4.0;

/// Distance from the water before a face within which its buffer goes on, dp: rows that are packed beside solids may be shifted.
const BESIDE_ROWS: f64 = 1.5;

/// Number of parts of a run at whose ends a level is looked at.
const LEVEL_SAMPLES: u32 = 2000;

/// Number of parts of a run at whose ends the speed through a face is compared with that of sound.
const SPEED_SAMPLES: u32 = 100;

/// Time at which poles along a face are sought, over the duration of the run: no period of a usual law.
const POLE_TIME: f64 = 0.618;

/// Refuses open boundary number `i` of a setup if it is invalid in a run until the time `until` (s).
///
/// # Errors
/// `Scene` if the face is not vertical, lies across a periodic side or a symmetry plane, has no water on one of its sides, is too near
/// to the end of a solid, at the end of the bed or where another face is, has a level that the water cannot follow, leaves the pressure
/// of a closed duct free, or lets water pass faster than the valid range of the water allows.
pub(crate) fn check<const D: usize>(setup: &Setup<D>, i: usize, until: f64) -> Result<()> {
    let (face, length) = (&setup.open_boundaries[i], setup.buffer_length());
    let (name, axis, at) = (&face.name, face.axis, face.at);
    if setup.open_boundaries.len() > MOST_FACES {
        let what = format!("{} open boundaries", setup.open_boundaries.len());
        return Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(format!("give {MOST_FACES} or fewer")));
    }
    if axis + 1 >= D || !at.is_finite() {
        let what = format!("open boundary {name:?} needs a finite coordinate along a horizontal axis");
        return Err(Error::scene(what));
    }
    let along = ["x", "y"][axis];
    if setup.periodic[axis].is_some() || setup.symmetry[axis].is_some() {
        let what = format!("open boundary {name:?} lies across {along}, which is periodic or has a symmetry plane");
        let help =
            format!("leave  periodic.{along}  and  symmetry.{along}  out; [current] drives a flow along a period");
        return Err(Error::scene(what).with_code(ErrorCode::ConflictingKeys).help(help));
    }
    check_other_faces(setup, i)?;
    let beyond: Vec<f64> = setup.water.iter().map(|r| face.beyond(r)).collect();
    let farthest = beyond.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !(farthest > 0.0 && beyond.iter().any(|beyond| *beyond < 0.0)) {
        let what = format!("open boundary {name:?} at {along} = {at} has no water on both of its sides");
        let help = match solid_at_face(setup, face) {
            Some(solid) => {
                let bounds = world_bounds(&solid.shape, &solid.initial_kinematics().pose);
                let [from, to] = [bounds.min[axis], bounds.max[axis]];
                format!("solid {:?} is there, from {along} = {from:.6} to {to:.6}: move the face out of it", solid.name)
            }
            None => "the water ends at the face, and neither it nor the buffer beyond it lies in a solid".into(),
        };
        return Err(Error::scene(what).help(help));
    }
    if farthest > length {
        let end = at + face.outward() * farthest;
        let what = format!("water reaches from open boundary {name:?} at {along} = {at} to {end:.6}");
        let help = format!("the buffer beyond a face is {length:.6} m long: move the face, or end the water there");
        return Err(Error::scene(what).help(help));
    }
    for solid in &setup.solids {
        let bounds = world_bounds(&solid.shape, &solid.initial_kinematics().pose);
        if !face.has_end_in_buffer(&solid.role, &bounds, length, setup.model.dp) {
            continue;
        }
        let end = at + face.outward() * length;
        let what = format!("solid {:?} ends in the buffer of open boundary {name:?}", solid.name);
        let help = match solid.role {
            Role::Free(_) => format!("keep it on the water's side of {along} = {at}"),
            _ => {
                format!("let it reach to {along} = {end:.6} or further, or end at {along} = {at} if it is not the bed")
            }
        };
        return Err(Error::scene(what).help(help));
    }
    if setup.initial_gravity()[D - 1] < 0.0 {
        check_water_beside(setup, face)?;
    }
    if let Some(solid) = bed_that_ends(setup, face) {
        let end = at + face.outward() * length;
        let what = format!(
            "solid {:?}, the bed, ends at open boundary {name:?}: water would fall out beside the buffer",
            solid.name
        );
        return Err(Error::scene(what).help(format!("let it reach to {along} = {end:.6} or further")));
    }
    let orbital = face.waves.as_ref().map_or(0.0, IncidentWaves::orbital_speed);
    let most = FASTEST * setup.model.c0;
    let in_buffer: Vec<_> = setup.water.iter().zip(&beyond).filter(|(_, beyond)| **beyond > 0.0).collect();
    let is_steady = face.steady_current().is_some();
    if !is_steady {
        check_poles(face, &in_buffer.iter().map(|(r, _)| **r).collect::<Vec<_>>(), until, setup.model.dp)?;
    }
    let samples = if is_steady { 0 } else { SPEED_SAMPLES };
    for t in (0..=samples).map(|k| until * f64::from(k) / f64::from(SPEED_SAMPLES)) {
        let speeds = in_buffer.iter().filter_map(|(r, _)| face.outward_velocity(r, t)).map(f64::abs);
        let fastest = speeds.fold(0.0, nan_max) + orbital;
        if fastest.is_nan() || fastest > most {
            let what = format!(
                "water passes open boundary {name:?} at {fastest:.4} m/s at t = {t:.4} s; the speed of sound allows {most:.4}"
            );
            let mut help = format!("write  model.c0 = {:.3}  or more", fastest / SOUND);
            if most > orbital {
                help += &format!(", or a velocity of {} m/s at most", two_digits_down(most - orbital));
            }
            return Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(help));
        }
    }
    if let Some(waves) = &face.waves
        && (face.steady_current() != Some(waves.current()) || face.level.is_none())
    {
        let what = format!("the waves of open boundary {name:?} are on a current of {} m/s", waves.current());
        let help = "give the face that velocity into the water, the same everywhere at all times, and a level";
        return Err(Error::scene(what).with_code(ErrorCode::ConflictingKeys).help(help));
    }
    check_level(setup, face, until)?;
    check_pressure(setup, face)?;
    match face.absorbed_speed {
        Some(speed) if !(speed > 0.0 && speed.is_finite()) => {
            Err(Error::scene(format!("open boundary {name:?} absorbs waves of a positive speed, not {speed}")))
        }
        _ => Ok(()),
    }
}

/// Refuses a velocity of `face` that grows without bound at the places `water` (m) until the time `until` (s). No speed of sound helps
/// then. It is looked at over time in the middle of the water, and along each axis at one time.
fn check_poles<const D: usize>(face: &OpenBoundary<D>, water: &[Vector<D>], until: f64, dp: f64) -> Result<()> {
    let Some(middle) = water.get(water.len() / 2) else { return Ok(()) };
    let speed = |r: &Vector<D>, t: f64| face.outward_velocity(r, t).unwrap_or_default();
    let in_time = find_pole(|t| speed(middle, t), [0.0, until]).map(|t| format!("t = {} s", three_digits(t)));
    let bounds = Bounds::around(water).grown(0.5 * dp);
    let along = |axis: &usize| {
        let moved = |x: f64| {
            let mut r = *middle;
            r[*axis] = x;
            speed(&r, POLE_TIME * until)
        };
        let at = find_pole(moved, [bounds.min[*axis], bounds.max[*axis]])?;
        Some(format!("{} = {} m", ["x", "y", "z"][*axis], three_digits(at)))
    };
    let Some(place) = in_time.or_else(|| (0..D).filter(|axis| *axis != face.axis).find_map(|axis| along(&axis))) else {
        return Ok(());
    };
    let what = format!("the velocity of open boundary {:?} grows without bound at {place}", face.name);
    let help = "write a formula that is finite on the whole face at all times, as with max(0.1, ..) below a division";
    Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(help))
}

/// The solid under the lowest water beside `face` that does not go on under the buffer.
fn bed_that_ends<'a, const D: usize>(setup: &'a Setup<D>, face: &OpenBoundary<D>) -> Option<&'a SolidSpec<D>> {
    if setup.initial_gravity()[D - 1] >= 0.0 {
        return None;
    }
    let dp = setup.model.dp;
    let mut lowest = BTreeMap::<Vec<i64>, Vector<D>>::new();
    for r in setup.water.iter().filter(|r| (0.0..dp).contains(&face.beyond(r))) {
        let column = r.iter().take(D - 1).map(|x| (x / dp).floor() as i64).collect();
        let own = lowest.entry(column).or_insert(*r);
        if r[D - 1] < own[D - 1] {
            *own = *r;
        }
    }
    let solid_at = |x: &Vector<D>| setup.solids.iter().find(|solid| is_inside(solid, x));
    lowest.into_values().find_map(|r| {
        let [inside, outside] = [-0.5, 0.5].map(|beyond| {
            let mut x = r;
            (x[face.axis], x[D - 1]) = (face.at + face.outward() * beyond * dp, r[D - 1] - dp);
            x
        });
        solid_at(&inside).filter(|_| solid_at(&outside).is_none())
    })
}

/// Refuses a face whose buffer has water at a height or place where neither water nor a solid is before the face, as beside channels
/// with different levels. The buffer is filled up to one level, between solids.
fn check_water_beside<const D: usize>(setup: &Setup<D>, face: &OpenBoundary<D>) -> Result<()> {
    let dp = setup.model.dp;
    let within = |rows: f64| setup.water.iter().filter(move |r| (0.0..dp).contains(&(rows * face.beyond(r))));
    let before: Vec<Vector<D>> = within(-1.0).copied().collect();
    let cells = PointCells::new(&before, dp);
    let opposite = |r: &Vector<D>| {
        let mut x = *r;
        x[face.axis] = face.at - face.outward() * 0.5 * dp;
        x
    };
    let has_none = |r: &&Vector<D>| {
        let (x, mut lone) = (opposite(r), true);
        cells.visit_near(&x, BESIDE_ROWS * dp, |_, y| lone &= (y - x).norm() >= BESIDE_ROWS * dp);
        lone && setup.solids.iter().all(|s| s.shape.signed_distance(&s.initial_kinematics().pose.local(&x)) > dp)
    };
    let Some(lone) = within(1.0).find(has_none) else { return Ok(()) };
    let what = format!(
        "the buffer of open boundary {:?} has water at {} m, and there is none before the face",
        face.name,
        coordinates(lone.iter())
    );
    let help = "give all water beside the face one level and the whole section between the solids, or close the rest by a solid";
    Err(Error::scene(what).help(help))
}

/// Refuses open boundary number `i` if one before it is in its place.
fn check_other_faces<const D: usize>(setup: &Setup<D>, i: usize) -> Result<()> {
    let face = &setup.open_boundaries[i];
    let is_here = |other: &&OpenBoundary<D>| {
        let is_beside = (face.at - other.at).abs() < setup.buffer_length();
        face.axis == other.axis && face.is_lower == other.is_lower && is_beside
    };
    let Some(other) = setup.open_boundaries[..i].iter().find(is_here) else { return Ok(()) };
    let what = format!(
        "open boundaries {:?} and {:?} are at one place, {} = {}",
        other.name,
        face.name,
        ["x", "y"][face.axis],
        face.at
    );
    let help = "leave one out, or move it to another end of the water; solids close a part of a face";
    Err(Error::scene(what).with_code(ErrorCode::ConflictingKeys).help(help))
}

/// Refuses a level of `face` that changes in time and, until the time `until` (s), is near to the bed, reaches the top of the domain or
/// a solid, or changes faster than the water can follow. Such a level is also refused without gravity, and together with waves
/// that enter.
fn check_level<const D: usize>(setup: &Setup<D>, face: &OpenBoundary<D>, until: f64) -> Result<()> {
    let (name, dp, g) = (&face.name, setup.model.dp, -setup.initial_gravity()[D - 1]);
    let Some(law) = face.level.as_ref().filter(|_| face.has_moving_level()) else { return Ok(()) };
    let refuse = |code: ErrorCode, what: String, help: String| Err(Error::scene(what).with_code(code).help(help));
    if g.is_nan() || g <= 0.0 || face.waves.is_some() {
        let what =
            format!("the level of open boundary {name:?} changes in time, without gravity or with waves that enter");
        return refuse(ErrorCode::ConflictingKeys, what, "give it one level for the whole run".into());
    }
    let in_buffer = || setup.water.iter().filter(|r| face.beyond(r) > 0.0);
    let heights = || in_buffer().map(|r| r[D - 1]);
    let bed = heights().fold(f64::INFINITY, f64::min) - 0.5 * dp;
    let still = heights().fold(f64::NEG_INFINITY, f64::max) + 0.5 * dp;
    // Without a domain of its own a scene has room above the water as high as the water is long.
    let all = Bounds::around(&setup.water);
    let ceiling = setup.domain.map_or(all.max[D - 1] + all.size().max(), |domain| domain.max[D - 1]) - dp;
    let least = bed + LEAST_ROWS * dp;
    let at = |level: f64, t: f64| {
        format!("the level of open boundary {name:?} is {} m at t = {} s", three_digits(level), three_digits(t))
    };
    let mut highest = f64::NEG_INFINITY;
    for t in (0..=LEVEL_SAMPLES).map(|k| until * f64::from(k) / f64::from(LEVEL_SAMPLES)) {
        let (level, rate) = law.value_and_rate(t);
        if level.is_nan() || level < least {
            let what = format!("{}, and the bed {} m", at(level, t), three_digits(bed));
            let help = format!("keep it at {} m or more, {LEAST_ROWS} dp above the bed", three_digits(least));
            return refuse(ErrorCode::OutOfRange, what, help);
        }
        if level > ceiling {
            let what = format!("{}, and the domain ends at {} m", at(level, t), three_digits(ceiling + dp));
            let help = format!("keep it at {} m or less, or let [domain] reach higher", three_digits(ceiling));
            return refuse(ErrorCode::OutOfRange, what, help);
        }
        let fastest = FASTEST_LEVEL * (g * (level - bed)).sqrt();
        if rate.is_nan() || rate.abs() > fastest {
            let what = format!(
                "the level of open boundary {name:?} changes by {} m/s at t = {} s; water of that depth follows {} m/s",
                three_digits(rate.abs()),
                three_digits(t),
                two_digits_down(fastest)
            );
            let help = format!("let the change take {} times as long", two_digits_up(rate.abs() / fastest));
            return refuse(ErrorCode::OutOfRange, what, help);
        }
        highest = highest.max(level);
    }
    let rises = |r: &&Vector<D>| r[D - 1] > still - dp && highest > still;
    for r in in_buffer().filter(rises) {
        let mut x = *r;
        while x[D - 1] <= highest {
            if let Some(solid) = setup.solids.iter().find(|solid| is_inside(solid, &x)) {
                let what = format!(
                    "the level of open boundary {name:?} rises to {} m, into solid {:?}",
                    three_digits(highest),
                    solid.name
                );
                let help = format!("keep it below {} m, or move the solid up", three_digits(x[D - 1] - 0.5 * dp));
                return refuse(ErrorCode::OutOfRange, what, help);
            }
            x[D - 1] += dp;
        }
    }
    Ok(())
}

/// Refuses a `face` without velocity and level at a closed duct in which no other face holds the pressure.
fn check_pressure<const D: usize>(setup: &Setup<D>, face: &OpenBoundary<D>) -> Result<()> {
    let holds = |face: &OpenBoundary<D>| face.velocity.is_none() && face.level.is_some();
    if face.velocity.is_some() || setup.open_boundaries.iter().any(holds) {
        return Ok(());
    }
    let Some(top) = top_of_closed_duct(setup) else { return Ok(()) };
    let what = format!("nothing holds the pressure of the closed duct that ends at open boundary {:?}", face.name);
    let help = format!("write  level = {}  there: without a velocity it holds the pressure", three_digits(top));
    Err(Error::scene(what).help(help))
}

/// The top (m) of the water if solids lie on all of its columns.
fn top_of_closed_duct<const D: usize>(setup: &Setup<D>) -> Option<f64> {
    let dp = setup.model.dp;
    let mut tops = BTreeMap::<Vec<i64>, Vector<D>>::new();
    for r in &setup.water {
        let column = r.iter().take(D - 1).map(|x| (x / dp).floor() as i64).collect();
        let top = tops.entry(column).or_insert(*r);
        if r[D - 1] > top[D - 1] {
            *top = *r;
        }
    }
    let is_closed = |r: &Vector<D>| {
        let mut above = *r;
        above[D - 1] += 1.5 * dp;
        setup.solids.iter().any(|solid| is_inside(solid, &above))
    };
    let highest = tops.values().map(|r| r[D - 1]).fold(f64::NEG_INFINITY, f64::max);
    tops.values().all(is_closed).then_some(highest + 0.5 * dp)
}

/// Whether `x` (m) lies in the solid at the start.
fn is_inside<const D: usize>(solid: &SolidSpec<D>, x: &Vector<D>) -> bool {
    solid.shape.signed_distance(&solid.initial_kinematics().pose.local(x)) < 0.0
}

/// The solid that takes the place of the water at `face`, half a dp to either side of it.
fn solid_at_face<'a, const D: usize>(setup: &'a Setup<D>, face: &OpenBoundary<D>) -> Option<&'a SolidSpec<D>> {
    let nearest = setup.water.iter().min_by(|a, b| face.beyond(a).abs().total_cmp(&face.beyond(b).abs()))?;
    let beside = [-0.5, 0.5].map(|rows| {
        let mut x = *nearest;
        x[face.axis] = face.at + rows * setup.model.dp;
        x
    });
    beside.iter().find_map(|x| setup.solids.iter().find(|solid| is_inside(solid, x)))
}

/// The greater of two numbers, or NaN if one is.
fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
