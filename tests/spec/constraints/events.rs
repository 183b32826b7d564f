//! Constraints and solids that begin, end or break during a run, as a scene says it.

use std::path::Path;

use pontoon::{
    Result,
    probe::{EnergyBudgetProbe, FrontProbe, Probe},
    scene::Scene,
    simulation::Simulation,
};

use crate::common::{run_to, scene_simulation};

/// A column of water behind a gate that is removed at 0.1 s; a line holds a float until 0.15 s, another breaks.
const GATE: &str = r#"
dimension = 2
dp = 0.02
until = 0.4
water = [{ fill = { box = { min = [0.0, 0.0], max = [0.4, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.4, 0.8] } }
[[solid]]
name = "gate"
fixed = true
until = 0.1
shape = { box = { size = [0.12, 0.6] } }
at = { x = 0.46, y = 0.3 }
"#;

const TIES: &str = r#"
[[solid]]
name = "float"
shape = { box = { size = [0.1, 0.08] } }
at = { x = 0.2, draft = "equilibrium" }
free = { density = 500.0 }
[[spring]]
name = "stay"
between = ["float"]
from = [0.2, 0.3]
to = [0.2, 0.6]
stiffness = 50.0
until = 0.15
[[spring]]
name = "latch"
between = ["float", "gate"]
from = [0.2, 0.3]
to = [0.4, 0.5]
stiffness = 20.0
[[rope]]
name = "leash"
between = ["float"]
from = [0.15, 0.3]
to = [0.0, 0.3]
since = 0.12
breaks = { tension = 1.0 }
"#;

#[test]
fn a_gate_that_is_removed_lets_the_dam_break_begin_then() -> Result<()> {
    let mut gated = scene_simulation::<2>(GATE)?;
    let particles = gated.system().fluid().len();
    run_to(&mut gated, 0.1)?;
    let speed = gated.system().fluid().v.iter().map(|v| v.norm()).fold(0.0, f64::max);
    // Still water behind the gate: under 1 % of √(g h).
    assert!(speed < 0.02, "{speed} m/s behind the gate");
    assert_eq!(gated.events()[0].to_string(), "solid \"gate\" is removed at t = 0.100000 s");
    run_to(&mut gated, 0.3)?;
    let (head, gate) = GATE.split_once("[[solid]]\nname = \"gate\"").unwrap();
    assert!(gate.contains("until = 0.1"));
    let mut open = scene_simulation::<2>(head)?;
    run_to(&mut open, 0.2)?;
    let front = |sim: &Simulation<2>| FrontProbe.sample(sim)[0];
    let (late, free) = (front(&gated), front(&open));
    assert!(free > 0.6, "the dam has broken: {free}");
    // The wall pressure of the gate leaves the water within a time of sound; one particle spacing is the resolution.
    assert!((late - free).abs() < 0.02, "front at {late} m, without a gate {free} m");
    assert_eq!(gated.system().fluid().len(), particles);
    Ok(())
}

#[test]
fn a_run_with_events_continues_with_the_same_bits_before_and_after_them() -> Result<()> {
    let text = [GATE, TIES].concat();
    let make = || {
        let mut sim = scene_simulation::<2>(&text).unwrap();
        sim.enable_energy_budget();
        sim
    };
    let mut whole = make();
    let mut states = Vec::new();
    // Steps end at these times, in the resumed runs too.
    let stops = [0.05, 0.11, 0.14, 0.2, 0.35];
    for time in stops {
        run_to(&mut whole, time)?;
        states.push(whole.save()?);
    }
    let last = whole.save()?;
    let _ = whole.save();
    for (k, state) in states.iter().enumerate() {
        let mut again = make();
        again.restore(state)?;
        stops[k + 1..].iter().try_for_each(|time| run_to(&mut again, *time))?;
        assert_eq!(again.events(), whole.events());
        assert!(again.save()? == last, "the states differ");
        let _ = again.save();
    }
    let texts: Vec<String> = whole.events().iter().map(ToString::to_string).collect();
    let begins = [
        "spring \"latch\" is released at t = 0.100000 s",
        "solid \"gate\" is removed at t = 0.100000 s",
        "rope \"leash\" is connected at t = 0.120000 s",
        "spring \"stay\" is released at t = 0.150000 s",
        "rope \"leash\" breaks at t = ",
    ];
    for begin in begins {
        assert!(texts.iter().any(|text| text.starts_with(begin)), "{begin}: {texts:?}");
    }
    assert_eq!(whole.rope_reading(0).tension, 0.0);
    Ok(())
}

#[test]
fn the_energy_budget_closes_over_events() -> Result<()> {
    let mut sim = scene_simulation::<2>(&[GATE, TIES].concat())?;
    sim.enable_energy_budget();
    let probe = EnergyBudgetProbe::new(sim.system());
    run_to(&mut sim, 0.35)?;
    let row = probe.sample(&sim);
    let turnover = sim.energy_budget().unwrap().entries().iter().map(|(_, energy)| energy.abs()).sum::<f64>();
    // The bound of the budgets without events.
    assert!(row[row.len() - 1].abs() < 0.01 * turnover, "{} J of {turnover} J", row[row.len() - 1]);
    Ok(())
}

#[test]
fn lifetimes_and_strengths_that_cannot_be_meant_are_refused() {
    let message = |from: &str, to: &str| {
        let text = [GATE, TIES].concat();
        assert!(text.contains(from), "{from}");
        let scene = Scene::parse(&text.replace(from, to), Path::new(""), &[]);
        scene.and_then(|scene| scene.build::<2>()).map(|_| ()).unwrap_err().to_string()
    };
    let line = "until = 0.15";
    let cases = [
        (line, "since = 0.2\nuntil = 0.15", "nothing lies between since = 0.2 and until = 0.15"),
        (line, "since = -1.0", "since = -1"),
        (line, "until = 0.0", "until must be a positive number"),
        (line, "breaks = { force = 3.0 }", "force has no meaning here"),
        (line, "breaks = {}", "no load is given"),
        (line, "breaks = -3.0", "breaks must be a positive number"),
        (line, "fails_at = 1.0", "fails_at"),
        ("until = 0.1\n", "until = -0.1\n", "until must be a positive number"),
    ];
    for (from, to, what) in cases {
        let message = message(from, to);
        assert!(message.contains(what), "{to}: {message}");
    }
    let number = [GATE, TIES].concat().replace(line, "breaks = 300");
    assert!(scene_simulation::<2>(&number).is_ok(), "a number is the tension");
}
