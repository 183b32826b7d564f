//! The words of a scene as a JSON schema, for editors: made from the types that read them, so that it cannot drift.
//!
//! Where exactly one key of several is to be said (`fixed`, `driven`, `free` of a solid), it says so, and where only `true` can
//! be meant (`fixed`). It is coarser than the program where words depend on one another otherwise (as many numbers as dimensions).

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

use super::Scene;

/// Types whose choices may be written as bare words, as `viscosity = "artificial"`.
const CHOICES: [&str; 9] =
    ["Kernel", "Gradient", "Viscosity", "Diffusion", "Shifting", "Walls", "Slip", "Sweeping", "Scheme"];

/// A type, and which of its keys are those of which exactly one is said.
type Kinds = (&'static str, fn(&str) -> bool);

/// What a solid, a body's weight, a water's room, a probe and a statistic are.
const KINDS: [Kinds; 5] = [
    ("SolidWords", |key| matches!(key, "fixed" | "driven" | "free")),
    ("FreeWords", |key| matches!(key, "density" | "mass")),
    ("FillWords", |key| matches!(key, "box" | "shape")),
    ("ProbeConfig", |key| !matches!(key, "name" | "every" | "average")),
    ("StatisticEntry", |key| !matches!(key, "name" | "period" | "depth" | "from" | "until")),
];

/// The JSON schema (draft 2020-12) of a scene.
pub fn schema() -> Value {
    let settings = SchemaSettings::draft2020_12().for_deserialize();
    let mut schema = settings.into_generator().into_root_schema_for::<Scene>().to_value();
    schema["title"] = json!("A scene of pontoon");
    required_only(&mut schema);
    expand_aliases(&mut schema);
    if let Some(types) = schema.get_mut("$defs").and_then(Value::as_object_mut) {
        types
            .iter_mut()
            .filter(|(name, _)| CHOICES.contains(&name.as_str()))
            .for_each(|(_, choice)| allow_bare_words(choice));
        for (name, is_kind) in KINDS {
            types.get_mut(name).into_iter().for_each(|words| require_one_of(words, is_kind));
        }
    }
    schema
}

/// Says of a type that exactly one of the keys that are its kinds is there.
fn require_one_of(words: &mut Value, is_kind: fn(&str) -> bool) {
    let keys = words["properties"].as_object().into_iter().flatten().map(|(key, _)| key);
    let kinds: Value = keys.filter(|key| is_kind(key)).map(|key| json!({ "required": [key] })).collect();
    words["oneOf"] = kinds;
}

/// Takes out that a key may be null: TOML has none.
fn required_only(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if let Some(Value::Array(types)) = map.get_mut("type") {
                types.retain(|name| name != "null");
                if let [one] = &types[..] {
                    map["type"] = one.clone();
                }
            }
            if let Some(Value::Array(kinds)) = map.get_mut("anyOf") {
                kinds.retain(|kind| *kind != json!({ "type": "null" }));
                // What is left of a choice between something and nothing is no choice.
                if let [Value::Object(one)] = &kinds[..] {
                    let one = one.clone();
                    map.remove("anyOf");
                    map.extend(one);
                }
            }
            if map.get("default") == Some(&Value::Null) {
                map.remove("default");
            }
            map.values_mut().for_each(required_only);
        }
        Value::Array(items) => items.iter_mut().for_each(required_only),
        _ => {}
    }
}

/// Takes a word's second name, which its type has noted as `also` beside its alias, for as good as its first.
fn expand_aliases(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if let Some(also) = map.remove("also")
                && let Some(word) = map.remove("const")
            {
                map.insert("enum".into(), json!([word, also]));
            }
            map.values_mut().for_each(expand_aliases);
        }
        Value::Array(items) => items.iter_mut().for_each(expand_aliases),
        _ => {}
    }
}

/// Adds to a choice of several that each of them may be written as a bare word, or as a table of nothing.
fn allow_bare_words(choice: &mut Value) {
    let mut tables = Map::new();
    let kinds = choice.get("oneOf").and_then(Value::as_array).into_iter().flatten().chain([&*choice]);
    for kind in kinds {
        let bare =
            kind.get("const").into_iter().chain(kind.get("enum").and_then(Value::as_array).into_iter().flatten());
        tables.extend(bare.filter_map(Value::as_str).map(|word| (word.to_string(), json!({ "type": "object" }))));
        let own = kind.get("properties").and_then(Value::as_object).into_iter().flatten();
        tables.extend(own.map(|(word, words)| (word.clone(), words.clone())));
    }
    let words: Vec<&String> = tables.keys().collect();
    *choice = json!({
        "description": choice["description"],
        "anyOf": [
            { "enum": words },
            {
                "type": "object", "properties": tables, "additionalProperties": false, "minProperties": 1, "maxProperties": 1,
            },
        ],
    });
}
