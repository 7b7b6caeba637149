//! A written crate, compiled in a temporary folder.

use std::fs::{self, File};
use std::io::{Error, Read};
use std::path::Path;
use std::process::{Command, Stdio};

use crate::cli::Failure;
use driveline_qemu::children::{Folder, Running};
use driveline_qemu::clone::target_directory;
use driveline_qemu::setup::cargo;

/// Compiles the crate whose files are below `rust/`, for a target or this computer: the bytes of its library, by the
/// library's file name.
///
/// With `keep`, and inside a clone, its dependencies are compiled once, in the clone's target folder.
///
/// # Errors
/// The compiler's error, such as a speed loop that is not stable within its tolerances.
pub fn build(files: &[(String, Vec<u8>)], target: Option<&str>, library: &str, keep: bool) -> Result<Vec<u8>, Failure> {
    let failed = |error: Error| Failure::failed(format!("the library cannot be built: {error}"));
    let temporary = Folder::make().map_err(failed)?;
    let kept = target_directory().ok().filter(|_| keep).map(|clone| clone.join("exported"));
    let folder = kept.as_deref().unwrap_or(temporary.path());
    fs::create_dir_all(folder).map_err(failed)?;
    // one export after the other, until this one's library is read
    let lock = File::create(folder.join("lock")).map_err(failed)?;
    lock.lock().map_err(failed)?;
    for (path, bytes) in files {
        let path = folder.join(path);
        fs::create_dir_all(path.parent().unwrap_or(folder)).map_err(failed)?;
        fs::write(path, bytes).map_err(failed)?;
    }
    let mut command = Command::new(cargo());
    command
        .args(["build", "--release", "--quiet", "--target-dir"])
        .arg(folder.join("target"))
        .args(target.iter().flat_map(|target| ["--target", target]))
        .current_dir(folder.join("rust"))
        // flags for the caller's own crates
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .env_remove("CARGO_BUILD_TARGET")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut child = Running::start(&mut command).map_err(failed)?;
    let mut said = String::new();
    if let Some(mut stderr) = child.stderr.take() {
        stderr.read_to_string(&mut said).map_err(failed)?;
    }
    if !child.wait().map_err(failed)?.success() {
        return Err(Failure::failed(format!("the compiler refused the code of this machine:\n{}", said.trim_end())));
    }
    let built = target.map_or_else(|| "target".into(), |target| Path::new("target").join(target));
    fs::read(folder.join(built).join("release").join(library)).map_err(failed)
}
