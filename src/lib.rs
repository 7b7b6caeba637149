#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![doc = include_str!("../README.md")]
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
//! # Modules
//! [`machine`] describes the machine and [`design`] its control (both `const fn` in `f64`); [`settings`] converts a
//! design to a [`number`] type. [`observer`], [`fluctuation`], [`governor`] and [`balancing`] are the parts of a
//! [`drive`], composed by type: a part that a machine does not need is `()` and costs nothing. [`scheduling`] follows a
//! load and a rope that change, and [`learning`] finds losses and errors while the machine works. [`fatigue`] counts
//! the cycles of the shaft torque; [`commissioning`] identifies the machine by a test. [`sample`] holds inputs and
//! outputs of a tick, [`fault`] its flags.
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
mod sentences;

pub mod angle;
pub mod balancing;
pub mod commissioning;
pub mod configure;
pub mod design;
pub mod drive;
pub mod fatigue;
pub mod fault;
pub mod fluctuation;
pub mod governor;
#[cfg(feature = "hal")]
pub mod hal;
pub mod learning;
pub mod machine;
pub mod math;
pub mod number;
pub mod observer;
#[cfg(feature = "parameters")]
pub mod parameters;
pub mod prelude;
pub mod sample;
pub mod scheduling;
pub mod settings;
#[cfg(feature = "telemetry")]
pub mod telemetry;
pub mod wheel;

/// The listings of the book.
#[cfg(all(doctest, feature = "hal"))]
#[doc = include_str!("../doc/first-drive.md")]
mod first_drive_on_a_board {}
