//! Waves by name: words that cannot be meant, what is told of a wave before a run, and that the water makes it.

use std::{f64::consts::TAU, path::Path};

use pontoon::{
    Error,
    math::Vector,
    model::{Dimension, Model, TimeScheme, Viscosity},
    preflight::{self, Finding, GeneratedWave, Preflight},
    scene::{BuiltScene, DrivenConfig, ProbeConfig, Scene, ShapeConfig, SolidConfig, SpongeLayerConfig, WaveConfig},
    simulation::{Setup, Simulation},
    solid::Dim,
    system::SpongeLayer,
    wavemaker::TheoryRegion,
};

use crate::rig;

/// A flume with nothing wrong: 1.2 s, 1.78 m, kd = 1.06.
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

fn with(driven: &str) -> String {
    assert!(FLUME.contains(PISTON));
    FLUME.replacen(PISTON, driven, 1)
}

fn built(text: &str) -> Result<BuiltScene<2>, Error> {
    Scene::parse(text, Path::new(""), &[])?.build()
}

fn look<const D: usize>(built: BuiltScene<D>) -> Preflight
where
    Dim<D>: Dimension<D>,
{
    let BuiltScene { setup, plan, removed_by_solids, still_water, .. } = built;
    preflight::preflight(&Simulation::new(setup).unwrap(), &plan, still_water, removed_by_solids, &[])
}

fn told(driven: &str) -> Preflight {
    look(built(&with(driven)).unwrap())
}

fn wave(driven: &str) -> GeneratedWave {
    told(driven).waves.remove(0)
}

/// The number after `key` in `text`.
fn number(text: &str, key: &str) -> f64 {
    let after = text.split(key).nth(1).unwrap_or_else(|| panic!("no {key:?} in {text:?}"));
    let digits: String = after.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    digits.parse().unwrap()
}

/// The finding of this topic about a scene, if any.
fn finding(text: &str, topic: &str) -> Option<Finding> {
    look(built(text).unwrap()).findings.into_iter().find(|f| f.topic == topic)
}

#[test]
fn words_that_cannot_be_meant_are_named_with_file_line_key_and_what_can() {
    let piston = |wave: &str| format!("along = [1.0, 0.0], wave = {{ {wave} }}");
    let flap =
        |height: f64| format!("hinge = [0.0, {height:?}], wave = {{ regular = {{ height = 0.1, period = 1.2 }} }}");
    let cases: [(String, &str, &str); 20] = [
        (piston("regular = { height = 0.3, period = 1.2 }"), "wave.regular.height", "highest that does not is 0.198 m"),
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
        // The first order has 0.6 m/s, the crests 1.7 m/s; the second order has more than both.
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
        let message = built(&with(&driven)).map(|_| ()).expect_err(&driven).to_string();
        assert!(message.contains(key) && message.contains(advice), "{driven}:\n{message}");
        // The line of the words themselves.
        assert!(message.contains("scene.toml:20:"), "{message}");
    }
    let flap = with("hinge = [0.0, 0.0], wave = { solitary = { height = 0.1 } }");
    assert!(built(&flap).map(|_| ()).unwrap_err().to_string().contains("needs a piston"));
    let both = with("along = [1.0, 0.0], distance = { formula = \"t\" }, wave = { solitary = { height = 0.1 } }");
    assert!(built(&both).map(|_| ()).unwrap_err().to_string().contains("one motion"));
}

#[test]
fn a_wave_can_be_ordered_from_rust_in_the_same_words() {
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
    assert_eq!(look(flap.build::<2>().unwrap()).waves[0].kind, Some("sea"));
}

#[test]
fn what_is_told_of_a_wave_is_what_the_books_say() {
    let wave = wave(PISTON);
    // ω²d/g = 0.8384: kd tanh kd.
    let kd = wave.kd.unwrap();
    assert!((kd * kd.tanh() - (TAU / 1.2).powi(2) * 0.3 / 9.81).abs() < 1e-9);
    assert!((wave.length_m - TAU * 0.3 / kd).abs() < 1e-9 && (wave.celerity_mps - wave.length_m / 1.2).abs() < 1e-9);
    let group = 0.5 * wave.celerity_mps * (1.0 + 2.0 * kd / (2.0 * kd).sinh());
    assert!((wave.group_mps - group).abs() < 1e-9);
    // 5 m of water less the half dp to the last particle, there and back.
    assert!((wave.back_s - 2.0 * 4.99 / group).abs() < 1e-3, "{wave:?}");
    assert!((wave.height_dp - 5.0).abs() < 1e-9 && wave.region == TheoryRegion::Stokes5 && wave.order == 2);
    // S = H (sinh 2kd + 2kd)/2(cosh 2kd − 1), and a tenth of a per cent of the second order's.
    let stroke = 0.1 * ((2.0 * kd).sinh() + 2.0 * kd) / (2.0 * ((2.0 * kd).cosh() - 1.0));
    assert!((wave.stroke_m / stroke - 1.0).abs() < 0.02, "{} against {stroke}", wave.stroke_m);
    assert!((wave.paddle_mps / (0.5 * stroke * TAU / 1.2) - 1.0).abs() < 0.2);
    let lone = self::wave("along = [1.0, 0.0], wave = { solitary = { height = 0.1 } }");
    assert!((lone.celerity_mps - (9.81_f64 * 0.4).sqrt()).abs() < 1e-12 && lone.period_s.is_none());
    assert_eq!(lone.region, TheoryRegion::Solitary);
}

