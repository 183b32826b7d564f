//! Bodies lighter than the water that goes with them: foam, shells, plates.

use pontoon::{
    model::{Model, Sweeping, Walls},
    shape::Shape,
    simulation::Simulation,
    solid::Role,
    space::{Pose, Vector},
};

use crate::rig;

const G: f64 = 9.81;

/// A body of `shape`, `ratio` as dense as water, in the middle of still water 0.8 m × 0.6 m, dp 10 mm.
fn submerged(shape: Shape<2>, ratio: f64) -> Simulation<2> {
    let dp = 0.01;
    let model = Model::water(2, dp, 0.6);
    let mut water = rig::lattice([0.0, 0.0], [0.8, 0.6], dp);
    let middle = Vector::from([0.4, 0.3]);
    water.retain(|r| shape.signed_distance(&(r - middle)) > 0.0);
    let body = rig::float(shape, [0.4, 0.3], 1000.0 * ratio);
    rig::simulation(model, water, 0.6, vec![rig::tank([0.8, 0.8], dp), body])
}

/// Rise (m) of the body in `time` (s).
fn rise(mut sim: Simulation<2>, time: f64) -> f64 {
    while sim.time() < time {
        sim.step_to(time).unwrap();
    }
    sim.system().solids()[1].kinematics.centre[1] - 0.3
}

#[test]
fn a_body_lighter_than_water_starts_upwards_with_its_added_mass() {
    // A box B = 16 dp broad drags κ ¼π B² of water, κ = 1.16 if it is an eighth as thick and 1.41 if 0.6 as thick, between
    // the 1 of a plate and the 1.51 of a square (Brennen 1982): a = (1 − ratio) g A/(κ ¼π B² + ratio A). In 80 ms it goes a
    // tenth of its depth at most. The surface above, the bed below and a face at half a dp: 15 %. An explicit exchange, at
    // half the step that just does not blow up, is four times too fast for the box and twenty for the plate at ratio 0.01.
    let time = 0.08;
    for (size, of_plate) in [([0.16, 0.02], 1.16), ([0.16, 0.1], 1.41)] {
        for ratio in [0.01, 0.05, 0.2] {
            let area = size[0] * size[1];
            let added = of_plate * 0.25 * std::f64::consts::PI * size[0] * size[0];
            let exact = 0.5 * (1.0 - ratio) * G * area / (added + ratio * area) * time * time;
            let found = rise(submerged(Shape::Box { size: Vector::from(size) }, ratio), time);
            assert!((found / exact - 1.0).abs() < 0.15, "{size:?}, ratio {ratio}: {found} m, exact {exact} m");
        }
    }
}

#[test]
fn a_sheet_of_foam_comes_to_rest_on_the_water() {
    // Let fall 1 dp on water it is at rest after a second: 5 mm/s, a third of a per cent of √(g depth). It should not hop at
    // all, and hops by a dp (docs/stability.md): 2 dp. A tenth of a dp of draft cannot be seen by particles: within 1.5 dp of it.
    let (dp, thick) = (0.01, 0.02);
    let water = rig::lattice([0.0, 0.0], [0.8, 0.3], dp);
    let float = rig::float(Shape::Box { size: Vector::from([0.16, thick]) }, [0.4, 0.3 + dp + 0.5 * thick], 10.0);
    let mut sim = rig::simulation(Model::water(2, dp, 0.3), water, 0.3, vec![rig::tank([0.8, 0.5], dp), float]);
    let (mut highest, mut fastest) = (0.0_f64, 0.0_f64);
    while sim.time() < 1.5 {
        sim.step().unwrap();
        let now = sim.system().solids()[1].kinematics;
        highest = highest.max(now.centre[1]);
        if sim.time() > 1.0 {
            fastest = fastest.max(now.velocity.norm());
        }
    }
    let rests = sim.system().solids()[1].kinematics.centre[1] - 0.5 * thick - 0.3;
    assert!(highest < 0.3 + 3.0 * dp + 0.5 * thick, "it hopped to {highest} m");
    assert!(fastest < 5e-3, "{fastest} m/s");
    assert!(rests.abs() < 1.5 * dp, "its lower face rests {rests} m above the water");
}

