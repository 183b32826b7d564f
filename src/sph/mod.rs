//! The equations: numbers in, numbers out. One law a file; no index, slice, loop or thread.
//!
//! A law states the contribution of a neighbour b to a particle a ([`Term`]) and, where a sum needs it, how
//! the complete sum becomes a value. It is generic over its number type, so that the same text serves
//! the f64 reference and the SIMD lanes.

pub mod continuity;
pub mod density_diffusion;
#[doc(hidden)]
pub mod gradient_correction;
pub mod kernel;
mod simd;
mod fluid_properties;
mod pair;
pub mod pressure;
pub mod particle_shifting;
#[cfg(feature = "gpu")]
pub mod trace;
pub mod equation_of_state;
pub mod viscosity;
pub mod boundary;

pub use fluid_properties::{FluidProperties, Units};
pub use pair::{AuxiliarySums, Num, Pair, PairGeometry, PairSide, Term};
