//! Building an image with cargo.
//!
//! In two target directories of its own, `target/firmware/fpu` for cores with an FPU and `target/firmware/no-fpu` for
//! the others. A test or a command that is itself run by cargo does not wait for cargo's lock, and two images can be
//! built at once. In each directory it is one image at a time: it is copied out before the next variant overwrites it.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::process::{Command, Stdio};

use driveline_firmware::board::Facts;

use super::fresh::fingerprint;
use super::{Image, Program};
use crate::children::{Folder, Running};
use crate::clone::{NoClone, target_directory, workspace};

/// Why an image was not built.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// There is nothing to build it from.
    #[error(transparent)]
    NoClone(#[from] NoClone),
    /// A file or cargo could not be reached.
    #[error("{place}: {error}")]
    Io {
        /// The step.
        place: String,
        error: io::Error,
    },
    /// Cargo refused.
    #[error("`{command}` failed:\n{output}")]
    Cargo {
        /// The command to type.
        command: String,
        output: String,
    },
}

/// Builds `program` holding `variant` for `board`, unless the image on disk is what would be built; `progress` receives
/// each line printed by cargo.
pub fn build(
    variant: &str,
    board: Facts,
    program: Program,
    mut progress: impl FnMut(&str),
) -> Result<Image, BuildError> {
    let (workspace, target) = (workspace()?, target_directory()?);
    let images = target.join("images");
    let place = |what: String| move |error| BuildError::Io { place: what, error };
    fs::create_dir_all(&images).map_err(place(format!("making {}", images.display())))?;
    let lane = if board.target.ends_with("hf") { "fpu" } else { "no-fpu" };
    let lock = images.join(format!(".{lane}.lock"));
    let held = File::create(&lock).map_err(place(format!("making {}", lock.display())))?;
    held.lock().map_err(place(format!("locking {}", lock.display())))?;

    let firmware = target.join("firmware").join(lane);
    let of_core = match board.core {
        "m7" => ",m7",
        "g474" => ",nucleo-g474re",
        _ => "",
    };
    let arguments = [
        "build",
        &format!("--manifest-path={}/Cargo.toml", program.folder()),
        "--profile=firmware",
        &format!("--{}={}", program.kind(), program.name()),
        &format!("--features={}{of_core}", program.features()),
        &format!("--target={}", board.target),
    ];
    let command = format!(
        "DRIVELINE_VARIANT={variant} DRIVELINE_BOARD={} DEFMT_LOG=info cargo {}",
        board.name,
        arguments.join(" ")
    );
    let path = images.join(format!("{}.{}.{}.elf", variant.replace('/', "-"), board.core, program.name()));
    let stamp = path.with_extension("stamp");
    let fresh =
        fingerprint(workspace, program.folder(), &command).map_err(place("reading the firmware's sources".into()))?;
    let image = Image { path: path.clone(), variant: variant.into(), board, program };
    if path.exists() && fs::read_to_string(&stamp).is_ok_and(|old| old == fresh) {
        return Ok(image);
    }
    let folder = Folder::make().map_err(place(format!("starting `{command}`")))?;
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .args(arguments)
        .arg("--target-dir")
        .arg(&firmware)
        .env("DRIVELINE_VARIANT", variant)
        .env("DRIVELINE_BOARD", board.name)
        // logs below this level are not in the image
        .env("DEFMT_LOG", "info")
        // what the compiler leaves when it is stopped goes with the folder
        .env("TMPDIR", folder.path())
        // these would replace the linker script that .cargo/config.toml names
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .current_dir(workspace)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let mut child = Running::start(&mut cargo).map_err(place(format!("starting `{command}`")))?;
    let mut output = String::new();
    for line in child.stderr.take().into_iter().flat_map(|stderr| BufReader::new(stderr).lines()) {
        let line = line.map_err(place(format!("reading from `{command}`")))?;
        progress(&line);
        output.push_str(&line);
        output.push('\n');
    }
    let status = child.wait().map_err(place(format!("waiting for `{command}`")))?;
    if !status.success() {
        return Err(BuildError::Cargo { command, output });
    }
    let built = firmware.join(board.target).join("firmware").join(program.name());
    // Without its stamp a half-copied image is never taken for a fresh one.
    let _ = fs::remove_file(&stamp);
    fs::copy(&built, &path).map_err(place(format!("copying {} to {}", built.display(), path.display())))?;
    fs::write(&stamp, fresh).map_err(place(format!("writing {}", stamp.display())))?;
    Ok(image)
}

/// Whether an image links: no where the linker names the symbol that a reachable panic calls.
pub fn links(variant: &str, board: Facts, program: Program) -> Result<bool, BuildError> {
    match build(variant, board, program, |_| {}) {
        Ok(_) => Ok(true),
        Err(BuildError::Cargo { output, .. }) if output.contains("undefined symbol: panic_is_reachable") => Ok(false),
        Err(error) => Err(error),
    }
}
