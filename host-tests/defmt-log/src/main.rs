//! Prints what an image logged through `defmt`, a message a line: the image as the argument, its frames on the input.

use std::io::{Error, Read, stdin};
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs};

use defmt_decoder::{DecodeError, Table};

fn print(image: &Path) -> Result<(), Error> {
    let table = Table::parse(&fs::read(image)?).map_err(Error::other)?;
    let table = table.ok_or_else(|| Error::other("the image logs nothing"))?;
    let mut log = Vec::new();
    stdin().read_to_end(&mut log)?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&log);
    loop {
        match decoder.decode() {
            Ok(frame) => println!("{}", frame.display_message()),
            Err(DecodeError::UnexpectedEof) => return Ok(()),
            Err(DecodeError::Malformed) if table.encoding().can_recover() => println!("(a damaged message)"),
            Err(DecodeError::Malformed) => return Err(Error::other("the log is damaged, or another image's")),
        }
    }
}

fn main() -> ExitCode {
    let Some(image) = env::args_os().nth(1) else {
        eprintln!("usage: driveline-defmt-log IMAGE < FRAMES");
        return ExitCode::from(2);
    };
    match print(Path::new(&image)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", Path::new(&image).display());
            ExitCode::FAILURE
        }
    }
}
