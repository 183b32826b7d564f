//! Executable specifications: each test is a sentence about the physics or a contract.

mod buoyancy;
mod checks;
mod coupling;
mod determinism;
mod errors;
mod gauges;
mod guards;
mod hostile;
mod joints;
mod kernels;
mod lanes;
mod laws;
mod light;
mod meshes;
mod near;
mod periodic;
mod preflight;
mod probes;
mod quiet;
mod rig;
mod scenes;
mod schema;
mod statistics;
mod steppers;
