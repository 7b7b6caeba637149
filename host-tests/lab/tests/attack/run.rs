//! A run of the command in a place of its own, and what is wrong with how it ended.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// A run that takes longer is ended: a guard against a hang, on a busy machine too.
const LIMIT: Duration = Duration::from_secs(120);

/// A folder to work in, one for temporary files, and an empty one for everything else.
pub struct Place {
    folder: TempDir,
    /// What was put there before the run.
    sources: BTreeMap<PathBuf, Vec<u8>>,
}

/// How a run ended.
pub struct Ended {
    pub code: Option<i32>,
    pub signal: Option<i32>,
    pub out: Vec<u8>,
    pub err: Vec<u8>,
    /// It was ended at the limit.
    pub late: bool,
}

impl Ended {
    pub fn said(&self) -> String {
        String::from_utf8_lossy(&self.err).into_owned()
    }
}

impl Place {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        for name in ["work", "tmp", "empty"] {
            fs::create_dir(folder.path().join(name)).unwrap();
        }
        Place { folder, sources: BTreeMap::new() }
    }

    /// A path in the folder to work in.
    pub fn at(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join("work").join(name)
    }

    pub fn outside(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Puts a file there, which no run may change.
    pub fn put(&mut self, name: &str, bytes: &[u8]) {
        fs::write(self.at(name), bytes).unwrap();
        self.sources.insert(name.into(), bytes.to_vec());
    }

    /// The command in this place. No other program is found from it, and no clone.
    pub fn command(&self, program: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(program);
        let empty = self.outside("empty");
        command.current_dir(self.at("")).env_clear().env("TMPDIR", self.outside("tmp"));
        for name in ["PATH", "HOME", "XDG_CACHE_HOME"] {
            command.env(name, &empty);
        }
        command
    }

    /// Runs the command with bytes on standard input.
    pub fn run(&self, arguments: &[OsString], input: &[u8]) -> Ended {
        let mut command = self.command(env!("CARGO_BIN_EXE_lab"));
        command.args(arguments);
        self.end(command, input)
    }

    /// Runs any command line in this place.
    pub fn end(&self, mut command: Command, input: &[u8]) -> Ended {
        let [out, err, stdin] = ["out", "err", "in"].map(|name| self.outside(name));
        fs::write(&stdin, input).unwrap();
        let into = |path: &Path| Stdio::from(File::create(path).unwrap());
        command.stdin(File::open(&stdin).unwrap()).stdout(into(&out)).stderr(into(&err));
        let (status, late) = wait(command.spawn().unwrap(), LIMIT);
        let [out, err] = [out, err].map(|path| fs::read(path).unwrap());
        Ended { code: status.code(), signal: status.signal(), out, err, late }
    }

    /// Runs a command line whose output goes through pipes, which have no limit of their size.
    pub fn piped(&self, mut command: Command) -> Ended {
        let output = command.stdin(Stdio::null()).output().unwrap();
        let (code, signal) = (output.status.code(), output.status.signal());
        Ended { code, signal, out: output.stdout, err: output.stderr, late: false }
    }

    /// What lies in a folder, by path: the bytes of files, nothing for folders.
    fn files(folder: &Path) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![folder.to_owned()];
        while let Some(next) = folders.pop() {
            for entry in fs::read_dir(next).unwrap() {
                let path = entry.unwrap().path();
                let name = path.strip_prefix(folder).unwrap().to_owned();
                if path.is_dir() {
                    folders.push(path);
                    found.insert(name, None);
                } else {
                    found.insert(name, Some(fs::read(path).unwrap_or_default()));
                }
            }
        }
        found
    }

    /// What is wrong with the files after a run: sources that have changed, what is left, pages that are half.
    pub fn faults(&self, results: &[&str], done: bool) -> Vec<String> {
        let mut faults = Vec::new();
        for name in Self::files(&self.outside("tmp")).into_keys().chain(Self::files(&self.outside("empty")).into_keys())
        {
            faults.push(format!("{} is left among the temporary files", name.display()));
        }
        let mut there = Self::files(&self.at(""));
        for (name, bytes) in &self.sources {
            if there.remove(name).flatten().as_ref() != Some(bytes) {
                faults.push(format!("the source {} has changed", name.display()));
            }
        }
        for (name, bytes) in there {
            let named = results.iter().any(|result| Path::new(result) == name) || name.starts_with("report");
            match bytes {
                None if name == Path::new("report") => {}
                Some(bytes) if named && done => {
                    let is_page = name.extension().is_some_and(|extension| extension == "html");
                    if is_page && !bytes.trim_ascii_end().ends_with(b"</html>") {
                        faults.push(format!("the page {} is not whole", name.display()));
                    }
                }
                _ => faults.push(format!("{} is left", name.display())),
            }
        }
        faults
    }

    /// Removes results, for the next run.
    pub fn clear(&self) {
        for name in Self::files(&self.at("")).into_keys().filter(|name| !self.sources.contains_key(name)) {
            let path = self.at(&name);
            let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        }
    }
}

/// Waits for a child, and kills it at the limit.
pub fn wait(mut child: Child, limit: Duration) -> (std::process::ExitStatus, bool) {
    let begun = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return (status, false);
        }
        if begun.elapsed() > limit {
            let _ = child.kill();
            return (child.wait().unwrap(), true);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// What no message has: words of a panic, of Rust's own output, of the library behind.
const NOT_SENTENCES: [&str; 8] =
    ["panicked", "RUST_BACKTRACE", "Os {", "Err(", "Some(", "unwrap", "assertion", "stack overflow"];

/// What is wrong with how a run ended: no exit code that there is, no sentence, no JSON, a number that is none.
pub fn wrong(ended: &Ended, json: bool) -> Vec<String> {
    let mut faults = Vec::new();
    let said = ended.said();
    let out = String::from_utf8_lossy(&ended.out);
    if ended.late {
        // long work says so
        return if said.trim().is_empty() { vec!["it takes long and says nothing".into()] } else { faults };
    }
    match ended.code {
        Some(0) if said.contains("error:") => faults.push("exit code 0 with an error".into()),
        Some(0) if json && serde_json::from_slice::<serde_json::Value>(&ended.out).is_err() => {
            faults.push("exit code 0 without JSON".into());
        }
        Some(0) if ["NaN", " inf"].iter().any(|word| out.contains(word)) => {
            faults.push("exit code 0 with a number that is none".into());
        }
        Some(0) => {}
        Some(1 | 2) if json => {
            let line = said.lines().last().unwrap_or_default();
            let error = serde_json::from_str::<serde_json::Value>(line).ok();
            if error.is_none_or(|error| error["error"].as_str().is_none_or(|sentence| sentence.len() < 10)) {
                faults.push("an error without its JSON".into());
            }
        }
        Some(1 | 2) if !said.contains("error: ") => faults.push("an error without a sentence".into()),
        Some(1 | 2) => {}
        code => faults.push(format!("exit code {code:?}, signal {:?}", ended.signal)),
    }
    faults.extend(NOT_SENTENCES.iter().filter(|word| said.contains(**word)).map(|word| format!("it says `{word}`")));
    if said.chars().any(|c| c.is_control() && !matches!(c, '\n' | '\t')) {
        faults.push("a control character in a message".into());
    }
    faults
}
