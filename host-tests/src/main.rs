//! The command line: `driveline check [--json] [--only STEP]`.

use std::process::ExitCode;

use host_tests::check::{Options, run};

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mut options = Options::default();
    let mut known = arguments.next().as_deref() == Some("check");
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--json" => options.json = true,
            "--only" => options.only = arguments.next(),
            _ => known = false,
        }
    }
    if !known {
        eprintln!("usage: driveline check [--json] [--only STEP]");
        return ExitCode::from(2);
    }
    match run(&options) {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
