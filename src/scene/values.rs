//! Values in time as words: a number, a formula in t, or a law's table; one, or one for each component.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer},
};

use super::bodies::LawWords;

/// A value in time: a number, a formula in t, or a law's table.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema)]
pub struct ValueWords(#[schemars(with = "OneWord")] pub LawWords);

/// How a value may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
enum OneWord {
    /// A number.
    Number(f64),
    /// A formula.
    Text(String),
    /// A law.
    Law(LawWords),
}

impl ValueWords {
    /// The formula `text`, in t (s).
    pub fn formula(text: impl Into<String>) -> Self {
        Self(LawWords { formula: Some(text.into()), ..LawWords::default() })
    }

    /// The number, if it is one.
    pub(super) fn number(&self) -> Option<f64> {
        self.0.formula.as_ref().and_then(|text| text.parse().ok()).filter(|x: &f64| x.is_finite())
    }
}

impl From<f64> for ValueWords {
    fn from(x: f64) -> Self {
        Self::formula(format!("{x:?}"))
    }
}

impl Serialize for ValueWords {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (self.number(), &self.0) {
            (Some(x), _) => serializer.serialize_f64(x),
            (None, LawWords { formula: Some(text), .. }) => serializer.serialize_str(text),
            (None, words) => words.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for ValueWords {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        match ValuesWords::deserialize(deserializer)?.0 {
            Read::One(value) => Ok(value),
            Read::Many(_) => Err(de::Error::custom("a list, where one value is meant")),
        }
    }
}

/// One value in time, or one for each component.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
pub struct ValuesWords(Read);

#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(untagged)]
enum Read {
    One(ValueWords),
    Many(Vec<ValueWords>),
}

impl ValuesWords {
    /// These components.
    pub fn new(components: impl IntoIterator<Item = ValueWords>) -> Self {
        Self(Read::Many(components.into_iter().collect()))
    }

    /// The components.
    pub fn components(&self) -> &[ValueWords] {
        match &self.0 {
            Read::One(one) => std::slice::from_ref(one),
            Read::Many(many) => many,
        }
    }

    /// The components, to be filled in.
    pub(super) fn components_mut(&mut self) -> &mut [ValueWords] {
        match &mut self.0 {
            Read::One(one) => std::slice::from_mut(one),
            Read::Many(many) => many,
        }
    }
}

impl Serialize for ValuesWords {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0 {
            Read::One(one) => one.serialize(serializer),
            Read::Many(many) => many.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for ValuesWords {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = ValuesWords;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a number, a formula such as \"20*sin(2*pi*t)\", or a table with `file` and `column`")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<ValuesWords, E> {
                let words = ValueWords::formula(text);
                Ok(ValuesWords(Read::One(words.number().map_or(words, ValueWords::from))))
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<ValuesWords, E> {
                Ok(ValuesWords(Read::One(x.into())))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<ValuesWords, E> {
                Ok(ValuesWords(Read::One((x as f64).into())))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ValuesWords, A::Error> {
                let words = LawWords::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ValuesWords(Read::One(ValueWords(words))))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<ValuesWords, A::Error> {
                let mut many = Vec::new();
                while let Some(value) = seq.next_element()? {
                    many.push(value);
                }
                Ok(ValuesWords(Read::Many(many)))
            }
        }
        deserializer.deserialize_any(Words)
    }
}
