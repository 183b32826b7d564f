//! Floating at rest (stub: helper "solid" writes this file).
use crate::{error::Result, shape::Shape, space::Pose};
/// Change of height that floats the body.
pub fn equilibrium_height<const D: usize>(
    _shape: &Shape<D>,
    _pose: &Pose<D>,
    _mass: f64,
    _rho0: f64,
    _level: f64,
) -> Result<f64> {
    unimplemented!()
}
