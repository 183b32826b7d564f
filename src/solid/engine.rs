//! The rigid-body engine behind a trait (stub: helper "solid" writes this file).
/// A dimension.
pub struct Dim<const D: usize>;
/// Dimensions that have an engine.
pub trait HasEngine<const D: usize> {}
#[cfg(feature = "dim2")]
impl HasEngine<2> for Dim<2> {}
#[cfg(feature = "dim3")]
impl HasEngine<3> for Dim<3> {}
