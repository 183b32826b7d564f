//! `[[inflow]]` and `[[outflow]]`: vertical faces through which water enters and leaves.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    water::{InitialFlow, WaterBody},
    wave::{self, IrregularWaveConfig, JONSWAP_GAMMA, RegularWaveConfig, WaveComponentsConfig},
    wavemaker::read_components,
};
use crate::{
    error::{ErrorCode, Result},
    geometry::{Shape, WaterRegion},
    math::{Bounds, Pose, expression::UnsteadyField, format::three_digits},
    scene::{
        context::{Context, Defaults, quoted_list, set_keys},
        untagged::{CoordinateUnit, FieldFormulaConfig, TimeValueConfig},
    },
    simulation::OpenBoundary,
    wavemaker::{IncidentWaves, WaterAtFace, WaveSpectrum, against_current, wave_number_on_current},
};

/// One `[[inflow]]` or `[[outflow]]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct OpenBoundaryConfig {
    /// Its name in messages and probes.
    pub name: Option<String>,
    /// Coordinate of a face normal to x, m.
    pub x: Option<f64>,
    /// Coordinate of a face normal to y, m; 3-D only.
    pub y: Option<f64>,
    /// Velocity in the sense of the flow, m/s: a number, or a formula in the position and t.
    pub velocity: Option<FieldFormulaConfig>,
    /// Velocity in the sense of the flow as a table over height and time, in place of `velocity`.
    pub profile: Option<VelocityProfileConfig>,
    /// Factor on the velocity, –: a number, a formula in t or a table.
    pub factor: Option<TimeValueConfig>,
    /// Height of the surface at rest, m: a number, a formula in t or a table.
    pub level: Option<TimeValueConfig>,
    /// Whether the velocity yields to waves that leave, so that they are not reflected.
    pub absorb: Option<bool>,
    /// Period of the waves that leave, s; long waves without one.
    pub absorb_period: Option<f64>,
    /// Waves that enter, on the current of the face.
    pub wave: Option<FaceWaveConfig>,
}

/// Waves that enter through a face, along its normal: exactly one kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct FaceWaveConfig {
    /// One height and one period, to first order.
    pub regular: Option<RegularWaveConfig>,
    /// A sea of JONSWAP's spectrum.
    pub jonswap: Option<IrregularWaveConfig>,
    /// A sea of Bretschneider's spectrum.
    pub bretschneider: Option<IrregularWaveConfig>,
    /// A fully developed sea: the height determines the period.
    pub pierson_moskowitz: Option<IrregularWaveConfig>,
    /// A sum of components from a table.
    pub components: Option<WaveComponentsConfig>,
    /// Duration of the rise to the full height, s.
    pub ramp: Option<f64>,
}

/// Velocities at heights and times, between which the velocity is linear; beyond their ends it is that at the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct VelocityProfileConfig {
    /// Heights (coordinates of the last axis), m, ascending.
    pub heights: Vec<f64>,
    /// Times, s, ascending; none if the velocity is steady.
    #[serde(default)]
    pub times: Vec<f64>,
    /// Velocities (m/s): a row for each time, or one for a steady velocity, with a number for each height.
    pub speeds: Vec<Vec<f64>>,
}

/// Most numbers of a table of velocities: each is evaluated for each particle of a buffer.
const MOST_SPEEDS: usize = 1000;

