//! Wavemakers of a scene: refused keys, the preflight report of a wave, its findings, and the generated wave height.

use std::{f64::consts::TAU, path::Path};

use pontoon::{
    Error,
    math::Vector,
    model::{Model, TimeScheme, Viscosity},
    preflight::{Finding, GeneratedWave, Preflight},
    scene::{BuiltScene, DrivenConfig, ProbeConfig, Scene, ShapeConfig, SolidConfig, SpongeLayerConfig, WaveConfig},
    simulation::{Setup, Simulation},
    system::SpongeLayer,
    wavemaker::TheoryRegion,
};

use crate::common::{self, TestFolder};

/// A valid flume with waves of 1.2 s and 1.78 m at kd = 1.06.
const FLUME: &str = r#"title     = "A flume"
dimension = 2
dp        = 0.02
until     = 6.0
frames    = "off"

[[water]]
fill = { box = { min = [0.0, 0.0], max = [5.0, 0.3] } }

[[solid]]
name  = "tank"
fixed = true
shape = { tank = { size = [5.2, 0.6] } }
at    = { x = -0.2 }

[[solid]]
name   = "paddle"
shape  = { box = { size = [0.1, 0.6] } }
at     = { x = -0.05, bottom = 0.0 }
driven = { along = [1.0, 0.0], wave = { regular = { height = 0.1, period = 1.2 } } }
"#;

const PISTON: &str = "along = [1.0, 0.0], wave = { regular = { height = 0.1, period = 1.2 } }";

fn flume(driven: &str) -> String {
    assert!(FLUME.contains(PISTON));
    FLUME.replacen(PISTON, driven, 1)
}

fn built(text: &str) -> Result<BuiltScene<2>, Error> {
    Scene::parse(text, Path::new(""), &[])?.build()
}

fn report_of(text: &str) -> Preflight {
    common::preflight_report(&Scene::parse(text, Path::new(""), &[]).unwrap())
}

fn report(driven: &str) -> Preflight {
    report_of(&flume(driven))
}

fn wave(driven: &str) -> GeneratedWave {
    report(driven).waves.remove(0)
}

/// The number after `key` in `text`.
fn number(text: &str, key: &str) -> f64 {
    let after = text.split(key).nth(1).unwrap_or_else(|| panic!("no {key:?} in {text:?}"));
    let digits: String = after.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    digits.parse().unwrap()
}

/// The finding of this topic about a scene, if any.
fn finding(text: &str, topic: &str) -> Option<Finding> {
    report_of(text).findings.into_iter().find(|f| f.topic == topic)
}

