//! Orientation check of the shells of a mesh: each shell must face out of the solid. The wall of a hollow faces the
//! hollow.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::welding::format_position;
use crate::{
    error::{Error, Result},
    math::{Bounds, Vector},
};

/// Fraction of the whole volume below which the code ignores a shell's orientation as round-off.
const NOTHING: f64 = 1e-9;

/// Distance from a facet of another shell below which a point lies on that facet, over the facet's size: more than the
/// round-off of a file in single precision.
const ON: f64 = 1e-4;

/// Round-off of the winding number, –: on the edge of another shell the winding number is not an integer.
const ROUND_OFF: f64 = 1e-6;

/// Facets that share edges.
struct Shell {
    facets: Vec<[u32; 3]>,
    numbers: Vec<usize>,
    bounds: Bounds<3>,
    volume: f64,
}

/// Refuses a shell whose inside counts twice, and a shell that subtracts volume outside the solid. The function assumes
/// a closed surface without self-intersection.
pub(crate) fn check_orientation(points: &[Vector<3>], facets: &[[u32; 3]]) -> Result<()> {
    let shells = shells(points, facets);
    let whole: f64 = shells.iter().map(|shell| shell.volume).sum();
    let judged = |i: usize| {
        let expected = f64::from(u8::from(shells[i].volume < 0.0));
        let (x, turns) = around(i, expected, &shells, points)?;
        (shells[i].volume.abs() > NOTHING * whole && turns != expected).then_some((i, x, turns))
    };
    let wrong = if shells.len() > 1 { (0..shells.len()).into_par_iter().find_map_first(judged) } else { None };
    wrong.map_or(Ok(()), |(i, x, turns)| Err(refusal(shells[i].volume, &x, turns)))
}

/// Reverses each outermost shell that is inside out, with the shells in it. Returns whether each facet was reversed.
/// `turned` marks facets that were reversed before.
///
/// # Errors
/// `Scene` if a shell inside another has facets of both orientations: it bounds a hollow or a solid.
pub(super) fn turn_outward(points: &[Vector<3>], facets: &mut [[u32; 3]], turned: &[bool]) -> Result<Vec<bool>> {
    let mut reversed = vec![false; facets.len()];
    let shells = shells(points, facets);
    let mixed = |shell: &Shell| shell.numbers.iter().any(|&i| turned[i]);
    if shells.iter().all(|shell| shell.volume >= 0.0 && (shells.len() == 1 || !mixed(shell))) {
        return Ok(reversed);
    }
    let corners = |facet: &[u32; 3]| facet.map(|p| points[p as usize]);
    let turns = |shell: &Shell, x: &Vector<3>| -> f64 {
        shell.facets.iter().map(|facet| solid_angle(&corners(facet), x)).sum::<f64>() / (2.0 * TAU)
    };
    let is_inside = |inner: &Shell, outer: &Shell| {
        if inner.volume.abs() > outer.volume.abs()
            || !outer.bounds.contains(&inner.bounds.min)
            || !outer.bounds.contains(&inner.bounds.max)
        {
            return false;
        }
        let middles = inner.facets.iter().map(|facet| corners(facet).iter().sum::<Vector<3>>() / 3.0);
        let mut found = middles.map(|x| turns(outer, &x)).filter(|turns| (turns - turns.round()).abs() < ROUND_OFF);
        found.next().is_some_and(|turns| turns.round() != 0.0)
    };
    let around: Vec<Vec<usize>> = (0..shells.len())
        .into_par_iter()
        .map(|i| (0..shells.len()).filter(|&j| j != i && is_inside(&shells[i], &shells[j])).collect())
        .collect();
    for (i, shell) in shells.iter().enumerate() {
        let outermost =
            if around[i].is_empty() { Some(i) } else { around[i].iter().copied().find(|&j| around[j].is_empty()) };
        if !around[i].is_empty() && mixed(shell) {
            let at = format_position(&points[shell.facets[0][0] as usize]);
            let what = format!("facets of a shell inside another, at {at} m, have both orientations");
            return Err(Error::scene(what).help(
                "let the normals of a hollow point into it, and those of a solid outward, in the program that made it",
            ));
        }
        if outermost.is_some_and(|j| shells[j].volume < 0.0) {
            shell.numbers.iter().for_each(|&i| reversed[i] = true);
        }
    }
    for (facet, _) in facets.iter_mut().zip(&reversed).filter(|(_, reversed)| **reversed) {
        facet.swap(0, 1);
    }
    Ok(reversed)
}

fn refusal(volume: f64, x: &Vector<3>, turns: f64) -> Error {
    let (at, size) = (format_position(x), volume.abs());
    if volume < 0.0 && turns == 0.0 {
        let what = format!(
            "a shell of the mesh about {at} m is inside out: its {size:.3e} m³ are taken off, and nothing is there"
        );
        return Error::scene(what)
            .help("turn its normals outward in the program that made it: only the wall of a hollow faces inward");
    }
    let what = format!(
        "a shell of the mesh about {at} m lies inside another and faces as that does: its {size:.3e} m³ count twice"
    );
    Error::scene(what).help(
        "the inner shell of a hollow solid has to face inward: turn its normals in the program that made it; if the solid \
         is full, leave the inner shell out",
    )
}

