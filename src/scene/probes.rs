//! The words of `[[probe]]`: what is watched, where, and how often.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer},
};

use super::{BoxConfig, NumberOrArray, ProbeKind, ProbePlan};
use crate::plan::{ContactListPlan, GaugeSurface};

/// One `[[probe]]`: exactly one of the words that say what it looks at.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ProbeConfig {
    /// Stem of the file it writes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Simulated time between readings, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub every: Option<f64>,
    /// Whether a reading is the mean since the one before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub average: Option<bool>,
    /// Motion of the solid of this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<String>,
    /// Force and torque on the solid of this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<String>,
    /// What the joint of this name carries, and how it moves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<String>,
    /// Length and tension of the spring of this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spring: Option<String>,
    /// Length and tension of the rope of this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rope: Option<String>,
    /// Surface elevation at a place, or at a row of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevation: Option<GaugeConfig>,
    /// Velocity at a point or a row of points, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<PointsConfig>,
    /// Pressure at a point or a row of points, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure: Option<PointsConfig>,
    /// Flow through a section.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<SectionConfig>,
    /// How far water runs up the solid of this name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runup: Option<String>,
    /// Force and pressure on a part of a solid's face.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub patch: Option<PatchConfig>,
    /// The leading edge of the water along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("const" = true))]
    pub front: Option<bool>,
    /// Energies of water and bodies.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("const" = true))]
    pub energy: Option<bool>,
    /// All loads on the free solid of this name, by kind.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub balance: Option<String>,
    /// How the two solids of these names press on each other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact: Option<[String; 2]>,
    /// How all that touch press on each other, as a list.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("const" = true))]
    pub contacts: Option<bool>,
    /// Where energy came from and went.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("const" = true))]
    pub budget: Option<bool>,
}

/// Where elevation gauges stand: x in 2-D, x and y in 3-D, or a row of them; and which surface they tell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GaugeConfig {
    /// m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// m; 3-D only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<f64>,
    /// Where a row begins, m: a number in 2-D, two in 3-D.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<NumberOrArray>,
    /// Where it ends, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<NumberOrArray>,
    /// How many gauges it has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// How far apart they are, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Which surface, where there are several above one another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<GaugeSurface>,
}

/// A point, or a row of them.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(untagged)]
pub enum PointsConfig {
    /// One, m.
    At(Vec<f64>),
    /// Several.
    Row(PointRowConfig),
}

/// Points in a row, evenly spaced: `count` of them, or as many as there are `spacing` apart.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointRowConfig {
    /// The first, m.
    pub from: Vec<f64>,
    /// The last, m; with `spacing` none lies beyond.
    pub to: Vec<f64>,
    /// How many.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// How far apart, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
}

/// A section that water flows through: a segment in 2-D, a rectangle upright to an axis in 3-D.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionConfig {
    /// One end or corner, m.
    pub from: Vec<f64>,
    /// The opposite one, m.
    pub to: Vec<f64>,
}

/// A part of a solid's face.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatchConfig {
    /// The solid.
    pub solid: String,
    /// The box in which that part lies at the start.
    #[serde(rename = "box")]
    pub corners: BoxConfig,
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
        struct Words;
        impl<'de> Visitor<'de> for Words {
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
        deserializer.deserialize_any(Words)
    }
}

impl GaugeConfig {
    /// The row that these words mean; none if they name a single place.
    pub(super) fn row(&self) -> Option<PointRowConfig> {
        let list = |numbers: &Option<NumberOrArray>| match numbers {
            Some(NumberOrArray::One(x)) => vec![*x],
            Some(NumberOrArray::List(list)) => list.clone(),
            _ => Vec::new(),
        };
        let said = self.from.is_some() || self.to.is_some() || self.count.is_some() || self.spacing.is_some();
        said.then(|| PointRowConfig {
            from: list(&self.from),
            to: list(&self.to),
            count: self.count,
            spacing: self.spacing,
        })
    }

    fn places(&self) -> Vec<Vec<f64>> {
        match self.row() {
            Some(row) => row.places(),
            None => vec![[self.x, self.y].into_iter().flatten().collect()],
        }
    }
}

impl PointsConfig {
    fn places(&self) -> Vec<Vec<f64>> {
        match self {
            Self::At(at) => vec![at.clone()],
            Self::Row(row) => row.places(),
        }
    }
}

impl PointRowConfig {
    /// How far the last is from the first, m.
    pub(super) fn length(&self) -> f64 {
        self.from.iter().zip(&self.to).map(|(a, b)| (b - a).powi(2)).sum::<f64>().sqrt()
    }

