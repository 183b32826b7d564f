//! Faces that cannot be are refused, and the numbers that the messages propose do.

use std::path::Path;

use pontoon::{
    error::Error,
    preflight::{FaceWave, Finding},
    scene::Scene,
};

use crate::common;

/// A channel, 4 m long and 0.4 m deep, with water at the speed of its inflow, these faces, and a lid if it is a duct.
fn channel(faces: &str, lid: bool, dp: f64) -> String {
    let lid = if lid {
        "{ name = \"lid\", fixed = true, shape = { box = { size = [9.0, 0.3] } }, at = [2.0, 0.55] },"
    } else {
        ""
    };
    format!(
        "dimension = 2\ndp = {dp}\nuntil = 2.0\n{faces}\n\
         water = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [4.0, 0.4] }} }}, velocity = [0.3, 0.0] }}]\n\
         solid = [{lid} {{ name = \"bed\", fixed = true, shape = {{ box = {{ size = [9.0, 0.3] }} }}, at = [2.0, -0.15] }}]\n"
    )
}

fn build(text: &str) -> Result<(), Error> {
    common::scene_simulation::<2>(text).map(|_| ())
}

/// The message and the remedy.
fn refusal(text: &str) -> String {
    let error = build(text).expect_err(text);
    format!("{} {}", error.message, error.help.unwrap_or_default())
}

/// The first number after `words`.
fn number_after(text: &str, words: &str) -> f64 {
    let rest = text.split(words).nth(1).unwrap_or_else(|| panic!("no {words:?} in {text}")).trim_start();
    rest.split([' ', ',', ';']).next().and_then(|word| word.parse().ok()).unwrap_or_else(|| panic!("{text}"))
}

#[test]
fn two_faces_at_one_place_are_refused() {
    let text = refusal(&channel(
        "inflow = [{ x = 0.0, velocity = 0.3 }, { x = 0.0, velocity = 0.2 }]\noutflow = [{ x = 4.0, velocity = 0.3 }]",
        false,
        0.04,
    ));
    assert!(text.contains("\"inflow\" and \"inflow_2\" are at one place, x = 0"), "{text}");
}

/// No speed of sound helps where the velocity grows without bound; the message gives the place of that.
#[test]
fn a_velocity_that_grows_without_bound_is_refused_with_its_place() {
    for (velocity, place) in [("0.3/(t-1)", "t = 1 s"), ("0.3/(y-0.1)", "y = 0.1 m"), ("0.1/(t-0.5037)", "t = 0.504 s")]
    {
        let faces =
            format!("inflow = [{{ x = 0.0, velocity = \"{velocity}\" }}]\noutflow = [{{ x = 4.0, velocity = 0.3 }}]");
        let text = refusal(&channel(&faces, false, 0.04));
        assert!(
            text.contains(&format!("grows without bound at {place}")) && !text.contains("c0"),
            "{velocity}: {text}"
        );
    }
}

/// Nothing fixes the pressure of a duct with a velocity at one end and nothing at the other; the level that the message proposes does, and
/// under a surface the same faces are sound.
#[test]
fn a_closed_duct_without_a_pressure_is_refused_with_the_level_that_would_do() {
    let faces = |level: &str| {
        format!(
            "inflow = [{{ x = 0.0, velocity = 0.3 }}]\noutflow = [{{ x = 4.0{level} }}]\ngravity = [0.0, 0.0]\nmodel = {{ c0 = 10.0 }}"
        )
    };
    let text = refusal(&channel(&faces(""), true, 0.04));
    assert!(text.contains("nothing holds the pressure") && text.contains("\"outflow\""), "{text}");
    let level = number_after(&text, "level =");
    build(&channel(&faces(&format!(", level = {level}")), true, 0.04)).expect("a pressure at one end");
    build(&channel("inflow = [{ x = 0.0, velocity = 0.3 }]\noutflow = [{ x = 4.0 }]", false, 0.04)).expect("a surface");
}

