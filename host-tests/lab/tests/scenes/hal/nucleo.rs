//! The parts of the board with a motor that need none of its registers: the operator, the terminal's requests, the
//! ring of the terminal's bytes, the last reset, the outputs.

use std::convert::Infallible;

use driveline::axis::TorqueOutput;
use driveline_firmware::board::nucleo_g474re::reset::{HARD_FAULT, NMI, bits, word};
use driveline_firmware::board::nucleo_g474re::ring_reader::RingReader;
use driveline_firmware::board::nucleo_g474re::{DEAD_TIME, PHASE_PINS, PWM_HZ, full_scale};
use driveline_firmware::panel::operator::{Operator, PERMIT, STANDS};
use driveline_firmware::panel::serial_request::{Asking, RELEASE, Request, SEQUENCE, SPEED, Sequence, Turn};
use driveline_firmware::scene::panel_keys::{DONE, refused};
use driveline_hal::{FullScale, PhaseConfig, PwmTorque, ThreePhase};
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use proptest::prelude::*;

/// CRC-16/IBM-3740, bit by bit: polynomial 0x1021, begun with 0xffff.
fn crc(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |crc: u16, byte| {
        (0..8).fold(crc ^ u16::from(*byte) << 8, |crc, _| crc << 1 ^ if crc & 0x8000 == 0 { 0 } else { 0x1021 })
    })
}

/// The nine bytes, from the description of the frame.
fn frame(number: u8, key: u32, value: u32) -> Vec<u8> {
    let mut frame = vec![0x5a, number, u8::try_from(key).unwrap()];
    frame.extend(value.to_le_bytes());
    frame.extend(crc(&frame).to_be_bytes());
    frame
}

fn asked(bytes: &[u8]) -> Vec<Request> {
    let mut asking = Asking::default();
    bytes.iter().filter_map(|byte| asking.take(*byte)).collect()
}

#[test]
fn requests_are_found_among_other_bytes() {
    // the catalogue's check value of this CRC
    assert_eq!(crc(b"123456789"), 0x29b1);
    let value = 30.0_f32.to_bits();
    let speed = frame(7, SPEED, value);
    // 0x5a alone, twice, and a frame that is cut short
    let bytes = [&[0x5a, 1, 0x5a], &speed[..], &speed[..4], &speed[..]].concat();
    assert_eq!(asked(&bytes), [Request { number: 7, key: SPEED, value }; 2]);
}

/// The bytes that the book prints permit a start.
#[test]
fn the_book_permits_a_start() {
    let book = include_str!("../../../../../doc/makers/boards.md");
    let printed = book.lines().find_map(|line| line.strip_prefix("printf '")?.strip_suffix("' > /dev/ttyACM0"));
    let bytes: Vec<u8> =
        printed.unwrap().split("\\x").skip(1).map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect();
    let mut sequence = Sequence::default();
    let found = asked(&bytes);
    assert_eq!(found.iter().map(|request| request.key).collect::<Vec<_>>(), [SEQUENCE, RELEASE]);
    assert_eq!(found[1].value, 1);
    assert!(found.iter().all(|request| sequence.turn(request) == Turn::Next));
}

proptest! {
    /// A CRC of 16 bits finds every burst of up to 16 bits.
    #[test]
    fn a_damaged_request_is_none(number: u8, key in 0_u32..256, value: u32, at in 0_usize..8, burst in 1_u16..) {
        let mut bytes = frame(number, key, value);
        prop_assert_eq!(asked(&bytes), [Request { number, key, value }]);
        for (byte, damage) in bytes[at..].iter_mut().zip(burst.to_le_bytes()) {
            *byte ^= damage;
        }
        prop_assert_eq!(asked(&bytes), Vec::<Request>::new());
    }

    /// Bytes of any kind, with whole requests among them, start nothing without the button.
    #[test]
    fn no_bytes_start_the_drive(keys in prop::collection::vec((any::<u8>(), any::<u32>()), 0..200), rests: bool) {
        let mut operator = Operator::new(rests);
        for (key, value) in keys {
            match (key % 4, value) {
                (0, _) => operator.permit(),
                (1, _) => operator.stop(),
                (2, ms) => { operator.set_timeout(ms); }
                _ => operator.answered(value),
            }
            for _ in 0..value % 300 {
                prop_assert!(!operator.tick(rests));
            }
        }
    }

    /// The DMA writes while the reader is away, up to one byte less than the ring holds.
    #[test]
    fn a_ring_loses_nothing(away in prop::collection::vec(0_usize..16, 0..100)) {
        const SIZE: usize = 16;
        let mut reader = RingReader::<SIZE>::default();
        let (mut ring, mut written, mut read) = ([0_usize; SIZE], 0, 0);
        for bytes in away {
            for _ in 0..bytes {
                ring[written % SIZE] = written;
                written += 1;
            }
            while let Some(at) = reader.next(SIZE - written % SIZE) {
                prop_assert_eq!(ring[at], read);
                read += 1;
            }
            prop_assert_eq!(read, written);
        }
    }
}

