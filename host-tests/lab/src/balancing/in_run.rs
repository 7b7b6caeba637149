//! In-run balancing by a head that moves its correction while the rotor turns: the steps, and how the vibration went.

use driveline_firmware::scene::panel_keys::Key;
use nalgebra::Complex;
use serde::Serialize;

use super::error::BalancingError;
use super::operator::Operator;
use super::outcome::{Claim, Stage, Vector};
use driveline_solver::rotor::Model;

/// Steps that the head is given.
const STEPS: usize = 8;

/// How the vibration went, step by step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Course {
    /// Root mean square of the sensors' steady vibration at each step over that of the start, by the full solver: the
    /// start first.
    pub left: Vec<f64>,
    /// The largest of them, on the way from step to step as well.
    pub worst: f64,
}

impl Course {
    /// What is claimed of it.
    pub(super) fn claims(&self) -> Vec<Claim> {
        let last = self.left.last().copied().unwrap_or(f64::NAN);
        vec![
            Claim { name: "vibration left after eight steps, as a share".to_owned(), measured: last, limit: 0.05 },
            Claim {
                name: "largest vibration at a step, as a share of the first".to_owned(),
                measured: self.worst,
                limit: 1.3,
            },
        ]
    }
}

/// A rotor with a balancing head.
pub(super) struct HeadRun<'a> {
    /// The rotor.
    pub model: &'a Model,
    /// The speed that it is balanced at (rad/s).
    pub speed: f64,
    /// Rate at which the head moves its correction (kg m/s).
    pub rate: f64,
    /// Time for the whirl to settle after the head has moved (s).
    pub settle: f64,
}

impl HeadRun<'_> {
    /// Balances the rotor, which turns with the unbalance `found` (kg m), in steps.
    pub fn balance(
        &self,
        operator: &mut Operator<'_>,
        found: Complex<f64>,
    ) -> Result<(Course, Vec<Stage>), BalancingError> {
        let first = self.size(found)?;
        let (mut now, mut left, mut stages) = (found, vec![1.0], Vec::new());
        for step in 0..=STEPS {
            operator.read()?;
            let pressed = operator.press(Key::Step, 0);
            stages.push(self.stage(step, operator, now, self.size(now)? / first)?);
            if step == STEPS {
                break;
            }
            pressed?;
            let head = operator.complex([Key::HeadRe, Key::HeadIm], 0)?;
            self.move_to(operator, &mut now, found + head)?;
            left.push(self.size(now)? / first);
        }
        // The head moves its correction along a straight line, on which a vibration is nowhere larger than at both of
        // its ends.
        let worst = left.iter().copied().fold(0.0, f64::max);
        Ok((Course { left, worst }, stages))
    }

    /// Root of the sum of squares of the sensors' vibration.
    fn size(&self, unbalance: Complex<f64>) -> Result<f64, BalancingError> {
        let vibration = self.model.response(self.speed, &[unbalance])?;
        Ok(vibration.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt())
    }

    /// Moves the head, so that the unbalance goes along a straight line, and lets the whirl settle.
    fn move_to(
        &self,
        operator: &mut Operator<'_>,
        now: &mut Complex<f64>,
        target: Complex<f64>,
    ) -> Result<(), BalancingError> {
        let ticks = ((target - *now).norm() / self.rate / operator.machine.period()).ceil().max(1.0);
        let from = *now;
        for tick in 1..=ticks as u64 {
            *now = from + (target - from) * (tick as f64 / ticks);
            operator.machine.whirl().set_unbalance(&[*now])?;
            operator.wait(operator.machine.period())?;
        }
        operator.wait(self.settle)
    }

    fn stage(
        &self,
        step: usize,
        operator: &mut Operator<'_>,
        unbalance: Complex<f64>,
        measure: f64,
    ) -> Result<Stage, BalancingError> {
        let mut read = Vec::new();
        for row in 0..2 {
            read.push(Vector::of(operator.complex([Key::RowRe, Key::RowIm], row)?));
        }
        Ok(Stage {
            name: if step == 0 { "as found".to_owned() } else { format!("step {step}") },
            unbalance: vec![Vector::of(unbalance)],
            vibration: self.model.response(self.speed, &[unbalance])?.into_iter().map(Vector::of).collect(),
            read,
            measure,
            time: operator.machine.time(),
        })
    }
}
