//! Chains of prescribed motions of one solid: each acts in the frame moved by those before it, with exact rates.

use std::path::Path;

use pontoon::{
    Result,
    math::{Bivector, Matrix, Pose, Vector},
    scene::Scene,
    simulation::Simulation,
    solid::{Kinematics, PrescribedMotion, Role, TimeFunction},
};

use crate::common::{self, run_to};

/// Water 0.1 m deep in a tank of 0.4 m × 0.3 m at the origin with dp 10 mm. The tank has the motion `driven`.
fn tank(driven: &str) -> Result<Scene> {
    let text = format!(
        "dimension = 2\ndp = 0.01\nuntil = 0.3\nwater = [{{ fill = {{ box = {{ min = [0, 0], max = [0.4, 0.1] }} }} }}]\n\
         [[solid]]\nname = \"tank\"\nshape = {{ tank = {{ size = [0.4, 0.3] }} }}\ndriven = {driven}\n"
    );
    Scene::parse(&text, Path::new(""), &[])
}

/// The tank with this list of motions.
fn moving_tank(motions: &str) -> Result<Simulation<2>> {
    Simulation::new(tank(&format!("{{ motions = [{motions}] }}"))?.build::<2>()?.setup)
}

const SURGE: &str = "{ along = [1, 0], distance = { formula = \"0.01*(1-cos(5*t))\" } }";
const HEAVE: &str = "{ along = [0, 2], distance = { formula = \"0.004*(1-cos(7*t))\" } }";
const PITCH: &str = "{ hinge = [0.2, -0.1], angle_deg = { formula = \"3*(1-cos(6*t))\" } }";

#[test]
fn a_surging_heaving_and_pitching_tank_moves_by_the_exact_derivatives_and_holds_its_water() -> Result<()> {
    let mut sim = moving_tank(&format!("{SURGE}, {HEAVE}, {PITCH}"))?;
    // Pitch about a hinge that surges and heaves: x = c + s + R (x₀ − c).
    let (hinge, amplitude) = (Vector::from([0.2, -0.1]), 3f64.to_radians());
    while sim.time() < 0.3 {
        sim.step_to(0.3)?;
        let (t, now) = (sim.time(), sim.system().solids()[0].kinematics);
        let shift = Vector::from([0.01 * (1.0 - (5.0 * t).cos()), 0.004 * (1.0 - (7.0 * t).cos())]);
        let rate = Vector::from([0.05 * (5.0 * t).sin(), 0.028 * (7.0 * t).sin()]);
        let (angle, spin) = (amplitude * (1.0 - (6.0 * t).cos()), 6.0 * amplitude * (6.0 * t).sin());
        let (sin, cos) = angle.sin_cos();
        let arm = Vector::from([-0.2 * cos - 0.1 * sin, -0.2 * sin + 0.1 * cos]);
        // Round-off of lengths, speeds and spins of order 1 and below.
        assert_eq!(now.centre, now.pose.position, "the centre is the origin of the frame");
        assert!((now.centre - (hinge + shift + arm)).norm() < 1e-14, "{now:?} at {t} s");
        assert!((now.velocity - (rate + Vector::from([-arm[1], arm[0]]) * spin)).norm() < 1e-14, "{now:?} at {t} s");
        assert!((now.spin.axial()[0] - spin).abs() < 1e-14, "{now:?} at {t} s");
    }
    // The tank moves by 9 mm and 4°. No particle leaks through bottom or sides.
    let pose = sim.system().solids()[0].kinematics.pose;
    let inside = |r: &Vector<2>| (0.0..0.4).contains(&r[0]) && (0.0..0.2).contains(&r[1]);
    assert!(sim.system().fluid().r.iter().all(|r| inside(&pose.local(r))));
    Ok(())
}