#[test]
fn a_request_is_carried_out_once_and_in_its_turn() {
    let mut sequence = Sequence::default();
    let mut turn = |number, key, value| sequence.turn(&Request { number, key, value });
    assert_eq!(turn(254, SPEED, 0), Turn::Next);
    assert_eq!(turn(255, SPEED, 0), Turn::Next);
    assert_eq!(turn(0, SPEED, 0), Turn::Next);
    assert_eq!(turn(0, SPEED, 0), Turn::Repeated);
    assert_eq!(turn(2, SPEED, 0), Turn::Missing);
    assert_eq!(turn(2, RELEASE, 1), Turn::Missing);
    assert_eq!(turn(1, SPEED, 0), Turn::Next);
    // a stop at any time, and a new sequence
    assert_eq!(turn(77, RELEASE, 0), Turn::Next);
    assert_eq!(turn(77, RELEASE, 0), Turn::Next);
    assert_eq!(turn(5, SEQUENCE, 0), Turn::Next);
    assert_eq!(turn(6, SPEED, 0), Turn::Next);
}

/// An operator with a button that is low at rest.
struct Desk(Operator);

impl Desk {
    /// Runs some ticks; whether the drive is released after the last one.
    fn ticks(&mut self, ticks: u32, level: bool) -> bool {
        (0..ticks).map(|_| self.0.tick(level)).last().unwrap()
    }

    /// Presses the button, with bouncing, and lets it go.
    fn press(&mut self) -> bool {
        for level in [true, false, true, false] {
            self.ticks(STANDS - 1, level);
        }
        self.ticks(STANDS, true);
        for level in [false, true, false, true] {
            self.ticks(STANDS - 1, level);
        }
        self.ticks(STANDS, false)
    }

    fn running() -> Desk {
        let mut desk = Desk(Operator::new(false));
        desk.0.permit();
        assert!(desk.press());
        desk
    }
}

#[test]
fn a_start_needs_the_command_then_the_button() {
    let mut desk = Desk(Operator::new(false));
    assert!(!desk.press(), "no command");
    desk.0.permit();
    assert!(!desk.ticks(PERMIT, false), "no button");
    assert!(!desk.press(), "too late");
    // a button that was held when the command came
    desk.ticks(STANDS, true);
    desk.0.permit();
    desk.ticks(STANDS, true);
    assert!(!desk.ticks(STANDS, false));
    assert!(desk.press(), "the next press");
    // a permit is for one start
    desk.0.stop();
    assert!(!desk.press());
    // a permit that was withdrawn
    desk.0.permit();
    desk.ticks(STANDS, true);
    desk.0.stop();
    assert!(!desk.ticks(STANDS, false));
}

#[test]
fn a_contact_counts_when_it_has_stood_for_ten_milliseconds() {
    let mut desk = Desk(Operator::new(false));
    desk.0.permit();
    desk.ticks(STANDS - 1, true);
    assert!(!desk.ticks(2 * STANDS, false), "too short a press");
    desk.ticks(STANDS, true);
    assert!(!desk.ticks(STANDS - 1, false));
    assert!(desk.ticks(1, false));
    // one that stops does so at once, and its release starts nothing
    assert!(!desk.ticks(1, true));
    desk.ticks(STANDS, true);
    assert!(!desk.ticks(10 * STANDS, false));
}

/// A terminal that sends without end, and is refused each time, does not keep the drive running.
#[test]
fn refused_requests_keep_no_drive_running() {
    for number in [0, 1, 44, 97, 98] {
        let mut desk = Desk::running();
        desk.0.set_timeout(500);
        desk.0.answered(DONE);
        for _ in 0..50 {
            desk.0.answered(refused(number));
            assert!(desk.ticks(100, false));
        }
        desk.0.answered(refused(number));
        assert!(!desk.ticks(1, false), "{number}");
    }
    // a figure that was read counts
    let mut desk = Desk::running();
    desk.0.set_timeout(500);
    for _ in 0..50 {
        desk.0.answered(1.5_f32.to_bits());
        assert!(desk.ticks(5_000, false));
    }
}

#[test]
fn a_line_that_goes_dead_stops_a_running_drive_if_so_set() {
    let mut desk = Desk::running();
    assert!(desk.ticks(1_000_000, false), "no time-out was set");
    assert!(desk.0.set_timeout(500));
    desk.0.answered(DONE);
    // 500 ms at 10 kHz
    assert!(desk.ticks(5_000, false));
    assert!(!desk.ticks(1, false));
    desk.0.answered(DONE);
    assert!(!desk.ticks(100, false), "it starts again by the operator alone");
    let mut desk = Desk::running();
    desk.0.set_timeout(500);
    for _ in 0..100 {
        desk.0.answered(DONE);
        assert!(desk.ticks(5_000, false));
    }
    assert!(!desk.0.set_timeout(60_001), "above a minute");
    assert!(!desk.ticks(5_001, false), "the time-out is as it was");
}

