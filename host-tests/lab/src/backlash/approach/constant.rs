//! Approaches with constant gains.

use driveline::design::BacklashDesign;

use super::luenberger;
use super::model::{Model, State, Unwrapped};
use crate::backlash::case::Case;
use crate::backlash::score::Estimator;

/// Treatment of the gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gap {
    /// Nothing.
    Ignored,
    /// Its position is a random walk, estimated. The shaft's torque depends on twist less gap position, and the motor's
    /// angle shows nothing else of either: the two are one state, a twist that wanders.
    Additive,
    /// In it, load and twist are left to the prediction.
    Switched,
    /// As [`Switched`](Self::Switched), and an impact ends it.
    Resynchronised,
    /// It is predicted, and corrected as in contact.
    Kept,
}

/// Ticks over which innovations are averaged to find an impact: a millisecond, in which one of half the rated torque is
/// felt.
const LOOKED_OVER: f64 = 10.0;
/// Mean innovation that is taken for an impact, in counts of the encoder: three standard deviations of the mean of that
/// many rounded angles.
const IMPACT: f64 = 0.28;

/// An observer with constant gains.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    model: Model,
    gap: Gap,
    gains: State,
    angle: Unwrapped,
    state: State,
    lasting: f64,
}

impl Constant {
    /// For a case, at rest.
    pub fn new(case: &Case, gap: Gap) -> Self {
        let BacklashDesign { contact, searching, .. } = case.design();
        let mut model = Model::new(case);
        if matches!(gap, Gap::Ignored | Gap::Additive) {
            model.half_gap = 0.0;
        }
        let gains = if gap == Gap::Additive { searching } else { contact.gains };
        Constant { model, gap, gains: gains.into(), angle: Unwrapped::default(), state: State::zeros(), lasting: 0.0 }
    }

    /// A Luenberger observer that takes the gap for closed, with five poles of Butterworth's pattern at `radius` times
    /// the resonance; none where they cannot be placed.
    pub fn luenberger(case: &Case, radius: f64) -> Option<Self> {
        let gains = luenberger::gains(&case.design().contact, radius * case.machine.resonance())?;
        Some(Constant { gains: gains.map(f64::from).into(), ..Constant::new(case, Gap::Ignored) })
    }
}

impl Estimator for Constant {
    fn tick(&mut self, angle: u32, torque: f64) {
        let measured = self.angle.take(angle);
        let mut state = if self.model.half_gap == 0.0 {
            self.model.side(&self.state, torque, 0.0)
        } else {
            self.model.step(&self.state, torque)
        };
        let innovation = measured - state[0];
        let open = self.model.half_gap > 0.0 && self.model.stretch(state[2]) == 0.0;
        let mut gains = self.gains;
        if open && matches!(self.gap, Gap::Switched | Gap::Resynchronised) {
            gains[2] = 0.0;
            gains[3] = 0.0;
            gains[4] = 0.0;
        }
        self.lasting += (innovation - self.lasting) / LOOKED_OVER;
        if self.gap == Gap::Resynchronised && open && self.lasting.abs() > IMPACT * self.model.count {
            // A motor behind its prediction is braked by the shaft: the right flank.
            state[2] = -self.lasting.signum() * self.model.half_gap * (1.0 + f64::EPSILON);
            self.lasting = 0.0;
        }
        self.state = state + gains * innovation;
    }

    fn estimate(&self) -> [f64; 2] {
        if self.model.half_gap == 0.0 { self.model.taut(&self.state, 0.0) } else { self.model.estimate(&self.state) }
    }
}
