//! Torque to duty, code and target.

use crate::hoist::Hoist;
use driveline::axis::TorqueOutput;
use driveline::configure::Machine as _;
use driveline::fault::Faults;
use driveline::number::Fixed;
use driveline::settings::Bases;
use driveline_hal::{Dac, FullScale, PhaseConfig, PwmTorque, Scaled, SpiDac, ThreePhase, Tmc4671};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Duty};

use super::bus::{Expected, FAILED};

const FULL: FullScale<f32> = FullScale::<f32>::new(10.0);

/// A torque and the duty of 1000 that it is: half at none, and never beyond the ends.
const DUTIES: [(f32, u16); 7] =
    [(0.0, 500), (5.0, 750), (-5.0, 250), (10.0, 1000), (-10.0, 0), (50.0, 1000), (f32::NEG_INFINITY, 0)];

/// The duties of torques in a number.
fn duties_are_set<N: Scaled>(full: FullScale<N>, all: &[(f32, u16)], number: impl Fn(f32) -> N)
where
    PwmTorque<Pwm, N>: TorqueOutput<N>,
{
    let expected: Vec<_> =
        all.iter().flat_map(|&(_, duty)| [Duty::max_duty_cycle(1000), Duty::set_duty_cycle(duty)]).collect();
    let mut output = PwmTorque::new(Pwm::new(&expected), full);
    for &(torque, _) in all {
        assert_eq!(output.set_torque(number(torque), 0), Ok(()));
    }
    output.release().done();
}

#[test]
fn a_torque_is_a_duty() {
    duties_are_set(FULL, &DUTIES, |torque| torque);
    // fixed point has no infinite torque
    const BASES_OF_TEN: Bases = Bases { torque: 40.0, ..Hoist::<10_000>::BASES };
    let fixed = |torque: f32| Fixed::from_f64(f64::from(torque) / BASES_OF_TEN.torque);
    duties_are_set(FullScale::<Fixed>::new(10.0, BASES_OF_TEN), &DUTIES[..6], fixed);
}

#[test]
fn a_duty_that_fails_is_a_fault_and_half_duty_is_asked_for() {
    let expected =
        [Duty::max_duty_cycle(1000), Duty::set_duty_cycle(750).with_error(FAILED), Duty::set_duty_cycle(500)];
    let mut output = PwmTorque::new(Pwm::new(&expected), FULL);
    assert_eq!(output.set_torque(5.0, 0), Err(Faults::TORQUE_OUTPUT));
    output.release().done();
}

#[test]
fn a_torque_that_is_no_number_is_a_fault_and_no_torque() {
    let expected = [Duty::max_duty_cycle(1000), Duty::set_duty_cycle(500)];
    let mut output = PwmTorque::new(Pwm::new(&expected), FULL);
    assert_eq!(output.set_torque(f32::NAN, 0), Err(Faults::TORQUE_OUTPUT));
    output.release().done();
}

/// Duties of 10000 for a quarter of the voltage, from the definition: a voltage a quarter turn before the field, and
/// the three shifted by half of the largest and the least.
fn duties(fraction: f64, electrical: f64) -> [f64; 3] {
    let third = std::f64::consts::TAU / 3.0;
    let phases = [0.0, third, 2.0 * third].map(|axis| -fraction * (electrical - axis).sin());
    let most = phases.iter().fold(f64::MIN, |a, &b| a.max(b));
    let least = phases.iter().fold(f64::MAX, |a, &b| a.min(b));
    phases.map(|phase| 5000.0 * (1.0 + phase - 0.5 * (most + least)))
}

#[derive(Clone, Default)]
struct Seen(std::rc::Rc<std::cell::Cell<u16>>);

impl embedded_hal::pwm::ErrorType for Seen {
    type Error = core::convert::Infallible;
}

impl embedded_hal::pwm::SetDutyCycle for Seen {
    fn max_duty_cycle(&self) -> u16 {
        10_000
    }
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Self::Error> {
        self.0.set(duty);
        Ok(())
    }
}

