//! Bodies lighter than the water that goes with them: foam, shells, plates.

use pontoon::{
    model::{Diffusion, Model, Sweeping, Viscosity, Walls},
    shape::Shape,
    simulation::Simulation,
    solid::{FreeBody, Role},
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

/// Mean upward acceleration (m/s²) of the body from 30 to 70 ms: before, the sound that the start sends out has to come back
/// from bed and walls.
fn acceleration(mut sim: Simulation<2>) -> f64 {
    let mut speed = |time: f64| {
        while sim.time() < time {
            sim.step_to(time).unwrap();
        }
        sim.system().solids()[1].kinematics.velocity[1]
    };
    (-speed(0.03) + speed(0.07)) / 0.04
}

#[test]
fn a_body_lighter_than_water_starts_upwards_with_its_added_mass() {
    // A plate B = 16 dp broad drags ¼π B² of water, a box of 16 × 10 dp 1.47 times that (Brennen 1982, between plate and
    // square): a = (1 − ratio) g A/(added area + ratio A). The bed 0.3 m below, the surface 0.3 m above and a face at half a
    // dp: 15 %. An explicit exchange, at half the step that just does not blow up, is ten times too fast.
    for (size, of_plate) in [([0.16, 0.02], 1.0), ([0.16, 0.1], 1.47)] {
        for ratio in [0.01, 0.05, 0.2] {
            let area = size[0] * size[1];
            let added = of_plate * 0.25 * std::f64::consts::PI * size[0] * size[0];
            let exact = (1.0 - ratio) * G * area / (added + ratio * area);
            let found = acceleration(submerged(Shape::Box { size: Vector::from(size) }, ratio));
            assert!((found / exact - 1.0).abs() < 0.15, "{size:?}, ratio {ratio}: {found} m/s², exact {exact} m/s²");
        }
    }
}

#[test]
fn a_light_piston_goes_with_the_sound_that_it_makes() {
    // Pushed with F, it goes at F/(ρ c A) (1 − exp(−t/T)), T = M/(ρ c A), until the echo is back after 2H/c. T is a quarter
    // of a step. 3 %: density and speed of sound vary by 1 %, and the front of the wave is dp wide.
    let (dp, c0, ratio) = (0.01, 20.0, 0.01);
    let (breadth, depth, thick) = (0.1, 1.0, 0.04);
    let mut model = Model::water(2, dp, 1.0);
    (model.gravity, model.c0, model.viscosity) = (vec![0.0, 0.0], c0, Viscosity::None);
    (model.diffusion, model.walls) = (Diffusion::None, Walls::Dbc);
    let shape = Shape::Box { size: Vector::from([breadth, thick]) };
    let mut body = FreeBody::from_density(&shape, 1000.0 * ratio);
    (body.locked_translations, body.locked_rotations[0]) = ([true, false], true);
    let piston =
        rig::solid("piston", shape, Pose::at(Vector::from([0.5 * breadth, depth + 0.5 * thick])), Role::Free(body));
    let water = rig::lattice([0.0, 0.0], [breadth, depth], dp);
    let mut sim = rig::simulation(model, water, -1.0, vec![rig::tank([breadth, depth + 0.2], dp), piston]);
    let force = Vector::from([0.0, -1000.0 * c0 * breadth * 0.02]);
    let (mut sum, mut count) = (0.0, 0);
    while sim.time() < 1.8 * depth / c0 {
        let at = sim.system().solids()[1].kinematics.centre;
        sim.push(1, &force, &at);
        sim.step().unwrap();
        if sim.time() > 0.6 * depth / c0 {
            sum += sim.system().solids()[1].kinematics.velocity[1];
            count += 1;
        }
    }
    let speed = sum / f64::from(count);
    assert!((speed / -0.02 - 1.0).abs() < 0.03, "{speed} m/s where sound allows -0.02");
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
            sum += sim.contacts().iter().map(|(_, _, force)| force).sum::<f64>();
            count += 1;
        }
    }
    // Beneath the lid no water presses from above: as much more as the lid is broad and the box's top deep, 0.1 m.
    let exact = 1000.0 * G * ((1.0 - ratio) * 0.16 * 0.1 + 0.04 * 0.1);
    let found = sum / f64::from(count);
    assert!((found / exact - 1.0).abs() < 0.02, "{found} N/m for {exact} N/m");
}
