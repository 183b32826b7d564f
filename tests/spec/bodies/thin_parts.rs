//! Thin parts. One layer of boundary particles stands for those thinner than dp, which have the buoyancy of their volume. In 3-D the
//! faces of parts thinner than 2.5 dp keep water out where the layers have gaps.

use std::fs;

use pontoon::{
    Result,
    math::Vector,
    scene::Scene,
    simulation::{Dimension, Simulation},
    solid::Dim,
};

use crate::common::{TestFolder, measurement, run_to, scene_simulation, time_mean, water_momentum};

const G: f64 = 9.81;

fn mean_force<const D: usize>(text: &str, from: f64, until: f64) -> Result<Vector<D>>
where
    Dim<D>: Dimension<D>,
{
    let mut sim: Simulation<D> = scene_simulation(text)?;
    Ok(time_mean(&mut sim, from, until, |sim| sim.system().solids()[1].load.force.into())?.into())
}

/// A plate of `size` (m) held at `at` in water 0.4 m deep, dp = 20 mm.
fn held(size: [f64; 2], at: [f64; 2]) -> String {
    format!(
        r#"dimension = 2
dp = 0.02
until = 1.5
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [0.8, 0.4] }} }}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.8, 0.6] }} }}
[[solid]]
name = "plate"
shape = {{ box = {{ size = [{}, {}] }} }}
at = {{ x = {}, y = {} }}
free = {{ density = 1000, locked = ["x", "y", "turn"] }}
"#,
        size[0], size[1], at[0], at[1]
    )
}

/// Bound: 0.15 dp of its area, as for the thickness of the layer of water that a face keeps off. A layer dp thick would have five
/// times the volume of these plates: 63 and 16 N/m more.
#[test]
fn plates_of_a_fifth_of_dp_have_the_buoyancy_of_their_volume() -> Result<()> {
    for (size, at, wet) in
        [([0.4, 0.004], [0.4, 0.21], 0.4), ([0.004, 0.2], [0.41, 0.4], 0.1), ([0.004, 0.2], [0.403, 0.2], 0.2)]
    {
        let (exact, bound) = (1000.0 * G * wet * 0.004, 1000.0 * G * wet * 0.15 * 0.02);
        let force = mean_force::<2>(&held(size, at), 0.7, 1.5)?;
        println!("{size:?} at {at:?}: {} N/m, Archimedes {exact}", force[1]);
        assert!((force[1] - exact).abs() < bound, "{size:?} at {at:?}: {} N/m, Archimedes {exact} N/m", force[1]);
    }
    Ok(())
}

/// What rows displace depends on their distance and on their number. Equal cells would give a plate of 1.5 dp 1.16 times its buoyancy, one
/// of 2.5 dp 1.08 times. Bound: a tenth; found: 1.09, 1.03, 0.98, 1.05.
#[test]
fn plates_of_no_whole_number_of_dp_have_the_buoyancy_of_their_volume() -> Result<()> {
    for thickness in [1.5, 1.75, 2.25, 2.5] {
        let exact = 1000.0 * G * 0.4 * thickness * 0.02;
        let force = mean_force::<2>(&held([0.4, thickness * 0.02], [0.403, 0.2]), 0.4, 1.0)?[1];
        println!("{thickness} dp: {force} N/m, Archimedes {exact}");
        assert!((force / exact - 1.0).abs() < 0.1, "{thickness} dp: {force} N/m, Archimedes {exact} N/m");
    }
    Ok(())
}

