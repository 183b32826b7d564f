//! The input of a law, a pair of particles, and its output, a term; both generic over the number type.
//!
//! Densities enter as x = ρ/ρ₀ − 1, pressures as P/ρ₀, and the common factor V₀ ∇_a W (V₀ = m/ρ₀) is
//! applied by the pair loop, so that single precision keeps all digits and a force changes its sign *bit for bit*
//! when a and b swap.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that laws are written in: `f64`, or several lanes of `f32`.
pub trait Num:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The constant `x`, in every lane of a number like this one.
    fn constant(self, x: f64) -> Self;
    /// The constant `x`, which may change from pass to pass: component `k` of what a trace reads as the input `name`.
    #[inline(always)]
    fn parameter(self, _name: &str, _k: usize, x: f64) -> Self {
        self.constant(x)
    }
    /// self·b + c; lanes round once where the processor can.
    fn fma(self, b: Self, c: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The larger of two.
    fn max(self, other: Self) -> Self;
    /// The smaller of two.
    fn min(self, other: Self) -> Self;
    /// `yes` where `self < limit`, else `no`.
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self;
}

impl Num for f64 {
    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
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
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        if self < limit { yes } else { no }
    }
}

/// One particle of a pair.
#[derive(Clone, Copy, Debug)]
pub struct PairSide<N, const D: usize> {
    /// Excess density x = ρ/ρ₀ − 1, –.
    pub compression: N,
    /// Pressure P/ρ₀, m²/s².
    pub p: N,
    /// Specific volume ρ₀/ρ, –.
    pub specific_volume: N,
    /// Tensile repulsion, m²/s² (read by laws with [`Term::REPULSION`]).
    pub repulsion: N,
    /// Whether water beside it is not shifted: 1 or 0 (read by laws with [`Term::SHIFTING_SUPPRESSION`]).
    pub shifting_suppressed: N,
    /// Sub-particle stress ρ₀ τ/ρ², m²/s²; symmetric, of which laws read `[i][j]` with j ≤ i (read by laws with
    /// [`Term::STRESS`]).
    pub stress: [[N; D]; D],
    /// B − 1 of the corrected gradient, –; symmetric, as above (read by laws with [`Term::GRADIENT_CORRECTION`]).
    pub gradient_correction: [[N; D]; D],
}

/// r_ab (m), v_ab (m/s), |r_ab|² (m²) and x_b − x_a (–) of a pair.
pub type PairGeometry<N, const D: usize> = ([N; D], [N; D], N, N);

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
    pub velocity_along_r: N,
    /// x_b − x_a, –.
    pub compression_difference: N,
    /// 1/(r² + η²), 1/m².
    pub inv_r2: N,
    /// ρ₀/(ρ̄_ab (r² + η²)) with ρ̄ the mean of both densities, 1/m².
    pub viscous_factor: N,
    /// Kernel, weighed with a particle's volume at ρ₀: V₀ W_ab, –.
    pub w: N,
    /// Particle a.
    pub a: PairSide<N, D>,
    /// Particle b.
    pub b: PairSide<N, D>,
}

impl<N: Num, const D: usize> Pair<N, D> {
    /// The pair of `a` and `b` with r_ab, v_ab, |r_ab|², x_b − x_a and kernel value as given; η² in m². In single precision the
    /// difference of x has more digits than x, so that it is right in deep water.
    #[inline(always)]
    pub fn new(
        (r_ab, v_ab, r2, compression_difference): PairGeometry<N, D>,
        w: N,
        eta2: N,
        a: PairSide<N, D>,
        b: PairSide<N, D>,
    ) -> Self {
        let mut vr = r_ab[0] * v_ab[0];
        for i in 1..D {
            vr = r_ab[i].fma(v_ab[i], vr);
        }
        // One division gives both reciprocals.
        let (away, twice_rho) = (r2 + eta2, (a.compression + b.compression) + r2.constant(2.0));
        let both = r2.constant(1.0) / (away * twice_rho);
        Self {
            r_ab,
            v_ab,
            r2,
            velocity_along_r: vr,
            compression_difference,
            inv_r2: both * twice_rho,
            viscous_factor: both + both,
            w,
            a,
            b,
        }
    }

    /// The constant `x`.
    #[inline(always)]
    pub fn constant(&self, x: f64) -> N {
        self.r2.constant(x)
    }
}

/// Sums beyond force and density rate, kept only for the laws that need them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuxiliarySums<N, const D: usize> {
    /// Concentration gradient ∇C = Σ V_b ∇_a W, 1/m ([`Term::SHIFT`]).
    pub concentration_gradient: [N; D],
    /// ∇·r = −Σ V_b r_ab·∇_a W, – ([`Term::SHIFT`]).
    pub position_divergence: N,
    /// Above zero if a marked particle is within the support ([`Term::SHIFTING_SUPPRESSION`]).
    pub shifting_suppressed: N,
    /// Strain rate S_ij, symmetric, of which `[i][j]` with j ≤ i is kept, 1/s ([`Term::STRESS`]).
    pub strain: [[N; D]; D],
    /// Moment M_ij of the neighbours, symmetric, of which `[i][j]` with j ≤ i is kept, – ([`Term::RENORMALIZATION`]).
    pub renormalization: [[N; D]; D],
}

