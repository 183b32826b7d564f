//! Load breakdown of constrained, rotating bodies in three dimensions: forces and torques sum to the change of momentum.

use std::path::Path;

use pontoon::{Result, scene::Scene, simulation::Simulation, solid::Load};

use crate::common;

/// Bodies above a small pool: two spinning bars, the upper on an inclined hinge and the lower on a ball joint below it; a brick that
/// swings on a rope; a plate on a ball joint with rotation about x locked; and a sled on a rail.
const MOBILE: &str = r#"
dimension = 3
dp        = 0.05
until     = 1.0
domain    = { min = [-3.0, -3.0, -1.0], max = [4.0, 4.0, 5.0] }

[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [0.3, 0.3, 0.2] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [0.3, 0.3, 0.3] } }

[[solid]]
name  = "upper"
shape = { box = { size = [0.1, 0.05, 0.3] } }
at    = { x = 0.15, y = 0.15, z = 2.0, turn_deg = [0.0, 40.0, 0.0] }
free  = { density = 600.0, inertia = [0.02, 0.05, 0.04] }

[[solid]]
name  = "lower"
shape = { box = { size = [0.08, 0.06, 0.3] } }
at    = { x = 0.15, y = 0.15, z = 1.6, turn_deg = [20.0, 0.0, 10.0] }
free  = { density = 700.0, spin = [0.0, 1.0, 3.0] }

[[solid]]
name  = "brick"
shape = { box = { size = [0.2, 0.1, 0.05] } }
at    = { x = 1.5, y = 0.0, z = 2.0 }
free  = { density = 900.0, spin = [1.0, 8.0, 2.0], velocity = [0.0, 0.5, 0.0] }

[[solid]]
name  = "plate"
shape = { box = { size = [0.2, 0.3, 0.05] } }
at    = { x = -1.0, y = 0.0, z = 2.0 }
free  = { density = 500.0, spin = [0.0, 2.0, 1.0], locked = ["turn_x"] }

[[solid]]
name  = "sled"
shape = { box = { size = [0.1, 0.1, 0.1] } }
at    = { x = 0.0, y = 2.0, z = 2.0 }
free  = { density = 500.0 }

[[joint]]
name    = "pin"
kind    = "hinge"
between = ["upper"]
at      = [0.15, 0.15, 2.2]
axis    = [0.0, 1.0, 0.2]

[[joint]]
name    = "knee"
kind    = "ball"
between = ["lower", "upper"]
at      = [0.15, 0.15, 1.8]

[[joint]]
name    = "corner"
kind    = "ball"
between = ["plate"]
at      = [-0.9, 0.1, 2.0]

[[joint]]
name    = "rail"
kind    = "slider"
between = ["sled"]
at      = [0.1, 2.1, 2.0]
along   = [1.0, 0.5, 0.2]
motor   = { damping = 3.0 }

[[rope]]
name    = "tether"
between = ["brick"]
from    = [1.6, 0.05, 2.0]
to      = [1.6, 0.05, 2.3]

[[force]]
name   = "twist"
on     = "lower"
torque = ["0.2*sin(20*t)", 0.0, 0.1]
"#;

/// The largest force (N) and torque (N m) among loads.
fn largest(loads: &[Load<3>]) -> (f64, f64) {
    let size = |x: &Load<3>| (x.force.norm(), x.torque.axial().iter().map(|t| t * t).sum::<f64>().sqrt());
    loads.iter().map(size).fold((0.0, 0.0), |most, one| (most.0.max(one.0), most.1.max(one.1)))
}

