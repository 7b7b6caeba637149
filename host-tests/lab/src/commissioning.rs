//! Commissioning against full plants: the test of `driveline::commissioning` in closed loop with the solver, on the
//! host or in QEMU.

mod course;
mod engine;
mod machine;
mod truth;
mod verdict;

pub use course::{Course, Moment, run};
pub use engine::{Target, VARIANT, in_qemu, on_host};
pub use machine::{Case, Trial, cases, named, of_file};
pub use truth::Truth;
pub use verdict::{Row, Verdict, verdict};
