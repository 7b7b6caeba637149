//! The two-mass steps over stiff and extreme machines: where each is right, where it is not, and why.
//!
//! Every step runs open loop, its correction gains zero, through the library's own tick. [`errors`] puts a machine
//! through a load torque that begins at once and pseudo-random motor torques, and compares with an exact motion of own
//! arithmetic. [`growths`] looks at the poles of the coefficients as they are stored.
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | place | one machine at one rate: omega T, inertia ratio, damping | |
//! | course | torques and ticks that a place is run through | |
//! | error | of speeds in the energy norm, or of the shaft torque, of the run's largest | 1 |
//! | growth | factor of a free swing over 1e8 ticks, less one | 1 |

mod cause;
mod error;
mod grid;
mod growth;
mod load;
mod number;
mod poles;
mod program;
mod reference;
mod step;

pub use cause::Cause;
pub use error::{FINEST, Outcome, STEPS, USABLE, errors};
pub use grid::{PERIOD, Place, open_loop, places};
pub use growth::{Growth, TICKS, TOLERANCE, growths};
pub use number::Swept;
pub use poles::log_radius;
pub use reference::{Reference, Truth};
pub use step::{Increments, OpenLoop, Step};
