//! How far a machine may differ from what it is told to be, and whether its speed loop bears that.

use super::closed_loop::ClosedLoop;
use super::plant::Plant;
use super::{Actuator, Error, RigidDesign, SpeedLoopDesign, TwoMassDesign};
use crate::machine::TwoMass;

/// Between which factors of its value a quantity lies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Spread {
    /// The smallest factor, above 0 and at most 1.
    pub min: f64,
    /// The largest factor, 1 or above.
    pub max: f64,
}

impl Spread {
    /// Known exactly.
    pub const NONE: Self = Self { min: 1.0, max: 1.0 };

    /// By so much either way, as a fraction.
    #[must_use]
    pub const fn within(fraction: f64) -> Self {
        Self { min: 1.0 - fraction, max: 1.0 + fraction }
    }

    /// Between two factors: a load of 0.05 to 1.1 times the one that is described.
    #[must_use]
    pub const fn between(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    const fn is_sound(&self) -> bool {
        self.min > 0.0 && self.min <= 1.0 && self.max >= 1.0 && self.max.is_finite()
    }

    const fn end(&self, upper: bool) -> f64 {
        if upper { self.max } else { self.min }
    }
}

/// How far machine and motor may differ from what the design is told.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tolerance {
    /// Inertia on the motor side of the shaft.
    pub motor_inertia: Spread,
    /// Inertia on the load side.
    pub load_inertia: Spread,
    /// Stiffness of the shaft.
    pub stiffness: Spread,
    /// Torque that acts over the torque that is reported: the motor's torque constant.
    pub torque: Spread,
    /// Ticks by which the torque may act later than told.
    pub late: u32,
    /// Lag of the torque \[s\] on top of the actuator's.
    pub lag: f64,
}

impl Tolerance {
    /// A machine by its drawings and a motor by its data sheet: motor side 10 %, load side and stiffness 20 %, torque
    /// constant 5 %, a torque that may come
    /// a tick late and through a current control of 500 Hz.
    pub const USUAL: Self = Self {
        motor_inertia: Spread::within(0.1),
        load_inertia: Spread::within(0.2),
        stiffness: Spread::within(0.2),
        torque: Spread::within(0.05),
        late: 1,
        lag: 1.0 / (core::f64::consts::TAU * 500.0),
    };

    /// Everything is as told.
    pub const NONE: Self = Self {
        motor_inertia: Spread::NONE,
        load_inertia: Spread::NONE,
        stiffness: Spread::NONE,
        torque: Spread::NONE,
        late: 0,
        lag: 0.0,
    };

    /// The machine at a corner, its torque's factor, and whether it is late: a bit for each.
    const fn corner(&self, machine: &TwoMass, corner: u32) -> (TwoMass, f64, bool) {
        let mut machine = *machine;
        machine.motor_inertia *= self.motor_inertia.end(corner & 1 != 0);
        machine.load_inertia *= self.load_inertia.end(corner & 2 != 0);
        machine.stiffness *= self.stiffness.end(corner & 4 != 0);
        (machine, self.torque.end(corner & 8 != 0), corner & 16 != 0)
    }
}

/// The least margins of a speed loop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Robustness {
    /// Factor by which the gain may grow or shrink, 1 or above.
    pub gain: f64,
    /// Phase margin \[rad\].
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
    /// One mass.
    Rigid(&'a RigidDesign),
}

impl LoopObserver<'_> {
    const fn close(&self, speed_loop: &SpeedLoopDesign, actuator: Actuator) -> Result<ClosedLoop, Error> {
        match self {
            Self::TwoMass(design) => ClosedLoop::of(design, speed_loop, actuator),
            Self::Rigid(design) => ClosedLoop::of_rigid(design, speed_loop, actuator),
        }
    }
}

