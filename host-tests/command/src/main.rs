//! `cargo driveline`: the command line. See [`cargo_driveline::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    cargo_driveline::cli::main(std::env::args_os())
}
