//! Bases of fixed point for a machine: those of its rating, doubled until the coefficients of its parts fit.
//!
//! A gain of the observer is a torque or a speed per innovation, at most 16 units in the last place per 2^-32 turn. A
//! fine encoder needs a gain of up to about J/T^2 for the torque (derived), and so a large base of the torque. The step
//! limits the ratio of the bases: T/J (base of the torque)/(base of the speed) must stay under 1/2. Behind a gear it
//! must stay under 1/16 with the inertia of the motor. So the base of the torque alone is tried first, then both.

use super::Rating;
use crate::design::{RigidDesign, SpeedLoopDesign, StepChoice, TwoMassDesign};
use crate::governor::SpeedLoopConfig;
use crate::number::Fixed;
use crate::observer::{RigidConfig, SemiImplicitConfig, TwoMassConfig};
use crate::settings::{Bases, Gear, SpeedLoopSettings};

/// Doublings of a base that are tried.
const DOUBLINGS: u32 = 12;

/// Which observers the bases must hold.
#[derive(Clone, Copy)]
struct Held {
    /// The exact step also where the design chose the semi-implicit one.
    exact: bool,
    semi_implicit: bool,
    rigid: bool,
    gear: bool,
}

/// From all observers that a drive may take to the least.
const HELD: [Held; 4] = {
    let all = Held { exact: true, semi_implicit: true, rigid: true, gear: true };
    [
        all,
        Held { exact: false, ..all },
        Held { gear: false, ..all },
        Held { semi_implicit: false, rigid: false, gear: false, ..all },
    ]
};

/// Parts whose coefficients the bases must hold.
struct Parts<'a> {
    two_mass: Option<&'a TwoMassDesign>,
    rigid: &'a RigidDesign,
    gear: &'a Gear,
    speed_loop: &'a SpeedLoopDesign,
    settings: SpeedLoopSettings,
}

impl Parts<'_> {
    /// Bases of this torque (N m) and this speed (rad/s), or those with a finer base of the twist: just over half
    /// the twist under the base of the torque, the least for which the compliance fits.
    const fn bases(&self, torque: f64, speed: f64, finer: bool) -> Bases {
        match self.two_mass {
            Some(design) if finer => {
                Bases { twist: 0.53 * torque / design.machine.stiffness, ..Bases::of(design, torque, speed) }
            }
            Some(design) => Bases::of(design, torque, speed),
            None => Bases::rigid(torque, speed),
        }
    }

    /// Whether the bases hold the coefficients of these observers and of the speed loop.
    const fn fit(&self, held: Held, bases: Bases) -> bool {
        let shaft = match self.two_mass {
            Some(design) => {
                let chosen = matches!(design.chosen, StepChoice::SemiImplicit);
                (!chosen || !held.semi_implicit || SemiImplicitConfig::<Fixed>::try_new(design, bases).is_ok())
                    && (chosen && !held.exact || TwoMassConfig::<Fixed>::try_new(design, bases).is_ok())
            }
            None => true,
        };
        shaft
            && (!held.rigid || RigidConfig::<Fixed>::try_new(self.rigid, 1.0, bases).is_ok())
            && (!held.gear || self.gear.efficiency >= 1.0 || self.gear.holds(self.rigid.period, bases))
            && SpeedLoopConfig::<Fixed>::try_new(self.speed_loop, self.settings, bases).is_ok()
    }

    /// The first bases that fit, from these on: the fewest doublings, of the torque alone if possible.
    const fn search(&self, held: Held, torque: f64, speed: f64) -> Option<Bases> {
        each!(alone, 0.., alone <= DOUBLINGS, {
            let bases = self.bases(torque * doubled(alone), speed, false);
            if self.fit(held, bases) {
                return Some(bases);
            }
        });
        each!(sum, 1.., sum <= 2 * DOUBLINGS, {
            each!(speeds, (sum.saturating_sub(DOUBLINGS)).., speeds <= sum && speeds <= DOUBLINGS, {
                let torques = sum - speeds;
                let (torque, speed) = (torque * doubled(torques), speed * doubled(speeds));
                let usual = self.bases(torque, speed, false);
                if self.fit(held, usual) {
                    return Some(usual);
                }
                // With twice the room for the torque, so that the twist keeps its own.
                let finer = self.bases(torque, speed, true);
                if torques >= 2 && self.fit(held, finer) {
                    return Some(finer);
                }
            });
        });
        None
    }
}

const fn doubled(times: u32) -> f64 {
    (1_u32 << times) as f64
}

impl Rating {
    /// Bases of fixed point: twice the torque limit, since the shaft swings by as much as the motor gives, and a third
    /// over rated speed.
    ///
    /// They are doubled until the coefficients of the observers, of the stiction behind a gear with losses and of the
    /// speed loop fit, each at most twelve times: the base of the torque alone, or where that does not suffice, both.
    /// A fine encoder or a stiff shaft makes the gains large. Each doubling takes one of 28 bits.
    ///
    /// Where not all of them fit together, the exact step that the design did not choose is left out, then the gear,
    /// then all but the exact step. An observer that was left out is a compile error with its sentence.
    #[must_use]
    pub const fn bases(
        &self,
        observer: &TwoMassDesign,
        rigid: &RigidDesign,
        gear: &Gear,
        speed_loop: &SpeedLoopDesign,
    ) -> Bases {
        self.search(Some(observer), rigid, gear, speed_loop)
    }

    /// [`bases`](Self::bases) for a drive with the observer of one mass: a machine of one mass, or one whose shaft no
    /// observer can follow at its rate.
    ///
    /// ```
    /// use driveline::prelude::*;
    /// use driveline::{design::SpeedLoopTuning, number::Fixed, observer::RigidObserver, settings::Bases};
    /// /// A shaft with 1100 Hz at 2000 ticks a second.
    /// struct Stiff;
    /// impl Machine for Stiff {
    ///     const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(1.0e7), Damping(0.5)).rotor(Inertia(0.48));
    ///     const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
    ///     const ENCODER: Encoder = Encoder::lines(2048);
    ///     const RATE_HZ: u32 = 2_000;
    ///     const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.003, damping: 1.0, shaft_damping: 1e-3 };
    ///     const BASES: Bases = Self::RATING.rigid_bases(&Self::RIGID_OBSERVER, &Self::GEAR, &Self::SPEED_LOOP);
    /// }
    /// type StiffDrive = Drive<Fixed, RigidObserver, SpeedLoop>;
    /// static CONFIG: ConfigOf<StiffDrive> = StiffDrive::configure::<Stiff>();
    /// ```
    #[must_use]
    pub const fn rigid_bases(&self, observer: &RigidDesign, gear: &Gear, speed_loop: &SpeedLoopDesign) -> Bases {
        self.search(None, observer, gear, speed_loop)
    }

    const fn search(
        &self,
        two_mass: Option<&TwoMassDesign>,
        rigid: &RigidDesign,
        gear: &Gear,
        speed_loop: &SpeedLoopDesign,
    ) -> Bases {
        let settings = SpeedLoopSettings { torque_limit: self.torque_limit.0, ramp: self.speed.0 };
        let (torque, speed) = (2.0 * self.torque_limit.0, 1.34 * self.speed.0);
        let parts = Parts { two_mass, rigid, gear, speed_loop, settings };
        each!(k, 0..HELD.len(), {
            if let Some(bases) = parts.search(HELD[k], torque, speed) {
                return bases;
            }
        });
        parts.bases(torque, speed, false)
    }
}
