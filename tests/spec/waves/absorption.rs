//! Active absorption: reflected waves are absorbed, the generated wave continues, and the state is part of a checkpoint.

use std::{f64::consts::TAU, path::Path};

use pontoon::{
    Error,
    math::Vector,
    scene::{BuiltScene, Scene},
    simulation::Simulation,
};

use crate::common;

/// A basin half a wavelength long with water 0.12 m deep and a box as its left end. The standing wave is about to rise at the
/// left. Its length is 1.2 m: ω² = g k tanh kd.
const BASIN: &str = r#"title     = "A standing wave is released"
dimension = 2
dp        = 0.01
until     = 3.0
frames    = "off"

[[water]]
fill     = { box = { min = [0.0, 0.0], max = [0.6, 0.12] } }
velocity = ["-0.115*sin(5.236*x)*cosh(5.236*y)/cosh(0.628)", "0.115*cos(5.236*x)*sinh(5.236*y)/cosh(0.628)"]

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.3] } }
at    = { x = -0.2 }

[[solid]]
name  = "end"
shape = { box = { size = [0.05, 0.3] } }
at    = { x = -0.025, bottom = 0.0 }
END
"#;

/// Period of the standing wave, s.
const PERIOD: f64 = 1.175;

const ABSORBER: &str = "driven = { along = [1.0, 0.0], wave = { absorb = { period = 1.175 } } }";

fn scene(end: &str) -> Result<Scene, Error> {
    Scene::parse(&BASIN.replace("END", end), Path::new(""), &[])
}

fn built(end: &str) -> Result<BuiltScene<2>, Error> {
    scene(end)?.build()
}

fn basin(end: &str) -> Simulation<2> {
    Simulation::new(built(end).unwrap().setup).unwrap()
}

#[test]
fn an_absorbing_paddle_removes_a_standing_wave_within_one_period() {
    // Mean kinetic energy over the second period.
    let mean_energy = |end: &str| {
        let mut sim = basin(end);
        let (mut sum, mut count) = (0.0, 0);
        while sim.time() < 2.0 * PERIOD {
            sim.step().unwrap();
            if sim.time() > PERIOD {
                (sum, count) = (sum + sim.system().kinetic_energy(), count + 1);
            }
        }
        sum / f64::from(count)
    };
    let (wall, absorber) = (mean_energy("fixed = true"), mean_energy(ABSORBER));
    // In one period the whole wave reaches the paddle once. In linear theory only the start from rest leaves a remainder. The bound
    // is a fifth of the amplitude, which is 0.04 of the energy.
    assert!(absorber < 0.04 * wall, "{absorber} of {wall}");
}

#[test]
fn an_absorbing_paddle_limits_a_resonant_basin_to_twice_the_wave_height() {
    let mut sim = basin(
        "driven = { along = [1.0, 0.0], wave = { regular = { height = 0.02, period = 1.175 }, ramp = 1.175, absorb = true } }",
    );
    sim.set_water_velocity(|_| Vector::zeros());
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    while sim.time() < 6.0 * PERIOD {
        sim.step().unwrap();
        if sim.time() > 5.0 * PERIOD {
            let level = sim.system().surface_heights(&Vector::from([0.565, 0.0])).next().unwrap();
            (low, high) = (low.min(level), high.max(level));
        }
    }
    // 2H at the wall, times cos k(0.6 − 0.565) at the gauge. Without absorption the paddle reflects in phase, which gives ten times H
    // after five periods. The bound of a fifth covers the loss of a wave of two dp and the error of the gauge.
    let share = (high - low) / (2.0 * 0.02 * (TAU / 1.2 * 0.035).cos());
    assert!((0.8..1.2).contains(&share), "{share}");
}

#[test]
fn a_run_with_an_absorbing_paddle_has_the_same_bits_after_a_restart_and_on_any_number_of_threads() {
    let runs: Vec<Vec<u8>> = [1, 3]
        .into_iter()
        .map(|threads| {
            common::on_threads(threads, || {
                let mut sim = basin(ABSORBER);
                common::steps(&mut sim, 150);
                sim.save().unwrap()
            })
        })
        .collect();
    assert!(runs[0] == runs[1]);
    let mut first = basin(ABSORBER);
    common::steps(&mut first, 70);
    let saved = first.save().unwrap();
    let mut again = basin(ABSORBER);
    again.restore(&saved).unwrap();
    assert!(again.save().unwrap() == saved, "a restored state saves to the same bytes");
    common::steps(&mut again, 80);
    assert!(again.save().unwrap() == runs[0]);
    let position = |sim: &Simulation<2>| sim.system().solids()[1].kinematics.pose.position[0];
    assert!((position(&again) + 0.025).abs() > 1e-4, "the paddle moved to absorb");
}

#[test]
fn invalid_absorption_keys_are_refused_with_the_key_and_a_remedy() {
    let wave = |words: &str| format!("driven = {{ along = [1.0, 0.0], wave = {{ {words} }} }}");
    let regular = "regular = { height = 0.02, period = 1.2 }";
    let cases: [(String, &str, &str); 8] = [
        (wave("absorb = true"), "wave.absorb", "period = 1.2"),
        (wave("absorb = false"), "driven.wave", "which wave"),
        (wave("absorb = 2.0"), "wave.absorb", "true, or a table"),
        (wave("absorb = { period = 0.0 }"), "absorb.period", "positive"),
        (wave("absorb = { perod = 1.0 }"), "absorb.perod", "did you mean \"period\""),
        (wave("absorb = { period = 0.2 }"), "wave.absorb", "a smaller dp"),
        (wave(&format!("{regular}, absorb = {{ stroke = 0.01 }}")), "wave.absorb", "a stroke of"),
        (wave(&format!("{regular}, absorb = {{ speed = 0.01 }}")), "wave.absorb", "a speed of"),
    ];
    for (end, key, advice) in cases {
        let message = built(&end).map(|_| ()).expect_err(&end).to_string();
        assert!(
            message.contains(key) && message.contains(advice) && message.contains("scene.toml:21:"),
            "{end}:\n{message}"
        );
    }
}

