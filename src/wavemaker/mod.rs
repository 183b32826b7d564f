//! Waves by name: how a paddle has to move so that the waves of a theory leave it.
//!
//! A `Wavemaker` knows the paddle and the water before it, and makes a [`PaddleMotion`]: the displacement of the paddle's face
//! at the still level, positive where the waves go, with its exact rate. There is no state: a wave is rebuilt from the
//! same words, and has the same bits at any time of any run. What a paddle yields to other waves is in `absorption`.
//!
//!   X(t) = r(t) Σ Aₙ sin(ωₙ t + φₙ),   η(x, t) = Σ aₙ cos(ωₙ t − kₙ x + φₙ),   Aₙ = aₙ/c(kₙ)
//!
//! c is the paddle's transfer function (`paddle`), r goes smoothly from 0 to 1. The waves of order 2 are in `second_order`,
//! the solitary one is in `solitary`.

mod absorption;
mod extent;
mod paddle;
mod record;
mod second_order;
mod solitary;
mod spectrum;
mod train;

pub(crate) use absorption::{Absorber, AbsorptionSettings, AbsorptionState};
pub(crate) use extent::LINEAR_SPEED_RATIO_MAX;
pub(crate) use paddle::Paddle;
pub use solitary::SolitaryTheory;
pub(crate) use solitary::SolitaryWave;
pub(crate) use spectrum::WaveSpectrum;
pub(crate) use train::LinearWave;
pub use train::{DepthRegime, TheoryRegion, wave_number};

use std::f64::consts::FRAC_PI_2;

use crate::{
    error::{Error, Result},
    math::time_series::TimeSeries,
};

/// Most components of one wave: their sum is formed at every step.
pub(crate) const COMPONENTS_MAX: usize = 2000;

/// Components of a sea or a group where nobody says how many.
pub(crate) const COMPONENTS_DEFAULT: usize = 100;

/// The largest displacement of a flap over its arm: 60°.
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

/// A paddle and the water before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wavemaker {
    /// Depth of the still water at the paddle, m.
    pub depth: f64,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// The paddle.
    pub paddle: Paddle,
}

/// What a wave is, for those who want to say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaveProperties {
    /// Its kind, in the words of a scene.
    pub kind: &'static str,
    /// Height, m: significant (4 √m₀) of a sea or a record, twice the crest of a focused group.
    pub height: f64,
    /// Order of the theory, 1 or 2.
    pub order: usize,
    /// The regular wave of its period or peak period; none of a solitary one.
    pub linear_wave: Option<LinearWave>,
    /// The solitary one.
    pub solitary: Option<SolitaryWave>,
    /// Distance (m) from the paddle and time (s) of a focused group's crest.
    pub focus: Option<(f64, f64)>,
}

/// The motion of a paddle that makes a wave.
#[derive(Clone, Debug)]
pub struct PaddleMotion {
    facts: WaveProperties,
    course: Course,
    /// Time (s) over which the motion comes to its full size.
    ramp: f64,
    /// When it has come to rest again, s.
    end: f64,
    paddle: Paddle,
}

#[derive(Clone, Debug)]
enum Course {
    /// A sin(ω t + φ), A the displacement of the face at the still level.
    Tones(Vec<WaveComponent>),
    Solitary(SolitaryWave),
}

impl PaddleMotion {
    /// The same wave with another ramp (s).
    pub(crate) fn with_ramp(mut self, ramp: f64) -> Self {
        self.ramp = ramp;
        self
    }

    /// How long (s) it takes to its full size.
    pub(crate) fn ramp_time(&self) -> f64 {
        self.ramp
    }

    /// The paddle that it is for.
    pub(crate) fn paddle(&self) -> Paddle {
        self.paddle
    }

    /// Depth of the still water that it is for, m.
    pub(crate) fn depth(&self) -> f64 {
        self.facts
            .linear_wave
            .map(|train| train.depth)
            .or(self.facts.solitary.map(|wave| wave.depth))
            .unwrap_or_default()
    }

    /// About how far (m) the face goes from end to end.
    pub(crate) fn stroke(&self) -> f64 {
        match &self.course {
            Course::Tones(tones) => 2.0 * size(tones),
            Course::Solitary(wave) => wave.stroke(),
        }
    }

    /// What it is.
    pub(crate) fn properties(&self) -> &WaveProperties {
        &self.facts
    }

    /// The regular wave of its period or peak period; of a solitary one that is as long and as fast.
    fn peak(&self, g: f64) -> LinearWave {
        match (self.facts.linear_wave, self.facts.solitary) {
            (None, Some(own)) => LinearWave::new(std::f64::consts::TAU * own.celerity / own.length(), own.depth, g),
            (train, _) => train.unwrap_or(LinearWave::new(1.0, self.depth(), g)),
        }
    }

    /// Displacement (m) of the face at the still level and its rate (m/s) at time `t` (s).
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

    /// What drives the paddle: displacement (m) and rate (m/s) of a piston, angle (rad) and rate (rad/s) of a flap,
    /// positive where the waves go.
    pub(crate) fn coordinate_and_rate(&self, t: f64) -> (f64, f64) {
        self.turned(self.displacement(t))
    }

    /// As [`Wave::coordinate_and_rate`], the face having yielded by `aside` (m and m/s).
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

    /// The surface (m) at `x` (m) before the paddle's face at rest and time `t` (s) by linear theory, the ramp left
    /// out; none of a solitary wave.
    pub fn elevation(&self, x: f64, t: f64) -> Option<f64> {
        let (Course::Tones(tones), Some(train)) = (&self.course, &self.facts.linear_wave) else { return None };
        let parts = tones.iter().filter(|tone| self.facts.order == 1 || tone.omega < 1.5 * train.omega).map(|tone| {
            let own = LinearWave::new(tone.omega, train.depth, train.g);
            tone.amplitude * self.paddle.transfer_function(&own) * (tone.omega * t - own.k * x + tone.phase).cos()
        });
        Some(parts.sum())
    }
}

