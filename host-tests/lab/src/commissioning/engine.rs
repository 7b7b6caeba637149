//! The test on the host.

use std::error::Error;

use driveline::commissioning::TestConfig;
use driveline_firmware::scenes::commission::Commission;

use super::course::{Course, run};
use super::machine::Case;
use driveline_closed_loop::ticks::OnHost;

/// Runs a case on the host.
pub fn on_host(case: &Case, seed: u64) -> Result<Course, Box<dyn Error>> {
    // It lives as long as the program: there are a few.
    let config: &'static TestConfig = Box::leak(Box::new(TestConfig::try_new(&case.settings)?));
    Ok(run(case, seed, &mut OnHost(Commission::of(config)))?)
}
