//! The series of slowness and torque in closed form, and windows that can and cannot be used.

use super::super::CycleConfig;
use super::*;

/// A slowness of one with this first order.
fn of(cos: f64, sin: f64) -> FourierSeries {
    let mut series = FourierSeries::constant(1.0);
    series.orders[0] = Order { cos, sin };
    series
}

fn ripple(cos: f64, sin: f64) -> Ripple {
    Ripple::of(of(cos, sin), 10.0, 0.0, TAU, 1, 1)
}

/// The antiderivative of `e^(j n theta)` over the ticks, times `x/sin x - 1`.
#[test]
fn ticks_are_beyond_their_integral_as_by_the_closed_form() {
    for (turned, speed, n) in [(0.4_f64, 0.02_f64, 1), (1.3, 0.2, 3), (2.0, 0.05, 9), (0.7, 0.6, 1)] {
        let (cos, sin) = Part { turned, speed }.sampled(&FourierSeries::constant(1.0), n);
        let n = f64::from(n);
        let x = 0.5 * n * speed;
        let share = (x / x.sin() - 1.0) / (n * speed);
        // the next term of x/sin x, and what some units in the last place of the sine leave of a small difference
        let left = (127.0 / 604_800.0 * x.powi(8) * 1.1 + 2e-15) / (n * speed);
        let (s, c) = (n * turned).sin_cos();
        assert!((cos - share * s).abs() < left && (sin + share * c).abs() < left, "{cos} {sin} {share}");
    }
    // the turn of a tick by the slowness there
    let slow = Part { turned: 0.0, speed: 0.2 }.sampled(&of(1.0, 0.0), 1);
    assert_eq!(slow, Part { turned: 0.0, speed: 0.1 }.sampled(&FourierSeries::constant(1.0), 1));
}

/// Ticks spread evenly over a bin: the mean of `cos(n e)` is `sin(h/2)/(h/2)`, with `h` the order's turn over it.
#[test]
fn a_bin_counts_its_ticks_as_the_integral_over_it() {
    let ticks = 12_000.0;
    let mut window = Window { bins: [Bin::<f64>::default(); 8], edges: [Edge::default(); 4], cycles: 1, forward: true };
    let Bin { ticks: count, first, second, .. } = even(12_000);
    window.bins[2] = Bin { ticks: count, first, second, torque: 0.0 };
    for n in [1, 2] {
        let found = window.counted(n);
        let n = f64::from(n);
        let h = n * TAU / 8.0;
        // the polynomial is without the sixth power
        let expected = ticks * ((0.5 * h).sin() / (0.5 * h) + f64::powi(h, 6) / 322_560.0);
        let (s, c) = (n * TAU / 8.0 * 2.5).sin_cos();
        // the next term, h^8/92897280, and rounding
        let left = ticks * (f64::powi(h, 8) / 9e7 + 1e-12);
        assert!((found.cos - expected * c).abs() < left && (found.sin - expected * s).abs() < left, "{n} {found:?}");
    }
    // all of them at the bin's end, 511.5/1024 and 127.9/256 from its middle, rounded down: there the parabola and the
    // cubic are farthest off, by h^3 (1/24 - 1/40)/2
    let bin = &mut window.bins[2];
    (bin.first, bin.second) = (511 * 12_000, 127 * 127 * 12_000);
    let found = window.counted(1);
    let (s, c) = (TAU / 8.0 * (2.5 + 511.5 / 1024.0)).sin_cos();
    let off = (found.cos / ticks - c).hypot(found.sin / ticks - s);
    assert!(off < f64::powi(TAU / 8.0, 3) / 120.0, "{off}");
    // more than the squares have room for: an even spread, whatever their sum; here about the middle, and a tenth
    // beside it, where the cubic is off by h^3/10 (1/24 - 1/40 + 1/600)
    for beside in [0.0, 0.1] {
        let (ticks, h) = (f64::from(1 << 19), TAU / 8.0);
        let first = (ticks * (1024.0 * beside - 0.5)) as i32;
        window.bins[2] = Bin { ticks: 1 << 19, first, second: 12_345, torque: 0.0 };
        let (found, expected) = (window.counted(1), ticks * (0.5 * h).sin() / (0.5 * h));
        let (s, c) = (h * (2.5 + beside)).sin_cos();
        let left = ticks * (f64::powi(h, 6) / 3e5 + beside * f64::powi(h, 3) * (1.0 / 60.0 + 1.0 / 600.0));
        let off = (found.cos - expected * c).hypot(found.sin - expected * s);
        assert!(off < left, "{beside}: {off} {left}");
    }
}

