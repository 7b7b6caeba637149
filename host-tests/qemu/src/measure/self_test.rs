//! The same bits on the host and in QEMU.

use std::error::Error;
use std::time::Duration;

use driveline_firmware::board::Facts;
use driveline_firmware::scenes::find;
use driveline_firmware::self_test::fingerprint;

use crate::image::{Program, build};
use crate::link;

/// Longest run: ten thousand ticks take a fraction of a second.
const LIMIT: Duration = Duration::from_secs(60);

/// Builds the self-test of `variant` for `board`, runs it, and compares its fingerprint with the host's; gives the
/// fingerprint, 16 hexadecimal digits.
pub fn self_test(variant: &str, board: Facts) -> Result<String, Box<dyn Error>> {
    let row = find(variant).ok_or_else(|| format!("no variant is called `{variant}`"))?;
    let on_host = format!("{:016x}", fingerprint::of_run(&mut row.start(), row.words()));
    let image = build(variant, board, Program::SelfTest, |_| {})?;
    let lines = link::run(&image, LIMIT)?.lines;
    let in_qemu = lines.first().and_then(|line| line["fingerprint"].as_str()).unwrap_or("no fingerprint");
    if in_qemu == on_host {
        Ok(on_host)
    } else {
        Err(format!("{variant}: {in_qemu} in QEMU on {}, {on_host} on the host", board.name).into())
    }
}