#[test]
fn loads_on_constrained_spinning_bodies_sum_to_zero_in_every_step() -> Result<()> {
    let mut sim = common::scene_simulation::<3>(MOBILE)?;
    sim.enable_load_breakdown();
    let mut turned = 0.0f64;
    for step in 0..250 {
        sim.step()?;
        for i in 1..6 {
            let (shares, name) = (sim.load_breakdown(i).unwrap(), &sim.system().solids()[i].spec.name);
            let (force, torque) = largest(&shares.kinds().map(|(_, load)| load));
            let off = largest(&[shares.residual()]);
            // Round-off of I Ω/Δt and of the constraint reactions: 1e-9 of the largest kind of load. Torques are compared with an arm of
            // 10 mm at least, for bodies with small torques.
            assert!(off.0 < 1e-9 * force, "step {step}, {name}: {:e} N of {force} N", off.0);
            let scale = torque.max(0.01 * force);
            assert!(off.1 < 1e-9 * scale, "step {step}, {name}: {:e} N m of {scale} N m", off.1);
        }
        turned = turned.max(largest(&[sim.load_breakdown(2).unwrap().change]).1);
    }
    assert!(turned > 0.1, "the torque on the lower bar is at most {turned} N m");
    assert!(sim.rope_reading(0).tension > 0.0 && sim.joint_reading(3).motor_force != 0.0, "rope and motor carry load");
    Ok(())
}

#[test]
fn the_change_term_of_a_constrained_body_equals_its_angular_momentum_change_to_first_order() -> Result<()> {
    // Over 50 ms, in N m s: Σ change Δt against I Ω at both ends, in the world's axes.
    let off = |dt_max: &str| -> Result<(f64, f64)> {
        let sets = [("time.dt_max".to_string(), dt_max.to_string())];
        let mut sim = Simulation::new(Scene::parse(MOBILE, Path::new(""), &sets)?.build::<3>()?.setup)?;
        sim.enable_load_breakdown();
        let momentum = |sim: &Simulation<3>| {
            let solid = &sim.system().solids()[2];
            let pontoon::solid::Role::Free(body) = &solid.spec.role else { panic!("it is free") };
            let turn = solid.kinematics.pose.rotation;
            let spin = pontoon::math::Vector::<3>::from_iterator(solid.kinematics.spin.axial());
            turn * body.inertia * turn.transpose() * spin
        };
        let before = momentum(&sim);
        let mut sum = pontoon::math::Vector::<3>::zeros();
        while sim.time() < 0.05 {
            sim.step_to(0.05)?;
            let change = sim.load_breakdown(2).unwrap().change.torque.axial();
            sum += pontoon::math::Vector::<3>::from_iterator(change) * sim.dt();
        }
        let gained = momentum(&sim) - before;
        Ok(((sum - gained).norm(), gained.norm()))
    };
    let ((coarse, gained), (fine, _)) = (off("1e-3")?, off("2.5e-4")?);
    assert!(coarse < 0.02 * gained, "{coarse} of {gained} N m s");
    // First order: a quarter of the step leaves a quarter of the error.
    assert!((0.15..0.35).contains(&(fine / coarse)), "{fine} after {coarse} N m s");
    Ok(())
}

/// A box with acoustic added mass, and with locked surge and pitch, under a force along x.
const LOCKED: &str = r#"
dimension = 2
dp        = 0.02
until     = 0.3

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.6] } }

[[solid]]
name  = "box"
shape = { box = { size = [0.4, 0.2] } }
at    = { x = 0.5, draft = "equilibrium" }
free  = { density = 300, locked = ["x", "turn"] }

[[force]]
name  = "push"
on    = "box"
force = [30.0, 0.0]
"#;

#[test]
fn locks_of_a_light_body_bear_the_whole_load_along_locked_motions_at_once() -> Result<()> {
    let mut sim = common::scene_simulation::<2>(LOCKED)?;
    sim.enable_load_breakdown();
    for step in 0..50 {
        sim.step()?;
        let shares = sim.load_breakdown(1).unwrap();
        let water = shares.pressure.force[0] + shares.viscous.force[0];
        // Round-off of pressures: the hydrostatic force on one side is 24 N.
        assert!(shares.delayed.force[0].abs() < 1e-9, "step {step}: {} N are delayed", shares.delayed.force[0]);
        assert!((shares.locks.force[0] + 30.0 + water).abs() < 1e-9, "step {step}: {:?}", shares.locks);
        assert_eq!(shares.delayed.torque.axial()[0], 0.0, "step {step}");
        let (force, torque) = (shares.residual().force.norm(), shares.residual().torque.axial()[0].abs());
        assert!(force < 1e-9 && torque < 1e-9, "step {step}: {:?}", shares.residual());
    }
    Ok(())
}
