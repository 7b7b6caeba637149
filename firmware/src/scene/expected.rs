//! What a scene's design says, at compile time, of the errors that its observer will have.
//!
//! For the host, which puts it beside what was measured. No image has anything of it: the tick does not ask.

use driveline::design::{BacklashDesign, RigidDesign, TwoMassDesign};
use driveline::machine::TwoMass;

/// What a design says of its observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Standard deviation of the shaft torque's estimate \[N m\]; none where the design does not follow the shaft.
    pub shaft_torque: Option<f64>,
    /// Standard deviation of the load speed's estimate [rad/s].
    pub load_speed: f64,
    /// The machine as the observer has it, with what its reduction left out; none where it is one mass.
    pub machine: Option<TwoMass>,
}

/// A design that says what is to be expected.
pub trait Expects {
    /// What it says.
    fn expected(&self) -> Expected;
}

impl Expects for TwoMassDesign {
    fn expected(&self) -> Expected {
        Expected {
            shaft_torque: Some(self.standard_deviation.shaft_torque),
            load_speed: self.standard_deviation.load_speed,
            machine: Some(self.machine),
        }
    }
}

/// The shaft in contact: of the gap itself the design predicts nothing.
impl Expects for BacklashDesign {
    fn expected(&self) -> Expected {
        self.contact.expected()
    }
}

impl Expects for RigidDesign {
    fn expected(&self) -> Expected {
        Expected { shaft_torque: None, load_speed: self.standard_deviation[1], machine: None }
    }
}
