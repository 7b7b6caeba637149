//! The CMSDK timer of the MPS2 boards as a counter of instructions, exact in QEMU.
//!
//! Under `-icount shift=10` an instruction takes 2^10 ns of virtual time. The timer runs at 25 MHz, 40 ns a
//! count (20 MHz and 50 ns with an SSE-200), so an instruction is 25.6 counts: n = (40 counts + 512) / 1024. The two
//! reads round by less than a count each, the quotient by less than an instruction. 32 bits last for 167 million
//! instructions.
//!
//! Registers: Arm DDI 0479C, Cortex-M System Design Kit, section 4.3.

use core::ptr;

/// Nanoseconds of virtual time that an instruction takes.
const INSTRUCTION: u64 = 1 << 10;
const ENABLE: u32 = 1;

/// The running timer whose registers begin at `BASE` and whose count takes so many nanoseconds.
pub struct Timer<const BASE: usize, const COUNT: u64>(());

impl<const BASE: usize, const COUNT: u64> Timer<BASE, COUNT> {
    const CTRL: *mut u32 = BASE as *mut u32;
    const VALUE: *mut u32 = (BASE + 0x4) as *mut u32;
    const RELOAD: *mut u32 = (BASE + 0x8) as *mut u32;

    /// Starts it from its largest value.
    pub fn start() -> Self {
        // SAFETY: the registers of TIMER0, which nothing else in an image uses.
        unsafe {
            ptr::write_volatile(Self::CTRL, 0);
            ptr::write_volatile(Self::RELOAD, u32::MAX);
            ptr::write_volatile(Self::VALUE, u32::MAX);
            ptr::write_volatile(Self::CTRL, ENABLE);
        }
        Timer(())
    }

    /// Counts since the start, modulo 2^32; the register counts down.
    #[inline(always)]
    pub fn count(&self) -> u32 {
        // SAFETY: reading VALUE has no side effect.
        !unsafe { ptr::read_volatile(Self::VALUE) }
    }

    /// Instructions in a difference of counts.
    pub const fn instructions(counts: u32) -> u32 {
        ((COUNT * counts as u64 + INSTRUCTION / 2) / INSTRUCTION) as u32
    }
}

/// TIMER0 of the MPS2 boards with a Cortex-M3, M4 or M7, at 25 MHz (Arm DAI 0385D, table 4-1).
pub type Timer0 = Timer<0x4000_0000, 40>;

/// TIMER0 of the MPS2 boards with an SSE-200, at its secure address, at 20 MHz (Arm DAI 0505C, tables 3-1 and 3-4).
pub type SecureTimer0 = Timer<0x5000_0000, 50>;

/// Implements `Board` for a type that wraps a [`Timer`], over semihosting.
macro_rules! qemu_mps2 {
    ($board:ident, $timer:ident) => {
        impl super::interface::Board for $board {
            const FACTS: super::facts::Facts = FACTS;
            const UNIT: &'static str = "instructions";
            type Link = super::semihosting::Pipes;

            fn start() -> Self {
                $board(super::cmsdk_timer::$timer::start())
            }

            #[inline(always)]
            fn count(&self) -> u32 {
                self.0.count()
            }

            fn instructions(counts: u32) -> u32 {
                super::cmsdk_timer::$timer::instructions(counts)
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
