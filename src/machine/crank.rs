//! Crank and slider: the inertia as a function of the angle, and the forces of the reciprocating masses.

use core::f64::consts::TAU;

use super::error::{not_negative, positive};
use super::{Error, Inertia, Length, Mass, MechanismPoint};
use crate::math::{sin_cos, sqrt};

/// A crank, a connecting rod and a slider in line with the crank's axis.
///
/// With crank radius r, connecting rod length l, `lambda = r/l` and the angle phi from the top dead centre, the
/// connecting rod leans by beta, `sin beta = lambda sin phi`. The slider's travel from the dead centre is
/// `s = r (1 - cos phi) + l (1 - cos beta)`. The energy `1/2 J(phi) omega^2` of everything that moves gives the inertia
/// [Wang 1989 (1-15)], and `J(phi) omega' + 1/2 J'(phi) omega^2 = tau` the motion \[derived\].
///
/// The connecting rod is exact: two point masses with its mass and centre of mass, and a correcting inertia (negative
/// for a rod with heavy ends) \[derived\].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CrankSlider {
    /// Radius of the crank (m).
    pub radius: Length,
    /// Length of the connecting rod from pin to pin (m).
    pub rod: Length,
    /// Inertia of the crank and the parts rotating with it (kg m2).
    pub crank: Inertia,
    /// Mass of the connecting rod (kg).
    pub rod_mass: Mass,
    /// Distance of the connecting rod's centre of mass from the crank pin (m).
    pub rod_centre: Length,
    /// Inertia of the connecting rod about its centre of mass (kg m2).
    pub rod_inertia: Inertia,
    /// Mass of the slider (kg).
    pub slider: Mass,
}

/// The slider's travel from the top dead centre and its derivatives by the crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Travel {
    /// Travel (m).
    pub travel: f64,
    /// First derivative (m/rad): velocity over speed, and torque at the crank over force on the slider.
    pub first: f64,
    /// Second derivative (m/rad2).
    pub second: f64,
}

impl CrankSlider {
    /// A crank and a slider with a massless connecting rod.
    #[must_use]
    pub const fn massless_rod(radius: Length, rod: Length, crank: Inertia, slider: Mass) -> Self {
        let (rod_mass, rod_centre, rod_inertia) = (Mass(0.0), Length(0.0), Inertia(0.0));
        Self { radius, rod, crank, rod_mass, rod_centre, rod_inertia, slider }
    }

    /// Whether every dimension is in its range.
    ///
    /// # Errors
    /// [`Error::CrankRadius`], [`Error::CrankMass`].
    pub const fn check(&self) -> Result<(), Error> {
        let masses = not_negative(self.crank.0)
            && not_negative(self.rod_mass.0)
            && not_negative(self.rod_inertia.0)
            && not_negative(self.slider.0);
        if !(positive(self.radius.0) && positive(self.rod.0) && self.radius.0 < self.rod.0) {
            Err(Error::CrankRadius)
        } else if !(masses && self.rod_centre.0 >= 0.0 && self.rod_centre.0 <= self.rod.0) {
            Err(Error::CrankMass)
        } else {
            Ok(())
        }
    }

    /// Crank radius over connecting rod length, below 1.
    #[must_use]
    pub const fn lambda(&self) -> f64 {
        self.radius.0 / self.rod.0
    }

    /// Position of the slider at an angle (rad) from the top dead centre.
    #[must_use]
    pub const fn travel(&self, angle: f64) -> Travel {
        let (r, lambda) = (self.radius.0, self.lambda());
        let (sine, cosine) = sin_cos(angle);
        let lean = lambda * sine;
        let upright = sqrt((1.0 - lean) * (1.0 + lean));
        // 1 - cos without cancellation at the dead centre.
        let half = sin_cos(0.5 * angle).0;
        let by_rod = self.rod.0 * lean * lean / (1.0 + upright);
        let swing = lambda * cosine / upright;
        Travel {
            travel: 2.0 * r * half * half + by_rod,
            first: r * sine * (1.0 + swing),
            second: r * (cosine * (1.0 + swing) + sine * self.lean_rate(sine, upright, swing)),
        }
    }