/// Too fast for the speed of sound, both proposed numbers do.
#[test]
fn a_velocity_that_sound_does_not_allow_is_refused_with_the_largest_that_would_do() {
    let scene = |speed: f64, c0: f64| {
        let faces = format!(
            "inflow = [{{ x = 0.0, velocity = {speed} }}]\noutflow = [{{ x = 4.0, velocity = {speed} }}]\nmodel = {{ c0 = {c0} }}"
        );
        channel(&faces, false, 0.04)
    };
    let text = refusal(&scene(7.0, 20.0));
    let (sound, speed) = (number_after(&text, "model.c0 ="), number_after(&text, "or a velocity of"));
    build(&scene(7.0, sound)).expect("fast sound");
    build(&scene(speed, 20.0)).expect("slow water");
    assert!(build(&scene(1.1 * speed, 20.0)).is_err(), "{speed} m/s is the largest, to two digits");
}

/// A wave that would leave against a current stops at it: the proposed period does not.
#[test]
fn waves_that_the_current_stops_are_refused_with_the_period_and_the_current_that_would_do() {
    let scene = |speed: f64, period: f64| {
        let faces = format!(
            "inflow = [{{ x = 0.0, velocity = {speed}, absorb_period = {period} }}]\noutflow = [{{ x = 4.0, velocity = {speed} }}]"
        );
        channel(&faces, false, 0.04)
    };
    let text = refusal(&scene(0.8, 0.8));
    let (speed, period) = (number_after(&text, "or: a current of"), number_after(&text, "or a period of"));
    build(&scene(0.8, period)).expect("long waves");
    build(&scene(speed, 0.8)).expect("a slow current");
    assert!(build(&scene(0.8, 0.9 * period)).is_err() && build(&scene(1.1 * speed, 0.8)).is_err(), "{text}");
}

fn report(wave: &str, velocity: f64) -> (Vec<Finding>, Vec<FaceWave>) {
    report_of(&format!(
        "inflow = [{{ x = 0.0, velocity = {velocity}, absorb = false, wave = {{ {wave} }} }}]\noutflow = [{{ x = 4.0, velocity = {velocity} }}]"
    ))
}

fn report_of(faces: &str) -> (Vec<Finding>, Vec<FaceWave>) {
    let scene = Scene::parse(&channel(faces, false, 0.04), Path::new(""), &[]).expect("a sound scene");
    let report = common::preflight_report(&scene);
    (report.findings, report.face_waves)
}

/// Waves shorter than dp resolves are a warning, with the dp and the shortest period that would do.
#[test]
fn waves_too_short_for_dp_are_a_warning_with_the_period_that_would_do() {
    let short = |period: f64| {
        let (findings, _) = report(&format!("regular = {{ height = 0.01, period = {period} }}"), 0.4);
        findings.into_iter().find(|f| f.topic == "short_waves")
    };
    let finding = short(0.35).expect("0.3 m is 8 dp");
    let period = number_after(&finding.mend, "or waves of");
    assert!(short(period).is_none() && short(0.9 * period).is_some(), "{finding:?}");
}

/// The report says what enters: height, period, and the length on the current, from (ω − k U)² = g k tanh kd.
#[test]
fn inspect_tells_which_sea_enters() {
    let (_, waves) = report("jonswap = { height = 0.04, peak_period = 1.3 }", 0.6);
    let [wave] = &waves[..] else { panic!("{waves:?}") };
    assert!((wave.height_m, wave.period_s, wave.components, wave.current_mps) == (0.04, 1.3, 40, 0.6), "{wave:?}");
    let (omega, k) = (std::f64::consts::TAU / wave.period_s, std::f64::consts::TAU / wave.length_m);
    let own = (9.81 * k * (0.4 * k).tanh()).sqrt();
    assert!(((omega - 0.6 * k) / own - 1.0).abs() < 1e-9, "{wave:?}");
}

