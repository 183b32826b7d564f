//! The equations: numbers in, numbers out. One law a file; no index, slice, loop or thread.

pub mod diffusion;
pub mod shifting;
pub mod viscosity;
