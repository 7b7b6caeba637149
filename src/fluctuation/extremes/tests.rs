//! Single steps, and readings of cycles made by hand.

use super::*;

/// A cycle of so many quarters of a turn, in ticks of 10 ms; speeds are per unit of 2 rad/s.
fn quarters(count: u32) -> CycleConfig {
    CycleConfig {
        length: 1 << 30,
        last_segment: count - 1,
        whole: 0,
        part: 0,
        divisor: 1,
        angle: TAU / 4.0 * f64::from(count),
        period: 0.01,
        speed: 2.0,
        torque: 1.0,
    }
}

/// A speed that is the same in all three samples, at the foot of the cycle.
fn flat(speed: f64) -> Peak<i64> {
    Peak { value: speed.rank(), before: speed.rank(), after: speed.rank(), place: 1 << 30 }
}

/// An extreme between two samples of 5, where it is infinite, and the same in all three otherwise.
fn peak(speed: f64) -> Peak<i64> {
    let beside = if speed.is_infinite() { 5.0_f64.copysign(speed) } else { speed };
    Peak { value: speed.rank(), ..flat(beside) }
}

/// Two cycles of a turn: of 50.25 ticks, and of 25.25. The motor turns by 1/32 in a tick, so that the three ends are
/// half, a quarter and none of a tick before theirs. The cycle's foot is at a quarter of a turn either way.
fn finished() -> Extremes<f64> {
    let speed = TAU / 32.0 / 0.02;
    let edge = |tick, beyond, angle| Edge { tick, angle, beyond, speed };
    let edges = [edge(100, 1 << 26, 7), edge(150, 1 << 25, (1 << 30) + (1 << 25)), edge(175, 0, 1 << 30)];
    Extremes {
        forward: true,
        edges: [edges[0], edges[1], edges[2], Edge::default()],
        filed: 3,
        good: 2,
        finished: [[[flat(6.0), flat(5.0)]; 2], [[flat(-1.0), flat(1.0)]; 2]],
        ..Extremes::default()
    }
}

/// The angle over the time; a cycle needs both of its ends, a change those of two cycles.
#[test]
fn mean_and_change_are_by_the_ends_of_cycles() {
    let turn = quarters(4);
    let (mean, before) = (TAU / 0.2525, TAU / 0.5025);
    for (forward, sign) in [(true, 1.0), (false, -1.0)] {
        for good in 0..=3 {
            let extremes = Extremes { forward, good, ..finished() };
            let reading = extremes.reading(&turn);
            assert_eq!((reading.is_some(), extremes.mean(&turn).is_some()), (good >= 2, good >= 2));
            let Some(reading) = reading else { continue };
            // some roundings
            assert!((reading.mean - sign * mean).abs() < 1e-13 * mean, "{reading:?}");
            assert_eq!(extremes.mean(&turn), Some(reading.mean));
            assert!((reading.duration - 0.2525).abs() < 1e-15, "{reading:?}");
            assert_eq!(reading.change.is_some(), good == 3);
            assert!(reading.change.is_none_or(|change| (change - sign * (mean - before)).abs() < 1e-13 * mean));
            // 12 and 10 rad/s
            assert!((reading.load.delta - 2.0 / mean).abs() < 1e-15, "{reading:?}");
        }
    }
    // ends that are in the wrong order, or at the same time
    for (beyond, is_right) in [((1 << 25) - 1, true), (1 << 25, false), (1 << 26, false)] {
        let mut extremes = finished();
        (extremes.edges[2].tick, extremes.edges[2].beyond) = (150, beyond);
        assert_eq!(extremes.mean(&turn).is_some(), is_right, "{beyond}");
    }
}

/// A standing load has a reading, and so has one that stands for a moment.
#[test]
fn a_reading_has_speeds_of_one_sign() {
    const ENDLESS: f64 = f64::INFINITY;
    for (first, second, delta) in [
        (7.0, 5.0, Some(2.0)),
        (-7.0, -5.0, Some(2.0)),
        (0.0, 0.0, Some(0.0)),
        (5.0, 0.0, Some(5.0)),
        (0.0, -5.0, Some(5.0)),
        (5.0, -5.0, None),
        (0.5, -5.0, None),
        (ENDLESS, 5.0, None),
        (-5.0, -ENDLESS, None),
        (5.0, f64::NAN, None),
    ] {
        for place in 0..2 {
            let mut extremes = finished();
            extremes.finished[0][place] = [peak(first), peak(second)];
            let reading = extremes.reading(&quarters(4));
            assert_eq!(reading.is_some(), delta.is_some(), "{first} {second}");
            if let (Some(reading), Some(delta)) = (reading, delta) {
                let found = if place == 0 { reading.motor } else { reading.load };
                // the numbers are of 2 rad/s
                assert!((found.delta * reading.mean - 2.0 * delta).abs() < 1e-13, "{first} {second} {found:?}");
                assert!(found.max.speed >= found.min.speed);
            }
        }
        // that of the other cycle passes zero
        assert_eq!(Extremes { other: true, ..finished() }.reading(&quarters(4)), None);
    }
}

