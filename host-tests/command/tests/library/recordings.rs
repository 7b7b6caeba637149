//! Where recordings of real machines are: they are not part of the project (GPL-3.0), but read from a folder beside it.

use std::path::{Path, PathBuf};

use cargo_driveline::check::skip;

/// A file or folder of the recordings, in `DRIVELINE_RECORDINGS`, or else in `../shared/real` beside the repository;
/// where it is not there, says that the test is skipped.
pub fn recording(name: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/real");
    let path = std::env::var_os("DRIVELINE_RECORDINGS").map_or_else(beside, PathBuf::from).join(name);
    if !path.exists() {
        skip(format!("no {}; DRIVELINE_RECORDINGS names the folder of the recordings", path.display()));
        return None;
    }
    Some(path)
}
