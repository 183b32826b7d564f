//! The state of the particles as a device has it: places as whole numbers, velocities in single precision, excess densities as whole
//! numbers.

use super::shaders::EXCESS;
use crate::{math::Vector, model::Model};

/// Number of units of a place in the kernel's support: 2⁴⁰.
const FINE: f64 = (1u64 << 40) as f64;

/// Largest distance of a place from the origin, in supports: an eighth of the distance that fits.
const FARTHEST: f64 = (1 << 20) as f64;

/// How particles are written for a device.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Number of units of a place in a metre, 1/m.
    inv_fine: f64,
    support: f64,
    speed: f64,
    rho0: f64,
}

/// A place: `hi` of three axes and the index, `lo` of three axes and the solid.
pub(super) type Place = [u32; 8];

/// The place with these coordinates, in units of a place.
pub(super) fn place_of<const D: usize>(x: [i64; D]) -> Place {
    let mut place = [0; 8];
    for k in 0..D {
        (place[k], place[4 + k]) = ((x[k] >> 32) as u32, x[k] as u32);
    }
    place
}

impl Layout {
    /// For the particles of `model`.
    pub(super) fn new<const D: usize>(model: &Model) -> Self {
        let (support, units) = (model.support_radius(), model.single_precision_units::<D>());
        Self { inv_fine: FINE / support, support, speed: units.length / units.time, rho0: model.rho0 }
    }

    /// Whether there is a place for `r` (m).
    pub(super) fn reaches<const D: usize>(&self, r: &Vector<D>) -> bool {
        r.amax() < FARTHEST * self.support
    }

    /// The place of a particle at `r` (m).
    pub(super) fn place<const D: usize>(&self, r: &Vector<D>, index: u32, solid: u32) -> Place {
        let mut place = place_of(std::array::from_fn::<_, D, _>(|k| self.fine(r[k])));
        (place[3], place[7]) = (index, solid);
        place
    }

    /// A coordinate (m) in units of a place.
    pub(super) fn fine(&self, x: f64) -> i64 {
        (x * self.inv_fine).round() as i64
    }

    /// The place of `r` (m) moved by as many of these periods (units of a place).
    pub(super) fn place_away<const D: usize>(&self, r: &Vector<D>, periods: [i64; D], periods_away: [i64; D]) -> Place {
        place_of(std::array::from_fn::<_, D, _>(|k| self.fine(r[k]) + periods[k] * periods_away[k]))
    }

    /// Where a particle is, m.
    pub(super) fn position<const D: usize>(&self, place: &[u32]) -> Vector<D> {
        let whole = |k: usize| (i64::from(place[k] as i32) << 32) | i64::from(place[4 + k]);
        Vector::from_fn(|k, _| whole(k) as f64 / self.inv_fine)
    }

    /// Velocity and excess density of a particle with `v` (m/s) and `rho` (kg/m³).
    pub(super) fn motion<const D: usize>(&self, v: &Vector<D>, rho: f64) -> [u32; 4] {
        let mut motion = [0; 4];
        motion[..3].copy_from_slice(&self.velocity_words(v));
        motion[3] = (((rho - self.rho0) / (self.rho0 * EXCESS)).round() as i32) as u32;
        motion
    }

    /// The change of a velocity by `v` (m/s).
    pub(super) fn velocity_words<const D: usize>(&self, v: &Vector<D>) -> [u32; 3] {
        std::array::from_fn(|k| if k < D { ((v[k] / self.speed) as f32).to_bits() } else { 0 })
    }

    /// The velocity, m/s.
    pub(super) fn velocity<const D: usize>(&self, motion: &[u32]) -> Vector<D> {
        Vector::from_fn(|k, _| f64::from(f32::from_bits(motion[k])) * self.speed)
    }

    /// The density, kg/m³.
    pub(super) fn density(&self, motion: &[u32]) -> f64 {
        self.rho0 * (1.0 + f64::from(motion[3] as i32) * EXCESS)
    }

    /// A coordinate (m) in 2⁻⁸ of the support, as `round` does.
    pub(super) fn coarse(&self, x: f64, round: fn(f64) -> f64) -> i32 {
        round(x / self.support * 256.0).clamp(-2e9, 2e9) as i32
    }
}