#[test]
fn a_doubtful_wave_is_told_with_the_number_that_mends_it() {
    let topics = |driven: &str| told(driven).findings.iter().map(|f| f.topic).collect::<Vec<_>>();
    assert_eq!(topics(PISTON), Vec::<&str>::new());
    let regular = |height: f64, period: f64| {
        format!("along = [1.0, 0.0], wave = {{ regular = {{ height = {height:?}, period = {period:?} }} }}")
    };
    let found = told(&regular(0.12, 3.0));
    let finding = found.findings.iter().find(|f| f.topic == "beyond_stokes").expect("H L²/d³ = 110");
    let height: f64 = finding.mend.rsplit(' ').next().unwrap().parse().unwrap();
    assert!(!topics(&regular(height, 3.0)).contains(&"beyond_stokes"), "{finding:?}");
    // That is less than five dp; a shorter period will do for the height that was asked for.
    let period = number(&finding.mend, "period = ");
    assert!(height < 0.1 && !topics(&regular(0.12, period)).contains(&"beyond_stokes"), "{finding:?}");
    assert!(topics(&regular(0.12, 1.1 * period)).contains(&"beyond_stokes"), "{finding:?}");
    let found = told(&regular(0.15, 4.0));
    let finding = found.findings.iter().find(|f| f.topic == "fast_paddle").expect("2ωA₂ is 0.6 of the celerity");
    assert!(!topics(&regular(number(&finding.mend, "height = "), 4.0)).contains(&"fast_paddle"), "{finding:?}");
    assert!(topics(&regular(0.01, 0.4)).contains(&"short_waves"));
    let flap = "hinge = [0.0, 0.15], wave = { regular = { height = 0.1, period = 1.2 } }";
    assert!(topics(flap).contains(&"steep_flap"));
    let sea = "along = [1.0, 0.0], wave = { jonswap = { height = 0.12, peak_period = 1.2 } }";
    assert!(topics(sea).contains(&"breaking_waves"));
    let low = with(PISTON).replace("size = [0.1, 0.6] }", "size = [0.1, 0.33] }");
    assert!(look(built(&low).unwrap()).findings.iter().any(|f| f.topic == "overtopped_paddle"));
}

#[test]
fn a_group_that_cannot_come_together_is_told_with_the_place_and_the_time_that_can() {
    let group = |distance: f64, time: f64| {
        with(&format!(
            "along = [1.0, 0.0], wave = {{ focused = {{ crest = 0.04, peak_period = 1.2, distance = {distance:?}, \
             time = {time:?} }} }}"
        ))
    };
    let far = finding(&group(30.0, 40.0), "far_focus").expect("the flume is 5 m long");
    assert_eq!(finding(&group(number(&far.mend, "distance = "), 40.0), "far_focus"), None);
    // 3 m at 1.12 m/s, and the ramp of a period.
    let early = finding(&group(3.0, 2.0), "early_focus").expect("3.9 s is the least");
    let time = number(&early.mend, "time = ");
    assert!((3.8..4.1).contains(&time), "{early:?}");
    assert_eq!(finding(&group(3.0, time), "early_focus"), None);
}

#[test]
fn zones_that_damp_the_paddle_or_no_water_are_told() {
    let zone = |from: &str, to: &str| format!("{FLUME}\n[[damping]]\nfrom = {from}\nto = {to}\n");
    let (right, wrong) = (zone("[3.0, 0.0]", "[5.0, 0.0]"), zone("[5.0, 0.0]", "[3.0, 0.0]"));
    let said = finding(&wrong, "reversed_damping").expect("it is full before x = 3 m");
    assert!(said.mend.contains("from = [3, 0], to = [5, 0]"), "{said:?}");
    assert!(finding(&zone("[6.0, 0.0]", "[8.0, 0.0]"), "idle_damping").is_some());
    let silent = [(&right, "reversed_damping"), (&right, "idle_damping"), (&wrong, "idle_damping")];
    assert!(silent.iter().all(|(text, topic)| finding(text, topic).is_none()));
}