    /// Second derivative of the connecting rod's angle, from its first one.
    const fn lean_rate(&self, sine: f64, upright: f64, swing: f64) -> f64 {
        let lean = self.lambda() * sine;
        lean * (swing * swing - 1.0) / upright
    }

    /// Inertia at the crank at an angle (rad) from the top dead centre, with the slider's leverage.
    #[must_use]
    pub const fn inertia(&self, angle: f64) -> MechanismPoint {
        let (sine, cosine) = sin_cos(angle);
        let lean = self.lambda() * sine;
        let upright = sqrt((1.0 - lean) * (1.0 + lean));
        let swing = self.lambda() * cosine / upright;
        let (to_and_fro, round, rest) = (self.reciprocating_mass().0, self.rotating_inertia().0, self.rod_correction());
        let travel = self.travel(angle);
        MechanismPoint {
            leverage: travel.first,
            inertia: round + to_and_fro * travel.first * travel.first + rest * swing * swing,
            derivative: 2.0
                * (to_and_fro * travel.first * travel.second + rest * swing * self.lean_rate(sine, upright, swing)),
        }
    }

    /// Reciprocating mass: the slider and the connecting rod's share (kg).
    #[must_use]
    pub const fn reciprocating_mass(&self) -> Mass {
        Mass(self.slider.0 + self.rod_mass.0 * self.rod_centre.0 / self.rod.0)
    }

    /// Inertia rotating with the crank: its own and the connecting rod's share at the pin (kg m2).
    #[must_use]
    pub const fn rotating_inertia(&self) -> Inertia {
        let share = self.rod_mass.0 * (1.0 - self.rod_centre.0 / self.rod.0);
        Inertia(self.crank.0 + share * self.radius.0 * self.radius.0)
    }

    /// Excess of the connecting rod's inertia over that of its masses at the pins (kg m2).
    const fn rod_correction(&self) -> f64 {
        let a = self.rod_centre.0;
        self.rod_inertia.0 - self.rod_mass.0 * a * (self.rod.0 - a)
    }

    /// Mean of J(phi) over a turn (kg m2): the crank drive's inertia in a chain.
    ///
    /// A sum over 256 even angles: exact for a periodic function but for harmonics of 256 and more, below 1e-12
    /// up to lambda 0.9.
    #[must_use]
    pub const fn mean_inertia(&self) -> Inertia {
        let mut sum = 0.0;
        each!(j, 0..256, {
            sum += self.inertia(j as f64 * (TAU / 256.0)).inertia;
        });
        Inertia(sum / 256.0)
    }

    /// Force of the reciprocating masses on the frame along the slider's path (N), away from the crank, at an angle
    /// (rad), a speed (rad/s) and an acceleration (rad/s2) of the crank: `m (s'' omega^2 + s' omega')`
    /// [derived; heading: Pfützner 1980 ch. 2].
    #[must_use]
    pub const fn mass_force(&self, angle: f64, speed: f64, acceleration: f64) -> f64 {
        let travel = self.travel(angle);
        self.reciprocating_mass().0 * (travel.second * speed * speed + travel.first * acceleration)
    }

    /// Orders of that force at a steady speed (rad/s): the amplitudes (N) of `cos(k phi)` for k from 0, `N` of them.
    ///
    /// These are all powers of lambda: the first is `m r omega^2`, the second `m r omega^2 (lambda + lambda^3/4 + 15
    /// lambda^5/128 + ...)`, other odd orders are zero. By 256 equidistant angles, which is exact to rounding for
    /// orders below 64 up to lambda 0.9 \[derived\].
    #[must_use]
    pub const fn force_orders<const N: usize>(&self, speed: f64) -> [f64; N] {
        let mut orders = [0.0; N];
        each!(j, 0..256, {
            let force = self.mass_force(j as f64 * (TAU / 256.0), speed, 0.0) / 128.0;
            each!(k, 1..N, {
                orders[k] += force * sin_cos(((k * j) % 256) as f64 * (TAU / 256.0)).1;
            });
        });
        orders
    }
}
