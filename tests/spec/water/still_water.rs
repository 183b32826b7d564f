//! Still water: hydrostatic pressure, constant level and small spurious velocities.

use pontoon::{
    Result,
    math::Vector,
    model::{Model, PairLoopKind, PressureGradient, Shifting, Slip, TimeScheme, Viscosity, Walls},
    probe::{PressureProbe, Probe},
    simulation::{Setup, Simulation},
    sph::{particle_shifting::Shift, viscosity::Artificial},
};

use crate::common;

const DEPTH: f64 = 0.4;
const DP: f64 = 0.02;

fn still_tank(model: Model, seconds: f64) -> Simulation<2> {
    let dp = model.dp;
    let water = common::lattice([0.0, 0.0], [0.4, DEPTH], dp);
    let mut sim = common::simulation(model, water, DEPTH, vec![common::tank([0.4, 0.6], dp)]);
    while sim.time() < seconds {
        sim.step_to(seconds).expect("still water");
    }
    sim
}

/// Mean pressure (Pa) and hydrostatic pressure of each row of water one dp high, surface and bed rows left out.
fn profile(sim: &Simulation<2>) -> Vec<(f64, f64)> {
    let (fluid, system) = (sim.system().fluid(), sim.system());
    let rows = (DEPTH / DP).round() as usize;
    (2..rows - 2)
        .map(|row| {
            let inside: Vec<usize> = (0..fluid.len()).filter(|&i| (fluid.r[i][1] / DP) as usize == row).collect();
            let n = inside.len() as f64;
            let p: f64 = inside.iter().map(|&i| system.pressure(fluid.rho[i])).sum();
            let still: f64 = inside.iter().map(|&i| 9810.0 * (DEPTH - fluid.r[i][1])).sum();
            (p / n, still / n)
        })
        .collect()
}

#[test]
fn still_water_keeps_hydrostatic_pressure_and_its_level() {
    for walls in [Walls::Dynamic, Walls::RelaxedAdami] {
        assert_hydrostatic(&still_tank(Model::water(2, DP, DEPTH).walls(walls), 5.0));
        assert_hydrostatic(&still_tank(
            Model::water(2, DP, DEPTH).walls(walls).gradient(PressureGradient::Corrected),
            5.0,
        ));
        // At h = 1.7 dp rows of the lattice rearrange occasionally and cause velocities of up to 3 % of √(g depth).
        // Dynamic walls come with the viscosity of the paper's method.
        let wide = Model::water(2, DP, DEPTH).walls(walls).h(2.0 * DP);
        let wide =
            if walls == Walls::Dynamic { wide.viscosity(Viscosity::Artificial(Artificial::default())) } else { wide };
        let mut sim = still_tank(wide, 1.0);
        while sim.time() < 5.0 {
            sim.step_to(5.0).expect("still water");
            let fastest = sim.system().fluid().v.iter().map(|v| v.norm()).fold(0.0, f64::max);
            assert!(
                fastest < 0.01 * (9.81 * DEPTH).sqrt(),
                "{walls:?}: {fastest} m/s in still water at {} s",
                sim.time()
            );
        }
        assert_hydrostatic(&sim);
    }
}

fn assert_hydrostatic(sim: &Simulation<2>) {
    for (p, still) in profile(sim) {
        // 2 % of the pressure at the bed, the project's bound for Fourtakas' term.
        assert!((p - still).abs() < 0.02 * 9810.0 * DEPTH, "{p} Pa for {still} Pa");
    }
    let fluid = sim.system().fluid();
    let mean = fluid.r.iter().map(|r| r[1]).sum::<f64>() / fluid.len() as f64;
    // The surface is at twice the mean height of the particles.
    assert!((2.0 * mean - DEPTH).abs() < 0.5 * DP, "level {}", 2.0 * mean);
    // Weight of the water on the tank, N/m, within the fluctuation of a sound wave.
    let weight = sim.system().solids()[0].load.force[1];
    assert!((weight / (-9810.0 * 0.4 * DEPTH) - 1.0).abs() < 0.02, "{weight} N/m");
}

#[test]
fn verlet_and_particle_shifting_keep_the_level_of_still_water() {
    for (scheme, shifting) in [
        (TimeScheme::Verlet { euler_every: 50 }, Shifting::None),
        (TimeScheme::Symplectic, Shifting::Everywhere(Shift::default())),
    ] {
        let dp = 0.04;
        let mut model = Model::water(2, dp, DEPTH);
        (model.scheme, model.shifting, model.walls) = (scheme, shifting, Walls::Dynamic);
        if scheme != TimeScheme::Symplectic {
            model.cfl = 0.2;
        }
        let sim = still_tank(model, 1.0);
        let fluid = sim.system().fluid();
        let mean = fluid.r.iter().map(|r| r[1]).sum::<f64>() / fluid.len() as f64;
        assert!((2.0 * mean - DEPTH).abs() < 0.5 * dp, "{scheme:?} {shifting:?}: level {}", 2.0 * mean);
    }
}

