//! From the turning drum to the travelling load: drums, ropes, masses.
//!
//! With a drum of diameter D behind the gear ratio i and n falls of rope, the load travels `r = D/(2 i n)` per motor
//! angle. Its inertia is `m r^2`, the rope's stiffness `k r^2`, the weight's torque `m g r` [Huang 1987 ch. 1].

use super::error::{not_negative, positive};
use super::refer::Flow;
use super::{Chain, Diameter, Error, Falls, Length, LinearDamping, Mass, Stiffness};

/// Standard acceleration of gravity (m/s2).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

impl Chain {
    /// A drum (or a pinion on a rack): turning becomes travel. Its own inertia is a rotor before it.
    ///
    /// Refused: [`Error::DrumDiameter`], [`Error::RotaryAfterDrum`].
    #[must_use]
    pub const fn drum(mut self, diameter: Diameter) -> Self {
        if self.travel != 0.0 {
            return self.refuse(Error::RotaryAfterDrum);
        }
        if !positive(diameter.0) || !positive(diameter.0 / (2.0 * self.ratio)) {
            return self.refuse(Error::DrumDiameter);
        }
        self.travel = diameter.0 / (2.0 * self.ratio);
        self
    }

    /// A rope without damping: falls, and stiffness (N/m) at the load.
    #[must_use]
    pub const fn rope(self, falls: Falls, stiffness: Stiffness) -> Self {
        self.damped_rope(falls, stiffness, LinearDamping(0.0))
    }

    /// A rope: falls, stiffness (N/m) and damping (N s/m) at the load.
    ///
    /// Refused: [`Error::DrumMissing`], [`Error::RopeFalls`], [`Error::RopeStiffness`], [`Error::RopeDamping`],
    /// [`Error::TooManyMasses`].
    #[must_use]
    pub const fn damped_rope(mut self, falls: Falls, stiffness: Stiffness, damping: LinearDamping) -> Self {
        if self.travel == 0.0 {
            return self.refuse(Error::DrumMissing);
        }
        if falls.0 == 0 {
            return self.refuse(Error::RopeFalls);
        }
        self.travel /= falls.0 as f64;
        let referred = self.at_motor(stiffness.0);
        if !positive(stiffness.0) || !positive(referred) {
            return self.refuse(Error::RopeStiffness);
        }
        if !not_negative(damping.0) {
            return self.refuse(Error::RopeDamping);
        }
        self.link(referred, self.at_motor(damping.0))
    }

    /// A mass (kg) that the drive lifts: its inertia, and its weight as a load torque.
    ///
    /// Refused: [`Error::LoadMass`], [`Error::DrumMissing`].
    #[must_use]
    pub const fn lifted(self, mass: Mass) -> Self {
        let mut chain = self.driven(mass);
        chain.gravity += mass.0 * STANDARD_GRAVITY * chain.travel;
        chain
    }

    /// Mass of the lifted loads (kg), from their weight; zero without one.
    #[must_use]
    pub const fn lifted_mass(&self) -> f64 {
        if self.gravity > 0.0 { self.gravity / (STANDARD_GRAVITY * self.travel) } else { 0.0 }
    }

    /// Lengths of the last rope: the shortest, that of its stiffness, the longest.
    ///
    /// Refused: [`Error::HoistingRange`].
    #[must_use]
    pub const fn lengths(mut self, shortest: Length, of_stiffness: Length, longest: Length) -> Self {
        self.lengths = [shortest.0, of_stiffness.0, longest.0];
        if rise(&self.lengths) { self } else { self.refuse(Error::HoistingRange) }
    }

    /// The least and the largest load of a hoist, such as the empty hook and a tenth over the largest.
    ///
    /// Refused: [`Error::HoistingRange`].
    #[must_use]
    pub const fn loads(mut self, least: Mass, largest: Mass) -> Self {
        self.loads = [least.0, largest.0];
        if rise(&self.loads) { self } else { self.refuse(Error::HoistingRange) }
    }

    /// Lengths of the rope (m), as given by [`lengths`](Self::lengths): the shortest, that of its stiffness, the
    /// longest.
    #[must_use]
    pub const fn lengths_of_rope(&self) -> [f64; 3] {
        self.lengths
    }