#[test]
fn what_the_water_loses_a_light_body_has_or_will_have() {
    for (sweep, rounding) in [(Sweeping::Reference, 1e-12), (Sweeping::Fast, 1e-8)] {
        let dp = 0.02;
        let mut model = Model::water(2, dp, 0.3);
        (model.gravity, model.sweep, model.c0, model.walls) = (vec![0.0, 0.0], sweep, 34.0, Walls::Dbc);
        let mut water = rig::lattice([-0.2, -0.2], [0.4, 0.4], dp);
        water.retain(|r| r[0].abs() > 0.06 || r[1].abs() > 0.04);
        let shape = Shape::Box { size: Vector::from([0.12, 0.08]) };
        let mut sim = rig::simulation(model, water, -1.0, vec![rig::float(shape, [0.0, 0.0], 20.0)]);
        sim.set_water_velocity(|r| Vector::from([0.5 - 2.0 * r[0] + r[1], 0.3 + 2.0 * r[1] - r[0]]));
        let whole = |sim: &Simulation<2>| {
            let solid = &sim.system().solids()[0];
            let Role::Free(body) = &solid.spec.role else { panic!("a free body") };
            rig::water_momentum(sim) + solid.kinematics.velocity * body.mass + sim.withheld(0)
        };
        let (start, scale) = (whole(&sim), 1000.0 * 0.15 * 0.5);
        let mut most = 0.0_f64;
        for _ in 0..500 {
            sim.step().unwrap();
            most = most.max(sim.withheld(0).norm());
        }
        // Rounding, as for heavy bodies; and what is withheld is not nothing.
        assert!((whole(&sim) - start).norm() < rounding * scale, "{:e}", (whole(&sim) - start).norm() / scale);
        assert!(most > 1e-6 * scale, "this body is not light: {most} N s");
    }
}

#[test]
fn a_light_body_held_down_weighs_what_archimedes_says() {
    // A lid holds a foam box under water: what presses on the lid is the buoyancy less the weight, 2 %, though neither is
    // known to the exchange. Friction is none and the water at rest.
    let (dp, ratio) = (0.01, 0.02);
    let model = Model::water(2, dp, 0.3);
    let mut water = rig::lattice([0.0, 0.0], [0.6, 0.3], dp);
    let shape = Shape::Box { size: Vector::from([0.16, 0.1]) };
    let lid = Shape::Box { size: Vector::from([0.04, 0.2]) };
    water.retain(|r| shape.signed_distance(&(r - Vector::from([0.3, 0.15]))) > 0.0);
    water.retain(|r| lid.signed_distance(&(r - Vector::from([0.3, 0.3]))) > 0.0);
    let solids = vec![
        rig::tank([0.6, 0.5], dp),
        rig::float(shape, [0.3, 0.15], 1000.0 * ratio),
        rig::solid("lid", lid, Pose::at(Vector::from([0.3, 0.3])), Role::Fixed),
    ];
    let mut sim = rig::simulation(model, water, 0.3, solids);
    let (mut sum, mut count) = (0.0, 0);
    while sim.time() < 1.5 {
        sim.step().unwrap();
        if sim.time() > 0.5 {
            sum += sim.contacts().iter().map(|contact| contact.pressing).sum::<f64>();
            count += 1;
        }
    }
    // Beneath the lid no water presses from above: as much more as the lid is broad and the box's top deep, 0.1 m.
    let exact = 1000.0 * G * ((1.0 - ratio) * 0.16 * 0.1 + 0.04 * 0.1);
    let found = sum / f64::from(count);
    assert!((found / exact - 1.0).abs() < 0.02, "{found} N/m for {exact} N/m");
}
