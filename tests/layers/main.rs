//! Layers: in no crate of the workspace do files import each other in a circle, and no import runs back up between
//! folders.
//!
//! A file imports another where a path in it, resolved through re-exports, leads to an item that stands there. A `mod`
//! line and a re-export that is not used where it stands are no imports: they say where things are. What is compiled
//! only for unit tests does not count. Folders are judged as files are: in each folder, its files and its folders, each
//! taken as one, have an order from the ground up.

mod graph;
mod imports;
mod manifests;
mod planted;
mod tree;

use std::path::{Path, PathBuf};

use graph::{circles, folders};
use imports::imports;
use tree::Tree;

/// The library and the host's crates, by the file that each begins with.
const CRATES: [&str; 7] = [
    "src/lib.rs",
    "firmware/src/lib.rs",
    "host-tests/longest-path/src/lib.rs",
    "host-tests/solver/src/lib.rs",
    "host-tests/report/src/lib.rs",
    "host-tests/qemu/src/lib.rs",
    "host-tests/command/src/lib.rs",
];

fn workspace() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// What is wrong with a crate, a sentence each.
fn faults(tree: &Tree) -> Vec<String> {
    let imports = imports(tree);
    let in_files = circles(&imports).into_iter().map(|circle| format!("files in a circle:\n{circle}"));
    let in_folders = folders(tree, &imports).into_iter().map(|circle| format!("imports that run back up:\n{circle}"));
    in_files.chain(in_folders).collect()
}

#[test]
fn no_file_and_no_folder_imports_what_imports_it() {
    let mut faults_of_all = Vec::new();
    for first in CRATES {
        let tree = Tree::on_disk(&workspace().join(first));
        assert!(!tree.files().is_empty() && !imports(&tree).is_empty(), "{first}: nothing was read");
        faults_of_all.extend(faults(&tree).into_iter().map(|fault| format!("{first}: {fault}")));
    }
    assert!(faults_of_all.is_empty(), "{}", faults_of_all.join("\n"));
}

/// Every source file is read, so that none escapes the check.
#[test]
fn every_file_is_read() {
    for first in CRATES {
        let first = workspace().join(first);
        let tree = Tree::on_disk(&first);
        let mut unread = sources(first.parent().unwrap());
        unread.retain(|path| !tree.reads(path));
        // Programs of the crate import its library; nothing imports them.
        unread.retain(|path| !path.ends_with("main.rs") && !path.components().any(|part| part.as_os_str() == "bin"));
        assert_eq!(unread, Vec::<PathBuf>::new(), "not read");
    }
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            found.push(path);
        }
    }
    found
}
