//! A run: a plant, what is done to it, and when.

use driveline::settings::Bases;

use crate::plant::Body;
use crate::sensors::Encoder;
use driveline_report::Fact;

/// Something that happens at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// The drive's setpoint changes (rad/s).
    Setpoint(f64),
    /// The governor is released.
    Release,
    /// A node's load torque changes to this (N m).
    Load(usize, f64),
    /// A node's brake closes with this torque (N m); 0 opens it.
    Brake(usize, f64),
    /// A rope is wound up or paid out: a shaft has this stiffness and damping now [N m/rad, N m s/rad].
    Rope(usize, f64, f64),
    /// A key of the panel with a number.
    Panel(u32, f32),
}

/// A load torque that follows the motion.
#[derive(Clone, Copy)]
pub struct Law {
    pub node: usize,
    /// Torque, referred to the motor (N m), for the plant as it is.
    pub torque: fn(&Body) -> f64,
}

/// One run of a scene's machine.
#[derive(Clone)]
pub struct Scenario {
    /// Its purpose.
    pub name: &'static str,
    /// The machine at the start.
    pub plant: Body,
    /// Actions, in the order of time (s).
    pub actions: Vec<(f64, Action)>,
    /// Torque that the drive holds until it is released (N m).
    pub held: f64,
    /// Duration (s).
    pub duration: f64,
    /// Whether its errors count among the variant's figures; what lies outside what the observer is made for is shown,
    /// not counted.
    pub counted: bool,
    /// Events marked in the plot (s).
    pub marks: Vec<(f64, &'static str)>,
    /// A load torque that follows the speed, as a fan's does, or the angle, as a press's; held over each tick.
    pub law: Option<Law>,
}

impl Scenario {
    /// A run that counts, without torque at first and without a law; its actions and duration are put in.
    pub fn of(name: &'static str, plant: impl Into<Body>) -> Self {
        let (actions, marks) = (Vec::new(), Vec::new());
        Self { name, plant: plant.into(), actions, held: 0.0, duration: 0.0, counted: true, marks, law: None }
    }
}

/// A scene's machine, as the report sees it.
pub struct Machine {
    /// The scene's name.
    pub name: &'static str,
    /// Its summary in the report.
    pub summary: &'static str,
    /// The machine in single figures.
    pub facts: Vec<Fact>,
    /// The report's notes on this machine's figures.
    pub notes: Vec<&'static str>,
    /// The observer that the design chooses, and the rate whose courses are drawn, as the variants' names have them.
    pub chosen: (&'static str, u32),
    /// The runs.
    pub scenarios: Vec<Scenario>,
    pub encoder: Encoder,
    /// Standard deviation of the drive's reported torque in a tick at the rate of `chosen` (N m): at another rate white
    /// noise of the same density.
    pub torque_noise: f64,
    /// The node of the load.
    pub load: usize,
    /// The torque that the drive calls the shaft's (N m).
    pub shaft_torque: fn(&Body) -> f64,
    /// The torque that the drive calls the load's (N m).
    pub load_torque: fn(&Body) -> f64,
    /// Dry friction on the motor's side, reported to the drive with the motor's torque while it turns, as identified in
    /// commissioning (N m).
    pub told_friction: f64,
    /// Rated speed of the motor (rad/s).
    pub rated_speed: f64,
    /// Bases of its fixed-point variants.
    pub bases: Bases,
}
