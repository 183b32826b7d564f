//! Values that may be written in more than one form: a number, a word, a list or a table.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer},
};

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

/// A draft: in metres, or the one at which the body floats at rest.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum DraftChoice {
    /// Where weight and buoyancy balance.
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
    pub fn metres(self) -> f64 {
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
pub struct PolylineConfig {
    /// Points, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<Vec<f64>>>,
    /// A table of points, or a drawing (.svg), beside the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The outline's id in the drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Factor on the drawing's lengths, –; 1 if not said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// LengthUnit of the drawing's lengths; m if not said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<LengthUnit>,
    /// Thickness of a wall, m; as many dp as the kernel reaches if not said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
}

impl PolylineConfig {
    /// The line through `points` (m).
    pub fn through<const N: usize>(points: [[f64; 2]; N]) -> Self {
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
    /// Factor on the drawing's lengths, –; 1 if not said.
    scale: Option<f64>,
    /// LengthUnit of the drawing's lengths; m if not said.
    unit: Option<LengthUnit>,
    /// Thickness of a wall, m; as many dp as the kernel reaches if not said.
    thickness: Option<f64>,
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
                let PolylineTable { points, file, id, scale, unit, thickness } =
                    PolylineTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(PolylineConfig { points, file, id, scale, unit, thickness })
            }
        }
        deserializer.deserialize_any(Form)
    }
}
