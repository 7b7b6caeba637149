//! A run: a plant, what is done to it, and when.

use driveline::constants::Bases;

use super::sensors::Encoder;
use crate::plant::Plant;

/// Something that happens at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// The drive's set point changes [rad/s].
    Reference(f64),
    /// The governor is released.
    Release,
    /// A node's load torque changes to this [N m].
    Load(usize, f64),
    /// A node's brake closes with this torque [N m]; 0 opens it.
    Brake(usize, f64),
}

/// One run of a scene's machine.
#[derive(Clone)]
pub struct Scenario {
    /// What it shows.
    pub name: &'static str,
    /// The machine at the start.
    pub plant: Plant,
    /// What happens, in the order of time [s].
    pub actions: Vec<(f64, Action)>,
    /// Torque that the drive holds until it is released [N m].
    pub held: f64,
    /// Duration [s].
    pub duration: f64,
    /// Whether its errors count among the variant's figures; what lies outside what the observer is made for is shown, not counted.
    pub counted: bool,
    /// What the plot says happened when [s].
    pub marks: Vec<(f64, &'static str)>,
}

/// A scene's machine, as the report sees it.
pub struct Machine {
    /// The scene's name.
    pub name: &'static str,
    /// The runs.
    pub scenarios: Vec<Scenario>,
    /// Its encoder.
    pub encoder: Encoder,
    /// Standard deviation of the torque that the drive believes to have given [N m].
    pub torque_noise: f64,
    /// The node of the load.
    pub load: usize,
    /// The torque that the drive calls the shaft's [N m].
    pub shaft_torque: fn(&Plant) -> f64,
    /// Rated speed of the motor [rad/s].
    pub rated_speed: f64,
    /// Bases of its fixed-point variants.
    pub bases: Bases,
}
