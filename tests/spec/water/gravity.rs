//! Gravity by a number, a formula or a table: slopes, sloshing and the energy budget.

use pontoon::{
    Result,
    probe::{ElevationProbe, EnergyBudgetProbe, Probe},
    scene::Scene,
    simulation::Simulation,
};

use crate::common::{TestFolder, run_to, scene_simulation};

/// A tank of 0.4 m with water 0.2 m deep; `GRAVITY` and `TANK` are replaced.
const TANK: &str = r#"
dimension = 2
dp = 0.02
until = 4.0
GRAVITY
water = [{ fill = { box = { min = [0.0, 0.0], max = [0.4, 0.2] } } }]
[[solid]]
name = "tank"
MOTION
shape = { tank = { size = [0.4, 0.4] } }
"#;

fn scene(gravity: &str, motion: &str) -> String {
    TANK.replace("GRAVITY", gravity).replace("MOTION", motion)
}

#[test]
fn a_surface_inclines_by_the_ratio_of_accelerations() -> Result<()> {
    // A horizontal acceleration grows smoothly over nearly three periods of the tank (0.75 s) to a fifth of gravity.
    let text = scene("gravity = [\"1.962*(1-cos(pi*min(t/2,1)))/2\", -9.81]", "fixed = true");
    let mut sim = scene_simulation::<2>(&text)?;
    let gauges = [0.05, 0.35].map(|x| ElevationProbe::new(sim.system(), &[x]).unwrap());
    run_to(&mut sim, 2.0)?;
    let (mut sum, mut count) = (0.0, 0.0);
    while sim.time() < 3.5 {
        let next = sim.time() + 0.025;
        run_to(&mut sim, next)?;
        let [low, high] = [0, 1].map(|i| gauges[i].sample(&sim)[0]);
        (sum, count) = (sum + (high - low) / 0.3, count + 1.0);
    }
    // tan = a/g = 0.2; a twentieth of the particle spacing over 0.3 m is 0.003, the remaining swing averages out.
    assert!((sum / count - 0.2_f64).abs() < 0.01, "{}", sum / count);
    assert!((sim.system().gravity()[0] - 1.962).abs() < 1e-12);
    Ok(())
}

#[test]
fn sloshing_under_swinging_gravity_is_that_of_a_driven_tank() -> Result<()> {
    // The tank goes by A (1 − cos ω t); in its frame the acceleration −A ω² cos ω t acts.
    let (amplitude, omega) = (0.01, 6.0);
    let gravity = format!("gravity = [\"-{amplitude}*{omega}^2*cos({omega}*t)\", \"-9.81\"]");
    let motion =
        format!("driven = {{ along = [1.0, 0.0], distance = {{ formula = \"{amplitude}*(1-cos({omega}*t))\" }} }}");
    let mut still = scene_simulation::<2>(&scene(&gravity, "fixed = true"))?;
    let mut driven = scene_simulation::<2>(&scene("gravity = 9.81", &motion))?;
    let gauge = ElevationProbe::new(still.system(), &[0.05])?;
    let moving = ElevationProbe::on_solid(driven.system(), "tank", &[0.05])?;
    let (mut most, mut off) = (0.0_f64, 0.0_f64);
    for i in 1..=80 {
        let t = 0.025 * f64::from(i);
        run_to(&mut still, t)?;
        run_to(&mut driven, t)?;
        let (a, b) = (gauge.sample(&still)[1], moving.sample(&driven)[1]);
        (most, off) = (most.max(a.abs()), off.max((a - b).abs()));
    }
    assert!(most > 0.02, "the water sloshes: {most}");
    // Both differ by the delay of the walls of a driven tank, some steps.
    assert!(off < 0.05 * most, "{off} of {most}");
    Ok(())
}

#[test]
fn the_energy_budget_closes_under_swinging_gravity_and_a_restart_keeps_the_bits() -> Result<()> {
    let body = "[[solid]]\nname = \"float\"\nshape = { box = { size = [0.1, 0.08] } }\nat = { x = 0.2, draft = \"equilibrium\" }\n\
                free = { density = 500.0 }\n";
    let text = scene("gravity = [\"2*sin(9*t)\", \"-9.81*(1+0.2*sin(5*t))\"]", "fixed = true") + body;
    let make = || {
        let mut sim = scene_simulation::<2>(&text).unwrap();
        sim.enable_energy_budget();
        sim
    };
    let mut sim = make();
    let probe = EnergyBudgetProbe::new(sim.system());
    run_to(&mut sim, 0.3)?;
    let state = sim.save()?;
    run_to(&mut sim, 1.0)?;
    let mut again = make();
    again.restore(&state)?;
    assert_eq!(again.system().gravity()[0], 2.0 * (9.0 * 0.3_f64).sin());
    run_to(&mut again, 1.0)?;
    assert!(sim.save()? == again.save()?, "the states differ");
    let row = probe.sample(&sim);
    let turnover = sim.energy_budget().unwrap().entries().iter().map(|(_, energy)| energy.abs()).sum::<f64>();
    // The bound of the budgets under constant gravity.
    assert!(row[row.len() - 1].abs() < 0.01 * turnover, "{} J of {turnover} J", row[row.len() - 1]);
    Ok(())
}

#[test]
fn gravity_by_number_formula_and_table_is_the_same() -> Result<()> {
    let folder = TestFolder::with_scene("gravity-table", "");
    std::fs::write(folder.join("g.csv"), "t_s,g\n0,9.81\n1,9.81\n2,9.81\n").unwrap();
    let forms = [
        "",
        "gravity = 9.81",
        "gravity = [0, -9.81]",
        "gravity = \"9.81\"",
        "gravity = [\"0*t\", \"-9.81\"]",
        "gravity = { file = \"g.csv\", column = \"g\" }",
        "gravity = [0.0, { file = \"g.csv\", column = \"g\", scale = -1.0 }]",
    ];
    let heights = forms.map(|form| {
        let scene = Scene::parse(&scene(form, "fixed = true"), &folder, &[]).unwrap();
        let mut sim = Simulation::<2>::new(scene.build::<2>().unwrap().setup).unwrap();
        (0..20).for_each(|_| sim.step().unwrap());
        sim.system().fluid().r.to_vec()
    });
    for (form, height) in forms.iter().zip(&heights) {
        assert!(height == &heights[0], "{form}");
    }
    let refused = |form: &str| {
        Scene::parse(&scene(form, "fixed = true"), &folder, &[]).and_then(|s| s.build::<2>()).err().unwrap()
    };
    for (form, what) in [
        ("gravity = -9.81", "its strength downwards"),
        ("gravity = [0.0, 0.0, -9.81]", "gravity has 3 numbers, not 2"),
        ("gravity = [\"t\", 0.0, -9.81]", "gravity has 3 components, not 2"),
        ("gravity = [\"sinn(t)\", -9.81]", "sinn"),
        ("gravity = [{ file = \"h.csv\", column = \"g\" }, -9.81]", "h.csv"),
        ("gravity = [\"1/t\", -9.81]", "at t = 0 s"),
    ] {
        let message = refused(form).to_string();
        assert!(message.contains(what), "{form}: {message}");
    }
    Ok(())
}
