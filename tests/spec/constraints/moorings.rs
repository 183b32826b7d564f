//! Mooring lines with mass in scenes: weight, momentum, energy, bits, winches, refusals.

use std::path::Path;

use pontoon::{
    Result,
    probe::{EnergyBudgetProbe, MooringProbe, Probe},
    scene::Scene,
    simulation::{Dimension, Simulation},
    solid::Dim,
};

use crate::common::{
    TestFolder, on_threads, preflight_report, run_to, scene_simulation, steps, time_mean, water_momentum,
};

/// A box on two slack chains in a small tank.
const MOORED: &str = r#"
dimension = 2
dp = 0.02
until = 0.4
water = [{ fill = { box = { min = [0.0, 0.0], max = [1.6, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.6, 0.6] } }
[[solid]]
name = "box"
shape = { box = { size = [0.3, 0.12] } }
at = { x = 0.8, draft = "equilibrium" }
free = { density = 500.0, velocity = [0.2, 0.0] }
[[line_type]]
name = "chain"
diameter = 0.008
mass_per_length = 0.3
stiffness = 2e3
[[mooring]]
name = "west"
between = ["box"]
from = [0.65, 0.3]
to = [0.1, 0.0]
length = 0.75
line = "chain"
[[mooring]]
name = "east"
between = ["box"]
from = [0.95, 0.3]
to = [1.5, 0.0]
length = 0.75
line = "chain"
"#;

/// Weight less buoyancy of a metre of the chain, N/m.
const WEIGHT: f64 = (0.3 - 1000.0 * 0.25 * std::f64::consts::PI * 0.008 * 0.008) * 9.81;

/// The fairlead bears the weight of what does not lie on the bed, within half a segment: the touchdown is that near to the middle
/// between the last node that lies and the first that does not.
#[test]
fn the_fairlead_bears_what_hangs() -> Result<()> {
    let sim = scene_simulation::<2>(MOORED)?;
    for line in 0..2 {
        let now = sim.mooring_reading(line);
        let hangs = 0.75 - now.on_bed;
        assert!(now.on_bed > 0.1, "{} m lie", now.on_bed);
        let lift = -now.end_forces[0][1];
        assert!((lift / WEIGHT - hangs).abs() < 0.75 / 40.0, "line {line}: {lift} N, and {hangs} m hang");
    }
    let [west, east] = [0, 1].map(|line| sim.mooring_reading(line).end_forces[0]);
    assert!((west[0] + east[0]).abs() < 1e-6 * east.norm(), "both pull alike: {west} {east}");
    Ok(())
}

/// A clump weight and a float on a line change the vertical force on the fairlead by their weight less buoyancy, within the weight of a
/// segment.
#[test]
fn the_fairlead_bears_clumps_and_floats() -> Result<()> {
    for (mass, volume) in [(0.1, 1e-5), (0.02, 8e-5)] {
        let keys = format!("length = 0.75\nclumps = [{{ at = 0.1, mass = {mass}, volume = {volume} }}]");
        let now = scene_simulation::<2>(&MOORED.replacen("length = 0.75", &keys, 1))?.mooring_reading(0);
        let (lift, hung): (f64, f64) = (-now.end_forces[0][1], (mass - 1000.0 * volume) * 9.81);
        assert!(hung.abs() > 5.0 * WEIGHT * 0.75 / 20.0, "{hung} N are more than a segment");
        assert!(((lift - hung) / WEIGHT - (0.75 - now.on_bed)).abs() < 0.75 / 20.0, "{lift} N, of which {hung} N hang");
    }
    Ok(())
}

/// A loop of chain hangs in water along the side of a driven box, or of a free one that is held. The box takes half of the kernel around
/// each node, as a wall does; the chain has its buoyancy all the same: (1.5 − 1000 π/4 0.03²) kg/m × 9.81 m/s² × 0.3 m on each end. The
/// water's rows leave up to 2 % at such a place.
#[test]
fn a_line_along_a_moving_body_has_its_whole_buoyancy() -> Result<()> {
    let hanging = (1.5 - 1000.0 * std::f64::consts::FRAC_PI_4 * 0.03 * 0.03) * 9.81 * 0.3;
    for role in
        ["driven = { along = [1, 0], distance = { formula = \"0\" } }", "free = { density = 900.0, release = 1.0 }"]
    {
        let text = format!(
            "dimension = 2\ndp = 0.02\nuntil = 1.0\nwater = [{{ fill = {{ box = {{ min = [0.0, 0.0], max = [1.0, 0.5] }} }} }}]\n\
             [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.0, 0.8] }} }}\n\
             [[solid]]\nname = \"b\"\nshape = {{ box = {{ size = [0.2, 0.6] }} }}\nat = {{ x = 0.5, bottom = 0.1 }}\n{role}\n\
             [[line_type]]\nname = \"chain\"\ndiameter = 0.03\nmass_per_length = 1.5\nstiffness = 2e4\n\
             [[mooring]]\nname = \"l\"\nbetween = [\"b\"]\nfrom = [0.4, 0.45]\nto = [0.4, 0.45]\nlength = 0.6\nline = \"chain\"\n"
        );
        // A single segment has no direction, and half of the weight at each end all the same.
        for segments in ["", "segments = 1\n"] {
            let sim = scene_simulation::<2>(&format!("{text}{segments}"))?;
            let ends = MooringProbe::new(sim.system(), "l")?.sample(&sim);
            for end in &ends[..2] {
                assert!((end / hanging - 1.0).abs() < 0.02, "{role}, {segments}: {end} N/m of {hanging} N/m");
            }
        }
    }
    Ok(())
}

/// The momentum of the box changes by the sum of its loads, the lines among them, to round-off; and the energy budget has their work.
#[test]
fn momentum_and_energy_close_with_the_lines() -> Result<()> {
    let mut sim = scene_simulation::<2>(MOORED)?;
    sim.enable_load_breakdown();
    sim.enable_energy_budget();
    let probe = EnergyBudgetProbe::new(sim.system());
    for k in 1..=40 {
        run_to(&mut sim, f64::from(k) * 0.01)?;
        let shares = sim.load_breakdown(1).unwrap();
        let size = shares.kinds().into_iter().map(|(_, load)| load.force.norm()).fold(0.0, f64::max);
        assert!(shares.moorings.force.norm() > 1.0, "the lines pull: {}", shares.moorings.force);
        assert!(shares.residual().force.norm() < 1e-9 * size, "{}", shares.residual().force);
    }
    let budget = *sim.energy_budget().unwrap();
    assert!(budget.springs < -1e-3, "the lines slow the box: {} J/m", budget.springs);
    let row = probe.sample(&sim);
    let turnover: f64 = budget.entries().iter().map(|(_, energy)| energy.abs()).sum();
    assert!(row.last().unwrap().abs() < 0.01 * turnover, "residual {} of {turnover} J/m", row.last().unwrap());
    Ok(())
}

/// Without lines the box drifts on. A chain keeps it within its length and 1 % of stretch, 20 N of 2 kN.
#[test]
fn chains_hold_the_box() -> Result<()> {
    let (free, _) = MOORED.split_once("[[line_type]]").unwrap();
    let farthest = |text: &str| -> Result<f64> {
        let mut sim: Simulation<2> = scene_simulation(text)?;
        let mut farthest: f64 = 0.0;
        while sim.time() < 1.8 {
            sim.step()?;
            farthest = farthest.max(sim.system().solids()[1].kinematics.centre[0] - 0.8);
        }
        Ok(farthest)
    };
    let (moored, free) =
        (farthest(&MOORED.replace("[0.2, 0.0]", "[0.4, 0.0]"))?, farthest(&free.replace("[0.2, 0.0]", "[0.4, 0.0]"))?);
    let reach = (0.7575_f64.powi(2) - 0.3 * 0.3).sqrt() - 0.55;
    assert!(moored < reach && free > 1.2 * reach, "{moored} m with chains of {reach} m, {free} m without");
    Ok(())
}

/// A line between a driven solid and the ground is advanced without a free body: moved slowly, it comes to the tension at rest of the
/// new place, within 3 % of its own oscillation.
#[test]
fn a_driven_solid_moves_its_line() -> Result<()> {
    let (free, law) = (
        "at = { x = 0.8, draft = \"equilibrium\" }\nfree = { density = 500.0, velocity = [0.2, 0.0] }",
        "driven = { along = [1.0, 0.0], distance = { formula = \"0.025*(1-cos(2*pi*min(t,0.5)))\" } }",
    );
    let mut sim = scene_simulation::<2>(&MOORED.replace(free, &format!("at = {{ x = 0.8, y = 0.3 }}\n{law}")))?;
    let moved = MOORED
        .replace(free, "at = { x = 0.85, y = 0.3 }\ndriven = { along = [1.0, 0.0], distance = { formula = \"0\" } }");
    let moved =
        moved.replace("from = [0.65, 0.3]", "from = [0.7, 0.3]").replace("from = [0.95, 0.3]", "from = [1.0, 0.3]");
    let probe = MooringProbe::new(sim.system(), "west")?;
    let (start, rest) = (probe.sample(&sim)[0], probe.sample(&scene_simulation::<2>(&moved)?)[0]);
    let [now] = time_mean(&mut sim, 0.8, 1.2, |sim| [probe.sample(sim)[0]])?;
    assert!((sim.mooring_reading(0).nodes[0][0] - 0.70).abs() < 1e-9, "the fairlead goes with the solid");
    assert!(rest > 1.1 * start && (now / rest - 1.0).abs() < 0.03, "{start} N, then {now} N, at rest {rest} N");
    Ok(())
}

/// A driven solid that stands still, in place of the free box.
fn standing() -> String {
    MOORED.replace(
        "at = { x = 0.8, draft = \"equilibrium\" }\nfree = { density = 500.0, velocity = [0.2, 0.0] }",
        "at = { x = 0.8, y = 0.3 }\ndriven = { along = [1.0, 0.0], distance = { formula = \"0\" } }",
    )
}

/// A line begins at rest at its time, with the force of the static line, and has none after its end.
#[test]
fn a_line_acts_from_since_until() -> Result<()> {
    let scene = standing().replacen("length = 0.75", "length = 0.75\nsince = 0.05\nuntil = 0.15", 1);
    let mut sim = scene_simulation::<2>(&scene)?;
    let probe = MooringProbe::new(sim.system(), "west")?;
    let other = MooringProbe::new(sim.system(), "east")?;
    assert!(probe.sample(&sim).iter().all(|x| *x == 0.0) && sim.mooring_reading(0).nodes.is_empty());
    run_to(&mut sim, 0.1)?;
    let [west, east] = [&probe, &other].map(|probe| probe.sample(&sim)[0]);
    assert!((west / east - 1.0).abs() < 0.05, "both lines hang alike: {west} N, {east} N");
    run_to(&mut sim, 0.2)?;
    assert!(probe.sample(&sim).iter().all(|x| *x == 0.0), "it has ended");
    let events: Vec<String> = sim.events().iter().map(ToString::to_string).collect();
    assert!(events.len() == 2 && events.iter().all(|event| event.contains("west")), "{events:?}");
    Ok(())
}

/// A line that a winch hauls in breaks at the fairlead, where its tension is largest, once that exceeds its strength, and then bears half a
/// segment there.
#[test]
fn a_hauled_line_breaks_at_its_strength() -> Result<()> {
    let keys = "length = 0.75\npaid_out = { formula = \"-0.1*t\" }\nbreaks = { tension = 1.5 }";
    let mut sim = scene_simulation::<2>(&standing().replacen("length = 0.75", keys, 1))?;
    let mut largest: f64 = 0.0;
    while sim.time() < 1.0 {
        sim.step_to(1.0)?;
        let now = sim.mooring_reading(0);
        if now.broken.is_none() {
            largest = now.tensions.iter().copied().fold(largest, f64::max);
        }
    }
    let now = sim.mooring_reading(0);
    assert_eq!((now.broken, now.tensions[0]), (Some(0), 0.0));
    assert!((1.3..=1.5).contains(&largest), "{largest} N before it breaks");
    assert!(now.end_forces[0].norm() < 0.1, "{} N at the fairlead", now.end_forces[0]);
    let events: Vec<String> = sim.events().iter().map(ToString::to_string).collect();
    assert!(events.len() == 1 && events[0].contains("west"), "{events:?}");
    Ok(())
}

/// Pre-flight has the tensions of the static lines, the touchdown point at the end of the part that lies, the step of the line, and the
/// period of surge on two catenaries, within 4 % (found: 2.5 %).
#[test]
fn preflight_tells_pretension_touchdown_and_surge_period() -> Result<()> {
    let report = preflight_report(&Scene::parse(MOORED, Path::new(""), &[])?);
    let sim = scene_simulation::<2>(MOORED)?;
    for (i, line) in report.moorings.iter().enumerate() {
        let now = sim.mooring_reading(i);
        let ends = now.end_forces.map(|force| force.norm());
        assert!(
            (line.fairlead_n / ends[0] - 1.0).abs() < 1e-9 && (line.anchor_n / ends[1] - 1.0).abs() < 1e-9,
            "{line:?}"
        );
        let [x, y] = line.touchdown_m.as_ref().expect("part of it lies")[..] else { panic!("{line:?}") };
        let anchor = now.nodes[20];
        assert!(((x - anchor[0]).abs() - line.on_bed_m).abs() < 0.75 / 20.0 && y.abs() < 1e-3, "{line:?}");
        assert!(line.shape_m.len() == 21 && line.step_s > 0.0 && line.step_s < 1e-3, "{line:?}");
    }
    // A catenary with the horizontal tension H = a w reaches over L − s + a acosh(1 + z/a), with the hanging length s = √(z² + 2 z a).
    let z = 0.3;
    let a = report.moorings[0].fairlead_n / WEIGHT - z;
    let stiffness = 2.0 * WEIGHT / ((1.0 + z / a).acosh() - 2.0 * z / (z * z + 2.0 * z * a).sqrt());
    let [surge] = &report.moored_surge[..] else { panic!("{:?}", report.moored_surge) };
    // A box of 0.3 m by 0.12 m and half the density of water.
    let period = std::f64::consts::TAU * (0.3 * 0.12 * 500.0 / stiffness).sqrt();
    assert!(
        (surge.period_s.expect("it returns") / period - 1.0).abs() < 0.04,
        "{surge:?}, {stiffness} N/m², {period} s"
    );
    Ok(())
}

/// A winch that hauls in slowly passes through the static tensions: after 0.03 m, paid out by formula or by a controller that holds a
/// length, the line has the tension of one that is 0.03 m shorter.
#[test]
fn a_winch_that_hauls_in_gives_the_tension_of_the_shorter_line() -> Result<()> {
    let tension = |sim: &Simulation<2>| sim.mooring_reading(0).end_forces[0].norm();
    let short = tension(&scene_simulation::<2>(&standing().replacen("length = 0.75", "length = 0.72", 1))?);
    // A record of the same length is read beside the scene.
    let folder = TestFolder::new("moorings-winch");
    std::fs::write(folder.join("winch.csv"), "t_s,out_m\n0,0\n0.3,-0.03\n5,-0.03\n").expect("the folder is new");
    for winch in [
        "paid_out = { formula = \"-0.1*min(t,0.3)\" }",
        "paid_out = { file = \"winch.csv\", column = \"out_m\" }",
        "winch = { hold_length = 0.72, rate_limit = 0.1 }",
    ] {
        let text = standing().replacen("length = 0.75", &format!("length = 0.75\n{winch}"), 1);
        let mut sim = Simulation::<2>::new(Scene::parse(&text, &folder, &[])?.build()?.setup)?;
        run_to(&mut sim, 1.0)?;
        let hauled = tension(&sim);
        assert!((hauled / short - 1.0).abs() < 0.05, "{winch}: {hauled} N, {short} N of the short line");
    }
    Ok(())
}

/// A winch with a controller holds the tension at rest within 1 %, from a line that starts with less and from one that starts with more. A
/// slack line answers to its length far less than its stiffness says, so that it takes some seconds.
#[test]
fn a_winch_holds_a_tension() -> Result<()> {
    let hold = |length: &str, tension: f64| -> Result<f64> {
        let line = format!("length = {length}\nwinch = {{ hold_tension = {tension}, rate_limit = 0.05 }}");
        let mut sim = scene_simulation::<2>(&standing().replacen("length = 0.75", &line, 1))?;
        let mean = time_mean(&mut sim, 5.0, 5.5, |sim| [sim.mooring_reading(0).end_forces[0].norm()])?;
        Ok(mean[0])
    };
    let start = scene_simulation::<2>(&standing())?.mooring_reading(0).end_forces[0].norm();
    for (length, tension) in [("0.75", 1.2 * start), ("0.7", start)] {
        let held = hold(length, tension)?;
        assert!((held / tension - 1.0).abs() < 0.01, "{held} N, not {tension} N, from {length} m on");
    }
    Ok(())
}

/// A loop of chain that a carriage tows through water of a periodic channel, over a bed without friction.
const TOWED: &str = r#"
dimension = 2
dp = 0.02
until = 0.9
periodic = { x = [0.0, 1.6] }
water = [{ fill = { box = { min = [0.0, 0.0], max = [1.6, 0.3] } } }]
model = { slip = "free" }
[[solid]]
name = "bed"
fixed = true
shape = { box = { size = [6.0, 0.1] } }
at = { x = 0.8, y = -0.05 }
[[solid]]
name = "carriage"
shape = { box = { size = [0.3, 0.06] } }
at = { x = 0.5, y = 0.6 }
driven = { along = [1.0, 0.0], distance = { formula = "0.5*(t-sin(2*pi*t)/(2*pi))" } }
[[solid]]
name = "other"
shape = { box = { size = [0.1, 0.06] } }
at = { x = 0.7, y = 0.6 }
driven = { along = [1.0, 0.0], distance = { formula = "0.5*(t-sin(2*pi*t)/(2*pi))" } }
[[line_type]]
name = "chain"
diameter = 0.04
mass_per_length = 1.0
stiffness = 2e3
[[mooring]]
name = "loop"
between = ["carriage", "other"]
from = [0.5, 0.57]
to = [0.7, 0.57]
length = 1.0
line = "chain"
acts_on_water = true
"#;

/// What the carriage gives to a line is in the line and in the water, within 1 % of the water's share. The bed has no friction, but its rows
/// of particles exchange momentum with water at rest: up to 2.5 mm/s after a second, which is why the test ends before. If the line does
/// not act on the water, the water stays at rest.
#[test]
fn a_towed_line_and_the_water_hold_the_impulse_that_it_is_given() -> Result<()> {
    let towed = |text: &str| -> Result<[f64; 3]> {
        let mut sim = scene_simulation::<2>(text)?;
        let (mut given, mut in_line) = (0.0, 0.0);
        while sim.time() < 0.9 {
            let (t, before) = (sim.time(), sim.mooring_reading(0).nodes);
            sim.step_to(0.9)?;
            let (dt, reading) = (sim.time() - t, sim.mooring_reading(0));
            given -= reading.end_forces.iter().map(|force| force[0]).sum::<f64>() * dt;
            let last = before.len() - 1;
            let mass = |i: usize| 1.0 / last as f64 * if i == 0 || i == last { 0.5 } else { 1.0 };
            in_line = (0..=last).map(|i| mass(i) * (reading.nodes[i] - before[i])[0] / dt).sum();
        }
        Ok([given, in_line, water_momentum(&sim)[0]])
    };
    let [given, in_line, in_water] = towed(TOWED)?;
    let gap = (given - in_line - in_water).abs();
    let text = format!("{given} N s given, {in_line} N s in the line, {in_water} N s in the water");
    assert!(in_water > 0.2 && gap < 0.01 * in_water, "{text}");
    let [given, _, in_water] = towed(&TOWED.replace("acts_on_water = true", ""))?;
    assert!(given > 0.3 && in_water.abs() < 1e-2 * given, "{given} N s given, {in_water} N s in the water");
    Ok(())
}

/// The energy that a towed line gives to the water is in the budget as `coupling`, and the budget closes within 2 % of it. A line that does
/// not act on the water gives nothing.
#[test]
fn the_energy_that_a_line_gives_to_the_water_is_in_the_budget() -> Result<()> {
    for acts in [true, false] {
        let mut sim =
            scene_simulation::<2>(&TOWED.replace("acts_on_water = true", &format!("acts_on_water = {acts}")))?;
        sim.enable_energy_budget();
        let probe = EnergyBudgetProbe::new(sim.system());
        run_to(&mut sim, 0.9)?;
        let (given, row) = (sim.energy_budget().unwrap().coupling, probe.sample(&sim));
        let residual = row.last().unwrap().abs();
        if acts {
            assert!(given > 5e-3 && residual < 0.02 * given, "{given} J/m given, {residual} J/m remain");
        } else {
            assert!(given == 0.0, "{given} J/m given");
        }
    }
    Ok(())
}

/// Across a symmetry plane the water has an image and the line has none: a line that acts on the water is refused there.
#[test]
fn a_line_that_acts_on_mirrored_water_is_refused() {
    let text = MOORED.replacen("length = 0.75", "length = 0.75\nacts_on_water = true", 1);
    let text =
        text.replace(", velocity = [0.2, 0.0]", "").replacen("until = 0.4", "until = 0.4\nsymmetry = { x = 0.8 }", 1);
    let error = scene_simulation::<2>(&text).err().expect("refused").to_string();
    assert!(error.contains("acts on the water") && error.contains("acts_on_water = false"), "{error}");
}

/// The box in three dimensions.
const SPATIAL: &str = r#"
dimension = 3
dp = 0.04
until = 1.0
water = [{ fill = { box = { min = [0.0, 0.0, 0.0], max = [0.8, 0.48, 0.24] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.8, 0.48, 0.48] } }
[[solid]]
name = "box"
shape = { box = { size = [0.24, 0.2, 0.12] } }
at = { x = 0.4, y = 0.24, draft = "equilibrium" }
free = { density = 500.0, velocity = [0.1, 0.0, 0.0] }
[[line_type]]
name = "chain"
diameter = 0.008
mass_per_length = 0.3
stiffness = 2e3
bed_friction = 0.4
[[mooring]]
name = "west"
between = ["box"]
from = [0.28, 0.24, 0.24]
to = [0.04, 0.2, 0.0]
length = 0.42
line = "chain"
[[mooring]]
name = "east"
between = ["box"]
from = [0.52, 0.24, 0.24]
to = [0.76, 0.3, 0.0]
length = 0.42
line = "chain"
"#;

/// Asserts that a scene has the same bits on one, two and three threads, and if it is resumed halfway.
fn has_the_same_bits<const D: usize>(text: &str) -> Result<()>
where
    Dim<D>: Dimension<D>,
{
    let run = |threads: usize| {
        on_threads(threads, || -> Result<[Vec<u8>; 2]> {
            let mut sim = scene_simulation::<D>(text)?;
            steps(&mut sim, 60);
            let half = sim.save()?;
            steps(&mut sim, 60);
            Ok([half, sim.save()?])
        })
    };
    let [half, whole] = run(1)?;
    for threads in [2, 3] {
        assert!(run(threads)? == [half.clone(), whole.clone()], "{threads} threads");
    }
    let mut resumed = scene_simulation::<D>(text)?;
    resumed.restore(&half)?;
    steps(&mut resumed, 60);
    assert!(resumed.save()? == whole, "a resumed run");
    Ok(())
}

/// Lines, lines that act on the water under both time schemes, and a winch do not depend on threads or restarts.
#[test]
fn moored_scenes_have_the_same_bits_on_any_number_of_threads_and_after_a_restart() -> Result<()> {
    let acting = |text: &str, length: &str| {
        let keys = format!("{length}\nacts_on_water = true\nwinch = {{ hold_tension = 3.0, rate_limit = 0.1 }}");
        text.replacen(length, &keys, 1)
    };
    let planar = acting(MOORED, "length = 0.75");
    has_the_same_bits::<2>(MOORED)?;
    has_the_same_bits::<2>(&planar)?;
    has_the_same_bits::<2>(&format!("{planar}\n[time]\nscheme = {{ verlet = {{ euler_every = 20 }} }}\n"))?;
    has_the_same_bits::<3>(SPATIAL)?;
    has_the_same_bits::<3>(&acting(SPATIAL, "length = 0.42"))
}

/// Two anchor legs and a hawser that meet in a weight.
const BRIDLE: &str = r#"
[[mooring_point]]
name = "joint"
at = [0.45, 0.15]
mass = 0.1
volume = 2e-5
[[mooring]]
name = "hawser"
between = ["box", "joint"]
from = [0.65, 0.3]
length = 0.3
line = "chain"
segments = 8
[[mooring]]
name = "leg"
between = ["joint"]
to = [0.2, 0.0]
length = 0.3
line = "chain"
segments = 8
[[mooring]]
name = "short-leg"
between = ["joint"]
to = [0.35, 0.0]
length = 0.2
line = "chain"
segments = 6
"#;

/// At rest the pulls of the lines that meet carry the weight of the point, and in motion the momentum of the box closes with them.
#[test]
fn lines_meet_in_a_point() -> Result<()> {
    let mut sim = scene_simulation::<2>(&format!("{MOORED}{BRIDLE}"))?;
    let lines: Vec<_> = (2..5).map(|line| sim.mooring_reading(line)).collect();
    // The node of the point carries half a segment of each line beside its own weight.
    let segments = [0.3 / 8.0, 0.3 / 8.0, 0.2 / 6.0];
    let weight = (0.1 - 1000.0 * 2e-5) * 9.81 + WEIGHT * 0.5 * segments.iter().sum::<f64>();
    let pull = -(lines[0].end_forces[1] + lines[1].end_forces[0] + lines[2].end_forces[0]);
    let lying = lines.iter().any(|line| line.nodes.last() == lines[0].nodes.last() && line.on_bed > 0.0);
    assert!(pull[0].abs() < 1e-3 * weight, "no pull to a side: {pull}");
    assert!(lying || (pull[1] / -weight - 1.0).abs() < 0.02, "the lines bear {pull}, and {weight} N weigh");
    sim.enable_load_breakdown();
    run_to(&mut sim, 0.1)?;
    let shares = sim.load_breakdown(1).unwrap();
    let size = shares.kinds().into_iter().map(|(_, load)| load.force.norm()).fold(0.0, f64::max);
    assert!(shares.residual().force.norm() < 1e-9 * size, "{}", shares.residual().force);
    let ends = [sim.mooring_reading(2).nodes[8], sim.mooring_reading(3).nodes[0], sim.mooring_reading(4).nodes[0]];
    assert!(ends[0] == ends[1] && ends[0] == ends[2], "the ends are in one place: {ends:?}");
    Ok(())
}

/// Faulty points, tables and winches are refused with their line and the remedy.
#[test]
fn faulty_points_and_tables_are_refused() {
    let whole = format!("{MOORED}{BRIDLE}");
    let message = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        let text = whole.replacen(from, to, 1);
        let built = Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.build::<2>());
        built.err().unwrap_or_else(|| panic!("{to} is accepted")).to_string()
    };
    assert!(
        message("between = [\"joint\"]\nto = [0.2", "between = [\"joint\"]\nfrom = [0.4, 0.1]\nto = [0.2")
            .contains("leave out from")
    );
    assert!(
        message("between = [\"box\", \"joint\"]\nfrom = [0.65, 0.3]", "between = [\"box\", \"joint\"]")
            .contains("from is missing")
    );
    assert!(message("name = \"leg\"", "name = \"leg\"\nuntil = 0.2").contains("leave out since and until"));
    assert!(message("name = \"joint\"", "name = \"box\"").contains("a solid is called"));
    assert!(message("mass = 0.1", "mass = -0.1").contains("mass must be 0 or more"));
    assert!(message("stiffness = 2e3", "stiffness = [[0.0, 1.0], [0.1, 2.0]]").contains("[0, 0]"));
    assert!(message("length = 0.75", "length = 0.75\npaid_out = { formula = \"0.1*\" }").contains("formula"));
    let lonely = "[[mooring_point]]\nname = \"lonely\"\nat = [0.5, 0.1]\n[[mooring_point]]\nname = \"joint\"";
    assert!(message("[[mooring_point]]\nname = \"joint\"", lonely).contains("joins 0 lines"));
}

/// What a user may get wrong is refused with its line and the remedy.
#[test]
fn faulty_moorings_are_refused() {
    let message = |from: &str, to: &str| {
        assert!(MOORED.contains(from), "{from}");
        let text = MOORED.replacen(from, to, 1);
        let built = Scene::parse(&text, Path::new(""), &[]).and_then(|scene| scene.build::<2>());
        let error = built.err().unwrap_or_else(|| panic!("{to} is accepted")).to_string();
        assert!(error.contains("scene.toml"), "the place is missing: {error}");
        error
    };
    let near = message("line = \"chain\"", "line = \"chian\"");
    assert!(near.contains("chain") && near.contains("no line type"), "{near}");
    let short = message("length = 0.75", "length = 0.4");
    assert!(short.contains("length = 0.6265"), "{short}");
    assert!(message("mass_per_length = 0.3", "mass_per_length = -0.3").contains("mass_per_length"));
    let winch = |keys: &str| message("length = 0.75", &format!("length = 0.75\nwinch = {{ {keys} }}"));
    assert!(winch("rate_limit = 0.1").contains("holds nothing"));
    assert!(winch("hold_tension = 5.0, hold_length = 0.7, rate_limit = 0.1").contains("not both"));
    assert!(winch("hold_length = 0.7, rate_limit = 0.1, gain = 1.0").contains("leave out gain"));
    assert!(winch("hold_tension = -5.0, rate_limit = 0.1").contains("hold_tension"));
    assert!(winch("hold_length = 0.7, rate_limit = 0.1, shortest = 0.72").contains("from 0.72 m"));
    assert!(winch("hold_tension = 5.0, rate_limit = 0.1 }\npaid_out = { formula = \"0\"").contains("leave out one"));
    assert!(winch("hold_tension = 5.0, rate_limit = 0.1 }\nbreaks = { tension = 4.0").contains("hold_tension = 2"));
    assert!(message("between = [\"box\"]", "between = [\"tank\"]").contains("moves"));
    assert!(message("between = [\"box\"]", "between = [\"boks\"]").contains("box"));
    assert!(message("length = 0.75", "length = 0.75\nclumps = [{ at = 0.8, mass = 1.0 }]").contains("0.75 m long"));
    let heavy = message("length = 0.75", "length = 0.75\nclumps = [{ at = 0.0, mass = 5.0 }]");
    assert!(heavy.contains("a tenth"), "{heavy}");
}
