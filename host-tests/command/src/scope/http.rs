//! The scope's page and its figures, on the loopback address. Nothing here reaches the drive.
//!
//! One thread serves all clients; a client that is slow, silent or gone stops no other. A request has a limit and a
//! time, and where there are too many clients the one that has been still for longest is closed.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use serde_json::{Value, json};

use super::order::orders;
use super::store::{Part, Store};
use crate::telemetry::Described;

/// What the page shows.
#[derive(Debug)]
pub struct Scope {
    /// Where the records come from.
    pub source: String,
    /// Records a second, where they are known.
    pub rate_hz: Option<u32>,
    /// The records.
    pub store: Store,
    pub channels: Vec<Described>,
    /// Records that came.
    pub records: u64,
    /// Records that the drive dropped.
    pub dropped: u32,
    /// Damaged frames.
    pub damaged: u64,
    /// Why no more comes.
    pub ended: Option<String>,
}

/// Most places of a window.
const MOST_PLACES: u64 = 4_000;

/// Most records that orders are computed from: the last of the window.
const MOST_RECORDS: usize = 32_768;

/// Most clients at once. A window for each in full takes some 7 MB.
const MOST_CLIENTS: usize = 64;

/// Longest request line with its headers, in bytes.
const LONGEST_HEAD: usize = 16_384;

/// Time for a request, and longest pause of a client that reads its answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// The page's parts: address, type, text.
const PARTS: [(&str, &str, &str); 5] = [
    ("/", "text/html; charset=utf-8", include_str!("../../scope/page.html")),
    ("/scope.js", "text/javascript; charset=utf-8", include_str!("../../scope/scope.js")),
    ("/scope.css", "text/css; charset=utf-8", include_str!("../../scope/scope.css")),
    ("/uPlot.js", "text/javascript; charset=utf-8", include_str!("../../scope/uPlot.iife.min.js")),
    ("/uPlot.css", "text/css; charset=utf-8", include_str!("../../scope/uPlot.min.css")),
];

/// Serves the page until the program ends, at a port of the loopback address; 0 takes a free one.
pub fn serve(scope: &Arc<Mutex<Scope>>, port: u16) -> io::Result<SocketAddr> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
    listener.set_nonblocking(true)?;
    let address = listener.local_addr()?;
    let scope = Arc::clone(scope);
    thread::spawn(move || {
        let mut clients = Vec::new();
        loop {
            turn(&listener, &mut clients, &scope);
        }
    });
    Ok(address)
}

/// Waits for a client and serves each that is ready, for as much as its socket takes.
fn turn(listener: &TcpListener, clients: &mut Vec<Client>, scope: &Mutex<Scope>) {
    let mut polled = vec![PollFd::new(listener, PollFlags::IN)];
    let waits = |client: &Client| {
        if client.answer.as_ref().is_some_and(Sending::goes_on) { PollFlags::OUT } else { PollFlags::IN }
    };
    polled.extend(clients.iter().map(|client| PollFd::new(&client.stream, waits(client))));
    let second = Timespec { tv_sec: 1, tv_nsec: 0 };
    let _ = poll(&mut polled, Some(&second));
    let ready: Vec<bool> = polled.iter().map(|one| !one.revents().is_empty()).collect();
    let mut ready = ready.into_iter().skip(1);
    clients.retain_mut(|client| {
        let is_ready = ready.next() == Some(true);
        (!is_ready || client.proceed(scope).is_ok()) && client.moved.elapsed() < PATIENCE
    });
    // not more at once than there is room for: each is heard before it is the oldest
    for _ in 0..MOST_CLIENTS {
        let accepted = listener.accept();
        let is_none = accepted.as_ref().is_err_and(|error| error.kind() == ErrorKind::WouldBlock);
        if !is_none && (clients.len() >= MOST_CLIENTS || accepted.is_err()) {
            // no room, here or among the files that the system lets this program open
            let oldest = (0..clients.len()).min_by_key(|&index| clients[index].moved);
            oldest.map(|index| clients.swap_remove(index));
        }
        match accepted {
            Ok((stream, _)) if stream.set_nonblocking(true).is_ok() => {
                let mut client = Client { stream, head: Vec::new(), answer: None, moved: Instant::now() };
                if client.proceed(scope).is_ok() {
                    clients.push(client);
                }
            }
            Ok(_) => {}
            Err(_) if is_none => break,
            Err(_) if clients.is_empty() => {
                thread::sleep(Duration::from_millis(10));
                break;
            }
            Err(_) => {}
        }
    }
}

