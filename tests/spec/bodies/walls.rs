//! Walls of tanks and polylines with water on both faces: drafts, levels and forces, compared with hydrostatics.

use pontoon::simulation::Simulation;

use crate::common::{run_to, scene_simulation, time_mean};

const RHO0: f64 = 1000.0;
const G: f64 = 9.81;

/// An open barge, 0.6 m wide and 0.3 m high outside with walls 0.1 m thick, of 120 kg/m: its draft is 0.2 m. It floats
/// in a basin 1.2 m long with a still level of 0.4 m. `aside` (dp) moves it off the lattice.
fn barge(shape: &str, dp: f64, aside: f64) -> Simulation<2> {
    let x = 0.4 + aside * dp;
    let water = [[0.0, 0.4, 0.4], [0.4, 0.8, 0.2], [0.8, 1.2, 0.4]]
        .map(|[a, b, top]| format!("[[water]]\nfill = {{ box = {{ min = [{a}, 0.0], max = [{b}, {top}] }} }}\n"))
        .concat();
    let text = format!(
        "dimension = 2\ndp = {dp}\nuntil = 2.0\n{water}\
         [[solid]]\nname = \"basin\"\nfixed = true\nshape = {{ tank = {{ size = [1.2, 0.6] }} }}\n\
         [[solid]]\nname = \"barge\"\nfree = {{ mass = 120.0 }}\nshape = {shape}\nat = {{ x = {x}, y = 0.3 }}\n"
    );
    scene_simulation(&text).expect("a sound scene")
}

/// Mean excess draft (dp) of the barge over that of Archimedes, over the second of two heave periods.
fn draft_error(mut sim: Simulation<2>, dp: f64) -> f64 {
    let water = sim.system().fluid().len() as f64 * dp * dp;
    let draft = 120.0 / RHO0 / 0.6;
    let level = (water + draft * 0.6) / 1.2;
    let [bottom] = time_mean(&mut sim, 0.9, 1.8, |sim| [sim.system().solids()[1].kinematics.pose.position[1] - 0.1])
        .expect("a sound run");
    (level - draft - bottom) / dp
}

const TANK: &str = "{ tank = { size = [0.4, 0.2], thickness = 0.1 } }";
const INNER_LINE: &str =
    "{ polyline = { points = [[0.0, 0.2], [0.0, 0.0], [0.4, 0.0], [0.4, 0.2]], thickness = 0.1 } }";
const OUTER_LINE: &str =
    "{ polyline = { points = [[0.5, 0.2], [0.5, -0.1], [-0.1, -0.1], [-0.1, 0.2]], thickness = 0.1 } }";

#[test]
fn a_barge_of_thick_walls_floats_at_the_draft_of_archimedes() {
    // Walls of 4, 5 and 8 dp; the kernel reaches 3.4 dp.
    for dp in [0.025, 0.02, 0.0125] {
        let error = draft_error(barge(TANK, dp, 0.0), dp);
        assert!(error.abs() < 0.1, "dp {dp}: {error} dp; the bound of the project on the lattice");
    }
    for shape in [INNER_LINE, OUTER_LINE] {
        let error = draft_error(barge(shape, 0.02, 0.0), 0.02);
        assert!(error.abs() < 0.1, "{shape}: {error} dp");
    }
}

#[test]
fn a_barge_of_thick_walls_off_the_lattice_floats_at_the_draft_of_archimedes() {
    for shape in [TANK, OUTER_LINE] {
        let error = draft_error(barge(shape, 0.02, 0.3), 0.02);
        assert!(error.abs() < 0.5, "{shape}: {error} dp; the bound of the project for any position");
    }
}

/// A basin 1.2 m long with the fixed solid `shape` at (0.6, 0.1), and water 0.4 m and 0.2 m deep on its sides, `reach`
/// (m) from its middle.
fn parted(shape: &str, reach: f64, dp: f64) -> Simulation<2> {
    let (a, b) = (0.6 - reach, 0.6 + reach);
    let text = format!(
        "dimension = 2\ndp = {dp}\nuntil = 5.0\n\
         [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [{a}, 0.4] }} }}\n\
         [[water]]\nfill = {{ box = {{ min = [{b}, 0.0], max = [1.2, 0.2] }} }}\n\
         [[solid]]\nname = \"basin\"\nfixed = true\nshape = {{ tank = {{ size = [1.2, 0.6] }} }}\n\
         [[solid]]\nname = \"wall\"\nfixed = true\nshape = {shape}\nat = {{ x = 0.6, y = 0.1 }}\n"
    );
    scene_simulation(&text).expect("a sound scene")
}

/// Depth of the water (m) on the left and on the right of x = 0.6 m: twice the mean height of its particles.
fn depths(sim: &Simulation<2>) -> [f64; 2] {
    let mean = |side: fn(f64) -> bool| {
        let heights: Vec<f64> = sim.system().fluid().r.iter().filter(|x| side(x[0])).map(|x| x[1]).collect();
        2.0 * heights.iter().sum::<f64>() / heights.len() as f64
    };
    [mean(|x| x < 0.6), mean(|x| x > 0.6)]
}

