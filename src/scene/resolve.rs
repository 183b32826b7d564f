//! Checks a scene, fills in its defaults and lists every effective value with its source.

use std::{cell::RefCell, fmt};

use super::{
    DrivenConfig, FramesChoice, Scene,
    context::{Context, Defaults},
    section::{
        analysis::{self, ProbeSeries},
        contact,
        gravity::{self, GravityValues},
        joint::verify_names,
        open_boundary::{self, FaceFlow},
        solid,
    },
    toml_source::ValueSource,
};
use crate::{
    error::Result,
    model::{Model, PressureGradient},
    probe::GaugeSurface,
};

/// An effective value and its source.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedValue {
    /// The key, as in `solid.box.free.density`.
    pub key: String,
    /// The value, as TOML.
    pub value: String,
    /// Its source.
    pub source: ValueSource,
}

impl fmt::Display for ResolvedValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}  ({})", self.key, self.value, self.source)
    }
}

/// Expands to the names of all entries of a list, read from one field of each entry.
macro_rules! names {
    ($list:expr) => {
        $list.iter().map(|entry| entry.name.as_str()).collect::<Vec<_>>()
    };
}

/// The largest jitter, dp.
pub(crate) const MOST_JITTER: f64 = 0.1;

impl Scene {
    /// Returns the properties of the scene that the validation and construction of its sections use.
    pub(super) fn context(&self) -> Context<'_> {
        let mut ctx = Context {
            origin: &self.origin,
            dimension: self.dimension,
            dp: self.dp,
            h: self.model.smoothing_length(self.dimension, self.dp),
            until: self.until,
            gravity: None,
            rho0: self.model.rho0,
            file_notes: RefCell::default(),
        };
        ctx.gravity = self.gravity.as_ref().map(|config| GravityValues::of(&ctx, config));
        ctx
    }

    /// Refuses dimensions other than 2 and 3.
    pub(super) fn require_known_dimension(&self) -> Result<()> {
        match self.dimension {
            2 | 3 => Ok(()),
            other => Err(self.context().error_at("dimension", format!("dimension is 2 or 3, not {other}"))),
        }
    }

    /// Refuses an invalid scene without opening files.
    fn verify(&self) -> Result<()> {
        let ctx = &self.context();
        self.require_known_dimension()?;
        ctx.require_positive("dp", Some(self.dp))?;
        ctx.require_positive("until", Some(self.until))?;
        if let Some(gravity) = &self.gravity {
            gravity::verify(ctx, gravity)?;
        }
        if let Some(jitter) = self.jitter.filter(|s| !(0.0..=MOST_JITTER).contains(s)) {
            return Err(
                ctx.error_at("jitter", format!("particles start 0 to {MOST_JITTER} dp off their places, not {jitter}"))
            );
        }
        self.domain.iter().try_for_each(|domain| domain.verify(ctx, "domain"))?;
        self.periodic.iter().try_for_each(|periodic| periodic.verify(ctx))?;
        self.symmetry.iter().try_for_each(|planes| planes.verify(ctx, self.periodic.as_ref()))?;
        self.guard.iter().try_for_each(|guard| guard.verify(ctx))?;
        if self.water.is_empty() {
            return Err(ctx.error_at("water", "the scene has no water"));
        }
        each(&self.water, "water", |water, key| water.verify(ctx, key))?;
        each(&self.damping, "damping", |layer, key| layer.verify(ctx, key, self.periodic.as_ref()))?;
        each(&self.inflow, "inflow", |face, key| face.verify(ctx, key, FaceFlow::In))?;
        each(&self.outflow, "outflow", |face, key| face.verify(ctx, key, FaceFlow::Out))?;
        open_boundary::verify_names(ctx, &self.inflow, &self.outflow)?;
        self.current.iter().try_for_each(|current| current.verify(ctx, self.periodic.as_ref()))?;
        self.towed.iter().try_for_each(|towed| towed.verify(ctx, self.makes_waves()))?;
        solid::verify(ctx, &self.solid)?;
        let solids = &self.solid;
        verify_names(ctx, "joint", &names!(self.joint))?;
        verify_names(ctx, "spring", &names!(self.spring))?;
        verify_names(ctx, "rope", &names!(self.rope))?;
        verify_names(ctx, "line_type", &names!(self.line_type))?;
        verify_names(ctx, "mooring_point", &names!(self.mooring_point))?;
        verify_names(ctx, "mooring", &names!(self.mooring))?;
        verify_names(ctx, "force", &names!(self.force))?;
        each(&self.joint, "joint", |joint, key| joint.verify(ctx, key, solids))?;
        each(&self.spring, "spring", |spring, key| spring.verify(ctx, key, solids))?;
        each(&self.rope, "rope", |rope, key| rope.verify(ctx, key, solids))?;
        each(&self.line_type, "line_type", |line, key| line.verify(ctx, key))?;
        each(&self.mooring_point, "mooring_point", |point, key| point.verify(ctx, key, solids))?;
        each(&self.mooring, "mooring", |mooring, key| mooring.verify(ctx, key, &self.mooring_scope()))?;
        each(&self.wind, "wind", |wind, key| wind.verify(ctx, key, solids))?;
        each(&self.force, "force", |force, key| force.verify(ctx, key, solids))?;
        contact::verify(ctx, &self.contact, solids)?;
        self.controls(ctx)?;
        self.model.verify(ctx)?;
        self.time.verify(ctx)?;
        self.verify_probes()?;
        self.frames.iter().try_for_each(|frames| frames.verify(ctx))?;
        self.checkpoint.iter().try_for_each(|checkpoint| checkpoint.verify(ctx))?;
        let series = ProbeSeries { probes: &self.probe, names: &self.probe_names() };
        each(&self.check, "check", |check, key| check.verify(ctx, key, &series))?;
        each(&self.statistic, "statistic", |statistic, key| statistic.verify(ctx, key, &series))
    }

    /// Whether a paddle or a face makes waves by name.
    fn makes_waves(&self) -> bool {
        let mut driven = self.solid.iter().filter_map(|solid| solid.driven.as_ref());
        driven.any(DrivenConfig::makes_waves) || self.inflow.iter().chain(&self.outflow).any(|face| face.wave.is_some())
    }

    /// Returns the values of water that the scene does not name.
    fn usual_model(&self) -> Model {
        // Lengths are in dp: h over dp is exact.
        let usual = Model::water(self.dimension, 1.0, 1.0);
        let weightless = self.context().gravity.is_some_and(|gravity| gravity.strongest == 0.0);
        let free = self.solid.iter().any(|solid| solid.free.is_some());
        let mut usual = match (self.makes_waves() && !weightless, free) {
            (true, true) => usual.for_bodies_in_waves(),
            (true, false) => usual.for_waves(),
            (false, true) => usual.for_free_bodies(),
            (false, false) => usual,
        };
        if !self.model.allows_corrected_gradients() {
            usual.gradient = PressureGradient::Plain;
        }
        if weightless || !free {
            return usual;
        }
        // Water that cannot be built has no depth; its construction reports the error.
        match self.still_water() {
            Ok(still) => usual.deep_water(still.depth / self.dp),
            Err(_) => usual,
        }
    }

    /// Returns the scene with every default filled in, and the reasons of the defaults.
    ///
    /// # Errors
    /// `Scene` if the scene is wrong.
    pub(super) fn with_defaults(&self) -> Result<(Self, Defaults)> {
        self.verify()?;
        let (mut scene, mut defaults) = (self.clone(), Defaults::default());
        let (usual, fills) = (self.usual_model(), &mut defaults);
        scene.model.fill_smoothing(fills, &usual);
        let ctx = &Context { h: scene.model.smoothing_length(self.dimension, self.dp), ..self.context() };
        fills.fill("title", &mut scene.title, "untitled".into(), "the scene has no title");
        fills.fill("gravity", &mut scene.gravity, usual.gravity.clone().into(), "the earth's, down the last axis");
        for value in scene.gravity.iter_mut().flat_map(|gravity| gravity.components_mut()) {
            value.0.fill(fills, "gravity");
        }
        scene.model.fill(fills, &usual);
        scene.time.fill(fills, &usual);
        scene.guard.get_or_insert_default().fill(fills);
        for (i, layer) in scene.damping.iter_mut().enumerate() {
            layer.fill(fills, &format!("damping.{i}"));
        }
        let volume = self.water_particles() * self.dp.powi(self.dimension as i32);
        if let Some(current) = &mut scene.current {
            current.fill(fills, self.periodic.as_ref(), volume);
        }
        if let Some(towed) = &mut scene.towed {
            towed.velocity.0.fill(fills, "towed.velocity");
        }
        for (i, face) in scene.inflow.iter_mut().enumerate() {
            face.fill(ctx, fills, i, FaceFlow::In);
        }
        for (i, face) in scene.outflow.iter_mut().enumerate() {
            face.fill(ctx, fills, i, FaceFlow::Out);
        }
        for (i, water) in scene.water.iter_mut().enumerate() {
            if let Some(shape) = &mut water.fill.shape {
                shape.fill(ctx, fills, &format!("water.{i}.fill.shape"));
            }
        }
        for (i, solid) in scene.solid.iter_mut().enumerate() {
            solid.fill(ctx, fills, &format!("solid.{i}"));
        }
        for (i, joint) in scene.joint.iter_mut().enumerate() {
            joint.fill(fills, &format!("joint.{i}"));
        }
        for (i, spring) in scene.spring.iter_mut().enumerate() {
            spring.fill(fills, &format!("spring.{i}"));
        }
        for (i, rope) in scene.rope.iter_mut().enumerate() {
            rope.fill(fills, &format!("rope.{i}"));
        }
        for (i, line) in scene.line_type.iter_mut().enumerate() {
            line.fill(fills, &format!("line_type.{i}"));
        }
        for (i, mooring) in scene.mooring.iter_mut().enumerate() {
            mooring.fill(fills, &format!("mooring.{i}"));
        }
        for (i, wind) in scene.wind.iter_mut().enumerate() {
            wind.fill(fills, &format!("wind.{i}"));
        }
        for (i, force) in scene.force.iter_mut().enumerate() {
            force.fill(fills, &format!("force.{i}"));
        }
        for (i, name) in scene.probe_names().into_iter().enumerate() {
            let (probe, key) = (&mut scene.probe[i], format!("probe.{i}"));
            fills.fill(format!("{key}.name"), &mut probe.name, name, "after the observed quantity");
            fills.fill(format!("{key}.every"), &mut probe.every, self.until / 1000.0, "1000 readings a run");
            if let Some(gauge) = &mut probe.elevation {
                let why = "a jet counts, spray does not";
                fills.fill(format!("{key}.elevation.surface"), &mut gauge.surface, GaugeSurface::Highest, why);
            }
        }
        let particles = scene.water_particles();
        scene.frames.get_or_insert(FramesChoice::On(Default::default())).fill(ctx, fills, particles);
        scene.checkpoint.get_or_insert_default().fill(fills);
        for (i, check) in scene.check.iter_mut().enumerate() {
            check.fill(fills, &format!("check.{i}"));
        }
        for (i, name) in analysis::default_names(&scene.statistic).into_iter().enumerate() {
            fills.fill(format!("statistic.{i}.name"), &mut scene.statistic[i].name, name, "after its kind");
        }
        analysis::require_different_names(ctx, &scene.statistic)?;
        Ok((scene, defaults))
    }

    /// Returns every effective value and its source, in the order of `docs/reference/scene.md`.
    ///
    /// # Errors
    /// `Scene` if the scene is wrong, or a file with a shape is missing or wrong.
    pub fn resolve(&self) -> Result<Vec<ResolvedValue>> {
        let (scene, defaults) = self.with_defaults()?;
        // From the text, so that the writing of scenes is compiled once.
        let values: toml::Table = scene.to_toml()?.parse().unwrap_or_default();
        let mut lines = Vec::new();
        for section in ORDER {
            if let Some(value) = values.get(section) {
                self.flatten(section.into(), value, &defaults, &mut lines);
            }
        }
        let derived = |key: &str, value: f64, why: &str| ResolvedValue {
            key: key.into(),
            value: format!("{value}"),
            source: ValueSource::Default(why.into()),
        };
        let still = scene.still_water()?;
        let ctx = &scene.context();
        for (i, layer) in scene.damping.iter().enumerate().filter(|(_, layer)| layer.strength.is_none()) {
            let strength = match self.dimension {
                2 => layer.build::<2>(ctx, &still).strength,
                _ => layer.build::<3>(ctx, &still).strength,
            };
            let key = format!("damping.{i}.");
            let at = lines.iter().rposition(|line| line.key.starts_with(&key)).map_or(lines.len(), |at| at + 1);
            lines.insert(at, derived(&format!("{key}strength"), strength, "of a long wave e⁻⁴ comes back, 1/s"));
        }
        let at = lines.iter().position(|line| line.key.starts_with("time.")).unwrap_or(lines.len());
        if scene.model.c0.is_none() {
            lines.insert(
                at,
                derived("model.c0", scene.model.build(ctx, &scene.time, &still)?.c0, "c0_factor · √(g · depth), m/s"),
            );
        }
        lines.insert(at, derived("model.h", ctx.h, "smoothing length from dp, m"));
        Ok(lines)
    }

    fn flatten(&self, key: String, value: &toml::Value, defaults: &Defaults, lines: &mut Vec<ResolvedValue>) {
        match value {
            toml::Value::Table(table) if !table.is_empty() => {
                table.iter().for_each(|(part, value)| self.flatten(format!("{key}.{part}"), value, defaults, lines));
            }
            toml::Value::Array(items) if items.iter().any(toml::Value::is_table) => {
                items
                    .iter()
                    .enumerate()
                    .for_each(|(i, value)| self.flatten(format!("{key}.{i}"), value, defaults, lines));
            }
            leaf => {
                let source = self.source(&key, defaults);
                lines.push(ResolvedValue { key: self.origin.key_with_names(&key), value: leaf.to_string(), source });
            }
        }
    }

    /// Returns the source of `key`: its own default or its line, or else the default of a key above it, of the law or of
    /// the shape.
    fn source(&self, key: &str, defaults: &Defaults) -> ValueSource {
        let above = |key: &str| key.rsplit_once('.').map(|(parent, _)| parent.to_string());
        let mut place = Some(key.to_string());
        while let Some(at) = place {
            if let Some(source) = defaults.source(&at) {
                return source;
            }
            if at == key
                && let Some(source) = self.origin.source(&at).or_else(|| self.origin.source(&list_item(&at)?))
            {
                return source;
            }
            place = above(&at);
        }
        if self.origin.file.is_empty() { ValueSource::Program } else { self.inherited(key) }
    }

    /// Returns the source of a value that the scene does not contain, although it may contain the table of the value.
    fn inherited(&self, key: &str) -> ValueSource {
        let written = |parent: &str| self.origin.source(parent);
        match key.rsplit_once('.') {
            Some((parent, "points")) => written(parent).unwrap_or(ValueSource::Program),
            Some((parent, _)) if written(parent).is_some() => {
                ValueSource::Default("of this choice, see docs/reference/scene.md".into())
            }
            _ => ValueSource::Default("see docs/reference/scene.md".into()),
        }
    }
}

/// Returns the key of a coordinate in a place that is written as a list.
fn list_item(key: &str) -> Option<String> {
    let (place, coordinate) = key.rsplit_once('.')?;
    let number = ["x", "y", "z"].iter().position(|name| *name == coordinate)?;
    Some(format!("{place}.{number}"))
}

/// The order in which values are listed.
const ORDER: [&str; 34] = [
    "title",
    "dimension",
    "dp",
    "until",
    "gravity",
    "jitter",
    "domain",
    "periodic",
    "symmetry",
    "guard",
    "water",
    "damping",
    "inflow",
    "outflow",
    "current",
    "towed",
    "solid",
    "joint",
    "spring",
    "rope",
    "line_type",
    "mooring_point",
    "mooring",
    "force",
    "wind",
    "contact",
    "control",
    "model",
    "time",
    "probe",
    "frames",
    "checkpoint",
    "check",
    "statistic",
];

/// Calls `verify` with each entry of a section and its key.
fn each<T>(entries: &[T], section: &str, verify: impl Fn(&T, &str) -> Result<()>) -> Result<()> {
    entries.iter().enumerate().try_for_each(|(i, entry)| verify(entry, &format!("{section}.{i}")))
}
