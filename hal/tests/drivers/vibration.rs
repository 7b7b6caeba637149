//! Vibration from an ADXL355 and from conversions.

use driveline::axis::{Axis, TRIPPING, VibrationSensor};
use driveline::balancing::{Phasors, PhasorsConfig, Reading, ReadingFault};
use driveline::drive::{Config, Drive};
use driveline::fault::Faults;
use driveline::governor::SpeedLoop;
use driveline::number::Fixed;
use driveline::settings::PhasorSettings;
use driveline_hal::{AdcVibration, Adxl355, Along, PerCount, Range};

use super::bus::Expected;
use super::scripted;

pub const MISSING: Result<Option<f32>, Faults> = Err(Faults::VIBRATION_MISSING);
const CLIPPED: Result<Option<f32>, Faults> = Err(Faults::VIBRATION_CLIPPED);
const PER_COUNT: PerCount<f32> = PerCount::<f32>::new(Range::G2.per_count());

/// The chip says who it is and takes its settings [ADXL355 datasheet, tables 17, 43, 46 and 47].
pub fn started(expected: &mut Expected) {
    started_at(expected, 0x81);
}

/// The same with the word of a range.
fn started_at(expected: &mut Expected, range: u8) {
    expected.exchange(&[0x01, 0, 0, 0], &[0, 0xad, 0x1d, 0xed]);
    expected.write(&[0x58, range]);
    expected.write(&[0x50, 0x00]);
    expected.write(&[0x5a, 0x00]);
}

