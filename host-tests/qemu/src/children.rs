//! Child processes and temporary files that do not outlive this one: ended and removed with their owner, and by
//! Ctrl-C, SIGTERM, SIGHUP or SIGQUIT where the program has asked for that.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::{Deref, DerefMut};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, exit};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, WaitOptions, kill_process_group, test_kill_process_group, waitpid};
use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;
use tempfile::TempDir;

/// All that is to be ended and removed, by numbers given in turn.
struct Owned {
    /// Whether signals are caught; children are then in groups of their own.
    signals: bool,
    next: u64,
    /// Leaders of groups, and whether they may have children in other groups and folders to remove.
    children: BTreeMap<u64, (Pid, bool)>,
    /// Temporary files and folders.
    paths: BTreeMap<u64, PathBuf>,
}

static OWNED: Mutex<Owned> =
    Mutex::new(Owned { signals: false, next: 0, children: BTreeMap::new(), paths: BTreeMap::new() });

fn owned() -> MutexGuard<'static, Owned> {
    OWNED.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Owned {
    fn number(&mut self) -> u64 {
        self.next += 1;
        self.next
    }
}

/// Longest wait for children that end their own children and folders. A QEMU at a pipe waits half a second in them.
const GRACE: Duration = Duration::from_secs(3);

/// From now on Ctrl-C, SIGTERM, SIGHUP and SIGQUIT end the children with theirs and remove the temporary files, before
/// they end the program as ever. SIGHUP stays ignored where it is, as by `nohup`.
pub fn end_with_signals() -> io::Result<()> {
    let hangup = (!ignores(SIGHUP)).then_some(SIGHUP);
    let mut signals = Signals::new([SIGINT, SIGTERM, SIGQUIT].into_iter().chain(hangup))?;
    owned().signals = true;
    thread::Builder::new().name("signals".into()).spawn(move || {
        let Some(signal) = signals.forever().next() else { return };
        // held to the end: nothing begins any more, and nobody reports what is ended here as a failure
        let owned = owned();
        for &(child, nests) in owned.children.values() {
            let _ = kill_process_group(child, if nests { Signal::TERM } else { Signal::KILL });
        }
        let begun = Instant::now();
        for &(child, _) in owned.children.values().filter(|(_, nests)| *nests) {
            // its leader is reaped here: until then its group exists
            while begun.elapsed() < GRACE && test_kill_process_group(child).is_ok() {
                let _ = waitpid(Some(child), WaitOptions::NOHANG);
                thread::sleep(Duration::from_millis(5));
            }
            let _ = kill_process_group(child, Signal::KILL);
        }
        for path in owned.paths.values() {
            // a child that was killed may still be closing its files
            for _ in 0..50 {
                let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
                if removed.is_ok() || !path.exists() {
                    break;
                }
                thread::sleep(Duration::from_millis(10));
            }
        }
        let _ = emulate_default_handler(signal);
        exit(128 + signal);
    })?;
    Ok(())
}

/// Whether a signal was ignored when the program began, where the system says so.
fn ignores(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).is_ok_and(|mask| mask >> (signal - 1) & 1 == 1))
}

/// A child; ended with its owner.
#[derive(Debug)]
pub struct Running {
    child: Child,
    number: u64,
    /// Whether it leads a group, which is then ended whole.
    leads: bool,
}

impl Running {
    /// Starts a child.
    pub fn start(command: &mut Command) -> io::Result<Self> {
        // under the lock, lest a signal come between the start and the entry
        let mut owned = owned();
        let leads = owned.signals;
        if leads {
            command.process_group(0);
        }
        let child = command.spawn()?;
        let number = owned.number();
        if let (true, Some(pid)) = (leads, i32::try_from(child.id()).ok().and_then(Pid::from_raw)) {
            // cargo runs tests and programs that are owners themselves
            let nests = Path::new(command.get_program()).file_stem().is_some_and(|name| name == "cargo");
            owned.children.insert(number, (pid, nests));
        }
        Ok(Running { child, number, leads })
    }
}

impl Deref for Running {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.child
    }
}

impl DerefMut for Running {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.child
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if matches!(self.child.try_wait(), Ok(None)) {
            if let (true, Some(pid)) = (self.leads, i32::try_from(self.child.id()).ok().and_then(Pid::from_raw)) {
                let _ = kill_process_group(pid, Signal::KILL);
            }
            // the kernel's kill: a QEMU that waits for a pipe does not hear a polite one
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
        owned().children.remove(&self.number);
    }
}

/// A path that signals remove while this lives.
#[derive(Debug)]
pub struct Guard {
    number: u64,
}

impl Guard {
    /// Makes a temporary file or folder, which its owner removes, and guards it; of a pair the second is dropped first.
    pub fn around<T>(make: impl FnOnce() -> io::Result<T>, path: impl FnOnce(&T) -> &Path) -> io::Result<(Self, T)> {
        // under the lock, lest a signal come between the two
        let mut owned = owned();
        let made = make()?;
        let number = owned.number();
        owned.paths.insert(number, path(&made).to_owned());
        Ok((Self { number }, made))
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        owned().paths.remove(&self.number);
    }
}

/// A temporary folder; removed with its owner.
#[derive(Debug)]
pub struct Folder {
    // removed before its guard goes
    folder: TempDir,
    _guard: Guard,
}

impl Folder {
    /// Makes one.
    ///
    /// # Errors
    /// Where it was to be made and what the system says.
    pub fn make() -> io::Result<Self> {
        Self::make_in(&std::env::temp_dir()).map_err(|error| {
            let place = std::env::temp_dir();
            let sentence = format!(
                "no temporary folder can be made in {}: {}; TMPDIR names another",
                place.display(),
                error.kind()
            );
            io::Error::new(error.kind(), sentence)
        })
    }

    /// Makes one, hidden, in another folder.
    pub fn make_in(place: &Path) -> io::Result<Self> {
        let prefix = if place == std::env::temp_dir() { "driveline-" } else { ".driveline-" };
        let make = || tempfile::Builder::new().prefix(prefix).tempdir_in(place);
        let (guard, folder) = Guard::around(make, TempDir::path)?;
        Ok(Folder { folder, _guard: guard })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Whether its disk has no room left.
    pub fn is_full(&self) -> bool {
        rustix::fs::statvfs(self.path()).is_ok_and(|disk| disk.f_bavail == 0)
    }
}

#[cfg(test)]
mod tests {
    use std::process::{Command, Stdio};

    use super::{Folder, Running};

    #[test]
    fn a_child_and_a_folder_end_with_their_owners() {
        let folder = Folder::make().unwrap();
        let path = folder.path().to_owned();
        std::fs::write(path.join("file"), "").unwrap();
        let mut child = Running::start(Command::new("cat").stdin(Stdio::piped()).stdout(Stdio::piped())).unwrap();
        let mut output = child.stdout.take().unwrap();
        assert!(matches!(child.try_wait(), Ok(None)));
        drop(child);
        // the other end is closed: it has ended
        assert_eq!(std::io::Read::read(&mut output, &mut [0]).unwrap(), 0);
        drop(folder);
        assert!(!path.exists());
    }
}
