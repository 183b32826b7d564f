//! Crowds, tanks that move with all that is in them, and what must not depend on where one stands.

use std::path::Path;

use pontoon::{
    Result,
    geometry::Shape,
    math::{Bivector, Matrix, Pose, Vector, expression::Formula},
    model::{Model, PairLoopKind, TimeScheme, Walls},
    scene::Scene,
    simulation::{Setup, Simulation},
    solid::{Constraints, Load, PrescribedMotion, Role, SolidSpec, TimeFunction},
};

use crate::rig;

/// Boxes of several densities in rows above water 0.2 m deep in a tank 1.2 m long.
fn pile(count: usize) -> Simulation<2> {
    let dp = 0.02;
    let mut solids = vec![rig::tank([1.2, 1.2], dp)];
    for i in 0..count {
        let (row, column) = (i / 6, i % 6);
        let at = [0.15 + 0.17 * column as f64 + 0.02 * (row % 2) as f64, 0.3 + 0.12 * row as f64];
        let shape = Shape::Box { size: Vector::from([0.1, 0.08]) };
        let mut solid = rig::float(shape, at, [300.0, 600.0, 900.0, 1500.0][i % 4]);
        (solid.name, solid.friction) = (format!("box-{i}"), 0.4);
        solids.push(solid);
    }
    rig::simulation(Model::water(2, dp, 0.3), rig::lattice([0.0, 0.0], [1.2, 0.2], dp), 0.2, solids)
}

/// Kinetic and potential energy of water and bodies and compression of the water, J/m.
fn energy(sim: &Simulation<2>) -> f64 {
    let (system, fluid) = (sim.system(), sim.system().fluid());
    let one =
        |i: usize| 0.5 * fluid.v[i].norm_squared() + 9.81 * fluid.r[i][1] + system.compression_energy(fluid.rho[i]);
    let water: f64 = (0..fluid.len()).map(one).sum::<f64>() * system.particle_mass();
    let bodies = system.solids().iter().map(|solid| match &solid.spec.role {
        Role::Free(body) => {
            let now = &solid.kinematics;
            let turning = body.inertia[(0, 0)] * now.spin.axial()[0].powi(2);
            0.5 * (body.mass * now.velocity.norm_squared() + turning) + body.mass * 9.81 * now.centre[1]
        }
        _ => 0.0,
    });
    water + bodies.sum::<f64>()
}

#[test]
fn thirty_bodies_give_the_same_bits_on_one_thread_and_on_two() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut sim = pile(30);
            while sim.time() < 0.35 {
                sim.step_to(0.35).expect("a sound run");
            }
            assert!(sim.contacts().len() > 10, "they lie on one another: {}", sim.contacts().len());
            sim.save().expect("a state")
        })
    };
    assert!(run(1) == run(2));
}

#[test]
fn a_pile_of_thirty_settles_and_never_gains_energy() {
    let mut sim = pile(30);
    let (start, mut least) = (energy(&sim), f64::INFINITY);
    let mut most_gained: f64 = 0.0;
    while sim.time() < 3.0 {
        sim.step_to(3.0).expect("a sound run");
        let now = energy(&sim);
        least = least.min(now);
        most_gained = most_gained.max(now - least);
    }
    // Compression of boundary particles, which is not counted, comes and goes with the blows.
    let fallen = start - least;
    assert!(fallen > 20.0 && most_gained < 0.02 * fallen, "gained {most_gained} J/m of {fallen} J/m fallen");
    let solids = &sim.system().solids()[1..];
    let fastest = solids.iter().map(|solid| solid.kinematics.velocity.norm()).fold(0.0, f64::max);
    assert!(fastest < 0.3, "it has come to rest, but for what the waves move: {fastest} m/s");
    // The heavy lie on the bottom or on what lies there, at most some layers up; nothing is inside anything.
    for (i, a) in solids.iter().enumerate() {
        let centre = a.kinematics.centre;
        assert!(centre[1] > 0.03 && centre[0] > 0.03 && centre[0] < 1.17, "{}: {centre}", a.spec.name);
        for b in &solids[i + 1..] {
            let apart = (centre - b.kinematics.centre).norm();
            // Half heights of 0.04 m each, less a tenth of dp.
            assert!(apart > 0.078, "{} and {} are {apart} m apart", a.spec.name, b.spec.name);
        }
    }
}

