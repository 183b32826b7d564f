//! `[[joint]]`: joints with their end stops and motors.

use std::{collections::BTreeMap, f64::consts::TAU, fmt};

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer},
};

use super::{
    force_element::tied,
    lifetime::{Element, LifetimeConfig, StrengthConfig},
    shape::vector,
    solid::{MotionMode, SolidConfig, require_solid, verify_modes},
};
use crate::{
    error::{ErrorCode, Result},
    scene::{
        context::{Context, Defaults, last_part},
        untagged::{CoordinateUnit, TimeValueConfig},
    },
    solid::{FreeMode, JointKind, JointSpec, Motor, TimeFunction},
};

/// A section `[[joint]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct JointConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// Its kind.
    pub kind: JointKindConfig,
    /// Two solids, the motion being that of the second relative to the first; or one, relative to the world.
    pub between: Vec<String>,
    /// Its position in the world at the start, m.
    pub at: Vec<f64>,
    /// Direction of the axis of a hinge; 3-D only.
    pub axis: Option<Vec<f64>>,
    /// Direction of a slider or a tow; of a generic joint the first axis of its frame.
    pub along: Option<Vec<f64>>,
    /// Modes that a generic joint leaves free.
    pub free: Option<Vec<MotionMode>>,
    /// Least and greatest value from the start, m or rad.
    pub limits: Option<LimitsConfig>,
    /// The same for rotations, degrees.
    pub limits_deg: Option<LimitsConfig>,
    /// A drive, brake or power take-off.
    pub motor: Option<MotorConfig>,
    /// Whether its two solids have contact forces with each other.
    pub contacts: Option<bool>,
    /// Time from which it acts, s.
    #[serde(alias = "from")]
    #[schemars(extend("also" = "from"))]
    pub since: Option<f64>,
    /// Time at which it ends, s.
    pub until: Option<f64>,
    /// Load under which it breaks, N or N m: of a line its tension, of a joint force or torque.
    pub breaks: Option<StrengthConfig>,
}

/// The kind of a joint, by the motion that it leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum JointKindConfig {
    /// Rotation about an axis.
    #[serde(alias = "revolute")]
    #[schemars(extend("also" = "revolute"))]
    Hinge,
    /// Moving along a line.
    #[serde(alias = "prismatic")]
    #[schemars(extend("also" = "prismatic"))]
    Slider,
    /// No motion.
    Fixed,
    /// Turning about any axis; 3-D only.
    #[serde(alias = "spherical")]
    #[schemars(extend("also" = "spherical"))]
    Ball,
    /// All motions but that along a line.
    Tow,
    /// The motions in its list `free`.
    Generic,
}

/// A motor, brake or power take-off: F = F₀ + k (x* − x) + c (v* − ẋ).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct MotorConfig {
    /// F₀ of a slider, N.
    pub force: Option<TimeValueConfig>,
    /// F₀ of a hinge, N m.
    pub torque: Option<TimeValueConfig>,
    /// x*, m or rad.
    pub position: Option<TimeValueConfig>,
    /// x* of a hinge, degrees.
    pub position_deg: Option<TimeValueConfig>,
    /// v*, m/s or rad/s.
    pub velocity: Option<TimeValueConfig>,
    /// k, N/m or N m/rad.
    pub stiffness: Option<TimeValueConfig>,
    /// c, N s/m or N m s/rad.
    pub damping: Option<TimeValueConfig>,
    /// Largest magnitude of its force, N or N m.
    pub strongest: Option<f64>,
}

impl MotorConfig {
    /// Returns the same motor with F₀ (N) of a slider.
    pub fn force(self, force: impl Into<TimeValueConfig>) -> Self {
        Self { force: Some(force.into()), ..self }
    }

    /// Returns the same motor with F₀ (N m) of a hinge.
    pub fn torque(self, torque: impl Into<TimeValueConfig>) -> Self {
        Self { torque: Some(torque.into()), ..self }
    }

    /// Returns the same motor with x* (m or rad).
    pub fn position(self, position: impl Into<TimeValueConfig>) -> Self {
        Self { position: Some(position.into()), ..self }
    }

    /// Returns the same motor with v* (m/s or rad/s).
    pub fn velocity(self, velocity: impl Into<TimeValueConfig>) -> Self {
        Self { velocity: Some(velocity.into()), ..self }
    }

