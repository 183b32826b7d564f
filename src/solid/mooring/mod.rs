//! Mooring lines with mass: elastic catenaries, and lumped-mass lines at rest and in motion.
//!
//! `forces` and `segment` have the equations, `line` their integration in time, `network` the points in which lines meet,
//! `equilibrium` and `catenary` the line at rest, and `attached` the line on the solids of a running system. No function here
//! knows the particles: the coupling provides the surroundings of each node.

mod attached;
mod catenary;
mod equilibrium;
mod forces;
mod line;
mod network;
mod pretension;
mod segment;
mod specification;
mod winch;

pub(crate) use attached::Mooring;
pub use attached::MooringReading;
pub(crate) use forces::{BedPlane, NodeSurroundings};
pub(crate) use line::{LineState, MooringLine};
pub(crate) use network::{Junctions, LineStep};
pub(crate) use pretension::{end_stiffness_at_rest, forces_at_rest};
pub use specification::{ClumpSpec, LineDamping, LineType, MooringPointSpec, MooringSpec};
pub(crate) use specification::{SHORTEST_SHARE, check_mooring, check_mooring_points, junctions};
pub use winch::{Winch, WinchTarget};

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/mooring/references.rs"]
mod references;

#[cfg(all(test, feature = "dim2", feature = "dim3"))]
#[path = "../../../tests/unit/solid/mooring/sample.rs"]
mod sample;
