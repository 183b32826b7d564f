//! Active absorption: a paddle makes its own waves and absorbs the waves that return to it.
//!
//! A gauge at distance δ from the face measures the elevation η. The paddle's own wave accounts for η₀.
//! The excess e = η − η₀ shifts the face by x from its prescribed motion:
//!
//!   T x″ + x′ + x/τ = −F e
//!
//! By linear theory, an incoming wave of amplitude a and a shift x = Re X e^{iωt} give, at the gauge and in the far
//! field,
//!
//!   η = a (e^{ikδ} + e^{−ikδ}) + (ic e^{−ikδ} + s) X,   a_out = a + icX
//!
//! c is the paddle's transfer function, and s = Σ sⱼ e^{−κⱼδ} is the contribution of the evanescent modes at the gauge.
//! No wave leaves the paddle if X = i η/(c e^{ikδ} + is); F and T satisfy this condition at a single period, with
//! the return to the mean position (τ, five periods) included.
//! The lag T compensates for δ and s, and filters the gauge's noise. In shallow water the law becomes the long-wave law
//! x′ = −√(g/d) e. @schaffer2000, @altomare2017

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::{
    Course, LinearWave, Paddle, PaddleMotion, STEEPEST, WaveComponent, Wavemaker, smooth,
    train::{evanescent_wave_numbers, wave_number},
};
use crate::error::{Error, Result};

/// Time τ of the return to the mean position, over the period of tuning.
const HOME: f64 = 5.0;

/// Default stroke over the stroke of the paddle's own wave. Absorption of the returning waves needs the same stroke
/// again; the rest is reserve.
const ROOM: f64 = 4.0;

/// Number of evanescent modes in the sum: the omitted modes are below 1e-4 of the paddle's motion.
const MODES: usize = 30;

/// Largest kδ: beyond, the gauge is too far from the face to absorb the wave.
const FARTHEST: f64 = 1.0;

/// Least number of periods of the own motion that the code samples for the stroke, and samples per period.
const PERIODS: u32 = 100;
const SAMPLES: u32 = 40;

/// The imaginary unit.
const I: Complex<f64> = Complex::new(0.0, 1.0);

/// Settings of the absorption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AbsorptionSettings {
    /// The period (s) whose waves the paddle absorbs completely; `None`: the period of the paddle's own wave.
    pub period: Option<f64>,
    /// Least distance from the face at rest to the gauge, m. For a flap the code increases the distance until T is at
    /// least the travel time of a long wave to this least distance: the evanescent field of a flap leads the wave that
    /// leaves it.
    pub gauge_distance: f64,
    /// Height of the still water, m.
    pub water_level: f64,
    /// Stroke limit (m) of the face at the still level; `None`: four times the stroke of the paddle's own wave.
    pub max_stroke: Option<f64>,
    /// Speed limit (m/s) of the face; `None`: four times the speed of the paddle's own wave. A paddle without a wave of
    /// its own then takes the speed of a sine motion of that stroke and period.
    pub max_speed: Option<f64>,
}

/// The absorption law of a paddle, with its coefficients.
#[derive(Clone, Debug)]
pub(crate) struct Absorber {
    maker: Wavemaker,
    train: LinearWave,
    gauge_distance: f64,
    water_level: f64,
    /// Largest displacement (m) of the face to each side of its mean position, and largest speed, m/s.
    reach: f64,
    speed: f64,
    /// F, 1/s; T and τ, s.
    gain: f64,
    lag: f64,
    home: f64,
    /// The paddle's own components at the gauge, in the order of the tones.
    own: Vec<Own>,
    /// Amplitude (m) of the bound wave of twice the frequency.
    bound: f64,
}

/// A component at the gauge: a cos(ωt − kx + φ) + s sin(ωt + φ), where a is `leaving` and s is `staying`.
#[derive(Clone, Copy, Debug)]
struct Own {
    k: f64,
    leaving: f64,
    staying: f64,
}

/// The absorption shift of a paddle, which one step passes to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct AbsorptionState {
    /// Time of this state, s.
    since: f64,
    /// The shift x (m), and its first and second time derivatives.
    x: f64,
    rate: f64,
    change: f64,
}

impl AbsorptionState {
    /// Returns the shift x (m) and its rate x′ (m/s) at time `t` (s).
    pub(crate) fn offset_and_rate(&self, t: f64) -> (f64, f64) {
        let s = t - self.since;
        (self.x + s * (self.rate + 0.5 * s * self.change), self.rate + s * self.change)
    }

    /// Returns whether all values are finite.
    pub(crate) fn is_finite(&self) -> bool {
        (self.since + self.x + self.rate + self.change).is_finite()
    }
}