    /// Returns the same motor with k (N/m or N m/rad).
    pub fn stiffness(self, stiffness: impl Into<TimeValueConfig>) -> Self {
        Self { stiffness: Some(stiffness.into()), ..self }
    }

    /// Returns the same motor with c (N s/m or N m s/rad).
    pub fn damping(self, damping: impl Into<TimeValueConfig>) -> Self {
        Self { damping: Some(damping.into()), ..self }
    }
}

/// End stops: least and greatest value, or such a pair for each of several modes.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[non_exhaustive]
pub enum LimitsConfig {
    /// Of a joint with one degree of freedom.
    One(Vec<f64>),
    /// Of a generic joint.
    Each(BTreeMap<MotionMode, Vec<f64>>),
}

impl<'de> Deserialize<'de> for LimitsConfig {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> std::result::Result<Self, De::Error> {
        struct Form;
        impl<'de> Visitor<'de> for Form {
            type Value = LimitsConfig;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "[least, greatest], or of a generic joint a table such as {{ x = [-0.1, 0.2] }}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> std::result::Result<LimitsConfig, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(LimitsConfig::One)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<LimitsConfig, A::Error> {
                BTreeMap::deserialize(MapAccessDeserializer::new(map)).map(LimitsConfig::Each)
            }
        }
        deserializer.deserialize_any(Form)
    }
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
            since: None,
            until: None,
            breaks: None,
        }
    }

    /// Returns the same joint along this direction, of a slider, a tow or a generic joint.
    pub fn along(self, along: impl Into<Vec<f64>>) -> Self {
        Self { along: Some(along.into()), ..self }
    }

    /// Returns the same joint about this axis, of a hinge in 3-D.
    pub fn axis(self, axis: impl Into<Vec<f64>>) -> Self {
        Self { axis: Some(axis.into()), ..self }
    }

    /// Returns the same joint with end stops, m or rad from the start.
    pub fn limits(self, min: f64, max: f64) -> Self {
        Self { limits: Some(LimitsConfig::One(vec![min, max])), ..self }
    }

    /// Its lifetime.
    fn lifetime(&self) -> LifetimeConfig<'_> {
        LifetimeConfig { since: self.since, until: self.until, breaks: self.breaks.as_ref() }
    }

    /// Returns the same joint with a motor.
    pub fn motor(self, motor: MotorConfig) -> Self {
        Self { motor: Some(motor), ..self }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        let why = "solids that a joint connects may overlap";
        defaults.fill(format!("{key}.contacts"), &mut self.contacts, false, why);
        for (word, value) in self.motor.iter_mut().flat_map(|motor| motor.time_values_mut()) {
            value.0.fill(defaults, &format!("{key}.motor.{word}"));
        }
    }

    /// Refuses a joint whose keys do not fit its kind.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        verify_ends(ctx, key, &self.between, solids)?;
        self.lifetime().verify(ctx, key, Element::Joint)?;
        self.lifetime().verify_solids(ctx, key, tied(solids, &self.between))?;
        ctx.require_dimension(&format!("{key}.at"), &self.at)?;
        let three = ctx.dimension == 3;
        let (hinge, slider) = (self.kind == JointKindConfig::Hinge, self.kind == JointKindConfig::Slider);
        if self.kind == JointKindConfig::Ball && !three {
            let help = "in 2-D  kind = \"hinge\"  turns freely about its point";
            return Err(ctx.error_with_help(&format!("{key}.kind"), "a plane has no ball joint", help));
        }
        let (along, generic) = (slider || self.kind == JointKindConfig::Tow, self.kind == JointKindConfig::Generic);
        let needs = [("axis", &self.axis, hinge && three, false), ("along", &self.along, along, generic)];
        for (word, vector, needed, allowed) in needs {
            let key = format!("{key}.{word}");
            match vector {
                None if needed => {
                    return Err(ctx
                        .error_at(&key, format!("{word} is missing: which way?"))
                        .with_code(ErrorCode::MissingKey));
                }
                Some(_) if !(needed || allowed) => {
                    let help = "a slider, a tow and a generic joint have  along, a hinge in 3-D has  axis; no other joint has a direction";
                    return Err(ctx.error_with_help(&key, format!("{word} has no meaning here"), help));
                }
                Some(vector) => {
                    ctx.require_direction(&key, vector)?;
                }
                None => {}
            }
        }
        self.verify_limits(ctx, key)?;
        match &self.motor {
            Some(_) if !(hinge || slider) => {
                let help = "a hinge or a slider has a motor";
                Err(ctx.error_with_help(&format!("{key}.motor"), "this joint has no way to go", help))
            }
            Some(motor) => motor.verify(ctx, &format!("{key}.motor"), hinge),
            None => Ok(()),
        }
    }

    /// Refuses modes that the joint cannot leave free, and end stops of modes that it does not leave free.
    fn verify_limits(&self, ctx: &Context, key: &str) -> Result<()> {
        let generic = self.kind == JointKindConfig::Generic;
        let free = self.free.as_deref().unwrap_or_default();
        verify_modes(ctx, &format!("{key}.free"), free)?;
        if generic && free.is_empty() {
            return Err(ctx
                .error_with_help(key, "free is missing: what does it leave?", "free = [\"x\", \"turn\"]")
                .with_code(ErrorCode::MissingKey));
        }
        if !generic && self.free.is_some() {
            let help = "the other kinds say what they leave free; a list has  kind = \"generic\"";
            return Err(ctx.error_with_help(&format!("{key}.free"), "free has no meaning here", help));
        }
        let hinge = self.kind == JointKindConfig::Hinge;
        let way = hinge || self.kind == JointKindConfig::Slider;
        let mut seen: Vec<MotionMode> = Vec::new();
        for (word, limits) in [("limits", &self.limits), ("limits_deg", &self.limits_deg)] {
            let Some(limits) = limits else { continue };
            let key = format!("{key}.{word}");
            match limits {
                LimitsConfig::One(_) if generic => {
                    let help = "name the motion: limits = { x = [-0.1, 0.2] }, limits_deg = { turn = [-10.0, 10.0] }";
                    return Err(ctx.error_with_help(&key, "which motion is limited?", help));
                }
                LimitsConfig::One(pair) if way => verify_stops(ctx, &key, pair, hinge)?,
                LimitsConfig::Each(all) if generic => {
                    for (mode, pair) in all {
                        let far = mode.index(ctx.dimension).is_some_and(|number| number < ctx.dimension);
                        if !free.contains(mode) || (word == "limits_deg" && far) || seen.contains(mode) {
                            let help = "each motion in  free  may have one pair, a turn's in rad or in degrees";
                            return Err(ctx.error_with_help(
                                &key,
                                "limits of what is not free, or twice the same",
                                help,
                            ));
                        }
                        seen.push(*mode);
                        verify_stops(ctx, &key, pair, !far)?;
                    }
                }
                LimitsConfig::Each(_) if way => {
                    return Err(ctx.error_with_help(&key, "this joint has one way to go", "limits = [-0.1, 0.2]"));
                }
                _ => {
                    let help = "a hinge, a slider or a generic joint has limits";
                    return Err(ctx.error_with_help(&key, "this joint has no way to go", help));
                }
            }
        }
        match (&self.limits, &self.limits_deg) {
            (Some(_), Some(_)) if !generic => Err(ctx
                .error_at(&format!("{key}.limits_deg"), "limits and limits_deg say the same twice")
                .with_code(ErrorCode::ConflictingKeys)),
            (_, Some(_)) if !(hinge || generic) => {
                Err(ctx.error_at(&format!("{key}.limits_deg"), "only turns have limits in degrees"))
            }
            _ => Ok(()),
        }
    }

    /// The joint of the solids with these numbers.
    pub(crate) fn build<const D: usize>(
        &self,
        ctx: &Context,
        key: &str,
        between: [Option<usize>; 2],
        solids: &[SolidConfig],
    ) -> Result<JointSpec<D>> {
        let kind = match self.kind {
            JointKindConfig::Hinge => JointKind::Hinge,
            JointKindConfig::Slider => JointKind::Slider,
            JointKindConfig::Fixed => JointKind::Fixed,
            JointKindConfig::Ball => JointKind::Ball,
            JointKindConfig::Tow => JointKind::Tow,
            JointKindConfig::Generic => JointKind::Generic,
        };
        let axis = vector(self.axis.as_ref().or(self.along.as_ref()).map_or(&[], |x| x));
        let mut joint = JointSpec::new(&self.name, kind, between, vector(&self.at), axis);
        joint.contacts_enabled = self.contacts.unwrap_or_default();
        joint.lifetime = self.lifetime().build(tied(solids, &self.between));
        let stops = [(&self.limits, 1.0), (&self.limits_deg, 1f64.to_radians())];
        let stop = |mode: Option<&MotionMode>| {
            stops.iter().find_map(|(limits, unit)| match (limits, mode) {
                (Some(LimitsConfig::One(pair)), None) => Some([pair[0] * unit, pair[1] * unit]),
                (Some(LimitsConfig::Each(all)), Some(mode)) => {
                    all.get(mode).map(|pair| [pair[0] * unit, pair[1] * unit])
                }
                _ => None,
            })
        };
        joint.limits = stop(None);
        let number = |mode: &MotionMode| Some(FreeMode { mode: mode.index(D)?, limits: stop(Some(mode)) });
        joint.free_modes = self.free.iter().flatten().filter_map(number).collect();
        let span = [joint.lifetime.since, joint.lifetime.until];
        let turns = self.kind == JointKindConfig::Hinge;
        let motor = |motor: &MotorConfig| motor.build(ctx, &format!("{key}.motor"), turns, span);
        joint.motor = self.motor.as_ref().map(motor).transpose()?;
        Ok(joint)
    }
}