/// Forty cycles with one tick or two at the same places of a bin each: the sum is theirs.
#[test]
fn a_few_ticks_count_where_they_are() {
    for places in [&[0.21][..], &[-0.37], &[-0.3, 0.3], &[-0.44, 0.1]] {
        let mut bins = [Bin::<f64>::default(); 8];
        for place in places {
            bins[5].ticks += 40;
            bins[5].first += 40 * f64::floor(place * 1024.0) as i32;
            bins[5].second += 40 * f64::floor(place * 256.0).powi(2) as u32;
        }
        let window = Window { bins, edges: [Edge::default(); 4], cycles: 40, forward: true };
        for n in [1, 2] {
            let h = f64::from(n) * TAU / 8.0;
            let (found, count) = (window.counted(n), 40.0 * places.len() as f64);
            let sum = |of: fn(f64) -> f64| places.iter().map(|place| 40.0 * of(h * (5.5 + place))).sum::<f64>();
            // half a unit of the distance, and of the squares half of twice the 0.44 that is rounded
            let left = count * (h / 2048.0 + 0.5 * h * h * 0.44 / 256.0);
            let off = (found.cos - sum(f64::cos)).hypot(found.sin - sum(f64::sin));
            assert!(off < left, "{places:?} {n}: {off} {left}");
        }
    }
}

fn config(turns: u32, torque: f64) -> WaveformConfig {
    let cycle = CycleConfig {
        length: 1 << 30,
        last_segment: 4 * turns - 1,
        whole: 0,
        part: 0,
        divisor: 1,
        angle: TAU * f64::from(turns),
        period: 0.01,
        speed: 1.0,
        torque,
    };
    WaveformConfig { cycle, cycles: 1, scale: 1 << 21, per_segment: 2 }
}

/// Ticks spread evenly over a bin: of whole numbers from -128 to 127 the mean square is 2^16/12 + 1/6.
fn even(ticks: u32) -> Bin<f64> {
    let second = (65_536.0 / 12.0 + 1.0 / 6.0) * f64::from(ticks);
    Bin { ticks, first: -(ticks as i32) / 2, second: second as u32, torque: 0.0 }
}

/// A steady motion of so many ticks, ends of cycles in whole ticks.
fn steady(cycles: u32, ticks: u32, speed: f64) -> Window<f64, 8> {
    let edges = [0, ticks / cycles, ticks - ticks / cycles, ticks].map(|tick| Edge { tick, speed, ..Edge::default() });
    Window { bins: [even(ticks / 8); 8], edges, cycles, forward: speed >= 0.0 }
}

/// The mean of a sine over a bin is that of its ends' integral. A bin without a tick has the torque of the one
/// before it, the first that of the last.
#[test]
fn the_torque_is_that_of_the_bins() {
    let mut window = steady(1, 8_000, 1.0);
    let width = TAU / 8.0;
    for (index, bin) in (0_u32..).zip(&mut window.bins) {
        let [from, to] = [index, index + 1].map(|index| width * f64::from(index));
        bin.torque = 1_000.0 * (5.0 + (to.sin() - from.sin() + 0.5 * (from.cos() - to.cos())) / width);
    }
    let found = window.motor_torque(&config(1, 2.0), 1);
    // some roundings
    let off = [found.mean - 10.0, found.order(1).cos - 2.0, found.order(1).sin - 1.0];
    assert!(off.iter().all(|off| off.abs() < 1e-13), "{found:?}");
    for (index, bin) in (0_u32..).zip(&mut window.bins) {
        let ticks = if index == 0 || index == 4 { 0 } else { 1_000 };
        (bin.ticks, bin.torque) = (ticks, f64::from(ticks * index));
    }
    // 7, 1, 2, 3, 3, 5, 6 and 7
    assert_eq!(window.motor_torque(&config(1, 2.0), 0).mean, 2.0 * 34.0 / 8.0);
}

#[test]
fn a_speed_against_the_mean_is_seen() {
    let mut ripple = ripple(0.1, 0.0);
    assert!(ripple.turns_one_way());
    for (speed, mean, is_so) in [(0.0, 10.0, false), (-1.0, 10.0, false), (1.0, -10.0, false), (1.0, 10.0, true)] {
        (ripple.motor.min.speed, ripple.mean) = (speed, mean);
        ripple.motor.max.speed = mean;
        assert_eq!(ripple.turns_one_way(), is_so, "{speed} {mean}");
    }
}

/// The slowness is least a little before the cycle's end, or at its beginning.
#[test]
fn extremes_are_within_the_cycle() {
    for (phase, expected) in [(-0.001, TAU - 0.001), (0.001, 0.001), (0.0, 0.0)] {
        let (sin, cos) = f64::sin_cos(phase);
        let angle = ripple(-0.1 * cos, -0.1 * sin).motor.max.angle;
        // Newton's method ends within rounding of a turn
        assert!((angle - expected).abs() < 1e-14, "{phase}: {angle}");
    }
}
