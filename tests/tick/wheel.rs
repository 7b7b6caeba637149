//! Toothed wheels, cams and readings of a rotor as they are described: their constants by hand.

use driveline::balancing::Steadiness;
use driveline::settings::*;
use driveline::wheel::{Cam, ToothedWheelConfig};

use super::accepts;

const TURN: f64 = 4_294_967_296.0;
const CLOCK: ToothClock = ToothClock { turns: 2, clock: 1e6, lowest_speed: 10.0 };

#[test]
fn the_places_of_teeth() {
    assert_eq!(Teeth::<3>::gap(4, 1).angles, [0.0, 0.25, 0.5]);
    assert_eq!(Teeth::<4>::gap(4, 0).angles, [0.0, 0.25, 0.5, 0.75]);
    assert_eq!(Teeth::<5>::without(8, &[1, 5, 6]).angles, [0.0, 0.25, 0.375, 0.5, 0.875]);
    assert_eq!(Teeth::<5>::without(8, &[0, 6, 7]).angles, [0.125, 0.25, 0.375, 0.5, 0.625]);
    assert_eq!(Teeth::<5>::extra(4, 45.0).angles, [0.0, 0.125, 0.25, 0.5, 0.75]);
    assert_eq!(Teeth::<5>::extra(4, 315.0).angles, [0.0, 0.25, 0.5, 0.75, 0.875]);
    assert_eq!(Teeth::<3>::degrees([0.0, 90.0, 270.0]).angles, [0.0, 0.25, 0.75]);
}

/// What a wheel cannot be.
#[test]
fn places_that_cannot_be() {
    let stops = |made: fn() -> Teeth<3>| std::panic::catch_unwind(made).is_err();
    for (made, is_wrong) in [
        ((|| Teeth::gap(4, 1)) as fn() -> Teeth<3>, false),
        (|| Teeth::gap(5, 1), true),
        (|| Teeth::gap(3, 1), true),
        (|| Teeth::without(5, &[1, 3]), false),
        (|| Teeth::without(5, &[3, 4]), false),
        (|| Teeth::without(5, &[3, 3]), true),
        (|| Teeth::without(5, &[3, 1]), true),
        (|| Teeth::without(5, &[1, 5]), true),
        (|| Teeth::without(5, &[1]), true),
        (|| Teeth::without(5, &[1, 2, 3]), true),
        (|| Teeth::extra(2, 90.0), false),
        (|| Teeth::extra(3, 90.0), true),
        (|| Teeth::extra(1, 90.0), true),
    ] {
        assert_eq!(stops(made), is_wrong);
    }
    let stops = |angle: f64, tolerance: f64| std::panic::catch_unwind(|| Cam::degrees(2, [angle], tolerance)).is_err();
    for (angle, tolerance, is_wrong) in [
        (0.0, 1.0, false),
        (719.9, 359.9, false),
        (720.0, 1.0, true),
        (-0.1, 1.0, true),
        (1.0, 0.0, true),
        (1.0, -1.0, true),
        (1.0, 360.0, true),
        (f64::NAN, 1.0, true),
    ] {
        assert_eq!(stops(angle, tolerance), is_wrong, "{angle} {tolerance}");
    }
}

#[test]
fn the_edges_of_a_cam() {
    let cam = Cam::degrees(2, [90.0, 540.0], 36.0);
    assert_eq!(cam, Cam { edges: [1 << 29, 3 << 30], tolerance: (TURN / 20.0) as u32 });
}

