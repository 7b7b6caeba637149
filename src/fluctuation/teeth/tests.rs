//! Windows of teeth made by hand: trend, places and orders in closed form.

use super::*;
use crate::settings::{Teeth, ToothClock};

const CLOCK: ToothClock = ToothClock { turns: 1, clock: 1e6, lowest_speed: 10.0 };

fn wheel() -> ToothedWheelConfig<4> {
    ToothedWheelConfig::new(&Teeth::<4>::gap(4, 0), CLOCK)
}

/// The same, an eighth of a turn further.
fn turned() -> ToothedWheelConfig<4> {
    ToothedWheelConfig::new(&Teeth { angles: [0.125, 0.375, 0.625, 0.875] }, CLOCK)
}

fn window(cycles: u32, opening: f64, closing: f64, missed: u32) -> ToothWindow<4> {
    ToothWindow { cycles, opening, closing, missed, whole: 1.5 * f64::from(cycles), ..ToothWindow::default() }
}

/// Cycles of 2 s and at last 1 s: the slowness falls by the logarithm of two, the speed rises by half of the
/// angle, over the cycles between, missed ones too, of 1.5 s.
#[test]
fn the_trend_is_that_from_the_first_cycle_to_the_last() {
    let fall = -core::f64::consts::LN_2;
    // a cycle of half a second behind one of a quarter
    let (rise, acceleration) = window(2, 0.25, 0.5, 0).trend(3.0);
    assert!((rise + fall).abs() < 1e-15 && (acceleration + 6.0 / 1.5).abs() < 1e-15, "{rise} {acceleration}");
    for (cycles, missed, between) in [(2, 0, 1.0), (4, 3, 6.0), (2, 3, 4.0)] {
        let (rise, acceleration) = window(cycles, 2.0, 1.0, missed).trend(3.0);
        // one logarithm and two divisions
        assert!((rise - fall / between).abs() < 1e-15, "{rise}");
        assert!((acceleration - 1.5 / (between * 1.5)).abs() < 1e-15, "{acceleration}");
    }
    for window in [window(1, 2.0, 1.0, 0), window(0, 2.0, 1.0, 0), window(3, 0.0, 1.0, 0), window(3, 1.0, 0.0, 0)] {
        assert_eq!(window.trend(3.0), (0.0, 0.0));
    }
}

/// A steady acceleration by the closed form: the square of the speed falls by `2 e` of itself in a cycle, which
/// takes `(1 - sqrt(1 - 2 e x))/e` to the share `x`. The slowness rises by `e/(1 - e)` of itself in the middle.
#[test]
fn a_steady_acceleration_is_taken_off() {
    let e = 0.05;
    let time = |x: f64| (1.0 - sqrt(1.0 - 2.0 * e * x)) / e;
    let rise = e / (1.0 - e);
    let late = [0.0, 0.25, 0.5, 0.75].map(|x| (time(x) / time(1.0) - x) as f32);
    let window = ToothWindow { late, cycles: 1, ..ToothWindow::default() };
    assert!(late[2] < -0.005);
    // the cycle begins with its first tooth, wherever that is
    for config in [wheel(), turned()] {
        let left = window.lateness(&config, rise);
        // of the third order
        assert!(left.iter().all(|left| left.abs() < 0.1 * rise * rise * rise), "{left:?} {rise}");
    }
}

/// The first cycle may have the number zero; the same one again is left out; one after a lost place begins anew.
#[test]
fn cycles_are_counted_by_their_numbers() {
    let cycle = |number: u32| ToothCycle { times: [0, 250, 500, 750], end: 1000, number };
    let mut window = ToothWindow::<4>::default();
    for (number, cycles, missed) in [(0, 1, 0), (0, 1, 0), (1, 2, 0), (4, 3, 2), (4 + LOST, 1, 0), (3, 1, 0)] {
        window.add(&wheel(), &cycle(number));
        assert_eq!((window.cycles(), window.missed), (cycles, missed), "{number}");
    }
}

/// No more orders than a quarter of the teeth, and no cycle whose length changes by more than a tenth.
#[test]
fn what_a_window_of_teeth_cannot_say() {
    let window = ToothWindow { late: [0.0, 0.01, 0.0, -0.01], ..window(1, 1.0, 1.0, 0) };
    let ripple = window.ripple(&wheel(), &ToothErrors::NONE, 16).unwrap();
    // lateness of sin(theta)/100, and its derivative
    assert!((ripple.motor.delta - 0.04 * core::f64::consts::PI).abs() < 1e-3, "{ripple:?}");
    assert_eq!(ripple.speed.highest(), 1);
    let trend = |closing: f64| {
        let window = ToothWindow { late: window.late.map(|late| 2.0 * late), ..self::window(2, 1.0, closing, 0) };
        window.ripple(&wheel(), &ToothErrors::NONE, 1).err()
    };
    assert_eq!([trend(1.05), trend(1.12), trend(0.88)], [None, Some(Unusable::Trend), Some(Unusable::Trend)]);
}

