//! Executable specifications: each test is a sentence about the physics or a contract.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

mod bodies;
mod common;
mod constraints;
mod run;
mod scene;
mod water;
mod waves;
