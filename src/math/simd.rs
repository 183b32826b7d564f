//! SIMD numbers of eight lanes: the instruction sets of the processor, loading and storing.
//!
//! The width is eight on every processor, and AVX-512, AVX2 and NEON all have fused multiply-add, so that no sum
//! depends on the instruction set.

pub use fearless_simd::Level;
pub(crate) use fearless_simd::{Simd, f32x8, i32x8};

use fearless_simd::{SimdBase, SimdFrom, SimdMask};

/// Lanes in a number.
pub(crate) const LANES: usize = 8;

/// Eight numbers in a row, aligned so that none is split between cache lines.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(crate) struct LaneRow(pub [f32; LANES]);

/// The SIMD instruction sets of this processor, the fastest first: AVX-512 and AVX2 on x86-64, elsewhere all that the processor
/// has. A processor of 2012 has none.
pub fn instruction_sets() -> Vec<Level> {
    #[cfg(target_arch = "x86_64")]
    {
        let all = Level::new();
        all.as_avx512().map(Level::Avx512).into_iter().chain(all.as_avx2().map(Level::Avx2)).collect()
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        vec![Level::new()]
    }
}

/// The first of [`instruction_sets`].
pub(crate) fn best_instruction_set() -> Option<Level> {
    instruction_sets().first().copied()
}

/// The name of an instruction set.
pub(crate) fn instruction_set_name(level: Level) -> String {
    format!("{level:?}").split('(').next().unwrap_or_default().to_lowercase()
}

/// A task that runs with a given instruction set; everything that `run` calls must be `#[inline(always)]`.
pub(crate) trait SimdTask {
    /// Its result.
    type Output;
    /// Runs it.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Does `work` with the instructions of `level`, one that [`instruction_sets`] gave.
pub(crate) fn dispatch<W: SimdTask>(level: Level, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        // Two instruction sets are compiled and not four: the sweeps are most of the program's compile time.
        if let Level::Avx512(simd) = level {
            return simd.vectorize(
                #[inline(always)]
                || work.run(simd),
            );
        }
        let Some(simd) = level.as_avx2() else { unreachable!("lanes are made where AVX2 is") };
        simd.vectorize(
            #[inline(always)]
            || work.run(simd),
        )
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        fearless_simd::dispatch!(level, simd => work.run(simd))
    }
}

/// Loads the numbers of a row.
#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, from: &[f32; LANES]) -> f32x8<S> {
    f32x8::simd_from(simd, *from)
}

/// Loads the whole numbers of a row.
#[inline(always)]
pub(crate) fn load_integers<S: Simd>(simd: S, from: &[i32; LANES]) -> i32x8<S> {
    i32x8::simd_from(simd, *from)
}

/// Whether a lane of `x` is below that of `limit`.
#[inline(always)]
pub(crate) fn any_below<S: Simd>(x: f32x8<S>, limit: f32x8<S>) -> bool {
    x.simd_lt(limit).any_true()
}

/// The sum of all lanes, always in the same order.
#[inline(always)]
pub(crate) fn sum_lanes<S: Simd>(x: f32x8<S>) -> f32 {
    let x = x.as_slice();
    ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
}

/// The largest of all lanes.
#[inline(always)]
pub(crate) fn max_lane<S: Simd>(x: f32x8<S>) -> f32 {
    x.as_slice().iter().fold(f32::NEG_INFINITY, |a, &b| if b > a { b } else { a })
}