#[test]
fn a_body_accelerated_along_two_axes_feels_its_added_mass_along_both() -> Result<()> {
    let mean = |sense: &str| -> Result<Vector<2>> {
        let law = format!("distance = {{ formula = \"{sense}0.5*t^2\" }}");
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 0.1\nwater = [{{ fill = {{ box = {{ min = [0, 0], max = [1, 0.6] }} }} }}]\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.0, 0.8] }} }}\n\
             [[solid]]\nname = \"body\"\nshape = {{ box = {{ size = [0.2, 0.2] }} }}\nat = {{ x = 0.5, y = 0.3 }}\n\
             driven = {{ motions = [{{ along = [1, 0], {law} }}, {{ along = [0, 1], {law} }}] }}\n"
        );
        let mut sim = common::scene_simulation::<2>(&text)?;
        let (mut sum, mut time) = (Vector::zeros(), 0.0);
        while sim.time() < 0.1 {
            sim.step_to(0.1)?;
            // The sound wave of the start has passed by then.
            if sim.time() > 0.04 {
                sum += sim.system().solids()[1].load.force * sim.dt();
                time += sim.dt();
            }
        }
        Ok(sum / time)
    };
    // Half of the difference excludes the buoyancy. The added mass of a square in unbounded water is 1.19 times its displaced mass of
    // 40 kg/m, and it is larger near walls and a bed. At 1 m/s² the force is −40 to −80 N/m along each axis.
    let force = (mean("")? - mean("-")?) * 0.5;
    assert!(force.iter().all(|component| (-80.0..-40.0).contains(component)), "{force:?} N/m");
    Ok(())
}

#[test]
fn two_equal_translations_equal_one_of_twice_the_distance_also_after_a_restart() -> Result<()> {
    let slide = |formula: &str| format!("{{ along = [1, 0], distance = {{ formula = \"{formula}\" }} }}");
    let half = slide("0.01*(1-cos(9*t))");
    let mut two = moving_tank(&format!("{half}, {half}"))?;
    let mut one = Simulation::new(tank(&slide("2*(0.01*(1-cos(9*t)))"))?.build::<2>()?.setup)?;
    for step in 0..40 {
        if step == 20 {
            let state = two.save()?;
            two = moving_tank(&format!("{half}, {half}"))?;
            two.restore(&state)?;
        }
        one.step()?;
        two.step()?;
    }
    // Doubling a number is exact and the frame starts at the origin, so the bits are equal.
    assert_eq!(one.system().solids()[0].kinematics, two.system().solids()[0].kinematics);
    assert_eq!(one.system().fluid().r, two.system().fluid().r);
    Ok(())
}

/// Kinematics at 1 s of a solid that starts at `at` and has these `motions`.
fn after_a_second<const D: usize>(at: &str, motions: &str) -> Result<Kinematics<D>>
where
    pontoon::solid::Dim<D>: pontoon::simulation::Dimension<D>,
{
    let corner = vec!["1"; D].join(", ");
    let size = vec!["0.1"; D].join(", ");
    let text = format!(
        "dimension = {D}\ndp = 0.1\nuntil = 1.0\nwater = [{{ fill = {{ box = {{ min = [{}], max = [{corner}] }} }} }}]\n\
         [[solid]]\nname = \"head\"\nshape = {{ box = {{ size = [{size}] }} }}\nat = {{ {at} }}\n\
         driven = {{ motions = [{motions}] }}\n",
        vec!["0"; D].join(", ")
    );
    let setup = Scene::parse(&text, Path::new(""), &[])?.build::<D>()?.setup;
    let Role::Driven(motion) = &setup.solids[0].role else { panic!("it is driven") };
    Ok(motion.kinematics(&setup.solids[0].pose, 1.0))
}

#[test]
fn the_order_of_a_translation_and_a_rotation_determines_the_motion() -> Result<()> {
    let turn = "{ hinge = [3, 0], angle_deg = { formula = \"90*t\" } }";
    let slide = "{ along = [1, 0], distance = { formula = \"2*t\" } }";
    let of = |motions: String| after_a_second::<2>("x = 3, y = 1", &motions);
    let (rail, cart) = (of(format!("{turn}, {slide}"))?, of(format!("{slide}, {turn}"))?);
    // The solid starts 1 m above the hinge. A rail on the turntable points up at 1 s; a turntable on the rail has moved by 2 m. The
    // bounds are round-off.
    assert!((rail.pose.position - Vector::from([2.0, 2.0])).norm() < 1e-14, "{rail:?}");
    assert!((cart.pose.position - Vector::from([4.0, 0.0])).norm() < 1e-14, "{cart:?}");
    let w = std::f64::consts::FRAC_PI_2;
    assert!((rail.velocity - Vector::from([-2.0 * w, 2.0 - w])).norm() < 1e-14, "{rail:?}");
    assert!((cart.velocity - Vector::from([2.0, -w])).norm() < 1e-14, "{cart:?}");
    Ok(())
}