#[test]
fn water_and_bodies_that_collide_in_free_space_keep_their_momentum() {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.3);
    (model.gravity, model.pair_loop, model.c0, model.scheme) =
        (vec![0.0, 0.0], PairLoopKind::Reference, 34.0, TimeScheme::Symplectic);
    let mut water = rig::lattice([-0.3, -0.2], [0.6, 0.4], dp);
    // A dry gap of one dp between them.
    let sizes = [[-0.06, 0.0], [0.06, 0.02]];
    water.retain(|r| sizes.iter().all(|at| (r - Vector::from(*at)).amax() > 0.051));
    let mut solids: Vec<SolidSpec<2>> =
        sizes.iter().map(|at| rig::float(Shape::Box { size: Vector::from([0.1, 0.1]) }, *at, 600.0)).collect();
    solids[1].name = "second".into();
    solids.iter_mut().for_each(|solid| (solid.friction, solid.restitution) = (0.3, 0.6));
    let mut sim = rig::simulation(model, water, -1.0, solids);
    sim.set_velocity(0, &Vector::from([3.0, 0.2]), &Bivector::from_axial(&[2.0]));
    sim.set_velocity(1, &Vector::from([-2.0, 0.0]), &Bivector::from_axial(&[-1.0]));
    sim.update_rates();
    let momentum = |sim: &Simulation<2>| {
        let bodies = sim.system().solids().iter().map(|solid| match &solid.spec.role {
            Role::Free(body) => solid.kinematics.velocity * body.mass,
            _ => Vector::zeros(),
        });
        rig::water_momentum(sim) + bodies.sum::<Vector<2>>()
    };
    let (start, scale, mut met) = (momentum(&sim), 6.0 * 3.0 + 6.0 * 2.0, 0);
    for _ in 0..600 {
        sim.step().expect("a sound run");
        met += sim.contacts().len();
    }
    assert!(met > 0, "they met");
    let off = (momentum(&sim) - start).norm() / scale;
    assert!(off < 1e-10, "{off:e}: the project's bound");
}

/// A drop in free space with two bodies inside, all of it moved to `pose` and, if `mirrored`, reflected in x before.
fn drop_at(pose: &Pose<2>, mirrored: bool, sweep: PairLoopKind) -> Simulation<2> {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.3);
    (model.gravity, model.pair_loop, model.c0, model.walls) = (vec![0.0, 0.0], sweep, 34.0, Walls::RelaxedAdami);
    let flip = if mirrored { Matrix::from_diagonal(&Vector::from([-1.0, 1.0])) } else { Matrix::identity() };
    let turn = pose.rotation * flip;
    let mut water = rig::lattice([-0.24, -0.2], [0.48, 0.4], dp);
    water.retain(|r| (r[0] + 0.1).abs() > 0.06 || r[1].abs() > 0.04);
    water.retain(|r| (r[0] - 0.1).abs() > 0.04 || (r[1] - 0.06).abs() > 0.04);
    let velocity = |r: &Vector<2>| Vector::from([0.5 - 2.0 * r[0] + r[1], 0.3 + 2.0 * r[1] - r[0]]);
    let place = |at: [f64; 2]| Pose { position: pose.position + turn * Vector::from(at), rotation: pose.rotation };
    let mut solids = vec![
        rig::float(Shape::Box { size: Vector::from([0.12, 0.08]) }, [0.0, 0.0], 600.0),
        rig::float(Shape::Box { size: Vector::from([0.08, 0.08]) }, [0.0, 0.0], 300.0),
    ];
    (solids[0].pose, solids[1].pose, solids[1].name) = (place([-0.1, 0.0]), place([0.1, 0.06]), "second".into());
    let moved: Vec<Vector<2>> = water.iter().map(|r| pose.position + turn * r).collect();
    let mut setup = Setup::new(model).water(moved, -1.0).solids(solids);
    setup.velocity = water.iter().map(|r| turn * velocity(r)).collect();
    Simulation::new(setup).expect("a sound setup")
}

