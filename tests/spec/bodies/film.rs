//! The film of water between a free body and what it touches: it carries the pressure that the water has at its rim.

use pontoon::{
    Result,
    math::Vector,
    simulation::{Dimension, Simulation},
    solid::Dim,
};

use crate::common::{run_to, scene_simulation, time_mean};

const G: f64 = 9.81;

/// A body that touches the bed or a wall is held there: the mean force (N; N/m in 2-D) of the water from 0.4 s on until `until` (s).
fn mean_force<const D: usize>(text: &str, until: f64) -> Result<Vector<D>>
where
    Dim<D>: Dimension<D>,
{
    let mut sim: Simulation<D> = scene_simulation(text)?;
    Ok(time_mean(&mut sim, 0.4, until, |sim| sim.system().solids()[1].load.force.into())?.into())
}

/// Water as far as `reach` (m) and `depth` (m) deep in a tank of 0.8 m, and a held body of `size` (m) at `at`.
fn held(dp: f64, [reach, depth]: [f64; 2], size: [f64; 2], at: &str) -> String {
    format!(
        r#"dimension = 2
dp = {dp}
until = 1.0
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [{reach}, {depth}] }} }}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.8, 0.8] }} }}
[[solid]]
name = "body"
shape = {{ box = {{ size = [{}, {}] }} }}
at = {{ {at} }}
free = {{ density = 600, locked = ["x", "y", "turn"] }}
"#,
        size[0], size[1]
    )
}

#[test]
fn a_body_on_the_bed_is_lifted_as_archimedes_says() -> Result<()> {
    // The weight of the water in its place. Without a film the water above presses with −330 N/m. Bound: a twentieth of the pressure
    // on the bed times the area, as for a gap of one row.
    let (exact, bound) = (1000.0 * G * 0.0144, 0.05 * 1000.0 * G * 0.4 * 0.12);
    for x in [0.4, 0.407] {
        let text = held(0.02, [0.8, 0.4], [0.12, 0.12], &format!("x = {x}, bottom = 0.0"));
        let lift = mean_force::<2>(&text, 1.0)?[1];
        assert!((lift - exact).abs() < bound, "at {x} m: {lift} N/m, Archimedes {exact} N/m");
    }
    Ok(())
}

#[test]
fn a_body_on_the_bed_is_lifted_as_archimedes_says_in_3d() -> Result<()> {
    let text = r#"dimension = 3
dp = 0.02
until = 0.6
[[water]]
fill = { box = { min = [0.0, 0.0, 0.0], max = [0.32, 0.32, 0.24] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.32, 0.32, 0.5] } }
[[solid]]
name = "body"
shape = { box = { size = [0.12, 0.12, 0.1] } }
at = { x = 0.16, y = 0.16, bottom = 0.0 }
free = { density = 1800, locked = ["x", "y", "z", "turn_x", "turn_y", "turn_z"] }
"#;
    let (exact, bound) = (1000.0 * G * 0.00144, 0.05 * 1000.0 * G * 0.24 * 0.0144);
    let lift = mean_force::<3>(text, 0.6)?[2];
    assert!((lift - exact).abs() < bound, "{lift} N, Archimedes {exact} N");
    Ok(())
}