#[test]
fn invalid_wave_keys_are_refused_with_file_line_key_and_remedy() {
    let piston = |wave: &str| format!("along = [1.0, 0.0], wave = {{ {wave} }}");
    let flap =
        |height: f64| format!("hinge = [0.0, {height:?}], wave = {{ regular = {{ height = 0.1, period = 1.2 }} }}");
    let cases: [(String, &str, &str); 20] = [
        (piston("regular = { height = 0.3, period = 1.2 }"), "wave.regular.height", "highest that does not is 0.197 m"),
        (piston("regular = { height = 0.1, period = 0.0 }"), "wave.regular.period", "positive"),
        (piston("regular = { height = -0.1, period = 1.0 }"), "wave.regular.height", "positive"),
        (piston("regular = { height = 0.1 }"), "wave.regular.period", "missing"),
        (piston("regular = { height = 0.1, period = 1.2, order = 3 }"), "wave.regular.order", "order = 1"),
        (piston("reglar = { height = 0.1, period = 1.2 }"), "wave.reglar", "did you mean \"regular\""),
        (
            piston("solitary = { height = 0.1 }, jonswap = { height = 0.1, peak_period = 1.2 }"),
            "driven.wave",
            "jonswap",
        ),
        (piston("ramp = 2.0"), "driven.wave", "which wave"),
        (piston("solitary = { height = 0.25 }"), "wave.solitary.height", "0.234 m"),
        (piston("jonswap = { height = 0.1 }"), "wave.jonswap.peak_period", "missing"),
        (piston("jonswap = { height = 0.1, peak_period = 1.2, components = 0 }"), "wave.jonswap", "components"),
        (piston("bretschneider = { height = 0.1, peak_period = 1.2, gamma = 3.3 }"), "bretschneider.gamma", "jonswap"),
        (piston("pierson_moskowitz = { height = 0.1, peak_period = 1.2 }"), "moskowitz.peak_period", "bretschneider"),
        (piston("components = { file = \"none.csv\" }"), "wave.components.file", "no file"),
        (piston("regular = { height = 0.1, period = 60.0, order = 1 }"), "driven.wave", "the water is 5.000 m long"),
        // The paddle speed of first order is 0.6 m/s and the celerity 1.7 m/s; the second order exceeds both.
        (piston("regular = { height = 0.2, period = 5.0 }"), "wave.regular.height", "period = 1.2"),
        (
            piston("focused = { crest = 0.05, peak_period = 1.2, distance = 0.0, time = 9.0 }"),
            "wave.focused.distance",
            "positive",
        ),
        (flap(0.28), "wave.regular.height", "60 is the most"),
        (flap(0.35), "driven.hinge", "above the still level"),
        (PISTON.replace("[1.0, 0.0]", "[-1.0, 0.0]"), "driven.along", "no water before the paddle"),
    ];
    for (driven, key, advice) in cases {
        let message = built(&flume(&driven)).map(|_| ()).expect_err(&driven).to_string();
        assert!(message.contains(key) && message.contains(advice), "{driven}:\n{message}");
        // The message names the line of the keys.
        assert!(message.contains("scene.toml:20:"), "{message}");
    }
    let flap = flume("hinge = [0.0, 0.0], wave = { solitary = { height = 0.1 } }");
    assert!(built(&flap).map(|_| ()).unwrap_err().to_string().contains("needs a piston"));
    let both = flume("along = [1.0, 0.0], distance = { formula = \"t\" }, wave = { solitary = { height = 0.1 } }");
    assert!(built(&both).map(|_| ()).unwrap_err().to_string().contains("one motion"));
}

#[test]
fn a_wave_built_in_rust_equals_the_same_wave_of_a_scene() {
    let paddle = |motion: DrivenConfig| {
        let at = pontoon::scene::PlacementConfig::point(&[-0.05]).bottom(0.0);
        let tank = SolidConfig::fixed("tank", ShapeConfig::tank([5.2, 0.6]))
            .at(pontoon::scene::PlacementConfig::point(&[-0.2]));
        Scene::new(2, 0.02, 6.0)
            .title("A flume")
            .water_box([0.0, 0.0], [5.0, 0.3])
            .solid(tank)
            .solid(SolidConfig::driven("paddle", ShapeConfig::cuboid([0.1, 0.6]), motion).at(at))
            .without_frames()
    };
    let piston = paddle(DrivenConfig::piston([1.0, 0.0], WaveConfig::regular(0.1, 1.2)));
    assert_eq!(piston, Scene::parse(FLUME, Path::new(""), &[]).unwrap());
    let again = Scene::parse(&piston.to_toml().unwrap(), Path::new(""), &[]).unwrap();
    assert_eq!(piston, again);
    let flap = paddle(DrivenConfig::flap([0.0, -0.1], WaveConfig::jonswap(0.06, 1.4, 7)))
        .damping(SpongeLayerConfig::between([4.0, 0.0], [5.0, 0.0]))
        .probe(ProbeConfig::motion("paddle"));
    assert_eq!(common::preflight_report(&flap).waves[0].kind, Some("sea"));
}