/// A connection: its request, then its answer, then the wait for its end.
struct Client {
    stream: TcpStream,
    head: Vec<u8>,
    answer: Option<Sending>,
    /// When it came, or last read a part of its answer.
    moved: Instant,
}

/// An answer on its way.
struct Sending {
    bytes: Vec<u8>,
    sent: usize,
    /// What follows it.
    rest: Option<Saved>,
}

impl Sending {
    /// Whether there is more to send.
    fn goes_on(&self) -> bool {
        self.sent < self.bytes.len() || self.rest.is_some()
    }
}

impl Client {
    /// Reads or writes what there is and has room; an error ends the connection.
    fn proceed(&mut self, scope: &Mutex<Scope>) -> io::Result<()> {
        match self.proceeded(scope) {
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => Ok(()),
            other => other,
        }
    }

    fn proceeded(&mut self, scope: &Mutex<Scope>) -> io::Result<()> {
        let mut bytes = [0; 4096];
        while self.answer.is_none() {
            let length = self.stream.read(&mut bytes)?;
            if length == 0 {
                return Err(ErrorKind::UnexpectedEof.into());
            }
            // a byte beyond the longest head shows that it is too long, and all behind an answer is left
            let room = (LONGEST_HEAD + 1).saturating_sub(self.head.len());
            self.head.extend_from_slice(&bytes[..length.min(room)]);
            let whole = self.head.windows(4).position(|end| end == b"\r\n\r\n");
            if whole.is_some() || room <= length {
                let head = std::mem::take(&mut self.head);
                self.answer = Some(answer(whole.map(|end| &head[..end]), scope));
                self.moved = Instant::now();
            }
        }
        while let Some(answer) = &mut self.answer {
            if answer.sent < answer.bytes.len() {
                answer.sent += self.stream.write(&answer.bytes[answer.sent..])?;
                self.moved = Instant::now();
                continue;
            }
            let Some(rest) = &mut answer.rest else { break };
            let Some(bytes) = rest.more() else {
                answer.rest = None;
                break;
            };
            (answer.bytes, answer.sent) = (bytes, 0);
            // one block a turn: others wait
            return Ok(());
        }
        // closed with input unread, the connection would be reset and the answer lost
        self.stream.shutdown(Shutdown::Write)?;
        for _ in 0..16 {
            if self.stream.read(&mut bytes)? == 0 {
                break;
            }
        }
        Err(ErrorKind::UnexpectedEof.into())
    }
}

/// The scope, also after a thread that had it has panicked.
fn locked(scope: &Mutex<Scope>) -> MutexGuard<'_, Scope> {
    scope.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Status, type, body.
type Answer = (u16, &'static str, Body);

enum Body {
    Text(String),
    Saved(Saved),
}

const JSON: &str = "application/json";

/// The answer to a request line with its headers; to one without end that it is too long.
fn answer(head: Option<&[u8]>, scope: &Mutex<Scope>) -> Sending {
    let head = head.map(std::str::from_utf8);
    let (status, kind, body) = match head {
        Some(Ok(head)) => answered(head, scope),
        Some(Err(_)) => wrong(400, "expected a request in ASCII"),
        None => wrong(431, "expected a request of at most 16 KiB"),
    };
    let is_chunked =
        matches!(head, Some(Ok(head)) if head.lines().next().is_some_and(|line| line.ends_with(" HTTP/1.1")));
    let policy = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:; \
                  frame-ancestors 'none'";
    let (length, body, rest) = match body {
        Body::Text(text) => (format!("Content-Length: {}\r\n", text.len()), text, None),
        Body::Saved(saved) => {
            let disposition = "Content-Disposition: attachment; filename=scope.csv\r\n";
            let coding = if is_chunked { "Transfer-Encoding: chunked\r\n" } else { "" };
            (format!("{disposition}{coding}"), String::new(), Some(Saved { is_chunked, ..saved }))
        }
    };
    let text = format!(
        "HTTP/1.1 {status} {}\r\nContent-Type: {kind}\r\n{length}Connection: close\r\nCache-Control: no-store\r\n\
         Content-Security-Policy: {policy}\r\nCross-Origin-Resource-Policy: same-origin\r\n\
         X-Content-Type-Options: nosniff\r\n\r\n{body}",
        reason(status)
    );
    Sending { bytes: text.into_bytes(), sent: 0, rest }
}

const CSV: &str = "text/csv; charset=utf-8";

/// The reason phrases of RFC 9110 and RFC 6585.
fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        431 => "Request Header Fields Too Large",
        _ => "Bad Request",
    }
}