/// Returns a point on shell `i` and the winding number of the other shells at this point: the solid angle of their
/// facets over 4π. The `expected` number counts if one of the outermost facets has it: where shells cross within the tolerance,
/// facets of one lie inside the other.
fn around(i: usize, expected: f64, shells: &[Shell], points: &[Vector<3>]) -> Option<(Vector<3>, f64)> {
    let corners = |facet: &[u32; 3]| facet.map(|p| points[p as usize]);
    let middle = |facet: &[u32; 3]| corners(facet).iter().sum::<Vector<3>>() / 3.0;
    let turns = |x: Vector<3>| {
        let others = shells.iter().enumerate().filter(|(j, other)| *j != i && other.bounds.contains(&x));
        let angles = others.flat_map(|(_, other)| &other.facets).map(|facet| solid_angle(&corners(facet), &x));
        let turns: f64 = angles.sum::<f64>() / (2.0 * TAU);
        ((turns - turns.round()).abs() < ROUND_OFF).then_some((x, turns.round()))
    };
    let middles = || shells[i].facets.iter().map(middle);
    let extreme = |(axis, sign): (usize, f64)| middles().max_by(|a, b| (sign * a[axis]).total_cmp(&(sign * b[axis])));
    let directions = (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]);
    let mut first = None;
    for found in directions.filter_map(extreme).filter_map(turns) {
        if found.1 == expected {
            return Some(found);
        }
        first.get_or_insert(found);
    }
    first.or_else(|| middles().find_map(turns))
}

/// Returns the solid angle of a facet seen from `x`, sr, positive from its inner side, after van Oosterom and Strackee
/// (1983). The result is NaN if `x` lies on the facet.
pub(super) fn solid_angle(facet: &[Vector<3>; 3], x: &Vector<3>) -> f64 {
    let [a, b, c] = facet.map(|p| p - x);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let (sine, all) = (a.dot(&b.cross(&c)), la * lb * lc);
    let cosine = all + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    if cosine < 0.0 && sine.abs() < ON * all { f64::NAN } else { 2.0 * sine.atan2(cosine) }
}

/// Returns the number of each facet's shell, and the volume (m³) inside that shell: negative for the wall of a hollow.
#[cfg(feature = "dim3")]
pub(super) fn shell_volumes(points: &[Vector<3>], facets: &[[u32; 3]]) -> Vec<(usize, f64)> {
    let mut of_facet = vec![(0, 0.0); facets.len()];
    for (number, shell) in shells(points, facets).into_iter().enumerate() {
        shell.numbers.iter().for_each(|&i| of_facet[i] = (number, shell.volume));
    }
    of_facet
}

/// Returns the shells of a closed surface.
fn shells(points: &[Vector<3>], facets: &[[u32; 3]]) -> Vec<Shell> {
    let sides = |(i, &[a, b, c]): (usize, &[u32; 3])| {
        [(a, b), (b, c), (c, a)].map(|(p, q): (u32, u32)| (p.min(q), p.max(q), i))
    };
    let mut edges: Vec<(u32, u32, usize)> = facets.iter().enumerate().flat_map(sides).collect();
    edges.sort_unstable();
    // Each facet refers to an earlier facet of its shell; the first facet refers to itself.
    let mut above: Vec<usize> = (0..facets.len()).collect();
    for pair in edges.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1)).filter(|pair| pair.len() == 2) {
        let (a, b) = (first(&mut above, pair[0].2), first(&mut above, pair[1].2));
        above[a.max(b)] = a.min(b);
    }
    let mut all: Vec<Vec<usize>> = vec![Vec::new(); facets.len()];
    (0..facets.len()).for_each(|i| all[first(&mut above, i)].push(i));
    let shell = |numbers: Vec<usize>| {
        let facets: Vec<[u32; 3]> = numbers.iter().map(|&i| facets[i]).collect();
        let around = Bounds::around(facets.iter().flatten().map(|&p| &points[p as usize]));
        let wedge = |facet: &[u32; 3]| {
            let [a, b, c] = facet.map(|p| points[p as usize] - around.min);
            a.dot(&b.cross(&c)) / 6.0
        };
        Shell {
            volume: facets.iter().map(wedge).sum(),
            bounds: around.grown(ON * around.size().max()),
            facets,
            numbers,
        }
    };
    all.into_iter().filter(|numbers| !numbers.is_empty()).map(shell).collect()
}

/// Returns the first facet of the shell of facet `i`, and shortens the path to it (union-find with path halving).
fn first(above: &mut [usize], mut i: usize) -> usize {
    while above[i] != i {
        above[i] = above[above[i]];
        i = above[i];
    }
    i
}
