//! The JSON schema of scenes accepts the scenes that the program accepts, and reports the faults that it refuses.

use std::{collections::BTreeSet, fs, path::Path};

use pontoon::scene::{Scene, schema};
use serde_json::{Value, json};

use super::reference::{code_names, page};

/// Keywords without effect on validity.
const ANNOTATIONS: [&str; 8] =
    ["$schema", "title", "description", "default", "format", "$defs", "examples", "deprecated"];

/// Violations of `schema`, a part of `root`, by `value`. An unknown keyword fails the test.
fn violations(root: &Value, schema: &Value, value: &Value, path: &str) -> Vec<String> {
    let Some(rules) = schema.as_object() else {
        return if schema == &json!(false) { vec![format!("{path} is unknown")] } else { vec![] };
    };
    let of = |schema: &Value| violations(root, schema, value, path);
    let list = |rule: &Value| rule.as_array().cloned().unwrap_or_default();
    let require = |valid: bool, message: &str| if valid { vec![] } else { vec![format!("{path}: {message}")] };
    let mut found = Vec::new();
    for (keyword, rule) in rules {
        found.extend(match keyword.as_str() {
            "$ref" => of(root.pointer(rule.as_str().unwrap().trim_start_matches('#')).unwrap()),
            "type" => {
                let types = if rule.is_array() { list(rule) } else { vec![rule.clone()] };
                let valid = types.iter().any(|name| has_type(name.as_str().unwrap(), value));
                require(valid, &format!("has not the type {rule}"))
            }
            "const" => require(rule == value, &format!("is not {rule}")),
            "enum" => require(list(rule).contains(value), &format!("is none of {rule}")),
            "anyOf" => require(list(rule).iter().any(|kind| of(kind).is_empty()), "is of no kind"),
            "oneOf" => require(list(rule).iter().filter(|kind| of(kind).is_empty()).count() == 1, "is not of one kind"),
            "required" => {
                let missing = list(rule)
                    .into_iter()
                    .filter(|key| value.is_object() && value.get(key.as_str().unwrap()).is_none());
                missing.map(|key| format!("{path} lacks {key}")).collect()
            }
            "minimum" => require(value.as_f64().is_none_or(|x| x >= rule.as_f64().unwrap()), "is too small"),
            "maximum" => require(value.as_f64().is_none_or(|x| x <= rule.as_f64().unwrap()), "is too large"),
            "minItems" => {
                require(value.as_array().is_none_or(|x| x.len() as u64 >= rule.as_u64().unwrap()), "is too short")
            }
            "maxItems" => {
                require(value.as_array().is_none_or(|x| x.len() as u64 <= rule.as_u64().unwrap()), "is too long")
            }
            "minProperties" => {
                require(value.as_object().is_none_or(|x| x.len() as u64 >= rule.as_u64().unwrap()), "has too few keys")
            }
            "maxProperties" => {
                require(value.as_object().is_none_or(|x| x.len() as u64 <= rule.as_u64().unwrap()), "has too many keys")
            }
            "items" => value.as_array().into_iter().flatten().flat_map(|x| violations(root, rule, x, path)).collect(),
            "prefixItems" => value
                .as_array()
                .into_iter()
                .flatten()
                .zip(list(rule))
                .flat_map(|(x, rule)| violations(root, &rule, x, path))
                .collect(),
            "properties" | "additionalProperties" => vec![],
            keyword if ANNOTATIONS.contains(&keyword) => vec![],
            other => panic!("the keyword {other} is unknown here"),
        });
    }
    for (key, value) in value.as_object().into_iter().flatten() {
        let own = rules.get("properties").and_then(|own| own.get(key)).or(rules.get("additionalProperties"));
        found.extend(own.into_iter().flat_map(|own| violations(root, own, value, &format!("{path}.{key}"))));
    }
    found
}

/// Whether a value has the type of this name in JSON schema.
fn has_type(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        other => panic!("the type {other} is unknown here"),
    }
}

/// Violations of the schema by the text of a scene.
fn violations_of_scene(text: &str) -> Vec<String> {
    let value: Value = serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap();
    let schema = schema();
    violations(&schema, &schema, &value, "scene")
}

#[test]
fn every_bundled_scene_is_valid_by_the_schema() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = fs::read_dir(scenes).unwrap().flatten().map(|entry| entry.path().join("scene.toml"));
    let files: Vec<_> = files.filter(|file| file.is_file()).collect();
    assert!(files.len() > 15, "{} scenes were found", files.len());
    for file in files {
        let wrong = violations_of_scene(&fs::read_to_string(&file).unwrap());
        assert!(wrong.is_empty(), "{}: {wrong:?}", file.display());
    }
}

const SCENE: &str =
    "dimension = 2\ndp = 0.02\nuntil = 1\n[[water]]\nfill = { box = { min = [0, 0], max = [1.0, 0.4] } }\n";

