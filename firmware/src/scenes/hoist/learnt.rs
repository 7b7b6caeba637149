//! The hoist's drive on its gain schedule, with its learners.
//!
//! The tick is that of the semi-implicit observer behind an eccentric encoder and a gear, with a calibrated torque.
//! Between the ticks the schedule follows load and rope. The gear's loss and the eccentricity are learnt in any lift.
//! The torque constant and the motor's inertia are learnt while the panel has named the load: with the empty hook and
//! a test weight, up and down at rated speed and with steps of the speed.

use driveline::configure::{Family, Machine, ScheduleOf, Units};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::{SetpointLag, SpeedLoop};
use driveline::learning::{
    Correction, EccentricityConfig, EccentricityObserver, GearLoss, GearLossConfig, RunUp, RunUpConfig,
    TorqueCalibration, TorqueConstant, TorqueConstantConfig,
};
use driveline::number::{Fixed, Magnitude, Number};
use driveline::observer::{GearFriction, GearedObserver, SemiImplicitObserver, Stiction};
use driveline::sample::{Estimate, Sample};
use driveline::scheduling::{LoadMass, LoadMassConfig, RopeLength};

use super::machine::{Hoist, TRAVEL};
use crate::scene::composed::{Beside, Composed, OverWords, output};
use crate::scene::{Input, Output};

type M = Hoist<10_000>;
/// The ramp's setpoint lags by the loop's own time constant, so that a ramp leaves less of a swing.
type Loop = SpeedLoop<SetpointLag>;
type HoistDrive<N> = Drive<N, EccentricityObserver<GearedObserver<SemiImplicitObserver>>, Loop>;

/// The drive with its schedule and learners, at 10 kHz.
pub type Learnt<N> = Composed<HoistDrive<N>, Follower<N>>;

/// Ticks between two updates of the learners, 10 ms; of the schedule, 50 ms; of the eccentricity, 100 ms.
const LEARNER_TICKS: u32 = 100;
const SCHEDULE_TICKS: u32 = 500;
const ECCENTRICITY_TICKS: u32 = 1_000;
/// Time between two updates of the learners (s).
const EVERY: f64 = LEARNER_TICKS as f64 / M::RATE_HZ as f64;

/// Filtered over 0.2 s, from an empty hook to a tenth over the largest load.
const MASS: LoadMassConfig = LoadMassConfig::new(TRAVEL, 0.2, 0.05, [500.0, 13_000.0]);
/// A gearbox of this size loses from 1 % to 15 %.
const EFFICIENCY: [f64; 2] = [0.85, 0.99];
const LOSS: GearLossConfig = GearLossConfig::new(M::RATING.torque.0, M::RATING.speed.0, EFFICIENCY, EVERY);
const TORQUE: TorqueConstantConfig =
    TorqueConstantConfig::new(M::RATING.torque.0, M::RATING.speed.0, EFFICIENCY, EVERY);
/// Inertia in front of the rope, by the drawings, and how far the motor's may be from it.
const MOTOR: f64 = M::TWO_MASS.motor_inertia;
const MOTOR_RANGE: [f32; 2] = [0.75, 1.25];
/// From an empty hook behind the lightest motor to the largest load behind the heaviest.
const RUN_UP: RunUpConfig = RunUpConfig::new(M::RATING.torque.0, M::RATING.speed.0, [0.7 * MOTOR, 2.1 * MOTOR], EVERY);
/// Up to a tenth of a degree, from ten turns at rated speed.
///
/// Generic and called through a constant pointer for the reason given at [`at_rest`](crate::scene::at_rest).
fn eccentricity<F: Family<5, 4>>() -> &'static EccentricityConfig {
    const { &EccentricityConfig::of_placed(&F::OBSERVERS[1][2], 0.1 * core::f64::consts::PI / 180.0, 0.4) }
}
/// Gravity (m/s2), the standard value of ISO 80000-3.
const GRAVITY: f32 = 9.80665;