impl VelocityProfileConfig {
    /// Refuses tables that do not fit together.
    fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let refuse = |name: &str, what: String, help: &str| {
            Err(ctx.error_with_help(&format!("{key}.{name}"), &what, help).with_code(ErrorCode::OutOfRange))
        };
        let ascends = |x: &[f64]| x.iter().all(|x| x.is_finite()) && x.windows(2).all(|pair| pair[0] < pair[1]);
        if self.heights.is_empty() || !ascends(&self.heights) {
            return refuse(
                "heights",
                "the heights of a profile are finite and ascend".into(),
                "write  heights = [0.0, 0.4]",
            );
        }
        if !ascends(&self.times) {
            return refuse(
                "times",
                "the times of a profile are finite and ascend".into(),
                "write  times = [0.0, 10.0]",
            );
        }
        let (rows, columns) = (self.times.len().max(1), self.heights.len());
        let fits = self.speeds.len() == rows && self.speeds.iter().all(|row| row.len() == columns);
        if !fits || self.speeds.iter().flatten().any(|x| !x.is_finite()) {
            let given: Vec<usize> = self.speeds.iter().map(Vec::len).collect();
            let what =
                format!("{rows} rows of {columns} finite velocities are needed, and rows of {given:?} are given");
            return refuse("speeds", what, "a row for each time, with a velocity for each height");
        }
        if rows * columns > MOST_SPEEDS {
            let what = format!("a profile has {MOST_SPEEDS} velocities at most, and this one {}", rows * columns);
            return refuse("speeds", what, "give a formula, velocity, or fewer heights and times");
        }
        Ok(())
    }

    /// The formula of the velocity in the height, which is the variable `height`, and the time t.
    fn formula(&self, height: &str) -> String {
        let at_height = |k: usize| {
            let speeds: Vec<String> = self.speeds.iter().map(|row| format!("({:?})", row[k])).collect();
            piecewise_linear("t", &self.times, &speeds)
        };
        let over_time: Vec<String> = (0..self.heights.len()).map(at_height).collect();
        piecewise_linear(height, &self.heights, &over_time)
    }
}

/// The formula that is `values` where `variable` is one of `places`, and linear between: a sum of ramps.
fn piecewise_linear(variable: &str, places: &[f64], values: &[String]) -> String {
    let ramps = places.windows(2).zip(values.windows(2)).map(|(x, y)| {
        let [from, to] = [x[0], x[1]];
        format!("+(({})-({}))*min(max(({variable}-({from:?}))/{:?},0),1)", y[1], y[0], to - from)
    });
    std::iter::once(values[0].clone()).chain(ramps).collect()
}

/// The sense of a flow through a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaceFlow {
    /// Water enters.
    In,
    /// Water leaves.
    Out,
}

impl FaceFlow {
    /// The section of the scene.
    pub(crate) fn section(self) -> &'static str {
        match self {
            Self::In => "inflow",
            Self::Out => "outflow",
        }
    }
}

impl OpenBoundaryConfig {
    /// The face normal to x at the coordinate `x` (m).
    pub fn at_x(x: f64) -> Self {
        Self { x: Some(x), ..Self::default() }
    }

    /// The same face with this velocity in the sense of the flow: a number (m/s) or a formula.
    pub fn velocity(self, velocity: &str) -> Self {
        Self { velocity: Some(FieldFormulaConfig(velocity.into())), ..self }
    }

    /// The same face with a surface at rest at the height `level`: a number (m) or a formula in t (s).
    pub fn level(self, level: impl Into<TimeValueConfig>) -> Self {
        Self { level: Some(level.into()), ..self }
    }

    /// The formula of the velocity in the sense of the flow, if the face has one.
    fn velocity_formula(&self, dimension: usize) -> Option<String> {
        let profile = self.profile.as_ref().map(|profile| profile.formula(if dimension == 2 { "y" } else { "z" }));
        profile.or_else(|| self.velocity.as_ref().map(|velocity| velocity.0.clone()))
    }

    /// Number of the axis and coordinate (m).
    pub(crate) fn place(&self) -> Option<(usize, f64)> {
        match (self.x, self.y) {
            (Some(x), None) => Some((0, x)),
            (None, Some(y)) => Some((1, y)),
            _ => None,
        }
    }

