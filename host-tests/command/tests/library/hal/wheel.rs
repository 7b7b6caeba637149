//! The angle from the teeth of a 60-2 wheel.

use driveline::fault::Faults;
use driveline::hal::{ToothedWheel, Wheel};

/// Counts of the timer a second.
pub const CLOCK: f64 = 1e6;
/// 60 places, two of them without a tooth; a tooth within 0.1 s.
pub const WHEEL: Wheel = Wheel { places: 60, missing: 2, slowest: 100_000 };

/// Times of the teeth of a wheel whose angle is `turns(t)` [turns], for places up to `end`, and the place of each; the
/// gap is before place 0.
pub fn teeth(time_of: impl Fn(f64) -> f64, end: u32) -> Vec<(u32, u32)> {
    (0..end)
        .filter(|place| place % 60 < 58)
        .map(|place| (place, (time_of(f64::from(place) / 60.0) * CLOCK).round() as u32))
        .collect()
}

#[test]
fn the_angle_runs_from_tooth_to_tooth_and_through_the_gap() {
    // 25 turns a second, and a third more within ten turns
    let time_of = |turns: f64| ((1.0 + turns / 15.0).sqrt() - 1.0) * 30.0 / 25.0;
    let turns_at = |time: f64| ((time * 25.0 / 30.0 + 1.0).powi(2) - 1.0) * 15.0;
    let mut wheel = ToothedWheel::new(WHEEL);
    let mut teeth = teeth(time_of, 600).into_iter().peekable();
    let (mut worst, mut known) = (0.0_f64, 0);
    let first_known = (time_of(2.0) * CLOCK) as u32;
    for now in (0..(time_of(9.9) * CLOCK) as u32).step_by(100) {
        while let Some(&(_, time)) = teeth.peek().filter(|&&(_, time)| time <= now) {
            wheel.tooth(time);
            teeth.next();
        }
        let Ok(angle) = wheel.at(now) else {
            assert!(now <= first_known + 100, "not known at {now}, though two gaps have passed");
            continue;
        };
        known += 1;
        let exact = turns_at(f64::from(now) / CLOCK);
        let error = f64::from(angle) / 4_294_967_296.0 - exact;
        worst = worst.max((error - error.round()).abs());
    }
    // The gap is the worst: three teeth long, run through at the speed of the tooth before it. From the middle of the
    // one to that of the other there are two teeth, in which the speed grows by 1/30 a turn at first, hence by 1/900.
    // Two edges are half a count off, which the gap takes three times, and so is the edge that it starts from: 3.5
    // counts of 31,000 a turn at the end.
    assert!(worst < 3.0 / 60.0 / 900.0 + 3.5 / 31_000.0, "{worst}");
    assert!(known > 2_000, "{known}");
}

const MISSING: Result<u32, Faults> = Err(Faults::ANGLE_MISSING);

/// A wheel at 25 turns a second that has been seen for three turns and ten teeth, and the time of its last tooth.
fn turning() -> (ToothedWheel, u32) {
    let mut wheel = ToothedWheel::new(WHEEL);
    let teeth = teeth(|turns| turns / 25.0, 191);
    for &(_, time) in &teeth {
        wheel.tooth(time);
    }
    (wheel, teeth[teeth.len() - 1].1)
}

#[test]
fn a_wheel_that_stops_gives_no_angle_for_good() {
    let (mut wheel, last) = turning();
    assert!(wheel.at(last + 600).is_ok());
    // a tooth takes 667 counts
    assert_eq!(wheel.at(last + 1001), MISSING);
    // nor does it when the timer has come round
    assert_eq!(wheel.at(last), MISSING);
    assert_eq!(wheel.at(last.wrapping_add(600)), MISSING);
}

#[test]
fn the_angle_waits_for_a_late_tooth() {
    let (mut wheel, last) = turning();
    let at_tooth = wheel.at(last + 667).unwrap();
    assert_eq!(wheel.at(last + 900), Ok(at_tooth));
}

#[test]
fn a_tooth_too_few_or_too_many_loses_the_place_until_two_gaps_agree() {
    for times in [vec![1333], vec![300, 667]] {
        let (mut wheel, last) = turning();
        for time in times {
            wheel.tooth(last + time);
        }
        assert_eq!(wheel.at(last + 1400), MISSING);
        // place 12 on: to the gap, a turn, and the gap again
        let all = teeth(|turns| turns / 25.0, 400);
        let mut found = None;
        for &(place, time) in all.iter().filter(|(_, time)| *time > last + 1400) {
            wheel.tooth(time);
            if wheel.at(time).is_ok() && found.is_none() {
                found = Some(place);
            }
        }
        assert_eq!(found, Some(300));
    }
}

#[test]
fn a_single_missing_tooth_is_not_mistaken_for_a_lost_one() {
    // 36-1: a lost tooth looks like the gap
    let mut wheel = ToothedWheel::new(Wheel { places: 36, missing: 1, slowest: 100_000 });
    let mut angles = Vec::new();
    for place in (0..36 * 5).filter(|place| place % 36 != 35 && *place != 36 * 3 + 9) {
        wheel.tooth(place * 1000);
        if let Ok(angle) = wheel.at(place * 1000) {
            let exact = (u64::from(place % 36) << 32) / 36;
            angles.push((place, u64::from(angle).abs_diff(exact)));
        }
    }
    // known from the second gap to the tooth that is lost, and from the second gap behind that
    let known: Vec<_> = angles.iter().map(|(place, _)| *place).collect();
    let expected: Vec<_> = (72..117).filter(|place| place % 36 != 35).collect();
    assert_eq!(known, expected);
    assert!(angles.iter().all(|&(_, error)| error < 36), "{angles:?}");
}
