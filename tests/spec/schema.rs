//! The JSON schema of scenes takes what the program takes, and tells what it refuses.

use std::{collections::BTreeSet, fs, path::Path};

use pontoon::scene::{Scene, schema};
use serde_json::{Value, json};

/// Keywords that say nothing of whether a value is right.
const SAID: [&str; 7] = ["$schema", "title", "description", "default", "format", "$defs", "examples"];

/// What is wrong with `value` by the `schema` under `root`; a keyword that is not known here fails the test.
fn wrong(root: &Value, schema: &Value, value: &Value, at: &str) -> Vec<String> {
    let Some(rules) = schema.as_object() else {
        return if schema == &json!(false) { vec![format!("{at} is not known")] } else { vec![] };
    };
    let of = |schema: &Value| wrong(root, schema, value, at);
    let list = |rule: &Value| rule.as_array().cloned().unwrap_or_default();
    let said = |ok: bool, what: &str| if ok { vec![] } else { vec![format!("{at}: {what}")] };
    let mut found = Vec::new();
    for (keyword, rule) in rules {
        found.extend(match keyword.as_str() {
            "$ref" => of(root.pointer(rule.as_str().unwrap().trim_start_matches('#')).unwrap()),
            "type" => {
                let types = if rule.is_array() { list(rule) } else { vec![rule.clone()] };
                said(types.iter().any(|word| is(word.as_str().unwrap(), value)), &format!("is no {rule}"))
            }
            "const" => said(rule == value, &format!("is not {rule}")),
            "enum" => said(list(rule).contains(value), &format!("is none of {rule}")),
            "anyOf" => said(list(rule).iter().any(|kind| of(kind).is_empty()), "is of no kind"),
            "oneOf" => said(list(rule).iter().filter(|kind| of(kind).is_empty()).count() == 1, "is not of one kind"),
            "required" => {
                let missing = list(rule)
                    .into_iter()
                    .filter(|key| value.is_object() && value.get(key.as_str().unwrap()).is_none());
                missing.map(|key| format!("{at} lacks {key}")).collect()
            }
            "minimum" => said(value.as_f64().is_none_or(|x| x >= rule.as_f64().unwrap()), "is too small"),
            "maximum" => said(value.as_f64().is_none_or(|x| x <= rule.as_f64().unwrap()), "is too large"),
            "minItems" => {
                said(value.as_array().is_none_or(|x| x.len() as u64 >= rule.as_u64().unwrap()), "is too short")
            }
            "maxItems" => {
                said(value.as_array().is_none_or(|x| x.len() as u64 <= rule.as_u64().unwrap()), "is too long")
            }
            "minProperties" => {
                said(value.as_object().is_none_or(|x| x.len() as u64 >= rule.as_u64().unwrap()), "says too little")
            }
            "maxProperties" => {
                said(value.as_object().is_none_or(|x| x.len() as u64 <= rule.as_u64().unwrap()), "says too much")
            }
            "items" => value.as_array().into_iter().flatten().flat_map(|x| wrong(root, rule, x, at)).collect(),
            "prefixItems" => value
                .as_array()
                .into_iter()
                .flatten()
                .zip(list(rule))
                .flat_map(|(x, rule)| wrong(root, &rule, x, at))
                .collect(),
            "properties" | "additionalProperties" => vec![],
            known if SAID.contains(&known) => vec![],
            other => panic!("the keyword {other} is not known here"),
        });
    }
    for (key, value) in value.as_object().into_iter().flatten() {
        let own = rules.get("properties").and_then(|own| own.get(key)).or(rules.get("additionalProperties"));
        found.extend(own.into_iter().flat_map(|own| wrong(root, own, value, &format!("{at}.{key}"))));
    }
    found
}

fn is(word: &str, value: &Value) -> bool {
    match word {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        other => panic!("the type {other} is not known here"),
    }
}

fn of(text: &str) -> Vec<String> {
    let value: Value = serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap();
    let schema = schema();
    wrong(&schema, &schema, &value, "scene")
}

