//! Waves that enter through an open boundary: linear waves on a uniform current, in Lagrangian coordinates.
//!
//! A particle that rests at (X, Z) without waves, where X drifts with the current U and Z = 0 is the surface, is at
//!
//!   x = X − Σ a cosh k(Z + d)/sinh kd sin θ,   z = Z + Σ a sinh k(Z + d)/sinh kd cos θ,   θ = k X − ω t + φ,
//!
//! with (ω − k U)² = g k tanh kd @peregrine1976: in a frame that moves with the current it is a wave in water at rest. Rows stay rows, because
//! no particle drifts relative to the current. The pressure is that of linear theory, which vanishes at the surface Z = 0.

use std::f64::consts::TAU;

use super::{LinearWave, WaveComponent, smooth, wave_number};
use crate::error::{Error, ErrorCode, Result};

/// Steps of the iteration for the place at rest: each reduces the error by the slope of the waves.
const ITERATIONS: usize = 8;

/// Linear waves that move along an axis of their own, on a current along it.
#[derive(Clone, Debug, PartialEq)]
pub struct IncidentWaves {
    depth: f64,
    current: f64,
    ramp: f64,
    trains: Vec<Train>,
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

impl IncidentWaves {
    /// A regular wave of `height` (m), `period` (s, at a fixed place) and `phase` (rad) at the origin of the axis, in water of this `depth`
    /// (m) with a `current` (m/s) along the axis under the acceleration `g` (m/s²). The waves rise in the time `ramp` (s).
    ///
    /// # Errors
    /// `Scene` if a number is no positive one, the current stops waves of this period, the waves would break, or water would move against
    /// the current.
    pub fn regular(height: f64, period: f64, phase: f64, depth: f64, current: f64, g: f64, ramp: f64) -> Result<Self> {
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
            return Err(Error::scene(what)
                .with_code(ErrorCode::OutOfRange)
                .help(format!("the highest that does not is {most:.3} m (Miche, McCowan)")));
        }
        let waves = Self { depth, current, ramp, trains: vec![train] };
        let fastest = waves.orbital_speed();
        if fastest >= current.abs() {
            let what = format!(
                "water moves to and fro through the face: the waves move it at {fastest:.4} m/s, the current at {current} m/s"
            );
            let help = format!(
                "a face makes waves on a current above {fastest:.4} m/s, or waves below {:.4} m; without a current use a paddle",
                height * current.abs() / fastest
            );
            return Err(Error::scene(what).with_code(ErrorCode::OutOfRange).help(help));
        }
        Ok(waves)
    }

    /// The orbit at time `t` (s) of the particle that is at `x` (m) along the axis and `z` (m) above the surface at rest, and the height of
    /// its place without waves, m.
    pub(crate) fn orbit(&self, x: f64, z: f64, t: f64) -> (Orbit, f64) {
        let (mut orbit, mut rest) = (Orbit::default(), [x, z]);
        for _ in 0..ITERATIONS {
            orbit = self.orbit_of(rest, t);
            rest = [x - orbit.displacement[0], (z - orbit.displacement[1]).clamp(-self.depth, 0.0)];
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

    /// Height (m), frequency at a fixed place (rad/s) and wave in the frame that moves with the current, of each component.
    pub(crate) fn regular_trains(&self) -> impl Iterator<Item = (f64, f64, LinearWave)> {
        self.trains.iter().map(|train| (2.0 * train.component.amplitude, train.component.omega, train.in_water))
    }

    /// Duration of the rise to the full height, s.
    pub(crate) fn ramp(&self) -> f64 {
        self.ramp
    }

    /// The greatest displacement along the axis, m.
    pub(crate) fn excursion(&self) -> f64 {
        self.trains.iter().map(Train::excursion).sum()
    }

    /// The greatest velocity of the water relative to the current, m/s.
    pub(crate) fn orbital_speed(&self) -> f64 {
        self.trains.iter().map(|train| train.excursion() * train.in_water.omega).sum()
    }
}

impl Train {
    fn new(component: WaveComponent, depth: f64, current: f64, g: f64) -> Result<Self> {
        let Some(k) = wave_number_on_current(component.omega, depth, current, g) else {
            let what = format!(
                "no wave of {:.4} s moves against a current of {} m/s in {depth} m of water",
                TAU / component.omega,
                current.abs()
            );
            return Err(Error::scene(what)
                .with_code(ErrorCode::OutOfRange)
                .help("choose a longer period, or a slower current"));
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

#[cfg(test)]
#[path = "../../tests/unit/wavemaker/incident.rs"]
mod tests;
