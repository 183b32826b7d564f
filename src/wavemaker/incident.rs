//! Waves that enter through an open boundary: linear waves on a uniform current, in Lagrangian coordinates.
//!
//! A particle that rests at (X, Z) without waves, where X drifts with the current U and Z = 0 is the surface, is at
//!
//!   x = X − Σ a cosh k(Z + d)/sinh kd sin θ,   z = Z + Σ a sinh k(Z + d)/sinh kd cos θ,   θ = k X − ω t + φ,
//!
//! with (ω − k U)² = g k tanh kd @peregrine1976. In a frame that moves with the current this is a wave in water at rest. Rows
//! stay rows, because no particle drifts relative to the current. The pressure is that of linear theory, which vanishes at the
//! surface Z = 0.

use std::f64::consts::TAU;

use super::{LinearWave, WaveComponent, WaveSpectrum, counted, irregular_components, smooth, wave_number};
use crate::{
    error::{Error, ErrorCode, Result},
    math::format::{three_digits_down, two_digits_down, two_digits_up},
};

/// Steps of the iteration for the place at rest: each reduces the error by the slope of the waves.
const ITERATIONS: usize = 8;

/// Change of the place at rest, over the depth, at which the iteration for irregular waves ends.
const CLOSE: f64 = 1e-6;

/// Samples of the motion of an irregular sea in the period of its shortest component.
const SAMPLES: f64 = 16.0;

/// Largest number of components times samples that are summed, which takes some seconds. A longer run has fewer samples in a
/// period; a run of 1000 waves of 40 components has all samples.
const SUMMED_MAX: f64 = 4e7;

/// Factor on an opposing current. Waves that the increased current would stop are as short as some dp, and are left out of a
/// spectrum.
const FASTER: f64 = 1.1;

/// Most of the energy of a spectrum that waves hold that are left out.
const LEFT_OUT: f64 = 0.15;

/// Factor on the greatest sample: between samples, and beside the face, the water moves a little further and faster.
const MARGIN: f64 = 1.05;

/// Linear waves that move along an axis of their own, on a current along it.
#[derive(Clone, Debug, PartialEq)]
pub struct IncidentWaves {
    depth: f64,
    current: f64,
    ramp: f64,
    trains: Vec<Train>,
    /// Height (significant of an irregular sea, m), frequency (of the peak, rad/s) and that wave in the frame of the current.
    main: (f64, f64, LinearWave),
    /// The greatest displacement along the axis, m.
    excursion: f64,
    /// The greatest velocity relative to the current, m/s.
    orbital_speed: f64,
    /// Share of the energy of a spectrum in waves that the current stops; the other waves get this energy.
    left_out: f64,
}

/// The water at a face through which a sea enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WaterAtFace {
    /// Depth, m.
    pub depth: f64,
    /// Current along the waves, m/s; negative against them.
    pub current: f64,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// Duration of the rise to the full height, s. `None`: two periods of the peak.
    pub ramp: Option<f64>,
    /// End of the run, s: until then the water may not move against the current.
    pub until: f64,
}

/// A component at a fixed place, and the same wave in the frame that moves with the current.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Train {
    component: WaveComponent,
    /// Its ω is that of the component less k U.
    in_water: LinearWave,
}

/// A particle in the waves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Orbit {
    /// Displacement from its place without waves, along the axis of the waves and upwards, m.
    pub displacement: [f64; 2],
    /// Velocity relative to the current, m/s.
    pub velocity: [f64; 2],
    /// Pressure less that of water at rest in the same place, as a head, m.
    pub head: f64,
}

/// Returns the components of a spectrum without the short waves that the current stops or almost stops, and the share of the
/// energy in those short waves. The other components are raised to the height of all. Returns all components if that share is not
/// small.
fn without_stopped(components: Vec<WaveComponent>, water: &WaterAtFace) -> (Vec<WaveComponent>, f64) {
    let WaterAtFace { depth, current, g, .. } = *water;
    if current >= 0.0 {
        return (components, 0.0);
    }
    let energy = |components: &[WaveComponent]| components.iter().map(|c| c.amplitude.powi(2)).sum::<f64>();
    let moves = |c: &&WaveComponent| Train::new(**c, depth, FASTER * current, g).is_ok();
    let mut kept: Vec<WaveComponent> = components.iter().filter(moves).copied().collect();
    let (part, all) = (energy(&kept), energy(&components));
    if part < (1.0 - LEFT_OUT) * all {
        return (components, 0.0);
    }
    kept.iter_mut().for_each(|c| c.amplitude *= (all / part).sqrt());
    (kept, 1.0 - part / all)
}

