//! Values that may be written in more than one form: a number, a word, a formula, a list or a table.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{
        self, IntoDeserializer, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer,
        value::SeqAccessDeserializer,
    },
};

use super::{
    context::{Context, Defaults, quoted_list, set_keys},
    files, finite_law, record,
    section::shape::AxisName,
};
use crate::{
    error,
    math::{expression::Formula, table::ColumnName, time_series::SampleScaling},
    solid::TimeFunction,
};

/// A formula in the place, or a number.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FieldFormulaConfig(#[schemars(with = "NumberOrFormula")] pub String);

/// How a formula may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
enum NumberOrFormula {
    /// A number.
    Number(f64),
    /// A formula.
    Text(String),
}

impl<'de> Deserialize<'de> for FieldFormulaConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Form;
        impl Visitor<'_> for Form {
            type Value = FieldFormulaConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a number, or a formula such as \"0.1*sin(2*pi*x)\"")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<FieldFormulaConfig, E> {
                Ok(FieldFormulaConfig(text.into()))
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<FieldFormulaConfig, E> {
                Ok(FieldFormulaConfig(format!("{x:?}")))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<FieldFormulaConfig, E> {
                Ok(FieldFormulaConfig(x.to_string()))
            }
        }
        deserializer.deserialize_any(Form)
    }
}

/// One axis, or several.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct AxesConfig(#[schemars(with = "OneOrSeveralAxes")] pub Vec<AxisName>);

/// How axes may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
enum OneOrSeveralAxes {
    /// One axis.
    One(AxisName),
    /// Several axes.
    Several(Vec<AxisName>),
}

impl<'de> Deserialize<'de> for AxesConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Form;
        impl<'de> Visitor<'de> for Form {
            type Value = AxesConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "an axis, or a list of axes such as [\"x\", \"y\"]")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<AxesConfig, E> {
                Ok(AxesConfig(vec![AxisName::deserialize(name.into_deserializer())?]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<AxesConfig, A::Error> {
                Ok(AxesConfig(Vec::deserialize(SeqAccessDeserializer::new(list))?))
            }
        }
        deserializer.deserialize_any(Form)
    }
}

/// A draft: in metres, or the one at which the body floats at rest.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DraftChoice {
    /// At rest: where weight, buoyancy and ties balance.
    Equilibrium,
    /// Depth of the lowest point below the still level, m.
    #[schemars(untagged)]
    Metres(f64),
}

impl Serialize for DraftChoice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Equilibrium => serializer.serialize_str("equilibrium"),
            Self::Metres(draft) => serializer.serialize_f64(*draft),
        }
    }
}

impl<'de> Deserialize<'de> for DraftChoice {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Form;
        impl Visitor<'_> for Form {
            type Value = DraftChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "\"equilibrium\" or a number of metres")
            }
            fn visit_str<E: de::Error>(self, word: &str) -> Result<DraftChoice, E> {
                match word {
                    "equilibrium" => Ok(DraftChoice::Equilibrium),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_f64<E: de::Error>(self, metres: f64) -> Result<DraftChoice, E> {
                Ok(DraftChoice::Metres(metres))
            }
            fn visit_i64<E: de::Error>(self, metres: i64) -> Result<DraftChoice, E> {
                Ok(DraftChoice::Metres(metres as f64))
            }
        }
        deserializer.deserialize_any(Form)
    }
}

/// The unit of lengths in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum LengthUnit {
    /// Metres.
    #[default]
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
    /// Inches.
    In,
    /// Feet.
    Ft,
}

impl LengthUnit {
    /// Its length, m.
    pub(crate) fn metres(self) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 0.01,
            Self::Mm => 0.001,
            Self::In => 0.0254,
            Self::Ft => 0.3048,
        }
    }
}

/// A line: its points, a table with the columns `x_m` and `y_m`, or a drawing; as a wall it may have a thickness.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[schemars(with = "PointsOrTable")]
#[non_exhaustive]
pub struct PolylineConfig {
    /// Points, m.
    pub points: Option<Vec<Vec<f64>>>,
    /// A table of points, or a drawing (.svg), beside the scene.
    pub file: Option<String>,
    /// The outline's id in the drawing.
    pub id: Option<String>,
    /// Factor on the drawing's lengths, –; by default 1.
    pub scale: Option<f64>,
    /// Unit of a drawing that does not give its own size; by default m.
    pub unit: Option<LengthUnit>,
    /// Thickness of a wall, m; by default as many dp as the kernel reaches.
    pub thickness: Option<f64>,
    /// Whether a wall returns from its last point to its first; by default only if those are the same.
    pub closed: Option<bool>,
}