/// 0 before 0, 1 after `ramp`, between them the quintic whose first and second rates vanish at both ends; and its rate.
fn smooth(t: f64, ramp: f64) -> (f64, f64) {
    let s = t / ramp;
    match s {
        s if s >= 1.0 || ramp <= 0.0 => (1.0, 0.0),
        s if s <= 0.0 => (0.0, 0.0),
        s => (s * s * s * (10.0 + s * (6.0 * s - 15.0)), 30.0 * (s * (1.0 - s)).powi(2) / ramp),
    }
}

impl Wavemaker {
    /// The regular wave of `height` (m), `period` (s) and phase (rad) of the surface at the paddle. Order 2 adds the
    /// motion that keeps the paddle from making free waves of twice the frequency.
    ///
    /// # Errors
    /// `Scene` if the wave would break, the paddle outrun it, or the order is neither 1 nor 2.
    pub(crate) fn regular(&self, height: f64, period: f64, phase: f64, order: usize) -> Result<PaddleMotion> {
        let train = self.train(period)?;
        self.unbroken("a regular wave", height, &train)?;
        let component = WaveComponent { amplitude: 0.5 * height, omega: train.omega, phase };
        let mut tones = self.tones(&[component])?;
        match order {
            1 => {}
            2 => {
                let along = second_order::correction(&self.paddle, &train, tones[0].amplitude);
                // Theory counts phases from the paddle's cosine.
                let phase = 2.0 * (phase - FRAC_PI_2) + along.arg() + FRAC_PI_2;
                tones.push(WaveComponent { amplitude: along.norm(), omega: 2.0 * train.omega, phase });
            }
            _ => return Err(Error::scene(format!("waves of order {order} are not known")).help("order = 1 or 2")),
        }
        self.wave("regular", height, order, train, tones).with_ramp(2.0 * period).check_speed(&train)
    }

    /// The irregular waves of significant height `height` (m) and this spectrum: `count` components of equal energy,
    /// whose phases are drawn from `seed`.
    ///
    /// # Errors
    /// `Scene` if even a regular wave of this height would break, or the components are none or too many.
    pub(crate) fn irregular(
        &self,
        height: f64,
        spectrum: &WaveSpectrum,
        seed: u64,
        count: usize,
    ) -> Result<PaddleMotion> {
        let train = self.train(spectrum.peak_period)?;
        self.unbroken("a wave of the significant height and the peak period", height, &train)?;
        let omegas = counted(count).map(|()| spectrum.equal_energy_frequencies(count))?;
        // m₀ = n a²/2 = (H/4)².
        let amplitude = height / (8.0 * count as f64).sqrt();
        let phases = spectrum::random_phases(seed);
        let components: Vec<WaveComponent> =
            omegas.into_iter().zip(phases).map(|(omega, phase)| WaveComponent { amplitude, omega, phase }).collect();
        Ok(self.wave("sea", height, 1, train, self.tones(&components)?))
    }

    /// The group whose crest of `crest` (m) stands at `distance` (m) before the paddle at `time` (s), by linear
    /// theory: of all groups of this spectrum the likeliest around a high crest (NewWave). @tromans1991
    ///
    /// # Errors
    /// `Scene` as [`Wavemaker::irregular`], for a wave of height `crest`.
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

    /// The waves that add up from these components, to first order.
    ///
    /// # Errors
    /// `Scene` if there are none or too many, or one of them would break by itself.
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

    /// The waves that show this `elevation` (m over s) at `distance` (m) before the paddle, `delay` (s) later than it
    /// says, to first order. Longer and shorter waves than those that hold the middle 99 % of its energy are left out.
    ///
    /// # Errors
    /// `Scene` if it is too short or still, or as [`Wavemaker::components`].
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

    /// The solitary wave of `height` (m).
    ///
    /// # Errors
    /// `Scene` if it would break, or the paddle is a flap, for which there is no theory.
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

    /// No wave at all: the paddle stands still, before waves of `period` (s) that come from elsewhere.
    ///
    /// # Errors
    /// `Scene` if the period is none.
    pub(crate) fn at_rest(&self, period: f64) -> Result<PaddleMotion> {
        Ok(self.wave("none", 0.0, 1, self.train(period)?, Vec::new()))
    }

    fn train(&self, period: f64) -> Result<LinearWave> {
        match period > 0.0 && period.is_finite() {
            true => Ok(LinearWave::new(std::f64::consts::TAU / period, self.depth, self.g)),
            false => Err(Error::scene(format!("a period must be a positive number of seconds, not {period}"))),
        }
    }

    /// Refuses a wave that would break as soon as it is made.
    fn unbroken(&self, what: &str, height: f64, train: &LinearWave) -> Result<()> {
        let most = train.breaking_height();
        if height <= most {
            return Ok(());
        }
        let (period, depth) = (train.period(), self.depth);
        let what =
            format!("{what}, {height:.3} m high, breaks: its period is {period:.3} s and the water {depth} m deep");
        Err(Error::scene(what).help(format!("the highest that does not is {most:.3} m (Miche, McCowan)")))
    }

    /// The paddle's tones for these components of the surface; refuses a flap that would lie down.
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

/// √Σ A², m: the amplitude of one tone.
fn size(tones: &[WaveComponent]) -> f64 {
    tones.iter().map(|tone| tone.amplitude.powi(2)).sum::<f64>().sqrt()
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
