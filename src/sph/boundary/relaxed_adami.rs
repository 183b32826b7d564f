//! Relaxed Adami walls: a boundary particle obeys continuity, and its density relaxes to that of the water's pressure
//! extrapolated to it (Adami, Hu and Adams 2012):
//!
//!   P_w = [Σ_f V_f P_f W_wf + (g − a_w)·Σ_f m_f r_wf W_wf] / Σ_f V_f W_wf,   r_wf = r_w − r_f,
//!   dρ_w/dt = continuity + (ρ(P_w) − ρ_w)/τ,   τ = 10 h/c₀.
//!
//! Where the water approaches the face slowly, the density becomes ρ(P_w) at once. Continuity also compresses boundary particles
//! along which water slides or which it leaves at a waterline. If they kept this pressure for τ, it would act as a false lift and
//! drag. Where the water approaches faster than [`SLOW_APPROACH`] times c₀, the relaxation takes τ: the wall acts on an impact as
//! a dynamic boundary, which stops it and dissipates its energy. A sudden increase of pressure, and any change at a plate thinner
//! than the kernel's support, takes τ as well.
//!
//! P_w has a lower limit, so that the face exerts no suction: P_w ≥ min(0, ρ₀ g·n' d), with d the depth along n' from the
//! water. Pressure may always decrease; an increase is scaled by the
//! [`SupportCoverage`], since spray and thin films would otherwise gain energy.

use crate::sph::Num;

/// τ over h/c₀, –. At 40 a gap of 0.05 to 0.07 dp remains before the faces; at 0 water enters the faces.
pub(crate) const RELAXATION_TIME: f64 = 10.0;

/// Speed of approach of the water over c₀, –. Up to this value walls take its pressure at once; from twice this value on they
/// relax within τ. A float of draft d in water of depth 10 d has c₀ = 32 √(g d): its own motions are slower than 0.01 c₀, impacts
/// are faster.
const SLOW_APPROACH: f64 = 0.01;

/// Increase of density in a step over ρ₀, –. Up to this value walls take it at once; from twice this value on they relax within
/// τ. Sound with a particle velocity of 2e-4 c₀ has this increase. Without this limit a light body that a rope stops at 0.1 c₀ is
/// thrown back by half a particle.
const SLOW_INCREASE: f64 = 2e-4;

/// Mass of a free body over the mass of water in the volume of its boundary particles, –. Below this value its walls relax within
/// τ, because a sheet of foam would hop on the water; from twice this value on they take the pressure at once.
const LIGHT: f64 = 0.05;

/// Weight of a boundary particle over the weight behind a flat face under water, –. From this value on, the particle has water on
/// two faces: its plate is thinner than the support.
const TWO_FACES: f64 = 1.3;

/// Number of intervals between the depths in the table of [`SupportCoverage`].
const DEPTHS: usize = 64;

/// Shares of the full weight, –: no increase is applied below the first, and all of it above the second.
const COVERAGE_MIN: f64 = 0.8;
const COVERAGE_FULL: f64 = 1.0;

/// Share (–) of the difference to its target that a boundary particle relaxes in `dt` (s), with h (m) and c₀ (m/s).
pub fn relaxation(dt: f64, h: f64, c0: f64) -> f64 {
    1.0 - (-dt * c0 / (RELAXATION_TIME * h)).exp()
}

/// The extrapolation sums of a boundary particle over the water near it @adami2012.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallExtrapolation<N, const D: usize> {
    /// Σ V_f W_wf, –.
    pub weight_sum: N,
    /// Σ V_f W_wf P_f/ρ₀, m²/s².
    pub pressure_sum: N,
    /// Σ V₀ W_wf r_wf, m.
    pub offset_sum: [N; D],
    /// Σ V_f W_wf v_f, m/s; summed where the wall's [`Slip`](super::Slip) asks for it.
    pub velocity_sum: [N; D],
}

impl<N: Num, const D: usize> WallExtrapolation<N, D> {
    /// All sums `zero`.
    #[inline(always)]
    pub fn filled_with(zero: N) -> Self {
        Self { weight_sum: zero, pressure_sum: zero, offset_sum: [zero; D], velocity_sum: [zero; D] }
    }

