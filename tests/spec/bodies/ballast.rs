//! Ballast: masses at points of a body that change with time. Motion in vacuum, drafts and heel at rest, load breakdown,
//! energy budget and restart.

use pontoon::{
    Result,
    math::Vector,
    probe::{EnergyBudgetProbe, MotionProbe, Probe},
    run,
    scene::Scene,
    simulation::Simulation,
    solid::{FreeBody, Kinematics, Load},
};

use crate::common::{TestFolder, run_to, scene_simulation, time_mean};

/// A pool far below a body in vacuum without gravity; `BODY` is replaced.
const VACUUM: &str = r#"
dimension = 2
dp = 0.05
until = 4.0
gravity = 0.0
model = { c0 = 10.0 }
domain = { min = [-9.0, -9.0], max = [9.0, 9.0] }
water = [{ fill = { box = { min = [0.0, 0.0], max = [0.3, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [0.3, 0.4] } }
[[solid]]
name = "body"
shape = { box = { size = [0.2, 0.2] } }
at = { x = 3.0, y = 3.0 }
BODY
"#;

/// A basin of 1 m with water 0.3 m deep; `BODY` is replaced.
const BASIN: &str = r#"
dimension = 2
dp = 0.01
until = 4.0
water = [{ fill = { box = { min = [0.0, 0.0], max = [1.0, 0.3] } } }]
[[solid]]
name = "tank"
fixed = true
shape = { tank = { size = [1.0, 0.5] } }
[[solid]]
name = "body"
BODY
"#;

fn vacuum(body: &str) -> Result<Simulation<2>> {
    scene_simulation(&VACUUM.replace("BODY", body))
}

/// Velocity (m/s) of the point of a body at the world position `x` (m).
fn velocity_at(motion: &Kinematics<2>, x: &Vector<2>) -> Vector<2> {
    motion.velocity + motion.spin.0 * (x - motion.centre)
}

#[test]
fn the_period_on_a_spring_grows_with_the_root_of_the_mass() -> Result<()> {
    let mut sim = vacuum(
        "free = { mass = 4.0, velocity = [1.0, 0.0], locked = [\"y\", \"turn\"], ballast = [{ at = [0.0, 0.0], mass = \
         \"12*min(max(50*(t-1.5),0),1)\" }] }\n[[spring]]\nname = \"line\"\nbetween = [\"body\"]\nfrom = [3.0, 3.0]\n\
         to = [1.0, 3.0]\nstiffness = 400.0",
    )?;
    let (mut crossings, mut before) = (Vec::new(), 0.0);
    while sim.time() < 4.0 {
        let t = sim.time();
        sim.step_to(4.0)?;
        let now = sim.system().solids()[1].kinematics.centre[0] - 3.0;
        if before * now < 0.0 {
            crossings.push(t + (sim.time() - t) * before / (before - now));
        }
        before = now;
    }
    let period = |from: f64, until: f64| {
        let own: Vec<f64> = crossings.iter().copied().filter(|t| (from..until).contains(t)).collect();
        2.0 * (own[own.len() - 1] - own[0]) / (own.len() - 1) as f64
    };
    // 2π √(m/k): 0.6283 s of 4 kg, and twice that of 16 kg. Steps limit the period to 0.2 % (SPRING_STEP).
    let exact = std::f64::consts::TAU * 0.1;
    let found = [period(0.0, 1.5), period(1.52, 4.0)];
    assert!((found[0] / exact - 1.0).abs() < 2e-3, "{} s, exactly {exact} s", found[0]);
    assert!((found[1] / (2.0 * exact) - 1.0).abs() < 2e-3, "{} s, exactly {} s", found[1], 2.0 * exact);
    Ok(())
}

#[test]
fn mass_that_arrives_and_leaves_changes_the_velocity_of_no_point() -> Result<()> {
    let mut sim = vacuum(
        "free = { mass = 4.0, velocity = [0.5, -0.2], spin = 3.0, ballast = [{ at = [0.1, 0.05], mass = \"6*max(0,\
         min(t,1-t))\" }] }",
    )?;
    sim.enable_load_breakdown();
    sim.enable_energy_budget();
    let body = |sim: &Simulation<2>| (sim.system().solids()[1].kinematics, sim.system().solids()[1].body.unwrap());
    let (start, own) = body(&sim);
    let energy_of = |motion: &Kinematics<2>, mass: &FreeBody<2>| {
        0.5 * (mass.mass * motion.velocity.norm_squared() + mass.inertia[(0, 0)] * motion.spin.axial()[0].powi(2))
    };
    let mut brought = Load::zero();
    let mut largest = 0.0_f64;
    while sim.time() < 1.2 {
        let (before, _) = body(&sim);
        sim.step_to(1.2)?;
        let (now, mass) = body(&sim);
        largest = largest.max(mass.mass);
        assert_eq!(now.spin, start.spin, "no torque acts");
        // The centre before the change has moved on its straight line; its velocity has not changed.
        let carried = before.centre + before.velocity * sim.dt();
        let off = (velocity_at(&now, &carried) - before.velocity).norm();
        assert!(off < 1e-12, "{off} m/s at {} s", sim.time());
        let breakdown = sim.load_breakdown(1).unwrap();
        brought += breakdown.ballast * sim.dt();
        let residual = breakdown.residual();
        assert!(residual.force.norm() + residual.torque.0.norm() < 1e-9, "{residual:?}");
    }
    assert!((largest - 7.0).abs() < 0.01, "{largest} kg");
    let (end, mass) = body(&sim);
    assert_eq!(mass, own, "all of it has left");
    // Momentum and angular momentum that came and went are those that the body has more.
    let gained = (end.velocity - start.velocity) * own.mass;
    assert!((gained - brought.force).norm() < 1e-12, "{gained:?} and {:?}", brought.force);
    let budget = sim.energy_budget().unwrap();
    let more = energy_of(&end, &mass) - energy_of(&start, &own);
    assert!((budget.solids - more).abs() < 1e-12, "{} J and {more} J", budget.solids);
    assert!(more.abs() > 0.01, "mass came and left at different velocities: {more} J");
    Ok(())
}

#[test]
fn a_box_that_takes_ballast_sinks_to_the_draft_of_archimedes() -> Result<()> {
    let mut sim = scene_simulation::<2>(&BASIN.replace(
        "BODY",
        "shape = { box = { size = [0.2, 0.16] } }\nat = { x = 0.5, draft = \"equilibrium\" }\nfree = { density = 500.0, locked = \
         [\"x\", \"turn\"], ballast = [{ at = [0.0, -0.05], mass = \"2*(1-cos(pi*min(t,1)))\" }] }",
    ))?;
    let probe = MotionProbe::new(sim.system(), "body")?;
    let [heave] = time_mean(&mut sim, 2.5, 4.0, |sim| [probe.sample(sim)[3]])?;
    // 4 kg/m displace 0.004 m²: the draft grows by 0.02 m, and the level of the basin by 0.004 m. A tenth of dp is the
    // bound of floats on the lattice.
    assert!((heave + 0.016).abs() < 0.001, "it sinks by {} m, exactly 0.016 m", -heave);
    Ok(())
}

#[test]
fn ballast_beside_the_middle_lists_a_box_by_the_hydrostatic_angle() -> Result<()> {
    let mut sim = scene_simulation::<2>(&BASIN.replace(
        "BODY",
        "shape = { box = { size = [0.4, 0.16] } }\nat = { x = 0.5, draft = \"equilibrium\" }\nfree = { density = 500.0, ballast = \
         [{ at = [0.1, -0.05], mass = \"2*(1-cos(pi*min(t,1)))\" }] }\n[[damping]]\nfrom = [0.15, 0.0]\nto = [0.0, 0.0]\n\
         [[damping]]\nfrom = [0.85, 0.0]\nto = [1.0, 0.0]",
    ))?;
    let probe = MotionProbe::new(sim.system(), "body")?;
    let [pitch] = time_mean(&mut sim, 2.0, 4.0, |sim| [probe.sample(sim)[4]])?;
    // Wall-sided box of 36 kg/m: draft 0.09 m, KB 0.045 m, BM 0.4²/(12·0.09), KG (32·0.08 + 4·0.03)/36, and its weight
    // 4·0.1/36 beside the middle: tan φ (GM + ½ BM tan² φ) = 0.4/36.
    let (bm, kg) = (0.16 / (12.0 * 0.09), (32.0 * 0.08 + 4.0 * 0.03) / 36.0);
    let gm = 0.045 + bm - kg;
    let mut tan = 0.0_f64;
    for _ in 0..50 {
        tan = 0.4 / 36.0 / (gm + 0.5 * bm * tan * tan);
    }
    let exact = -tan.atan().to_degrees();
    // An error of the draft of a tenth of dp on both sides is a heel of 0.001/0.2: 0.3°.
    assert!((pitch - exact).abs() < 0.3, "{pitch}°, exactly {exact}°");
    Ok(())
}

/// Scenes of a body that is light before it takes ballast beside its middle, so that it has acoustic added mass.
fn foam() -> Simulation<2> {
    let text = BASIN.replace("dp = 0.01", "dp = 0.02").replace(
        "BODY",
        "shape = { box = { size = [0.2, 0.08] } }\nat = { x = 0.5, draft = 0.03 }\nfree = { density = 40.0, ballast = [{ at = \
         [0.06, 0.0], mass = \"6*max(0,min(min(t-0.1,1),1.5-t))\" }, { at = [-0.05, 0.02], mass = 0.5 }] }",
    );
    let mut sim = scene_simulation::<2>(&text).unwrap();
    sim.enable_energy_budget();
    sim.enable_load_breakdown();
    sim
}

#[test]
fn momentum_and_energy_are_accounted_for_and_a_restart_keeps_the_bits() -> Result<()> {
    let mut sim = foam();
    let probe = EnergyBudgetProbe::new(sim.system());
    let mut most = 0.0_f64;
    let mut pending = 0.0_f64;
    let mut state = Vec::new();
    while sim.time() < 1.6 {
        sim.step_to(1.6)?;
        if state.is_empty() && sim.time() > 0.6 {
            state = sim.save()?;
        }
        let breakdown = sim.load_breakdown(1).unwrap();
        let size = breakdown.kinds().iter().map(|(_, load)| load.force.norm()).fold(0.0, f64::max);
        most = most.max(breakdown.residual().force.norm() / size);
        pending = pending.max(sim.pending_impulse(1).norm());
    }
    assert!(pending > 0.0, "the foam has acoustic added mass");
    // The bound of the load breakdown of other bodies: round-off.
    assert!(most < 1e-9, "the residual is {most} of the largest load");
    let row = probe.sample(&sim);
    let turnover = sim.energy_budget().unwrap().entries().iter().map(|(_, energy)| energy.abs()).sum::<f64>();
    // The bound of the budgets of bodies of constant mass.
    assert!(row[row.len() - 1].abs() < 0.01 * turnover, "{} J of {turnover} J", row[row.len() - 1]);
    let mut again = foam();
    again.restore(&state)?;
    assert!(again.save()? == state, "a restored state saves to the same bytes");
    run_to(&mut again, 1.6)?;
    assert!(sim.save()? == again.save()?, "the states differ");
    assert_eq!(sim.system().solids()[1].body, again.system().solids()[1].body);
    Ok(())
}

#[test]
fn inspect_tells_the_mass_at_the_start_and_the_largest() -> Result<()> {
    let text = BASIN.replace(
        "BODY",
        "shape = { box = { size = [0.2, 0.16] } }\nat = { x = 0.5, draft = \"equilibrium\" }\nfree = { density = 500.0, ballast = \
         [{ at = [0.0, -0.05], mass = \"4-t\" }] }",
    );
    let folder = TestFolder::with_scene("ballast-inspect", &text);
    let found = run::inspect(&folder.join("scene.toml"), &run::InspectOptions::default())?;
    let body = &found.report().unwrap().preflight.bodies[0];
    // 20 kg/m at a draft of 0.1 m.
    assert!((body.mass_kg - 20.0).abs() < 1e-12 && (body.largest_mass_kg.unwrap() - 20.0).abs() < 1e-12, "{body:?}");
    assert!((body.draft_m - 0.1).abs() < 1e-9 && (body.afloat.as_ref().unwrap().draft_m - 0.1).abs() < 1e-9);
    Ok(())
}

#[test]
fn ballast_by_number_formula_and_table_is_the_same_and_what_cannot_be_is_refused() {
    let folder = TestFolder::with_scene("ballast-table", "");
    std::fs::write(folder.join("m.csv"), "t_s,kg,less\n0,3,1\n1,3,-1\n4,3,-2\n").unwrap();
    let scene = |ballast: &str, role: &str| {
        let body = format!(
            "shape = {{ box = {{ size = [0.2, 0.16] }} }}\nat = {{ x = 0.5, draft = 0.05 }}\n{role} ballast = [{ballast}] }}"
        );
        BASIN.replace("dp = 0.01", "dp = 0.02").replace("BODY", &body)
    };
    let build = |ballast: &str, role: &str| Scene::parse(&scene(ballast, role), &folder, &[])?.build::<2>();
    let free = "free = { density = 300.0,";
    let forms = ["3.0", "\"3\"", "\"3+0*t\"", "{ file = \"m.csv\", column = \"kg\" }"];
    let heights = forms.map(|form| {
        let setup = build(&format!("{{ at = [0.02, 0.0], mass = {form} }}"), free).unwrap().setup;
        let mut sim = Simulation::<2>::new(setup).unwrap();
        (0..20).for_each(|_| sim.step().unwrap());
        sim.system().solids()[1].kinematics
    });
    for (form, height) in forms.iter().zip(&heights) {
        assert!(height == &heights[0], "{form}");
    }
    for (ballast, what) in [
        ("{ at = [0.0, 0.0], mass = -1.0 }", "a mass of -1 kg at t = 0 s"),
        ("{ at = [0.0, 0.0], mass = \"1-t\" }", "the ballast has a mass of -"),
        ("{ at = [0.0, 0.0], mass = \"1/(t-t)\" }", "the value inf at t = 0 s"),
        ("{ at = [0.0, 0.0], mass = { file = \"m.csv\", column = \"less\" } }", "at t = 1 s"),
        ("{ at = [0.0, 0.0, 0.0], mass = 1.0 }", "at has 3 numbers, not 2"),
        ("{ at = [0.0, 0.0], mas = 1.0 }", "mas"),
        ("{ at = [0.0, 0.0] }", "mass"),
    ] {
        let error = build(ballast, free).err().unwrap_or_else(|| panic!("{ballast} is accepted"));
        let message = error.to_string();
        assert!(message.contains(what), "{ballast}: {message}");
    }
}

/// A case of 1.5 kg/m with 6 kg/m in it is no light plate, and one of 0.1 kg/m with 0.7 kg/m weighs two particles.
#[test]
fn ballast_counts_in_the_weight_of_thin_and_small_bodies() -> Result<()> {
    let body = |size: &str, mass: f64, ballast: &str| {
        let free = format!("free = {{ mass = {mass:?}, ballast = [{ballast}] }}");
        let shape = format!("shape = {{ box = {{ size = {size} }} }}\nat = {{ x = 0.5, draft = \"equilibrium\" }}\n");
        scene_simulation::<2>(&BASIN.replace("BODY", &(shape + &free)).replace("dp = 0.01", "dp = 0.02"))
    };
    let inside = |mass: f64| format!("{{ at = [0.0, 0.0], mass = {mass:?} }}");
    for (size, mass, ballast) in [("[0.5, 0.026]", 1.5, 6.0), ("[0.04, 0.04]", 0.1, 0.7)] {
        assert!(body(size, mass, "").is_err(), "{size}");
        body(size, mass, &inside(ballast))?;
        body(size, mass + ballast, "")?;
    }
    Ok(())
}
