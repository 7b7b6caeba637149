//! Largest torque of a prime mover against its speed.

use super::Error;
use crate::machine::{Characteristic, Speed};

/// Largest torque against speed, by straight lines through `K` points; level beyond the last.
///
/// A power limit P is put in at the points: between two whose speeds differ by a ratio r the line lies above P/omega by
/// at most `(sqrt(r) - 1/sqrt(r))^2/4` of it (0.23 % at r = 1.1), its chord's excess.
///
/// ```
/// use driveline::design::TorqueCurve;
/// let curve = TorqueCurve::through([[0.0, 300.0], [100.0, 300.0], [200.0, 300.0]]).with_power_limit(30_000.0);
/// assert!((curve.points()[2][1] - 150.0).abs() < 1e-9); // 30 kW at 200 rad/s
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueCurve<const K: usize> {
    points: [[f64; 2]; K],
}

impl<const K: usize> TorqueCurve<K> {
    stops! {
        /// A curve through points of speed (rad/s), the first of them at zero and each above the last, and torque (N
        /// m).
        pub const fn through(points: [[f64; 2]; K]) -> Self = try_through
    }

    /// [`through`](Self::through), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::TorqueCurve`].
    pub const fn try_through(points: [[f64; 2]; K]) -> Result<Self, Error> {
        each!(k, 0..K, {
            let [speed, torque] = points[k];
            let follows = if k == 0 { speed == 0.0 } else { speed > points[k - 1][0] };
            if !(follows && speed.is_finite() && torque >= 0.0 && torque.is_finite()) {
                return Err(Error::TorqueCurve);
            }
        });
        if K == 0 { Err(Error::TorqueCurve) } else { Ok(TorqueCurve { points }) }
    }

    stops! {
        /// The largest torque of a prime mover at these speeds (rad/s), the first of them zero. It is zero where the
        /// mover brakes.
        ///
        /// ```
        /// # use driveline::design::TorqueCurve;
        /// # use driveline::machine::{Characteristic, Line, Speed, Torque};
        /// const MOTOR: Characteristic = Characteristic::Line(Line::new((Speed(150.0), Torque(90.0)), Speed(160.0)));
        /// const LIMIT: TorqueCurve<3> = TorqueCurve::of(&MOTOR, [0.0, 150.0, 160.0]);
        /// assert_eq!(LIMIT.points()[1][0], 150.0);
        /// assert!((LIMIT.points()[1][1] - 90.0).abs() < 1e-9);
        /// ```
        pub const fn of(mover: &Characteristic, speeds: [f64; K]) -> Self = try_of
    }

    /// [`of`](Self::of), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::TorqueCurve`].
    pub const fn try_of(mover: &Characteristic, speeds: [f64; K]) -> Result<Self, Error> {
        let mut points = [[0.0; 2]; K];
        each!(k, 0..K, {
            let torque = mover.torque(Speed(speeds[k])).0;
            points[k] = [speeds[k], if torque < 0.0 { 0.0 } else { torque }];
        });
        Self::try_through(points)
    }

    /// The curve with no more than `power` (W) at each of its points.
    #[must_use]
    pub const fn with_power_limit(mut self, power: f64) -> Self {
        each!(k, 0..K, {
            let [speed, torque] = self.points[k];
            if speed * torque > power {
                self.points[k][1] = power / speed;
            }
        });
        self
    }

    /// The points: speed (rad/s), torque (N m).
    #[must_use]
    pub const fn points(&self) -> &[[f64; 2]; K] {
        &self.points
    }
}
