//! Executable specifications: each test is a sentence about the physics or a contract.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::print_stderr, reason = "tests may")]

mod bodies;
mod common;
mod constraints;
mod run;
#[path = "../support/run_files.rs"]
mod run_files;
mod scene;
mod water;
mod waves;
