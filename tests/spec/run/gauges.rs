//! Gauges: rows of gauges, layered surfaces, flow, run-up, wall patches and time means.

use std::path::{Path, PathBuf};

use pontoon::{
    Result,
    math::Vector,
    model::Model,
    output::SeriesTable,
    probe::{
        ElevationProbe, FlowProbe, ForceProbe, GaugeSurface, PatchProbe, PressureProbe, Probe, ProbeRow, RunupProbe,
    },
    run::{self, Progress, RunOptions},
    scene::Scene,
    simulation::Simulation,
};

use crate::common::{self, TestFolder};

const DP: f64 = 0.02;

/// A tank 0.4 m wide with these boxes of water, hydrostatic below 0.2 m.
fn tank(boxes: &[([f64; 2], [f64; 2])]) -> Simulation<2> {
    let size = |min: &[f64; 2], max: &[f64; 2]| [max[0] - min[0], max[1] - min[1]];
    let water = boxes.iter().flat_map(|(min, max)| common::lattice(*min, size(min, max), DP)).collect();
    common::simulation(Model::water(2, DP, 0.2), water, 0.2, vec![common::tank([0.4, 0.6], DP)])
}

fn pool() -> Simulation<2> {
    tank(&[([0.0, 0.0], [0.4, 0.2])])
}

impl TestFolder {
    fn write_scene(&self, probes: &str) -> PathBuf {
        let base = "dimension = 2\ndp = 0.02\nuntil = 0.06\nframes = \"off\"\n\
                     [[water]]\nfill = { box = { min = [0.0, 0.0], max = [0.2, 0.2] } }\n\
                     [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [0.6, 0.3] } }\n";
        let file = self.join("scene.toml");
        std::fs::write(&file, format!("{base}{probes}")).unwrap();
        file
    }

    fn readings(&self, run: &str, probe: &str) -> Result<SeriesTable> {
        SeriesTable::read(&self.join(run).join(format!("series/{probe}.csv")))
    }

    fn options(&self, run: &str) -> RunOptions {
        RunOptions { out: Some(self.join(run)), threads: Some(1), ..RunOptions::default() }
    }
}

fn always(_: &Progress) -> bool {
    true
}

#[test]
fn a_row_of_gauges_has_the_readings_of_its_gauges_with_their_positions() -> Result<()> {
    let sim = pool();
    let gauge = |x: f64| -> Result<Box<dyn Probe<2>>> { Ok(Box::new(ElevationProbe::new(sim.system(), &[x])?)) };
    let row = ProbeRow::new(vec![(vec![0.1], gauge(0.1)?), (vec![0.3], gauge(0.3)?)]);
    assert_eq!(row.columns(), ["level_at_0.1_m", "eta_at_0.1_m", "level_at_0.3_m", "eta_at_0.3_m"]);
    assert_eq!(row.sample(&sim), [gauge(0.1)?.sample(&sim), gauge(0.3)?.sample(&sim)].concat());
    Ok(())
}

#[test]
fn a_gauge_above_two_layers_of_water_reads_the_highest_the_lowest_or_all_surfaces() -> Result<()> {
    let sim = tank(&[([0.0, 0.0], [0.4, 0.2]), ([0.0, 0.4], [0.4, 0.5])]);
    let sample =
        |surface| -> Result<Vec<f64>> { Ok(ElevationProbe::with_surface(sim.system(), &[0.2], surface)?.sample(&sim)) };
    let near = |x: f64, level: f64| (x - level).abs() < 0.1 * DP;
    assert!(near(sample(GaugeSurface::Highest)?[0], 0.5) && near(sample(GaugeSurface::Lowest)?[0], 0.2));
    let all = sample(GaugeSurface::All)?;
    assert!(
        near(all[0], 0.5) && near(all[2], 0.2) && all[3].is_nan(),
        "the bound is a tenth of dp, as for one layer: {all:?}"
    );
    assert_eq!(sample(GaugeSurface::Highest)?, ElevationProbe::new(sim.system(), &[0.2])?.sample(&sim));
    Ok(())
}

