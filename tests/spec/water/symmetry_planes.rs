//! Symmetry planes: half and quarter models move as the whole model does, at rest and in motion, and keep momentum and energy.

use std::{collections::BTreeMap, path::Path};

use pontoon::{
    Result,
    math::Vector,
    model::PairLoopKind,
    probe::{EnergyBudgetProbe, Probe},
    scene::Scene,
    simulation::{Dimension, Setup, Simulation},
    solid::Dim,
};

use crate::common;

/// Largest difference of positions after 50 steps, dp: sums of single precision in another order leave 10⁻⁷ of an acceleration,
/// which moves a particle by far less than this within 50 steps.
const BOUND: f64 = 1e-6;

/// A column of water in the middle of a tank.
const COLUMN: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
water = [{ fill = { box = { min = [0.4, 0.0], max = [0.8, 0.4] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.2, 0.8] } }
"#;

/// A box of nine rows, which has a row on the plane, let go above its draft.
const BOX: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
water = [{ fill = { box = { min = [0.0, 0.0], max = [0.8, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.6] } }
[[solid]]
name = "box"
shape = { box = { size = [0.18, 0.1] } }
at = { x = 0.4, draft = 0.03 }
free = { density = 500.0 }
"#;

/// A light disc, whose rows do not fit the lattice and which has an acoustic added mass.
const DISC: &str = r#"
dimension = 2
dp = 0.02
until = 1.0
water = [{ fill = { box = { min = [0.0, 0.0], max = [0.8, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.6] } }
[[solid]]
name = "box"
shape = { ball = { radius = 0.08 } }
at = { x = 0.4, draft = 0.06 }
free = { density = 40.0 }
"#;

const BOX_3D: &str = r#"
dimension = 3
dp = 0.05
until = 1.0
water = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [1.0, 0.8, 0.4] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.8, 0.7] } }
[[solid]]
name = "box"
shape = { box = { size = [0.3, 0.25, 0.2] } }
at = { x = 0.5, y = 0.4, draft = 0.04 }
free = { density = 500.0 }
"#;

/// The set-up of a scene with further keys before its first line.
fn setup<const D: usize>(keys: &str, scene: &str, pair_loop: PairLoopKind) -> Result<Setup<D>> {
    let mut setup = Scene::parse(&format!("{keys}\n{scene}"), Path::new(""), &[])?.build::<D>()?.setup;
    setup.model = setup.model.pair_loop(pair_loop);
    Ok(setup)
}

/// The simulation of a scene with further keys before its first line.
fn simulation<const D: usize>(keys: &str, scene: &str, pair_loop: PairLoopKind) -> Result<Simulation<D>>
where
    Dim<D>: Dimension<D>,
{
    Simulation::new(setup(keys, scene, pair_loop)?)
}

/// The whole of which `part` has the water on one side of planes at `planes` (m): water packed around a body is symmetric only so.
fn whole_of<const D: usize>(part: &Setup<D>, mut whole: Setup<D>) -> Setup<D> {
    (whole.water, whole.surface_levels) = (part.water.clone(), part.surface_levels.clone());
    for (axis, at) in part.symmetry.iter().enumerate().filter_map(|(axis, at)| Some((axis, (*at)?))) {
        let image = |r: &Vector<D>| Vector::from_fn(|i, _| if i == axis { 2.0 * at - r[i] } else { r[i] });
        whole.water.extend(whole.water.iter().map(image).collect::<Vec<_>>());
        whole.surface_levels.extend_from_within(..);
    }
    whole
}

/// The place of each water particle after some steps, by its place at the start in thousandths of dp.
fn places<const D: usize>(sim: &mut Simulation<D>, steps: usize) -> BTreeMap<[i64; D], Vector<D>>
where
    Dim<D>: Dimension<D>,
{
    let unit = 1e-3 * sim.system().model().dp;
    let fluid = sim.system().fluid();
    let key = |r: &Vector<D>| std::array::from_fn(|i| (r[i] / unit).round() as i64);
    let start: BTreeMap<u32, [i64; D]> = fluid.id.iter().copied().zip(fluid.r.iter().map(key)).collect();
    assert!(start.len() == fluid.len());
    common::steps(sim, steps);
    let fluid = sim.system().fluid();
    fluid.id.iter().zip(fluid.r).map(|(id, r)| (start[id], *r)).collect()
}

/// Largest distance (dp) of the particles of `part` from those of `whole`.
fn difference<const D: usize>(
    part: &BTreeMap<[i64; D], Vector<D>>,
    whole: &BTreeMap<[i64; D], Vector<D>>,
    dp: f64,
) -> f64 {
    part.iter().map(|(key, r)| (whole[key] - r).norm() / dp).fold(0.0, f64::max)
}

/// Asserts that the scene with the `planes` moves as without them over 50 steps, its water and its second solid.
fn moves_as_the_whole<const D: usize>(planes: &str, scene: &str, parts: usize)
where
    Dim<D>: Dimension<D>,
{
    for kind in [PairLoopKind::Reference, PairLoopKind::Fast] {
        let half = setup::<D>(planes, scene, kind).expect("a part of the model");
        let full = setup::<D>("", scene, kind).expect("the whole model");
        assert!(!half.water.is_empty() && full.water.len().abs_diff(half.water.len() * parts) < parts * 2);
        let mut whole = Simulation::new(whole_of(&half, full)).expect("the whole model");
        let mut part = Simulation::new(half).expect("a part of it");
        let dp = whole.system().model().dp;
        assert_eq!(part.system().fluid().len() * parts, whole.system().fluid().len(), "{planes}");
        let (all, some) = (places(&mut whole, 50), places(&mut part, 50));
        let off = difference(&some, &all, dp);
        assert!(off < BOUND, "{planes} {kind:?}: water differs by {off:.1e} dp");
        let (whole, part) = (whole.system().solids(), part.system().solids());
        for (a, b) in part.iter().zip(whole) {
            let name = &a.spec.name;
            let off = (a.kinematics.centre - b.kinematics.centre).norm() / dp;
            assert!(off < BOUND, "{planes} {kind:?}: {name} differs by {off:.1e} dp");
            // Only the normal components of the load of the whole are round-off.
            let (load, reference) = (a.load.force, b.load.force);
            let off = (load - reference).norm() / reference.norm().max(1e-9);
            assert!(off < 1e-4, "{planes} {kind:?}: the load on {name} differs by {off:.1e}");
        }
    }
}

#[test]
fn the_halves_of_a_symmetric_model_move_alike() {
    // The measure of what a half model can reach.
    for kind in [PairLoopKind::Reference, PairLoopKind::Fast] {
        let mut whole = simulation::<2>("", COLUMN, kind).expect("the whole model");
        let all = places(&mut whole, 50);
        let mirrored =
            all.iter().map(|(key, r)| ([60_000 - key[0], key[1]], Vector::from([1.2 - r[0], r[1]]))).collect();
        let off = difference(&mirrored, &all, 0.02);
        assert!(off < BOUND, "{kind:?}: {off:.1e} dp");
    }
}

#[test]
fn half_a_collapsing_column_moves_as_the_whole() {
    moves_as_the_whole::<2>("symmetry = { x = 0.6 }", COLUMN, 2);
}

#[test]
fn a_half_model_moves_as_the_whole_with_tensors_shifting_no_slip_dynamic_walls_and_verlet() {
    for keys in [
        "viscosity = { sps = { nu0 = 1e-3 } }\nslip = \"none\"",
        "gradient = \"corrected\"\nkernel = \"wendland\"",
        "shifting = { everywhere = { a = 2.0 } }\nwalls = \"dbc\"",
    ] {
        moves_as_the_whole::<2>("symmetry = { x = 0.6 }", &format!("{COLUMN}\n[model]\n{keys}\n"), 2);
    }
    let verlet = "time = { scheme = { verlet = { euler_every = 20 } } }";
    moves_as_the_whole::<2>("symmetry = { x = 0.6 }", &format!("{verlet}\n{COLUMN}"), 2);
}

#[test]
fn a_body_cut_by_a_plane_heaves_as_in_the_whole_model() {
    // A light box also has an acoustic added mass.
    for scene in [BOX, &BOX.replace("500.0", "40.0"), DISC] {
        moves_as_the_whole::<2>("symmetry = { x = 0.4 }", scene, 2);
    }
}

#[test]
fn a_box_in_a_quarter_model_heaves_as_in_the_whole_model() {
    moves_as_the_whole::<3>("symmetry = { x = 0.5, y = 0.4 }", BOX_3D, 4);
}

/// Two boxes side by side, mirror images of one another, or one of them. They do not fit the lattice, because the first pressure of a
/// boundary particle that is equally near to two particles of water is not symmetric.
fn pair(both: bool) -> String {
    let body = |name: &str, x: f64| {
        format!(
            "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [0.13, 0.1] }} }}\n\
             at = {{ x = {x}, draft = 0.03 }}\nfree = {{ density = 500.0 }}\n"
        )
    };
    let tank = COLUMN.replace("min = [0.4, 0.0], max = [0.8, 0.4]", "min = [0.0, 0.0], max = [1.2, 0.3]");
    tank + &body("box", 0.703) + &if both { body("other", 0.497) } else { String::new() }
}

#[test]
fn a_body_beside_a_plane_moves_as_with_its_mirror_image() {
    for kind in [PairLoopKind::Reference, PairLoopKind::Fast] {
        let half = setup::<2>("symmetry = { x = 0.6 }", &pair(false), kind).expect("one of them");
        let full = setup::<2>("", &pair(true), kind).expect("both bodies");
        let mut whole = Simulation::new(whole_of(&half, full)).expect("both bodies");
        let mut part = Simulation::new(half).expect("one of them");
        let (all, some) = (places(&mut whole, 50), places(&mut part, 50));
        let off = difference(&some, &all, 0.02);
        assert!(off < BOUND, "{kind:?}: water differs by {off:.1e} dp");
        let [a, b] = [&part, &whole].map(|sim| sim.system().solids()[1].kinematics);
        let off = (a.pose.position - b.pose.position).norm() / 0.02;
        assert!(off < BOUND, "{kind:?}: the box differs by {off:.1e} dp");
        let turned = (a.pose.rotation - b.pose.rotation).norm();
        assert!(a.spin.axial()[0] != 0.0 && turned < BOUND, "{kind:?}: the box turns by {turned:.1e} rad more");
    }
}

#[test]
fn the_series_of_a_half_model_are_those_of_the_whole() {
    let half = setup::<2>("symmetry = { x = 0.4 }", BOX, PairLoopKind::Reference).expect("a half model");
    let full = setup::<2>("", BOX, PairLoopKind::Reference).expect("the whole model");
    let mut whole = Simulation::new(whole_of(&half, full)).expect("the whole model");
    let mut part = Simulation::new(half).expect("a half model");
    let row = |sim: &mut Simulation<2>| {
        let probe = EnergyBudgetProbe::new(sim.system());
        sim.enable_energy_budget();
        common::steps(sim, 100);
        probe.sample(sim)
    };
    let (all, some) = (row(&mut whole), row(&mut part));
    // Both are sums over the whole, of which round-off in 100 steps is the only difference.
    let turnover: f64 = all.iter().skip(1).map(|energy| energy.abs()).sum();
    for (a, b) in all.iter().zip(&some) {
        assert!((a - b).abs() < 1e-6 * turnover, "{all:?}\n{some:?}");
    }
    // The budget closes as far as that of the whole model does.
    let [whole_rest, rest] = [&all, &some].map(|row| row[row.len() - 1].abs());
    assert!(
        rest < 1.01 * whole_rest + 1e-9 * turnover,
        "{rest} J/m left of {turnover}, {whole_rest} in the whole model"
    );
}

#[test]
fn momentum_along_a_plane_changes_by_weight_and_loads_alone() {
    let mut sim = simulation::<2>("symmetry = { x = 0.6 }", COLUMN, PairLoopKind::Reference).expect("half a column");
    let mass = sim.system().particle_mass() * sim.system().fluid().len() as f64;
    for _ in 0..100 {
        let before = common::water_momentum(&sim);
        sim.step().expect("a sound run");
        let system = sim.system();
        let change = (common::water_momentum(&sim) - before) / sim.dt();
        // The computed side has half of the load on the tank, and along the normal the force of the plane.
        let vertical = -9.81 * mass - 0.5 * system.solids()[0].load.force[1];
        let off = (change[1] - vertical).abs() / (9.81 * mass);
        assert!(off < 1e-10, "{off:.1e} of the weight, of which pair forces leave round-off");
        assert!(system.solids()[0].load.force[0] == 0.0, "the load on the whole tank has no normal component");
    }
}

#[test]
fn still_water_beside_a_plane_stays_still_and_presses_on_it() {
    let scene = COLUMN.replace("min = [0.4, 0.0], max = [0.8, 0.4]", "min = [0.0, 0.0], max = [1.2, 0.4]");
    let mut whole = simulation::<2>("", &scene, PairLoopKind::Fast).expect("a tank");
    common::run_to(&mut whole, 0.5).expect("a run");
    let half = |dp: &str| {
        let scene = scene.replace("dp = 0.02", dp);
        let mut sim = simulation::<2>("symmetry = { x = 0.6 }", &scene, PairLoopKind::Fast).expect("half a tank");
        let mean = common::time_mean(&mut sim, 0.2, 0.5, |sim| [sim.system().symmetry_plane_force(0)]);
        (mean.expect("a run")[0], sim)
    };
    let ((coarse, sim), (fine, _)) = (half("dp = 0.02"), half("dp = 0.01"));
    // Pairs of water and images of the bed carry the pressure at the bed over a third of dp more than the depth, an error of first
    // order. The rest is compression and the row at the surface, (1/40)² and less.
    let (force, expected) = (2.0 * fine - coarse, 0.5 * 1000.0 * 9.81 * 0.4 * 0.4);
    assert!((force / expected - 1.0).abs() < 0.005, "{coarse}, {fine} N/m, in the limit {force} N/m of {expected} N/m");
    let fastest = |sim: &Simulation<2>| sim.system().fluid().v.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let (own, reference) = (fastest(&sim), fastest(&whole));
    assert!(own < 1.5 * reference + 1e-4, "{own} m/s beside the plane, {reference} m/s in the whole tank");
    let across = sim.system().fluid().r.iter().filter(|r| r[0] < 0.6).count();
    assert!(across == 0, "{across} particles have left the computed side");
}

#[test]
fn a_run_with_planes_has_the_same_bits_after_a_restart_and_on_any_number_of_threads() {
    for (planes, scene) in [
        ("symmetry = { x = 0.4 }\ntime = { scheme = { verlet = { euler_every = 20 } } }", DISC),
        ("symmetry = { x = 0.6 }", pair(false).as_str()),
    ] {
        let scene = format!("{scene}[model]\nviscosity = {{ sps = {{ nu0 = 1e-3 }} }}\n");
        let start = || simulation::<2>(planes, &scene, PairLoopKind::Fast).expect("a sound scene");
        let on = |threads: usize| {
            common::on_threads(threads, || {
                let mut sim = start();
                common::steps(&mut sim, 70);
                let saved = sim.save().expect("a state");
                common::steps(&mut sim, 70);
                (saved, sim.save().expect("a state"))
            })
        };
        let (saved, whole) = on(1);
        assert!(on(3) == (saved.clone(), whole.clone()), "{planes}: threads");
        let mut resumed = start();
        resumed.restore(&saved).expect("a state of this setup");
        common::steps(&mut resumed, 70);
        assert!(resumed.save().expect("a state") == whole, "{planes}: restart");
    }
}

#[test]
fn what_contradicts_the_symmetry_is_refused_with_a_remedy() {
    let refused = |keys: &str, scene: &str| {
        let scene = Scene::parse(&format!("{keys}\n{scene}"), Path::new(""), &[]).expect("a readable scene");
        match scene.build::<2>() {
            Ok(_) => panic!("{keys} is accepted"),
            Err(error) => error.to_string(),
        }
    };
    let plane = "symmetry = { x = 0.4 }";
    let still = |keys: &str| {
        let tank = &BOX[..BOX.rfind("[[solid]]").unwrap_or(0)];
        tank.replace("max = [0.8, 0.3] } }", &format!("max = [0.8, 0.3] }} }}, {keys}")).replace(", }", " }")
    };
    let lower_beyond = still("").replace(
        "{ fill = { box = { min = [0.0",
        "{ fill = { box = { min = [0.0, 0.0], max = [0.4, 0.2] } } }, { fill = { box = { min = [0.4",
    );
    for keys in ["velocity = [\"0.2*(x-0.4)\", \"0.1*cos(4*(x-0.4))\"]", "pressure = \"50*(x-0.4)^2\""] {
        let scene = Scene::parse(&format!("{plane}\n{}", still(keys)), Path::new(""), &[]).expect("a readable scene");
        assert_eq!(scene.build::<2>().err().map(|error| error.to_string()), None, "{keys} is symmetric");
    }
    let line = |from: [f64; 2], to: [f64; 2]| {
        format!(
            "{BOX}[[spring]]\nname = \"s{}\"\nbetween = [\"box\"]\nfrom = {from:?}\nto = {to:?}\nstiffness = 50.0\n",
            (100.0 * from[0]) as i32
        )
    };
    let force = |load: &str| format!("{BOX}[[force]]\nname = \"f\"\non = \"box\"\n{load}\n");
    // With its mirror image a load keeps the symmetry.
    let both = line([0.35, 0.3], [0.1, 0.3]) + &line([0.45, 0.3], [0.7, 0.3])[BOX.len()..];
    let vertical = force("at = [0.4, 0.3]\nforce = [0.0, -1.0]");
    for scene in [both, line([0.4, 0.3], [0.4, 0.0]), vertical] {
        let scene = Scene::parse(&format!("{plane}\n{scene}"), Path::new(""), &[]).expect("a readable scene");
        let refusal = scene.build::<2>().err().map(|error| error.to_string());
        assert_eq!(refusal, None, "a symmetric load is accepted");
    }
    // A turned disc ends where the disc does.
    let turned = BOX.replace("box = { size = [0.18, 0.1] }", "ball = { radius = 0.1 }");
    let turned = turned.replace("x = 0.4, draft = 0.03", "x = 0.52, draft = 0.1, angle_deg = 45");
    let scene = Scene::parse(&format!("{plane}\n{turned}"), Path::new(""), &[]).expect("a readable scene");
    assert_eq!(scene.build::<2>().err().map(|error| error.to_string()), None, "a disc beside the plane");
    for (keys, scene, expected) in [
        ("symmetry = { y = 0.2 }", BOX.into(), "gravity"),
        ("symmetry = { x = 0.605 }", COLUMN.into(), "symmetry.x = "),
        ("symmetry = { x = 0.4 }\nperiodic = { x = [0.0, 0.8] }", BOX.into(), "leave  periodic.x"),
        (plane, BOX.replace("x = 0.4, draft", "x = 0.43, draft"), "not symmetric"),
        (plane, BOX.replace("x = 0.4, draft", "x = 0.2, draft"), "lies beyond"),
        (plane, BOX.replace("density = 500.0", "density = 500.0, velocity = [0.1, 0.0]"), "out of the symmetry"),
        (plane, BOX.replace("max = [0.8, 0.3]", "max = [0.7, 0.3]"), "the water is not symmetric"),
        (plane, lower_beyond, "the water is not symmetric"),
        (plane, still("velocity = [0.2, 0.0]"), "the velocity of the water at the start"),
        (plane, still("velocity = [0.0, \"0.2*(x-0.4)\"]"), "the velocity of the water at the start"),
        (plane, still("pressure = \"50*x\""), "the pressure of the water at the start"),
        ("symmetry = { x = 0.4 }\ntowed = { along = \"x\", velocity = \"0.2*t\" }", still(""), "towed along x"),
        (plane, format!("{BOX}[[force]]\nname = \"f\"\non = \"box\"\nforce = [1.0, 0.0]\n"), "leave out its component"),
        (plane, line([0.35, 0.3], [0.1, 0.3]), "mirror image too"),
        (plane, force("at = [0.45, 0.3]\nforce = [0.0, -1.0]"), "mirror image at"),
        (plane, force("torque = [1.0]"), "leave out its torque"),
    ] {
        let message = refused(keys, &scene);
        assert!(message.contains(expected) && message.contains("symmetry"), "{message}");
    }
    let beside = BOX.replace("x = 0.4, draft", "x = 0.7, draft")
        + &BOX[BOX.rfind("[[solid]]").unwrap_or(0)..].replace("\"box\"\n", "\"cut\"\n");
    assert!(refused(plane, &beside.replace("size = [0.18, 0.1]", "size = [0.1, 0.1]")).contains("touch = false"));
}

#[test]
fn a_body_that_reaches_a_plane_stops_the_run() {
    let scene = pair(false).replace("density = 500.0", "density = 500.0, velocity = [-2.0, 0.0]");
    let mut sim = simulation::<2>("symmetry = { x = 0.6 }", &scene, PairLoopKind::Fast).expect("a sound scene");
    let error = (0..2000).find_map(|_| sim.step().err()).expect("the box meets its image");
    assert!(error.to_string().contains("mirror image"), "{error}");
}
