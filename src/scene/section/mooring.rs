//! `[[mooring]]`, `[[mooring_point]]` and `[[line_type]]`: mooring lines with mass, the points in which they meet, and what they are
//! made of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    force_element::{ends, tied},
    lifetime::{Element, LifetimeConfig, StrengthConfig},
    solid::{SolidConfig, require_solid},
    winch::WinchConfig,
};
use crate::{
    error::{ErrorCode, Result, suggestion},
    math::{NumberOrArray, format::three_digits},
    scene::{
        context::{Context, Defaults},
        section::shape::vector,
        untagged::{CoordinateUnit, TimeFunctionConfig},
    },
    solid::{ClumpSpec, LineDamping, LineType, MooringPointSpec, MooringSpec, SHORTEST_SHARE, TimeFunction},
};

/// Number of segments of a line unless it is given.
const SEGMENTS: usize = 20;

/// Number of parts of a run at whose ends the length of a line with a winch is checked.
const PAID_OUT_SAMPLES: u32 = 1000;

/// A section `[[mooring]]`: a mooring line with mass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct MooringConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// The solids or mooring points at its two ends; or one, the other end on the ground.
    pub between: Vec<String>,
    /// Attachment point on the first solid at the start, m; absent at a mooring point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub from: Vec<f64>,
    /// Attachment point on the second solid or the ground at the start, m; absent at a mooring point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub to: Vec<f64>,
    /// Length without tension, m.
    pub length: f64,
    /// Name of its `[[line_type]]`.
    pub line: String,
    /// Number of segments.
    pub segments: Option<usize>,
    /// Length that a winch pays out, m, over the time of the run, in addition to `length`.
    pub paid_out: Option<TimeFunctionConfig>,
    /// A winch that holds a tension or a length.
    pub winch: Option<WinchConfig>,
    /// Clump weights and floats.
    pub clumps: Option<Vec<ClumpConfig>>,
    /// Whether the water gets the opposite of its drag and added-mass force.
    pub acts_on_water: Option<bool>,
    /// Time from which it acts, s.
    pub since: Option<f64>,
    /// Time at which it ends, s.
    pub until: Option<f64>,
    /// Tension under which a segment breaks, N.
    pub breaks: Option<StrengthConfig>,
}

/// A clump weight or a float on a mooring line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ClumpConfig {
    /// Length of line from `from` to the clump, m.
    pub at: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Volume, m³.
    pub volume: Option<f64>,
    /// Drag coefficient times area, m².
    pub drag_area: Option<f64>,
    /// Added-mass coefficient of the volume.
    pub added_mass: Option<f64>,
}

/// A section `[[mooring_point]]`: a point in which mooring lines meet, with the mass of a clump weight or a buoy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct MooringPointConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// Place from which it finds its rest at the start, m.
    pub at: Vec<f64>,
    /// Mass, kg.
    pub mass: Option<f64>,
    /// Volume, m³.
    pub volume: Option<f64>,
    /// Drag coefficient times area, m².
    pub drag_area: Option<f64>,
    /// Added-mass coefficient of the volume.
    pub added_mass: Option<f64>,
}

impl MooringPointConfig {
    /// A point without mass near this place (m).
    pub fn new(name: impl Into<String>, at: impl Into<Vec<f64>>) -> Self {
        Self { name: name.into(), at: at.into(), mass: None, volume: None, drag_area: None, added_mass: None }
    }

    /// Refuses a name of a solid, and numbers out of range.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, solids: &[SolidConfig]) -> Result<()> {
        if solids.iter().any(|solid| solid.name == self.name) {
            let what = format!("a solid is called \"{}\" too", self.name);
            return Err(ctx.error_with_help(&format!("{key}.name"), what, "give each its own name"));
        }
        ctx.require_dimension(&format!("{key}.at"), &self.at)?;
        verify_body(ctx, key, [self.mass, self.volume, self.drag_area, self.added_mass])
    }

    /// The point.
    pub(crate) fn build<const D: usize>(&self) -> MooringPointSpec<D> {
        let body = ClumpSpec {
            at: 0.0,
            mass: self.mass.unwrap_or_default(),
            volume: self.volume.unwrap_or_default(),
            drag_area: self.drag_area.unwrap_or_default(),
            added_mass: self.added_mass.unwrap_or_default(),
        };
        MooringPointSpec::<D>::new(&self.name, vector(&self.at)).body(body)
    }
}