/// A vertical wall, 0.2 m thick.
const BAFFLE: &str = "{ polyline = { points = [[-0.1, -0.1], [-0.1, 0.5]], thickness = 0.2 } }";

#[test]
fn a_dry_caisson_and_a_thick_baffle_keep_the_level_of_the_sea() {
    // A hold of 0.2 m with walls of five dp, and a wall of ten dp.
    let caisson = "{ compound = [{ shape = { tank = { size = [0.2, 0.4], thickness = 0.1 } }, at = { x = -0.1 } }] }";
    for (shape, reach) in [(caisson, 0.2), (BAFFLE, 0.1)] {
        let mut sim = parted(shape, reach, 0.02);
        let start = depths(&sim);
        let late = time_mean(&mut sim, 4.0, 5.0, depths).expect("a sound run");
        for (start, late) in start.iter().zip(late) {
            assert!((late - start).abs() < 0.002, "{shape}: {start} to {late} m; the bound is a tenth of dp");
        }
    }
}

#[test]
fn a_thick_baffle_feels_the_water_on_both_faces() {
    let mut sim = parted(BAFFLE, 0.1, 0.0125);
    let [force] = time_mean(&mut sim, 0.5, 1.5, |sim| [sim.system().solids()[1].load.force[0]]).expect("a sound run");
    let exact = 0.5 * RHO0 * G * (0.4 * 0.4 - 0.2 * 0.2);
    // The bound of the project. The force of a box is short by the same 1.3 %, which falls with dp.
    assert!((force / exact - 1.0).abs() < 0.02, "{force} for {exact} N/m");
}

#[test]
fn a_closed_wall_keeps_water_inside_and_outside() {
    // A drum of 0.4 m with a wall of six dp, with water inside up to its middle, in water up to its middle. Both
    // orientations of the line, with the first point repeated and with `closed`.
    let circle = |radius: f64, turns: f64| {
        let point = |i: usize| {
            let (sin, cos) = (turns * std::f64::consts::TAU * i as f64 / 48.0).sin_cos();
            format!("[{}, {}]", radius * cos, radius * sin)
        };
        (0..48).map(point).collect::<Vec<_>>()
    };
    let mut repeated = circle(0.2, 1.0);
    repeated.push(repeated[0].clone());
    let rings = [
        format!("{{ points = [{}], thickness = 0.12 }}", repeated.join(", ")),
        format!("{{ points = [{}], thickness = 0.12, closed = true }}", circle(0.32, -1.0).join(", ")),
    ];
    for ring in rings {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 3.0\n\
             [[water]]\nfill = {{ box = {{ min = [0.0, 0.0], max = [1.2, 0.4] }} }}\n\
             [[solid]]\nname = \"basin\"\nfixed = true\nshape = {{ tank = {{ size = [1.2, 0.6] }} }}\n\
             [[solid]]\nname = \"drum\"\nfixed = true\nshape = {{ polyline = {ring} }}\nat = {{ x = 0.6, y = 0.4 }}\ndry = false\n"
        );
        let mut sim: Simulation<2> = scene_simulation(&text).expect("a sound scene");
        let inside = |sim: &Simulation<2>| {
            let r = sim.system().fluid().r;
            r.iter().filter(|x| (x[0] - 0.6).hypot(x[1] - 0.4) < 0.26).count()
        };
        let start = inside(&sim);
        // The lower half of a disc of radius 0.2 m, to half a row along its rim.
        assert!((start as f64 * 4e-4 - 0.5 * std::f64::consts::PI * 0.04).abs() < 0.006, "{start} particles inside");
        run_to(&mut sim, 3.0).expect("a sound run");
        assert_eq!(inside(&sim), start, "no particle passes the wall");
        let shape = &sim.system().solids()[1].spec.shape;
        let deepest = sim.system().fluid().r.iter().map(|x| {
            let pose = &sim.system().solids()[1].kinematics.pose;
            -shape.signed_distance(&pose.local(x)) / 0.02
        });
        assert!(deepest.fold(0.0, f64::max) < 0.5, "no particle is half a dp within the wall");
        let exact = RHO0 * G * 0.5 * std::f64::consts::PI * (0.32 * 0.32 - 0.2 * 0.2);
        let [lift] = mean_lift(&mut sim);
        assert!((lift / exact - 1.0).abs() < 0.02, "{lift} for {exact} N/m: buoyancy less the water inside");
    }
}

/// Mean vertical force (N/m) on the second solid over the next second.
fn mean_lift(sim: &mut Simulation<2>) -> [f64; 1] {
    let now = sim.time();
    time_mean(sim, now, now + 1.0, |sim| [sim.system().solids()[1].load.force[1]]).expect("a sound run")
}
