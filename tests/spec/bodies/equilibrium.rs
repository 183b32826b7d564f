//! Equilibrium of bodies in water: list, stacked loads, a floating tub, a spring, a gate, and the limit of capsizing.
//! Drafts of single bodies are in `buoyancy`.

use pontoon::{
    Result,
    math::{Pose, Vector},
    simulation::Simulation,
    solid::{Role, hydrostatics::equilibrium_height},
};

use crate::common::{scene_simulation, time_mean};

const DP: f64 = 0.02;
const G: f64 = 9.81;

/// A tank `long` dp long with water `deep` dp deep, and the sections `more`.
fn afloat(long: f64, deep: f64, more: &str) -> Result<Simulation<2>> {
    let fill = format!("box = {{ min = [0, 0], max = [{}, {}] }}", long * DP, deep * DP);
    pool(&fill, [long * DP, 1.6 * deep * DP], more)
}

/// A tank of this size (m), filled with the region `fill`, and the sections `more`.
fn pool(fill: &str, [long, high]: [f64; 2], more: &str) -> Result<Simulation<2>> {
    let text = format!(
        "dimension = 2\ndp = {DP}\nuntil = 100.0\nmodel.viscosity.artificial.alpha = 0.1\n[[water]]\nfill = {{ {fill} }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [{long}, {high}] }} }}\n{more}"
    );
    scene_simulation::<2>(&text)
}

fn tilt(sim: &Simulation<2>, solid: usize) -> f64 {
    sim.system().solids()[solid].kinematics.pose.rotation_vector()[0]
}

/// Height of the origin of the frame of a solid, m.
fn height(sim: &Simulation<2>, solid: usize) -> f64 {
    sim.system().solids()[solid].kinematics.pose.position[1]
}

