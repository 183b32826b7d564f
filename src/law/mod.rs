//! The equations: numbers in, numbers out. One law a file; no index, slice, loop or thread.
//!
//! A law says what one neighbour b contributes to a particle a ([`Term`]) and, where a sum needs it, how
//! the finished sum becomes a value (`close`). It is generic over its number, so that the same text serves
//! the f64 oracle and SIMD lanes.

pub mod continuity;
pub mod diffusion;
pub mod gradient;
pub mod kernel;
mod lanes;
mod medium;
mod pair;
pub mod pressure;
pub mod shifting;
pub mod state;
pub mod viscosity;
pub mod wall;

pub use medium::{Medium, Units};
pub use pair::{Extra, Num, Pair, Side, Term};
