//! Gauges and points that go with a solid.

use std::path::Path;

use pontoon::{
    Result,
    probe::{ElevationProbe, PressureProbe, Probe, VelocityProbe},
    scene::Scene,
};

use crate::common::{run_to, scene_simulation};

/// A tank that goes with its water at 0.5 m/s.
const GOING: &str = r#"
dimension = 2
dp = 0.02
until = 0.4
water = [{ fill = { box = { min = [0.0, 0.0], max = [0.4, 0.2] } }, velocity = [0.5, 0.0] }]
[[solid]]
name = "tank"
driven = { along = [1.0, 0.0], distance = { formula = "0.5*t" } }
shape = { tank = { size = [0.4, 0.4] } }
"#;

#[test]
fn probes_on_a_tank_that_goes_with_its_water_measure_still_water() -> Result<()> {
    let mut sim = scene_simulation::<2>(GOING)?;
    let gauge = ElevationProbe::on_solid(sim.system(), "tank", &[0.3])?;
    let pressure = PressureProbe::on_solid(sim.system(), "tank", &[0.2, 0.05])?;
    let velocity = VelocityProbe::on_solid(sim.system(), "tank", &[0.2, 0.1])?;
    run_to(&mut sim, 0.4)?;
    let [level, eta] = gauge.sample(&sim)[..] else { panic!("two columns") };
    // Water at rest keeps its level within a twentieth of dp.
    assert!((level - 0.2).abs() < 0.01 && eta.abs() < 1e-3, "level {level}, eta {eta}");
    let (p, hydrostatic) = (pressure.sample(&sim)[0], 1000.0 * 9.81 * 0.15);
    assert!((p / hydrostatic - 1.0).abs() < 0.03, "{p} of {hydrostatic} Pa");
    let relative = velocity.sample(&sim);
    // 1 % of the speed of the tank.
    assert!(relative.iter().all(|v| v.abs() < 5e-3), "{relative:?}");
    Ok(())
}

#[test]
fn a_scene_mounts_gauges_and_points_and_refuses_other_probes() {
    let plan = |probe: &str| {
        let text = format!("{GOING}[[probe]]\n{probe}\n");
        Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.plan())
    };
    for good in [
        "elevation = { x = 0.1, on = \"tank\" }",
        "elevation = { x = 0.1 }\non = \"tank\"",
        "pressure = [0.1, 0.0]\non = \"tank\"",
        "velocity = { from = [0.0, 0.1], to = [0.4, 0.1], count = 5 }\non = \"tank\"",
    ] {
        assert!(plan(good).is_ok(), "{good}: {}", plan(good).err().unwrap());
    }
    for (bad, what) in [
        ("elevation = { x = 0.1, on = \"tnk\" }", "tank"),
        ("pressure = [0.1, 0.0]\non = \"hull\"", "no solid is called \"hull\""),
        ("front = true\non = \"tank\"", "a probe of front does not go with a solid"),
    ] {
        let message = plan(bad).unwrap_err().to_string();
        assert!(message.contains(what), "{bad}: {message}");
    }
}
