//! A mocked SPI device that can fail, and the transactions that it expects.

use std::collections::BTreeSet;

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::spi::{Mock, Transaction};

/// What a mocked pin or channel fails with.
pub const FAILED: MockError = MockError::Io(std::io::ErrorKind::NotConnected);

/// A mock has no errors on SPI: this one fails instead of asking it.
pub struct Bus {
    mock: Mock<u8>,
    failing: BTreeSet<usize>,
    done: usize,
}

/// What a bus is to expect, transaction by transaction.
#[derive(Default)]
pub struct Expected {
    transactions: Vec<Transaction<u8>>,
    failing: BTreeSet<usize>,
    count: usize,
}

impl Expected {
    pub fn exchange(&mut self, sent: &[u8], answer: &[u8]) {
        self.one(Transaction::transfer_in_place(sent.to_vec(), answer.to_vec()));
    }

    pub fn write(&mut self, sent: &[u8]) {
        self.one(Transaction::write_vec(sent.to_vec()));
    }

    /// A transaction that fails, whatever is sent.
    pub fn failure(&mut self) {
        self.failing.insert(self.count);
        self.count += 1;
    }

    pub fn bus(self) -> Bus {
        Bus { mock: Mock::new(&self.transactions), failing: self.failing, done: 0 }
    }

    fn one(&mut self, transaction: Transaction<u8>) {
        self.transactions.extend([Transaction::transaction_start(), transaction, Transaction::transaction_end()]);
        self.count += 1;
    }
}

impl Bus {
    /// All that was expected has come.
    pub fn done(self) {}
}

/// Where it goes out of use, all that was expected has come.
impl Drop for Bus {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            self.mock.done();
        }
    }
}

impl ErrorType for Bus {
    type Error = ErrorKind;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let number = self.done;
        self.done += 1;
        if self.failing.contains(&number) {
            return Err(ErrorKind::Other);
        }
        self.mock.transaction(operations)
    }
}

impl embedded_hal_async::spi::SpiDevice for Bus {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let number = self.done;
        self.done += 1;
        if self.failing.contains(&number) {
            return Err(ErrorKind::Other);
        }
        embedded_hal_async::spi::SpiDevice::transaction(&mut self.mock, operations).await
    }
}
