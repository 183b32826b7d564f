//! `[[spring]]`, `[[rope]]` and `[[force]]`: springs, mooring lines without mass, ropes and prescribed forces.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    joint::verify_ends,
    lifetime::{Element, LifetimeConfig, StrengthConfig},
    shape::vector,
    solid::{SolidConfig, require_solid},
};
use crate::{
    error::Result,
    scene::{
        context::{Context, Defaults},
        untagged::{CoordinateUnit, TimeValueConfig, TimeVectorConfig},
    },
    solid::{ForceSpec, LineEnd, RopeSpec, SpringSpec, TimeFunction},
};

/// A section `[[spring]]`: a spring, or a mooring line if it bears tension only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SpringConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solids at its two ends; or one, the other end on the ground.
    pub between: Vec<String>,
    /// Attachment point on the first solid at the start, m.
    pub from: Vec<f64>,
    /// Attachment point on the second solid or the ground at the start, m.
    pub to: Vec<f64>,
    /// N/m.
    pub stiffness: f64,
    /// N s/m.
    pub damping: Option<f64>,
    /// Length without tension, m.
    pub length: Option<f64>,
    /// Whether it bears tension only.
    pub tension_only: Option<bool>,
    /// Time from which it acts, s.
    pub since: Option<f64>,
    /// Time at which it ends, s.
    pub until: Option<f64>,
    /// Load under which it breaks, N or N m: of a line its tension, of a joint force or torque.
    pub breaks: Option<StrengthConfig>,
}

/// A section `[[rope]]`: an inextensible line that bears tension only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct RopeConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solids at its two ends; or one, the other end on the ground.
    pub between: Vec<String>,
    /// Attachment point on the first solid at the start, m.
    pub from: Vec<f64>,
    /// Attachment point on the second solid or the ground at the start, m.
    pub to: Vec<f64>,
    /// Its length, m.
    pub length: Option<f64>,
    /// Time from which it acts, s.
    pub since: Option<f64>,
    /// Time at which it ends, s.
    pub until: Option<f64>,
    /// Load under which it breaks, N or N m: of a line its tension, of a joint force or torque.
    pub breaks: Option<StrengthConfig>,
}

/// A section `[[force]]`: a force and a torque on a free solid, as functions of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ForceConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solid.
    pub on: String,
    /// Point of application at the start, m; by default the centre of mass.
    pub at: Option<Vec<f64>>,
    /// Its components, N.
    pub force: Option<TimeVectorConfig>,
    /// Its components, N m: one in 2-D.
    pub torque: Option<TimeVectorConfig>,
    /// Whether the axes turn with the solid.
    pub frame: Option<ForceFrame>,
    /// Time from which it acts, s.
    #[serde(alias = "from")]
    #[schemars(extend("also" = "from"))]
    pub since: Option<f64>,
    /// Time at which it ends, s.
    pub until: Option<f64>,
}

/// The axes of a force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ForceFrame {
    /// Those of the world.
    World,
    /// Those of the solid, which turn with it.
    Body,
}

impl SpringConfig {
    /// A spring of `stiffness` (N/m) from the point `from` of the first solid to the point `to` (m) of the second, or of the ground.
    pub fn new<const N: usize>(
        name: impl Into<String>,
        between: [&str; N],
        from: impl Into<Vec<f64>>,
        to: impl Into<Vec<f64>>,
        stiffness: f64,
    ) -> Self {
        let (between, from, to) = (between.map(String::from).to_vec(), from.into(), to.into());
        Self {
            name: name.into(),
            between,
            from,
            to,
            stiffness,
            damping: None,
            length: None,
            tension_only: None,
            since: None,
            until: None,
            breaks: None,
        }
    }

    /// A mooring line of `stiffness` (N/m) from the point `from` of `solid` to the point `to` of the ground, as long as it starts.
    pub fn mooring(
        name: impl Into<String>,
        solid: impl Into<String>,
        from: impl Into<Vec<f64>>,
        to: impl Into<Vec<f64>>,
        stiffness: f64,
    ) -> Self {
        let spring = Self::new::<0>(name, [], from, to, stiffness);
        Self { between: vec![solid.into()], tension_only: Some(true), ..spring }
    }

    /// Returns the same spring with a damping (N s/m).
    pub fn damping(self, damping: f64) -> Self {
        Self { damping: Some(damping), ..self }
    }

