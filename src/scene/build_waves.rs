//! From the words of a wave to the motion of its paddle.

use std::f64::consts::TAU;

use super::{
    AbsorbChoice, DrivenConfig, MeasuredElevationConfig, Scene, WaveComponentsConfig, WaveConfig,
    build::{StillWaterLevel, WaterBody},
    geometry::{vector, world_bounds},
    table,
    waves::IrregularWaveConfig,
};
use crate::{
    error::{Error, Result},
    geometry::Shape,
    math::{Bivector, Bounds, Pose, Vector, time_series::TimeSeries},
    solid::{PrescribedMotion, TimeFunction},
    wavemaker::{Paddle, PaddleMotion, WaveComponent, WaveSpectrum, Wavemaker},
};

/// The water at rest: what drafts and waves are measured in.
pub(super) struct StillWater<const D: usize> {
    pub(super) level: StillWaterLevel,
    pub(super) bounds: Bounds<D>,
}

impl<const D: usize> StillWater<D> {
    /// Of all bodies of water; there is one at least.
    pub(super) fn of(water: &[WaterBody<D>]) -> Self {
        let mut bounds: Bounds<D> =
            Bounds { min: Vector::repeat(f64::INFINITY), max: Vector::repeat(f64::NEG_INFINITY) };
        for body in water {
            let own = world_bounds(&body.region.shape, &body.region.pose);
            bounds = Bounds { min: bounds.min.inf(&own.min), max: bounds.max.sup(&own.max) };
        }
        Self { level: StillWaterLevel::of(water), bounds }
    }
}

/// Where a paddle is that absorbs.
pub(super) struct AbsorberSite<const D: usize> {
    /// A point (m) of its face at rest, in the middle of its width.
    pub(super) face: Vector<D>,
    /// Where its waves go; a unit vector.
    pub(super) direction: Vector<D>,
    /// Height of the still water, m.
    pub(super) level: f64,
}

impl<const D: usize> AbsorberSite<D> {
    /// Of a paddle in the box `own`, whose waves go along `way`.
    fn of(own: &Bounds<D>, way: Vector<D>, level: f64) -> Self {
        let middle = 0.5 * (own.min + own.max);
        Self { face: middle + way * (support(own, &way) - middle.dot(&way)), direction: way, level }
    }
}

/// The largest x·`way` in a box.
fn support<const D: usize>(bounds: &Bounds<D>, way: &Vector<D>) -> f64 {
    (0..D).map(|i| (way[i] * bounds.min[i]).max(way[i] * bounds.max[i])).sum()
}

impl Scene {
    /// The motion of the paddle of this shape and pose that makes a wave.
    pub(super) fn paddle_motion<const D: usize>(
        &self,
        key: &str,
        words: &DrivenConfig,
        (shape, pose): (&Shape<D>, &Pose<D>),
        pool: &StillWater<D>,
    ) -> Result<Option<PrescribedMotion<D>>> {
        let Some(wave) = &words.wave else { return Ok(None) };
        let own = world_bounds(shape, pose);
        let depth = wave.depth.unwrap_or(pool.level.depth);
        let g = self.gravity.as_ref().and_then(|g| g.last()).map_or(0.0, |g| -g);
        let maker = Wavemaker { depth, g, paddle: Paddle::Piston };
        match &words.along {
            Some(along) => self.piston_motion(key, wave, vector::<D>(along).normalize(), &maker, (&own, pool)),
            None => self.flap_motion(key, words, wave, &maker, (&own, pool)),
        }
        .map(Some)
    }

