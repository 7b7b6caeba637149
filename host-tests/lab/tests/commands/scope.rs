//! The scope of `watch --web`: every record is there, gaps are counted, requests from elsewhere and clients that are
//! slow or gone stop nothing.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStderr, ChildStdin, Command, Stdio};
use std::time::{Duration, Instant};

use driveline::telemetry::{Channel, Kind, Ring};

use crate::browser::Browser;

const CHANNELS: [Channel<'static>; 3] = [
    Channel { name: "angle", unit: "turn", kind: Kind::Integer(1.0 / 4_294_967_296.0) },
    Channel { name: "motor speed", unit: "rad/s", kind: Kind::Single },
    Channel { name: "faults", unit: "", kind: Kind::Integer(1.0) },
];

/// A turn every 500 ticks, a speed of 100 rad/s with 3 rad/s once a turn, a quarter of a turn late.
fn record(tick: u32) -> [u32; 3] {
    let turned = f64::from(tick) / 500.0;
    let speed = 100.0 + 3.0 * (std::f64::consts::TAU * (turned - 0.25)).cos();
    [(turned.fract() * 4_294_967_296.0) as u32, (speed as f32).to_bits(), u32::from(tick == 7_000)]
}

/// The frames of ticks, without some of them.
fn frames(ticks: std::ops::Range<u32>, without: std::ops::Range<u32>) -> Vec<u8> {
    frames_of(ticks, without, record)
}

fn frames_of(ticks: std::ops::Range<u32>, without: std::ops::Range<u32>, record: impl Fn(u32) -> [u32; 3]) -> Vec<u8> {
    let mut bytes = vec![0; 256 + 64 * ticks.len()];
    let room = bytes.len();
    let mut rest = &mut bytes[..];
    let ring = Ring::<3, 16>::new();
    Channel::send(&CHANNELS, &mut rest).unwrap();
    for tick in ticks {
        ring.record(&record(tick));
        let mut lost = [0; 64];
        if without.contains(&tick) {
            ring.send(&mut &mut lost[..]).unwrap();
        } else {
            ring.send(&mut rest).unwrap();
        }
    }
    let length = room - rest.len();
    bytes.truncate(length);
    bytes
}

struct Served {
    child: Child,
    /// Kept open for what it says later.
    _said: BufReader<ChildStderr>,
    address: String,
}

