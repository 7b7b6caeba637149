//! Ticks that did not run, counted from a timer.

use driveline::axis::MissedTicks;
use driveline::fault::Faults;
use driveline_solver::noise::Noise;

use super::scripted::{CONFIG, Scripted, WANTED, governing};

/// Periods of a timer at 84 MHz in a tick at 10 kHz, which is not a power of two.
const PERIOD: u32 = 8_400;

/// Ticks that are late by up to half a period at random, of which one in a hundred does not run, on timers of 32 and of
/// 16 bits, and by a clock that is up to 1 % off: each gap is counted, and nothing else.
#[test]
fn late_ticks_are_late_and_missed_ones_are_counted() {
    for (bits, clock) in [(32, 1.0), (16, 1.0), (32, 1.01), (32, 0.99)] {
        let mut missed = MissedTicks::new(PERIOD, bits);
        let mut noise = Noise::new(3);
        let (mut gap, mut gaps) = (0, 0);
        for tick in 0..200_000_u64 {
            if tick > 0 && noise.uniform() > 0.98 && gap < 5 {
                gap += 1;
                continue;
            }
            // most are on time, some are late: the earliest ones show when ticks are due
            let late = (noise.uniform() - 0.5).max(0.0) * f64::from(PERIOD);
            let now = (clock * tick as f64 * f64::from(PERIOD) + late) as u64 & (u64::MAX >> (64 - bits));
            assert_eq!(missed.count(now as u32), gap, "tick {tick}, {bits} bits, clock {clock}");
            gaps += u32::from(gap > 0);
            gap = 0;
        }
        assert!(gaps > 1_500, "{gaps}");
    }
}

/// The axis makes up the ticks that its board reports: the estimates stand, and each gap is flagged once.
#[test]
fn an_axis_makes_up_the_ticks_that_its_board_has_missed() {
    let (mut axis, mut sound) = (governing(Scripted::sound()), governing(Scripted::sound()));
    for tick in 0..2_000 {
        sound.tick(CONFIG, WANTED);
        let missed = if tick % 100 == 99 { 1 + tick / 100 % 8 } else { 0 };
        axis.board().missed = missed as u32;
        axis.board().tick += missed;
        let found = axis.tick(CONFIG, WANTED).faults;
        axis.board().missed = 0;
        assert_eq!(found, if missed > 0 { Faults::TICK_MISSED } else { Faults::NONE }, "tick {tick}");
    }
    // not made up, each gap is a jump of the angle by its length: eight ticks at 30 rad/s are 31 counts of 8192. The
    // motor turns steadily whatever the torque, so that a prediction is off by the torque over the 0.7 kg m2 before the
    // rope, 8 ticks of it.
    let speed = |axis: &super::scripted::Whole<Scripted>| f64::from(axis.drive().estimate(CONFIG).motor_speed);
    let torque = f64::from(sound.tick(CONFIG, WANTED).torque).abs();
    assert!((speed(&axis) - speed(&sound)).abs() < torque / 0.7 * 8e-4 + 0.01, "{} {}", speed(&axis), speed(&sound));
}
