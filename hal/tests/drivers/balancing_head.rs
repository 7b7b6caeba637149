//! The balancing head: the weight that the angles of both masses make.

use std::f64::consts::TAU;

use driveline::balancing::{BalancingHead, Complex, HeadPosition};
use driveline_hal::TwoMassHead;
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::pwm::{Mock, Transaction};

/// Duties by hand: a weight of none has its masses opposite, the whole capacity both at its angle, half of it 60 degrees
/// to either side; one beyond the capacity is set at it.
#[test]
fn two_masses_make_a_weight() {
    const MASS: f64 = 5e-4;
    for ([re, im], angles) in [
        ([0.0, 0.0], [90.0, 270.0]),
        ([1e-3, 0.0], [0.0, 0.0]),
        ([0.0, 1e-3], [90.0, 90.0]),
        ([-5e-4, 0.0], [240.0, 120.0]),
        ([0.0, -9e-3], [270.0, 270.0]),
    ] {
        let duty = |degrees: f64| (degrees / 360.0 * 36_000.0).round() as u16;
        let channel = |degrees: f64| {
            Mock::new(&[Transaction::max_duty_cycle(36_000), Transaction::set_duty_cycle(duty(degrees))])
        };
        let mut head = TwoMassHead::new(angles.map(channel), MASS as f32);
        head.set(&[Complex::new(re as f32, im as f32)]).unwrap();
        assert_eq!(head.position(), Ok(HeadPosition::Unmeasured));
        head.release().iter_mut().for_each(Mock::done);
        // what the masses make
        let sum: Complex<f64> = angles.map(|degrees| Complex::from_polar(MASS, degrees / 360.0 * TAU)).iter().sum();
        let size = f64::hypot(re, im);
        let wanted = Complex::new(re, im) * if size > 2.0 * MASS { 2.0 * MASS / size } else { 1.0 };
        assert!((sum - wanted).norm() < 1e-15, "{re} {im}: {sum}");
    }
}

/// A failed channel is the head's error.
#[test]
fn a_failed_channel_is_an_error() {
    let failing = Transaction::set_duty_cycle(9_000).with_error(MockError::Io(std::io::ErrorKind::Other));
    let first = Mock::new(&[Transaction::max_duty_cycle(36_000), failing]);
    let mut head = TwoMassHead::new([first, Mock::new(&[])], 5e-4);
    assert!(head.set(&[Complex::new(0.0, 0.0)]).is_err());
    head.release().iter_mut().for_each(Mock::done);
}
