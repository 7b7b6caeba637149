//! Barred speeds: where they lie, and that no setpoint stays in one.

use driveline::design::{Actuator, BarredSpeeds, Error, LoadFeedForward, Rate, USUAL_MARGIN};
use driveline::governor::{Barred, BarredConfig, Gains, Governor, SpeedGovernor, SymmetricLimitConfig};
use driveline::machine::{Chain, Cylinder, Damping, Inertia, Length, Stiffness};
use driveline::number::StateOf;
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use proptest::prelude::*;

use super::plain;

const PERIOD: f64 = 1e-3;

/// The critical speeds of a chain whose frequencies are known: 0.6 and 0.4 kg m2 on 240 N m/rad have 1000 (rad/s)^2 as
/// 240/(0.24).
#[test]
fn ranges_lie_about_frequency_over_order() {
    let chain = Chain::motor(Inertia(0.6)).shaft(Stiffness(240.0), Damping(0.0)).rotor(Inertia(0.4));
    let frequency = chain.modes().resonances()[0].frequency;
    assert!((frequency - 1000.0_f64.sqrt()).abs() < 1e-9);
    let barred = BarredSpeeds::<3>::new(&[frequency], &[0.5, 1.0, 3.0], USUAL_MARGIN, 100.0);
    let expected: Vec<f64> = [3.0, 1.0, 0.5].iter().map(|order| 1000.0_f64.sqrt() / order).collect();
    for (range, critical) in barred.ranges().iter().zip(expected) {
        assert!((range[0] - 0.9 * critical).abs() < 1e-9 && (range[1] - 1.1 * critical).abs() < 1e-9, "{range:?}");
    }
}

proptest! {
    /// Ranges rise, lie apart, cover every critical speed with its margin, and nothing that no critical speed accounts
    /// for.
    #[test]
    fn ranges_are_the_union(
        frequencies in prop::collection::vec(10.0..200.0_f64, 1..5),
        orders in prop::collection::vec(0.5..6.0_f64, 1..5),
    ) {
        let barred = BarredSpeeds::<16>::new(&frequencies, &orders, USUAL_MARGIN, 1000.0);
        for pair in barred.ranges().windows(2) {
            prop_assert!(pair[0][1] < pair[1][0]);
        }
        for speed in (1..4000).map(|step| 0.11 * f64::from(step)) {
            let near = |f: &f64, o: &f64| (speed * o / f - 1.0).abs() <= USUAL_MARGIN;
            let critical = frequencies.iter().any(|f| orders.iter().any(|o| near(f, o)));
            let inside = barred.ranges().iter().any(|range| (range[0]..=range[1]).contains(&speed));
            // The edges themselves are a rounding either way.
            let at_an_edge = barred.ranges().iter().flatten().any(|edge| (edge / speed - 1.0).abs() < 1e-12);
            prop_assert!(critical == inside || at_an_edge, "{speed} {critical} {inside}");
        }
    }
}

/// Six throws of equal inertia on equal shafts, omega = 2 sqrt(k/J) sin(m pi/12). Of the orders 3/2 and 3 the first
/// mode, odd about the middle, answers to 3/2 alone; the second, even, to neither.
#[test]
fn an_engine_bars_where_its_phasor_sum_is_large() {
    const THIRD: f64 = std::f64::consts::TAU / 3.0;
    const SIX: [Cylinder; 6] = Cylinder::fired(
        Cylinder::in_line([0.0, 2.0 * THIRD, THIRD, THIRD, 2.0 * THIRD, 0.0], Length(0.1)),
        [1, 5, 3, 6, 2, 4],
    );
    let (shaft, throw) = ((Stiffness(9.0e5), Damping(0.0)), Inertia(0.4));
    let mut chain = Chain::motor(throw);
    for _ in 1..6 {
        chain = chain.shaft(shaft.0, shaft.1).rotor(throw);
    }
    let first = 2.0 * f64::sqrt(9.0e5 / 0.4) * (std::f64::consts::PI / 12.0).sin();
    let of = |orders: &[f64], least: f64| {
        let at = [0, 1, 2, 3, 4, 5];
        BarredSpeeds::<8>::try_of_engine(&chain.modes(), (&SIX, at), orders, least, USUAL_MARGIN, 0.8 * first)
    };
    let ranges = of(&[1.5, 3.0], 1.0).unwrap();
    assert_eq!(ranges.ranges().len(), 1, "{ranges:?}");
    for (edge, share) in ranges.ranges()[0].iter().zip([0.9, 1.1]) {
        // modes to rounding
        assert!((edge / (share * first / 1.5) - 1.0).abs() < 1e-12, "{edge}");
    }
    // 1, 3, 2 against 5, 6, 4: twice (cos 15 + cos 45 + cos 75) = 4 cos 15 degrees
    assert_eq!(of(&[1.5], 3.99).unwrap().ranges().len(), 1);
    assert!(of(&[1.5], 4.01).unwrap().ranges().is_empty());
    // whether or not a sum passes
    for (orders, least) in [([0.0], 0.0), ([0.0], 9.0), ([f64::NAN], 9.0), ([1.5], f64::NAN), ([1.5], -1.0)] {
        assert_eq!(of(&orders, least), Err(Error::Barred), "{orders:?} {least}");
    }
    let margin = BarredSpeeds::<8>::try_of_engine(&chain.modes(), (&SIX, [0; 6]), &[1.5], 9.0, 1.0, first);
    assert_eq!(margin, Err(Error::Barred));
    let beyond = (&SIX, [0, 1, 2, 3, 4, 6]);
    assert_eq!(
        BarredSpeeds::<8>::try_of_engine(&chain.modes(), beyond, &[1.5], 1.0, USUAL_MARGIN, first),
        Err(Error::Barred)
    );
}

