//! `cargo lab peers`: other observers on the scenes' own runs.

use std::path::PathBuf;

use clap::Args;
use driveline_firmware::board::BOARDS;

use crate::peers::{Comparison, Images, Replay, SceneComparison, peers_markdown, scenes};
use crate::stamp::Stamp;
use cargo_driveline::cli::results::{Destination, check_writable};
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::setup::Need;

/// Compare the library's observers with others on the scenes' own runs: errors, instructions, code, stack and state.
///
/// The others are constant gains by hand and by `nalgebra`, Luenberger, a disturbance observer, a low-pass, and the
/// Kalman filter of `idsp`. They are dependencies of a crate of their own, which this command builds.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo lab peers
  cargo lab peers --scene hoist spindle
  cargo lab peers --markdown doc/makers/peers.md")]
pub struct Peers {
    /// Only these scenes
    #[arg(long, value_name = "NAME", num_args = 1..)]
    scene: Vec<String>,
    /// Seconds of each run at most, 1 to 1000
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=1000))]
    seconds: u32,
    /// Where the tables go as Markdown, for the book
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Print JSON, and no table
    #[arg(long)]
    pub json: bool,
}

impl Peers {
    /// Runs the comparison and shows it.
    ///
    /// # Errors
    /// No such scene; a build or a run that failed; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        if let Some(unknown) = self.scene.iter().find(|name| scenes().all(|scene| scene != *name)) {
            let known: Vec<String> = scenes().map(|scene| format!("`{scene}`")).collect();
            return Err(Failure::usage(format!("there is no scene `{unknown}`; there are {}", known.join(", "))));
        }
        let markdown = self.markdown.as_ref().map(|path| Destination::chosen("tables", path));
        check_writable(&[], &markdown)?;
        ready(&Need::to_run(BOARDS))?;
        let wanted: Vec<&str> =
            scenes().filter(|scene| self.scene.is_empty() || self.scene.iter().any(|name| name == scene)).collect();
        let bar = Progress::of(2 + wanted.len() as u64);
        let failed = |error: Box<dyn std::error::Error>| Failure::failed(error.to_string());
        bar.says("building the observers for the host");
        let replay = Replay::build().map_err(failed)?;
        bar.step();
        let images = Images::build(&|line| bar.says(line)).map_err(failed)?;
        bar.step();
        let mut comparison = Comparison { measured: Stamp::now().to_string(), ..Comparison::default() };
        for scene in wanted {
            let says = |text: &str| bar.says(text);
            let compared = SceneComparison::run(scene, self.seconds.into(), &replay, &images, &says).map_err(failed)?;
            comparison.scenes.push(compared);
            bar.step();
        }
        drop(bar);
        if self.json {
            say_json(&comparison)?;
        } else {
            for scene in &comparison.scenes {
                say(format_args!("{}\n{}", scene.scene, scene.table()));
            }
        }
        markdown.map_or(Ok(()), |file| file.write_and_say(&peers_markdown(&comparison), self.json))
    }
}
