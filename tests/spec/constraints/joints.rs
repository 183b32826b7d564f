//! Joints, springs, ropes and forces of a scene in water. Tests of constraints without water are in `tests/unit/solid/constraint/assembly.rs`.

use std::path::Path;

use pontoon::{
    Error, Result,
    probe::{JointProbe, LineProbe, Probe},
    scene::Scene,
    simulation::Simulation,
};

use crate::common;

/// A buoy held under water by a line, and a flap hinged at the bed; both have half the density of water and 0.02 m².
const MOORED: &str = r#"
dimension = 2
dp        = 0.02
until     = 2.0

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.0, 0.4] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.6] } }

[[solid]]
name  = "buoy"
shape = { box = { size = [0.2, 0.1] } }
at    = { x = 0.3, y = 0.25 }
free  = { density = 500.0 }

[[solid]]
name  = "flap"
shape = { box = { size = [0.1, 0.2] } }
at    = { x = 0.7, y = 0.18 }
free  = { density = 500.0 }

[[spring]]
name         = "line"
between      = ["buoy"]
from         = [0.3, 0.2]
to           = [0.3, 0.0]
stiffness    = 20000.0
damping      = 100.0
tension_only = true

[[joint]]
name    = "foot"
kind    = "hinge"
between = ["tank", "flap"]
at      = [0.7, 0.06]
motor   = { damping = 5.0 }

[[probe]]
joint = "foot"

[[probe]]
spring = "line"
"#;

fn moored() -> Result<Simulation<2>> {
    common::scene_simulation::<2>(MOORED)
}

#[test]
fn a_line_and_a_hinge_carry_the_net_buoyancy_of_their_bodies() -> Result<()> {
    let mut sim = moored()?;
    let (line, foot) = (sim.find_spring("line")?, sim.find_joint("foot")?);
    let [tension, carried] = common::time_mean(&mut sim, 1.0, 2.0, |sim| {
        [sim.spring_reading(line).tension, -sim.joint_reading(foot).force[1]]
    })?;
    // (ρ₀ − ρ) g V to 2 %: the bodies are 5 dp thick, and the line stretches by 5 mm.
    let exact = 500.0 * 9.81 * 0.02;
    assert!((tension / exact - 1.0).abs() < 0.02, "line {tension} N/m, exact {exact}");
    assert!((carried / exact - 1.0).abs() < 0.02, "hinge {carried} N/m, exact {exact}");
    assert!(sim.joint_reading(foot).position.abs() < 0.05, "the flap stays upright: {:?}", sim.joint_reading(foot));
    Ok(())
}

#[test]
fn a_resumed_run_with_a_mooring_and_a_hinge_reaches_the_same_bits() -> Result<()> {
    let mut whole = moored()?;
    common::steps(&mut whole, 30);
    whole.spring_parameters(0).rest_length = 0.19;
    let saved = whole.save()?;
    common::steps(&mut whole, 30);
    let mut resumed = moored()?;
    resumed.restore(&saved)?;
    common::steps(&mut resumed, 30);
    assert!(resumed.save()? == whole.save()?);
    assert!(whole.spring_reading(0).tension > 0.0 && whole.joint_reading(0).absorbed_energy != 0.0);
    Ok(())
}

/// A box that hangs on a rope, and one that hangs on a spring of 50 N/m² stretched by 0.2 m, both out of the water and at rest.
const HANGING: &str = r#"
dimension = 2
dp        = 0.05
until     = 0.02

[[water]]
fill = { box = { min = [0.0, 0.0], max = [1.6, 0.5] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [1.6, 0.8] } }

[[solid]]
name  = "hung"
shape = { box = { size = [0.4, 0.4] } }
at    = { x = 0.4, y = 1.6 }
free  = { mass = 10.0 }

[[solid]]
name  = "sprung"
shape = { box = { size = [0.4, 0.4] } }
at    = { x = 1.2, y = 1.6 }
free  = { mass = 10.0 }

