//! A new folder that appears whole or not at all.

use std::fs;
use std::io;
use std::path::Path;

use crate::cli::Failure;
use driveline_qemu::children::Folder;

/// Writes files, by their paths in it, into a folder that does not exist yet, or is empty.
///
/// They are written into a temporary folder beside it, which then takes its name.
///
/// # Errors
/// A folder that has something in it, a parent that does not exist, the system's error. Nothing is left then.
pub fn write(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<(), Failure> {
    is_free(folder)?;
    let failed = |error: io::Error| Failure::failed(format!("{} cannot be written: {error}", folder.display()));
    let folder = std::path::absolute(folder).map_err(failed)?;
    let parent = folder.parent().unwrap_or(&folder);
    let temporary = Folder::make_in(parent).map_err(failed)?;
    // a folder in it, since the temporary one is for its owner alone
    let whole = temporary.path().join("whole");
    for (path, bytes) in files {
        let path = whole.join(path);
        fs::create_dir_all(path.parent().unwrap_or(&whole)).map_err(failed)?;
        fs::write(path, bytes).map_err(failed)?;
    }
    // an empty folder is replaced; one that has come to hold something is an error of the system
    fs::rename(&whole, &folder).map_err(failed)
}

/// Whether a folder can be written: before long work.
pub fn is_free(folder: &Path) -> Result<(), Failure> {
    let shown = folder.display();
    match fs::read_dir(folder).map(|entries| entries.count()) {
        Ok(entries) if entries > 0 => {
            return Err(Failure::usage(format!("{shown} exists and is not empty; name a new folder")));
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            return Err(Failure::usage(format!("{shown} is no folder that can be written: {error}")));
        }
        _ => {}
    }
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
    match whole.parent() {
        Some(parent) if parent.is_dir() => Ok(()),
        _ => Err(Failure::usage(format!("{shown} would stand in a folder that does not exist; make that first"))),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::write;

    #[test]
    fn a_folder_appears_whole_and_nothing_else_does() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("project");
        let files = [("a.txt".to_owned(), b"a".to_vec()), ("b/c.txt".to_owned(), b"c".to_vec())];
        write(&folder, &files).unwrap();
        assert_eq!(fs::read(folder.join("b/c.txt")).unwrap(), b"c");
        // it is not written over
        let refused = write(&folder, &[("a.txt".to_owned(), b"other".to_vec())]).unwrap_err().to_string();
        assert!(refused.contains("exists and is not empty"), "{refused}");
        assert_eq!(fs::read(folder.join("a.txt")).unwrap(), b"a");
        // a file where a folder is needed: the write fails half-way, and nothing is left
        let other = place.path().join("other");
        let files = [("a".to_owned(), Vec::new()), ("a/b".to_owned(), Vec::new())];
        write(&other, &files).unwrap_err();
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
        // an empty folder is taken
        fs::create_dir(&other).unwrap();
        write(&other, &[("a".to_owned(), Vec::new())]).unwrap();
        assert!(other.join("a").is_file());
        let nowhere = write(&place.path().join("none/project"), &[]).unwrap_err().to_string();
        assert!(nowhere.contains("make that first"), "{nowhere}");
    }
}
