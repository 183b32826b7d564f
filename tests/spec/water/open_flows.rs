//! Flows between faces against theory, and the same flow between periodic sides: what is due to the faces, and what to the particles.

use std::path::Path;

use pontoon::{
    math::Vector,
    probe::{ElevationProbe, EnergyBudgetProbe, FlowProbe, PatchProbe, PressureProbe, Probe},
    scene::Scene,
    simulation::Simulation,
};

use crate::common;

/// Largest velocity of the flow between plates, m/s: u = 4 U y (1 − y) over a height of 1 m.
const LARGEST: f64 = 0.75;

/// Gradient of the pressure in it, Pa/m: 8 ρ ν U with ν = 0.1 m²/s.
const GRADIENT: f64 = 600.0;

/// The scene of the flow between plates, 20 dp apart, over 2 m, driven as `drive` says. Shifting keeps the particles in order: a disturbed
/// flow between periodic sides without it has 8 % more drag.
fn plates(drive: &str) -> String {
    format!(
        r#"
        dimension = 2
        dp = 0.05
        until = 8.0
        {drive}
        [[water]]
        fill = {{ box = {{ min = [0.0, 0.0], max = [2.0, 1.0] }} }}
        velocity = ["3*y*(1-y)+0.1*sin(4*pi*x)*sin(3*pi*y)", "0.1*sin(6*pi*x+1)*sin(pi*y)"]
        [[solid]]
        name = "bottom"
        fixed = true
        shape = {{ box = {{ size = [8.0, 0.2] }} }}
        at = {{ x = 1.0, y = -0.1 }}
        [[solid]]
        name = "top"
        fixed = true
        shape = {{ box = {{ size = [8.0, 0.2] }} }}
        at = {{ x = 1.0, y = 1.1 }}
        [model]
        rho0 = 1000.0
        c0 = 20.0
        slip = "none"
        diffusion = {{ molteni = {{ delta = 0.1 }} }}
        viscosity = {{ laminar = {{ nu0 = 0.1 }} }}
        shifting = {{ everywhere = {{ }} }}
        "#
    )
}

/// Of the flow between 4 and 8 s the mean deviation from the profile over the largest velocity, the drop of pressure over the middle
/// metre, Pa, and the number of particles beside the inflow over that at the start.
fn flow_between_plates(drive: &str) -> [f64; 3] {
    let mut sim = common::scene_simulation::<2>(&plates(drive)).expect("a sound scene");
    let probes = [0.5, 1.5].map(|x| PressureProbe::<2>::new(&[x, 0.5]).expect("a place in the water"));
    let now = |sim: &Simulation<2>| {
        let fluid = sim.system().fluid();
        let middle = || fluid.r.iter().zip(fluid.v).filter(|(r, _)| (0.6..1.4).contains(&r[0]));
        let off = middle().map(|(r, v)| (v[0] - 4.0 * LARGEST * r[1] * (1.0 - r[1])).abs()).sum::<f64>();
        let [first, last] = [0, 1].map(|i| probes[i].sample(sim)[0]);
        let beside = fluid.r.iter().filter(|r| r[0] < 0.4).count() as f64 / 160.0;
        [off / middle().count() as f64 / LARGEST, first - last, beside]
    };
    common::time_mean(&mut sim, 4.0, 8.0, now).expect("a sound run")
}

/// The control: between periodic sides, driven by the gradient as a body force, the same particles keep the profile within 2 %.
#[test]
fn poiseuille_flow_between_periodic_sides_keeps_its_profile_at_its_gradient() {
    let drive = "gravity = [0.6, 0.0]\nperiodic = { x = [0.0, 2.0] }";
    let [off, ..] = flow_between_plates(drive);
    assert!(off < 0.02, "the velocity is off by {off} of the largest");
}