/// A tooth without an edge is as late as its neighbours; places are counted from the first tooth.
#[test]
fn a_tooth_without_an_edge_is_between_its_neighbours() {
    for config in [wheel(), turned()] {
        let mut window = ToothWindow::<4>::default();
        // the second is late by 0.01, the third has no edge: its time is before the first's
        let cycle = ToothCycle { times: [1000, 1260, 999, 1770], end: 2000, number: 7 };
        window.add(&config, &cycle);
        let expected = [0.0, 0.01, 0.015, 0.02];
        // rounding of f32
        assert!(window.late.iter().zip(expected).all(|(late, expected)| (late - expected).abs() < 1e-7), "{window:?}");
        // 0.01^2 + 0.015^2 + 0.02^2
        assert!((window.squares - 7.25e-4).abs() < 1e-8, "{window:?}");
        // a cycle of 1 ms, and one of 2 ms
        window.add(&config, &ToothCycle { times: [0, 500, 1000, 1500], end: 2000, number: 8 });
        // two roundings
        assert!((window.opening - 1e-3).abs() < 1e-18 && (window.closing - 2e-3).abs() < 1e-18, "{window:?}");
        assert!((window.whole - 3e-3).abs() < 1e-18 && (window.squares - 7.25e-4).abs() < 1e-8, "{window:?}");
    }
}

/// Two turns of four teeth to a cycle.
fn two_turns(angles: [f64; 4]) -> ToothedWheelConfig<4> {
    ToothedWheelConfig::new(&Teeth { angles }, ToothClock { turns: 2, ..CLOCK })
}

/// A window of two cycles of 0.1 s whose mean lateness is this.
fn of_mean(late: [f64; 8]) -> ToothWindow<8> {
    let sums = late.map(|late| (2.0 * late) as f32);
    let squares = 2.0 * late.iter().map(|late| late * late).sum::<f64>();
    ToothWindow { late: sums, squares, cycles: 2, whole: 0.2, opening: 0.1, closing: 0.1, ..ToothWindow::default() }
}

/// Half of the least span beside a tooth is its slack: 1/8, 1/8, 1/16 and 1/16 of a turn, of which 0.7 may be left,
/// as 0.04375 and 0.021875 of a cycle of two turns. A pair of teeth is late and early by the same.
#[test]
fn a_tooth_is_out_of_place_beyond_its_slack() {
    let config = two_turns([0.0, 0.25, 0.5, 0.625]);
    assert_eq!([2, 5, 7].map(|tooth| place(&config, tooth)), [0.25, 0.625, 0.8125]);
    for (pair, left, is_right) in [
        ([0, 1], 0.043, true),
        ([0, 5], 0.043, true),
        ([4, 1], -0.043, true),
        ([0, 1], 0.045, false),
        ([0, 5], -0.045, false),
        ([2, 3], 0.021, true),
        ([3, 6], -0.021, true),
        ([2, 3], 0.023, false),
        ([7, 6], 0.023, false),
    ] {
        let mut late = [0.0; 8];
        (late[pair[0]], late[pair[1]]) = (left, -left);
        let ripple = of_mean(late).ripple(&config, &ToothErrors::NONE, 0);
        assert_eq!(ripple.err(), (!is_right).then_some(Unusable::Teeth), "{pair:?} {left}");
    }
}

/// Residue and spread are the roots of mean squares (rad). In two cycles that are each as far from their mean, the
/// mean of the squares is that of the mean and that of the distance.
#[test]
fn residue_and_spread_are_roots_of_mean_squares() {
    let config = two_turns([0.0, 0.25, 0.5, 0.75]);
    let (left, apart) = (0.01, 0.003);
    let mut window = of_mean([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0].map(|sign| sign * left));
    window.squares += 2.0 * 8.0 * apart * apart;
    window.missed = 3;
    let ripple = window.ripple(&config, &ToothErrors::NONE, 2).unwrap();
    // eight teeth tell two orders from that one; lateness is of single precision
    assert!((ripple.quality.residue / (left * 2.0 * TAU) - 1.0).abs() < 1e-6, "{ripple:?}");
    assert!((ripple.quality.spread / (apart * 2.0 * TAU) - 1.0).abs() < 1e-5, "{ripple:?}");
    assert_eq!((ripple.quality.trend, ripple.quality.missed, ripple.cycles), (0.0, 3, 2));
    // two turns in 0.1 s, without orders
    assert!((ripple.mean / (20.0 * TAU) - 1.0).abs() < 1e-15 && ripple.motor.delta < 1e-7, "{ripple:?}");
    // of a single cycle there is no spread, be its squares any
    (window.cycles, window.squares) = (1, 1.0);
    assert_eq!(window.ripple(&config, &ToothErrors::NONE, 2).unwrap().quality.spread, 0.0);
    // a quarter of the teeth: two orders, of which that of the teeth is none
    let ripple = window.ripple(&config, &ToothErrors::NONE, 16).unwrap();
    assert!(ripple.speed.order(3).amplitude() == 0.0);
}

