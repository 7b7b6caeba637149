#![no_std]
#![no_main]
//! Instructions of the functions in the bench's table, as lines of JSON.

use cortex_m_rt::entry;
use driveline_firmware::Words;
use driveline_firmware::bench::{self, Bench};
use driveline_firmware::board::{Board, ThisBoard};
use driveline_firmware::scene::Variant;
use driveline_firmware::self_test::fingerprint::SEED;
use driveline_firmware::self_test::inputs::Program;

driveline_firmware::selected!();

#[entry]
fn main() -> ! {
    let board = ThisBoard::start();
    let inputs = Program::new(SEED, const { Words::of::<Selected>() });
    bench::run::<Selected, _>(&mut Bench::new(&board, Selected::NAME, inputs), driveline_tick);
    board.exit(true)
}
