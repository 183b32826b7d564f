//! Waves that driven solids make, checked against dp, the paddle and the tank. Named waves have their specified
//! properties. The waves of any other motion follow from its largest stroke by linear wavemaker theory.

use serde::Serialize;

use super::{
    Finding, PreflightContext,
    expected_errors::{WaveAtGauge, heights_at_gauges},
    wavemaker_site::{WavemakerSite, is_wall},
};
use crate::{
    geometry::world_bounds,
    math::format::{three_digits, two_digits_down, two_digits_up},
    scene::StillWaterLevel,
    solid::{PrescribedMotion, Role, Solid},
    wavemaker::{DepthRegime, LinearWave, Paddle, TheoryRegion},
};

/// Wave height over dp below which waves lose much of their height as they propagate.
pub(super) const LEAST: f64 = 5.0;

/// Wave length over dp below which a wave is not resolved: a crest then spans less than two kernel supports.
const SHORTEST: f64 = 15.0;

/// The wave that a driven solid makes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GeneratedWave {
    /// Name of the solid.
    pub solid: String,
    /// Kind of the wave, as a scene writes it; absent if the scene gives the motion of the solid instead.
    pub kind: Option<&'static str>,
    /// Order of the wavemaker theory.
    pub order: usize,
    /// The largest stroke between two turning points, at the still water level, m.
    pub stroke_m: f64,
    /// Period, s: the peak period of a sea; twice the duration of the largest stroke of a motion; absent for a solitary
    /// wave.
    pub period_s: Option<f64>,
    /// Height, m: as specified, the significant height for a sea; otherwise by linear theory from the stroke.
    pub height_m: f64,
    /// The same height over dp.
    pub height_dp: f64,
    /// Length, m; for a solitary wave the distance between the points at a hundredth of its height.
    pub length_m: f64,
    /// The same length over dp.
    pub length_dp: f64,
    /// Depth at the paddle, m.
    pub depth_m: f64,
    /// Relative depth kd; absent for a solitary wave.
    pub kd: Option<f64>,
    /// Depth regime of the wave; a solitary wave is in shallow water.
    pub regime: DepthRegime,
    /// The valid wave theory, according to the chart of Le Méhauté.
    pub region: TheoryRegion,
    /// Speed of the crests, m/s.
    pub celerity_mps: f64,
    /// Group velocity, the speed of the wave's front and energy, m/s.
    pub group_mps: f64,
    /// The largest speed of the paddle at the still water level, m/s.
    pub paddle_mps: f64,
    /// Duration of the ramp to the full motion, s; 0 if the scene gives the motion.
    pub ramp_s: f64,
    /// Distance from the paddle to the first reflector, m.
    pub reach_m: f64,
    /// Name of the reflecting solid; absent if the end of the water reflects.
    pub answers: Option<String>,
    /// Distance from the paddle to the start of a damping zone before the reflector, m.
    pub damping_m: Option<f64>,
    /// Heights to be expected at gauges; absent unless the waves are regular and by name, with the laws that were measured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gauges: Vec<WaveAtGauge>,
    /// Time at which the wave front reaches the reflector, s.
    pub far_s: f64,
    /// Time at which the reflected front reaches the paddle, s.
    pub back_s: f64,
}

/// Adds findings about waves that dp does not resolve, from their height and their length, each in m and over dp. `name` is their
/// source, and the verb `does` its action. `period` returns the period (s) of waves of a length (m) for the remedy, or `None` if
/// the current stops them.
pub(super) fn check_resolution(
    (name, does): (&str, &str),
    height: (f64, f64),
    length: (f64, f64),
    period: &dyn Fn(f64) -> Option<f64>,
    findings: &mut Vec<Finding>,
) {
    let mut check = |topic, [about, sense, loss]: [&str; 3], (size, size_dp): (f64, f64), least: f64| {
        if size_dp < least {
            let size_m = three_digits(size);
            let waves = format!("\"{name}\" {does} waves {about}{size_m} m {sense}, {} dp", three_digits(size_dp));
            let what = format!("{waves}; with less than {least} dp they {loss}");
            let period = (least == SHORTEST).then(|| period(least * size / size_dp)).flatten();
            let other = period.map_or(String::new(), |period| format!(", or waves of {} s", two_digits_up(period)));
            findings.push(Finding::warning(topic, what, format!("dp = {}{other}", two_digits_down(size / least))));
        }
    };
    check("low_waves", ["about ", "high", "lose height"], height, LEAST);
    check("short_waves", ["", "long", "die away"], length, SHORTEST);
}

