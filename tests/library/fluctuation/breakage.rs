//! Attempts to break it: estimates that are no numbers, angles that jump, machines that turn back, wheels with other
//! teeth than was said.

use core::f64::consts::TAU;

use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation, ToothErrors, ToothWindow, Waveform, WaveformConfig};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle, Teeth, ToothClock};
use driveline::wheel::{CycleTimes, ToothedWheel, ToothedWheelConfig};
use proptest::prelude::*;

use super::rig::{BINS, PERIOD};

/// Any number at all, those that are none more often than not.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(f32::NAN),
        Just(f32::INFINITY),
        Just(f32::NEG_INFINITY),
        Just(0.0),
        -300.0_f32..300.0,
        any::<f32>()
    ]
}

proptest! {
    /// Stretches of any speed with any estimates, disturbances and jumps between them: what is read is finite and
    /// within its cycle.
    #[test]
    fn whatever_is_read_is_a_number(
        stretches in prop::collection::vec(
            (
                -200_000_000..200_000_000_i32, 1..300_u32, number(), number(), any::<bool>(),
                prop::option::weighted(0.1, any::<u32>()),
            ),
            1..12,
        ),
        turns in 1..40_u32,
        cycles in 1..40_u32,
    ) {
        prop_assume!(turns <= 16 * cycles);
        let cycle = CycleConfig::new(Cycle { turns, cycles }, PERIOD, Bases::SI);
        let config = (cycle, WaveformConfig::new::<BINS>(cycle, 2));
        let mut parts = <(Extremes<f32>, Waveform<BINS>)>::default();
        let mut angle = 0_u32;
        for (step, ticks, speed, torque, disturbed, jump) in stretches {
            if disturbed {
                Fluctuation::<f32>::disturb(&mut parts);
                prop_assert!(parts.0.reading(&cycle).is_none());
            }
            angle = angle.wrapping_add(jump.unwrap_or(0));
            for _ in 0..ticks {
                angle = angle.wrapping_add(step as u32);
                let estimate = Estimate { motor_speed: speed, load_speed: -speed, ..Estimate::default() };
                parts.measure(&config, angle, torque, &estimate);
                if let Some(window) = parts.1.take() {
                    // or it is refused: too few ticks, a cycle too uneven
                    if let Ok(ripple) = window.ripple(&config.1, 8) {
                        prop_assert!(ripple.mean.is_finite(), "{ripple:?}");
                    }
                }
                let Some(reading) = parts.0.reading(&cycle) else { continue };
                prop_assert!(reading.mean.is_finite() && reading.duration > 0.0, "{reading:?}");
                for one in [reading.motor, reading.load] {
                    let within = |angle: f32| (0.0..=cycle.angle as f32).contains(&angle);
                    let angles = within(one.max.angle) && within(one.min.angle);
                    prop_assert!(one.delta.is_finite() && angles, "{reading:?}");
                }
            }
        }
    }

    /// A machine that turns back now and then at one speed has that speed in every cycle that it turns through.
    #[test]
    fn turning_back_is_in_no_reading(
        stretches in prop::collection::vec((any::<bool>(), 500..5000_u32), 1..8),
        step in 10_000_000..20_000_000_u32,
        turns in 1..9_u32,
        cycles in 1..3_u32,
        skipped in prop::option::of(0..5000_u32),
    ) {
        let cycle = CycleConfig::new(Cycle { turns, cycles }, PERIOD, Bases::SI);
        let speed = f64::from(step) / 4_294_967_296.0 * TAU / PERIOD;
        let mut extremes = Extremes::<f64>::default();
        let (mut angle, mut tick, mut turned_back) = (0_u32, 0, 0);
        for (forward, ticks) in stretches {
            // The cycle that it turns back in takes as long as it takes, and is shown until the next.
            turned_back = extremes.cycles();
            for _ in 0..ticks {
                tick += 1;
                angle = if forward { angle.wrapping_add(step) } else { angle.wrapping_sub(step) };
                let signed = if forward { speed } else { -speed };
                if skipped == Some(tick) {
                    Fluctuation::<f64>::disturb(&mut extremes);
                    continue;
                }
                let estimate = Estimate { motor_speed: signed, load_speed: signed, ..Estimate::default() };
                extremes.measure(&cycle, angle, 0.0, &estimate);
                if extremes.cycles() < turned_back + 2 {
                    continue;
                }
                let Some(reading) = extremes.reading(&cycle) else { continue };
                // To a thousandth of a tick of a cycle of 100.
                prop_assert!((reading.mean / signed - 1.0).abs() < 1e-5, "{reading:?} {signed}");
                prop_assert!(reading.motor.delta < 1e-9, "{reading:?}");
            }
        }
        prop_assert!(turned_back <= extremes.cycles());
    }

    /// Whatever wheel turns at a steady speed, a cycle of a 60-2 wheel is only had from a 60-2 wheel; with false teeth,
    /// what is had is a number.
    #[test]
    fn a_wheel_of_other_teeth_gives_no_window(
        places in 5..90_u32,
        missing in 0..5_u32,
        pitch in 1..200_000_u32,
        faults in prop::collection::vec((0..3000_u32, any::<u32>()), 0..5),
    ) {
        let clock = ToothClock { turns: 1, clock: 1e6, lowest_speed: 0.1 };
        let config = ToothedWheelConfig::new(&Teeth::<58>::gap(60, 2), clock);
        let mut wheel = ToothedWheel::<CycleTimes<58>>::default();
        for count in 0..3000_u32 {
            if count % places >= places - missing.min(places - 1) {
                continue;
            }
            let late = faults.iter().find(|(at, _)| *at == count).map_or(0, |(_, late)| *late);
            wheel.tooth(&config, count.wrapping_mul(pitch).wrapping_add(late));
            if let Some(cycle) = wheel.take() {
                let mut window = ToothWindow::default();
                window.add(&config, &cycle);
                if let Ok(ripple) = window.ripple(&config, &ToothErrors::NONE, 4) {
                    prop_assert!(ripple.mean.is_finite() && ripple.motor.delta.is_finite(), "{ripple:?}");
                }
                prop_assert!(!faults.is_empty() || (places, missing) == (60, 2), "{places}-{missing}");
            }
        }
    }
}
