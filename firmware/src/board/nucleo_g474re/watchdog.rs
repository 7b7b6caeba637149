//! IWDG: resets the board where no tick has come to its end for five milliseconds. At a reset every pin floats, and the
//! pull-downs of the wiring hold the drive off.

use stm32_metapac::iwdg::vals::{Key, Pr};
use stm32_metapac::{DBGMCU, IWDG};

/// Counts of 4 / 32 kHz: 5 ms, 50 ticks. The clock is its own, good to 7 % (DS12288).
const COUNTS: u16 = 40;

/// The watchdog, running.
pub struct Watchdog(());

impl Watchdog {
    /// Starts it; it cannot be stopped again.
    pub fn start() -> Self {
        // it waits while a debugger has stopped the core, which switches the outputs off by itself
        DBGMCU.apb1lfzr().modify(|r| r.set_iwdg(true));
        IWDG.kr().write(|r| r.set_key(Key::START));
        IWDG.kr().write(|r| r.set_key(Key::ENABLE));
        IWDG.pr().write(|r| r.set_pr(Pr::DIVIDE_BY4));
        IWDG.rlr().write(|r| r.set_rl(COUNTS - 1));
        while IWDG.sr().read().0 != 0 {}
        let watchdog = Watchdog(());
        watchdog.feed();
        watchdog
    }

    /// Feeds it.
    #[inline(always)]
    pub fn feed(&self) {
        IWDG.kr().write(|r| r.set_key(Key::RESET));
    }
}
