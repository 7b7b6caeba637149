//! Robustness of a speed loop: margins at the described machine, stability within its tolerances.

use super::closed_loop::{ClosedLoop, Mapped};
use super::margins::Margins;
use super::plant::Plant;
use super::{Actuator, Error, PlacedObserver, RigidDesign, SpeedLoopDesign, Tolerance, TwoMassDesign};
use crate::machine::TwoMass;

/// The least margins of a speed loop.
///
/// The characteristic polynomial is linear in each of load inertia, stiffness and torque, not in all together, and the
/// sampled machine is neither. So ends that are stable do not make a range stable. A wide range is dangerous: as the
/// resonance moves through it, the loop's phase there may be bad in the middle alone. Hence a range is sampled at
/// points of which each is at most twice the one before. The usual ranges have their two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Robustness {
    /// Factor by which the gain may grow or shrink, 1 or above.
    pub gain: f64,
    /// Phase margin (rad).
    pub phase: f64,
}

impl Robustness {
    /// 6 dB and 30 degrees, the least that books on control take for sound [Åström and Murray, Feedback Systems,
    /// §10.3].
    pub const USUAL: Self = Self { gain: 2.0, phase: core::f64::consts::FRAC_PI_6 };

    /// A stable loop, no more.
    pub const NONE: Self = Self { gain: 1.0, phase: 0.0 };
}