#[test]
fn rotations_about_two_axes_compose_to_the_product_of_their_matrices() -> Result<()> {
    let turn = |axis: &str, rate: f64| {
        format!("{{ hinge = [3, 0, 0], axis = [{axis}], angle = {{ formula = \"{rate}*t\" }} }}")
    };
    let (yaw, roll) = (turn("0, 0, 1", 0.5), turn("2, 0, 0", 0.8));
    let of = |motions: String| after_a_second::<3>("x = 3, y = 0.6, z = 0.2", &motions);
    let rotation = |axial: [f64; 3]| -> Matrix<3> { Bivector::from_axial(&axial).exp() };
    let (z, x) = (rotation([0.0, 0.0, 0.5]), rotation([0.8, 0.0, 0.0]));
    let (rolled, yawed) = (of(format!("{yaw}, {roll}"))?, of(format!("{roll}, {yaw}"))?);
    assert!((rolled.pose.rotation - z * x).norm() < 1e-14 && (yawed.pose.rotation - x * z).norm() < 1e-14);
    assert!((rolled.pose.rotation - yawed.pose.rotation).norm() > 0.1, "the order matters");
    // The outer rotation carries the inner axis: Ω = 0.5 e_z + 0.8 R_z e_x.
    let spin = Vector::from([0.8 * 0.5f64.cos(), 0.8 * 0.5f64.sin(), 0.5]);
    assert!((Vector::<3>::from_iterator(rolled.spin.axial()) - spin).norm() < 1e-14, "{rolled:?}");
    let arm = z * x * Vector::from([0.0, 0.6, 0.2]);
    assert!((rolled.velocity - spin.cross(&arm)).norm() < 1e-14, "{rolled:?}");
    Ok(())
}

#[test]
fn an_invalid_list_of_motions_is_refused_with_a_remedy() {
    let wave = "{ along = [1, 0], wave = { regular = { height = 0.02, period = 1.2 } } }";
    let cases: [(&str, &[&str]); 7] = [
        ("{ motions = [] }", &["the list of motions is empty", "driven.motions", "write  motions = ["]),
        (&format!("{{ motions = [{SURGE}, {wave}] }}"), &["has no other motion beside it", "wave"]),
        (&format!("{{ motions = [{{ motions = [{SURGE}] }}] }}"), &["a list of motions within another", "in one list"]),
        (&format!("{{ motions = [{SURGE}], along = [1, 0] }}"), &["along stands beside motions", "driven.along"]),
        ("{ motions = [{ along = [1, 0] }] }", &["this does not say one motion", "driven.motions.0"]),
        (
            &format!("{{ motions = [{SURGE}, {{ along = [0, 0], distance = {{ formula = \"t\" }} }}] }}"),
            &["along points nowhere"],
        ),
        ("{ along = [1, 0], hinge = [0, 0] }", &["this does not say one motion", "motions = [{ .. }, { .. }]"]),
    ];
    for (words, expected) in cases {
        let message = tank(words).and_then(|scene| scene.build::<2>().map(|_| ())).expect_err(words).to_string();
        for part in expected {
            assert!(message.contains(part), "{words}: \"{part}\" is not in\n{message}");
        }
    }
    // The Rust interface refuses it as well.
    let chain = PrescribedMotion::<2>::chain([]).check().expect_err("empty").to_string();
    assert!(chain.contains("its list of motions is empty"), "{chain}");
}

#[test]
fn a_scene_with_a_list_of_motions_survives_writing_and_reading() -> Result<()> {
    let scene = tank(&format!("{{ motions = [{SURGE}, {PITCH}] }}"))?;
    assert!(Scene::parse(&scene.to_toml()?, Path::new(""), &[])? == scene, "{}", scene.to_toml()?);
    let one = PrescribedMotion::chain([PrescribedMotion::slide(Vector::from([1.0, 0.0]), TimeFunction::constant(0.1))]);
    let still = one.kinematics(&Pose::identity(), 2.0);
    assert_eq!(
        (still.centre, still.velocity),
        (Vector::from([0.1, 0.0]), Vector::zeros()),
        "a list of one motion equals the motion"
    );
    Ok(())
}