/// The gap below a round or chamfered bottom widens outwards: the film ends where water has room. Bound: 15 % of the weight of
/// the water in the place of the body, as half a row of water at each rim may lack. Before, the rim was sought within the body, and the
/// forces were 14, −306 and −98 N/m.
#[test]
fn a_round_body_that_touches_is_lifted_as_archimedes_says() -> Result<()> {
    let body = |shape: &str, at: &str| {
        held(0.02, [0.8, 0.4], [0.2, 0.2], at).replace("{ box = { size = [0.2, 0.2] } }", shape)
    };
    let disc = "{ ball = { radius = 0.1 } }";
    let barge = "{ polygon = [[-0.06, 0.0], [0.06, 0.0], [0.12, 0.06], [0.12, 0.16], [-0.12, 0.16], [-0.12, 0.06]] }";
    let octagon = "{ polygon = [[0.041, -0.1], [0.1, -0.041], [0.1, 0.041], [0.041, 0.1], [-0.041, 0.1], [-0.1, 0.041], \
                   [-0.1, -0.041], [-0.041, -0.1]] }";
    let area = [std::f64::consts::PI * 0.01, 0.24 * 0.1 + 0.5 * 0.06 * (0.12 + 0.24), 0.2 * 0.2 - 2.0 * 0.059 * 0.059];
    for ((name, shape), area) in [("disc", disc), ("barge", barge), ("octagon", octagon)].into_iter().zip(area) {
        for x in [0.4, 0.407] {
            let lift = mean_force::<2>(&body(shape, &format!("x = {x}, bottom = 0.0")), 1.0)?[1];
            println!("{name} at {x} m: {lift:.0} N/m of {:.0} N/m", 1000.0 * G * area);
            assert!((lift / (1000.0 * G * area) - 1.0).abs() < 0.15, "{name} at {x} m: {lift} N/m");
        }
    }
    let push = mean_force::<2>(&body(disc, "x = 0.1, bottom = 0.1"), 1.0)?;
    println!("disc beside a wall: {:.0} and {:.0} N/m", push[0], push[1]);
    assert!(push[0].abs() < 0.15 * 1000.0 * G * area[0], "{} N/m towards the water", push[0]);
    Ok(())
}

/// The mean force (N/m) of the water on each of two held solids, in water 0.4 m deep, from 0.4 s to 1 s. `solids` come after the tank.
fn forces_on_pair(solids: [String; 2]) -> Result<[f64; 2]> {
    let tank = r#"dimension = 2
dp = 0.02
until = 1.0
[[water]]
fill = { box = { min = [0.0, 0.0], max = [0.8, 0.4] } }
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.8] } }
"#;
    let mut sim = scene_simulation::<2>(&[tank.to_string(), solids.concat()].concat())?;
    time_mean(&mut sim, 0.4, 1.0, |sim| [1, 2].map(|k| sim.system().solids()[k].load.force[1]))
}

/// A solid `width` (m) wide and 0.1 m high, in the middle of the tank at the height `bottom` (m).
fn block(name: &str, width: f64, bottom: f64, role: &str) -> String {
    format!(
        r#"[[solid]]
name = "{name}"
shape = {{ box = {{ size = [{width}, 0.1] }} }}
at = {{ x = 0.4, bottom = {bottom} }}
{role}
"#
    )
}

const FIXED: &str = "fixed = true";
const HELD: &str = "free = { density = 600, locked = [\"x\", \"y\", \"turn\"] }";

/// The film ends where the narrower solid ends, over or under which there is water; without a film the force is −392 N/m. Bound: the
/// pressure on half a dp, because the film consists of whole particles, and the end of the pier lies anywhere between two of them.
#[test]
fn a_body_wider_than_its_support_is_lifted_as_archimedes_says() -> Result<()> {
    let exact = 1000.0 * G * 0.2 * 0.1;
    for width in [0.1, 0.11, 0.12] {
        let [_, lift] = forces_on_pair([block("pier", width, 0.0, FIXED), block("body", 0.2, 0.1, HELD)])?;
        println!("on a pier of {width} m: {lift:.1} N/m of {exact:.1} N/m");
        assert!((lift - exact).abs() < 0.5 * 0.02 * 1000.0 * G * 0.3, "on a pier of {width} m: {lift} N/m");
    }
    Ok(())
}

/// Two free bodies, the narrower one above or below the wider one, in either order in the scene. Bound: a twentieth of the pressure on
/// the face between them, and on the bed.
#[test]
fn a_film_does_not_depend_on_the_order_of_the_solids() -> Result<()> {
    for [upper, lower] in [[0.12, 0.24], [0.24, 0.12], [0.2, 0.2]] {
        let (above, below) = (block("upper", upper, 0.1, HELD), block("lower", lower, 0.0, HELD));
        let [on_upper, on_lower] = forces_on_pair([above.clone(), below.clone()])?;
        let [lower_first, upper_second] = forces_on_pair([below, above])?;
        println!("{upper} m on {lower} m: {on_upper:.1} and {on_lower:.1}; {upper_second:.1} and {lower_first:.1} N/m");
        let bound = 0.05 * 1000.0 * G * 0.3 * upper.min(lower);
        for lift in [on_upper, upper_second] {
            assert!((lift - 1000.0 * G * 0.1 * upper).abs() < bound, "on the upper one of {upper} m: {lift} N/m");
        }
        let bound = bound + 0.05 * 1000.0 * G * 0.4 * lower;
        for lift in [on_lower, lower_first] {
            assert!((lift - 1000.0 * G * 0.1 * lower).abs() < bound, "on the lower one of {lower} m: {lift} N/m");
        }
    }
    Ok(())
}