impl Absorber {
    /// Returns the absorption law for the paddle of `maker`, whose own motion is `wave`.
    ///
    /// # Errors
    /// `Scene` if the gauge is too far from the face for the wavelength, or if the stroke or the speed is too small for
    /// the paddle's own wave.
    pub(crate) fn new(maker: &Wavemaker, wave: &PaddleMotion, tuning: &AbsorptionSettings) -> Result<Self> {
        let AbsorptionSettings { gauge_distance, water_level, .. } = *tuning;
        let train = match tuning.period {
            Some(period) => maker.train(period)?,
            None => wave.peak(maker.g),
        };
        let (stroke, speed) = allowed_motion(maker, wave, &train, tuning)?;
        let mut absorber = Self {
            maker: *maker,
            train,
            gauge_distance,
            water_level,
            reach: 0.5 * stroke,
            speed,
            gain: 0.0,
            lag: 0.0,
            home: HOME * train.period(),
            own: Vec::new(),
            bound: 0.0,
        };
        let least = gauge_distance / (maker.g * maker.depth).sqrt();
        absorber.tune();
        while absorber.lag < least && train.k * absorber.gauge_distance < FARTHEST {
            absorber.gauge_distance += 0.25 * gauge_distance;
            absorber.tune();
        }
        if absorber.lag < least || train.k * absorber.gauge_distance > FARTHEST {
            let what = format!(
                "waves of {:.3} s, {:.3} m long, cannot be absorbed by a gauge {:.3} m before this paddle",
                train.period(),
                train.wavelength(),
                absorber.gauge_distance
            );
            return Err(Error::scene(what).help("a smaller dp brings the gauge nearer; a flap needs a lower hinge"));
        }
        absorber.learn(wave);
        Ok(absorber)
    }

    /// Sets F and T for the period of tuning: −ω²T + iω + 1/τ = F i (c e^{ikδ} + is).
    fn tune(&mut self) {
        let (omega, turn) = (self.train.omega, (I * self.train.k * self.gauge_distance).exp());
        let (c, s) = self.answer(&self.train);
        let wanted = I * (turn * c + I * s);
        self.gain = omega / wanted.im;
        self.lag = (1.0 / self.home - self.gain * wanted.re) / (omega * omega);
    }

    /// Stores the contribution of the paddle's own `wave` at the gauge.
    fn learn(&mut self, wave: &PaddleMotion) {
        let Course::Tones(tones) = &wave.course else { return };
        let facts = &wave.facts;
        // The second tone of order 2 makes no wave: this tone suppresses a free wave.
        let real = if facts.order == 2 { &tones[..1] } else { &tones[..] };
        let own = |tone: &WaveComponent| {
            let train = LinearWave::new(tone.omega, self.maker.depth, self.maker.g);
            let (c, s) = self.answer(&train);
            Own { k: train.k, leaving: c * tone.amplitude, staying: s * tone.amplitude }
        };
        self.own = real.iter().map(own).collect();
        if let (2, Some(train)) = (facts.order, facts.linear_wave) {
            self.bound = 0.5 * facts.height * train.second_order_ratio(facts.height);
        }
    }

    /// Returns c and s for a wave, –.
    fn answer(&self, train: &LinearWave) -> (f64, f64) {
        let Wavemaker { depth, g, paddle } = self.maker;
        let stays = evanescent_wave_numbers(train.omega, depth, g, MODES).into_iter().map(|kappa| {
            let k = Complex::new(0.0, -kappa);
            let whole = k * 4.0 * (k * depth).sinh() * paddle.shape_integral(k, depth);
            let norm = (k * depth * 2.0).sinh() + k * depth * 2.0;
            -(whole / norm).im * (-kappa * self.gauge_distance).exp()
        });
        (paddle.transfer_function(train), stays.sum())
    }

    /// Returns the period (s) whose waves the paddle absorbs completely.
    pub(crate) fn period(&self) -> f64 {
        self.train.period()
    }

    /// Returns the distance from the face at rest to the gauge, m.
    pub(crate) fn gauge_distance(&self) -> f64 {
        self.gauge_distance
    }

    /// Returns the stroke limit (m) and the speed limit (m/s) of the face.
    pub(crate) fn motion_limits(&self) -> (f64, f64) {
        (2.0 * self.reach, self.speed)
    }

    /// Returns the reflected fraction of the amplitude of a wave of `period` (s), by linear theory, –.
    pub(crate) fn reflection_coefficient(&self, period: f64) -> f64 {
        let omega = std::f64::consts::TAU / period;
        let train = LinearWave { omega, k: wave_number(omega, self.maker.depth, self.maker.g), ..self.train };
        let (c, s) = self.answer(&train);
        let phase = train.k * self.gauge_distance;
        let law = Complex::from(-self.gain) / Complex::new(1.0 / self.home - omega * omega * self.lag, omega);
        let seen = I * c * (I * -phase).exp() + s;
        let x = law * 2.0 * phase.cos() / (Complex::from(1.0) - law * seen);
        (Complex::from(1.0) + I * c * x).norm()
    }

