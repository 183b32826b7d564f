//! The equations: numbers in, numbers out. One law a file; no index, slice, loop or thread.
//!
//! A law states the contribution of a neighbour b to a particle a ([`Term`]) and, where a sum needs it, how
//! the complete sum becomes a value. It is generic over its number type, so that the same text serves
//! the f64 reference and the SIMD lanes.

pub mod continuity;
pub mod density_diffusion;
pub(crate) mod gradient_correction; //NARROW
pub mod kernel;
mod simd;
mod fluid_properties;
mod pair;
pub mod pressure;
pub(crate) mod particle_shifting; //NARROW
pub(crate) mod equation_of_state; //NARROW
pub mod viscosity;
pub mod boundary;

pub(crate) use fluid_properties::FluidProperties; //NARROW
pub(crate) use fluid_properties::Units; //NARROW
pub(crate) use pair::AuxiliarySums; //NARROW
pub use pair::Num;
pub use pair::Pair;
pub(crate) use pair::PairSide; //NARROW
pub use pair::Term;
