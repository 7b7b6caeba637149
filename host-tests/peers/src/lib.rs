#![no_std]
//! Other observers on the signals of driveline's scenes.
//!
//! Each is an observer behind one trait, [`Replayed`]: angle and torque of a tick in, shaft torque and load speed out.
//! `replay` runs one on the host over a recording, the image `peers` runs the same code in QEMU and counts it.
//!
//! | observer | model | tuning |
//! |---|---|---|
//! | [`library`] | as the scenes have them | the scene's; `tuned` by a bandwidth, which is swept |
//! | [`ByHand`], [`ByNalgebra`] | two masses and load torque, 5 states | gains of the library's design |
//! | [`ByHand`] as Luenberger | the same | poles of Butterworth's pattern, their radius swept |
//! | [`DisturbanceObserver`] | motor's inertia | its corner, swept |
//! | [`DifferenceLowPass`] | motor's inertia | its corner, swept |
//! | [`kalman`] of `idsp` | 5 states, covariance live | Q, R and first covariance of the library's design |
//!
//! All behind a lossy gear get the same friction and the same deadband as the library's observers.

pub mod constant_gain;
pub mod kalman;
pub mod library;
pub mod list;
pub mod luenberger;
pub mod model;
pub mod scene;
pub mod simple;

pub use constant_gain::{ByHand, ByNalgebra};
pub use list::{PEERS, TUNED, Visitor, with};
pub use model::{Behind, Model, Peer, Replayed};
pub use scene::{SCENES, Scene};
pub use simple::{DifferenceLowPass, DisturbanceObserver};