#[test]
fn the_preflight_report_of_a_wave_agrees_with_linear_theory() {
    let wave = wave(PISTON);
    // ω²d/g = 0.8384: kd tanh kd.
    let kd = wave.kd.unwrap();
    assert!((kd * kd.tanh() - (TAU / 1.2).powi(2) * 0.3 / 9.81).abs() < 1e-9);
    assert!((wave.length_m - TAU * 0.3 / kd).abs() < 1e-9 && (wave.celerity_mps - wave.length_m / 1.2).abs() < 1e-9);
    let group = 0.5 * wave.celerity_mps * (1.0 + 2.0 * kd / (2.0 * kd).sinh());
    assert!((wave.group_mps - group).abs() < 1e-9);
    // Twice 5 m of water less the half dp to the last particle.
    assert!((wave.back_s - 2.0 * 4.99 / group).abs() < 1e-3, "{wave:?}");
    assert!((wave.height_dp - 5.0).abs() < 1e-9 && wave.region == TheoryRegion::Stokes5 && wave.order == 2);
    // S = H (sinh 2kd + 2kd)/2(cosh 2kd − 1); the second order adds less than 2 %.
    let stroke = 0.1 * ((2.0 * kd).sinh() + 2.0 * kd) / (2.0 * ((2.0 * kd).cosh() - 1.0));
    assert!((wave.stroke_m / stroke - 1.0).abs() < 0.02, "{} against {stroke}", wave.stroke_m);
    assert!((wave.paddle_mps / (0.5 * stroke * TAU / 1.2) - 1.0).abs() < 0.2);
    let lone = self::wave("along = [1.0, 0.0], wave = { solitary = { height = 0.1 } }");
    assert!((lone.celerity_mps - (9.81_f64 * 0.4).sqrt()).abs() < 1e-12 && lone.period_s.is_none());
    assert_eq!(lone.region, TheoryRegion::Solitary);
}

#[test]
fn a_finding_about_a_wave_contains_the_value_that_removes_it() {
    let topics = |driven: &str| report(driven).findings.iter().map(|f| f.topic).collect::<Vec<_>>();
    assert_eq!(topics(PISTON), Vec::<&str>::new());
    let regular = |height: f64, period: f64| {
        format!("along = [1.0, 0.0], wave = {{ regular = {{ height = {height:?}, period = {period:?} }} }}")
    };
    let found = report(&regular(0.12, 3.0));
    let finding = found.findings.iter().find(|f| f.topic == "beyond_stokes").expect("H L²/d³ = 110");
    let height: f64 = finding.mend.rsplit(' ').next().unwrap().parse().unwrap();
    assert!(!topics(&regular(height, 3.0)).contains(&"beyond_stokes"), "{finding:?}");
    // That height is below five dp. A shorter period permits the requested height.
    let period = number(&finding.mend, "period = ");
    assert!(height < 0.1 && !topics(&regular(0.12, period)).contains(&"beyond_stokes"), "{finding:?}");
    assert!(topics(&regular(0.12, 1.1 * period)).contains(&"beyond_stokes"), "{finding:?}");
    let found = report(&regular(0.15, 4.0));
    let finding = found.findings.iter().find(|f| f.topic == "fast_paddle").expect("2ωA₂ is 0.6 of the celerity");
    assert!(!topics(&regular(number(&finding.mend, "height = "), 4.0)).contains(&"fast_paddle"), "{finding:?}");
    assert!(topics(&regular(0.01, 0.4)).contains(&"short_waves"));
    let flap = "hinge = [0.0, 0.15], wave = { regular = { height = 0.1, period = 1.2 } }";
    assert!(topics(flap).contains(&"steep_flap"));
    let sea = "along = [1.0, 0.0], wave = { jonswap = { height = 0.12, peak_period = 1.2 } }";
    assert!(topics(sea).contains(&"breaking_waves"));
    let low = flume(PISTON).replace("size = [0.1, 0.6] }", "size = [0.1, 0.33] }");
    assert!(report_of(&low).findings.iter().any(|f| f.topic == "overtopped_paddle"));
}

