//! Periodic sides: results do not depend on their position, and particles and momentum are conserved.

use std::f64::consts::TAU;

use pontoon::{
    geometry::Shape,
    math::{Pose, Vector},
    model::{Diffusion, Model, PairLoopKind, Shifting, Slip, Viscosity},
    simulation::{Setup, Simulation},
    solid::Role,
    sph::{particle_shifting::Shift, viscosity::Laminar},
};

use crate::common::{self, Random};

const DP: f64 = 0.05;

fn model() -> Model {
    let mut model = Model::water(2, DP, 1.0);
    (model.c0, model.gravity) = (20.0, vec![0.0, 0.0]);
    model.viscosity = Viscosity::Laminar(Laminar { nu0: 0.01 });
    model.shifting = Shifting::Everywhere(Shift::default());
    model
}

/// A square metre of swirling water, periodic from (`x`, `y`), with particles displaced from the lattice.
fn swirl(model: Model, x: f64, y: f64) -> Simulation<2> {
    let mut random = Random(7);
    let off = |r: Vector<2>, random: &mut Random| r + (random.point::<2>() - Vector::repeat(0.5)) * (0.2 * DP);
    let wrap = |r: f64, from: f64| from + (r - from).rem_euclid(1.0);
    let water: Vec<Vector<2>> =
        common::lattice([0.0, 0.0], [1.0, 1.0], DP).into_iter().map(|r| off(r, &mut random)).collect();
    let velocity = water.iter().map(|r| Vector::from([-(TAU * r[1]).sin(), (TAU * r[0]).sin()])).collect();
    let pressure = water.iter().map(|r| 2000.0 + 300.0 * (TAU * r[0]).cos()).collect();
    let water = water.iter().map(|r| Vector::from([wrap(r[0], x), wrap(r[1], y)]));
    let mut setup = Setup::new(model).water(water, 0.0).periodic(0, x, x + 1.0).periodic(1, y, y + 1.0);
    (setup.velocity, setup.pressure) = (velocity, pressure);
    Simulation::new(setup).expect("a sound setup")
}

#[test]
fn the_position_of_the_periodic_sides_does_not_change_the_flow() {
    for (pair_loop, bound) in [(PairLoopKind::Reference, 1e-9), (PairLoopKind::Fast, 1e-3)] {
        let at = |x: f64, y: f64| {
            let mut sim = swirl(model().pair_loop(pair_loop), x, y);
            (0..20).for_each(|_| sim.step().expect("a sound run"));
            let fluid = sim.system().fluid();
            let mut v = vec![Vector::<2>::zeros(); fluid.len()];
            fluid.id.iter().zip(fluid.v).for_each(|(id, v_of)| v[*id as usize] = *v_of);
            v
        };
        let (here, there) = (at(0.0, 0.0), at(0.37, -0.61));
        // Sums are in another order, and 20 steps amplify the rounding. SIMD lanes round in single precision.
        let off = here.iter().zip(&there).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(off < bound, "{pair_loop:?}: {off} m/s");
    }
}

#[test]
fn periodic_sides_conserve_particles_and_momentum() {
    let mut sim = swirl(model(), 0.0, 0.0);
    let (before, mass) = (common::water_momentum(&sim), sim.system().particle_mass());
    let n = sim.system().fluid().len();
    while sim.time() < 1.2 {
        sim.step().expect("a sound run");
    }
    let fluid = sim.system().fluid();
    let mut ids = fluid.id.to_vec();
    ids.sort_unstable();
    assert!(ids.iter().copied().eq(0..n as u32), "every particle is present once");
    // Between two rebuilds of the neighbour lists a particle may lie slightly outside its side.
    assert!(fluid.r.iter().all(|r| r.iter().all(|x| (-DP..1.0 + DP).contains(x))));
    // Pair forces cancel except for the last bit of the position of an image: single precision of the largest force.
    let drift = (common::water_momentum(&sim) - before).norm();
    assert!(drift < 1e-5 * n as f64 * mass, "{drift} kg m/s");
}

#[test]
fn a_periodic_run_has_the_same_bits_after_a_restart_and_on_any_number_of_threads() {
    let on = |threads: usize| {
        common::on_threads(threads, || {
            let mut sim = swirl(model(), 0.0, 0.0);
            (0..60).for_each(|_| sim.step().expect("a sound run"));
            let saved = sim.save().expect("a state");
            (0..60).for_each(|_| sim.step().expect("a sound run"));
            (saved, sim.save().expect("a state"))
        })
    };
    let (saved, whole) = on(1);
    assert!(on(3) == (saved.clone(), whole.clone()));
    let mut resumed = swirl(model(), 0.0, 0.0);
    resumed.restore(&saved).expect("a state of this setup");
    (0..60).for_each(|_| resumed.step().expect("a sound run"));
    assert!(resumed.save().expect("a state") == whole);
}

#[test]
fn the_wall_drag_in_a_steady_periodic_channel_equals_the_driving_force() {
    // In steady flow the drag of both walls is the weight of the water along the channel, images not counted.
    let (height, length, g) = (1.0, 0.5, 0.8);
    let mut model = model().gravity([g, 0.0]).shifting(Shifting::None).diffusion(Diffusion::None);
    (model.viscosity, model.slip) = (Viscosity::Laminar(Laminar { nu0: 0.1 }), Slip::None);
    let water = common::lattice([0.0, 0.0], [length, height], DP);
    let slab = |name: &str, y: f64| {
        let shape = Shape::Box { size: Vector::from([3.0, 0.2]) };
        common::solid(name, shape, Pose::at(Vector::from([0.0, y])), Role::Fixed)
    };
    let solids = vec![slab("bottom", -0.1), slab("top", height + 0.1)];
    let setup = Setup::new(model).water(water, 0.0).solids(solids).periodic(0, 0.0, length);
    let mut sim = Simulation::new(setup).expect("a sound setup");
    while sim.time() < 5.0 {
        sim.step().expect("a sound run");
    }
    let drag: f64 = sim.system().solids().iter().map(|s| s.load.force[0]).sum();
    let driven = 1000.0 * height * length * g;
    // The flow approaches its steady state with the time H²/(π² ν); after five of them seven thousandths remain.
    assert!((drag / driven - 1.0).abs() < 0.02, "{drag} N/m of {driven} N/m");
}

#[test]
fn invalid_periodic_sides_are_refused() {
    let setup = |from: f64, to: f64, solids| {
        let water = common::lattice([0.0, 0.0], [1.0, 1.0], DP);
        Simulation::new(Setup::new(model()).water(water, 0.0).solids(solids).periodic(0, from, to))
            .err()
            .map(|e| e.to_string())
            .unwrap_or_default()
    };
    assert_eq!(setup(0.0, 1.0, vec![]), "");
    assert!(setup(0.0, 0.3, vec![]).contains("so short"));
    assert!(setup(0.0, 1.02, vec![]).contains("not a whole number of dp"));
    let box_ = Shape::Box { size: Vector::from([1.0, 0.2]) };
    let ends = common::solid("bed", box_.clone(), Pose::at(Vector::from([0.5, -0.1])), Role::Fixed);
    assert!(setup(0.0, 1.0, vec![ends]).contains("\"bed\" ends at a periodic side"));
    assert!(setup(0.0, 1.0, vec![common::float(box_, [0.5, 1.2], 500.0)]).contains("\"float\" is free"));
}
