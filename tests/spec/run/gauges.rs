//! Gauges: rows of them, surfaces over one another, flow, run-up, patches of walls, means.

use std::path::{Path, PathBuf};

use pontoon::{
    Result,
    math::Vector,
    model::Model,
    output::SeriesTable,
    probe::{ElevationProbe, FlowProbe, ForceProbe, GaugeSurface, PatchProbe, Probe, ProbeRow, RunupProbe},
    run::{self, Progress, RunOptions},
    scene::Scene,
    simulation::Simulation,
};

use crate::common::{self, TestFolder};

const DP: f64 = 0.02;

/// Water in a tank 0.4 m wide: these boxes of it, still as if 0.2 m deep.
fn tank(boxes: &[([f64; 2], [f64; 2])]) -> Simulation<2> {
    let size = |min: &[f64; 2], max: &[f64; 2]| [max[0] - min[0], max[1] - min[1]];
    let water = boxes.iter().flat_map(|(min, max)| common::lattice(*min, size(min, max), DP)).collect();
    common::simulation(Model::water(2, DP, 0.2), water, 0.2, vec![common::tank([0.4, 0.6], DP)])
}

fn pool() -> Simulation<2> {
    tank(&[([0.0, 0.0], [0.4, 0.2])])
}

impl TestFolder {
    fn scene(&self, probes: &str) -> PathBuf {
        let words = "dimension = 2\ndp = 0.02\nuntil = 0.06\nframes = \"off\"\n\
                     [[water]]\nfill = { box = { min = [0.0, 0.0], max = [0.2, 0.2] } }\n\
                     [[solid]]\nname = \"tank\"\nfixed = true\nshape = { tank = { size = [0.6, 0.3] } }\n";
        let file = self.join("scene.toml");
        std::fs::write(&file, format!("{words}{probes}")).unwrap();
        file
    }

    fn readings(&self, run: &str, probe: &str) -> Result<SeriesTable> {
        SeriesTable::read(&self.join(run).join(format!("series/{probe}.csv")))
    }

    fn options(&self, run: &str) -> RunOptions {
        RunOptions { out: Some(self.join(run)), threads: Some(1), ..RunOptions::default() }
    }
}

fn go_on(_: &Progress) -> bool {
    true
}

#[test]
fn a_row_of_gauges_reads_what_each_reads_and_says_where() -> Result<()> {
    let sim = pool();
    let gauge = |x: f64| -> Result<Box<dyn Probe<2>>> { Ok(Box::new(ElevationProbe::new(sim.system(), &[x])?)) };
    let row = ProbeRow::new(vec![(vec![0.1], gauge(0.1)?), (vec![0.3], gauge(0.3)?)]);
    assert_eq!(row.columns(), ["level_at_0.1_m", "eta_at_0.1_m", "level_at_0.3_m", "eta_at_0.3_m"]);
    assert_eq!(row.sample(&sim), [gauge(0.1)?.sample(&sim), gauge(0.3)?.sample(&sim)].concat());
    Ok(())
}

#[test]
fn of_two_layers_of_water_a_gauge_tells_the_highest_the_lowest_or_all() -> Result<()> {
    let sim = tank(&[([0.0, 0.0], [0.4, 0.2]), ([0.0, 0.4], [0.4, 0.5])]);
    let look =
        |surface| -> Result<Vec<f64>> { Ok(ElevationProbe::with_surface(sim.system(), &[0.2], surface)?.sample(&sim)) };
    let near = |x: f64, level: f64| (x - level).abs() < 0.1 * DP;
    assert!(near(look(GaugeSurface::Highest)?[0], 0.5) && near(look(GaugeSurface::Lowest)?[0], 0.2));
    let all = look(GaugeSurface::All)?;
    assert!(near(all[0], 0.5) && near(all[2], 0.2) && all[3].is_nan(), "within a tenth of dp, as one layer: {all:?}");
    assert_eq!(look(GaugeSurface::Highest)?, ElevationProbe::new(sim.system(), &[0.2])?.sample(&sim));
    Ok(())
}

#[test]
fn what_flows_through_a_section_is_speed_times_depth_wherever_it_stands() -> Result<()> {
    let mut sim = pool();
    sim.set_water_density(|_| 1000.0);
    sim.set_water_velocity(|_| Vector::from([0.5, -0.25]));
    for x in [0.2, 0.207, 0.21] {
        let flow = FlowProbe::<2>::new(&[x, 0.0], &[x, 0.5])?.sample(&sim)[0];
        assert!((flow - 0.5 * 0.2).abs() < 1e-12, "rows dp apart weigh 1 in all, wherever they lie; got {flow} at {x}");
    }
    let down = FlowProbe::<2>::new(&[0.3, 0.1], &[0.1, 0.1])?.sample(&sim)[0];
    assert!(
        (down + 0.25 * 0.2).abs() < 1e-12,
        "walking back, up is on the right: what falls counts against; got {down}"
    );
    assert!(
        FlowProbe::<3>::new(&[0.0; 3], &[1.0, 1.0, 1.0]).is_err() && FlowProbe::<2>::new(&[0.0; 2], &[0.0; 2]).is_err()
    );
    Ok(())
}

