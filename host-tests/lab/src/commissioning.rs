//! Commissioning against full plants: the test of `driveline::commissioning` in closed loop with the solver, on the
//! host.

mod course;
mod engine;
mod machine;
mod truth;
mod verdict;

pub use course::{Course, run};
pub use engine::on_host;
pub use machine::{Case, Trial, named, of_file};
pub use truth::Truth;
pub use verdict::{Row, Verdict, verdict};