    /// Refuses a face without a place, and one whose flow nothing determines.
    pub(crate) fn verify(&self, ctx: &Context, key: &str, flow: FaceFlow) -> Result<()> {
        if let Some(name) = &self.name {
            ctx.require_file_name(&format!("{key}.name"), name)?;
        }
        if self.y.is_some() && ctx.dimension == 2 {
            let what = "a face normal to y is horizontal in 2-D; faces are vertical";
            return Err(ctx.error_with_help(&format!("{key}.y"), what, "write  x = 0.0"));
        }
        if self.place().is_none_or(|(_, at)| !at.is_finite()) {
            let what = "a face is normal to one horizontal axis, at one coordinate";
            return Err(ctx.error_with_help(key, what, "write  x = 0.0"));
        }
        if let Some(profile) = &self.profile {
            if self.velocity.is_some() {
                let what = "a face has a velocity or a profile, not both";
                let help = "leave velocity or profile out; factor multiplies either";
                return Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::ConflictingKeys));
            }
            profile.verify(ctx, &format!("{key}.profile"))?;
        }
        let velocity = self.velocity_formula(ctx.dimension);
        match &velocity {
            Some(velocity) if ctx.dimension == 2 => UnsteadyField::<2>::parse(velocity).map(|_| ()),
            Some(velocity) => UnsteadyField::<3>::parse(velocity).map(|_| ()),
            None => Ok(()),
        }
        .map_err(|e| ctx.with_location(e, &format!("{key}.velocity")))?;
        if let Some(factor) = &self.factor {
            factor.verify(ctx, &format!("{key}.factor"))?;
        }
        if velocity.is_none() {
            if flow == FaceFlow::In {
                let what = "an inflow has a velocity";
                return Err(ctx.error_with_help(key, what, "write  velocity = 0.5        # m/s, into the water"));
            }
            if self.factor.is_some() || self.absorb == Some(true) || self.absorb_period.is_some() || self.wave.is_some()
            {
                let what = "without a velocity there is nothing to multiply or to return to, and no current for waves";
                let help = "write  velocity = 0.5        # m/s, that of the inflow";
                return Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::ConflictingKeys));
            }
        }
        ctx.require_positive(&format!("{key}.absorb_period"), self.absorb_period)?;
        if self.absorb_period.is_some() && self.absorb == Some(false) {
            let what = "a face that absorbs no waves has no use for their period";
            let help = "leave absorb_period out, or write  absorb = true";
            return Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::ConflictingKeys));
        }
        if let Some(wave) = &self.wave {
            wave.verify(ctx, &format!("{key}.wave"))?;
        }
        if self.absorb == Some(true) && ctx.gravity.is_some() && !ctx.has_gravity() {
            let what = "without gravity there are no waves to absorb";
            return Err(ctx.error_with_help(key, what, "leave absorb out"));
        }
        if let Some(level) = &self.level {
            level.verify(ctx, &format!("{key}.level"))?;
        }
        Ok(())
    }

    /// Fills in the defaults of face number `i` of its section.
    pub(crate) fn fill(&mut self, ctx: &Context, defaults: &mut Defaults, i: usize, flow: FaceFlow) {
        let (section, key) = (flow.section(), format!("{}.{i}", flow.section()));
        defaults.fill(format!("{key}.name"), &mut self.name, default_name(section, i), "after its kind");
        for (word, law) in [("factor", &mut self.factor), ("level", &mut self.level)] {
            if let Some(law) = law {
                law.0.fill(defaults, &format!("{key}.{word}"));
            }
        }
        // A scene that gives no gravity has that of the earth.
        let weight = ctx.gravity.is_none() || ctx.has_gravity();
        let waves = self.wave.is_some() || self.absorb_period.is_some();
        let absorbs = (flow == FaceFlow::Out || waves) && self.velocity_formula(ctx.dimension).is_some() && weight;
        let why = match (flow, absorbs) {
            (_, true) => "waves leave",
            (FaceFlow::In, _) => "the discharge is exact",
            (FaceFlow::Out, _) => "no velocity or no gravity is given",
        };
        defaults.fill(format!("{key}.absorb"), &mut self.absorb, absorbs, why);
        if let Some(wave) = &mut self.wave {
            let period = wave.fill(ctx, defaults, &format!("{key}.wave"));
            if let Some(period) = period.filter(|_| self.absorb == Some(true)) {
                let why = "of the wave that enters";
                defaults.fill(format!("{key}.absorb_period"), &mut self.absorb_period, period, why);
            }
        }
    }

    /// The face beside `water` in a run until the time `until` (s), and the buffer of length `length` (m) that is to be filled beyond it.
    /// `bed` (m) is the height of the bed there; if it is not known, the water reaches down to the end of its region.
    pub(crate) fn build<const D: usize>(
        &self,
        ctx: &Context,
        (key, flow): (&str, FaceFlow),
        water: &[WaterBody<D>],
        (length, until): (f64, f64),
        bed: Option<f64>,
    ) -> Result<(OpenBoundary<D>, WaterBody<D>)> {
        let Some((axis, at)) = self.place() else { return Err(ctx.error_at(key, "where is the face?")) };
        let along = ["x", "y"][axis];
        let all = water.iter().fold(Bounds::<D>::empty(), |all, body| all.union(&body.bounds()));
        let is_lower = at - all.min[axis] < all.max[axis] - at;
        // Zero without a sign.
        let end = 0.0 + if is_lower { all.min[axis] } else { all.max[axis] };
        if (at - end).abs() > 1e-6 * ctx.dp {
            let what = format!("the face at {along} = {at} is not where the water ends, at {along} = {end}");
            let help =
                format!("write  {along} = {end}, or end the water at the face; the program fills the buffer beyond it");
            return Err(ctx.error_with_help(&format!("{key}.{along}"), what, help));
        }
        let beside = water.iter().filter(|body| {
            let bounds = body.bounds();
            (if is_lower { bounds.min[axis] } else { bounds.max[axis] } - at).abs() <= 1e-6 * ctx.dp
        });
        let mut bounds = beside.clone().fold(Bounds::<D>::empty(), |all, body| all.union(&body.bounds()));
        let top = beside.map(|body| body.level).fold(f64::NEG_INFINITY, f64::max);
        let law = |value: &Option<TimeValueConfig>, word: &str| {
            let unit = CoordinateUnit::Si(if word == "level" { "m" } else { "1" });
            value.as_ref().map(|law| law.0.build(ctx, &format!("{key}.{word}"), unit)).transpose()
        };
        let written = law(&self.level, "level")?;
        let level = written.as_ref().map_or(top, |level| level.value_and_rate(0.0).0);
        let changes = written.as_ref().is_some_and(|level| level.steady_value().is_none());
        if ctx.has_gravity() && (level - top).abs() > 0.5 * ctx.dp {
            let (what, help) = if changes {
                let what = format!("the level is {level} m at t = 0, and that of the water beside the face {top} m");
                let by = three_digits(top - level);
                (what, format!("add {by} m to it, or change the water: a step of the surface would break"))
            } else {
                let what = format!("the level {level} m differs from {top} m, that of the water beside the face");
                (what, format!("write  level = {top}, or change the water: a step of the surface would break"))
            };
            return Err(ctx.error_with_help(&format!("{key}.level"), what, help));
        }
        let (from, to) = if is_lower { (at - length, at) } else { (at, at + length) };
        (bounds.min[axis], bounds.max[axis]) = (from, to);
        bounds.max[D - 1] = top;
        let velocity = self.velocity_formula(D).map(|velocity| UnsteadyField::parse(&velocity)).transpose();
        let velocity = velocity.map_err(|e| ctx.with_location(e, &format!("{key}.velocity")))?;
        let name = self.name.as_deref().unwrap_or(flow.section());
        let face = match (flow, velocity) {
            (FaceFlow::In, Some(velocity)) => OpenBoundary::inflow(name, axis, at, velocity),
            (_, velocity) => OpenBoundary::outflow(name, axis, at, velocity),
        };
        let face = OpenBoundary { is_lower, factor: law(&self.factor, "factor")?, ..face };
        let (g, depth) = (ctx.gravity_norm(), top - bed.unwrap_or(bounds.min[D - 1]));
        let middle = 0.5 * (bounds.min + bounds.max);
        let waves = self.wave.as_ref().map(|wave| {
            let current = face.steady_current().ok_or_else(|| {
                let what = "waves enter on a current that is the same at every height and time";
                ctx.error_with_help(key, what, "write  velocity = 0.3        # m/s, and leave factor out")
            })?;
            let water = WaterAtFace { depth, current, g, ramp: wave.ramp, until };
            wave.build(ctx, &format!("{key}.wave"), &water)
        });
        let waves = waves.transpose()?;
        let period = self.absorb_period.or(waves.as_ref().map(IncidentWaves::main_period));
        let absorbed_speed = match (self.absorb, period) {
            // The water follows its level by long waves, whatever `absorb` is: its default is false without a velocity.
            _ if changes && face.velocity.is_none() => Some((g * depth).sqrt()),
            (None | Some(false), _) => None,
            // Without a period, the speed is that of long waves.
            (Some(true), None) => Some((g * depth).sqrt()),
            (Some(true), Some(period)) => {
                // The phase speed relative to the water of the waves that leave, on the current that they meet.
                let (omega, along) = (TAU / period, face.outward_velocity(&middle, 0.0).unwrap_or(0.0));
                let k = wave_number_on_current(omega, depth, along, g).ok_or_else(|| {
                    let what = format!("the current of {} m/s stops waves of {period} s that would leave", -along);
                    let help = format!("write  absorb = false, or: {}", against_current(omega, depth, -along, g));
                    ctx.error_with_help(&format!("{key}.absorb_period"), &what, &help)
                })?;
                Some(omega / k - along)
            }
        };
        // Without velocity and level the pressure is that of the water.
        let level = if face.velocity.is_some() { written.or(Some(level.into())) } else { written };
        let face = OpenBoundary { level, absorbed_speed, waves, ..face };
        let shape = Shape::Box { size: bounds.size() };
        let pose = Pose::at(middle);
        let buffer = WaterBody {
            region: WaterRegion { shape, pose },
            bottom: bounds.min[D - 1],
            level: top,
            flow: InitialFlow::at_rest(),
            inside: None,
        };
        Ok((face, buffer))
    }
}

