//! Prints what an image logged through `defmt`, a message a line: the image as the argument, its frames on the input.

use std::io::{Error, Read, stdin};
use std::{env, fs};

use defmt_decoder::Table;

fn main() -> Result<(), Error> {
    let image = env::args_os().nth(1).ok_or_else(|| Error::other("an image is expected as the argument"))?;
    let table = Table::parse(&fs::read(image)?).map_err(Error::other)?;
    let table = table.ok_or_else(|| Error::other("the image logs nothing"))?;
    let mut log = Vec::new();
    stdin().read_to_end(&mut log)?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&log);
    while let Ok(frame) = decoder.decode() {
        println!("{}", frame.display_message());
    }
    Ok(())
}
