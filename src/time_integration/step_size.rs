//! The longest stable step:  Δt = CFL·min( √(h/|f|), h/(c₀ + h max|v_ab·r_ab|/(r² + η²)) ),  and with a viscosity ν₀
//! Δt ≤ h²/(8 ν₀).
//!
//! f is the whole acceleration, gravity included; √(h/|f|) is what eq. (14) of the paper means by h/√|f|. Free bodies do not
//! shorten the step: see `coupling/acoustic_added_mass.rs`.

use crate::{sph::FluidProperties, system::StepLimits};

/// The longest step (s) that the water allows; eq. (14) of @pirkhalili2023, @monaghan1992.
pub fn fluid_step_limit<const D: usize>(peaks: &StepLimits, medium: &FluidProperties<D>, cfl: f64) -> f64 {
    let by_force = (medium.h / peaks.acceleration).sqrt();
    let by_sound = medium.h / (medium.c0 + medium.h * peaks.approach_rate);
    cfl * by_force.min(by_sound)
}
