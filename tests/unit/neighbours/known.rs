//! Unit tests of what queries at a point find where a rank knows a part of the water.

use super::*;
use crate::math::simd::instruction_sets;

/// The queries of two ranks, each with half of the water and a third of the other's, find what a query of all water finds of these, in
/// the same order: sums over what they find have the same bits then.
#[test]
fn a_query_finds_the_known_water_in_the_order_of_all() {
    // Multiples of irrational numbers fill a square evenly, in no order.
    let place = |i: u32| Vector::from([2.0_f64.sqrt(), 3.0_f64.sqrt()].map(|x| 4.0 * (f64::from(i) * x).fract()));
    let water: Vec<Vector<2>> = (1..500).map(place).collect();
    let found = |lists: &NeighbourLists<2>, x: [f64; 2]| {
        let mut these = Vec::new();
        lists.visit_fluid_around(&Vector::from(x), &mut |i| these.push(i));
        these
    };
    let lists = || NeighbourLists::<2>::new(0.4, 0.2, instruction_sets().pop());
    let mut all = lists();
    all.find_at(&water);
    std::thread::scope(|scope| {
        for ranks in Ranks::in_threads(2) {
            scope.spawn(|| {
                let rank = ranks.rank();
                let mut part = lists().on_ranks(ranks);
                let own: Vec<u32> = (0..499).filter(|&i| (water[i as usize][0] < 2.0) == (rank == 0)).collect();
                let mut these: Vec<u32> = (0..499).step_by(3).chain(own.iter().copied()).collect();
                these.sort_unstable();
                these.dedup();
                let division = part.division_mut().expect("lists of clusters");
                division.by_owner = true;
                division.set_own_water(own, water.len());
                (part.bounds_at_build, part.positions_at_build) = (Bounds::around(&water), water.clone());
                part.know(these.clone(), &these.iter().map(|&i| water[i as usize]).collect::<Vec<_>>());
                let mut unknown = 0;
                for x in [[0.3, 0.3], [1.9, 2.2], [2.0, 3.9], [3.7, 1.0], [-0.2, 4.1]] {
                    let whole = found(&all, x);
                    let wanted: Vec<usize> = whole.iter().copied().filter(|&i| these.contains(&(i as u32))).collect();
                    assert!(wanted.len() > 1, "several known particles are near {x:?}");
                    unknown += whole.len() - wanted.len();
                    assert_eq!(found(&part, x), wanted, "rank {rank} near {x:?}");
                }
                assert!(unknown > 10, "of the other rank's water most is unknown");
            });
        }
    });
}
