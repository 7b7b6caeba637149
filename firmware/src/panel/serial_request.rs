//! A request of a terminal to a board in nine bytes: a number, a key and a value.
//!
//! | byte | |
//! |---|---|
//! | 0 | 0x5a |
//! | 1 | the request's number: one more than the last one's, modulo 256 |
//! | 2 | the key: one of those below, or one of the panel's ([`Key`](crate::scene::panel_keys::Key)) |
//! | 3 to 6 | the value, least significant byte first: an integer, or the bits of an `f32` |
//! | 7, 8 | CRC-16/IBM-3740 of the bytes 0 to 6, most significant byte first, so that it finds every burst of 16 bits |

use crc::{CRC_16_IBM_3740, Crc};

/// Key: 1 permits a start by the button, 0 stops the drive.
pub const RELEASE: u32 = 32;
/// Key: the speed to be held (rad/s), as bits of an `f32`.
pub const SPEED: u32 = 33;
/// Key: the time without a request after which a running drive stops (ms); 0 is none.
pub const TIMEOUT: u32 = 34;
/// Key: this request's number is the first of a new sequence.
pub const SEQUENCE: u32 = 35;

const BEGIN: u8 = 0x5a;
const LENGTH: usize = 9;
const CHECK: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// A request that arrived whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Its number.
    pub number: u8,
    /// Its key.
    pub key: u32,
    /// Its value.
    pub value: u32,
}

/// Finds requests in bytes that may begin anywhere and be damaged anywhere.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asking {
    /// The last bytes, the newest at the end.
    bytes: [u8; LENGTH],
}

impl Asking {
    /// Takes a byte; gives the request that it completes.
    pub fn take(&mut self, byte: u8) -> Option<Request> {
        let [_, begin, number, key, a, b, c, d, high] = self.bytes;
        self.bytes = [begin, number, key, a, b, c, d, high, byte];
        let check = u16::from_be_bytes([high, byte]);
        if begin != BEGIN || CHECK.checksum(&[begin, number, key, a, b, c, d]) != check {
            return None;
        }
        // its bytes are part of no other
        self.bytes = [0; LENGTH];
        Some(Request { number, key: key.into(), value: u32::from_le_bytes([a, b, c, d]) })
    }
}

/// What is to be done with a request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// It is the next one: carry it out.
    Next,
    /// It is the last one again: answer it as before, and do not carry it out a second time.
    Repeated,
    /// Requests before it are missing: refuse it.
    Missing,
}

/// The numbers of the requests.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sequence {
    last: Option<u8>,
}

impl Sequence {
    /// The turn of a request. The first one has any number. One that stops is always carried out.
    pub fn turn(&mut self, request: &Request) -> Turn {
        let stops = request.key == RELEASE && request.value == 0;
        let turn = match self.last {
            _ if stops || request.key == SEQUENCE => Turn::Next,
            Some(last) if request.number == last => Turn::Repeated,
            Some(last) if request.number != last.wrapping_add(1) => Turn::Missing,
            _ => Turn::Next,
        };
        if turn == Turn::Next {
            self.last = Some(request.number);
        }
        turn
    }
}
