//! Probes: known fields are read exactly, and looking changes nothing.

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

/// A body in the air above the water.
fn floats() -> Simulation<2> {
    let water = common::lattice([0.0, 0.0], [0.4, 0.1], DP);
    let body = common::float(Shape::Box { size: Vector::from([0.1, 0.06]) }, [0.2, 0.3], 500.0);
    common::simulation(Model::water(2, DP, 0.1), water, 0.1, vec![common::tank([0.4, 0.4], DP), body])
}

#[test]
fn a_linear_velocity_is_read_exactly_at_a_point_of_symmetry() -> Result<()> {
    let mut sim = pool();
    sim.set_water_density(|_| 1000.0);
    sim.set_water_velocity(|r| Vector::from([1.0 + 2.0 * r[0] - r[1], 3.0 * r[1]]));
    let seen = VelocityProbe::<2>::new(&[0.2, 0.1])?.sample(&sim);
    let error = (seen[0] - 1.3).abs().max((seen[1] - 0.3).abs());
    assert!(error < 1e-12, "the lattice is symmetric about the point, so only round-off is left; got {error:e}");
    Ok(())
}

#[test]
fn still_water_has_its_level_and_its_pressure() -> Result<()> {
    let sim = pool();
    let level = ElevationProbe::new(sim.system(), &[0.2])?.sample(&sim);
    assert!(
        (level[0] - 0.2).abs() < 0.1 * DP,
        "a tenth of the spacing, as the water ends half of it above its last row"
    );
    assert_eq!(level[1], 0.0, "η counts from the start");
    for (at, depth) in [([0.2, 0.1], 0.1), ([0.2, 0.0], 0.2), ([0.0, 0.05], 0.15)] {
        let p = PressureProbe::<2>::new(&at)?.sample(&sim)[0];
        // The water is up to 0.5 % denser than ρ₀ at the start, and no more is off, on the walls too.
        assert!((p / (1000.0 * 9.81 * depth) - 1.0).abs() < 0.01, "hydrostatic within 1 % at {at:?}; got {p}");
    }
    Ok(())
}

#[test]
fn the_front_is_the_end_of_the_farthest_particle() {
    let front = FrontProbe.sample(&pool())[0];
    assert!((front - 0.4).abs() < 1e-12, "the last particle is half a dp before it; got {front}");
    assert_eq!(Probe::<3>::columns(&FrontProbe), ["front_m"]);
}

#[test]
fn a_dry_place_gives_no_number_and_no_pressure() -> Result<()> {
    let sim = pool();
    assert!(VelocityProbe::<2>::new(&[0.2, 0.35])?.sample(&sim).iter().all(|x| x.is_nan()));
    assert_eq!(PressureProbe::<2>::new(&[0.2, 0.35])?.sample(&sim)[0], 0.0, "the air's");
    assert!(ElevationProbe::new(sim.system(), &[1.0])?.sample(&sim)[0].is_nan());
    assert!(VelocityProbe::<2>::new(&[0.2]).is_err() && ElevationProbe::new(sim.system(), &[0.1, 0.1]).is_err());
    Ok(())
}

#[test]
fn motion_counts_from_the_start_and_reads_the_velocity() -> Result<()> {
    let mut sim = floats();
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
fn energies_of_a_uniform_motion_are_those_of_a_block() -> Result<()> {
    let mut sim = floats();
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
fn looking_changes_no_bit() -> Result<()> {
    let mut sim = floats();
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
        assert!(row.iter().all(|x| x.is_finite()), "all is wet here; got {row:?}");
    }
    assert_eq!(sim.save()?, before);
    Ok(())
}