/// The observer whose estimates a speed loop takes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LoopObserver<'a> {
    /// Two masses.
    TwoMass(&'a TwoMassDesign),
    /// Two masses, at a point of a gain schedule.
    Placed(&'a PlacedObserver),
    /// One mass.
    Rigid(&'a RigidDesign),
}

impl LoopObserver<'_> {
    /// The speed loop with this observer in it.
    ///
    /// # Errors
    /// As [`ClosedLoop::of`].
    pub const fn close(&self, speed_loop: &SpeedLoopDesign, actuator: Actuator) -> Result<ClosedLoop, Error> {
        match self {
            Self::TwoMass(design) => ClosedLoop::of(design, speed_loop, actuator),
            Self::Placed(design) => ClosedLoop::of_placed(design, speed_loop, actuator),
            Self::Rigid(design) => ClosedLoop::of_rigid(design, speed_loop, actuator),
        }
    }

    /// The loop with its torque as described, and as late as the tolerance allows.
    ///
    /// # Errors
    /// As [`ClosedLoop::of`].
    pub const fn close_within(
        &self,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        tolerance: &Tolerance,
    ) -> Result<[ClosedLoop; 2], Error> {
        let later = Actuator {
            delay: actuator.delay + tolerance.late as f64 * speed_loop.period,
            lag: actuator.lag + tolerance.lag,
        };
        match (self.close(speed_loop, actuator), self.close(speed_loop, later)) {
            (Ok(prompt), Ok(delayed)) => Ok([prompt, delayed]),
            (Err(error), _) | (_, Err(error)) => Err(error),
        }
    }
}

impl TwoMass {
    /// Whether a speed loop on this machine, with its observer in it, has the required margins, and is stable within
    /// the tolerances.
    ///
    /// Nothing but stability is tested. The nominal machine is tested with the gain at both ends of its margin and with
    /// the phase at its margin. The tolerances are tested at all their points, 32 for the usual ones. With one
    /// resonance of [`Tolerance::undescribed`] at any frequency and of any weight up to its own, the nominal two masses
    /// are tested at both ends of the gain's margin, with the extremes of torque and motor inertia: a bound over the
    /// resonances, not a sample of them.
    ///
    /// # Errors
    /// [`Error::Tolerance`] for one that is out of range; [`Error::LoopUnstable`], [`Error::LoopGain`],
    /// [`Error::LoopPhase`]; or the tolerance that alone is too wide: [`Error::LoopMotorInertia`],
    /// [`Error::LoopLoadInertia`], [`Error::LoopStiffness`], [`Error::LoopDamping`], [`Error::LoopTorque`],
    /// [`Error::LoopLate`]; [`Error::LoopCorner`] where only several together are; [`Error::LoopUndescribed`].
    pub const fn try_robust(
        &self,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        tolerance: &Tolerance,
        robustness: &Robustness,
    ) -> Result<(), Error> {
        if !(tolerance.is_sound() && robustness.gain >= 1.0 && robustness.phase >= 0.0) {
            return Err(Error::Tolerance);
        }
        let [prompt, delayed] = get!(observer.close_within(speed_loop, actuator, tolerance));
        get!(prompt.try_margins(&Plant::of(self), robustness));
        let loops = [prompt.mapped(), delayed.mapped()];
        if !self.is_stable_within(tolerance, &loops, speed_loop.period) {
            return Err(self.cause(tolerance, &loops, speed_loop.period));
        }
        if self.bears_undescribed(tolerance, &[prompt, delayed], robustness.gain) {
            Ok(())
        } else {
            Err(Error::LoopUndescribed)
        }
    }

    /// Whether a speed loop on this machine, with its observer in it, has the required margins.
    ///
    /// # Errors
    /// [`Error::LoopUnstable`], [`Error::LoopGain`], [`Error::LoopPhase`], and those of [`ClosedLoop::of`].
    pub const fn try_margins(
        &self,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        robustness: &Robustness,
    ) -> Result<(), Error> {
        get!(observer.close(speed_loop, actuator)).try_margins(&Plant::of(self), robustness)
    }

    /// Whether these loops are stable, with their gain at both ends of its margin, with the resonance that the
    /// description leaves out.
    const fn bears_undescribed(&self, tolerance: &Tolerance, loops: &[ClosedLoop; 2], gain: f64) -> bool {
        let Tolerance { torque, motor_inertia, undescribed, .. } = tolerance;
        if undescribed.weight == 0.0 {
            return true;
        }
        let gains = [torque.min / (gain * motor_inertia.max), 1.0, gain * torque.max / motor_inertia.min];
        let plant = Plant::of(self);
        let least = undescribed.above * self.resonance();
        let residue = undescribed.weight / self.motor_inertia;
        loops[0].bears(&plant, &gains, least, residue, undescribed.damping_ratio)
            && loops[1].bears(&plant, &gains, least, residue, undescribed.damping_ratio)
    }

    /// Whether these loops are stable at all points of the tolerances but the torque's delay, which is the loop's own.
    const fn is_stable_within(&self, tolerance: &Tolerance, loops: &[Mapped], period: f64) -> bool {
        let torque = [tolerance.torque.min, tolerance.torque.max];
        each!(index, 0..tolerance.machines(), {
            let machine = Mapped::of_plant(&Plant::of(&tolerance.machine(self, index)), period);
            let mut rest = loops;
            while let [first, others @ ..] = rest {
                if !first.is_stable(&machine, torque) {
                    return false;
                }
                rest = others;
            }
        });
        true
    }

    /// The least of each margin of a speed loop on this machine, with its observer in it, over all points of the
    /// tolerances. A sweep of the frequency response at each: for a host, not for a constant.
    ///
    /// # Errors
    /// [`Error::Tolerance`] for one that is out of range; [`Error::LoopUnstable`] for a loop that is unstable at a
    /// point.
    pub const fn least_margins(
        &self,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        tolerance: &Tolerance,
    ) -> Result<Margins, Error> {
        if !tolerance.is_sound() {
            return Err(Error::Tolerance);
        }
        let [prompt, delayed] = get!(observer.close_within(speed_loop, actuator, tolerance));
        let mut least = Margins::NONE;
        let torques = [tolerance.torque.min, tolerance.torque.max];
        each!(index, 0..2 * tolerance.machines(), {
            let closed = if index & 1 == 0 { &prompt } else { &delayed };
            match closed.margins_at(&Plant::of(&tolerance.machine(self, index / 2)), torques) {
                Ok(found) => least = least.and(&found),
                Err(error) => return Err(error),
            }
        });
        Ok(least)
    }

    /// The tolerance that alone makes the loop unstable.
    const fn cause(&self, tolerance: &Tolerance, loops: &[Mapped; 2], period: f64) -> Error {
        const EXACT: Tolerance = Tolerance::NONE;
        let (prompt, delayed) = loops.split_at(1);
        if !self.is_stable_within(&Tolerance { motor_inertia: tolerance.motor_inertia, ..EXACT }, prompt, period) {
            Error::LoopMotorInertia
        } else if !self.is_stable_within(&Tolerance { load_inertia: tolerance.load_inertia, ..EXACT }, prompt, period) {
            Error::LoopLoadInertia
        } else if !self.is_stable_within(&Tolerance { stiffness: tolerance.stiffness, ..EXACT }, prompt, period) {
            Error::LoopStiffness
        } else if !self.is_stable_within(&Tolerance { damping: tolerance.damping, ..EXACT }, prompt, period) {
            Error::LoopDamping
        } else if !self.is_stable_within(&Tolerance { torque: tolerance.torque, ..EXACT }, prompt, period) {
            Error::LoopTorque
        } else if !self.is_stable_within(&EXACT, delayed, period) {
            Error::LoopLate
        } else {
            Error::LoopCorner
        }
    }
}
