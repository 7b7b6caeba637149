//! The watch on an actuator, against lags by their exact solution.

use driveline::fault::Faults;
use driveline::governor::{ActuatorMonitor, ActuatorMonitorConfig, Trip};
use driveline::number::{Fixed, Number};
use driveline::settings::{ActuatorMonitorSettings, Bases};

use super::SET;

const PERIOD: f64 = 1.0 / 2400.0;
const LAGS: [f64; 2] = [0.1, 0.25];
const SETTINGS: ActuatorMonitorSettings =
    ActuatorMonitorSettings { tolerance: 200.0, max_torque: 1500.0, timeout: 0.01 };
const BASES: Bases = Bases::new(&SET, 2500.0, 210.0);

fn single() -> ActuatorMonitorConfig<f32, 2> {
    ActuatorMonitorConfig::<f32, 2>::new(&LAGS, &SETTINGS, PERIOD, Bases::SI)
}

/// The torque that a step of the command to 1000 N m has come to after so many ticks, through the two lags.
fn step_response(ticks: u32) -> f64 {
    let time = f64::from(ticks) * PERIOD;
    let [valve, chest] = LAGS;
    1000.0 * (1.0 - (chest * (-time / chest).exp() - valve * (-time / valve).exp()) / (chest - valve))
}

/// The expected torque is the lags' step response, in both numbers.
#[test]
fn what_is_expected_is_the_lags_response() {
    let (single, fixed) = (single(), ActuatorMonitorConfig::<Fixed, 2>::new(&LAGS, &SETTINGS, PERIOD, BASES));
    let (mut by_single, mut by_fixed) = (ActuatorMonitor::<f32, 2>::new(), ActuatorMonitor::<Fixed, 2>::new());
    for tick in 0..4800 {
        let wanted = step_response(tick);
        // The second lag follows the end of the first one's tick and not its course: half a tick of 0.4 ms at the
        // steepest, 2200 N m/s, and as much for what f32 loses of small differences.
        assert!((f64::from(by_single.expected()) - wanted).abs() < 1.0, "{tick}: {by_single:?} {wanted}");
        assert!((by_fixed.expected().to_f64() * BASES.torque - wanted).abs() < 1.0, "{tick}: {by_fixed:?} {wanted}");
        by_single.advance(&single, 1000.0);
        by_fixed.advance(&fixed, Fixed::from_f64(1000.0 / BASES.torque));
    }
}

/// What differs by more than the tolerance is replaced and flagged, for the patience; then it is lost, and for what
/// reason.
#[test]
fn what_is_elsewhere_is_replaced_and_then_lost() {
    let config = single();
    for (told, reason) in [
        (201.0, Trip::Actuator),
        (-201.0, Trip::Actuator),
        (1501.0, Trip::SensorLoss),
        (f32::NAN, Trip::SensorLoss),
        (f32::INFINITY, Trip::SensorLoss),
        (f32::NEG_INFINITY, Trip::SensorLoss),
    ] {
        let mut watch = ActuatorMonitor::<f32, 2>::new();
        // 10 ms are 24 ticks.
        for tick in 0..25 {
            assert_eq!(watch.trip(&config), None, "{tick}");
            assert_eq!(watch.check(&config, told), (0.0, Faults::TORQUE));
        }
        assert_eq!(watch.trip(&config), Some(reason), "{told}");
        // However long it lasted, it is found again after one good tick, and forgotten after as many as it took.
        for _ in 0..1000 {
            watch.check(&config, told);
        }
        assert_eq!(watch.check(&config, 199.0), (199.0, Faults::NONE));
        assert_eq!(watch.trip(&config), None);
        for _ in 0..24 {
            watch.check(&config, 0.0);
        }
        for _ in 0..24 {
            watch.check(&config, told);
            assert_eq!(watch.trip(&config), None);
        }
    }
}

/// Every word of fixed point beyond the tolerance is found, those too whose difference wraps.
#[test]
fn no_word_of_fixed_point_passes_for_another() {
    let config = ActuatorMonitorConfig::<Fixed, 2>::new(&LAGS, &SETTINGS, PERIOD, BASES);
    let mut watch = ActuatorMonitor::<Fixed, 2>::new();
    for _ in 0..24_000 {
        watch.advance(&config, Fixed::ONE);
    }
    let expected = watch.expected();
    for word in (0..=u32::MAX).step_by(65_521) {
        let told = Fixed::from_word(word);
        let far = (told.to_f64() - expected.to_f64()).abs() > config.tolerance.to_f64();
        assert_eq!(watch.check(&config, told).1.is_none(), !far, "{told:?}");
    }
}
