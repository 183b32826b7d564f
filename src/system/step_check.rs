//! The check of each step: the valid range of a water particle, the largest displacement, the first particle outside the range,
//! and the removal of particles.

use std::fmt;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{System, own_water};
use crate::{
    error::ErrorCode,
    math::{Bounds, Vector},
    particles::{PARTICLES_PER_TASK, Particles},
};

/// The valid range of a water particle. Scene words `[guard]`.
///
/// ```
/// use pontoon::simulation::{Escape, ParticleLimits};
///
/// let limits = ParticleLimits::default().density(0.9, 1.1).escape(Escape::Remove);
/// assert_eq!(limits.density, [0.9, 1.1]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ParticleLimits {
    /// Largest speed over c₀, –.
    pub speed: f64,
    /// Smallest and largest density over ρ₀, –.
    pub density: [f64; 2],
    /// What becomes of a particle outside the domain.
    pub escape: Escape,
}

impl ParticleLimits {
    /// The same range with this largest speed, over c₀ (–).
    pub fn speed(self, speed: f64) -> Self {
        Self { speed, ..self }
    }

    /// The same range with these smallest and largest densities, over ρ₀ (–).
    pub fn density(self, min: f64, max: f64) -> Self {
        Self { density: [min, max], ..self }
    }

    /// The same range with another treatment of particles that leave the domain.
    pub fn escape(self, escape: Escape) -> Self {
        Self { escape, ..self }
    }
}

/// What becomes of a particle that leaves the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Escape {
    /// It stops the run.
    Stop,
    /// It is taken out, and listed with its last state.
    Remove,
}

impl Default for ParticleLimits {
    /// Speeds up to half of c₀, where the density differs by an eighth and the water is no longer weakly compressible; densities
    /// from 0.5 ρ₀ to 1.5 ρ₀. A particle that leaves the domain stops the run.
    fn default() -> Self {
        Self { speed: 0.5, density: [0.5, 1.5], escape: Escape::Stop }
    }
}

/// A particle that left the domain and was taken out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RemovedParticle<const D: usize> {
    /// Its number.
    pub id: u32,
    /// Its last place, m.
    pub r: Vector<D>,
    /// Its last velocity, m/s.
    pub v: Vector<D>,
    /// Its last density, kg/m³.
    pub rho: f64,
    /// The side by which it left, and so its likely exit: "over a wall".
    pub exit: ExitPath,
}

/// How a particle is likely to have left the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExitPath {
    /// By the top: thrown up.
    Up,
    /// By a side, above the initial height of the water or after a fall from above it: over a wall.
    Over,
    /// By the bottom or a side, from a lower height: through a gap or a wall that is too thin.
    Through,
}

impl fmt::Display for ExitPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Up => "thrown up out of the domain",
            Self::Over => "splashed over a wall",
            Self::Through => "went through a wall or a gap",
        })
    }
}

/// What a step looks at while it moves a particle.
#[derive(Clone, Copy)]
pub(crate) struct ValidRange<const D: usize> {
    speed2: f64,
    rho: [f64; 2],
    /// Everywhere, if those that leave the domain are taken out.
    domain: Bounds<D>,
}

/// A water particle outside the valid range: its number, the code, the reason and its usual cause.
pub(crate) type LimitViolation = (usize, ErrorCode, &'static str, &'static str);

/// The result of the check of all particles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepCheck {
    /// Square of the largest displacement since the lists were made, m²; NaN if any displacement is NaN.
    pub(crate) max_displacement2: f64,
    /// Whether all are in the valid range.
    pub(crate) valid: bool,
}

impl StepCheck {
    /// Nothing yet.
    pub(crate) const INITIAL: Self = Self { max_displacement2: 0.0, valid: true };

    /// The check of a particle in the middle of a step, which was at `then` when the lists were made. The end of the step decides
    /// whether the particle is valid.
    #[inline(always)]
    pub(crate) fn displacement<const D: usize>(then: &Vector<D>, r: &Vector<D>) -> Self {
        Self { max_displacement2: (r - then).norm_squared(), valid: true }
    }

    /// Both.
    #[inline(always)]
    pub(crate) fn combine(self, other: Self) -> Self {
        let moved2 = if self.max_displacement2.is_nan() || self.max_displacement2 > other.max_displacement2 {
            self.max_displacement2
        } else {
            other.max_displacement2
        };
        Self { max_displacement2: moved2, valid: self.valid && other.valid }
    }
}

impl<const D: usize> ValidRange<D> {
    /// Looks at a particle that was at `then` when the lists were made.
    #[inline(always)]
    pub(crate) fn check(&self, then: &Vector<D>, r: &Vector<D>, v: &Vector<D>, rho: f64) -> StepCheck {
        // Whatever is not finite fails one of these comparisons.
        let [least, most] = self.rho;
        let valid = v.norm_squared() <= self.speed2 && rho >= least && rho <= most && self.domain.contains(r);
        StepCheck { max_displacement2: (r - then).norm_squared(), valid }
    }
}

impl<const D: usize> System<D> {
    /// What looks at the water while it is moved.
    pub(crate) fn valid_range(&self) -> ValidRange<D> {
        let ParticleLimits { speed, density, escape } = self.fluid_domain.limits;
        let domain = match escape {
            Escape::Stop => self.fluid_domain.domain,
            Escape::Remove => Bounds { min: Vector::repeat(f64::MIN), max: Vector::repeat(f64::MAX) },
        };
        ValidRange {
            speed2: (speed * self.properties.c0).powi(2),
            rho: density.map(|x| x * self.properties.rho0),
            domain,
        }
    }

