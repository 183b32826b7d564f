//! The valid range of a water particle, how far the water has moved, and who leaves the range first.

use rayon::prelude::*;

use super::System;
use crate::{
    particles::PER_TASK,
    space::{Bounds, Vector},
};

/// What a step looks at while it moves a particle.
#[derive(Clone, Copy)]
pub(crate) struct Guard<const D: usize> {
    c2: f64,
    domain: Bounds<D>,
}

/// What it saw of all particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    /// Square of the furthest way since the lists were made, m²; NaN if one is.
    pub(crate) moved2: f64,
    /// Whether all are in the valid range.
    pub(crate) valid: bool,
}

impl Seen {
    /// Nothing yet.
    pub(crate) const NOTHING: Self = Self { moved2: 0.0, valid: true };

    /// Both.
    #[inline(always)]
    pub(crate) fn and(self, other: Self) -> Self {
        let moved2 = if self.moved2.is_nan() || self.moved2 > other.moved2 { self.moved2 } else { other.moved2 };
        Self { moved2, valid: self.valid && other.valid }
    }
}

impl<const D: usize> Guard<D> {
    /// Looks at a particle that was at `then` when the lists were made.
    #[inline(always)]
    pub(crate) fn see(&self, then: &Vector<D>, r: &Vector<D>, v: &Vector<D>, rho: f64) -> Seen {
        // Whatever is not finite fails one of these comparisons.
        let valid = v.norm_squared() <= self.c2 && rho > 0.0 && rho < f64::INFINITY && self.domain.contains(r);
        Seen { moved2: (r - then).norm_squared(), valid }
    }
}

impl<const D: usize> System<D> {
    /// What looks at the water while it is moved.
    pub(crate) fn guard(&self) -> Guard<D> {
        Guard { c2: self.medium.c0 * self.medium.c0, domain: self.domain }
    }

    /// Looks at all water now.
    pub(crate) fn look(&mut self) {
        let (guard, fluid) = (self.guard(), &self.fluid);
        let all = fluid.r.par_iter().zip(&fluid.v).zip(&fluid.rho).zip(self.near.built()).with_min_len(PER_TASK);
        self.seen = all.map(|(((r, v), rho), then)| guard.see(then, r, v, *rho)).reduce(|| Seen::NOTHING, Seen::and);
    }

    /// The first water particle that has left the valid range, with what is wrong and its usual cause.
    pub(crate) fn first_fault(&self) -> Option<(usize, &'static str, &'static str)> {
        if self.seen.valid {
            return None;
        }
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
