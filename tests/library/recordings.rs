//! Where recordings of real machines are: they are not part of the project (GPL-3.0), but read from a folder beside it.

use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A file or folder of the recordings, in `DRIVELINE_RECORDINGS`, or else in `../shared/real` beside the repository;
/// where it is not there, says that the test is skipped.
pub fn recording(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/real");
    let path = std::env::var_os("DRIVELINE_RECORDINGS").map_or_else(beside, PathBuf::from).join(name);
    if !path.exists() {
        // past the capture of the test's runner, so that the check counts the test as skipped
        let (thread, path) = (std::thread::current(), path.display());
        let test = thread.name().unwrap_or("a test");
        let line = format!("\nskipped: {test}: no {path}; DRIVELINE_RECORDINGS names the folder of the recordings\n");
        let _ = std::io::stdout().write_all(line.as_bytes());
        return None;
    }
    Some(path)
}