#[test]
fn the_flow_through_a_section_is_speed_times_depth_at_any_position() -> Result<()> {
    let mut sim = pool();
    sim.set_water_density(|_| 1000.0);
    sim.set_water_velocity(|_| Vector::from([0.5, -0.25]));
    for x in [0.2, 0.207, 0.21] {
        let flow = FlowProbe::<2>::new(&[x, 0.0], &[x, 0.5])?.sample(&sim)[0];
        assert!(
            (flow - 0.5 * 0.2).abs() < 1e-12,
            "the kernel weights of rows dp apart sum to 1 at any position; got {flow} at {x}"
        );
    }
    let down = FlowProbe::<2>::new(&[0.3, 0.1], &[0.1, 0.1])?.sample(&sim)[0];
    assert!(
        (down + 0.25 * 0.2).abs() < 1e-12,
        "seen from start to end of the section, flow to the right is positive; got {down}"
    );
    assert!(
        FlowProbe::<3>::new(&[0.0; 3], &[1.0, 1.0, 1.0]).is_err() && FlowProbe::<2>::new(&[0.0; 2], &[0.0; 2]).is_err()
    );
    Ok(())
}

#[test]
fn the_volume_through_a_section_is_the_volume_behind_it() -> Result<()> {
    let home = TestFolder::new("gauges-flow");
    // A collapsing column and a section at its foot.
    let file = home.write_scene(
        "[[probe]]\nflow = { from = [0.2, 0.0], to = [0.2, 0.3] }\nevery = 0.001\n[[probe]]\nfront = true\n",
    );
    run::run(&file, &RunOptions { overrides: vec![("until".into(), "0.2".into())], ..home.options("a") }, &mut always)?;
    let table = home.readings("a", "flow")?;
    let (volume, front) =
        (table.values[1].last().copied().unwrap_or(0.0), home.readings("a", "front")?.values[0].last().copied());
    // The toe is a wedge from the section to the front, lower than the column.
    let toe = front.unwrap_or(0.0) - 0.2;
    assert!(toe > 0.05, "the water flowed by {toe} m");
    assert!(volume > 0.2 * 0.2 * toe && volume < 0.2 * toe, "{volume} m² in a toe of {toe} m");
    Ok(())
}

#[test]
fn the_runup_probe_reads_the_highest_water_on_the_face_without_drops() -> Result<()> {
    let tongue = ([0.36, 0.2], [0.4, 0.3]);
    let drop = ([0.38, 0.4], [0.4, 0.42]);
    let middle = ([0.18, 0.2], [0.22, 0.4]);
    let sim = tank(&[([0.0, 0.0], [0.4, 0.2]), tongue, middle, drop]);
    let now = RunupProbe::new(sim.system(), "tank")?.sample(&sim);
    // The last particle of the tongue is half a dp below its end and half a dp from the wall.
    assert!((now[0] - 0.4).abs() < 1e-9 && (now[1] - 0.29).abs() < 1e-9, "{now:?}");
    assert_eq!(now[2], 0.0, "the run-up is relative to the start");
    assert!(RunupProbe::new(sim.system(), "slope").is_err());
    Ok(())
}

#[test]
fn wall_patches_read_hydrostatic_forces_and_sum_to_the_total_force() -> Result<()> {
    let sim = pool();
    let patch = |min: [f64; 2], max: [f64; 2]| -> Result<Vec<f64>> {
        Ok(PatchProbe::new(sim.system(), "tank", &min, &max)?.sample(&sim))
    };
    let bed = patch([0.095, -0.01], [0.295, 0.01])?;
    let weight = 1000.0 * 9.81 * 0.2 * 0.2;
    // The ends of the patch are between boundary particles, and pressures of still water are accurate to 1 %. The side walls cause the
    // rest of the 5 %.
    assert!((bed[1] / -weight - 1.0).abs() < 0.05, "{} N/m on {weight}", bed[1]);
    assert!((bed[2] / (1000.0 * 9.81 * 0.2) - 1.0).abs() < 0.01 && bed[3] >= bed[2], "{bed:?}");
    let wall = patch([0.39, 0.0], [0.41, 0.6])?;
    assert!((wall[0] / (0.5 * 1000.0 * 9.81 * 0.04) - 1.0).abs() < 0.1, "½ ρ g d²; {wall:?}");
    let whole = patch([-0.1, -0.1], [0.5, 0.7])?;
    let force = ForceProbe::new(sim.system(), "tank")?.sample(&sim);
    let error = (whole[0] - force[0]).abs().max((whole[1] - force[1]).abs());
    assert!(error < 1e-9 * weight, "the same forces in another order; off by {error:e}");
    let nothing = patch([0.1, 0.1], [0.2, 0.2]).err().map(|e| e.message).unwrap_or_default();
    assert!(nothing.contains("no face of solid \"tank\""), "{nothing}");
    Ok(())
}