[[rope]]
name    = "rope"
between = ["hung"]
from    = [0.4, 1.8]
to      = [0.4, 2.6]

[[spring]]
name      = "spring"
between   = ["sprung"]
from      = [1.2, 1.8]
to        = [1.2, 2.8]
stiffness = 50.0
length    = 0.8

[[joint]]
name    = "rail"
kind    = "slider"
along   = [0.0, 1.0]
between = ["sprung"]
at      = [1.2, 1.6]
motor   = { stiffness = 100.0, damping = 10.0 }

[[probe]]
rope = "rope"
[[probe]]
spring = "spring"
[[probe]]
joint = "rail"
[[probe]]
balance = "hung"
[[probe]]
contact = ["hung", "sprung"]
"#;

/// Loads that only a step can tell are NaN before the first step: zeros would enter means and extremes.
#[test]
fn a_load_that_is_not_known_at_the_start_is_nan_there() -> Result<()> {
    let scene = Scene::parse(HANGING, Path::new(""), &[])?;
    let mut sim = common::scene_simulation::<2>(HANGING)?;
    let kinds = scene.plan()?.probes.into_iter().map(|probe| probe.kind);
    let kinds: Vec<_> = kinds.inspect(|kind| kind.enable_records(&mut sim)).collect();
    let probes = kinds.iter().map(|kind| kind.build(sim.system())).collect::<Result<Vec<_>>>()?;
    let sample = |sim: &Simulation<2>| probes.iter().map(|probe| probe.sample(sim)).collect::<Vec<_>>();
    let [rope, spring, joint, balance, contact] = &sample(&sim)[..] else { panic!("five probes") };
    assert!((rope[0] - 0.8).abs() < 1e-12 && rope[1].is_nan(), "{rope:?}");
    assert!((spring[0] - 1.0).abs() < 1e-12 && (spring[1] - 10.0).abs() < 1e-9, "50 N/m² times 0.2 m: {spring:?}");
    let [loads @ .., position, rate, motor, power, absorbed] = &joint[..] else { panic!("{joint:?}") };
    assert!(loads.iter().chain([motor, power]).all(|x| x.is_nan()), "{joint:?}");
    assert_eq!([*position, *rate, *absorbed], [0.0; 3]);
    assert!(balance.iter().chain(contact).all(|x| x.is_nan()), "{balance:?} {contact:?}");

    sim.step()?;
    let [rope, _, joint, balance, contact] = &sample(&sim)[..] else { panic!("five probes") };
    // The weight of 10 kg, to the 1e-6 of the engine's reactions.
    assert!((rope[1] / 98.1 - 1.0).abs() < 1e-6, "{rope:?}");
    assert!(joint.iter().chain(balance).all(|x| x.is_finite()), "{joint:?} {balance:?}");
    assert_eq!(contact[..3], [0.0; 3], "they do not touch");
    Ok(())
}

#[test]
fn joint_and_line_probes_name_their_units_and_read_the_values_of_the_simulation() -> Result<()> {
    let mut sim = moored()?;
    sim.step()?;
    let (foot, line) = (JointProbe::new(sim.system(), "foot")?, LineProbe::spring(sim.system(), "line")?);
    let expected =
        "fx_N_per_m fy_N_per_m torque_Nm_per_m angle_deg rate_radps motor_Nm_per_m power_W_per_m absorbed_J_per_m";
    assert_eq!(Probe::<2>::columns(&foot).join(" "), expected);
    assert_eq!(Probe::<3>::columns(&foot)[..7].join(" "), "fx_N fy_N fz_N tx_Nm ty_Nm tz_Nm angle_deg");
    assert_eq!(Probe::<2>::columns(&line), ["length_m", "tension_N_per_m"]);
    let now = sim.joint_reading(0);
    assert_eq!(
        foot.sample(&sim)[3..],
        [now.position.to_degrees(), now.rate, now.motor_force, now.absorbed_power(), now.absorbed_energy]
    );
    assert_eq!(line.sample(&sim), [sim.spring_reading(0).length, sim.spring_reading(0).tension]);
    let unknown = JointProbe::new(sim.system(), "food").err().and_then(|e| e.help);
    assert_eq!(unknown, Some("did you mean \"foot\"?".into()));
    Ok(())
}

