#![no_std]
#![no_main]
//! Log of the selected scene over the built-in inputs: its name, and every change of its fault flags.

use cortex_m_rt::entry;
use driveline_firmware::Words;
use driveline_firmware::board::{Board, ThisBoard};
use driveline_firmware::scene::{Scene, Variant};
use driveline_firmware::self_test::fingerprint::{SEED, TICKS};
use driveline_firmware::self_test::inputs::Program;

driveline_firmware::selected!();

#[entry]
fn main() -> ! {
    let board = ThisBoard::start();
    let mut drive = Selected::start();
    let mut inputs = Program::new(SEED, const { Words::of::<Selected>() });
    let mut faults = 0;
    defmt::info!("{=str} on {=str}", Selected::NAME, ThisBoard::FACTS.name);
    for tick in 0..TICKS {
        let now = drive.tick(&inputs.next_input()).faults;
        if now != faults {
            defmt::warn!("tick {=u32}: faults {=u32:#x}", tick, now);
            faults = now;
        }
    }
    defmt::info!("{=u32} ticks", TICKS);
    board.exit(true)
}