/// Refuses a mass, volume, drag area or added-mass coefficient below 0.
fn verify_body(ctx: &Context, key: &str, numbers: [Option<f64>; 4]) -> Result<()> {
    for (word, x) in ["mass", "volume", "drag_area", "added_mass"].into_iter().zip(numbers) {
        if let Some(x) = x.filter(|x| !(*x >= 0.0 && x.is_finite())) {
            let what = format!("{word} must be 0 or more, not {x}");
            return Err(ctx.error_at(&format!("{key}.{word}"), what).with_code(ErrorCode::OutOfRange));
        }
    }
    Ok(())
}

/// A section `[[line_type]]`: what a mooring line is made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct LineTypeConfig {
    /// Name: letters, digits, `_` and `-`.
    pub name: String,
    /// Volume-equivalent diameter, m.
    pub diameter: f64,
    /// Mass of a metre in air, kg/m.
    pub mass_per_length: f64,
    /// Axial stiffness EA, N; or rows of strain and tension, N.
    pub stiffness: NumberOrArray,
    /// Axial damping BA, N s.
    pub damping: Option<f64>,
    /// Axial damping over the critical damping of a segment.
    pub damping_ratio: Option<f64>,
    /// Bending stiffness EI, N m².
    pub bending_stiffness: Option<f64>,
    /// Added-mass coefficient across the line.
    pub added_mass: Option<f64>,
    /// Added-mass coefficient along the line.
    pub added_mass_axial: Option<f64>,
    /// Drag coefficient across the line.
    pub drag: Option<f64>,
    /// Drag coefficient along the line.
    pub drag_axial: Option<f64>,
    /// Diameter with which the line touches fixed solids, m; by default its axis touches them.
    pub contact_diameter: Option<f64>,
    /// Stiffness of fixed solids against the line, Pa/m.
    pub bed_stiffness: Option<f64>,
    /// Damping of fixed solids against the line, Pa s/m.
    pub bed_damping: Option<f64>,
    /// Coulomb friction coefficient of fixed solids.
    pub bed_friction: Option<f64>,
}

impl LineTypeConfig {
    /// A line type of this volume-equivalent diameter (m), mass (kg/m) and axial stiffness EA (N).
    pub fn new(name: impl Into<String>, diameter: f64, mass_per_length: f64, stiffness: f64) -> Self {
        Self {
            name: name.into(),
            diameter,
            mass_per_length,
            stiffness: NumberOrArray::One(stiffness),
            damping: None,
            damping_ratio: None,
            bending_stiffness: None,
            added_mass: None,
            added_mass_axial: None,
            drag: None,
            drag_axial: None,
            contact_diameter: None,
            bed_stiffness: None,
            bed_damping: None,
            bed_friction: None,
        }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        let usual = LineType::new(self.diameter, self.mass_per_length, 1.0);
        if self.damping.is_none() {
            let why = "of a segment: no ringing of the shortest wave on the line";
            defaults.fill(format!("{key}.damping_ratio"), &mut self.damping_ratio, 1.0, why);
        }
        let values = [
            ("bending_stiffness", &mut self.bending_stiffness, usual.bending_stiffness, "a chain"),
            ("added_mass", &mut self.added_mass, usual.added_mass[0], "a cylinder across the flow"),
            ("added_mass_axial", &mut self.added_mass_axial, usual.added_mass[1], "a smooth line"),
            ("drag", &mut self.drag, usual.drag[0], "a cylinder across the flow"),
            ("drag_axial", &mut self.drag_axial, usual.drag[1], "a smooth line"),
            ("bed_stiffness", &mut self.bed_stiffness, usual.bed_stiffness, "as MoorDyn"),
            ("bed_damping", &mut self.bed_damping, usual.bed_damping, "as MoorDyn"),
            ("bed_friction", &mut self.bed_friction, usual.bed_friction, "as MoorDyn: no friction"),
        ];
        for (word, value, usual, why) in values {
            defaults.fill(format!("{key}.{word}"), value, usual, why);
        }
    }

