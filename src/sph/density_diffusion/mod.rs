//! Density diffusions, one a file. They act between water particles only: a wall's density is not
//! the water's to smooth.

mod fourtakas;
mod molteni;

pub use fourtakas::{Fourtakas, FourtakasTerm};
pub use molteni::Molteni;
