//! Examples and remedies of errors belong to the key of the error.

use super::*;

#[test]
fn an_example_has_the_key_of_the_error_at_its_place() {
    // The key of the error, and the words with which its example begins.
    for (key, right) in [
        ("damping.0.from", "from = ["),
        ("damping.0", "[[damping]]"),
        ("spring.0.damping", "damping = 2"),
        ("joint.0.motor.damping", "motor = { damping"),
        ("joint.0.breaks.force", "force = 3"),
        ("rope.1.breaks.tension", "tension = 3"),
        ("force.0.at", "at = [0.1"),
        ("solid.1.free.ballast.0.at", "at = [0.1"),
        ("mooring.0.clumps.0.at", "at = 1.0"),
        ("joint.0.at", "at = [2.0"),
        ("solid.0.at", "at = { x"),
        ("solid.0.at.angle_deg", "angle_deg = 5"),
        ("solid.0.shape.compound.1.at.angle_deg", "angle_deg = 5"),
        ("solid.0.driven.angle_deg", "angle_deg = { formula"),
        ("solid.0.driven.motions.1.distance", "distance = { formula"),
        ("solid.0.driven.wave.focused.distance", "distance = 4"),
        ("solid.0.driven.wave.focused.time", "time = 10"),
        ("current.response", "response = 2"),
        ("check.0.response", "response = { to"),
        ("solid.0.driven.distance.time", "time = \"t_s\""),
        ("check.0.time", "time = \"t_s\""),
        ("time", "[time]"),
        (".model", "[model]"),
        ("solid.0.shape.mesh.contact", "contact = \"hull\""),
        ("contact.0", "[[contact]]"),
        ("solid.0.shape.cylinder.axis", "axis = \"z\""),
        ("water.0.fill.shape.cone.axis", "axis = \"z\""),
        ("solid.0.shape.compound.0.shape.torus.axis", "axis = \"z\""),
        ("joint.0.axis", "axis = [0"),
        ("solid.0.shape.compound.0.shape.ball", "shape = { ball"),
        ("solid.0.shape.ball", "shape = { ball"),
        ("inflow.0.wave.regular.period", "regular = {"),
        ("probe.0.velocity", "velocity = [0.75"),
        ("towed.velocity", "velocity = \"0.5*min"),
        ("solid.0.free.velocity", "velocity = [0.5"),
    ] {
        let found = example(key).unwrap_or_default();
        assert!(found.starts_with(&format!("write  {right}")), "{key}: {found}");
    }
    // No example of these keys is known.
    for key in ["joint.0.kind.hinge", "joint.0.kind.fixed", "spring.0.contact", "solid.0.damping", "solid.0.at.mooring"]
    {
        assert_eq!(example(key), None, "{key}");
    }
}

#[test]
fn every_listed_key_is_one_of_a_scene() {
    let schema = crate::scene::schema::schema();
    for (key, _) in EXAMPLES.iter().filter(|(key, _)| !key.starts_with("*.")) {
        let path: Vec<&str> = key.split('.').collect();
        assert!(has_path(&schema, &schema, &path, 0), "a scene has no key {key}");
    }
}

/// Whether the schema at `node` has the key with this path.
fn has_path(root: &serde_json::Value, node: &serde_json::Value, path: &[&str], depth: usize) -> bool {
    let [first, rest @ ..] = path else { return true };
    if depth > 12 {
        return false;
    }
    let go = |node: &serde_json::Value, path: &[&str]| has_path(root, node, path, depth + 1);
    let target = node["$ref"].as_str().and_then(|name| root["$defs"].get(name.trim_start_matches("#/$defs/")));
    let choices = ["anyOf", "oneOf", "allOf"].into_iter().filter_map(|word| node[word].as_array()).flatten();
    target.is_some_and(|target| go(target, path))
        || choices.into_iter().any(|choice| go(choice, path))
        || node.get("items").is_some_and(|items| go(items, path))
        || node["properties"].get(*first).is_some_and(|inner| go(inner, rest))
}

#[test]
fn a_wrong_word_proposes_the_nearest_one() {
    let help = |message: &str, key: &str| explain(message, key).0.help.unwrap_or_default();
    let kinds = "expected one of `hinge`, `slider`, `fixed`, `ball`, `tow`, `generic`";
    for (word, near) in [("hnge", "hinge"), ("fixd", "fixed"), ("Slider", "slider"), ("twow", "tow")] {
        let help = help(&format!("unknown variant `{word}`, {kinds}"), "joint.0.kind");
        assert!(help.ends_with(&format!("write  kind = \"{near}\"")), "{word}: {help}");
    }
    let list = help("unknown variant `turnx`, expected one of `x`, `y`, `turn_x`", "solid.0.free.locked.0");
    assert!(list.ends_with("write  turn_x  in place of  turnx"), "{list}");
    let table = help("unknown variant `mesch`, expected one of `ball`, `mesh`", "solid.0.shape.mesch");
    assert!(table.ends_with("write  mesh  in place of  mesch"), "{table}");
    let table = help("unknown variant `bal`, expected one of `ball`, `mesh`", "solid.0.shape.bal");
    assert!(table.ends_with("write  shape = { ball = { radius = 0.1 } }"), "{table}");
}