/// Between faces the profile is right within 2 % and the gradient of the pressure within 3 %, whether the outflow has a velocity or
/// a pressure only. Water enters all the time, though with shifting all lists are rebuilt within steps: no more than a row of the
/// eight beside the inflow is missing in the mean.
#[test]
fn poiseuille_flow_has_its_profile_and_gradient_with_a_prescribed_and_a_free_outflow() {
    for outflow in ["velocity = \"3*y*(1-y)\"", "level = 1.0"] {
        let faces = format!(
            "gravity = [0.0, 0.0]\ninflow = [{{ x = 0.0, velocity = \"3*y*(1-y)\" }}]\noutflow = [{{ x = 2.0, {outflow} }}]"
        );
        let [off, drop, beside] = flow_between_plates(&faces);
        assert!(off < 0.02, "{outflow}: the velocity is off by {off} of the largest");
        assert!((drop / GRADIENT - 1.0).abs() < 0.03, "{outflow}: {drop} Pa over 1 m, in theory {GRADIENT} Pa");
        assert!((beside - 1.0).abs() < 0.125, "{outflow}: {beside} of the water beside the inflow");
    }
}

/// Faces are vertical: there is no key for one normal to z.
#[test]
fn a_horizontal_face_is_refused_with_the_keys_that_exist() {
    let text = "dimension = 3\ndp = 0.1\nuntil = 1.0\ninflow = [{ z = 0.0, velocity = 0.5 }]\n\
                water = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 1.2, 0.4] } } }]\n";
    let error = common::scene_simulation::<3>(text).err().expect("no such face");
    assert_eq!(error.location.as_ref().map(|place| place.key.as_str()), Some("inflow.0.z"), "{error}");
    assert!(error.to_string().contains("name, x, y, velocity"), "{error}");
}

/// A channel between two faces, from x = 0 to `length` (m), with water 0.4 m deep.
fn channel(length: f64, dp: f64, until: f64, faces: &str) -> String {
    format!(
        r#"
        dimension = 2
        dp = {dp}
        until = {until}
        {faces}
        [[water]]
        fill = {{ box = {{ min = [0.0, 0.0], max = [{length:?}, 0.4] }} }}
        [[solid]]
        name = "bed"
        fixed = true
        shape = {{ box = {{ size = [8.0, 0.2] }} }}
        at = {{ x = 1.0, y = -0.1 }}
        "#
    )
}

/// The least distance of two particles of the buffer of a face, over dp.
fn nearest_in_buffer(sim: &Simulation<2>, face: usize) -> f64 {
    let r: Vec<_> = sim.system().buffer_particles(face).map(|(r, ..)| *r).collect();
    let pairs = r.iter().enumerate().flat_map(|(i, a)| r[..i].iter().map(move |b| (a - b).norm()));
    pairs.fold(f64::INFINITY, f64::min) / sim.system().model().dp
}

/// The mass that has come through all faces, in particles.
fn exchanged(sim: &Simulation<2>) -> i64 {
    sim.system().face_exchange().iter().map(|face| face.entered as i64 - face.left as i64).sum()
}

/// A basin of 1.2 m follows the level of its face, which rises and falls by 4 dp in 12 s, five times the period of its sloshing, within
/// dp; that is the part of a row and the sloshing that the rise excites. Mass is in the books, and no two particles of the buffer come
/// nearer than half of dp: rows are dp apart, and water that has left moves apart when lists are rebuilt, which is seldom at slack water.
#[test]
fn a_basin_follows_the_level_of_its_face_up_and_down() {
    let dp = 0.04;
    let level = |t: f64| 0.4 + 2.0 * dp * (1.0 - (std::f64::consts::TAU * t / 12.0).cos());
    let mut text = channel(1.2, dp, 12.0, "outflow = [{ x = 0.0, level = \"0.4+0.08*(1-cos(2*pi*t/12))\" }]");
    text += "[[solid]]\nname = \"wall\"\nfixed = true\nshape = { box = { size = [0.2, 1.0] } }\nat = { x = 1.3, y = 0.5 }\n";
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    let start = sim.system().fluid().len();
    let gauge = ElevationProbe::new(sim.system(), &[0.6]).expect("a place in the water");
    let mut most = start;
    for k in 1..=48 {
        let t = 0.25 * f64::from(k);
        while sim.time() < t {
            sim.step_to(t).expect("a sound run");
        }
        let (now, count) = (gauge.sample(&sim)[0], sim.system().fluid().len());
        assert!((now - level(t)).abs() < dp, "{now} m at {t} s, of {} m", level(t));
        assert_eq!(count as i64, start as i64 + exchanged(&sim), "the books at {t} s");
        let nearest = nearest_in_buffer(&sim, 0);
        assert!(nearest > 0.5, "{nearest} dp between two particles of the buffer at {t} s");
        most = most.max(count);
    }
    // Four rows of ten, within a row.
    assert!((most as f64 / start as f64 - 1.4).abs() < 0.1, "{most} of {start} particles");
}

