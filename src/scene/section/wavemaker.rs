//! The paddle of a `wave`: its motion, and its absorption of waves that come back.

use std::f64::consts::TAU;

use super::{
    motion::DrivenConfig,
    shape::vector,
    water::StillWater,
    wave::{
        AbsorbChoice, AbsorptionConfig, IrregularWaveConfig, JONSWAP_GAMMA, MeasuredElevationConfig,
        WaveComponentsConfig, WaveConfig,
    },
};
use crate::{
    error::{Error, Result},
    geometry::{Shape, farthest_along, world_bounds},
    math::{
        Bivector, Bounds, Pose, Vector,
        time_series::{SampleScaling, TimeSeries},
    },
    scene::{
        context::{Context, FileNote},
        files,
        record::{self, Outside, Record},
    },
    solid::{PrescribedMotion, TimeFunction},
    wavemaker::{Absorber, AbsorptionSettings, Paddle, PaddleMotion, WaveComponent, WaveSpectrum, Wavemaker},
};

/// Distance of the absorption gauge from the face of the paddle, in smoothing lengths: the radius of the kernel.
const GAUGE_DISTANCE: f64 = 2.0;

/// The place of an absorbing paddle, and the direction of its waves.
struct AbsorberSite<const D: usize> {
    /// A point (m) of its face at rest, in the middle of its width.
    face: Vector<D>,
    /// Direction of its waves, a unit vector.
    way: Vector<D>,
    /// Height of the still water, m.
    level: f64,
}

impl<const D: usize> AbsorberSite<D> {
    /// The site of a paddle of this shape and pose, whose waves go along `way`, beside the water in the box `water`. Where the paddle
    /// is wider than the water on one side, the middle is that of the part beside the water.
    fn of((shape, pose): (&Shape<D>, &Pose<D>), way: Vector<D>, (water, level): (&Bounds<D>, f64)) -> Self {
        let own = world_bounds(shape, pose);
        let mut middle = 0.5 * (own.min + own.max);
        for i in 0..D - 1 {
            let [least, most] = [own.min[i].max(water.min[i]), own.max[i].min(water.max[i])];
            if least <= most && !(water.min[i]..=water.max[i]).contains(&middle[i]) {
                middle[i] = 0.5 * (least + most);
            }
        }
        Self { face: middle + way * (farthest_along(shape, pose, &way) - middle.dot(&way)), way, level }
    }
}

/// The largest x·`way` in a box.
fn support<const D: usize>(bounds: &Bounds<D>, way: &Vector<D>) -> f64 {
    (0..D).map(|i| (way[i] * bounds.min[i]).max(way[i] * bounds.max[i])).sum()
}

/// The motion of the paddle of this shape and pose that makes `wave`.
pub(super) fn build<const D: usize>(
    ctx: &Context,
    key: &str,
    config: &DrivenConfig,
    wave: &WaveConfig,
    (shape, pose): (&Shape<D>, &Pose<D>),
    pool: &StillWater<D>,
) -> Result<PrescribedMotion<D>> {
    let own = world_bounds(shape, pose);
    let depth = wave.depth.unwrap_or(pool.basin(&own).depth);
    let g = ctx.gravity.as_ref().and_then(|g| g.initial.last()).map_or(0.0, |g| -g);
    let maker = Wavemaker { depth, g, paddle: Paddle::Piston };
    let motion = match &config.along {
        Some(along) => piston_motion(ctx, key, wave, vector::<D>(along).normalize(), &maker, (shape, pose, pool)),
        None => flap_motion(ctx, key, config, wave, &maker, (shape, pose, pool)),
    };
    motion.map_err(|e| record::with_unit_notes(ctx, &format!("{key}.wave.elevation"), e))
}

