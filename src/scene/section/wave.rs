//! `wave`: the waves that a paddle makes, and its absorption of waves that come back.

use std::fmt;

use schemars::JsonSchema;
use serde::{
    Deserialize, Deserializer, Serialize,
    de::{self, MapAccess, Visitor, value::MapAccessDeserializer},
};

use crate::{
    error::{ErrorCode, Result},
    math::table::ColumnName,
    scene::{
        context::{Context, Defaults, quoted_list, set_keys},
        record,
    },
    wavemaker::{COMPONENTS_DEFAULT, COMPONENTS_MAX, SolitaryTheory},
};

/// Peakedness of JONSWAP's spectrum, if the scene gives none.
pub(super) const JONSWAP_GAMMA: f64 = 3.3;

/// A wave by name: exactly one kind; none of a paddle that only absorbs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct WaveConfig {
    /// One height and one period.
    pub regular: Option<RegularWaveConfig>,
    /// A sea of JONSWAP's spectrum.
    pub jonswap: Option<IrregularWaveConfig>,
    /// A sea of Bretschneider's spectrum.
    pub bretschneider: Option<IrregularWaveConfig>,
    /// A fully developed sea: the height determines the period.
    pub pierson_moskowitz: Option<IrregularWaveConfig>,
    /// A focused group.
    pub focused: Option<FocusedWaveConfig>,
    /// A solitary wave.
    pub solitary: Option<SolitaryWaveConfig>,
    /// A sum of components from a table.
    pub components: Option<WaveComponentsConfig>,
    /// A measured elevation.
    pub elevation: Option<MeasuredElevationConfig>,
    /// Duration of the ramp to the full motion of the paddle, s.
    pub ramp: Option<f64>,
    /// Depth of the still water at the paddle, m.
    pub depth: Option<f64>,
    /// Whether the paddle absorbs waves that come back to it.
    pub absorb: Option<AbsorbChoice>,
}

/// A regular wave.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct RegularWaveConfig {
    /// From trough to crest, m.
    pub height: f64,
    /// s.
    pub period: f64,
    /// Order of the theory: 1 or 2 of a paddle, 1 of a face.
    pub order: Option<usize>,
    /// Phase of the surface at the paddle or face, degrees.
    pub phase_deg: Option<f64>,
}

/// An irregular sea.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct IrregularWaveConfig {
    /// Significant height, 4 √m₀, m.
    pub height: f64,
    /// Period at the spectrum's peak, s.
    pub peak_period: Option<f64>,
    /// JONSWAP's peakedness, –.
    pub gamma: Option<f64>,
    /// Seed of the random phases.
    pub seed: Option<u64>,
    /// Number of components.
    pub components: Option<usize>,
}

/// A focused group.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct FocusedWaveConfig {
    /// Height of its crest over the still level, m.
    pub crest: f64,
    /// Period at the spectrum's peak, s.
    pub peak_period: f64,
    /// Distance of the crest from the paddle's face at rest, m.
    pub distance: f64,
    /// Time of the crest, s.
    pub time: f64,
    /// JONSWAP's peakedness, –.
    pub gamma: Option<f64>,
    /// Number of components.
    pub components: Option<usize>,
}

/// A solitary wave.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct SolitaryWaveConfig {
    /// Of its crest over the still level, m.
    pub height: f64,
    /// Theory of the paddle.
    pub theory: Option<SolitaryTheory>,
}

/// A table of components.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct WaveComponentsConfig {
    /// The table, beside the scene: `amplitude_m`; `period_s` or `frequency_hz`; `phase_rad` or `phase_deg`.
    pub file: String,
}

/// A measured elevation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct MeasuredElevationConfig {
    /// The table, beside the scene.
    pub file: String,
    /// Its column of elevations, m.
    pub column: ColumnName,
    /// Its column of times, s.
    pub time: Option<ColumnName>,
    /// Factor on the elevations, –.
    pub scale: Option<f64>,
    /// Factor on its times, –.
    pub time_factor: Option<f64>,
    /// Where it was measured: distance from the paddle's face at rest, m.
    pub distance: Option<f64>,
    /// Time added to its times, s.
    #[serde(alias = "delay")]
    #[schemars(extend("also" = "delay"))]
    pub offset: Option<f64>,
}