/// A wheel above the water turns by 10 rad between two rows: more than a turn.
#[test]
fn the_angle_of_a_hinge_counts_the_turns_between_two_rows() -> Result<()> {
    let wheel = "[[solid]]\nname = \"wheel\"\nshape = { ball = { radius = 0.1 } }\nat = [0.6, 2.0]\nfree = { mass = 10.0 }\n\
                 [[joint]]\nname = \"axle\"\nkind = \"hinge\"\nbetween = [\"wheel\"]\nat = [0.6, 2.0]\n\
                 motor = { velocity = 20.0, damping = 1e6 }\n";
    let mut sim = Simulation::<2>::new(pool(0.1, wheel)?.build()?.setup)?;
    let axle = JointProbe::new(sim.system(), "axle")?;
    common::run_to(&mut sim, 0.1)?;
    let (start, before) = (sim.time(), axle.sample(&sim));
    common::run_to(&mut sim, 0.6)?;
    let mut now = axle.sample(&sim);
    Probe::<2>::continue_from(&axle, &before, &mut now, 0.5);
    // The motor holds its speed. In 2-D the engine turns by atan(ω Δt) in a step, 0.16 % too little with 3.5 ms. A lost turn is 6.28 rad.
    let (turned, exact) = ((now[3] - before[3]).to_radians(), 20.0 * (sim.time() - start));
    assert!((turned - exact).abs() < 0.03, "{turned} rad in place of {exact} rad");
    Ok(())
}

/// A tank of water of 1.2 m × 0.4 m with spacing `dp` (m), and the sections `more`.
fn pool(dp: f64, more: &str) -> Result<Scene> {
    let text = format!(
        "dimension = 2\ndp = {dp}\nuntil = 4.0\n[[water]]\nfill = {{ box = {{ min = [0, 0], max = [1.2, 0.4] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.2, 0.6] }} }}\n{more}"
    );
    Scene::parse(&text, Path::new(""), &[])
}

/// A barge with ballast on one side, in a guide with free heave and 2° of free rotation.
const GUIDED: &str = r#"
[[solid]]
name  = "barge"
shape = { box = { size = [0.3, 0.1] } }
at    = { x = 0.6, draft = 0.05 }
free  = { density = 500.0, centre_offset = [0.03, 0.0] }

[[joint]]
name       = "guide"
kind       = "generic"
between    = ["barge"]
at         = [0.6, 0.4]
free       = ["y", "turn"]
limits     = { y = [-0.05, 0.05] }
limits_deg = { turn = [-2.0, 2.0] }
"#;

#[test]
fn a_guide_at_its_stop_carries_the_difference_of_heeling_and_righting_moment() -> Result<()> {
    let mut sim = Simulation::new(pool(0.0125, GUIDED)?.build::<2>()?.setup)?;
    let guide = JointProbe::new(sim.system(), "guide")?;
    assert_eq!(Probe::<2>::columns(&guide)[3..], ["y_m", "turn_deg"]);
    let [carried] = common::time_mean(&mut sim, 3.0, 4.0, |sim| [sim.joint_reading(0).torque.axial()[0]])?;
    let [y, turn]: [f64; 2] = guide.sample(&sim)[3..].try_into().unwrap();
    // Without the guide the barge would list by 13°. Heave is free, and the draft is accurate to 0.2 dp.
    assert!((turn + 2.0).abs() < 1e-3 && y.abs() < 0.2 * 0.0125, "{turn}° and {y} m");
    assert!(sim.system().solids()[1].kinematics.pose.position[0] - 0.6 < 1e-6, "the barge does not drift");
    // Weight × (offset cos φ − GM sin φ), with BM = B²/12T and KB − KG = −25 mm. Moments of 8 rows are accurate to a few per cent.
    let (gm, list) = (0.3 * 0.3 / 0.6 - 0.025, 2f64.to_radians());
    let exact = 500.0 * 0.03 * 9.81 * (0.03 * list.cos() - gm * list.sin());
    assert!((carried / exact - 1.0).abs() < 0.05, "{carried} N m/m, exact {exact}");
    Ok(())
}