    /// Its lifetime.
    fn lifetime(&self) -> LifetimeConfig<'_> {
        LifetimeConfig { since: self.since, until: self.until, breaks: self.breaks.as_ref() }
    }

    /// Returns the same spring with this length without tension (m).
    pub fn length(self, length: f64) -> Self {
        Self { length: Some(length), ..self }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        defaults.fill(format!("{key}.damping"), &mut self.damping, 0.0, "a spring without loss");
        let length = distance(&self.from, &self.to);
        if self.since.is_none_or(|since| since == 0.0) {
            defaults.fill(format!("{key}.length"), &mut self.length, length, "as it starts");
        }
        defaults.fill(format!("{key}.tension_only"), &mut self.tension_only, false, "it pushes as it pulls");
    }

    /// Refuses ends that cannot move and numbers out of range.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        verify_ends(ctx, key, &self.between, solids)?;
        ctx.require_dimension(&format!("{key}.from"), &self.from)?;
        ctx.require_dimension(&format!("{key}.to"), &self.to)?;
        self.lifetime().verify(ctx, key, Element::Line)?;
        self.lifetime().verify_solids(ctx, key, tied(solids, &self.between))?;
        ctx.require_positive(&format!("{key}.stiffness"), Some(self.stiffness))
    }

    /// The spring between the points of `solids`.
    pub(crate) fn build<const D: usize>(&self, solids: &[SolidConfig]) -> SpringSpec<D> {
        SpringSpec {
            name: self.name.clone(),
            ends: ends(solids, &self.between, &self.from, &self.to),
            stiffness: self.stiffness,
            damping: self.damping.unwrap_or_default(),
            rest_length: self.length,
            tension_only: self.tension_only.unwrap_or_default(),
            lifetime: self.lifetime().build(tied(solids, &self.between)),
        }
    }
}

impl RopeConfig {
    /// A rope from the point `from` of the first solid to the point `to` (m) of the second, or of the ground; taut at the start.
    pub fn new<const N: usize>(
        name: impl Into<String>,
        between: [&str; N],
        from: impl Into<Vec<f64>>,
        to: impl Into<Vec<f64>>,
    ) -> Self {
        let between = between.map(String::from).to_vec();
        Self {
            name: name.into(),
            between,
            from: from.into(),
            to: to.into(),
            length: None,
            since: None,
            until: None,
            breaks: None,
        }
    }

    /// Its lifetime.
    fn lifetime(&self) -> LifetimeConfig<'_> {
        LifetimeConfig { since: self.since, until: self.until, breaks: self.breaks.as_ref() }
    }

    /// Returns the same rope with this length (m).
    pub fn length(self, length: f64) -> Self {
        Self { length: Some(length), ..self }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        let length = distance(&self.from, &self.to);
        if self.since.is_none_or(|since| since == 0.0) {
            defaults.fill(format!("{key}.length"), &mut self.length, length, "as it starts");
        }
    }

    /// Refuses ends that cannot move and a length that is not positive.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        verify_ends(ctx, key, &self.between, solids)?;
        ctx.require_dimension(&format!("{key}.from"), &self.from)?;
        ctx.require_dimension(&format!("{key}.to"), &self.to)?;
        self.lifetime().verify(ctx, key, Element::Line)?;
        self.lifetime().verify_solids(ctx, key, tied(solids, &self.between))?;
        ctx.require_positive(&format!("{key}.length"), self.length)
    }

    /// The rope between the points of `solids`.
    pub(crate) fn build<const D: usize>(&self, solids: &[SolidConfig]) -> RopeSpec<D> {
        let ends = ends(solids, &self.between, &self.from, &self.to);
        let lifetime = self.lifetime().build(tied(solids, &self.between));
        RopeSpec { name: self.name.clone(), ends, max_length: self.length, lifetime }
    }
}

