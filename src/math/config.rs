//! Boxes and arrays of numbers as a scene file writes them.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{self, SeqAccess, Visitor},
};

/// A box given by two corners.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct BoxConfig {
    /// Lowest corner, m.
    pub min: Vec<f64>,
    /// Highest corner, m.
    pub max: Vec<f64>,
}

/// A number, a list of numbers, or a list of rows.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum NumberOrArray {
    /// One.
    One(f64),
    /// A list.
    List(Vec<f64>),
    /// Rows of a matrix.
    Rows(Vec<Vec<f64>>),
}

impl<'de> Deserialize<'de> for NumberOrArray {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Form;
        impl<'de> Visitor<'de> for Form {
            type Value = NumberOrArray;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a number, a list of numbers, or a list of rows")
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<NumberOrArray, E> {
                Ok(NumberOrArray::One(x))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<NumberOrArray, E> {
                Ok(NumberOrArray::One(x as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<NumberOrArray, A::Error> {
                let (mut list, mut rows) = (Vec::new(), Vec::new());
                while let Some(entry) = seq.next_element::<NumberOrArray>()? {
                    match entry {
                        NumberOrArray::One(x) => list.push(x),
                        NumberOrArray::List(row) => rows.push(row),
                        NumberOrArray::Rows(_) => return Err(de::Error::custom("a list nested too deep")),
                    }
                }
                match (list.is_empty(), rows.is_empty()) {
                    (_, true) => Ok(NumberOrArray::List(list)),
                    (true, false) => Ok(NumberOrArray::Rows(rows)),
                    (false, false) => Err(de::Error::custom("a list that mixes numbers and lists")),
                }
            }
        }
        deserializer.deserialize_any(Form)
    }
}