/// A flap pinned under a paddle that oscillates at the surface.
const PINNED: &str = r#"
[[solid]]
name   = "paddle"
shape  = { box = { size = [0.1, 0.16] } }
at     = { x = 0.5, y = 0.42 }
driven = { along = [1.0, 0.0], distance = { formula = "0.05*(1-cos(2*pi*t))" } }

[[solid]]
name  = "flap"
shape = { box = { size = [0.1, 0.2] } }
at    = { x = 0.5, y = 0.22 }
free  = { density = 800.0 }

[[joint]]
name    = "pin"
kind    = "hinge"
between = ["paddle", "flap"]
at      = [0.5, 0.34]
"#;

#[test]
fn a_flap_pinned_to_a_driven_paddle_stays_attached_and_its_loads_sum_to_zero() -> Result<()> {
    let mut sim = Simulation::new(pool(0.02, PINNED)?.build::<2>()?.setup)?;
    sim.enable_load_breakdown();
    let (mut gap, mut swing): (f64, f64) = (0.0, 0.0);
    while sim.time() < 1.0 {
        sim.step_to(1.0)?;
        let [paddle, flap] = [1, 2].map(|i| sim.system().solids()[i].kinematics.pose);
        let apart = paddle.point(&[0.0, -0.08].into()) - flap.point(&[0.0, 0.12].into());
        (gap, swing) = (gap.max(apart.norm()), swing.max(sim.joint_reading(0).position.abs()));
        let shares = sim.load_breakdown(2).unwrap();
        let largest = shares.kinds().iter().map(|(_, load)| load.force.norm()).fold(0.0, f64::max);
        let off = shares.residual().force.norm();
        assert!(off < 1e-9 * largest, "{off} N/m of {largest} at {} s", sim.time());
    }
    // The engine corrects positions within the step; the remainder is of second order in the step.
    assert!(gap < 1e-5, "the joint is open by {gap} m");
    assert!(swing.to_degrees() > 2.0, "the flap swings in the water: {}°", swing.to_degrees());
    Ok(())
}

#[test]
fn a_joint_in_conflict_with_another_constraint_is_reported() -> Result<()> {
    let more = "[[joint]]\nname = \"weld\"\nkind = \"fixed\"\nbetween = [\"tank\", \"flap\"]\nat = [0.5, 0.14]\n";
    let text = format!("{PINNED}\n{more}");
    let mut sim = Simulation::new(pool(0.02, &text)?.build::<2>()?.setup)?;
    assert!(sim.violated_joints().is_empty(), "no joint is violated at the start");
    while sim.time() < 0.3 {
        sim.step_to(0.3)?;
    }
    // The paddle has moved 65 mm away from the flap, which is fixed to the tank.
    assert!(
        sim.violated_joints().iter().any(|message| message.contains("is torn by 0.06")),
        "{:?}",
        sim.violated_joints()
    );
    Ok(())
}

#[test]
fn only_stiff_springs_shorten_the_step() -> Result<()> {
    let limit = |stiffness: &str| -> Result<f64> {
        let sets = [("spring.line.stiffness".to_string(), stiffness.to_string())];
        Ok(Simulation::new(Scene::parse(MOORED, Path::new(""), &sets)?.build::<2>()?.setup)?.step_limit())
    };
    let (soft, stiff) = (limit("20000")?, limit("2e9")?);
    assert_eq!(soft, limit("20")?, "the water sets the step");
    // 10 kg/m on 2e9 N/m²: ω = 14142 rad/s.
    assert!((stiff * 2e8f64.sqrt() - 0.2).abs() < 1e-6, "{stiff}");
    Ok(())
}

