//! Pages in a browser. Without one a step says so and counts nothing.

use super::{Count, Failed, Voice, cargo};

/// Names under which Chromium is installed; the tests have the same.
const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];
/// Of the tests that need a browser, the one that needs QEMU, too.
const OF_FIRMWARE: &str = "pages_of_firmware_read_well_in_a_browser";

fn is_installed() -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|place| BROWSERS.iter().any(|name| place.join(name).is_file()))
}

/// Every page that a command writes within seconds, the scope, and the design.
pub fn quick(voice: &Voice) -> Result<Count, Failed> {
    in_browser(3, &["in_a_browser", "--skip", OF_FIRMWARE], voice)
}

/// The pages of commands that compile and run firmware.
pub fn of_firmware(voice: &Voice) -> Result<Count, Failed> {
    in_browser(1, &[OF_FIRMWARE], voice)
}

/// Runs so many tests, or fails.
fn in_browser(expected: u64, tests: &[&str], voice: &Voice) -> Result<Count, Failed> {
    if !is_installed() {
        voice.say("skipped: Chromium is not installed");
        return Ok(Count { skipped: expected, ..Count::default() });
    }
    let run = ["test", "--package=driveline-lab", "--test=commands", "--", "--ignored", "--nocapture"];
    let count = cargo::tests(&[&run[..], tests].concat(), voice)?;
    if count.passed == expected {
        Ok(count)
    } else {
        let message = format!("{} tests ran, expected {expected}", count.passed);
        Err(Failed { count, message })
    }
}
