//! Eight lanes of `f32` as a number for laws.

use fearless_simd::{Select, SimdBase, SimdFloat};

use super::Num;
use crate::math::simd::{Simd, f32x8};

impl<S: Simd> Num for f32x8<S> {
    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        Self::splat(self.simd, x as f32)
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self.mul_add(b, c)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        SimdBase::max(self, other)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        SimdBase::min(self, other)
    }
    #[inline(always)]
    fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        self.simd_lt(limit).select(yes, no)
    }
}
