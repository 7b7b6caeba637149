//! A written crate, compiled in a temporary folder.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Error};
use std::path::Path;
use std::process::{Command, Stdio};

use crate::cli::Failure;
use crate::cli::progress::Progress;
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
        .args(["build", "--release", "--target-dir"])
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
    let (progress, mut said) = (Progress::open(), String::new());
    for line in child.stderr.take().into_iter().flat_map(|stderr| BufReader::new(stderr).lines()) {
        let line = line.map_err(failed)?;
        // cargo's own lines have their verb at the right of twelve columns; an error begins at the left
        match line.strip_prefix("   ").map(str::trim_start) {
            Some(step) if step.starts_with("Finished") => {}
            Some(step) if step.starts_with(char::is_uppercase) => progress.says(step),
            _ => said += &format!("{line}\n"),
        }
    }
    drop(progress);
    if !child.wait().map_err(failed)?.success() {
        return Err(Failure::failed(format!("the compiler refused the code of this machine:\n{}", said.trim_end())));
    }
    let built = target.map_or_else(|| "target".into(), |target| Path::new("target").join(target));
    fs::read(folder.join(built).join("release").join(library)).map_err(failed)
}
