//! What flows through a section, and how much has: as wave overtopping over a crest.
//!
//!   q = Σ V_b v_b·n w(s_b),   w(s) = (1 − |s|/a)/a  for |s| < a = 2 dp
//!
//! over the water whose foot lies on the section, s its distance from it. Water in rows dp apart is weighed with 1 in
//! all, wherever the section lies between them.

use super::Probe;
use crate::{
    error::{Error, ErrorKind, Result},
    math::Vector,
    simulation::Simulation,
    system::System,
};

/// Half the thickness over which the flow is taken, over dp.
const HALF: f64 = 2.0;

/// Watches the flow through a section (m³/s; m²/s in 2-D) and the volume (m³; m²) that has gone through since the start,
/// less what has come back.
pub struct FlowProbe<const D: usize> {
    middle: Vector<D>,
    normal: Vector<D>,
    /// Directions of the section's sides and half their lengths, m.
    sides: Vec<(Vector<D>, f64)>,
}

impl<const D: usize> FlowProbe<D> {
    /// The flow through the segment between two points (m) in 2-D, positive to the right of who walks from `from` to `to`:
    /// along x if upwards. In 3-D through the rectangle of which they are opposite corners, positive along the axis to
    /// which it is upright.
    ///
    /// # Errors
    /// `Usage` if there is no such section.
    pub fn new(from: &[f64], to: &[f64]) -> Result<Self> {
        let (from, to) = (super::point::<D>(from, D)?, super::point::<D>(to, D)?);
        let (middle, across) = (0.5 * (from + to), to - from);
        let axis = |i: usize| Vector::<D>::from_fn(|k, _| f64::from(u8::from(k == i)));
        let flat: Vec<usize> = (0..D).filter(|&i| across[i] == 0.0).collect();
        if D == 2 && across.norm() > 0.0 {
            let along = across / across.norm();
            let normal = Vector::from_fn(|i, _| if i == 0 { along[1] } else { -along[0] });
            return Ok(Self { middle, normal, sides: vec![(along, 0.5 * across.norm())] });
        }
        if D == 3 && flat.len() == 1 {
            let sides = (0..D).filter(|i| *i != flat[0]).map(|i| (axis(i), 0.5 * across[i].abs()));
            return Ok(Self { middle, normal: axis(flat[0]), sides: sides.collect() });
        }
        let what = if D == 2 {
            "a section of no length"
        } else {
            "a section in 3-D is a rectangle: its corners have one coordinate in common, and only one"
        };
        Err(Error::new(ErrorKind::Usage, what))
    }

    /// The flow now.
    fn flow(&self, system: &System<D>) -> f64 {
        let (fluid, half) = (system.fluid(), HALF * system.model().dp);
        let mut sum = 0.0;
        for ((r, v), rho) in fluid.r.iter().zip(fluid.v).zip(fluid.rho) {
            let off = minimum_image(r - self.middle, system);
            let s = off.dot(&self.normal).abs();
            if s < half && self.sides.iter().all(|(along, length)| off.dot(along).abs() <= *length) {
                sum += system.particle_mass() / rho * v.dot(&self.normal) * (1.0 - s / half) / half;
            }
        }
        sum
    }
}

/// The way `off` (m), the shortest there is across periodic sides.
fn minimum_image<const D: usize>(mut off: Vector<D>, system: &System<D>) -> Vector<D> {
    for (x, side) in off.iter_mut().zip(system.periodic()) {
        if let Some([from, to]) = side {
            *x -= (to - from) * (*x / (to - from)).round();
        }
    }
    off
}

impl<const D: usize> Probe<D> for FlowProbe<D> {
    fn columns(&self) -> Vec<String> {
        let names = if D == 2 { ["flow_m2ps", "volume_m2"] } else { ["flow_m3ps", "volume_m3"] };
        names.map(String::from).to_vec()
    }

    fn sample(&self, sim: &Simulation<D>) -> Vec<f64> {
        vec![self.flow(sim.system()), 0.0]
    }

    fn continue_from(&self, before: &[f64], now: &mut [f64], dt: f64) {
        now[1] = before[1] + 0.5 * dt * (before[0] + now[0]);
    }

    fn cumulative_columns(&self) -> usize {
        1
    }
}
