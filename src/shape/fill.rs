//! Filling with water (stub: helper "shape" writes this file).
use crate::{
    error::Result,
    shape::Shape,
    space::{Pose, Vector},
};
/// A body of water.
pub struct Region<const D: usize> {
    pub shape: Shape<D>,
    pub pose: Pose<D>,
}
/// What the filling gave.
pub struct Filled<const D: usize> {
    pub r: Vec<Vector<D>>,
    pub overlapped: usize,
    pub doubled: usize,
}
/// Fills.
pub fn fill<const D: usize>(_regions: &[Region<D>], _solids: &[(&Shape<D>, &Pose<D>)], _dp: f64) -> Result<Filled<D>> {
    unimplemented!()
}