#[test]
fn a_thin_disc_has_the_buoyancy_of_its_volume_in_3d() -> Result<()> {
    let text = r#"dimension = 3
dp = 0.02
until = 0.8
[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [0.36, 0.36, 0.2] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.36, 0.36, 0.4] } }
[[solid]]
name = "plate"
shape = { cylinder = { length = 0.004, radius = 0.1 } }
at = { x = 0.18, y = 0.18, z = 0.11 }
free = { mass = 1.0, locked = ["x", "y", "z", "turn_x", "turn_y", "turn_z"] }
"#;
    let area = std::f64::consts::PI * 0.01;
    let (exact, bound) = (1000.0 * G * area * 0.004, 1000.0 * G * area * 0.15 * 0.02);
    let force = mean_force::<3>(text, 0.3, 0.8)?;
    println!("disc: {} N, Archimedes {exact}", force[2]);
    assert!((force[2] - exact).abs() < bound, "{} N, Archimedes {exact} N", force[2]);
    Ok(())
}

/// A hull with a keel of 0.4 dp 0.2 m deep rests where Archimedes says within the half dp of bodies off the lattice. A keel dp thick
/// would lift it by 4 mm.
#[test]
fn a_hull_with_a_thin_keel_rests_at_its_draft() -> Result<()> {
    let text = r#"dimension = 2
dp = 0.01
until = 3.0
[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.8, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.6] } }
[[solid]]
name = "hull"
shape = { polygon = [[-0.15, 0.0], [-0.002, 0.0], [-0.002, -0.2], [0.002, -0.2], [0.002, 0.0], [0.15, 0.0], [0.15, 0.1], [-0.15, 0.1]] }
at = { x = 0.4, draft = "equilibrium" }
free = { density = 500.0, locked = ["x", "turn"] }
"#;
    let mut sim: Simulation<2> = scene_simulation(text)?;
    let start = sim.system().solids()[1].kinematics.centre[1];
    let rest = time_mean(&mut sim, 1.5, 3.0, |sim| [sim.system().solids()[1].kinematics.centre[1], 0.0])?[0];
    println!("keel: {} mm", (rest - start) * 1e3);
    assert!((rest - start).abs() < 0.5 * 0.01, "it moves by {} m", rest - start);
    Ok(())
}

/// A plate 0.6 m high and `thickness` (m) thick on the bed of a tank, with water `depths` (m) deep on its left and right, dp = 20 mm.
fn standing(role: &str, thickness: f64, depths: [f64; 2]) -> String {
    let sides = [[0.0, 0.41, depths[0]], [0.41, 0.82, depths[1]]];
    let water = sides.iter().filter(|side| side[2] > 0.0).map(|[from, to, depth]| {
        format!("[[water]]\nfill = {{ box = {{ min = [{from}, 0.0], max = [{to}, {depth}] }} }}\n")
    });
    format!(
        r#"dimension = 2
dp = 0.02
until = 1.5
{}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.82, 0.7] }} }}
[[solid]]
name = "plate"
shape = {{ box = {{ size = [{thickness}, 0.6] }} }}
at = {{ x = 0.41, y = 0.3 }}
{role}
"#,
        water.collect::<String>()
    )
}

/// Its faces are upright and nothing is below its foot: no vertical force. Bound: 3 % of what presses on its faces, because rows of
/// water at rest hold to the rows of boundary particles beside them. The buoyancy of its layer, with nothing below the foot, would be
/// 38 to 49 N/m with water on one side, 55 to 71 N/m on both. Along x ½ ρ g (d₁² − d₂²) holds within half a dp of each depth.
#[test]
fn a_thin_plate_on_the_bed_has_no_vertical_force() -> Result<()> {
    let fixed = "fixed = true";
    let driven = r#"driven = { along = [1.0, 0.0], distance = { formula = "1e-6*(1-cos(t))" } }"#;
    for (role, thickness, depths) in [
        (fixed, 0.002, [0.4, 0.0]),
        (fixed, 0.006, [0.4, 0.0]),
        (fixed, 0.006, [0.4, 0.2]),
        (fixed, 0.006, [0.4, 0.4]),
        (driven, 0.006, [0.4, 0.0]),
    ] {
        let [left, right] = depths;
        let force = mean_force::<2>(&standing(role, thickness, depths), 0.7, 1.5)?;
        let (exact, bound) =
            (0.5 * 1000.0 * G * (left * left - right * right), 1000.0 * G * 0.5 * 0.02 * (left + right));
        let friction = 0.03 * 0.5 * 1000.0 * G * (left * left + right * right);
        println!("{thickness} m, {depths:?}: {} N/m of {exact}, upwards {}", force[0], force[1]);
        assert!((force[0] - exact).abs() < bound, "{thickness} m, {depths:?}: {} N/m, exact {exact} N/m", force[0]);
        assert!(force[1].abs() < friction, "{thickness} m, {depths:?}: {} N/m upwards", force[1]);
    }
    Ok(())
}

