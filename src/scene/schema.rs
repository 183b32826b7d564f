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
        types.get_mut("PlacementConfig").into_iter().for_each(allow_position);
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

/// Accepts the coordinates of a position (m) in place of a table.
fn allow_position(placement: &mut Value) {
    let position = json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 3 });
    let description = placement["description"].take();
    *placement = json!({ "description": description, "anyOf": [position, placement.take()] });
}

/// Accepts the alias of a value or of a key, which its type declares as `also`, in addition to the value or the key.
fn expand_aliases(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if let Some(Value::Object(keys)) = map.get_mut("properties") {
                let aliases: Vec<(String, Value)> = keys.values_mut().filter_map(key_alias).collect();
                keys.extend(aliases);
            }
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

/// Takes the alias of a key out of the schema of its value, if it declares one. Returns the alias and its schema, which marks it as
/// deprecated.
fn key_alias(value: &mut Value) -> Option<(String, Value)> {
    let map = value.as_object_mut()?;
    let Some(Value::String(alias)) = map.remove("also") else { return None };
    let mut schema = Value::Object(map.clone());
    schema["deprecated"] = json!(true);
    Some((alias, schema))
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
