//! Joints, lines and forces in a scene and in water; what they promise in air is in `solid/rig/tests.rs`.

use std::path::Path;

use pontoon::{
    Error, Result,
    probe::{JointProbe, LineProbe, Probe},
    scene::Scene,
    simulation::Simulation,
};

/// A buoy held under water by a line, and a flap hinged at the bed; half as heavy as water, 0.02 m² each.
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
fn a_line_and_a_hinge_carry_what_archimedes_says() -> Result<()> {
    let mut sim = moored()?;
    let (line, foot) = (sim.find_spring("line")?, sim.find_joint("foot")?);
    let (mut tension, mut carried) = (0.0, 0.0);
    while sim.time() < 2.0 {
        sim.step_to(2.0)?;
        if sim.time() > 1.0 {
            tension += sim.spring_reading(line).tension * sim.dt();
            carried -= sim.joint_reading(foot).force[1] * sim.dt();
        }
    }
    // (ρ₀ − ρ) g V, held to 2 %: the bodies are 5 dp thick, and the line gives way by 5 mm.
    let exact = 500.0 * 9.81 * 0.02;
    assert!((tension / exact - 1.0).abs() < 0.02, "line {tension} N/m, exact {exact}");
    assert!((carried / exact - 1.0).abs() < 0.02, "hinge {carried} N/m, exact {exact}");
    assert!(sim.joint_reading(foot).position.abs() < 0.05, "the flap stands: {:?}", sim.joint_reading(foot));
    Ok(())
}

#[test]
fn a_moored_and_hinged_run_resumed_goes_on_to_the_same_bits() -> Result<()> {
    let steps = |sim: &mut Simulation<2>, n: usize| (0..n).try_for_each(|_| sim.step());
    let mut whole = moored()?;
    steps(&mut whole, 30)?;
    whole.spring_parameters(0).rest_length = 0.19;
    let kept = whole.save()?;
    steps(&mut whole, 30)?;
    let mut resumed = moored()?;
    resumed.restore(&kept)?;
    steps(&mut resumed, 30)?;
    assert!(resumed.save()? == whole.save()?);
    assert!(whole.spring_reading(0).tension > 0.0 && whole.joint_reading(0).absorbed_energy != 0.0);
    Ok(())
}

