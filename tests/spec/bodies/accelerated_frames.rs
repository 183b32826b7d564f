//! Accelerated tanks and floors: the slope of the free surface, a float on it, and a body carried by friction.

use pontoon::{
    Result,
    geometry::Shape,
    math::{Pose, Vector, expression::Formula},
    model::Model,
    probe::{EnergyBudgetProbe, EnergyProbe, Probe},
    simulation::{Setup, Simulation},
    solid::{Constraints, Dim, FreeBody, HasEngine, Load, PrescribedMotion, Role, SolidSpec, TimeFunction},
};

use crate::common;

#[test]
fn the_free_surface_in_an_accelerated_tank_has_the_slope_a_over_g() {
    // The tank starts from rest with 0.05 g. The surface oscillates about the slope a/g with the 0.9 s period of its first mode.
    // The centre of mass of the water lies a/g · L²/(12 d) behind the middle of the tank, which gives the slope.
    let (dp, length, depth) = (0.01, 0.4, 0.1);
    let slope = 0.05;
    let law = TimeFunction::Formula(Formula::parse(&format!("0.5*{slope}*9.81*t^2")).expect("a formula"));
    let mut tank = common::tank([length, 0.25], dp);
    tank.role = Role::Driven(PrescribedMotion::slide(Vector::from([1.0, 0.0]), law));
    let mut model = Model::water(2, dp, depth);
    model.viscosity = pontoon::model::Viscosity::Artificial(pontoon::sph::viscosity::Artificial { alpha: 0.1 });
    let water = common::lattice([0.0, 0.0], [length, depth], dp);
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
    assert!(
        (found / slope - 1.0).abs() < 0.05,
        "slope {found}, exact {slope}; ten rows of water, mean over four periods"
    );
}

#[test]
fn a_float_in_an_accelerated_tank_moves_with_it_and_is_parallel_to_the_surface() -> Result<()> {
    let text = "dimension = 2\ndp = 0.01\nuntil = 3.0\nmodel.viscosity.artificial.alpha = 0.1\n\
        domain = { min = [-1, -1], max = [9, 2] }\nwater = [{ fill = { box = { min = [0, 0], max = [0.6, 0.12] } } }]\n\
        [[solid]]\nname = \"tank\"\nshape = { tank = { size = [0.6, 0.35] } }\n\
        driven = { along = [1, 0], distance = { formula = \"0.5*0.4905*t^2\" } }\n\
        [[solid]]\nname = \"float\"\nshape = { box = { size = [0.16, 0.04] } }\nfree = { density = 500 }\nat = { x = 0.3, draft = \"equilibrium\" }";
    let mut sim = common::scene_simulation::<2>(text)?;
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
    // In the frame of the tank g and −a act on float and water alike, so the float tilts by a/g = 0.05 to the left.
    assert!(
        (tilt / weight + 0.05).abs() < 0.0125,
        "tilt {} rad; the bound is a quarter of dp over half the length of the float",
        tilt / weight
    );
    assert!((lag / weight).abs() < 0.05, "the float lags by {} m/s", lag / weight);
    Ok(())
}

#[test]
fn a_block_on_an_accelerated_floor_gains_at_most_the_acceleration_that_friction_allows() -> Result<()> {
    // μ = 0.4 on a floor that accelerates with 0.3 g and with 0.5 g.
    for (floor, carried) in [(0.3, 0.3), (0.5, 0.4)] {
        let law = TimeFunction::Formula(Formula::parse(&format!("0.5*{}*t^2", floor * 9.81))?);
        let (slab, block) = (Vector::from([4.0, 0.5]), Vector::from([0.2, 0.1]));
        let motion = PrescribedMotion::slide(Vector::from([1.0, 0.0]), law);
        let block = Shape::Box { size: block };
        let mut solids = vec![
            common::solid(
                "floor",
                Shape::Box { size: slab },
                Pose::at(Vector::from([0.0, -0.25])),
                Role::Driven(motion.clone()),
            ),
            common::solid(
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
        // The contact needs some steps to form.
        assert!((gained / carried - 1.0).abs() < 0.01, "floor {floor} g: block {gained} g");
    }
    Ok(())
}

/// A barge afloat in a towed frame keeps its place over the ground and its height: its potential energy stays within that of a rise by 0.1 dp,
/// also where the towing stops to accelerate. The frame gives water and barge the energy of their motion, ½ m V², in `driven`, and the
/// budget closes within 0.5 % of it.
#[test]
fn towing_a_frame_gives_no_potential_energy_to_a_float() -> Result<()> {
    let text = "dimension = 2\ndp = 0.02\nuntil = 1.5\ntowed = { along = \"x\", velocity = \"0.3*min(t,1)\" }\n\
        periodic = { x = [0.0, 1.0] }\ndomain = { min = [-9, -2], max = [9, 5] }\n\
        water = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.2] } } }]\n\
        [[solid]]\nname = \"bed\"\nfixed = true\nshape = { box = { size = [2.0, 0.1] } }\nat = [0.5, -0.05]\n\
        [[contact]]\nbetween = [\"barge\"]\ntouch = false\n\
        [[solid]]\nname = \"barge\"\nshape = { box = { size = [0.3, 0.16] } }\nat = { x = 0.5, draft = \"equilibrium\" }\nfree = { density = 500 }";
    let mut sim = common::scene_simulation::<2>(text)?;
    sim.enable_energy_budget();
    let (energy, budget) = (EnergyProbe::new(sim.system()), EnergyBudgetProbe::new(sim.system()));
    let mass = sim.system().solids()[1].body.as_ref().expect("a body").mass;
    let mut most: f64 = 0.0;
    while sim.time() < 1.5 {
        sim.step_to(1.5)?;
        most = most.max(energy.sample(&sim)[4].abs());
    }
    assert!(most < mass * 9.81 * 0.002, "{most} J/m of {} J/m", mass * 9.81 * 0.002);
    let all = mass + sim.system().fluid().len() as f64 * sim.system().particle_mass();
    let moving = 0.5 * all * 0.3 * 0.3;
    let driven = sim.energy_budget().expect("it is recorded").driven;
    assert!((driven / moving - 1.0).abs() < 0.02, "{driven} J/m of {moving} J/m");
    let residual = budget.sample(&sim).last().expect("a residual").abs();
    assert!(residual < 0.005 * moving, "{residual} J/m of {moving} J/m remain");
    Ok(())
}
