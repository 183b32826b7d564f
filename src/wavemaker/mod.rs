//! Wave generation: the paddle motion that makes the waves of a named theory.
//!
//! A `Wavemaker` describes the paddle and the water in front of it, and makes a [`PaddleMotion`]. The motion is the
//! displacement of the paddle's face at the still level, positive in the direction of wave propagation, and its exact
//! rate. The motion has no state: the same scene keys give a bit-identical wave at any time of any run. The module
//! `absorption` computes how the paddle yields to other waves.
//!
//!   X(t) = r(t) Σ Aₙ sin(ωₙ t + φₙ),   η(x, t) = Σ aₙ cos(ωₙ t − kₙ x + φₙ),   Aₙ = aₙ/c(kₙ)
//!
//! c is the paddle's transfer function (`paddle`); the ramp r rises smoothly from 0 to 1. The module `second_order`
//! treats waves of order 2, the module `solitary` solitary waves, and the module `incident` waves that enter through a face.

mod absorption;
mod extent;
mod incident;
mod paddle;
mod record;
mod second_order;
mod solitary;
mod spectrum;
mod train;

pub(crate) use absorption::{Absorber, AbsorptionSettings, AbsorptionState};
pub(crate) use extent::LINEAR_SPEED_RATIO_MAX;
pub use incident::IncidentWaves;
pub(crate) use incident::{Orbit, WaterAtFace, against_current, period_of_length, wave_number_on_current};
pub(crate) use paddle::Paddle;
pub use solitary::SolitaryTheory;
pub(crate) use solitary::SolitaryWave;
pub(crate) use spectrum::WaveSpectrum;
pub(crate) use train::LinearWave;
pub use train::{DepthRegime, TheoryRegion, wave_number};

use std::f64::consts::FRAC_PI_2;

use crate::{
    error::{Error, Result},
    math::{format::three_digits_down, time_series::TimeSeries},
};

/// Largest number of components of a wave: the paddle motion sums all components at every step.
pub(crate) const COMPONENTS_MAX: usize = 2000;

/// Number of components of a sea or a focused group if the scene does not set the number.
pub(crate) const COMPONENTS_DEFAULT: usize = 100;

/// Largest displacement of a flap over its arm: 60° of rotation.
const STEEPEST: f64 = 1.7321;

/// A component of the surface: η(x, t) = a cos(ω t − k x + φ), x (m) from the paddle's face at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaveComponent {
    /// a, m.
    pub amplitude: f64,
    /// ω, rad/s.
    pub omega: f64,
    /// φ, rad.
    pub phase: f64,
}

/// A paddle and the water in front of the paddle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wavemaker {
    /// Depth of the still water at the paddle, m.
    pub depth: f64,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// The paddle.
    pub paddle: Paddle,
}

/// The properties of a wave, for reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaveProperties {
    /// Kind of the wave, as the scene names the kind.
    pub kind: &'static str,
    /// Height, m: significant (4 √m₀) of a sea or a record, twice the crest of a focused group.
    pub height: f64,
    /// Order of the theory, 1 or 2.
    pub order: usize,
    /// The regular wave of the wave's period or peak period; `None` for a solitary wave.
    pub linear_wave: Option<LinearWave>,
    /// The solitary wave; `None` for any other wave.
    pub solitary: Option<SolitaryWave>,
    /// Distance (m) from the paddle and time (s) of the crest of a focused group; `None` for any other wave.
    pub focus: Option<(f64, f64)>,
}

/// The motion of a paddle that makes a wave.
#[derive(Clone, Debug)]
pub struct PaddleMotion {
    facts: WaveProperties,
    course: Course,
    /// Duration (s) of the ramp, over which the motion grows to full amplitude.
    ramp: f64,
    /// Time (s) at which the paddle is at rest again.
    end: f64,
    paddle: Paddle,
}

