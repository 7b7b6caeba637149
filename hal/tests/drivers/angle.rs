//! The angle from a counter and from a magnetic encoder.

use driveline::axis::AngleSensor;
use driveline::fault::Faults;
use driveline_hal::{Chip, Counter, MagneticEncoder, Quadrature};

use super::bus::Expected;

/// Counts as a list, `None` where the counter fails.
pub struct Counts(pub std::vec::IntoIter<Option<u32>>);

impl Counter for Counts {
    type Error = ();
    fn count(&mut self) -> Result<u32, ()> {
        self.0.next().flatten().ok_or(())
    }
}

fn counts(counts: impl IntoIterator<Item = Option<u32>>) -> Counts {
    Counts(counts.into_iter().collect::<Vec<_>>().into_iter())
}

const MISSING: Result<u32, Faults> = Err(Faults::ANGLE_MISSING);

#[test]
fn counts_are_an_angle_over_the_counters_end_and_the_turns() {
    // 10,000 counts a turn, 16 bits: neither is a multiple of the other
    let mut position = 65_000_i64;
    let mut all = vec![Some(65_000)];
    let mut exact = vec![0];
    let mut turned = 0_i64;
    for step in 0..5_000_i64 {
        let move_by = if step < 3_000 { 137 } else { -4_999 };
        position += move_by;
        turned += move_by;
        all.push(Some(position.rem_euclid(65_536) as u32));
        exact.push(((i128::from(turned.rem_euclid(10_000)) << 32) / 10_000) as u32);
    }
    let mut encoder = Quadrature::new(counts(all), 10_000, 16);
    for (step, exact) in exact.into_iter().enumerate() {
        let angle = encoder.angle().unwrap();
        // the reciprocal is cut off: a count of 2^-32 turn at most
        assert!(exact.wrapping_sub(angle) <= 1, "{step}: {angle} {exact}");
    }
}

#[test]
fn counts_of_a_power_of_two_are_exact() {
    let mut encoder = Quadrature::new(counts([Some(7), Some(8), Some(7), Some(6)]), 8192, 32);
    let angles: Vec<_> = (0..4).map(|_| encoder.angle().unwrap() as i32 as i64).collect();
    // cut off by the reciprocal's last place where the position is not zero
    assert_eq!(angles, [0, (1 << 19) - 1, 0, -(1 << 19) - 1]);
}

#[test]
fn a_counter_that_fails_gives_no_angle_and_the_next_one_is_right() {
    let mut encoder = Quadrature::new(counts([Some(0), Some(100), None, Some(300)]), 1000, 16);
    assert_eq!(encoder.angle(), Ok(0));
    let hundred = encoder.angle().unwrap();
    assert_eq!(encoder.angle(), MISSING);
    // three times the angle, but for what is cut off
    assert!((3 * hundred).abs_diff(encoder.angle().unwrap()) <= 3);
}

#[test]
fn an_index_off_its_place_is_one_missing_angle() {
    let all = [Some(0), Some(990), Some(1990), Some(2993), Some(2993)];
    let mut encoder = Quadrature::new(counts(all), 1000, 16);
    encoder.angle().unwrap();
    encoder.index(500);
    encoder.angle().unwrap();
    // a turn on, and a count beside it: the edge of the index
    encoder.index(1501);
    assert!(encoder.angle().is_ok());
    encoder.index(2504);
    assert_eq!(encoder.angle(), MISSING);
    assert!(encoder.angle().is_ok());
}

/// An index of 1000 counts a turn, seen once a turn; what each turn's count is off, and what the reading after it says.
fn turns(offs: impl IntoIterator<Item = i64>) -> (Vec<bool>, i32) {
    let offs: Vec<i64> = offs.into_iter().collect();
    let place = |turn: usize| (1000 * turn as i64 + 500 + offs[turn]).rem_euclid(65_536) as u32;
    // read a little before the index, and a little after it
    let around = |turn: usize| [-20, 20].map(|by| Some(place(turn).wrapping_add_signed(by) & 0xffff));
    let mut encoder = Quadrature::new(counts((0..offs.len()).flat_map(around)), 1000, 16);
    let mut told = Vec::new();
    for turn in 0..offs.len() {
        assert!(encoder.angle().is_ok());
        encoder.index(place(turn));
        told.push(encoder.angle() == MISSING);
    }
    (told, encoder.slipped())
}

#[test]
fn counts_that_slip_one_by_one_are_told() {
    // one a turn: every second turn they are two, and are told
    for direction in [1, -1] {
        let (told, slipped) = turns((0..101).map(|turn| direction * turn));
        assert_eq!(told.iter().filter(|&&told| told).count(), 50);
        assert!((0..101).all(|turn| told[turn] == (turn > 0 && turn % 2 == 0)), "{told:?}");
        assert_eq!(slipped, 100 * direction as i32);
    }
}

#[test]
fn an_index_between_two_counts_is_no_slip() {
    let (told, slipped) = turns((0..100).map(|turn| i64::from(turn % 3 == 1) - i64::from(turn % 7 == 3)).skip(2));
    assert_eq!((told.iter().any(|&told| told), slipped), (false, 0));
}

#[test]
fn a_slip_is_told_once_and_the_next_one_again() {
    let (told, slipped) = turns([0, 0, 3, 3, 4, 3, 1, 1, 500, 500]);
    assert_eq!(told, (0..10).map(|turn| [2, 6, 8].contains(&turn)).collect::<Vec<_>>());
    // half a turn and a count less: 3, then back by 2, then on by 499
    assert_eq!(slipped, 3 - 2 + 499);
}

