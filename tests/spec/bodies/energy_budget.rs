//! Load breakdown and energy budget: they close, and enabling them changes no bit of the run.

use std::path::Path;

use pontoon::{
    geometry::Shape,
    math::{Bivector, Vector},
    probe::{EnergyBudgetProbe, Probe},
    scene::Scene,
    simulation::{Dimension, Simulation},
    solid::{Dim, Load, Role},
};

use crate::common;

/// A tank with bodies in contact, on a hinge, a spring and a rope, and under an external force.
const SCENE: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
water = [{ fill = { box = { min = [0.0, 0.0], max = [1.6, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.6, 0.6] } }
[[solid]]
name = "raft"
shape = { box = { size = [0.3, 0.08] } }
at = { x = 0.4, draft = 0.05 }
free = { density = 400.0 }
[[solid]]
name = "crate"
shape = { box = { size = [0.08, 0.08] } }
at = { x = 0.43, bottom = 0.335 }
free = { density = 200.0, velocity = [0.1, 0.0] }
[[solid]]
name = "stone"
shape = { box = { size = [0.08, 0.08] } }
at = { x = 0.9, bottom = 0.002 }
free = { density = 2500.0, velocity = [-0.3, 0.0] }
restitution = 0.3
[[solid]]
name = "buoy"
shape = { ball = { radius = 0.08 } }
at = { x = 1.2, draft = "equilibrium" }
free = { density = 500.0, locked = ["turn"] }
[[solid]]
name = "flap"
shape = { box = { size = [0.06, 0.2] } }
at = { x = 1.45, y = 0.25 }
free = { density = 300.0, release = 0.05 }
[[joint]]
name = "hinge"
kind = "hinge"
between = ["flap"]
at = [1.45, 0.15]
motor = { damping = 3.0 }
[[spring]]
name = "mooring"
between = ["buoy"]
from = [1.2, 0.3]
to = [1.1, 0.0]
stiffness = 300.0
damping = 4.0
[[rope]]
name = "tether"
between = ["raft"]
from = [0.25, 0.3]
to = [0.25, 0.36]
[[force]]
name = "wind"
on = "raft"
force = [4.0, 0.0]
"#;

fn simulation(model: &str) -> Simulation<2> {
    let text = format!("{SCENE}\n[model]\n{model}");
    let scene = Scene::parse(&text, Path::new(""), &[]).expect("a sound scene");
    Simulation::new(scene.build::<2>().expect("a sound scene").setup).expect("a sound setup")
}

/// Relative residual of the load breakdown of solid number `i` in the last step: the larger of those of force and torque.
fn relative_residual(sim: &Simulation<2>, i: usize) -> f64 {
    let shares = sim.load_breakdown(i).unwrap();
    let force = shares.kinds().iter().fold(0.0f64, |most, (_, load)| most.max(load.force.norm()));
    // The bodies are 0.1 m large, so torques far below a hundredth of a metre times the force are round-off of the force.
    let turning = shares.kinds().iter().fold(0.01 * force, |most, (_, load)| most.max(torque(load)));
    let off = shares.residual();
    (off.force.norm() / force).max(torque(&off) / turning)
}

#[test]
fn the_loads_on_every_body_sum_to_the_change_of_its_momentum() {
    // Round-off of sums over some hundred particles and of the engine: 1e-9 of the largest kind of load.
    for model in
        ["", "slip = \"partial\"", "walls = \"dbc\"\nviscosity = { laminar = { nu0 = 1e-4 } }\nslip = \"none\""]
    {
        let mut sim = simulation(model);
        sim.enable_load_breakdown();
        let mut seen = [false; 14];
        for step in 0..400 {
            sim.step().unwrap();
            // The readings of hinge and rope equal their loads. In a step of several iterations, with contacts between bodies of
            // different mass, the constraints rotate during the step: 1e-3 as the rope becomes taut.
            let (hinged, hung) = (sim.load_breakdown(5).unwrap(), sim.load_breakdown(1).unwrap());
            for (constraints, reading, weight) in [
                (hinged.joints, sim.joint_reading(0).force.norm(), hinged.weight),
                (hung.ropes, sim.rope_reading(0).tension, hung.weight),
            ] {
                let (force, round_off) = (constraints.force.norm(), 1e-12 * weight.force.norm());
                assert!(
                    (force - reading).abs() <= 1e-3 * force + round_off,
                    "{model}, {step}: {force} N, reading {reading} N"
                );
            }
            for i in 1..6 {
                let off = relative_residual(&sim, i);
                assert!(off < 1e-9, "{model}, step {step}, solid {i}: {off:e}");
                for (seen, (_, load)) in seen.iter_mut().zip(sim.load_breakdown(i).unwrap().kinds()) {
                    *seen |= load.force.norm() + torque(&load) > 0.0;
                }
            }
        }
        let kinds = sim.load_breakdown(1).unwrap().kinds().map(|(kind, _)| kind);
        let absent: Vec<_> = kinds.into_iter().zip(seen).filter(|(_, seen)| !seen).map(|(kind, _)| kind).collect();
        let inviscid = |kind: &str| kind == "viscous" && model.is_empty();
        let of_other_tests = ["delayed", "pushes", "moorings", "ballast"];
        assert!(absent.iter().all(|kind| of_other_tests.contains(kind) || inviscid(kind)), "{model}: {absent:?}");
    }
}

#[test]
fn loads_with_joints_and_ropes_but_without_contacts_sum_to_round_off() {
    let mut text = SCENE.to_string();
    for name in ["crate", "stone"] {
        let start = text.find(&format!("[[solid]]\nname = \"{name}\"")).unwrap();
        let end = start + 1 + text[start + 1..].find("[[solid]]").unwrap();
        text.replace_range(start..end, "");
    }
    let scene = Scene::parse(&text, Path::new(""), &[]).expect("a sound scene");
    let mut sim = Simulation::new(scene.build::<2>().expect("a sound scene").setup).expect("a sound setup");
    sim.enable_load_breakdown();
    for step in 0..1500 {
        sim.step().unwrap();
        for i in 1..4 {
            let off = relative_residual(&sim, i);
            assert!(off < 1e-9, "step {step}, solid {i}: {off:e}");
        }
    }
    assert!(sim.rope_reading(0).tension + sim.joint_reading(0).force.norm() > 0.0, "the constraints carry load");
}

fn torque(load: &Load<2>) -> f64 {
    load.torque.axial()[0].abs()
}

/// Residual of the energy budget after a run of `steps`, and the sum of the magnitudes of its entries, J.
fn residual<const D: usize>(mut sim: Simulation<D>, steps: usize) -> (f64, f64)
where
    Dim<D>: Dimension<D>,
{
    sim.enable_energy_budget();
    let probe = EnergyBudgetProbe::new(sim.system());
    for _ in 0..steps {
        sim.step().unwrap();
    }
    let row = probe.sample(&sim);
    let turnover = sim.energy_budget().unwrap().entries().iter().map(|(_, energy)| energy.abs()).sum::<f64>();
    (row[row.len() - 1].abs(), turnover)
}

#[test]
fn the_energy_budget_closes() {
    // The bound is 1 % of the sum of the entries; the time step is of second order.
    let shifting = "shifting = { everywhere = { a = 2.0 } }\nviscosity = { sps = { nu0 = 1e-6 } }";
    for model in ["", "walls = \"dbc\"", "slip = \"partial\"", "gradient = \"corrected\"", shifting] {
        let (off, turnover) = residual(simulation(model), 3000);
        assert!(off < 0.01 * turnover, "{model}: {off} J of {turnover} J");
    }
}

/// A plate of 0.4 dp that is driven through the water, a tray with walls of 0.6 dp that falls into it, and a tank of 1.2 dp. The bound is
/// that of thick parts.
#[test]
fn the_energy_budget_closes_beside_thin_parts_in_3d() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec/run/restart/thin.toml");
    let sim = Simulation::new(Scene::read(&file, &[]).unwrap().build::<3>().unwrap().setup).unwrap();
    let (off, turnover) = residual(sim, 400);
    assert!(off < 0.01 * turnover, "{off} J of {turnover} J");
}

/// Within the bound of the others. The water on each side of the plate acts with its own pressure, once a step.
#[test]
fn the_energy_budget_closes_beside_a_thin_plate_in_2d() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spec/run/restart/thin-sides.toml");
    let sim = Simulation::new(Scene::read(&file, &[]).unwrap().build::<2>().unwrap().setup).unwrap();
    let (off, turnover) = residual(sim, 400);
    assert!(off < 0.01 * turnover, "{off} J of {turnover} J");
}

