//! Determinism: the same bits on any number of threads and after a restart, and refusal of damaged checkpoints.

use pontoon::{
    geometry::Shape,
    math::{Pose, Vector, expression::Formula},
    model::{Model, PressureGradient, Shifting, TimeScheme, Viscosity, Walls},
    simulation::Simulation,
    solid::{PrescribedMotion, Role, TimeFunction},
    sph::{particle_shifting::Shift, viscosity::Sps},
};

use crate::common;

/// Both time schemes, wall models and pressure gradients.
const KINDS: [(TimeScheme, Walls, PressureGradient); 5] = [
    (TimeScheme::Symplectic, Walls::Dynamic, PressureGradient::Plain),
    (TimeScheme::Verlet { euler_every: 50 }, Walls::Dynamic, PressureGradient::Plain),
    (TimeScheme::Symplectic, Walls::RelaxedAdami, PressureGradient::Plain),
    (TimeScheme::Symplectic, Walls::RelaxedAdami, PressureGradient::Corrected),
    (TimeScheme::Symplectic, Walls::RelaxedAdami, PressureGradient::NearSurface),
];

/// A dam break onto two colliding floats, one as light as foam, beside a paddle, with every term that keeps state between steps.
fn scene((scheme, walls, gradient): (TimeScheme, Walls, PressureGradient)) -> Simulation<2> {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.3);
    (model.scheme, model.cfl, model.walls) = (scheme, 0.2, walls);
    (model.viscosity, model.gradient) = (Viscosity::Sps(Sps::default()), gradient);
    if gradient == PressureGradient::Plain {
        model.shifting = Shifting::AwayFromFixed(Shift::default());
    }
    let mut water = common::lattice([0.1, 0.0], [0.5, 0.3], dp);
    water.extend(common::lattice([0.6, 0.0], [0.8, 0.1], dp));
    let mut second = common::float(Shape::Ball { radius: 0.06 }, [1.16, 0.17], 30.0);
    second.name = "second".into();
    let paddle = PrescribedMotion::slide(
        Vector::from([1.0, 0.0]),
        TimeFunction::Formula(Formula::parse("0.02*sin(9*t)").unwrap()),
    );
    let paddle_shape = Shape::Box { size: Vector::from([0.08, 0.6]) };
    let solids = vec![
        common::tank([1.4, 0.6], dp),
        common::float(Shape::Box { size: Vector::from([0.2, 0.1]) }, [1.0, 0.16], 500.0),
        second,
        common::solid("paddle", paddle_shape, Pose::at(Vector::from([0.05, 0.31])), Role::Driven(paddle)),
    ];
    common::simulation(model, water, 0.3, solids)
}

#[test]
fn one_two_three_and_eight_threads_compute_the_same_bits() {
    for kind in KINDS {
        let runs: Vec<Vec<u8>> = [1, 2, 3, 8]
            .into_iter()
            .map(|n| {
                common::on_threads(n, || {
                    let mut sim = scene(kind);
                    common::steps(&mut sim, 150);
                    sim.save().unwrap()
                })
            })
            .collect();
        assert!(runs.iter().all(|run| *run == runs[0]), "{kind:?}");
    }
}

#[test]
fn a_resumed_run_reaches_the_same_bits() {
    for kind in KINDS {
        let mut whole = scene(kind);
        common::steps(&mut whole, 73);
        let saved = whole.save().unwrap();
        common::steps(&mut whole, 120);
        let mut resumed = scene(kind);
        resumed.restore(&saved).unwrap();
        assert_eq!(resumed.save().unwrap(), saved, "a restored state saves to the same bytes");
        common::steps(&mut resumed, 120);
        assert!(resumed.save().unwrap() == whole.save().unwrap(), "{kind:?}");
    }
}

#[test]
fn a_damaged_checkpoint_is_refused() {
    let sim = scene(KINDS[0]);
    let saved = sim.save().unwrap();
    let mut other = scene(KINDS[0]);
    assert!(other.restore(&saved[..saved.len() / 2]).is_err());
    assert!(other.restore(&[]).is_err());
    // Eight bytes at a time become a number that is not finite or far too large. The result is an error or a valid state, no panic.
    for wrong in [f64::NAN, f64::INFINITY, 1e99, -1e15] {
        for at in (0..saved.len() - 8).step_by(saved.len() / 300) {
            let mut bytes = saved.clone();
            bytes[at..at + 8].copy_from_slice(&wrong.to_le_bytes());
            let _ = other.restore(&bytes);
        }
    }
    // The first position, after the number of particles.
    let places = saved.windows(8).position(|b| b == sim.system().fluid().r[0][0].to_le_bytes()).unwrap();
    let far = [&saved[..places], &1e15f64.to_le_bytes(), &saved[places + 8..]].concat();
    assert!(other.restore(&far).is_err_and(|e| e.message.contains("nowhere")));
}