#[test]
fn under_a_dam_the_pressure_falls_evenly_to_the_dry_side() -> Result<()> {
    // Water of 0.2 m on one side of a block 0.2 m wide: half of its pressure on average. Bound: the rims are half a dp inside, 2.5 %.
    let text = held(0.01, [0.4, 0.2], [0.2, 0.3], "x = 0.5, bottom = 0.0");
    let lift = mean_force::<2>(&text, 1.0)?[1];
    let exact = 0.5 * 1000.0 * G * 0.2 * 0.2;
    assert!((lift / exact - 1.0).abs() < 0.025, "{lift} N/m of {exact} N/m");
    Ok(())
}

/// The particles at the dry rim of a narrow foot see the water on the other side. Bound: 3 % of what presses on the side, to which rows
/// of water at rest hold; the pressure of the water under the whole foot would be 39, 78 and 118 N/m more.
#[test]
fn under_a_narrow_foot_the_pressure_falls_to_the_dry_side() -> Result<()> {
    let bound = 0.03 * 0.5 * 1000.0 * G * 0.4 * 0.4;
    for rows in [1.0, 2.0, 3.0] {
        let width = 0.02 * rows;
        let text = held(0.02, [0.4, 0.4], [width, 0.6], &format!("x = {}, bottom = 0.0", 0.4 + 0.5 * width));
        let lift = mean_force::<2>(&text, 1.0)?[1];
        let exact = 0.5 * 1000.0 * G * 0.4 * width;
        println!("foot of {rows} rows: {lift} N/m of {exact} N/m");
        assert!((lift - exact).abs() < bound, "{rows} rows: {lift} N/m of {exact} N/m");
    }
    Ok(())
}

#[test]
fn a_body_beside_a_wall_is_not_pressed_against_it() -> Result<()> {
    // The water between wall and body has the pressure of the water on the other side, 110 N/m here: nothing remains. Bound: one row
    // of dp at the lowest pressure of the film, 13 % of one side.
    let text = held(0.01, [0.8, 0.3], [0.2, 0.15], "x = 0.1, bottom = 0.15");
    let push = mean_force::<2>(&text, 1.0)?[0];
    let side = 0.5 * 1000.0 * G * 0.15 * 0.15;
    assert!(push.abs() < 0.13 * side, "{push} N/m of {side} N/m");
    Ok(())
}

#[test]
fn a_rising_level_lifts_a_body_off_the_bed_when_its_buoyancy_exceeds_its_weight() -> Result<()> {
    // Two pistons raise the level at 17 mm/s and more. The draft is 0.08 m; the body must leave the bed within one dp of that level, and
    // not before it but for half a dp: the surface is known to a tenth of dp, and the water runs up and down by as much.
    let dp = 0.01;
    let text = format!(
        r#"dimension = 2
dp = {dp}
until = 6.0
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [1.2, 0.06] }} }}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [1.2, 0.4] }} }}
[[solid]]
name = "body"
shape = {{ box = {{ size = [0.2, 0.16] }} }}
at = {{ x = 0.6, bottom = 0.0 }}
free = {{ density = 500.0, locked = ["turn"] }}
[[solid]]
name = "left"
shape = {{ box = {{ size = [0.1, 0.4] }} }}
at = {{ x = -0.05, bottom = 0.0 }}
driven = {{ along = [1.0, 0.0], distance = {{ formula = "0.05*t" }} }}
[[solid]]
name = "right"
shape = {{ box = {{ size = [0.1, 0.4] }} }}
at = {{ x = 1.25, bottom = 0.0 }}
driven = {{ along = [1.0, 0.0], distance = {{ formula = "-0.05*t" }} }}
"#
    );
    let mut sim = scene_simulation::<2>(&text)?;
    // The mean level beside the body: its water over the width between the pistons.
    let water = sim.system().particle_mass() * sim.system().fluid().len() as f64 / 1000.0;
    let level = |t: f64| water / (1.2 - 0.2 - 0.1 * t);
    while sim.system().solids()[1].kinematics.centre[1] < 0.08 + 0.25 * dp {
        sim.step()?;
        assert!(level(sim.time()) < 0.08 + dp, "it lies on the bed at a level of {} m", level(sim.time()));
    }
    assert!(level(sim.time()) > 0.08 - 0.5 * dp, "it has left the bed at a level of {} m", level(sim.time()));
    Ok(())
}