#[derive(Clone, Debug)]
enum Course {
    /// Sum of A sin(ω t + φ), where A is the displacement of the face at the still level.
    Tones(Vec<WaveComponent>),
    Solitary(SolitaryWave),
}

impl PaddleMotion {
    /// Returns the same motion with another ramp duration (s).
    pub(crate) fn with_ramp(mut self, ramp: f64) -> Self {
        self.ramp = ramp;
        self
    }

    /// Returns the ramp duration, s.
    pub(crate) fn ramp_time(&self) -> f64 {
        self.ramp
    }

    /// Returns the paddle of this motion.
    pub(crate) fn paddle(&self) -> Paddle {
        self.paddle
    }

    /// Returns the depth of the still water at the paddle, m.
    pub(crate) fn depth(&self) -> f64 {
        self.facts
            .linear_wave
            .map(|train| train.depth)
            .or(self.facts.solitary.map(|wave| wave.depth))
            .unwrap_or_default()
    }

    /// Returns the approximate stroke of the face, m: the distance between its two extreme positions.
    pub(crate) fn stroke(&self) -> f64 {
        match &self.course {
            Course::Tones(tones) => 2.0 * size(tones),
            Course::Solitary(wave) => wave.stroke(),
        }
    }

    /// Returns the properties of the wave.
    pub(crate) fn properties(&self) -> &WaveProperties {
        &self.facts
    }

    /// Returns the regular wave of the wave's period or peak period; for a solitary wave, a regular wave of equal
    /// length and speed.
    fn peak(&self, g: f64) -> LinearWave {
        match (self.facts.linear_wave, self.facts.solitary) {
            (None, Some(own)) => LinearWave::new(std::f64::consts::TAU * own.celerity / own.length(), own.depth, g),
            (train, _) => train.unwrap_or(LinearWave::new(1.0, self.depth(), g)),
        }
    }

    /// Returns the displacement (m) of the face at the still level and its rate (m/s) at time `t` (s).
    pub(crate) fn displacement(&self, t: f64) -> (f64, f64) {
        if t <= 0.0 || t >= self.end {
            return (0.0, 0.0);
        }
        let (x, v) = match &self.course {
            Course::Tones(tones) => tones.iter().fold((0.0, 0.0), |(x, v), tone| {
                let (sin, cos) = (tone.omega * t + tone.phase).sin_cos();
                (x + tone.amplitude * sin, v + tone.amplitude * tone.omega * cos)
            }),
            Course::Solitary(wave) => wave.displacement(t),
        };
        let (on, on_rate) = smooth(t, self.ramp);
        let (off, off_rate) = if self.end.is_finite() { smooth(self.end - t, self.ramp) } else { (1.0, 0.0) };
        (x * on * off, v * on * off + x * (on_rate * off - on * off_rate))
    }

    /// Returns the coordinate that drives the paddle, and its rate: displacement (m) and rate (m/s) of a piston, angle
    /// (rad) and rate (rad/s) of a flap. Both are positive in the direction of wave propagation.
    pub(crate) fn coordinate_and_rate(&self, t: f64) -> (f64, f64) {
        self.turned(self.displacement(t))
    }

    /// Returns the same as [`Wave::coordinate_and_rate`] for a face that absorption has shifted by `aside` (m and m/s).
    pub(super) fn with_offset(&self, t: f64, aside: (f64, f64)) -> (f64, f64) {
        let (x, v) = self.displacement(t);
        self.turned((x + aside.0, v + aside.1))
    }

    fn turned(&self, (x, v): (f64, f64)) -> (f64, f64) {
        match self.paddle {
            Paddle::Piston => (x, v),
            Paddle::Flap { arm } => ((x / arm).atan(), v / arm / (1.0 + (x / arm).powi(2))),
        }
    }