/// A tide to and fro through both ends of a channel keeps its water: from cycle to cycle, at the same phase, within 1 %. The first
/// cycle starts without the slope of the surface that belongs to the tide.
#[test]
fn a_tide_through_both_ends_of_a_channel_keeps_its_water() {
    let tide = "velocity = 0.3, factor = \"cos(2*pi*t/5)\"";
    let faces = format!("inflow = [{{ x = 0.0, {tide} }}]\noutflow = [{{ x = 3.0, {tide} }}]");
    let text = channel(3.0, 0.05, 20.0, &faces).replace("[3.0, 0.4] } }", "[3.0, 0.4] } }\nvelocity = [0.3, 0.0]");
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    let start = sim.system().fluid().len();
    // The mean over a second, because rows enter whole.
    let mut water = |cycle: f64| {
        let now = |sim: &Simulation<2>| [sim.system().fluid().len() as f64 / start as f64];
        common::time_mean(&mut sim, 5.0 * cycle - 1.0, 5.0 * cycle, now).expect("a sound run")[0]
    };
    let [first, last] = [water(1.0), water(4.0)];
    assert!((last - first).abs() < 0.03, "{first} of the water after the first cycle, {last} after the fourth");
    assert_eq!(sim.system().fluid().len() as i64, start as i64 + exchanged(&sim));
    assert!((0..2).all(|face| nearest_in_buffer(&sim, face) > 0.6));
}

/// Rows that come and go with the level and with the sense of the flow have the same bits on any number of threads and after a restart.
#[test]
fn rows_of_a_tide_have_the_same_bits_on_any_number_of_threads_and_after_a_restart() {
    let level = "level = \"0.4+0.1*sin(2*pi*t/6)\"";
    let faces = format!(
        "inflow = [{{ x = 0.0, velocity = 0.5, factor = \"cos(2*pi*t/1.5)\", {level} }}]\noutflow = [{{ x = 2.0, {level} }}]"
    );
    let build = || common::scene_simulation::<2>(&channel(2.0, 0.05, 3.0, &faces)).expect("a sound scene");
    let on = |threads: usize| {
        common::on_threads(threads, || {
            let mut sim = build();
            while sim.time() < 1.2 {
                sim.step_to(1.2).expect("a sound run");
            }
            let saved = sim.save().expect("a state");
            common::steps(&mut sim, 300);
            (saved, sim.save().expect("a state"))
        })
    };
    let (saved, whole) = on(1);
    assert!(on(3) == (saved.clone(), whole.clone()));
    let mut resumed = build();
    resumed.restore(&saved).expect("a state of this setup");
    common::steps(&mut resumed, 300);
    assert!(resumed.save().expect("a state") == whole);
}

/// The energy of the water that passes the faces of a pulsating channel is in the budget, `removed`, and the budget closes within 0.1 % of
/// the sum of its entries: `walls` has the work of the pressure at the faces.
#[test]
fn the_energy_through_the_faces_is_in_the_budget() {
    let faces = "inflow = [{ x = 0.0, velocity = 1.0, factor = \"1+0.3*sin(2*pi*t)\" }]\noutflow = [{ x = 2.0, velocity = 1.0 }]";
    let text = channel(2.0, 0.05, 3.0, faces).replace("[2.0, 0.4] } }", "[2.0, 0.4] } }\nvelocity = [1.0, 0.0]");
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    sim.enable_energy_budget();
    let probe = EnergyBudgetProbe::new(sim.system());
    common::run_to(&mut sim, 3.0).expect("a sound run");
    let (budget, row) = (*sim.energy_budget().expect("it is recorded"), probe.sample(&sim));
    let passed: f64 = sim.system().face_exchange().iter().map(|face| face.energy).sum();
    let turnover: f64 = budget.entries().iter().map(|(_, energy)| energy.abs()).sum();
    let residual = row.last().expect("a residual").abs();
    assert!((budget.removed - passed).abs() < 1e-9 * turnover, "{} J/m of {passed} J/m", budget.removed);
    assert!(budget.walls.abs() > 1.0 && residual < 1e-3 * turnover, "{residual} J/m of {turnover} J/m remain");
}

