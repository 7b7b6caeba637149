//! Telemetry: a record of every tick at a fixed cost, framed over `embedded-io`.
//!
//! The tick puts a record of `VALUES` words into a ring ([`Ring::record`]); the main loop takes records out and sends
//! them as frames ([`Ring::send`]). A record that finds the ring full is dropped and counted; the tick never waits, and
//! takes the same instructions whether the record is kept or not. That is why the ring is our own: a queue of
//! `heapless` takes another way where it is full. It holds words of 32 bits, which even a Cortex-M0+ loads and stores
//! as a whole, and needs neither a lock nor unsafe code.
//!
//! # Frames
//! A frame is a packet after consistent overhead byte stuffing [Cheshire, Baker 1999], and a zero. A packet ends with
//! the CRC-16 of its preceding bytes (polynomial 0x1021, begun with 0xffff, most significant bit first), all words
//! least significant byte first. The first byte is the kind of the packet; each field is followed by its bytes:
//!
//! - **record**, kind 1: number of the tick, 4; records dropped before it, 4; each value, 4.
//! - **channel**, kind 2: its index, 1; number of channels, 1; type, 1 (0 `f32`, 1 integer); factor of an integer as
//!   `f32`, 4; length of its name, 1; name; unit.
//!
//! The number of the tick counts dropped records, too: a gap in it is as long as it was.

mod frame;
mod record;
mod ring;

pub use frame::{Channel, Kind};
pub use record::Record;
pub use ring::Ring;
