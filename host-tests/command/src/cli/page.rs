//! `cargo driveline page`: the design in a page of a browser.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use flate2::Compression;
use flate2::write::GzEncoder;

use super::project::Source;
use super::results::{Destination, check_writable};
use super::setup::install;
use super::{Failure, say_json};
use driveline_qemu::setup::{Need, cargo};

/// Write the page that designs in a browser: one file, opened from the disk or served by any web server.
///
/// A machine is typed or read from a file, its numbers have sliders, and loop, steps and band follow. A recording gives
/// its machine, readings give weights. Needs a clone of driveline; the target wasm32-unknown-unknown
/// is installed where it is missing.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline page
  cargo driveline page --html public/index.html")]
pub struct Page {
    /// File of the page
    #[arg(long, value_name = "PATH", default_value = "driveline.html")]
    html: PathBuf,
    /// Print JSON: the page's size
    #[arg(long)]
    pub json: bool,
}

/// Name and text of each example.
const EXAMPLES: [(&str, &str); 5] = [
    ("roll", include_str!("../../machines/roll.toml")),
    ("hoist", include_str!("../../machines/hoist.toml")),
    ("axis", include_str!("../../machines/axis.toml")),
    ("mill", include_str!("../../machines/mill.toml")),
    ("fan-balance", include_str!("../../rotors/fan-balance.toml")),
];

impl Page {
    /// Compiles the design for the browser and writes the page.
    ///
    /// # Errors
    /// No clone, no target; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let Source::Clone(root) = Source::find() else {
            return Err(Failure::usage(
                "the page is written from a clone of driveline, and this program's is not there",
            ));
        };
        let html = Destination::chosen("page", &self.html);
        check_writable(&[], [&html])?;
        let page = page(&core(&root)?);
        html.write_and_say(&page, self.json)?;
        if self.json { say_json(&serde_json::json!({ "page": self.html, "bytes": page.len() })) } else { Ok(()) }
    }
}

/// The design as WebAssembly.
fn core(root: &Path) -> Result<Vec<u8>, Failure> {
    const TARGET: &str = "wasm32-unknown-unknown";
    install(&[Need::Target(TARGET)])?;
    let mut command = Command::new(cargo());
    command.args(["build", "--locked", "--package=driveline-browser", "--profile=page", "--target", TARGET]);
    // its messages alone, as lines of JSON, go to standard output: one of them says where the file is
    command.arg("--message-format=json-render-diagnostics").current_dir(root).stderr(Stdio::inherit());
    let failed = |why: String| Failure::failed(format!("the page's design cannot be compiled: {why}"));
    let ended = command.output().map_err(|error| failed(error.to_string()))?;
    if !ended.status.success() {
        return Err(failed("see above".to_owned()));
    }
    let messages = String::from_utf8_lossy(&ended.stdout);
    let files = messages.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let named = |message: serde_json::Value| Some(message["filenames"].as_array()?.first()?.as_str()?.to_owned());
    let file = files.filter_map(named).find(|file| file.ends_with("driveline_browser.wasm"));
    let file = file.ok_or_else(|| failed("cargo names no file".to_owned()))?;
    std::fs::read(&file).map_err(|error| failed(format!("{file}: {error}")))
}

fn page(core: &[u8]) -> String {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    // into memory
    let packed = packed.write_all(core).and_then(|()| packed.finish()).unwrap_or_default();
    let examples = serde_json::json!(EXAMPLES.iter().copied().collect::<std::collections::BTreeMap<_, _>>());
    include_str!("../../page/page.html")
        .replace("@EXAMPLES@", &examples.to_string())
        .replace("@SCRIPT@", include_str!("../../page/page.js"))
        .replace("@CORE@", &base64(&packed))
}

/// As RFC 4648 has it.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let four = |three: &[u8]| {
        let word = (0..3).fold(0_usize, |word, at| word << 8 | usize::from(three.get(at).copied().unwrap_or(0)));
        let letter = |at: usize| if at <= three.len() { LETTERS[word >> (18 - 6 * at) & 63] as char } else { '=' };
        [0, 1, 2, 3].map(letter)
    };
    bytes.chunks(3).flat_map(four).collect()
}

#[cfg(test)]
mod tests {
    /// The vectors of RFC 4648, section 10.
    #[test]
    fn bytes_are_written_as_letters() {
        for (bytes, letters) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(super::base64(bytes.as_bytes()), letters);
        }
    }
}
