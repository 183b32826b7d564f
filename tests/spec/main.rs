//! Executable specifications: each test is a sentence about the physics or a contract.

mod coupling;
mod determinism;
mod errors;
mod kernels;
mod laws;
mod near;
mod quiet;
mod rig;
mod steppers;
