//! TIM6: the control loop's interrupt, every second period of the PWM.

use cortex_m::peripheral::DWT;
use stm32_metapac::{TIM4, TIM6};

use super::clock::CLOCK_HZ;

/// Count of TIM4 where TIM6 is at zero: the last of a tick's conversions is triggered 2.5 us before the next tick, 10
/// us of 12.5 after the start, and is in the memory 1.6 us before it. So an interrupt may be 11 us late and finds the
/// same half of the ring.
const BEAT: u16 = (CLOCK_HZ / 400_000) as u16;

/// Starts the timer, the beat of the conversions and the interrupt, so many ticks a second; the interrupt itself is
/// unmasked by the caller.
pub fn start_tick(rate_hz: u32) {
    start_clock();
    TIM6.psc().write_value(9);
    TIM6.arr().write(|r| r.set_arr((counts(rate_hz) - 1) as u16));
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

/// Periods of the core's clock between two ticks, as [`start_tick`] sets them.
pub const fn tick_clocks(rate_hz: u32) -> u32 {
    counts(rate_hz) * 10
}

/// 170 MHz by ten, so that 260 Hz to 17 MHz fit; a rate of zero is the slowest.
const fn counts(rate_hz: u32) -> u32 {
    match (CLOCK_HZ / 10).checked_div(rate_hz) {
        Some(counts) if counts < 2 => 2,
        Some(counts) if counts < 65_536 => counts,
        _ => 65_536,
    }
}

/// The core's clock, free-running: it times the ticks.
fn start_clock() {
    // SAFETY: nothing else uses the cycle counter, and it is started before the interrupt that reads it.
    let mut core = unsafe { cortex_m::Peripherals::steal() };
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
}

/// The core's clock now.
#[inline(always)]
pub fn clock_now() -> u32 {
    DWT::cycle_count()
}

/// The interrupt is being served.
#[inline(always)]
pub fn tick_taken() {
    TIM6.sr().write(|r| r.set_uif(false));
}
