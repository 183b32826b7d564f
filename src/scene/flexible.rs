//! Words that may be written in more than one form: a word or a table, a number or a list.

use std::{collections::BTreeMap, fmt};

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer},
};

use super::{BoxConfig, MotionMode};

/// Frames for ParaView: `"off"`, or when and which fields.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
pub enum FramesChoice {
    /// None are written.
    Off,
    /// Some are.
    #[schemars(untagged)]
    On(FramesConfig),
}

/// When frames are written, and with which fields.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FramesConfig {
    /// Simulated time between frames, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub every: Option<f64>,
    /// Fields of the particles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fields: Option<Vec<String>>,
    /// Only water in this box is kept.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub corners: Option<BoxConfig>,
}

impl Serialize for FramesChoice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Off => serializer.serialize_str("off"),
            Self::On(words) => words.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for FramesChoice {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = FramesChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a table with `every` and `fields`, or \"off\"")
            }
            fn visit_str<E: de::Error>(self, word: &str) -> Result<FramesChoice, E> {
                match word {
                    "off" => Ok(FramesChoice::Off),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FramesChoice, A::Error> {
                FramesConfig::deserialize(MapAccessDeserializer::new(map)).map(FramesChoice::On)
            }
        }
        deserializer.deserialize_any(Words)
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
        struct Words;
        impl Visitor<'_> for Words {
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
        deserializer.deserialize_any(Words)
    }
}

/// A formula in the place, or a number.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct FieldFormulaConfig(#[schemars(with = "NumberOrFormula")] pub String);

/// How a formula may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
pub(super) enum NumberOrFormula {
    /// A number.
    Number(f64),
    /// A formula.
    Text(String),
}

impl<'de> Deserialize<'de> for FieldFormulaConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Words;
        impl Visitor<'_> for Words {
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
        deserializer.deserialize_any(Words)
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
    /// Unit of the drawing's lengths; m if not said.
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
    /// Unit of the drawing's lengths; m if not said.
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
        struct Words;
        impl<'de> Visitor<'de> for Words {
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
        deserializer.deserialize_any(Words)
    }
}

/// End stops: least and greatest value, or such a pair for each of several motions.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum LimitsConfig {
    /// Of a joint with one way to go.
    One(Vec<f64>),
    /// Of a generic joint.
    Each(BTreeMap<MotionMode, Vec<f64>>),
}

impl<'de> Deserialize<'de> for LimitsConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = LimitsConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "[least, greatest], or of a generic joint a table such as {{ x = [-0.1, 0.2] }}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<LimitsConfig, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(LimitsConfig::One)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<LimitsConfig, A::Error> {
                BTreeMap::deserialize(MapAccessDeserializer::new(map)).map(LimitsConfig::Each)
            }
        }
        deserializer.deserialize_any(Words)
    }
}