impl<N: Num, const D: usize> AuxiliarySums<N, D> {
    /// All sums `zero`.
    #[inline(always)]
    pub fn filled_with(zero: N) -> Self {
        Self {
            concentration_gradient: [zero; D],
            position_divergence: zero,
            shifting_suppressed: zero,
            strain: [[zero; D]; D],
            renormalization: [[zero; D]; D],
        }
    }
}

/// The contribution of one neighbour. Each method gets the sum of the terms before it and returns it with
/// its own contribution added; a term without a contribution returns the sum and costs no instruction.
///
/// The force per unit of mass on a is V₀ ∂W (`along_r` r_ab + `along_v` v_ab + `vector`), and the rate of
/// x_a is V₀ ∂W times the first of `rate`, with ∂W = (dW/dr)/r, so that ∇_a W = ∂W r_ab.
pub trait Term<const D: usize>: Copy + Send + Sync {
    /// Whether `along_v` is used.
    const ALONG_V: bool = false;
    /// Whether the sides' `repulsion` is read.
    const REPULSION: bool = false;
    /// Whether the sides' `stress` is read, in `vector`, and the strain summed.
    const STRESS: bool = false;
    /// Whether the sides' `gradient_correction` is read, in `vector`.
    const GRADIENT_CORRECTION: bool = false;
    /// Whether the moment of the neighbours is summed.
    const RENORMALIZATION: bool = false;
    /// Whether the sums of shifting are made.
    const SHIFT: bool = false;
    /// Whether the sides' `shifting_suppressed` is read, and summed.
    const SHIFTING_SUPPRESSION: bool = false;
    /// Whether `auxiliary` is used.
    const AUXILIARY: bool = Self::STRESS || Self::RENORMALIZATION || Self::SHIFT || Self::SHIFTING_SUPPRESSION;
    /// Whether `vector` is used.
    const VECTOR: bool = Self::STRESS || Self::GRADIENT_CORRECTION;

    /// Takes the acceleration of gravity of the next pass, in the units of the pair loop.
    fn set_gravity(&mut self, _gravity: &[f64; D]) {}
    /// Share along r_ab, m²/s²; symmetric under the swap of a and b.
    #[inline(always)]
    fn along_r<N: Num>(&self, _ab: &Pair<N, D>, sum: N) -> N {
        sum
    }
    /// Share along v_ab, m²/s; symmetric.
    #[inline(always)]
    fn along_v<N: Num>(&self, _ab: &Pair<N, D>, sum: N) -> N {
        sum
    }
    /// Share in any direction, m³/s²; antisymmetric.
    #[inline(always)]
    fn vector<N: Num>(&self, _ab: &Pair<N, D>, sum: [N; D]) -> [N; D] {
        sum
    }
    /// Contributions to the rates of x_a and x_b, m²/s.
    #[inline(always)]
    fn rate<N: Num>(&self, _ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
        sum
    }
    /// Contributions to the auxiliary sums of a and b, without the factor V₀ ∂W.
    #[inline(always)]
    fn auxiliary<N: Num>(
        &self,
        _ab: &Pair<N, D>,
        _factor: N,
        _a: &mut AuxiliarySums<N, D>,
        _b: &mut AuxiliarySums<N, D>,
    ) {
    }
}

/// No law.
impl<const D: usize> Term<D> for () {}

macro_rules! tuple_of_terms {
    ($($name:ident $index:tt),+) => {
        impl<const D: usize, $($name: Term<D>),+> Term<D> for ($($name,)+) {
            const ALONG_V: bool = $($name::ALONG_V)|+;
            const REPULSION: bool = $($name::REPULSION)|+;
            const STRESS: bool = $($name::STRESS)|+;
            const GRADIENT_CORRECTION: bool = $($name::GRADIENT_CORRECTION)|+;
            const RENORMALIZATION: bool = $($name::RENORMALIZATION)|+;
            const SHIFT: bool = $($name::SHIFT)|+;
            const SHIFTING_SUPPRESSION: bool = $($name::SHIFTING_SUPPRESSION)|+;
            fn set_gravity(&mut self, gravity: &[f64; D]) {
                $(self.$index.set_gravity(gravity);)+
            }
            #[inline(always)]
            fn along_r<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
                $(let sum = self.$index.along_r(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn along_v<N: Num>(&self, ab: &Pair<N, D>, sum: N) -> N {
                $(let sum = self.$index.along_v(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn vector<N: Num>(&self, ab: &Pair<N, D>, sum: [N; D]) -> [N; D] {
                $(let sum = self.$index.vector(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn rate<N: Num>(&self, ab: &Pair<N, D>, sum: (N, N)) -> (N, N) {
                $(let sum = self.$index.rate(ab, sum);)+
                sum
            }
            #[inline(always)]
            fn auxiliary<N: Num>(&self, ab: &Pair<N, D>, factor: N, a: &mut AuxiliarySums<N, D>, b: &mut AuxiliarySums<N, D>) {
                $(self.$index.auxiliary(ab, factor, a, b);)+
            }
        }
    };
}
tuple_of_terms!(A 0, B 1);
