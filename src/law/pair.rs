//! What a law sees: a pair of particles and a number; and what it gives: a term.
//!
//! Densities enter as x = ρ/ρ₀ − 1, pressures as P/ρ₀, and the common factor V₀ ∇_a W (V₀ = m/ρ₀) is
//! left to the sweep, so that single precision loses nothing and a force changes its sign *bit for bit*
//! when a and b swap.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that laws are written in: `f64`, or several lanes of `f32`.
pub trait Num:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The constant `x`.
    fn of(x: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger of two.
    fn max(self, other: Self) -> Self;
    /// The smaller of two.
    fn min(self, other: Self) -> Self;
    /// `yes` where `self < limit`, else `no`.
    fn if_below(self, limit: Self, yes: Self, no: Self) -> Self;
}

impl Num for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn if_below(self, limit: Self, yes: Self, no: Self) -> Self {
        if self < limit { yes } else { no }
    }
}

/// One particle of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Side<N, const D: usize> {
    /// Excess density x = ρ/ρ₀ − 1, –.
    pub x: N,
    /// Pressure P/ρ₀, m²/s².
    pub p: N,
    /// Specific volume ρ₀/ρ, –.
    pub s: N,
    /// Sub-particle stress ρ₀ τ/ρ², m²/s² (zero unless the viscosity has one).
    pub stress: [[N; D]; D],
}

/// Two particles a and b, and what their places give.
#[derive(Clone, Copy, Debug)]
pub struct Pair<N, const D: usize> {
    /// r_a − r_b, m.
    pub r_ab: [N; D],
    /// v_a − v_b, m/s.
    pub v_ab: [N; D],
    /// |r_ab|², m².
    pub r2: N,
    /// v_ab · r_ab, m²/s.
    pub vr: N,
    /// 1/(r² + η²), 1/m².
    pub inv_r2: N,
    /// ρ₀/ρ̄_ab with ρ̄ the mean of both densities, –.
    pub s_mean: N,
    /// Kernel W_ab, 1/mᴰ.
    pub w: N,
    /// Particle a.
    pub a: Side<N, D>,
    /// Particle b.
    pub b: Side<N, D>,
}

impl<N: Num, const D: usize> Pair<N, D> {
    /// The pair of `a` and `b` with r_ab, v_ab, |r_ab|² and kernel value as given; η² in m².
    #[inline(always)]
    pub fn new(r_ab: [N; D], v_ab: [N; D], r2: N, w: N, eta2: N, a: Side<N, D>, b: Side<N, D>) -> Self {
        let mut vr = r_ab[0] * v_ab[0];
        for i in 1..D {
            vr = vr + r_ab[i] * v_ab[i];
        }
        // One division gives both reciprocals.
        let (away, twice_rho) = (r2 + eta2, N::of(2.0) + (a.x + b.x));
        let both = N::of(1.0) / (away * twice_rho);
        let (inv_r2, s_mean) = (both * twice_rho, N::of(2.0) * both * away);
        Self { r_ab, v_ab, r2, vr, inv_r2, s_mean, w, a, b }
    }
}

/// Sums beyond force and density rate, kept only for the laws that need them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extra<N, const D: usize> {
    /// Concentration gradient ∇C = Σ V_b ∇_a W, 1/m.
    pub grad_c: [N; D],
    /// ∇·r = −Σ V_b r_ab·∇_a W, –.
    pub div_r: N,
    /// Strain rate S_ij, symmetric, 1/s.
    pub strain: [[N; D]; D],
}

impl<N: Num, const D: usize> Extra<N, D> {
    /// All sums zero.
    #[inline(always)]
    pub fn zero() -> Self {
        let o = N::of(0.0);
        Self { grad_c: [o; D], div_r: o, strain: [[o; D]; D] }
    }
}

/// One neighbour's share, as a fold: each hook gets the sum of the laws before it and returns it with
/// its own share added; a law that has nothing to say returns what came in and leaves no instruction.
///
/// The force per unit of mass on a is V₀ ∂W (`along_r` r_ab + `along_v` v_ab + `vector`), and the rate of
/// x_a is V₀ ∂W times the first of `rate`, with ∂W = (dW/dr)/r, so that ∇_a W = ∂W r_ab.
pub trait Term<N: Num, const D: usize>: Copy + Send + Sync {
    /// Whether `extra` is used.
    const EXTRA: bool = false;
    /// Whether the sides' `stress` is read.
    const STRESS: bool = false;

    /// Share along r_ab, m²/s²; symmetric under the swap of a and b.
    #[inline(always)]
    fn along_r(&self, _ab: &Pair<N, D>, sum: N) -> N {
        sum
    }
    /// Share along v_ab, m²/s; symmetric.
    #[inline(always)]
    fn along_v(&self, _ab: &Pair<N, D>, sum: N) -> N {
        sum
    }
    /// Share in any direction, m³/s²; antisymmetric.
    #[inline(always)]
    fn vector(&self, _ab: &Pair<N, D>, sum: [N; D]) -> [N; D] {
        sum
    }
    /// Shares of the rates of x_a and x_b, m²/s.
    #[inline(always)]
    fn rate(&self, _ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
        sum
    }
    /// Shares of the extra sums of a and b, without the factor V₀ ∂W.
    #[inline(always)]
    fn extra(&self, _ab: &Pair<N, D>, _factor: N, _a: &mut Extra<N, D>, _b: &mut Extra<N, D>) {}
}

/// No law.
impl<N: Num, const D: usize> Term<N, D> for () {}

macro_rules! tuple_of_terms {
    ($($name:ident $index:tt),+) => {
        impl<N: Num, const D: usize, $($name: Term<N, D>),+> Term<N, D> for ($($name,)+) {
            const EXTRA: bool = $($name::EXTRA)|+;
            const STRESS: bool = $($name::STRESS)|+;
            #[inline(always)]
            fn along_r(&self, ab: &Pair<N, D>, sum: N) -> N {
                $(let sum = self.$index.along_r(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn along_v(&self, ab: &Pair<N, D>, sum: N) -> N {
                $(let sum = self.$index.along_v(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn vector(&self, ab: &Pair<N, D>, sum: [N; D]) -> [N; D] {
                $(let sum = self.$index.vector(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn rate(&self, ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
                $(let sum = self.$index.rate(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn extra(&self, ab: &Pair<N, D>, factor: N, a: &mut Extra<N, D>, b: &mut Extra<N, D>) {
                $(self.$index.extra(ab, factor, a, b);)+
            }
        }
    };
}
tuple_of_terms!(A 0, B 1);
