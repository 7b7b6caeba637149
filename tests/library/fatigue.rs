//! Fatigue: the tick's rainflow count against the four-point rule applied to whole series, and against ASTM E1049's example.

use driveline::fatigue::{Classed, Counts, LifeRecord, Rainflow, TorqueClasses, WoehlerLine};
use driveline::fluctuation::Fluctuation;
use driveline::number::Fixed;
use driveline::sample::Estimate;

const CLASSES: usize = 64;
/// Classes of 1 N m.
const LIMIT: f64 = 32.0;
/// The class above zero torque, where a count starts.
const ZERO: u8 = 32;
const SINGLE: TorqueClasses<f32> = TorqueClasses::<f32>::new::<CLASSES>(LIMIT);
/// A base of 100 N m.
const FIXED: TorqueClasses<Fixed> = TorqueClasses::<Fixed>::new::<CLASSES>(LIMIT, 100.0);

type Count<N> = Rainflow<CLASSES, N>;

/// Feeds classes, each for three ticks, as torques in their middle.
fn counted<N: Classed>(series: &[u8], config: &TorqueClasses<N>, torque: impl Fn(f64) -> N) -> Counts<CLASSES> {
    let mut count = Count::<N>::default();
    for class in series {
        let shaft_torque = torque(f64::from(*class) - 0.5 * CLASSES as f64 + 0.5);
        let estimate = Estimate { shaft_torque, ..Estimate::default() };
        for _ in 0..3 {
            count.measure(config, 0, N::ZERO, &estimate);
        }
    }
    count.counts(config)
}

/// The rule as the standard has it, on a whole series that starts at zero torque: reversals first; then, of any four in
/// a row, the middle two are a cycle where their range is not greater than the ranges on either side; they are taken
/// out and the search begins again.
fn by_rule(series: &[u8]) -> ([u32; CLASSES], Vec<u8>) {
    let mut points: Vec<i32> = vec![ZERO.into()];
    for &value in series {
        let value = i32::from(value);
        match points[..] {
            [.., last] if last == value => {}
            [.., before, last] if (last - before).signum() == (value - last).signum() => {
                *points.last_mut().unwrap() = value;
            }
            _ => points.push(value),
        }
    }
    let mut cycles = [0; CLASSES];
    'search: loop {
        for at in 0..points.len().saturating_sub(3) {
            let [a, b, c, d] = points[at..at + 4] else { unreachable!() };
            let (left, inner, right) = ((b - a).abs(), (c - b).abs(), (d - c).abs());
            if inner <= left && inner <= right {
                cycles[inner as usize] += 1;
                points.drain(at + 1..at + 3);
                continue 'search;
            }
        }
        return (cycles, points.into_iter().map(|point| point as u8).collect());
    }
}

