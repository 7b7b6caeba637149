//! Where a project takes the crates of `driveline` from.

use std::path::{Path, PathBuf};

/// The crates: in the clone that this program was built from, else as published.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The root of the clone.
    Clone(PathBuf),
    /// The version.
    Published(&'static str),
}

impl Source {
    /// Where this program's own sources are, if they still are there.
    pub fn find() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("/"));
        if root.join("budgets.toml").is_file() && root.join("src/lib.rs").is_file() {
            Source::Clone(root.into())
        } else {
            Source::Published(env!("CARGO_PKG_VERSION"))
        }
    }

    /// The dependency on the crate in a folder of the repository, in the words of a `Cargo.toml`.
    pub fn dependency(&self, folder: &str) -> String {
        match self {
            // a basic string of TOML escapes as Rust does
            Source::Clone(root) => format!("path = {:?}", root.join(folder).to_string_lossy().trim_end_matches('/')),
            Source::Published(version) => format!("version = {version:?}"),
        }
    }

    /// The clone's `Cargo.lock`: the versions that it was tested with.
    pub fn lock(&self) -> Option<Vec<u8>> {
        match self {
            Source::Clone(root) => std::fs::read(root.join("Cargo.lock")).ok(),
            Source::Published(_) => None,
        }
    }

    /// The comment above the dependencies.
    pub fn note(&self) -> &'static str {
        match self {
            Source::Clone(_) => {
                "# By path: the clone that wrote this project. On another machine name its git address\n\
                 # (git = \"...\"), or its version once it is published."
            }
            Source::Published(_) => "# The version that wrote this project.",
        }
    }
}