/// A burst with a status and the counts of z.
pub fn burst(expected: &mut Expected, status: u8, z: i32) {
    let [z2, z1, z0, _] = (z << 12).to_be_bytes();
    let sent = [0x09, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    expected.exchange(&sent, &[0, status, 0, 7, 0x67, 1, 2, 3, 4, 5, 6, z2, z1, z0]);
}

pub fn sensor(expected: Expected) -> Adxl355<Expected, f32> {
    Adxl355::start(expected, Along::Z, Range::G2, PER_COUNT, 3).map_err(|(faults, _)| faults).unwrap()
}

#[test]
fn a_sample_is_an_acceleration_once() {
    let mut expected = Expected::default();
    started(&mut expected);
    burst(&mut expected, 1, 256_000);
    burst(&mut expected, 0, 256_000);
    burst(&mut expected, 1, -128_000);
    let mut sensor = sensor(expected);
    // a g at 256,000 counts, to the digits of an f32
    assert!((sensor.vibration().unwrap().unwrap() - 9.806_65).abs() < 1e-6);
    assert_eq!(sensor.vibration(), Ok(None));
    assert!((sensor.vibration().unwrap().unwrap() + 0.5 * 9.806_65).abs() < 1e-6);
    drop(sensor.release());
}

/// Each range has its own word and its own counts to a g [ADXL355 datasheet, tables 1 and 43].
#[test]
fn every_range_is_set_at_the_chip() {
    for (range, word, of_a_g) in [(Range::G2, 0x81, 256_000), (Range::G4, 0x82, 128_000), (Range::G8, 0x83, 64_000)] {
        let mut expected = Expected::default();
        started_at(&mut expected, word);
        burst(&mut expected, 1, of_a_g);
        let per_count = PerCount::<f32>::new(range.per_count());
        let mut sensor = Adxl355::start(expected, Along::Z, range, per_count, 3).map_err(|(faults, _)| faults).unwrap();
        // a g, to the digits of an f32
        assert!((sensor.vibration().unwrap().unwrap() - 9.806_65).abs() < 1e-6, "{range:?}");
    }
}

#[test]
fn fixed_point_is_per_unit() {
    let mut expected = Expected::default();
    started(&mut expected);
    burst(&mut expected, 1, 128_000);
    let per_count = PerCount::<Fixed>::new(Range::G2.per_count(), 4.0 * 9.806_65);
    let mut sensor = Adxl355::start(expected, Along::Z, Range::G2, per_count, 3).map_err(|(faults, _)| faults).unwrap();
    let sample = sensor.vibration().unwrap().unwrap();
    // half a g of four; the factor has 24 places
    assert!((sample.to_f64() - 0.125).abs() < 0.125 * 1e-7, "{sample:?}");
}

#[test]
fn every_fault_is_no_sample() {
    let mut expected = Expected::default();
    started(&mut expected);
    expected.failure();
    // clipped at either end; lost its trimming; a line stuck high
    burst(&mut expected, 1, (1 << 19) - 1);
    burst(&mut expected, 1, -(1 << 19));
    // where both ends are alike
    burst(&mut expected, 1, 1 - (1 << 19));
    burst(&mut expected, 0x11, 1000);
    expected.exchange(&[0x09, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], &[0xff; 14]);
    burst(&mut expected, 1, 1000);
    let mut sensor = sensor(expected);
    for expected in [MISSING, CLIPPED, CLIPPED, CLIPPED, MISSING, MISSING] {
        assert_eq!(sensor.vibration(), expected);
    }
    assert!(sensor.vibration().unwrap().is_some());
}

#[test]
fn a_sample_that_stays_away_is_a_fault_after_the_patience() {
    let mut expected = Expected::default();
    started(&mut expected);
    (0..5).for_each(|_| burst(&mut expected, 0, 1000));
    burst(&mut expected, 1, 1000);
    let mut sensor = sensor(expected);
    for poll in 0..5 {
        assert_eq!(sensor.vibration(), if poll < 3 { Ok(None) } else { MISSING });
    }
    assert!(sensor.vibration().unwrap().is_some());
}

#[test]
fn another_chip_or_none_does_not_start() {
    for answer in [[0, 0xe5, 0, 0], [0xff; 4], [0; 4]] {
        let mut expected = Expected::default();
        expected.exchange(&[0x01, 0, 0, 0], &answer);
        let started = Adxl355::start(expected, Along::X, Range::G2, PER_COUNT, 3);
        let (faults, bus) = started.err().unwrap();
        assert_eq!(faults, Faults::VIBRATION_MISSING);
        drop(bus);
    }
}

#[test]
fn conversions_are_their_mean() {
    let mut vibration = AdcVibration::new(2048, 4095, PerCount::<f32>::new(0.01 / 256.0));
    assert_eq!(vibration.mean(&[2048, 2050, 2049, 2049], 1), Ok(0.01));
    // a quarter of a count is kept
    assert_eq!(vibration.mean(&[2048, 2048, 2048, 2047], 2), Ok(-0.0025));
}

#[test]
fn old_clipped_and_no_conversions_are_faults() {
    const NONE: Result<f32, Faults> = Err(Faults::VIBRATION_MISSING);
    let mut vibration = AdcVibration::new(2048, 4095, PerCount::<f32>::new(0.01 / 256.0));
    assert!(vibration.mean(&[2048], 1).is_ok());
    assert_eq!(vibration.mean(&[2048], 1), NONE);
    assert_eq!(vibration.mean(&[], 2), NONE);
    assert_eq!(vibration.mean(&[2048, 0], 3), Err(Faults::VIBRATION_CLIPPED));
    assert_eq!(vibration.mean(&[4095, 2048], 4), Err(Faults::VIBRATION_CLIPPED));
    assert!(vibration.mean(&[2048], 5).is_ok());
}

/// Readings of two turns through an axis, whose angle comes from a board and whose samples from conversions: a sound
/// one, then with a conversion at the end of the range, a transfer that stood still, and sound again.
#[test]
fn a_reading_through_an_axis_says_what_its_samples_lacked() {
    let config = Config {
        limits: scripted::CONFIG.limits,
        observer: scripted::CONFIG.observer,
        fluctuation: (),
        governor: scripted::CONFIG.governor,
        balancer: PhasorsConfig::<f32, 1>::new(&PhasorSettings { turns: 1, ..PhasorSettings::DIRECT }, [100.0]),
    };
    let mut axis = Axis::<_, Drive<f32, scripted::Observer, SpeedLoop, (), Phasors<1, 3>>>::new(
        scripted::Scripted::sound(),
        &config,
        TRIPPING,
    );
    let mut adc = AdcVibration::new(2048, 4095, PerCount::<f32>::new(0.01 / 256.0));
    let mut transfers = 0;
    let mut read = |fault: Option<Faults>| {
        axis.drive_mut().balancer_mut().begin();
        // at 30 rad/s and 10 kHz a turn has 2094 ticks: the fault comes within the reading
        for tick in 0..8000 {
            axis.tick(&config, scripted::WANTED);
            let theta = f64::from(axis.drive().angle()) / 4_294_967_296.0 * std::f64::consts::TAU;
            let faulty = fault.filter(|_| tick == 3000);
            transfers += u32::from(faulty != Some(Faults::VIBRATION_MISSING));
            let swing = if faulty == Some(Faults::VIBRATION_CLIPPED) { 2047.0 } else { (1500.0 * theta.cos()).round() };
            let sample = adc.mean(&[(2048.0 + swing) as u16], transfers).map(|sample| Some([sample]));
            let faults = axis.vibration(&config, sample);
            assert_eq!(faults, faulty.unwrap_or(Faults::NONE));
        }
        axis.drive().balancer().reading(&config.balancer, 0)
    };
    // 1500 counts of 0.01 each, to a tenth of a count and the table's 2e-4
    let sound = |reading: Result<Reading, ReadingFault>| (reading.unwrap().phasor.amplitude() - 15.0).abs() < 5e-3;
    assert!(sound(read(None)));
    assert_eq!(read(Some(Faults::VIBRATION_CLIPPED)), Err(ReadingFault::Clipped));
    let missing = read(Some(Faults::VIBRATION_MISSING));
    assert_eq!(missing, Err(ReadingFault::Missing { samples: 1 }));
    assert_eq!(missing.unwrap_err().to_string(), "samples were missing or not sound, 1 of them");
    assert!(sound(read(None)));
}