    /// Adds a water particle of pressure `p` (P/ρ₀, m²/s²) and specific volume `s` (ρ₀/ρ) at r_w − `r_wf` (m), seen with
    /// kernel weight `w` (V₀ W).
    #[inline(always)]
    pub fn add(&mut self, w: N, p: N, s: N, r_wf: [N; D]) {
        let share = w * s;
        self.weight_sum = self.weight_sum + share;
        self.pressure_sum = share.fma(p, self.pressure_sum);
        for (arm, r) in self.offset_sum.iter_mut().zip(r_wf) {
            *arm = w.fma(r, *arm);
        }
    }

    /// Adds its velocity `v` (m/s) too.
    #[inline(always)]
    pub fn add_velocity(&mut self, w: N, s: N, v: [N; D]) {
        let share = w * s;
        for (flow, v) in self.velocity_sum.iter_mut().zip(v) {
            *flow = share.fma(v, *flow);
        }
    }
}

/// Σ a_k b_k.
#[inline(always)]
fn dot<N: Num, const D: usize>(a: &[N; D], b: &[N; D]) -> N {
    (1..D).fold(a[0] * b[0], |sum, k| a[k].fma(b[k], sum))
}

/// Least weight (–) of a boundary particle that has water: a smaller one, at the rim of the support, is round-off.
const LEAST_WEIGHT: f64 = 1e-9;

impl<N: Num, const D: usize> WallExtrapolation<N, D> {
    /// The unit vector from the water to the boundary particle; zero without water.
    #[inline(always)]
    pub fn direction(&self) -> [N; D] {
        let square = dot(&self.offset_sum, &self.offset_sum);
        let (zero, one) = (square.constant(0.0), square.constant(1.0));
        let norm = zero.select_below(square, square, one).sqrt();
        self.offset_sum.map(|x| x / norm)
    }

    /// The weight, or 1 without water.
    #[inline(always)]
    fn divisor(&self) -> N {
        let one = self.weight_sum.constant(1.0);
        self.weight_sum.select_below(one.constant(LEAST_WEIGHT), one, self.weight_sum)
    }

    /// `x` where there is water, else 0.
    #[inline(always)]
    fn with_water(&self, x: N) -> N {
        self.weight_sum.select_below(x.constant(LEAST_WEIGHT), x.constant(0.0), x)
    }

    /// The pressure P_w/ρ₀ (m²/s²) of a boundary particle `depth` (m) below the face, from `pull` = g − a_w (m/s²) and the
    /// gravity `g` (m/s²).
    #[inline(always)]
    pub fn pressure(&self, pull: &[N; D], g: &[N; D], depth: N) -> N {
        // The face is on the side of the water: a thin plate has two faces.
        let least = (dot(g, &self.direction()) * depth).min(depth.constant(0.0));
        self.with_water(((self.pressure_sum + dot(pull, &self.offset_sum)) / self.divisor()).max(least))
    }

    /// The speed (m/s) at which the water comes towards a boundary particle of velocity `v` (m/s), at least 0.
    #[inline(always)]
    pub fn approach(&self, v: &[N; D]) -> N {
        let divisor = self.divisor();
        let past = std::array::from_fn(|k| self.velocity_sum[k] / divisor - v[k]);
        self.with_water(dot(&self.direction(), &past).max(divisor.constant(0.0)))
    }
}

/// The density that a boundary particle takes, and the shares of a step's change that it takes at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallTarget<N> {
    /// ρ(P_w), kg/m³.
    pub density: N,
    /// Share of an increase that is applied at all, –: [`Cover::fraction`].
    pub increase: N,
    /// Share of a decrease that is applied at once, –; the rest within τ.
    pub prompt_decrease: N,
    /// Share of an increase that is applied at once, –; the rest within τ.
    pub prompt_increase: N,
}

/// Share (–) of a change that the walls of a solid take at once. `heaviness` (–) is the mass of the body over the mass of the
/// water in its place.
pub fn promptness(heaviness: f64) -> f64 {
    (heaviness / LIGHT - 1.0).clamp(0.0, 1.0)
}

