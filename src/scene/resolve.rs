//! Fills in the defaults, each with its reason: the one place where a default stands.

use std::{collections::BTreeMap, fmt};

use super::{
    AxisName, ForceFrame, FramesChoice, FramesConfig, LengthUnit, PlacementConfig, PolylineConfig, Scene, ShapeConfig,
    TimeFunctionConfig, document::ValueSource, verify::FIELDS,
};
use crate::{
    error::Result,
    geometry::Touchable,
    model::{C0_FACTOR, Model, Scheme},
    probe::GaugeSurface,
};

/// A value in force and who said it.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedValue {
    /// The key, as in `solid.box.free.density`.
    pub key: String,
    /// The value, as TOML.
    pub value: String,
    /// Who said it.
    pub source: ValueSource,
}

impl fmt::Display for ResolvedValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}  ({})", self.key, self.value, self.source)
    }
}

impl fmt::Display for ValueSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Default(reason) => write!(f, "default: {reason}"),
            Self::Line(line) => write!(f, "scene line {line}"),
            Self::Set => write!(f, "--set"),
            Self::Program => write!(f, "program"),
        }
    }
}

/// Reasons of the defaults that were filled in, by key.
pub(super) type Reasons = BTreeMap<String, String>;

/// Wall time from one checkpoint to the next where nobody says it, s.
pub(super) const CHECKPOINT_WALL: f64 = 600.0;

pub(super) struct Defaults(Reasons);

impl Defaults {
    pub(super) fn fill<T>(
        &mut self,
        key: impl Into<String>,
        slot: &mut Option<T>,
        value: T,
        reason: impl Into<String>,
    ) {
        if slot.is_none() {
            *slot = Some(value);
            self.0.insert(key.into(), reason.into());
        }
    }
}

impl Scene {
    /// Smoothing length over particle spacing where nobody says it, and why.
    pub(super) fn default_h_over_dp(&self) -> (f64, &'static str) {
        let usual = Model::water(self.dimension, 1.0, 1.0);
        match self.dimension {
            3 => (usual.h / usual.dp, "waves lose height below 1.5 dp and keep no more above; about 110 neighbours"),
            _ => (usual.h / usual.dp, "waves lose height below 1.7 dp; about 36 neighbours"),
        }
    }

    /// Layers of boundary particles: as many as the kernel reaches.
    pub(super) fn boundary_layers(&self) -> usize {
        (2.0 * self.smoothing_length() / self.dp - 1e-9).ceil() as usize
    }

    /// The scene with every default filled in, and the reason of each.
    ///
    /// # Errors
    /// `Scene` if the words contradict one another or cannot be meant.
    pub(super) fn with_defaults(&self) -> Result<(Self, Reasons)> {
        self.verify()?;
        let mut scene = self.clone();
        let mut filler = Defaults(Reasons::new());
        filler.fill("title", &mut scene.title, "untitled".into(), "the scene has no title");
        let usual = Model::water(scene.dimension, scene.dp, 1.0);
        filler.fill("gravity", &mut scene.gravity, usual.gravity.clone(), "the earth's, down the last axis");
        scene.fill_model_defaults(&mut filler, &usual);
        scene.fill_guard_defaults(&mut filler);
        scene.fill_damping_defaults(&mut filler);
        scene.fill_solid_defaults(&mut filler);
        scene.fill_constraint_defaults(&mut filler);
        scene.fill_output_defaults(&mut filler);
        Ok((scene, filler.0))
    }

