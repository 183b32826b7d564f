//! Walls: by what density a boundary particle shows itself to the water.

mod dbc;

pub use dbc::Dbc;