/// Asserts that the 0.5 m of water in a tank of 0.6 m keep out of its walls, and that walls of dp and more receive the momentum that the
/// water loses. Bounds: no particle is deeper than half a dp in a wall, or behind it; 10⁻⁶ of the weight over the time, because sums over
/// pairs are in single precision.
fn keeps_water_in(mut sim: Simulation<3>, thickness: f64) -> Result<()> {
    let dp = sim.system().model().dp;
    let (weight, start) = (1000.0 * G * 0.6 * 0.6 * 0.5, water_momentum(&sim)[2]);
    let mut impulse = 0.0;
    while sim.time() < 0.6 {
        let before = sim.time();
        sim.step()?;
        impulse -= (sim.system().solids()[0].load.force[2] + weight) * (sim.time() - before);
    }
    let water = sim.system().fluid().r;
    let depth = |r: &Vector<3>| [r[0], 0.6 - r[0], r[1], 0.6 - r[1], r[2]].into_iter().fold(f64::INFINITY, f64::min);
    let (count, least) = (water.len(), water.iter().map(depth).fold(f64::INFINITY, f64::min) / dp);
    let off = (water_momentum(&sim)[2] - start - impulse) / (weight * sim.time());
    println!("{thickness} m: {count} particles, the nearest {least} dp before a face; momentum {off}");
    assert!(count == 1440 && least > -0.5, "{thickness} m: {count} of 1440 particles, one {} dp in a wall", -least);
    assert!(thickness < dp || off.abs() < 1e-6, "{thickness} m: momentum off by {off}");
    Ok(())
}

/// By boundary particles alone 392 of 1440 particles leave a tank of 1.4 dp in a second, 96 one of 2.33 dp, and 130 one of 2.48 dp.
#[test]
fn thin_tanks_keep_water_in_in_3d() -> Result<()> {
    for thickness in ["0.005", "0.07", "0.1165", "0.124"] {
        let sim = measurement("thin-tank", &[("solid.tank.shape.tank.thickness", thickness)])?;
        keeps_water_in(sim, thickness.parse().unwrap())?;
    }
    Ok(())
}

/// By boundary particles alone 570 of 1440 particles leave a mesh of 0.4 dp in a second, 88 one of 1.4 dp, and 19 one of 2.4 dp.
#[test]
fn thin_meshes_keep_water_in_in_3d() -> Result<()> {
    for thickness in [0.02, 0.07, 0.12] {
        let home = TestFolder::new(&format!("thin-mesh-{thickness}"));
        // The corners of the hollow, and of the outer face: x and y around, below and above.
        let corners = |low: f64, high: f64, bottom: f64| {
            let around = [[low, low], [high, low], [high, high], [low, high]];
            [bottom, 0.6].map(|z| around.map(|[x, y]| format!("v {x} {y} {z}\n")).concat()).concat()
        };
        let side = |k: usize| {
            let (a, b) = (k + 1, (k + 1) % 4 + 1);
            let inner = format!("f {b} {a} {} {}\n", a + 4, b + 4);
            let outer = format!("f {} {} {} {}\n", a + 8, b + 8, b + 12, a + 12);
            format!("{inner}{outer}f {} {} {} {}\n", a + 4, a + 12, b + 12, b + 4)
        };
        let faces = (0..4).map(side).collect::<String>() + "f 1 2 3 4\nf 12 11 10 9\n";
        let text = corners(0.0, 0.6, 0.0) + &corners(-thickness, 0.6 + thickness, -thickness) + &faces;
        fs::write(home.join("tank.obj"), text).unwrap();
        let scene = r#"dimension = 3
dp = 0.05
until = 1.0
[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [0.6, 0.6, 0.5] } }
[[solid]]
name = "tank"
fixed = true
shape = { mesh = { file = "tank.obj" } }
"#;
        fs::write(home.join("scene.toml"), scene).unwrap();
        let sim = Simulation::new(Scene::read(&home.join("scene.toml"), &[])?.build::<3>()?.setup)?;
        keeps_water_in(sim, thickness)?;
    }
    Ok(())
}

