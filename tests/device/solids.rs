//! Solids that come and go while the water is on a device.

use std::collections::BTreeMap;

use pontoon::{
    math::Vector,
    model::{Model, PairLoopKind, TimeScheme},
    simulation::{Setup, Simulation},
    solid::{PrescribedMotion, Role, SolidSpec, TimedRemoval},
};

use super::{
    Shape, beside,
    coupled::{assert_repeats_and_resumes, solids_apart},
    dam_with, device, distances,
    forces::law,
    run, under,
};

const DP: f64 = 0.02;

/// Water behind a gate, which is removed at `at` (s).
fn gate(model: Model, gate: SolidSpec<2>, at: f64) -> Setup<2> {
    let mut setup = dam_with(model, [0.8, 0.3], [gate]);
    setup.constraints.removals.push(TimedRemoval { solid: 1, at });
    setup
}

fn plate() -> Shape<2> {
    Shape::Box { size: [4.0 * DP, 0.4].into() }
}

#[test]
fn solids_that_are_removed_agree_with_the_reference() {
    let water = || Model::water(2, DP, 0.3);
    let verlet = TimeScheme::Verlet { euler_every: 40 };
    let fixed = || SolidSpec::fixed("gate", plate()).at([0.36, 0.2]);
    let slides = PrescribedMotion::slide([0.0, 1.0].into(), law("0.5*t"));
    let driven = SolidSpec::driven("gate", plate(), slides).at([0.36, 0.2]);
    let body = SolidSpec::free("box", Shape::Box { size: [0.2, 0.2].into() }, 500.0).at([0.14, 0.32]);
    for (name, setup) in [
        ("fixed", gate(water(), fixed(), 0.03)),
        ("Verlet", gate(water().scheme(verlet).cfl(0.2), fixed(), 0.03)),
        ("driven", gate(water(), driven, 0.03)),
        ("free", gate(water().for_free_bodies(), body, 0.03)),
    ] {
        let [on_device, reference] = beside(&setup, 0.01, 200);
        let ([r, v], solids) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
        println!("{name}: water {r:.1e} dp, {v:.1e} c0, solids {solids:.1e} dp, after {} s", reference.time());
        assert_eq!(on_device.system().boundary().len(), reference.system().boundary().len(), "{name}");
        let times = [&on_device, &reference].map(|sim| sim.events().last().expect("a removal").time);
        // A device counts time in whole ticks, of which a step has more than a hundred thousand.
        assert!((times[0] - times[1]).abs() < 1e-5 * 0.03, "{name}: removed at {times:?} s");
        // The bound of free bodies.
        assert!(r < 1e-3 && solids < 1e-3, "{name}: water {r} dp, solids {solids} dp off");
        // The checkpoint in the middle is after the removal.
        assert_repeats_and_resumes(name, &setup, 240, 1e-3);
    }
    // In one go the device ends a step at the removal, too.
    let mut sim = Simulation::new(gate(water(), fixed(), 0.03)).unwrap().on_device(&device()).unwrap();
    while sim.time() < 0.05 {
        sim.step_to_pause(0.05, 1.0).unwrap();
    }
    let time = sim.events().last().expect("a removal").time;
    assert!((time / 0.03 - 1.0).abs() < 1e-9, "removed at {time} s");
}

#[test]
fn solids_that_a_program_adds_and_removes_agree_with_the_reference() {
    let setup = dam_with(Model::water(2, DP, 0.3).for_free_bodies(), [0.8, 0.3], []);
    let state = run(&setup, 0.02);
    let mut reference = under(&setup, PairLoopKind::Reference, &state);
    let mut on_device = under(&setup, PairLoopKind::Fast, &state).on_device(&device()).unwrap();
    let hull = || Shape::Box { size: [0.2, 0.2].into() };
    for sim in [&mut reference, &mut on_device] {
        let go = |sim: &mut Simulation<2>| (0..60).for_each(|_| sim.step().unwrap());
        go(sim);
        let late = SolidSpec::free("late", hull(), 500.0).at([0.16, 0.3]);
        assert!(sim.add_solid(late).unwrap().displaced > 20);
        go(sim);
        let lift = sim.system().solids()[1].load.force[1];
        assert!(lift > 5.0, "water bears it: {lift} N/m");
        sim.add_solid(SolidSpec::fixed("step", hull()).at([0.7, 0.1])).unwrap();
        sim.remove_solid(1).unwrap();
        go(sim);
    }
    // The first solid has displaced water, whose names are missing.
    let water = |sim: &Simulation<2>| {
        let fluid = sim.system().fluid();
        fluid.id.iter().copied().zip(fluid.r.iter().copied()).collect::<BTreeMap<_, _>>()
    };
    let [here, there] = [&on_device, &reference].map(water);
    assert!(here.keys().eq(there.keys()), "the same water");
    let apart = here.values().zip(there.values()).map(|(a, b)| (a - b).norm() / DP).fold(0.0, f64::max);
    let solids = solids_apart(&on_device, &reference);
    println!("water {apart:.1e} dp, solids {solids:.1e} dp");
    // The bound of free bodies.
    assert!(apart < 1e-3 && solids < 1e-3, "water {apart} dp, solids {solids} dp off");
}

#[test]
fn bodies_that_a_program_moves_agree_with_the_reference() {
    // The program integrates by Euler's symplectic scheme. One body is light.
    for density in [500.0, 60.0] {
        let body = SolidSpec::free("box", Shape::Box { size: [0.2, 0.1].into() }, density).at([0.16, 0.3]);
        let setup = dam_with(Model::water(2, DP, 0.3).for_free_bodies(), [0.8, 0.3], [body]);
        let of = |pair_loop| {
            let mut setup = setup.clone();
            setup.model.pair_loop = pair_loop;
            Simulation::with_external_bodies(setup).unwrap()
        };
        let mut reference = of(PairLoopKind::Reference);
        let mut on_device = of(PairLoopKind::Fast).on_device(&device()).unwrap();
        let start = reference.system().solids()[1].kinematics;
        for sim in [&mut reference, &mut on_device] {
            let Role::Free(body) = sim.system().solids()[1].spec.role.clone() else { panic!("a free body") };
            for _ in 0..200 {
                let mut next = sim.system().solids()[1].kinematics;
                sim.step_with(1.0, |step| {
                    next.velocity += (step.loads()[1].force / body.mass + Vector::from([0.0, -9.81])) * step.dt();
                    next.centre += next.velocity * step.dt();
                    next.pose.position += next.velocity * step.dt();
                    step.solids[1] = next;
                    Ok(())
                })
                .unwrap();
            }
        }
        let ([r, v], solids) = (distances(&on_device, &reference), solids_apart(&on_device, &reference));
        let way = (reference.system().solids()[1].kinematics.centre - start.centre).norm() / DP;
        println!("{density} kg/m³: water {r:.1e} dp, {v:.1e} c0, box {solids:.1e} of {way:.1} dp");
        // The bound of free bodies.
        assert!(r < 1e-3 && solids < 1e-3 && way > 0.1, "water {r} dp, box {solids} of {way} dp off");
    }
}