impl PolylineConfig {
    /// The line through `points` (m).
    pub(crate) fn through<const N: usize>(points: [[f64; 2]; N]) -> Self {
        Self { points: Some(points.iter().map(|p| p.to_vec()).collect()), ..Self::default() }
    }

    /// Whether its points are the outline of a drawing.
    pub(super) fn is_drawing(&self) -> bool {
        self.file.as_ref().is_some_and(|name| name.to_ascii_lowercase().ends_with(".svg"))
    }
}

/// A line as a table.
#[derive(Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct PolylineTable {
    /// Points, m.
    points: Option<Vec<Vec<f64>>>,
    /// A table of points, or a drawing (.svg), beside the scene.
    file: Option<String>,
    /// The outline's id in the drawing.
    id: Option<String>,
    /// Factor on the drawing's lengths, –; by default 1.
    scale: Option<f64>,
    /// Unit of a drawing that does not give its own size; by default m.
    unit: Option<LengthUnit>,
    /// Thickness of a wall, m; by default as many dp as the kernel reaches.
    thickness: Option<f64>,
    /// Whether a wall returns from its last point to its first; by default only if those are the same.
    closed: Option<bool>,
}

/// How a line may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
enum PointsOrTable {
    /// Points, m.
    Points(Vec<Vec<f64>>),
    /// A table.
    Table(PolylineTable),
}

impl<'de> Deserialize<'de> for PolylineConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Form;
        impl<'de> Visitor<'de> for Form {
            type Value = PolylineConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a list of points, or a table with `points` or `file`")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<PolylineConfig, A::Error> {
                let points = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(PolylineConfig { points: Some(points), ..PolylineConfig::default() })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<PolylineConfig, A::Error> {
                let PolylineTable { points, file, id, scale, unit, thickness, closed } =
                    PolylineTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(PolylineConfig { points, file, id, scale, unit, thickness, closed })
            }
        }
        deserializer.deserialize_any(Form)
    }
}

/// The unit in which a law is written.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum CoordinateUnit {
    /// This unit of the SI.
    Si(&'static str),
    /// Radians, or degrees in a column whose name ends in `_deg`.
    Radians,
    /// Degrees.
    Degrees,
}

/// How a driven coordinate moves: `formula`, or `file` with `column`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct TimeFunctionConfig {
    /// A formula in t (s), with sin, cos, exp, …, and pi.
    pub formula: Option<String>,
    /// A table, beside the scene.
    pub file: Option<String>,
    /// Its column of values.
    pub column: Option<ColumnName>,
    /// Its column of times, s.
    pub time: Option<ColumnName>,
    /// Factor on the values of the table, –.
    pub scale: Option<f64>,
    /// Factor on the times of the table, –.
    pub time_factor: Option<f64>,
    /// Time added to the times of the table, s.
    pub offset: Option<f64>,
}