#[test]
fn a_paddle_that_stands_as_no_paddle_of_theory_does_is_told() {
    let sized = |height: f64, bottom: f64| {
        let paddle = format!("[0.1, {height:?}] }} }}\nat     = {{ x = -0.05, bottom = {bottom:?}");
        FLUME.replacen("[0.1, 0.6] } }\nat     = { x = -0.05, bottom = 0.0", &paddle, 1)
    };
    let drowned = finding(&sized(0.25, 0.0), "drowned_paddle").expect("it ends 0.05 m below the level");
    let more: f64 = drowned.mend.split(' ').next().unwrap().parse().unwrap();
    assert!(["drowned_paddle", "overtopped_paddle"].iter().all(|t| finding(&sized(0.25 + more, 0.0), t).is_none()));
    let lifted = finding(&sized(0.6, 0.1), "lifted_paddle").expect("0.1 m above the bed");
    assert!(lifted.mend.contains("bottom = 0"), "{lifted:?}");
    assert_eq!(finding(&sized(0.6, 0.02), "lifted_paddle"), None, "one dp is no gap");
    let more = |words: &str| with(&PISTON.replace("} }", &format!("}}, {words} }}")));
    let deep = finding(&more("depth = 0.31"), "wrong_depth").expect("there are 0.3 m");
    assert!(deep.mend.contains("depth = 0.3"), "{deep:?}");
    let long = finding(&more("ramp = 4.0"), "long_ramp").expect("of a run of 6 s");
    let ramp = format!("ramp = {:?}", number(&long.mend, "ramp = "));
    assert_eq!(finding(&more(&ramp), "long_ramp"), None);
}

#[test]
fn how_a_paddle_goes_does_not_hang_on_when_a_run_ends() {
    let short = |driven: &str| {
        let text = with(driven).replacen("until     = 6.0", "until     = 0.3", 1);
        look(built(&text).unwrap()).waves.remove(0)
    };
    let solitary = "along = [1.0, 0.0], wave = { solitary = { height = 0.1 } }";
    for driven in [PISTON, solitary] {
        let (short, long) = (short(driven), wave(driven));
        assert_eq!((short.stroke_m, short.paddle_mps), (long.stroke_m, long.paddle_mps), "{driven}");
    }
    // cH/(d + H), √(g(d + H)) as c; sampled.
    let fastest = (9.81_f64 * 0.4).sqrt() * 0.1 / 0.4;
    assert!((short(solitary).paddle_mps / fastest - 1.0).abs() < 1e-3);
}

#[test]
fn the_first_answer_is_that_of_what_stands_in_the_way() {
    let wall = |height: f64| {
        let wall = format!(
            "\n[[solid]]\nname = \"wall\"\nfixed = true\nshape = {{ box = {{ size = [0.1, {height:?}] }} }}\n\
             at = {{ x = 2.05, bottom = 0.1 }}\n\n[[damping]]\nfrom = [1.5, 0.0]\nto = [4.0, 0.0]\n"
        );
        look(built(&format!("{FLUME}{wall}")).unwrap()).waves.remove(0)
    };
    let first = wall(0.4);
    assert!(first.answers.as_deref() == Some("wall") && (first.reach_m - 2.0).abs() < 1e-6, "{first:?}");
    assert!((first.back_s - 4.0 / first.group_mps).abs() < 1e-6 && first.damping_m == Some(1.5), "{first:?}");
    let line = first.first_reflection();
    assert!(line.contains("2 m to \"wall\"") && line.contains("a damping zone begins at 1.5 m"), "{line}");
    // Waves pass over it.
    let over = wall(0.1);
    assert!(over.answers.is_none() && (over.reach_m - 4.99).abs() < 1e-3, "{over:?}");
}

#[test]
fn a_statistic_of_another_period_than_the_paddles_is_told() {
    let asked = |period: f64| {
        format!(
            "{FLUME}\n[[probe]]\nname = \"row\"\nelevation = {{ from = 1.9, to = 2.3, count = 3 }}\n\n\
             [[statistic]]\nreflection = [\"row\"]\nperiod = {period:?}\n"
        )
    };
    let stale = finding(&asked(1.4), "stale_period").expect("the paddle makes waves of 1.2 s");
    assert!(stale.what.contains("1.4 s") && stale.what.contains("1.2 s"), "{stale:?}");
    assert_eq!(finding(&asked(number(&stale.mend, "period = ")), "stale_period"), None);
}

