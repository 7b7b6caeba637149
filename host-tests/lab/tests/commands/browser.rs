//! Chromium without a window, by its debugging protocol over a pipe.
//!
//! The tests that need it are ignored; `cargo lab check --only pages` runs them where there is one.

use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};
use tempfile::TempDir;

/// Names under which it is installed.
const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// A browser with one page.
pub struct Browser {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    _profile: TempDir,
    session: Value,
    sent: u64,
    /// What the page has said on its console or thrown.
    pub said: Vec<String>,
    /// Addresses that it has asked for.
    pub asked: Vec<String>,
}

impl Browser {
    pub fn start() -> Self {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let places: Vec<PathBuf> = std::env::split_paths(&path).collect();
        let found = NAMES.iter().flat_map(|name| places.iter().map(move |at| at.join(name))).find(|at| at.is_file());
        let profile = tempfile::tempdir().unwrap();
        // the protocol's pipes are 3 and 4; a browser that hangs is ended
        let mut child = Command::new("sh")
            .args(["-c", r#"exec timeout 900 "$0" "$@" 3<&0 4>&1 >/dev/null 2>&1"#])
            .arg(found.unwrap_or_else(|| panic!("expected one of {NAMES:?} on the PATH")))
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (input, output) = (child.stdin.take().unwrap(), BufReader::new(child.stdout.take().unwrap()));
        let (said, asked) = (Vec::new(), Vec::new());
        let mut browser =
            Browser { child, input, output, _profile: profile, session: Value::Null, sent: 0, said, asked };
        let target = browser.call("Target.createTarget", json!({"url": "about:blank"}))["targetId"].clone();
        let attached = browser.call("Target.attachToTarget", json!({"targetId": target, "flatten": true}));
        browser.session = attached["sessionId"].clone();
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser
    }

    /// Calls a method of the protocol; events that come before its answer are noted.
    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.sent += 1;
        let mut message = json!({"id": self.sent, "method": method, "params": parameters});
        if !self.session.is_null() {
            message["sessionId"] = self.session.clone();
        }
        write!(self.input, "{message}\0").unwrap();
        self.input.flush().unwrap();
        loop {
            let mut bytes = Vec::new();
            self.output.read_until(0, &mut bytes).unwrap();
            let message: Value =
                serde_json::from_slice(bytes.strip_suffix(&[0]).expect("the browser has gone")).unwrap();
            if message["id"] == self.sent {
                assert!(message["error"].is_null(), "{method}: {}", message["error"]);
                return message["result"].clone();
            }
            let event = &message["params"];
            match message["method"].as_str().unwrap_or_default() {
                "Runtime.consoleAPICalled" => self.said.push(event["args"].to_string()),
                "Runtime.exceptionThrown" => self.said.push(event["exceptionDetails"].to_string()),
                // a warning is the reading of a canvas by the test itself
                "Log.entryAdded" if event["entry"]["level"] == "error" => {
                    self.said.push(event["entry"]["text"].to_string());
                }
                "Network.requestWillBeSent" => {
                    self.asked.push(event["request"]["url"].as_str().unwrap_or_default().to_owned());
                }
                _ => {}
            }
        }
    }

    /// Opens a page and waits until it is loaded.
    pub fn open(&mut self, address: &str) {
        let opened = self.call("Page.navigate", json!({"url": address}));
        assert!(opened["errorText"].is_null(), "{address}: {opened}");
        let loaded =
            "new Promise((done) => document.readyState === 'complete' ? done() : addEventListener('load', done))";
        self.run(loaded);
    }

    /// Evaluates a script in the page and waits for its promise.
    pub fn run(&mut self, script: &str) -> Value {
        let parameters = json!({"expression": script, "awaitPromise": true, "returnByValue": true});
        let done = self.call("Runtime.evaluate", parameters);
        assert!(done["exceptionDetails"].is_null(), "{script}: {}", done["exceptionDetails"]);
        done["result"]["value"].clone()
    }

    /// Waits until an expression is true; ten seconds at most.
    pub fn wait(&mut self, expression: &str) {
        let script = format!(
            "(async () => {{ for (let n = 0; n < 100; n++) {{ if ({expression}) return true; \
             await new Promise((done) => setTimeout(done, 100)); }} return document.body.innerText; }})()"
        );
        let found = self.run(&script);
        assert_eq!(found, true, "{expression}: {found}");
    }

    /// Shows the page so wide, for `screen` or `print`.
    pub fn show(&mut self, width: u32, medium: &str) {
        let size = json!({"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false});
        self.call("Emulation.setDeviceMetricsOverride", size);
        self.call("Emulation.setEmulatedMedia", json!({"media": medium}));
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
