//! Values that depend on time: a formula, a column of a table, a number.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer},
};

use crate::{
    error,
    math::{expression::Formula, time_series::TimeSeries},
    scene::{
        context::{Context, Defaults},
        table,
    },
    solid::TimeFunction,
};

/// The unit in which a law is written.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum CoordinateUnit {
    /// SI, whatever the quantity.
    Si,
    /// Radians, or degrees in a column whose name ends in `_deg`.
    Radians,
    /// Degrees.
    Degrees,
}

/// How a driven coordinate moves: `formula`, or `file` with `column`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TimeFunctionConfig {
    /// A formula in t (s), with sin, cos, exp, …, and pi.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// A table, beside the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Its column of values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<String>,
    /// Its column of times, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Factor on the values of the table, –.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
}

impl TimeFunctionConfig {
    /// Refuses a law that is not either a formula or a column of a file.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> error::Result<()> {
        match (&self.formula, &self.file) {
            (Some(_), None) if self.column.is_none() && self.scale.is_none() && self.time.is_none() => Ok(()),
            (Some(_), None) => Err(ctx.error_at(key, "column, time and scale belong to a file, not to a formula")),
            (None, Some(_)) if self.column.is_some() => Ok(()),
            (None, Some(_)) => Err(ctx.error_at(key, "which column of the file?")),
            _ => Err(ctx.error_at(key, "a law is either a formula or a file with a column")),
        }
    }

    /// Fills in the defaults of a law from a table.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        if self.file.is_some() {
            defaults.fill(format!("{key}.time"), &mut self.time, "t_s".into(), "the name our own tables have");
            defaults.fill(format!("{key}.scale"), &mut self.scale, 1.0, "as in the table");
        }
    }

    /// The law, with the values in SI units.
    pub(crate) fn build(&self, ctx: &Context, key: &str, unit: CoordinateUnit) -> error::Result<TimeFunction> {
        let place = |word: &str, e: error::Error| ctx.with_location(e, &format!("{key}.{word}"));
        if let Some(text) = &self.formula {
            let formula = Formula::parse(text).map_err(|e| place("formula", e))?;
            return Ok(TimeFunction::Formula(match unit {
                CoordinateUnit::Degrees => {
                    Formula::parse(&format!("({text})*(pi/180)")).map_err(|e| place("formula", e))?
                }
                CoordinateUnit::Si | CoordinateUnit::Radians => formula,
            }));
        }
        let file = self.file.as_deref().unwrap_or("");
        let path = table::path_beside(ctx.folder(), file).map_err(|e| place("file", e))?;
        let column = self.column.as_deref().unwrap_or("");
        let time = self.time.as_deref().unwrap_or("");
        let series = table::read_series(&path, time, column).map_err(|e| place("column", e))?;
        let degrees = unit == CoordinateUnit::Degrees || (unit == CoordinateUnit::Radians && column.ends_with("_deg"));
        let factor = self.scale.unwrap_or(1.0) * if degrees { 1f64.to_radians() } else { 1.0 };
        let values: Vec<f64> = series.values().iter().map(|x| x * factor).collect();
        TimeSeries::new(series.times(), values).map(TimeFunction::Table).map_err(|e| place("scale", e))
    }
}

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

    /// Refuses a value that cannot be read.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> error::Result<()> {
        self.0.verify(ctx, key)?;
        match &self.0.formula {
            Some(text) => Formula::parse(text).map(|_| ()).map_err(|e| ctx.with_location(e, key)),
            None => Ok(()),
        }
    }

    /// The number, if it is one.
    pub(crate) fn number(&self) -> Option<f64> {
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
    pub(crate) fn components_mut(&mut self) -> &mut [TimeValueConfig] {
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
        struct Form;
        impl<'de> Visitor<'de> for Form {
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
        deserializer.deserialize_any(Form)
    }
}