    /// Returns the elevation (m) of the paddle's own `wave` alone at `x` (m) from the face at rest and time `t` (s).
    fn wanted(&self, wave: &PaddleMotion, x: f64, t: f64) -> f64 {
        match &wave.course {
            Course::Tones(tones) => {
                let parts = tones.iter().zip(&self.own).map(|(tone, own)| {
                    let phase = tone.omega * t + tone.phase;
                    own.leaving * (phase - own.k * x).cos() + own.staying * phase.sin()
                });
                let sum: f64 = parts.sum();
                let double = match (tones.first(), self.own.first()) {
                    (Some(tone), Some(own)) => (2.0 * (tone.omega * t + tone.phase - own.k * x)).cos(),
                    _ => 0.0,
                };
                let end = if wave.end.is_finite() { smooth(wave.end - t, wave.ramp).0 } else { 1.0 };
                (sum + self.bound * double) * smooth(t, wave.ramp).0 * end
            }
            Course::Solitary(own) => {
                let theta = own.kappa * own.celerity * (t - own.crest_time(x));
                own.height / theta.cosh().powi(2)
            }
        }
    }

    /// Returns the absorption state from time `t` (s) on, for own motion `wave` and previous state `before`. `level` is
    /// the height (m) of the water at the gauge, or `None` if the gauge finds no water.
    pub(crate) fn update(
        &self,
        wave: &PaddleMotion,
        before: &AbsorptionState,
        t: f64,
        level: Option<f64>,
    ) -> AbsorptionState {
        let (x, rate) = before.offset_and_rate(t);
        let (own, own_rate) = wave.displacement(t);
        let place = own + x;
        let excess = level.map_or(0.0, |z| z - self.water_level - self.wanted(wave, place + self.gauge_distance, t));
        // The paddle slows down before the end of the stroke, so that the lag does not carry it beyond the end.
        let room = |left: f64| self.speed.min(left.max(0.0) / (4.0 * self.lag));
        let asked = own_rate - x / self.home - self.gain * excess;
        let allowed = asked.clamp(-room(self.reach + place), room(self.reach - place)) - own_rate;
        AbsorptionState { since: t, x, rate, change: (allowed - rate) / self.lag }
    }
}

/// Returns the stroke limit (m) and the speed limit (m/s) of the face: the values in `tuning`, or the defaults.
fn allowed_motion(
    maker: &Wavemaker,
    wave: &PaddleMotion,
    train: &LinearWave,
    tuning: &AbsorptionSettings,
) -> Result<(f64, f64)> {
    let (own, own_speed) = extent(wave, train);
    let most = if let Paddle::Flap { arm } = maker.paddle { 2.0 * STEEPEST * arm } else { f64::INFINITY };
    let usual = if own > 0.0 { ROOM * own } else { train.breaking_height() / maker.paddle.transfer_function(train) };
    let stroke = tuning.max_stroke.unwrap_or(usual).min(most);
    let usual = if own > 0.0 { ROOM * own_speed } else { 0.5 * train.omega * stroke };
    let speed = tuning.max_speed.unwrap_or(usual);
    match stroke >= 2.0 * own && speed >= own_speed {
        true => Ok((stroke, speed)),
        false => {
            let what = format!("the paddle's own wave takes {own:.3} m to and fro, and {own_speed:.3} m/s");
            let least = format!("a stroke of {:.3} m and a speed of {own_speed:.3} m/s are the least", 2.0 * own);
            Err(Error::scene(what).help(format!("{least}: twice as far, so that it can yield; or leave both out")))
        }
    }
}

/// Returns twice the largest displacement (m) of the paddle's own motion, and its largest speed, m/s.
fn extent(wave: &PaddleMotion, train: &LinearWave) -> (f64, f64) {
    let step = train.period() / f64::from(SAMPLES);
    let first = f64::from(PERIODS) * train.period();
    // The paddle moves most for the crest of a group, and a record has an end: both may come later.
    let group = wave.facts.focus.map_or(0.0, |(_, time)| time + 2.0 * wave.peak(train.g).period());
    let [from, until] = if wave.end.is_finite() { [first, wave.end] } else { [first.max(group - first), group] };
    let later = (0..((until - from) / step).ceil() as u64).map(|i| from + i as f64 * step);
    let motion = (0..PERIODS * SAMPLES).map(|i| f64::from(i) * step).chain(later).map(|t| wave.displacement(t));
    motion.fold((0.0, 0.0), |most, (x, v)| (most.0.max(2.0 * x.abs()), most.1.max(v.abs())))
}

#[cfg(test)]
#[path = "../../tests/unit/wavemaker/absorption.rs"]
mod tests;
