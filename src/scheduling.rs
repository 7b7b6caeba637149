//! Gain scheduling: constants of observer and governor over two parameters of the machine, such as load and rope.
//!
//! A [`Schedule`] holds the constants at the points of a grid, designed by the compiler (see
//! [`Family`](crate::configure::Family)). Between two ticks, some twenty times a second, the drive takes those of the
//! present parameters ([`Drive::follow`](crate::drive::Drive::follow)): bilinear interpolation, and bumpless transfer.
//! The tick is that of a drive without a schedule. [`ShaperSlots`] is the schedule of an input shaper, over the rope
//! alone.
//!
//! | scheduling variable | from |
//! |---|---|
//! | [`LoadMass`] | the estimated load torque: `m = tau_L/(g r)`, filtered |
//! | [`RopeLength`] | the motor's turns |
//!
//! # Terms
//! *Scheduling variable*: a measured or estimated parameter that the gains follow. *Travel*: the load's path per angle
//! of the motor, r (m/rad).

mod constants;
mod grid;
mod load_mass;
mod rope_length;
mod shaper_slots;

pub use grid::{Breakpoints, Schedule};
pub use load_mass::{LoadMass, LoadMassConfig};
pub use rope_length::RopeLength;
pub use shaper_slots::ShaperSlots;
