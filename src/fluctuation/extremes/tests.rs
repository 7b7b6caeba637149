//! Single steps from states made by hand.

use super::*;

/// A cycle of so many quarters of a turn, in ticks of 10 ms.
fn quarters(count: u32) -> CycleConfig {
    CycleConfig {
        length: 1 << 30,
        last_segment: count - 1,
        whole: 0,
        part: 0,
        divisor: 1,
        angle: TAU / 4.0 * f64::from(count),
        period: 0.01,
        speed: 1.0,
        torque: 1.0,
    }
}

/// Of equal samples the first is the extreme.
#[test]
fn a_sample_is_compared_one_sample_later() {
    let at = |value| Peak { value, before: value, after: value, place: 1 };
    for (last, max, min) in [
        (7, Peak { value: 7, before: 5, after: 4, place: 9 }, at(3)),
        (5, at(5), at(3)),
        (3, at(5), at(3)),
        (2, at(5), Peak { value: 2, before: 3, after: 4, place: 9 }),
    ] {
        let mut speed = Speed { last, max: at(5), min: at(3) };
        speed.follow(4, || 9);
        assert_eq!(speed, Speed { last: 4, max, min });
        assert_eq!(speed.fresh(6), Peak { value: 4, before: 4, after: 4, place: 6 });
    }
}

/// A slice's work, in this tick at this angle.
fn step(extremes: &mut Extremes<f64>, angle: u32, tick: u32) -> Slice {
    extremes.position.is_sure = true;
    extremes.slice(&CycleConfig { whole: 5, ..quarters(4) }, angle, tick, &Estimate::default());
    extremes.slice
}

/// The end of a segment belongs to the next one; that of a cycle is here five units beyond its last segment's.
#[test]
fn ends_are_in_what_follows() {
    for (within, expected) in [((1 << 30) - 1, Slice::Watch), (1 << 30, Slice::Ahead), ((1 << 30) + 1, Slice::Ahead)] {
        let mut extremes = Extremes { slice: Slice::Watch, ..Extremes::default() };
        assert_eq!(step(&mut extremes, within, 1), expected, "{within}");
        assert_eq!(extremes.edge.beyond, within.saturating_sub(1 << 30));
    }
    for (beyond, expected) in [(4, Slice::Watch), (5, Slice::NextCycle), (6, Slice::NextCycle)] {
        let mut extremes = Extremes::default();
        assert_eq!(step(&mut extremes, 0, 1), Slice::Watch);
        (extremes.slice, extremes.edge.beyond) = (Slice::Beyond, beyond);
        assert_eq!(step(&mut extremes, 0, 3), expected, "{beyond}");
    }
}

/// Of four ticks the first and the third are slices of the work, the second samples the load's speed and the fourth
/// the motor's.
#[test]
fn ticks_take_turns() {
    let mut extremes = Extremes::<f64>::default();
    let estimate = Estimate { motor_speed: 3.0, load_speed: 2.0, ..Estimate::default() };
    let (motor, load) = (3.0_f64.rank(), 2.0_f64.rank());
    for (angle, slice, samples) in [
        (0, Slice::Watch, [0, 0]),
        (1 << 30, Slice::Watch, [0, load]),
        (1 << 30, Slice::Ahead, [0, load]),
        (1 << 30, Slice::Ahead, [motor, load]),
    ] {
        extremes.measure(&quarters(4), angle, 0.0, &estimate);
        assert_eq!((extremes.slice, [extremes.motor.last, extremes.load.last]), (slice, samples));
    }
}
