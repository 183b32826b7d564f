//! The binary: arguments, progress, exit code. All else is the library.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the program prints")]

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
