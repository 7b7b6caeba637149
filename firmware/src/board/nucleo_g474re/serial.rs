//! LPUART1 to the ST-LINK's virtual port: 921,600 baud, 8N1, transmitted from PA2, received on PA3.
//!
//! DMA takes what is received into a ring of 44 ms at the full rate, whatever the main loop does meanwhile. The longest
//! that it does is to send a full ring of records, 28 ms, and the channels' descriptions, 11 ms.

use core::cell::UnsafeCell;
use core::convert::Infallible;
use core::ptr;

use embedded_io::{ErrorType, Write};
use stm32_metapac::bdma::vals::{Dir, Size};
use stm32_metapac::gpio::vals::Pupdr;
use stm32_metapac::{DMA1, DMAMUX1, LPUART1};

use super::clock::CLOCK_HZ;
use super::pin::alternate;
use super::ring_reader::RingReader;

/// Symbols a second.
const BAUD: u64 = 921_600;
/// 256 clocks over symbols (RM0440, LPUART_BRR).
const DIVIDER: u16 = ((CLOCK_HZ as u64 * 256 + BAUD / 2) / BAUD) as u16;
/// Bytes received that wait.
const WAITING: usize = 4096;
/// Channel of DMA1, after those of the vibration.
const CHANNEL: usize = 2;
/// Request to the DMA: LPUART1_RX (RM0440, table of DMAMUX inputs).
const REQUEST: u8 = 34;

/// Buffer of the DMA.
struct Received(UnsafeCell<[u8; WAITING]>);

// SAFETY: written by the DMA alone, read by volatile reads.
unsafe impl Sync for Received {}

static RECEIVED: Received = Received(UnsafeCell::new([0; WAITING]));

/// The port. It blocks while it sends.
pub struct Serial {
    reader: RingReader<WAITING>,
}

impl Serial {
    /// Starts the port.
    pub fn start() -> Self {
        alternate('A', 2, 12, Pupdr::FLOATING);
        alternate('A', 3, 12, Pupdr::PULL_UP);
        DMAMUX1.ccr(CHANNEL).write(|r| r.set_dmareq_id(REQUEST));
        let channel = DMA1.ch(CHANNEL);
        channel.par().write_value(LPUART1.rdr().as_ptr() as u32);
        channel.mar().write_value(RECEIVED.0.get() as u32);
        channel.ndtr().write(|r| r.set_ndt(WAITING as u16));
        channel.cr().write(|r| {
            r.set_dir(Dir::FROM_PERIPHERAL);
            r.set_circ(true);
            r.set_minc(true);
            r.set_psize(Size::BITS8);
            r.set_msize(Size::BITS8);
            r.set_en(true);
        });
        LPUART1.brr().write(|r| r.set_brr(DIVIDER));
        LPUART1.cr3().modify(|r| {
            // no error stops the port: a damaged byte fails the request's check
            r.set_ovrdis(true);
            r.set_dmar(true);
        });
        LPUART1.cr1().modify(|r| {
            r.set_fifoen(true);
            r.set_te(true);
            r.set_re(true);
            r.set_ue(true);
        });
        Serial { reader: RingReader::default() }
    }

    /// The next byte received, where there is one.
    pub fn receive(&mut self) -> Option<u8> {
        let at = self.reader.next(DMA1.ch(CHANNEL).ndtr().read().ndt().into())?;
        // SAFETY: the reader's places are within the ring.
        Some(unsafe { ptr::read_volatile(RECEIVED.0.get().cast::<u8>().add(at)) })
    }
}

/// Sends bytes through the port that was started.
pub(super) fn transmit(bytes: &[u8]) {
    for &byte in bytes {
        while !LPUART1.isr().read().txe() {}
        LPUART1.tdr().write(|r| r.set_dr(byte.into()));
    }
}

impl ErrorType for Serial {
    type Error = Infallible;
}

impl Write for Serial {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        transmit(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while !LPUART1.isr().read().tc() {}
        Ok(())
    }
}
