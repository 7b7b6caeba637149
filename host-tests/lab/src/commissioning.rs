//! Commissioning against full plants: the test of `driveline::commissioning` in closed loop with the solver, on the
//! host.

mod course;
mod machine;
mod truth;
mod verdict;

pub use course::{Course, on_host, run};
pub use machine::{Case, named};
pub use truth::Truth;
pub use verdict::{Row, Verdict, verdict};
