//! The observers on the host: the program `replay` of the crate `host-tests/peers`.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use driveline_qemu::clone::{target_directory, workspace};

use super::recording::{Recording, words};
use driveline_closed_loop::units::Units;

/// What there is, by number.
#[derive(Clone, Debug, Default)]
pub struct Listed {
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Names of the observers.
    pub peers: Vec<String>,
    /// Those that have a corner to tune.
    pub tuned: Vec<String>,
}

/// The program.
#[derive(Clone, Debug)]
pub struct Replay(PathBuf);

impl Replay {
    /// Builds it.
    pub fn build() -> Result<Self, Box<dyn Error>> {
        let target = target_directory()?.join("peers");
        let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--manifest-path=host-tests/peers/Cargo.toml", "--bin=replay", "--target-dir"])
            .arg(&target)
            .current_dir(workspace()?)
            .stdin(Stdio::null())
            .output()?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        Ok(Replay(target.join("debug/replay")))
    }

    /// What it has.
    pub fn list(&self) -> Result<Listed, Box<dyn Error>> {
        let output = Command::new(&self.0).arg("list").output()?;
        let mut listed = Listed::default();
        for line in String::from_utf8(output.stdout)?.lines() {
            match line.split_once(' ') {
                Some(("scene", name)) => listed.scenes.push(name.to_owned()),
                Some(("peer", name)) => listed.peers.push(name.to_owned()),
                Some(("tuned", name)) => listed.tuned.push(name.to_owned()),
                _ => return Err(format!("{} lists `{line}`", self.0.display()).into()),
            }
        }
        Ok(listed)
    }

    /// Estimates of an observer of a scene over a recording, both by their numbers; empty where the machine has no such
    /// observer.
    pub fn estimates(
        &self,
        [scene, peer]: [usize; 2],
        corner: f32,
        recording: &Recording,
        units: &Units,
    ) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
        let mut child = Command::new(&self.0)
            .args([scene.to_string(), peer.to_string(), corner.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let mut bytes = Vec::with_capacity(12 * recording.ticks.len());
        for tick in &recording.ticks {
            let input = words(tick, units, false);
            for word in [input.angle, input.torque, input.flags] {
                bytes.extend(word.to_le_bytes());
            }
        }
        // It reads all before it writes; closed at the end of the statement.
        child.stdin.take().ok_or("no standard input")?.write_all(&bytes)?;
        let output = child.wait_with_output()?;
        if !output.status.success() {
            return Err(format!("{} ended with {}", self.0.display(), output.status).into());
        }
        let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        let pairs = output.stdout.chunks_exact(8);
        Ok(pairs.map(|pair| [units.torque(word(pair)), units.speed(word(&pair[4..]))]).collect())
    }
}