#[test]
fn added_and_removed_solids_and_water_enter_the_energy_budget() {
    let mut sim = simulation("");
    sim.enable_energy_budget();
    let probe = EnergyBudgetProbe::new(sim.system());
    let residual = |sim: &Simulation<2>| probe.sample(sim).last().copied().unwrap_or(f64::NAN);
    for _ in 0..300 {
        sim.step().unwrap();
    }
    let before = residual(&sim);
    // The body is added with velocity and spin, half under water, and displaces water.
    let shape = Shape::Box { size: Vector::from([0.1, 0.1]) };
    let mut late = common::float(shape, [0.7, 0.3], 700.0);
    let Role::Free(body) = &mut late.role else { panic!("a free body") };
    (body.velocity, body.spin) = (Vector::from([0.3, 0.2]), Bivector::from_axial(&[4.0]));
    late.name = "late".into();
    let brought = 7.0 * (0.5 * 0.13 + 9.81 * 0.3) + 0.5 * (7.0 * 0.02 / 12.0) * 16.0;
    let added = sim.add_solid(late).unwrap();
    assert!(added.displaced > 0);
    let budget = *sim.energy_budget().unwrap();
    assert!((budget.solids / brought - 1.0).abs() < 1e-12, "{} J/m of {brought}", budget.solids);
    // About 12 particles of 0.4 kg/m, 0.27 m above the bottom.
    assert!(budget.removed < -0.3 * 9.81 * 0.24 * added.displaced as f64 * 0.4, "{} J/m", budget.removed);
    // The addition itself changes the residual by round-off only.
    assert!((residual(&sim) - before).abs() < 1e-9 * brought);
    for _ in 0..300 {
        sim.step().unwrap();
    }
    let before = residual(&sim);
    sim.remove_solid(added.solid).unwrap();
    assert!((residual(&sim) - before).abs() < 1e-9 * brought);
    for _ in 0..300 {
        sim.step().unwrap();
    }
    let turnover = sim.energy_budget().unwrap().entries().iter().map(|(_, energy)| energy.abs()).sum::<f64>();
    // The bound is that of a run without added solids.
    assert!(residual(&sim).abs() < 0.01 * turnover, "{} J of {turnover} J", residual(&sim));
}

#[test]
fn load_breakdown_and_energy_budget_change_no_bit_and_continue_after_a_restart() {
    let (mut plain, mut recorded) = (simulation(""), simulation(""));
    recorded.enable_energy_budget();
    recorded.enable_load_breakdown();
    for _ in 0..100 {
        plain.step().unwrap();
        recorded.step().unwrap();
    }
    assert_eq!(plain.system().fluid().r, recorded.system().fluid().r);
    assert_eq!(plain.system().solids()[1].kinematics, recorded.system().solids()[1].kinematics);
    let mut again = simulation("");
    again.enable_energy_budget();
    again.enable_load_breakdown();
    again.restore(&recorded.save().unwrap()).unwrap();
    for _ in 0..37 {
        recorded.step().unwrap();
        again.step().unwrap();
    }
    assert_eq!(recorded.energy_budget(), again.energy_budget());
    assert_eq!(recorded.load_breakdown(2), again.load_breakdown(2));
    assert!(
        plain.restore(&recorded.save().unwrap()).is_err(),
        "a checkpoint with a budget is refused by a simulation without one"
    );
}
