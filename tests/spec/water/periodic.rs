//! Periodic sides: results do not depend on their position, and particles and momentum are conserved.

use std::f64::consts::TAU;

use pontoon::{
    error::Result,
    geometry::Shape,
    math::{Pose, Vector, expression::Formula},
    model::{Diffusion, Model, PairLoopKind, Shifting, Slip, Viscosity},
    simulation::{Setup, Simulation},
    solid::{FreeBody, PrescribedMotion, Role, SolidSpec, TimeFunction},
    sph::{particle_shifting::Shift, viscosity::Laminar},
};

use crate::common::{self, Random};

const DP: f64 = 0.05;

fn model() -> Model {
    let mut model = Model::water(2, DP, 1.0);
    (model.c0, model.gravity) = (20.0, vec![0.0, 0.0]);
    model.viscosity = Viscosity::Laminar(Laminar { nu0: 0.01 });
    model.shifting = Shifting::Everywhere(Shift::default());
    model
}

/// A square metre of swirling water, periodic from (`x`, `y`), with particles displaced from the lattice.
fn swirl(model: Model, x: f64, y: f64) -> Simulation<2> {
    let mut random = Random(7);
    let off = |r: Vector<2>, random: &mut Random| r + (random.point::<2>() - Vector::repeat(0.5)) * (0.2 * DP);
    let wrap = |r: f64, from: f64| from + (r - from).rem_euclid(1.0);
    let water: Vec<Vector<2>> =
        common::lattice([0.0, 0.0], [1.0, 1.0], DP).into_iter().map(|r| off(r, &mut random)).collect();
    let velocity = water.iter().map(|r| Vector::from([-(TAU * r[1]).sin(), (TAU * r[0]).sin()])).collect();
    let pressure = water.iter().map(|r| 2000.0 + 300.0 * (TAU * r[0]).cos()).collect();
    let water = water.iter().map(|r| Vector::from([wrap(r[0], x), wrap(r[1], y)]));
    let mut setup = Setup::new(model).water(water, 0.0).periodic(0, x, x + 1.0).periodic(1, y, y + 1.0);
    (setup.velocity, setup.pressure) = (velocity, pressure);
    Simulation::new(setup).expect("a sound setup")
}

#[test]
fn the_position_of_the_periodic_sides_does_not_change_the_flow() {
    for (pair_loop, bound) in [(PairLoopKind::Reference, 1e-9), (PairLoopKind::Fast, 1e-3)] {
        let at = |x: f64, y: f64| {
            let mut sim = swirl(model().pair_loop(pair_loop), x, y);
            (0..20).for_each(|_| sim.step().expect("a sound run"));
            let fluid = sim.system().fluid();
            let mut v = vec![Vector::<2>::zeros(); fluid.len()];
            fluid.id.iter().zip(fluid.v).for_each(|(id, v_of)| v[*id as usize] = *v_of);
            v
        };
        let (here, there) = (at(0.0, 0.0), at(0.37, -0.61));
        // Sums are in another order, and 20 steps amplify the rounding. SIMD lanes round in single precision.
        let off = here.iter().zip(&there).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(off < bound, "{pair_loop:?}: {off} m/s");
    }
}

#[test]
fn periodic_sides_conserve_particles_and_momentum() {
    let mut sim = swirl(model(), 0.0, 0.0);
    let (before, mass) = (common::water_momentum(&sim), sim.system().particle_mass());
    let n = sim.system().fluid().len();
    while sim.time() < 1.2 {
        sim.step().expect("a sound run");
    }
    let fluid = sim.system().fluid();
    let mut ids = fluid.id.to_vec();
    ids.sort_unstable();
    assert!(ids.iter().copied().eq(0..n as u32), "every particle is present once");
    // Between two rebuilds of the neighbour lists a particle may lie slightly outside its side.
    assert!(fluid.r.iter().all(|r| r.iter().all(|x| (-DP..1.0 + DP).contains(x))));
    // Pair forces cancel except for the last bit of the position of an image: single precision of the largest force.
    let drift = (common::water_momentum(&sim) - before).norm();
    assert!(drift < 1e-5 * n as f64 * mass, "{drift} kg m/s");
}

