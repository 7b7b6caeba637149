#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Controllers for machine drives. In every tick of the control loop a drive estimates shaft torque, load speed and
//! load torque from the motor's angle and torque alone. With these estimates it governs the speed, measures its cyclic
//! fluctuation and balances the rotor.
//!
//! A machine is a type with four constants. The compiler reduces it to two masses and designs observer and governor;
//! the firmware holds their coefficients:
//!
//! ```
//! use driveline::prelude::*;
//!
//! /// Motor, coupling, gear and a roll of 12 kg m2.
//! struct Roll;
//! impl Machine for Roll {
//!     const CHAIN: Chain = Chain::motor(Inertia(0.4))
//!         .gear(Ratio(5.0), Efficiency(0.97))
//!         .shaft(Stiffness(5.0e5), Damping(10.0))
//!         .rotor(Inertia(12.0));
//!     const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
//!     const ENCODER: Encoder = Encoder::lines(2048);
//!     const RATE_HZ: u32 = 10_000;
//! }
//! /// Number, observer, governor.
//! type RollDrive = Drive<Fixed, TwoMassObserver, SpeedLoop>;
//! static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
//!
//! let mut drive = RollDrive::new(&CONFIG, 0);
//! // a tick: the motor's angle (2^-32 turn), the torque of the last tick (N m), the setpoint (rad/s)
//! let command = drive.tick(&CONFIG, &Sample::si::<Roll>(0, 0.0, 100.0));
//! assert!(command.faults.is_none() && command.torque_si::<Roll>() > 0.0);
//! let estimate = drive.estimate(&CONFIG).si::<Roll>();
//! assert_eq!(estimate.load_speed, 0.0);
//! ```
//!
//! A tick allocates nothing, cannot panic, and gives the same bits on every target. Values are in SI units, or per unit
//! of [`settings::Bases`] in fixed point.
//!
//! # Modules
//! | module | holds |
//! |---|---|
//! | [`prelude`] | what a first drive needs |
//! | [`configure`] | [`configure::Machine`]: the constants of a machine, from which all others follow |
//! | [`machine`], [`design`] | the machine and the design of its control: `const fn` in `f64` |
//! | [`settings`] | the design as the constants of a [`number`] type |
//! | [`axis`] | a drive on a board: its trip, missed ticks, and what a board must have |
//! | [`drive`] | a tick through all parts; [`sample`] its inputs and outputs, [`fault`] its flags |
//! | [`observer`], [`fluctuation`], [`governor`], [`balancing`] | the parts; `()` is one that is not needed |
//! | [`adaptive`] | a drive that follows load and rope and learns its machine |
//! | [`scheduling`], [`learning`] | loads and ropes that change; losses and errors found while the machine works |
//! | [`fatigue`] | cycles of the shaft torque and their damage |
//! | [`commissioning`] | a test that identifies the machine |
//! | [`angle`], [`wheel`], [`math`] | angles behind gears and of toothed wheels; functions of a constant |
//! | `telemetry`, `parameters` | features: records of ticks, a record in flash |
//!
//! # Errors
//! A machine that cannot be, or whose observer or speed loop is unstable, is a compile error with a sentence. Where the
//! machine is read from a file, a chain carries its first error, and the `try_` form of what ends it returns the same
//! sentence:
//!
//! ```
//! # use driveline::design::{Disturbance, Encoder, Error, Rate};
//! # use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness};
//! # let machine = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35));
//! # let usual = Disturbance { torque_accuracy: 2.0, load_torque_step: 100.0, within: 1.0 };
//! let two = machine.reduce(Match::ResonanceAntiresonance);
//! assert_eq!(two.try_observer(Rate::hz(10_000), Encoder::lines(0), usual), Err(Error::EncoderLines));
//! assert!(Chain::motor(Inertia(-0.62)).error().unwrap().message().contains("inertia"));
//! ```
//!
//! Each step has its own error: [`machine::Error`] a chain, [`design::Error`] a design, [`settings::Error`] constants
//! that a number cannot hold, [`commissioning::Error`] a test, `balancing::Error` readings and weights,
//! `parameters::Error` the flash. A tick has none: [`fault::Faults`] flags its samples.
//!
//! # Glossary
//! | term | meaning | unit |
//! |---|---|---|
//! | twist | motor angle less load angle, referred to the motor | rad |
//! | twist rate | motor speed less load speed | rad/s |
//! | shaft torque | torque that the shaft or rope carries, referred to the motor | N m |
//! | load torque | torque that the load opposes to its motion | N m |
//! | resonance, antiresonance | natural frequency of the free machine; of the machine with its motor locked | rad/s |
//! | reduction | two masses that stand for a longer chain | |
//! | innovation | measured less predicted motor angle | 2^-32 turn |
//! | cycle | period of the machine: a turn of the motor, two of a four-stroke engine, or any ratio | |
//! | order | multiple of the cycle's frequency | |
//! | delta | coefficient of speed fluctuation (cyclic irregularity): largest less smallest speed of a cycle, over its mean | |
//! | tick | one run of the controller, at a fixed rate | |
//! | coast | a tick by prediction alone (dead reckoning), without a usable angle | |
//! | base | unit of a fixed-point number | |

#[macro_use]
mod constants;
#[macro_use]
mod sentences;

pub mod adaptive;
pub mod angle;
pub mod axis;
pub mod balancing;
pub mod commissioning;
pub mod configure;
pub mod design;
pub mod drive;
pub mod fatigue;
pub mod fault;
pub mod fluctuation;
pub mod governor;
pub mod learning;
pub mod machine;
pub mod math;
pub mod number;
pub mod observer;
#[cfg(feature = "parameters")]
pub mod parameters;
mod parts;
pub mod prelude;
pub mod sample;
pub mod scheduling;
pub mod settings;
#[cfg(feature = "telemetry")]
pub mod telemetry;
pub mod wheel;

#[cfg(doctest)]
#[doc = include_str!("../doc/first-drive.md")]
mod first_drive_on_a_board {}

#[cfg(doctest)]
#[doc = include_str!("../doc/hoist.md")]
mod hoist {}

#[cfg(doctest)]
#[doc = include_str!("../doc/generator-set.md")]
mod generator_set {}

#[cfg(doctest)]
#[doc = include_str!("../doc/rolling-mill.md")]
mod rolling_mill {}

#[cfg(all(doctest, feature = "balancing"))]
#[doc = include_str!("../doc/self-balancing.md")]
mod self_balancing {}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