    fn fill_model_defaults(&mut self, filler: &mut Defaults, usual: &Model) {
        let (ratio, why) = self.default_h_over_dp();
        let (model, time) = (&mut self.model, &mut self.time);
        let wendland = "no pairing of particles and less noise than the cubic spline, at the same cost";
        filler.fill("model.kernel", &mut model.kernel, usual.kernel, wendland);
        if model.c_h.is_none() {
            filler.fill("model.h_over_dp", &mut model.h_over_dp, ratio, why);
        }
        let why = "each pair by its own places alone; \"corrected\" where waves travel";
        filler.fill("model.gradient", &mut model.gradient, usual.gradient, why);
        filler.fill(
            "model.viscosity",
            &mut model.viscosity,
            usual.viscosity,
            "robust in any flow; α = 0.02 as in the method",
        );
        let why = "damps the density's noise and keeps still water still; δ = 0.1 as in the method";
        filler.fill("model.diffusion", &mut model.diffusion, usual.diffusion, why);
        filler.fill("model.shifting", &mut model.shifting, usual.shifting, "shifting slowly inflates the water");
        filler.fill(
            "model.walls",
            &mut model.walls,
            usual.walls,
            "no gap between water and wall; bodies rest at their draft",
        );
        let why = "no particle resolves the boundary layer, and artificial viscosity would make one many dp thick";
        filler.fill("model.slip", &mut model.slip, usual.slip, why);
        let why = "single precision where it is harmless; \"reference\" is double precision throughout";
        filler.fill("model.sweep", &mut model.sweep, usual.pair_loop, why);
        if model.c0.is_none() {
            let why =
                "density varies by 1 %, a few in an impact; the depth is from the lowest water to the highest level";
            filler.fill("model.c0_factor", &mut model.c0_factor, C0_FACTOR, why);
        }
        filler.fill("model.rho0", &mut model.rho0, usual.rho0, "fresh water, kg/m³");
        filler.fill("model.gamma", &mut model.gamma, usual.gamma, "water");
        let why = "second order, without the odd–even mode of Verlet, as exact at the same price";
        filler.fill("time.scheme", &mut time.scheme, usual.scheme, why);
        let (cfl, why) = match time.scheme {
            Some(Scheme::Verlet { .. }) => (0.2, "the method's, for Verlet"),
            _ => (usual.cfl, "impacts, contacts and ropes are worse above; waves and still water take 0.6"),
        };
        filler.fill("time.cfl", &mut time.cfl, cfl, why);
    }

    fn fill_solid_defaults(&mut self, filler: &mut Defaults) {
        let sheet = ShapeDefaults {
            thickness: self.boundary_layers() as f64 * self.dp,
            upright: [AxisName::Y, AxisName::Z][self.dimension - 2],
        };
        for (i, water) in self.water.iter_mut().enumerate() {
            if let Some(shape) = &mut water.fill.shape {
                sheet.fill(filler, &format!("water.{i}.fill.shape"), shape);
            }
        }
        for (i, solid) in self.solid.iter_mut().enumerate() {
            let key = format!("solid.{i}");
            sheet.fill(filler, &format!("{key}.shape"), &mut solid.shape);
            filler.fill(
                format!("{key}.at"),
                &mut solid.at,
                PlacementConfig::default(),
                "the shape's frame is the world's",
            );
            filler.fill(format!("{key}.friction"), &mut solid.friction, 0.3, "wet wood or plastic");
            let why = "the water between bodies takes the bounce";
            filler.fill(format!("{key}.restitution"), &mut solid.restitution, 0.0, why);
            if let Some(driven) = &mut solid.driven {
                driven.fill(filler, &format!("{key}.driven"));
            }
        }
    }

    fn fill_constraint_defaults(&mut self, filler: &mut Defaults) {
        for (i, joint) in self.joint.iter_mut().enumerate() {
            let key = format!("joint.{i}");
            filler.fill(format!("{key}.contacts"), &mut joint.contacts, false, "what is jointed may overlap");
            for (word, value) in joint.motor.iter_mut().flat_map(|motor| motor.time_values_mut()) {
                fill_time_function(filler, &format!("{key}.motor.{word}"), &mut value.0);
            }
        }
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        for (i, spring) in self.spring.iter_mut().enumerate() {
            let key = format!("spring.{i}");
            filler.fill(format!("{key}.damping"), &mut spring.damping, 0.0, "a spring without loss");
            let length = apart(&spring.from, &spring.to);
            filler.fill(format!("{key}.length"), &mut spring.length, length, "as it starts");
            filler.fill(format!("{key}.tension_only"), &mut spring.tension_only, false, "it pushes as it pulls");
        }
        for (i, rope) in self.rope.iter_mut().enumerate() {
            let length = apart(&rope.from, &rope.to);
            filler.fill(format!("rope.{i}.length"), &mut rope.length, length, "as it starts");
        }
        for (i, force) in self.force.iter_mut().enumerate() {
            let key = format!("force.{i}");
            filler.fill(format!("{key}.frame"), &mut force.frame, ForceFrame::World, "as wind, not as a thruster");
            for (word, values) in [("force", &mut force.force), ("torque", &mut force.torque)] {
                for value in values.iter_mut().flat_map(|values| values.components_mut()) {
                    fill_time_function(filler, &format!("{key}.{word}"), &mut value.0);
                }
            }
        }
    }