/// The motion of a piston of this shape and pose in the direction `along`.
fn piston_motion<const D: usize>(
    ctx: &Context,
    key: &str,
    wave: &WaveConfig,
    along: Vector<D>,
    maker: &Wavemaker,
    (shape, pose, pool): (&Shape<D>, &Pose<D>, &StillWater<D>),
) -> Result<PrescribedMotion<D>> {
    let refuse = |what: &str, help: &str| Err(ctx.error_with_help(&format!("{key}.along"), what, help));
    if along[D - 1].abs() > 1e-6 {
        return refuse("a piston that makes waves slides level", "write  along = [1.0, 0.0]");
    }
    let ahead = support(&pool.bounds, &along) - farthest_along(shape, pose, &along);
    if ahead <= ctx.dp {
        let help = "along is the direction in which the waves go: turn it round, or put the paddle behind the water";
        return refuse("there is no water before the paddle in this direction", help);
    }
    let key = format!("{key}.wave");
    let law = wave_from_config(ctx, &key, wave, maker)?;
    if law.stroke() > 0.5 * ahead {
        let what = format!("the piston would go {:.3} m to and fro, and the water is {ahead:.3} m long", law.stroke());
        let help = "waves so long need a longer tank: take a shorter period or a lower height";
        return Err(ctx.error_with_help(&key, what, help));
    }
    let level = pool.basin(&world_bounds(shape, pose)).level;
    let site = AbsorberSite::of((shape, pose), along, (&pool.bounds, level));
    note_distance(ctx, &key, wave, ahead);
    with_absorption(ctx, &key, wave, maker, &site, PrescribedMotion::slide(along, TimeFunction::Wave(Box::new(law))))
}

/// The motion of a flap of this shape and pose.
fn flap_motion<const D: usize>(
    ctx: &Context,
    key: &str,
    config: &DrivenConfig,
    wave: &WaveConfig,
    maker: &Wavemaker,
    (shape, pose, pool): (&Shape<D>, &Pose<D>, &StillWater<D>),
) -> Result<PrescribedMotion<D>> {
    let hinge: Vector<D> = vector(config.hinge.as_deref().unwrap_or(&[]));
    let own = world_bounds(shape, pose);
    let level = pool.basin(&own).level;
    let arm = level - hinge[D - 1];
    if arm <= 0.0 {
        let what = format!("the hinge is {:.3} m above the still level: such a flap makes no wave by theory", -arm);
        let help = format!("a flap is hinged below {level:.3} m: at the bed, above or under it");
        return Err(ctx.error_with_help(&format!("{key}.hinge"), what, help));
    }
    let unit = |x: &Vec<f64>| vector::<D>(x).normalize().iter().copied().collect();
    let axis: Vec<f64> = config.axis.as_ref().map_or_else(|| vec![1.0], unit);
    if axis.get(2).is_some_and(|x| x.abs() > 1e-6) {
        let help = "write  axis = [0.0, 1.0, 0.0]";
        return Err(ctx.error_with_help(&format!("{key}.axis"), "the axis of a flap that makes waves is level", help));
    }
    let mut up = Vector::zeros();
    up[D - 1] = 1.0;
    let way = Bivector::<D>::from_axial(&axis).velocity_at(&up);
    let middle = 0.5 * (pool.bounds.min + pool.bounds.max) - 0.5 * (own.min + own.max);
    let sense = if way.dot(&middle) < 0.0 { -1.0 } else { 1.0 };
    let axis: Vec<f64> = axis.iter().map(|x| sense * x).collect();
    let (key, maker) = (format!("{key}.wave"), Wavemaker { paddle: Paddle::Flap { arm }, ..*maker });
    let law = wave_from_config(ctx, &key, wave, &maker)?;
    let site = AbsorberSite::of((shape, pose), way.normalize() * sense, (&pool.bounds, level));
    note_distance(ctx, &key, wave, support(&pool.bounds, &site.way) - site.face.dot(&site.way));
    with_absorption(
        ctx,
        &key,
        wave,
        &maker,
        &site,
        PrescribedMotion::hinge(hinge, &axis, TimeFunction::Wave(Box::new(law))),
    )
}

/// The `motion` of a paddle, with its absorption if it has one.
fn with_absorption<const D: usize>(
    ctx: &Context,
    key: &str,
    config: &WaveConfig,
    maker: &Wavemaker,
    site: &AbsorberSite<D>,
    motion: PrescribedMotion<D>,
) -> Result<PrescribedMotion<D>> {
    match config.absorb.and_then(AbsorbChoice::settings) {
        Some(config) => absorbing(ctx, &format!("{key}.absorb"), &config, maker, site, motion),
        None => Ok(motion),
    }
}