#[test]
fn a_finding_about_an_impossible_focus_contains_a_possible_position_or_time() {
    let group = |distance: f64, time: f64| {
        flume(&format!(
            "along = [1.0, 0.0], wave = {{ focused = {{ crest = 0.04, peak_period = 1.2, distance = {distance:?}, \
             time = {time:?} }} }}"
        ))
    };
    let far = finding(&group(30.0, 40.0), "far_focus").expect("the flume is 5 m long");
    assert_eq!(finding(&group(number(&far.mend, "distance = "), 40.0), "far_focus"), None);
    // 3 m at 1.12 m/s, plus the ramp of one period.
    let early = finding(&group(3.0, 2.0), "early_focus").expect("3.9 s is the least");
    let time = number(&early.mend, "time = ");
    assert!((3.8..4.1).contains(&time), "{early:?}");
    assert_eq!(finding(&group(3.0, time), "early_focus"), None);
}

#[test]
fn a_reversed_damping_zone_and_one_without_water_are_findings() {
    let zone = |from: &str, to: &str| format!("{FLUME}\n[[damping]]\nfrom = {from}\nto = {to}\n");
    let (right, wrong) = (zone("[3.0, 0.0]", "[5.0, 0.0]"), zone("[5.0, 0.0]", "[3.0, 0.0]"));
    let reversed = finding(&wrong, "reversed_damping").expect("the rate is full before x = 3 m");
    assert!(reversed.mend.contains("from = [3, 0], to = [5, 0]"), "{reversed:?}");
    assert!(finding(&zone("[6.0, 0.0]", "[8.0, 0.0]"), "idle_damping").is_some());
    let absent = [(&right, "reversed_damping"), (&right, "idle_damping"), (&wrong, "idle_damping")];
    assert!(absent.iter().all(|(text, topic)| finding(text, topic).is_none()));
}

/// Two readings a period are the least: waves of 1.2 s that are read every 0.7 s look like waves of 1.68 s.
#[test]
fn a_gauge_that_reads_less_than_twice_a_period_is_a_finding() {
    let read = |every: f64| format!("{FLUME}\n[[probe]]\nname = \"g\"\nelevation = {{ x = 2.0 }}\nevery = {every}\n");
    let found = finding(&read(0.7), "slow_probe").expect("0.7 s are more than 0.6 s");
    assert_eq!(finding(&read(number(&found.mend, "every = ")), "slow_probe"), None);
    assert_eq!(finding(&read(0.59), "slow_probe"), None);
}

/// The part below the hinge takes from the wave. A flap that ends at its hinge, on a fixed wall, is that of theory.
#[test]
fn a_flap_that_reaches_below_its_hinge_is_a_finding() {
    let flap = flume("hinge = [0.0, 0.1], wave = { regular = { height = 0.03, period = 1.2 } }");
    let found = finding(&flap, "lifted_paddle").expect("the hinge is 0.1 m above the lower edge");
    assert!(found.what.contains("reaches 0.1 m below its hinge") && found.mend.contains("bottom = 0.1"), "{found:?}");
    let wall = "\n[[solid]]\nname = \"sill\"\nfixed = true\nshape = { box = { size = [0.1, 0.1] } }\nat = { x = -0.05, y = 0.05 }\n";
    assert_eq!(finding(&(flap.replacen("bottom = 0.0", "bottom = 0.1", 1) + wall), "lifted_paddle"), None);
}

#[test]
fn a_paddle_placed_or_sized_against_wavemaker_theory_is_a_finding() {
    let sized = |height: f64, bottom: f64| {
        let paddle = format!("[0.1, {height:?}] }} }}\nat     = {{ x = -0.05, bottom = {bottom:?}");
        FLUME.replacen("[0.1, 0.6] } }\nat     = { x = -0.05, bottom = 0.0", &paddle, 1)
    };
    let drowned = finding(&sized(0.25, 0.0), "drowned_paddle").expect("the paddle ends 0.05 m below the level");
    let more: f64 = drowned.mend.split(' ').next().unwrap().parse().unwrap();
    assert!(["drowned_paddle", "overtopped_paddle"].iter().all(|t| finding(&sized(0.25 + more, 0.0), t).is_none()));
    let lifted = finding(&sized(0.6, 0.1), "lifted_paddle").expect("the paddle is 0.1 m above the bed");
    assert!(lifted.mend.contains("bottom = 0"), "{lifted:?}");
    assert_eq!(finding(&sized(0.6, 0.02), "lifted_paddle"), None, "one dp is not a gap");
    let more = |words: &str| flume(&PISTON.replace("} }", &format!("}}, {words} }}")));
    let deep = finding(&more("depth = 0.31"), "wrong_depth").expect("the depth is 0.3 m");
    assert!(deep.mend.contains("depth = 0.3"), "{deep:?}");
    let long = finding(&more("ramp = 4.0"), "long_ramp").expect("the run takes 6 s");
    let ramp = format!("ramp = {:?}", number(&long.mend, "ramp = "));
    assert_eq!(finding(&more(&ramp), "long_ramp"), None);
}