#[test]
fn the_volume_that_flowed_is_what_is_missing_before_the_section() -> Result<()> {
    let home = TestFolder::new("gauges-flow");
    // A column that falls, and a section through which all of its foot goes.
    let file = home
        .scene("[[probe]]\nflow = { from = [0.2, 0.0], to = [0.2, 0.3] }\nevery = 0.001\n[[probe]]\nfront = true\n");
    run::run(&file, &RunOptions { overrides: vec![("until".into(), "0.2".into())], ..home.options("a") }, &mut go_on)?;
    let table = home.readings("a", "flow")?;
    let (volume, front) =
        (table.values[1].last().copied().unwrap_or(0.0), home.readings("a", "front")?.values[0].last().copied());
    // The toe is a wedge from the section to the front, lower than the column was.
    let toe = front.unwrap_or(0.0) - 0.2;
    assert!(toe > 0.05, "it has flowed: {toe}");
    assert!(volume > 0.2 * 0.2 * toe && volume < 0.2 * toe, "{volume} m² in a toe of {toe} m");
    Ok(())
}

#[test]
fn the_waterline_is_the_highest_water_on_the_face_and_drops_do_not_count() -> Result<()> {
    let tongue = ([0.36, 0.2], [0.4, 0.3]);
    let drop = ([0.38, 0.4], [0.4, 0.42]);
    let middle = ([0.18, 0.2], [0.22, 0.4]);
    let sim = tank(&[([0.0, 0.0], [0.4, 0.2]), tongue, middle, drop]);
    let now = RunupProbe::new(sim.system(), "tank")?.sample(&sim);
    // The last particle of the tongue lies half a dp below its end and half a dp from the wall.
    assert!((now[0] - 0.4).abs() < 1e-9 && (now[1] - 0.29).abs() < 1e-9, "{now:?}");
    assert_eq!(now[2], 0.0, "it counts from the start");
    assert!(RunupProbe::new(sim.system(), "slope").is_err());
    Ok(())
}

#[test]
fn patches_of_a_wall_carry_the_weight_of_the_water_and_together_all_of_it() -> Result<()> {
    let sim = pool();
    let patch = |min: [f64; 2], max: [f64; 2]| -> Result<Vec<f64>> {
        Ok(PatchProbe::new(sim.system(), "tank", &min, &max)?.sample(&sim))
    };
    let bed = patch([0.095, -0.01], [0.295, 0.01])?;
    let weight = 1000.0 * 9.81 * 0.2 * 0.2;
    // Its ends fall between boundary particles, and pressures of still water are within 1 %: the rest is the walls.
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

const MEANED: &str = "[[probe]]\nname = \"mean\"\npressure = [0.1, 0.02]\nevery = 0.01\naverage = true\n\
                      [[probe]]\nname = \"all\"\npressure = [0.1, 0.02]\nevery = 1e-9\n";

#[test]
fn an_average_is_the_mean_of_every_step_since_the_reading_before() -> Result<()> {
    let home = TestFolder::new("gauges-mean");
    run::run(&home.scene(MEANED), &home.options("a"), &mut go_on)?;
    let (mean, all) = (home.readings("a", "mean")?, home.readings("a", "all")?);
    assert_eq!(mean.values[0][0], all.values[0][0], "the first is the reading itself");
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
fn means_and_volumes_of_an_interrupted_run_end_as_those_of_an_unbroken_one() -> Result<()> {
    let home = TestFolder::new("gauges-resumed");
    let file =
        home.scene(&format!("{MEANED}[[probe]]\nflow = {{ from = [0.2, 0.0], to = [0.2, 0.3] }}\naverage = true\n"));
    run::run(&file, &home.options("whole"), &mut go_on)?;
    run::run(&file, &home.options("broken"), &mut |now: &Progress| now.steps < 7)?;
    let broken = home.join("broken");
    run::resume(&broken, &[], Some(1), &mut |now: &Progress| now.steps < 23)?;
    run::resume(&broken, &[], Some(1), &mut go_on)?;
    let bytes = |run: &Path, name: &str| std::fs::read(run.join(format!("series/{name}.csv"))).unwrap();
    for name in ["mean", "all", "flow"] {
        assert_eq!(bytes(&broken, name), bytes(&home.join("whole"), name), "{name}");
    }
    Ok(())
}

#[test]
fn places_that_cannot_be_meant_are_refused_in_words() {
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
        let file = home.scene(&format!("[[probe]]\n{probe}\n"));
        let said = Scene::read(&file, &[]).and_then(|scene| scene.plan()).err().map(|e| e.to_string());
        assert!(said.as_ref().is_some_and(|said| said.contains(word)), "{probe}: {said:?}");
    }
}