/// A tank of 0.4 m by 0.16 m with water 0.3 m deep on the left of the `wall`, which ends at x = 0.2 m there; dp = 20 mm.
fn behind(wall: &str, model: &str) -> Result<Simulation<3>> {
    scene_simulation(&format!(
        r#"dimension = 3
dp = 0.02
until = 1.0
{model}
[[water]]
fill = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.199999999, 0.16, 0.3] }} }}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.4, 0.16, 0.5], thickness = 0.06 }} }}
[[solid]]
name = "wall"
fixed = true
{wall}
"#
    ))
}

/// A wall that stands on a tip of 25° a row below the floor. By boundary particles alone a third of the water passes the tip in a second.
#[test]
fn the_tip_of_a_wedge_keeps_water_out_in_3d() -> Result<()> {
    let wall = r#"shape = { prism = { points = [[0.2, -0.02], [0.4, 0.4], [0.2, 0.4]], length = 0.24, axis = "y" } }
at = { y = 0.08 }"#;
    let mut sim = behind(wall, "")?;
    run_to(&mut sim, 0.6)?;
    let farthest = sim.system().fluid().r.iter().map(|r| r[0]).fold(0.0, f64::max);
    println!("farthest {farthest} m");
    assert!(farthest < 0.2 + 0.5 * 0.02, "a particle is at x = {farthest} m, and the wall begins at 0.2 m");
    Ok(())
}

/// Water at rest beside a wall of 1 dp, with the largest steps that are allowed. A push that does not follow the step holds 0.36 J;
/// beside a wall of 3 dp the water has 0.018 J. Bound: twice that.
#[test]
fn faces_of_thin_parts_are_stable_at_the_largest_steps() -> Result<()> {
    let wall = "shape = { box = { size = [0.02, 0.28, 0.56] } }\nat = { x = 0.21, y = 0.08, z = 0.22 }";
    let mut sim = behind(wall, "model = { h_over_dp = 2.5 }\ntime = { cfl = 0.8 }")?;
    run_to(&mut sim, 0.6)?;
    let moving: f64 = sim.system().fluid().v.iter().map(|v| 0.5 * v.norm_squared()).sum();
    let energy = moving * sim.system().particle_mass();
    println!("{energy} J");
    assert!(energy < 2.0 * 0.018, "the water has {energy} J");
    Ok(())
}

/// A vessel on a spring carries the weight of its water, 78.5 N, whatever its walls. Bound: 2 %, as for forces on walls. With the excess
/// buoyancy of its layers subtracted as under a sea, it carried 94 N with walls of 0.5 dp and 110 N with 0.1 dp.
#[test]
fn a_thin_vessel_carries_the_weight_of_its_water() -> Result<()> {
    for thickness in ["0.01", "0.002"] {
        let mut sim: Simulation<3> = measurement("thin-vessel", &[("solid.vessel.shape.tank.thickness", thickness)])?;
        let [force] = time_mean(&mut sim, 0.3, 0.6, |sim| [sim.system().solids()[0].load.force[2]])?;
        println!("{thickness} m: {force} N");
        assert!((force / (-1000.0 * G * 0.008) - 1.0).abs() < 0.02, "{thickness} m: {force} N for 78.5 N of water");
    }
    Ok(())
}

