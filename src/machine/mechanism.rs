//! Mechanisms whose inertia depends on the angle: one table over a turn, filled from a law.

use core::f64::consts::TAU;

use super::error::not_negative;
use super::{CrankSlider, Error, Inertia, Mass};
use crate::math::sin_cos;

/// Points of a [`Mechanism`] on a turn.
pub const MECHANISM_POINTS: usize = 256;

/// A mechanism with its crank at one angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MechanismPoint {
    /// Inertia J at the crank (kg m2).
    pub inertia: f64,
    /// Derivative J' of the inertia by the angle (kg m2/rad).
    pub derivative: f64,
    /// Derivative y' of the tool's way by the angle (m/rad): torque at the crank over force against the tool. Of a
    /// four-bar the tool is the rocker (rad/rad).
    pub leverage: f64,
}

impl MechanismPoint {
    /// Adds a mass (kg) on a way of these derivatives by the angle (m/rad, m/rad2), or an inertia on an angle.
    #[must_use]
    pub(super) const fn moving(mut self, mass: f64, [first, second]: [f64; 2]) -> Self {
        self.inertia += mass * first * first;
        self.derivative += 2.0 * mass * first * second;
        self
    }
}

/// A mechanism on its own shaft, the crank: inertia and leverage over a turn, and the weight on its tool.
///
/// A mechanism with one degree of freedom turns with its crank. Mass m on a way y(phi), or inertia on an angle, gives
/// the inertia `J(phi) = sum m y'(phi)^2` [Wang 1989 (1-15)]. A force along a way is the torque `F y'(phi)`
/// [Wang 1989 (1-12)].
///
/// ```
/// use driveline::machine::{FourBar, Inertia, Length, Mass, Mechanism};
///
/// const BARS: FourBar = FourBar::massless(Length(0.1), Length(0.4), Length(0.3), Length(0.35), Inertia(6.0));
/// const ROCKER: Mechanism = Mechanism::four_bar(&BARS).rotor(Inertia(2.0));
/// assert!(ROCKER.error().is_none() && ROCKER.mean_inertia().0 > 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mechanism {
    /// Points at even angles, the first at zero.
    pub points: [MechanismPoint; MECHANISM_POINTS],
    /// Force (N) against the increase of the tool's way; of a four-bar torque (N m) against the rocker's angle.
    pub weight: f64,
    error: Option<Error>,
}

impl Mechanism {
    pub(super) const fn with(error: Option<Error>) -> Self {
        let point = MechanismPoint { inertia: 0.0, derivative: 0.0, leverage: 0.0 };
        Self { points: [point; MECHANISM_POINTS], weight: 0.0, error }
    }

    pub(crate) const fn of_points(points: [MechanismPoint; MECHANISM_POINTS]) -> Self {
        Self { points, weight: 0.0, error: None }
    }

    /// A crank with its slider, from the top dead centre on; the tool's way is the slider's travel.
    #[must_use]
    pub const fn slider_crank(crank: &CrankSlider) -> Self {
        let mut mechanism = match crank.check() {
            Ok(()) => Self::with(None),
            Err(error) => return Self::with(Some(error)),
        };
        each!(j, 0..MECHANISM_POINTS, {
            mechanism.points[j] = crank.inertia(angle_of(j));
        });
        mechanism
    }

    /// A cam with a follower of this mass, from lifts (m) at even angles, the first at zero: an odd number of them, by
    /// trigonometric interpolation. The tool's way is the lift.
    #[must_use]
    pub const fn cam<const K: usize>(lift: &[f64; K], follower: Mass) -> Self {
        let Some(way) = interpolated(lift) else { return Self::with(Some(Error::MechanismTable)) };
        let mut mechanism = Self::with(if not_negative(follower.0) { None } else { Some(Error::LinkageMass) });
        each!(j, 0..MECHANISM_POINTS, {
            let [_, first, second] = way[j];
            let point = MechanismPoint { leverage: first, ..mechanism.points[j] };
            mechanism.points[j] = point.moving(follower.0, [first, second]);
        });
        mechanism
    }

    /// Inertias (kg m2) and positions of the tool (m) at even angles, the first at zero: an odd number of them, by
    /// trigonometric interpolation. Positions that are all the same are a mechanism without a tool.
    #[must_use]
    pub const fn table<const K: usize>(inertia: &[f64; K], way: &[f64; K]) -> Self {
        let (Some(inertia), Some(way)) = (interpolated(inertia), interpolated(way)) else {
            return Self::with(Some(Error::MechanismTable));
        };
        let mut mechanism = Self::with(None);
        each!(j, 0..MECHANISM_POINTS, {
            let [value, derivative, _] = inertia[j];
            mechanism.points[j] = MechanismPoint { inertia: value, derivative, leverage: way[j][1] };
        });
        mechanism
    }

    /// Adds a constant inertia on the crank's shaft.
    #[must_use]
    pub const fn rotor(mut self, inertia: Inertia) -> Self {
        if !not_negative(inertia.0) {
            self.error = Some(Error::RotorInertia);
        }
        each!(j, 0..MECHANISM_POINTS, {
            self.points[j].inertia += inertia.0;
        });
        self
    }

    /// Sets a weight: a force (N) against the increase of the tool's way, negative where it acts along it. A four-bar
    /// has a torque (N m) against the rocker's angle.
    #[must_use]
    pub const fn weight(mut self, force: f64) -> Self {
        self.weight = force;
        self
    }

    /// The first fault of its dimensions.
    #[must_use]
    pub const fn error(&self) -> Option<Error> {
        self.error
    }

    /// Mean of J(phi) over a turn (kg m2), of the points.
    #[must_use]
    pub const fn mean_inertia(&self) -> Inertia {
        let mut sum = 0.0;
        each!(j, 0..MECHANISM_POINTS, {
            sum += self.points[j].inertia;
        });
        Inertia(sum / MECHANISM_POINTS as f64)
    }
}

pub(super) const fn angle_of(point: usize) -> f64 {
    point as f64 * (TAU / MECHANISM_POINTS as f64)
}

/// Value and two derivatives, at the points of a turn, of the trigonometric interpolation of an odd number of values.
const fn interpolated<const K: usize>(values: &[f64; K]) -> Option<[[f64; 3]; MECHANISM_POINTS]> {
    if K < 3 || K & 1 == 0 {
        return None;
    }
    let mut turn = [(0.0, 0.0); K];
    each!(k, 0..K, {
        if !values[k].is_finite() {
            return None;
        }
        turn[k] = sin_cos(k as f64 * TAU / K as f64);
    });
    let mut places = [(0.0, 0.0); MECHANISM_POINTS];
    each!(j, 0..MECHANISM_POINTS, {
        places[j] = sin_cos(angle_of(j));
    });
    let mut out = [[0.0; 3]; MECHANISM_POINTS];
    each!(order, 0.., 2 * order < K, {
        let weight = if order == 0 { 1.0 } else { 2.0 } / K as f64;
        let (mut cosine, mut sine) = (0.0, 0.0);
        each!(k, 0..K, {
            let (s, c) = turn[k * order % K];
            cosine += weight * values[k] * c;
            sine += weight * values[k] * s;
        });
        let n = order as f64;
        each!(j, 0..MECHANISM_POINTS, {
            let (s, c) = places[j * order % MECHANISM_POINTS];
            let value = cosine * c + sine * s;
            out[j][0] += value;
            out[j][1] += n * (sine * c - cosine * s);
            out[j][2] -= n * n * value;
        });
    });
    Some(out)
}