impl IncidentWaves {
    /// A regular wave of `height` (m), `period` (s, at a fixed place) and `phase` (rad) at the origin of the axis, in water of this `depth`
    /// (m) with a `current` (m/s) along the axis under the acceleration `g` (m/s²). The waves rise in the time `ramp` (s).
    ///
    /// # Errors
    /// `Scene` if `height`, `period`, `depth` or `g` is not positive, the current stops waves of this period, the waves would
    /// break, or they would move water against the current.
    pub fn regular(height: f64, period: f64, phase: f64, depth: f64, current: f64, g: f64, ramp: f64) -> Result<Self> {
        Self::unchecked(height, period, phase, (depth, current, g), ramp)?.along_current()
    }

    /// The same wave, which may move water against the current.
    fn unchecked(
        height: f64,
        period: f64,
        phase: f64,
        (depth, current, g): (f64, f64, f64),
        ramp: f64,
    ) -> Result<Self> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if !(positive(height) && positive(period) && positive(depth) && positive(g) && current.is_finite()) {
            let what = format!("waves {height} m high, of {period} s, in {depth} m of water");
            return Err(Error::scene(what).help("give a positive height and period, and gravity"));
        }
        let component = WaveComponent { amplitude: 0.5 * height, omega: TAU / period, phase };
        let train = Train::new(component, depth, current, g)?;
        let most = train.in_water.breaking_height();
        if height > most {
            let what = format!("a wave {height} m high breaks on this current");
            let mut help = format!("the highest that does not is {} m (Miche, McCowan)", three_digits_down(most));
            if let Some(shortest) = shortest_unbroken(height, depth, current, g) {
                help += &format!(", the shortest of this height has {} s", two_digits_up(shortest));
            }
            return Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(help));
        }
        let excursion = train.excursion();
        let main = (height, component.omega, train.in_water);
        let orbital_speed = excursion * train.in_water.omega;
        Ok(Self { depth, current, ramp, trains: vec![train], main, excursion, orbital_speed, left_out: 0.0 })
    }

    /// A sea of significant `height` (m) with this `spectrum` at a fixed place, of `count` components with random phases from `seed`.
    ///
    /// # Errors
    /// As of [`IncidentWaves::components`].
    pub(crate) fn irregular(
        height: f64,
        spectrum: &WaveSpectrum,
        (seed, count): (u64, usize),
        water: &WaterAtFace,
    ) -> Result<Self> {
        let components = irregular_components(height, spectrum, seed, count)?;
        let (components, left_out) = without_stopped(components, water);
        Ok(Self { left_out, ..Self::sum(&components, (height, spectrum.peak_period), water)? })
    }

    /// The waves η = Σ a cos(ω t + φ) at the origin of the axis.
    ///
    /// # Errors
    /// `Scene` if there are no components or too many, the current stops one, a wave of the significant height and the period of the largest
    /// would break, or water would move against the current before the end of the run.
    pub(crate) fn components(components: &[WaveComponent], water: &WaterAtFace) -> Result<Self> {
        counted(components.len())?;
        let energy = |c: &WaveComponent| c.amplitude.powi(2);
        let largest = components.iter().max_by(|a, b| energy(a).total_cmp(&energy(b)));
        let height = match components {
            [alone] => 2.0 * alone.amplitude.abs(),
            _ => 4.0 * (0.5 * components.iter().map(energy).sum::<f64>()).sqrt(),
        };
        Self::sum(components, (height, largest.map_or(1.0, |c| TAU / c.omega)), water)
    }

    /// The sum of `components`, with the significant height (m) and the period (s) of its peak.
    fn sum(components: &[WaveComponent], (height, period): (f64, f64), water: &WaterAtFace) -> Result<Self> {
        let WaterAtFace { depth, current, g, ramp, until } = *water;
        let ramp = ramp.unwrap_or(2.0 * period);
        let shortest = components.iter().map(|c| c.omega).fold(0.0, f64::max);
        let train = |component| Train::new(component, depth, current, g);
        // The current stops the shortest first.
        train(WaveComponent { amplitude: 0.0, omega: shortest, phase: 0.0 }).map_err(|mut e| {
            let times = shortest * period / TAU;
            e.message = format!("the sea has components of {:.4} s: {}", TAU / shortest, e.message);
            e.help = e.help.map(|help| format!("{help}; the peak period is {times:.3} times that of the component"));
            e
        })?;
        let at_origin = |c: &WaveComponent| train(WaveComponent { phase: -c.phase, ..*c });
        let trains = components.iter().map(at_origin).collect::<Result<Vec<_>>>()?;
        let peak = Self::unchecked(height, period, 0.0, (depth, current, g), ramp)?;
        let mut waves = Self { trains, ..peak };
        let step = (TAU / shortest / SAMPLES).max(until * components.len() as f64 / SUMMED_MAX);
        let (mut excursion, mut speed) = (0.0f64, 0.0f64);
        for k in 0..=(until / step).ceil() as u64 {
            let orbit = waves.orbit_of([0.0, 0.0], k as f64 * step);
            excursion = excursion.max(orbit.displacement[0].abs());
            speed = speed.max(orbit.velocity[0].hypot(orbit.velocity[1]));
        }
        (waves.excursion, waves.orbital_speed) = (MARGIN * excursion, MARGIN * speed);
        waves.along_current()
    }

    /// Refuses waves that move water against their current.
    fn along_current(self) -> Result<Self> {
        let (fastest, current, height) = (self.orbital_speed, self.current, self.main.0);
        if fastest < current.abs() {
            return Ok(self);
        }
        let what = format!(
            "water moves to and fro through the face: the waves move it at {fastest:.4} m/s, the current at {current} m/s"
        );
        let help = format!(
            "a face makes waves on a current above {fastest:.4} m/s, or waves below {:.4} m; without a current use a paddle",
            height * current.abs() / fastest
        );
        Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(help))
    }

    /// The orbit at time `t` (s) of the particle that is at `x` (m) along the axis and `z` (m) above the surface at rest, and the height of
    /// its place without waves, m.
    pub(crate) fn orbit(&self, x: f64, z: f64, t: f64) -> (Orbit, f64) {
        let (mut orbit, mut rest) = (Orbit::default(), [x, z]);
        for _ in 0..ITERATIONS {
            orbit = self.orbit_of(rest, t);
            let before = rest;
            rest = [x - orbit.displacement[0], (z - orbit.displacement[1]).clamp(-self.depth, 0.0)];
            // Of many components each step is dear.
            if self.trains.len() > 1 && (rest[0] - before[0]).hypot(rest[1] - before[1]) < CLOSE * self.depth {
                break;
            }
        }
        (orbit, rest[1])
    }

    /// The orbit of the particle that is at `rest` without waves.
    pub(crate) fn orbit_of(&self, [x, z]: [f64; 2], t: f64) -> Orbit {
        let (ramp, rate) = smooth(t, self.ramp);
        let mut sum = Orbit::default();
        for Train { component: WaveComponent { amplitude, omega, phase }, in_water } in &self.trains {
            let (sin, cos) = (in_water.k * x - omega * t + phase).sin_cos();
            let [level, along, up] = profile(in_water.k, z, self.depth).map(|part| part * amplitude);
            let own = [-along * sin, up * cos];
            sum.displacement[0] += ramp * own[0];
            sum.displacement[1] += ramp * own[1];
            sum.velocity[0] += ramp * in_water.omega * along * cos + rate * own[0];
            sum.velocity[1] += ramp * in_water.omega * up * sin + rate * own[1];
            sum.head += ramp * level * cos;
        }
        sum
    }

    /// The current along the axis, m/s.
    pub(crate) fn current(&self) -> f64 {
        self.current
    }

    /// Height (m; significant of an irregular sea), frequency at a fixed place (rad/s; of the peak), and the wave of that frequency in the
    /// frame that moves with the current.
    pub(crate) fn main_train(&self) -> (f64, f64, LinearWave) {
        self.main
    }

    /// The period of the wave or of the peak, s.
    pub(crate) fn main_period(&self) -> f64 {
        TAU / self.main.1
    }

    /// Number of components.
    pub(crate) fn component_count(&self) -> usize {
        self.trains.len()
    }

    /// Share of the energy of a spectrum in waves that the current stops and that therefore do not enter; the other waves get
    /// this energy.
    pub(crate) fn left_out(&self) -> f64 {
        self.left_out
    }

    /// The surface (m) above that at rest at the time `t` (s) and the fixed place `x` (m) along the axis.
    pub fn elevation(&self, x: f64, t: f64) -> f64 {
        let (mut orbit, mut rest) = (Orbit::default(), x);
        for _ in 0..ITERATIONS {
            orbit = self.orbit_of([rest, 0.0], t);
            rest = x - orbit.displacement[0];
        }
        orbit.displacement[1]
    }

    /// Duration of the rise to the full height, s.
    pub(crate) fn ramp(&self) -> f64 {
        self.ramp
    }

    /// The greatest displacement along the axis, m.
    pub(crate) fn excursion(&self) -> f64 {
        self.excursion
    }

    /// The greatest velocity of the water relative to the current, m/s.
    pub(crate) fn orbital_speed(&self) -> f64 {
        self.orbital_speed
    }
}

