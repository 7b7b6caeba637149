//! A request of a terminal to a board in seven bytes: a key and a value.
//!
//! | byte | |
//! |---|---|
//! | 0 | 0x5a |
//! | 1 | the key: [`RELEASE`], [`SPEED`], or one of the panel's ([`Key`](crate::scene::panel_keys::Key)) |
//! | 2 to 5 | the value, least significant byte first: an integer, or the bits of an `f32` |
//! | 6 | sum of the bytes 0 to 5, modulo 256 |

/// Key: 1 releases the drive, 0 stops it.
pub const RELEASE: u32 = 32;
/// Key: the speed to be held (rad/s), as bits of an `f32`.
pub const SPEED: u32 = 33;

const BEGIN: u8 = 0x5a;
const LENGTH: usize = 7;

/// Finds requests in bytes that may begin anywhere and be damaged anywhere.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asking {
    /// The last bytes, the newest at the end.
    bytes: [u8; LENGTH],
}

impl Asking {
    /// Takes a byte; gives the key and the value that it completes.
    pub fn take(&mut self, byte: u8) -> Option<[u32; 2]> {
        let [_, rest @ ..] = self.bytes;
        let [b, c, d, e, f, g] = rest;
        self.bytes = [b, c, d, e, f, g, byte];
        let sum = rest.iter().fold(0_u8, |sum, byte| sum.wrapping_add(*byte));
        if b != BEGIN || sum != byte {
            return None;
        }
        // its bytes are part of no other
        self.bytes = [0; LENGTH];
        Some([c.into(), u32::from_le_bytes([d, e, f, g])])
    }
}