/// A body slides down along a solid that turns about a hinge, here by nothing, until the end stop 0.05 m below holds it.
#[test]
fn an_end_stop_against_a_solid_that_turns_about_a_hinge_acts_at_its_place() -> Result<()> {
    let text = "dimension = 2\ndp = 0.05\nuntil = 0.5\nwater = [{ fill = { box = { min = [3.0, 0.0], max = [3.5, 0.3] } } }]\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [0.5, 0.5] } }\nat = [3.0, 0.0]\n\
         [[solid]]\nname = \"arm\"\nshape = { box = { size = [0.2, 0.2] } }\nat = [0.0, 2.0]\n\
         driven = { hinge = [2.0, 5.0], angle = { formula = \"0*t\" } }\n\
         [[solid]]\nname = \"body\"\nshape = { box = { size = [0.2, 0.2] } }\nat = [0.0, 1.5]\nfree = { mass = 20.0 }\n\
         [[joint]]\nname = \"rail\"\nkind = \"slider\"\nbetween = [\"arm\", \"body\"]\nat = [0.0, 1.5]\n\
         along = [0.0, 1.0]\nlimits = [-0.05, 0.05]\n";
    let mut sim = common::scene_simulation::<2>(text)?;
    run_to(&mut sim, 0.5)?;
    // The engine leaves a thousandth of a dp.
    let fall = 1.5 - sim.system().solids()[2].kinematics.pose.position[1];
    assert!((fall - 0.05).abs() < 5e-5, "{fall} m");
    Ok(())
}

/// A solid 2 m beside the hinge of its motion goes 0.08 m down and up within 0.785 s. It bears two bodies on ropes, one under the other.
#[test]
fn bodies_on_ropes_in_series_follow_a_solid_that_turns_about_a_hinge() -> Result<()> {
    let turn = "hinge = [2.0, 2.0], angle = { formula = \"0.02*(1-cos(8*t))\" }";
    let no_slide = "{ along = [1.0, 0.0], distance = { formula = \"0\" } }";
    let body = |name: &str, y: f64, role: &str| {
        format!(
            "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [0.2, 0.2] }} }}\nat = [0.0, {y:?}]\n{role}\n"
        )
    };
    let rope = |[above, below]: [&str; 2], y: f64| {
        format!(
            "[[rope]]\nname = \"{below}\"\nbetween = [\"{above}\", \"{below}\"]\nfrom = [0.0, {y:?}]\nto = [0.0, {:?}]\n",
            y - 0.3
        )
    };
    // The same motion, alone and in a list.
    for motion in [turn.to_owned(), format!("motions = [{{ {turn} }}, {no_slide}]")] {
        let text = format!(
            "dimension = 2\ndp = 0.05\nuntil = 0.8\nwater = [{{ fill = {{ box = {{ min = [3.0, 0.0], max = [3.5, 0.3] }} }} }}]\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [0.5, 0.5] }} }}\nat = [3.0, 0.0]\n{}{}{}{}{}",
            body("arm", 2.0, &format!("driven = {{ {motion} }}")),
            body("upper", 1.5, "free = { mass = 20.0 }"),
            body("lower", 1.0, "free = { mass = 20.0 }"),
            rope(["arm", "upper"], 1.9),
            rope(["upper", "lower"], 1.4),
        );
        let mut sim = common::scene_simulation::<2>(&text)?;
        while sim.time() < 0.8 {
            sim.step_to(0.8)?;
            let [arm, upper, lower] = [1, 2, 3].map(|i| sim.system().solids()[i].kinematics.pose);
            let end = arm.point(&Vector::from([0.0, -0.1]))[1];
            // The ropes lean by less than 0.03 rad, which lifts each body by 0.03²/2 of its 0.3 m and 0.8 m.
            assert!(
                (end - upper.position[1] - 0.4).abs() < 5e-4,
                "{} m of {end} m at {} s",
                upper.position[1],
                sim.time()
            );
            assert!(
                (end - lower.position[1] - 0.9).abs() < 5e-4,
                "{} m of {end} m at {} s",
                lower.position[1],
                sim.time()
            );
            // 20 kg/m below each against gravity and the arm, half a step late, by 0.2 %. The last steps are half as long.
            let pull = 20.0 * (9.81 - 2.56 * (8.0 * sim.time()).cos());
            for (rope, exact) in [2.0 * pull, pull].into_iter().enumerate() {
                let tension = sim.rope_reading(rope).tension;
                assert!((tension / exact - 1.0).abs() < 5e-3, "{tension} N of {exact} N at {} s", sim.time());
            }
        }
    }
    Ok(())
}