#[test]
fn a_flap_without_a_wall_below_or_with_a_hinge_aside_is_a_finding() {
    // The flap stands 0.1 m above the bed, on a wall of 0.1 × `wall` m, if there is one.
    let flap = |hinge: [f64; 2], bottom: f64, wall: Option<f64>| {
        let paddle = format!("[0.1, 0.6] }} }}\nat     = {{ x = -0.05, bottom = {bottom:?}");
        let motion = format!("hinge = {hinge:?}, wave = {{ regular = {{ height = 0.04, period = 1.2 }} }}");
        let text = flume(&motion).replacen("[0.1, 0.6] } }\nat     = { x = -0.05, bottom = 0.0", &paddle, 1);
        let below = |high: f64| {
            format!(
                "[[solid]]\nname = \"sill\"\nfixed = true\nshape = {{ box = {{ size = [0.1, {high:?}] }} }}\nat = {{ x = -0.05, bottom = 0.0 }}\n"
            )
        };
        format!("{text}\n{}", wall.map(below).unwrap_or_default())
    };
    let open = finding(&flap([0.0, 0.1], 0.1, None), "lifted_paddle").expect("0.1 m are open below it");
    assert!(open.what.contains("0.1 m are open"), "{open:?}");
    assert_eq!(finding(&flap([0.0, 0.1], 0.1, Some(0.1)), "lifted_paddle"), None, "the wall closes it");
    let low = finding(&flap([0.0, 0.1], 0.1, Some(0.05)), "lifted_paddle").expect("0.05 m are open above the wall");
    assert!(low.what.contains("0.05 m are open"), "{low:?}");
    assert_eq!(finding(&flap([0.0, 0.0], 0.0, None), "lifted_paddle"), None, "it reaches the bed");
    // 0.3 m deep: a hinge behind the paddle by a tenth of it or less is one of its own.
    let aside = finding(&flap([0.5, 0.0], 0.0, None), "hinge_aside").expect("the hinge is 0.5 m before the face");
    assert!(aside.what.contains("0.5 m before") && aside.mend.contains("hinge = [0, 0]"), "{aside:?}");
    let behind = finding(&flap([-0.5, 0.0], 0.0, None), "hinge_aside").expect("the hinge is 0.4 m behind the back");
    assert!(behind.what.contains("0.4 m behind"), "{behind:?}");
    assert_eq!(finding(&flap([-0.12, 0.0], 0.0, None), "hinge_aside"), None);
}

#[test]
fn the_motion_of_a_paddle_does_not_depend_on_the_end_of_the_run() {
    let short = |driven: &str| {
        let text = flume(driven).replacen("until     = 6.0", "until     = 0.3", 1);
        report_of(&text).waves.remove(0)
    };
    let solitary = "along = [1.0, 0.0], wave = { solitary = { height = 0.1 } }";
    for driven in [PISTON, solitary] {
        let (short, long) = (short(driven), wave(driven));
        assert_eq!((short.stroke_m, short.paddle_mps), (long.stroke_m, long.paddle_mps), "{driven}");
    }
    // cH/(d + H) with c = √(g(d + H)); the report samples the motion.
    let fastest = (9.81_f64 * 0.4).sqrt() * 0.1 / 0.4;
    assert!((short(solitary).paddle_mps / fastest - 1.0).abs() < 1e-3);
}