/// The `motion` of the paddle of `maker` at this `site`, with absorption.
fn absorbing<const D: usize>(
    ctx: &Context,
    key: &str,
    config: &AbsorptionConfig,
    maker: &Wavemaker,
    site: &AbsorberSite<D>,
    motion: PrescribedMotion<D>,
) -> Result<PrescribedMotion<D>> {
    let Some(wave) = motion.wave() else { return Ok(motion) };
    let AbsorptionConfig { period, stroke, speed } = *config;
    let tuning = AbsorptionSettings {
        period,
        gauge_distance: GAUGE_DISTANCE * ctx.h,
        water_level: site.level,
        max_stroke: stroke,
        max_speed: speed,
    };
    let absorber = Absorber::new(maker, wave, &tuning).map_err(|e| ctx.with_location(e, key))?;
    let gauge: Vector<D> = site.face + site.way * absorber.gauge_distance();
    Ok(motion.with_absorber(absorber, gauge, site.way))
}

/// Adds a warning for a record that was measured behind the paddle, or further ahead (m) than the water reaches.
fn note_distance(ctx: &Context, key: &str, wave: &WaveConfig, ahead: f64) {
    let Some(distance) = wave.elevation.as_ref().and_then(|config| config.distance) else { return };
    if (0.0..=ahead).contains(&distance) {
        return;
    }
    let shown = ctx.shown_key(&format!("{key}.elevation.distance"));
    let what = format!("{shown} = {distance}: the water reaches from the paddle to {ahead:.3} m before it");
    let mend = "it is the distance of the gauge from the paddle's face, in the direction of the waves, m".into();
    ctx.add_note(FileNote::warning("gauge_distance", what, mend));
}

/// The motion of a paddle that makes no waves of its own, before its absorption.
fn zero_wave(ctx: &Context, key: &str, config: Option<AbsorptionConfig>, maker: &Wavemaker) -> Result<PaddleMotion> {
    match config.and_then(|config| config.period) {
        Some(period) => maker.at_rest(period).map_err(|e| ctx.with_location(e, key)),
        None => Err(ctx.error_at(key, "which wave?")),
    }
}

/// The wave that a paddle is to make.
fn wave_from_config(ctx: &Context, key: &str, config: &WaveConfig, maker: &Wavemaker) -> Result<PaddleMotion> {
    let place = |word: &str| {
        let key = format!("{key}.{word}");
        move |e: Error| ctx.with_location(e, &key)
    };
    let gamma = |gamma: Option<f64>| gamma.unwrap_or(JONSWAP_GAMMA);
    let wave = match config {
        WaveConfig { regular: Some(config), .. } => {
            let (order, phase) = (config.order.unwrap_or(2), config.phase_deg.unwrap_or(0.0).to_radians());
            maker.regular(config.height, config.period, phase, order).map_err(place("regular.height"))?
        }
        WaveConfig { jonswap: Some(config), .. } => {
            let spectrum = WaveSpectrum::jonswap(config.peak_period.unwrap_or_default(), gamma(config.gamma));
            irregular_wave(config, &spectrum, maker).map_err(place("jonswap.height"))?
        }
        WaveConfig { bretschneider: Some(config), .. } => {
            let spectrum = WaveSpectrum::bretschneider(config.peak_period.unwrap_or_default());
            irregular_wave(config, &spectrum, maker).map_err(place("bretschneider.height"))?
        }
        WaveConfig { pierson_moskowitz: Some(config), .. } => {
            let spectrum = WaveSpectrum::pierson_moskowitz(config.height, maker.g);
            irregular_wave(config, &spectrum, maker).map_err(place("pierson_moskowitz.height"))?
        }
        WaveConfig { focused: Some(config), .. } => {
            let spectrum = WaveSpectrum::jonswap(config.peak_period, gamma(config.gamma));
            if config.time > ctx.until {
                ctx.add_note(FileNote::warning(
                    "focus_after_end",
                    format!(
                        "the crest of {} comes at {} s, and the run ends at {} s",
                        ctx.shown_key(key),
                        config.time,
                        ctx.until
                    ),
                    format!("run to  until = {}, or let it come earlier", config.time),
                ));
            }
            let count = config.components.unwrap_or_default();
            let made = maker.focused(config.crest, &spectrum, config.distance, config.time, count);
            made.map_err(place("focused.crest"))?
        }
        WaveConfig { solitary: Some(config), .. } => {
            let made = maker.solitary(config.height, config.theory.unwrap_or_default());
            made.map_err(place("solitary.height"))?
        }
        WaveConfig { components: Some(config), .. } => {
            let components =
                read_components(ctx, &format!("{key}.components"), config).map_err(place("components.file"))?;
            maker.components(&components).map_err(place("components"))?
        }
        WaveConfig { elevation: Some(config), .. } => {
            let series = read_elevation(ctx, &format!("{key}.elevation"), config)?;
            let (distance, delay) = (config.distance.unwrap_or_default(), config.offset.unwrap_or_default());
            maker.measured(&series, distance, delay).map_err(place("elevation"))?
        }
        _ => zero_wave(ctx, key, config.absorb.and_then(AbsorbChoice::settings), maker)?,
    };
    Ok(match config.ramp {
        Some(ramp) => wave.with_ramp(ramp),
        None => wave,
    })
}

