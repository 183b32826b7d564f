//! One to a thousand bodies: the same bits on any number of threads, and a pile that comes to rest without gaining energy.

use pontoon::{
    geometry::Shape,
    math::Vector,
    model::Model,
    simulation::{Dimension, Simulation},
    solid::{Dim, Role},
};

use crate::common;

/// `count` cubes of 4 dp, at most `row` side by side, stacked 0.2 dp apart from 2 dp below the surface upwards. Neighbouring cubes
/// approach one another.
fn crowd<const D: usize>(count: usize, row: usize) -> Simulation<D>
where
    Dim<D>: Dimension<D>,
{
    let (dp, depth) = (0.02, 10.0);
    let row = row.min(count);
    let shape = Shape::Box { size: Vector::repeat(4.0 * dp) };
    let mut floats = Vec::new();
    for i in 0..count {
        let cell: [usize; D] = std::array::from_fn(|axis| {
            let layer = i / row.pow(axis as u32);
            if axis + 1 == D { layer } else { layer % row }
        });
        let mut at = cell.map(|k| (3.0 + 4.2 * (k as f64 + 0.5)) * dp);
        at[D - 1] += (depth - 5.0) * dp;
        let mut float = common::float(shape.clone(), at, [300.0, 600.0, 900.0, 1500.0][i % 4]);
        (float.name, float.friction, float.restitution) = (format!("cube-{i}"), 0.4, 0.2);
        let Role::Free(body) = &mut float.role else { panic!("a free body") };
        let sense = if cell.iter().sum::<usize>() % 2 == 0 { 1.0 } else { -1.0 };
        body.velocity = Vector::from_fn(|axis, _| if axis == 0 { 0.8 } else { -0.5 }) * sense;
        floats.push(float);
    }
    let mut size = [(4.2 * row as f64 + 6.0).ceil() * dp; D];
    size[D - 1] = depth * dp;
    let mut water = common::lattice([0.0; D], size, dp);
    // Water particles start half a dp off the faces of the cubes.
    water.retain(|r| floats.iter().all(|float| (r - float.pose.position).amax() > 2.45 * dp));
    let highest = floats.last().map_or(0.0, |float| float.pose.position[D - 1]);
    size[D - 1] = highest + 8.0 * dp;
    let mut solids = vec![common::tank(size, dp)];
    solids.extend(floats);
    common::simulation(Model::water(D, dp, depth * dp), water, depth * dp, solids)
}

/// True if 50 steps of the cubes end in the same bits on 1, 2 and 3 threads. Asserts that the bodies collide.
fn same_bits<const D: usize>(count: usize, row: usize) -> bool
where
    Dim<D>: Dimension<D>,
{
    let run = |threads: usize| {
        common::on_threads(threads, || {
            let (mut sim, mut met) = (crowd::<D>(count, row), 0);
            for _ in 0..50 {
                sim.step().expect("a sound run");
                met += sim.contacts().len();
            }
            // Neighbours approach at 1.6 m/s over a gap of 4 mm. Measured: 13 contacts among 10 bodies, 700 among 100.
            assert!(met >= count / 2, "{count} bodies had {met} contacts");
            sim.save().expect("a state")
        })
    };
    let first = run(1);
    run(2) == first && run(3) == first
}

#[test]
fn one_to_a_thousand_bodies_have_the_same_bits_on_one_two_and_three_threads() {
    for count in [1, 10, 100, 1000] {
        assert!(same_bits::<2>(count, 40), "{count} bodies");
    }
}

#[test]
fn a_hundred_bodies_in_three_dimensions_have_the_same_bits_on_one_two_and_three_threads() {
    assert!(same_bits::<3>(100, 5));
}

/// Boxes of several densities in rows above water 0.2 m deep in a tank 1.2 m long.
fn pile(count: usize) -> Simulation<2> {
    let dp = 0.02;
    let mut solids = vec![common::tank([1.2, 1.2], dp)];
    for i in 0..count {
        let (row, column) = (i / 6, i % 6);
        let at = [0.15 + 0.17 * column as f64 + 0.02 * (row % 2) as f64, 0.3 + 0.12 * row as f64];
        let shape = Shape::Box { size: Vector::from([0.1, 0.08]) };
        let mut solid = common::float(shape, at, [300.0, 600.0, 900.0, 1500.0][i % 4]);
        (solid.name, solid.friction) = (format!("box-{i}"), 0.4);
        solids.push(solid);
    }
    common::simulation(Model::water(2, dp, 0.3), common::lattice([0.0, 0.0], [1.2, 0.2], dp), 0.2, solids)
}

/// Kinetic and potential energy of water and bodies, and compression energy of the water, J/m.
fn energy(sim: &Simulation<2>) -> f64 {
    let bodies = sim.system().solids().iter().map(|solid| match &solid.spec.role {
        Role::Free(body) => {
            let now = &solid.kinematics;
            let turning = body.inertia[(0, 0)] * now.spin.axial()[0].powi(2);
            0.5 * (body.mass * now.velocity.norm_squared() + turning) + body.mass * 9.81 * now.centre[1]
        }
        _ => 0.0,
    });
    common::water_energy(sim) + bodies.sum::<f64>()
}

#[test]
fn a_pile_of_thirty_bodies_has_the_same_bits_on_one_and_two_threads() {
    let run = |threads: usize| {
        common::on_threads(threads, || {
            let mut sim = pile(30);
            while sim.time() < 0.35 {
                sim.step_to(0.35).expect("a sound run");
            }
            assert!(sim.contacts().len() > 10, "the bodies lie on one another: {} contacts", sim.contacts().len());
            sim.save().expect("a state")
        })
    };
    assert!(run(1) == run(2));
}

#[test]
fn a_pile_of_thirty_bodies_comes_to_rest_without_gaining_energy() {
    let mut sim = pile(30);
    let (start, mut least) = (energy(&sim), f64::INFINITY);
    let mut most_gained: f64 = 0.0;
    while sim.time() < 3.0 {
        sim.step_to(3.0).expect("a sound run");
        let now = energy(&sim);
        least = least.min(now);
        most_gained = most_gained.max(now - least);
    }
    // The sum omits the compression energy of the boundary particles, which varies with the impacts.
    let fallen = start - least;
    assert!(fallen > 20.0 && most_gained < 0.02 * fallen, "gained {most_gained} J/m of {fallen} J/m fallen");
    let solids = &sim.system().solids()[1..];
    let fastest = solids.iter().map(|solid| solid.kinematics.velocity.norm()).fold(0.0, f64::max);
    assert!(fastest < 0.3, "the pile is at rest except for motion by waves: {fastest} m/s");
    // Every body lies inside the tank, and no two bodies overlap.
    for (i, a) in solids.iter().enumerate() {
        let centre = a.kinematics.centre;
        assert!(centre[1] > 0.03 && centre[0] > 0.03 && centre[0] < 1.17, "{}: {centre}", a.spec.name);
        for b in &solids[i + 1..] {
            let apart = (centre - b.kinematics.centre).norm();
            // Two half heights of 0.04 m, less a tenth of dp.
            assert!(apart > 0.078, "{} and {} are {apart} m apart", a.spec.name, b.spec.name);
        }
    }
}