#[test]
fn every_form_of_a_key_is_valid_by_the_schema() {
    for keys in [
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
        "[[joint]]\nname = \"a\"\nkind = \"fixed\"\nbetween = [\"box\"]\nat = [0, 0]\nfrom = 0.1",
        "[[force]]\nname = \"wind\"\non = \"box\"\nforce = [1, 0]\nfrom = 0.1",
        "[model]\nwalls = \"settling\"",
        "[[solid]]\nname = \"a\"\nshape = { ball = { radius = 0.1 } }\nat = [0.5, 1]\nfixed = true\nskin = 0.01",
        "[[check]]\nseries = \"a.x_m\"\nreference = \"a.csv\"\ndelay = 0.1",
        "[[statistic]]\nrao = { motion = \"box\", wave = \"gauge\" }",
        "[[force]]\nname = \"wind\"\non = \"box\"\nforce = [\"20*sin(t)\", 0.0]\ntorque = 2",
        "[[solid]]\nname = \"a\"\nshape = { polygon = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }\nat = { draft = \"equilibrium\" }\nfree = { density = 500 }",
        "[[solid]]\nname = \"a\"\nshape = { polygon = { file = \"a.svg\", unit = \"mm\" } }\nat = { draft = 0.1 }\nfixed = true",
    ] {
        let wrong = violations_of_scene(&format!("{SCENE}{keys}\n"));
        assert!(wrong.is_empty(), "{keys}: {wrong:?}");
    }
    for top in ["frames = \"off\"", "jitter = 0.01", "scatter = 0.01"] {
        let wrong = violations_of_scene(&format!("{top}\n{SCENE}"));
        assert!(wrong.is_empty(), "{top}: {wrong:?}");
    }
}

#[test]
fn a_misspelt_key_or_value_violates_the_schema() {
    for (keys, expected) in [
        ("[[solid]]\nname = \"a\"\nsahpe = { ball = { radius = 0.1 } }", "sahpe"),
        ("[model]\nviscosity = \"artifical\"", "viscosity"),
        ("[model]\ngamma = \"7\"", "gamma"),
        ("[[probe]]\nelevation = { z = 1.0 }", "elevation.z"),
        ("[frames]\nevry = 0.1", "frames"),
        ("[[solid]]\nname = \"a\"\nshape = { ball = { radius = 0.1 } }\nat = [0.5, \"bed\"]\nfixed = true", "at"),
        ("[[joint]]\nkind = \"revolving\"", "kind"),
    ] {
        let wrong = violations_of_scene(&format!("{SCENE}{keys}\n"));
        assert!(wrong.iter().any(|wrong| wrong.contains(expected)), "{keys}: {wrong:?}");
    }
    assert!(
        violations_of_scene("dimension = 2\ndp = 0.1").iter().any(|wrong| wrong.contains("until")),
        "a missing required key is reported"
    );
}

#[test]
fn the_schema_requires_exactly_one_role_of_a_solid_one_mass_of_a_body_and_one_quantity_of_a_probe() {
    let solid = "[[solid]]\nname = \"a\"\nshape = { ball = { radius = 0.1 } }\n";
    for (keys, path) in [
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
        let wrong = violations_of_scene(&format!("{SCENE}{keys}\n"));
        assert!(wrong.contains(&format!("{path}: is not of one kind")), "{keys}: {wrong:?}");
    }
    for role in ["fixed = true", "free = { mass = 1 }", "driven = { along = [1, 0], distance = { formula = \"t\" } }"] {
        assert!(violations_of_scene(&format!("{SCENE}{solid}{role}\n")).is_empty(), "{role}");
    }
    for probe in ["motion = \"a\"", "force = \"a\"", "front = true", "energy = true", "budget = true"] {
        let wrong = violations_of_scene(&format!("{SCENE}[[probe]]\nname = \"b\"\nevery = 0.1\n{probe}\n"));
        assert!(wrong.is_empty(), "{probe}: {wrong:?}");
    }
}

#[test]
fn schema_and_program_refuse_false_for_keys_that_can_only_be_true() {
    let solid = "[[solid]]\nname = \"a\"\nshape = { ball = { radius = 0.1 } }\nat = { x = 0.5, y = 0.2 }\n";
    let probe = "[[probe]]\nname = \"b\"\n";
    for (section, key, path) in [
        (solid, "fixed", "scene.solid.fixed"),
        (probe, "front", "scene.probe.front"),
        (probe, "energy", "scene.probe.energy"),
        (probe, "budget", "scene.probe.budget"),
        (probe, "contacts", "scene.probe.contacts"),
    ] {
        let scene = |value: bool| format!("{SCENE}{section}{key} = {value}\n");
        let refused = |text: &str| Scene::parse(text, ".".as_ref(), &[]).and_then(|scene| scene.plan()).err();
        assert!(
            violations_of_scene(&scene(true)).is_empty() && refused(&scene(true)).is_none(),
            "{key} = true: {:?}",
            refused(&scene(true))
        );
        let (wrong, why) = (violations_of_scene(&scene(false)), refused(&scene(false)).map(|e| e.to_string()));
        assert_eq!(wrong, [format!("{path}: is not true")]);
        assert!(why.as_ref().is_some_and(|why| why.contains(&format!("{key} = false"))), "{key} = false: {why:?}");
    }
}

/// Adds the keys and choices of a schema at every depth to `names`.
pub fn collect_names(schema: &Value, names: &mut BTreeSet<String>) {
    if let Some(keys) = schema.get("properties").and_then(Value::as_object) {
        names.extend(keys.keys().cloned());
    }
    let choices = schema.get("enum").and_then(Value::as_array).into_iter().flatten().chain(schema.get("const"));
    names.extend(choices.filter_map(Value::as_str).map(String::from));
    match schema {
        Value::Object(entries) => entries.values().for_each(|inner| collect_names(inner, names)),
        Value::Array(items) => items.iter().for_each(|inner| collect_names(inner, names)),
        _ => {}
    }
}

#[test]
fn every_key_and_choice_of_a_scene_is_in_the_scene_reference() {
    let (page, mut names) = (page("scene.md"), BTreeSet::new());
    collect_names(&schema(), &mut names);
    assert!(names.len() > 150, "{} names were found", names.len());
    let known = code_names(&page);
    let missing: Vec<&String> = names.iter().filter(|name| !known.contains(name.as_str())).collect();
    assert!(missing.is_empty(), "not in scene.md: {missing:?}");
}
