//! Files that results go to: never a source, never one file twice, and whole or not at all.
//!
//! A command checks its files before it begins, prints what it found, and only then writes them: where the system lets
//! nothing be written, the figures are printed all the same. Long work is not begun for a named file that cannot be
//! written. A file is written beside its place and renamed, so that
//! what stood there is kept until the new one is complete.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::output::say;
use crate::machine_file::printable;
use driveline_qemu::children::Guard;
use tempfile::NamedTempFile;

/// The folder of pages that nobody named.
const FOLDER: &str = "report";

/// A file that a result goes to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    /// What it holds: `page`, `table`.
    what: &'static str,
    path: PathBuf,
    /// Whether its folder is made where it is missing: that of the pages is, one that the user names may be a typo.
    makes_folder: bool,
    /// Whether the user named it.
    is_named: bool,
}

impl Destination {
    /// A path that the user chose.
    pub fn chosen(what: &'static str, path: &Path) -> Self {
        Self { what, path: path.to_owned(), makes_folder: path.parent() == Some(Path::new(FOLDER)), is_named: true }
    }

    /// The page of a command: where `--html` says, else `report/NAME.html`.
    pub fn page(html: Option<&Path>, name: &str) -> Self {
        let usual = Path::new(FOLDER).join(format!("{name}.html"));
        Self { is_named: html.is_some(), ..Self::chosen("page", html.unwrap_or(&usual)) }
    }

    /// The page of a command that with `--json` writes one only where `--html` says.
    pub fn page_unless(json: bool, html: Option<&Path>, name: &str) -> Option<Self> {
        (html.is_some() || !json).then(|| Self::page(html, name))
    }

    /// Writes it and says where.
    ///
    /// # Errors
    /// What the file system says; what stood there is left as it was.
    pub fn write(&self, bytes: &(impl AsRef<[u8]> + ?Sized)) -> Result<(), Failure> {
        self.begin(bytes.as_ref()).map(drop).map_err(|error| self.unwritable(&error))
    }

    /// Writes it, and says where it is unless there is JSON on standard output.
    pub fn write_and_say(&self, bytes: &(impl AsRef<[u8]> + ?Sized), json: bool) -> Result<(), Failure> {
        self.write(bytes)?;
        if !json {
            say(printable(&format!("{}: {}", self.what, self.name()), usize::MAX));
        }
        Ok(())
    }

    /// Makes its folder, where that is made.
    pub fn make_folder(&self) -> Result<(), Failure> {
        let made = if self.makes_folder { fs::create_dir_all(folder_of(&self.path)) } else { Ok(()) };
        made.map_err(|error| self.unwritable(&error))
    }

    /// Writes its beginning, and gives the file for what follows: until the beginning is complete, what stood there
    /// stays.
    pub fn begin(&self, bytes: &[u8]) -> io::Result<File> {
        let there = fs::metadata(&self.path).ok();
        if there.as_ref().is_some_and(|there| !there.is_file()) {
            // a terminal, a pipe: nothing to rename
            let mut file = OpenOptions::new().write(true).open(&self.path)?;
            file.write_all(bytes)?;
            return Ok(file);
        }
        let path = behind_links(&self.path);
        let folder = folder_of(&path);
        if self.makes_folder {
            fs::create_dir_all(folder)?;
        }
        let permissions = there.map_or_else(|| fs::Permissions::from_mode(0o666), |there| there.permissions());
        let make = || tempfile::Builder::new().prefix(".driveline-").permissions(permissions).tempfile_in(folder);
        let (_guard, mut beside) = Guard::around(make, NamedTempFile::path)?;
        beside.write_all(bytes)?;
        // a disk that is full may say so only here
        beside.as_file().sync_all()?;
        Ok(beside.persist(path)?)
    }

