//! The full solver of rotors: a shaft with discs on bearings, turning and whirling, as a balancer sees it.
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | spin, speed | angle and rate of the shaft's own turning, `phi` and `Omega` | rad, rad/s |
//! | station | a place along the shaft where unbalance acts and weights can be set | |
//! | unbalance | `u = m e exp(i phi_u)`: mass times distance from the axis, at an angle fixed in the rotor | kg m |
//! | sensor | a direction in which the shaft's motion is read at a place | |
//! | influence coefficient | vibration at a sensor per unbalance at a station, both complex | m/(kg m) |
//! | critical speed | speed at which the unbalance meets a natural whirl | rad/s |
//! | forward, backward | whirl with the spin, against it | |
//!
//! Coordinates of a node: deflections `x`, `y` and slopes `dx/dz`, `dy/dz`. With `q` all of them,
//! `M q'' + (C + Omega G) q' + K q = f`, `G` the gyroscopic matrix. A disc of polar inertia `Ip` turns its slopes by
//! `Id s_x'' + Ip Omega s_y' = ...`, `Id s_y'' - Ip Omega s_x' = ...`. The torque that speeds a disc up follows its
//! axis, so a changing speed brings no term of its own. An unbalance `u` brings the force `u (Omega^2 - i Omega') exp(i
//! phi)`, its real part along `x`, its imaginary part along `y`; at a constant speed a vibration is `Re(X exp(i phi))`.
//!
//! Sources: Timoshenko elements with consistent mass [Nelson 1980, J. Mech. Design 102(4), 793-803], gyroscopic terms
//! [Nelson and McVaugh 1976, J. Eng. Ind. 98(2), 593-600], shear coefficient [Cowper 1966, J. Appl. Mech. 33, 335-340].
//!
//! ```
//! use driveline_solver::rotor::{Bearing, Direction, Disc, FlexibleRotor, Material, Polar};
//! let rotor = FlexibleRotor::uniform(12, 1.2, 0.05, Material::STEEL)
//!     .disc(3, Disc::of(0.28, 0.05, 0.05, Material::STEEL))
//!     .bearing(0, Bearing::isotropic(4e6, 2500.0))
//!     .bearing(12, Bearing::isotropic(4e6, 2500.0))
//!     .station(3)
//!     .sensor(1, Direction::X)
//!     .build()?;
//! let vibration = rotor.response(100.0, &[Polar::degrees(1e-4, 30.0)])?;
//! assert!(vibration[0].norm() > 1e-8);
//! # Ok::<(), driveline_solver::rotor::RotorError>(())
//! ```
//!
//! - [`FlexibleRotor`] and [`RigidRotor`] describe, [`Model`] holds the equations and answers at a constant speed,
//!   with the natural whirls, the Campbell diagram and the critical speeds;
//! - [`Modal`] has the natural vibrations at rest, all of them or the lowest;
//! - [`Whirl`] runs in time, in lock-step with a spin; [`converge`] proves a run by another integrator;
//! - [`Spin`] turns the shaft, with ripple; [`Transducer`] is what a sensor makes of the truth.

mod band;
mod beam;
mod bearing;
pub mod converge;
mod count;
mod critical;
mod error;
mod flexible;
mod material;
mod modal;
mod model;
mod pencil;
mod polar;
mod rigid;
mod spin;
mod stepping;
mod transducer;
mod whirl;

pub use beam::Section;
pub use bearing::Bearing;
pub use critical::{Campbell, Critical, Natural, WhirlSense};
pub use error::RotorError;
pub use flexible::{Disc, FlexibleRotor};
pub use material::Material;
pub use modal::Modal;
pub use model::{Direction, Model};
pub use polar::Polar;
pub use rigid::RigidRotor;
pub use spin::{Ripple, Spin, Turn};
pub use transducer::{Faulty, Transducer};
pub use whirl::{Motion, Whirl};