#[test]
fn a_periodic_run_has_the_same_bits_after_a_restart_and_on_any_number_of_threads() {
    let on = |threads: usize| {
        common::on_threads(threads, || {
            let mut sim = swirl(model(), 0.0, 0.0);
            (0..60).for_each(|_| sim.step().expect("a sound run"));
            let saved = sim.save().expect("a state");
            (0..60).for_each(|_| sim.step().expect("a sound run"));
            (saved, sim.save().expect("a state"))
        })
    };
    let (saved, whole) = on(1);
    assert!(on(3) == (saved.clone(), whole.clone()));
    let mut resumed = swirl(model(), 0.0, 0.0);
    resumed.restore(&saved).expect("a state of this setup");
    (0..60).for_each(|_| resumed.step().expect("a sound run"));
    assert!(resumed.save().expect("a state") == whole);
}

#[test]
fn the_wall_drag_in_a_steady_periodic_channel_equals_the_driving_force() {
    // In steady flow the drag of both walls is the weight of the water along the channel, images not counted.
    let (height, length, g) = (1.0, 0.5, 0.8);
    let mut model = model().gravity([g, 0.0]).shifting(Shifting::None).diffusion(Diffusion::None);
    (model.viscosity, model.slip) = (Viscosity::Laminar(Laminar { nu0: 0.1 }), Slip::None);
    let water = common::lattice([0.0, 0.0], [length, height], DP);
    let slab = |name: &str, y: f64| {
        let shape = Shape::Box { size: Vector::from([3.0, 0.2]) };
        common::solid(name, shape, Pose::at(Vector::from([0.0, y])), Role::Fixed)
    };
    let solids = vec![slab("bottom", -0.1), slab("top", height + 0.1)];
    let setup = Setup::new(model).water(water, 0.0).solids(solids).periodic(0, 0.0, length);
    let mut sim = Simulation::new(setup).expect("a sound setup");
    while sim.time() < 5.0 {
        sim.step().expect("a sound run");
    }
    let drag: f64 = sim.system().solids().iter().map(|s| s.load.force[0]).sum();
    let driven = 1000.0 * height * length * g;
    // The flow approaches its steady state with the time H²/(π² ν); after five of them seven thousandths remain.
    assert!((drag / driven - 1.0).abs() < 0.02, "{drag} N/m of {driven} N/m");
}

#[test]
fn invalid_periodic_sides_are_refused() {
    let setup = |from: f64, to: f64, solids| {
        let water = common::lattice([0.0, 0.0], [1.0, 1.0], DP);
        Simulation::new(Setup::new(model()).water(water, 0.0).solids(solids).periodic(0, from, to))
            .err()
            .map(|e| e.to_string())
            .unwrap_or_default()
    };
    assert_eq!(setup(0.0, 1.0, vec![]), "");
    assert!(setup(0.0, 0.3, vec![]).contains("so short"));
    assert!(setup(0.0, 1.02, vec![]).contains("not a whole number of dp"));
    let box_ = Shape::Box { size: Vector::from([1.0, 0.2]) };
    let ends = common::solid("bed", box_.clone(), Pose::at(Vector::from([0.5, -0.1])), Role::Fixed);
    assert!(setup(0.0, 1.0, vec![ends]).contains("\"bed\" ends at a periodic side"));
}

/// Water of two metres square, periodic along both axes, with pressure and without gravity, that swirls and drifts with
/// `drift` (m/s); and in it a free body.
fn swirl_with_body(density: f64, pair_loop: PairLoopKind, drift: [f64; 2]) -> Simulation<2> {
    let mut model = model().pair_loop(pair_loop).shifting(Shifting::None);
    model.viscosity = Viscosity::Laminar(Laminar { nu0: 0.01 });
    let shape = Shape::Box { size: Vector::from([0.4, 0.2]) };
    let mut body = FreeBody::from_density(&shape, density);
    body.velocity = drift.into();
    let solid = SolidSpec::with_body("body", shape, body).at([0.7, 1.1]);
    let swirl = |r: &Vector<2>| Vector::from([-(0.5 * TAU * r[1]).sin(), (0.5 * TAU * r[0]).sin()]) * 0.3;
    let setup = Setup::new(model).solid(solid).fill_box([0.0, 0.0], [2.0, 2.0]).expect("room for water");
    let setup = setup.velocity(|r| swirl(r) + Vector::from(drift)).pressure(|_| 3000.0);
    Simulation::new(setup.periodic(0, 0.0, 2.0).periodic(1, 0.0, 2.0)).expect("a sound setup")
}

/// Momentum of the water and of a free body with what it has yet to get, kg m/s.
fn momentum_with_body(sim: &Simulation<2>) -> Vector<2> {
    let body = &sim.system().solids()[0];
    let mass = body.body.expect("a free body").mass;
    common::water_momentum(sim) + body.kinematics.velocity * mass + sim.pending_impulse(0)
}

