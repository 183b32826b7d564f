//! `gravity`: a number downwards, or a vector; each component a number, a formula in t or a table.

use crate::{
    error::{ErrorCode, Result},
    scene::{
        context::{Context, Defaults},
        untagged::{CoordinateUnit, TimeValueConfig, TimeVectorConfig},
    },
    solid::TimeFunction,
};

/// Number of times of the run at which the strongest gravity is sought.
const SAMPLES: u32 = 1000;

/// The acceleration of gravity of a scene, m/s².
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct GravityValues {
    /// At the start.
    pub(crate) initial: Vec<f64>,
    /// Largest magnitude during the run.
    pub(crate) strongest: f64,
    /// Whether it changes.
    pub(crate) varies: bool,
}

impl GravityValues {
    /// The values of a constant vector.
    fn constant(initial: Vec<f64>) -> Self {
        let strongest = norm(initial.iter().copied());
        Self { initial, strongest, varies: false }
    }

    /// The values of `config`. A component whose table cannot be read counts as 0; [`build`] refuses it.
    pub(crate) fn of(ctx: &Context, config: &TimeVectorConfig) -> Self {
        let components = components(config, ctx.dimension);
        if let Some(numbers) = components.iter().map(TimeValueConfig::number).collect::<Option<Vec<f64>>>() {
            return Self::constant(numbers);
        }
        let law = |component: &TimeValueConfig| {
            let mut value = component.clone();
            value.0.fill(&mut Defaults::default(), "gravity");
            value.0.read(ctx, "gravity", CoordinateUnit::Si("m/s²")).unwrap_or_else(|_| TimeFunction::constant(0.0))
        };
        let laws: Vec<TimeFunction> = components.iter().map(law).collect();
        let at = |t: f64| laws.iter().map(move |law| law.value_and_rate(t).0);
        let times = (0..=SAMPLES).map(|i| ctx.until * f64::from(i) / f64::from(SAMPLES));
        // A law without bound is refused where it is built.
        let strongest = times.map(|t| norm(at(t))).filter(|g| g.is_finite()).fold(0.0, f64::max);
        Self { initial: at(0.0).collect(), strongest, varies: true }
    }
}

/// Refuses components that do not fit the dimension or cannot be read.
pub(crate) fn verify(ctx: &Context, config: &TimeVectorConfig) -> Result<()> {
    let given = config.components();
    let numbers: Option<Vec<f64>> = given.iter().map(TimeValueConfig::number).collect();
    match (config.is_list(), numbers) {
        (true, Some(numbers)) => return ctx.require_dimension("gravity", &numbers),
        (false, Some(numbers)) => {
            let help = if ctx.dimension == 3 {
                "write  gravity = 9.81  or  gravity = [0.0, 0.0, -9.81]"
            } else {
                "write  gravity = 9.81  or  gravity = [0.0, -9.81]"
            };
            return match numbers.first() {
                Some(g) if !(*g >= 0.0 && g.is_finite()) => {
                    let what = format!("gravity = {g}: a number is its strength downwards, 0 or more");
                    Err(ctx.error_with_help("gravity", what, help).with_code(ErrorCode::OutOfRange))
                }
                _ => Ok(()),
            };
        }
        (true, None) if given.len() != ctx.dimension => {
            let (d, n) = (ctx.dimension, given.len());
            let help = "one component along each axis, as in  gravity = [\"0.5*sin(t)\", -9.81]";
            let what = format!("gravity has {n} components, not {d}");
            return Err(ctx.error_with_help("gravity", what, help).with_code(ErrorCode::WrongType));
        }
        _ => {}
    }
    given.iter().try_for_each(|value| value.verify(ctx, "gravity"))
}

/// The laws of the components (m/s²); empty if gravity is constant.
pub(crate) fn build(ctx: &Context, config: &TimeVectorConfig) -> Result<Vec<TimeFunction>> {
    let components = components(config, ctx.dimension);
    if components.iter().all(|value| value.number().is_some()) {
        return Ok(Vec::new());
    }
    components.iter().map(|value| value.0.build(ctx, "gravity", CoordinateUnit::Si("m/s²"))).collect()
}

/// One value along each axis; a single value points downwards.
fn components(config: &TimeVectorConfig, dimension: usize) -> Vec<TimeValueConfig> {
    if config.is_list() {
        return config.components().to_vec();
    }
    let down = |value: &TimeValueConfig| {
        let mut down = value.clone();
        match value.number() {
            Some(g) => down = TimeValueConfig::from(-g),
            None => {
                down.0.formula = value.0.formula.as_ref().map(|text| format!("-({text})"));
                if down.0.file.is_some() {
                    down.0.scale = Some(-value.0.scale.unwrap_or(1.0));
                }
            }
        }
        down
    };
    let sideways = std::iter::repeat_n(TimeValueConfig::from(0.0), dimension.saturating_sub(1));
    sideways.chain(config.components().iter().map(down)).collect()
}

/// The magnitude of a vector.
pub(crate) fn norm(components: impl Iterator<Item = f64>) -> f64 {
    components.map(|g| g * g).sum::<f64>().sqrt()
}