    fn fill_output_defaults(&mut self, filler: &mut Defaults) {
        for (i, name) in self.probe_names().into_iter().enumerate() {
            let probe = &mut self.probe[i];
            filler.fill(format!("probe.{i}.name"), &mut probe.name, name, "after what it looks at");
            filler.fill(format!("probe.{i}.every"), &mut probe.every, self.until / 1000.0, "1000 readings a run");
            if let Some(gauge) = &mut probe.elevation {
                let key = format!("probe.{i}.elevation.surface");
                filler.fill(key, &mut gauge.surface, GaugeSurface::Highest, "a jet counts, spray does not");
            }
        }
        let (count, why) = self.default_frames();
        let frames = self.frames.get_or_insert(FramesChoice::On(FramesConfig::default()));
        if let FramesChoice::On(words) = frames {
            filler.fill("frames.every", &mut words.every, self.until / count, why);
            let fields = FIELDS.map(String::from).to_vec();
            filler.fill("frames.fields", &mut words.fields, fields, "all that there are");
        }
        let wall = &mut self.checkpoint.get_or_insert_default().wall;
        filler.fill("checkpoint.wall", wall, CHECKPOINT_WALL, "a run that is killed loses ten minutes at most");
        for (i, check) in self.check.iter_mut().enumerate().filter(|(_, check)| check.formula.is_none()) {
            filler.fill(format!("check.{i}.time"), &mut check.time, "t_s".into(), "the name our own tables have");
            filler.fill(format!("check.{i}.delay"), &mut check.delay, 0.0, "the clocks agree");
        }
        for (i, name) in self.statistic_names().into_iter().enumerate() {
            filler.fill(format!("statistic.{i}.name"), &mut self.statistic[i].name, name, "after what it is");
        }
    }

    /// Every value in force and who said it, in the order of `docs/scene.md`.
    ///
    /// # Errors
    /// `Scene` if the words contradict one another or cannot be meant, or a file that gives a shape is
    /// missing or wrong.
    pub fn resolve(&self) -> Result<Vec<ResolvedValue>> {
        let (scene, reasons) = self.with_defaults()?;
        let words = toml::Table::try_from(&scene).unwrap_or_default();
        let mut lines = Vec::new();
        for section in ORDER {
            if let Some(value) = words.get(section) {
                self.flatten(section.into(), value, &reasons, &mut lines);
            }
        }
        let derived = |key: &str, value: f64, why: &str| ResolvedValue {
            key: key.into(),
            value: format!("{value}"),
            source: ValueSource::Default(why.into()),
        };
        let c0 = match self.dimension {
            2 => scene.sound_speed::<2>()?,
            _ => scene.sound_speed::<3>()?,
        };
        for (zone, strength) in scene.default_strengths()? {
            let at = lines.iter().rposition(|line| line.key.starts_with(&zone)).map_or(lines.len(), |at| at + 1);
            lines.insert(at, derived(&format!("{zone}strength"), strength, "of a long wave e⁻⁴ comes back, 1/s"));
        }
        let at = lines.iter().position(|line| line.key.starts_with("time.")).unwrap_or(lines.len());
        if scene.model.c0.is_none() {
            lines.insert(at, derived("model.c0", c0, "c0_factor · √(g · depth), m/s"));
        }
        lines.insert(at, derived("model.h", scene.smoothing_length(), "smoothing length from dp, m"));
        Ok(lines)
    }

    fn flatten(&self, key: String, value: &toml::Value, reasons: &Reasons, lines: &mut Vec<ResolvedValue>) {
        match value {
            toml::Value::Table(table) if !table.is_empty() => {
                table.iter().for_each(|(part, value)| self.flatten(format!("{key}.{part}"), value, reasons, lines));
            }
            toml::Value::Array(items) if items.iter().any(toml::Value::is_table) => {
                items
                    .iter()
                    .enumerate()
                    .for_each(|(i, value)| self.flatten(format!("{key}.{i}"), value, reasons, lines));
            }
            leaf => {
                let source = self.source(&key, reasons);
                lines.push(ResolvedValue { key: self.origin.key_with_names(&key), value: leaf.to_string(), source });
            }
        }
    }