#[test]
fn a_table_of_components_without_phases_is_refused_by_both_names_and_its_key() {
    let folder = std::env::temp_dir().join(format!("pontoon-components-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("sea.csv"), "amplitude_m,period_s\n0.02,1.2\n").unwrap();
    let text = with("along = [1.0, 0.0], wave = { components = { file = \"sea.csv\" } }");
    let message = Scene::parse(&text, &folder, &[]).and_then(|s| s.build::<2>()).map(|_| ()).unwrap_err().to_string();
    assert!(["phase_deg", "phase_rad", "wave.components.file"].iter().all(|w| message.contains(w)), "{message}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_flap_leans_towards_the_water_where_the_waves_go() {
    for (side, hinge) in [(1.0, 0.0), (-1.0, 5.0)] {
        let text = with(&format!(
            "hinge = [{hinge:?}, -0.1], wave = {{ regular = {{ height = 0.05, period = 1.2, phase_deg = 90.0 }}, ramp = 0.1 }}"
        ));
        let at = if side > 0.0 { "x = -0.05" } else { "x = 5.05" };
        let text = text
            .replace("x = -0.05", at)
            .replace("size = [5.2, 0.6] } }\nat    = { x = -0.2 }", "size = [5.4, 0.6] } }\nat    = { x = -0.2 }");
        let setup = built(&text).unwrap().setup;
        let paddle = &setup.solids[1];
        let pontoon::solid::Role::Driven(motion) = &paddle.role else { panic!("it is driven") };
        // cos(ωt + 90°)/ω in the surface: the paddle is foremost at t = T.
        let now = motion.kinematics(&paddle.pose, 1.2);
        let top = now.pose.point(&Vector::from([0.0, 0.0]))[0] - paddle.pose.position[0];
        assert!(top * side > 0.005, "{side}: {top}");
    }
}

/// The largest less the smallest reading of the surface at `x` (m) over times `from` to `until` (s).
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

/// Height of the highest water within a smoothing length of `x`, and half a dp.
fn surface(sim: &Simulation<2>, x: f64) -> f64 {
    let (h, dp) = (sim.system().model().h, sim.system().model().dp);
    let beside = sim.system().fluid().r.iter().filter(|r| (r[0] - x).abs() < h);
    beside.map(|r| r[1]).fold(f64::NEG_INFINITY, f64::max) + 0.5 * dp
}

#[test]
fn a_piston_makes_waves_of_the_height_that_was_asked_for() {
    let text = format!("{FLUME}\n[model]\nviscosity = {{ laminar = {{ nu0 = 1e-6 }} }}\n");
    let mut sim = Simulation::new(built(&text).unwrap().setup).unwrap();
    // At 1.2 m the front (1.2 m/s) has passed with its ramp at 4.2 s, the far end's answer comes after 7 s.
    let height = height_at(&mut sim, 1.2, 4.4, 5.8);
    // A tenth: a dp is a fifth of the wave, and tops of particles stand up to half a dp off the surface, both ways.
    assert!((height / 0.1 - 1.0).abs() < 0.1, "{height}");
}

#[test]
fn a_damping_zone_slows_water_by_its_law_whatever_the_scheme() {
    let water = rig::lattice([0.0, 0.0], [0.4, 0.4], 0.05);
    for scheme in [TimeScheme::Symplectic, TimeScheme::Verlet { euler_every: 50 }] {
        let mut model = Model::water(2, 0.05, 1.0);
        (model.c0, model.gravity, model.viscosity, model.scheme) = (20.0, vec![0.0, 0.0], Viscosity::None, scheme);
        // It begins far to the left: s = 1 where the water is.
        let zone = SpongeLayer { from: [-9.0, 0.0].into(), to: [-8.0, 0.0].into(), strength: 3.0, power: 2.0 };
        let velocity = |_: &Vector<2>| Vector::from([0.2, 0.1]);
        let setup = Setup::new(model).water(water.clone(), 0.0).velocity(velocity).sponge_layer(zone);
        let mut sim = Simulation::new(setup).unwrap();
        while sim.time() < 0.5 {
            sim.step_to(0.5).unwrap();
        }
        // Water that moves as one has no forces: exp(−β t), to round-off.
        let left = (-3.0_f64 * 0.5).exp();
        for v in sim.system().fluid().v {
            assert!((v - Vector::from([0.2, 0.1]) * left).norm() < 1e-9, "{scheme:?}: {v}");
        }
    }
}

#[test]
fn a_zone_that_no_water_reaches_changes_no_bit_and_a_run_goes_on_to_the_same_ones() {
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
    // The paddle's law is made anew from the words.
    let kept = run(&small, 60).save().unwrap();
    let mut again = Simulation::new(built(&small).unwrap().setup).unwrap();
    again.restore(&kept).unwrap();
    (0..60).for_each(|_| again.step().unwrap());
    assert_eq!(bits(&plain), bits(&again));
}
