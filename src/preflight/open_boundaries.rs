//! Faces that let in more water than they let out, or less.

use super::{Finding, PreflightContext};
use crate::{math::format::three_digits, system::prescribed_discharge};

/// Difference between what enters and what leaves, over the larger, from which on a warning names it.
const UNEQUAL: f64 = 0.02;

/// Adds a finding if all faces have a velocity that does not change in time, and the discharges do not cancel.
pub(super) fn check<const D: usize>(context: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let (system, until) = (context.system, context.end_time());
    let faces = system.open_boundaries();
    let at = |i: usize, t: f64| prescribed_discharge(system, i, t);
    let mut outward = Vec::new();
    for i in 0..faces.len() {
        let Some(now) = at(i, 0.0) else { return };
        if [0.37, 0.71, 1.0].iter().any(|part| at(i, part * until).is_none_or(|q| (q - now).abs() > 1e-9 * now.abs())) {
            return;
        }
        outward.push(now);
    }
    let [enters, leaves] = [-1.0, 1.0].map(|sense| outward.iter().map(|q| (sense * q).max(0.0)).sum::<f64>());
    if (enters - leaves).abs() <= UNEQUAL * enters.max(leaves) {
        return;
    }
    let unit = if D == 2 { "m²/s" } else { "m³/s" };
    let what = format!(
        "{} {unit} of water enter through the faces, and {} {unit} leave",
        three_digits(enters),
        three_digits(leaves)
    );
    let outflow = faces.iter().position(|face| !face.is_inflow);
    let mend = match outflow.filter(|&i| outward[i] > 0.0 && outward[i] + enters > leaves) {
        Some(i) => {
            let (name, factor) = (&faces[i].name, 1.0 + (enters - leaves) / outward[i]);
            format!("give \"{name}\" {} times its velocity, or a level without a velocity", three_digits(factor))
        }
        None => "a velocity is positive in the sense of the flow; give an outflow a level without a velocity".into(),
    };
    findings.push(Finding::warning("unequal_discharges", what, mend));
}
