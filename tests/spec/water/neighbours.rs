//! Neighbours: every pair within the support is met, once, and stays in the lists while they hold.

use std::collections::BTreeMap;

use pontoon::{
    math::Vector,
    model::PairLoopKind,
    neighbours::{CHUNK, Clusters, NeighbourLists, PAD, PairLists},
};

use crate::common::Dice;

const REACH: f64 = 0.1;
const ALL: [PairLoopKind; 2] = [PairLoopKind::Fast, PairLoopKind::Reference];

fn near<const D: usize>(sweep: PairLoopKind) -> NeighbourLists<D> {
    NeighbourLists::new(REACH, REACH / 3.5, sweep.instruction_set())
}

/// How often each pair is met: of two waters (the smaller index first), or of a water and a boundary particle.
#[derive(Default, PartialEq, Debug)]
struct Met {
    among: BTreeMap<(u32, u32), usize>,
    beside: BTreeMap<(u32, u32), usize>,
}

/// The pairs nearer than the support, by looking at all.
fn all_pairs<const D: usize>(water: &[Vector<D>], skin: &[Vector<D>]) -> Met {
    let mut met = Met::default();
    for (i, x) in water.iter().enumerate() {
        for (j, y) in water.iter().enumerate().skip(i + 1).filter(|(_, y)| (x - *y).norm() < REACH) {
            let _ = y;
            met.among.insert((i as u32, j as u32), 1);
        }
        for (j, _) in skin.iter().enumerate().filter(|(_, y)| (x - *y).norm() < REACH) {
            met.beside.insert((i as u32, j as u32), 1);
        }
    }
    met
}

/// The pairs nearer than the support that the lists know.
fn listed<const D: usize>(near: &NeighbourLists<D>, water: &[Vector<D>], skin: &[Vector<D>]) -> Met {
    let mut met = match near.pair_lists() {
        PairLists::Clusters(clusters, _) => from_clusters(clusters),
        PairLists::Lists(lists) => {
            let mut met = Met::default();
            for i in 0..water.len() {
                let (among, beside) = lists.fluid[i / CHUNK].neighbours_of(i % CHUNK);
                // Here each of two waters lists the other.
                for &j in among.iter().filter(|&&j| j > i as u32) {
                    *met.among.entry((i as u32, j)).or_default() += 1;
                }
                for &j in beside {
                    *met.beside.entry((i as u32, j)).or_default() += 1;
                }
            }
            met
        }
    };
    met.among.retain(|&(i, j), _| (water[i as usize] - water[j as usize]).norm() < REACH);
    met.beside.retain(|&(i, j), _| (water[i as usize] - skin[j as usize]).norm() < REACH);
    met
}

fn from_clusters(clusters: &Clusters) -> Met {
    let mut met = Met::default();
    for slab in &clusters.slabs {
        for slot in slab.first * 8..slab.end * 8 {
            let (cluster, i) = (slot / 8, clusters.source[slot]);
            let [start, _, end] = slab.spans[slot - slab.first * 8].map(|k| k as usize);
            assert!(i != PAD || start == end, "a pad meets nobody");
            for &c in &slab.index[start..end] {
                let is_water = |c: usize| clusters.slabs.iter().any(|s| (s.first..s.middle).contains(&c));
                for &j in clusters.source[c as usize * 8..c as usize * 8 + 8].iter().filter(|&&j| j != PAD) {
                    match (is_water(cluster), is_water(c as usize)) {
                        // Within a cluster each comes to the other.
                        (true, true) if c as usize == cluster && j <= i => {}
                        (true, true) => *met.among.entry((i.min(j), i.max(j))).or_default() += 1,
                        (true, false) => *met.beside.entry((i, j)).or_default() += 1,
                        (false, true) => *met.beside.entry((j, i)).or_default() += 1,
                        (false, false) => panic!("boundary particles do not meet"),
                    }
                }
            }
        }
    }
    met
}

fn lists_hold_every_pair<const D: usize>(seed: u64, n: usize, origin: f64) {
    for sweep in ALL {
        let mut dice = Dice(seed);
        let at = |x: Vector<D>| x + Vector::repeat(origin);
        let mut water: Vec<Vector<D>> = (0..n).map(|_| at(dice.point())).collect();
        // Boundary particles lie around the water as well.
        let around = |x: Vector<D>| at(x * 1.3 - Vector::repeat(0.15));
        let mut skin: Vec<Vector<D>> = (0..n).map(|_| around(dice.point())).collect();
        let mut near = near(sweep);
        near.build(&water, &skin);
        for &i in near.boundary_near_fluid() {
            let nearest = water.iter().map(|x| (x - skin[i as usize]).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < REACH + near.margin() * 1.001, "a wet boundary particle has water near it");
        }
        // Not yet a margin apart: half of it minus rounding, each in its own direction.
        for x in water.iter_mut().chain(&mut skin) {
            let d = dice.point::<D>() - Vector::repeat(0.5);
            *x += d.normalize() * (0.499 * near.margin());
        }
        let expected = all_pairs(&water, &skin);
        assert!(expected.among.len() > n && expected.beside.len() > n / 2, "the case has pairs");
        assert_eq!(listed(&near, &water, &skin), expected, "{sweep:?} in {D}-D");
        for &(_, j) in expected.beside.keys() {
            assert!(near.boundary_near_fluid().binary_search(&j).is_ok(), "a boundary particle with water is wet");
        }
    }
}

#[test]
fn no_pair_is_missing_in_two_and_three_dimensions() {
    lists_hold_every_pair::<2>(1, 700, 0.0);
    lists_hold_every_pair::<3>(2, 1500, 0.0);
}

#[test]
fn nor_a_kilometre_from_the_origin() {
    lists_hold_every_pair::<2>(3, 500, 1000.0);
    lists_hold_every_pair::<3>(4, 800, -1000.0);
}

#[test]
fn strays_empty_cells_and_a_heap_in_one_cell_lose_no_pair() {
    for sweep in ALL {
        let mut near = near::<2>(sweep);
        near.build(&[], &[]);
        assert!(near.boundary_near_fluid().is_empty());
        let alone = [Vector::from([1e6, -1e6])];
        near.build(&alone, &[]);
        assert_eq!(listed(&near, &alone, &[]), Met::default(), "a particle is not its own neighbour");
        let heap = vec![Vector::from([0.5, 0.5]); 40];
        let mut spread = heap.clone();
        spread.push(Vector::from([1e5, 1e5]));
        near.build(&spread, &heap);
        let met = listed(&near, &spread, &heap);
        assert_eq!((met.among.len(), met.beside.len()), (40 * 39 / 2, 40 * 40), "{sweep:?}");
        assert!(met.among.values().chain(met.beside.values()).all(|&n| n == 1), "each once");
        assert_eq!(near.boundary_near_fluid().len(), 40);
    }
}

#[test]
fn particles_on_the_faces_of_columns_lose_no_pair() {
    // Columns are two dp wide from the lowest particle: on a lattice of dp every other particle lies on a face.
    let dp = REACH / 3.5;
    for sweep in ALL {
        let water: Vec<Vector<3>> = (0..12 * 7 * 5)
            .map(|i| Vector::from([(i % 12) as f64, (i / 12 % 7) as f64, (i / 84) as f64]) * dp)
            .collect();
        let skin: Vec<Vector<3>> =
            (0..60).map(|i| Vector::from([(i % 12) as f64, (i / 12) as f64, -1.0]) * dp).collect();
        let mut near = near(sweep);
        near.build(&water, &skin);
        assert_eq!(listed(&near, &water, &skin), all_pairs(&water, &skin), "{sweep:?}");
    }
}
