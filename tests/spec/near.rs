//! Neighbours: every pair within the support is listed, and stays listed while the lists hold.

use pontoon::{
    near::{CHUNK, Near},
    space::Vector,
};

use crate::rig::Dice;

const REACH: f64 = 0.1;

/// Pairs (water, water) and (water, skin) nearer than the support, by looking at all.
fn all_pairs<const D: usize>(water: &[Vector<D>], skin: &[Vector<D>]) -> (Vec<Vec<u32>>, Vec<Vec<u32>>) {
    let near = |x: &Vector<D>, of: &[Vector<D>]| -> Vec<u32> {
        (0..of.len()).filter(|&j| (of[j] - x).norm() < REACH).map(|j| j as u32).collect()
    };
    let mut among: Vec<_> = water.iter().map(|x| near(x, water)).collect();
    among.iter_mut().enumerate().for_each(|(i, list)| list.retain(|&j| j != i as u32));
    (among, water.iter().map(|x| near(x, skin)).collect())
}

fn lists_hold_every_pair<const D: usize>(seed: u64, n: usize) {
    let mut dice = Dice(seed);
    let mut water: Vec<Vector<D>> = (0..n).map(|_| dice.point()).collect();
    let mut skin: Vec<Vector<D>> = (0..n / 2).map(|_| dice.point()).collect();
    let mut near = Near::new(REACH);
    assert!(near.due(&water, &skin), "without lists they are due");
    near.build(&water, &skin);
    // Not yet a margin apart: half of it (a tenth of the support) minus rounding, each in its own direction.
    for x in water.iter_mut().chain(&mut skin) {
        let d = dice.point::<D>() - Vector::repeat(0.5);
        *x += d.normalize() * (0.0499 * REACH);
    }
    assert!(!near.due(&water, &skin));
    let (among, beside) = all_pairs(&water, &skin);
    let sorted = |list: &[u32], within: &dyn Fn(u32) -> bool| {
        let mut list: Vec<u32> = list.iter().copied().filter(|&j| within(j)).collect();
        list.sort_unstable();
        list
    };
    let mut seen = vec![0; skin.len()];
    for i in 0..n {
        let (w, s) = near.lists().water[i / CHUNK].of(i % CHUNK);
        assert_eq!(sorted(w, &|j| (water[j as usize] - water[i]).norm() < REACH), among[i]);
        assert_eq!(sorted(s, &|j| (skin[j as usize] - water[i]).norm() < REACH), beside[i]);
        beside[i].iter().for_each(|&j| seen[j as usize] += 1);
    }
    for (k, x) in skin.iter().enumerate() {
        let (w, _) = near.lists().skin[k / CHUNK].of(k % CHUNK);
        let count = w.iter().filter(|&&j| (water[j as usize] - x).norm() < REACH).count();
        assert_eq!(count, seen[k], "a boundary particle sees the water that sees it");
    }
    water[0][0] += 0.1 * REACH;
    assert!(near.due(&water, &skin), "moved by a margin");
}

#[test]
fn no_pair_is_missing_in_two_and_three_dimensions() {
    lists_hold_every_pair::<2>(1, 700);
    lists_hold_every_pair::<3>(2, 1500);
}

#[test]
fn strays_empty_cells_and_a_heap_in_one_cell_lose_no_pair() {
    let mut near = Near::<2>::new(REACH);
    near.build(&[], &[]);
    near.build(&[Vector::from([1e6, -1e6])], &[]);
    assert!(near.lists().water[0].of(0).0.is_empty(), "a particle is not its own neighbour");
    let heap = vec![Vector::from([0.5, 0.5]); 40];
    let mut spread = heap.clone();
    spread.push(Vector::from([1e5, 1e5]));
    near.build(&spread, &heap);
    for i in 0..40 {
        let (w, s) = near.lists().water[0].of(i);
        assert_eq!((w.len(), s.len()), (39, 40));
    }
    spread[7][0] = f64::NAN;
    assert!(near.due(&spread, &heap), "a lost particle is noticed");
}
