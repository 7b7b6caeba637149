//! `cargo lab`: the command line. See [`driveline_lab::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    driveline_lab::cli::main(std::env::args_os())
}