impl<const D: usize> PreflightContext<'_, D> {
    /// Returns the waves of the driven solids that oscillate through the water surface, and adds findings about them.
    pub(super) fn generated_waves(&self, findings: &mut Vec<Finding>) -> Vec<GeneratedWave> {
        let mut waves = Vec::new();
        let depth = self.still_water.depth;
        if self.g > 0.0 && depth < 10.0 * self.dp() * (1.0 - 1e-9) {
            let what = format!(
                "the water is {} m deep, {} dp: too few for waves and floats, which take 10",
                three_digits(depth),
                three_digits(depth / self.dp())
            );
            findings.push(Finding::warning("shallow", what, format!("dp = {}", two_digits_down(0.1 * depth))));
        }
        for solid in self.solids() {
            let Role::Driven(motion) = &solid.spec.role else { continue };
            if let Some(law) = motion.wave() {
                self.check_site(solid, motion, law, findings);
            }
            let Some((wave, stand)) = self.generated_wave(solid, motion) else { continue };
            let (height, length) = ((wave.height_m, wave.height_dp), (wave.length_m, wave.length_dp));
            check_resolution((&wave.solid, "makes"), height, length, &|_| None, findings);
            self.misplaced_zones(&wave, &stand, findings);
            if let Some(law) = motion.wave() {
                self.check_wave(&wave, solid, law, findings);
                self.check_speed(&wave, law, findings);
                self.check_focus(&wave, &stand, law, findings);
            }
            waves.push(wave);
        }
        self.dry_zones(findings);
        self.check_statistic_periods(&waves, findings);
        self.check_reading_intervals(&waves, findings);
        waves
    }

    fn generated_wave(
        &self,
        solid: &Solid<D>,
        motion: &PrescribedMotion<D>,
    ) -> Option<(GeneratedWave, WavemakerSite<D>)> {
        let bounds = world_bounds(&solid.spec.shape, &solid.kinematics.pose);
        let StillWaterLevel { level, depth } = self.basin(&bounds);
        // A moving tank contains the water and is not a paddle.
        if is_wall(&solid.spec.shape) || self.g == 0.0 || bounds.min[D - 1] >= level || bounds.max[D - 1] <= level {
            return None;
        }
        let swing = self.driven_stroke(solid, motion, &bounds)?;
        let named = motion.wave();
        let [stand, behind] = [swing.direction, -swing.direction].map(|way| WavemakerSite::new(solid, way, level));
        // A motion that the scene gives makes waves to both sides; the waves with the longer path are evaluated.
        let stand = if named.is_none() && self.water_end(&behind) > self.water_end(&stand) { behind } else { stand };
        let depth = named.map_or(depth, |wave| wave.depth());
        let facts = named.map(|wave| wave.properties());
        let kind = facts.map(|facts| facts.kind);
        let (order, ramp) = (facts.map_or(1, |f| f.order), named.map_or(0.0, |wave| wave.ramp_time()));
        let mut wave = match facts.and_then(|facts| facts.solitary) {
            Some(own) => GeneratedWave {
                period_s: None,
                height_m: own.height,
                length_m: own.length(),
                kd: None,
                regime: DepthRegime::Shallow,
                region: TheoryRegion::Solitary,
                celerity_mps: own.celerity,
                group_mps: own.celerity,
                ..GeneratedWave::empty(&solid.spec.name)
            },
            None => {
                let train = match facts.and_then(|facts| facts.linear_wave) {
                    Some(train) => train,
                    None => LinearWave::new(std::f64::consts::PI / swing.half_period?, depth, self.g),
                };
                let height = facts.map_or_else(
                    || swing.stroke * equivalent_paddle(motion, level).transfer_function(&train),
                    |f| f.height,
                );
                GeneratedWave {
                    period_s: Some(train.period()),
                    height_m: height,
                    length_m: train.wavelength(),
                    kd: Some(train.kd()),
                    regime: train.depth_regime(),
                    region: train.theory_region(height),
                    celerity_mps: train.celerity(),
                    group_mps: train.group_velocity(),
                    ..GeneratedWave::empty(&solid.spec.name)
                }
            }
        };
        (wave.kind, wave.order, wave.depth_m, wave.ramp_s) = (kind, order, depth, ramp);
        (wave.stroke_m, wave.paddle_mps) = (swing.stroke, swing.speed);
        (wave.height_dp, wave.length_dp) = (wave.height_m / self.dp(), wave.length_m / self.dp());
        (wave.reach_m, wave.answers) = self.first_reflector(solid, &stand);
        wave.damping_m = self.damping_start(&stand).filter(|begins| *begins < wave.reach_m);
        wave.gauges = heights_at_gauges(self, &wave, &stand);
        (wave.far_s, wave.back_s) = (wave.reach_m / wave.group_mps, 2.0 * wave.reach_m / wave.group_mps);
        (wave.height_m.is_finite() && swing.stroke > 1e-3 * self.dp()).then_some((wave, stand))
    }
}

/// Returns the paddle that is equivalent to the motion in water with this level (m).
fn equivalent_paddle<const D: usize>(motion: &PrescribedMotion<D>, level: f64) -> Paddle {
    match motion.hinge_height() {
        Some(height) if height < level => Paddle::Flap { arm: level - height },
        _ => Paddle::Piston,
    }
}

impl GeneratedWave {
    /// Returns one line with the time at which the first reflection reaches the paddle and its reflector.
    pub fn first_reflection(&self) -> String {
        let (reach, far, back) = (three_digits(self.reach_m), three_digits(self.far_s), three_digits(self.back_s));
        let what = self.answers.as_ref().map_or("the far end".into(), |name| format!("\"{name}\""));
        let zone = self.damping_m.map(|begins| format!("; a damping zone begins at {} m", three_digits(begins)));
        format!("{reach} m to {what}: there after {far} s, back after {back} s{}", zone.unwrap_or_default())
    }

    fn empty(solid: &str) -> Self {
        Self {
            solid: solid.into(),
            kind: None,
            order: 1,
            stroke_m: 0.0,
            period_s: None,
            height_m: 0.0,
            height_dp: 0.0,
            length_m: 0.0,
            length_dp: 0.0,
            depth_m: 0.0,
            kd: None,
            regime: DepthRegime::Shallow,
            region: TheoryRegion::Airy,
            celerity_mps: 0.0,
            group_mps: 0.0,
            paddle_mps: 0.0,
            ramp_s: 0.0,
            reach_m: 0.0,
            answers: None,
            damping_m: None,
            gauges: Vec::new(),
            far_s: 0.0,
            back_s: 0.0,
        }
    }
}
