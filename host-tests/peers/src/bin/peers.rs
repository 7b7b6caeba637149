#![no_std]
#![no_main]
//! One observer in lock-step with a host: an input in, a tick, an output with its instructions out. The first input's
//! request says which: scene and observer in the key, their corner as the value.

use cortex_m_rt::entry;
use driveline_firmware::board::json_line::Line;
use driveline_firmware::board::{Board, Link, ThisBoard};
use driveline_firmware::measure::count::Counter;
use driveline_firmware::measure::stack::Deepest;
use driveline_firmware::scene::{Input, Output};
use driveline_peers::{PEERS, Replayed, SCENES, Visitor, with};

/// The crates here can panic: an image that runs in QEMU alone may.
#[unsafe(no_mangle)]
extern "C" fn panic_is_reachable() -> ! {
    loop {}
}

#[inline(never)]
fn tick<R: Replayed>(observer: &mut R, input: &Input, output: &mut Output) {
    observer.tick(input, output);
}

/// The loop round an observer, to the end of the link.
struct Served<'b, L> {
    board: &'b ThisBoard,
    link: L,
    name: &'static str,
}

impl<L: Link> Visitor for Served<'_, L> {
    type Output = ();

    fn visit<R: Replayed>(self, mut observer: R) {
        let counter = Counter::new(self.board);
        let (mut input, mut output) = (Input::default(), Output::default());
        if !self.link.send(&output) {
            self.board.exit(false);
        }
        let mut ticks = 0_u32;
        let mut stack = Deepest::painted();
        while self.link.receive(&mut input) {
            if input.flags & Input::RELEASED == 0 {
                observer.start(&input);
                output.instructions = 0;
            } else {
                output.instructions = counter.call(tick::<R>, &mut observer, &input, &mut output);
                stack.after_call();
            }
            if !self.link.send(&output) {
                self.board.exit(false);
            }
            stack.after_work();
            ticks = ticks.wrapping_add(1);
        }
        let mut line = Line::new()
            .text("control_loop", self.name)
            .text("board", ThisBoard::FACTS.name)
            .number("ticks", ticks)
            .number("stack", stack.bytes())
            .number("state", size_of::<R>() as u32)
            .number("overhead", counter.overhead())
            .number("function", tick::<R> as fn(&mut R, &Input, &mut Output) as usize as u32);
        self.board.print(line.finish());
        self.board.exit(true)
    }
}

#[entry]
fn main() -> ! {
    let board = ThisBoard::start();
    let Some(link) = board.open_link() else { board.exit(false) };
    let mut input = Input::default();
    if !link.receive(&mut input) {
        board.exit(false);
    }
    let [key, value] = input.asked;
    let (scene, peer) = ((key >> 8) as usize, (key & 0xff) as usize);
    let Some(scene) = SCENES.get(scene) else { board.exit(false) };
    let served = Served { board: &board, link, name: PEERS.get(peer).copied().unwrap_or_default() };
    let _ = with(scene, peer, f32::from_bits(value), served);
    board.exit(false)
}