fn wrong(status: u16, why: &str) -> Answer {
    (status, JSON, Body::Text(json!({ "error": why }).to_string()))
}

/// Why a request is not of the scope's own page, by its headers.
///
/// A page from elsewhere may resolve its own name to this address: the host is looked at; its port may be forwarded.
fn foreign<'h>(headers: impl Iterator<Item = (&'h str, &'h str)>) -> Option<&'static str> {
    let (mut host, mut origin) = (None, None);
    for (name, value) in headers {
        match name.to_ascii_lowercase().as_str() {
            "host" if host.is_some() => return Some("expected one host"),
            "host" => host = Some(value.to_ascii_lowercase()),
            "origin" => origin = Some(value.to_ascii_lowercase()),
            "sec-fetch-site" if value != "same-origin" && value != "none" => {
                return Some("expected a request of the scope's own page: open its address in a window of its own");
            }
            _ => {}
        }
    }
    let host = host.unwrap_or_default();
    if !matches!(host.split(':').next(), Some("127.0.0.1" | "localhost")) {
        return Some("expected 127.0.0.1 or localhost as host");
    }
    origin.filter(|origin| *origin != format!("http://{host}")).map(|_| "expected the scope's own page as origin")
}

fn answered(head: &str, scope: &Mutex<Scope>) -> Answer {
    let mut lines = head.split("\r\n");
    let words: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
    let &[method, url, "HTTP/1.0" | "HTTP/1.1"] = &words[..] else {
        return wrong(400, "expected a request of HTTP 1.0 or 1.1");
    };
    if method != "GET" {
        return wrong(405, "expected GET: the scope only shows");
    }
    let headers = lines.filter_map(|line| line.split_once(':')).map(|(name, value)| (name.trim(), value.trim()));
    if let Some(why) = foreign(headers) {
        return wrong(403, why);
    }
    let (path, query) = url.split_once('?').unwrap_or((url, ""));
    if let Some((_, kind, text)) = PARTS.iter().find(|(at, ..)| *at == path) {
        return (200, kind, Body::Text((*text).to_owned()));
    }
    let asked = Query(query);
    let found = match path {
        "/state" => Ok(state(&locked(scope)).to_string()),
        "/window" => window(&asked, scope),
        "/rise" => rise(&asked, scope).map(|value| value.to_string()),
        "/orders" => spectrum(&asked, scope).map(|value| value.to_string()),
        "/csv" => match Saved::of(&asked, scope) {
            Ok(saved) => return (200, CSV, Body::Saved(saved)),
            Err(why) => Err(why),
        },
        _ => return wrong(404, "expected /, /state, /window, /rise, /orders or /csv"),
    };
    match found {
        Ok(text) => (200, JSON, Body::Text(text)),
        Err(why) => wrong(400, &why),
    }
}

/// The part of an address behind `?`.
struct Query<'a>(&'a str);

impl Query<'_> {
    fn number<N: std::str::FromStr>(&self, name: &str) -> Result<N, String> {
        let of =
            |pair: &'_ str| pair.split_once('=').filter(|(key, _)| *key == name).map(|(_, value)| value.to_owned());
        let value = self.0.split('&').find_map(of).ok_or_else(|| format!("expected `{name}`"))?;
        value.parse().map_err(|_| format!("`{name}`: found {value}, expected a number"))
    }
}

fn state(scope: &Scope) -> Value {
    let Scope { source, rate_hz, store, channels, records, dropped, damaged, ended } = scope;
    let named: Vec<Value> = channels.iter().map(|one| json!({ "name": one.name, "unit": one.unit })).collect();
    let last = store.ends().and_then(|(_, last)| store.records(last, last).next().map(|(_, values)| values.to_vec()));
    json!({
        "source": source, "rate_hz": rate_hz, "channels": named, "records": records, "dropped": dropped,
        "damaged": damaged, "missing": store.missing, "restarts": store.restarts, "ends": store.ends(),
        "last": last, "ended": ended,
    })
}