/// The force on the level bed of a river is that of the water between the faces. It bears the weight of this water within 1 %; with the
/// buffers it would bear 40 % more. Water that slips pushes it along by less than 0.1 % of that weight. A patch over the whole bed has
/// the same force.
#[test]
fn the_force_on_a_bed_is_that_of_the_water_between_the_faces() {
    let faces = "inflow = [{ x = 0.0, velocity = 0.5 }]\noutflow = [{ x = 2.0, velocity = 0.5 }]";
    let text = channel(2.0, 0.05, 2.0, faces).replace("[2.0, 0.4] } }", "[2.0, 0.4] } }\nvelocity = [0.5, 0.0]");
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    let patch = PatchProbe::<2>::new(sim.system(), "bed", &[-9.0, -0.4], &[9.0, 0.1]).expect("a part of the bed");
    let now = |sim: &Simulation<2>| {
        let bed = sim.system().solids().iter().find(|solid| solid.spec.name == "bed").expect("a bed");
        let weight = sim.system().fluid().len() as f64 * sim.system().particle_mass() * 9.81;
        let part = patch.sample(sim);
        let differs = (part[0] - bed.load.force[0]).abs() + (part[1] - bed.load.force[1]).abs();
        [bed.load.force[0] / weight, -bed.load.force[1] / weight, differs / weight]
    };
    let [along, down, differs] = common::time_mean(&mut sim, 1.0, 2.0, now).expect("a sound run");
    assert!((down - 1.0).abs() < 0.01, "the bed bears {down} of the weight of the water");
    assert!(along.abs() < 1e-3, "the water pushes the bed along by {along} of its weight");
    assert!(differs < 1e-9, "the forces of bed and patch differ by {differs} of the weight");
}

/// A carriage that starts to tow with 0.8 m/s in water at rest: in its frame the water enters at the bow and leaves at the stern with this
/// speed, within 1 %, and the surface stays level within a twentieth of dp.
#[test]
fn water_at_rest_passes_a_towed_frame_through_its_faces() {
    let speed = "0.4*(1-cos(pi*min(t,2)/2))";
    let face = |x: f64| format!("[{{ x = {x:?}, velocity = 1.0, factor = \"{speed}\" }}]");
    let (bow, stern) = (face(2.0), face(0.0));
    let drive = format!("towed = {{ along = \"x\", velocity = \"{speed}\" }}\ninflow = {bow}\noutflow = {stern}");
    let mut sim = common::scene_simulation::<2>(&channel(2.0, 0.05, 6.0, &drive)).expect("a sound scene");
    let gauge = ElevationProbe::new(sim.system(), &[1.0]).expect("a place in the water");
    let now = |sim: &Simulation<2>| {
        let fluid = sim.system().fluid();
        [fluid.v.iter().map(|v| v[0]).sum::<f64>() / fluid.len() as f64, gauge.sample(sim)[0]]
    };
    let [velocity, level] = common::time_mean(&mut sim, 3.0, 6.0, now).expect("a sound run");
    assert!((velocity + 0.8).abs() < 0.008, "{velocity} m/s in the frame of the carriage");
    assert!((level - 0.4).abs() < 0.05 * 0.05, "{level} m of 0.4 m");
}

