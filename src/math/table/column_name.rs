//! Names of the columns of tables, as a scene gives them.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, de};

/// A column of a table: its name, or its number from 1.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ColumnName {
    /// Its number, from 1.
    Number(u64),
    /// Its name in the header.
    Name(String),
}

impl fmt::Display for ColumnName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => write!(f, "{name}"),
        }
    }
}

impl Default for ColumnName {
    fn default() -> Self {
        Self::Name(String::new())
    }
}

impl From<&str> for ColumnName {
    fn from(name: &str) -> Self {
        Self::Name(name.into())
    }
}

impl From<String> for ColumnName {
    fn from(name: String) -> Self {
        Self::Name(name)
    }
}

impl From<&Self> for ColumnName {
    fn from(name: &Self) -> Self {
        name.clone()
    }
}

impl<'de> Deserialize<'de> for ColumnName {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Form;
        impl de::Visitor<'_> for Form {
            type Value = ColumnName;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "the name of a column, or its number from 1")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<ColumnName, E> {
                Ok(name.into())
            }
            fn visit_i64<E: de::Error>(self, number: i64) -> Result<ColumnName, E> {
                let number = u64::try_from(number).ok().filter(|number| *number > 0);
                number.map(ColumnName::Number).ok_or_else(|| E::custom("columns are counted from 1"))
            }
            fn visit_u64<E: de::Error>(self, number: u64) -> Result<ColumnName, E> {
                self.visit_i64(i64::try_from(number).unwrap_or(0))
            }
        }
        deserializer.deserialize_any(Form)
    }
}
