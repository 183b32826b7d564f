//! The binary: arguments, progress, exit code. All else is the library.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