    /// Returns the surface elevation (m) by linear theory at `x` (m) from the paddle's face at rest and time `t` (s).
    /// The elevation ignores the ramp. Returns `None` for a solitary wave.
    pub fn elevation(&self, x: f64, t: f64) -> Option<f64> {
        let (Course::Tones(tones), Some(train)) = (&self.course, &self.facts.linear_wave) else { return None };
        let parts = tones.iter().filter(|tone| self.facts.order == 1 || tone.omega < 1.5 * train.omega).map(|tone| {
            let own = LinearWave::new(tone.omega, train.depth, train.g);
            tone.amplitude * self.paddle.transfer_function(&own) * (tone.omega * t - own.k * x + tone.phase).cos()
        });
        Some(parts.sum())
    }
}

/// Returns the ramp factor and its rate: 0 before t = 0, 1 after `ramp`, and in between the quintic whose first and
/// second derivatives vanish at both ends.
fn smooth(t: f64, ramp: f64) -> (f64, f64) {
    let s = t / ramp;
    match s {
        s if s >= 1.0 || ramp <= 0.0 => (1.0, 0.0),
        s if s <= 0.0 => (0.0, 0.0),
        s => (s * s * s * (10.0 + s * (6.0 * s - 15.0)), 30.0 * (s * (1.0 - s)).powi(2) / ramp),
    }
}

impl Wavemaker {
    /// Returns the motion for the regular wave of `height` (m), `period` (s) and `phase` (rad) of the surface at the
    /// paddle. Order 2 adds the motion that prevents free waves of twice the frequency.
    ///
    /// # Errors
    /// `Scene` if the wave would break, the paddle would outrun the wave, or the order is neither 1 nor 2.
    pub(crate) fn regular(&self, height: f64, period: f64, phase: f64, order: usize) -> Result<PaddleMotion> {
        let train = self.train(period)?;
        self.unbroken("a regular wave", height, &train)?;
        let component = WaveComponent { amplitude: 0.5 * height, omega: train.omega, phase };
        let mut tones = self.tones(&[component])?;
        match order {
            1 => {}
            2 => {
                let along = second_order::correction(&self.paddle, &train, tones[0].amplitude);
                // The second-order theory counts phases from the cosine of the paddle motion.
                let phase = 2.0 * (phase - FRAC_PI_2) + along.arg() + FRAC_PI_2;
                tones.push(WaveComponent { amplitude: along.norm(), omega: 2.0 * train.omega, phase });
            }
            _ => return Err(Error::scene(format!("waves of order {order} are not known")).help("order = 1 or 2")),
        }
        self.wave("regular", height, order, train, tones).with_ramp(2.0 * period).check_speed(&train)
    }

    /// Returns the motion for irregular waves of significant height `height` (m) and the given spectrum. The waves have
    /// `count` components of equal energy, with random phases drawn from `seed`.
    ///
    /// # Errors
    /// `Scene` if a regular wave of this height would break, or if the number of components is zero or too large.
    pub(crate) fn irregular(
        &self,
        height: f64,
        spectrum: &WaveSpectrum,
        seed: u64,
        count: usize,
    ) -> Result<PaddleMotion> {
        let train = self.train(spectrum.peak_period)?;
        self.unbroken("a wave of the significant height and the peak period", height, &train)?;
        let components = irregular_components(height, spectrum, seed, count)?;
        Ok(self.wave("sea", height, 1, train, self.tones(&components)?))
    }

    /// Returns the motion for a focused group, by linear theory. The group has a crest of height `crest` (m) at
    /// `distance` (m) from the paddle at `time` (s). The group is the most likely shape around a high crest in this
    /// spectrum (NewWave). @tromans1991
    ///
    /// # Errors
    /// `Scene` under the conditions of [`Wavemaker::irregular`], for a wave of height `crest`.
    pub fn focused(
        &self,
        crest: f64,
        spectrum: &WaveSpectrum,
        distance: f64,
        time: f64,
        count: usize,
    ) -> Result<PaddleMotion> {
        let train = self.train(spectrum.peak_period)?;
        self.unbroken("a wave as high as the crest", crest, &train)?;
        let omegas = counted(count).map(|()| spectrum.equal_energy_frequencies(count))?;
        let component = |omega: f64| {
            let phase = wave_number(omega, self.depth, self.g) * distance - omega * time;
            WaveComponent { amplitude: crest / count as f64, omega, phase }
        };
        let components: Vec<WaveComponent> = omegas.into_iter().map(component).collect();
        let mut wave = self.wave("focused", 2.0 * crest, 1, train, self.tones(&components)?);
        wave.facts.focus = Some((distance, time));
        Ok(wave)
    }