const AVERAGED: &str = "[[probe]]\nname = \"mean\"\npressure = [0.1, 0.02]\nevery = 0.01\naverage = true\n\
                      [[probe]]\nname = \"all\"\npressure = [0.1, 0.02]\nevery = 1e-9\n";

#[test]
fn an_average_is_the_trapezoidal_mean_of_all_steps_since_the_previous_reading() -> Result<()> {
    let home = TestFolder::new("gauges-mean");
    run::run(&home.write_scene(AVERAGED), &home.options("a"), &mut always)?;
    let (mean, all) = (home.readings("a", "mean")?, home.readings("a", "all")?);
    assert_eq!(mean.values[0][0], all.values[0][0], "the first value is the reading itself");
    for (i, w) in mean.times.windows(2).enumerate() {
        let inside: Vec<usize> =
            (1..all.times.len()).filter(|&k| all.times[k - 1] >= w[0] && all.times[k] <= w[1]).collect();
        let sum: f64 = inside
            .iter()
            .map(|&k| 0.5 * (all.times[k] - all.times[k - 1]) * (all.values[0][k] + all.values[0][k - 1]))
            .sum();
        let (expected, found) = (sum / (w[1] - w[0]), mean.values[0][i + 1]);
        assert!((found / expected - 1.0).abs() < 1e-12, "round-off of the sum; {found} and {expected}");
    }
    assert!(mean.times.len() > 5);
    Ok(())
}

#[test]
fn means_and_volumes_of_an_interrupted_run_equal_those_of_an_uninterrupted_run() -> Result<()> {
    let home = TestFolder::new("gauges-resumed");
    let file = home.write_scene(&format!(
        "{AVERAGED}[[probe]]\nflow = {{ from = [0.2, 0.0], to = [0.2, 0.3] }}\naverage = true\n"
    ));
    run::run(&file, &home.options("whole"), &mut always)?;
    run::run(&file, &home.options("interrupted"), &mut |now: &Progress| now.steps < 7)?;
    let interrupted = home.join("interrupted");
    run::resume(&interrupted, &[], Some(1), &mut |now: &Progress| now.steps < 23)?;
    run::resume(&interrupted, &[], Some(1), &mut always)?;
    let bytes = |run: &Path, name: &str| std::fs::read(run.join(format!("series/{name}.csv"))).unwrap();
    for name in ["mean", "all", "flow"] {
        assert_eq!(bytes(&interrupted, name), bytes(&home.join("whole"), name), "{name}");
    }
    Ok(())
}

