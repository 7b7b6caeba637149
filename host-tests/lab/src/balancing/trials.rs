//! Balancing with trial weights by an operator, as the panel asks for it.

use driveline_firmware::scene::panel_keys::{Key, next};
use nalgebra::Complex;

use super::error::BalancingError;
use super::operator::{Hand, Operator};
use super::outcome::{Stage, Vector};
use driveline_solver::rotor::Model;

/// A rotor, how it is run, and what is set on it.
pub(super) struct Trials<'a, const PLANES: usize> {
    pub model: &'a Model,
    /// Speeds of a run (rad/s), and the time that each is given to settle (s).
    pub speeds: &'a [f64],
    pub settle: f64,
    /// Trial weights (kg m).
    pub weights: [Complex<f64>; PLANES],
    pub hand: Hand,
    /// Stages, whatever the procedure would go on to: as found, corrected, trimmed.
    pub stages: usize,
    /// Criterion of an unbalance.
    pub measure: &'a dyn Fn(&[Complex<f64>]) -> Result<f64, BalancingError>,
}

impl<const PLANES: usize> Trials<'_, PLANES> {
    /// Balances a rotor with the unbalance `now` (kg m): the stages, and the unbalance that is left.
    pub fn balance(
        mut self,
        operator: &mut Operator<'_>,
        mut now: [Complex<f64>; PLANES],
    ) -> Result<(Vec<Stage>, [Complex<f64>; PLANES]), BalancingError> {
        let mut stages = Vec::new();
        loop {
            match operator.ask(Key::Next, 0)? {
                next::BASELINE => {
                    self.run(operator)?;
                    operator.press(Key::Baseline, 0)?;
                    stages.push(self.stage("as found", operator, &now)?);
                }
                step @ (next::CORRECTION | next::TRIM) if stages.len() < self.stages => {
                    operator.press(Key::Solve, 0)?;
                    for (plane, u) in now.iter_mut().enumerate() {
                        *u += self.hand.set(operator.complex([Key::AddRe, Key::AddIm], plane as u32)?);
                    }
                    set(operator, &now)?;
                    operator.press(Key::Placed, 0)?;
                    self.run(operator)?;
                    operator.press(Key::Verified, 0)?;
                    stages.push(self.stage(
                        if step == next::TRIM { "trimmed" } else { "corrected" },
                        operator,
                        &now,
                    )?);
                }
                next::CORRECTION | next::TRIM => break,
                step @ next::TRIAL.. => {
                    let plane = step - next::TRIAL;
                    let weight = self.weights.get(plane as usize).copied().unwrap_or_default();
                    let mut with = now;
                    if let Some(u) = with.get_mut(plane as usize) {
                        *u += self.hand.set(weight);
                    }
                    set(operator, &with)?;
                    self.run(operator)?;
                    operator.tell_weight(weight)?;
                    operator.press(Key::Trial, plane)?;
                }
                _ => break,
            }
        }
        Ok((stages, now))
    }

    /// To each speed, and a reading of both channels.
    fn run(&self, operator: &mut Operator<'_>) -> Result<(), BalancingError> {
        for (index, speed) in self.speeds.iter().enumerate() {
            operator.bring_to(*speed, self.settle)?;
            operator.read()?;
            operator.press(Key::Row, 2 * index as u32)?;
        }
        Ok(())
    }

    fn stage(
        &self,
        name: &str,
        operator: &mut Operator<'_>,
        unbalance: &[Complex<f64>],
    ) -> Result<Stage, BalancingError> {
        let (mut read, mut vibration) = (Vec::new(), Vec::new());
        for row in 0..2 * self.speeds.len() as u32 {
            read.push(Vector::of(operator.complex([Key::RowRe, Key::RowIm], row)?));
        }
        for speed in self.speeds {
            vibration.extend(self.model.response(*speed, unbalance)?.into_iter().map(Vector::of));
        }
        Ok(Stage {
            name: name.to_owned(),
            unbalance: unbalance.iter().map(|&u| Vector::of(u)).collect(),
            vibration,
            read,
            measure: (self.measure)(unbalance)?,
            time: operator.machine.time(),
        })
    }
}

/// To standstill, and other weights.
fn set(operator: &mut Operator<'_>, unbalance: &[Complex<f64>]) -> Result<(), BalancingError> {
    operator.bring_to(0.0, 0.5)?;
    Ok(operator.machine.whirl().set_unbalance(unbalance)?)
}