/// Components of a sea that enters through a face, if the scene does not say.
const FACE_COMPONENTS: usize = 40;

/// Acceleration of gravity of a scene that gives none, m/s².
const EARTH: f64 = 9.81;

impl FaceWaveConfig {
    /// The sea, its name in the scene and its spectrum under the acceleration `g` (m/s²).
    fn sea(&self, g: f64) -> Option<(&'static str, &IrregularWaveConfig, WaveSpectrum)> {
        let peak = |sea: &IrregularWaveConfig| sea.peak_period.unwrap_or_default();
        if let Some(sea) = &self.jonswap {
            return Some(("jonswap", sea, WaveSpectrum::jonswap(peak(sea), sea.gamma.unwrap_or(JONSWAP_GAMMA))));
        }
        if let Some(sea) = &self.bretschneider {
            return Some(("bretschneider", sea, WaveSpectrum::bretschneider(peak(sea))));
        }
        let sea = self.pierson_moskowitz.as_ref()?;
        Some(("pierson_moskowitz", sea, WaveSpectrum::pierson_moskowitz(sea.height, g)))
    }

    /// Refuses waves of no kind or of several, of another order than the first, and without a constant gravity.
    fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let kinds = set_keys([
            ("regular", self.regular.is_some()),
            ("jonswap", self.jonswap.is_some()),
            ("bretschneider", self.bretschneider.is_some()),
            ("pierson_moskowitz", self.pierson_moskowitz.is_some()),
            ("components", self.components.is_some()),
        ]);
        let [kind] = kinds[..] else {
            let what = match kinds.len() {
                0 => "which wave?".to_string(),
                _ => format!("one kind of wave enters through a face; this one lets in {}", quoted_list(&kinds)),
            };
            return Err(ctx.error_with_help(key, &what, "write  wave = { regular = { height = 0.05, period = 1.3 } }"));
        };
        wave::require_gravity(ctx)?;
        ctx.require_positive(&format!("{key}.ramp"), self.ramp)?;
        let key = &format!("{key}.{kind}");
        let mut numbers = Vec::new();
        if let Some(RegularWaveConfig { height, period, .. }) = self.regular {
            numbers.extend([("height", Some(height)), ("period", Some(period))]);
        }
        if let Some((_, sea, _)) = self.sea(ctx.gravity_norm()) {
            numbers.extend([("height", Some(sea.height)), ("peak_period", sea.peak_period), ("gamma", sea.gamma)]);
            sea.verify(ctx, key)?;
        }
        numbers.into_iter().try_for_each(|(word, x)| ctx.require_positive(&format!("{key}.{word}"), x))?;
        match self.regular.as_ref().and_then(|regular| regular.order).filter(|order| *order != 1) {
            Some(order) => {
                let what = format!("waves enter through a face by theory of order 1, not {order}");
                Err(ctx.error_with_help(&format!("{key}.order"), what, "leave order out"))
            }
            None => Ok(()),
        }
    }

    /// Fills in the defaults, and returns the period of the wave or of the peak (s), unless a file gives it.
    fn fill(&mut self, ctx: &Context, defaults: &mut Defaults, key: &str) -> Option<f64> {
        if let Some(regular) = &mut self.regular {
            defaults.fill(format!("{key}.regular.order"), &mut regular.order, 1, "waves enter by linear theory");
            defaults.fill(format!("{key}.regular.phase_deg"), &mut regular.phase_deg, 0.0, "a crest at the start");
        }
        if let Some(sea) = &mut self.jonswap {
            defaults.fill(format!("{key}.jonswap.gamma"), &mut sea.gamma, JONSWAP_GAMMA, "JONSWAP's mean");
        }
        let seas = [
            ("jonswap", &mut self.jonswap),
            ("bretschneider", &mut self.bretschneider),
            ("pierson_moskowitz", &mut self.pierson_moskowitz),
        ];
        for (word, sea) in seas.into_iter().filter_map(|(word, sea)| Some((word, sea.as_mut()?))) {
            defaults.fill(format!("{key}.{word}.seed"), &mut sea.seed, 1, "one of the seas of this spectrum");
            let why = "each is summed for each particle of the buffer";
            defaults.fill(format!("{key}.{word}.components"), &mut sea.components, FACE_COMPONENTS, why);
        }
        let g = if ctx.gravity.is_some() { ctx.gravity_norm() } else { EARTH };
        let regular = self.regular.as_ref().map(|regular| regular.period);
        let period = regular.or_else(|| Some(self.sea(g)?.2.peak_period))?;
        defaults.fill(format!("{key}.ramp"), &mut self.ramp, 2.0 * period, "two periods");
        Some(period)
    }

    /// The waves in this water.
    fn build(&self, ctx: &Context, key: &str, water: &WaterAtFace) -> Result<IncidentWaves> {
        if let Some(config) = &self.components {
            let key = &format!("{key}.components");
            let components = read_components(ctx, key, config);
            let components = components.map_err(|e| ctx.with_location(e, &format!("{key}.file")))?;
            return IncidentWaves::components(&components, water).map_err(|e| ctx.with_location(e, key));
        }
        let waves = if let Some((_, config, spectrum)) = self.sea(water.g) {
            let phases = (config.seed.unwrap_or(1), config.components.unwrap_or(FACE_COMPONENTS));
            IncidentWaves::irregular(config.height, &spectrum, phases, water)
        } else {
            let RegularWaveConfig { height, period, phase_deg, .. } = self.regular.clone().unwrap_or_default();
            // At the face the surface is H/2 cos(ω t + phase), as at a paddle.
            let phase = 0.0 - phase_deg.unwrap_or(0.0).to_radians();
            let WaterAtFace { depth, current, g, ramp, .. } = *water;
            IncidentWaves::regular(height, period, phase, depth, current, g, ramp.unwrap_or_default())
        };
        waves.map_err(|e| ctx.with_location(e, key))
    }
}

