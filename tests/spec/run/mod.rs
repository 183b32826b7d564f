//! Runs: restart, determinism, step checks, probes, checks and statistics.

mod checks;
mod determinism;
mod gauges;
mod mounted_probes;
mod probes;
mod progress;
mod ranks;
mod rao;
mod readings;
mod restart;
mod statistics;
mod step_checks;