    fn name(&self) -> std::path::Display<'_> {
        self.path.display()
    }

    /// That it cannot be written, and why.
    pub fn unwritable(&self, error: &io::Error) -> Failure {
        Failure::failed(format!("{} cannot be written: {}", self.name(), reason(error)))
    }

    /// Whether it can be written, as far as can be told without writing.
    fn probe(&self) -> io::Result<()> {
        let path = behind_links(&self.path);
        match fs::metadata(&path) {
            Ok(there) if is_special(&there) => return Ok(()),
            // a file that may not be written may not be replaced either
            Ok(_) => drop(OpenOptions::new().append(true).open(&path)?),
            Err(_) => {}
        }
        let folder = Some(folder_of(&path)).filter(|folder| folder.exists()).unwrap_or(Path::new("."));
        let make = || tempfile::Builder::new().prefix(".driveline-").tempfile_in(folder);
        Guard::around(make, NamedTempFile::path).map(|(_guard, file)| drop(file))
    }

    /// Whether it is a file in a folder that is there. What the system refuses is said when it is written.
    fn check(&self) -> Result<(), Failure> {
        let there = fs::metadata(&self.path);
        if there.as_ref().is_ok_and(Metadata::is_dir) {
            return Err(Failure::usage(format!("{} is a folder; name a file in it", self.name())));
        }
        let path = behind_links(&self.path);
        if path.is_symlink() {
            return Err(Failure::usage(format!("{} is a link that leads to itself; name a file", self.name())));
        }
        let folder = folder_of(&path);
        if there.is_ok_and(|there| is_special(&there)) || folder.is_dir() || self.makes_folder && !folder.exists() {
            return Ok(());
        }
        let (name, there) = (self.name(), folder.exists());
        let folder = folder.display();
        Err(Failure::usage(if there {
            format!("{name}: {folder} is not a folder")
        } else {
            format!("{name}: there is no folder {folder}; make it, or name another")
        }))
    }
}

/// Before any work: refuses files that are a source or one another, and those whose folder is missing. Standard output
/// counts where it goes into a file. A source `-` is standard input.
pub fn check<'d>(sources: &[&Path], files: impl IntoIterator<Item = &'d Destination>) -> Result<(), Failure> {
    let source =
        |path: &&Path| (Identity::of(if **path == *"-" { Path::new("/dev/stdin") } else { path }), "made from");
    let mut taken: Vec<(Option<Identity>, &str)> = sources.iter().map(source).collect();
    let output = Identity::of(Path::new("/dev/stdout"));
    if taken.iter().any(|(source, _)| source.is_some() && *source == output) {
        return Err(Failure::usage("standard output would overwrite the input of the result"));
    }
    taken.push((output, "also printed to"));
    for file in files {
        let identity = Identity::of(&file.path);
        if let Some((_, how)) = taken.iter().find(|(other, _)| identity.is_some() && *other == identity) {
            let sentence = match *how {
                "made from" => format!("{} would overwrite its own input", file.name()),
                "also printed to" => format!("{} is where standard output goes; name another file", file.name()),
                what => format!("{} would hold both the {what} and the {}; name another file", file.name(), file.what),
            };
            return Err(Failure::usage(sentence));
        }
        file.check()?;
        taken.push((identity, file.what));
    }
    Ok(())
}

/// The same before long work, and whether each file that the user named can be written.
pub fn check_writable<'d>(
    sources: &[&Path],
    files: impl IntoIterator<Item = &'d Destination> + Clone,
) -> Result<(), Failure> {
    check(sources, files.clone())?;
    for file in files.into_iter().filter(|file| file.is_named) {
        file.probe().map_err(|error| file.unwritable(&error))?;
    }
    Ok(())
}

/// Of results that are all written, whichever fails: the first failure.
pub fn all(written: impl IntoIterator<Item = Result<(), Failure>>) -> Result<(), Failure> {
    let written: Vec<_> = written.into_iter().collect();
    written.into_iter().collect()
}

/// The file that a path leads to, by whatever name or link.
#[derive(Debug, PartialEq, Eq)]
enum Identity {
    /// Device and inode.
    There(u64, u64),
    /// Not there yet: its folder's, and its name in it.
    New(u64, u64, PathBuf),
    /// Nor is its folder.
    Far(PathBuf),
}

impl Identity {
    /// None for a terminal or a pipe, which hold nothing to be lost.
    fn of(path: &Path) -> Option<Self> {
        match fs::metadata(path) {
            Ok(there) if is_special(&there) => None,
            Ok(there) => Some(Self::There(there.dev(), there.ino())),
            Err(_) => {
                let path = behind_links(path);
                match (fs::metadata(folder_of(&path)), path.file_name()) {
                    (Ok(folder), Some(name)) => Some(Self::New(folder.dev(), folder.ino(), name.into())),
                    _ => std::path::absolute(path).ok().map(Self::Far),
                }
            }
        }
    }
}