    /// Returns the motion for the sum of these wave components, to first order.
    ///
    /// # Errors
    /// `Scene` if the number of components is zero or too large, or if any single component would break.
    pub(crate) fn components(&self, components: &[WaveComponent]) -> Result<PaddleMotion> {
        counted(components.len())?;
        for component in components {
            let own = LinearWave::new(component.omega, self.depth, self.g);
            self.unbroken("one of the components", 2.0 * component.amplitude.abs(), &own)?;
        }
        let energy = |c: &WaveComponent| c.amplitude.powi(2);
        let largest = components.iter().max_by(|a, b| energy(a).total_cmp(&energy(b)));
        let train = LinearWave::new(largest.map_or(1.0, |c| c.omega), self.depth, self.g);
        let height = 4.0 * (0.5 * components.iter().map(energy).sum::<f64>()).sqrt();
        Ok(self.wave("components", height, 1, train, self.tones(components)?))
    }

    /// Returns the motion that reproduces the record `elevation` (m) at `distance` (m) from the paddle, to first order. The
    /// waves arrive `delay` (s) later than in the record. The motion omits the frequencies outside the middle 99 % of
    /// the record's energy.
    ///
    /// # Errors
    /// `Scene` if the record is too short or constant, or under the conditions of [`Wavemaker::components`].
    pub(crate) fn measured(&self, elevation: &TimeSeries, distance: f64, delay: f64) -> Result<PaddleMotion> {
        let found = record::fourier_components(elevation)?;
        let early = |c: &WaveComponent| WaveComponent {
            phase: c.phase + wave_number(c.omega, self.depth, self.g) * distance - c.omega * delay,
            ..*c
        };
        let components: Vec<WaveComponent> = found.iter().map(early).collect();
        let mut wave = self.components(&components)?;
        wave.facts.kind = "elevation";
        wave.end = elevation.span().1 + delay;
        Ok(wave)
    }

    /// Returns the motion for the solitary wave of `height` (m).
    ///
    /// # Errors
    /// `Scene` if the wave would break, or if the paddle is a flap: the theory covers only a piston.
    pub fn solitary(&self, height: f64, theory: SolitaryTheory) -> Result<PaddleMotion> {
        if self.paddle != Paddle::Piston {
            return Err(Error::scene("a solitary wave needs a piston: there is no theory of a flap that makes one")
                .help("write  driven = { along = [1.0, 0.0], wave = { solitary = { height = 0.1 } } }"));
        }
        let most = train::MCCOWAN_LIMIT * self.depth;
        if height > most {
            return Err(Error::scene(format!("a solitary wave of {height} m breaks in {} m of water", self.depth))
                .help(format!("the highest is 0.78 of the depth, {most:.3} m")));
        }
        let wave = SolitaryWave::new(height, self.depth, self.g, theory);
        let facts =
            WaveProperties { kind: "solitary", height, order: 1, linear_wave: None, solitary: Some(wave), focus: None };
        let (course, paddle) = (Course::Solitary(wave), self.paddle);
        Ok(PaddleMotion { facts, course, ramp: wave.ramp_time(), end: f64::INFINITY, paddle })
    }