/// The components of a table.
pub(super) fn read_components(ctx: &Context, key: &str, config: &WaveComponentsConfig) -> Result<Vec<WaveComponent>> {
    let mut table = files::open_table(ctx.folder(), &config.file)?;
    let (file, names) = (table.file().to_string(), table.header().to_vec());
    let either = |one: &'static str, other: &'static str| {
        let has = |column: &str| names.iter().any(|n| n == column);
        if has(one) && has(other) {
            let what = format!("{file} has a column \"{one}\" and a column \"{other}\", and both give one number");
            return Err(Error::scene(what).help("keep one of the two"));
        }
        let given = [(one, true), (other, false)].into_iter().find(|(column, _)| has(column));
        given.ok_or_else(|| {
            let what = format!("{file} has neither a column \"{one}\" nor \"{other}\"");
            Error::scene(what).help(format!("components need one of the two; its columns: {}", names.join(", ")))
        })
    };
    let (time, is_period) = either("period_s", "frequency_hz")?;
    let (phase, in_degrees) = either("phase_deg", "phase_rad")?;
    let [amplitudes, times, phases] =
        table.complete_columns(["amplitude_m", time, phase]).map_err(files::with_line_in_message)?;
    record::note_layout(ctx, key, &config.file, &table);
    for column in ["amplitude_m", time, phase] {
        table.unit(column)?;
    }
    let component = |i: usize| {
        let (x, phase) = (times[i], phases[i]);
        if x <= 0.0 {
            let what = format!("{file}: component {} has {time} = {x}", i + 1);
            return Err(Error::scene(what).help("periods and frequencies are positive"));
        }
        let omega = if is_period { TAU / x } else { TAU * x };
        let phase = if in_degrees { phase.to_radians() } else { phase };
        Ok(WaveComponent { amplitude: amplitudes[i], omega, phase })
    };
    (0..times.len()).map(component).collect()
}

/// The elevation of a table, without its offset.
fn read_elevation(ctx: &Context, key: &str, config: &MeasuredElevationConfig) -> Result<TimeSeries> {
    let place = |word: &str, e: Error| ctx.with_location(files::with_line_in_message(e), &format!("{key}.{word}"));
    let table = files::open_table(ctx.folder(), &config.file).map_err(|e| place("file", e))?;
    let scaling = record::scaling(config.given_scaling());
    let (time, column) = (config.time.clone().unwrap_or_else(|| "t_s".into()), config.column.clone());
    let mut record = Record { ctx, key, file: &config.file, table, time, column, scaling, unit: Some("m") };
    let series = record.read()?;
    record.note_span(&series, Outside::Waves);
    record.note_uneven(&series);
    series.scaled(&SampleScaling { offset: 0.0, ..scaling }).map_err(|e| place("scale", e))
}

/// An irregular sea of this spectrum.
fn irregular_wave(config: &IrregularWaveConfig, spectrum: &WaveSpectrum, maker: &Wavemaker) -> Result<PaddleMotion> {
    maker.irregular(config.height, spectrum, config.seed.unwrap_or_default(), config.components.unwrap_or_default())
}