#[test]
fn every_shipped_scene_keeps_the_schema() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = fs::read_dir(scenes).unwrap().flatten().map(|entry| entry.path().join("scene.toml"));
    let files: Vec<_> = files.filter(|file| file.is_file()).collect();
    assert!(files.len() > 15, "the scenes were found");
    for file in files {
        let wrong = of(&fs::read_to_string(&file).unwrap());
        assert!(wrong.is_empty(), "{}: {wrong:?}", file.display());
    }
}

const SCENE: &str =
    "dimension = 2\ndp = 0.02\nuntil = 1\n[[water]]\nfill = { box = { min = [0, 0], max = [1.0, 0.4] } }\n";

#[test]
fn words_in_each_of_their_forms_keep_the_schema() {
    for words in [
        "[model]\nviscosity = \"none\"\nkernel = \"cubic\"\nslip = \"free\"",
        "[model]\nviscosity = { laminar = { nu0 = 1e-6 } }\nshifting = \"everywhere\"\ndiffusion = { none = {} }",
        "[time]\nscheme = { verlet = {} }",
        "[frames]\nevery = 0.1\nbox = { min = [0.0, 0.0], max = [1.0, 1.0] }",
        "[[probe]]\nelevation = { from = 0.1, to = [0.4], count = 4, surface = \"all\" }\naverage = true",
        "[[probe]]\nvelocity = [0.1, 0.2]\n[[probe]]\npressure = { from = [0.1, 0.1], to = [0.2, 0.1], spacing = 0.01 }",
        "[[joint]]\nname = \"a\"\nkind = \"hinge\"\nbetween = [\"box\"]\nat = [0, 0]",
        "[[joint]]\nname = \"a\"\nkind = \"revolute\"\nbetween = [\"box\"]\nat = [0, 0]",
        "[[joint]]\nname = \"a\"\nkind = \"prismatic\"\nbetween = [\"box\"]\nat = [0, 0]\nalong = [1, 0]",
        "[[joint]]\nname = \"a\"\nkind = \"generic\"\nbetween = [\"box\"]\nat = [0, 0]\nfree = [\"y\", \"turn\"]\nlimits = { y = [-0.1, 0.1] }",
        "[[joint]]\nname = \"a\"\nkind = \"slider\"\nbetween = [\"box\"]\nat = [0, 0]\nalong = [1, 0]\nlimits = [-0.1, 0.1]",
        "[[statistic]]\nrao = { motion = \"box\", wave = \"gauge\" }",
        "[[force]]\nname = \"wind\"\non = \"box\"\nforce = [\"20*sin(t)\", 0.0]\ntorque = 2",
        "[[solid]]\nname = \"a\"\nshape = { polygon = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }\nat = { draft = \"equilibrium\" }\nfree = { density = 500 }",
        "[[solid]]\nname = \"a\"\nshape = { polygon = { file = \"a.svg\", unit = \"mm\" } }\nat = { draft = 0.1 }\nfixed = true",
    ] {
        let wrong = of(&format!("{SCENE}{words}\n"));
        assert!(wrong.is_empty(), "{words}: {wrong:?}");
    }
    assert!(of(&format!("frames = \"off\"\n{SCENE}")).is_empty());
}

#[test]
fn a_misspelt_key_and_a_wrong_word_break_the_schema() {
    for (words, expected) in [
        ("[[solid]]\nname = \"a\"\nsahpe = { ball = { radius = 0.1 } }", "sahpe"),
        ("[model]\nviscosity = \"artifical\"", "viscosity"),
        ("[model]\ngamma = \"7\"", "gamma"),
        ("[[probe]]\nelevation = { z = 1.0 }", "elevation.z"),
        ("[frames]\nevry = 0.1", "frames"),
        ("[[joint]]\nkind = \"revolving\"", "kind"),
    ] {
        let wrong = of(&format!("{SCENE}{words}\n"));
        assert!(wrong.iter().any(|wrong| wrong.contains(expected)), "{words}: {wrong:?}");
    }
    assert!(of("dimension = 2\ndp = 0.1").iter().any(|wrong| wrong.contains("until")), "what is needed is told");
}