/// Whether a paddle absorbs: `true`, or how.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
#[non_exhaustive]
pub enum AbsorbChoice {
    /// With the default parameters, or not at all.
    Switch(bool),
    /// With these parameters.
    Parameters(AbsorptionConfig),
}

/// How a paddle absorbs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct AbsorptionConfig {
    /// Period of the waves that it absorbs completely, s.
    pub period: Option<f64>,
    /// Largest stroke from end to end, m.
    pub stroke: Option<f64>,
    /// Largest speed, m/s.
    pub speed: Option<f64>,
}

impl AbsorbChoice {
    /// The settings of the absorption; `None` if the paddle does not absorb.
    pub(crate) fn settings(self) -> Option<AbsorptionConfig> {
        match self {
            Self::Switch(absorbs) => absorbs.then(AbsorptionConfig::default),
            Self::Parameters(config) => Some(config),
        }
    }
}

impl<'de> Deserialize<'de> for AbsorbChoice {
    fn deserialize<De: Deserializer<'de>>(deserializer: De) -> std::result::Result<Self, De::Error> {
        struct Form;
        impl<'de> Visitor<'de> for Form {
            type Value = AbsorbChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "true, or a table with `period`, `stroke`, `speed`")
            }
            fn visit_bool<E: de::Error>(self, absorbs: bool) -> std::result::Result<AbsorbChoice, E> {
                Ok(AbsorbChoice::Switch(absorbs))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<AbsorbChoice, A::Error> {
                AbsorptionConfig::deserialize(MapAccessDeserializer::new(map)).map(AbsorbChoice::Parameters)
            }
        }
        deserializer.deserialize_any(Form)
    }
}

impl WaveConfig {
    /// A regular wave of `height` (m) and `period` (s).
    pub fn regular(height: f64, period: f64) -> Self {
        Self { regular: Some(RegularWaveConfig { height, period, ..Default::default() }), ..Self::default() }
    }

    /// The sea number `seed` of significant height `height` (m) and JONSWAP's spectrum.
    pub fn jonswap(height: f64, peak_period: f64, seed: u64) -> Self {
        let sea =
            IrregularWaveConfig { height, peak_period: Some(peak_period), seed: Some(seed), ..Default::default() };
        Self { jonswap: Some(sea), ..Self::default() }
    }

    /// The focused group with its crest of `crest` (m) at `distance` (m) from the paddle at `time` (s).
    pub fn focused(crest: f64, peak_period: f64, distance: f64, time: f64) -> Self {
        let group = FocusedWaveConfig { crest, peak_period, distance, time, ..Default::default() };
        Self { focused: Some(group), ..Self::default() }
    }

    /// The solitary wave of `height` (m).
    pub fn solitary(height: f64) -> Self {
        Self { solitary: Some(SolitaryWaveConfig { height, theory: None }), ..Self::default() }
    }

    /// No wave: a paddle that absorbs waves of `period` (s).
    pub fn absorber(period: f64) -> Self {
        let config = AbsorptionConfig { period: Some(period), ..AbsorptionConfig::default() };
        Self { absorb: Some(AbsorbChoice::Parameters(config)), ..Self::default() }
    }

    /// Returns the same wave of a paddle that absorbs waves which come back.
    pub fn absorbing(self) -> Self {
        Self { absorb: Some(AbsorbChoice::Switch(true)), ..self }
    }

