//! `frames` and `[checkpoint]`: the files of a run besides the series of the probes.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, Visitor, value::MapAccessDeserializer},
};

use crate::{
    error::{self, ErrorCode, suggestion},
    math::{BoxConfig, format::bytes},
    output::frame::particle_bytes,
    plan::FramesPlan,
    scene::context::{Context, Defaults},
};

/// Fields that a frame can hold.
const FIELDS: [&str; 4] = ["velocity", "density", "pressure", "id"];

/// Disk space of the frames where the scene does not say how many there are, B.
const DISK: f64 = 200e6;

/// Fewest and most frames where the scene does not say how many there are.
const FRAMES: [f64; 2] = [20.0, 100.0];

/// Wall time between checkpoints where the scene does not give it, s.
const CHECKPOINT_WALL: f64 = 600.0;

/// FramesChoice for ParaView: `"off"`, or when and which fields.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[non_exhaustive]
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
#[non_exhaustive]
pub struct FramesConfig {
    /// Simulated time between frames, s.
    pub every: Option<f64>,
    /// Fields of the particles.
    pub fields: Option<Vec<String>>,
    /// Only water in this box is written.
    #[serde(rename = "box")]
    pub corners: Option<BoxConfig>,
}

impl Serialize for FramesChoice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Off => serializer.serialize_str("off"),
            Self::On(config) => config.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for FramesChoice {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> std::result::Result<Self, De::Error> {
        struct Words;
        impl<'de> Visitor<'de> for Words {
            type Value = FramesChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a table with `every` and `fields`, or \"off\"")
            }
            fn visit_str<E: de::Error>(self, word: &str) -> std::result::Result<FramesChoice, E> {
                match word {
                    "off" => Ok(FramesChoice::Off),
                    _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<FramesChoice, A::Error> {
                FramesConfig::deserialize(MapAccessDeserializer::new(map)).map(FramesChoice::On)
            }
        }
        deserializer.deserialize_any(Words)
    }
}

impl FramesChoice {
    /// Refuses unknown fields and an empty box.
    pub(crate) fn verify(&self, ctx: &Context) -> error::Result<()> {
        let Self::On(FramesConfig { every, fields, corners }) = self else { return Ok(()) };
        ctx.require_positive("frames.every", *every)?;
        if let Some(field) = fields.iter().flatten().find(|field| !FIELDS.contains(&field.as_str())) {
            let what = format!("no field is called \"{field}\"{}", suggestion(field, FIELDS.iter().copied()));
            return Err(ctx
                .error_with_help("frames.fields", what, format!("known: {}", FIELDS.join(", ")))
                .with_code(ErrorCode::UnknownName));
        }
        let fields = fields.as_deref().unwrap_or_default();
        if let Some(twice) = (1..fields.len()).find(|&i| fields[..i].contains(&fields[i])) {
            let what = format!("the field \"{}\" is named twice", fields[twice]);
            return Err(ctx.error_with_help("frames.fields", what, "name each field once"));
        }
        corners.as_ref().map_or(Ok(()), |corners| corners.verify(ctx, "frames.box"))
    }

    /// Fills in the defaults of a run with so many `water_particles`.
    pub(crate) fn fill(&mut self, ctx: &Context, defaults: &mut Defaults, water_particles: f64) {
        let Self::On(config) = self else { return };
        let (count, why) = config.default_count(water_particles);
        defaults.fill("frames.every", &mut config.every, ctx.until / count, why);
        let fields = FIELDS.map(String::from).to_vec();
        defaults.fill("frames.fields", &mut config.fields, fields, "all that there are");
    }

    /// The frames of the run; `None` if it writes none.
    pub(crate) fn build(&self, ctx: &Context) -> Option<FramesPlan> {
        let Self::On(config) = self else { return None };
        Some(FramesPlan {
            every: config.every.unwrap_or(ctx.until),
            fields: config.fields.clone().unwrap_or_default(),
            crop: config.corners.as_ref().map(|corners| [corners.min.clone(), corners.max.clone()]),
            moorings: false,
        })
    }
}

impl FramesConfig {
    /// How many frames a run has by default, and why.
    fn default_count(&self, water_particles: f64) -> (f64, String) {
        let fields = self.fields.clone().unwrap_or_else(|| FIELDS.map(String::from).to_vec());
        let frame = particle_bytes(&fields).0 * water_particles;
        let count = (DISK / frame).floor().clamp(FRAMES[0], FRAMES[1]);
        if count == FRAMES[1] {
            return (count, format!("{count} frames a run"));
        }
        let why = format!("{count} frames a run of about {} each: more would take over {}", bytes(frame), bytes(DISK));
        (count, why)
    }
}

/// Checkpoints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct CheckpointConfig {
    /// Simulated time between them, s.
    pub every: Option<f64>,
    /// Wall time between them, s.
    pub wall: Option<f64>,
}

impl CheckpointConfig {
    pub(crate) fn verify(&self, ctx: &Context) -> error::Result<()> {
        ctx.require_positive("checkpoint.every", self.every)?;
        ctx.require_positive("checkpoint.wall", self.wall)
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults) {
        let why = "a run that is killed loses ten minutes at most";
        defaults.fill("checkpoint.wall", &mut self.wall, CHECKPOINT_WALL, why);
    }

    /// Wall time between checkpoints, s.
    pub(crate) fn wall_time(&self) -> f64 {
        self.wall.unwrap_or(CHECKPOINT_WALL)
    }
}
