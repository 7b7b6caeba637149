//! The QEMU that runs the images: the one on the path, else the private copy that `setup` has made.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub const PROGRAM: &str = "qemu-system-arm";

/// The program for 32-bit RISC-V, which runs where it is installed: Debian's package is `qemu-system-misc`.
pub const RISC_V: &str = "qemu-system-riscv32";

/// A QEMU for Arm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Emulator {
    /// Installed, and on the path.
    Installed,
    /// Unpacked below this folder, with the libraries that the system lacks.
    Copy(PathBuf),
}

impl Emulator {
    /// The one to use; none where there is neither.
    pub fn find() -> Option<Self> {
        let path = env::var_os("PATH").unwrap_or_default();
        if env::split_paths(&path).any(|folder| folder.join(PROGRAM).is_file()) {
            return Some(Emulator::Installed);
        }
        let copy = Emulator::Copy(Self::folder());
        copy.answers().then_some(copy)
    }

    /// The folder of the private copy: `driveline/qemu` in the user's cache, else among temporary files.
    pub fn folder() -> PathBuf {
        crate::cache::folder("qemu")
    }

    /// A command that starts it.
    pub fn command(&self) -> Command {
        let folder = match self {
            Emulator::Installed => return Command::new(PROGRAM),
            Emulator::Copy(folder) => folder,
        };
        let mut command = Command::new(folder.join("usr/bin").join(PROGRAM));
        command.arg("-L").arg(folder.join("usr/share/qemu")).env("LD_LIBRARY_PATH", library_path(folder));
        command
    }

    /// Whether it starts and gives its version.
    pub fn answers(&self) -> bool {
        let status = self.command().arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        status.is_ok_and(|status| status.success())
    }
}

/// The folders of libraries below `folder`, one for each architecture (`usr/lib/x86_64-linux-gnu`), before the caller's
/// own.
fn library_path(folder: &Path) -> OsString {
    let mut path: Vec<PathBuf> = Vec::new();
    for libraries in [folder.join("usr/lib"), folder.join("lib")] {
        let inside = fs::read_dir(&libraries).into_iter().flatten().flatten().map(|entry| entry.path());
        path.extend(inside.filter(|path| path.is_dir()));
        path.push(libraries);
    }
    path.sort();
    let own = env::var_os("LD_LIBRARY_PATH").filter(|own| !own.is_empty());
    path.extend(own.iter().flat_map(env::split_paths));
    // a colon in the user's own path cannot be written in a search path
    env::join_paths(path).unwrap_or_default()
}