/// Four places of which one is missing: spans of 1/2 before the first tooth and 1/4 before the others.
#[test]
fn the_constants_of_a_wheel() {
    let config = ToothedWheelConfig::new(&Teeth::<3>::gap(4, 1), CLOCK);
    let teeth = config.teeth.map(|tooth| (tooth.angle, tooth.span, tooth.slack, tooth.spans));
    // half of the lesser neighbour's span: an eighth; 4096 over the span
    assert_eq!(
        teeth,
        [(0, 1 << 31, 1 << 29, 8_192), (1 << 30, 1 << 30, 1 << 29, 16_384), (1 << 31, 1 << 30, 1 << 29, 16_384),]
    );
    assert_eq!((config.turns, config.period), (2, 1e-6));
    // a turn at 10 rad/s in counts of 1 us
    assert_eq!(config.slowest, 628_318);
    // unequal spans beside a tooth: the lesser one's half on either side
    let config = ToothedWheelConfig::new(&Teeth::<4>::degrees([0.0, 45.0, 180.0, 270.0]), CLOCK);
    assert_eq!(config.teeth.map(|tooth| tooth.slack), [1 << 28, 1 << 28, 1 << 29, 1 << 29]);
    let parts = [
        (ToothedWheelConfig::new(&Teeth::<4>::gap(4, 0), CLOCK).sector, 1),
        (ToothedWheelConfig::new(&Teeth::<6>::without(8, &[1, 5]), CLOCK).sector, 3),
        (ToothedWheelConfig::new(&Teeth::<6>::without(8, &[1, 6]), CLOCK).sector, 6),
    ];
    assert!(parts.iter().all(|(found, expected)| found == expected), "{parts:?}");
    assert_eq!(ToothedWheelConfig::new(&Teeth::<58>::gap(60, 2), CLOCK).sector, 58);
}

#[test]
fn the_limits_of_a_wheel() {
    let of = |angles: [f64; 3], clock: ToothClock| ToothedWheelConfig::try_new(&Teeth { angles }, clock);
    let even = [0.0, 0.3, 0.6];
    let wrong = [
        [0.0, 0.3, 0.3],
        [0.0, 0.6, 0.3],
        [-0.1, 0.3, 0.6],
        [0.0, 0.3, 1.0],
        [0.1, 0.3, 1.0],
        [0.0, 0.3, 0.300_049],
        [0.0, 0.3, 0.999_951],
        [0.0, f64::NAN, 0.6],
    ];
    accepts(&[even, [0.0, 0.3, 0.999], [0.0, 0.3, 0.300_051]], &wrong, |angles| of(angles, CLOCK));
    accepts(&[1, 8], &[0, 9], |turns| of(even, ToothClock { turns, ..CLOCK }));
    let clocked = |clock| of(even, ToothClock { clock, ..CLOCK });
    accepts(&[1e6], &[0.0, -1.0, f64::INFINITY, f64::NAN], clocked);
    // 2^30 counts on a turn at most, and one at least
    accepts(&[1_073_741_823.0, 1.001], &[1_073_741_825.0, 0.999, -1e3], |counts| {
        of(even, ToothClock { lowest_speed: std::f64::consts::TAU * CLOCK.clock / counts, ..CLOCK })
    });
    // a clock is refused as one, whatever the counts
    assert!([0.0, f64::INFINITY].iter().all(|&clock| clocked(clock).err() == clocked(-1.0).err()));
    assert!(clocked(-1.0).err() != of(even, ToothClock { lowest_speed: 0.0, ..CLOCK }).err());
    assert!(ToothedWheelConfig::try_new(&Teeth::<10_000>::gap(10_000, 0), CLOCK).is_ok());
    assert!(ToothedWheelConfig::try_new(&Teeth::<10_001>::gap(10_001, 0), CLOCK).is_err());
    // one tooth more at a whole turn is beyond the last place
    assert!(ToothedWheelConfig::try_new(&Teeth::<5>::extra(4, 359.0), CLOCK).is_ok());
    assert!(ToothedWheelConfig::try_new(&Teeth::<5>::extra(4, 360.0), CLOCK).is_err());
    assert!(ToothedWheelConfig::try_new(&Teeth { angles: [0.0] }, CLOCK).is_err());
    assert!(ToothedWheelConfig::try_new(&Teeth { angles: [0.0, 0.3] }, CLOCK).is_ok());
    // 128 teeth of which no part repeats, 130 of which the half does
    assert!(ToothedWheelConfig::try_new(&Teeth::<128>::gap(129, 1), CLOCK).is_ok());
    assert!(ToothedWheelConfig::try_new(&Teeth::<129>::gap(130, 1), CLOCK).is_err());
    assert!(ToothedWheelConfig::try_new(&Teeth::<130>::without(132, &[65, 131]), CLOCK).is_ok());
}

