//! The design in a page of a browser: a request as JSON in, an answer as JSON out, by the functions of the commands
//! `design`, `identify` and `balancing`.
//!
//! The page writes a request to [`room`], calls [`answer`], and reads as many bytes at [`answered`].

use std::cell::RefCell;

use cargo_driveline::cli::{balance, design};
use cargo_driveline::identification::{Drive, NotIdentified, identify, machine_file, page};
use cargo_driveline::machine_file::{Diagnostic, balance as readings, parse};
use cargo_driveline::recording::{self, Asked};
use serde::{Deserialize, Serialize};

/// What is done with a file.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Do {
    Design,
    Identify,
    Balancing,
}

#[derive(Deserialize)]
struct Request {
    #[serde(rename = "do")]
    what: Do,
    /// Name of the file.
    name: String,
    /// Its text.
    text: String,
    /// Whether a design is answered as JSON, too.
    #[serde(default)]
    json: bool,
    /// Whether it is drawn with fewer points.
    #[serde(default)]
    quick: bool,
    /// Of a recording: samples a second, torque per current (N m/A), its part (s).
    rate: Option<f64>,
    torque_constant: Option<f64>,
    #[serde(default)]
    window: [Option<f64>; 2],
}

#[derive(Default, Serialize)]
struct Answer {
    /// What `design` prints with `--json`.
    json: Option<String>,
    /// What it writes with `--html`.
    page: Option<String>,
    /// The machine file of a recording.
    machine: Option<String>,
    /// The constants of a design.
    rust: Option<String>,
    error: Option<String>,
}

impl Request {
    fn answer(&self) -> Result<Answer, String> {
        let placed = |fault: Diagnostic| fault.explained();
        match self.what {
            Do::Design => {
                let machine = parse(&self.name, &self.text).map_err(placed)?;
                let design::Answered { json, page, rust } = design::Answered::of(&machine, self.json, self.quick)?;
                Ok(Answer { json, page: Some(page), rust, ..Answer::default() })
            }
            Do::Balancing => {
                let file = readings::parse(&self.name, &self.text).map_err(placed)?;
                let page = balance::answered(&file).map_err(|failure| failure.to_string())?;
                Ok(Answer { page: Some(page), ..Answer::default() })
            }
            Do::Identify => {
                let Self { rate, torque_constant, window, .. } = *self;
                let asked = Asked { rate, torque_constant, window, ..Asked::default() };
                let recording = recording::parse(&self.name, &self.text, &asked).map_err(placed)?;
                let identified = identify(&recording, torque_constant).map_err(|error| match error {
                    NotIdentified::File(fault) => placed(fault),
                    NotIdentified::Refused(why) => format!("no machine is identified: {why}"),
                })?;
                let torque = recording.torque(torque_constant).map_err(placed)?;
                let name = self.name.split('.').next().unwrap_or("recording");
                let machine = machine_file(name, &identified, &Drive::of(&identified, &recording, &torque));
                Ok(Answer { page: Some(page(name, &identified)), machine: Some(machine), ..Answer::default() })
            }
        }
    }
}

thread_local! {
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Room for a request of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        *request = vec![0; length];
        request.as_mut_ptr()
    })
}

/// Answers the request that was written: the number of bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    let request = REQUEST.take();
    let answer = serde_json::from_slice(&request).map_err(|error| error.to_string());
    let answer = answer.and_then(|request: Request| request.answer());
    let answer = answer.unwrap_or_else(|error| Answer { error: Some(error), ..Answer::default() });
    ANSWER.with_borrow_mut(|bytes| {
        *bytes = serde_json::to_vec(&answer).unwrap_or_default();
        bytes.len()
    })
}

/// Where the answer stands.
#[unsafe(no_mangle)]
pub extern "C" fn answered() -> *const u8 {
    ANSWER.with_borrow(|bytes| bytes.as_ptr())
}