/// The error message of the scene with `from` replaced by `to`.
fn error_message(from: &str, to: &str) -> String {
    assert!(MOORED.contains(from), "\"{from}\" is not in the scene");
    let built = Scene::parse(&MOORED.replacen(from, to, 1), Path::new(""), &[]).and_then(|scene| {
        scene.resolve()?;
        scene.build::<2>().map(|_| ())
    });
    built.map_err(|e: Error| e.to_string()).expect_err("this scene is wrong")
}

#[test]
fn wrong_keys_of_joints_and_springs_are_refused_with_their_location_and_a_remedy() {
    let motor = "motor   = { damping = 5.0 }";
    let cases: [(&str, &str, &[&str]); 26] = [
        (
            "between = [\"tank\", \"flap\"]",
            "between = [\"tank\", \"flip\"]",
            &["did you mean \"flap\"?", "joint.0.between", ":38:"],
        ),
        ("between = [\"tank\", \"flap\"]", "between = [\"tank\"]", &["\"tank\" is not free"]),
        ("between = [\"tank\", \"flap\"]", "between = [\"flap\", \"flap\"]", &["named twice"]),
        ("between = [\"tank\", \"flap\"]", "between = []", &["one solid or two, not 0"]),
        ("kind    = \"hinge\"", "kind    = \"hing\"", &["did you mean \"hinge\"?"]),
        ("kind    = \"hinge\"", "kind    = \"slider\"", &["along is missing", "along = [0.0, 1.0]"]),
        ("kind    = \"hinge\"", "kind    = \"ball\"", &["a plane has no ball joint"]),
        ("kind    = \"hinge\"", "kind    = \"fixed\"", &["no way to go"]),
        ("kind    = \"hinge\"", "kind = \"generic\"", &["free is missing"]),
        ("kind    = \"hinge\"", "kind = \"generic\"\nfree = [\"turn\"]", &["no way to go", "has a motor"]),
        ("kind    = \"hinge\"", "kind = \"generic\"\nfree = [\"z\"]", &["no such motion in 2-D"]),
        ("kind    = \"hinge\"", "kind = \"hinge\"\nfree = [\"y\"]", &["free has no meaning here"]),
        (
            "kind    = \"hinge\"",
            "kind = \"generic\"\nfree = [\"turn\"]\nlimits = { y = [-0.1, 0.1] }",
            &["limits of what is not free"],
        ),
        (
            "kind    = \"hinge\"",
            "kind = \"generic\"\nfree = [\"turn\"]\nlimits_deg = { trun = [-5, 5] }",
            &["did you mean \"turn\"?"],
        ),
        ("at      = [0.7, 0.06]", "at      = [0.7]", &["1 number, not 2"]),
        ("at      = [0.7, 0.06]", "at = [0.7, 0.06]\naxis = [0.0, 1.0]", &["axis has no meaning here"]),
        ("at      = [0.7, 0.06]", "at = [0.7, 0.06]\nlimits_deg = [10.0, 20.0]", &["0 is where it starts"]),
        (motor, "motor = {}", &["no force"]),
        (motor, "motor = { position = 0.1 }", &["no force"]),
        (motor, "motor = { damping = -5 }", &["damping is -5"]),
        (motor, "motor = { damping = 1, force = 2.0 }", &["force has no meaning here", "torque"]),
        (motor, "motor = { torque = \"sinus(t)\" }", &["\"sinus\" is not known", "joint.0.motor.torque"]),
        (motor, "motor = { torque = 1, velocity = 2 }", &["a velocity needs a damping"]),
        ("stiffness    = 20000.0", "stiffness = -1.0", &["stiffness must be a positive number"]),
        ("joint = \"foot\"", "joint = \"fot\"", &["did you mean \"foot\"?"]),
        ("to           = [0.3, 0.0]", "too = [0.3, 0.0]", &["unknown key \"too\"; did you mean \"to\"?"]),
    ];
    for (from, to, expected) in cases {
        let message = error_message(from, to);
        for part in expected {
            assert!(message.contains(part), "{to}: \"{part}\" is not in\n{message}");
        }
    }
    let twice = error_message(
        "[[probe]]\njoint",
        "[[joint]]\nname = \"foot\"\nkind = \"fixed\"\nbetween = [\"flap\"]\nat = [0.7, 0.2]\n\n[[probe]]\njoint",
    );
    assert!(twice.contains("two joints are called \"foot\""), "{twice}");
    let long = error_message(
        "[[joint]]",
        "[[rope]]\nname = \"r\"\nbetween = [\"buoy\"]\nfrom = [0.3, 0.2]\nto = [0.3, 0.0]\nlength = 0.1\n\n[[joint]]",
    );
    assert!(long.contains("its ends start 0.2 m apart"), "{long}");
}

