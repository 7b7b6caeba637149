//! A rotor that balances itself by its head while it turns, watched: how the vibration went.

use driveline_firmware::scene::panel_keys::{DONE, Key};
use nalgebra::Complex;
use serde::Serialize;

use super::error::BalancingError;
use super::operator::Operator;
use super::outcome::{Claim, Stage, Vector};
use driveline_solver::rotor::Model;

/// Longest time until it holds (s), and time between two looks at it (s).
const PATIENCE: f64 = 200.0;
const LOOK: f64 = 0.05;

/// How the vibration went, stop by stop of the head.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Course {
    /// Root mean square of the sensors' steady vibration at each stop over that of the start, by the full solver: the
    /// start first.
    pub left: Vec<f64>,
    /// The largest of them, on the way from stop to stop as well.
    pub worst: f64,
    /// The grade of the unbalance that is left (mm/s), and as the drive judges it.
    pub grades: [f64; 2],
}

impl Course {
    /// What is claimed of it.
    pub(super) fn claims(&self) -> Vec<Claim> {
        let claim = |name: &str, measured: f64, limit: f64| Claim { name: name.to_owned(), measured, limit };
        vec![
            claim("vibration left when it holds, as a share", self.left.last().copied().unwrap_or(f64::NAN), 0.05),
            claim("largest vibration on the way, as a share of the first", self.worst, 1.3),
            claim("grade of the unbalance that is left, mm/s", self.grades[0], 2.5),
            claim("grade by the drive's own verdict, mm/s", self.grades[1], 2.5),
        ]
    }
}

/// A rotor with a balancing head.
pub(super) struct HeadRun<'a> {
    /// The rotor.
    pub model: &'a Model,
    /// Its mass (kg).
    pub mass: f64,
    /// The speed that it is balanced at (rad/s).
    pub speed: f64,
}

impl HeadRun<'_> {
    /// Watches the rotor, which turns with the unbalance `found` (kg m), until the drive holds.
    pub fn watch(
        &self,
        operator: &mut Operator<'_>,
        found: Complex<f64>,
    ) -> Result<(Course, Vec<Stage>), BalancingError> {
        let end = operator.machine.time() + PATIENCE;
        while operator.ask(Key::State, 0)? != DONE && operator.machine.time() < end {
            operator.wait(LOOK)?;
        }
        let told = f64::from(f32::from_bits(operator.ask(Key::Grade, 0)?));
        let first = self.size(found)?;
        let (mut left, mut stages) = (Vec::new(), Vec::new());
        // The head moves along straight lines, on which a vibration is nowhere larger than at both of their ends.
        for (move_, &(time, at)) in operator.stops().iter().enumerate() {
            let unbalance = found + at;
            let share = self.size(unbalance)? / first;
            left.push(share);
            stages.push(Stage {
                name: if move_ == 0 { "as found".to_owned() } else { format!("move {move_}") },
                unbalance: vec![Vector::of(unbalance)],
                vibration: self.model.response(self.speed, &[unbalance])?.into_iter().map(Vector::of).collect(),
                read: Vec::new(),
                measure: share,
                time,
            });
        }
        let last = operator.stops().last().map_or(found, |(_, at)| found + at);
        let grade = 1e3 * last.norm() * self.speed / self.mass;
        // a drive without a verdict has none that is good
        let told = if told > 0.0 { told } else { f64::INFINITY };
        let worst = left.iter().copied().fold(0.0, f64::max);
        Ok((Course { left, worst, grades: [grade, told] }, stages))
    }

    /// Root of the sum of squares of the sensors' vibration.
    fn size(&self, unbalance: Complex<f64>) -> Result<f64, BalancingError> {
        let vibration = self.model.response(self.speed, &[unbalance])?;
        Ok(vibration.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt())
    }
}