#[test]
fn nothing_depends_on_where_one_stands_how_one_is_turned_or_on_a_mirror() {
    let quarter = Matrix::from_row_slice(&[0.0, -1.0, 1.0, 0.0]);
    let home = Pose::identity();
    for (sweep, bound) in [(PairLoopKind::Reference, 1e-9), (PairLoopKind::Fast, 1e-5)] {
        let run = |pose: &Pose<2>, mirrored: bool| {
            let mut sim = drop_at(pose, mirrored, sweep);
            for _ in 0..150 {
                sim.step().expect("a sound run");
            }
            [0, 1].map(|i| sim.system().solids()[i].kinematics)
        };
        let here = run(&home, false);
        let cases = [
            ("moved", Pose::at(Vector::from([3.0, -7.0])), false),
            ("turned", Pose { rotation: quarter, ..home }, false),
            ("mirrored", home, true),
        ];
        for (what, pose, mirrored) in cases {
            let there = run(&pose, mirrored);
            let flip = if mirrored { Matrix::from_diagonal(&Vector::from([-1.0, 1.0])) } else { Matrix::identity() };
            for (a, b) in here.iter().zip(&there) {
                let place = (pose.position + pose.rotation * flip * a.centre - b.centre).norm();
                let speed = (pose.rotation * flip * a.velocity - b.velocity).norm();
                let spin = a.spin.axial()[0] * if mirrored { -1.0 } else { 1.0 } - b.spin.axial()[0];
                // Round-off of f64, or of single precision in the sweep, and what 150 steps make of it, over 1 m/s.
                assert!(
                    place.max(speed).max(0.1 * spin.abs()) < bound,
                    "{sweep:?} {what}: {place:e} m {speed:e} m/s {spin:e}"
                );
            }
        }
    }
}

#[test]
fn water_in_a_tank_that_gains_speed_leans_by_a_over_g() {
    // From rest at 0.05 g: the surface swings about the slope a/g, its first mode with a period of 0.9 s. The slope is read from
    // the water's centre, which lies a/g · L²/(12 d) behind the middle of the tank.
    let (dp, length, depth) = (0.01, 0.4, 0.1);
    let slope = 0.05;
    let law = TimeFunction::Formula(Formula::parse(&format!("0.5*{slope}*9.81*t^2")).expect("a formula"));
    let mut tank = rig::tank([length, 0.25], dp);
    tank.role = Role::Driven(PrescribedMotion::slide(Vector::from([1.0, 0.0]), law));
    let mut model = Model::water(2, dp, depth);
    model.viscosity = pontoon::model::Viscosity::Artificial(pontoon::sph::viscosity::Artificial { alpha: 0.1 });
    let water = rig::lattice([0.0, 0.0], [length, depth], dp);
    let setup = Setup::new(model).water(water, depth).solid(tank).domain([-1.0, -1.0], [9.0, 2.0]);
    let mut sim = Simulation::new(setup).expect("a sound setup");
    let (mut sum, mut weight) = (0.0, 0.0);
    while sim.time() < 4.6 {
        sim.step_to(4.6).expect("a sound run");
        if sim.time() > 1.0 {
            let fluid = sim.system().fluid();
            let centre = fluid.r.iter().map(|r| r[0]).sum::<f64>() / fluid.len() as f64;
            let middle = sim.system().solids()[0].kinematics.pose.position[0] + 0.5 * length;
            sum += (middle - centre) * 12.0 * depth / (length * length) * sim.dt();
            weight += sim.dt();
        }
    }
    let found = sum / weight;
    assert!((found / slope - 1.0).abs() < 0.05, "{found}, exact {slope}: ten rows of water, means over four periods");
}

#[test]
fn a_float_in_a_tank_that_gains_speed_goes_with_it_and_lies_along_the_surface() -> Result<()> {
    let text = "dimension = 2\ndp = 0.01\nuntil = 3.0\nmodel.viscosity.artificial.alpha = 0.1\n\
        domain = { min = [-1, -1], max = [9, 2] }\nwater = [{ fill = { box = { min = [0, 0], max = [0.6, 0.12] } } }]\n\
        [[solid]]\nname = \"tank\"\nshape = { tank = { size = [0.6, 0.35] } }\n\
        driven = { along = [1, 0], distance = { formula = \"0.5*0.4905*t^2\" } }\n\
        [[solid]]\nname = \"float\"\nshape = { box = { size = [0.16, 0.04] } }\nfree = { density = 500 }\nat = { x = 0.3, draft = \"equilibrium\" }";
    let mut sim = Simulation::new(Scene::parse(text, Path::new(""), &[])?.build::<2>()?.setup)?;
    let (mut tilt, mut lag, mut weight) = (0.0, 0.0, 0.0);
    while sim.time() < 3.0 {
        sim.step_to(3.0)?;
        if sim.time() > 0.6 {
            let [tank, float] = [0, 1].map(|i| &sim.system().solids()[i].kinematics);
            tilt += float.pose.rotation_vector()[0] * sim.dt();
            lag += (tank.velocity[0] - float.velocity[0]) * sim.dt();
            weight += sim.dt();
        }
    }
    // It feels gravity g and −a, as the water does, and lies across their sum: a/g = 0.05 to the left.
    assert!((tilt / weight + 0.05).abs() < 0.0125, "{} rad: a quarter of dp over half its length", tilt / weight);
    assert!((lag / weight).abs() < 0.05, "it falls behind by {} m/s", lag / weight);
    Ok(())
}