/// A lateness of `a sin(theta)` is a slowness of `1 + 2 pi a cos(theta)`, which the tooth's own error is passed
/// with. What is left of the error in a round is a quarter of it: two of eight teeth.
#[test]
fn errors_of_teeth_are_passed_with_the_slowness_there() {
    let config = two_turns([0.0, 0.25, 0.5, 0.75]);
    let errors = ToothErrors([0.3, 0.0, 0.0, 0.0, 0.0, -0.2, 0.0, 0.0]);
    for size in [0.02, 1e-6] {
        let mut late = [0.0; 8];
        for (tooth, late) in late.iter_mut().enumerate() {
            let (sin, cos) = sin_cos(TAU * tooth as f64 / 8.0);
            *late = size * sin + f64::from(errors.0[tooth]) / TAU * (1.0 + TAU * size * cos);
        }
        let ripple = of_mean(late).ripple(&config, &errors, 1).unwrap();
        // the speed's first order is that of the slowness to its square; the lateness is of single precision, 3e-9,
        // and the errors' part is left by (0.3/4)^3
        let expected = TAU * size;
        let found = ripple.speed.order(1);
        let left = 2.0 * expected * expected + 1e-7 + 1e-3 * expected;
        assert!((found.cos / ripple.mean + expected).abs() < left, "{size} {found:?} {ripple:?}");
        assert!((found.sin / ripple.mean).abs() < left, "{size} {found:?}");
        // a hundredth of the order, and the rounding
        assert!(ripple.quality.residue < 0.01 * size * 2.0 * TAU + 1e-6, "{size} {ripple:?}");
    }
    // they are the lateness of a window without a ripple
    let found = of_mean([0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.02]).errors(&config);
    let expected = [0.01 * TAU, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.02 * TAU];
    // single precision
    let is_so = |(found, expected): (&f32, f64)| (f64::from(*found) - expected).abs() < 1e-8;
    assert!(found.radians().iter().zip(expected).all(is_so), "{found:?}");
    // rise in a window that becomes slower: at the middle of the cycle less by rise/8
    let slower = ToothWindow { closing: 0.101, ..of_mean([0.0; 8]) };
    let (rise, _) = slower.trend(1.0);
    assert!((f64::from(slower.errors(&config).radians()[4]) - TAU * rise / 8.0).abs() < 1e-8);
}

/// Orders are found whatever the places of the teeth, and whatever their size: to 1e-9 of the largest, times what
/// the places magnify that by. In four fifths of a cycle that is some thousand times.
#[test]
fn orders_are_found_at_uneven_teeth() {
    // the second needs conjugate directions: by a wrong share of the last one forty steps leave some percent
    let four_fifths = [0.0, 0.07, 0.17, 0.30, 0.41, 0.50, 0.62, 0.80];
    let two_thirds = [0.0, 0.07, 0.15, 0.24, 0.35, 0.45, 0.55, 0.68];
    for (angles, size) in [(four_fifths, 1.0), (four_fifths, 1e-7), (two_thirds, 1.0), (two_thirds, 1e-7)] {
        let config = ToothedWheelConfig::<8>::new(&Teeth { angles }, CLOCK);
        let mut of = FourierSeries::constant(0.3 * size);
        of.orders[0] = Order { cos: size, sin: -0.4 * size };
        of.orders[1] = Order { cos: 0.2 * size, sin: 0.7 * size };
        let mut values = [0.0; 8];
        for (tooth, value) in values.iter_mut().enumerate() {
            *value = of.at(TAU * place(&config, tooth));
        }
        for guess in [FourierSeries::default(), FourierSeries::constant(2.0 * size)] {
            let found = fitted(&config, &values, &guess, 2);
            let off = combined(&found, -1.0, &of);
            assert!(sqrt(product(&off, &off)) < 1e-6 * size, "{size} {found:?}");
        }
    }
}