impl Served {
    fn start(arguments: &[&str]) -> (Self, ChildStdin) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
        command.args(["watch", "-", "--web"]).args(arguments);
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = piped.spawn().unwrap();
        let input = child.stdin.take().unwrap();
        let mut line = String::new();
        let mut said = BufReader::new(child.stderr.take().unwrap());
        said.read_line(&mut line).unwrap();
        let address = line.split_once("http://").and_then(|(_, rest)| rest.split_once('/')).unwrap().0.to_owned();
        (Self { child, _said: said, address }, input)
    }

    fn ask(&self, head: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        write!(stream, "{head}\r\nConnection: close\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        (head.split(' ').nth(1).unwrap().parse().unwrap(), body.to_owned())
    }

    fn get(&self, path: &str) -> (u16, String) {
        self.ask(&format!("GET {path} HTTP/1.0\r\nHost: {}", self.address))
    }

    fn json(&self, path: &str) -> serde_json::Value {
        let (status, body) = self.get(path);
        assert_eq!(status, 200, "{path}: {body}");
        serde_json::from_str(&body).unwrap_or_else(|error| panic!("{path}: {error}: {body}"))
    }

    /// The state once so many records are there, or the source has ended.
    fn state(&self, is_there: impl Fn(&serde_json::Value) -> bool) -> serde_json::Value {
        let begun = Instant::now();
        loop {
            let state = self.json("/state");
            if is_there(&state) {
                return state;
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "{state}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_scope_has_every_record_and_counts_what_is_missing() {
    let (scope, mut input) = Served::start(&["--rate", "10000"]);
    // a client that asks and never reads, and one that begins to ask
    let mut stuck = TcpStream::connect(&scope.address).unwrap();
    // 10 MB, more than the sockets hold
    write!(stuck, "{}", format!("GET /uPlot.js HTTP/1.1\r\nHost: {}\r\n\r\n", scope.address).repeat(200)).unwrap();
    let mut half = TcpStream::connect(&scope.address).unwrap();
    write!(half, "GET /").unwrap();

    input.write_all(&frames(0..10_000, 4_000..4_100)).unwrap();
    drop(input);
    let state = scope.state(|state| state["ended"].is_string());
    for (key, expected) in [("records", 9_900), ("missing", 100), ("damaged", 0), ("restarts", 0), ("rate_hz", 10_000)]
    {
        assert_eq!(state[key], expected, "{key} of {state}");
    }
    assert_eq!(state["ends"], serde_json::json!([0, 9_999]));
    assert_eq!(state["channels"][1], serde_json::json!({ "name": "motor speed", "unit": "rad/s" }));

    // every tick alone, and all in ten places
    let each = scope.json("/window?from=3990&to=4110&places=1000");
    assert_eq!(each["ticks"].as_array().unwrap().len(), 21 + 1, "{each}");
    assert_eq!(each["least"][1].as_array().unwrap().iter().filter(|least| least.is_null()).count(), 1);
    let all = scope.json("/window?from=0&to=9999&places=10");
    // ten places, and one for the gap, which lies between two of them
    let known = |of: &str| all[of][1].as_array().unwrap().iter().filter_map(serde_json::Value::as_f64).collect();
    let (least, most): (Vec<f64>, Vec<f64>) = (known("least"), known("most"));
    assert_eq!((least.len(), all["ticks"].as_array().unwrap().len()), (10, 11), "{all}");
    for (place, (least, most)) in least.iter().zip(&most).enumerate() {
        // 3 rad/s either way; the largest step of the angle beside a peak is 0.0126 rad: 2.4e-4 rad/s
        assert!((least - 97.0).abs() < 5e-4 && (most - 103.0).abs() < 5e-4, "{place}: {least} to {most}");
    }
    assert_eq!(scope.json("/rise?channel=2&above=0.5&after=0")["tick"], 7_000);
    assert!(scope.json("/rise?channel=2&above=0.5&after=7000")["tick"].is_null());

    let orders = scope.json("/orders?from=5000&to=9999&channel=1");
    let first = orders["orders"].as_array().unwrap().iter().find(|one| one["order"] == 1.0).unwrap().clone();
    // 500 records a turn: the trapezoids' error is `(2 pi/500)^2/12` of 3 rad/s
    assert!((first["amplitude"].as_f64().unwrap() - 3.0).abs() < 1e-4, "{first}");
    assert!((first["phase"].as_f64().unwrap() - std::f64::consts::FRAC_PI_2).abs() < 1e-3, "{first}");

    // what is saved is a recording with its times
    let (_, saved) = scope.get("/csv?from=100&to=102");
    let lines: Vec<&str> = saved.lines().collect();
    assert_eq!((lines[0], lines.len()), ("time [s],angle [turn],motor speed [rad/s],faults", 4), "{saved}");
    assert!(lines[2].starts_with("0.0001,0.20"), "{saved}");
}

#[test]
fn a_scope_answers_its_own_page_only_and_says_what_it_expects() {
    let (scope, mut input) = Served::start(&["--keep", "1000"]);
    input.write_all(&frames(0..5_000, 0..0)).unwrap();
    let state = scope.state(|state| state["records"] == 5_000);
    let first = state["ends"][0].as_u64().unwrap();
    // whole blocks of 256 are given up
    assert!((4_000 - 2 * 256..=4_000).contains(&first), "{state}");
    for path in ["/", "/scope.js", "/scope.css", "/uPlot.js", "/uPlot.css"] {
        assert_eq!(scope.get(path).0, 200, "{path}");
    }
    for (head, status, word) in [
        ("GET /state HTTP/1.0\r\nHost: example.org", 403, "expected 127.0.0.1"),
        ("GET /state HTTP/1.0\r\nHost: localhost.example.org:80", 403, "expected 127.0.0.1"),
        // the usual port, and one that is forwarded
        ("GET /state HTTP/1.0\r\nHost: LOCALHOST", 200, "records"),
        ("GET /state HTTP/1.0\r\nHost: 127.0.0.1:9", 200, "records"),
        ("POST /state HTTP/1.0\r\nHost: ADDRESS", 405, "expected GET"),
        ("GET /drive HTTP/1.0\r\nHost: ADDRESS", 404, "expected /, /state"),
        ("GET /window?from=0&to=9 HTTP/1.0\r\nHost: ADDRESS", 400, "expected `places`"),
        ("GET /window?from=9&to=0&places=1 HTTP/1.0\r\nHost: ADDRESS", 400, "expected 9 or more"),
        ("GET /window?from=-1&to=0&places=1 HTTP/1.0\r\nHost: ADDRESS", 400, "found -1"),
        ("GET /orders?from=0&to=1&channel=3 HTTP/1.0\r\nHost: ADDRESS", 400, "below 3"),
    ] {
        let (found, body) = scope.ask(&head.replace("ADDRESS", &scope.address));
        assert!(found == status && body.contains(word), "{head}: {found} {body}");
    }
    // extreme, not wrong
    let far = scope.json("/window?from=0&to=18446744073709551615&places=18446744073709551615");
    assert!(!far["ticks"].as_array().unwrap().is_empty());
    assert!(scope.json("/rise?channel=99&above=NaN&after=18446744073709551615")["tick"].is_null());
    assert!(scope.json("/orders?from=0&to=18446744073709551615&channel=0")["orders"].is_array());
}

/// A drive that is flashed anew tells fewer channels; the page and what it saves have those alone.
#[test]
fn telemetry_that_changes_begins_the_scope_anew() {
    let (scope, mut input) = Served::start(&[]);
    input.write_all(&frames(0..1_000, 0..0)).unwrap();
    let mut bytes = [0; 8_192];
    let mut rest = &mut bytes[..];
    let ring = Ring::<1, 16>::new();
    Channel::send(&CHANNELS[1..2], &mut rest).unwrap();
    for tick in 0..100 {
        ring.record(&[record(tick)[1]]);
        ring.send(&mut rest).unwrap();
    }
    let length = 8_192 - rest.len();
    input.write_all(&bytes[..length]).unwrap();
    let state = scope.state(|state| state["records"] == 1_100);
    assert_eq!(
        (&state["ends"], state["channels"].as_array().unwrap().len()),
        (&serde_json::json!([0, 99]), 1),
        "{state}"
    );
    let (status, saved) = scope.get("/csv?from=0&to=99");
    assert_eq!((status, saved.lines().next(), saved.lines().count()), (200, Some("tick,motor speed [rad/s]"), 101));
}

/// The page in a browser: values, buttons, the trail of what turns once a turn, and the trigger after the telemetry has
/// changed.
#[test]
#[ignore = "needs Chromium: cargo lab check --only pages"]
fn the_scope_runs_in_a_browser() {
    let (scope, mut input) = Served::start(&["--rate", "10000"]);
    input.write_all(&frames(0..30_000, 4_000..4_100)).unwrap();
    scope.state(|state| state["records"] == 29_900);
    let mut page = Browser::start();
    page.show(400, "screen");
    page.open(&format!("http://{}/", scope.address));
    page.wait("byId('state').textContent === '29900 records, 100 ticks missing'");
    // 3 rad/s once a turn, a quarter of a turn late; the trapezoids' error is below 1e-4
    page.wait("byId('order-state').textContent.startsWith('once a turn: 3.0000 rad/s at 90.0')");
    page.wait("byId('values').innerText.includes('motor speed\\trad/s')");
    page.wait("document.querySelector('figure canvas') && document.querySelector('#spectrum canvas')");
    page.wait("document.documentElement.scrollWidth <= document.documentElement.clientWidth");
    for expected in ["Run", "Pause"] {
        assert_eq!(page.run("byId('hold').click(), byId('hold').textContent"), expected);
    }
    // the rim is at 124 of 160 pixels, the last reading is orange, #D55E00
    let colour = |x: u32, y: u32| format!("byId('polar').getContext('2d').getImageData({x}, {y}, 1, 1).data.join()");
    let orange = "'213,94,0,255'";
    page.wait(&format!("{} === {orange}", colour(160, 36)));
    // then half as much, in phase with the angle, in a window of its own
    let half = |tick: u32| {
        let [angle, _, faults] = record(tick);
        let speed = 100.0 + 1.5 * (std::f64::consts::TAU * f64::from(tick) / 500.0).cos();
        [angle, (speed as f32).to_bits(), faults]
    };
    input.write_all(&frames_of(30_000..60_000, 0..0, half)).unwrap();
    page.wait("byId('order-state').textContent.startsWith('once a turn: 1.5000 rad/s')");
    page.wait(&format!("{} === {orange}", colour(222, 160)));
    // the first one stays in the trail, blue, #0072B2, upon white
    page.wait(&format!("(([r, g, b, a]) => a > 0 && b > r + 50)({}.split(',').map(Number))", colour(160, 36)));
    assert_eq!(page.said, Vec::<String>::new());
    // a drive that is flashed anew disarms the trigger, which is then armed for another channel
    page.run("byId('arm').click()");
    page.wait("byId('arm').textContent === 'Disarm'");
    let speeds = |ticks: std::ops::Range<u32>, speed: f32| {
        let mut bytes = [0; 65_536];
        let mut rest = &mut bytes[..];
        let ring = Ring::<1, 16>::new();
        Channel::send(&CHANNELS[1..2], &mut rest).unwrap();
        for tick in 0..ticks.end {
            let mut lost = [0; 64];
            ring.record(&[speed.to_bits()]);
            if ticks.contains(&tick) { ring.send(&mut rest) } else { ring.send(&mut &mut lost[..]) }.unwrap();
        }
        let length = 65_536 - rest.len();
        bytes[..length].to_vec()
    };
    input.write_all(&speeds(0..1_000, 100.0)).unwrap();
    page.wait("byId('trigger-channel').options.length === 1 && byId('arm').textContent === 'Arm'");
    page.run("byId('level').value = 150; byId('arm').click()");
    page.wait("state.ends[1] === 999 && byId('arm').textContent === 'Disarm'");
    input.write_all(&speeds(1_000..1_100, 200.0)).unwrap();
    page.wait("byId('arm').textContent === 'Arm again (triggered at 0.10000)'");
    // without an angle there are no orders, and the page shows the scope's refusal
    page.wait("byId('order-state').textContent.includes('orders need a channel')");
    page.said.retain(|said| !said.contains("400 (Bad Request)"));
    assert_eq!(page.said, Vec::<String>::new());
    let own = format!("http://{}/", scope.address);
    assert!(page.asked.iter().all(|asked| asked.starts_with(&own) || asked.starts_with("data:")), "{:?}", page.asked);
}

/// Clients that send half a request, that never read, that announce huge lengths: another is answered at once, by few
/// threads. 0.1 s is what a page that is drawn ten times a second needs.
#[test]
fn clients_that_stall_stop_no_other() {
    let (scope, mut input) = Served::start(&[]);
    input.write_all(&frames(0..10_000, 0..0)).unwrap();
    scope.state(|state| state["records"] == 10_000);
    // as many as the descriptors of this process have room for
    let room = rustix::process::getrlimit(rustix::process::Resource::Nofile).current.unwrap_or(4096);
    let each = 400.min(room.saturating_sub(100) / 3);
    let mut stalled = Vec::new();
    let host = &scope.address;
    for _ in 0..each {
        for head in [
            "GET /state HTTP/1.1\r\nHost: ".to_owned(),
            format!("GET /csv?from=0&to=9999 HTTP/1.1\r\nHost: {host}\r\n\r\n").repeat(50),
            format!("POST / HTTP/1.1\r\nHost: {host}\r\nContent-Length: {}\r\n\r\n", u64::MAX),
        ] {
            let mut stream = TcpStream::connect(host).unwrap();
            stream.set_nonblocking(true).unwrap();
            // one that is closed already stalls nothing
            let _ = stream.write(head.as_bytes());
            stalled.push(stream);
        }
        if stalled.len() % 60 == 0 {
            // the least of five: other tests keep the processors busy
            let answered = || {
                let begun = Instant::now();
                assert!(!scope.json("/window?from=0&to=9999&places=10")["ticks"].is_null());
                begun.elapsed()
            };
            let least = (0..5).map(|_| answered()).min().unwrap();
            assert!(least < Duration::from_millis(100), "{least:?}, {} stall", stalled.len());
        }
    }
    let status = std::fs::read_to_string(format!("/proc/{}/status", scope.child.id())).unwrap_or_default();
    let threads =
        status.lines().find_map(|line| line.strip_prefix("Threads:")).map_or(1, |n| n.trim().parse().unwrap());
    assert!(threads <= 32, "{threads} threads");
    let (status, csv) = scope.get("/csv?from=0&to=9999");
    assert_eq!((status, csv.lines().count()), (200, 10_001));
    drop(stalled);
}

/// What a page from elsewhere can have its visitor's browser send is not answered; a head without end is refused.
#[test]
fn nothing_is_served_across_origins() {
    let (scope, _input) = Served::start(&[]);
    let host = &scope.address;
    let port = host.split_once(':').unwrap().1;
    for (headers, status) in [
        (format!("Host: {host}"), 200),
        (format!("Host: {host}\r\nOrigin: http://{host}\r\nSec-Fetch-Site: same-origin"), 200),
        (format!("Host: localhost:{port}\r\nSec-Fetch-Site: none"), 200),
        (format!("Host: {host}\r\nOrigin: http://example.org"), 403),
        (format!("Host: {host}\r\nOrigin: null"), 403),
        (format!("Host: {host}\r\nOrigin: http://127.0.0.1:1"), 403),
        (format!("Host: {host}\r\nOrigin: https://{host}"), 403),
        (format!("Host: {host}\r\nsec-fetch-site: cross-site"), 403),
        (format!("Host: {host}\r\nSEC-FETCH-SITE:same-site"), 403),
        (format!("Host: {host}\r\nHost: example.org"), 403),
        ("Host: 127.0.0.1.example.org".to_owned(), 403),
        ("Accept: */*".to_owned(), 403),
        (format!("Host: {host}\r\nA: {}", "a".repeat(20_000)), 431),
    ] {
        for path in ["/", "/state", "/csv?from=0&to=9"] {
            let (found, body) = scope.ask(&format!("GET {path} HTTP/1.1\r\n{headers}"));
            assert_eq!(found, status, "{path} {}: {body}", &headers[..headers.len().min(80)]);
        }
    }
}