#[test]
fn values_of_joints_and_forces_may_be_numbers_formulas_or_tables() -> Result<()> {
    let with_motor =
        |text: &str| Scene::parse(&MOORED.replace("motor   = { damping = 5.0 }", text), Path::new(""), &[]);
    for motor in [
        "motor = { damping = 5 }",
        "motor = { torque = \"sin(t)\", damping = \"5*t\" }",
        "motor = { torque = { formula = \"sin(t)\" }, strongest = 3.0 }",
        "motor = { position_deg = { file = \"angle.csv\", column = \"angle_deg\" }, stiffness = 100 }",
    ] {
        let scene = with_motor(motor)?;
        let again = Scene::parse(&scene.to_toml()?, Path::new(""), &[])?;
        assert!(again == scene && again.to_toml()? == scene.to_toml()?, "{motor}: {}", scene.to_toml()?);
    }
    let guided = pool(0.0125, GUIDED)?;
    assert!(Scene::parse(&guided.to_toml()?, Path::new(""), &[])? == guided, "{}", guided.to_toml()?);
    let force = "[[force]]\nname = \"wind\"\non = \"buoy\"\nforce = [\"10*t\", 0]\ntorque = 0.5\nframe = \"body\"\n\n\
                 [[contact]]\nbetween = [\"buoy\"]\nfriction = 0.1\n\n[[contact]]\nbetween = [\"buoy\", \"flap\"]\ntouch = false\n\n[[joint]]";
    let scene = Scene::parse(&MOORED.replacen("[[joint]]", force, 1), Path::new(""), &[])?;
    let links = scene.build::<2>()?.setup.constraints;
    assert_eq!((links.forces[0].force.len(), links.forces[0].torque.len(), links.contacts.len()), (2, 1, 2));
    assert!(!links.can_touch(1, 2) && links.can_touch(1, 0) && !links.can_touch(0, 2), "jointed solids do not touch");
    let pushed = links.forces[0].force[0].value_and_rate(0.5).0;
    assert_eq!(pushed, 5.0);
    Ok(())
}

#[test]
fn a_force_on_a_body_in_water_also_accelerates_its_added_mass() -> Result<()> {
    let force = "[[force]]\nname = \"tow\"\non = \"buoy\"\nforce = [30.0, 0.0]\n\n[[joint]]";
    let scene = Scene::parse(&MOORED.replacen("[[joint]]", force, 1), Path::new(""), &[])?;
    let mut towed = Simulation::new(scene.build::<2>()?.setup)?;
    let mut still = moored()?;
    for sim in [&mut towed, &mut still] {
        while sim.time() < 0.05 {
            sim.step_to(0.05)?;
        }
    }
    let speed = |sim: &Simulation<2>| sim.system().solids()[1].kinematics.velocity[0];
    let gained = speed(&towed) - speed(&still);
    // In air the velocity would be 30 N · 0.05 s / 10 kg. The added mass is 0.2 to 2 times the mass of a block of that breadth.
    assert!(0.15 / 3.0 < gained && gained < 0.15 / 1.2, "{gained} m/s");
    Ok(())
}
