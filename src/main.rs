//! The binary: arguments and exit code. All else is the library.

fn main() -> std::process::ExitCode {
    pontoon::cli::main(std::env::args_os()).into()
}
