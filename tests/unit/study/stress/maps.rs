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
fn the_holes_of_a_scene_are_filled_with_formulae_words_and_parts() -> Result<()> {
    let map = read(TINY, "tiny")?.remove(0);
    let cases = map.cases(false)?;
    assert_eq!((cases.len(), map.count(), map.cases(true)?.len()), (6, 6, 4));
    let text = cases[5].scene.to_toml()?;
    assert!(text.contains("cubic") && text.contains("0.6"), "{text}");
    assert_eq!(cases[5].values, ["30", "cubic"]);
    assert!((0..6).all(|i| cases[..i].iter().all(|case| case.key != cases[i].key)), "each has its own key");
    Ok(())
}

#[test]
fn a_hole_that_cannot_be_filled_is_told_with_its_map() -> Result<()> {
    for (from, to, said) in
        [("${y}", "${1/0}", "is inf"), ("${y}", "${ypsilon}", "not known"), ("${tank}", "${tank", "not closed")]
    {
        let map = read(&TINY.replace(from, to), "tiny")?.remove(0);
        let error = map.cases(false).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains(said) && error.contains("tiny"), "{error}");
    }
    Ok(())
}

#[test]
fn every_case_of_the_program_can_be_built_or_is_refused_in_words() -> Result<()> {
    let all = maps(None)?;
    let cases = all.iter().map(|map| map.cases(false)).collect::<Result<Vec<_>>>()?.concat();
    assert!(cases.len() >= 200, "{} cases: the matrix is to have 200", cases.len());
    for case in &cases {
        assert!(case.criteria.energy.is_some() && case.criteria.walls.is_some(), "{}", case.map);
        // A refusal is an outcome too, as long as it says what to write.
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
fn a_map_that_is_not_there_names_the_nearest() -> Result<()> {
    let error = select_maps(maps(None)?, &["flaot".to_string()], false).err();
    assert!(error.is_some_and(|e| e.to_string().contains("did you mean \"float\"?")));
    Ok(())
}