#[test]
fn three_duties_make_a_voltage_a_quarter_turn_before_the_field() {
    let config = PhaseConfig { full_scale: FULL, pole_pairs: 4, zero: 1 << 28 };
    let channels = [Seen::default(), Seen::default(), Seen::default()];
    let [a, b, c] = channels.clone();
    let mut bridge = ThreePhase::new((a, b, c), config);
    for step in 0..1000_u32 {
        let angle = step.wrapping_mul(4_294_967);
        let electrical = 4.0 * f64::from(angle.wrapping_sub(1 << 28)) / 4_294_967_296.0 * std::f64::consts::TAU;
        for torque in [2.5, -10.0, 0.0] {
            bridge.set_torque(torque, angle).unwrap();
            for (channel, exact) in channels.iter().zip(duties(f64::from(torque) / 10.0, electrical)) {
                // 1.8e-4 of the sine in two of three phases, half a duty of rounding
                let tolerance = 5000.0 * 2.0 * 1.8e-4 + 0.5;
                assert!((f64::from(channel.0.get()) - exact).abs() < tolerance, "{angle} {torque}");
            }
        }
    }
}

#[test]
fn one_phase_that_fails_takes_the_voltage_off_all() {
    let half =
        [Duty::max_duty_cycle(1000), Duty::set_duty_cycle(500), Duty::max_duty_cycle(1000), Duty::set_duty_cycle(500)];
    let failing = [
        Duty::max_duty_cycle(1000),
        Duty::set_duty_cycle(500).with_error(FAILED),
        Duty::max_duty_cycle(1000),
        Duty::set_duty_cycle(500),
    ];
    let config = PhaseConfig { full_scale: FULL, pole_pairs: 1, zero: 0 };
    let mut bridge = ThreePhase::new((Pwm::new(&half), Pwm::new(&failing), Pwm::new(&half)), config);
    assert_eq!(bridge.set_torque(0.0, 0), Err(Faults::TORQUE_OUTPUT));
    let (mut a, mut b, mut c) = bridge.release();
    a.done();
    b.done();
    c.done();
}

#[test]
fn a_torque_is_a_code_of_either_dac() {
    let mut expected = Expected::default();
    // 24 bits: eight of no meaning or power down, the code: 0x8000 is the middle
    expected.write(&[0, 0x80, 0x00]);
    expected.write(&[0, 0xff, 0xff]);
    expected.write(&[0, 0x40, 0x00]);
    let mut dac = SpiDac::new(expected, Dac::Ad5662, FULL);
    for torque in [0.0, 10.0, -5.0] {
        assert_eq!(dac.set_torque(torque, 0), Ok(()));
    }
    drop(dac.release());
    let mut expected = Expected::default();
    // channel A, not buffered, gain 1, active; then twelve bits
    expected.write(&[0x38, 0x00]);
    expected.write(&[0x3f, 0xff]);
    let mut dac = SpiDac::new(expected, Dac::Mcp4921, FULL);
    for torque in [0.0, 10.0] {
        assert_eq!(dac.set_torque(torque, 0), Ok(()));
    }
}

#[test]
fn a_dac_that_is_not_reached_is_a_fault_and_the_middle_is_asked_for() {
    let mut expected = Expected::default();
    expected.failure();
    expected.write(&[0, 0x80, 0x00]);
    let mut dac = SpiDac::new(expected, Dac::Ad5662, FULL);
    assert_eq!(dac.set_torque(5.0, 0), Err(Faults::TORQUE_OUTPUT));
}

#[test]
fn a_target_is_written_and_read_back() {
    let mut expected = Expected::default();
    expected.write(&[0xe4, 0x40, 0x00, 0, 0]);
    expected.exchange(&[0x64, 0, 0, 0, 0], &[0xff, 0x40, 0x00, 0, 0]);
    // what is read back differs: the target is set to zero
    expected.write(&[0xe4, 0xc0, 0x00, 0, 0]);
    expected.exchange(&[0x64, 0, 0, 0, 0], &[0xff, 0x40, 0x00, 0, 0]);
    expected.write(&[0xe4, 0, 0, 0, 0]);
    expected.exchange(&[0x64, 0, 0, 0, 0], &[0xff, 0, 0, 0, 0]);
    // the bus fails while reading back
    expected.write(&[0xe4, 0xc0, 0x00, 0, 0]);
    expected.failure();
    expected.write(&[0xe4, 0, 0, 0, 0]);
    expected.exchange(&[0x64, 0, 0, 0, 0], &[0xff, 0, 0, 0, 0]);
    let mut drive = Tmc4671::new(expected, FULL);
    assert_eq!(drive.set_torque(5.0, 0), Ok(()));
    assert_eq!(drive.set_torque(-5.0, 0), Err(Faults::TORQUE_OUTPUT));
    assert_eq!(drive.set_torque(-5.0, 0), Err(Faults::TORQUE_OUTPUT));
    drop(drive.release());
}