/// The parabola through -1, 0 and 1 has its vertex at `(before - after)/2` over the curvature, and there
/// `(before - after)/4` times that less; the last sample is at 1, four ticks on.
#[test]
fn an_extreme_is_at_the_vertex() {
    let turns = quarters(16);
    for (forward, speeds, place, speed, angle) in [
        // -1/2 over -3/2: a sixth
        (true, [9.0, 10.0, 9.5], 4.0, 20.0 + 1.0 / 24.0, 4.0 - 5.0 / 6.0 * 0.04 * 20.0),
        (false, [-9.0, -10.0, -9.5], 4.0, -20.0 - 1.0 / 24.0, 4.0 + 5.0 / 6.0 * 0.04 * 20.0),
        // into the cycle, whose angle is 8 pi
        (true, [9.0, 10.0, 9.0], 0.5, 20.0, 0.5 - 0.8 + 8.0 * PI),
        (false, [-9.0, -10.0, -9.0], 25.0, -20.0, 25.8 - 8.0 * PI),
        // no further than a sample
        (true, [0.0, 1.0, 1.5], 4.0, 2.75, 4.0),
        (true, [1.5, 1.0, 0.0], 4.0, 2.75, 4.0 - 0.16),
        // all the same
        (true, [10.0, 10.0, 10.0], 4.0, 20.0, 4.0 - 0.8),
        (true, [0.0, 0.0, 0.0], 0.0, 0.0, 0.0),
        // further than a cycle in four ticks: not a motion
        (true, [1e4, 1e4, 1e4], 4.0, 2e4, 4.0),
        (false, [-1e4, -1e4, -1e4], 4.0, -2e4, 4.0),
    ] {
        let segment = (place / TAU * 4.0) as u32;
        let foot = 1_u32 << 30;
        let from = foot.wrapping_add((place / RADIANS) as u64 as u32);
        let [before, value, after] = speeds.map(Ranked::rank);
        let found = Extremes { forward, ..finished() }
            .vertex(&turns, &Peak { value, before, after, place: super::place(from, segment) });
        // six bits less of the angle, and the rounding of a speed
        assert!((found.angle - angle).abs() < 1e-7 && (0.0..turns.angle).contains(&found.angle), "{found:?} {angle}");
        assert!((found.speed - speed).abs() < 1e-11, "{found:?} {speed}");
    }
}

/// A sample is less than half a turn from the middle of its segment, of which there are four to a turn.
#[test]
fn a_sample_is_in_the_turn_of_its_segment() {
    for (segment, within, turns) in [
        (0, 0.125, 0.125),
        (0, 0.62, 0.62),
        (0, 0.63, -0.37),
        (1, 0.87, 0.87),
        (1, 0.88, -0.12),
        (7, 0.38, 1.38),
        (7, 0.37, 2.37),
        (15, 0.38, 3.38),
        (15, 0.37, 4.37),
    ] {
        let from = (1_u32 << 30).wrapping_add((within * 4_294_967_296.0) as u32);
        for forward in [true, false] {
            let peak = Peak { place: super::place(from, segment), ..flat(1.0) };
            let found = Extremes { forward, ..finished() }.place(&quarters(16), &peak);
            assert!((found - TAU * turns).abs() < 1e-7, "{segment} {within} {found}");
        }
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

/// The work behind an end of a cycle begins so that an extreme is taken in the tick after a sample of the motor's,
/// which is in every fourth tick. A change of direction makes the cycles before worthless; three good ends of cycles
/// make two cycles.
#[test]
fn cycles_are_counted_from_their_second_end_on() {
    for (tick, expected) in [(1, Slice::Direction), (3, Slice::TakeMotorMax), (5, Slice::Direction)] {
        for (ahead, forward, good) in [(true, true, 2), (false, false, 2), (true, false, 0), (false, true, 0)] {
            let mut extremes = Extremes { slice: Slice::Direction, ahead, forward, good: 2, ..Extremes::default() };
            assert_eq!(step(&mut extremes, 0, tick), expected);
            let is_done = expected != Slice::Direction;
            assert_eq!((extremes.forward, extremes.good), if is_done { (ahead, good) } else { (forward, 2) });
        }
    }
    for (before, good, cycles) in [(0, 1, 0), (1, 2, 1), (2, 3, 1), (3, 3, 1)] {
        let mut extremes = Extremes { slice: Slice::Publish, good: before, filed: 6, ..Extremes::default() };
        assert_eq!(step(&mut extremes, 0, 1), Slice::Count);
        assert_eq!(step(&mut extremes, 0, 3), Slice::Watch);
        assert_eq!((extremes.good, extremes.cycles(), extremes.filed, extremes.other), (good, cycles, 7, true));
    }
}

/// What has been found at the end of a segment is void behind a disturbance; behind the end of a cycle it is not.
#[test]
fn a_disturbance_ends_the_search_for_an_end() {
    let slices = [Slice::Ahead, Slice::Behind, Slice::Advance, Slice::Retreat, Slice::Away, Slice::Jump, Slice::Beyond];
    let others = [Slice::Watch, Slice::Begin, Slice::NextCycle, Slice::ReadingFault, Slice::Count];
    for (slice, is_over) in slices.map(|slice| (slice, true)).into_iter().chain(others.map(|slice| (slice, false))) {
        let mut extremes = Extremes::<f64> { slice, good: 3, ..Extremes::default() };
        extremes.position.is_sure = true;
        extremes.disturb();
        assert_eq!((extremes.slice, extremes.good), (if is_over { Slice::Watch } else { slice }, 0));
        assert!(!extremes.position.is_sure);
    }
    for (slice, is_taking) in
        [(Slice::Watch, false), (Slice::LastCycle, false), (Slice::Direction, true), (Slice::Count, true)]
    {
        assert_eq!(Extremes::<f64> { slice, ..Extremes::default() }.is_taking(), is_taking);
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
