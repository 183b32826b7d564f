//! Paddles that absorb: what comes to them does not go back, their own wave goes on, and their state is kept.

use std::{f64::consts::TAU, path::Path};

use pontoon::{
    Error,
    math::Vector,
    preflight,
    scene::{BuiltScene, Scene},
    simulation::Simulation,
};

/// A basin one half of a wave long, whose left end is a box; water 0.12 m deep is in it, about to rise at the left. The wave
/// is 1.2 m long: ω² = g k tanh kd.
const BASIN: &str = r#"title     = "A standing wave is let go"
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

/// Its period, s.
const PERIOD: f64 = 1.175;

const TAKER: &str = "driven = { along = [1.0, 0.0], wave = { absorb = { period = 1.175 } } }";

fn built(end: &str) -> Result<BuiltScene<2>, Error> {
    Scene::parse(&BASIN.replace("END", end), Path::new(""), &[])?.build()
}

fn basin(end: &str) -> Simulation<2> {
    Simulation::new(built(end).unwrap().setup).unwrap()
}

#[test]
fn a_standing_wave_is_gone_after_one_period_before_a_paddle_that_absorbs() {
    // Mean energy of the motion over the second period.
    let left = |end: &str| {
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
    let (wall, taker) = (left("fixed = true"), left(TAKER));
    // In one period all of it has met the paddle once. By linear theory nothing is left but of the first moments, as the
    // paddle sets out from rest: a fifth of the amplitude would be 0.04 of the energy.
    assert!(taker < 0.04 * wall, "{taker} of {wall}");
}

#[test]
fn a_basin_in_tune_with_its_paddle_holds_twice_the_wave_and_no_more() {
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
    // 2H at the wall, cos k(0.6 − 0.565) of it here. A paddle that does not absorb sends all back in step: after five periods
    // ten times H. A fifth is the height that two dp of wave lose and gauges miss.
    let share = (high - low) / (2.0 * 0.02 * (TAU / 1.2 * 0.035).cos());
    assert!((0.8..1.2).contains(&share), "{share}");
}

#[test]
fn a_run_with_a_paddle_that_absorbs_goes_on_to_the_same_bits_on_any_number_of_threads() {
    let steps = |sim: &mut Simulation<2>, n: usize| (0..n).for_each(|_| sim.step().unwrap());
    let runs: Vec<Vec<u8>> = [1, 3]
        .into_iter()
        .map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut sim = basin(TAKER);
                steps(&mut sim, 150);
                sim.save().unwrap()
            })
        })
        .collect();
    assert!(runs[0] == runs[1]);
    let mut first = basin(TAKER);
    steps(&mut first, 70);
    let kept = first.save().unwrap();
    let mut again = basin(TAKER);
    again.restore(&kept).unwrap();
    assert!(again.save().unwrap() == kept, "what was kept comes back whole");
    steps(&mut again, 80);
    assert!(again.save().unwrap() == runs[0]);
    let place = |sim: &Simulation<2>| sim.system().solids()[1].kinematics.pose.position[0];
    assert!((place(&again) + 0.025).abs() > 1e-4, "it has yielded");
}

#[test]
fn words_of_absorption_that_cannot_be_meant_are_named_with_what_can() {
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
fn what_a_paddle_absorbs_is_told_before_a_run() {
    let told = |end: &str| {
        let BuiltScene { setup, plan, removed_by_solids, still_water, .. } = built(end).unwrap();
        preflight::preflight(&Simulation::new(setup).unwrap(), &plan, still_water, removed_by_solids, &[]).absorbers
    };
    assert!(told("fixed = true").is_empty());
    let own = &told(TAKER)[0];
    // The kernel's reach before the face: 2 · 1.7 dp.
    assert!((own.period_s - 1.175).abs() < 1e-12 && (own.gauge_m - 0.034).abs() < 1e-12, "{own:?}");
    assert!(own.sends_back.iter().all(|(_, share)| (1e-4..0.1).contains(share)), "{own:?}");
    let flap = "driven = { hinge = [0.0, 0.0], wave = { regular = { height = 0.02, period = 1.2 }, absorb = { stroke = 0.2 } } }";
    let own = &told(flap)[0];
    assert!((own.stroke_m - 0.2).abs() < 1e-12 && (own.period_s - 1.2).abs() < 1e-12, "{own:?}");
}
