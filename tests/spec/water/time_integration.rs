//! Time integration: order of convergence, exact free fall, and the step size.

use pontoon::{
    coupling::stiffest_frequency,
    math::Vector,
    model::{Diffusion, Model, TimeScheme, Viscosity},
    simulation::Simulation,
    sph::viscosity::Laminar,
    time_integration::step_size,
};

use crate::common;

const SCHEMES: [TimeScheme; 2] = [TimeScheme::Verlet { euler_every: 1_000_000 }, TimeScheme::Symplectic];

/// A small drop that oscillates between round and flat, run with step `dt` until `until`.
fn drop(scheme: TimeScheme, dt: f64, until: f64) -> Simulation<2> {
    let dp = 0.02;
    let mut model = Model::water(2, dp, 0.2);
    (model.scheme, model.cfl, model.dt_max) = (scheme, 1e3, dt);
    (model.gravity, model.viscosity, model.diffusion) = (vec![0.0, 0.0], Viscosity::None, Diffusion::None);
    let mut sim = common::simulation(model, common::lattice([-0.1, -0.1], [0.2, 0.2], dp), 0.0, vec![]);
    sim.set_water_velocity(|r| Vector::from([-2.0 * r[0] + r[1], 2.0 * r[1] - r[0]]));
    while sim.time() < until {
        sim.step_to(until).expect("a calm drop");
    }
    sim
}

/// Largest differences of position and of density between corresponding particles of two runs.
fn apart(a: &Simulation<2>, b: &Simulation<2>) -> (f64, f64) {
    let (a, b) = (a.system().fluid(), b.system().fluid());
    let mut of_id = vec![0; b.len()];
    b.id.iter().enumerate().for_each(|(j, &id)| of_id[id as usize] = j);
    (0..a.len())
        .map(|i| (i, of_id[a.id[i] as usize]))
        .fold((0.0, 0.0), |(r, rho), (i, j)| ((a.r[i] - b.r[j]).norm().max(r), (a.rho[i] - b.rho[j]).abs().max(rho)))
}

#[test]
fn both_time_schemes_are_of_second_order() {
    for scheme in SCHEMES {
        let until = 0.02;
        let runs: Vec<_> = [2e-4, 1e-4, 5e-5].iter().map(|&dt| drop(scheme, dt, until)).collect();
        let (coarse, fine) = (apart(&runs[0], &runs[1]), apart(&runs[1], &runs[2]));
        // Halving the step quarters the difference: a ratio of 4, between 3 and 5 with the next order.
        for (name, ratio) in [("position", coarse.0 / fine.0), ("density", coarse.1 / fine.1)] {
            assert!((3.0..5.0).contains(&ratio), "{scheme:?}: {name} {ratio}");
        }
    }
}

#[test]
fn free_fall_is_exact_with_both_time_schemes() {
    for scheme in SCHEMES {
        let mut model = Model::water(2, 0.01, 0.1);
        model.scheme = scheme;
        let mut sim = common::simulation(model, vec![Vector::from([0.0, 0.0])], 0.0, vec![]);
        let until = 0.05;
        while sim.time() < until {
            sim.step_to(until).unwrap();
        }
        let fluid = sim.system().fluid();
        // Both schemes integrate a constant acceleration exactly: rounding only.
        assert!((fluid.r[0][1] + 0.5 * 9.81 * until * until).abs() < 1e-14, "{scheme:?}");
        assert!((fluid.v[0][1] + 9.81 * until).abs() < 1e-13, "{scheme:?}");
    }
}

#[test]
fn the_step_size_follows_the_limits_of_acceleration_sound_and_viscosity() {
    let model = Model::water(2, 0.01, 1.0);
    let mut sim = common::simulation(model.clone(), vec![Vector::from([0.0, 0.0])], 0.0, vec![]);
    sim.step().unwrap();
    // For a lone particle no pair approaches, and √(h/g) is far longer than h/c₀.
    assert_eq!(sim.dt(), model.cfl * (model.h / model.c0));
    // Morris' limit for laminar viscosity; the other two limits cover artificial viscosity.
    assert_eq!(model.viscosity.step_limit(model.h), f64::INFINITY);
    let thick = model.clone().viscosity(Viscosity::Laminar(Laminar { nu0: 0.5 }));
    assert_eq!(thick.viscosity.step_limit(model.h), model.h * model.h / 4.0);
    let peaks = pontoon::system::StepLimits { acceleration: 1e7, approach_rate: 0.0 };
    assert_eq!(step_size::fluid_step_limit(&peaks, sim.system().properties(), 0.2), 0.2 * (model.h / 1e7).sqrt());
    let peaks = pontoon::system::StepLimits { acceleration: 0.0, approach_rate: 100.0 };
    assert_eq!(
        step_size::fluid_step_limit(&peaks, sim.system().properties(), 0.2),
        0.2 * (model.h / (model.c0 + model.h * 100.0))
    );
}

#[test]
fn the_stiffest_frequency_of_a_body_falls_with_the_square_root_of_its_mass() {
    use pontoon::{geometry::Shape, solid::FreeBody};
    let dp = 0.01;
    let properties = Model::water(2, dp, 1.0).fluid_properties::<2>();
    let shape = Shape::Box { size: Vector::from([0.1, 0.1]) };
    let of = |density| stiffest_frequency(&shape, &FreeBody::from_density(&shape, density), &properties);
    assert!((of(10.0) / of(1000.0) - 10.0).abs() < 1e-9);
    // The box is ten dp wide. Its outer layer acts as 36 springs ρ₀ c₀², nine a side, with those of the corners along the
    // diagonals. Along an axis they sum to 18 on the mass 100 ρ dp². About the centre they sum to 4 Σ (i + ½)² over a
    // side of nine, 4·60 dp², on 100·100/6 ρ dp⁴, which is less.
    let omega = properties.c0 / dp * (18.0f64 / 100.0).sqrt();
    assert!((of(1000.0) / omega - 1.0).abs() < 0.02, "{}", of(1000.0) / omega);
}
