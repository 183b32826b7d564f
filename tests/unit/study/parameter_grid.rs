//! Unit tests of `src/study/parameter_grid.rs`.

use super::*;

fn grid(dp: &[f64], vary: &[(&str, &[&str])]) -> ParameterGrid {
    let vary = vary.iter().map(|(key, values)| VariedKey {
        key: key.to_string(),
        values: values.iter().map(|v| v.to_string()).collect(),
    });
    ParameterGrid {
        name: "x".into(),
        scene: "x".into(),
        dp: dp.into(),
        vary: vary.collect(),
        overrides: vec![],
        frames: None,
        repeat: 1,
    }
}

#[test]
fn a_grid_combines_every_spacing_with_every_value_from_the_coarsest_on() -> Result<()> {
    let values: [(&str, &[&str]); 2] = [("model.kernel", &["cubic", "wendland"]), ("time.cfl", &["0.1", "0.2"])];
    let jobs = grid(&[0.01, 0.02, 0.005], &values).jobs(Path::new("out"))?;
    assert_eq!(jobs.len(), 12);
    assert_eq!(jobs[0].folder, Path::new("out/runs/dp-0.02_kernel-cubic_cfl-0.1"));
    assert_eq!(jobs[11].name, "dp-0.005_kernel-wendland_cfl-0.2");
    assert_eq!(jobs[11].group, "model.kernel = wendland, time.cfl = 0.2");
    assert_eq!(jobs[11].overrides.last(), Some(&("dp".to_string(), "0.005".to_string())));
    assert_eq!(grid(&[0.01], &[]).jobs(Path::new("out"))?[0].name, "dp-0.01");
    Ok(())
}

#[test]
fn column_titles_are_the_differing_values_and_frames_match_the_requested_times() -> Result<()> {
    let laws: [(&str, &[&str]); 1] = [("model.diffusion", &["none", "fourtakas"])];
    let named = |grid: ParameterGrid| grid.jobs(Path::new("out")).map(|jobs| distinguishing_labels(&jobs));
    assert_eq!(named(grid(&[0.01], &laws))?, ["diffusion = none", "diffusion = fourtakas"]);
    assert_eq!(named(grid(&[0.01, 0.02], &[]))?, ["dp = 0.02 m", "dp = 0.01 m"]);
    assert_eq!(named(grid(&[0.01], &[]))?, ["dp-0.01"]);
    let frames =
        ParameterGrid { frames: Some(0.1), ..grid(&[0.01], &[]) }.jobs(Path::new("out"))?[0].overrides[0].clone();
    assert_eq!((frames.0.as_str(), frames.1.starts_with("{ every = 0.1,")), ("frames", true));
    // Times without a long common interval: 200 frames, of which the nearest is used.
    assert_eq!(
        [frame_interval(&[0.0], 2.0), frame_interval(&[0.5, 1.25], 2.0), frame_interval(&[0.333, 1.0], 2.0)],
        [2.0, 0.25, 0.01]
    );
    Ok(())
}

#[test]
fn repeats_share_a_name_and_differ_by_a_jitter_of_a_millionth_of_dp() -> Result<()> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/still-tank");
    let thrice = |sets: &[(&str, &str)]| {
        let sets = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        ParameterGrid { scene: scene.clone(), overrides: sets, repeat: 3, ..grid(&[0.05], &[]) }.jobs(Path::new("out"))
    };
    // The largest jitter leaves no room above: repeats have less.
    let most: Vec<f64> = thrice(&[("jitter", "0.1")])?.iter().filter_map(|job| job.read_scene().ok()?.jitter).collect();
    assert_eq!(most, [0.1, 0.1 - 1e-6, 0.1 - 2e-6]);
    let jobs = thrice(&[])?;
    assert!(jobs.iter().all(|job| job.name == "dp-0.05" && job.group.is_empty()));
    let folders = ["out/runs/dp-0.05", "out/runs/dp-0.05_repeat-2", "out/runs/dp-0.05_repeat-3"];
    assert_eq!(jobs.iter().map(|job| job.folder.as_path()).collect::<Vec<_>>(), folders.map(Path::new));
    assert_eq!(distinguishing_labels(&jobs), ["repeat 1", "repeat 2", "repeat 3"]);
    let starts = |jobs: &[Job]| jobs.iter().map(|job| Ok(job.read_scene()?.jitter)).collect::<Result<Vec<_>>>();
    // The first repeat equals a run without repeats, so that an existing study can be repeated.
    assert_eq!(starts(&jobs)?, [None, Some(1e-6), Some(2e-6)]);
    assert_eq!(starts(&thrice(&[("jitter", "1e-3")])?)?, [1e-3, 1e-3 + 1e-6, 1e-3 + 2e-6].map(Some));
    let refused = |grid: ParameterGrid| grid.jobs(Path::new("out")).err().map(|e| e.kind);
    assert_eq!(refused(ParameterGrid { repeat: 0, ..grid(&[0.05], &[]) }), Some(ErrorKind::Usage));
    let varied = grid(&[0.05], &[("jitter", &["1e-7", "1e-6"])]);
    assert_eq!(refused(ParameterGrid { repeat: 2, ..varied }), Some(ErrorKind::Usage));
    Ok(())
}

#[test]
fn duplicate_and_missing_values_are_refused() {
    let refused = |grid: ParameterGrid| grid.jobs(Path::new("out")).err().map(|e| e.kind);
    assert_eq!(refused(grid(&[0.01, 0.01], &[])), Some(ErrorKind::Usage));
    assert_eq!(refused(grid(&[], &[])), Some(ErrorKind::Usage));
    assert_eq!(refused(grid(&[0.01], &[("dp", &["0.01", "0.02"])])), Some(ErrorKind::Usage));
    assert_eq!(refused(grid(&[0.01], &[("a", &["1", ""])])), Some(ErrorKind::Usage));
}

#[test]
fn a_long_name_is_shortened_and_remains_unique() -> Result<()> {
    let long = "{ artificial = { alpha = 0.0200000000000000000000000000000000000000000000000000000000000000000001 } }";
    let jobs = grid(&[0.01], &[("model.viscosity", &[long, &long.replace("1 }", "2 }")])]).jobs(Path::new("out"))?;
    assert!(jobs.iter().all(|job| job.name.len() <= LONGEST));
    assert!(jobs[0].name.starts_with("dp-0.01_viscosity-artificial-alpha-0.02"));
    Ok(())
}

#[test]
fn keys_that_vary_the_same_value_are_refused_under_each_of_their_names() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/still-tank");
    let refusal = |vary: &[(&str, &[&str])]| {
        let grid = ParameterGrid { scene: scene.clone(), ..grid(&[0.05], vary) };
        grid.jobs(Path::new("out")).err().map(|e| e.to_string())
    };
    for [first, second, value, other] in [
        ["model.c0_factor", "model.c0_factor", "10", "30"],
        ["model.viscosity", "model.viscosity.laminar.nu0", "none", "1e-6"],
        ["jitter", "scatter", "1e-3", "1e-2"],
        ["probe.0.every", "probe.low.every", "0.1", "0.2"],
    ] {
        for [first, second] in [[first, second], [second, first]] {
            let told = refusal(&[(first, &[value]), (second, &[other])]).unwrap_or_else(|| panic!("{first}, {second}"));
            assert!(told.contains(first) && told.contains(second), "{told}");
        }
    }
    assert_eq!(refusal(&[("model.c0_factor", &["10", "20"]), ("model.c0", &["30"])]), None, "a longer name is no part");
}