    /// The keys that give its kind.
    fn named_kinds(&self) -> Vec<&'static str> {
        set_keys([
            ("regular", self.regular.is_some()),
            ("jonswap", self.jonswap.is_some()),
            ("bretschneider", self.bretschneider.is_some()),
            ("pierson_moskowitz", self.pierson_moskowitz.is_some()),
            ("focused", self.focused.is_some()),
            ("solitary", self.solitary.is_some()),
            ("components", self.components.is_some()),
            ("elevation", self.elevation.is_some()),
        ])
    }

    /// Fills in the defaults.
    pub(crate) fn fill(&mut self, defaults: &mut Defaults, key: &str) {
        let peaked = "JONSWAP's mean";
        let many = "the spectrum's form, and a sea that does not repeat";
        if let Some(config) = &mut self.regular {
            let why = "without the free wave of twice the frequency that a plain paddle makes";
            defaults.fill(format!("{key}.regular.order"), &mut config.order, 2, why);
            defaults.fill(
                format!("{key}.regular.phase_deg"),
                &mut config.phase_deg,
                0.0,
                "the paddle sets out forwards",
            );
        }
        for (word, sea) in self.spectra_mut() {
            let Some(sea) = sea else { continue };
            if word == "jonswap" {
                defaults.fill(format!("{key}.{word}.gamma"), &mut sea.gamma, JONSWAP_GAMMA, peaked);
            }
            defaults.fill(format!("{key}.{word}.seed"), &mut sea.seed, 1, "one of the seas of this spectrum");
            defaults.fill(format!("{key}.{word}.components"), &mut sea.components, COMPONENTS_DEFAULT, many);
        }
        if let Some(config) = &mut self.focused {
            defaults.fill(format!("{key}.focused.gamma"), &mut config.gamma, JONSWAP_GAMMA, peaked);
            defaults.fill(format!("{key}.focused.components"), &mut config.components, COMPONENTS_DEFAULT, many);
        }
        if let Some(config) = &mut self.solitary {
            let why = "its wave keeps its height better than Boussinesq's";
            defaults.fill(format!("{key}.solitary.theory"), &mut config.theory, SolitaryTheory::Rayleigh, why);
        }
        if let Some(config) = &mut self.elevation {
            let key = format!("{key}.elevation");
            defaults.fill(format!("{key}.time"), &mut config.time, "t_s".into(), "the name our own tables have");
            defaults.fill(format!("{key}.scale"), &mut config.scale, 1.0, "as in the table");
            defaults.fill(format!("{key}.distance"), &mut config.distance, 0.0, "measured at the paddle");
            defaults.fill(format!("{key}.time_factor"), &mut config.time_factor, 1.0, "as in the table");
            defaults.fill(format!("{key}.offset"), &mut config.offset, 0.0, "the clocks agree");
        }
    }

    fn spectra_mut(&mut self) -> [(&'static str, &mut Option<IrregularWaveConfig>); 3] {
        [
            ("jonswap", &mut self.jonswap),
            ("bretschneider", &mut self.bretschneider),
            ("pierson_moskowitz", &mut self.pierson_moskowitz),
        ]
    }

    /// Refuses a wave that is not of exactly one kind, or whose numbers are out of range.
    pub(crate) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let kinds = self.named_kinds();
        let absorb = self.absorb.and_then(AbsorbChoice::settings);
        if let Some(config) = &absorb {
            config.verify(ctx, &format!("{key}.absorb"), !kinds.is_empty())?;
        }
        if kinds.len() > 1 || (kinds.is_empty() && absorb.is_none()) {
            let what = match kinds.len() {
                0 => "which wave?".to_string(),
                _ => format!("a paddle makes one kind of wave; this one {}", quoted_list(&kinds)),
            };
            return Err(ctx.error_at(key, what));
        }
        require_gravity(ctx)?;
        ctx.require_positive(&format!("{key}.ramp"), self.ramp)?;
        ctx.require_positive(&format!("{key}.depth"), self.depth)?;
        let Some(kind) = kinds.first() else { return Ok(()) };
        let key = &format!("{key}.{kind}");
        let mut numbers = Vec::new();
        if let Some(config) = &self.regular {
            numbers.extend([("height", Some(config.height)), ("period", Some(config.period))]);
            if let Some(order) = config.order.filter(|order| !(1..=2).contains(order)) {
                let help = "order = 1, or  order = 2  without free waves of twice the frequency";
                return Err(ctx.error_with_help(
                    &format!("{key}.order"),
                    format!("order is 1 or 2, not {order}"),
                    help,
                ));
            }
        }
        for sea in [&self.jonswap, &self.bretschneider, &self.pierson_moskowitz].into_iter().flatten() {
            numbers.extend([("height", Some(sea.height)), ("peak_period", sea.peak_period), ("gamma", sea.gamma)]);
            sea.verify(ctx, key)?;
        }
        if let Some(config) = &self.focused {
            numbers.extend([("crest", Some(config.crest)), ("peak_period", Some(config.peak_period))]);
            numbers.extend([("distance", Some(config.distance)), ("time", Some(config.time)), ("gamma", config.gamma)]);
            verify_count(ctx, &format!("{key}.components"), config.components)?;
        }
        if let Some(config) = &self.elevation {
            record::verify_scaling(ctx, key, config.given_scaling())?;
            if let Some(x) = config.distance.filter(|x| !x.is_finite()) {
                return Err(
                    ctx.error_at(&format!("{key}.distance"), format!("distance is a number of metres, not {x}"))
                );
            }
        }
        numbers.extend(self.solitary.iter().map(|config| ("height", Some(config.height))));
        numbers.into_iter().try_for_each(|(word, x)| ctx.require_positive(&format!("{key}.{word}"), x))
    }
}

