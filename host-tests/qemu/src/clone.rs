//! The clone of the repository that images are built from: the current folder is in it.

use std::env;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// No folder from the current one upwards is a clone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this needs a clone of driveline's repository, and the current folder is in none; type it inside one")]
pub struct NoClone;

/// Files that only the root of the repository has together.
const ROOT: [&str; 3] = ["budgets.toml", "firmware/Cargo.toml", "src/lib.rs"];

/// The root of the clone.
pub fn workspace() -> Result<&'static Path, NoClone> {
    static FOUND: OnceLock<Option<PathBuf>> = OnceLock::new();
    FOUND.get_or_init(|| root(&env::current_dir().ok()?)).as_deref().ok_or(NoClone)
}

/// The root of the nearest clone that a folder is, or lies in.
pub fn root(folder: &Path) -> Option<PathBuf> {
    folder.ancestors().find(|folder| ROOT.iter().all(|file| folder.join(file).is_file())).map(Path::to_owned)
}

/// Cargo's target directory of the clone.
pub fn target_directory() -> Result<PathBuf, NoClone> {
    let root = workspace()?;
    let named = env::var_os("CARGO_TARGET_DIR").filter(|name| !name.is_empty());
    let named = named.map_or_else(|| root.join("target"), PathBuf::from);
    Ok(std::path::absolute(&named).unwrap_or(named))
}
