//! A copy of QEMU for this project alone, unpacked from the system's packages; the system is left as it is.
//!
//! For a machine where `apt-get` would have to remove something to install QEMU, and for a user who may not install.

use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::Path;

use super::packages::Manager;
use super::runner::Runner;
use crate::link::{Emulator, QEMU};

/// Whether a manager's packages can be unpacked so.
pub fn is_possible(manager: Manager) -> bool {
    manager == Manager::Apt
}

/// Downloads the packages and unpacks them into [`Emulator::folder`].
///
/// # Errors
/// A sentence: a folder that cannot be made, a download or a package that failed.
pub fn make(runner: &mut Runner) -> Result<(), String> {
    let folder = Emulator::folder();
    let parent = folder.parent().unwrap_or(Path::new("."));
    let at = |path: &Path| format!("{}", path.display());
    let io = |path: &Path, error: io::Error| format!("{}: {error}", at(path));
    fs::create_dir_all(parent).map_err(|error| io(parent, error))?;
    // beside its later place, so that it can be moved there whole
    let work = tempfile::Builder::new().prefix("qemu-").tempdir_in(parent).map_err(|error| io(parent, error))?;
    let (archives, unpacked) = (work.path().join("archives"), work.path().join("unpacked"));
    for path in [&archives.join("partial"), &work.path().join("lists/partial"), &unpacked] {
        fs::create_dir_all(path).map_err(|error| io(path, error))?;
    }
    let apt = |words: &[&str]| -> Vec<String> {
        let folders = [
            format!("Dir::Cache::archives={}", at(&archives)),
            format!("Dir::State::lists={}", at(&work.path().join("lists"))),
            format!("Dir::Cache::pkgcache={}", at(&work.path().join("packages.bin"))),
            format!("Dir::Cache::srcpkgcache={}", at(&work.path().join("sources.bin"))),
            // nothing of the system's is written: root's locks are not needed
            "Debug::NoLocking=true".to_owned(),
            // the unprivileged user of downloads cannot write here
            "APT::Sandbox::User=root".to_owned(),
        ];
        let options = folders.into_iter().flat_map(|option| ["-o".to_owned(), option]);
        ["apt-get", "-qq"].map(String::from).into_iter().chain(options).chain(words.iter().map(|&w| w.into())).collect()
    };
    runner.say("package lists are downloaded into a folder of their own");
    let warning = runner.quietly(&apt(&["update"]), "apt-get update")?;
    let download = apt(&["install", "-y", "--download-only", "--no-install-recommends", QEMU]);
    runner.say(&format!("{QEMU} and the libraries that it lacks are downloaded"));
    // without a network there are no lists, which is no error of the update's
    let lists = |error| format!("{error} ({warning})");
    runner.quietly(&download, "apt-get install --download-only").map_err(lists)?;
    let packages = fs::read_dir(&archives).map_err(|error| io(&archives, error))?;
    let packages: Vec<_> = packages.flatten().map(|entry| entry.path()).collect();
    for package in packages.iter().filter(|path| path.extension() == Some(OsStr::new("deb"))) {
        let command = ["dpkg-deb".into(), "-x".into(), at(package), at(&unpacked)];
        runner.quietly(&command, "dpkg-deb")?;
    }
    if !Emulator::Copy(unpacked.clone()).answers() {
        return Err(format!("{QEMU} as unpacked from {} packages does not start", packages.len()));
    }
    // an older copy, or one without its libraries, does not answer
    if folder.exists() && !Emulator::Copy(folder.clone()).answers() {
        fs::remove_dir_all(&folder).map_err(|error| io(&folder, error))?;
    }
    match fs::rename(&unpacked, &folder) {
        // another process has made one meanwhile
        Err(_) if Emulator::Copy(folder.clone()).answers() => Ok(()),
        other => other.map_err(|error| io(&folder, error)),
    }
}
