//! The CMSDK timer of the MPS2 boards as a counter of instructions, exact in QEMU.
//!
//! Under `-icount shift=10` an instruction takes 2^10 ns of virtual time. The timer runs at 25 MHz, 40 ns a
//! count, so an instruction is 25.6 counts: n = (10 counts + 128) / 256. The two reads round by less than a count each, the
//! quotient by less than an instruction. 32 bits last for 167 million instructions.
//!
//! Registers: Arm DDI 0479C, Cortex-M System Design Kit, section 4.3.

use core::ptr;

/// TIMER0 of the MPS2 boards (Arm DAI 0385D, table 4-1).
const TIMER0: usize = 0x4000_0000;
const CTRL: *mut u32 = TIMER0 as *mut u32;
const VALUE: *mut u32 = (TIMER0 + 0x4) as *mut u32;
const RELOAD: *mut u32 = (TIMER0 + 0x8) as *mut u32;
const ENABLE: u32 = 1;

/// The running timer.
pub struct Timer(());

impl Timer {
    /// Starts it from its largest value.
    pub fn start() -> Self {
        // SAFETY: the registers of TIMER0, which nothing else in an image uses.
        unsafe {
            ptr::write_volatile(CTRL, 0);
            ptr::write_volatile(RELOAD, u32::MAX);
            ptr::write_volatile(VALUE, u32::MAX);
            ptr::write_volatile(CTRL, ENABLE);
        }
        Timer(())
    }

    /// Counts since the start, modulo 2^32; the register counts down.
    #[inline(always)]
    pub fn count(&self) -> u32 {
        // SAFETY: reading VALUE has no side effect.
        !unsafe { ptr::read_volatile(VALUE) }
    }

    /// Instructions in a difference of counts.
    pub const fn instructions(counts: u32) -> u32 {
        ((10 * counts as u64 + 128) / 256) as u32
    }
}

/// Implements `Board` for a type that wraps a [`Timer`], over semihosting.
macro_rules! qemu_mps2 {
    ($board:ident) => {
        impl super::Board for $board {
            const FACTS: super::Facts = FACTS;
            type Link = super::semihosting::Pipes;

            fn start() -> Self {
                $board(super::cmsdk_timer::Timer::start())
            }

            #[inline(always)]
            fn count(&self) -> u32 {
                self.0.count()
            }

            fn instructions(counts: u32) -> u32 {
                super::cmsdk_timer::Timer::instructions(counts)
            }

            fn open_link(&self) -> Option<Self::Link> {
                super::semihosting::Pipes::open()
            }

            fn print(&self, line: &[u8]) {
                super::semihosting::print(line);
            }

            fn exit(&self, success: bool) -> ! {
                super::semihosting::exit(success)
            }
        }
    };
}
pub(super) use qemu_mps2;