/// A duct with the wake of a cylinder, whose faces keep rows because their velocity has a factor: the disordered water that leaves stays
/// between the walls. In the wall the velocity, a parabola, is negative: particles there would come back, and did, after 3.9 s.
#[test]
fn water_that_leaves_a_duct_with_a_wake_stays_between_its_walls() {
    let profile = "velocity = \"30*y*(0.4-y)\", factor = \"1+0*t\"";
    let text = format!(
        r#"
        dimension = 2
        dp = 0.02
        until = 5.0
        gravity = [0.0, 0.0]
        inflow = [{{ x = 0.0, {profile} }}]
        outflow = [{{ x = 1.2, {profile} }}]
        [[water]]
        fill = {{ box = {{ min = [0.0, 0.0], max = [1.2, 0.4] }} }}
        velocity = ["30*y*(0.4-y)+0.3*sin(4*pi*x)*sin(7.5*pi*y)", "0.3*sin(6*pi*x+1)*sin(2.5*pi*y)"]
        [[solid]]
        name = "bottom"
        fixed = true
        shape = {{ box = {{ size = [4.0, 0.2] }} }}
        at = [0.6, -0.1]
        [[solid]]
        name = "top"
        fixed = true
        shape = {{ box = {{ size = [4.0, 0.2] }} }}
        at = [0.6, 0.5]
        [[solid]]
        name = "cylinder"
        fixed = true
        shape = {{ ball = {{ radius = 0.04 }} }}
        at = [0.5, 0.19]
        [model]
        c0 = 20.0
        slip = "none"
        diffusion = {{ molteni = {{ delta = 0.1 }} }}
        viscosity = {{ laminar = {{ nu0 = 0.002 }} }}
        shifting = {{ everywhere = {{ }} }}
        "#
    );
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    for k in 1..=50 {
        common::run_to(&mut sim, 0.1 * f64::from(k)).expect("a sound run");
        let system = sim.system();
        let buffer = system.buffer_particles(1).map(|(r, ..)| r[1]);
        let outside = system.fluid().r.iter().map(|r| r[1]).chain(buffer).map(|y| (-y).max(y - 0.4));
        let farthest = outside.fold(f64::NEG_INFINITY, f64::max);
        assert!(farthest < 0.25 * 0.02, "{farthest} m in a wall at {} s", sim.time());
    }
    assert!(sim.rollbacks().is_empty(), "{:?}", sim.rollbacks());
}

/// After an alarm the run returns to an earlier state with the water, and the books, of that time; both go on from there.
#[test]
fn a_rollback_restores_the_water_and_the_books_of_the_faces() {
    let faces = "inflow = [{ x = 0.0, velocity = 1.0 }]\noutflow = [{ x = 2.0, velocity = 1.0 }]";
    let text = channel(2.0, 0.05, 9.0, faces).replace("[2.0, 0.4] } }", "[2.0, 0.4] } }\nvelocity = [1.0, 0.0]");
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    let start = sim.system().fluid().len() as i64;
    let books = |sim: &Simulation<2>| (sim.system().fluid().len(), sim.system().face_exchange().to_vec());
    common::steps(&mut sim, 500);
    let then = books(&sim);
    common::steps(&mut sim, 200);
    assert!(books(&sim) != then, "water has passed the faces since");
    let c0 = sim.system().model().c0;
    sim.set_water_velocity(|r| Vector::from([if (0.9..1.0).contains(&r[0]) { 2.0 * c0 } else { 1.0 }, 0.0]));
    sim.step().expect("the run rolls back");
    assert_eq!((sim.steps(), sim.rollbacks().len()), (500, 1));
    assert_eq!(books(&sim), then);
    common::steps(&mut sim, 600);
    assert_eq!(sim.system().fluid().len() as i64, start + exchanged(&sim));
    assert!(books(&sim) != then && sim.rollbacks().len() == 1, "water goes on to pass");
}

/// A barge in a current of 0.4 m/s on a chain, part of which lies on the bed: from 8 s to 12 s the mean horizontal pull of the chain is the mean
/// force of the water within 1 %, and the tension at the bow is that of a catenary, H + w z with this force H, the weight w of the chain in
/// water (N/m) and the height z of the bow (m), within 3 %. Found: 0.01 % and 0.5 %.
#[test]
fn the_drag_of_a_moored_barge_is_borne_by_a_catenary() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/moored-barge");
    // A chain twice as heavy, because the drag of this coarse barge lifts the scene's from the bed.
    let keys = [("dp", "0.04"), ("line_type.0.mass_per_length", "2.4")].map(|(key, value)| (key.into(), value.into()));
    let scene = Scene::read(&path, &keys).expect("a scene");
    let mut sim = Simulation::<2>::new(scene.build().expect("a sound scene").setup).expect("a sound setup");
    sim.enable_load_breakdown();
    let now = |sim: &Simulation<2>| {
        let (loads, line) = (sim.load_breakdown(1).expect("it is recorded"), sim.mooring_reading(0));
        let drag = loads.pressure.force[0] + loads.viscous.force[0];
        [drag, -loads.moorings.force[0], line.end_forces[0].norm(), line.nodes[0][1], line.on_bed]
    };
    let [drag, pull, tension, height, on_bed] = common::time_mean(&mut sim, 8.0, 12.0, now).expect("a sound run");
    let weight = (2.4 - 1000.0 * 0.25 * std::f64::consts::PI * 0.014 * 0.014) * 9.81;
    assert!(drag > 10.0 && on_bed > 0.1, "{drag} N/m, {on_bed} m lie");
    assert!((pull / drag - 1.0).abs() < 0.01, "the chain pulls with {pull} N/m, the water with {drag} N/m");
    let theory = drag + weight * height;
    assert!((tension / theory - 1.0).abs() < 0.03, "{tension} N/m at the bow, by the catenary {theory} N/m");
}