/// Times of three turns of 1,000 counts and more of a wheel that begins anywhere.
#[test]
fn a_wheel_is_learnt() {
    let places = [0.0, 0.1, 0.35, 0.6];
    let times = |turns: usize, first: usize, late: f64| {
        let place = |edge: usize| (edge / 4) as f64 + places[edge % 4];
        let mut times: Vec<u32> = (first..=first + 4 * turns)
            .map(|edge| 4_294_960_000_u32.wrapping_add((place(edge) * 1e4) as u32))
            .collect();
        // an edge of the second turn
        times[5] = times[5].wrapping_add((late * 1e4) as u32);
        times
    };
    for first in 0..4 {
        let learnt = Teeth::<4>::learnt(&times(3, first, 0.0)).unwrap();
        // the angle is 0 behind the largest span, 0.4
        for (found, expected) in learnt.angles.iter().zip(places) {
            assert!((found - expected).abs() < 2e-4, "{first} {learnt:?}");
        }
    }
    assert!(Teeth::<4>::learnt(&times(3, 0, 0.0)[..12]).is_err());
    assert!(Teeth::<4>::learnt(&times(2, 0, 0.0)).is_err());
    assert!(Teeth::<1>::learnt(&[1, 2, 3, 4, 5]).is_err());
    // no time between two edges of each turn is no wheel, and not an unsteady one
    let together = Teeth::<2>::learnt(&[0, 0, 10, 10, 20, 20, 30]).unwrap_err();
    assert_eq!([Teeth::<4>::learnt(&[7; 13]).unwrap_err(), Teeth::<1>::learnt(&[1; 5]).unwrap_err()], [together; 2]);
    assert_eq!(Teeth::<2>::learnt(&[0, 2, 8, 10, 16, 18, 24]).unwrap().angles, [0.0, 0.25]);
    // two thirds of the displacement beside the mean of three turns: a tenth of the least span is 0.01
    assert!(Teeth::<4>::learnt(&times(3, 0, 0.014)).is_ok());
    assert!(Teeth::<4>::learnt(&times(3, 0, 0.016)).is_err());
}

#[test]
fn the_limits_of_a_rotors_measurement() {
    let of = |change: fn(&mut PhasorSettings)| {
        let mut settings = PhasorSettings { steadiness: Steadiness::USUAL, ..PhasorSettings::DIRECT };
        change(&mut settings);
        driveline::balancing::PhasorsConfig::<f64, 1>::try_new(&settings, [1.0]).err()
    };
    for (change, error) in [
        ((|s| s.order = 1) as fn(&mut PhasorSettings), None),
        (|s| s.order = 0, Some(PhasorError::Ratio)),
        (|s| (s.order, s.motor_turns, s.turns) = (64, 8, 4), None),
        (|s| (s.order, s.motor_turns, s.turns) = (65, 8, 4), Some(PhasorError::Ratio)),
        (|s| s.motor_turns = 0, Some(PhasorError::Ratio)),
        (|s| s.rotor_turns = 16, Some(PhasorError::Ratio)),
        (|s| s.rotor_turns = -15, None),
        (|s| s.rotor_turns = i32::MAX, Some(PhasorError::Ratio)),
        (|s| (s.rotor_turns, s.order, s.turns) = (i32::MAX, 2, 8), Some(PhasorError::Ratio)),
        (|s| s.turns = 0, Some(PhasorError::Turns)),
        (|s| s.turns = 300, None),
        (|s| s.turns = 301, Some(PhasorError::Turns)),
        (|s| (s.turns, s.order) = (150, 2), None),
        (|s| (s.turns, s.order) = (151, 2), Some(PhasorError::Turns)),
    ] {
        assert_eq!(of(change), error);
    }
    type Of<N> = driveline::balancing::PhasorsConfig<N, 2>;
    for (limit, float, fixed) in [
        (2.0, true, true),
        (2.1, true, false),
        (0.0, false, false),
        (-1.0, false, false),
        (f64::NAN, false, false),
        (1e30, true, false),
        (1.1e30, false, false),
    ] {
        for limits in [[limit, 1.0], [1.0, limit]] {
            assert_eq!(Of::<f32>::try_new(&PhasorSettings::DIRECT, limits).is_ok(), float, "{limits:?}");
            let fixed_point = Of::<driveline::number::Fixed>::try_new(&PhasorSettings::DIRECT, limits);
            assert_eq!(fixed_point.is_ok(), fixed, "{limits:?}");
        }
    }
    assert!(Of::<f64>::try_new(&PhasorSettings::DIRECT, [1.1e30, 1e300]).is_ok());
}
