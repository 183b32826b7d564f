//! A winch with a controller: it holds the tension of a line, or goes to a length.
//!
//! To hold the tension T₀, the winch pays out at the rate L̇ = g (T − T₀), up to the rate limit. This is an integral controller,
//! so that no error remains at rest. The tension of its own line changes by dT/dL = −EA/L. With the rate of the end of the step,
//!
//!   L̇ = g (T − T₀)/(1 + g EA Δt/L),
//!
//! the winch is stable with any gain (backward Euler). The line and its winch are a spring and a dashpot in series, which add no
//! energy to the bodies at the ends (Maxwell 1867).

/// What a winch holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WinchTarget {
    /// The tension at the first end of the line.
    Tension {
        /// The tension, N (N/m in 2-D).
        tension: f64,
        /// Rate of paying out over the excess of tension, m/s/N (m²/s/N in 2-D).
        gain: f64,
    },
    /// The length without tension, m, to which it goes at the rate limit.
    Length(f64),
}

/// A winch with a controller at the first end of a mooring line. All segments grow alike.
///
/// ```
/// use pontoon::solid::{Winch, WinchTarget};
///
/// // 50 N, at most 0.1 m/s, with which it goes if 100 N are lacking, between half and twice the length of 8 m.
/// let winch = Winch::new(WinchTarget::Tension { tension: 50.0, gain: 0.001 }, 0.1, [4.0, 16.0]);
/// assert_eq!(winch.longest, 16.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Winch {
    /// What it holds.
    pub target: WinchTarget,
    /// Largest rate of hauling in and paying out, m/s.
    pub rate_limit: f64,
    /// Shortest length without tension to which it hauls in, m.
    pub shortest: f64,
    /// Longest length without tension to which it pays out, m.
    pub longest: f64,
}

impl Winch {
    /// A winch that hauls in and pays out at this rate (m/s) at most, between these lengths (m) without tension.
    pub fn new(target: WinchTarget, rate_limit: f64, [shortest, longest]: [f64; 2]) -> Self {
        Self { target, rate_limit, shortest, longest }
    }

    /// Length (m) of a line after a step of `dt` (s), from this `length` (m), with this `tension` (N) and axial `stiffness` (N).
    pub(super) fn next_length(&self, length: f64, tension: f64, stiffness: f64, dt: f64) -> f64 {
        let way = match self.target {
            WinchTarget::Tension { tension: target, gain } => {
                gain * (tension - target) * dt / (1.0 + gain * stiffness * dt / length)
            }
            WinchTarget::Length(target) => target - length,
        };
        let longest = self.rate_limit * dt;
        (length + way.clamp(-longest, longest)).clamp(self.shortest, self.longest)
    }

    /// Checks the winch of a line that starts with this `length` (m). The error says which number is wrong.
    pub(super) fn check(&self, length: f64) -> Result<(), String> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        match self.target {
            WinchTarget::Tension { tension, gain } if !positive(tension) || !positive(gain) => {
                Err(format!("tension is {tension} N and whose gain is {gain} m/s/N"))
            }
            WinchTarget::Length(target) if !positive(target) || !(self.shortest..=self.longest).contains(&target) => {
                Err(format!("target is {target} m, and whose range is {} m to {} m", self.shortest, self.longest))
            }
            _ if !positive(self.rate_limit) => Err(format!("rate limit is {} m/s", self.rate_limit)),
            _ if !positive(self.shortest) || !(self.shortest..=self.longest).contains(&length) => {
                Err(format!("range is {} m to {} m, and the line is {length} m long", self.shortest, self.longest))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/solid/mooring/winch.rs"]
mod tests;
