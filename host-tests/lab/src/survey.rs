//! Every scene and every stiff case at one go: what they come to beside what is aimed at, and why a scene misses.
//!
//! The list of drivetrains is [`SCENES`](crate::drivetrains::SCENES)', that of variants the firmware's, that of rotors
//! [`balancing::scenes`](crate::balancing::scenes)'. The work is cut into [jobs](Job), which share the cores; a job
//! that fails is reported in its place and loses no other.
//!
//! | term | meaning |
//! |---|---|
//! | aim | rms error that a scene's chosen observer may have: shaft torque of its peak, load speed of rated |
//! | chosen | the observer that the scene's design takes, in every number and on every core |
//! | dynamic factor | peak of the shaft torque over the largest that the machine would carry were it rigid |
//! | reason | what a missed aim's squared error is made of, measured, beside what the design predicted |

mod aim;
mod factor;
mod figures;
mod jobs;
mod page;
mod pool;
mod selection;

pub use aim::Aim;
pub use factor::Factor;
pub use figures::{Failure, Gentle, Run, SceneFigures, Survey};
pub use jobs::{CASES, Job, Piece, jobs};
pub use page::{survey_markdown, survey_table};
pub use pool::work;
pub use selection::{COMMISSIONING, GENERATOR, Wanted};
