//! A folder of its own, and the command run in it.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A folder that a test writes its files into and runs the command in; it goes with the test.
pub struct Bench(TempDir);

impl Bench {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// With a file in it.
    pub fn with(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let bench = Self::new();
        bench.write(name, bytes);
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-driveline"));
        command.arg("driveline").args(arguments).current_dir(&self.0).env_remove("CARGO_TARGET_DIR").output().unwrap()
    }

    /// What a command prints that succeeds.
    #[track_caller]
    pub fn said(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    }

    /// The same with `--json`.
    #[track_caller]
    pub fn json(&self, arguments: &[&str]) -> Value {
        serde_json::from_str(&self.said(&[arguments, &["--json"]].concat())).unwrap()
    }

    /// What a command says that is not begun, and prints nothing.
    #[track_caller]
    pub fn refused(&self, arguments: &[&str]) -> String {
        self.ended(arguments, 2)
    }

    /// What a command says whose answer is no, and prints nothing.
    #[track_caller]
    pub fn failed(&self, arguments: &[&str]) -> String {
        self.ended(arguments, 1)
    }

    #[track_caller]
    fn ended(&self, arguments: &[&str], code: i32) -> String {
        let Output { status, stdout, stderr } = self.run(arguments);
        let [said, printed] = [stderr, stdout].map(|bytes| String::from_utf8(bytes).unwrap());
        assert_eq!((status.code(), &*printed), (Some(code), ""), "{arguments:?}: {said}");
        said
    }
}

/// Encoder, control, disturbance and limits of a machine whose drive does not matter.
pub const SETTINGS: &str = "[encoder]\nlines = 2048\n[control]\nrate_hz = 10000\n[disturbance]\n\
    torque_accuracy = 1.0\nload_torque_step = 1.0\nwithin = 1.0\n[limits]\ntorque = 100.0\nspeed = 200.0\n";

#[track_caller]
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// What a command answers of a file with this text.
#[track_caller]
pub fn answered(command: &str, text: &str) -> Value {
    Bench::with("file.toml", text).json(&[command, "file.toml"])
}
