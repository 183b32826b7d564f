//! Refuses formulas in t that have no finite value during a run.

use super::context::Context;
use crate::{
    error::{ErrorCode, Result},
    math::{expression::Formula, find_pole},
};

/// Number of equal intervals of the span at whose ends the value is checked.
const INTERVALS: u32 = 1000;

/// Halvings of an interval that locate the first time without a value, to 1e-6 of the interval.
const HALVINGS: u32 = 20;

/// Refuses the `formula` with this `text` at `key` if its value is not finite over an interval of the `span` (s) in which the
/// part that it drives exists. A value that is not finite at the start or end of the run is refused too. At any other single time
/// it is accepted, because no step meets such a time, unless it is a pole, near which the value grows without bound.
pub(super) fn require_finite(ctx: &Context, key: &str, text: &str, formula: &Formula, span: [f64; 2]) -> Result<()> {
    let [from, until] = [span[0].max(0.0), span[1].min(ctx.until)];
    let value = |t: f64| formula.value_and_rate(t).0;
    let time = |i: u32| from + (until - from) * f64::from(i) / f64::from(INTERVALS);
    let is_wrong = |i: u32| !value(time(i)).is_finite();
    let meets = |i: u32| match i {
        0 => from == 0.0 || is_wrong(1),
        INTERVALS => until == ctx.until || is_wrong(INTERVALS - 1),
        _ => is_wrong(i + 1) || is_wrong(i - 1),
    };
    let refuse = |shown: &str, t: f64| {
        let rounded = (t * 1e4).round() / 1e4;
        let what = format!("\"{text}\" {shown} at t = {rounded} s of a run to {} s", ctx.until);
        let help = "write a formula that is finite at all times, as sqrt(max(t - 0.2, 0)), or end the run before";
        Err(ctx.error_with_help(key, what, help).with_code(ErrorCode::OutOfRange))
    };
    let Some(found) = (0..=INTERVALS).find(|&i| is_wrong(i) && meets(i)) else {
        return find_pole(value, [from, until]).map_or(Ok(()), |t| refuse("grows without bound", t));
    };
    let mut bracket = [if found == 0 { from } else { time(found - 1) }, time(found)];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (bracket[0] + bracket[1]);
        bracket[usize::from(!value(middle).is_finite())] = middle;
    }
    let wrong = bracket[1];
    let shown = match value(wrong) {
        x if x.is_nan() => "has no value".into(),
        x => format!("has the value {x}"),
    };
    refuse(&shown, wrong)
}