/// A spectrum that comes against a current lacks the waves that the current stops: a note has their part of the energy.
#[test]
fn inspect_tells_what_of_a_sea_a_current_stops() {
    let against = |velocity: f64| {
        let wave = "jonswap = { height = 0.03, peak_period = 1.3 }";
        let (findings, waves) = report_of(&format!(
            "inflow = [{{ x = 0.0, velocity = {velocity} }}]\noutflow = [{{ x = 4.0, velocity = {velocity}, wave = {{ {wave} }} }}]"
        ));
        (findings.into_iter().find(|f| f.topic == "waves_left_out"), waves[0].left_out)
    };
    let (note, left_out) = against(0.3);
    let note = note.expect("short waves are stopped");
    let shown = number_after(&note.what, "lets in,");
    // Rounded upwards to two digits.
    assert!((left_out..1.1 * left_out).contains(&(0.01 * shown)) && left_out < 0.15, "{note:?}, {left_out}");
    let (none, all) = report("jonswap = { height = 0.03, peak_period = 1.3 }", 0.3);
    assert!(all[0].left_out == 0.0 && none.iter().all(|f| f.topic != "waves_left_out"), "{none:?}");
}

/// A buffer is filled to one level: channels with different levels at one face are refused.
#[test]
fn channels_with_different_levels_at_one_face_are_refused() {
    let scene = |level: f64| {
        let water = |y: [f64; 2], level: f64| {
            format!(
                "{{ fill = {{ box = {{ min = [0.0, {:?}, 0.0], max = [0.8, {:?}, {level:?}] }} }}, velocity = [0.3, 0.0, 0.0] }}",
                y[0], y[1]
            )
        };
        let solid = |name: &str, size: [f64; 3], at: [f64; 3]| {
            format!("{{ name = \"{name}\", fixed = true, shape = {{ box = {{ size = {size:?} }} }}, at = {at:?} }}")
        };
        format!(
            "dimension = 3\ndp = 0.05\nuntil = 1.0\ninflow = [{{ x = 0.0, velocity = 0.3 }}]\n\
             outflow = [{{ x = 0.8, velocity = 0.3 }}]\nwater = [{}, {}]\nsolid = [{}, {}, {}, {}]\n",
            water([0.0, 0.3], 0.5),
            water([0.5, 0.8], level),
            solid("bed", [4.0, 1.6, 0.2], [0.4, 0.4, -0.1]),
            solid("right", [4.0, 0.3, 0.8], [0.4, -0.15, 0.4]),
            solid("middle", [4.0, 0.2, 0.8], [0.4, 0.4, 0.4]),
            solid("left", [4.0, 0.3, 0.8], [0.4, 0.95, 0.4])
        )
    };
    let build = |text: &str| common::scene_simulation::<3>(text).map(|_| ());
    build(&scene(0.5)).expect("one level");
    let error = build(&scene(0.3)).expect_err("two levels").to_string();
    assert!(error.contains("buffer of open boundary \"inflow\"") && error.contains("one level"), "{error}");
}

/// Where a solid fills the lowest part of the region of the water, waves at a face are those of the depth above it.
#[test]
fn waves_at_a_face_have_the_depth_above_the_bed() {
    let faces = "inflow = [{ x = 0.0, velocity = 0.4, wave = { regular = { height = 0.02, period = 1.2 } } }]\n\
         outflow = [{ x = 4.0, velocity = 0.4 }]";
    let scene = |bottom: &str| {
        let text = channel(faces, false, 0.04).replace("min = [0.0, 0.0]", &format!("min = [0.0, {bottom}]"));
        Scene::parse(&text, Path::new(""), &[]).expect("a readable scene")
    };
    let at_faces = |bottom: &str| {
        let built = scene(bottom).build::<2>().expect("a sound scene");
        let faces = &built.setup.open_boundaries;
        let length = common::preflight_report(&scene(bottom)).face_waves[0].length_m;
        [length, faces[0].absorbed_speed.expect("it absorbs"), faces[1].absorbed_speed.expect("it absorbs")]
    };
    for (above, below) in at_faces("0.0").into_iter().zip(at_faces("-0.2")) {
        assert!((below / above - 1.0).abs() < 1e-9, "{below} instead of {above}");
    }
}