/// The frames of a magnetic encoder, an AS5047P.
#[derive(Default)]
pub struct Frames {
    pub expected: Expected,
    primed: bool,
}

/// A line of ones makes the word's parity even by its top bit.
pub fn even(word: u16) -> u16 {
    word | (word.count_ones() as u16 % 2) << 15
}

/// Reads of `ANGLECOM`, `DIAAGC` and `ERRFL`, with their parity [AS5047P datasheet, tables 11 and 13].
const ANGLE: [u8; 2] = [0xff, 0xff];
const DIAGNOSIS: [u8; 2] = [0xff, 0xfc];
const ERRORS: [u8; 2] = [0x40, 0x01];
/// The offset is compensated, a gain in the middle.
const SOUND: u16 = 0x0180;

/// What goes wrong in a reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrong {
    Bus,
    Parity,
    ErrorBit,
    Magnet,
    Strong,
    Overflow,
    Low,
    High,
}

impl Frames {
    fn prime(&mut self) {
        if !self.primed {
            // the answer is to nothing that was asked
            self.expected.exchange(&DIAGNOSIS, &[0x12, 0x34]);
            self.primed = true;
        }
    }

    pub fn good(&mut self, counts: u16) {
        self.prime();
        self.expected.exchange(&ANGLE, &even(SOUND).to_be_bytes());
        self.expected.exchange(&DIAGNOSIS, &even(counts).to_be_bytes());
    }

    pub fn wrong(&mut self, counts: u16, wrong: Wrong) {
        self.prime();
        let (state, angle) = match wrong {
            Wrong::Bus => {
                self.expected.failure();
                self.expected.exchange(&ERRORS, &[0, 0]);
                self.primed = false;
                return;
            }
            Wrong::Parity => (even(SOUND), even(counts) ^ 0x0010),
            Wrong::ErrorBit => (even(SOUND), even(counts | 0x4000)),
            // too weak: the gain is at its end
            Wrong::Magnet => (even(SOUND | 0x08ff), even(counts)),
            // MAGH and COF alone [AS5047P datasheet, table 13]
            Wrong::Strong => (even(SOUND | 1 << 10), even(counts)),
            Wrong::Overflow => (even(SOUND | 1 << 9), even(counts)),
            Wrong::Low => (0, 0),
            Wrong::High => (0xffff, 0xffff),
        };
        self.expected.exchange(&ANGLE, &state.to_be_bytes());
        if wrong != Wrong::High {
            self.expected.exchange(&DIAGNOSIS, &angle.to_be_bytes());
        }
        if !matches!(wrong, Wrong::Magnet | Wrong::Strong | Wrong::Overflow | Wrong::Low) {
            self.expected.exchange(&ERRORS, &[0, 0]);
            self.primed = false;
        }
    }
}

#[test]
fn a_magnetic_encoder_gives_its_fourteen_bits() {
    let mut frames = Frames::default();
    let all = [0, 1, 0x1fff, 0x2000, 0x3fff];
    all.iter().for_each(|&counts| frames.good(counts));
    let mut encoder = MagneticEncoder::new(frames.expected, Chip::As5047P);
    for counts in all {
        assert_eq!(encoder.angle(), Ok(u32::from(counts) << 18));
    }
    drop(encoder.release());
}

#[test]
fn the_older_chip_has_its_diagnosis_elsewhere() {
    let mut expected = Expected::default();
    // 0x7ffd has an even number of ones
    expected.exchange(&[0x7f, 0xfd], &[0, 0]);
    expected.exchange(&ANGLE, &even(SOUND).to_be_bytes());
    expected.exchange(&[0x7f, 0xfd], &even(1234).to_be_bytes());
    let mut encoder = MagneticEncoder::new(expected, Chip::As5048A);
    assert_eq!(encoder.angle(), Ok(1234 << 18));
}

#[test]
fn whatever_is_wrong_there_is_no_angle_and_the_next_one_is_new() {
    let magnet = [Wrong::Magnet, Wrong::Strong, Wrong::Overflow];
    let bus = [Wrong::Bus, Wrong::Parity, Wrong::ErrorBit, Wrong::Low, Wrong::High];
    for wrong in magnet.into_iter().chain(bus) {
        let mut frames = Frames::default();
        frames.good(100);
        frames.wrong(200, wrong);
        frames.good(300);
        let mut encoder = MagneticEncoder::new(frames.expected, Chip::As5047P);
        assert_eq!(encoder.angle(), Ok(100 << 18));
        assert_eq!(encoder.angle(), MISSING, "{wrong:?}");
        assert_eq!(encoder.angle(), Ok(300 << 18), "{wrong:?}");
    }
}

#[test]
fn every_flipped_bit_of_an_answer_is_seen() {
    for bit in 0..16 {
        let mut expected = Expected::default();
        expected.exchange(&DIAGNOSIS, &[0, 0]);
        expected.exchange(&ANGLE, &even(SOUND).to_be_bytes());
        expected.exchange(&DIAGNOSIS, &(even(0x1234) ^ 1 << bit).to_be_bytes());
        expected.exchange(&ERRORS, &[0, 0]);
        let mut encoder = MagneticEncoder::new(expected, Chip::As5047P);
        assert_eq!(encoder.angle(), MISSING, "bit {bit}");
    }
}