#[test]
fn a_body_on_a_driven_floor_is_carried_as_far_as_friction_goes() -> Result<()> {
    use pontoon::solid::{Dim, FreeBody, HasEngine};
    // μ = 0.4 on a floor of 0.3 g, and of 0.5 g.
    for (floor, carried) in [(0.3, 0.3), (0.5, 0.4)] {
        let law = TimeFunction::Formula(Formula::parse(&format!("0.5*{}*t^2", floor * 9.81))?);
        let (slab, block) = (Vector::from([4.0, 0.5]), Vector::from([0.2, 0.1]));
        let motion = PrescribedMotion::slide(Vector::from([1.0, 0.0]), law);
        let block = Shape::Box { size: block };
        let mut solids = vec![
            rig::solid(
                "floor",
                Shape::Box { size: slab },
                Pose::at(Vector::from([0.0, -0.25])),
                Role::Driven(motion.clone()),
            ),
            rig::solid(
                "block",
                block.clone(),
                Pose::at(Vector::from([0.0, 0.05])),
                Role::Free(FreeBody::from_mass(&block, 2.0)),
            ),
        ];
        solids.iter_mut().for_each(|solid| solid.friction = 0.4);
        let start: Vec<_> = solids.iter().map(SolidSpec::initial_kinematics).collect();
        let mut engine = Dim::<2>::engine(&solids, &start, &Constraints::default(), &Vector::from([0.0, -9.81]), 0.01)?;
        let (dt, idle) = (2e-4, Load::zero());
        for step in 1..=2000 {
            let then = motion.kinematics(&solids[0].pose, dt * f64::from(step));
            engine.step(dt, &[idle; 2], &[Some(then), None]).expect("a sound step");
        }
        let gained = engine.kinematics(1).velocity[0] / (2000.0 * dt * 9.81);
        // The first contact takes some steps.
        assert!((gained / carried - 1.0).abs() < 0.01, "floor {floor} g: block {gained} g");
    }
    Ok(())
}

#[test]
fn a_body_that_tumbles_in_a_vacuum_for_ten_seconds_keeps_energy_and_angular_momentum() -> Result<()> {
    use pontoon::solid::{Dim, FreeBody, HasEngine};
    let shape = Shape::Box { size: Vector::repeat(0.1) };
    let inertia = Matrix::<3>::from_diagonal(&Vector::from([1e-3, 2e-3, 2.5e-3]));
    let spin = Vector::<3>::from([1.0, 8.0, 2.0]);
    let body = FreeBody::from_mass(&shape, 2.0).inertia(inertia).spin(Bivector::from_axial(spin.as_slice()));
    let brick = rig::solid("brick", shape, Pose::identity(), Role::Free(body));
    let mut engine = Dim::<3>::engine(
        std::slice::from_ref(&brick),
        &[brick.initial_kinematics()],
        &Constraints::default(),
        &Vector::zeros(),
        0.01,
    )?;
    let (momentum, energy) = (inertia * spin, spin.dot(&(inertia * spin)));
    let mut worst: f64 = 0.0;
    for _ in 0..50_000 {
        let idle = Load::zero();
        engine.step(2e-4, &[idle], &[None]).expect("a sound step");
        let now = engine.kinematics(0);
        let spin = Vector::<3>::from_column_slice(&now.spin.axial());
        let turned = now.pose.rotation * inertia * now.pose.rotation.transpose() * spin;
        worst = worst.max((turned.dot(&spin) / energy - 1.0).abs());
        // Angular momentum is what is integrated: round-off.
        let off = (turned - momentum).norm() / momentum.norm();
        assert!(off < 1e-9, "{off:e}");
    }
    // Second order in Δt, about (8 rad/s · Δt)²/12 = 2e-7, which comes and goes; the project's bound is 1e-6.
    assert!(worst < 1e-6, "{worst:e}");
    Ok(())
}
