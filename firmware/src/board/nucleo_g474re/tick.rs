//! TIM6: the control loop's interrupt, every second period of the PWM.

use stm32_metapac::TIM6;

use super::clock::CLOCK_HZ;

/// Starts the timer and its interrupt, so many ticks a second; the interrupt itself is unmasked by the caller.
pub fn start_tick(rate_hz: u32) {
    // 170 MHz by ten, so that 260 Hz to 17 MHz fit; a rate of zero is the slowest
    let counts = (CLOCK_HZ / 10).checked_div(rate_hz).unwrap_or(u32::MAX).clamp(2, 65_536);
    TIM6.psc().write_value(9);
    TIM6.arr().write(|r| r.set_arr((counts - 1) as u16));
    TIM6.egr().write(|r| r.set_ug(true));
    tick_taken();
    TIM6.dier().modify(|r| r.set_uie(true));
    TIM6.cr1().modify(|r| r.set_cen(true));
}

/// The interrupt is being served.
#[inline(always)]
pub fn tick_taken() {
    TIM6.sr().write(|r| r.set_uif(false));
}
