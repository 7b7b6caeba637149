//! Linkages: the four-bar, and the toggle that one drives.

use super::error::{not_negative, positive};
use super::mechanism::angle_of;
use super::{Error, Inertia, Length, MECHANISM_POINTS, Mass, Mechanism, MechanismPoint};
use crate::math::{atan2, hypot, sin_cos, sqrt};

/// A four-bar whose crank turns round and whose rocker swings, on the side of positive angles.
///
/// The closed loop `a e^(i phi) + b e^(i theta) = d + c e^(i psi)` of crank a, coupler b, rocker c and ground d gives
/// the coupler's angle theta and the rocker's psi, from the line between the pivots. Its derivatives by the crank's
/// angle give their rates:
///
/// ```text
/// b theta' sin(psi - theta) = a sin(phi - psi),     c psi' sin(psi - theta) = a sin(phi - theta)
/// ```
///
/// and those of these the second ones \[derived\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FourBar {
    /// Radius of the crank (m), the shortest bar.
    pub crank: Length,
    /// Length of the coupler, from the crank pin to the rocker (m).
    pub coupler: Length,
    /// Length of the rocker (m).
    pub rocker: Length,
    /// Distance of the pivots of crank and rocker (m).
    pub ground: Length,
    /// Mass of the coupler (kg).
    pub coupler_mass: Mass,
    /// Distance of the coupler's centre of mass from the crank pin, on the bar (m).
    pub coupler_centre: Length,
    /// Inertia of the coupler about its centre of mass (kg m2).
    pub coupler_inertia: Inertia,
    /// Inertia of the rocker about its pivot, with all that swings with it (kg m2).
    pub rocker_inertia: Inertia,
}

/// Derivatives by the crank's angle, first and second, of an angle or a way.
type Rates = [f64; 2];

impl FourBar {
    /// A four-bar of crank, coupler, rocker and ground with a massless coupler.
    #[must_use]
    pub const fn massless(
        crank: Length,
        coupler: Length,
        rocker: Length,
        ground: Length,
        rocker_inertia: Inertia,
    ) -> Self {
        let (coupler_mass, coupler_centre, coupler_inertia) = (Mass(0.0), Length(0.0), Inertia(0.0));
        Self { crank, coupler, rocker, ground, coupler_mass, coupler_centre, coupler_inertia, rocker_inertia }
    }

    /// Whether the crank turns round and every mass is in its range.
    ///
    /// # Errors
    /// [`Error::LinkageBars`], [`Error::LinkageMass`].
    const fn check(&self) -> Result<(), Error> {
        let (a, b, c, d) = (self.crank.0, self.coupler.0, self.rocker.0, self.ground.0);
        let longest = if b > c && b > d {
            b
        } else if c > d {
            c
        } else {
            d
        };
        let shortest = a < b && a < c && a < d;
        let lengths = positive(a) && positive(b) && positive(c) && positive(d);
        if !(lengths && shortest && a + longest < b + c + d - longest) {
            return Err(Error::LinkageBars);
        }
        let masses = not_negative(self.coupler_mass.0)
            && not_negative(self.coupler_inertia.0)
            && not_negative(self.rocker_inertia.0);
        if !(masses && self.coupler_centre.0 >= 0.0 && self.coupler_centre.0 <= b) {
            return Err(Error::LinkageMass);
        }
        Ok(())
    }

    /// Sine and cosine of the rocker's angle at an angle of the crank (rad), and the rates of coupler and rocker; with
    /// the way of the coupler's centre.
    const fn motion(&self, angle: f64) -> ((f64, f64), [Rates; 2], [Rates; 2]) {
        let (a, b, c, s) = (self.crank.0, self.coupler.0, self.rocker.0, self.coupler_centre.0);
        let (sine, cosine) = sin_cos(angle);
        let (x, y) = (self.ground.0 - a * cosine, -a * sine);
        let across = hypot(x, y);
        // the triangle of coupler, rocker and the line from the pin to the rocker's pivot
        let at_pin = (b * b + across * across - c * c) / (2.0 * b * across);
        let at_pin = atan2(sqrt((1.0 - at_pin) * (1.0 + at_pin)), at_pin);
        let coupler = sin_cos(atan2(y, x) + at_pin);
        let rocker = ((b * coupler.0 - y) / c, (b * coupler.1 - x) / c);
        // sine and cosine of the angles between crank, coupler and rocker
        let (open, open_cosine) = less(rocker, coupler);
        let (to_rocker, to_rocker_cosine) = less((sine, cosine), rocker);
        let (to_coupler, to_coupler_cosine) = less((sine, cosine), coupler);
        let (theta, psi) = (a * to_rocker / (b * open), a * to_coupler / (c * open));
        let opening = open_cosine * (psi - theta);
        let theta = [theta, (a * to_rocker_cosine * (1.0 - psi) / b - theta * opening) / open];
        let psi = [psi, (a * to_coupler_cosine * (1.0 - theta[0]) / c - psi * opening) / open];
        let (square, turn) = (theta[0] * theta[0], theta[1]);
        let centre = [
            [-a * sine - s * theta[0] * coupler.0, -a * cosine - s * (turn * coupler.0 + square * coupler.1)],
            [a * cosine + s * theta[0] * coupler.1, -a * sine + s * (turn * coupler.1 - square * coupler.0)],
        ];
        (rocker, [theta, psi], centre)
    }