/// Refuses waves unless gravity is constant and straight down.
pub(super) fn require_gravity(ctx: &Context) -> Result<()> {
    let down = ctx.gravity.as_ref().is_none_or(|g| {
        let (up, rest) = g.initial.split_last().map_or((0.0, &[][..]), |(up, rest)| (*up, rest));
        up < 0.0 && rest.iter().all(|x| *x == 0.0) && !g.varies
    });
    if down {
        return Ok(());
    }
    let what = "waves need a constant gravity straight down";
    Err(ctx.error_with_help("gravity", what, "write  gravity = [0.0, -9.81]"))
}

impl MeasuredElevationConfig {
    /// The scaling of the table as far as it is given.
    pub(crate) fn given_scaling(&self) -> [Option<f64>; 3] {
        [self.scale, self.time_factor, self.offset]
    }
}

impl IrregularWaveConfig {
    /// Refuses keys that do not belong to the spectrum.
    pub(super) fn verify(&self, ctx: &Context, key: &str) -> Result<()> {
        let grown = key.ends_with("pierson_moskowitz");
        let place = |word: &str| format!("{key}.{word}");
        if grown && self.peak_period.is_some() {
            let what = "the height of a fully grown sea says its period: 5 s √(height in m)";
            let help = "leave it out, or write  bretschneider = { height = 0.1, peak_period = 1.4 }";
            return Err(ctx.error_with_help(&place("peak_period"), what, help));
        }
        if !grown && self.peak_period.is_none() {
            return Err(ctx.error_at(&place("peak_period"), "peak_period is missing").with_code(ErrorCode::MissingKey));
        }
        if self.gamma.is_some() && !key.ends_with("jonswap") {
            return Err(ctx.error_with_help(&place("gamma"), "gamma belongs to jonswap", "leave it out"));
        }
        verify_count(ctx, &place("components"), self.components)
    }
}

/// Refuses a sum of no or too many components.
fn verify_count(ctx: &Context, key: &str, count: Option<usize>) -> Result<()> {
    match count.filter(|count| !(1..=COMPONENTS_MAX).contains(count)) {
        Some(count) => {
            let what = format!("a wave has 1 to {COMPONENTS_MAX} components, not {count}");
            let help = "components = 100, or leave it out for its default";
            Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::OutOfRange))
        }
        None => Ok(()),
    }
}

impl AbsorptionConfig {
    /// Refuses numbers that are not positive, and a paddle without a wave and without a period.
    fn verify(&self, ctx: &Context, key: &str, makes_waves: bool) -> Result<()> {
        let all = [("period", self.period), ("stroke", self.stroke), ("speed", self.speed)];
        all.into_iter().try_for_each(|(word, x)| ctx.require_positive(&format!("{key}.{word}"), x))?;
        match makes_waves || self.period.is_some() {
            true => Ok(()),
            false => {
                let what = "a paddle that makes no wave of its own absorbs those of a period, and none is said";
                Err(ctx.error_with_help(key, what, "write  wave = { absorb = { period = 1.2 } }"))
            }
        }
    }
}