#[test]
fn invalid_probe_positions_are_refused_with_the_reason() {
    let home = TestFolder::new("gauges-refused");
    for (probe, word) in [
        ("elevation = { x = 0.1, from = 0.0, to = 0.2, count = 3 }", "one place or is a row"),
        ("elevation = { from = 0.0, to = 0.2 }", "either a count or a spacing"),
        ("elevation = { from = [0.0, 0.1], to = 0.2, count = 3 }", "from has 2 numbers"),
        ("elevation = { from = 0.0, to = 0.2, count = 1 }", "2 to 1000 places"),
        ("elevation = { y = 0.2 }", "stands at x in 2-D"),
        ("velocity = { from = [0.0, 0.1], to = [0.2, 0.1], spacing = 1e-7 }", "2 to 1000 places"),
        ("elevation = { x = 0.1, surface = \"crest\" }", "unknown surface"),
        ("flow = { from = [0.1, 0.1], to = [0.1, 0.1] }", "no length"),
        ("runup = \"tnak\"", "did you mean \"tank\""),
        ("patch = { solid = \"tank\", box = { min = [0.1, 0.1], max = [0.0, 0.2] } }", "nothing lies between"),
    ] {
        let file = home.write_scene(&format!("[[probe]]\n{probe}\n"));
        let message = Scene::read(&file, &[]).and_then(|scene| scene.plan()).err().map(|e| e.to_string());
        assert!(message.as_ref().is_some_and(|message| message.contains(word)), "{probe}: {message:?}");
    }
}

/// A tank 0.5 m long with a wall of this `thickness` (m) from x = 0.5 m on, water 0.4 m deep before it, and `behind` (m) deep behind it.
fn walled(thickness: f64, behind: f64) -> Result<Simulation<2>> {
    let pool = |from: f64, to: f64, depth: f64| match depth > 0.0 {
        true => format!("[[water]]\nfill = {{ box = {{ min = [{from:?}, 0.0], max = [{to:?}, {depth:?}] }} }}\n"),
        false => String::new(),
    };
    let far = 0.5 + thickness;
    let text = format!(
        "dimension = 2\ndp = 0.02\nuntil = 1.0\n{}{}[[solid]]\nname = \"wall\"\nfixed = true\n\
         shape = {{ box = {{ size = [{thickness:?}, 0.6] }} }}\nat = {{ x = {:?}, bottom = 0.0 }}\n\
         [[solid]]\nname = \"tank\"\nfixed = true\nshape = {{ tank = {{ size = [1.0, 0.6] }} }}\n",
        pool(0.0, 0.5, 0.4),
        pool(far, 1.0, behind),
        0.5 + 0.5 * thickness
    );
    common::scene_simulation::<2>(&text)
}

/// On a wall of two to five rows the patch on the wet face has all of the force, and that on the dry face none; the force of water on both
/// faces is divided. The part between 0.1 and 0.3 m has the hydrostatic force within 2 %: the rows at its ends lie between particles.
#[test]
fn patches_on_thin_walls_read_the_force_of_the_water_on_their_side() -> Result<()> {
    for rows in [2, 3, 5] {
        let (thickness, far) = (0.02 * f64::from(rows), 0.5 + 0.02 * f64::from(rows));
        for behind in [0.0, 0.4] {
            let sim = walled(thickness, behind)?;
            let patch = |x: f64| -> Result<f64> {
                Ok(PatchProbe::new(sim.system(), "wall", &[x - 0.01, 0.1], &[x + 0.01, 0.3])?.sample(&sim)[0])
            };
            let exact = 9810.0 * 0.2 * 0.2;
            let [near, other] = [patch(0.5)?, patch(far)?];
            assert!((near / exact - 1.0).abs() < 0.02, "{rows} rows, {behind} m behind: {near} N/m instead of {exact}");
            let of_other = if behind > 0.0 { -exact } else { 0.0 };
            assert!(
                (other - of_other).abs() < 0.02 * exact,
                "{rows} rows, {behind} m behind: {other} N/m on the other face"
            );
        }
    }
    Ok(())
}

/// A wall of one row has its particles in its middle. Its two faces together have the force on the wall.
#[test]
fn a_patch_on_a_wall_of_one_row_is_read_on_its_wet_face() -> Result<()> {
    let sim = walled(0.02, 0.0)?;
    let patch = |x: f64| {
        PatchProbe::new(sim.system(), "wall", &[x - 0.005, -0.1], &[x + 0.005, 0.7]).map(|own| own.sample(&sim))
    };
    let (wet, dry) = (patch(0.5)?, patch(0.52)?);
    let whole = ForceProbe::new(sim.system(), "wall")?.sample(&sim)[0];
    assert!((wet[0] / whole - 1.0).abs() < 0.01 && dry[0].abs() < 0.01 * whole, "{wet:?} and {dry:?} of {whole} N/m");
    Ok(())
}

