//! Gauges and points that go with a solid.

use std::path::Path;

use pontoon::{
    Result,
    probe::{ElevationProbe, JointProbe, PressureProbe, Probe, VelocityProbe},
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

/// Both columns of a gauge on a body that rises are heights above its point: the level falls by the rise.
#[test]
fn the_level_of_a_gauge_on_a_rising_body_is_a_height_above_its_point() -> Result<()> {
    let text = GOING
        .replace("velocity = [0.5, 0.0]", "velocity = [0.0, 0.0]")
        .replace("driven = { along = [1.0, 0.0], distance = { formula = \"0.5*t\" } }", "fixed = true")
        + "[[solid]]\nname = \"lift\"\nshape = { box = { size = [0.1, 0.1] } }\nat = { x = 0.2, y = 0.5 }\n\
           driven = { along = [0.0, 1.0], distance = { formula = \"0.25*t\" } }\n";
    let mut sim = scene_simulation::<2>(&text)?;
    let (gauge, fixed) =
        (ElevationProbe::on_solid(sim.system(), "lift", &[0.1])?, ElevationProbe::new(sim.system(), &[0.3])?);
    run_to(&mut sim, 0.4)?;
    let [level, eta] = gauge.sample(&sim)[..] else { panic!("two columns") };
    let world = fixed.sample(&sim)[0];
    // The body starts at 0.5 m and rises by 0.1 m up to the last step.
    let height = sim.system().solids()[1].kinematics.pose.position[1];
    assert!((height - 0.6).abs() < 1e-3 && (level - (world - height)).abs() < 1e-12, "{level} m of {world} m");
    assert!((eta + 0.1).abs() < 2e-3, "{eta} m");
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

/// A body falls from 0 s, and is removed at 0.1 s. Its probes and those on it follow it until then; after that there is nothing to
/// measure, and the readings have no numbers, which would enter the statistics.
#[test]
fn probes_of_a_removed_body_read_its_state_before_and_nothing_after() -> Result<()> {
    let text = GOING.replace("velocity = [0.5, 0.0]", "velocity = [0.0, 0.0]").replace("0.5*t", "0")
        + "[[solid]]\nname = \"b\"\nshape = { box = { size = [0.1, 0.1] } }\nat = { x = 0.2, y = 1.0 }\nuntil = 0.1\n\
           free = { density = 500.0 }\n\
           [[probe]]\nmotion = \"b\"\n[[probe]]\nforce = \"b\"\n[[probe]]\nbalance = \"b\"\n[[probe]]\nrunup = \"b\"\n\
           [[probe]]\ncontact = [\"b\", \"tank\"]\n[[probe]]\nname = \"gauge\"\nelevation = { x = 0.0, on = \"b\" }\n\
           [[probe]]\nname = \"p\"\non = \"b\"\npressure = [0.0, -0.8]\n\
           [[probe]]\nname = \"v\"\non = \"b\"\nvelocity = [0.0, -0.85]\n";
    let plan = Scene::parse(&text, Path::new(""), &[])?.plan()?;
    let mut sim = scene_simulation::<2>(&text)?;
    plan.probes.iter().for_each(|probe| probe.kind.enable_records(&mut sim));
    let probes = plan.probes.iter().map(|probe| probe.kind.build(sim.system())).collect::<Result<Vec<_>>>()?;
    run_to(&mut sim, 0.09)?;
    let motion = probes[0].sample(&sim);
    let column = |name: &str| probes[0].columns().iter().position(|column| column == name).expect("a column of motion");
    // Symplectic steps of constant gravity give the velocity to round-off.
    let (vy, fallen) = (motion[column("vy_mps")], -9.81 * sim.time());
    assert!((vy - fallen).abs() < 1e-9, "{vy} m/s of {fallen}");
    run_to(&mut sim, 0.1)?;
    for (probe, plan) in probes.iter().zip(&plan.probes) {
        let row = probe.sample(&sim);
        assert!(row.len() == probe.columns().len() && row.iter().all(|x| x.is_nan()), "{}: {row:?}", plan.name);
    }
    Ok(())
}

/// The position of a slider that begins at 0.1 s counts from there, and there is none before. Released, it has none either.
#[test]
fn a_joint_has_a_position_only_while_it_acts() -> Result<()> {
    let text = GOING.replace("velocity = [0.5, 0.0]", "velocity = [0.0, 0.0]").replace("0.5*t", "0")
        + "[[solid]]\nname = \"b\"\nshape = { box = { size = [0.1, 0.1] } }\nat = { x = 0.2, y = 2.0 }\n\
           free = { density = 500.0, velocity = [1.0, 0.0] }\n\
           [[joint]]\nname = \"j\"\nkind = \"slider\"\nbetween = [\"b\"]\nat = [0.2, 2.0]\nalong = [1, 0]\n\
           from = 0.1\nuntil = 0.2\n";
    let mut sim = scene_simulation::<2>(&text)?;
    let probe = JointProbe::new(sim.system(), "j")?;
    let column = |name: &str| Probe::<2>::columns(&probe).iter().position(|column| column == name).expect("a column");
    let (position, rate) = (column("position_m"), column("rate_mps"));
    let mut before = probe.sample(&sim);
    while sim.time() < 0.3 {
        let t = sim.time();
        sim.step_to(if t < 0.15 { 0.15 } else { 0.3 })?;
        let mut row = probe.sample(&sim);
        Probe::<2>::continue_from(&probe, &before, &mut row, sim.time() - t);
        // The body slides at 1 m/s, to the round-off of the joint.
        match t {
            0.1..0.2 => {
                let slid = sim.time() - 0.1;
                assert!((row[position] - slid).abs() < 1e-6 && (row[rate] - 1.0).abs() < 1e-6, "{row:?} at {t} s");
            }
            _ => assert!(row[position].is_nan() && row[rate].is_nan() && row[0] == 0.0, "{row:?} at {t} s"),
        }
        before = row;
    }
    Ok(())
}
