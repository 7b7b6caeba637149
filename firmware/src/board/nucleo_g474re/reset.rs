//! Why the board was reset last, and the option bytes that it should have: one word of the telemetry.

/// Word in a backup register: a fault of the core ended the last run.
pub const HARD_FAULT: u32 = 0x1d1e_0001;
/// The same, a non-maskable interrupt: the crystal failed, the memory has wrong parity, or the flash a double error.
pub const NMI: u32 = 0x1d1e_0002;

/// Bits of the word. The first eight are bits 24 to 31 of RCC_CSR.
pub mod bits {
    /// Option bytes were loaded.
    pub const OPTION_BYTES: u32 = 1 << 1;
    /// The reset pin; set with every other cause, too.
    pub const PIN: u32 = 1 << 2;
    /// Power on, or a brown-out.
    pub const BROWN_OUT: u32 = 1 << 3;
    /// Software or a debugger.
    pub const SOFTWARE: u32 = 1 << 4;
    /// The independent watchdog.
    pub const WATCHDOG: u32 = 1 << 5;
    /// A fault of the core ended the last run, then the watchdog.
    pub const HARD_FAULT: u32 = 1 << 8;
    /// The crystal, the memory's parity or a double error in the flash ended it, then the watchdog.
    pub const NMI: u32 = 1 << 9;
    /// Option byte: the brown-out level is not 4, 2.8 V.
    pub const BROWN_OUT_LEVEL_LOW: u32 = 1 << 10;
    /// Option byte: the parity of the memory is not checked.
    pub const PARITY_OFF: u32 = 1 << 11;
}

/// The word, from RCC_CSR at the start, FLASH_OPTR and the backup register.
pub const fn word(csr: u32, optr: u32, mark: u32) -> u32 {
    // a supply that has gone leaves a register of anything
    let powered = csr >> 24 & bits::BROWN_OUT == 0;
    let ended = match mark {
        HARD_FAULT if powered => bits::HARD_FAULT,
        NMI if powered => bits::NMI,
        _ => 0,
    };
    let level = if optr >> 8 & 7 == 4 { 0 } else { bits::BROWN_OUT_LEVEL_LOW };
    let parity = if optr >> 24 & 1 == 0 { 0 } else { bits::PARITY_OFF };
    // bit 23 clears the flags, bit 24 is reserved
    (csr >> 24 & 0xfe) | ended | level | parity
}
