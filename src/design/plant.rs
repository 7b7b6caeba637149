//! The machine as its motor feels it: one inertia that turns freely, and vibrations.

use super::ExactStep;
use super::polynomial::Polynomial;
use crate::machine::{Modes, TwoMass};

const MODES: usize = crate::machine::CAPACITY - 1;

/// Share of a vibration in the motor's acceleration, over that of the whole inertia, below which it is no part of the
/// loop. A vibration of quality Q changes the loop's gain at its peak by at most Q times its share. Q is below 1e4 for
/// any shaft of steel, so the loop changes by less than 1e-5. A node at the motor is found with a share of 1e-30, not
/// zero. Its undamped poles, which no torque of the motor moves, would count as unstable.
const NEGLIGIBLE: f64 = 1e-9;

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Vibration {
    /// Square of the natural frequency (1/s2).
    pub square: f64,
    /// Modal damping (1/s).
    pub damping: f64,
    /// Square of the shape at the motor (1/(kg m2)).
    pub residue: f64,
}

/// A machine as its motor feels it: what a loop's stability depends on. All vibrations are linear; gaps count as
/// closed.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::design::{Actuator, ClosedLoop, Plant};
/// // designed for two masses, tested round a machine of three: the coupling's flange has 0.05 kg m2
/// const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.05))
///     .shaft(Stiffness(1.0e6), Damping(0.5)).rotor(Inertia(0.43));
/// let plant = Plant::of_modes(CHAIN.total_inertia(), &CHAIN.modes());
/// let speed_loop = ClosedLoop::of(&Roll::OBSERVER, &Roll::SPEED_LOOP, Actuator::DIRECT).unwrap();
/// assert!(speed_loop.is_stable(&plant, 1.0));
/// assert!(!speed_loop.is_stable(&plant, 100.0)); // no loop bears any gain
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Plant {
    pub(super) inertia: f64,
    pub(super) vibration: [Vibration; MODES],
    pub(super) count: usize,
}

impl Plant {
    /// Two masses and their one vibration.
    #[must_use]
    pub const fn of(machine: &TwoMass) -> Self {
        let (inertia, reduced) = (machine.total_inertia(), machine.reduced_inertia());
        let mut plant = Self::rigid(inertia);
        plant.vibration[0] = Vibration {
            square: machine.stiffness / reduced,
            damping: machine.damping / reduced,
            residue: machine.load_inertia / (inertia * machine.motor_inertia),
        };
        plant.count = 1;
        plant
    }

    /// A machine of this inertia (kg m2) with vibrations, as of a train. A vibration with a node at the motor is left
    /// out: the motor neither excites nor feels it.
    #[must_use]
    pub const fn of_modes(inertia: f64, modes: &Modes) -> Self {
        let mut plant = Self::rigid(inertia);
        let modes = modes.resonances();
        each!(k, 0.., k < modes.len() && plant.count < MODES, {
            let mode = &modes[k];
            if mode.residue * inertia > NEGLIGIBLE {
                plant.vibration[plant.count] =
                    Vibration { square: mode.frequency * mode.frequency, damping: mode.damping, residue: mode.residue };
                plant.count += 1;
            }
        });
        plant
    }

    const fn rigid(inertia: f64) -> Self {
        Self { inertia, vibration: [Vibration { square: 0.0, damping: 0.0, residue: 0.0 }; MODES], count: 0 }
    }

    /// The motor's angle per torque that is held over the tick before it: numerator without its factor z, and
    /// denominator.
    pub(super) const fn sampled(&self, period: f64) -> (Polynomial, Polynomial) {
        let glide = period * period / self.inertia;
        let mut numerator = Polynomial::new([glide, 0.5 * glide]);
        let mut denominator = Polynomial::new([0.0, 0.0, 1.0]);
        each!(k, 0.., k < self.count && k < MODES, {
            let Vibration { square, damping, residue } = self.vibration[k];
            let twist = Twist::of(&ExactStep::from_rates(square, damping, period));
            let turned = denominator.times(&twist.numerator);
            numerator = numerator.times(&twist.denominator).plus(residue, &turned);
            denominator = denominator.times(&twist.denominator);
        });
        (numerator, denominator)
    }
}

/// The twist's answer to a forcing that is held over a tick.
#[derive(Clone, Copy)]
pub(super) struct Twist {
    pub numerator: Polynomial,
    pub denominator: Polynomial,
}

impl Twist {
    pub(super) const fn of(step: &ExactStep) -> Self {
        let n = step;
        Self {
            numerator: Polynomial::new([n.n12 * n.g2 - n.n22 * n.g1, n.g1]),
            denominator: Polynomial::new([n.n11 * n.n22 - n.n12 * n.n21, -(n.n11 + n.n22), 1.0]),
        }
    }
}
