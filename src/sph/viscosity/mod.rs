//! Viscosities, one a file.

mod artificial;
mod laminar;
mod sps;

pub use artificial::{Artificial, ArtificialTerm};
pub use laminar::{Laminar, LaminarTerm};
pub use sps::{Sps, SpsTerm};
