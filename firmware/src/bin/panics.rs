#![no_std]
#![no_main]
//! An image in which a panic can be reached, by an index known only at run time: it must not link.

use core::hint::black_box;

use cortex_m_rt::entry;
use driveline_firmware::board::{Board, ThisBoard};

#[entry]
fn main() -> ! {
    let board = ThisBoard::start();
    let table = black_box([1_u8, 2, 3, 4]);
    let index = black_box(5_usize);
    board.print(&[table[index]]);
    board.exit(true)
}
