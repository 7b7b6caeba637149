//! TIM6: the control loop's interrupt, every second period of the PWM.

use stm32_metapac::{TIM4, TIM6};

use super::clock::CLOCK_HZ;

/// Count of TIM4 where TIM6 is at zero: the last of a tick's conversions is triggered 2.5 us before the next tick, 10
/// us of 12.5 after the start, and is in the memory 1.6 us before it. So an interrupt may be 11 us late and finds the
/// same half of the ring.
const BEAT: u16 = (CLOCK_HZ / 400_000) as u16;

/// Starts the timer, the beat of the conversions and the interrupt, so many ticks a second; the interrupt itself is
/// unmasked by the caller.
pub fn start_tick(rate_hz: u32) {
    // 170 MHz by ten, so that 260 Hz to 17 MHz fit; a rate of zero is the slowest
    let counts = (CLOCK_HZ / 10).checked_div(rate_hz).unwrap_or(u32::MAX).clamp(2, 65_536);
    TIM6.psc().write_value(9);
    TIM6.arr().write(|r| r.set_arr((counts - 1) as u16));
    TIM6.egr().write(|r| r.set_ug(true));
    tick_taken();
    TIM6.dier().modify(|r| r.set_uie(true));
    TIM4.cnt().write(|r| r.set_cnt(BEAT));
    TIM6.cr1().modify(|r| r.set_cen(true));
    TIM4.cr1().modify(|r| r.set_cen(true));
}

/// Whether the next tick is due already.
#[inline(always)]
pub fn tick_is_due() -> bool {
    TIM6.sr().read().uif()
}

/// The interrupt is being served.
#[inline(always)]
pub fn tick_taken() {
    TIM6.sr().write(|r| r.set_uif(false));
}
