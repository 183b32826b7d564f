//! Probes: readings of known fields, and no effect on the run.

use pontoon::{
    Result,
    geometry::Shape,
    math::{Bivector, Vector},
    model::Model,
    probe::{ElevationProbe, EnergyProbe, ForceProbe, FrontProbe, MotionProbe, PressureProbe, Probe, VelocityProbe},
    simulation::Simulation,
};

use crate::common;

const DP: f64 = 0.02;

/// Still water 0.4 m wide and 0.2 m deep in a tank.
fn pool() -> Simulation<2> {
    let water = common::lattice([0.0, 0.0], [0.4, 0.2], DP);
    common::simulation(Model::water(2, DP, 0.2), water, 0.2, vec![common::tank([0.4, 0.4], DP)])
}

/// A pool with a body in the air above the water.
fn body_in_air() -> Simulation<2> {
    let water = common::lattice([0.0, 0.0], [0.4, 0.1], DP);
    let body = common::float(Shape::Box { size: Vector::from([0.1, 0.06]) }, [0.2, 0.3], 500.0);
    common::simulation(Model::water(2, DP, 0.1), water, 0.1, vec![common::tank([0.4, 0.4], DP), body])
}

#[test]
fn the_velocity_probe_reads_a_linear_field_exactly_at_a_point_of_symmetry() -> Result<()> {
    let mut sim = pool();
    sim.set_water_density(|_| 1000.0);
    sim.set_water_velocity(|r| Vector::from([1.0 + 2.0 * r[0] - r[1], 3.0 * r[1]]));
    let reading = VelocityProbe::<2>::new(&[0.2, 0.1])?.sample(&sim);
    let error = (reading[0] - 1.3).abs().max((reading[1] - 0.3).abs());
    assert!(error < 1e-12, "the lattice is symmetric about the point, so only round-off is left; got {error:e}");
    Ok(())
}

#[test]
fn probes_read_the_level_and_the_hydrostatic_pressure_of_still_water() -> Result<()> {
    let sim = pool();
    let level = ElevationProbe::new(sim.system(), &[0.2])?.sample(&sim);
    assert!(
        (level[0] - 0.2).abs() < 0.1 * DP,
        "the bound is a tenth of dp; the water ends half a dp above its last row"
    );
    assert_eq!(level[1], 0.0, "η is relative to the start");
    for (at, depth) in [([0.2, 0.1], 0.1), ([0.2, 0.0], 0.2), ([0.0, 0.05], 0.15)] {
        let p = PressureProbe::<2>::new(&at)?.sample(&sim)[0];
        // The water is up to 0.5 % denser than ρ₀ at the start; the error is no larger, at the walls too.
        assert!((p / (1000.0 * 9.81 * depth) - 1.0).abs() < 0.01, "hydrostatic within 1 % at {at:?}; got {p}");
    }
    Ok(())
}

#[test]
fn the_front_probe_reads_the_outer_end_of_the_farthest_particle() {
    let front = FrontProbe.sample(&pool())[0];
    assert!((front - 0.4).abs() < 1e-12, "the last particle is half a dp before the front; got {front}");
    assert_eq!(Probe::<3>::columns(&FrontProbe), ["front_m"]);
}

#[test]
fn probes_at_a_dry_position_read_no_number_and_zero_pressure() -> Result<()> {
    let sim = pool();
    assert!(VelocityProbe::<2>::new(&[0.2, 0.35])?.sample(&sim).iter().all(|x| x.is_nan()));
    assert_eq!(PressureProbe::<2>::new(&[0.2, 0.35])?.sample(&sim)[0], 0.0, "the pressure of the air");
    assert!(ElevationProbe::new(sim.system(), &[1.0])?.sample(&sim)[0].is_nan());
    assert!(VelocityProbe::<2>::new(&[0.2]).is_err() && ElevationProbe::new(sim.system(), &[0.1, 0.1]).is_err());
    Ok(())
}

#[test]
fn the_motion_probe_reads_displacements_from_the_start_and_velocities() -> Result<()> {
    let mut sim = body_in_air();
    let probe = MotionProbe::new(sim.system(), "float")?;
    let columns = Probe::<2>::columns(&probe);
    sim.set_velocity(1, &Vector::from([0.5, -0.25]), &Bivector::from_axial(&[2.0]));
    let now = probe.sample(&sim);
    assert_eq!(columns.len(), now.len());
    let of = |name: &str| columns.iter().position(|c| c == name).map(|i| now[i]);
    for (name, expected) in [
        ("surge_m", 0.0),
        ("heave_m", 0.0),
        ("pitch_deg", 0.0),
        ("vx_mps", 0.5),
        ("vy_mps", -0.25),
        ("spin_radps", 2.0),
    ] {
        assert_eq!(of(name), Some(expected), "{name}");
    }
    let unknown = MotionProbe::new(sim.system(), "flaot").err().and_then(|e| e.help);
    assert_eq!(unknown, Some("did you mean \"float\"?".into()));
    Ok(())
}

#[test]
fn the_energy_probe_reads_the_kinetic_energy_of_uniform_motion() -> Result<()> {
    let mut sim = body_in_air();
    let probe = EnergyProbe::new(sim.system());
    sim.set_water_density(|_| 1000.0);
    sim.set_water_velocity(|_| Vector::from([0.6, 0.8]));
    sim.set_velocity(1, &Vector::from([2.0, 0.0]), &Bivector::from_axial(&[0.0]));
    let now = Probe::<2>::sample(&probe, &sim);
    let (water, body) = (0.5 * 1000.0 * 0.4 * 0.1, 0.5 * 500.0 * 0.1 * 0.06 * 4.0);
    let expected = [water, 0.0, 0.0, body, 0.0, water + body];
    for (x, y) in now.iter().zip(expected) {
        assert!((x - y).abs() < 1e-9 * water, "round-off of the sums; got {now:?}");
    }
    Ok(())
}

#[test]
fn sampling_probes_changes_no_bit_of_the_run() -> Result<()> {
    let mut sim = body_in_air();
    sim.step()?;
    let before = sim.save()?;
    let system = sim.system();
    let probes: Vec<Box<dyn Probe<2>>> = vec![
        Box::new(MotionProbe::new(system, "float")?),
        Box::new(ForceProbe::new(system, "tank")?),
        Box::new(ElevationProbe::new(system, &[0.1])?),
        Box::new(VelocityProbe::new(&[0.1, 0.05])?),
        Box::new(PressureProbe::new(&[0.1, 0.05])?),
        Box::new(EnergyProbe::new(system)),
    ];
    for probe in &probes {
        let row = probe.sample(&sim);
        assert_eq!(row.len(), probe.columns().len());
        assert!(row.iter().all(|x| x.is_finite()), "all positions are wet; got {row:?}");
    }
    assert_eq!(sim.save()?, before);
    Ok(())
}
