//! Values in time as words: a number, a formula in t, or a law's table; one, or one for each component.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer},
};

use super::bodies::TimeFunctionConfig;

/// A value in time: a number, a formula in t, or a law's table.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema)]
pub struct TimeValueConfig(#[schemars(with = "TimeValueForm")] pub TimeFunctionConfig);

/// How a value may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
enum TimeValueForm {
    /// A number.
    Number(f64),
    /// A formula.
    Text(String),
    /// A law.
    Law(TimeFunctionConfig),
}

impl TimeValueConfig {
    /// The formula `text`, in t (s).
    pub fn formula(text: impl Into<String>) -> Self {
        Self(TimeFunctionConfig { formula: Some(text.into()), ..TimeFunctionConfig::default() })
    }

    /// The number, if it is one.
    pub(super) fn number(&self) -> Option<f64> {
        self.0.formula.as_ref().and_then(|text| text.parse().ok()).filter(|x: &f64| x.is_finite())
    }
}

impl From<f64> for TimeValueConfig {
    fn from(x: f64) -> Self {
        Self::formula(format!("{x:?}"))
    }
}

impl Serialize for TimeValueConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (self.number(), &self.0) {
            (Some(x), _) => serializer.serialize_f64(x),
            (None, TimeFunctionConfig { formula: Some(text), .. }) => serializer.serialize_str(text),
            (None, words) => words.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for TimeValueConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        match TimeVectorConfig::deserialize(deserializer)?.0 {
            TimeVectorForm::One(value) => Ok(value),
            TimeVectorForm::Many(_) => Err(de::Error::custom("a list, where one value is meant")),
        }
    }
}

/// One value in time, or one for each component.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
pub struct TimeVectorConfig(TimeVectorForm);

#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(untagged)]
enum TimeVectorForm {
    One(TimeValueConfig),
    Many(Vec<TimeValueConfig>),
}

impl TimeVectorConfig {
    /// These components.
    pub fn new(components: impl IntoIterator<Item = TimeValueConfig>) -> Self {
        Self(TimeVectorForm::Many(components.into_iter().collect()))
    }

    /// The components.
    pub fn components(&self) -> &[TimeValueConfig] {
        match &self.0 {
            TimeVectorForm::One(one) => std::slice::from_ref(one),
            TimeVectorForm::Many(many) => many,
        }
    }

    /// The components, to be filled in.
    pub(super) fn components_mut(&mut self) -> &mut [TimeValueConfig] {
        match &mut self.0 {
            TimeVectorForm::One(one) => std::slice::from_mut(one),
            TimeVectorForm::Many(many) => many,
        }
    }
}

impl Serialize for TimeVectorConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0 {
            TimeVectorForm::One(one) => one.serialize(serializer),
            TimeVectorForm::Many(many) => many.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for TimeVectorConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = TimeVectorConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a number, a formula such as \"20*sin(2*pi*t)\", or a table with `file` and `column`")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<TimeVectorConfig, E> {
                let words = TimeValueConfig::formula(text);
                Ok(TimeVectorConfig(TimeVectorForm::One(words.number().map_or(words, TimeValueConfig::from))))
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<TimeVectorConfig, E> {
                Ok(TimeVectorConfig(TimeVectorForm::One(x.into())))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<TimeVectorConfig, E> {
                Ok(TimeVectorConfig(TimeVectorForm::One((x as f64).into())))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TimeVectorConfig, A::Error> {
                let words = TimeFunctionConfig::deserialize(MapAccessDeserializer::new(map))?;
                Ok(TimeVectorConfig(TimeVectorForm::One(TimeValueConfig(words))))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<TimeVectorConfig, A::Error> {
                let mut many = Vec::new();
                while let Some(value) = seq.next_element()? {
                    many.push(value);
                }
                Ok(TimeVectorConfig(TimeVectorForm::Many(many)))
            }
        }
        deserializer.deserialize_any(Words)
    }
}
