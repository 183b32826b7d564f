//! `winch` of a `[[mooring]]`: a winch with a controller.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{
    error::{ErrorCode, Result},
    scene::context::{Context, Defaults},
    solid::{Winch, WinchTarget},
};

/// A winch with a controller at the end `from` of a mooring line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct WinchConfig {
    /// Tension at `from` that it holds, N.
    pub hold_tension: Option<f64>,
    /// Length without tension to which it goes at the rate limit, and which it holds, m.
    pub hold_length: Option<f64>,
    /// Largest rate of hauling in and paying out, m/s.
    pub rate_limit: f64,
    /// Rate of paying out over the excess of tension, m/s/N.
    pub gain: Option<f64>,
    /// Shortest length without tension, m.
    pub shortest: Option<f64>,
    /// Longest length without tension, m.
    pub longest: Option<f64>,
}

impl WinchConfig {
    /// Fills in the defaults for a line of this `length` (m).
    pub(super) fn fill(&mut self, defaults: &mut Defaults, key: &str, length: f64) {
        if let Some(tension) = self.hold_tension {
            let (gain, why) = (self.gain(tension), "the rate limit at an error of a tenth of hold_tension");
            defaults.fill(format!("{key}.gain"), &mut self.gain, gain, why);
        }
        let [shortest, longest] = self.range(length);
        defaults.fill(format!("{key}.shortest"), &mut self.shortest, shortest, "half the length");
        defaults.fill(format!("{key}.longest"), &mut self.longest, longest, "twice the length");
    }

    /// Refuses none or two targets, numbers out of range, and a tension above that under which the line `breaks` (N).
    pub(super) fn verify(&self, ctx: &Context, key: &str, length: f64, breaks: f64) -> Result<()> {
        let target = match (self.hold_tension, self.hold_length) {
            (Some(tension), None) => ("hold_tension", tension),
            (None, Some(length)) => ("hold_length", length),
            (given, _) => {
                let what = if given.is_some() {
                    "a winch holds a tension or a length, not both"
                } else {
                    "the winch holds nothing"
                };
                let help = "write  winch = { hold_tension = 50.0, rate_limit = 0.1 }  (N, m/s), or hold_length (m) in its place";
                let code = if given.is_some() { ErrorCode::ConflictingKeys } else { ErrorCode::MissingKey };
                return Err(ctx.error_with_help(key, what, help).with_code(code));
            }
        };
        if self.gain.is_some() && self.hold_length.is_some() {
            let help = "leave out gain: the winch goes to hold_length at rate_limit";
            let error = ctx.error_with_help(&format!("{key}.gain"), "gain belongs to hold_tension", help);
            return Err(error.with_code(ErrorCode::ConflictingKeys));
        }
        let numbers = [
            ("rate_limit", Some(self.rate_limit)),
            ("gain", self.gain),
            ("shortest", self.shortest),
            ("longest", self.longest),
        ];
        for (word, x) in [(target.0, Some(target.1))].into_iter().chain(numbers) {
            ctx.require_positive(&format!("{key}.{word}"), x)?;
        }
        let [shortest, longest] = self.range(length);
        for (word, x) in [("length", length), ("hold_length", self.hold_length.unwrap_or(length))] {
            if !(shortest..=longest).contains(&x) {
                let what = format!("{word} is {x} m, and the winch goes from {shortest} m to {longest} m");
                let help = "shortest and longest are lengths without tension with the length at the start between them";
                let place = if x < shortest { "shortest" } else { "longest" };
                let error = ctx.error_with_help(&format!("{key}.{place}"), what, help);
                return Err(error.with_code(ErrorCode::OutOfRange));
            }
        }
        if let Some(tension) = self.hold_tension.filter(|tension| *tension >= breaks) {
            let what = format!("the winch holds {tension} N, and the line breaks at {breaks} N");
            let help = format!("write  hold_tension = {:.6}  or less, or a higher  breaks", 0.5 * breaks);
            return Err(ctx
                .error_with_help(&format!("{key}.hold_tension"), what, help)
                .with_code(ErrorCode::OutOfRange));
        }
        Ok(())
    }

    /// The gain, m/s/N: by default the winch goes at its rate limit if a tenth of `tension` (N) is lacking.
    fn gain(&self, tension: f64) -> f64 {
        self.gain.unwrap_or(10.0 * self.rate_limit / tension)
    }

    /// Shortest and longest length (m) of a line of this `length` (m) at the start.
    fn range(&self, length: f64) -> [f64; 2] {
        let target = self.hold_length.unwrap_or(length);
        [self.shortest.unwrap_or(0.5 * length.min(target)), self.longest.unwrap_or(2.0 * length.max(target))]
    }

    /// The winch of a line of this `length` (m).
    pub(super) fn build(&self, length: f64) -> Winch {
        let target = match (self.hold_tension, self.hold_length) {
            (Some(tension), _) => WinchTarget::Tension { tension, gain: self.gain(tension) },
            (None, target) => WinchTarget::Length(target.unwrap_or(length)),
        };
        Winch::new(target, self.rate_limit, self.range(length))
    }
}