impl MotorConfig {
    /// The laws that are given, with their keys.
    pub(crate) fn time_values(&self) -> impl Iterator<Item = (&'static str, &TimeValueConfig)> {
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
    fn time_values_mut(&mut self) -> impl Iterator<Item = (&'static str, &mut TimeValueConfig)> {
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

    /// Refuses a motor without a force, or with keys that do not fit its joint.
    fn verify(&self, ctx: &Context, key: &str, hinge: bool) -> Result<()> {
        let foreign: &[&str] = if hinge { &["force"] } else { &["torque", "position_deg"] };
        if let Some((word, _)) = self.time_values().find(|(word, _)| foreign.contains(word)) {
            let help = "a hinge has a torque, N m, and angles in rad or degrees; a slider a force, N, and metres";
            return Err(ctx.error_with_help(&format!("{key}.{word}"), format!("{word} has no meaning here"), help));
        }
        let position = self.position.is_some() || self.position_deg.is_some();
        let drives = [&self.force, &self.torque, &self.stiffness, &self.damping];
        if drives.iter().all(|law| law.is_none()) {
            return Err(ctx.error_at(key, "this motor has no force: give a force or torque, a stiffness, or a damping"));
        }
        if self.position.is_some() && self.position_deg.is_some() {
            return Err(ctx
                .error_at(&format!("{key}.position_deg"), "position and position_deg say the same twice")
                .with_code(ErrorCode::ConflictingKeys));
        }
        if position && self.stiffness.is_none() {
            let what = "a position needs a stiffness with which it is held";
            return Err(ctx.error_at(&format!("{key}.stiffness"), what));
        }
        if self.velocity.is_some() && self.damping.is_none() {
            let what = "a velocity needs a damping with which it is held";
            return Err(ctx.error_at(&format!("{key}.damping"), what));
        }
        ctx.require_positive(&format!("{key}.strongest"), self.strongest)?;
        self.time_values().try_for_each(|(word, value)| value.verify(ctx, &format!("{key}.{word}")))?;
        for (word, value) in [("stiffness", &self.stiffness), ("damping", &self.damping)] {
            if let Some(x) = value.as_ref().and_then(TimeValueConfig::number).filter(|x| *x < 0.0) {
                let what = format!("{word} is {x}: below 0 it would drive what it should hold");
                return Err(ctx.error_at(&format!("{key}.{word}"), what));
            }
        }
        Ok(())
    }

    /// The motor of a joint that exists during `span` (s); `turns` tells a hinge from a slider.
    fn build(&self, ctx: &Context, key: &str, turns: bool, span: [f64; 2]) -> Result<Motor> {
        let mut motor = Motor { max_force: self.strongest.unwrap_or(f64::INFINITY), ..Motor::default() };
        for (word, value) in self.time_values() {
            let unit = match word {
                "position_deg" => CoordinateUnit::Degrees,
                "position" if turns => CoordinateUnit::Radians,
                "position" => CoordinateUnit::Si("m"),
                "velocity" if turns => CoordinateUnit::Si("rad/s"),
                "velocity" => CoordinateUnit::Si("m/s"),
                "stiffness" if turns => CoordinateUnit::Si("N m/rad"),
                "stiffness" => CoordinateUnit::Si("N/m"),
                "damping" if turns => CoordinateUnit::Si("N m s/rad"),
                "damping" => CoordinateUnit::Si("N s/m"),
                "torque" => CoordinateUnit::Si("N m"),
                _ => CoordinateUnit::Si("N"),
            };
            let law = value.0.build_during(ctx, &format!("{key}.{word}"), unit, span)?;
            if matches!(word, "stiffness" | "damping")
                && let TimeFunction::Table(series) = &law
                && let Some(x) = series.values().iter().find(|x| **x < 0.0)
            {
                let what = format!("{word} is {x} in the table: below 0 it would drive what it should hold");
                return Err(ctx.error_at(&format!("{key}.{word}"), what));
            }
            match word {
                "force" | "torque" => motor.force = law,
                "position" | "position_deg" => motor.position = law,
                "velocity" => motor.velocity = Some(law),
                "stiffness" => motor.stiffness = law,
                _ => motor.damping = law,
            }
        }
        Ok(motor)
    }
}

/// Refuses end stops that do not have the start between them, or of a rotation (`turns`) all of a turn.
fn verify_stops(ctx: &Context, key: &str, pair: &[f64], turns: bool) -> Result<()> {
    match pair {
        [min, max] if *min <= 0.0 && 0.0 <= *max && min < max => {
            let in_degrees = last_part(key) == "limits_deg";
            let (turn, unit) = if in_degrees { (360.0, "degrees") } else { (TAU, "rad") };
            if !turns || max - min < turn {
                return Ok(());
            }
            let help = match in_degrees {
                false if max - min < 360.0 => "limits are in rad; those in degrees have the key  limits_deg",
                false => "from stop to stop a turn is less than 2π, as in  [-3.0, 3.0]        # rad",
                true => "from stop to stop a turn is less than 360, as in  [-170.0, 170.0]        # degrees",
            };
            Err(ctx.error_with_help(key, format!("from {min} to {max} {unit} it would turn all the way round"), help))
        }
        _ => {
            let what = format!("{pair:?} does not reach from 0 or less to 0 or more; 0 is where it starts");
            Err(ctx.error_at(key, what))
        }
    }
}

/// Refuses ends that are not one or two solids, of which one is free.
pub(crate) fn verify_ends(ctx: &Context, key: &str, between: &[String], solids: &[SolidConfig]) -> Result<()> {
    let key = format!("{key}.between");
    if !(1..=2).contains(&between.len()) {
        return Err(ctx.error_at(&key, format!("between names one solid or two, not {}", between.len())));
    }
    between.iter().try_for_each(|name| require_solid(ctx, solids, &key, name))?;
    if between.len() == 2 && between[0] == between[1] {
        return Err(ctx.error_at(&key, format!("\"{}\" is named twice", between[0])));
    }
    let free = |solid: &&SolidConfig| between.contains(&solid.name) && solid.free.is_some();
    if solids.iter().any(|solid| free(&solid)) {
        return Ok(());
    }
    let verb = if between.len() == 2 { "are" } else { "is" };
    let what = format!("\"{}\" {verb} not free: nothing here can move otherwise", between.join("\" and \""));
    Err(ctx.error_with_help(&key, what, "one of them at least must be  free = { density = 500.0 }"))
}

/// Refuses names that are not names, or are given twice.
pub(crate) fn verify_names(ctx: &Context, kind: &str, names: &[&str]) -> Result<()> {
    names.iter().enumerate().try_for_each(|(i, name)| {
        let key = format!("{kind}.{i}.name");
        ctx.require_file_name(&key, name)?;
        match names[..i].contains(name) {
            true => {
                Err(ctx.error_with_help(&key, format!("two {kind}s are called \"{name}\""), "give each its own name"))
            }
            false => Ok(()),
        }
    })
}