impl ForceConfig {
    /// Neither force nor torque, on the centre of mass of the solid `on`.
    pub fn new(name: impl Into<String>, on: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            on: on.into(),
            at: None,
            force: None,
            torque: None,
            frame: None,
            since: None,
            until: None,
        }
    }

    /// Its lifetime.
    fn lifetime(&self) -> LifetimeConfig<'_> {
        LifetimeConfig { since: self.since, until: self.until, breaks: None }
    }

    /// Returns the same load with a force (N), one component along each axis.
    pub fn force<F: Into<TimeValueConfig>>(self, force: impl IntoIterator<Item = F>) -> Self {
        Self { force: Some(TimeVectorConfig::new(force.into_iter().map(Into::into))), ..self }
    }

    /// Returns the same load with a torque (N m): one axial component in 2-D, three in 3-D.
    pub fn torque<F: Into<TimeValueConfig>>(self, torque: impl IntoIterator<Item = F>) -> Self {
        Self { torque: Some(TimeVectorConfig::new(torque.into_iter().map(Into::into))), ..self }
    }

    /// Returns the same load at this point (m) at the start.
    pub fn at(self, at: impl Into<Vec<f64>>) -> Self {
        Self { at: Some(at.into()), ..self }
    }

    /// Returns the same load with axes of the world, or of the solid.
    pub fn frame(self, frame: ForceFrame) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        defaults.fill(format!("{key}.frame"), &mut self.frame, ForceFrame::World, "as wind, not as a thruster");
        for (word, values) in [("force", &mut self.force), ("torque", &mut self.torque)] {
            for value in values.iter_mut().flat_map(|values| values.components_mut()) {
                value.0.fill(defaults, &format!("{key}.{word}"));
            }
        }
    }

    /// Refuses a force on a solid that is not free, and components that do not fit the dimension.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        require_solid(ctx, solids, &format!("{key}.on"), &self.on)?;
        self.lifetime().verify(ctx, key, Element::Force)?;
        self.lifetime().verify_solids(ctx, key, tied(solids, std::slice::from_ref(&self.on)))?;
        if !solids.iter().any(|solid| solid.name == self.on && solid.free.is_some()) {
            let what = format!("\"{}\" is not free: a force does not move it", self.on);
            return Err(ctx.error_with_help(&format!("{key}.on"), what, "a force acts on a free solid"));
        }
        if let Some(at) = &self.at {
            ctx.require_dimension(&format!("{key}.at"), at)?;
        }
        if self.force.is_none() && self.torque.is_none() {
            return Err(ctx.error_at(key, "neither a force nor a torque is given"));
        }
        let turns = if ctx.dimension == 3 { 3 } else { 1 };
        for (word, values, count) in [("force", &self.force, ctx.dimension), ("torque", &self.torque, turns)] {
            let Some(values) = values else { continue };
            let key = format!("{key}.{word}");
            let values = values.components();
            if values.len() != count {
                let what = format!("{word} has {} components, and a {}-D scene {count}", values.len(), ctx.dimension);
                return Err(ctx.error_at(&key, what));
            }
            values.iter().try_for_each(|value| value.verify(ctx, &key))?;
        }
        Ok(())
    }

    /// The force on one of `solids`.
    pub(crate) fn build<const D: usize>(
        &self,
        ctx: &Context,
        key: &str,
        solids: &[SolidConfig],
    ) -> Result<ForceSpec<D>> {
        let solid = solids.iter().position(|solid| solid.name == self.on).unwrap_or_default();
        let lifetime = self.lifetime().build(tied(solids, std::slice::from_ref(&self.on)));
        let span = [lifetime.since, lifetime.until];
        let laws = |word: &str, values: &[TimeValueConfig]| -> Result<Vec<TimeFunction>> {
            let key = format!("{key}.{word}");
            let unit = CoordinateUnit::Si(if word == "force" { "N" } else { "N m" });
            values.iter().map(|value| value.0.build_during(ctx, &key, unit, span)).collect()
        };
        Ok(ForceSpec {
            name: self.name.clone(),
            solid,
            at: self.at.as_ref().map(|at| vector(at)),
            force: laws("force", self.force.as_ref().map_or(&[], |values| values.components()))?,
            torque: laws("torque", self.torque.as_ref().map_or(&[], |values| values.components()))?,
            rotates_with_solid: self.frame == Some(ForceFrame::Body),
            lifetime,
        })
    }
}

/// The distance of two points, m.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The `solids` that are named in `between`.
pub(crate) fn tied<'a>(solids: &'a [SolidConfig], between: &'a [String]) -> impl Iterator<Item = &'a SolidConfig> {
    solids.iter().filter(|solid| between.contains(&solid.name))
}

/// The two ends of a line; one without a solid is fixed in the world.
pub(crate) fn ends<const D: usize>(
    solids: &[SolidConfig],
    between: &[String],
    from: &[f64],
    to: &[f64],
) -> [LineEnd<D>; 2] {
    let number = |name: &String| solids.iter().position(|solid| solid.name == *name);
    [(0, from), (1, to)].map(|(k, at)| LineEnd { solid: between.get(k).and_then(number), at: vector(at) })
}