#[test]
fn a_free_body_that_drifts_across_both_sides_moves_as_one_that_stays() {
    // The lighter bodies have acoustic added mass, which reads lists that are rebuilt at other times in a current: of 800 kg/m³ 0.9 mm of
    // a way of 5.4 m are left, a fiftieth of dp; the lightest turns by another angle, and only its momentum is held.
    for (density, bound) in [(3000.0, 1e-6), (800.0, 0.05 * DP), (60.0, f64::INFINITY)] {
        let run = |drift: [f64; 2]| {
            let mut sim = swirl_with_body(density, PairLoopKind::Reference, drift);
            let start = momentum_with_body(&sim);
            common::run_to(&mut sim, 1.5).expect("a sound run");
            let drifted = (momentum_with_body(&sim) - start).norm();
            // Loads on the body and on the water are sums of the same forces: round-off of 3000 Pa on 1.2 m over 1.5 s.
            assert!(drifted < 1e-9 * 3000.0 * 1.2 * 1.5, "{density} kg/m³, {drift:?}: {drifted} kg m/s");
            sim.system().solids()[0].kinematics
        };
        let (still, moving) = (run([0.0, 0.0]), run([2.0, 3.0]));
        // It has crossed two sides along x and three along y, and its position goes on beyond them.
        let way = moving.pose.position - still.pose.position;
        let off = (way - Vector::from([3.0, 4.5])).norm();
        let slip = (moving.velocity - still.velocity - Vector::from([2.0, 3.0])).norm();
        let moved = (still.pose.position - Vector::from([0.7, 1.1])).norm();
        assert!(moved > 0.05, "the water moves it: {moved} m");
        // Of the heaviest, steps and sums differ by round-off, which the flow amplifies.
        assert!(off < bound && slip < 10.0 * bound, "{density} kg/m³: {off} m, {slip} m/s");
    }
}

/// A channel of 1.2 m with a bed and a box that starts 0.02 m above its draft; water and box go with `speed` (m/s).
fn channel(speed: f64, density: f64) -> String {
    format!(
        r#"
dimension = 2
dp = 0.02
until = 2.2
periodic = {{ x = [0.0, 1.2] }}
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [1.2, 0.3] }} }}
velocity = ["{speed}", "0"]
[[solid]]
name = "bed"
fixed = true
shape = {{ box = {{ size = [2.4, 0.12] }} }}
at = {{ x = 0.6, y = -0.06 }}
[[solid]]
name = "box"
shape = {{ box = {{ size = [0.2, 0.1] }} }}
at = {{ x = 0.6, draft = 0.03 }}
free = {{ density = {density}, velocity = [{speed}, 0.0] }}
[[contact]]
between = ["box"]
touch = false
"#
    )
}

#[test]
fn a_box_heaves_in_a_current_through_the_sides_as_in_still_water() {
    let heave = |speed: f64| {
        let mut sim = common::scene_simulation::<2>(&channel(speed, 500.0)).expect("a sound scene");
        let mut heights = Vec::new();
        for i in 1..=44 {
            common::run_to(&mut sim, 0.05 * f64::from(i)).expect("a sound run");
            heights.push(sim.system().solids()[1].kinematics.centre[1] - 0.3);
        }
        let way = sim.system().solids()[1].kinematics.centre[0] - 0.6;
        (heights, way)
    };
    let ((still, rest), (moving, way)) = (heave(0.0), heave(1.0));
    assert!(rest.abs() < 0.02, "{rest} m");
    assert!((way - 2.2).abs() < 0.05, "it crosses the side at 0.6 and 1.8 m: {way} m");
    let off = still.iter().zip(&moving).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // The bed is not smooth for water that slides along it.
    assert!(off < 0.002, "{off} m, a tenth of the first displacement");
}

#[test]
fn a_run_with_a_body_across_a_side_has_the_same_bits_after_a_restart_and_on_any_number_of_threads() {
    // A light one with acoustic added mass, on a line to the ground.
    let text = channel(1.0, 80.0)
        + "[[spring]]\nname = \"line\"\nbetween = [\"box\"]\nfrom = [0.6, 0.3]\nto = [0.2, 0.0]\nstiffness = 1.0\n";
    let make = || {
        let mut sim = common::scene_simulation::<2>(&text).expect("a sound scene");
        sim.enable_load_breakdown();
        sim
    };
    let on = |threads: usize| {
        common::on_threads(threads, || {
            let mut sim = make();
            common::run_to(&mut sim, 0.6).expect("a sound run");
            let saved = sim.save().expect("a state");
            let across = sim.system().solids()[1].kinematics.centre[0];
            common::run_to(&mut sim, 0.9).expect("a sound run");
            (saved, across, sim.save().expect("a state"))
        })
    };
    let (saved, across, whole) = on(1);
    assert!((across - 1.2).abs() < 0.08, "its middle is at {across} m, the side at 1.2 m");
    assert!(on(3) == (saved.clone(), across, whole.clone()));
    let mut resumed = make();
    resumed.restore(&saved).expect("a state of this setup");
    common::run_to(&mut resumed, 0.9).expect("a sound run");
    assert!(resumed.save().expect("a state") == whole);
}

