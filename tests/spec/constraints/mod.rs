//! Joints, ropes, forces and prescribed motions.

mod events;
mod hinge_loads;
mod joints;
mod moorings;
mod prescribed_motions;
mod taut_lines;