fn is_special(there: &Metadata) -> bool {
    let kind = there.file_type();
    kind.is_char_device() || kind.is_block_device() || kind.is_fifo() || kind.is_socket()
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Where a file is or would be made: behind all symbolic links, also behind those that lead to nothing yet.
fn behind_links(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // as many as Linux follows
    for _ in 0..40 {
        let Ok(next) = fs::read_link(&path) else { break };
        path = folder_of(&path).join(next);
    }
    path
}

/// A field of a CSV, in quotes where it has to be [RFC 4180].
pub fn field(text: &str) -> String {
    if text.contains([',', '"', '\r', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// The system's words without the path of the file beside, which means nothing to the user.
fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" at path ").next().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::path::Path;

    use super::{Destination, check};

    fn refused(sources: &[&Path], files: &[Destination]) -> String {
        check(sources, files).unwrap_err().to_string()
    }

    #[test]
    fn a_source_is_known_by_every_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("source"), "kept").unwrap();
        symlink(at("source"), at("symbolic")).unwrap();
        fs::hard_link(at("source"), at("hard")).unwrap();
        fs::create_dir(at("sub")).unwrap();
        let source = at("source");
        for name in ["source", "symbolic", "hard", "sub/../source", "./source"] {
            let page = Destination::chosen("page", &at(name));
            let sentence = refused(&[&source], &[page]);
            assert!(sentence.ends_with("would overwrite its own input"), "{sentence}");
        }
        check(&[&source], &[Destination::chosen("page", &at("other"))]).unwrap();
        assert_eq!(fs::read_to_string(source).unwrap(), "kept");
    }

    #[test]
    fn two_results_have_two_files() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        let both = [Destination::chosen("table", &at("new")), Destination::chosen("page", &at("sub/../new"))];
        assert!(refused(&[], &both).contains("would hold both the table and the page"));
        fs::write(at("old"), "").unwrap();
        symlink(at("old"), at("link")).unwrap();
        let both = [Destination::chosen("table", &at("old")), Destination::chosen("page", &at("link"))];
        assert!(refused(&[], &both).contains("would hold both the table and the page"));
        // links to a file that is not there yet, one behind the other
        symlink("future", at("dangling")).unwrap();
        symlink("sub/../dangling", at("second")).unwrap();
        for (one, other) in [("future", "dangling"), ("dangling", "second"), ("second", "sub/../future")] {
            let both = [Destination::chosen("table", &at(one)), Destination::chosen("page", &at(other))];
            assert!(refused(&[], &both).contains("would hold both the table and the page"), "{one} {other}");
        }
        let page = Destination::chosen("page", &at("second"));
        page.write("new").unwrap();
        assert_eq!(fs::read_to_string(at("future")).unwrap(), "new");
        assert!(at("dangling").is_symlink() && at("second").is_symlink());
        symlink("loop", at("loop")).unwrap();
        assert!(refused(&[], &[Destination::chosen("page", &at("loop"))]).contains("leads to itself"));
        let both = ["table", "page"].map(|what| Destination::chosen(what, &at("not/there")));
        assert_eq!(super::Identity::of(&both[0].path), super::Identity::of(&both[1].path));
        // what holds nothing can be written twice
        let both = ["table", "page"].map(|what| Destination::chosen(what, Path::new("/dev/null")));
        check(&[], &both).unwrap();
    }

    #[test]
    fn a_folder_that_is_not_there_is_not_made_by_a_typo() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("reprot/page.html");
        assert!(refused(&[], &[Destination::chosen("page", &path)]).contains("there is no folder"));
        assert!(refused(&[], &[Destination::chosen("page", folder.path())]).contains("is a folder"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_page_replaces_the_old_one_whole_and_keeps_its_links_and_rights() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("page"), "old").unwrap();
        fs::set_permissions(at("page"), fs::Permissions::from_mode(0o640)).unwrap();
        symlink(at("page"), at("link")).unwrap();
        let page = Destination::chosen("page", &at("link"));
        check(&[], [&page]).unwrap();
        page.write("new").unwrap();
        assert_eq!(fs::read_to_string(at("page")).unwrap(), "new");
        assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
        assert_eq!(fs::metadata(at("page")).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing is left beside");
        let full = Destination::chosen("page", Path::new("/dev/full"));
        if Path::new("/dev/full").exists() {
            assert!(full.write("text").unwrap_err().to_string().contains("No space left"));
        }
    }
}