    /// The motion of a piston that goes `along`; `own` is the box around it.
    fn piston_motion<const D: usize>(
        &self,
        key: &str,
        wave: &WaveConfig,
        along: Vector<D>,
        maker: &Wavemaker,
        (own, pool): (&Bounds<D>, &StillWater<D>),
    ) -> Result<PrescribedMotion<D>> {
        let refuse = |what: &str, help: &str| Err(self.error_with_help(&format!("{key}.along"), what, help));
        if along[D - 1].abs() > 1e-6 {
            return refuse("a piston that makes waves slides level", "write  along = [1.0, 0.0]");
        }
        let ahead = support(&pool.bounds, &along) - support(own, &along);
        if ahead <= self.dp {
            let help =
                "along is the direction in which the waves go: turn it round, or put the paddle behind the water";
            return refuse("there is no water before the paddle in this direction", help);
        }
        let key = format!("{key}.wave");
        let law = self.wave_from_config(&key, wave, maker)?;
        if law.stroke() > 0.5 * ahead {
            let what =
                format!("the piston would go {:.3} m to and fro, and the water is {ahead:.3} m long", law.stroke());
            let help = "waves so long need a longer tank: take a shorter period or a lower height";
            return Err(self.error_with_help(&key, what, help));
        }
        let site = AbsorberSite::of(own, along, pool.level.level);
        self.with_absorption_if_asked(
            &key,
            wave,
            maker,
            &site,
            PrescribedMotion::slide(along, TimeFunction::Wave(Box::new(law))),
        )
    }

    /// The motion of a flap; `own` is the box around it.
    fn flap_motion<const D: usize>(
        &self,
        key: &str,
        words: &DrivenConfig,
        wave: &WaveConfig,
        maker: &Wavemaker,
        (own, pool): (&Bounds<D>, &StillWater<D>),
    ) -> Result<PrescribedMotion<D>> {
        let hinge: Vector<D> = vector(words.hinge.as_deref().unwrap_or(&[]));
        let arm = pool.level.level - hinge[D - 1];
        if arm <= 0.0 {
            let what = format!("the hinge is {:.3} m above the still level: such a flap makes no wave by theory", -arm);
            let help = format!("a flap is hinged below {:.3} m: at the bed, above or under it", pool.level.level);
            return Err(self.error_with_help(&format!("{key}.hinge"), what, help));
        }
        let unit = |x: &Vec<f64>| vector::<D>(x).normalize().iter().copied().collect();
        let axis: Vec<f64> = words.axis.as_ref().map_or_else(|| vec![1.0], unit);
        if axis.get(2).is_some_and(|x| x.abs() > 1e-6) {
            let help = "write  axis = [0.0, 1.0, 0.0]";
            return Err(self.error_with_help(
                &format!("{key}.axis"),
                "the axis of a flap that makes waves is level",
                help,
            ));
        }
        let mut up = Vector::zeros();
        up[D - 1] = 1.0;
        let way = Bivector::<D>::from_axial(&axis).velocity_at(&up);
        let middle = 0.5 * (pool.bounds.min + pool.bounds.max) - 0.5 * (own.min + own.max);
        let sense = if way.dot(&middle) < 0.0 { -1.0 } else { 1.0 };
        let axis: Vec<f64> = axis.iter().map(|x| sense * x).collect();
        let (key, maker) = (format!("{key}.wave"), Wavemaker { paddle: Paddle::Flap { arm }, ..*maker });
        let law = self.wave_from_config(&key, wave, &maker)?;
        let site = AbsorberSite::of(own, way.normalize() * sense, pool.level.level);
        self.with_absorption_if_asked(
            &key,
            wave,
            &maker,
            &site,
            PrescribedMotion::hinge(hinge, &axis, TimeFunction::Wave(Box::new(law))),
        )
    }

    /// The `motion` of a paddle, which absorbs if its words say so.
    fn with_absorption_if_asked<const D: usize>(
        &self,
        key: &str,
        words: &WaveConfig,
        maker: &Wavemaker,
        site: &AbsorberSite<D>,
        motion: PrescribedMotion<D>,
    ) -> Result<PrescribedMotion<D>> {
        match words.absorb.and_then(AbsorbChoice::parameters) {
            Some(words) => self.with_absorption(&format!("{key}.absorb"), &words, maker, site, motion),
            None => Ok(motion),
        }
    }

