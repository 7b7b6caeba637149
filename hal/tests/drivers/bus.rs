//! A device on SPI that expects its transactions, and fails where it is told to.

use std::collections::VecDeque;

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use embedded_hal_mock::eh1::MockError;

/// What a mocked pin or channel fails with.
pub const FAILED: MockError = MockError::Io(std::io::ErrorKind::NotConnected);

/// What is sent, and the answer where there is one; none of both where the transaction fails, whatever is sent.
type Transaction = Option<(Vec<u8>, Option<Vec<u8>>)>;

/// The transactions that are still to come; where it goes out of use, all have.
#[derive(Default)]
pub struct Expected(VecDeque<Transaction>);

impl Expected {
    pub fn exchange(&mut self, sent: &[u8], answer: &[u8]) {
        self.0.push_back(Some((sent.to_vec(), Some(answer.to_vec()))));
    }

    pub fn write(&mut self, sent: &[u8]) {
        self.0.push_back(Some((sent.to_vec(), None)));
    }

    /// A transaction that fails, whatever is sent.
    pub fn failure(&mut self) {
        self.0.push_back(None);
    }
}

impl Drop for Expected {
    fn drop(&mut self) {
        assert!(std::thread::panicking() || self.0.is_empty(), "still expected: {:02x?}", self.0);
    }
}

impl ErrorType for Expected {
    type Error = ErrorKind;
}

impl SpiDevice for Expected {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let next = self.0.pop_front().unwrap_or_else(|| panic!("not expected: {operations:02x?}"));
        let (sent, answer) = next.ok_or(ErrorKind::Other)?;
        match (operations, answer) {
            ([Operation::Write(words)], None) => assert_eq!(**words, sent),
            ([Operation::TransferInPlace(words)], Some(answer)) => {
                assert_eq!(**words, sent);
                words.copy_from_slice(&answer);
            }
            other => panic!("{other:02x?}"),
        }
        Ok(())
    }
}