impl<N: Num> WallTarget<N> {
    /// The target `density` (kg/m³) of a boundary particle of density `own` (kg/m³), which the water approaches with the speed
    /// `approach` (m/s). `cover` is its coverage by water, `promptness` (–) the value of [`promptness()`] for its solid. ρ₀ in
    /// kg/m³, c₀ in m/s.
    #[inline(always)]
    pub fn new(density: N, own: N, approach: N, cover: Cover<N>, promptness: N, [rho0, c0]: [f64; 2]) -> Self {
        let (zero, one) = (own.constant(0.0), own.constant(1.0));
        let below = |x: N, limit: f64| (x.constant(2.0) - x / x.constant(limit)).max(zero).min(one);
        let slow = below(approach / own.constant(c0), SLOW_APPROACH);
        let slow = own.constant(TWO_FACES).select_below(cover.share, zero, slow) * promptness;
        let gentle = below((density - own).max(zero) / own.constant(rho0), SLOW_INCREASE);
        Self { density, increase: cover.fraction(), prompt_decrease: slow, prompt_increase: slow * gentle }
    }

    /// The change of the density `own` (kg/m³) in a step in which the share `relaxation` (–) of a difference relaxes.
    #[inline(always)]
    pub(crate) fn change(&self, own: N, relaxation: N) -> N {
        let one = own.constant(1.0);
        let share = own.select_below(self.density, self.increase, one);
        let prompt = own.select_below(self.density, self.prompt_increase, self.prompt_decrease);
        (self.density - own) * share * (one - relaxation).fma(prompt, relaxation)
    }
}

/// Share of water in the part of a boundary particle's kernel support that lies before the face, from the weight of its
/// [`WallExtrapolation`].
#[derive(Clone, Debug)]
pub struct SupportCoverage {
    /// Weights of boundary particles behind a flat face under water, at depths from 0.
    full: Vec<f64>,
    /// Distance from one depth to the next, m.
    step: f64,
}

impl SupportCoverage {
    /// For a kernel `w` (V₀ W of the squared distance) of support `reach` (m) over particles `dp` (m) apart in `dimension`.
    pub fn new(w: impl Fn(f64) -> f64, dp: f64, reach: f64, dimension: usize) -> Self {
        let (step, most) = (reach / DEPTHS as f64, (reach / dp).ceil() as i32);
        let layers = if dimension == 2 { 0 } else { most };
        let full = (0..=DEPTHS).map(|k| {
            let mut sum = 0.0;
            for row in 0..most {
                let up = k as f64 * step + (f64::from(row) + 0.5) * dp;
                for i in -most..=most {
                    for j in -layers..=layers {
                        sum += w(up * up + f64::from(i * i + j * j) * dp * dp);
                    }
                }
            }
            sum
        });
        Self { full: full.collect(), step }
    }

    /// The weight of a boundary particle `depth` (m) behind a flat face under water, –; above zero.
    pub(crate) fn full_weight(&self, depth: f64) -> f64 {
        let place = (depth / self.step).clamp(0.0, DEPTHS as f64 - 1e-9);
        let (k, rest) = (place as usize, place.fract());
        (self.full[k] + (self.full[k + 1] - self.full[k]) * rest).max(1e-6)
    }

    /// The share (–) of the pressure on a flat face under water that acts on the row of boundary particles `depth` (m) below the face, with
    /// rows `dp` (m) apart: the shares of all rows sum up to 1.
    pub(crate) fn row_share(&self, depth: f64, dp: f64) -> f64 {
        2.0 * (self.full_weight((depth - 0.5 * dp).max(0.0)) - self.full_weight(depth + 0.5 * dp))
    }

    /// The cover of a boundary particle `depth` (m) below the face whose extrapolation has `weight`.
    pub fn cover(&self, weight: f64, depth: f64) -> Cover<f64> {
        Cover { share: weight / self.full_weight(depth) }
    }
}

/// How much of a boundary particle's support before the face is water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover<N> {
    /// Its weight over that behind a flat face under water, –.
    pub share: N,
}

impl<N: Num> Cover<N> {
    /// The factor (0 to 1) on an increase of pressure: 0 beside spray, 0.22 in a film of one row (2-D, h = 1.7 dp), 1 where water
    /// fills the support.
    #[inline(always)]
    pub fn fraction(self) -> N {
        let of = |x: f64| self.share.constant(x);
        let t = ((self.share - of(COVERAGE_MIN)) / of(COVERAGE_FULL - COVERAGE_MIN)).max(of(0.0)).min(of(1.0));
        t * t * (of(3.0) - of(2.0) * t)
    }
}
