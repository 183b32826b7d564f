//! The words of what ties solids: joints with their motors, springs, ropes, forces, contacts of pairs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    LimitsConfig, MotionMode, Scene,
    values::{TimeValueConfig, TimeVectorConfig},
};

/// One `[[joint]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// What it leaves free.
    pub kind: JointKindConfig,
    /// The two solids, of which the second moves against the first; or one, which moves against the world.
    pub between: Vec<String>,
    /// The point of the world at which it sits at the start, m.
    pub at: Vec<f64>,
    /// Direction of the axis of a hinge; 3-D only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// Direction of a slider or a tow; of a generic joint the first axis of its frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<Vec<f64>>,
    /// Motions that a generic joint leaves free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub free: Option<Vec<MotionMode>>,
    /// Least and greatest value from the start, m or rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits: Option<LimitsConfig>,
    /// The same of turns, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limits_deg: Option<LimitsConfig>,
    /// What moves or brakes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motor: Option<MotorConfig>,
    /// Whether its two solids touch one another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contacts: Option<bool>,
}

/// What a joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKindConfig {
    /// Turning about an axis.
    #[serde(alias = "revolute")]
    #[schemars(extend("also" = "revolute"))]
    Hinge,
    /// Moving along a line.
    #[serde(alias = "prismatic")]
    #[schemars(extend("also" = "prismatic"))]
    Slider,
    /// Nothing.
    Fixed,
    /// Turning any way; 3-D only.
    #[serde(alias = "spherical")]
    #[schemars(extend("also" = "spherical"))]
    Ball,
    /// All but moving along a line.
    Tow,
    /// The motions in its list `free`.
    Generic,
}

/// A motor, brake or power take-off: F = F₀ + k (x* − x) + c (v* − ẋ).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MotorConfig {
    /// F₀ of a slider, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<TimeValueConfig>,
    /// F₀ of a hinge, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<TimeValueConfig>,
    /// x*, m or rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<TimeValueConfig>,
    /// x* of a hinge, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_deg: Option<TimeValueConfig>,
    /// v*, m/s or rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub velocity: Option<TimeValueConfig>,
    /// k, N/m or N m/rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<TimeValueConfig>,
    /// c, N s/m or N m s/rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<TimeValueConfig>,
    /// The strongest that it can be, N or N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strongest: Option<f64>,
}

impl MotorConfig {
    /// The words that are given, with their laws.
    pub(super) fn time_values(&self) -> impl Iterator<Item = (&'static str, &TimeValueConfig)> {
        let all = [
            ("force", &self.force),
            ("torque", &self.torque),
            ("position", &self.position),
            ("position_deg", &self.position_deg),
            ("velocity", &self.velocity),
            ("stiffness", &self.stiffness),
            ("damping", &self.damping),
        ];
        all.into_iter().filter_map(|(word, law)| Some((word, law.as_ref()?)))
    }

    /// All laws, to be filled in.
    pub(super) fn time_values_mut(&mut self) -> impl Iterator<Item = (&'static str, &mut TimeValueConfig)> {
        let all = [
            ("force", &mut self.force),
            ("torque", &mut self.torque),
            ("position", &mut self.position),
            ("position_deg", &mut self.position_deg),
            ("velocity", &mut self.velocity),
            ("stiffness", &mut self.stiffness),
            ("damping", &mut self.damping),
        ];
        all.into_iter().filter_map(|(word, law)| Some((word, law.as_mut()?)))
    }
}

/// One `[[spring]]`: a spring or, if it goes slack, a mooring line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solids at its two ends; or one, the other end on the ground.
    pub between: Vec<String>,
    /// Where it is made fast to the first, m, at the start.
    pub from: Vec<f64>,
    /// Where it is made fast to the second or the ground, m, at the start.
    pub to: Vec<f64>,
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
    /// Length without tension, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Whether it goes slack instead of pushing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension_only: Option<bool>,
}

/// One `[[rope]]`: it goes slack and cannot be stretched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RopeConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solids at its two ends; or one, the other end on the ground.
    pub between: Vec<String>,
    /// Where it is made fast to the first, m, at the start.
    pub from: Vec<f64>,
    /// Where it is made fast to the second or the ground, m, at the start.
    pub to: Vec<f64>,
    /// The longest that it can be, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
}

/// One `[[force]]`: a force and a torque on a free solid, after laws of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solid.
    pub on: String,
    /// The point of the solid that is here at the start, m; its centre of mass if not said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<Vec<f64>>,
    /// Its components, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<TimeVectorConfig>,
    /// Its components, N m: one in 2-D.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<TimeVectorConfig>,
    /// Whether the axes turn with the solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<ForceFrame>,
}

/// Whose axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ForceFrame {
    /// The world's.
    World,
    /// The world's at the start, turning with the solid.
    Body,
}

/// One `[[contact]]`: how solids touch, pair by pair; of several of the same pair the last counts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactConfig {
    /// The two, each a solid or a group of them; or one, for its contacts with all others.
    pub between: Vec<String>,
    /// `false`: they pass through one another.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub touch: Option<bool>,
    /// Coulomb friction coefficient, –.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    /// Restitution coefficient, –.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
}

impl JointConfig {
    /// A joint that sits at `at` (m) at the start.
    pub fn new<const N: usize>(
        name: impl Into<String>,
        kind: JointKindConfig,
        between: [&str; N],
        at: impl Into<Vec<f64>>,
    ) -> Self {
        Self {
            name: name.into(),
            kind,
            between: between.map(String::from).to_vec(),
            at: at.into(),
            axis: None,
            along: None,
            free: None,
            limits: None,
            limits_deg: None,
            motor: None,
            contacts: None,
        }
    }

    /// The same joint with a linear power take-off of `damping` (N s/m, or N m s/rad of a hinge).
    pub fn with_damping(mut self, damping: f64) -> Self {
        self.motor.get_or_insert_default().damping = Some(damping.into());
        self
    }
}

impl SpringConfig {
    /// A mooring line of `stiffness` (N/m) from the point `from` of `solid` to the point `to` of the ground, as long as it starts.
    pub fn mooring(
        name: impl Into<String>,
        solid: impl Into<String>,
        from: impl Into<Vec<f64>>,
        to: impl Into<Vec<f64>>,
        stiffness: f64,
    ) -> Self {
        let (from, to) = (from.into(), to.into());
        let between = vec![solid.into()];
        let tension_only = Some(true);
        Self { name: name.into(), between, from, to, stiffness, damping: None, length: None, tension_only }
    }
}

impl Scene {
    /// The same scene with a joint more.
    pub fn joint(mut self, joint: JointConfig) -> Self {
        self.joint.push(joint);
        self
    }

    /// The same scene with a spring or mooring line more.
    pub fn spring(mut self, spring: SpringConfig) -> Self {
        self.spring.push(spring);
        self
    }
}
