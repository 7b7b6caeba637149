//! The scope's page and its figures, on the loopback address. Nothing here reaches the drive.

use std::io::{self, Write};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};
use tiny_http::{Header, Method, Request, Response, Server};

use super::order::orders;
use super::store::Store;
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
    /// Their channels.
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

/// Most records of a recording that is saved from the page.
const MOST_SAVED: usize = 2_000_000;

/// The page's parts: address, type, text.
const PARTS: [(&str, &str, &str); 5] = [
    ("/", "text/html; charset=utf-8", include_str!("../../scope/page.html")),
    ("/scope.js", "text/javascript; charset=utf-8", include_str!("../../scope/scope.js")),
    ("/scope.css", "text/css; charset=utf-8", include_str!("../../scope/scope.css")),
    ("/uPlot.js", "text/javascript; charset=utf-8", include_str!("../../scope/uPlot.iife.min.js")),
    ("/uPlot.css", "text/css; charset=utf-8", include_str!("../../scope/uPlot.min.css")),
];

/// Serves the page until the program ends, at a port of the loopback address; 0 takes a free one.
///
/// Each request has a thread of its own, and holds the records only while its answer is computed: a client that is slow
/// or gone stops nothing. Where no more connections can be opened, the scope begins to listen anew.
///
/// # Errors
/// A port that is taken.
pub fn serve(scope: &Arc<Mutex<Scope>>, port: u16) -> io::Result<SocketAddr> {
    let mut server = Server::http((Ipv4Addr::LOCALHOST, port)).map_err(io::Error::other)?;
    let address = server.server_addr().to_ip().ok_or_else(|| io::Error::other("no address"))?;
    let scope = Arc::clone(scope);
    thread::spawn(move || {
        loop {
            for request in server.incoming_requests() {
                let scope = Arc::clone(&scope);
                thread::spawn(move || answer(request, &scope));
            }
            let _ = writeln!(io::stderr(), "the scope has too many connections, and listens anew");
            drop(server);
            server = loop {
                thread::sleep(Duration::from_secs(1));
                if let Ok(server) = Server::http(address) {
                    break server;
                }
            };
        }
    });
    Ok(address)
}

/// The scope, also after a thread that had it has panicked.
fn locked(scope: &Mutex<Scope>) -> MutexGuard<'_, Scope> {
    scope.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Status, type, text.
type Answer = (u16, &'static str, String);

const JSON: &str = "application/json";

fn answer(request: Request, scope: &Mutex<Scope>) {
    let (status, kind, text) = answered(&request, scope);
    let header = |name: &str, value: &str| Header::from_bytes(name, value).ok();
    let mut response = Response::from_string(text).with_status_code(status);
    let policy = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:";
    let headers = [
        header("Content-Type", kind),
        header("Cache-Control", "no-store"),
        header("Content-Security-Policy", policy),
        header("X-Content-Type-Options", "nosniff"),
        (kind == CSV).then(|| header("Content-Disposition", "attachment; filename=scope.csv")).flatten(),
    ];
    headers.into_iter().flatten().for_each(|header| response.add_header(header));
    // a client that is gone needs no answer
    let _ = request.respond(response);
}

const CSV: &str = "text/csv; charset=utf-8";

fn answered(request: &Request, scope: &Mutex<Scope>) -> Answer {
    let wrong = |status, why: &str| (status, JSON, json!({ "error": why }).to_string());
    if *request.method() != Method::Get {
        return wrong(405, "expected GET: the scope only shows");
    }
    // a page from elsewhere that resolves its own name to this address is not answered; a port may be forwarded
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    let name = host.map_or("", |host| host.value.as_str()).split(':').next().unwrap_or_default();
    if name != "127.0.0.1" && !name.eq_ignore_ascii_case("localhost") {
        return wrong(403, "expected 127.0.0.1 or localhost as host");
    }
    let (path, query) = request.url().split_once('?').unwrap_or((request.url(), ""));
    if let Some((_, kind, text)) = PARTS.iter().find(|(at, ..)| *at == path) {
        return (200, kind, (*text).to_owned());
    }
    let asked = Query(query);
    let found = match path {
        "/state" => Ok((JSON, state(&locked(scope)).to_string())),
        "/window" => window(&asked, scope).map(|text| (JSON, text)),
        "/rise" => rise(&asked, scope).map(|value| (JSON, value.to_string())),
        "/orders" => spectrum(&asked, scope).map(|value| (JSON, value.to_string())),
        "/csv" => saved(&asked, scope).map(|text| (CSV, text)),
        _ => return wrong(404, "expected /, /state, /window, /rise, /orders or /csv"),
    };
    match found {
        Ok((kind, text)) => (200, kind, text),
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

/// The records of a window as a recording that `replay` and `identify` read.
fn saved(asked: &Query<'_>, scope: &Mutex<Scope>) -> Result<String, String> {
    let (from, to): (u64, u64) = (asked.number("from")?, asked.number("to")?);
    // copied first: the drive goes on while the text is made
    let (rate_hz, channels, rows) = {
        let scope = locked(scope);
        let rows = scope.store.records(from, to).take(MOST_SAVED + 1).map(|(tick, values)| (tick, values.to_vec()));
        (scope.rate_hz, scope.channels.clone(), rows.collect::<Vec<_>>())
    };
    if rows.len() > MOST_SAVED {
        return Err(format!("more than {MOST_SAVED} records; zoom in, or record all by `--csv`"));
    }
    let mut csv = csv::Writer::from_writer(Vec::new());
    let time = rate_hz.map_or("tick", |_| "time [s]").to_owned();
    let mut write = |row: Vec<String>| csv.write_record(row).map_err(|error| error.to_string());
    write([time].into_iter().chain(channels.iter().map(Described::heading)).collect())?;
    for (tick, values) in rows {
        let at = rate_hz.map_or(tick as f64, |rate| (tick - from.min(tick)) as f64 / f64::from(rate));
        write([at.to_string()].into_iter().chain(values.iter().map(f32::to_string)).collect())?;
    }
    String::from_utf8(csv.into_inner().map_err(|error| error.to_string())?).map_err(|error| error.to_string())
}
