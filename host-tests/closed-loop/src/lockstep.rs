//! The plant and a drive in lock-step.

use std::io;

use driveline_firmware::scene::{Input, Output};

use crate::actuator::{Actuator, ActuatorErrors};
use crate::encoder_errors::EncoderErrors;
use crate::plant::Body;
use crate::scenario::{Action, Machine, Scenario};
use crate::ticks::Ticks;
use crate::units::Units;
use driveline_solver::noise::Noise;

/// True values, estimates and exchanged words of one tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment {
    /// Time (s).
    pub time: f64,
    /// Torque commanded (N m).
    pub torque: f64,
    /// Speed of the motor (rad/s).
    pub motor_speed: f64,
    /// Shaft torque, load speed, load torque as the plant has them (N m, rad/s, N m).
    pub truth: [f64; 3],
    /// The same as the drive estimates them.
    pub estimate: [f64; 3],
    /// Angular momentum of the whole machine about the motor's shaft (N m s); NaN where a crank changes an inertia.
    pub momentum: f64,
    /// A gap is open or a rope slack.
    pub open: bool,
    /// Fault flags.
    pub faults: u32,
    /// Instructions of the tick; zero on the host.
    pub instructions: u32,
}

impl Moment {
    /// Estimate less truth.
    pub fn error(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.estimate[k] - self.truth[k])
    }
}

/// Results of a run.
pub struct Trace {
    /// Every tick.
    pub moments: Vec<Moment>,
    pub words: Vec<(Input, Output)>,
    /// The plant with everything that was done to it, ready to be proven.
    pub recording: Body,
}

/// Departures of sensors, actuator and timing from the ideal ones. The default has none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Imperfections {
    /// Of the encoder and its sampling.
    pub encoder: EncoderErrors,
    /// Of the inverter and the motor.
    pub actuator: ActuatorErrors,
    /// Share of the ticks that do not run: the command before them stays.
    pub missed_ticks: f64,
    /// Added to the seeds of the noises.
    pub seed: u64,
}

/// Runs a scenario to its end with a drive that ticks `rate_hz` times a second, and keeps everything.
pub fn run(
    machine: &Machine,
    scenario: &Scenario,
    units: &Units,
    rate_hz: u32,
    drive: &mut impl Ticks,
    mut progress: impl FnMut(u64),
) -> io::Result<Trace> {
    let mut recording = scenario.plant.clone();
    let ticks = (scenario.duration * f64::from(rate_hz)).round() as usize;
    let (mut moments, mut words) = (Vec::with_capacity(ticks), Vec::with_capacity(ticks));
    let ideal = Imperfections::default();
    follow(machine, scenario, units, rate_hz, &ideal, drive, &mut recording, |moment, exchanged| {
        if moments.len() % 1024 == 0 {
            progress(moments.len() as u64);
        }
        moments.push(*moment);
        words.push(exchanged);
    })?;
    Ok(Trace { moments, words, recording })
}

/// Runs a scenario to its end on `plant`, and shows every tick that ran with the words that it exchanged.
#[expect(clippy::too_many_arguments, reason = "what a closed loop is made of")]
pub fn follow(
    machine: &Machine,
    scenario: &Scenario,
    units: &Units,
    rate_hz: u32,
    imperfections: &Imperfections,
    drive: &mut impl Ticks,
    plant: &mut Body,
    seen: impl FnMut(&Moment, (Input, Output)),
) -> io::Result<()> {
    LockStep::new(plant, imperfections, rate_hz).follow(machine, scenario, units, drive, plant, seen)
}

/// What a plant and a drive have between them, from a run's start on.
#[derive(Clone, Debug)]
pub struct LockStep {
    imperfections: Imperfections,
    period: f64,
    noise: Noise,
    /// Apart from the torque's noise, which is the same with all imperfections.
    timing: Noise,
    actuator: Actuator,
    /// Angle of the motor at the start (rad).
    start: f64,
    setpoint: f64,
    released: bool,
    command: f64,
    reported: f64,
    /// A request waits for a tick that runs.
    asked: [u32; 2],
    /// Ticks that did not run since the last one that did.
    missed: u32,
}

