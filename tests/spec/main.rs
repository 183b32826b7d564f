//! Executable specifications: each test is a sentence about the physics or a contract.

mod books;
mod buoyancy;
mod carried;
mod checks;
mod coupling;
mod determinism;
mod equilibrium;
mod errors;
mod guards;
mod hostile;
mod hosted;
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
mod steppers;
mod waves;
