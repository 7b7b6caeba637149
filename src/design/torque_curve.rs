//! Largest torque of a prime mover against its speed.

use super::Error;
use crate::machine::{Characteristic, Speed};
use crate::math::sqrt;

/// Largest torque against speed, by straight lines through `K` points; level beyond the last.
///
/// A power limit P is put in at the points: between two whose speeds differ by a ratio r the line lies above P/omega by
/// at most `(sqrt(r) - 1/sqrt(r))^2/4` of it (0.23 % at r = 1.1), its chord's excess.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueCurve<const K: usize> {
    points: [[f64; 2]; K],
}

impl<const K: usize> TorqueCurve<K> {
    /// A curve through points of speed (rad/s), the first of them at zero and each above the last, and torque (N m).
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_through`](Self::try_through)
    /// returns.
    #[must_use]
    pub const fn through(points: [[f64; 2]; K]) -> Self {
        match Self::try_through(points) {
            Ok(curve) => curve,
            Err(error) => error.stop(),
        }
    }

    /// [`through`](Self::through), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::TorqueCurve`].
    pub const fn try_through(points: [[f64; 2]; K]) -> Result<Self, Error> {
        let mut k = 0;
        while k < K {
            let [speed, torque] = points[k];
            let follows = if k == 0 { speed == 0.0 } else { speed > points[k - 1][0] };
            if !(follows && speed.is_finite() && torque >= 0.0 && torque.is_finite()) {
                return Err(Error::TorqueCurve);
            }
            k += 1;
        }
        if K == 0 { Err(Error::TorqueCurve) } else { Ok(TorqueCurve { points }) }
    }

    /// The largest torque of a prime mover at these speeds (rad/s), the first of them zero. It is zero where the mover
    /// brakes; below idle it is an engine's at idle, since the engine is not to stall by its limit.
    ///
    /// ```
    /// # use driveline::design::TorqueCurve;
    /// # use driveline::machine::{Characteristic, Combustion, CombustionType, Speed, Torque};
    /// const RATED: (Speed, Torque) = (Speed(200.0), Torque(1500.0));
    /// const ENGINE: Characteristic =
    ///     Characteristic::Combustion(Combustion::new(CombustionType::Spark, RATED, Speed(70.0), Speed(210.0)));
    /// const LIMIT: TorqueCurve<5> = TorqueCurve::of(&ENGINE, [0.0, 70.0, 135.0, 200.0, 210.0]);
    /// assert!(LIMIT.interpolation_error(&ENGINE) < 0.03 * 1500.0);
    /// ```
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_of`](Self::try_of) returns.
    #[must_use]
    pub const fn of(mover: &Characteristic, speeds: [f64; K]) -> Self {
        match Self::try_of(mover, speeds) {
            Ok(curve) => curve,
            Err(error) => error.stop(),
        }
    }

    /// [`of`](Self::of), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::TorqueCurve`].
    pub const fn try_of(mover: &Characteristic, speeds: [f64; K]) -> Result<Self, Error> {
        let mut points = [[0.0; 2]; K];
        let mut k = 0;
        while k < K {
            let speed = match mover {
                Characteristic::Combustion(engine) if speeds[k] < engine.idle => engine.idle,
                _ => speeds[k],
            };
            let torque = mover.torque(Speed(speed)).0;
            points[k] = [speeds[k], if torque < 0.0 { 0.0 } else { torque }];
            k += 1;
        }
        Self::try_through(points)
    }

    /// Bound of the difference to the prime mover (N m) that the curve was made [`of`](Self::of), from its first point
    /// to its last.
    ///
    /// A line between two points a distance h apart differs by at most `h^2/8` of the largest second derivative
    /// between them. A corner within, of a step d in slope at the distances x and h - x, adds `d x (h - x)/h`. Both
    /// are in closed form for every prime mover.
    #[must_use]
    pub const fn interpolation_error(&self, mover: &Characteristic) -> f64 {
        let mut largest = 0.0;
        let mut k = 1;
        while k < K {
            let (from, to) = (self.points[k - 1][0], self.points[k][0]);
            let length = to - from;
            let mut bound = 0.125 * length * length * curvature(mover, from, to);
            let corners = corners(mover);
            let mut corner = 0;
            while corner < corners.len() {
                let (at, step) = corners[corner];
                if at > from && at < to {
                    bound += step.abs() * (at - from) * (to - at) / length;
                }
                corner += 1;
            }
            if bound > largest {
                largest = bound;
            }
            k += 1;
        }
        largest
    }

    /// The curve with no more than `power` (W) at each of its points.
    #[must_use]
    pub const fn with_power_limit(mut self, power: f64) -> Self {
        let mut k = 0;
        while k < K {
            let [speed, torque] = self.points[k];
            if speed * torque > power {
                self.points[k][1] = power / speed;
            }
            k += 1;
        }
        self
    }

    /// The points: speed (rad/s), torque (N m).
    #[must_use]
    pub const fn points(&self) -> &[[f64; 2]; K] {
        &self.points
    }
}