#[test]
fn the_last_reset_and_the_option_bytes_are_one_word() {
    // RM0440: BOR_LEV is bits 8 to 10 of FLASH_OPTR, SRAM_PE bit 24, low where the parity is checked
    let good = 4 << 8;
    // RCC_CSR: PINRSTF 26, BORRSTF 27, SFTRSTF 28, IWDGRSTF 29
    let [pin, supply, software, watchdog] = [26, 27, 28, 29].map(|bit| 1 << bit);
    assert_eq!(word(pin | supply, good, 0), bits::PIN | bits::BROWN_OUT);
    assert_eq!(word(pin | software | 3, good, 0), bits::PIN | bits::SOFTWARE);
    assert_eq!(word(pin | watchdog, good, HARD_FAULT), bits::PIN | bits::WATCHDOG | bits::HARD_FAULT);
    assert_eq!(word(pin | watchdog, good, NMI), bits::PIN | bits::WATCHDOG | bits::NMI);
    // the supply was away: the register's content says nothing
    assert_eq!(word(supply, good, HARD_FAULT), bits::BROWN_OUT);
    // as delivered
    assert_eq!(word(pin, 0xffef_f8aa, 0), bits::PIN | bits::BROWN_OUT_LEVEL_LOW | bits::PARITY_OFF);
}

/// A channel that keeps its duty.
struct Duty<'a>(&'a std::cell::Cell<u16>);

const FULL: u16 = 4_250;

impl ErrorType for Duty<'_> {
    type Error = Infallible;
}

impl SetDutyCycle for Duty<'_> {
    fn max_duty_cycle(&self) -> u16 {
        FULL
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.set(duty);
        Ok(())
    }
}

/// Share of the period that a dead time takes of every pulse.
const DEAD: f64 = DEAD_TIME * PWM_HZ as f64;

/// Mean of the difference of two complementary outputs: each pulse begins later by the dead time, and one that is
/// shorter is lost.
fn difference(duty: f64) -> f64 {
    let pulse = |share: f64| if share == 1.0 { 1.0 } else { (share - DEAD).max(0.0) };
    pulse(duty) - pulse(1.0 - duty)
}

#[test]
fn the_torque_stays_out_of_the_flats_that_the_dead_time_makes() {
    let limit = 5.0;
    let linearity = |full: f64| {
        let duty = std::cell::Cell::new(0);
        let mut output = PwmTorque::<_, f32>::new(Duty(&duty), FullScale::<f32>::new(full));
        (-100..=100).map(|i| limit * f64::from(i) / 100.0).fold(0.0_f64, |worst, torque| {
            output.set_torque(torque as f32, 0).unwrap();
            worst.max((difference(f64::from(duty.get()) / f64::from(FULL)) - torque / full).abs())
        })
    };
    // half a count of the duty, twice, and the rounding of the fraction
    let count = 1.0 / f64::from(FULL) + 1.0 / 32_768.0;
    assert!(linearity(full_scale(limit)) < count, "{}", linearity(full_scale(limit)));
    // what the test can see: without the allowance it is off by up to a dead time, just before the end
    assert!(linearity(limit) > 0.5 * DEAD, "{}", linearity(limit));
}

/// Three voltages that are moved into the middle fill 0.866 of the bridge, and leave 0.067 at either end.
#[test]
fn the_bridge_has_no_flats_at_full_torque() {
    let duties = [const { std::cell::Cell::new(0) }; 3];
    let [a, b, c] = duties.each_ref().map(Duty);
    let config = PhaseConfig { full_scale: FullScale::<f32>::new(1.0), pole_pairs: 1, zero: 0 };
    let mut bridge = ThreePhase::new((a, b, c), config);
    let flat = (DEAD * f64::from(FULL)).ceil() as u16;
    for angle in (0..1_000_u32).map(|i| i * 4_294_967) {
        bridge.set_torque(1.0, angle).unwrap();
        for duty in &duties {
            assert!((flat..=FULL - flat).contains(&duty.get()), "{} at {angle}", duty.get());
        }
    }
}

/// Of the timer's outputs the image drives the two that the wiring has, and its comment names them.
#[test]
fn outputs_without_a_function_are_not_driven() {
    let book = include_str!("../../../../../doc/makers/boards.md");
    let name = |(port, number)| format!("P{port}{number}");
    let driven = PHASE_PINS.map(|pins| pins.map(|pin| book.contains(&format!("| {}, TIM1_CH", name(pin)))));
    assert_eq!(driven, [[true; 2], [false; 2], [false; 2]]);
    let source = include_str!("../../../../../firmware/src/board/nucleo_g474re/nucleo.rs");
    assert!(source.contains("Self::with(counts_per_turn, false, PwmTorque"), "one phase for the torque input");
}