#[test]
fn probes_of_ties_name_their_units_and_read_what_the_simulation_tells() -> Result<()> {
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

/// A tank of water 1.2 m × 0.4 m, and what else `words` say, at this spacing (m).
fn pool(dp: f64, words: &str) -> Result<Scene> {
    let text = format!(
        "dimension = 2\ndp = {dp}\nuntil = 4.0\n[[water]]\nfill = {{ box = {{ min = [0, 0], max = [1.2, 0.4] }} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.2, 0.6] }} }}\n{words}"
    );
    Scene::parse(&text, Path::new(""), &[])
}

/// A barge with its ballast on one side, in a guide in which it may heave and turn by 2°.
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
fn a_guide_with_play_carries_the_moment_that_the_water_does_not() -> Result<()> {
    let mut sim = Simulation::new(pool(0.0125, GUIDED)?.build::<2>()?.setup)?;
    let guide = JointProbe::new(sim.system(), "guide")?;
    assert_eq!(Probe::<2>::columns(&guide)[3..], ["y_m", "turn_deg"]);
    let mut carried = 0.0;
    while sim.time() < 4.0 {
        sim.step_to(4.0)?;
        if sim.time() > 3.0 {
            carried += sim.joint_reading(0).torque.axial()[0] * sim.dt();
        }
    }
    let [y, turn]: [f64; 2] = guide.sample(&sim)[3..].try_into().unwrap();
    // Its ballast would have it list by 13°; heave is free, and 0.2 dp is what a draft is known to.
    assert!((turn + 2.0).abs() < 1e-3 && y.abs() < 0.2 * 0.0125, "{turn}° and {y} m");
    assert!(sim.system().solids()[1].kinematics.pose.position[0] - 0.6 < 1e-6, "and it does not drift");
    // Weight × (offset cos φ − GM sin φ), with BM = B²/12T and KB − KG = −25 mm; moments of 8 rows are right to a few hundredths.
    let (gm, list) = (0.3 * 0.3 / 0.6 - 0.025, 2f64.to_radians());
    let exact = 500.0 * 0.03 * 9.81 * (0.03 * list.cos() - gm * list.sin());
    assert!((carried / exact - 1.0).abs() < 0.05, "{carried} N m/m, exact {exact}");
    Ok(())
}

/// A flap pinned under a paddle that goes to and fro in the surface.
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
fn a_flap_pinned_to_a_moving_paddle_goes_with_it_and_its_loads_add_up() -> Result<()> {
    let mut sim = Simulation::new(pool(0.02, PINNED)?.build::<2>()?.setup)?;
    sim.enable_load_breakdown();
    let (mut torn, mut swung): (f64, f64) = (0.0, 0.0);
    while sim.time() < 1.0 {
        sim.step_to(1.0)?;
        let [paddle, flap] = [1, 2].map(|i| sim.system().solids()[i].kinematics.pose);
        let apart = paddle.point(&[0.0, -0.08].into()) - flap.point(&[0.0, 0.12].into());
        (torn, swung) = (torn.max(apart.norm()), swung.max(sim.joint_reading(0).position.abs()));
        let shares = sim.load_breakdown(2).unwrap();
        let largest = shares.kinds().iter().map(|(_, load)| load.force.norm()).fold(0.0, f64::max);
        let off = shares.residual().force.norm();
        assert!(off < 1e-9 * largest, "{off} N/m of {largest} at {} s", sim.time());
    }
    // The engine mends places as fast as it moves them: what is left is of second order in the step.
    assert!(torn < 1e-5, "the pin is torn by {torn} m");
    assert!(swung.to_degrees() > 2.0, "the water swings it: {}°", swung.to_degrees());
    Ok(())
}

#[test]
fn a_joint_that_something_contradicts_is_told_of() -> Result<()> {
    let more = "[[joint]]\nname = \"weld\"\nkind = \"fixed\"\nbetween = [\"tank\", \"flap\"]\nat = [0.5, 0.14]\n";
    let text = format!("{PINNED}\n{more}");
    let mut sim = Simulation::new(pool(0.02, &text)?.build::<2>()?.setup)?;
    assert!(sim.violated_joints().is_empty(), "whole at the start");
    while sim.time() < 0.3 {
        sim.step_to(0.3)?;
    }
    // The paddle has gone 65 mm from what is welded to the tank.
    assert!(sim.violated_joints().iter().any(|said| said.contains("is torn by 0.06")), "{:?}", sim.violated_joints());
    Ok(())
}

#[test]
fn stiff_lines_shorten_the_step_and_nothing_else_does() -> Result<()> {
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

/// What is said of the scene with `from` replaced by `to`.
fn said(from: &str, to: &str) -> String {
    assert!(MOORED.contains(from), "\"{from}\" is not in the scene");
    let built = Scene::parse(&MOORED.replacen(from, to, 1), Path::new(""), &[]).and_then(|scene| {
        scene.resolve()?;
        scene.build::<2>().map(|_| ())
    });
    built.map_err(|e: Error| e.to_string()).expect_err("this scene is wrong")
}

#[test]
fn wrong_words_of_ties_are_told_with_their_place_and_what_to_write() {
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
        ("at      = [0.7, 0.06]", "at      = [0.7]", &["1 numbers, not 2"]),
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
        let message = said(from, to);
        for part in expected {
            assert!(message.contains(part), "{to}: \"{part}\" is not in\n{message}");
        }
    }
    let twice = said(
        "[[probe]]\njoint",
        "[[joint]]\nname = \"foot\"\nkind = \"fixed\"\nbetween = [\"flap\"]\nat = [0.7, 0.2]\n\n[[probe]]\njoint",
    );
    assert!(twice.contains("two joints are called \"foot\""), "{twice}");
    let long = said(
        "[[joint]]",
        "[[rope]]\nname = \"r\"\nbetween = [\"buoy\"]\nfrom = [0.3, 0.2]\nto = [0.3, 0.0]\nlength = 0.1\n\n[[joint]]",
    );
    assert!(long.contains("its ends start 0.2 m apart"), "{long}");
}

#[test]
fn values_of_ties_may_be_numbers_formulas_or_tables() -> Result<()> {
    let words = |text: &str| Scene::parse(&MOORED.replace("motor   = { damping = 5.0 }", text), Path::new(""), &[]);
    for motor in [
        "motor = { damping = 5 }",
        "motor = { torque = \"sin(t)\", damping = \"5*t\" }",
        "motor = { torque = { formula = \"sin(t)\" }, strongest = 3.0 }",
        "motor = { position_deg = { file = \"angle.csv\", column = \"angle_deg\" }, stiffness = 100 }",
    ] {
        let scene = words(motor)?;
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
    assert!(
        !links.can_touch(1, 2) && links.can_touch(1, 0) && !links.can_touch(0, 2),
        "what is jointed does not touch either"
    );
    let pushed = links.forces[0].force[0].value_and_rate(0.5).0;
    assert_eq!(pushed, 5.0);
    Ok(())
}

#[test]
fn a_force_on_a_body_in_water_moves_the_water_too() -> Result<()> {
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
    // In air it would have 30 N · 0.05 s / 10 kg; the water goes along with 0.2 to 2 times the mass of a block of that breadth.
    assert!(0.15 / 3.0 < gained && gained < 0.15 / 1.2, "{gained} m/s");
    Ok(())
}
