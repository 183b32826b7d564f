//! Unit tests of `src/geometry/packing.rs`.

use super::*;

#[test]
fn spreading_restores_the_spacing_of_a_disturbed_lattice() {
    let mut points: Vec<Vector<2>> = Vec::new();
    let cell = |i: i32, j: i32| Vector::from([i as f64, j as f64]);
    for (i, j) in (0..49).map(|k| (k % 7 - 3, k / 7 - 3)) {
        points.push(cell(i, j) + Vector::from([(3.0 * i as f64).sin(), (5.0 * j as f64).cos()]) * 0.2);
    }
    let movable = points.len();
    let outer = (0..225_i32).map(|k| (k % 15 - 7, k / 15 - 7)).filter(|(i, j)| i.abs() > 3 || j.abs() > 3);
    points.extend(outer.map(|(i, j)| cell(i, j)));
    spread_points(&mut points, movable, 1.0, |_, _, _| f64::INFINITY);
    for (k, x) in points.iter().enumerate() {
        let nearest = points.iter().enumerate().filter(|(j, _)| *j != k).map(|(_, y)| (x - y).norm());
        let gap = nearest.fold(f64::INFINITY, f64::min);
        assert!((0.85..=1.01).contains(&gap), "{k}: {gap}");
    }
}

#[test]
fn spreading_damps_an_alternating_shift_of_a_cubic_lattice() {
    let place = |k: i32| Vector::from([(k % 15) as f64, (k / 15 % 15) as f64, (k / 225) as f64]);
    let is_inner = |x: &Vector<3>| x.iter().all(|c| (3.0..12.0).contains(c));
    let (inner, outer): (Vec<_>, Vec<_>) = (0..3375).map(place).partition(is_inner);
    // Rows are shifted alternately to the left and to the right, the least stable mode.
    let shifted = inner.iter().map(|x| x + Vector::from([0.03 * (x[0] * std::f64::consts::PI).cos(), 0.0, 0.0]));
    let mut points: Vec<_> = shifted.chain(outer).collect();
    spread_points(&mut points, inner.len(), 1.0, |_, _, _| f64::INFINITY);
    let off = points.iter().zip(&inner).map(|(x, at)| (x - at).norm()).fold(0.0, f64::max);
    assert!(off < 0.01, "{off} dp off the lattice");
}

/// Each rank moves its own chunks of the points, some of them none, and has all of them after each pass. Whoever moves a point, its
/// place has the same bits.
#[test]
fn ranks_share_the_spreading_and_have_the_same_points() {
    let place =
        |k: i32| Vector::from([(k % 12) as f64 + 0.2 * f64::from(k).sin(), (k / 12 % 12) as f64, (k / 144) as f64]);
    let start: Vec<Vector<3>> = (0..12 * 144).map(place).collect();
    // Three chunks and a part of one.
    let movable = 3 * CHUNK + 40;
    let confine = |_: usize, from: &Vector<3>, x: &mut Vector<3>| {
        if x[0] < 0.1 {
            *x = *from;
        }
        0.3
    };
    let mut alone = start.clone();
    spread_points(&mut alone, movable, 1.0, confine);
    assert!(alone[..movable] != start[..movable] && alone[movable..] == start[movable..]);
    for count in [2, 5] {
        let shared: Vec<_> = std::thread::scope(|scope| {
            let start = &start;
            let work = move |ranks: Ranks| {
                let mut points = start.clone();
                spread_points_on(&ranks, &mut points, movable, 1.0, confine);
                points
            };
            let threads: Vec<_> =
                Ranks::in_threads(count).into_iter().map(|ranks| scope.spawn(move || work(ranks))).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(shared.into_iter().all(|points| points == alone), "{count} ranks");
    }
}