/// Largest second derivative of a characteristic (N m s2/rad2) between two speeds, either way.
const fn curvature(mover: &Characteristic, from: f64, to: f64) -> f64 {
    match mover {
        Characteristic::Line(_) | Characteristic::Shunt(_) => 0.0,
        Characteristic::Parabola(parabola) => 2.0 * parabola.square.abs(),
        Characteristic::Series(motor) => {
            // It falls with the speed.
            let current = motor.current(Speed(from));
            6.0 * motor.flux
                * (motor.flux * current / motor.voltage)
                * (motor.flux * current / motor.voltage)
                * (current * current)
        }
        Characteristic::Induction(motor) => {
            // The torque is 2 tau_A s_A Re 1/(s + i s_A), so that the third derivative, as Re 1/(s + i s_A)^4, is zero
            // at s/s_A = cot of odd eighths of pi: +-(sqrt 2 + 1), +-(sqrt 2 - 1).
            let root = sqrt(2.0);
            let a = motor.breakdown_slip;
            let (low, high) = (1.0 - to / motor.synchronous, 1.0 - from / motor.synchronous);
            let places = [low, high, a * (root + 1.0), a * (root - 1.0), a * (1.0 - root), -a * (root + 1.0)];
            let mut largest = 0.0;
            let mut k = 0;
            while k < places.len() {
                let s = places[k];
                if s >= low && s <= high {
                    let sum = s * s + a * a;
                    let bend = (s * (s * s - 3.0 * a * a) / (sum * sum * sum)).abs();
                    if bend > largest {
                        largest = bend;
                    }
                }
                k += 1;
            }
            4.0 * motor.breakdown * a * largest / (motor.synchronous * motor.synchronous)
        }
        Characteristic::Combustion(engine) => {
            if to > engine.idle && from < engine.rated_speed {
                2.0 * engine.full_load()[2].abs()
            } else {
                0.0
            }
        }
    }
}

/// Corners of the limit by a characteristic: speed (rad/s), step of the slope (N m s/rad). A speed that is no number is
/// none.
const fn corners(mover: &Characteristic) -> [(f64, f64); 3] {
    const NONE: (f64, f64) = (f64::NAN, 0.0);
    let zeros = match mover {
        Characteristic::Line(line) => [line.stall / line.slope, f64::NAN],
        Characteristic::Parabola(parabola) => {
            let (a, b, c) = (parabola.constant, parabola.linear, parabola.square);
            let root = sqrt(b * b - 4.0 * a * c);
            let sum = -0.5 * if b < 0.0 { b - root } else { b + root };
            [a / sum, sum / c]
        }
        Characteristic::Shunt(motor) => [motor.no_load_speed().0, f64::NAN],
        Characteristic::Series(_) => [f64::NAN; 2],
        Characteristic::Induction(motor) => [motor.synchronous, f64::NAN],
        Characteristic::Combustion(engine) => {
            let [_, b, c] = engine.full_load();
            let governed = engine.slope(Speed(engine.rated_speed));
            let (idle, rated) = (b + 2.0 * c * engine.idle, governed - b - 2.0 * c * engine.rated_speed);
            return [(engine.idle, idle), (engine.rated_speed, rated), (engine.no_load, governed)];
        }
    };
    [(zeros[0], mover.slope(Speed(zeros[0]))), (zeros[1], mover.slope(Speed(zeros[1]))), NONE]
}
