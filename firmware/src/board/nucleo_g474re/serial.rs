//! LPUART1 to the ST-LINK's virtual port: 921,600 baud, 8N1, transmitted from PA2, received on PA3.

use core::convert::Infallible;

use embedded_io::{ErrorType, Write};
use stm32_metapac::LPUART1;
use stm32_metapac::gpio::vals::Pupdr;

use super::clock::CLOCK_HZ;
use super::pin::alternate;

/// Symbols a second.
const BAUD: u64 = 921_600;
/// 256 clocks over symbols (RM0440, LPUART_BRR).
const DIVIDER: u16 = ((CLOCK_HZ as u64 * 256 + BAUD / 2) / BAUD) as u16;
/// Bytes received that wait; a power of two.
const WAITING: usize = 32;

/// The port. It blocks while it sends, and keeps what arrives meanwhile; more than 32 bytes are lost.
pub struct Serial {
    received: [u8; WAITING],
    head: usize,
    tail: usize,
}

impl Serial {
    /// Starts the port.
    pub fn start() -> Self {
        alternate('A', 2, 12, Pupdr::FLOATING);
        alternate('A', 3, 12, Pupdr::PULL_UP);
        LPUART1.brr().write(|r| r.set_brr(DIVIDER));
        // bytes that arrive too fast are overwritten; no error stops the port
        LPUART1.cr3().modify(|r| r.set_ovrdis(true));
        LPUART1.cr1().modify(|r| {
            r.set_fifoen(true);
            r.set_te(true);
            r.set_re(true);
            r.set_ue(true);
        });
        Serial { received: [0; WAITING], head: 0, tail: 0 }
    }

    /// The next byte received, where there is one.
    pub fn receive(&mut self) -> Option<u8> {
        self.poll();
        if self.head == self.tail {
            return None;
        }
        let byte = self.received.get(self.tail % WAITING).copied();
        self.tail = self.tail.wrapping_add(1);
        byte
    }

    fn poll(&mut self) {
        while LPUART1.isr().read().rxne() {
            let byte = LPUART1.rdr().read().dr() as u8;
            if self.head.wrapping_sub(self.tail) < WAITING {
                if let Some(place) = self.received.get_mut(self.head % WAITING) {
                    *place = byte;
                }
                self.head = self.head.wrapping_add(1);
            }
        }
    }
}

impl ErrorType for Serial {
    type Error = Infallible;
}

impl Write for Serial {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        for &byte in bytes {
            while !LPUART1.isr().read().txe() {
                self.poll();
            }
            LPUART1.tdr().write(|r| r.set_dr(byte.into()));
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while !LPUART1.isr().read().tc() {
            self.poll();
        }
        Ok(())
    }
}
