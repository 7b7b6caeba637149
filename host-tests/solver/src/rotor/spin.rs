//! How the shaft turns: speeds over time with a ripple, and the stretch of turning within a tick.

use std::f64::consts::TAU;

use super::error::{RotorError, check};

/// The turning of a shaft over a tick: angle and speed at both ends, a cubic between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Angle at the start (rad).
    pub angle: f64,
    /// Speed at the start (rad/s).
    pub speed: f64,
    /// Angle at the end (rad).
    pub end_angle: f64,
    /// Speed at the end (rad/s).
    pub end_speed: f64,
    /// Duration (s).
    pub duration: f64,
}

impl Turn {
    /// Angle, speed and its rate [rad, rad/s, rad/s2] at a share 0..1 of the tick.
    #[must_use]
    pub fn at(&self, share: f64) -> (f64, f64, f64) {
        let (h, s) = (self.duration, share);
        // the rest of the turn after its mean speed: Hermite's cubic
        let turned = self.end_angle - self.angle;
        let (a, b) = (self.speed * h - turned, turned - self.end_speed * h);
        let bend = s * (1.0 - s) * (a * (1.0 - s) + b * s);
        let rate = (1.0 - 2.0 * s) * (a * (1.0 - s) + b * s) + s * (1.0 - s) * (b - a);
        let second = -2.0 * (a * (1.0 - s) + b * s) + 2.0 * (1.0 - 2.0 * s) * (b - a);
        (self.angle + turned * s + bend, (turned + rate) / h, second / (h * h))
    }
}

/// A ripple of the speed, tied to the mean angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Waves a turn.
    pub order: f64,
    /// Amplitude, as a share of the speed.
    pub share: f64,
    /// Phase (rad).
    pub phase: f64,
}

/// A course of speed: straight lines between points, with ripples.
#[derive(Clone, Debug)]
pub struct Spin {
    /// Time, speed, and the mean angle reached [s, rad/s, rad].
    points: Vec<(f64, f64, f64)>,
    ripples: Vec<Ripple>,
}

impl Spin {
    /// A constant speed (rad/s).
    #[must_use]
    pub fn steady(speed: f64) -> Self {
        Spin { points: vec![(0.0, speed, 0.0)], ripples: Vec::new() }
    }

    /// Straight lines between points of time (s) and speed (rad/s); before the first and after the last the speed
    /// stays.
    ///
    /// # Errors
    /// No point, a number that is not finite, a time that does not follow the one before.
    pub fn through(points: &[(f64, f64)]) -> Result<Self, RotorError> {
        if points.is_empty() {
            return Err(RotorError::Count { name: "points of the speed", found: 0, expected: 1 });
        }
        let mut course: Vec<(f64, f64, f64)> = Vec::with_capacity(points.len());
        for (index, &(time, speed)) in points.iter().enumerate() {
            let place = || format!("point {index} of the speed");
            check("speed", place, speed, true, "a finite number")?;
            let angle = match course.last() {
                Some(&(before, from, angle)) => {
                    check("time", place, time, time > before, "later than the point before")?;
                    angle + 0.5 * (from + speed) * (time - before)
                }
                None => {
                    check("time", place, time, true, "a finite number")?;
                    speed * time
                }
            };
            course.push((time, speed, angle));
        }
        Ok(Spin { points: course, ripples: Vec::new() })
    }

    /// Adds a ripple.
    #[must_use]
    pub fn ripple(mut self, ripple: Ripple) -> Self {
        self.ripples.push(ripple);
        self
    }

    /// Angle and speed at a time [rad, rad/s].
    #[must_use]
    pub fn at(&self, time: f64) -> (f64, f64) {
        let next = self.points.partition_point(|&(at, ..)| at <= time);
        let (mean, speed) = match (next.checked_sub(1).map(|k| self.points[k]), self.points.get(next)) {
            (Some((at, speed, angle)), Some(&(then, end, _))) => {
                let (passed, rate) = (time - at, (end - speed) / (then - at));
                (angle + speed * passed + 0.5 * rate * passed * passed, speed + rate * passed)
            }
            (Some((at, speed, angle)), None) | (None, Some(&(at, speed, angle))) => {
                (angle + speed * (time - at), speed)
            }
            (None, None) => (0.0, 0.0),
        };
        let (mut turned, mut factor) = (0.0, 1.0);
        for &Ripple { order, share, phase } in &self.ripples {
            // the mean angle wrapped for the sine's argument, so that a long run keeps its digits
            let argument = order * mean.rem_euclid(TAU * 64.0) + phase;
            turned += share / order * argument.sin();
            factor += share * argument.cos();
        }
        (mean + turned, speed * factor)
    }

    /// The turning from a time on for a duration (s).
    #[must_use]
    pub fn turn(&self, time: f64, duration: f64) -> Turn {
        let (angle, speed) = self.at(time);
        let (end_angle, end_speed) = self.at(time + duration);
        Turn { angle, speed, end_angle, end_speed, duration }
    }
}