impl Train {
    fn new(component: WaveComponent, depth: f64, current: f64, g: f64) -> Result<Self> {
        let Some(k) = wave_number_on_current(component.omega, depth, current, g) else {
            let (period, speed) = (TAU / component.omega, current.abs());
            let what = format!("no wave of {period:.4} s moves against a current of {speed} m/s in {depth} m of water");
            return Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(against_current(
                component.omega,
                depth,
                speed,
                g,
            )));
        };
        Ok(Self { component, in_water: LinearWave { depth, g, omega: component.omega - k * current, k } })
    }

    /// The greatest displacement along the axis, that of the surface, m.
    fn excursion(&self) -> f64 {
        self.component.amplitude.abs() / self.in_water.kd().tanh()
    }
}

/// cosh k(z + d)/cosh kd, cosh k(z + d)/sinh kd and sinh k(z + d)/sinh kd, without an overflow in deep water.
fn profile(k: f64, z: f64, depth: f64) -> [f64; 3] {
    let (rise, fall, bed) = ((k * z).exp(), (-k * (z + 2.0 * depth)).exp(), (-2.0 * k * depth).exp());
    [(rise + fall) / (1.0 + bed), (rise + fall) / (1.0 - bed), (rise - fall) / (1.0 - bed)]
}

/// The wave number k (1/m) of waves of frequency `omega` (rad/s, at a fixed place) that move along a current (m/s; negative against it),
/// from ω = k U + √(g k tanh kd); `None` if the current stops them. `depth` in m, `g` in m/s².
pub(crate) fn wave_number_on_current(omega: f64, depth: f64, current: f64, g: f64) -> Option<f64> {
    let in_water = |k: f64| LinearWave { depth, g, omega: (g * k * (k * depth).tanh()).sqrt(), k };
    let excess = |k: f64| k * current + in_water(k).omega - omega;
    let bisect = |mut low: f64, mut high: f64, below: &dyn Fn(f64) -> bool| {
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if below(middle) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let mut most = wave_number(omega, depth, g);
    if current < 0.0 {
        // The current stops the energy of this wave, and carries that of shorter ones away.
        let advances = |k: f64| in_water(k).group_velocity() > -current;
        let mut short = most;
        while advances(short) {
            short *= 2.0;
        }
        most = bisect(1e-9 / depth, short, &advances);
    }
    (excess(most) >= 0.0).then(|| bisect(0.0, most, &|k| excess(k) < 0.0))
}

/// The remedy for waves of frequency `omega` (rad/s) that an opposing current of `speed` (m/s) stops: the greatest current
/// against which these waves move, and the shortest period that moves against the present current. `depth` in m, `g` in m/s².
pub(crate) fn against_current(omega: f64, depth: f64, speed: f64, g: f64) -> String {
    let moves = |omega: f64, speed: f64| wave_number_on_current(omega, depth, -speed, g).is_some();
    let limit = |mut good: f64, mut bad: f64, moves: &dyn Fn(f64) -> bool| {
        for _ in 0..60 {
            let middle = 0.5 * (good + bad);
            if moves(middle) { good = middle } else { bad = middle }
        }
        good
    };
    let slowest = limit(0.0, speed, &|speed| moves(omega, speed));
    let current = format!("a current of {} m/s at most", two_digits_down(slowest));
    // No wave is faster than the longest.
    if speed >= (g * depth).sqrt() {
        return format!("{current}; against this one no wave moves");
    }
    let lowest = limit(1e-6 * omega, omega, &|omega| moves(omega, speed));
    format!("{current}, or a period of {} s at least", two_digits_up(TAU / lowest))
}

/// The shortest period (s, at a fixed place) of a wave of this length (m) or more on a current (m/s) along it, if it moves against the
/// current. `depth` in m, `g` in m/s².
pub(crate) fn period_of_length(length: f64, depth: f64, current: f64, g: f64) -> Option<f64> {
    let k = TAU / length;
    let omega = (g * k * (k * depth).tanh()).sqrt();
    let in_water = LinearWave { depth, g, omega, k };
    (in_water.group_velocity() + current > 0.0).then(|| TAU / (omega + k * current))
}

/// The period (s, at a fixed place) of the shortest wave of this `height` (m) that does not break; `None` if all do.
fn shortest_unbroken(height: f64, depth: f64, current: f64, g: f64) -> Option<f64> {
    let breaks = |length: f64| {
        let k = TAU / length;
        LinearWave { depth, g, omega: (g * k * (k * depth).tanh()).sqrt(), k }.breaking_height() < height
    };
    // So long a wave breaks by its depth alone.
    let mut long = 1e3 * depth;
    if breaks(long) {
        return None;
    }
    let mut short = 1e-3 * depth;
    for _ in 0..60 {
        let middle = 0.5 * (short + long);
        if breaks(middle) { short = middle } else { long = middle }
    }
    period_of_length(long, depth, current, g)
}

#[cfg(test)]
#[path = "../../tests/unit/wavemaker/incident.rs"]
mod tests;