#[test]
fn the_first_reflection_comes_from_the_nearest_obstacle() {
    let wall = |height: f64| {
        let wall = format!(
            "\n[[solid]]\nname = \"wall\"\nfixed = true\nshape = {{ box = {{ size = [0.1, {height:?}] }} }}\n\
             at = {{ x = 2.05, bottom = 0.1 }}\n\n[[damping]]\nfrom = [1.5, 0.0]\nto = [4.0, 0.0]\n"
        );
        report_of(&format!("{FLUME}{wall}")).waves.remove(0)
    };
    let first = wall(0.4);
    assert!(first.answers.as_deref() == Some("wall") && (first.reach_m - 2.0).abs() < 1e-6, "{first:?}");
    assert!((first.back_s - 4.0 / first.group_mps).abs() < 1e-6 && first.damping_m == Some(1.5), "{first:?}");
    let line = first.first_reflection();
    assert!(line.contains("2 m to \"wall\"") && line.contains("a damping zone begins at 1.5 m"), "{line}");
    // Waves pass over a low wall.
    let over = wall(0.1);
    assert!(over.answers.is_none() && (over.reach_m - 4.99).abs() < 1e-3, "{over:?}");
}

#[test]
fn a_statistic_with_a_period_other_than_that_of_the_paddle_is_a_finding() {
    let asked = |period: f64| {
        format!(
            "{FLUME}\n[[probe]]\nname = \"row\"\nelevation = {{ from = 1.9, to = 2.3, count = 3 }}\n\n\
             [[statistic]]\nreflection = [\"row\"]\nperiod = {period:?}\n"
        )
    };
    let stale = finding(&asked(1.4), "stale_period").expect("the paddle generates waves of 1.2 s");
    assert!(stale.what.contains("1.4 s") && stale.what.contains("1.2 s"), "{stale:?}");
    assert_eq!(finding(&asked(number(&stale.mend, "period = ")), "stale_period"), None);
}

#[test]
fn a_component_table_without_phases_is_refused_with_both_column_names_and_its_key() {
    let folder = TestFolder::new("components");
    std::fs::write(folder.join("sea.csv"), "amplitude_m,period_s\n0.02,1.2\n").unwrap();
    let text = flume("along = [1.0, 0.0], wave = { components = { file = \"sea.csv\" } }");
    let message = Scene::parse(&text, &folder, &[]).and_then(|s| s.build::<2>()).map(|_| ()).unwrap_err().to_string();
    assert!(["phase_deg", "phase_rad", "wave.components.file"].iter().all(|w| message.contains(w)), "{message}");
}

#[test]
fn a_flap_leans_in_the_direction_of_propagation_at_its_crest() {
    for (side, hinge) in [(1.0, 0.0), (-1.0, 5.0)] {
        let text = flume(&format!(
            "hinge = [{hinge:?}, -0.1], wave = {{ regular = {{ height = 0.05, period = 1.2, phase_deg = 90.0 }}, ramp = 0.1 }}"
        ));
        let at = if side > 0.0 { "x = -0.05" } else { "x = 5.05" };
        let text = text
            .replace("x = -0.05", at)
            .replace("size = [5.2, 0.6] } }\nat    = { x = -0.2 }", "size = [5.4, 0.6] } }\nat    = { x = -0.2 }");
        let setup = built(&text).unwrap().setup;
        let paddle = &setup.solids[1];
        let pontoon::solid::Role::Driven(motion) = &paddle.role else { panic!("a driven solid") };
        // The motion at the surface is cos(ωt + 90°)/ω: the paddle is at its foremost position at t = T.
        let now = motion.kinematics(&paddle.pose, 1.2);
        let top = now.pose.point(&Vector::from([0.0, 0.0]))[0] - paddle.pose.position[0];
        assert!(top * side > 0.005, "{side}: {top}");
    }
}

