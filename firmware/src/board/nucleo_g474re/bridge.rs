//! TIM1: three phases with their complements at 20 kHz, and a break input that switches them off without the core.
//!
//! | pin | |
//! |---|---|
//! | PA8, PA9, PA10 | phases U, V, W: CH1, CH2, CH3 |
//! | PA7, PB0, PB1 | their complements: CH1N, CH2N, CH3N |
//! | PA6 | BKIN: low switches off, and so does a wire that has broken |
//!
//! Off is low, driven. The core's lockup, a double error in the flash and a supply that fails break, too
//! (SYSCFG), so does a wrong parity of the memory, a crystal that fails (CSS: the input's filter needs a clock), and a
//! debugger that stops the core. A broken output stays off until [`Outputs`] are switched on again. Pins of phases that
//! are not used stay as they are after a reset, analogue.

use core::convert::Infallible;

use driveline::axis::Enabling;
use driveline::fault::Faults;
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32_metapac::gpio::vals::Pupdr;
use stm32_metapac::timer::vals::{Bkp, Cms, FilterValue, Lock, Ocm, Ossi, Ossr};
use stm32_metapac::{DBGMCU, PWR, SYSCFG, TIM1};

use super::clock::CLOCK_HZ;
use super::pin::alternate;
use super::{DEAD_TIME, PHASE_PINS, PWM_HZ, reset};

/// Counts of full duty: up and down again in a period.
const FULL: u16 = (CLOCK_HZ / PWM_HZ / 2) as u16;
/// The dead time as (64 + 21) x 2 clocks (RM0440, DTG of TIMx_BDTR).
const DTG: u8 = 0b1000_0000 | 21;
const _: () = assert!((64 + 21) * 2 == (DEAD_TIME * CLOCK_HZ as f64) as u32);

/// Clocks until MOE is read as it was written.
const SYNCHRONISED: u32 = 16;

/// Starts the timer with one phase or all three, outputs off.
#[inline(always)]
pub fn start(three: bool) {
    DBGMCU.apb2fzr().modify(|r| r.set_tim1(true));
    // the supply below 2.9 V or so: PLS 6
    PWR.cr2().modify(|r| {
        r.set_pls(6);
        r.set_pvde(true);
    });
    TIM1.cr1().modify(|r| {
        r.set_cms(Cms::CENTER_ALIGNED1);
        r.set_arpe(true);
    });
    TIM1.arr().write(|r| r.set_arr(FULL));
    for pair in 0..2 {
        TIM1.ccmr_output(pair).modify(|r| {
            for channel in 0..2 {
                r.set_ocm(channel, Ocm::PWM_MODE1);
                r.set_ocpe(channel, true);
            }
        });
    }
    for channel in 0..if three { 3 } else { 1 } {
        TIM1.ccr(channel).write(|r| r.set_ccr(FULL / 2));
        TIM1.ccer().modify(|r| {
            r.set_cce(channel, true);
            r.set_ccne(channel, true);
        });
    }
    TIM1.bdtr().write(|r| {
        r.set_dtg(DTG);
        r.set_ossr(Ossr::IDLE_LEVEL);
        r.set_ossi(Ossi::IDLE_LEVEL);
        r.set_bkp(0, Bkp::ACTIVE_LOW);
        r.set_bkf(0, FilterValue::FCK_INT_N8);
        r.set_bke(0, true);
        // polarity, dead time and break cannot be changed until the next reset
        r.set_lock(Lock::LEVEL1);
    });
    SYSCFG.cfgr2().modify(|r| {
        r.set_cll(true);
        // acts where the option byte SRAM_PE has the parity checked
        r.set_spl(true);
        r.set_eccl(true);
        r.set_pvdl(true);
    });
    TIM1.egr().write(|r| r.set_ug(true));
    TIM1.cr1().modify(|r| r.set_cen(true));
    alternate('A', 6, 6, Pupdr::PULL_DOWN);
    let [first, second, third] = PHASE_PINS;
    let drive = |pins: [(char, usize); 2]| pins.map(|(port, number)| alternate(port, number, 6, Pupdr::PULL_DOWN));
    drive(first);
    if three {
        drive(second);
        drive(third);
    }
}

/// Whether the outputs are on: MOE, which the hardware clears at a break.
#[inline]
pub fn outputs_are_on() -> bool {
    TIM1.bdtr().read().moe()
}

/// Address of TIM1_BDTR.
const BDTR: u32 = 0x4001_2c44;
/// MOE in it.
const MOE: u32 = 1 << 15;

/// Address of TAMP_BKP0R, which a reset leaves as it is.
const BACKUP: u32 = 0x4000_2500;

/// Defines a handler: the outputs off, again and again; the mark for the next start; the watchdog, which nobody feeds
/// any more, does the rest. It uses no stack, for there may be none.
macro_rules! last_handler {
    ($(#[$text:meta])* $name:ident, $mark:expr) => {
        $(#[$text])*
        #[unsafe(naked)]
        #[unsafe(no_mangle)]
        extern "C" fn $name() -> ! {
            core::arch::naked_asm!(
                "movw r0, {low}",
                "movt r0, {high}",
                "movw r2, {backup_low}",
                "movt r2, {backup_high}",
                "movw r3, {mark_low}",
                "movt r3, {mark_high}",
                "2: ldr r1, [r0]",
                "bic r1, r1, {moe}",
                "str r1, [r0]",
                "str r3, [r2]",
                "b 2b",
                low = const BDTR & 0xffff,
                high = const BDTR >> 16,
                moe = const MOE,
                backup_low = const BACKUP & 0xffff,
                backup_high = const BACKUP >> 16,
                mark_low = const $mark & 0xffff,
                mark_high = const $mark >> 16,
            );
        }
    };
}

last_handler! {
    /// The stack has run out of the memory, or worse.
    HardFault, reset::HARD_FAULT
}
last_handler! {
    /// The crystal has failed, the parity of the memory is wrong, or the flash has a double error.
    NonMaskableInt, reset::NMI
}

/// The outputs as a link of the enable chain.
pub struct Outputs;

impl Enabling for Outputs {
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        if enabled {
            TIM1.sr().write(|r| {
                // writing ones changes nothing
                r.0 = u32::MAX;
                r.set_bif(0, false);
                r.set_sbif(false);
            });
        }
        TIM1.bdtr().modify(|r| r.set_moe(enabled));
        // MOE is read behind a synchroniser, some clocks later than it is written: RM0440, the break function of TIM1
        cortex_m::asm::delay(SYNCHRONISED);
        // the break input holds them off
        if outputs_are_on() == enabled { Ok(()) } else { Err(Faults::ENABLE) }
    }
}

/// A phase: its duty becomes that of its output at the next crest or trough of the PWM, within 25 us.
#[derive(Clone, Copy, Debug)]
pub struct Channel<const NUMBER: usize>;

impl<const NUMBER: usize> ErrorType for Channel<NUMBER> {
    type Error = Infallible;
}

impl<const NUMBER: usize> SetDutyCycle for Channel<NUMBER> {
    #[inline]
    fn max_duty_cycle(&self) -> u16 {
        FULL
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        TIM1.ccr(NUMBER).write(|r| r.set_ccr(duty));
        Ok(())
    }
}