/// Slip acts through viscosity alone: without it, water that flows along walls into corners has the rates of free slip. Bound: rounding of
/// the sums in double precision, over the largest rate. (Runs differ by 10⁻³ dp, because the steps differ.)
#[test]
fn without_viscosity_water_slips_whatever_the_slip() {
    let dp = 0.02;
    for walls in [Walls::Dynamic, Walls::RelaxedAdami] {
        let rates = |slip: Slip| {
            let mut model = Model::water(3, dp, 0.1).walls(walls).slip(slip).viscosity(Viscosity::None);
            model.pair_loop = PairLoopKind::Reference;
            let water = common::lattice([0.0, 0.0, 0.0], [0.1, 0.08, 0.1], dp);
            let setup = Setup::new(model).water(water, 0.1).solids(vec![common::tank([0.1, 0.08, 0.2], dp)]);
            let setup = setup.velocity(|r| Vector::from([r[2] + 0.3, 0.2 - r[0], 0.1]));
            let mut sim = Simulation::new(setup).expect("a sound setup");
            sim.update_rates();
            let system = sim.system();
            (0..system.fluid().len()).map(|i| system.fluid_density_rate(i)).collect::<Vec<_>>()
        };
        let (free, none) = (rates(Slip::Free), rates(Slip::None));
        let largest = free.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
        let off = free.iter().zip(&none).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest;
        println!("{walls:?}: off by {off} of {largest} kg/m³/s");
        assert!(largest > 100.0 && off < 1e-9, "{walls:?}: rates are off by {off} of the largest, {largest} kg/m³/s");
    }
}

/// Still water that sticks to its tank moves no more than water that slips. When the dragging velocities of edges and corners compressed
/// the water, its kinetic energy was 25 times larger after 2.35 s, and the run failed.
#[test]
fn water_that_sticks_to_its_tank_stays_at_rest_in_3d() -> Result<()> {
    let energy = |slip: &str| -> Result<f64> {
        let mut sim = common::measurement("no-slip-corner", &[("model.slip", &format!("\"{slip}\""))])?;
        let kinetic = |sim: &Simulation<3>| [sim.system().fluid().v.iter().map(|v| v.norm_squared()).sum::<f64>()];
        Ok(common::time_mean(&mut sim, 1.5, 2.4, kinetic)?[0])
    };
    let [none, free] = [energy("none")?, energy("free")?];
    println!("{none} of {free}");
    assert!(none < free, "Σ v² is {none} m²/s² without slip, {free} m²/s² with free slip");
    Ok(())
}

/// A basin 1.6 m long with a hull on legs at x = 0.8 m, open above 0.72 m, and this water.
fn basin_with_hull(water: &str) -> String {
    format!(
        r#"
        dimension = 2
        dp = 0.04
        until = 1.0
        {water}
        [[solid]]
        name = "hull"
        fixed = true
        dry = true
        at = {{ x = 0.8, bottom = 0.4 }}
        [solid.shape]
        compound = [
            {{ shape = {{ box = {{ size = [0.8, 0.08] }} }}, at = [0.0, 0.04] }},
            {{ shape = {{ box = {{ size = [0.08, 0.32] }} }}, at = [-0.36, 0.24] }},
            {{ shape = {{ box = {{ size = [0.08, 0.32] }} }}, at = [0.36, 0.24] }},
        ]
        [[solid]]
        name = "tank"
        fixed = true
        shape = {{ tank = {{ size = [1.6, 0.9] }} }}
        "#
    )
}

/// The places (m) and densities (kg/m³) of the water of a scene, by place.
fn sorted_water(text: &str) -> Vec<[f64; 3]> {
    let sim = common::scene_simulation::<2>(text).unwrap_or_else(|e| panic!("{e}"));
    let fluid = sim.system().fluid();
    let rounded = |x: f64| (x * 1e9).round() * 1e-9;
    let mut all: Vec<_> =
        (0..fluid.len()).map(|i| [rounded(fluid.r[i][0]), rounded(fluid.r[i][1]), fluid.rho[i]]).collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    all
}