/// Keys of the panel, with a value as the bits of `f32`.
pub mod panel {
    /// The rope has this length now (m).
    pub const ROPE: u32 = 1;
    /// A known load hangs on the hook (kg); a negative number ends it.
    pub const LOAD: u32 = 2;
    /// Answers the learnt gain of the torque.
    pub const GAIN: u32 = 3;
    /// The torque's offset (N m).
    pub const OFFSET: u32 = 4;
    /// The friction of the gear per shaft torque.
    pub const LOSS: u32 = 5;
    /// The motor's inertia over that of the drawings.
    pub const MOTOR: u32 = 6;
    /// The encoder's eccentricity (rad).
    pub const ECCENTRICITY: u32 = 7;
}

/// What changes between the ticks: constants of the drive, load, rope, and what is learnt.
#[derive(Clone)]
pub struct Follower<N: Correction + Stiction> {
    config: ConfigOf<HoistDrive<N>>,
    calibration: TorqueCalibration<N>,
    mass: LoadMass,
    rope: RopeLength,
    loss: GearLoss,
    torque: TorqueConstant,
    run_up: RunUp,
    /// The named load (kg).
    named: Option<f32>,
    /// Motor's inertia over that of the drawings.
    motor: f32,
    ticks: u32,
    /// At the learners' last update (rad/s).
    speed: f32,
    /// Of the last tick.
    reported: N,
    /// Whether the brake has been closed since the learners' last update.
    held: bool,
}

