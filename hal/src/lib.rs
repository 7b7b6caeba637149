#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Drivers of chips and peripherals for the controllers of `driveline`, over `embedded-hal` 1.0: the parts of a
//! [`Board`](driveline::axis::Board).
//!
//! | driver | takes | for |
//! |---|---|---|
//! | [`Quadrature`] | a [`Counter`] | an incremental encoder on a timer |
//! | [`MagneticEncoder`] | `SpiDevice` | an absolute encoder: AS5047P, AS5048A |
//! | [`PwmTorque`] | `SetDutyCycle` | a drive's torque input behind a filter, a DC motor's bridge |
//! | [`ThreePhase`] | three `SetDutyCycle` | the bridge of a small synchronous motor |
//! | [`SpiDac`] | `SpiDevice` | a drive's torque input in volts |
//! | [`Tmc4671`] | `SpiDevice` | a drive that controls the current itself |
//! | [`EnableChain`], [`TripLine`] | `OutputPin` | enabling the power stage, tripping the contactor |
//! | [`Adxl355`] | `SpiDevice` | vibration, digital |
//! | [`AdcVibration`] | a slice of conversions | vibration, analog |
//! | `TwoMassHead`, by the feature `balancing` | two `SetDutyCycle` | a balancing head |
//! | [`AwaitedAngle`], [`AwaitedTorque`] | values awaited between two ticks | the four on `SpiDevice` under `embedded-hal-async` |
//!
//! A toothed wheel and the count of missed ticks take times alone: they are
//! [`ToothedWheel`](driveline::wheel::ToothedWheel) and [`MissedTicks`](driveline::axis::MissedTicks) of the library.
//!
//! A reading is a value that is new and sound, or [`Faults`](driveline::fault::Faults). `doc/adapters.md` lists every
//! fault of every driver and the drive's reaction, from runs.
//!
//! Crates for the encoders and the accelerometer exist (`as5048a`, `adxl355`), on `embedded-hal` 0.2; these are our
//! own.
//!
//! # A board
//! An encoder on a timer, a torque input and one enable line, as the parts of an axis:
//!
//! ```
//! use driveline::axis::{Axis, Parts, TRIPPING};
//! use driveline::prelude::*;
//! use driveline_hal::{Counter, EnableChain, EnableLine, FullScale, PwmTorque, Quadrature};
//! use embedded_hal::{digital::OutputPin, pwm::SetDutyCycle};
//!
//! # struct Roll;
//! # impl Machine for Roll {
//! #     const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
//! #     const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
//! #     const ENCODER: Encoder = Encoder::lines(2048);
//! #     const RATE_HZ: u32 = 10_000;
//! # }
//! type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
//! static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
//!
//! type RollParts<C, P, L> = Parts<Quadrature<C>, PwmTorque<P, f32>, EnableChain<L, 1>>;
//! type RollAxis<C, P, L> = Axis<RollParts<C, P, L>, RollDrive>;
//!
//! fn wired<C: Counter, P: SetDutyCycle, L: OutputPin>(timer: C, channel: P, pin: L) -> RollAxis<C, P, L> {
//!     let parts = Parts {
//!         angle: Quadrature::new(timer, 4 * 2048, 16),
//!         torque: PwmTorque::new(channel, FullScale::<f32>::new(550.0)),
//!         enable: EnableChain::new([EnableLine::high(pin)]),
//!     };
//!     Axis::new(parts, &CONFIG, TRIPPING)
//! }
//! ```
//!
//! # Awaited
//! With the feature `async` the four drivers on `SpiDevice` also run on that of `embedded-hal-async`. They are the
//! same types with the same frames and checks; awaited methods end in `_async`: `MagneticEncoder::angle_async`,
//! `SpiDac::set_torque_async`, `Tmc4671::set_torque_async`, `Adxl355::start_async` and `vibration_async`. So a bus that
//! implements both traits is never ambiguous, and nothing need be imported. A future may be dropped at any point: the
//! next call starts afresh, and a lost value raises a fault.
//!
//! [`Axis::tick`](driveline::axis::Axis::tick) never waits. [`AwaitedAngle`] and [`AwaitedTorque`] are the board's parts
//! between the tick and the awaited bus:
//!
//! ```
//! # #[cfg(feature = "async")] mod awaited {
//! # use driveline::{drive::{ConfigOf, Drive}, governor::SpeedLoop, observer::TwoMassObserver, fault::Faults};
//! use driveline::axis::{Axis, Enabling, Parts};
//! use driveline_hal::{AwaitedAngle, AwaitedTorque, MagneticEncoder, SpiDac};
//! use embedded_hal_async::spi::SpiDevice;
//!
//! # type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
//! type OnTask<E> = Axis<Parts<AwaitedAngle, AwaitedTorque<f32>, E>, RollDrive>;
//!
//! async fn one_tick<E: Enabling, S: SpiDevice>(
//!     axis: &mut OnTask<E>, config: &ConfigOf<RollDrive>, encoder: &mut MagneticEncoder<S>, dac: &mut SpiDac<S, f32>,
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

mod adc;
mod adxl355;
mod awaited;
#[cfg(feature = "balancing")]
mod balancing_head;
mod dac;
mod enable;
mod magnetic;
mod pwm;
mod quadrature;
mod scale;
mod sine;
mod three_phase;
mod tmc4671;

pub use adc::AdcVibration;
pub use adxl355::{Adxl355, Along, Range};
pub use awaited::{AwaitedAngle, AwaitedTorque};
#[cfg(feature = "balancing")]
pub use balancing_head::TwoMassHead;
pub use dac::{Dac, SpiDac};
pub use enable::{EnableChain, EnableLine, TripLine};
pub use magnetic::{Chip, MagneticEncoder};
pub use pwm::PwmTorque;
pub use quadrature::{Counter, Quadrature};
pub use scale::{FullScale, PerCount, Scaled};
pub use three_phase::{PhaseConfig, ThreePhase};
pub use tmc4671::Tmc4671;
