//! Points of a probe in a scene file: one point, or a row of evenly spaced points.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer},
};

use super::ProbeScope;
use crate::error;

/// Largest number of points in a row.
const MAX_POINTS: usize = 1000;

/// Least spacing (m) of a row, because the names of the columns contain places to a micrometre.
const MIN_SPACING: f64 = 1e-6;

/// A point or a row of points.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(untagged)]
#[non_exhaustive]
pub enum PointsConfig {
    /// A single point, m.
    At(Vec<f64>),
    /// A row of points.
    Row(PointRowConfig),
}

/// Evenly spaced points in a row: `count` points, or as many points at distance `spacing` as the row holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct PointRowConfig {
    /// The first point, m.
    pub from: Vec<f64>,
    /// The last point, m. With `spacing`, no point lies beyond it.
    pub to: Vec<f64>,
    /// Number of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Distance between neighbouring points, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
}

impl Serialize for PointsConfig {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::At(at) => at.serialize(serializer),
            Self::Row(row) => row.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for PointsConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> Result<Self, De::Error> {
        struct PointsVisitor;
        impl<'de> Visitor<'de> for PointsVisitor {
            type Value = PointsConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a point, or a row of points as in {{ from = [..], to = [..], count = 5 }}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<PointsConfig, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(PointsConfig::At)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<PointsConfig, A::Error> {
                PointRowConfig::deserialize(MapAccessDeserializer::new(map)).map(PointsConfig::Row)
            }
        }
        deserializer.deserialize_any(PointsVisitor)
    }
}

impl PointsConfig {
    /// Checks the coordinates of the point or the row at `key`.
    pub(super) fn verify(&self, key: &str, scene: &dyn ProbeScope) -> error::Result<()> {
        match self {
            Self::At(at) => scene.require_vector(key, at),
            Self::Row(row) => row.verify(key, scene, scene.dimension()),
        }
    }

    /// Returns the points, m.
    pub(super) fn places(&self) -> Vec<Vec<f64>> {
        match self {
            Self::At(at) => vec![at.clone()],
            Self::Row(row) => row.places(),
        }
    }
}

impl PointRowConfig {
    /// Returns the distance (m) from the first point to the last.
    fn length(&self) -> f64 {
        self.from.iter().zip(&self.to).map(|(a, b)| (b - a).powi(2)).sum::<f64>().sqrt()
    }

    /// Number of points.
    fn point_count(&self) -> usize {
        match (self.count, self.spacing) {
            (Some(count), _) => count,
            // Round-off can make a length slightly less than the multiple of `spacing` that it should be.
            (None, Some(spacing)) => (self.length() / spacing * (1.0 + 1e-12)) as usize + 1,
            (None, None) => 1,
        }
    }

    /// Returns the points, m.
    pub(super) fn places(&self) -> Vec<Vec<f64>> {
        let step = match (self.count, self.spacing) {
            (Some(count), _) => 1.0 / count.saturating_sub(1).max(1) as f64,
            (None, spacing) => spacing.unwrap_or_default() / self.length(),
        };
        let at = |i: usize| self.from.iter().zip(&self.to).map(|(a, b)| a + (b - a) * (i as f64 * step)).collect();
        (0..self.point_count()).map(at).collect()
    }

    /// Checks that each point of the row at `key` has `coordinates` coordinates, and that the number of points is
    /// valid.
    pub(super) fn verify(&self, key: &str, scene: &dyn ProbeScope, coordinates: usize) -> error::Result<()> {
        for (word, at) in [("from", &self.from), ("to", &self.to)] {
            if at.len() != coordinates || at.iter().any(|x| !x.is_finite()) {
                let what = format!("{word} has {} numbers: a place here has {coordinates}", at.len());
                let help = format!("write  {word} = [{}]", vec!["0.0"; coordinates].join(", "));
                return Err(scene.error_with_help(&format!("{key}.{word}"), &what, &help));
            }
        }
        let help = "write  count = 5  or  spacing = 0.1";
        if self.count.is_some() == self.spacing.is_some() {
            return Err(scene.error_with_help(key, "a row has either a count or a spacing", help));
        }
        scene.require_positive(&format!("{key}.spacing"), self.spacing)?;
        let (count, length) = (self.point_count(), self.length());
        if !(2..=MAX_POINTS).contains(&count) {
            let what = format!("a row has 2 to {MAX_POINTS} places, this one has {count}");
            return Err(scene.error_with_help(key, &what, help));
        }
        if length < MIN_SPACING * (count - 1) as f64 {
            return Err(scene.error_with_help(key, &format!("{count} places do not fit on {length} m"), help));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_goes_from_its_first_place_to_its_last_and_never_beyond() {
        let row = |count, spacing| PointRowConfig { from: vec![0.0], to: vec![1.0], count, spacing };
        assert_eq!(row(Some(3), None).places(), [[0.0], [0.5], [1.0]]);
        assert_eq!(row(None, Some(0.1)).places().len(), 11, "a multiple that round-off would miss");
        assert_eq!(row(None, Some(0.4)).places(), [[0.0], [0.4], [0.8]]);
    }
}