    /// Inertia of the bars, with the rocker as the tool.
    const fn point(&self, [theta, psi]: [Rates; 2], [x, y]: [Rates; 2]) -> MechanismPoint {
        MechanismPoint { inertia: 0.0, derivative: 0.0, leverage: psi[0] }
            .moving(self.coupler_mass.0, x)
            .moving(self.coupler_mass.0, y)
            .moving(self.coupler_inertia.0, theta)
            .moving(self.rocker_inertia.0, psi)
    }
}

/// Sine and cosine of the difference of two angles.
const fn less(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.1 - a.1 * b.0, a.1 * b.1 + a.0 * b.0)
}

/// A four-bar whose rocker drives a link to a slider, on a line through the pivot of the rocker.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Toggle {
    /// The bars, the rocker from its pivot to the knee.
    pub bars: FourBar,
    /// Link from the knee to the slider (m), longer than the rocker.
    pub link: Length,
    /// Direction of the line from the pivot of the rocker to the slider (rad from that of the ground bar).
    pub direction: f64,
    /// Mass of the slider (kg).
    pub slider: Mass,
}

impl Toggle {
    /// Derivatives of the slider's distance from the rocker's pivot.
    const fn way(&self, rocker: (f64, f64), psi: Rates) -> Rates {
        let (c, l) = (self.bars.rocker.0, self.link.0);
        let (sine, cosine) = less(rocker, sin_cos(self.direction));
        let reach = sqrt(l * l - c * c * sine * sine);
        // y = c cos + reach by the knee's angle, and its second derivative
        let share = c * c * sine * cosine / reach;
        let first = -c * sine - share;
        let second = -c * cosine - (c * c * (cosine * cosine - sine * sine) + share * share) / reach;
        [first * psi[0], second * psi[0] * psi[0] + first * psi[1]]
    }
}

impl Mechanism {
    /// A four-bar; its tool is the rocker, with torque and angle for force and way.
    #[must_use]
    pub const fn four_bar(bars: &FourBar) -> Self {
        let mut mechanism = match bars.check() {
            Ok(()) => Self::with(None),
            Err(error) => return Self::with(Some(error)),
        };
        each!(j, 0..MECHANISM_POINTS, {
            let (_, rates, centre) = bars.motion(angle_of(j));
            mechanism.points[j] = bars.point(rates, centre);
        });
        mechanism
    }

    /// A toggle; its tool is the slider, whose way is the distance from the rocker's pivot.
    #[must_use]
    pub const fn toggle(toggle: &Toggle) -> Self {
        let mut mechanism = match toggle.bars.check() {
            Ok(()) => Self::with(None),
            Err(error) => return Self::with(Some(error)),
        };
        if !(toggle.link.0 > toggle.bars.rocker.0 && toggle.link.0.is_finite() && toggle.direction.is_finite()) {
            return Self::with(Some(Error::LinkageBars));
        }
        if !not_negative(toggle.slider.0) {
            return Self::with(Some(Error::LinkageMass));
        }
        each!(j, 0..MECHANISM_POINTS, {
            let (rocker, rates, centre) = toggle.bars.motion(angle_of(j));
            let way = toggle.way(rocker, rates[1]);
            let point = toggle.bars.point(rates, centre).moving(toggle.slider.0, way);
            mechanism.points[j] = MechanismPoint { leverage: way[0], ..point };
        });
        mechanism
    }
}