/// A free plate of 0.2 dp moves alike at the usual steps and at steps of a quarter, to 0.05 dp in 0.6 s. A neutral one stays within 0.2 dp,
/// a lighter one rises. Without springs on its faces it had no acoustic added mass and leapt by 4 dp in a second at the usual steps.
#[test]
fn light_thin_plates_move_alike_at_all_steps() -> Result<()> {
    for density in ["1000.0", "300.0"] {
        let height = |cfl: &str| -> Result<f64> {
            let mut sim: Simulation<3> =
                measurement("thin-plate", &[("solid.plate.free.density", density), ("time.cfl", cfl)])?;
            run_to(&mut sim, 0.6)?;
            Ok(sim.system().solids()[1].kinematics.centre[2])
        };
        let [usual, short] = [height("0.4")?, height("0.1")?];
        println!("{density} kg/m³: z = {usual} and {short} m");
        assert!((usual - short).abs() < 0.05 * 0.02, "{density} kg/m³: z = {usual} m, with short steps {short} m");
        let rises = usual - 0.1;
        assert!(
            if density == "1000.0" { rises.abs() < 0.2 * 0.02 } else { rises > 0.02 },
            "{density} kg/m³: {rises} m"
        );
    }
    Ok(())
}

/// Buoyancy of a held plate thinner than dp in 3-D, on and off the lattice. Bound: 0.1 dp of its area.
#[test]
fn thin_plates_have_the_buoyancy_of_their_volume_in_3d() -> Result<()> {
    for (thickness, z) in [("0.002", "0.1"), ("0.01", "0.1"), ("0.002", "0.105"), ("0.01", "0.105")] {
        let size = format!("[0.2, 0.2, {thickness}]");
        let locked = r#"["x", "y", "z", "turn_x", "turn_y", "turn_z"]"#;
        let sets = [
            ("solid.plate.shape.box.size", size.as_str()),
            ("solid.plate.at.z", z),
            ("solid.plate.free.locked", locked),
        ];
        let mut sim: Simulation<3> = measurement("thin-plate", &sets)?;
        let [force] = time_mean(&mut sim, 0.4, 0.8, |sim| [sim.system().solids()[1].load.force[2]])?;
        let weight = 1000.0 * G * 0.04;
        let off = (force / weight - thickness.parse::<f64>().unwrap()) / 0.02;
        println!("{thickness} m at {z} m: {force} N, off by {off} dp");
        assert!(off.abs() < 0.1, "{thickness} m at {z} m: {force} N, off by {off} dp of its area");
    }
    Ok(())
}

