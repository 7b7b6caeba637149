//! Reduction of a branched or closed train to two masses, equivalent at the motor.

use super::main_mode::{MainMode, UNSEEN};
use super::reduce::{error_of, matched, truncated};
use super::{Error, Match, ReductionError, Train, TwoMass};

impl Train {
    stops! {
        /// Two masses for this train, which stand for its main mode: see [`Match`].
        pub const fn reduce(&self, by: Match) -> TwoMass = try_reduce
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
        if modes.resonances().is_empty() {
            return Err(Error::Unseen);
        }
        let main = MainMode::of(&modes, total);
        let mode = modes.resonances()[main.index];
        if mode.residue * total < UNSEEN {
            return Err(Error::Unseen);
        }
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
            Match::ResonanceAntiresonance => matched(&mut machine, total, &mode, main.antiresonance),
            Match::ModalTruncation => truncated(&mut machine, total, &mode),
            Match::TextbookCut(_) | Match::TextbookShaft(_) => return Err(Error::TrainCut),
        }
        let mut compliance = 0.0;
        each!(i, 0..modes.resonances().len(), {
            let mode = &modes.resonances()[i];
            compliance += mode.residue / (mode.frequency * mode.frequency);
        });
        machine.error = ReductionError {
            slipping: self.slipping / total,
            ..error_of(&machine, &modes, &main, self.inertia[0], compliance)
        };
        if !machine.error.is_sound() {
            return Err(Error::Reduction);
        }
        machine.checked()
    }
}
