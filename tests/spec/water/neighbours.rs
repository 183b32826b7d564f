//! Neighbour search: the lists contain every pair within the support radius once, until the next rebuild is due.

use std::collections::BTreeMap;

use pontoon::{
    math::Vector,
    model::PairLoopKind,
    neighbours::{CHUNK, Clusters, ListPart, NeighbourLists, PAD, PairLists},
};

use crate::common::Random;

const SUPPORT_RADIUS: f64 = 0.1;
const ALL: [PairLoopKind; 2] = [PairLoopKind::Fast, PairLoopKind::Reference];

fn neighbours<const D: usize>(pair_loop: PairLoopKind) -> NeighbourLists<D> {
    NeighbourLists::new(SUPPORT_RADIUS, SUPPORT_RADIUS / 3.5, pair_loop.instruction_set())
}

/// Number of times that each pair is listed: fluid with fluid (the smaller index first), and fluid with boundary.
#[derive(Default, PartialEq, Debug)]
struct PairCounts {
    fluid_fluid: BTreeMap<(u32, u32), usize>,
    fluid_boundary: BTreeMap<(u32, u32), usize>,
}

/// The pairs closer than the support radius, from a test of all pairs.
fn all_pairs<const D: usize>(water: &[Vector<D>], boundary: &[Vector<D>]) -> PairCounts {
    let mut counts = PairCounts::default();
    for (i, x) in water.iter().enumerate() {
        for (j, y) in water.iter().enumerate().skip(i + 1).filter(|(_, y)| (x - *y).norm() < SUPPORT_RADIUS) {
            let _ = y;
            counts.fluid_fluid.insert((i as u32, j as u32), 1);
        }
        for (j, _) in boundary.iter().enumerate().filter(|(_, y)| (x - *y).norm() < SUPPORT_RADIUS) {
            counts.fluid_boundary.insert((i as u32, j as u32), 1);
        }
    }
    counts
}

/// The pairs closer than the support radius that the lists contain.
fn listed<const D: usize>(neighbours: &NeighbourLists<D>, water: &[Vector<D>], boundary: &[Vector<D>]) -> PairCounts {
    let mut counts = match neighbours.pair_lists() {
        PairLists::Clusters(clusters, _) => from_clusters(clusters),
        PairLists::Lists(lists) => {
            let mut counts = PairCounts::default();
            for i in 0..water.len() {
                let (fluid_fluid, fluid_boundary) = lists.fluid[i / CHUNK].neighbours_of(i % CHUNK);
                // Each of two fluid particles lists the other.
                for &j in fluid_fluid.iter().filter(|&&j| j > i as u32) {
                    *counts.fluid_fluid.entry((i as u32, j)).or_default() += 1;
                }
                for &j in fluid_boundary {
                    *counts.fluid_boundary.entry((i as u32, j)).or_default() += 1;
                }
            }
            counts
        }
    };
    counts.fluid_fluid.retain(|&(i, j), _| (water[i as usize] - water[j as usize]).norm() < SUPPORT_RADIUS);
    counts.fluid_boundary.retain(|&(i, j), _| (water[i as usize] - boundary[j as usize]).norm() < SUPPORT_RADIUS);
    counts
}

fn from_clusters(clusters: &Clusters) -> PairCounts {
    let mut counts = PairCounts::default();
    for slab in &clusters.slabs {
        for slot in slab.first * 8..slab.end * 8 {
            let (cluster, i) = (slot / 8, clusters.source[slot]);
            let entries = slab.list(slot - slab.first * 8).flat_map(|ListPart { base, water, boundary }| {
                water.iter().chain(boundary).map(move |&entry| slab.first + base + usize::from(entry))
            });
            for c in entries {
                assert!(i != PAD, "a padding slot has no neighbours");
                let is_water = |c: usize| clusters.slabs.iter().any(|s| (s.first..s.middle).contains(&c));
                for &j in clusters.source[c * 8..c * 8 + 8].iter().filter(|&&j| j != PAD) {
                    match (is_water(cluster), is_water(c)) {
                        // Within a cluster each particle lists the other.
                        (true, true) if c == cluster && j <= i => {}
                        (true, true) => *counts.fluid_fluid.entry((i.min(j), i.max(j))).or_default() += 1,
                        (true, false) => *counts.fluid_boundary.entry((i, j)).or_default() += 1,
                        (false, true) => *counts.fluid_boundary.entry((j, i)).or_default() += 1,
                        (false, false) => panic!("boundary particles do not pair with one another"),
                    }
                }
            }
        }
    }
    counts
}