/// The default wall of a tank in 3-D is as thick as the support. Patches away from the edges have the hydrostatic force within 2 %, for
/// the reason above; the mean pressure on a wall down to the bed is that at half the depth within 1 %.
#[test]
fn patches_and_gauges_on_the_default_tank_read_still_water_in_3d() -> Result<()> {
    let text = "dimension = 3\ndp = 0.05\nuntil = 1.0\n[[water]]\nfill = { box = { min = [0.0, 0.0, 0.0], max = [0.8, 0.8, 0.5] } }\n\
                [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [0.8, 0.8, 0.7] } }\n";
    let sim = common::scene_simulation::<3>(text)?;
    let patch = |min: [f64; 3], max: [f64; 3]| -> Result<Vec<f64>> {
        Ok(PatchProbe::new(sim.system(), "tank", &min, &max)?.sample(&sim))
    };
    let side = patch([-0.01, 0.2, 0.1], [0.01, 0.6, 0.4])?;
    let exact = 9810.0 * 0.25 * 0.4 * 0.3;
    assert!((-side[0] / exact - 1.0).abs() < 0.02, "{} N instead of {exact} N", -side[0]);
    let bed = patch([0.2, 0.2, -0.01], [0.6, 0.6, 0.01])?;
    let exact = 9810.0 * 0.5 * 0.16;
    assert!((-bed[2] / exact - 1.0).abs() < 0.02, "{} N instead of {exact} N", -bed[2]);
    let whole = patch([-0.01, 0.0, 0.0], [0.01, 0.8, 0.5])?;
    assert!((whole[3] / (9810.0 * 0.25) - 1.0).abs() < 0.01, "a mean of {} Pa", whole[3]);
    // Gauges in the corner of two walls read the level within a fifth of dp.
    for (x, y) in [(0.0, 0.02), (0.01, 0.03), (0.8, 0.05), (0.0, 0.4)] {
        let found = ElevationProbe::new(sim.system(), &[x, y])?.sample(&sim)[0];
        assert!((found - 0.5).abs() < 0.01, "{found} m at {x}, {y} m");
    }
    Ok(())
}

/// The mean pressure on a wall down to the bed is that at half the depth, and the pressure in the edge that at the bed, within 1 %.
#[test]
fn pressures_down_to_an_inner_edge_are_hydrostatic() -> Result<()> {
    let sim = pool();
    let wall = PatchProbe::new(sim.system(), "tank", &[-0.005, 0.0], &[0.005, 0.2])?.sample(&sim);
    assert!((wall[2] / (9810.0 * 0.1) - 1.0).abs() < 0.01, "a mean of {} Pa", wall[2]);
    let edge = PressureProbe::<2>::new(&[0.0, 0.0])?.sample(&sim)[0];
    assert!((edge / (9810.0 * 0.2) - 1.0).abs() < 0.01, "{edge} Pa in the edge");
    Ok(())
}

/// A gauge reads the level of still water within a fifth of dp at any distance from a wall, on one side of a thin wall too.
#[test]
fn gauges_at_walls_read_the_level_of_still_water() -> Result<()> {
    let level =
        |sim: &Simulation<2>, x: f64| -> Result<f64> { Ok(ElevationProbe::new(sim.system(), &[x])?.sample(sim)[0]) };
    let sim = pool();
    for x in [0.0, 0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.39, 0.4] {
        let found = level(&sim, x)?;
        assert!((found - 0.2).abs() < 0.2 * DP, "{found} m at {x} m");
    }
    for rows in [2, 5] {
        let thickness = 0.02 * f64::from(rows);
        let sim = walled(thickness, 0.2)?;
        for (x, exact) in [(0.48, 0.4), (0.495, 0.4), (0.5, 0.4), (0.5 + thickness, 0.2), (0.51 + thickness, 0.2)] {
            let found = level(&sim, x)?;
            assert!((found - exact).abs() < 0.2 * DP, "{found} m at {x} m beside {rows} rows");
        }
    }
    Ok(())
}