impl LockStep {
    /// At a plant's start.
    pub fn new(plant: &Body, imperfections: &Imperfections, rate_hz: u32) -> Self {
        let period = 1.0 / f64::from(rate_hz);
        Self {
            imperfections: *imperfections,
            period,
            noise: Noise::new(1_u64.wrapping_add(imperfections.seed)),
            timing: Noise::new(!imperfections.seed),
            actuator: Actuator::new(imperfections.actuator, period),
            start: plant.motor_angle(),
            setpoint: 0.0,
            released: false,
            command: 0.0,
            reported: 0.0,
            asked: [0; 2],
            missed: 0,
        }
    }

    /// Goes on with a scenario to its end, as [`follow`].
    pub fn follow(
        &mut self,
        machine: &Machine,
        scenario: &Scenario,
        units: &Units,
        drive: &mut impl Ticks,
        plant: &mut Body,
        mut seen: impl FnMut(&Moment, (Input, Output)),
    ) -> io::Result<()> {
        let Self {
            imperfections,
            period,
            noise,
            timing,
            actuator,
            start,
            setpoint,
            released,
            command,
            reported,
            asked,
            missed,
        } = self;
        let period = *period;
        // of one density at every rate
        let torque_noise = machine.torque_noise / (period * f64::from(machine.chosen.1)).sqrt();
        let ticks = (scenario.duration / period).round() as usize;
        let node = machine.load;
        let mut actions = scenario.actions.iter().peekable();
        for tick in 0..ticks {
            let time = tick as f64 * period;
            // An action belongs to the tick that it falls on: half a period of slack against rounding.
            while let Some((_, action)) = actions.next_if(|(at, _)| *at < time + 0.5 * period) {
                match *action {
                    Action::Setpoint(speed) => *setpoint = speed,
                    Action::Release => *released = true,
                    Action::Load(node, torque) => plant.set_load_torque(node, torque),
                    Action::Brake(node, torque) => plant.set_brake(node, torque),
                    Action::Rope(shaft, stiffness, damping) => plant.set_shaft(shaft, stiffness, damping),
                    Action::Panel(key, value) => *asked = [key, value.to_bits()],
                }
            }
            if let Some(law) = scenario.law {
                let torque = (law.torque)(plant);
                plant.set_load_torque(law.node, torque);
            }
            let torque_noise = torque_noise * noise.normal();
            let runs =
                imperfections.missed_ticks <= 0.0 || 0.5 * (timing.uniform() + 1.0) >= imperfections.missed_ticks;
            let exchanged = if !runs {
                *missed += 1;
                None
            } else {
                // Reported torque of friction in the tick that has ended. At rest it balances the motor.
                let friction = if *released { machine.told_friction } else { 0.0 };
                let slipping = match plant.motor_speed() {
                    0.0 => -reported.clamp(-friction, friction),
                    speed => -friction * speed.signum(),
                };
                let late = if imperfections.encoder.jitter > 0.0 { timing.normal() } else { 0.0 };
                let angle = imperfections.encoder.seen(plant.motor_angle() - *start, plant.motor_speed(), late);
                let input = Input {
                    angle: machine.encoder.read(angle),
                    torque: units.torque_word(*reported + slipping + torque_noise),
                    setpoint: if *released { units.speed_word(*setpoint) } else { units.torque_word(scenario.held) },
                    flags: if *released { Input::RELEASED } else { 0 },
                    asked: std::mem::take(asked),
                    ..Input::default()
                };
                let faults = if *missed > 0 { drive.missed(&input, std::mem::take(missed)) } else { 0 };
                let mut output = drive.tick(&input)?;
                output.faults |= faults;
                *command = units.torque(output.torque);
                Some((input, output))
            };
            let applied;
            (applied, *reported) = actuator.torques(*command, plant.motor_angle());
            if let Some((input, output)) = exchanged {
                let moment = Moment {
                    time,
                    torque: applied,
                    motor_speed: plant.motor_speed(),
                    truth: [(machine.shaft_torque)(plant), plant.speed(node), (machine.load_torque)(plant)],
                    estimate: [
                        units.torque(output.shaft_torque),
                        units.speed(output.load_speed),
                        units.torque(output.load_torque),
                    ],
                    momentum: plant.momentum(),
                    open: plant.is_open(),
                    faults: output.faults,
                    instructions: output.instructions,
                };
                seen(&moment, (input, output));
            }
            plant.advance(applied, period);
        }
        Ok(())
    }
}
