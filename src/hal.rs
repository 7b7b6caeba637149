//! Adapters to `embedded-hal` 1.0, and the [`Axis`] that ties them to a
//! [`Drive`](crate::drive::Drive).
//!
//! | adapter | takes | for |
//! |---|---|---|
//! | [`Quadrature`] | a [`Counter`] | an incremental encoder on a timer |
//! | [`MagneticEncoder`] | `SpiDevice` | an absolute encoder: AS5047P, AS5048A |
//! | [`ToothedWheel`](crate::wheel::ToothedWheel) | capture times | a toothed wheel |
//! | [`PwmTorque`] | `SetDutyCycle` | a drive's torque input behind a filter, a DC motor's bridge |
//! | [`ThreePhase`] | three `SetDutyCycle` | the bridge of a small synchronous motor |
//! | [`SpiDac`] | `SpiDevice` | a drive's torque input in volts |
//! | [`Tmc4671`] | `SpiDevice` | a drive that controls the current itself |
//! | [`EnableChain`], [`TripLine`] | `OutputPin` | enabling the power stage, tripping the contactor |
//! | [`Adxl355`] | `SpiDevice` | vibration, digital |
//! | [`AdcVibration`] | a slice of conversions | vibration, analog |
//! | [`MissedTicks`] | a free-running timer, or the sample's time | ticks that did not run |
//! | `AwaitedAngle`, `AwaitedTorque` | values awaited between two ticks | the four on `SpiDevice` under `embedded-hal-async` |
//!
//! A reading is a value that is new and sound, or [`Faults`](crate::fault::Faults); there is no third answer, so that a
//! failed bus never repeats the last value. `doc/adapters.md` lists every fault of every adapter and the drive's
//! reaction, from runs.
//!
//! Crates for the encoders and the accelerometer exist (`as5048a`, `adxl355`), on `embedded-hal` 0.2; these are our
//! own.
//!
//! # Awaited
//! With the feature `hal-async` the four adapters on `SpiDevice` also run on that of `embedded-hal-async`. They are the
//! same types with the same frames and checks; awaited methods end in `_async`: `MagneticEncoder::angle_async`,
//! `SpiDac::set_torque_async`, `Tmc4671::set_torque_async`, `Adxl355::start_async` and `vibration_async`. So a bus that
//! implements both traits is never ambiguous, and nothing need be imported. A future may be dropped at any point: the
//! next call starts afresh, and a lost value raises a fault.
//!
//! [`Axis::tick`] never waits. `AwaitedAngle` and `AwaitedTorque` are the board's parts between the tick and the
//! awaited bus:
//!
//! ```
//! # #[cfg(feature = "hal-async")] mod awaited {
//! # use driveline::{drive::{ConfigOf, Drive}, governor::SpeedLoop, observer::TwoMassObserver, fault::Faults};
//! use driveline::hal::{AwaitedAngle, AwaitedTorque, Axis, Enabling, MagneticEncoder, Parts, SpiDac};
//! use embedded_hal_async::spi::SpiDevice;
//!
//! # type Config = ConfigOf<Drive<f32, TwoMassObserver<f32>, (), SpeedLoop<f32>>>;
//! type OnTask<E> = Axis<Parts<AwaitedAngle, AwaitedTorque<f32>, E>, f32, TwoMassObserver<f32>, (), SpeedLoop<f32>>;
//!
//! async fn one_tick<E: Enabling, S: SpiDevice>(
//!     axis: &mut OnTask<E>, config: &Config, encoder: &mut MagneticEncoder<S>, dac: &mut SpiDac<S, f32>,
//! ) -> Faults {
//!     axis.board().angle.fetch(encoder.angle_async()).await;
//!     let command = axis.tick(config, 150.0);
//!     axis.board().torque.give(async |torque| dac.set_torque_async(torque).await).await;
//!     command.faults
//! }
//! # }
//! ```
//!
//! A time limit round either await is safe: without an angle the tick coasts, and a torque that did not arrive trips in
//! the next tick.
//!
//! # A board
//! A new board is one file with one type that implements [`Board`]: an angle in, a torque out, the power stage on and
//! off. [`Parts`] is that type made of adapters. This is a board and its control loop:
//!
//! ```
//! use driveline::fault::Faults;
//! use driveline::hal::{Axis, Board, Quadrature};
//! # #[derive(Default)] struct Timer; #[derive(Default)] struct Bridge;
//! # impl driveline::hal::Counter for Timer { type Error = (); fn count(&mut self) -> Result<u32, ()> { Ok(0) } }
//! # impl Bridge { fn duty(&mut self, _: f32) {} fn enable(&mut self, _: bool) {} }
//! struct MyBoard {
//!     encoder: Quadrature<Timer>, // the timer's count register behind `Counter`
//!     bridge: Bridge,
//! }
//!
//! impl Board<f32> for MyBoard {
//!     fn angle(&mut self) -> Result<u32, Faults> {
//!         self.encoder.read()
//!     }
//!     fn set_torque(&mut self, torque: f32, _angle: u32) -> Result<(), Faults> {
//!         self.bridge.duty(torque / 2.5);
//!         Ok(())
//!     }
//!     fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
//!         self.bridge.enable(enabled);
//!         Ok(())
//!     }
//! }
//! ```
//!
//! The timer's interrupt then calls [`Axis::tick`]. A board whose interrupt may be held up for longer than a tick
//! counts the ticks that did not run, with [`MissedTicks`] behind [`Board::missed`]; the axis makes them up by
//! prediction.
//!
//! # From a board to a governed motor
//! With the feature `hal`, two dozen lines, on any board; the timer's wait here stands for its interrupt. A new drive
//! takes its constants from a [`Machine`](crate::configure::Machine). A [`Config`](crate::drive::Config) by hand, as
//! here, is for values that come at run time; the functions that begin with `try_` then return an error:
//!
//! ```
//! # struct MyBoard(u32);
//! # impl driveline::hal::Board<f32> for MyBoard {
//! #     fn angle(&mut self) -> Result<u32, Faults> { Ok(0) }
//! #     fn set_torque(&mut self, torque: f32, _: u32) -> Result<(), Faults> {
//! #         self.0 += (torque > 0.0) as u32;
//! #         Ok(())
//! #     }
//! #     fn set_enabled(&mut self, _: bool) -> Result<(), Faults> { Ok(()) }
//! # }
//! # impl MyBoard { fn wait_for_timer(&mut self) -> bool { self.0 < 3 } }
//! use driveline::{settings::*, design::*, drive::*, fault::Faults, governor::*, hal::*, machine::*, observer};
//!
//! const TWO: TwoMass = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35))
//!     .reduce(Match::ResonanceAntiresonance);
//! const RATE: Rate = Rate::hz(10_000);
//! const LOAD: Disturbance = Disturbance { torque_accuracy: 2.0, load_torque_step: 100.0, within: 1.0 };
//! const CONFIG: ConfigOf<Drive<f32, observer::TwoMassObserver<f32>, (), SpeedLoop<f32>>> = Config {
//!     limits: Limits::<f32>::new(&Screening {
//!         torque: 500.0, setpoint: 180.0, innovation: 0.05, frozen_turn: 0.0015, max_coast: 150,
//!     }, Bases::SI),
//!     observer: observer::TwoMassConfig::<f32>::new(&TWO.observer(RATE, Encoder::lines(2048), LOAD), Bases::SI),
//!     fluctuation: (),
//!     governor: SpeedLoopConfig::<f32>::new(
//!         &TWO.speed_loop(RATE, SpeedLoopTuning::USUAL),
//!         SpeedLoopSettings { torque_limit: 300.0, ramp: 75.0 },
//!         Bases::SI,
//!     ),
//!     balancer: (),
//! };
//!
//! fn run(board: MyBoard) -> Result<(), Faults> {
//!     type Mill<P> = Axis<P, f32, observer::TwoMassObserver<f32>, (), SpeedLoop<f32>>;
//!     let mut mill = Mill::new(board, &CONFIG, TRIPPING);
//!     mill.start(&CONFIG)?;
//!     while mill.board().wait_for_timer() {
//!         mill.tick(&CONFIG, 150.0);
//!     }
//!     Ok(())
//! }
//! # assert_eq!(run(MyBoard(0)), Ok(()));
//! ```

mod adc;
mod adxl355;
mod angle;
#[cfg(feature = "hal-async")]
mod awaited;
mod axis;
mod board;
mod dac;
mod enable;
mod magnetic;
mod missed_ticks;
mod pwm;
mod quadrature;
mod scale;
mod sine;
mod three_phase;
mod tmc4671;
mod toothed_wheel;
mod torque;
mod vibration;

pub use adc::AdcVibration;
pub use adxl355::{Adxl355, Along, Range};
pub use angle::AngleSensor;
#[cfg(feature = "hal-async")]
pub use awaited::{AwaitedAngle, AwaitedTorque};
pub use axis::{Axis, TRIPPING};
pub use board::{Board, Parts};
pub use dac::{Dac, SpiDac};
pub use enable::{EnableChain, EnableLine, Enabling, TripLine};
pub use magnetic::{Chip, MagneticEncoder};
pub use missed_ticks::MissedTicks;
pub use pwm::PwmTorque;
pub use quadrature::{Counter, Quadrature};
pub use scale::{FullScale, PerCount, Scaled};
pub use three_phase::{PhaseConfig, ThreePhase};
pub use tmc4671::Tmc4671;
pub use torque::TorqueOutput;
pub use vibration::VibrationSensor;
