//! Ratios of gaps and of even teeth, missing places, and a wheel with one tooth more.

use super::*;

/// The teeth at which a ratio of so many octaves may end, one bit each.
fn fitting<const TEETH: usize>(teeth: &Teeth<TEETH>, octaves: f64) -> u128 {
    let config = ToothedWheelConfig::new(teeth, ToothClock { turns: 1, clock: 1e6, lowest_speed: 1.0 });
    // from 1/8 on, in eighths of an octave
    let [low, high] = config.fitting[(8.0 * (octaves + 3.0)) as usize];
    u128::from(high) << 64 | u128::from(low)
}

/// 60-2: three spans and one are log2 3 = 1.585 octaves apart. 0.6 of that and an eighth are 1.076.
#[test]
fn a_gap_is_known_by_six_tenths_of_its_ratio() {
    let teeth = Teeth::<58>::gap(60, 2);
    let (behind, next, others) = (1, 2, (1 << 58) - 4);
    for (octaves, expected) in [
        (3.0, 0),
        (2.75, 0),
        (2.625, behind),
        (1.125, behind),
        (1.0, behind | others),
        (0.625, behind | others),
        (0.5, others),
        (-0.5, others),
        (-0.625, next | others),
        (-1.0, next | others),
        (-1.125, next),
        (-2.625, next),
        (-2.75, 0),
    ] {
        assert_eq!(fitting(&teeth, octaves), expected, "{octaves}");
    }
}

/// Even teeth, which differ by rounding alone, by 2.2 and an eighth of an octave; 0.05 octaves apart by 0.6 of that
/// and an eighth; and a gap of 67 spans, 6.07 octaves, by the last ratio on either side.
#[test]
fn even_teeth_and_wide_gaps() {
    let even = Teeth::<12>::gap(12, 0);
    for (octaves, expected) in [(1.25, 0), (1.125, 1), (-1.125, 1), (-1.25, 0)] {
        assert_eq!(fitting(&even, octaves), expected, "{octaves}");
    }
    // spans of 92, 88.9, 90.2 and 88.9 degrees: 0.049, -0.049, 0.021 and -0.021 octaves, within 0.155
    let nearly = Teeth::<4>::degrees([0.0, 88.9, 179.1, 268.0]);
    for (octaves, expected) in [(0.25, 0), (0.125, 13), (0.0, 15), (-0.125, 14), (-0.25, 0)] {
        assert_eq!(fitting(&nearly, octaves), expected, "{octaves}");
    }
    let wide = Teeth::<6>::degrees([0.0, 5.0, 10.0, 15.0, 20.0, 25.0]);
    for (octaves, expected) in [(3.0, 1), (2.875, 0), (1.0, 60), (0.0, 60), (-2.875, 0), (-3.0, 2)] {
        assert_eq!(fitting(&wide, octaves), expected, "{octaves}");
    }
    // a gap of eight spans, three octaves, to the last ratio on either side
    let octave = Teeth::<8>::gap(15, 7);
    for (octaves, expected) in [(3.0, 1), (1.875, 1), (1.75, 0), (-1.75, 0), (-1.875, 2), (-3.0, 2)] {
        assert_eq!(fitting(&octave, octaves), expected, "{octaves}");
    }
}