    /// The wave that a paddle is to make.
    fn wave_from_config(&self, key: &str, words: &WaveConfig, maker: &Wavemaker) -> Result<PaddleMotion> {
        let place = |word: &str| {
            let key = format!("{key}.{word}");
            move |e: Error| self.origin.with_location(e, &key)
        };
        let gamma = |gamma: Option<f64>| gamma.unwrap_or(3.3);
        let wave = match words {
            WaveConfig { regular: Some(words), .. } => {
                let (order, phase) = (words.order.unwrap_or(2), words.phase_deg.unwrap_or(0.0).to_radians());
                maker.regular(words.height, words.period, phase, order).map_err(place("regular.height"))?
            }
            WaveConfig { jonswap: Some(sea), .. } => {
                let spectrum = WaveSpectrum::jonswap(sea.peak_period.unwrap_or_default(), gamma(sea.gamma));
                irregular_wave(sea, &spectrum, maker).map_err(place("jonswap.height"))?
            }
            WaveConfig { bretschneider: Some(sea), .. } => {
                let spectrum = WaveSpectrum::bretschneider(sea.peak_period.unwrap_or_default());
                irregular_wave(sea, &spectrum, maker).map_err(place("bretschneider.height"))?
            }
            WaveConfig { pierson_moskowitz: Some(sea), .. } => {
                let spectrum = WaveSpectrum::pierson_moskowitz(sea.height, maker.g);
                irregular_wave(sea, &spectrum, maker).map_err(place("pierson_moskowitz.height"))?
            }
            WaveConfig { focused: Some(words), .. } => {
                let spectrum = WaveSpectrum::jonswap(words.peak_period, gamma(words.gamma));
                let count = words.components.unwrap_or_default();
                let made = maker.focused(words.crest, &spectrum, words.distance, words.time, count);
                made.map_err(place("focused.crest"))?
            }
            WaveConfig { solitary: Some(words), .. } => {
                let made = maker.solitary(words.height, words.theory.unwrap_or_default());
                made.map_err(place("solitary.height"))?
            }
            WaveConfig { components: Some(words), .. } => {
                let components = self.read_components(words).map_err(place("components.file"))?;
                maker.components(&components).map_err(place("components"))?
            }
            WaveConfig { elevation: Some(words), .. } => {
                let series = self.read_elevation(words).map_err(place("elevation.column"))?;
                let (distance, delay) = (words.distance.unwrap_or_default(), words.delay.unwrap_or_default());
                maker.measured(&series, distance, delay).map_err(place("elevation"))?
            }
            _ => self.zero_wave(key, words.absorb.and_then(AbsorbChoice::parameters), maker)?,
        };
        Ok(match words.ramp {
            Some(ramp) => wave.with_ramp(ramp),
            None => wave,
        })
    }

    /// The components of a table.
    fn read_components(&self, words: &WaveComponentsConfig) -> Result<Vec<WaveComponent>> {
        let path = table::path_beside(&self.origin.folder, &words.file)?;
        let names = table::read_header(&path)?;
        let either = |one: &'static str, other: &'static str| {
            let given = [(one, true), (other, false)].into_iter().find(|(column, _)| names.iter().any(|n| n == column));
            given.ok_or_else(|| {
                let what = format!("{} has neither a column \"{one}\" nor \"{other}\"", path.display());
                Error::scene(what).help(format!("components need one of the two; its columns: {}", names.join(", ")))
            })
        };
        let (time, is_period) = either("period_s", "frequency_hz")?;
        let (phase, in_degrees) = either("phase_deg", "phase_rad")?;
        let columns = table::read_columns(&path, &["amplitude_m", time, phase])?;
        let component = |i: usize| {
            let (x, phase) = (columns[1][i], columns[2][i]);
            if x <= 0.0 {
                let what = format!("{}: component {} has {time} = {x}", path.display(), i + 1);
                return Err(Error::scene(what).help("periods and frequencies are positive"));
            }
            let omega = if is_period { TAU / x } else { TAU * x };
            let phase = if in_degrees { phase.to_radians() } else { phase };
            Ok(WaveComponent { amplitude: columns[0][i], omega, phase })
        };
        (0..columns[0].len()).map(component).collect()
    }

    /// The elevation of a table.
    fn read_elevation(&self, words: &MeasuredElevationConfig) -> Result<TimeSeries> {
        let path = table::path_beside(&self.origin.folder, &words.file)?;
        let series = table::read_series(&path, words.time.as_deref().unwrap_or("t_s"), &words.column)?;
        let scale = words.scale.unwrap_or(1.0);
        TimeSeries::new(series.times(), series.values().iter().map(|x| x * scale).collect::<Vec<f64>>())
    }
}

fn irregular_wave(words: &IrregularWaveConfig, spectrum: &WaveSpectrum, maker: &Wavemaker) -> Result<PaddleMotion> {
    maker.irregular(words.height, spectrum, words.seed.unwrap_or_default(), words.components.unwrap_or_default())
}