/// The name of face number `i` of its section, if the scene gives none.
fn default_name(section: &str, i: usize) -> String {
    if i == 0 { section.into() } else { format!("{section}_{}", i + 1) }
}

/// The names of all faces.
pub(crate) fn names(inflow: &[OpenBoundaryConfig], outflow: &[OpenBoundaryConfig]) -> Vec<String> {
    let each = |faces: &[OpenBoundaryConfig], flow: FaceFlow| {
        let name = |(i, face): (usize, &OpenBoundaryConfig)| {
            face.name.clone().unwrap_or_else(|| default_name(flow.section(), i))
        };
        faces.iter().enumerate().map(name).collect::<Vec<_>>()
    };
    let mut names = each(inflow, FaceFlow::In);
    names.extend(each(outflow, FaceFlow::Out));
    names
}

/// Refuses faces of the same name.
pub(crate) fn verify_names(ctx: &Context, inflow: &[OpenBoundaryConfig], outflow: &[OpenBoundaryConfig]) -> Result<()> {
    let names = names(inflow, outflow);
    match (0..names.len()).find(|&i| names[..i].contains(&names[i])) {
        Some(i) => {
            let key = match i.checked_sub(inflow.len()) {
                Some(i) => format!("outflow.{i}"),
                None => format!("inflow.{i}"),
            };
            let what = format!("two faces have the name \"{}\"", names[i]);
            Err(ctx.error_with_help(&key, what, "give each its own:  name = \"...\""))
        }
        None => Ok(()),
    }
}
