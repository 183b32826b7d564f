//! Unit tests of `src/system/own_water.rs`.

use super::*;
use crate::{
    geometry::Shape,
    model::{HasPairLoop as _, Model},
    solid::{Dim, SolidSpec},
    system::{Setup, known_water},
};

/// A system of water at rest in a tank, 30 dp long, on each of `count` ranks, and what `work` makes of it.
fn still_tanks<T: Send>(count: usize, work: impl Fn(&mut System<2>) -> T + Sync) -> Vec<T> {
    let still_tank = |ranks: Ranks| {
        let dp = 0.02;
        let tank = SolidSpec::fixed("tank", Shape::Tank { size: Vector::from([0.6, 0.4]), thickness: 4.0 * dp });
        let setup = Setup::<2>::new(Model::water(2, dp, 0.2)).solid(tank).fill_box([0.0, 0.0], [0.6, 0.2]);
        let setup = setup.expect("a tank holds water");
        let pair_loop = Dim::<2>::pair_loop(&setup.model);
        work(&mut System::new(setup, pair_loop, ranks.with_all_water()).expect("a sound setup"))
    };
    std::thread::scope(|scope| {
        let still_tank = &still_tank;
        let ranks = Ranks::in_threads(count).into_iter();
        let threads: Vec<_> = ranks.map(|ranks| scope.spawn(move || still_tank(ranks))).collect();
        threads.into_iter().map(|thread| thread.join().expect("a rank does not panic")).collect()
    })
}

/// A rank finds near its boundary particles what a single rank finds there, in the same order, also beside the water of other ranks; and
/// the boundary particles of all ranks are those of a single one.
#[test]
fn a_rank_that_knows_the_adjacent_slabs_finds_all_water_near_its_boundary_particles() {
    let near_walls = |count: usize| {
        still_tanks(count, |system| {
            assert_eq!(is_apart(&system.neighbours), count > 1);
            known_water::know_adjacent_slabs(system);
            let reach = system.model.support_radius();
            let water = |i: usize| {
                let (x, Particles { r, rho, .. }) = (system.boundary.particles.r[i], &system.fluid.particles);
                let mut found = Vec::new();
                system.neighbours.visit_fluid_around(&x, &mut |j| {
                    if (r[j] - x).norm() < reach {
                        found.push((j, r[j], rho[j].to_bits()));
                    }
                });
                (i, found)
            };
            own_near(&system.neighbours).map(water).collect::<Vec<_>>()
        })
    };
    let alone = near_walls(1).swap_remove(0);
    assert!(alone.iter().filter(|(_, found)| found.len() > 3).count() > 30, "water is near the walls");
    for count in [2, 3] {
        let mut all = near_walls(count).concat();
        all.sort_by_key(|(i, _)| *i);
        assert_eq!(all, alone, "{count} ranks");
    }
}

/// The first rank has the places of all water between the two calls, and its own before and after them.
#[test]
fn the_first_rank_has_the_places_of_all_water_until_it_forgets_them() {
    let alone = still_tanks(1, |system| system.fluid.particles.r.clone()).swap_remove(0);
    let places = still_tanks(3, |system| {
        known_water::gather_places(system);
        let all = system.fluid.particles.r.clone();
        known_water::forget_places(system);
        let these = own(&system.neighbours, all.len()).0;
        let kept = system.fluid.particles.r[these.clone()] == all[these.clone()];
        let others = (0..all.len()).filter(|i| !these.contains(i));
        (all, kept, others.filter(|&i| system.fluid.particles.r[i] != Vector::<2>::zeros()).count())
    });
    assert_eq!(places[0].0, alone);
    assert!(places.iter().all(|(_, kept, _)| *kept), "each rank keeps its own water");
    assert_eq!(places[0].2, 0, "the first rank keeps no other water");
}

/// The densities at the start of a step are those of then, also where ranks have advanced boundary particles since.
#[test]
fn the_densities_of_all_boundary_particles_at_the_start_of_a_step_come_back() {
    for count in [1, 3] {
        let came_back = still_tanks(count, |system| {
            let (then, start) = (system.boundary.particles.rho.clone(), StateAtStart::of(system));
            let own: Vec<usize> = own_near(&system.neighbours).collect();
            own.iter().for_each(|&i| system.boundary.particles.rho[i] += 1.0);
            share_boundary_density(&system.neighbours, &mut system.boundary.particles.rho);
            let changed = system.boundary.particles.rho.iter().zip(&then).filter(|(now, then)| now != then).count();
            let places = own.iter().enumerate();
            let own_are_kept = places.into_iter().all(|(place, &i)| start.boundary_density(place) == then[i]);
            changed > 30 && own_are_kept && start.all_boundary_densities(system) == then
        });
        assert_eq!(came_back, vec![true; count]);
    }
}
