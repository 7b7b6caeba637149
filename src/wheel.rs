//! The toothed wheel: the angle and the times of a cycle's teeth, from one capture interrupt.
//!
//! | part | called by | gives |
//! |---|---|---|
//! | [`ToothedWheel::tooth`] | the interrupt of the crank's capture | |
//! | [`ToothedWheel::cam`] | the interrupt of a cam's capture, where there is one | the phase of the cycle |
//! | [`ToothedWheel::index`] | that of an index's capture | the zero of a wheel without a gap |
//! | [`ToothedWheel::at`] | the tick | the angle, with its standard deviation |
//! | [`ToothedWheel::take`] | the main loop, once a cycle | the times of its teeth, for [`crate::fluctuation`] |
//!
//! # Place
//! The wheel is described by the angles of its teeth ([`crate::settings::Teeth`]). While the place is unknown, the
//! ratio of each interval to the one before excludes the places where it cannot occur. The place that is left must then
//! hold for a turn, for two where there is jitter or where the teeth are few. Every tooth must come within half a pitch
//! of where the smoothed speed expects it: a wheel with other teeth gives no angle. A wheel that once was found to be
//! the one described is found again at its next gap, if the edges counted since it was known lead to that gap, or time
//! and speed do. Otherwise the machine may have turned back, and the place is checked for a turn.
//!
//! # Speed
//! The passage of the next tooth is predicted from a smoothed time and a smoothed speed, which are corrected by the
//! prediction's error. How strongly follows from the errors: errors of the same sign call for more, errors of
//! alternating sign are jitter and call for less.
//!
//! # Edges too many and too few
//! An edge that comes early by more than five times the errors' mean size, or by three quarters of a pitch, is left
//! out. An edge that fits one of the next [`SKIPPED`] teeth stands for that tooth. Behind a longer interval the machine
//! is taken to have paused, if its speed was steady; otherwise the place is lost. More than eight of these lose the
//! place; one is forgotten in 16 good teeth.
//!
//! # Doubt
//! There is no angle while other places are possible. Behind a tooth without an edge two teeth must come when expected.
//! The place must be found again where an edge stands in a gap, or where a tooth without an edge may have been a slower
//! speed. The same holds where the speed falls to half of that of late: the machine may turn back.
//!
//! One pickup does not see the direction: the wheel counts upwards.

mod angle;
mod cam;
mod check;
mod cycle;
mod description;
mod phase;
mod place;
mod state;
mod tooth;
mod track;

pub use angle::{SKIPPED, WheelAngle};
pub(crate) use cycle::LOST;
pub use cycle::{CycleTimes, ToothCycle, ToothRecord};
pub use description::{Tooth, ToothedWheelConfig};
pub use phase::Cam;
pub(crate) use place::{MOST, RATIOS, ratio_of};
pub use state::{Synchronization, ToothedWheel};