/// A sinking box catches a row of water, which leaves the gap. Bounds: a twentieth of dp; 2 % of the pressure on the bed times the
/// width, to which a film carries it.
#[test]
fn a_sunk_body_comes_to_lie_on_the_bed_with_its_weight_less_its_buoyancy() -> Result<()> {
    for density in [1500.0, 3000.0] {
        let text = format!(
            r#"dimension = 2
dp = 0.02
until = 3.0
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [0.8, 0.5] }} }}
[[solid]]
name = "tank"
fixed = true
shape = {{ tank = {{ size = [0.8, 0.8] }} }}
[[solid]]
name = "body"
shape = {{ box = {{ size = [0.2, 0.2] }} }}
at = {{ x = 0.4, bottom = 0.1 }}
free = {{ density = {density} }}
"#
        );
        let mut sim = scene_simulation::<2>(&text)?;
        let pressing = |sim: &Simulation<2>| [sim.contacts().iter().map(|contact| contact.normal_force).sum()];
        let [force] = time_mean(&mut sim, 2.0, 3.0, pressing)?;
        let (height, exact) = (sim.system().solids()[1].kinematics.centre[1] - 0.1, (density - 1000.0) * 0.04 * G);
        println!("{density} kg/m³: {force:.1} N/m of {exact:.1} N/m, {:.2} mm above the bed", 1e3 * height);
        assert!(height.abs() < 0.05 * 0.02, "{density} kg/m³: {height} m above the bed");
        assert!((force - exact).abs() < 0.02 * 1000.0 * G * 0.5 * 0.2, "{density} kg/m³: {force} N/m of {exact} N/m");
    }
    Ok(())
}

/// A slab sinks to the bed of a tank that moves steadily with its water as to that of a tank at rest.
#[test]
fn water_leaves_the_gap_under_a_body_in_a_moving_tank_as_at_rest() -> Result<()> {
    let end = |speed: f64| -> Result<[f64; 3]> {
        let text = format!(
            r#"dimension = 2
dp = 0.02
until = 0.6
[[water]]
fill = {{ box = {{ min = [0.0, 0.0], max = [0.8, 0.24] }} }}
velocity = [{speed:?}, 0.0]
[[solid]]
name = "tank"
shape = {{ tank = {{ size = [0.8, 0.4] }} }}
driven = {{ along = [1.0, 0.0], distance = {{ formula = "{speed:?}*t" }} }}
[[solid]]
name = "slab"
shape = {{ box = {{ size = [0.4, 0.1] }} }}
at = {{ x = 0.4, bottom = 0.02 }}
free = {{ density = 2000.0, velocity = [{speed:?}, 0.0] }}
"#
        );
        let mut sim = scene_simulation::<2>(&text)?;
        run_to(&mut sim, 0.6)?;
        let pose = sim.system().solids()[1].kinematics.pose;
        Ok([pose.position[0] - 0.4 - 0.6 * speed, pose.position[1], pose.rotation_vector()[0].to_degrees()])
    };
    let still = end(0.0)?;
    for speed in [0.5, -0.5] {
        let moving = end(speed)?;
        // A tenth of a dp, and the turn by which one end of the slab is as much higher.
        let far = (moving[0] - still[0]).abs().max((moving[1] - still[1]).abs());
        assert!(far < 0.002 && (moving[2] - still[2]).abs() < 0.3, "{moving:?} for {still:?} at {speed} m/s");
    }
    Ok(())
}