#[test]
fn too_many_ranges_and_wrong_numbers_are_refused() {
    assert_eq!(BarredSpeeds::<1>::try_new(&[10.0, 100.0], &[1.0], 0.1, 1e3), Err(Error::BarredCount));
    assert_eq!(BarredSpeeds::<1>::try_new(&[10.0], &[0.0], 0.1, 1e3), Err(Error::Barred));
    assert_eq!(BarredSpeeds::<1>::try_new(&[f64::NAN], &[1.0], 0.1, 1e3), Err(Error::Barred));
    assert_eq!(BarredSpeeds::<1>::try_new(&[10.0], &[1.0], 1.0, 1e3), Err(Error::Barred));
    // Those that touch are one, and what begins beyond the highest speed is none.
    assert_eq!(BarredSpeeds::<1>::new(&[10.0, 10.5, 500.0], &[1.0], 0.1, 100.0).ranges().len(), 1);
}

/// A setpoint on its way through a range moves four times as fast; asked to stop inside, it stops at the edge that it
/// came from.
#[test]
fn a_range_is_passed_quickly_and_never_stayed_in() {
    let barred = BarredSpeeds::<2>::new(&[40.0, 80.0], &[1.0], USUAL_MARGIN, 200.0);
    let machine = Chain::motor(Inertia(0.6)).shaft(Stiffness(2.4e4), Damping(1.0)).rotor(Inertia(0.4));
    let design = machine.reduce(driveline::machine::Match::ResonanceAntiresonance).governor(
        Rate::every(PERIOD),
        Actuator { delay: 0.0, lag: 0.05 },
        3.0,
        LoadFeedForward::NONE,
    );
    let config = plain(
        Gains::<f64>::new(&design, SpeedLoopSettings { torque_limit: 100.0, ramp: 10.0 }, Bases::SI),
        BarredConfig::<f64, 2>::new(&barred, 40.0, PERIOD, Bases::SI),
        (),
        SymmetricLimitConfig::<f64>::new(100.0, Bases::SI),
    );
    let mut governor = <StateOf<SpeedGovernor<Barred<2>>, f64>>::default();
    let inside = |speed: f64| barred.ranges().iter().any(|r| speed > r[0] + 1e-9 && speed < r[1] - 1e-9);
    let mut go = |setpoint: f64, ticks: usize| {
        let mut dwelt = 0;
        for _ in 0..ticks {
            governor.set_setpoint(setpoint);
            let now = Estimate { motor_speed: governor.ramped_setpoint(), ..Estimate::default() };
            governor.command(&config, &now);
            dwelt += usize::from(inside(governor.ramped_setpoint()));
        }
        (governor.ramped_setpoint(), dwelt)
    };
    // 36 to 44 rad/s and 72 to 88 at 40 rad/s2: 0.2 s and 0.4 s inside, the first tick of each by the slow ramp.
    let (reached, dwelt) = go(120.0, 20_000);
    assert!((reached - 120.0).abs() < 1e-9 && (590..=610).contains(&dwelt), "{reached} {dwelt}");
    // From above and from below: stops at the edge on its side.
    assert!((go(75.0, 20_000).0 - 88.0).abs() < 1e-9);
    assert!((go(50.0, 20_000).0 - 50.0).abs() < 1e-9);
    assert!((go(85.0, 20_000).0 - 72.0).abs() < 1e-9);
    assert_eq!(go(85.0, 100).1, 0);
}