fn lists_hold_every_pair<const D: usize>(seed: u64, n: usize, origin: f64) {
    for pair_loop in ALL {
        let mut random = Random(seed);
        let at = |x: Vector<D>| x + Vector::repeat(origin);
        let mut water: Vec<Vector<D>> = (0..n).map(|_| at(random.point())).collect();
        // Boundary particles lie in and around the water.
        let around = |x: Vector<D>| at(x * 1.3 - Vector::repeat(0.15));
        let mut boundary: Vec<Vector<D>> = (0..n).map(|_| around(random.point())).collect();
        let mut neighbours = neighbours(pair_loop);
        neighbours.build(&water, &boundary);
        for &i in neighbours.boundary_near_fluid() {
            let nearest = water.iter().map(|x| (x - boundary[i as usize]).norm()).fold(f64::INFINITY, f64::min);
            assert!(
                nearest < SUPPORT_RADIUS + neighbours.margin() * 1.001,
                "a boundary particle near fluid has a fluid neighbour"
            );
        }
        // Each particle moves by just under half of the margin, in its own direction: no rebuild is due yet.
        for x in water.iter_mut().chain(&mut boundary) {
            let d = random.point::<D>() - Vector::repeat(0.5);
            *x += d.normalize() * (0.499 * neighbours.margin());
        }
        let expected = all_pairs(&water, &boundary);
        assert!(expected.fluid_fluid.len() > n && expected.fluid_boundary.len() > n / 2, "the case has pairs");
        assert_eq!(listed(&neighbours, &water, &boundary), expected, "{pair_loop:?} in {D}-D");
        for &(_, j) in expected.fluid_boundary.keys() {
            assert!(
                neighbours.boundary_near_fluid().binary_search(&j).is_ok(),
                "a boundary particle with a fluid neighbour is listed as near fluid"
            );
        }
    }
}

#[test]
fn the_lists_hold_every_pair_in_two_and_three_dimensions() {
    lists_hold_every_pair::<2>(1, 700, 0.0);
    lists_hold_every_pair::<3>(2, 1500, 0.0);
}

#[test]
fn the_lists_hold_every_pair_a_kilometre_from_the_origin() {
    lists_hold_every_pair::<2>(3, 500, 1000.0);
    lists_hold_every_pair::<3>(4, 800, -1000.0);
}

#[test]
fn the_lists_hold_every_pair_of_isolated_particles_empty_cells_and_one_crowded_cell() {
    for pair_loop in ALL {
        let mut neighbours = neighbours::<2>(pair_loop);
        neighbours.build(&[], &[]);
        assert!(neighbours.boundary_near_fluid().is_empty());
        let alone = [Vector::from([1e6, -1e6])];
        neighbours.build(&alone, &[]);
        assert_eq!(listed(&neighbours, &alone, &[]), PairCounts::default(), "a particle is not its own neighbour");
        let heap = vec![Vector::from([0.5, 0.5]); 40];
        let mut spread = heap.clone();
        spread.push(Vector::from([1e5, 1e5]));
        neighbours.build(&spread, &heap);
        let counts = listed(&neighbours, &spread, &heap);
        assert_eq!((counts.fluid_fluid.len(), counts.fluid_boundary.len()), (40 * 39 / 2, 40 * 40), "{pair_loop:?}");
        assert!(counts.fluid_fluid.values().chain(counts.fluid_boundary.values()).all(|&n| n == 1), "each once");
        assert_eq!(neighbours.boundary_near_fluid().len(), 40);
    }
}

#[test]
fn the_lists_hold_every_pair_of_particles_on_the_faces_of_cell_columns() {
    // Columns are two dp wide, measured from the lowest particle. On a lattice of dp every other particle lies on a face.
    let dp = SUPPORT_RADIUS / 3.5;
    for pair_loop in ALL {
        let water: Vec<Vector<3>> = (0..12 * 7 * 5)
            .map(|i| Vector::from([(i % 12) as f64, (i / 12 % 7) as f64, (i / 84) as f64]) * dp)
            .collect();
        let boundary: Vec<Vector<3>> =
            (0..60).map(|i| Vector::from([(i % 12) as f64, (i / 12) as f64, -1.0]) * dp).collect();
        let mut neighbours = neighbours(pair_loop);
        neighbours.build(&water, &boundary);
        assert_eq!(listed(&neighbours, &water, &boundary), all_pairs(&water, &boundary), "{pair_loop:?}");
    }
}

#[test]
fn the_lists_hold_every_pair_of_slabs_with_more_clusters_than_an_entry_can_number() {
    // An entry has 16 bits: two slabs of more than 2¹⁶ clusters need lists in parts. Columns a metre wide make such slabs.
    let (n, support_radius, dp) = (540_000, 0.01, 0.5);
    let mut random = Random(7);
    let water: Vec<Vector<3>> =
        (0..n).map(|_| random.point::<3>().component_mul(&Vector::from([1.9, 1.0, 1.0]))).collect();
    let boundary: Vec<Vector<3>> = (0..1000).map(|i| water[i * 500] + Vector::from([0.0, 0.0, 1e-3])).collect();
    let counts = ALL.map(|pair_loop| {
        let mut neighbours = NeighbourLists::new(support_radius, dp, pair_loop.instruction_set());
        neighbours.build(&water, &boundary);
        if let PairLists::Clusters(clusters, _) = neighbours.pair_lists() {
            assert!(clusters.slabs[0].list(0).count() > 1, "the lists have parts");
        }
        let mut counts = listed(&neighbours, &water, &boundary);
        counts.fluid_fluid.retain(|&(i, j), _| (water[i as usize] - water[j as usize]).norm() < support_radius);
        counts.fluid_boundary.retain(|&(i, j), _| (water[i as usize] - boundary[j as usize]).norm() < support_radius);
        counts
    });
    assert!(counts[0].fluid_fluid.len() > n / 2 && counts[0].fluid_boundary.len() >= 1000, "the case has pairs");
    assert!(counts[0] == counts[1], "clusters and single neighbours list the same pairs");
}
