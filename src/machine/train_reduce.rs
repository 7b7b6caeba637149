//! Reduction of a branched or closed train to two masses, equivalent at the motor.

use super::reduce::{matched, truncated};
use super::{Error, Match, Modes, ReductionError, Train, TwoMass};

/// Modal share at the motor (residue times total inertia) below which a mode is unobservable at the motor, such as two
/// equal branches in opposition.
const UNSEEN: f64 = 1e-6;

/// Modes of a train that are observable at the motor, with their antiresonances.
struct Seen {
    /// Index of the first vibration that is seen, and of the second; `count` where there is none.
    mode: [usize; 2],
    antiresonance: f64,
}

impl Train {
    /// Two masses for this train. Modes that are unobservable at the motor are left out.
    ///
    /// # Panics
    /// At compile time in a constant, where the match is a textbook's cut, which only a chain has, or no mode is
    /// observable at the motor.
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
    /// That of the train, [`Error::TrainCut`], [`Error::Unseen`]; [`Error::Reduction`] where an error of the reduction
    /// is not a number.
    pub const fn try_reduce(&self, by: Match) -> Result<TwoMass, Error> {
        if let Some(error) = self.error() {
            return Err(error);
        }
        let modes = self.modes();
        let total = self.total_inertia();
        let Some(seen) = self.seen(&modes, total) else { return Err(Error::Unseen) };
        let first = modes.resonances()[seen.mode[0]];
        let mut machine = TwoMass {
            motor_inertia: 0.0,
            load_inertia: 0.0,
            stiffness: 0.0,
            damping: 0.0,
            gap: self.total_gap(),
            gravity_torque: self.gravity_torque(),
            error: ReductionError::NONE,
        };
        match by {
            Match::ResonanceAntiresonance => matched(&mut machine, total, &first, seen.antiresonance),
            Match::ModalTruncation => truncated(&mut machine, total, &first),
            Match::TextbookCut(_) | Match::TextbookShaft(_) => return Err(Error::TrainCut),
        }
        machine.error = self.error_of(&machine, &modes, &seen, total);
        if !machine.error.is_sound() {
            return Err(Error::Reduction);
        }
        Ok(machine)
    }

    const fn seen(&self, modes: &Modes, total: f64) -> Option<Seen> {
        let all = modes.resonances();
        let held = modes.antiresonances();
        let mut mode = [all.len(); 2];
        let mut found = 0;
        // Resonances and antiresonances alternate. An unseen resonance coincides with an antiresonance beside it; the
        // other one of the two stays.
        let mut lower = 0.0;
        let mut antiresonance = 0.0;
        let mut i = 0;
        while i < all.len() && found < 2 {
            let (below, frequency) = (if lower > 0.0 { lower } else { held[i] }, all[i].frequency);
            if all[i].residue * total < UNSEEN {
                let above = if i + 1 < held.len() { held[i + 1] } else { f64::INFINITY };
                lower = if frequency - below < above - frequency { above } else { below };
            } else {
                if found == 0 {
                    antiresonance = below;
                }
                mode[found] = i;
                found += 1;
                lower = 0.0;
            }
            i += 1;
        }
        if found > 0 { Some(Seen { mode, antiresonance }) } else { None }
    }

    const fn error_of(&self, machine: &TwoMass, modes: &Modes, seen: &Seen, total: f64) -> ReductionError {
        let all = modes.resonances();
        let first = all[seen.mode[0]];
        let residue = machine.load_inertia / (machine.motor_inertia * total);
        let load_share = machine.load_inertia / total;
        let mut left_out = (first.residue - residue).abs();
        let mut compliance = 0.0;
        let mut i = 0;
        while i < all.len() {
            if i != seen.mode[0] {
                left_out += all[i].residue;
            }
            compliance += all[i].residue / (all[i].frequency * all[i].frequency);
            i += 1;
        }
        let (next_mode, next_share) = if seen.mode[1] < all.len() {
            (all[seen.mode[1]].frequency, all[seen.mode[1]].residue * total)
        } else {
            (f64::INFINITY, 0.0)
        };
        ReductionError {
            next_mode,
            next_share,
            resonance: machine.resonance() / first.frequency - 1.0,
            antiresonance: machine.antiresonance() / seen.antiresonance - 1.0,
            compliance: load_share * load_share / machine.stiffness / compliance - 1.0,
            worst: left_out * self.inertia[0],
        }
    }
}