    /// Refuses numbers out of range.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        for (word, x) in [("diameter", self.diameter), ("mass_per_length", self.mass_per_length)] {
            ctx.require_positive(&format!("{key}.{word}"), Some(x))?;
        }
        match &self.stiffness {
            NumberOrArray::One(x) => ctx.require_positive(&format!("{key}.stiffness"), Some(*x))?,
            other if is_table(other) => {}
            _ => {
                let help = "a number (EA, N), or rows of strain and tension (N), as in  stiffness = [[0, 0], [0.01, 100], [0.05, 900]] : \
                            the first is [0, 0], and both increase";
                let error =
                    ctx.error_with_help(&format!("{key}.stiffness"), "this is no table of tension over strain", help);
                return Err(error.with_code(ErrorCode::OutOfRange));
            }
        }
        let others = [
            ("damping", self.damping),
            ("damping_ratio", self.damping_ratio),
            ("bending_stiffness", self.bending_stiffness),
            ("added_mass", self.added_mass),
            ("added_mass_axial", self.added_mass_axial),
            ("drag", self.drag),
            ("drag_axial", self.drag_axial),
            ("contact_diameter", self.contact_diameter),
            ("bed_stiffness", self.bed_stiffness),
            ("bed_damping", self.bed_damping),
            ("bed_friction", self.bed_friction),
        ];
        for (word, x) in others {
            if let Some(x) = x.filter(|x| !(*x >= 0.0 && x.is_finite())) {
                let what = format!("{word} must be 0 or more, not {x}");
                return Err(ctx.error_at(&format!("{key}.{word}"), what).with_code(ErrorCode::OutOfRange));
            }
        }
        if self.damping.is_some() && self.damping_ratio.is_some() {
            let what = "damping and damping_ratio say the same twice";
            return Err(ctx.error_at(&format!("{key}.damping_ratio"), what).with_code(ErrorCode::ConflictingKeys));
        }
        Ok(())
    }

    /// The line type with all defaults.
    fn build(&self) -> LineType {
        let mut made = LineType::new(self.diameter, self.mass_per_length, 1.0);
        match &self.stiffness {
            NumberOrArray::One(stiffness) => made.stiffness = *stiffness,
            NumberOrArray::List(_) => {}
            NumberOrArray::Rows(rows) => made = made.table(rows.iter().map(|row| [row[0], row[1]]).collect()),
        }
        made.damping = match self.damping {
            Some(damping) => LineDamping::Given(damping),
            None => LineDamping::OfCritical(self.damping_ratio.unwrap_or(1.0)),
        };
        let or = |value: Option<f64>, usual: f64| value.unwrap_or(usual);
        made.bending_stiffness = or(self.bending_stiffness, made.bending_stiffness);
        made.added_mass = [or(self.added_mass, made.added_mass[0]), or(self.added_mass_axial, made.added_mass[1])];
        made.drag = [or(self.drag, made.drag[0]), or(self.drag_axial, made.drag[1])];
        made.contact_diameter = self.contact_diameter;
        made.bed_stiffness = or(self.bed_stiffness, made.bed_stiffness);
        made.bed_damping = or(self.bed_damping, made.bed_damping);
        made.bed_friction = or(self.bed_friction, made.bed_friction);
        made
    }
}

/// Whether these are rows of increasing strain and tension from [0, 0] on.
fn is_table(rows: &NumberOrArray) -> bool {
    let NumberOrArray::Rows(rows) = rows else { return false };
    let rises = |pair: &[Vec<f64>]| (0..2).all(|k| pair[1][k] > pair[0][k]);
    rows.len() >= 2
        && rows.iter().all(|row| row.len() == 2 && row.iter().all(|x| x.is_finite()))
        && rows[0] == [0.0, 0.0]
        && rows.windows(2).all(rises)
}

/// What a `[[mooring]]` refers to in its scene.
pub(crate) struct MooringScope<'a> {
    /// The solids.
    pub(crate) solids: &'a [SolidConfig],
    /// The points in which lines meet.
    pub(crate) points: &'a [MooringPointConfig],
    /// The line types.
    pub(crate) types: &'a [LineTypeConfig],
}

impl MooringScope<'_> {
    /// The number of the mooring point called `name`.
    fn point(&self, name: &str) -> Option<usize> {
        self.points.iter().position(|point| point.name == name)
    }
}

