#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Controllers for machine drives: shaft torque, load speed and load torque estimated from the motor's side alone.
//!
//! The machine (a crane, a rolling mill, a converter, a generator set) is described once, as a constant. The compiler reduces it to what
//! the controller can feel, designs the observer and the governor, and leaves nothing but their coefficients in the firmware. A tick then
//! takes the motor's angle and torque, estimates what no sensor on the motor sees, and gives the torque for the next tick: no allocation,
//! no panic, no unsafe code, the same bits on the host and on the controller.
//!
//! ```
//! use driveline::constants::{Bases, Screening, SpeedLoopSettings};
//! use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopTuning, TwoMassDesign};
//! use driveline::drive::{ConfigOf, Config, Drive, Limits};
//! use driveline::governor::{SpeedLoop, SpeedLoopConfig};
//! use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness, TwoMass};
//! use driveline::observer::{self, TwoMassConfig};
//! use driveline::sample::Sample;
//!
//! const MACHINE: Chain =
//!     Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35));
//! const TWO: TwoMass = MACHINE.reduce(Match::ResonanceAntiresonance);
//! const RATE: Rate = Rate::hz(10_000);
//! const DESIGN: TwoMassDesign = TWO.observer(
//!     RATE,
//!     Encoder::lines(2048),
//!     Disturbance { torque_accuracy: 2.0, load_torque_step: 100.0, within: 1.0 },
//! );
//! type Mill = Drive<f32, observer::TwoMass<f32>, (), SpeedLoop<f32>>; // `()`: no fluctuation is measured
//! const CONFIG: ConfigOf<Drive<f32, observer::TwoMass<f32>, (), SpeedLoop<f32>>> = Config {
//!     limits: Limits::<f32>::new(&Screening {
//!         torque: 500.0, reference: 180.0, innovation: 0.05, standstill: 0.0015, missed: 150,
//!     }, Bases::SI),
//!     observer: TwoMassConfig::<f32>::new(&DESIGN, Bases::SI),
//!     fluctuation: (),
//!     governor: SpeedLoopConfig::<f32>::new(
//!         &TWO.speed_loop(RATE, SpeedLoopTuning::USUAL),
//!         SpeedLoopSettings { torque_limit: 300.0, ramp: 75.0 }, Bases::SI,
//!     ),
//!     balancer: (),
//! };
//!
//! let mut mill = Mill::new(&CONFIG, 0);
//! // every 100 us: the angle of 2^32 to the turn, the torque of the tick that has just ended, the speed that is wanted
//! let command = mill.tick(&CONFIG, &Sample { angle: 0, torque: 0.0, reference: 150.0 });
//! assert!(command.faults.is_none() && command.torque > 0.0 && command.torque <= 300.0);
//! // what cannot be true is flagged and left out
//! let command = mill.tick(&CONFIG, &Sample { angle: 1 << 30, torque: f32::NAN, reference: 150.0 });
//! assert_eq!(command.faults.to_string(), "torque, angle jump");
//! ```
//!
//! A machine that cannot be, or cannot be controlled, is a compile error with a sentence; at run time, where the machine is read from a
//! file, the `try_` form of each function returns the same sentence:
//!
//! ```
//! # use driveline::design::{Disturbance, Encoder, Error, Rate};
//! # use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness};
//! # let machine = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35));
//! # let usual = Disturbance { torque_accuracy: 2.0, load_torque_step: 100.0, within: 1.0 };
//! let two = machine.reduce(Match::ResonanceAntiresonance);
//! assert_eq!(two.try_observer(Rate::hz(10_000), Encoder::lines(0), usual), Err(Error::EncoderLines));
//! assert!(Chain::try_motor(Inertia(-0.62)).unwrap_err().message().contains("inertia"));
//! ```
//!
//! # The rooms
//! [`machine`] says what the machine is, [`design`] how it will be controlled (both `const fn` in `f64`), and [`constants`] turns a design into
//! what a [`number`] can hold. [`observer`], [`fluctuation`], [`governor`] and [`balance`] are the parts of a [`drive`], composed by type: a
//! part that a machine does not need is `()` and costs nothing. [`commissioning`] finds the machine by a test. [`sample`] is what goes in and
//! comes out, [`fault`] what was wrong with it.
//!
//! # Glossary
//! | term | meaning | unit |
//! |---|---|---|
//! | twist | motor angle less load angle, referred to the motor | rad |
//! | slip, twist rate | motor speed less load speed | rad/s |
//! | shaft torque | torque that the shaft or rope carries, referred to the motor | N m |
//! | load torque | torque that the load opposes to its motion | N m |
//! | resonance, antiresonance | natural frequency of the free machine; of the machine with its motor held | rad/s |
//! | reduction | two masses that stand for a longer chain | |
//! | innovation | measured less predicted motor angle | 2^-32 turn |
//! | cycle | what repeats: a turn of the motor, two of a four-stroke engine, or any ratio | |
//! | order | multiple of the cycle's frequency | |
//! | delta | largest less least speed of a cycle, over its mean | |
//! | tick | one run of the controller, at a fixed rate | |
//! | coast | a tick by prediction alone, since the angle cannot be used | |
//! | base | what a fixed-point number is a fraction of | |
//!
//! # Features
//! `defmt`: `defmt::Format` for every public type that can have it. `balancing`: influence coefficients, weights and the procedure, off the
//! tick. `hal`: adapters to `embedded-hal` 1.0 (`driveline::hal`). `hal-async`: those on SPI awaited as well, by `embedded-hal-async` 1.0. `telemetry`:
//! records of the ticks as frames over `embedded-io` (`driveline::telemetry`). `parameters`: a versioned record in flash
//! (`driveline::parameters`).
//! tick. `hal`: adapters to `embedded-hal` 1.0 (`driveline::hal`); `hal-async`: those on SPI awaited as well. `telemetry`: records of the ticks as
//! frames over `embedded-io` (`driveline::telemetry`). `parameters`: a versioned record in flash (`driveline::parameters`).

pub mod balance;
pub mod commissioning;
pub mod configure;
pub mod constants;
pub mod design;
pub mod drive;
pub mod fault;
pub mod fluctuation;
pub mod governor;
#[cfg(feature = "hal")]
pub mod hal;
#[cfg(feature = "defmt")]
mod logged;
pub mod machine;
pub mod number;
pub mod observer;
#[cfg(feature = "parameters")]
pub mod parameters;
pub mod prelude;
pub mod sample;
pub mod scalar;
#[cfg(feature = "telemetry")]
pub mod telemetry;