impl TimeFunctionConfig {
    /// Refuses a law that is not either a formula or a column of a file.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> error::Result<()> {
        let of_file = set_keys([
            ("column", self.column.is_some()),
            ("time", self.time.is_some()),
            ("scale", self.scale.is_some()),
            ("time_factor", self.time_factor.is_some()),
            ("offset", self.offset.is_some()),
        ]);
        match (&self.formula, &self.file) {
            (Some(_), None) if of_file.is_empty() => Ok(()),
            (Some(_), None) => {
                let what = format!("{} belong to a file, not to a formula", quoted_list(&of_file));
                Err(ctx.error_at(key, what))
            }
            (None, Some(_)) if self.column.is_some() => record::verify_scaling(ctx, key, self.given_scaling()),
            (None, Some(file)) => {
                let help = record::column_help(ctx, file);
                Err(ctx.error_with_help(
                    &format!("{key}.column"),
                    "\"column\" is missing: which one of the file?",
                    help,
                ))
            }
            _ => Err(ctx.error_at(key, "a law is either a formula or a file with a column")),
        }
    }

    /// Fills in the defaults of a law from a table.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        if self.file.is_some() {
            defaults.fill(format!("{key}.time"), &mut self.time, "t_s".into(), "the name our own tables have");
            defaults.fill(format!("{key}.scale"), &mut self.scale, 1.0, "as in the table");
            defaults.fill(format!("{key}.time_factor"), &mut self.time_factor, 1.0, "as in the table");
            defaults.fill(format!("{key}.offset"), &mut self.offset, 0.0, "the clocks agree");
        }
    }

    /// The scaling as far as it is given.
    fn given_scaling(&self) -> [Option<f64>; 3] {
        [self.scale, self.time_factor, self.offset]
    }

    /// The law, with the values in SI units.
    ///
    /// # Errors
    /// `Scene` if it cannot be read, or its formula is not finite during the run.
    pub(crate) fn build(&self, ctx: &Context, key: &str, unit: CoordinateUnit) -> error::Result<TimeFunction> {
        self.build_during(ctx, key, unit, [0.0, ctx.until])
    }

    /// The law as in [`TimeFunctionConfig::build`], of a part that exists from the first to the second of these times (s).
    pub(crate) fn build_during(
        &self,
        ctx: &Context,
        key: &str,
        unit: CoordinateUnit,
        span: [f64; 2],
    ) -> error::Result<TimeFunction> {
        let law = self.read(ctx, key, unit)?;
        if let (Some(text), TimeFunction::Formula(formula)) = (&self.formula, &law) {
            finite_law::require_finite(ctx, &format!("{key}.formula"), text, formula, span)?;
        }
        Ok(law)
    }

    /// The law, whether its formula is finite or not.
    pub(crate) fn read(&self, ctx: &Context, key: &str, unit: CoordinateUnit) -> error::Result<TimeFunction> {
        let place = |word: &str, e: error::Error| ctx.with_location(e, &format!("{key}.{word}"));
        if let Some(text) = &self.formula {
            let formula = Formula::parse(text).map_err(|e| place("formula", e))?;
            return Ok(TimeFunction::Formula(match unit {
                CoordinateUnit::Degrees => {
                    Formula::parse(&format!("({text})*(pi/180)")).map_err(|e| place("formula", e))?
                }
                CoordinateUnit::Si(_) | CoordinateUnit::Radians => formula,
            }));
        }
        let (Some(file), Some(column)) = (&self.file, &self.column) else {
            return Err(ctx.error_at(key, "a law is either a formula or a file with a column"));
        };
        let table = files::open_table(ctx.folder(), file).map_err(|e| place("file", e))?;
        let scaling = record::scaling(self.given_scaling());
        let time = self.time.clone().unwrap_or_else(|| "t_s".into());
        let mut record = record::Record { ctx, key, file, table, time, column: column.clone(), scaling, unit: None };
        let factor = record.take_unit(unit)?;
        let series = record.read()?;
        record.note_span(&series, record::Outside::Holds);
        // The order of the factors keeps the bits of a law without time factor and offset.
        let by = SampleScaling { scale: scaling.scale * factor, ..scaling };
        series.scaled(&by).map(TimeFunction::Table).map_err(|e| place("scale", e))
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

/// A formula in t (s).
impl From<&str> for TimeValueConfig {
    fn from(formula: &str) -> Self {
        Self::formula(formula)
    }
}

/// A formula in t (s).
impl From<String> for TimeValueConfig {
    fn from(formula: String) -> Self {
        Self::formula(formula)
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
            (None, config) => config.serialize(serializer),
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

    /// Whether it is written as a list.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self.0, TimeVectorForm::Many(_))
    }

    /// The components.
    pub(crate) fn components(&self) -> &[TimeValueConfig] {
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

/// Constant components.
impl From<Vec<f64>> for TimeVectorConfig {
    fn from(components: Vec<f64>) -> Self {
        Self::new(components.into_iter().map(TimeValueConfig::from))
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
                let config = TimeValueConfig::formula(text);
                Ok(TimeVectorConfig(TimeVectorForm::One(config.number().map_or(config, TimeValueConfig::from))))
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<TimeVectorConfig, E> {
                Ok(TimeVectorConfig(TimeVectorForm::One(x.into())))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<TimeVectorConfig, E> {
                Ok(TimeVectorConfig(TimeVectorForm::One((x as f64).into())))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TimeVectorConfig, A::Error> {
                let config = TimeFunctionConfig::deserialize(MapAccessDeserializer::new(map))?;
                Ok(TimeVectorConfig(TimeVectorForm::One(TimeValueConfig(config))))
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
