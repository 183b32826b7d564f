//! The keys of a scene as a JSON schema, for editors, generated from the types that read them.
//!
//! The schema requires exactly one key of each set of alternatives (for a solid: `fixed`, `driven` or `free`), and the value
//! `true` where no other value is valid (`fixed`). It does not check other rules, such as that a vector has one number for each
//! dimension.

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

use super::Scene;

/// Types whose choices may be written as bare words, as `viscosity = "artificial"`.
const CHOICES: [&str; 9] = [
    "KernelKind",
    "PressureGradient",
    "Viscosity",
    "Diffusion",
    "Shifting",
    "Walls",
    "Slip",
    "PairLoopKind",
    "TimeScheme",
];

/// The name of a type, and a function that selects its alternative keys. A scene sets exactly one alternative.
type Kinds = (&'static str, fn(&str) -> bool);

/// The alternatives of a solid, of the mass of a body, of the region of water, of a probe and of a statistic.
const KINDS: [Kinds; 5] = [
    ("SolidConfig", |key| matches!(key, "fixed" | "driven" | "free")),
    ("FreeBodyConfig", |key| matches!(key, "density" | "mass")),
    ("FillConfig", |key| matches!(key, "box" | "shape")),
    ("ProbeConfig", |key| !matches!(key, "name" | "every" | "average")),
    ("StatisticConfig", |key| !matches!(key, "name" | "period" | "depth" | "from" | "until")),
];

/// Returns the JSON schema (draft 2020-12) of a scene.
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

/// Requires exactly one of the alternative keys of a type.
fn require_one_of(words: &mut Value, is_kind: fn(&str) -> bool) {
    let keys = words["properties"].as_object().into_iter().flatten().map(|(key, _)| key);
    let kinds: Value = keys.filter(|key| is_kind(key)).map(|key| json!({ "required": [key] })).collect();
    words["oneOf"] = kinds;
}

/// Removes null as a value of a key, because TOML has no null.
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
                // A choice with a single remaining alternative is replaced by this alternative.
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

/// Accepts the alias of a value, which its type declares as `also`, in addition to the value.
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

/// Accepts each alternative of a choice as a bare word or as an empty table.
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
