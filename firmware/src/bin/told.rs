#![no_std]
#![no_main]
//! Telemetry of the selected scene over the built-in inputs, as frames to the host's pipe `told` until it is closed.

use cortex_m_rt::entry;
use driveline::telemetry::{Channel, Ring};
use driveline_firmware::Words;
use driveline_firmware::board::{Board, Sink, ThisBoard};
use driveline_firmware::control_loop::telemetry::{VALUES, channels, values};
use driveline_firmware::scene::{Scene, Variant};
use driveline_firmware::self_test::fingerprint::SEED;
use driveline_firmware::self_test::inputs::Program;

driveline_firmware::selected!();

/// Ticks reported: a minute of the drive's time.
const TICKS: u32 = 60 * Selected::RATE_HZ;
/// Ticks between two turns of the main loop, and between two descriptions of the channels.
const TURN: u32 = 16;
const DESCRIBED: u32 = 1024;

/// The words of the link, and what the variant has beside them.
const ALL: usize = VALUES + Selected::CHANNELS.len();
const CHANNELS: [Channel<'static>; ALL] = {
    let (words, more) = (channels::<Selected>(), Selected::CHANNELS);
    let mut all = [words[0]; ALL];
    let mut at = 1;
    while at < ALL {
        all[at] = if at < VALUES { words[at] } else { more[at - VALUES] };
        at += 1;
    }
    all
};

#[entry]
fn main() -> ! {
    static RING: Ring<ALL, 32> = Ring::new();

    let board = ThisBoard::start();
    let Some(mut sink) = Sink::open(c"told") else { board.exit(false) };
    let mut drive = Selected::start();
    let mut inputs = Program::new(SEED, const { Words::of::<Selected>() });
    for tick in 0..TICKS {
        let input = inputs.next_input();
        let words = values(&input, &drive.exchange(&input));
        RING.record(&core::array::from_fn(|at| match words.get(at) {
            Some(word) => *word,
            None => drive.channel(at - VALUES),
        }));
        let described = !tick.is_multiple_of(DESCRIBED) || Channel::send(&CHANNELS, &mut sink).is_ok();
        if !described || (tick.is_multiple_of(TURN) && RING.send(&mut sink).is_err()) {
            break;
        }
    }
    board.exit(true)
}
