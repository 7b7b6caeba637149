//! A full solver of drivetrains and rotors, and the proof of its runs against a second integrator.
//!
//! It shares no code with `driveline`, whose observers and controllers are judged by it: [`plant`] solves chains and
//! trains of masses, shafts, gaps, gears and brakes, [`rotor`] whirling rotors, [`noise`] is that of their sensors.

mod exponential;
mod jacobi;
pub mod noise;
pub mod plant;
pub mod rotor;