    /// The least and the largest load (kg), as given by [`loads`](Self::loads).
    #[must_use]
    pub const fn least_and_largest_load(&self) -> [f64; 2] {
        self.loads
    }

    /// The same hoist with another load, on another length of its rope: the lifted mass and the stiffness of the last
    /// shaft are replaced, this in proportion to the inverse of the length; the rope's damping stays. A shaft in series
    /// with the rope counts as rope.
    ///
    /// Refused: [`Error::LoadMass`] also for a chain that lifts nothing, [`Error::HoistingRange`] for a length that is
    /// not positive, or a chain without [`lengths`](Self::lengths).
    #[must_use]
    pub const fn hoisting(mut self, load: Mass, rope: Length) -> Self {
        let lifted = self.lifted_mass();
        if !positive(lifted) || !positive(load.0) || self.count < 2 {
            return self.refuse(Error::LoadMass);
        }
        let share = self.lengths[1] / rope.0;
        if !positive(rope.0) || !positive(share) {
            return self.refuse(Error::HoistingRange);
        }
        let last = self.count - 1;
        self.inertia[last] += self.at_motor(load.0) - self.at_motor(lifted);
        self.shaft[last - 1].stiffness *= share;
        self.gravity *= load.0 / lifted;
        self
    }

    /// A mass (kg) that the drive moves on the level: inertia only.
    ///
    /// Refused: [`Error::LoadMass`], [`Error::DrumMissing`].
    #[must_use]
    pub const fn driven(mut self, mass: Mass) -> Self {
        if self.travel == 0.0 {
            return self.refuse(Error::DrumMissing);
        }
        let referred = self.at_motor(mass.0);
        if !positive(mass.0) || !positive(referred) {
            return self.refuse(Error::LoadMass);
        }
        self.inertia[self.count - 1] += referred;
        self
    }

    /// A mass (kg) that swings on a rope (m) under a travelling mass, such as a crane's load: a spring of `m g/l`
    /// at the travel, then the mass.
    ///
    /// For small angles: at an amplitude of theta (rad) a pendulum swings slower than this by `theta^2/16`, 0.4 % at
    /// 15 degrees.
    ///
    /// Refused: [`Error::DrumMissing`], [`Error::PendulumLength`], [`Error::LoadMass`], [`Error::TooManyMasses`].
    #[must_use]
    pub const fn swinging(self, mass: Mass, rope: Length) -> Self {
        if self.travel == 0.0 {
            return self.refuse(Error::DrumMissing);
        }
        if !positive(rope.0) {
            return self.refuse(Error::PendulumLength);
        }
        let spring = self.at_motor(mass.0 * STANDARD_GRAVITY / rope.0);
        if !positive(mass.0) || !positive(spring) {
            return self.refuse(Error::LoadMass);
        }
        self.link(spring, 0.0).driven(mass)
    }

    /// Free travel along the load's path (m), such as a slack rope: `2 i n x / D` at the motor.
    ///
    /// Refused: [`Error::BacklashGap`], [`Error::DrumMissing`].
    #[must_use]
    pub const fn slack(self, travel: Length) -> Self {
        if self.travel == 0.0 {
            return self.refuse(Error::DrumMissing);
        }
        if !not_negative(travel.0) {
            return self.refuse(Error::BacklashGap);
        }
        self.slacken(travel.0 / self.travel)
    }

    /// A mass (kg), stiffness (N/m) or damping (N s/m) along the travel, at the motor's shaft.
    const fn at_motor(&self, linear: f64) -> f64 {
        let kept = linear * self.travel * self.travel;
        match self.flow {
            Flow::Lossless => kept,
            Flow::Motoring => kept / self.efficiency,
            Flow::Overhauling => kept * self.back_efficiency,
        }
    }
}

/// Whether values rise from above zero.
const fn rise(values: &[f64]) -> bool {
    let mut least = 0.0;
    each!(k, 0..values.len(), {
        if !positive(values[k]) || values[k] < least {
            return false;
        }
        least = values[k];
    });
    true
}