#[test]
fn a_solid_has_one_role_a_body_one_weight_and_a_probe_looks_at_one_thing() {
    let solid = "[[solid]]\nname = \"a\"\nshape = { ball = { radius = 0.1 } }\n";
    for (words, at) in [
        (format!("{solid}fixed = true\nfree = {{ density = 500 }}"), "scene.solid"),
        (solid.to_string(), "scene.solid"),
        (format!("{solid}free = {{ density = 500, mass = 1 }}"), "scene.solid.free"),
        (format!("{solid}free = {{ velocity = [0, 0] }}"), "scene.solid.free"),
        ("[[probe]]\nmotion = \"a\"\nforce = \"a\"".into(), "scene.probe"),
        ("[[probe]]\nname = \"a\"\nevery = 0.1\naverage = true".into(), "scene.probe"),
        ("[[statistic]]\nwaves = \"a.eta_m\"\nreflection = [\"b\"]".into(), "scene.statistic"),
        ("[[statistic]]\nperiod = 1.2".into(), "scene.statistic"),
        ("[[water]]\nlevel = 0.1\nfill = {}".into(), "scene.water.fill"),
    ] {
        let wrong = of(&format!("{SCENE}{words}\n"));
        assert!(wrong.contains(&format!("{at}: is not of one kind")), "{words}: {wrong:?}");
    }
    for role in ["fixed = true", "free = { mass = 1 }", "driven = { along = [1, 0], distance = { formula = \"t\" } }"] {
        assert!(of(&format!("{SCENE}{solid}{role}\n")).is_empty(), "{role}");
    }
    for probe in ["motion = \"a\"", "force = \"a\"", "front = true", "energy = true", "budget = true"] {
        let wrong = of(&format!("{SCENE}[[probe]]\nname = \"b\"\nevery = 0.1\n{probe}\n"));
        assert!(wrong.is_empty(), "{probe}: {wrong:?}");
    }
}

#[test]
fn what_can_only_be_true_is_refused_as_false_by_schema_and_program_alike() {
    let solid = "[[solid]]\nname = \"a\"\nshape = { ball = { radius = 0.1 } }\nat = { x = 0.5, y = 0.2 }\n";
    let probe = "[[probe]]\nname = \"b\"\n";
    for (section, key, at) in [
        (solid, "fixed", "scene.solid.fixed"),
        (probe, "front", "scene.probe.front"),
        (probe, "energy", "scene.probe.energy"),
        (probe, "budget", "scene.probe.budget"),
        (probe, "contacts", "scene.probe.contacts"),
    ] {
        let scene = |value: bool| format!("{SCENE}{section}{key} = {value}\n");
        let refused = |text: &str| Scene::parse(text, ".".as_ref(), &[]).and_then(|scene| scene.plan()).err();
        assert!(
            of(&scene(true)).is_empty() && refused(&scene(true)).is_none(),
            "{key} = true: {:?}",
            refused(&scene(true))
        );
        let (wrong, why) = (of(&scene(false)), refused(&scene(false)).map(|e| e.to_string()));
        assert_eq!(wrong, [format!("{at}: is not true")]);
        assert!(why.as_ref().is_some_and(|why| why.contains(&format!("{key} = false"))), "{key} = false: {why:?}");
    }
}

/// The keys and words that a schema knows, wherever they stand in it.
pub fn known(schema: &Value, found: &mut BTreeSet<String>) {
    if let Some(keys) = schema.get("properties").and_then(Value::as_object) {
        found.extend(keys.keys().cloned());
    }
    let words = schema.get("enum").and_then(Value::as_array).into_iter().flatten().chain(schema.get("const"));
    found.extend(words.filter_map(Value::as_str).map(String::from));
    match schema {
        Value::Object(all) => all.values().for_each(|inner| known(inner, found)),
        Value::Array(all) => all.iter().for_each(|inner| known(inner, found)),
        _ => {}
    }
}

#[test]
fn every_key_and_word_of_a_scene_is_in_its_reference() {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md")).unwrap();
    // What stands between back-quotes, in pieces.
    let code = text.split('`').skip(1).step_by(2);
    let said: BTreeSet<&str> = code.flat_map(|code| code.split(|c: char| !c.is_alphanumeric() && c != '_')).collect();
    let mut words = BTreeSet::new();
    known(&schema(), &mut words);
    assert!(words.len() > 150, "the words were found: {}", words.len());
    let missing: Vec<&String> = words.iter().filter(|word| !said.contains(word.as_str())).collect();
    assert!(missing.is_empty(), "not in docs/scene.md: {missing:?}");
}
