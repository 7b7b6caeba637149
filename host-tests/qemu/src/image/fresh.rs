//! Whether an image on disk is what would be built: by a fingerprint of everything that goes into it.
//!
//! A variant is chosen by an environment variable, so that cargo builds the firmware anew whenever another was built in
//! between. The fingerprint of the sources, kept beside the image, saves that for images that are already there.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io;
use std::path::Path;
use std::process::Command;

/// Sources of an image, from the workspace's root, beside the folder of its crate.
const SOURCES: [&str; 5] = ["Cargo.toml", "Cargo.lock", ".cargo/config.toml", "src", "firmware"];

/// Fingerprint of the sources, with those in `folder`, of the compiler and of the command.
pub fn fingerprint(root: &Path, folder: &str, command: &str) -> io::Result<String> {
    let mut hasher = DefaultHasher::new();
    command.hash(&mut hasher);
    Command::new("rustc").arg("-vV").current_dir(root).output()?.stdout.hash(&mut hasher);
    for source in SOURCES.into_iter().chain((!SOURCES.contains(&folder)).then_some(folder)) {
        add(&root.join(source), &mut hasher)?;
    }
    Ok(format!("{:016x}", hasher.finish()))
}

/// Adds a file, or a folder's files in the order of their names.
fn add(path: &Path, hasher: &mut DefaultHasher) -> io::Result<()> {
    path.hash(hasher);
    if !path.is_dir() {
        fs::read(path)?.hash(hasher);
        return Ok(());
    }
    let mut entries: Vec<_> = fs::read_dir(path)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    entries.sort();
    entries.iter().try_for_each(|entry| add(entry, hasher))
}