#[test]
fn preflight_reports_the_absorbing_paddles() {
    let absorbers = |end: &str| common::preflight_report(&scene(end).unwrap()).absorbers;
    assert!(absorbers("fixed = true").is_empty());
    let own = &absorbers(ABSORBER)[0];
    // The gauge stands one support radius before the face: 2 · 2.4 dp.
    assert!((own.period_s - 1.175).abs() < 1e-12 && (own.gauge_m - 0.048).abs() < 1e-12, "{own:?}");
    assert!(own.sends_back.iter().all(|(_, share)| (1e-4..0.1).contains(share)), "{own:?}");
    let flap = "driven = { hinge = [0.0, 0.0], wave = { regular = { height = 0.02, period = 1.2 }, absorb = { stroke = 0.2 } } }";
    let own = &absorbers(flap)[0];
    assert!((own.stroke_m - 0.2).abs() < 1e-12 && (own.period_s - 1.2).abs() < 1e-12, "{own:?}");
}

/// A basin in 3-D, 0.8 m long, 0.5 m wide and 0.2 m deep, turned by `turn` (degrees) in plan, whose water moves towards an absorbing
/// paddle at 0.3 m/s. `sides` are planes or periodic sides in place of its walls; the paddle reaches from the first to the second y of
/// `paddle`.
fn turned_basin(turn: f64, sides: &str, paddle: [f64; 2]) -> Simulation<3> {
    let (sin, cos) = turn.to_radians().sin_cos();
    let at = |[x, y, z]: [f64; 3]| {
        format!("{{ x = {}, y = {}, z = {z}, turn_deg = [0.0, 0.0, {turn:?}] }}", x * cos - y * sin, x * sin + y * cos)
    };
    let solid = |name: &str, size: [f64; 3], place: [f64; 3], role: &str| {
        format!("[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = {size:?} }} }}\nat = {}\n{role}\n", at(place))
    };
    let wall = |name: &str, size: [f64; 3], place: [f64; 3]| solid(name, size, place, "fixed = true");
    let walls = match sides {
        "" => wall("right", [2.0, 0.3, 0.6], [0.4, -0.15, 0.3]) + &wall("left", [2.0, 0.3, 0.6], [0.4, 0.65, 0.3]),
        sides if sides.contains("symmetry") => wall("left", [2.0, 0.3, 0.6], [0.4, 0.65, 0.3]),
        _ => String::new(),
    };
    let absorbs = format!("driven = {{ along = [{cos}, {sin}, 0.0], wave = {{ absorb = {{ period = 1.0 }} }} }}");
    let (wide, middle) = (paddle[1] - paddle[0], 0.5 * (paddle[0] + paddle[1]));
    common::scene_simulation::<3>(&format!(
        "dimension = 3\ndp = 0.05\nuntil = 1.0\n{sides}\n[[water]]\nfill = {{ shape = {{ box = {{ size = [0.8, 0.5, 0.2] }} }}, at = {} }}\n\
         velocity = [{}, {}, 0.0]\n{}{}{}{walls}",
        at([0.4, 0.25, 0.1]),
        -0.3 * cos,
        -0.3 * sin,
        wall("bed", [2.0, 3.6, 0.2], [0.4, 0.0, -0.1]),
        wall("end", [0.2, 3.6, 0.6], [0.9, 0.0, 0.3]),
        solid("paddle", [0.2, wide, 0.6], [-0.1, middle, 0.3], &absorbs)
    ))
    .expect("a sound scene")
}

/// How far (m) the paddle has yielded to the water after 0.3 s.
fn yielded(turn: f64, sides: &str, paddle: [f64; 2]) -> f64 {
    let mut sim = turned_basin(turn, sides, paddle);
    common::run_to(&mut sim, 0.3).expect("a sound run");
    let (sin, cos) = turn.to_radians().sin_cos();
    let paddle = sim.system().solids().iter().find(|solid| solid.spec.name == "paddle").expect("a paddle");
    (paddle.spec.pose.position - paddle.kinematics.pose.position).dot(&Vector::from([cos, sin, 0.0]))
}

/// The gauge of an oblique paddle is before its face, not before the box around it, where the water has not risen yet.
#[test]
fn an_absorbing_paddle_yields_alike_in_every_direction() {
    let [straight, oblique] = [0.0, 45.0].map(|turn| yielded(turn, "", [0.0, 0.5]));
    // The water is packed to the walls in another way: 5 % of the way.
    assert!(straight > 0.005 && (oblique / straight - 1.0).abs() < 0.1, "{oblique} m instead of {straight} m");
}

/// A paddle that reaches beyond a periodic side or a symmetry plane has its gauge in the water all the same.
#[test]
fn an_absorbing_paddle_wider_than_the_water_has_its_gauge_in_the_water() {
    for (sides, centred, aside) in [
        ("periodic = { y = [0.0, 0.5] }", [-0.6, 1.1], [-1.4, 1.0]),
        ("symmetry = { y = 0.0 }", [-0.5, 0.9], [-1.3, 0.5]),
    ] {
        let [centred, aside] = [centred, aside].map(|paddle| yielded(0.0, sides, paddle));
        // The water rises alike over the width, so the place of the gauge across it matters little.
        assert!(centred > 0.005 && (aside / centred - 1.0).abs() < 0.01, "{sides}: {aside} m instead of {centred} m");
    }
}
