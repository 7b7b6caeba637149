//! The whole machine in lock-step with a drive: drivetrain, whirling rotor, sensors.

use std::io;

use driveline_firmware::scene::{Input, Output};
use driveline_firmware::self_test::fingerprint::Fingerprint;

use driveline_closed_loop::sensors::Encoder;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::noise::Noise;
use driveline_solver::plant::Plant;
use driveline_solver::rotor::{Faulty, Turn, Whirl};

/// The drivetrain that turns the rotor, and what loads it.
pub struct Drivetrain {
    /// Motor, coupling and rotor.
    pub plant: Plant,
    /// The node of the rotor.
    pub rotor: usize,
    /// Load torque per square of the speed (N m s2).
    pub load: f64,
    /// Load torque at any speed (N m).
    pub torque: f64,
    /// Ripple of the load: waves a turn and amplitude (N m) at the rated speed, where it is largest.
    pub ripple: Vec<(f64, f64)>,
    /// The rated speed (rad/s).
    pub rated: f64,
    /// Standard deviation of the drive's reported torque (N m).
    pub torque_noise: f64,
}

/// Drivetrain, rotor and sensors between two ticks of the drive.
pub struct Machine {
    drivetrain: Drivetrain,
    whirl: Whirl,
    sensors: [Faulty; 2],
    encoder: Encoder,
    units: Units,
    /// Vibration of a word of one.
    unit: f64,
    noise: Noise,
    applied: f64,
    setpoint: f64,
    released: bool,
    ticks: u64,
    fingerprint: Fingerprint,
    /// Most instructions of a tick, and the sum of all.
    instructions: (u32, u64),
    /// Every tick, where they are kept.
    seen: Option<Vec<Seen>>,
}

/// A tick, as the plant has it and as the drive estimates it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Angle of the motor (rad).
    pub angle: f64,
    /// Speed of motor and rotor (rad/s) and torque of the first shaft (N m).
    pub truth: [f64; 3],
    /// The same by the drive.
    pub estimate: [f64; 3],
    /// Fault flags.
    pub faults: u32,
}

impl Machine {
    /// A machine at rest; its ticks are those of the whirl, `unit` is what a vibration word of one is in the sensors'
    /// unit.
    #[must_use]
    pub fn new(drivetrain: Drivetrain, whirl: Whirl, sensors: [Faulty; 2], units: Units, unit: f64) -> Self {
        Machine {
            drivetrain,
            whirl,
            sensors,
            encoder: Encoder::new(8192),
            units,
            unit,
            noise: Noise::new(11),
            applied: 0.0,
            setpoint: 0.0,
            released: false,
            ticks: 0,
            fingerprint: Fingerprint::new(),
            instructions: (0, 0),
            seen: None,
        }
    }

    /// The same with an encoder of so many counts a turn.
    #[must_use]
    pub fn with_encoder(self, counts: u32) -> Self {
        Machine { encoder: Encoder::new(counts), ..self }
    }

    /// The same with another seed of the torque's noise.
    #[must_use]
    pub fn with_noise(self, seed: u64) -> Self {
        Machine { noise: Noise::new(seed), ..self }
    }

    /// Keeps every tick from now on.
    pub fn keep(&mut self) {
        self.seen.get_or_insert_default();
    }

    /// The ticks that were kept.
    #[must_use]
    pub fn seen(&self) -> &[Seen] {
        self.seen.as_deref().unwrap_or_default()
    }

    /// Changes the load torque at any speed (N m), and the ripple.
    pub fn set_torque(&mut self, torque: f64, ripple: Vec<(f64, f64)>) {
        (self.drivetrain.torque, self.drivetrain.ripple) = (torque, ripple);
    }

    /// Gives the drive its setpoint (rad/s) and releases it.
    pub fn set_setpoint(&mut self, speed: f64) {
        self.setpoint = speed;
        self.released = true;
    }

    /// The drive's setpoint (rad/s).
    #[must_use]
    pub fn setpoint(&self) -> f64 {
        self.setpoint
    }

    /// Time since the start (s).
    #[must_use]
    pub fn time(&self) -> f64 {
        self.ticks as f64 * self.whirl.tick()
    }

    /// Duration of a tick (s).
    #[must_use]
    pub fn period(&self) -> f64 {
        self.whirl.tick()
    }

    /// Speed of the rotor (rad/s).
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.drivetrain.plant.speed(self.drivetrain.rotor)
    }

    /// The rotor.
    pub fn whirl(&mut self) -> &mut Whirl {
        &mut self.whirl
    }

    /// A number that two runs share if every word of their outputs is the same.
    #[must_use]
    pub fn fingerprint(&self) -> u64 {
        self.fingerprint.value()
    }

    /// Most instructions of a tick, and their mean; zero on the host.
    #[must_use]
    pub fn instructions(&self) -> (u32, f64) {
        (self.instructions.0, self.instructions.1 as f64 / self.ticks.max(1) as f64)
    }

    /// One tick of the drive and its machine, with the request `asked` to the panel.
    ///
    /// # Errors
    /// What the drive's link says.
    pub fn tick(&mut self, drive: &mut dyn Ticks, asked: [u32; 2]) -> io::Result<Output> {
        let (angle, speed) = (self.angle(), self.speed());
        let mut vibration = [0; 2];
        for (channel, (word, sensor)) in vibration.iter_mut().zip(&mut self.sensors).enumerate() {
            let motion = self.whirl.motion(channel).unwrap_or_default();
            *word = self.units.word(sensor.read(&motion, angle, speed), self.unit);
        }
        let input = Input {
            angle: self.encoder.read(self.drivetrain.plant.motor_angle()),
            torque: self.units.torque_word(self.applied + self.drivetrain.torque_noise * self.noise.normal()),
            setpoint: if self.released { self.units.speed_word(self.setpoint) } else { self.units.torque_word(0.0) },
            flags: if self.released { Input::RELEASED } else { 0 },
            vibration,
            asked,
        };
        let output = drive.tick(&input)?;
        self.note(&output);
        if let Some(seen) = &mut self.seen {
            let plant = &self.drivetrain.plant;
            seen.push(Seen {
                angle: plant.motor_angle(),
                truth: [plant.motor_speed(), speed, plant.shaft_torque(0)],
                estimate: [
                    self.units.speed(output.motor_speed),
                    self.units.speed(output.load_speed),
                    self.units.torque(output.shaft_torque),
                ],
                faults: output.faults,
            });
        }
        self.applied = self.units.torque(output.torque);
        self.advance(angle, speed);
        Ok(output)
    }

    fn angle(&self) -> f64 {
        self.drivetrain.plant.angle(self.drivetrain.rotor)
    }

    fn advance(&mut self, angle: f64, speed: f64) {
        let period = self.whirl.tick();
        let Drivetrain { plant, rotor, load, torque, ripple, rated, .. } = &mut self.drivetrain;
        let share = (speed / *rated).powi(2);
        let waves: f64 = ripple.iter().map(|(order, size)| size * (order * angle).cos()).sum();
        plant.set_load_torque(*rotor, *load * speed * speed.abs() + *torque + share * waves);
        plant.advance(self.applied, period);
        let (end_angle, end_speed) = (plant.angle(*rotor), plant.speed(*rotor));
        self.whirl.advance(&Turn { angle, speed, end_angle, end_speed, duration: period });
        self.ticks += 1;
    }

    fn note(&mut self, output: &Output) {
        self.fingerprint.add(output);
        self.instructions.0 = self.instructions.0.max(output.instructions);
        self.instructions.1 += u64::from(output.instructions);
    }
}