fn window(asked: &Query<'_>, scope: &Mutex<Scope>) -> Result<String, String> {
    let (from, to): (u64, u64) = (asked.number("from")?, asked.number("to")?);
    let places = asked.number::<u64>("places")?.clamp(1, MOST_PLACES);
    if to < from {
        return Err(format!("`to`: found {to}, expected {from} or more"));
    }
    let window = locked(scope).store.window(from, to, places);
    serde_json::to_string(&window).map_err(|error| error.to_string())
}

fn rise(asked: &Query<'_>, scope: &Mutex<Scope>) -> Result<Value, String> {
    let (channel, above, after) = (asked.number("channel")?, asked.number("above")?, asked.number("after")?);
    Ok(json!({ "tick": locked(scope).store.rise(channel, above, after) }))
}

fn spectrum(asked: &Query<'_>, scope: &Mutex<Scope>) -> Result<Value, String> {
    let (from, to, channel): (u64, u64, usize) = (asked.number("from")?, asked.number("to")?, asked.number("channel")?);
    let mut records: Vec<(f64, f64)> = {
        let scope = locked(scope);
        let angle = scope.channels.iter().position(|one| one.unit == "turn");
        let angle = angle.ok_or("orders need a channel in `turn`, and no channel has that unit")?;
        if channel >= scope.store.channels() {
            return Err(format!("`channel`: found {channel}, expected one below {}", scope.store.channels()));
        }
        let to = scope.store.ends().map_or(to, |(_, last)| to.min(last));
        let from = from.max(to.saturating_sub(MOST_RECORDS as u64));
        let mut whole: Vec<(f64, f64)> = Vec::new();
        let mut before = from;
        for (tick, values) in scope.store.records(from, to) {
            // turns are lost in a gap
            if tick - before > 1 {
                whole.clear();
            }
            before = tick;
            whole.extend(values.get(angle).zip(values.get(channel)).map(|(a, x)| (f64::from(*a), f64::from(*x))));
        }
        whole
    };
    records.retain(|(angle, value)| angle.is_finite() && value.is_finite());
    Ok(json!({ "orders": orders(&records), "records": records.len() }))
}

/// The records of a window as a recording that `replay` and `identify` read, block by block as the client reads it.
/// The blocks are shared with the store: the drive goes on, and nothing is copied before it is sent.
struct Saved {
    part: Part,
    from: u64,
    rate_hz: Option<u32>,
    /// The first line, until it is sent.
    head: Option<Vec<String>>,
    is_chunked: bool,
    is_ended: bool,
}

impl Saved {
    fn of(asked: &Query<'_>, scope: &Mutex<Scope>) -> Result<Self, String> {
        let (from, to): (u64, u64) = (asked.number("from")?, asked.number("to")?);
        let scope = locked(scope);
        let time = scope.rate_hz.map_or("tick", |_| "time [s]").to_owned();
        let head = [time].into_iter().chain(scope.channels.iter().map(Described::heading)).collect();
        let (part, rate_hz) = (scope.store.part(from, to), scope.rate_hz);
        Ok(Self { part, from, rate_hz, head: Some(head), is_chunked: false, is_ended: false })
    }

    /// The next bytes; none at the end.
    fn more(&mut self) -> Option<Vec<u8>> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        // a vector takes whatever is written
        if let Some(head) = self.head.take() {
            let _ = csv.write_record(head);
        } else if let Some(block) = self.part.next() {
            for (tick, values) in self.part.records(&block) {
                let at = |rate: u32| (tick - self.from.min(tick)) as f64 / f64::from(rate);
                let at = self.rate_hz.map_or(tick as f64, at);
                let _ = csv.write_record([at.to_string()].into_iter().chain(values.iter().map(f32::to_string)));
            }
        } else {
            let ends = self.is_chunked && !std::mem::replace(&mut self.is_ended, true);
            return ends.then(|| b"0\r\n\r\n".to_vec());
        }
        let text = csv.into_inner().unwrap_or_default();
        Some(match (self.is_chunked, text.is_empty()) {
            // an empty chunk would be the last
            (true, false) => [format!("{:x}\r\n", text.len()).as_bytes(), &text, b"\r\n"].concat(),
            _ => text,
        })
    }
}
