//! The valid range of a water particle, and who leaves it first.

use rayon::prelude::*;

use super::System;
use crate::particles::PER_TASK;

impl<const D: usize> System<D> {
    /// The first water particle that has left the valid range, with what is wrong and its usual cause.
    pub(crate) fn first_fault(&self) -> Option<(usize, &'static str, &'static str)> {
        let limit2 = self.medium.c0 * self.medium.c0;
        let bad = |i: usize| {
            let (r, v, rho) = (&self.fluid.r[i], &self.fluid.v[i], self.fluid.rho[i]);
            let finite = r.iter().chain(v.iter()).all(|x| x.is_finite()) && rho.is_finite();
            if !finite {
                Some(("non-finite state", NON_FINITE))
            } else if v.norm_squared() > limit2 {
                Some(("speed above the speed of sound", TOO_FAST))
            } else if rho <= 0.0 {
                Some(("density at or below zero", TOO_FAST))
            } else if !self.domain.contains(r) {
                Some(("escape from the domain", ESCAPED))
            } else {
                None
            }
        };
        let i = (0..self.fluid.len()).into_par_iter().with_min_len(PER_TASK).find_first(|&i| bad(i).is_some())?;
        bad(i).map(|(what, cause)| (i, what, cause))
    }
}

const NON_FINITE: &str = "Usual cause: two particles or bodies pressed into one another at the start, or a time step \
    too long for a very light body. Try a smaller time.cfl, and look at the last frame.";
const TOO_FAST: &str = "Usual cause: a speed of sound too low for this flow, or a body that starts inside water. Raise \
    model.c0 (or model.c0_factor), or lower time.cfl.";
const ESCAPED: &str = "Usual cause: splash over a wall, or a wall thinner than the kernel's support. Make the walls \
    higher or thicker, or set domain.min and domain.max wider.";