macro_rules! follower {
    ($number:ident) => {
        impl Follower<$number> {
            /// Takes the torque of the last tick: every 10 ms. A loop that creeps into its setpoint accelerates motor
            /// and load all the while, which is no part of the load torque.
            fn learn(&mut self, estimate: &Estimate<f32>) {
                let speed = estimate.motor_speed;
                let change = speed - core::mem::replace(&mut self.speed, speed);
                if core::mem::take(&mut self.held) {
                    self.loss.interrupt();
                    self.torque.interrupt();
                    self.run_up.interrupt();
                    return;
                }
                let reported = self.reported.to_torque::<M>();
                let load = self.named.map_or(0.0, |mass| mass * const { (TRAVEL * TRAVEL) as f32 });
                let accelerating = (self.motor * MOTOR as f32 + load) * change * const { (1.0 / EVERY) as f32 };
                self.torque.update(&TORQUE, reported - accelerating, speed);
                let torque = self.torque.gain() * reported + self.torque.offset();
                self.loss.update(&LOSS, torque, speed);
                let friction = (self.loss.friction() * estimate.shaft_torque.abs()).copysign(speed);
                if self.named.is_some() {
                    self.run_up.update(&RUN_UP, torque - friction, speed);
                    let motor = (self.run_up.inertia() - load) * const { (1.0 / MOTOR) as f32 };
                    let [least, most] = MOTOR_RANGE;
                    if self.run_up.is_learnt() && motor >= least && motor <= most {
                        self.motor = motor;
                    }
                }
                // the schedule has the loss of the data sheet
                self.config.observer.friction = GearFriction::of(self.loss.friction());
                let offset = <$number as Units>::from_torque::<M>(self.torque.offset());
                self.calibration = TorqueCalibration::new(self.torque.gain(), offset);
            }

            /// Generic and called through a constant pointer for the reason given at
            /// [`at_rest`](crate::scene::at_rest).
            fn schedule<F: Family<5, 4>>() -> &'static ScheduleOf<HoistDrive<$number>, 5, 4> {
                const { &HoistDrive::<$number>::schedule::<F, 5, 4>() }
            }

            #[inline]
            fn follow(&mut self, drive: &mut HoistDrive<$number>, estimate: &Estimate<f32>) {
                let mass = self.mass.update(&MASS, estimate.load_torque);
                let length = self.rope.update(drive.angle(), estimate.motor_speed, 0.05);
                let schedule: fn() -> &'static ScheduleOf<HoistDrive<$number>, 5, 4> = const { Self::schedule::<M> };
                drive.follow(&mut self.config, schedule(), 1e3 / mass, 1.0 / length.max(1.0));
                self.config.observer.friction = GearFriction::of(self.loss.friction());
                let motor = &mut self.config.observer.observer.motor;
                *motor = Magnitude::scaled(motor, 1.0 / self.motor);
            }

            fn answer(&mut self, drive: &HoistDrive<$number>, [key, value]: [u32; 2]) -> u32 {
                let number = f32::from_bits(value);
                match key {
                    panel::ROPE => self.rope = RopeLength::new(TRAVEL as f32, number, drive.angle()),
                    panel::LOAD => {
                        self.named = (number >= 0.0).then_some(number);
                        self.torque.set_load(self.named.map(|mass| mass * GRAVITY * TRAVEL as f32));
                        self.run_up.restart();
                    }
                    panel::GAIN => return self.torque.gain().to_bits(),
                    panel::OFFSET => return self.torque.offset().to_bits(),
                    panel::LOSS => return self.loss.friction().to_bits(),
                    panel::MOTOR => return self.motor.to_bits(),
                    panel::ECCENTRICITY => {
                        let [amplitude, _] = drive.observer().amplitude_and_phase();
                        return (amplitude as f32).to_bits();
                    }
                    _ => {}
                }
                0
            }
        }

        impl Beside<HoistDrive<$number>> for Follower<$number> {
            fn start(_: &mut HoistDrive<$number>, config: &ConfigOf<HoistDrive<$number>>) -> Self {
                let friction = 0.5 * (1.0 / M::GEAR.efficiency - M::GEAR.efficiency);
                Follower {
                    config: *config,
                    calibration: TorqueCalibration::new(1.0, <$number>::ZERO),
                    mass: LoadMass::new(&MASS, 12_000.0),
                    rope: RopeLength::new(TRAVEL as f32, 12.0, 0),
                    loss: GearLoss::new(&LOSS, friction as f32),
                    torque: TorqueConstant::new(&TORQUE, 1.0, 0.0),
                    run_up: RunUp::new(&RUN_UP, MOTOR as f32),
                    named: None,
                    motor: 1.0,
                    ticks: 0,
                    speed: 0.0,
                    reported: <$number>::ZERO,
                    held: true,
                }
            }

            #[inline(always)]
            fn tick(
                &mut self,
                drive: &mut HoistDrive<$number>,
                _: &ConfigOf<HoistDrive<$number>>,
                input: &Input,
            ) -> Output {
                if input.flags & Input::RELEASED == 0 {
                    self.held = true;
                    return drive.advance(&self.config, input);
                }
                let setpoint = Number::from_word(input.setpoint);
                self.reported = Number::from_word(input.torque);
                let torque = self.calibration.torque(self.reported);
                let command = drive.tick(&self.config, &Sample { angle: input.angle, torque, setpoint });
                output(&command, &drive.estimate(&self.config))
            }

            #[inline]
            fn panel(
                &mut self,
                drive: &mut HoistDrive<$number>,
                _: &mut &'static ConfigOf<HoistDrive<$number>>,
                asked: [u32; 2],
            ) -> u32 {
                self.ticks = self.ticks.wrapping_add(1);
                if self.ticks % LEARNER_TICKS == 0 {
                    let estimate = drive.estimate(&self.config).si::<M>();
                    self.learn(&estimate);
                    if self.ticks % SCHEDULE_TICKS == 0 {
                        self.follow(drive, &estimate);
                    }
                    if self.ticks % ECCENTRICITY_TICKS == 0 {
                        let eccentricity: fn() -> &'static EccentricityConfig = const { eccentricity::<M> };
                        drive.observer_mut().learn(eccentricity(), estimate.motor_speed);
                    }
                }
                self.answer(drive, asked)
            }

            #[cfg(not(target_os = "none"))]
            fn copy(&self) -> Option<Self> {
                Some(self.clone())
            }
        }
    };
}

follower!(f32);
follower!(Fixed);
