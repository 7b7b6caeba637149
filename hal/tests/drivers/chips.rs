//! Chips that answer, on a bus that fails or waits where it is told to: one of the kind that is blocked on, and one
//! that is awaited.

use std::cell::RefCell;
use std::rc::Rc;

use embedded_hal::spi::{ErrorKind, ErrorType, Operation};

/// A chip on SPI: a transfer's bytes go in and its answer comes out.
pub trait Chip {
    fn transfer(&mut self, words: &mut [u8]);
}

/// What has been seen on a bus.
#[derive(Default)]
pub struct Seen {
    /// Every transaction that was begun: what was sent.
    pub sent: Vec<Vec<u8>>,
    /// The number of the transaction that fails, before the chip sees it.
    pub failing: Option<usize>,
}

/// A bus with a chip. Awaited, every transaction waits once before the chip sees it and once after.
pub struct Wired<C> {
    pub chip: Rc<RefCell<C>>,
    pub seen: Rc<RefCell<Seen>>,
}

impl<C> Clone for Wired<C> {
    fn clone(&self) -> Self {
        Wired { chip: self.chip.clone(), seen: self.seen.clone() }
    }
}

impl<C: Chip> Wired<C> {
    pub fn new(chip: C, failing: Option<usize>) -> Self {
        let seen = Seen { sent: Vec::new(), failing };
        Wired { chip: Rc::new(RefCell::new(chip)), seen: Rc::new(RefCell::new(seen)) }
    }

    fn exchange(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let [operation] = operations else { panic!("one operation a transaction") };
        let sent = match operation {
            Operation::Write(words) => words.to_vec(),
            Operation::TransferInPlace(words) => words.to_vec(),
            other => panic!("{other:?}"),
        };
        let mut seen = self.seen.borrow_mut();
        seen.sent.push(sent.clone());
        if seen.failing == Some(seen.sent.len() - 1) {
            return Err(ErrorKind::Other);
        }
        let mut answer = sent;
        self.chip.borrow_mut().transfer(&mut answer);
        if let Operation::TransferInPlace(words) = operation {
            words.copy_from_slice(&answer);
        }
        Ok(())
    }
}

impl<C> ErrorType for Wired<C> {
    type Error = ErrorKind;
}

impl<C: Chip> embedded_hal::spi::SpiDevice for Wired<C> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        self.exchange(operations)
    }
}

impl<C: Chip> embedded_hal_async::spi::SpiDevice for Wired<C> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        pause().await;
        let exchanged = self.exchange(operations);
        pause().await;
        exchanged
    }
}

/// Waits once.
pub async fn pause() {
    let mut waited = false;
    std::future::poll_fn(|_| {
        if waited {
            return std::task::Poll::Ready(());
        }
        waited = true;
        std::task::Poll::Pending
    })
    .await;
}

/// Polls a future so many times, and drops it: what it gave by then.
pub fn polled<T>(future: impl Future<Output = T>, times: usize) -> Option<T> {
    let mut future = std::pin::pin!(future);
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    (0..times).find_map(|_| match future.as_mut().poll(&mut context) {
        std::task::Poll::Ready(value) => Some(value),
        std::task::Poll::Pending => None,
    })
}

/// Polls a future to its end.
pub fn awaited<T>(future: impl Future<Output = T>) -> T {
    polled(future, 1000).expect("a future of these tests ends within a thousand polls")
}

/// An AS5047P: the answer to a command comes with the next frame [AS5047P datasheet, tables 8 to 13].
pub struct As5047P {
    /// 14 bits.
    pub angle: u16,
    /// `DIAAGC`.
    pub diagnosis: u16,
    /// Set in every answer until `ERRFL` is read.
    pub error: bool,
    answer: u16,
}

impl As5047P {
    /// With the offset compensated and a gain in the middle; its first answer is of no meaning.
    pub fn at(angle: u16) -> Self {
        As5047P { angle, diagnosis: 0x0180, error: false, answer: 0x0abc }
    }
}

impl Chip for As5047P {
    fn transfer(&mut self, words: &mut [u8]) {
        let command = u16::from_be_bytes(words.try_into().expect("a frame of 16 bits"));
        assert!(command.count_ones() % 2 == 0 && command & 0x4000 != 0, "{command:04x}");
        words.copy_from_slice(&super::angle::even(self.answer).to_be_bytes());
        let data = match command & 0x3fff {
            0x3fff => self.angle,
            0x3ffc => self.diagnosis,
            0x0001 => {
                self.error = false;
                0
            }
            register => panic!("{register:04x}"),
        };
        self.answer = data | u16::from(self.error) << 14;
    }
}

/// An ADXL355 whose sample is taken by the read of its data [ADXL355 datasheet, tables 16, 17 and 24 to 26].
pub struct Adxl355 {
    /// Counts of z.
    pub z: i32,
    pub ready: bool,
}

impl Chip for Adxl355 {
    fn transfer(&mut self, words: &mut [u8]) {
        match words {
            [0x01, identity @ ..] => identity.copy_from_slice(&[0xad, 0x1d, 0xed]),
            [0x09, data @ ..] => {
                data.fill(0);
                data[0] = u8::from(std::mem::take(&mut self.ready));
                data[10..].copy_from_slice(&(self.z << 12).to_be_bytes()[..3]);
            }
            [0x58 | 0x50 | 0x5a, _] => {}
            other => panic!("{other:02x?}"),
        }
    }
}

/// The target of a TMC4671, and what takes the codes of a DAC.
#[derive(Default)]
pub struct Taker {
    pub taken: [u8; 4],
    /// The target does not change any more.
    pub stuck: bool,
}

impl Chip for Taker {
    fn transfer(&mut self, words: &mut [u8]) {
        match words {
            [0xe4, target @ ..] if !self.stuck => self.taken.copy_from_slice(target),
            [0xe4, ..] => {}
            [0x64, data @ ..] => data.copy_from_slice(&self.taken),
            [0, high, low] | [high, low] => self.taken = [*high, *low, 0, 0],
            other => panic!("{other:02x?}"),
        }
    }
}

/// A power stage.
#[derive(Default)]
pub struct Stage {
    pub enabled: bool,
}

impl driveline::axis::Enabling for Stage {
    fn set_enabled(&mut self, enabled: bool) -> Result<(), driveline::fault::Faults> {
        self.enabled = enabled;
        Ok(())
    }
}