impl MooringConfig {
    /// A mooring line of `length` (m) of the line type `line` from the point `from` (m) of `solid` to the point `to` (m) of the ground.
    pub fn new(
        name: impl Into<String>,
        solid: impl Into<String>,
        from: impl Into<Vec<f64>>,
        to: impl Into<Vec<f64>>,
        length: f64,
        line: impl Into<String>,
    ) -> Self {
        Self {
            name: name.into(),
            between: vec![solid.into()],
            from: from.into(),
            to: to.into(),
            length,
            line: line.into(),
            segments: None,
            paid_out: None,
            winch: None,
            clumps: None,
            acts_on_water: None,
            since: None,
            until: None,
            breaks: None,
        }
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        defaults.fill(format!("{key}.segments"), &mut self.segments, SEGMENTS, "tension at rest within 1e-4");
        if let Some(law) = &mut self.paid_out {
            law.fill(defaults, &format!("{key}.paid_out"));
        }
        if let Some(winch) = &mut self.winch {
            winch.fill(defaults, &format!("{key}.winch"), self.length);
        }
        let why = "its wake is narrower than a particle";
        defaults.fill(format!("{key}.acts_on_water"), &mut self.acts_on_water, false, why);
    }

    fn lifetime(&self) -> LifetimeConfig<'_> {
        LifetimeConfig { since: self.since, until: self.until, breaks: self.breaks.as_ref() }
    }

    /// Refuses ends that do not move, an unknown line type, and numbers out of range.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, scope: &MooringScope) -> Result<()> {
        let MooringScope { solids, types, .. } = *scope;
        let between = format!("{key}.between");
        if !(1..=2).contains(&self.between.len()) {
            let what = format!("between names one solid or two, not {}", self.between.len());
            return Err(ctx.error_at(&between, what));
        }
        let on_solids = self.between.iter().filter(|name| scope.point(name).is_none());
        on_solids.clone().try_for_each(|name| require_solid(ctx, solids, &between, name))?;
        if self.between.len() == 2 && self.between[0] == self.between[1] {
            return Err(ctx.error_at(&between, format!("\"{}\" is named twice", self.between[0])));
        }
        let moves = |solid: &&SolidConfig| self.between.contains(&solid.name) && solid.fixed != Some(true);
        let joined = on_solids.count() < self.between.len();
        if !joined && !solids.iter().any(|solid| moves(&solid)) {
            let help = "one of them at least is  free = { ... }  or  driven = { ... }";
            return Err(ctx.error_with_help(&between, "this line holds nothing that moves", help));
        }
        for (k, (word, at)) in [("from", &self.from), ("to", &self.to)].into_iter().enumerate() {
            let point = self.between.get(k).filter(|name| scope.point(name).is_some());
            match (point, at.is_empty()) {
                (Some(name), false) => {
                    let what = format!("{word} is given, and this end is in the mooring point \"{name}\"");
                    let help = format!("leave out {word}: the point has its place");
                    return Err(ctx.error_with_help(&format!("{key}.{word}"), what, help));
                }
                (Some(_), true) => {}
                (None, true) => {
                    let what = format!("{word} is missing: where is this end at the start?");
                    let help = format!("write  {word} = [1.0, 0.0]        # m, with a number for each axis");
                    return Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::MissingKey));
                }
                (None, false) => ctx.require_dimension(&format!("{key}.{word}"), at)?,
            }
        }
        if let Some(law) = &self.paid_out {
            law.verify(ctx, &format!("{key}.paid_out"))?;
        }
        ctx.require_positive(&format!("{key}.length"), Some(self.length))?;
        self.lifetime().verify(ctx, key, Element::Line)?;
        self.lifetime().verify_solids(ctx, key, tied(solids, &self.between))?;
        if let Some(winch) = &self.winch {
            if self.paid_out.is_some() {
                let help = "leave out one: paid_out is a given length over time, winch a controller";
                let error = ctx.error_with_help(&format!("{key}.winch"), "the line has paid_out and winch", help);
                return Err(error.with_code(ErrorCode::ConflictingKeys));
            }
            let breaks = self.lifetime().build(std::iter::empty()).strength;
            winch.verify(ctx, &format!("{key}.winch"), self.length, breaks)?;
        }
        if !types.iter().any(|known| known.name == self.line) {
            let known: Vec<&str> = types.iter().map(|known| known.name.as_str()).collect();
            let what =
                format!("no line type is called \"{}\"{}", self.line, suggestion(&self.line, known.iter().copied()));
            let help = match known.is_empty() {
                true => "the scene has no [[line_type]]: it gives diameter, mass_per_length and stiffness".into(),
                false => format!("known: {}", known.join(", ")),
            };
            let error = ctx.error_with_help(&format!("{key}.line"), what, help);
            return Err(error.with_code(ErrorCode::UnknownName));
        }
        for (i, clump) in self.clumps.iter().flatten().enumerate() {
            let key = format!("{key}.clumps.{i}");
            if !(0.0..=self.length).contains(&clump.at) {
                let what = format!("at is {}, and the line is {} m long", clump.at, self.length);
                return Err(ctx.error_at(&format!("{key}.at"), what).with_code(ErrorCode::OutOfRange));
            }
            verify_body(ctx, &key, [Some(clump.mass), clump.volume, clump.drag_area, clump.added_mass])?;
        }
        Ok(())
    }

    /// The line between the solids and points of `scope`.
    ///
    /// # Errors
    /// `Scene` if the law of the winch is not valid.
    pub(crate) fn build<const D: usize>(
        &self,
        ctx: &Context,
        key: &str,
        scope: &MooringScope,
    ) -> Result<MooringSpec<D>> {
        let kind = scope.types.iter().find(|kind| kind.name == self.line);
        let line = kind.map_or_else(|| LineType::new(1.0, 1.0, 1.0), LineTypeConfig::build);
        let points = [0, 1].map(|k| self.between.get(k).and_then(|name| scope.point(name)));
        let place = |k: usize, at: &[f64]| points[k].map_or_else(|| at.to_vec(), |p| scope.points[p].at.clone());
        let ends = ends(scope.solids, &self.between, &place(0, &self.from), &place(1, &self.to));
        let mut made =
            MooringSpec::new(&self.name, ends, self.length, line).segments(self.segments.unwrap_or(SEGMENTS));
        made.points = points;
        made.lifetime = self.lifetime().build(tied(scope.solids, &self.between));
        if let Some(law) = &self.paid_out {
            let span = [made.lifetime.since, made.lifetime.until];
            let law = law.build_during(ctx, &format!("{key}.paid_out"), CoordinateUnit::Si("m"), span)?;
            self.require_line_left(ctx, key, &law, [span[0].max(0.0), span[1].min(ctx.until)])?;
            made.paid_out = Some(law);
        }
        made.winch = self.winch.map(|winch| winch.build(self.length));
        made.acts_on_water = self.acts_on_water.unwrap_or_default();
        made.clumps = (self.clumps.iter().flatten())
            .map(|clump| ClumpSpec {
                at: clump.at,
                mass: clump.mass,
                volume: clump.volume.unwrap_or_default(),
                drag_area: clump.drag_area.unwrap_or_default(),
                added_mass: clump.added_mass.unwrap_or_default(),
            })
            .collect();
        Ok(made)
    }

    /// Refuses a `law` of the winch that makes the line shorter, at a time of the `span` (s), than the program can compute.
    fn require_line_left(&self, ctx: &Context, key: &str, law: &TimeFunction, span: [f64; 2]) -> Result<()> {
        let time = |i: u32| span[0] + (span[1] - span[0]) * f64::from(i) / f64::from(PAID_OUT_SAMPLES);
        let left = |t: f64| self.length + law.value_and_rate(t).0;
        let short = (0..=PAID_OUT_SAMPLES).map(time).find(|&t| left(t) < SHORTEST_SHARE * self.length);
        let Some(t) = short else { return Ok(()) };
        let what = format!(
            "at t = {} s the winch has left {} m of a line of {} m",
            three_digits(t),
            three_digits(left(t)),
            self.length
        );
        let help =
            format!("pay out {} m or more, or end the line before", three_digits((SHORTEST_SHARE - 1.0) * self.length));
        let error = ctx.error_with_help(&format!("{key}.paid_out"), what, help);
        Err(error.with_code(ErrorCode::OutOfRange))
    }
}
