//! Reduction of a chain to two masses, equivalent at the motor, and its errors.

use super::refer::series;
use super::{Chain, Error, Mode, ReductionError, TwoMass};

/// How two masses stand in for a chain. Every choice keeps the total inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Match {
    /// Same first resonance and first antiresonance (motor locked): the choice for control at the motor.
    ResonanceAntiresonance,
    /// Same first resonance and same residue at the motor: the first mode kept exactly, the others dropped.
    ModalTruncation,
    /// Inertias lumped left and right of this shaft (0 at the motor), joined by all shafts in series
    /// [Huang 1987 ch. 1].
    TextbookCut(usize),
    /// Inertias lumped left and right of this shaft (0 at the motor), joined by this shaft alone, the others taken as
    /// rigid.
    TextbookShaft(usize),
}

impl Chain {
    /// Two masses for this chain.
    ///
    /// # Panics
    /// At compile time in a constant, where the chain is incomplete, has no shaft or not the shaft of the cut.
    #[must_use]
    pub const fn reduce(&self, by: Match) -> TwoMass {
        match self.try_reduce(by) {
            Ok(machine) => machine,
            Err(error) => error.stop(),
        }
    }

    /// [`reduce`](Self::reduce), with an error instead of a panic.
    ///
    /// # Errors
    /// As [`check`](Self::check), [`Error::Rigid`], [`Error::CutOutOfRange`]; [`Error::Reduction`] where an error of
    /// the reduction is not a number.
    pub const fn try_reduce(&self, by: Match) -> Result<TwoMass, Error> {
        if let Err(error) = self.check() {
            return Err(error);
        }
        if self.count < 2 {
            return Err(Error::Rigid);
        }
        if let Match::TextbookCut(cut) | Match::TextbookShaft(cut) = by
            && cut >= self.count - 1
        {
            return Err(Error::CutOutOfRange);
        }
        let mut machine = TwoMass {
            motor_inertia: self.inertia[0],
            load_inertia: self.inertia[1],
            stiffness: self.shaft[0].stiffness,
            damping: self.shaft[0].damping,
            gap: self.total_gap(),
            gravity_torque: self.gravity_torque(),
            error: ReductionError::NONE,
        };
        if self.count == 2 {
            return Ok(machine);
        }
        let modes = self.modes();
        let first = modes.resonances()[0];
        let total = self.total_inertia();
        match by {
            Match::ResonanceAntiresonance => matched(&mut machine, total, &first, modes.antiresonances()[0]),
            Match::ModalTruncation => truncated(&mut machine, total, &first),
            Match::TextbookCut(cut) => {
                self.lump(&mut machine, cut);
                let mut k = self.shaft[0].stiffness;
                let mut j = 1;
                while j + 1 < self.count {
                    k = series(k, self.shaft[j].stiffness);
                    j += 1;
                }
                machine.stiffness = k;
                machine.damping = 0.0;
                let mut j = 0;
                while j + 1 < self.count {
                    let part = k / self.shaft[j].stiffness;
                    machine.damping += self.shaft[j].damping * part * part;
                    j += 1;
                }
            }
            Match::TextbookShaft(cut) => {
                self.lump(&mut machine, cut);
                machine.stiffness = self.shaft[cut].stiffness;
                machine.damping = self.shaft[cut].damping;
            }
        }
        machine.error = self.error_of(&machine, &modes);
        if !machine.error.is_sound() {
            return Err(Error::Reduction);
        }
        Ok(machine)
    }

    /// Lumps the inertias on either side of a shaft.
    const fn lump(&self, machine: &mut TwoMass, cut: usize) {
        machine.motor_inertia = 0.0;
        machine.load_inertia = 0.0;
        let mut j = 0;
        while j < self.count {
            if j <= cut {
                machine.motor_inertia += self.inertia[j];
            } else {
                machine.load_inertia += self.inertia[j];
            }
            j += 1;
        }
    }

    const fn error_of(&self, machine: &TwoMass, modes: &super::Modes) -> ReductionError {
        let (first, next) = (modes.resonances()[0], modes.resonances()[1]);
        let total = self.total_inertia();
        let residue = machine.load_inertia / (machine.motor_inertia * total);
        let load_share = machine.load_inertia / total;
        let resonance = machine.resonance() / first.frequency - 1.0;
        // Same frequency: the two cosines stay together. Otherwise they drift apart to twice the mean.
        let mut left_out =
            if resonance.abs() < 1e-9 { (first.residue - residue).abs() } else { first.residue + residue };
        let mut i = 1;
        while i + 1 < self.count {
            left_out += modes.resonances()[i].residue;
            i += 1;
        }
        ReductionError {
            next_mode: next.frequency,
            next_share: next.residue * total,
            resonance,
            antiresonance: machine.antiresonance() / modes.antiresonances()[0] - 1.0,
            compliance: load_share * load_share / machine.stiffness / self.compliance() - 1.0,
            worst: left_out * self.inertia[0],
        }
    }

    /// Static compliance at the motor (rad/(N m)): its angle against the mean angle of all masses under a steady
    /// torque.
    ///
    /// Each shaft passes on the share of the torque that the inertia beyond it takes: `sum (J_beyond/J)^2 / k`.
    #[must_use]
    pub const fn compliance(&self) -> f64 {
        let mut stiffness = [0.0; super::CAPACITY - 1];
        let mut j = 0;
        while j + 1 < self.count {
            stiffness[j] = self.shaft[j].stiffness;
            j += 1;
        }
        compliance(&self.inertia, &stiffness, self.count - 1)
    }
}

/// Gives two masses of this total the frequency of a vibration and an antiresonance (rad/s).
pub(super) const fn matched(machine: &mut TwoMass, total: f64, first: &Mode, held: f64) {
    let ratio = held / first.frequency;
    machine.motor_inertia = total * ratio * ratio;
    machine.load_inertia = total * (1.0 - ratio) * (1.0 + ratio);
    machine.stiffness = held * held * machine.load_inertia;
    machine.damping = first.damping * machine.reduced_inertia();
}

/// Gives two masses of this total the frequency of a vibration and its residue at the motor.
pub(super) const fn truncated(machine: &mut TwoMass, total: f64, first: &Mode) {
    let share = first.residue * total;
    machine.motor_inertia = total / (1.0 + share);
    machine.load_inertia = total * share / (1.0 + share);
    machine.stiffness = first.frequency * first.frequency * machine.reduced_inertia();
    machine.damping = first.damping * machine.reduced_inertia();
}

/// [`Chain::compliance`] of bare inertias and stiffnesses.
pub(super) const fn compliance(
    inertia: &[f64; super::CAPACITY],
    stiffness: &[f64; super::CAPACITY - 1],
    shafts: usize,
) -> f64 {
    let mut total = 0.0;
    let mut j = 0;
    while j <= shafts {
        total += inertia[j];
        j += 1;
    }
    let mut sum = 0.0;
    let mut beyond = 0.0;
    let mut j = shafts;
    while j > 0 {
        beyond += inertia[j];
        let share = beyond / total;
        sum += share * share / stiffness[j - 1];
        j -= 1;
    }
    sum
}