    /// Looks at all water now.
    pub(crate) fn check_water(&mut self) {
        let (guard, fluid) = (self.valid_range(), &self.fluid.particles);
        let (these, own) = own_water::present(&self.neighbours, fluid.len());
        let all = fluid.r[these.clone()].par_iter().zip(&fluid.v[these.clone()]).zip(&fluid.rho[these.clone()]);
        self.status.step_check = all
            .zip(&self.neighbours.positions_at_build()[these.clone()])
            .enumerate()
            .with_min_len(PARTICLES_PER_TASK)
            .map(|(i, (((r, v), rho), then))| {
                let is_other = own.is_some_and(|own| !own[these.start + i]);
                if is_other { StepCheck::INITIAL } else { guard.check(then, r, v, *rho) }
            })
            .reduce(|| StepCheck::INITIAL, StepCheck::combine);
        if own_water::is_apart(&self.neighbours) {
            own_water::combine_checks(self);
        }
    }

    /// The first water particle that has left the valid range, with the reason and its usual cause. All ranks get the particle's
    /// state.
    pub(crate) fn first_invalid_particle(&mut self) -> Option<LimitViolation> {
        if self.status.step_check.valid {
            return None;
        }
        let (these, own) = own_water::present(&self.neighbours, self.fluid.particles.len());
        let is_bad = |i: &usize| own.is_none_or(|own| own[*i]) && self.violation(*i).is_some();
        let first = these.into_par_iter().with_min_len(PARTICLES_PER_TASK).find_first(is_bad);
        let i = own_water::share_first(self, first)?;
        self.violation(i).map(|(code, what, cause)| (i, code, what, cause))
    }

    /// What is wrong with water particle `i`, and its usual cause.
    fn violation(&self, i: usize) -> Option<(ErrorCode, &'static str, &'static str)> {
        let ValidRange { speed2, rho: [least, most], domain } = self.valid_range();
        let (r, v, rho) = (&self.fluid.particles.r[i], &self.fluid.particles.v[i], self.fluid.particles.rho[i]);
        let finite = r.iter().chain(v.iter()).all(|x| x.is_finite()) && rho.is_finite();
        if !finite {
            Some((ErrorCode::NonFiniteState, "non-finite state", NON_FINITE))
        } else if v.norm_squared() > speed2 {
            Some((ErrorCode::SpeedLimit, "speed too near the speed of sound (guard.speed)", TOO_FAST))
        } else if !(least..=most).contains(&rho) {
            Some((ErrorCode::DensityLimit, "density out of bounds (guard.density)", TOO_FAST))
        } else if !domain.contains(r) {
            Some((ErrorCode::LeftDomain, "escape from the domain", ESCAPED))
        } else {
            None
        }
    }

    /// Removes water particles that have left the domain from `order`, if the limits say so. Returns these particles.
    pub(super) fn remove_outside(&self, order: &mut Vec<u32>) -> Vec<RemovedParticle<D>> {
        let Particles { r, v, rho, id } = &self.fluid.particles;
        let mut lost = Vec::new();
        if self.fluid_domain.limits.escape == Escape::Remove {
            order.retain(|&i| {
                let i = i as usize;
                let inside = self.fluid_domain.domain.contains(&r[i]);
                if !inside {
                    let way = self.exit_path(&r[i], &v[i]);
                    lost.push(RemovedParticle { id: id[i], r: r[i], v: v[i], rho: rho[i], exit: way });
                }
                inside
            });
        }
        lost
    }

    /// How a particle at `x` (m) with velocity `v` (m/s), outside the domain, is likely to have come there.
    fn exit_path(&self, x: &Vector<D>, v: &Vector<D>) -> ExitPath {
        let up = D - 1;
        // Only gravity acts outside the domain: the particle fell from the height to which it would rise if time ran backwards. A
        // particle that went through a wall comes from no higher than the initial water level, except for pushes by other
        // particles.
        let (g, falls) = (-self.properties.gravity[up], v[up] < 0.0);
        let summit = if g > 0.0 && falls { x[up] + v[up].powi(2) / (2.0 * g) } else { x[up] };
        if x[up] > self.fluid_domain.domain.max[up] {
            ExitPath::Up
        } else if x[up] > self.fluid_domain.initial_water_height
            || summit > self.fluid_domain.initial_water_height + 2.0 * self.properties.h
        {
            ExitPath::Over
        } else {
            ExitPath::Through
        }
    }
}

const NON_FINITE: &str = "Usual cause: two particles or bodies pressed into one another at the start, or a time step \
    too long for a very light body. Try a smaller time.cfl, and look at the last frame.";
const TOO_FAST: &str = "Usual cause: a speed of sound too low for this flow, or a body that starts inside water. Raise \
    model.c0 (or model.c0_factor), or lower time.cfl; or allow more in [guard].";
const ESCAPED: &str = "Usual cause: splash over a wall, or a wall thinner than the kernel's support. Make the walls \
    higher or thicker, or set domain.min and domain.max wider; or let such particles go:  [guard] escape = \"remove\", \
    or, to go on with this run:  pontoon resume DIR --set guard.escape=remove";
