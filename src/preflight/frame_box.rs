//! Checks that the box of the frames holds water at the start.

use super::{Finding, PreflightContext};
use crate::math::{Bounds, Vector, format::coordinates};

/// Adds a note about a box of the frames that holds no water at the start.
pub(super) fn check<const D: usize>(look: &PreflightContext<D>, findings: &mut Vec<Finding>) {
    let Some([min, max]) = look.plan.frames.as_ref().and_then(|frames| frames.crop.as_ref()) else { return };
    let [min, max] = [min, max].map(|corner| Vector::<D>::from_fn(|i, _| corner[i]));
    let (water, corners) = (&look.system.fluid().r, Bounds { min, max });
    if water.is_empty() || water.iter().any(|r| corners.contains(r)) {
        return;
    }
    let all = Bounds::around(*water);
    let what = format!(
        "frames.box, from {} to {} m, holds no water at the start: frames stay empty until water enters it",
        coordinates(&min),
        coordinates(&max)
    );
    let mend = format!("the water is from {} to {} m", coordinates(&all.min), coordinates(&all.max));
    findings.push(Finding::note("empty_frames", what, mend));
}