/// Shapes and boxes that describe the same water give the same particles to round-off, whatever the levels of other bodies of water.
#[test]
fn each_body_of_water_ends_at_its_own_level() {
    let sea = "[[water]]\nfill = { box = { min = [0.0, 0.0], max = [1.6, 0.6] } }\n";
    let (low, high) = ("[[water]]\ninside = \"hull\"\n", "[[water]]\n");
    let hold = "fill = { box = { min = [0.48, 0.48], max = [1.12, 0.56] } }\n";
    let hold_by_shape =
        "level = 0.56\nfill = { shape = { polygon = [[0.48, 0.48], [1.12, 0.48], [1.12, 0.72], [0.48, 0.72]] } }\n";
    let all = "fill = { shape = { box = { size = [1.6, 0.88] } }, at = [0.8, 0.44] }\n";
    let boxes = sorted_water(&basin_with_hull(&format!("{sea}{low}{hold}")));
    for (name, water) in [
        ("a lower hold", format!("{sea}{low}{hold_by_shape}")),
        ("the hold first", format!("{low}{hold_by_shape}{sea}")),
        ("a hold whose region ends in the hull", format!("{high}{hold_by_shape}{sea}")),
        ("two shapes", format!("{high}level = 0.6\n{all}{low}level = 0.56\n{all}")),
    ] {
        let found = sorted_water(&basin_with_hull(&water));
        assert_eq!(found.len(), boxes.len(), "{name}");
        let differs = found.iter().zip(&boxes).flat_map(|(a, b)| (0..3).map(move |i| (a[i] - b[i]).abs()));
        assert!(differs.fold(0.0, f64::max) < 1e-6, "{name}");
    }
}

/// A tank 1 m long with these bodies of water.
fn tank_with(water: &str) -> String {
    let tank = "[[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [1.0, 0.8] } }\n";
    format!("dimension = 2\ndp = 0.02\nuntil = 1.0\n{water}{tank}")
}

#[test]
fn where_bodies_of_water_overlap_the_first_has_its_level_and_its_velocity() -> Result<()> {
    let (tall, low) = ("max = [0.3, 0.5] } }\n", "max = [1.0, 0.1] } }\n");
    let [tall, low] = [tall, low].map(|max| format!("[[water]]\nfill = {{ box = {{ min = [0.0, 0.0], {max}"));
    // At the start a row of particles has the pressure at its middle: within 2 % of that below the level of the first.
    for (water, level) in [(format!("{tall}{low}"), 0.5), (format!("{low}{tall}"), 0.1)] {
        let sim = common::scene_simulation::<2>(&tank_with(&water))?;
        let p = PressureProbe::<2>::new(&[0.15, 0.05])?.sample(&sim)[0];
        let exact = 9810.0 * (level - 0.05);
        assert!((p / exact - 1.0).abs() < 0.02, "{p} Pa instead of {exact} Pa");
    }
    let moving = |min: f64, max: f64, u: f64| {
        format!("[[water]]\nfill = {{ box = {{ min = [{min}, 0.0], max = [{max}, 0.4] }} }}\nvelocity = [{u}, 0.0]\n")
    };
    let sim =
        common::scene_simulation::<2>(&tank_with(&format!("{}{}", moving(0.0, 0.6, 0.1), moving(0.4, 1.0, 0.3))))?;
    let fluid = sim.system().fluid();
    for (r, v) in fluid.r.iter().zip(fluid.v) {
        assert_eq!(v[0], if r[0] < 0.6 { 0.1 } else { 0.3 }, "at {r}");
    }
    Ok(())
}

#[test]
fn the_space_above_the_level_of_a_body_of_water_is_free_for_others() -> Result<()> {
    let first = "[[water]]\nlevel = 0.1\nfill = { shape = { box = { size = [1.0, 0.8] } }, at = [0.5, 0.4] }\n";
    let tray = "[[solid]]\nname = \"tray\"\nfixed = true\nshape = { tank = { size = [0.2, 0.3] } }\nat = [0.4, 0.4]\n";
    for (min, max, more) in [([0.0_f64, 0.0], [0.3, 0.5], ""), ([0.4, 0.4], [0.6, 0.6], tray)] {
        let second = format!("[[water]]\nfill = {{ box = {{ min = {min:?}, max = {max:?} }} }}\n");
        let sim = common::scene_simulation::<2>(&format!("{}{more}", tank_with(&format!("{first}{second}"))))?;
        // A layer of 0.1 m over the length of 1 m, and what of the second body lies above it.
        let volume = 0.1 + (max[0] - min[0]) * (max[1] - min[1].max(0.1));
        let found = sim.system().fluid().len() as f64 * DP * DP;
        assert!((found / volume - 1.0).abs() < 1e-9, "{found} m² instead of {volume} m²");
    }
    Ok(())
}
