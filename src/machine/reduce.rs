//! Reduction of a chain to two masses, equivalent at the motor, and its errors.

use super::main_mode::MainMode;
use super::refer::series;
use super::{Chain, Error, Mode, Modes, ReductionError, TwoMass};

/// How two masses stand in for a chain. Every choice keeps the total inertia.
///
/// The main mode of a chain is its first, the slow swing of its load, although another may be more compliant;
/// `Train::of(chain)` has the other choice. That of a train has the largest share of the static compliance at the
/// motor: a lower mode, such as nearly equal branches in opposition, is left out with the antiresonance that nearly
/// cancels it.
///
/// ```
/// use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness};
/// let chain = Chain::motor(Inertia(0.5)).shaft(Stiffness(1.0e4), Damping(0.5)).rotor(Inertia(0.3));
/// let reduced = chain.reduce(Match::ResonanceAntiresonance);
/// assert!((reduced.load_inertia - 0.3).abs() < 1e-9); // two masses stand for themselves
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Match {
    /// Same resonance and antiresonance (motor locked) of the main mode: the choice for control at the motor.
    ResonanceAntiresonance,
    /// Same resonance and residue at the motor of the main mode: this mode kept exactly, the others dropped.
    ModalTruncation,
    /// Inertias lumped left and right of this shaft (0 at the motor), joined by all shafts in series
    /// [Huang 1987 ch. 1].
    TextbookCut(usize),
    /// Inertias lumped left and right of this shaft (0 at the motor), joined by this shaft alone, the others taken as
    /// rigid.
    TextbookShaft(usize),
}

impl Chain {
    stops! {
        /// Two masses for this chain.
        pub const fn reduce(&self, by: Match) -> TwoMass = try_reduce
    }

    /// [`reduce`](Self::reduce), with an error instead of a panic.
    ///
    /// # Errors
    /// As [`check`](Self::check), [`Error::Rigid`], [`Error::CutOutOfRange`]; [`Error::Reduction`] where an error of
    /// the reduction is not a number.
    pub const fn try_reduce(&self, by: Match) -> Result<TwoMass, Error> {
        get!(self.check());
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
            return machine.checked();
        }
        let modes = self.modes();
        let total = self.total_inertia();
        let main = MainMode::first(&modes);
        let mode = modes.resonances()[main.index];
        match by {
            Match::ResonanceAntiresonance => matched(&mut machine, total, &mode, main.antiresonance),
            Match::ModalTruncation => truncated(&mut machine, total, &mode),
            Match::TextbookCut(cut) => {
                self.lump(&mut machine, cut);
                let mut k = self.shaft[0].stiffness;
                each!(j, 1.., j + 1 < self.count, {
                    k = series(k, self.shaft[j].stiffness);
                });
                machine.stiffness = k;
                machine.damping = 0.0;
                each!(j, 0.., j + 1 < self.count, {
                    let part = k / self.shaft[j].stiffness;
                    machine.damping += self.shaft[j].damping * part * part;
                });
            }
            Match::TextbookShaft(cut) => {
                self.lump(&mut machine, cut);
                machine.stiffness = self.shaft[cut].stiffness;
                machine.damping = self.shaft[cut].damping;
            }
        }
        machine.error = error_of(&machine, &modes, &main, self.inertia[0], self.compliance());
        if !machine.error.is_sound() {
            return Err(Error::Reduction);
        }
        machine.checked()
    }

    /// Lumps the inertias on either side of a shaft.
    const fn lump(&self, machine: &mut TwoMass, cut: usize) {
        machine.motor_inertia = 0.0;
        machine.load_inertia = 0.0;
        each!(j, 0..self.count, {
            if j <= cut {
                machine.motor_inertia += self.inertia[j];
            } else {
                machine.load_inertia += self.inertia[j];
            }
        });
    }

    /// Static compliance at the motor (rad/(N m)): its angle against the mean angle of all masses under a steady
    /// torque.
    ///
    /// Each shaft passes on the share of the torque that the inertia beyond it takes: `sum (J_beyond/J)^2 / k`.
    #[must_use]
    pub const fn compliance(&self) -> f64 {
        let mut stiffness = [0.0; super::CAPACITY - 1];
        each!(j, 0.., j + 1 < self.count, {
            stiffness[j] = self.shaft[j].stiffness;
        });
        compliance(&self.inertia, &stiffness, self.count - 1)
    }
}

/// Errors of two masses against the modes of their machine, whose motor has this inertia (kg m2).
pub(super) const fn error_of(
    machine: &TwoMass,
    modes: &Modes,
    main: &MainMode,
    motor_inertia: f64,
    compliance: f64,
) -> ReductionError {
    let all = modes.resonances();
    let mode = all[main.index];
    let total = machine.total_inertia();
    let residue = machine.load_inertia / (machine.motor_inertia * total);
    let load_share = machine.load_inertia / total;
    let resonance = machine.resonance() / mode.frequency - 1.0;
    // Same frequency: the two cosines stay together. Otherwise they drift apart to twice the mean.
    let mut left_out = if resonance.abs() < 1e-9 { (mode.residue - residue).abs() } else { mode.residue + residue };
    each!(i, 0..all.len(), {
        if i != main.index {
            left_out += all[i].residue;
        }
    });
    let (next_mode, next_share) = if main.next < all.len() {
        (all[main.next].frequency, all[main.next].residue * total)
    } else {
        (f64::INFINITY, 0.0)
    };
    ReductionError {
        next_mode,
        next_share,
        resonance,
        antiresonance: machine.antiresonance() / main.nearest - 1.0,
        compliance: load_share * load_share / machine.stiffness / compliance - 1.0,
        worst: left_out * motor_inertia,
        slipping: 0.0,
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
    each!(j, 0.., j <= shafts, {
        total += inertia[j];
    });
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

#[cfg(test)]
mod tests {
    use super::{Chain, Error, Match};
    use crate::machine::{Damping, Efficiency, Inertia, Ratio, Stiffness};

    /// Finite parts whose sum, or whose inertia at the motor, is not.
    #[test]
    fn two_masses_are_finite_or_refused() {
        let chain = |motor: f64, ratio: f64, load: f64| {
            Chain::motor(Inertia(motor))
                .gear(Ratio(ratio), Efficiency(1.0))
                .shaft(Stiffness(1e4), Damping(0.0))
                .rotor(Inertia(load))
                .try_reduce(Match::ResonanceAntiresonance)
                .err()
        };
        assert_eq!(chain(1.0, 2.0, 1.0), None);
        for (motor, ratio, load) in [(1.0, 1e-160, 1.0), (1e308, 1.0, 1e308), (1e-320, 1.0, 1e-320), (1.0, 1e170, 1.0)]
        {
            assert!(chain(motor, ratio, load).is_some(), "{motor} {ratio} {load}");
        }
        assert_eq!(chain(1e308, 1.0, 1e308), Some(Error::Reduction));
    }
}
