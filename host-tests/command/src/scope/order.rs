//! Orders of a channel: its Fourier coefficients over whole turns of an angle.

use std::f64::consts::TAU;

use rustfft::num_complex::Complex;
use serde::Serialize;

use crate::recording::unwrapped;

/// A share of a channel that repeats with the turns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Order {
    /// Times a turn.
    pub order: f64,
    /// Zero-to-peak amplitude.
    pub amplitude: f64,
    /// How far behind the angle's zero its peak comes (rad of the order), from -pi to pi.
    pub phase: f64,
}

/// Orders that are computed: halves up to 16.
const MOST: usize = 32;

/// The orders of values over an angle (turn), from the last whole turns; half orders from pairs of turns. The integral
/// goes over the angle by trapezoids, so the speed may change. An order needs more than two records in its period.
///
/// `None` where there is less than a turn.
pub fn orders(records: &[(f64, f64)]) -> Option<Vec<Order>> {
    let angle = unwrapped(&records.iter().map(|(angle, _)| TAU * angle).collect::<Vec<_>>());
    let unwrapped: Vec<(f64, f64)> =
        angle.iter().zip(records).map(|(angle, (_, value))| (angle / TAU, *value)).collect();
    let (start, end) = (unwrapped.first()?.0, unwrapped.last()?.0);
    let (way, turns) = ((end - start).signum(), (end - start).abs().floor());
    let (whole, step) = if turns >= 2.0 { (turns - turns % 2.0, 1) } else { (turns, 2) };
    if whole < 1.0 {
        return None;
    }
    let begin = end - way * whole;
    let first = unwrapped.iter().rposition(|(angle, _)| way * (end - angle) >= whole)?;
    let seen = (unwrapped.len() - first) as f64 / whole;
    let mut sums = [(0.0, 0.0); MOST];
    for pair in unwrapped[first..].windows(2) {
        let [(mut a, mut x), (b, y)] = [pair[0], pair[1]];
        if way * (end - a) > whole && a != b {
            // the interval in which the turns begin
            (a, x) = (begin, x + (y - x) * (begin - a) / (b - a));
        }
        // each half order is a turn of the one before: sine and cosine once a record, not once an order
        let half = |angle: f64| Complex::from_polar(1.0, 0.5 * TAU * angle);
        let (one, one_b) = (half(a), half(b));
        let (mut wave, mut wave_b) = (one, one_b);
        for (re, im) in &mut sums {
            *re += 0.5 * (x * wave.re + y * wave_b.re) * (b - a);
            *im += 0.5 * (x * wave.im + y * wave_b.im) * (b - a);
            (wave, wave_b) = (wave * one, wave_b * one_b);
        }
    }
    let of = |half: usize| {
        let (re, im) = sums[half - 1];
        let (re, im) = (2.0 * re / (end - begin), 2.0 * im / (end - begin));
        Order { order: half as f64 / 2.0, amplitude: re.hypot(im), phase: im.atan2(re) }
    };
    Some((step..=MOST).step_by(step).filter(|&half| (half as f64) < seen).map(of).collect())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::orders;

    /// A wave of known orders over an angle whose speed changes; 2e-3 is the trapezoids' error at 200 records a turn,
    /// `(2 pi k/200)^2/12` of the third order.
    #[test]
    fn orders_are_found_at_any_speed_and_in_both_directions() {
        for direction in [1.0, -1.0] {
            let records: Vec<(f64, f64)> = (0..1_090)
                .map(|n| {
                    let turned = direction * (f64::from(n) / 200.0 + 0.1 * (f64::from(n) / 300.0).sin());
                    let wave = |order: f64, phase: f64| (TAU * order * turned - phase).cos();
                    (turned.rem_euclid(1.0), 7.0 + 0.5 * wave(0.5, 0.0) + 3.0 * wave(1.0, 0.7) + wave(3.0, -1.2))
                })
                .collect();
            let found = orders(&records).unwrap();
            for (order, amplitude, phase) in [(0.5, 0.5, 0.0), (1.0, 3.0, 0.7), (3.0, 1.0, -1.2), (2.0, 0.0, 0.0)] {
                let one = found.iter().find(|one| one.order == order).unwrap();
                assert!((one.amplitude - amplitude).abs() < 2e-3, "{one:?} for {amplitude}");
                assert!(amplitude == 0.0 || (one.phase - phase).abs() < 5e-3, "{one:?} for {phase}");
            }
        }
    }

    /// An axis that reverses after 2.7 turns: the turns before the end count, not those beyond it.
    #[test]
    fn a_reversal_does_no_harm() {
        for end in (1_000..4_000).step_by(60) {
            let records: Vec<(f64, f64)> = (0..end)
                .map(|n| {
                    let turned = 2.7 * (0.85 * TAU * f64::from(n) / 8_000.0).sin();
                    (turned.rem_euclid(1.0), 5.0 + 2.0 * (TAU * turned).cos())
                })
                .collect();
            let Some(found) = orders(&records) else { continue };
            // 500 records a turn and more: the trapezoids' error is below `(2 pi/500)^2/12` of the sum, 7
            for one in found {
                let expected = if one.order == 1.0 { 2.0 } else { 0.0 };
                assert!((one.amplitude - expected).abs() < 1e-3, "{end}: {one:?}");
            }
        }
    }

    /// Sixteen records a turn show orders below 8; those above would be the mean and its neighbours again.
    #[test]
    fn orders_that_the_records_cannot_show_are_left_out() {
        let records: Vec<(f64, f64)> = (0..160).map(|n| (f64::from(n) / 16.0 % 1.0, 100.0)).collect();
        let found = orders(&records).unwrap();
        assert!(found.last().unwrap().order < 8.5 && found.iter().all(|one| one.amplitude < 1e-9), "{found:?}");
    }

    #[test]
    fn less_than_a_turn_has_no_orders() {
        assert!(orders(&[]).is_none() && orders(&[(0.1, 1.0)]).is_none());
        assert!(orders(&[(0.1, 1.0), (0.4, 1.0), (0.7, 1.0), (0.0, 2.0)]).is_none());
        // standing still
        assert!(orders(&[(0.3, 1.0); 50]).is_none());
    }
}
