//! Unit tests of `src/study/validation_cases.rs`.

use super::*;

fn scene(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

#[test]
fn every_validation_case_is_a_valid_scene_in_its_short_and_full_form() -> Result<()> {
    let all = validation_cases()?;
    assert!(all.len() >= 26, "{}", all.len());
    for case in &all {
        assert!(case.about.ends_with('.'), "{}: {:?}", case.name, case.about);
        for full in [false, true] {
            let job = case.job(full, &scene(&case.scene), Path::new("out"))?;
            job.estimated_size().map_err(|e| e.at(case.name.clone(), None, ""))?;
            assert!(!job.checks()?.is_empty(), "{} has checks", case.name);
        }
    }
    let mut names: Vec<&str> = all.iter().map(|case| case.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all.len(), "names are unique");
    Ok(())
}

#[test]
fn a_validation_case_of_a_paper_has_its_models_and_published_values() -> Result<()> {
    let case = select_cases(&["column-17".to_string()], true)?.remove(0);
    let job = case.job(true, &scene("column"), Path::new("out"))?;
    let lines: Vec<String> = job.read_scene()?.resolve()?.iter().map(|v| format!("{} = {}", v.key, v.value)).collect();
    for line in [
        "dp = 0.0085",
        "model.kernel.cubic.tensile = true",
        "model.viscosity.sps.nu0 = 0.000001",
        "model.diffusion.molteni.delta = 0.1",
        "model.shifting.away_from_solids.a = 2.0",
        "time.scheme.verlet.euler_every = 50",
        "time.cfl = 0.2",
        "check.0.paper.N = 0.305",
    ] {
        assert!(lines.iter().any(|l| l == line), "no line \"{line}\" in\n{}", lines.join("\n"));
    }
    Ok(())
}

#[test]
fn an_unknown_case_is_refused_with_the_nearest_name() {
    let error = select_cases(&["colum-3".to_string()], false).err();
    assert!(error.is_some_and(|e| e.to_string().contains("did you mean \"column-3\"?")));
}
