//! The board for the bench: a counter of cycles and a terminal. All pins but the terminal's stay as after a reset.

use cortex_m::Peripherals;
use cortex_m::peripheral::DWT;

use super::clock;
use super::serial::{Serial, transmit};
use crate::board::facts::Facts;
use crate::board::interface::{Board, Link};
use crate::scene::{Input, Output};

/// The board: cycles at 170 MHz by the core's counter (Arm DDI 0403E, C1.8.8), with the flash's wait states, caches and
/// prefetch as the drive's image sets them.
pub struct NucleoG474re(());

impl Board for NucleoG474re {
    const FACTS: Facts = super::FACTS;
    const UNIT: &'static str = "cycles";
    type Link = NoLink;

    fn start() -> Self {
        clock::start();
        let _ = Serial::start();
        // SAFETY: nothing else in an image of the bench uses the core's peripherals.
        let mut core = unsafe { Peripherals::steal() };
        core.DCB.enable_trace();
        core.DWT.enable_cycle_counter();
        NucleoG474re(())
    }

    #[inline(always)]
    fn count(&self) -> u32 {
        DWT::cycle_count()
    }

    fn instructions(counts: u32) -> u32 {
        counts
    }

    fn open_link(&self) -> Option<NoLink> {
        None
    }

    fn print(&self, line: &[u8]) {
        transmit(line);
    }

    /// Waits for the reset button.
    fn exit(&self, _: bool) -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }
}

/// No host in lock-step: there is none of this type.
pub enum NoLink {}

impl Link for NoLink {
    fn receive(&self, _: &mut Input) -> bool {
        match *self {}
    }

    fn send(&self, _: &Output) -> bool {
        match *self {}
    }
}