/// The tilt (rad) at which the centre of buoyancy is vertically below the centre of mass of free solid number `solid`.
fn hydrostatic_list(sim: &Simulation<2>, solid: usize) -> Result<f64> {
    let spec = &sim.system().solids()[solid].spec;
    let Role::Free(body) = &spec.role else { panic!("a free body") };
    let lever = |tilt: f64| -> Result<f64> {
        let mut pose = Pose::rotated(Vector::zeros(), &[tilt]);
        pose.position[1] += equilibrium_height(&spec.shape, &pose, body.mass, 1000.0, 0.0)?;
        Ok(spec.shape.submerged_volume(&pose, 0.0).1[0] - pose.point(&body.centre)[0])
    };
    let (mut low, mut high) = (-0.5, 0.5);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        // A counter-clockwise tilt moves the centre of buoyancy to the left.
        if lever(middle)? > 0.0 { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

#[test]
fn a_body_with_an_offset_centre_of_mass_lists_by_the_hydrostatic_angle() -> Result<()> {
    for aside in [0.012, -0.02] {
        let words = format!(
            "[[solid]]\nname = \"barge\"\nshape = {{ box = {{ size = [0.4, 0.2] }} }}\n\
             free = {{ density = 500, centre_offset = [{aside}, -0.02] }}\nat = {{ x = 0.6, draft = \"equilibrium\", angle_deg = 0 }}"
        );
        let mut sim = afloat(60.0, 16.0, &words)?;
        let exact = hydrostatic_list(&sim, 1)?.to_degrees();
        let [found] = time_mean(&mut sim, 3.0, 5.0, |sim| [tilt(sim, 1).to_degrees()])?;
        // The list is 7 or 11 degrees. Ten rows of particles resolve the levels at both ends, 20 dp apart, to a quarter of a dp.
        assert!(exact.abs() > 5.0 && (found - exact).abs() < 0.7, "{aside} m: {found}°, hydrostatics {exact}°");
    }
    Ok(())
}

#[test]
fn a_raft_with_a_crate_floats_at_the_draft_of_both_and_carries_the_weight_of_the_crate() -> Result<()> {
    let words = "[[solid]]\nname = \"raft\"\nshape = { box = { size = [0.4, 0.1] } }\nfree = { density = 400 }\nat = { x = 0.6, draft = 0.06 }\n\
                 friction = 0.5\n[[solid]]\nname = \"crate\"\nshape = { box = { size = [0.12, 0.08] } }\nfree = { mass = 8 }\n\
                 at = { x = 0.6, bottom = 0.36 }\nfriction = 0.5";
    let mut sim = afloat(60.0, 16.0, words)?;
    let sample = |sim: &Simulation<2>| {
        let pair = sim.contacts().into_iter().find(|pair| pair.between == [1, 2]);
        [height(sim, 1), height(sim, 2), pair.map_or(0.0, |pair| pair.normal_force)]
    };
    let [raft, load, force] = time_mean(&mut sim, 2.0, 4.0, sample)?;
    // Both start at their draft, so the level in the closed tank is that of the fill; 24 kg over 0.4 m.
    let draft = 0.32 - (raft - 0.05);
    assert!((draft - 0.06).abs() < 0.15 * DP, "draft {draft} m; the bound is 1.5 times that of a box on the lattice");
    assert!((force / (8.0 * G) - 1.0).abs() < 0.01, "{force} N/m of {}", 8.0 * G);
    // Contacts with the stiffness (0.05/Δt)² sink by micrometres.
    assert!((load - raft - 0.09).abs() < 0.01 * DP, "{} m above the raft", load - raft - 0.09);
    Ok(())
}

#[test]
fn a_catamaran_floats_on_its_hulls_and_lists_by_the_hydrostatic_angle() -> Result<()> {
    // Two hulls of 8 × 8 dp under a deck of 28 × 3 dp, with offset ballast. The hulls alone displace the mass.
    let hull = |x: f64| format!("{{ shape = {{ box = {{ size = [0.16, 0.16] }} }}, at = {{ x = {x} }} }}");
    let deck = "{ shape = { box = { size = [0.56, 0.06] } }, at = { y = 0.11 } }";
    let shape = format!("{{ compound = [{}, {}, {deck}] }}", hull(-0.2), hull(0.2));
    let words = format!(
        "[[solid]]\nname = \"cat\"\nshape = {shape}\nfree = {{ mass = 30, centre_offset = [0.02, 0] }}\n\
         at = {{ x = 0.6, draft = \"equilibrium\", angle_deg = 0 }}"
    );
    let mut sim = afloat(60.0, 16.0, &words)?;
    let exact = hydrostatic_list(&sim, 1)?;
    let [found, keel] = time_mean(&mut sim, 3.0, 5.0, |sim| [tilt(sim, 1), height(sim, 1)])?;
    // Two hulls are stiff in roll: a quarter of a dp at 10 dp from the middle is 0.7°.
    assert!(exact.abs() > 0.02 && (found - exact).abs() < 0.7f64.to_radians(), "{found} rad, hydrostatics {exact}");
    let Role::Free(body) = &sim.system().solids()[1].spec.role else { panic!("a free body") };
    let mut rest = Pose::rotated(Vector::zeros(), &[exact]);
    rest.position[1] += equilibrium_height(&sim.system().solids()[1].spec.shape, &rest, body.mass, 1000.0, 0.32)?;
    assert!((keel - rest.position[1]).abs() < 0.25 * DP, "{keel} m, hydrostatics {} m", rest.position[1]);
    Ok(())
}

#[test]
fn a_box_floats_in_a_floating_tub() -> Result<()> {
    // The tub has walls of 0.0864 m² and holds 0.0512 m² of water and half of 0.0128 m² of the box. It displaces 0.64 m × 0.14 m.
    let words = "[[water]]\nfill = { box = { min = [0.44, 0.42], max = [0.92, 0.54] } }\n\
                 [[solid]]\nname = \"tub\"\nshape = { tank = { size = [0.48, 0.22], thickness = 0.08 } }\n\
                 free = { mass = 32.0, locked = [\"turn\"] }\nat = { x = 0.44, y = 0.42 }\n\
                 [[solid]]\nname = \"box\"\nshape = { box = { size = [0.16, 0.08] } }\nfree = { density = 500 }\n\
                 at = { x = 0.68, y = 0.54 }";
    let around = "shape = { polygon = [[0, 0], [1.36, 0], [1.36, 0.48], [1.0, 0.48], [1.0, 0.34], [0.36, 0.34], [0.36, 0.48], [0, 0.48]] }";
    let mut sim = pool(around, [1.36, 0.8], words)?;
    let [tub, float] = time_mean(&mut sim, 3.0, 5.0, |sim| [height(sim, 1), height(sim, 2)])?;
    // Around a tub at its initial draft the level is that of the fill.
    let draft = 0.48 - (tub - 0.08);
    // An excess draft raises the level outside by 0.64/1.36 of it.
    let off = (draft - 0.14) / (1.0 - 0.64 / 1.36);
    assert!(off.abs() < 0.25 * DP, "tub: excess draft {off} m; the bound of a box off the lattice");
    let above = float - tub;
    assert!((above - 0.12).abs() < 0.25 * DP, "box: {above} m above the tub's floor, Archimedes 0.12 m");
    Ok(())
}

#[test]
fn a_body_on_a_spring_half_under_water_oscillates_with_the_period_of_spring_and_waterplane() -> Result<()> {
    let stiffness = 20000.0;
    let mass = 8000.0 * 0.1 * 0.2;
    let words = format!(
        "[[solid]]\nname = \"weight\"\nshape = {{ box = {{ size = [0.1, 0.2] }} }}\nfree = {{ mass = {mass}, locked = [\"x\", \"turn\"] }}\n\
         at = {{ x = 0.5, y = 0.4 }}\n[[spring]]\nname = \"coil\"\nbetween = [\"weight\"]\nfrom = [0.5, 0.5]\nto = [0.5, 1.0]\n\
         length = 0.45\nstiffness = {stiffness}"
    );
    let mut sim = afloat(50.0, 20.0, &words)?;
    // Equilibrium at x below the start, where the waterline is at mid-height: k (0.05 + x) = m g − ρ g (0.1 · 0.1 + 0.1 x).
    let stiffer = stiffness + 1000.0 * G * 0.1;
    let rest = 0.4 - (mass * G - 1000.0 * G * 0.01 - stiffness * 0.05) / stiffer;
    let mut passages = Vec::new();
    let mut before = (0.0, height(&sim, 1) - rest);
    let (mut sum, mut weight) = (0.0, 0.0);
    while passages.len() < 9 {
        sim.step_to(10.0)?;
        let now = (sim.time(), height(&sim, 1) - rest);
        if before.1 < 0.0 && now.1 >= 0.0 {
            passages.push(before.0 + (now.0 - before.0) * before.1 / (before.1 - now.1));
        }
        if (1..9).contains(&passages.len()) {
            sum += (now.1 + rest) * sim.dt();
            weight += sim.dt();
        }
        before = now;
    }
    let period = (passages[8] - passages[0]) / 8.0;
    // Linear potential flow between the walls of the tank, by tests/references/linear_waves.py: 0.559 s; with half and twice the
    // added mass 0.554 and 0.569 s.
    assert!((period / 0.559 - 1.0).abs() < 0.005, "period {period} s, theory 0.559 s");
    assert!((sum / weight - rest).abs() < 0.1 * DP, "mean height {} m, equilibrium {rest} m", sum / weight);
    Ok(())
}

#[test]
fn a_fixed_joint_carries_the_hydrostatic_force_and_moment_on_a_gate() -> Result<()> {
    // A gate between water and air: F = ½ ρ g d², at a third of the depth above the bottom.
    let words = "[[solid]]\nname = \"gate\"\nshape = { box = { size = [0.08, 0.5] } }\nfree = { density = 500 }\nat = { x = 0.54, bottom = 0 }\n\
                 [[joint]]\nname = \"foot\"\nkind = \"fixed\"\nbetween = [\"tank\", \"gate\"]\nat = [0.5, 0.0]";
    let mut sim = pool("box = { min = [0, 0], max = [0.5, 0.4] }", [1.0, 0.6], words)?;
    let sample = |sim: &Simulation<2>| {
        let (joint, load) = (sim.joint_reading(0), &sim.system().solids()[1].load);
        [joint.force[0], joint.torque.axial()[0], joint.force[1], load.force[0]]
    };
    let [across, torque, up, load] = time_mean(&mut sim, 1.5, 3.0, sample)?;
    assert!((across / -load - 1.0).abs() < 1e-3, "joint {across} N/m, water {load} N/m: the gate is at rest");
    let push = 0.5 * 1000.0 * G * 0.16;
    // A quarter of a dp of level in 20 rows is 2.5 % of the force. The numerical pressure gradient adds 2 %.
    assert!((across / -push - 1.0).abs() < 0.045, "{across} N/m, hydrostatics {}", -push);
    // About the foot, the force to the right at height d/3 and the weight 0.04 m to the right act clockwise. Under the gate the pressure
    // falls evenly from that of the water to none: its force acts a third of the breadth to the right, against them.
    let (weight, uplift) = (500.0 * 0.04 * G, 0.5 * 1000.0 * G * 0.4 * 0.08);
    let turning = push * 0.4 / 3.0 + weight * 0.04 - uplift * 0.08 / 3.0;
    assert!(
        (torque / turning - 1.0).abs() < 0.06,
        "{torque} N m/m, hydrostatics {turning}; the moment grows with the cube of the depth"
    );
    // A quarter of a dp of level is 1.3 % of the uplift; its four rows have the pressure half a dp inside, which is 5 % of it at most.
    let rest = weight - uplift;
    assert!((up - rest).abs() < 0.065 * uplift, "{up} N/m, weight of the gate less the uplift {rest}");
    Ok(())
}

/// Largest tilt (degrees) in the sixth second of a barge that starts at 3° with GM = `gm_over_bm` · BM.
fn largest_tilt(gm_over_bm: f64) -> Result<f64> {
    // A box 20 × 10 dp of half the water's density: KB = 2.5, BM = 20²/(12 · 5), KG = 5 dp + offset.
    let bm = 20.0 * 20.0 / 60.0;
    let offset = (2.5 + bm - 5.0 - gm_over_bm * bm) * DP;
    let words = format!(
        "[[solid]]\nname = \"barge\"\nshape = {{ box = {{ size = [0.4, 0.2] }} }}\nfree = {{ density = 500, centre_offset = [0, {offset}] }}\n\
         at = {{ x = 0.6, draft = \"equilibrium\", angle_deg = 3 }}"
    );
    let mut sim = afloat(60.0, 16.0, &words)?;
    let mut most: f64 = 0.0;
    while sim.time() < 6.0 {
        sim.step_to(6.0)?;
        if sim.time() > 5.0 {
            most = most.max(tilt(&sim, 1).to_degrees().abs());
        }
    }
    Ok(most)
}

#[test]
fn a_barge_capsizes_when_its_metacentre_is_below_its_centre_of_mass() -> Result<()> {
    // The righting arm of a wall-sided body is (GM + ½ BM tan² φ) sin φ. Its angle of loll is 18° with GM = −0.05 BM and 11° with
    // −0.02 BM; with GM > 0 it is upright. All start at 3°. At ±5 % the stable barge returns below 3° and the unstable one exceeds 6°.
    // At the ±2 % of the project the stable one is below 3° and the unstable one above 4.5°. Its list of 5° in place of 11° is a known
    // limitation (docs/explanation/validation.md).
    let [upright, less, more, over] = [0.05, 0.02, -0.02, -0.05].map(largest_tilt);
    let (upright, less, more, over) = (upright?, less?, more?, over?);
    assert!(upright < 3.0, "GM = 0.05 BM: {upright}°");
    assert!(over > 6.0, "GM = −0.05 BM: {over}°");
    assert!(less < 3.0 && more > 4.5, "GM = 0.02 BM: {less}°, GM = −0.02 BM: {more}°");
    Ok(())
}

#[test]
fn the_metacentre_is_at_its_hydrostatic_height() -> Result<()> {
    // The barge is held at 3° and free to heave, with its centre of mass at the metacentre. The torque is ½ BM tan² φ sin φ times its weight.
    let (bm, tilt) = (20.0 * 20.0 / 60.0 * DP, 3f64.to_radians());
    let offset = 2.5 * DP + bm - 5.0 * DP;
    let words = format!(
        "[[solid]]\nname = \"barge\"\nshape = {{ box = {{ size = [0.4, 0.2] }} }}\n\
         free = {{ density = 500, centre_offset = [0, {offset}], locked = [\"x\", \"turn\"] }}\n\
         at = {{ x = 0.6, draft = \"equilibrium\", angle_deg = 3 }}"
    );
    let mut sim = afloat(60.0, 16.0, &words)?;
    let [torque] = time_mean(&mut sim, 1.0, 4.0, |sim| [sim.system().solids()[1].load.torque.axial()[0]])?;
    let weight = 500.0 * 0.08 * G;
    // The tilt is counter-clockwise, so a righting torque is negative.
    let found = -torque / (weight * tilt.sin()) / bm - 0.5 * tilt.tan().powi(2);
    assert!(found.abs() < 0.02, "the metacentre is off by {found} of BM");
    Ok(())
}

#[test]
fn a_body_of_the_density_of_water_stays_at_its_depth() -> Result<()> {
    for shape in ["box = { size = [0.16, 0.12] }", "ball = { radius = 0.08 }"] {
        let words = format!(
            "[[solid]]\nname = \"float\"\nshape = {{ {shape} }}\nfree = {{ density = 1000 }}\nat = {{ x = 0.4, y = 0.2 }}"
        );
        let mut sim = afloat(40.0, 20.0, &words)?;
        let start = sim.system().solids()[1].kinematics.centre;
        while sim.time() < 2.0 {
            sim.step_to(2.0)?;
        }
        let moved = (sim.system().solids()[1].kinematics.centre - start) / DP;
        // An error of 0.2 % of its weight, with an added mass equal to its mass, would move it by ½ · 0.002 g/2 · (2 s)² = 1 dp.
        assert!(moved.norm() < 1.0, "{shape}: moved by {moved} dp");
    }
    Ok(())
}
