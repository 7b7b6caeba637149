//! Angles that come round after a turn.

use std::f64::consts::{PI, TAU};

/// An angle that comes round after a turn, as it goes on: no step is beyond half a turn.
pub fn unwrapped(angle: &[f64]) -> Vec<f64> {
    let (mut turns, mut last) = (0.0, angle.first().copied().unwrap_or(0.0));
    let step = |&angle: &f64| {
        turns -= ((angle - last) / TAU).round();
        last = angle;
        angle + turns * TAU
    };
    angle.iter().map(step).collect()
}

/// The same where an angle does come round: it stays within a turn, and steps by more than half of one. `None` for one
/// that counts its turns, however fast.
pub(super) fn counted(angle: &[f64]) -> Option<Vec<f64>> {
    let (low, high) = angle.iter().fold((f64::MAX, f64::MIN), |(low, high), one| (low.min(*one), high.max(*one)));
    // a turn, and the rounding of what was written
    let is_wrapped = high - low < TAU * (1.0 + 1e-6) && angle.windows(2).any(|pair| (pair[1] - pair[0]).abs() > PI);
    is_wrapped.then(|| unwrapped(angle))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{counted, unwrapped};

    #[test]
    fn an_angle_that_comes_round_goes_on() {
        for step in [1.7, -1.7, 3.0] {
            let angle = |at: i32| 3.0 + step * f64::from(at);
            let wrapped: Vec<f64> = (0..50).map(|at| angle(at).rem_euclid(TAU)).collect();
            for (at, found) in (0..).zip(unwrapped(&wrapped)) {
                // rounding of sums of 150
                assert!((found - angle(at)).abs() < 1e-12, "{at}: {found}");
            }
        }
    }

    #[test]
    fn an_angle_that_counts_its_turns_stays() {
        let fast: Vec<f64> = (0..50).map(|at| 4.0 * f64::from(at)).collect();
        let swinging: Vec<f64> = (0..50).map(|at| 3.0 * (0.1 * f64::from(at)).sin()).collect();
        assert!(counted(&fast).is_none() && counted(&swinging).is_none() && counted(&[]).is_none());
        let wrapped: Vec<f64> = (0..50).map(|at| (0.5 * f64::from(at)).rem_euclid(TAU)).collect();
        // rounding of 25
        assert!((counted(&wrapped).unwrap()[49] - 24.5).abs() < 1e-13);
    }
}