    /// Who said `key`: the default above it, its line, or else the law's or shape's own default.
    fn source(&self, key: &str, reasons: &Reasons) -> ValueSource {
        let above = |key: &str| key.rsplit_once('.').map(|(parent, _)| parent.to_string());
        let mut place = Some(key.to_string());
        while let Some(at) = place {
            if let Some(reason) = reasons.get(&at) {
                return ValueSource::Default(reason.clone());
            }
            if at == key
                && let Some(source) = self.origin.source(&at)
            {
                return source;
            }
            place = above(&at);
        }
        if self.origin.file.is_empty() { ValueSource::Program } else { self.inherited_source(key) }
    }

    /// The source of a value that was not written itself, but whose table may have been.
    fn inherited_source(&self, key: &str) -> ValueSource {
        let written = |parent: &str| self.origin.source(parent);
        match key.rsplit_once('.') {
            Some((parent, "points")) => written(parent).unwrap_or(ValueSource::Program),
            Some((parent, _)) if written(parent).is_some() => {
                ValueSource::Default("of this choice, see docs/scene.md".into())
            }
            _ => ValueSource::Default("see docs/scene.md".into()),
        }
    }
}

/// The order in which values are listed.
const ORDER: [&str; 24] = [
    "title",
    "dimension",
    "dp",
    "until",
    "gravity",
    "scatter",
    "domain",
    "periodic",
    "guard",
    "water",
    "damping",
    "solid",
    "joint",
    "spring",
    "rope",
    "force",
    "contact",
    "model",
    "time",
    "probe",
    "frames",
    "checkpoint",
    "check",
    "statistic",
];

/// Fills in what a law that is a table does not say.
pub(super) fn fill_time_function(filler: &mut Defaults, key: &str, law: &mut TimeFunctionConfig) {
    if law.file.is_some() {
        filler.fill(format!("{key}.time"), &mut law.time, "t_s".into(), "the name our own tables have");
        filler.fill(format!("{key}.scale"), &mut law.scale, 1.0, "as in the table");
    }
}

/// What a shape needs to know of the scene for its defaults.
struct ShapeDefaults {
    thickness: f64,
    upright: AxisName,
}

impl ShapeDefaults {
    fn fill(&self, filler: &mut Defaults, key: &str, shape: &mut ShapeConfig) {
        let thick = "as many dp as the kernel reaches";
        match shape {
            ShapeConfig::Capsule { axis, .. } => {
                filler.fill(format!("{key}.capsule.axis"), axis, self.upright, "upright");
            }
            ShapeConfig::Cylinder { axis, .. } => {
                filler.fill(format!("{key}.cylinder.axis"), axis, self.upright, "upright");
            }
            ShapeConfig::Polyline(PolylineConfig { thickness, .. }) => {
                filler.fill(format!("{key}.polyline.thickness"), thickness, self.thickness, thick);
            }
            ShapeConfig::Tank { thickness, .. } => {
                filler.fill(format!("{key}.tank.thickness"), thickness, self.thickness, thick);
            }
            ShapeConfig::Mesh(words) => {
                let key = format!("{key}.mesh");
                filler.fill(format!("{key}.scale"), &mut words.scale, 1.0, "the file's own size");
                filler.fill(
                    format!("{key}.unit"),
                    &mut words.unit,
                    LengthUnit::M,
                    "neither STL nor OBJ tells its unit",
                );
                let why = "the surface if fixed, else the hull if that is nearly all solid, else convex parts";
                filler.fill(format!("{key}.contact"), &mut words.contact, Touchable::Fitting, why);
            }
            ShapeConfig::Polygon(words) if words.is_drawing() => {
                let key = format!("{key}.polygon");
                filler.fill(format!("{key}.scale"), &mut words.scale, 1.0, "the drawing's own size");
                filler.fill(format!("{key}.unit"), &mut words.unit, LengthUnit::M, "a unit of the drawing is a metre");
            }
            ShapeConfig::Compound(parts) => {
                for (i, part) in parts.iter_mut().enumerate() {
                    self.fill(filler, &format!("{key}.compound.{i}.shape"), &mut part.shape);
                }
            }
            ShapeConfig::Box { .. } | ShapeConfig::Ball { .. } | ShapeConfig::Polygon(_) => {}
        }
    }
}
