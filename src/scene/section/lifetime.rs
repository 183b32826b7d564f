//! `since`, `until` and `breaks` of joints, springs, ropes, forces and solids.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, MapAccess, Visitor, value::MapAccessDeserializer},
};

use super::solid::SolidConfig;
use crate::{
    error::{ErrorCode, Result},
    scene::context::Context,
    solid::Lifetime,
};

/// The load at which a constraint breaks: a number (N), or a table.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema)]
#[schemars(with = "StrengthForm")]
#[non_exhaustive]
pub struct StrengthConfig {
    /// Tension of a spring or a rope, N (N/m in 2-D).
    pub tension: Option<f64>,
    /// Force of a joint, N (N/m in 2-D).
    pub force: Option<f64>,
    /// Torque of a joint, N m (N m/m in 2-D).
    pub torque: Option<f64>,
    /// Tension or force, if it is given as a number.
    load: Option<f64>,
}

/// How a strength may be written, for the schema.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code, reason = "only its shape counts")]
enum StrengthForm {
    /// Tension of a spring or a rope, force of a joint, N (N/m in 2-D).
    Load(f64),
    /// A table.
    Table(StrengthTable),
}

/// A strength as a table.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct StrengthTable {
    /// Tension of a spring or a rope, N (N/m in 2-D).
    tension: Option<f64>,
    /// Force of a joint, N (N/m in 2-D).
    force: Option<f64>,
    /// Torque of a joint, N m (N m/m in 2-D).
    torque: Option<f64>,
}

impl Serialize for StrengthConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match *self {
            Self { load: Some(load), .. } => serializer.serialize_f64(load),
            Self { tension, force, torque, load: None } => {
                StrengthTable { tension, force, torque }.serialize(serializer)
            }
        }
    }
}

impl<'de> Deserialize<'de> for StrengthConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> std::result::Result<Self, De::Error> {
        struct Form;
        impl<'de> Visitor<'de> for Form {
            type Value = StrengthConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(
                    f,
                    "a number of newtons, or a table such as {{ tension = 300.0 }}, of a joint {{ force = 300.0 }}"
                )
            }
            fn visit_f64<E: de::Error>(self, load: f64) -> std::result::Result<StrengthConfig, E> {
                Ok(StrengthConfig { load: Some(load), ..StrengthConfig::default() })
            }
            fn visit_i64<E: de::Error>(self, load: i64) -> std::result::Result<StrengthConfig, E> {
                self.visit_f64(load as f64)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<StrengthConfig, A::Error> {
                let StrengthTable { tension, force, torque } =
                    StrengthTable::deserialize(MapAccessDeserializer::new(map))?;
                Ok(StrengthConfig { tension, force, torque, load: None })
            }
        }
        deserializer.deserialize_any(Form)
    }
}

/// The kind of element that has a lifetime.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Element {
    /// A spring or a rope.
    Line,
    /// A joint.
    Joint,
    /// A force, which has no strength.
    Force,
}

/// The lifetime of an element as its section gives it.
#[derive(Clone, Copy)]
pub(crate) struct LifetimeConfig<'a> {
    pub(crate) since: Option<f64>,
    pub(crate) until: Option<f64>,
    pub(crate) breaks: Option<&'a StrengthConfig>,
}

impl LifetimeConfig<'_> {
    /// Refuses times that leave no duration, and a strength that does not fit the element.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, element: Element) -> Result<()> {
        if let Some(since) = self.since.filter(|since| !(*since >= 0.0 && since.is_finite())) {
            let what = format!("since = {since}: it is a time of the run, 0 s or later");
            return Err(ctx.error_at(&format!("{key}.since"), what).with_code(ErrorCode::OutOfRange));
        }
        ctx.require_positive(&format!("{key}.until"), self.until)?;
        if let (Some(since), Some(until)) = (self.since, self.until)
            && since >= until
        {
            let what = format!("nothing lies between since = {since} and until = {until}");
            let help = "since is the time at which it begins, until that at which it ends, s";
            let error = ctx.error_with_help(&format!("{key}.until"), what, help);
            return Err(error.with_code(ErrorCode::OutOfRange));
        }
        let Some(breaks) = self.breaks else { return Ok(()) };
        let key = format!("{key}.breaks");
        let given = [("tension", breaks.tension), ("force", breaks.force), ("torque", breaks.torque)];
        for (word, load) in given {
            let fits = (element == Element::Line) == (word == "tension");
            let key = format!("{key}.{word}");
            if load.is_some() && !fits {
                let help = "a spring or a rope has  breaks = { tension = 300.0 }, a joint  breaks = { force = 300.0 }  or  \
                            { torque = 20.0 }";
                return Err(ctx.error_with_help(&key, format!("{word} has no meaning here"), help));
            }
            ctx.require_positive(&key, load)?;
        }
        ctx.require_positive(&key, breaks.load)?;
        if breaks.load.is_none() && given.iter().all(|(_, load)| load.is_none()) {
            let word = if element == Element::Line { "tension" } else { "force" };
            let help = format!("write  breaks = {{ {word} = 300.0 }}        # N");
            return Err(ctx.error_with_help(&key, "no load is given at which it breaks", help));
        }
        Ok(())
    }

    /// Refuses an element that begins when one of its solids is removed, or later.
    pub(crate) fn verify_solids<'s>(
        &self,
        ctx: &Context,
        key: &str,
        mut solids: impl Iterator<Item = &'s SolidConfig>,
    ) -> Result<()> {
        let since = self.since.unwrap_or(0.0);
        let Some((name, end)) = solids.find_map(|solid| Some((&solid.name, solid.until.filter(|end| *end <= since)?)))
        else {
            return Ok(());
        };
        let what = format!("it begins at {since} s, and solid \"{name}\" is removed at {end} s");
        let help = format!("begin before that, or remove \"{name}\" later, by its  until");
        Err(ctx.error_with_help(&format!("{key}.since"), what, help).with_code(ErrorCode::OutOfRange))
    }

    /// The lifetime, which ends with the first of the `solids` that is removed.
    pub(crate) fn build<'s>(&self, solids: impl Iterator<Item = &'s SolidConfig>) -> Lifetime {
        let ends = solids.filter_map(|solid| solid.until).chain(self.until);
        let none = StrengthConfig::default();
        let breaks = self.breaks.unwrap_or(&none);
        Lifetime::default()
            .since(self.since.unwrap_or(0.0))
            .until(ends.fold(f64::INFINITY, f64::min))
            .strength(breaks.load.or(breaks.tension).or(breaks.force).unwrap_or(f64::INFINITY))
            .torque_strength(breaks.torque.unwrap_or(f64::INFINITY))
    }
}