impl TwoMass {
    /// Stops where a speed loop does not bear its tolerances.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_robust`](Self::try_robust) returns.
    pub const fn robust(
        &self,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        tolerance: &Tolerance,
        robustness: &Robustness,
    ) {
        if let Err(error) = self.try_robust(observer, speed_loop, actuator, tolerance, robustness) {
            error.stop()
        }
    }

    /// Whether a speed loop on this machine, with its observer in it, has the margins that are asked for, and is stable
    /// at every corner of the tolerances.
    ///
    /// Nothing but stability is tested: at the nominal machine with the gain at both ends of its margin and the phase
    /// at its margin, and at all 32 corners.
    ///
    /// # Errors
    /// [`Error::LoopUnstable`], [`Error::LoopGain`], [`Error::LoopPhase`]; or the tolerance that alone is too wide:
    /// [`Error::LoopMotorInertia`],
    /// [`Error::LoopLoadInertia`], [`Error::LoopStiffness`], [`Error::LoopTorque`], [`Error::LoopLate`];
    /// [`Error::LoopCorner`] where only several together are.
    pub const fn try_robust(
        &self,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        tolerance: &Tolerance,
        robustness: &Robustness,
    ) -> Result<(), Error> {
        let Tolerance { motor_inertia, load_inertia, stiffness, torque, late, lag } = tolerance;
        let spreads = motor_inertia.is_sound() && load_inertia.is_sound() && stiffness.is_sound() && torque.is_sound();
        if !(spreads && robustness.gain >= 1.0 && robustness.phase >= 0.0) {
            return Err(Error::Tolerance);
        }
        let prompt = match observer.close(speed_loop, actuator) {
            Ok(closed) => closed,
            Err(error) => return Err(error),
        };
        let later = Actuator { delay: actuator.delay + *late as f64 * speed_loop.period, lag: actuator.lag + *lag };
        let delayed = match observer.close(speed_loop, later) {
            Ok(closed) => closed,
            Err(error) => return Err(error),
        };
        let nominal = Plant::of(self);
        if !prompt.is_stable(&nominal, 1.0) {
            return Err(Error::LoopUnstable);
        }
        if !(prompt.is_stable(&nominal, robustness.gain) && prompt.is_stable(&nominal, 1.0 / robustness.gain)) {
            return Err(Error::LoopGain);
        }
        if !prompt.is_stable_turned(&nominal, robustness.phase) {
            return Err(Error::LoopPhase);
        }
        let mut corner = 0;
        while corner < 32 {
            let (machine, gain, is_late) = tolerance.corner(self, corner);
            let closed = if is_late { &delayed } else { &prompt };
            if !closed.is_stable(&Plant::of(&machine), gain) {
                return Err(self.cause(&prompt, &delayed, tolerance));
            }
            corner += 1;
        }
        Ok(())
    }

    /// The tolerance that alone makes the loop unstable.
    const fn cause(&self, prompt: &ClosedLoop, delayed: &ClosedLoop, tolerance: &Tolerance) -> Error {
        let causes =
            [Error::LoopMotorInertia, Error::LoopLoadInertia, Error::LoopStiffness, Error::LoopTorque, Error::LoopLate];
        let mut which = 0;
        while which < 5 {
            let mut end = 0;
            while end < 2 {
                let alone = match which {
                    0 => Tolerance { motor_inertia: tolerance.motor_inertia, ..Tolerance::NONE },
                    1 => Tolerance { load_inertia: tolerance.load_inertia, ..Tolerance::NONE },
                    2 => Tolerance { stiffness: tolerance.stiffness, ..Tolerance::NONE },
                    3 => Tolerance { torque: tolerance.torque, ..Tolerance::NONE },
                    _ => Tolerance::NONE,
                };
                let (machine, gain, is_late) = alone.corner(self, (end * 15) | if which == 4 { 16 } else { 0 });
                let closed = if is_late { delayed } else { prompt };
                if !closed.is_stable(&Plant::of(&machine), gain) {
                    return causes[which];
                }
                end += 1;
            }
            which += 1;
        }
        Error::LoopCorner
    }
}