/// Water gets under a thin plate that is held on the bed, whose buoyancy is then that of its volume. Bound: 0.6 dp of its area, 6 % of the
/// water above it. Where the film between plate and bed had no rim, the water pressed the plate down with 7.7 dp; where it had one but the
/// water above acted on the bed through the plate, it lifted the plate with 2.3 dp.
#[test]
fn water_gets_under_a_thin_plate_on_the_bed() -> Result<()> {
    for thickness in [0.002, 0.006, 0.012, 0.02] {
        let (size, z) = (format!("[0.2, 0.2, {thickness}]"), format!("{}", 0.5 * thickness + 1e-4));
        let sets = [
            ("solid.plate.shape.box.size", size.as_str()),
            ("solid.plate.at.z", z.as_str()),
            ("solid.plate.free.locked", r#"["x", "y", "z", "turn_x", "turn_y", "turn_z"]"#),
        ];
        let mut sim: Simulation<3> = measurement("thin-plate", &sets)?;
        let [force] = time_mean(&mut sim, 0.3, 0.6, |sim| [sim.system().solids()[1].load.force[2]])?;
        let off = (force / (1000.0 * G * 0.04) - thickness) / 0.02;
        println!("{thickness} m: {force} N, off by {off} dp");
        assert!(off.abs() < 0.6, "{thickness} m: {force} N, off by {off} dp of its area");
    }
    Ok(())
}

/// A driven plate of 0.4 dp that ends at the walls and the floor of a tank lets no water pass its edges: by its own push alone 42 of 1,600
/// particles passed.
#[test]
fn a_thin_paddle_that_ends_at_thick_walls_lets_no_water_pass() -> Result<()> {
    let mut sim: Simulation<3> = measurement("thin-paddle", &[])?;
    let count = sim.system().fluid().r.len();
    run_to(&mut sim, 0.6)?;
    let front = sim.system().solids()[1].kinematics.centre[0];
    let (water, dp) = (sim.system().fluid().r, 0.02);
    let behind = water.iter().filter(|r| r[0] < front - dp).count();
    println!("{behind} of {} behind x = {front} m", water.len());
    assert!(behind == 0 && water.len() == count, "{behind} of {} particles are behind the plate", water.len());
    Ok(())
}

/// Added mass over ρ π a² and drag coefficient, by Fourier averages over the first period, of a heave plate 0.1 dp thick and 20 dp across,
/// driven from rest with the amplitude `kc` 0.4 m/2π.
fn heave_plate(kc: f64, gravity: &str) -> Result<[f64; 2]> {
    let (half, omega) = (0.2, std::f64::consts::TAU);
    let amplitude = kc * 2.0 * half / omega;
    let formula = format!("\"{amplitude}*(1-cos(2*pi*t))\"");
    let sets = [("solid.plate.driven.distance.formula", formula.as_str()), ("gravity", gravity)];
    let mut sim: Simulation<2> = measurement("heave-plate", &sets)?;
    let [mut inertia, mut inertias, mut power, mut powers] = [0.0; 4];
    while sim.time() < 1.0 {
        let before = sim.time();
        sim.step_to(1.0)?;
        let (dt, middle) = (sim.time() - before, 0.5 * (sim.time() + before));
        let force = sim.system().solids()[1].load.force[1];
        let speed = amplitude * omega * (omega * middle).sin();
        let acceleration = amplitude * omega * omega * (omega * middle).cos();
        inertia -= force * acceleration * dt;
        inertias += 1000.0 * std::f64::consts::PI * half * half * acceleration.powi(2) * dt;
        power -= force * speed * dt;
        powers += 1000.0 * half * speed.abs().powi(3) * dt;
    }
    Ok([inertia / inertias, power / powers])
}

/// Measurements fit Cd = 8 KC^(−1/3) (Graham 1980) and 10 KC^(−1/3), and an added mass of 1 + 0.35 KC^(2/3) times ρ π a² (Luhar and Nepf
/// 2016). A vortex method agrees with Graham's drag in the first period (tests/references/heave_plate.py); later the vortices of earlier
/// periods raise it in 2-D. Bound: the 10 % of the project. At KC = 0.1 the pressure of gravity would govern the drag, because particles
/// resist rearrangement. There, where the sides of the layer were not told apart, the added mass was 1.31 and the drag coefficient 60.
#[test]
fn a_thin_heave_plate_has_the_added_mass_and_damping_of_a_thin_plate() -> Result<()> {
    for (kc, gravity) in [(0.1, "1.0"), (1.0, "9.81"), (2.0, "9.81")] {
        let (drag, mass) = (8.0 * f64::powf(kc, -1.0 / 3.0), 1.0 + 0.35 * f64::powf(kc, 2.0 / 3.0));
        let [added_mass, drag_coefficient] = heave_plate(kc, gravity)?;
        println!("KC {kc}: added mass {added_mass} ({mass}), drag coefficient {drag_coefficient} ({drag})");
        assert!((added_mass / mass - 1.0).abs() < 0.1, "KC {kc}: added mass {added_mass} ρ π a², measured {mass}");
        assert!((drag_coefficient / drag - 1.0).abs() < 0.1, "KC {kc}: Cd {drag_coefficient}, measured {drag}");
    }
    Ok(())
}