    /// How many there are.
    pub(super) fn point_count(&self) -> usize {
        match (self.count, self.spacing) {
            (Some(count), _) => count,
            // A length that should be a multiple may lie a few last bits below it.
            (None, Some(spacing)) => (self.length() / spacing * (1.0 + 1e-12)) as usize + 1,
            (None, None) => 1,
        }
    }

    /// The points, m.
    fn places(&self) -> Vec<Vec<f64>> {
        let step = match (self.count, self.spacing) {
            (Some(count), _) => 1.0 / count.saturating_sub(1).max(1) as f64,
            (None, spacing) => spacing.unwrap_or_default() / self.length(),
        };
        let at = |i: usize| self.from.iter().zip(&self.to).map(|(a, b)| a + (b - a) * (i as f64 * step)).collect();
        (0..self.point_count()).map(at).collect()
    }
}

impl ProbeConfig {
    /// The motion of the solid of this name.
    pub fn motion(solid: impl Into<String>) -> Self {
        Self { motion: Some(solid.into()), ..Self::default() }
    }

    /// Force and torque on the solid of this name.
    pub fn force(solid: impl Into<String>) -> Self {
        Self { force: Some(solid.into()), ..Self::default() }
    }

    /// What the joint of this name carries, and how it moves.
    pub fn joint(joint: impl Into<String>) -> Self {
        Self { joint: Some(joint.into()), ..Self::default() }
    }

    /// Length and tension of the spring of this name.
    pub fn spring(spring: impl Into<String>) -> Self {
        Self { spring: Some(spring.into()), ..Self::default() }
    }

    /// The probe of a scene with its defaults filled in, for the plan of a run that ends at `until` (s); none of a list.
    pub(super) fn to_plan(&self, until: f64) -> Option<ProbePlan> {
        self.contacts.is_none().then(|| ProbePlan {
            name: self.name.clone().unwrap_or_default(),
            what: self.kind(),
            every: self.every.unwrap_or(until),
            average: self.average.unwrap_or_default(),
        })
    }

    /// The list of contacts that it is, with its defaults filled in; none of a probe that writes a series.
    pub(super) fn to_contact_list(&self, until: f64) -> Option<ContactListPlan> {
        let name = self.name.clone().unwrap_or_default();
        self.contacts.map(|_| ContactListPlan { name, every: self.every.unwrap_or(until) })
    }

    fn kind(&self) -> ProbeKind {
        match self.clone() {
            Self { motion: Some(solid), .. } => ProbeKind::Motion { solid },
            Self { force: Some(solid), .. } => ProbeKind::Force { solid },
            Self { joint: Some(joint), .. } => ProbeKind::Joint { joint },
            Self { spring: Some(spring), .. } => ProbeKind::Spring { spring },
            Self { rope: Some(rope), .. } => ProbeKind::Rope { rope },
            Self { elevation: Some(gauge), .. } => {
                ProbeKind::Elevation { places: gauge.places(), surface: gauge.surface.unwrap_or_default() }
            }
            Self { velocity: Some(at), .. } => ProbeKind::Velocity { places: at.places() },
            Self { pressure: Some(at), .. } => ProbeKind::Pressure { places: at.places() },
            Self { flow: Some(SectionConfig { from, to }), .. } => ProbeKind::Flow { from, to },
            Self { runup: Some(solid), .. } => ProbeKind::Runup { solid },
            Self { patch: Some(PatchConfig { solid, corners }), .. } => {
                ProbeKind::Patch { solid, min: corners.min, max: corners.max }
            }
            Self { front: Some(_), .. } => ProbeKind::Front,
            Self { balance: Some(solid), .. } => ProbeKind::Balance { solid },
            Self { contact: Some(between), .. } => ProbeKind::Contact { between },
            Self { budget: Some(_), .. } => ProbeKind::Budget,
            _ => ProbeKind::Energy,
        }
    }

    /// The words that say what it looks at.
    pub(super) fn named_kinds(&self) -> Vec<&'static str> {
        let given = [
            ("motion", self.motion.is_some()),
            ("force", self.force.is_some()),
            ("joint", self.joint.is_some()),
            ("spring", self.spring.is_some()),
            ("rope", self.rope.is_some()),
            ("elevation", self.elevation.is_some()),
            ("velocity", self.velocity.is_some()),
            ("pressure", self.pressure.is_some()),
            ("flow", self.flow.is_some()),
            ("runup", self.runup.is_some()),
            ("patch", self.patch.is_some()),
            ("front", self.front.is_some()),
            ("energy", self.energy.is_some()),
            ("balance", self.balance.is_some()),
            ("contact", self.contact.is_some()),
            ("contacts", self.contacts.is_some()),
            ("budget", self.budget.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(word, _)| word).collect()
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