/// A level that cannot be followed, and a bed that ends at a face, are refused with the number that would do.
#[test]
fn moving_levels_and_beds_that_cannot_be_are_refused_with_the_number_that_would_do() {
    let build = |text: &str| {
        common::scene_simulation::<2>(text).err().map(|e| format!("{e} {}", e.help.clone().unwrap_or_default()))
    };
    let with =
        |level: &str| build(&channel(2.0, 0.05, 10.0, &format!("outflow = [{{ x = 0.0, level = \"{level}\" }}]")));
    assert_eq!(with("0.4+0.01*t"), None);
    for (level, said) in [
        ("0.5+0.01*t", "add -0.1 m"),
        ("0.4-0.03*t", "keep it at 0.2 m or more"),
        ("0.4+0.3*t", "let the change take 1.6 times as long"),
    ] {
        let refused = with(level).unwrap_or_default();
        assert!(refused.contains("outflow.0") && refused.contains(said), "{level}: {refused}");
    }
    let low = channel(2.0, 0.05, 10.0, "outflow = [{ x = 0.0, level = \"0.4+0.05*t\" }]");
    let refused = build(&format!("{low}\n[domain]\nmin = [-1.0, -1.0]\nmax = [3.0, 0.7]\n")).unwrap_or_default();
    assert!(refused.contains("keep it at 0.65 m or less"), "{refused}");
    let lid =
        "[[solid]]\nname = \"lid\"\nfixed = true\nshape = { box = { size = [8.0, 0.2] } }\nat = { x = 1.0, y = 0.6 }\n";
    let refused = build(&format!("{low}\n{lid}")).unwrap_or_default();
    assert!(refused.contains("into solid \"lid\"") && refused.contains("keep it below 0.5 m"), "{refused}");
    let short = low.replace("size = [8.0, 0.2]", "size = [2.0, 0.2]");
    let refused = build(&short).unwrap_or_default();
    assert!(
        refused.contains("solid \"bed\", the bed, ends at open boundary") && refused.contains("let it reach to x = -"),
        "{refused}"
    );
}

/// Probes at a face also see the water of the buffer beyond it: after a step the flow and the pressure are exact within 2 %, the level
/// within a fifth of dp.
#[test]
fn probes_at_a_face_read_as_those_in_the_water() {
    let faces = "inflow = [{ x = 0.0, velocity = 0.5 }]\noutflow = [{ x = 2.0, velocity = 0.5 }]";
    let text = channel(2.0, 0.05, 2.0, faces).replace("0.4] } }", "0.4] } }\nvelocity = [0.5, 0.0]");
    let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
    common::steps(&mut sim, 1);
    for x in [0.0, 0.01, 0.05, 1.0, 1.97, 2.0] {
        let flow = FlowProbe::<2>::new(&[x, 0.0], &[x, 0.4]).expect("a section").sample(&sim)[0];
        assert!((flow / 0.2 - 1.0).abs() < 0.02, "a flow of {flow} m²/s at {x} m");
        let p = PressureProbe::<2>::new(&[x, 0.2]).expect("a place").sample(&sim)[0];
        assert!((p / (9810.0 * 0.2) - 1.0).abs() < 0.02, "{p} Pa at {x} m");
        let level = ElevationProbe::new(sim.system(), &[x]).expect("a place").sample(&sim)[0];
        assert!((level - 0.4).abs() < 0.01, "a level of {level} m at {x} m");
    }
}