/// Range (m) of the surface height at `x` (m) from `from` to `until` (s).
fn height_at(sim: &mut Simulation<2>, x: f64, from: f64, until: f64) -> f64 {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    let mut next = 0.0_f64;
    while sim.time() < until {
        sim.step().expect("a sound step");
        if sim.time() >= next.max(from) {
            next = sim.time() + 0.04;
            let top = surface(sim, x);
            range = (range.0.min(top), range.1.max(top));
        }
    }
    range.1 - range.0
}

/// Height of the highest particle within a smoothing length of `x`, plus half a dp.
fn surface(sim: &Simulation<2>, x: f64) -> f64 {
    let (h, dp) = (sim.system().model().h, sim.system().model().dp);
    let beside = sim.system().fluid().r.iter().filter(|r| (r[0] - x).abs() < h);
    beside.map(|r| r[1]).fold(f64::NEG_INFINITY, f64::max) + 0.5 * dp
}

#[test]
fn a_piston_generates_waves_of_the_requested_height() {
    let text = format!("{FLUME}\n[model]\nviscosity = {{ laminar = {{ nu0 = 1e-6 }} }}\n");
    let mut sim = Simulation::new(built(&text).unwrap().setup).unwrap();
    // At 1.2 m the front (1.2 m/s) and its ramp have passed at 4.2 s; the reflection of the far end arrives after 7 s.
    let height = height_at(&mut sim, 1.2, 4.4, 5.8);
    // The bound of a tenth: a dp is a fifth of the wave, and the highest particle is within half a dp of the surface.
    assert!((height / 0.1 - 1.0).abs() < 0.1, "{height}");
}

#[test]
fn a_damping_zone_decays_velocity_exponentially_with_both_time_schemes() {
    let water = common::lattice([0.0, 0.0], [0.4, 0.4], 0.05);
    for scheme in [TimeScheme::Symplectic, TimeScheme::Verlet { euler_every: 50 }] {
        let mut model = Model::water(2, 0.05, 1.0);
        (model.c0, model.gravity, model.viscosity, model.scheme) = (20.0, vec![0.0, 0.0], Viscosity::None, scheme);
        // The zone begins far to the left, so s = 1 in the water.
        let zone = SpongeLayer { from: [-9.0, 0.0].into(), to: [-8.0, 0.0].into(), strength: 3.0, power: 2.0 };
        let velocity = |_: &Vector<2>| Vector::from([0.2, 0.1]);
        let setup = Setup::new(model).water(water.clone(), 0.0).velocity(velocity).sponge_layer(zone);
        let mut sim = Simulation::new(setup).unwrap();
        while sim.time() < 0.5 {
            sim.step_to(0.5).unwrap();
        }
        // Uniform motion causes no forces, so the velocity decays as exp(−β t) to round-off.
        let left = (-3.0_f64 * 0.5).exp();
        for v in sim.system().fluid().v {
            assert!((v - Vector::from([0.2, 0.1]) * left).norm() < 1e-9, "{scheme:?}: {v}");
        }
    }
}

#[test]
fn a_damping_zone_without_water_and_a_restart_change_no_bit() {
    let small = FLUME.replace("max = [5.0, 0.3]", "max = [1.0, 0.3]").replace("size = [5.2, 0.6]", "size = [1.2, 0.6]");
    let zoned = format!("{small}\n[[damping]]\nfrom = [2.0, 0.0]\nto = [3.0, 0.0]\n");
    let run = |text: &str, steps: usize| {
        let mut sim = Simulation::new(built(text).unwrap().setup).unwrap();
        (0..steps).for_each(|_| sim.step().unwrap());
        sim
    };
    let bits = |sim: &Simulation<2>| sim.system().fluid().v.iter().map(|v| v[0].to_bits()).collect::<Vec<_>>();
    let (plain, beyond) = (run(&small, 120), run(&zoned, 120));
    assert_eq!(bits(&plain), bits(&beyond));
    // A restart rebuilds the motion of the paddle from the scene.
    let saved = run(&small, 60).save().unwrap();
    let mut again = Simulation::new(built(&small).unwrap().setup).unwrap();
    again.restore(&saved).unwrap();
    (0..60).for_each(|_| again.step().unwrap());
    assert_eq!(bits(&plain), bits(&again));
}
