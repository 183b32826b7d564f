//! Weight of the water missing beside parts that are thinner than dp.
//!
//! One layer of boundary particles in the middle of a part of thickness t < dp keeps the water dp apart. Beside it water of the
//! thickness dp − t is missing, and the layer is lifted by its weight too much. Each of its particles gets that weight back,
//!
//!   dv_i/dt = g (1 − t/dp) min(1, Σ_f V_f W / F),   F = [`FULLY_WET`],
//!
//! so that loads at rest and drafts are those of the true volume. The motion of the water is not affected.

use rayon::prelude::*;

use super::boundary::FULLY_WET;
use crate::{
    geometry::{Shape, thin::thin_place},
    interaction::PairSums,
    math::Vector,
};

/// The boundary particles in the middle of thin parts.
#[derive(Default)]
pub(super) struct ThinParts {
    /// Index of each, in ascending order, and 1 − t/dp, –.
    particles: Vec<(u32, f64)>,
}

impl ThinParts {
    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.particles.is_empty()
    }

    /// Adds those of `points` (m) at the `depths` (m) below the faces of `shape`, which stand in the arrays `copies` times from
    /// index `first` on.
    pub(super) fn append<const D: usize>(
        &mut self,
        shape: &Shape<D>,
        (points, depths): (&[Vector<D>], &[f64]),
        dp: f64,
        (first, copies): (usize, usize),
    ) {
        let thin = |i: usize| {
            let place =
                (depths[i] < 0.5 * dp * (1.0 - 1e-3)).then(|| thin_place(shape, &points[i], dp, 1e-3 * dp))??;
            Some((i, 1.0 - place.thickness / dp))
        };
        let found: Vec<(usize, f64)> = (0..points.len()).into_par_iter().filter_map(thin).collect();
        for copy in 0..copies {
            let start = first + copy * points.len();
            self.particles.extend(found.iter().map(|(i, share)| ((start + i) as u32, *share)));
        }
    }

    /// Removes those from index `start` to index `end`, which have left the arrays.
    pub(super) fn remove_range(&mut self, start: usize, end: usize) {
        self.particles.retain(|(i, _)| !(start..end).contains(&(*i as usize)));
        for (i, _) in self.particles.iter_mut().filter(|(i, _)| *i as usize >= end) {
            *i -= (end - start) as u32;
        }
    }

    /// Adds the acceleration by the weight of the missing water to `sums`, one for each boundary particle of `wet`, as `wetness` is.
    pub(super) fn add_to<const D: usize>(
        &self,
        sums: &mut [PairSums<D>],
        (wet, wetness): (&[u32], &[f64]),
        gravity: &Vector<D>,
    ) {
        let mut k = 0;
        for (i, share) in &self.particles {
            k += wet[k..].iter().take_while(|w| *w < i).count();
            if wet.get(k) == Some(i) {
                let submerged = wetness.get(k).map_or(0.0, |wetness| (wetness / FULLY_WET).min(1.0));
                sums[k].acceleration += gravity * (share * submerged);
            }
        }
    }
}