#[test]
fn free_bodies_that_periodic_sides_do_not_allow_are_refused_with_the_remedy() {
    let refused = |from: &str, to: &str| {
        let text = channel(0.0, 500.0).replace(from, to);
        common::scene_simulation::<2>(&text).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert_eq!(refused("", ""), "");
    // A turned disc ends where the disc does: at 1.18 m.
    let disc = |x: f64| {
        let text = channel(0.0, 500.0).replace("box = { size = [0.2, 0.1] }", "ball = { radius = 0.1 }");
        let text = text.replace("x = 0.6, draft = 0.03", &format!("x = {x}, draft = 0.1, angle_deg = 45"));
        common::scene_simulation::<2>(&text).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert_eq!(disc(1.08), "");
    assert!(disc(1.12).contains("starts across a periodic side"));
    let message = refused("at = { x = 0.6, draft", "at = { x = 1.15, draft");
    assert!(message.contains("starts across a periodic side") && message.contains("move it by -0.05"), "{message}");
    let message = refused("size = [0.2, 0.1]", "size = [1.0, 0.1]");
    assert!(message.contains("the period less twice"), "{message}");
    let message = refused("touch = false", "friction = 0.1");
    assert!(message.contains("may touch \"bed\"") && message.contains("[[contact]]"), "{message}");
}

/// Water of two metres square, periodic along both axes, without gravity, that swirls and goes with `drift` (m/s); and in it a driven
/// box of `size` (m) that goes with it, heaves and turns.
fn swirl_with_driven(drift: [f64; 2], size: [f64; 2]) -> Result<Simulation<2>> {
    let formula = |text: String| TimeFunction::from(Formula::parse(&text).expect("a formula"));
    let slide = |along: [f64; 2], law: String| PrescribedMotion::slide(along.into(), formula(law));
    let motion = PrescribedMotion::chain([
        slide([1.0, 0.0], format!("{}*t", drift[0])),
        slide([0.0, 1.0], format!("{}*t + 0.1*(1 - cos(6*t))", drift[1])),
    ]);
    let shape = Shape::Box { size: size.into() };
    let solid = SolidSpec::driven("body", shape, motion).at([0.7, 1.1]);
    let swirl = |r: &Vector<2>| Vector::from([-(0.5 * TAU * r[1]).sin(), (0.5 * TAU * r[0]).sin()]) * 0.3;
    let model = model().pair_loop(PairLoopKind::Reference).shifting(Shifting::None);
    let setup = Setup::new(model).solid(solid).fill_box([0.0, 0.0], [2.0, 2.0])?;
    let setup = setup.velocity(|r| swirl(r) + Vector::from(drift)).pressure(|_| 3000.0);
    Simulation::new(setup.periodic(0, 0.0, 2.0).periodic(1, 0.0, 2.0))
}

#[test]
fn a_driven_body_that_drifts_across_both_sides_gets_the_loads_of_one_that_stays() {
    let run = |drift: [f64; 2]| {
        let mut sim = swirl_with_driven(drift, [0.4, 0.2]).expect("a sound setup");
        let (start, mut impulse, mut loads) = (common::water_momentum(&sim), Vector::<2>::zeros(), Vec::new());
        for i in 1..=30 {
            let until = 0.05 * f64::from(i);
            while sim.time() < until {
                let before = sim.time();
                sim.step().expect("a sound run");
                impulse += sim.system().solids()[0].load.force * (sim.time() - before);
            }
            loads.push(sim.system().solids()[0].load.force);
        }
        (loads, common::water_momentum(&sim) - start, impulse)
    };
    let ((still, gained, given), (moving, gained_moving, _)) = (run([0.0, 0.0]), run([2.0, 3.0]));
    let largest = still.iter().map(|f| f.norm()).fold(0.0, f64::max);
    // The water gets what the body gives, but for the first order of the sum over steps.
    assert!((gained + given).norm() < 0.02 * given.norm().max(1.0), "{gained} and {given} kg m/s");
    assert!(largest > 100.0, "it pushes the water: {largest} N/m");
    // Water that a body displaces sidewise meets other steps and lists: a hundredth of the largest load.
    let off = still.iter().zip(&moving).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(off < 0.01 * largest, "{off} of {largest} N/m");
    assert!((gained - gained_moving).norm() < 0.01 * gained.norm().max(1.0), "{gained} and {gained_moving} kg m/s");
}

#[test]
fn driven_bodies_that_would_end_at_a_side_are_refused_with_the_remedy() {
    let long = swirl_with_driven([0.0, 0.0], [1.2, 0.2]).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(long.contains("ends at a periodic side along x") && long.contains("passes through them"), "{long}");
    let scene = |length: f64, speed: f64| {
        let text = channel(0.0, 500.0);
        let text = text.split("[[solid]]\nname = \"box\"").next().expect("water and bed");
        let lid = format!(
            "[[solid]]\nname = \"lid\"\nshape = {{ box = {{ size = [{length}, 0.12] }} }}\nat = {{ x = 0.6, y = 0.38 }}\n\
             driven = {{ along = [1.0, 0.0], distance = {{ formula = \"{speed}*t\" }} }}\n"
        );
        common::scene_simulation::<2>(&format!("{text}{lid}")).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert_eq!(scene(5.0, 0.5), "");
    // Its end comes to the first side at 1.9 − 0.15 m.
    let message = scene(5.0, 1.0);
    assert!(
        message.contains("ends at a periodic side along x at t = 1.7") && message.contains("beyond both sides"),
        "{message}"
    );
    assert_eq!(scene(0.5, 1.0), "", "a short one passes through the sides");
}

#[test]
fn a_long_driven_solid_stops_the_run_where_its_end_comes_to_a_side() {
    let law = TimeFunction::from(Formula::parse("20*t").expect("a formula"));
    let shape = Shape::Box { size: [4.0, 0.2].into() };
    let lid = SolidSpec::driven("lid", shape, PrescribedMotion::slide([1.0, 0.0].into(), law)).at([0.5, 1.1]);
    let water = common::lattice([0.0, 0.0], [1.0, 1.0], DP);
    let setup = Setup::new(model()).water(water, 0.0).solid(lid).periodic(0, 0.0, 1.0).periodic(1, 0.0, 2.0);
    let mut sim = Simulation::new(setup).expect("a sound setup");
    let stopped = common::run_to(&mut sim, 0.1).expect_err("its end passes the side");
    assert!(stopped.to_string().contains("an end at a periodic side along x"), "{stopped}");
    assert!(sim.time() > 0.04, "the end reaches 1.5 m less what water sees, {} s", sim.time());
}

/// A wall drags water round a periodic channel. Lists that are rebuilt within a step leave water beyond the sides, and the moving
/// wall and the water may move so that all are. The water still stays at the sides, within the reach of walls and images.
#[test]
fn water_that_a_wall_drags_along_comes_in_again_at_the_other_side() {
    let wall = |name: &str, z: f64, role: &str| {
        format!(
            "[[solid]]\nname = \"{name}\"\nshape = {{ box = {{ size = [1.6, 0.65, 0.1] }} }}\nat = [0.25, 0.125, {z}]\n{role}\n"
        )
    };
    let lid = "driven = { along = [1.0, 0.0, 0.0], distance = { formula = \"0.42*t\" } }";
    let mut sim = common::scene_simulation::<3>(&format!(
        "dimension = 3\ndp = 0.025\nuntil = 0.5\ngravity = 0.0\nperiodic = {{ x = [0.0, 0.5], y = [0.0, 0.25] }}\n\
         model = {{ c0 = 4.0, viscosity = {{ laminar = {{ nu0 = 0.01 }} }}, slip = \"none\" }}\n\
         water = [{{ fill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.5, 0.25, 0.15] }} }} }}]\n{}{}",
        wall("bed", -0.05, "fixed = true"),
        wall("lid", 0.2, lid)
    ))
    .expect("a sound scene");
    // The support of the kernel, and a step of the wall.
    let far = 0.075 + 0.42 * 0.005;
    while sim.time() < 0.4 {
        sim.step().expect("a sound run");
        let beyond = sim.system().fluid().r.iter().map(|r| (r[0] - 0.5).max(-r[0])).fold(0.0, f64::max);
        assert!(beyond < far, "{beyond} m beyond a side after {} s", sim.time());
    }
}
