//! The angle between the teeth, with jitter, bounces, lost and doubled edges, and at a standstill.

use driveline::fault::Faults;
use driveline::settings::Teeth;
use driveline::wheel::{ToothedWheel, ToothedWheelConfig};

use super::edges::{Random, Run, TIMING, clock};

const TEETH: Teeth<58> = Teeth::gap(60, 2);
const WHEEL: ToothedWheelConfig<58> = ToothedWheelConfig::new(&TEETH, TIMING);
const RUN: Run = Run { speed: 20.0, ripple: 0.0, order: 2.0, jitter: 0.0, seed: 1 };

/// Rms and largest error of the angle (degree) and its own rms deviation in ticks of 1 ms, and the share of the ticks
/// with an angle from `from` turns on.
struct Errors {
    rms: f64,
    largest: f64,
    own: f64,
    share: f64,
}

fn errors<const TEETH: usize>(
    config: &ToothedWheelConfig<TEETH>,
    run: &Run,
    edges: &[f64],
    [from, to]: [f64; 2],
) -> Errors {
    let mut wheel = ToothedWheel::<()>::default();
    let mut edges = edges.iter().peekable();
    let (mut ticks, mut known, mut squares, mut own, mut largest) = (0, 0, 0.0, 0.0, 0.0_f64);
    for tick in 1.. {
        let now = f64::from(tick) * 1e-3;
        let turns = run.turns(now);
        if turns > to {
            break;
        }
        while let Some(edge) = edges.next_if(|edge| **edge <= now) {
            wheel.tooth(config, clock(*edge));
        }
        let angle = wheel.at(config, clock(now));
        if turns < from {
            continue;
        }
        ticks += 1;
        if let Ok(angle) = angle {
            known += 1;
            let error = f64::from(angle.angle) / 4_294_967_296.0 - turns;
            let error = (error - error.round()) * 360.0;
            squares += error * error;
            own += (f64::from(angle.deviation) / 4_294_967_296.0 * 360.0).powi(2);
            largest = largest.max(error.abs());
        }
    }
    let n = f64::from(known.max(1));
    Errors { rms: (squares / n).sqrt(), largest, own: (own / n).sqrt(), share: f64::from(known) / f64::from(ticks) }
}

#[test]
fn the_angle_runs_from_tooth_to_tooth_and_through_the_gap() {
    let run = Run { ripple: 0.05, ..RUN };
    let found = errors(&WHEEL, &run, &run.edges(&TEETH, 40), [2.0, 38.0]);
    // The gap is the worst: three places run through at the speed of the place before. The speed changes by up to
    // 2 pi 2 0.05 a turn, over the two places between their middles by 0.021, hence over 18 degrees by 0.38.
    assert!(found.share == 1.0 && found.largest < 0.42 && found.rms < 0.15, "{} {}", found.largest, found.rms);
}

/// A fifth of the pitch from tooth to tooth at three deviations: each edge by 0.2/3/sqrt(2) of it and more.
#[test]
fn jitter_of_a_fifth_is_smoothed_and_stated() {
    for (ripple, seed) in [(0.0, 1), (0.02, 2), (0.02, 3)] {
        let run = Run { ripple, seed, jitter: 0.06, ..RUN };
        let found = errors(&WHEEL, &run, &run.edges(&TEETH, 100), [8.0, 98.0]);
        // One edge is off by 0.36 degrees.
        assert!(found.share > 0.99 && found.rms < 0.4, "{} {}", found.rms, found.share);
        // The deviation that it states is the error's within a factor of two.
        assert!(found.own < 2.0 * found.rms && found.own > 0.5 * found.rms, "{} {}", found.own, found.rms);
    }
}

/// Of a clean wheel one edge in a hundred is lost, doubled or followed by a bounce.
#[test]
fn bounces_lost_and_doubled_edges_leave_the_angle() {
    let clean = RUN.edges(&TEETH, 60);
    for seed in 1..4 {
        let mut random = Random(seed);
        let mut edges = Vec::new();
        for (index, &edge) in clean.iter().enumerate() {
            let defect = if index > 130 { random.even() } else { 1.0 };
            match defect {
                _ if defect < 0.01 => continue,
                _ if defect < 0.02 => edges.extend([edge, edge + 0.3 / 1200.0]),
                _ if defect < 0.03 => edges.extend([edge, edge + 2e-5, edge + 4e-5]),
                _ => edges.push(edge),
            }
        }
        let found = errors(&WHEEL, &RUN, &edges, [2.0, 58.0]);
        // While a lost edge is overdue there is no angle for half a pitch of one in a hundred.
        assert!(found.share > 0.97 && found.largest < 0.1, "{} {}", found.largest, found.share);
    }
}

#[test]
fn a_lost_place_is_found_at_the_next_gap() {
    let mut edges = RUN.edges(&TEETH, 20);
    // Ten teeth stay away, as with a loose plug.
    edges.drain(600..610);
    let found = errors(&WHEEL, &RUN, &edges, [10.0, 19.0]);
    // Lost in the eleventh turn, at its 20th tooth; found at its end.
    assert!(found.largest < 0.1 && found.share > (9.0 - 0.72) / 9.0, "{} {}", found.largest, found.share);
}

const MISSING: Result<u32, Faults> = Err(Faults::ANGLE_MISSING);

#[test]
fn a_wheel_that_stops_gives_no_angle_for_good() {
    let mut wheel = ToothedWheel::<()>::default();
    // 1000 counts to a place.
    for place in (0..191).filter(|place| place % 60 < 58) {
        wheel.tooth(&WHEEL, place * 1000);
    }
    let mut at = |now: u32| wheel.at(&WHEEL, now).map(|angle| angle.angle >> 16);
    // Places 10 and 11 of 60, to 2^-16 turn: half a place after the last tooth.
    assert_eq!(at(190_500), Ok((10.5 / 60.0 * 65_536.0) as u32));
    assert_eq!(at(191_501), MISSING);
    assert_eq!(at(197_000), MISSING);
    // Nor does it when the clock has come round.
    assert_eq!(at(190_000), MISSING);
    assert_eq!(at(190_500), MISSING);
}

/// Constants and times that nobody made stop no interrupt.
#[test]
fn any_times_are_taken() {
    let mut random = Random(7);
    for turns in [1, 0, u32::MAX] {
        let mut config = WHEEL;
        (config.turns, config.slowest, config.sector) = (turns, u32::MAX, turns);
        let mut wheel = ToothedWheel::<driveline::wheel::CycleTimes<58>>::default();
        let mut time = 0_u32;
        for k in 0..20_000 {
            time = time.wrapping_add((random.even() * f64::from(1_u32 << (k % 32))) as u32);
            wheel.tooth(&config, time);
            wheel.index(&config);
            wheel.cam(&config, &driveline::wheel::Cam { edges: [0, 1 << 31], tolerance: u32::MAX }, time);
            let _ = (wheel.at(&config, time.wrapping_sub(50)), wheel.take());
        }
    }
}