    /// Returns the motion of a paddle that makes no wave, in front of waves of `period` (s) from another source.
    ///
    /// # Errors
    /// `Scene` if `period` is not a valid period.
    pub(crate) fn at_rest(&self, period: f64) -> Result<PaddleMotion> {
        Ok(self.wave("none", 0.0, 1, self.train(period)?, Vec::new()))
    }

    fn train(&self, period: f64) -> Result<LinearWave> {
        match period > 0.0 && period.is_finite() {
            true => Ok(LinearWave::new(std::f64::consts::TAU / period, self.depth, self.g)),
            false => Err(Error::scene(format!("a period must be a positive number of seconds, not {period}"))),
        }
    }

    /// Refuses a wave whose height exceeds the breaking height.
    fn unbroken(&self, what: &str, height: f64, train: &LinearWave) -> Result<()> {
        let most = train.breaking_height();
        if height <= most {
            return Ok(());
        }
        let (period, depth) = (train.period(), self.depth);
        let what =
            format!("{what}, {height:.3} m high, breaks: its period is {period:.3} s and the water {depth} m deep");
        Err(Error::scene(what)
            .help(format!("the highest that does not is {} m (Miche, McCowan)", three_digits_down(most))))
    }

    /// Returns the tones of the paddle motion for these surface components. Refuses a flap whose displacement is too
    /// large for its arm.
    fn tones(&self, components: &[WaveComponent]) -> Result<Vec<WaveComponent>> {
        let tone = |c: &WaveComponent| {
            let train = LinearWave::new(c.omega, self.depth, self.g);
            WaveComponent { amplitude: c.amplitude / self.paddle.transfer_function(&train), ..*c }
        };
        let tones: Vec<WaveComponent> = components.iter().map(tone).collect();
        match self.paddle {
            Paddle::Flap { arm } if size(&tones).is_nan() || size(&tones) > STEEPEST * arm => {
                let degrees = (size(&tones) / arm).atan().to_degrees();
                let what = format!(
                    "the flap would swing by {degrees:.0} degrees to each side: its hinge is too near the surface"
                );
                Err(Error::scene(what)
                    .help("60 is the most, and theory is for less than 30: a lower hinge, or lower waves"))
            }
            _ => Ok(tones),
        }
    }

    fn wave(
        &self,
        kind: &'static str,
        height: f64,
        order: usize,
        train: LinearWave,
        tones: Vec<WaveComponent>,
    ) -> PaddleMotion {
        let facts = WaveProperties { kind, height, order, linear_wave: Some(train), solitary: None, focus: None };
        PaddleMotion {
            facts,
            course: Course::Tones(tones),
            ramp: train.period(),
            end: f64::INFINITY,
            paddle: self.paddle,
        }
    }
}

/// Returns √Σ A², m: the amplitude of a single tone of equal energy.
fn size(tones: &[WaveComponent]) -> f64 {
    tones.iter().map(|tone| tone.amplitude.powi(2)).sum::<f64>().sqrt()
}

/// Returns the `count` components of equal energy of a sea of significant `height` (m) and this spectrum, with random phases drawn from
/// `seed`.
fn irregular_components(height: f64, spectrum: &WaveSpectrum, seed: u64, count: usize) -> Result<Vec<WaveComponent>> {
    let omegas = counted(count).map(|()| spectrum.equal_energy_frequencies(count))?;
    // m₀ = n a²/2 = (H/4)².
    let amplitude = height / (8.0 * count as f64).sqrt();
    let phases = spectrum::random_phases(seed);
    Ok(omegas.into_iter().zip(phases).map(|(omega, phase)| WaveComponent { amplitude, omega, phase }).collect())
}

fn counted(count: usize) -> Result<()> {
    match (1..=COMPONENTS_MAX).contains(&count) {
        true => Ok(()),
        false => Err(Error::scene(format!("a wave has 1 to {COMPONENTS_MAX} components, not {count}"))),
    }
}

#[cfg(test)]
#[path = "../../tests/unit/wavemaker/mod.rs"]
mod tests;
