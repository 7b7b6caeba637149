#![no_std]
#![no_main]
//! The control loop in lock-step with a host: an input in, a tick, an output with its instructions out.

use core::mem::MaybeUninit;

use cortex_m_rt::entry;
use driveline_firmware::board::json_line::Line;
use driveline_firmware::board::{Board, Link, ThisBoard};
use driveline_firmware::measure::count::Counter;
use driveline_firmware::measure::stack::Deepest;
use driveline_firmware::scene::{Input, Output, Scene, Variant};

driveline_firmware::selected!();

#[entry]
fn main() -> ! {
    // a static, so that the drive's memory shows in the image's
    static mut DRIVE: MaybeUninit<<Selected as Variant>::Scene> = MaybeUninit::uninit();

    let board = ThisBoard::start();
    let Some(link) = board.open_link() else { board.exit(false) };
    let counter = Counter::new(&board);
    let drive = DRIVE.write(Selected::start());
    let (mut input, mut output) = (Input::default(), Output::default());
    let mut ticks = 0_u32;
    let mut stack = Deepest::painted();
    while link.receive(&mut input) {
        output.instructions = counter.call(driveline_tick, drive, &input, &mut output);
        stack.after_call();
        output.answer = drive.panel(input.asked);
        stack.after_work();
        if !link.send(&output) {
            board.exit(false);
        }
        ticks = ticks.wrapping_add(1);
    }
    let mut line = Line::new()
        .text("control_loop", Selected::NAME)
        .text("board", ThisBoard::FACTS.name)
        .number("ticks", ticks)
        .number("stack", stack.bytes())
        .number("state", size_of::<<Selected as Variant>::Scene>() as u32)
        .number("overhead", counter.overhead());
    board.print(line.finish());
    board.exit(true)
}
