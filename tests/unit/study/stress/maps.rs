//! Unit tests of `src/study/stress/maps.rs`.

use super::*;

const TINY: &str = r#"
    [part]
    tank = "name = \"tank\"\nfixed = true\nshape = { tank = { size = [${0.02*x}, 0.3] } }"
    [[map]]
    name = "tiny"
    about = "A tank."
    x = { label = "width", unit = "dp", values = [10, 20, 30] }
    y = { label = "kernel", unit = "", values = ["wendland", "cubic"] }
    scene = '''
    dimension = 2
    dp = 0.02
    until = 0.1
    model = { kernel = "${y}" }
    water = [{ fill = { box = { min = [0, 0], max = [${0.02*x}, 0.1] } } }]
    [[solid]]
    ${tank}
    '''"#;

#[test]
fn placeholders_of_a_map_are_replaced_by_formulas_names_and_parts() -> Result<()> {
    let map = read(TINY, "tiny")?.remove(0);
    let cases = map.cases(false)?;
    assert_eq!((cases.len(), map.count(), map.cases(true)?.len()), (6, 6, 4));
    let text = cases[5].scene.to_toml()?;
    assert!(text.contains("cubic") && text.contains("0.6"), "{text}");
    assert_eq!(cases[5].values, ["30", "cubic"]);
    assert!((0..6).all(|i| cases[..i].iter().all(|case| case.key != cases[i].key)), "keys are unique");
    Ok(())
}

#[test]
fn an_invalid_placeholder_is_refused_with_the_name_of_its_map() -> Result<()> {
    for (from, to, part) in
        [("${y}", "${1/0}", "is inf"), ("${y}", "${ypsilon}", "not known"), ("${tank}", "${tank", "not closed")]
    {
        let map = read(&TINY.replace(from, to), "tiny")?.remove(0);
        let error = map.cases(false).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains(part) && error.contains("tiny"), "{error}");
    }
    Ok(())
}

#[test]
fn every_stress_case_of_the_program_is_built_or_refused_with_a_remedy() -> Result<()> {
    let all = maps(None)?;
    let cases = all.iter().map(|map| map.cases(false)).collect::<Result<Vec<_>>>()?.concat();
    assert!(cases.len() >= 200, "{} cases, at least 200", cases.len());
    for case in &cases {
        assert!(case.criteria.energy.is_some() && case.criteria.walls.is_some(), "{}", case.map);
        // A refusal is a valid outcome if it has a remedy.
        if let Err(error) = case.scene.plan() {
            assert!(error.kind == ErrorKind::Scene && error.help.is_some(), "{}: {error}", case.map);
        }
    }
    for map in &all {
        assert!(map.about.ends_with('.'), "{}: {:?}", map.name, map.about);
    }
    Ok(())
}

#[test]
fn an_unknown_map_is_refused_with_the_nearest_name() -> Result<()> {
    let error = select_maps(maps(None)?, &["flaot".to_string()], false).err();
    assert!(error.is_some_and(|e| e.to_string().contains("did you mean \"float\"?")));
    Ok(())
}

#[test]
fn an_axis_without_values_is_refused() {
    for (values, axis) in [("[10, 20, 30]", "x"), ("[\"wendland\", \"cubic\"]", "y")] {
        let told = read(&TINY.replace(values, "[]"), "tiny").unwrap_err().to_string();
        assert!(
            told.contains(&format!("no value along {axis}")) && told.contains(&format!("map.{axis}.values")),
            "{told}"
        );
    }
}
