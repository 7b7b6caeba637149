#![no_std]
#![no_main]
//! The fingerprint of the selected scene over the built-in inputs, to be compared with the host's.

use driveline_firmware::Words;
use driveline_firmware::board::json_line::Line;
use driveline_firmware::board::{Board, ThisBoard};
use driveline_firmware::scene::Variant;
use driveline_firmware::self_test::fingerprint;

driveline_firmware::selected!();

#[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
#[cfg_attr(target_arch = "riscv32", unsafe(no_mangle))]
fn main() -> ! {
    let board = ThisBoard::start();
    let mut line = Line::new()
        .text("self_test", Selected::NAME)
        .text("board", ThisBoard::FACTS.name)
        .number("ticks", fingerprint::TICKS)
        .hex("fingerprint", fingerprint::of_run(&mut Selected::start(), const { Words::of::<Selected>() }));
    board.print(line.finish());
    board.exit(true)
}