/// Marsaglia's generator (xorshift), for series that differ.
fn random(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

/// 1,000 random series: white, wandering and swinging, of up to 1,000 values. Counts are whole numbers, and equal.
#[test]
fn a_thousand_random_series_are_counted_as_by_the_rule() {
    let mut state = 88_172_645_463_325_252;
    let mut closed = 0;
    for number in 0..1_000_u32 {
        let length = 2 + random(&mut state) % 999;
        let mut place = 32.0_f64;
        let series: Vec<u8> = (0..length)
            .map(|at| {
                let white = (random(&mut state) % 64) as f64;
                place = match number % 3 {
                    0 => white,
                    1 => (place + (white - 31.5) / 6.0).clamp(0.0, 63.0),
                    _ => 32.0 + 20.0 * (0.3 * at as f64).sin() * (0.011 * at as f64).sin() + (white - 31.5) / 12.0,
                };
                place as u8
            })
            .collect();
        let (cycles, residue) = by_rule(&series);
        let single = counted(&series, &SINGLE, |torque| torque as f32);
        let fixed = counted(&series, &FIXED, |torque| Fixed::from_f64(torque / 100.0));
        assert_eq!((single.cycles(), single.residue(), single.lost()), (&cycles, &residue[..], 0), "{number}");
        assert_eq!((fixed.cycles(), fixed.residue(), fixed.lost()), (&cycles, &residue[..], 0), "{number}");
        closed += cycles.iter().sum::<u32>();
    }
    assert!(closed > 50_000, "{closed}");
}

/// ASTM E1049-85, figure 6: -2, 1, -3, 5, -1, 3, -4, 4, -2, of which the first is put at zero torque. Its one whole
/// cycle is 4 (from -1 to 3); the half cycles 3, 4, 8, 9, 8, 6 are the residue's ranges, from the standard's table.
#[test]
fn the_standard_s_example() {
    let series = [-2, 1, -3, 5, -1, 3, -4, 4, -2].map(|value: i8| ZERO.wrapping_add_signed(value + 2));
    let counts = counted(&series, &SINGLE, |torque| torque as f32);
    let mut cycles = [0; CLASSES];
    cycles[4] = 1;
    assert_eq!(counts.cycles(), &cycles);
    let ranges: Vec<u8> = counts.residue().windows(2).map(|pair| pair[0].abs_diff(pair[1])).collect();
    assert_eq!(ranges, [3, 4, 8, 9, 8, 6]);
    // Miner's sum of the same table: amplitudes are half the ranges.
    let line = WoehlerLine { knee: 2.5, cycles: 1e6, slope: 3.0, below: 5.0 };
    let each = |range: f64, share: f64| {
        let over = range / 5.0;
        share * over.powf(if over < 1.0 { 5.0 } else { 3.0 }) / 1e6
    };
    let halves: f64 = [3.0, 4.0, 8.0, 9.0, 8.0, 6.0].iter().map(|range| each(*range, 0.5)).sum();
    // exponential and logarithm to an ulp each
    assert!((counts.damage(&line) / (each(4.0, 1.0) + halves) - 1.0).abs() < 1e-13);
}

/// Time above a limit by the classes that begin there, largest torque, and their factor.
#[test]
fn times_and_peaks() {
    let config = SINGLE.with_period(1e-3);
    let mut count = Count::<f32>::default();
    for tick in 0..1_000 {
        let shaft_torque = if tick < 100 {
            25.5
        } else if tick < 130 {
            -27.25
        } else {
            3.5
        };
        count.measure(&config, 0, 0.0, &Estimate { shaft_torque, ..Estimate::default() });
    }
    let counts = count.counts(&config);
    // counts of ticks times the period
    for (limit, time) in [(20.0, 0.13), (25.0, 0.13), (26.0, 0.03), (28.0, 0.0), (3.0, 1.0), (99.0, 0.0)] {
        assert!((counts.time_above(limit) - time).abs() < 1e-12, "{limit}: {}", counts.time_above(limit));
    }
    assert_eq!(counts.largest(), 27.25);
}

/// The longest residue there can be fits: ranges that grow class by class to the whole and shrink again.
#[test]
fn the_longest_residue_fits() {
    let mut series = vec![ZERO];
    for range in (1..64).chain((1..63).rev()) {
        let last = *series.last().unwrap();
        series.push(if series.len() % 2 == 0 { last + range } else { last - range });
    }
    let (cycles, residue) = by_rule(&series);
    assert_eq!((cycles, residue.len()), ([0; CLASSES], 126));
    let counts = counted(&series, &SINGLE, |torque| torque as f32);
    assert_eq!((counts.cycles(), counts.residue(), counts.lost()), (&cycles, &residue[..], 0));
}

/// Reversals in every tick are more than a tick can count: the count says so.
#[test]
fn reversals_that_come_too_fast_are_reported() {
    let mut count = Count::<f32>::default();
    for tick in 0..2_000 {
        let shaft_torque = if tick % 2 == 0 { 10.5 } else { -10.5 };
        count.measure(&SINGLE, 0, 0.0, &Estimate { shaft_torque, ..Estimate::default() });
    }
    assert!(count.counts(&SINGLE).lost() > 0);
}

/// Noise about a boundary between two classes is no cycle, and does not hide the swings that are: 100 of them.
#[test]
fn noise_about_a_boundary_is_no_cycle() {
    let mut count = Count::<f32>::default();
    let mut at_rest = Count::<f32>::default();
    for tick in 0..100_000_u32 {
        let noise = if tick % 2 == 0 { 0.01 } else { -0.01 };
        let swing = if tick % 1_000 == 999 { 20.5 } else { 0.0 };
        count.measure(&SINGLE, 0, 0.0, &Estimate { shaft_torque: noise + swing, ..Estimate::default() });
        at_rest.measure(&SINGLE, 0, 0.0, &Estimate { shaft_torque: noise, ..Estimate::default() });
    }
    let counts = count.counts(&SINGLE);
    // from class 31 or 32 at rest to 52; the last swing is the residue's
    let swings: u32 = counts.cycles()[20..].iter().sum();
    assert_eq!((counts.lost(), swings, counts.cycles()[..20].iter().sum::<u32>()), (0, 99, 0));
    let counts = at_rest.counts(&SINGLE);
    assert_eq!((counts.lost(), counts.cycles().iter().sum::<u32>()), (0, 0));
}

/// A start and a stop close no cycle while the controller runs; switched off, they are one, of 20 classes: an amplitude
/// of 10 N m, four times that of the knee.
#[test]
fn a_start_and_a_stop_are_a_cycle_of_the_life() {
    let line = WoehlerLine { knee: 2.5, cycles: 1e6, slope: 3.0, below: 5.0 };
    let (mut life, mut count) = (LifeRecord::default(), Count::<f32>::default());
    for power_on in 1..=3 {
        for torque in [0.5, 20.5, 0.5] {
            let estimate = Estimate { shaft_torque: torque, ..Estimate::default() };
            (0..3).for_each(|_| count.measure(&SINGLE, 0, 0.0, &estimate));
        }
        let before = life;
        life.take(&mut count, &SINGLE, &line, 25.0);
        assert_eq!(life.damage, before.damage);
        life.close(&mut count, &SINGLE, &line, 25.0);
        // powers and sums of three, to an ulp each
        assert!((life.damage / (f64::from(power_on) * 64.0 / 1e6) - 1.0).abs() < 1e-13, "{life:?}");
    }
    assert_eq!(life.largest, 20.5);
}

/// A torque that is NaN is in no class: counts, times, residue and largest torque are those of the ticks without it.
#[test]
fn a_torque_that_is_no_number_is_left_out() {
    let (mut sound, mut broken) = (Count::<f32>::default(), Count::<f32>::default());
    for tick in 0..3_000_u32 {
        let torque = if tick / 10 % 2 == 0 { 12.5 } else { -7.5 };
        let shaft_torque = if tick % 7 == 3 { f32::NAN } else { torque };
        let estimate = Estimate { shaft_torque, ..Estimate::default() };
        broken.measure(&SINGLE, 0, 0.0, &estimate);
        if !shaft_torque.is_nan() {
            sound.measure(&SINGLE, 0, 0.0, &estimate);
        }
    }
    let (sound, broken) = (sound.counts(&SINGLE), broken.counts(&SINGLE));
    // from class 44 to 24, every 20 ticks; the start and the last half are the residue's
    assert_eq!((sound.cycles()[20], sound.largest()), (149, 12.5));
    assert_eq!(broken, sound);
}

/// A torque beyond the classes counts in the outermost, and the count says so; at their edge it does not.
#[test]
fn a_torque_beyond_the_classes_is_told() {
    for (torque, beyond) in [(31.9, false), (32.1, true), (-32.1, true), (300.0, true)] {
        let mut count = Count::<f32>::default();
        count.measure(&SINGLE, 0, 0.0, &Estimate { shaft_torque: torque, ..Estimate::default() });
        let counts = count.take(&SINGLE);
        assert_eq!(counts.exceeds_classes(), beyond, "{torque}");
        // a tick in the outermost class, which begins at 31 N m
        assert_eq!(counts.time_above(31.0), 1.0, "{torque}");
        assert!(!count.take(&SINGLE).exceeds_classes(), "taken");
    }
}
