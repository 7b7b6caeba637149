//! `cargo driveline`: the command line. See [`host_tests::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    host_tests::cli::main(std::env::args_os())
}
