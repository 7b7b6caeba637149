//! `cargo driveline watch`: a running drive's telemetry, live in the terminal and as CSV.

use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Read, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use driveline_firmware::board::BOARDS;

use super::results::{Destination, check, field};
use super::setup::ready;
use super::{Failure, say, say_json};
use crate::machine_file::printable;
use crate::scope::{Scope, Store, serve};
use crate::telemetry::{Decoder, Described, Told};
use driveline_qemu::image::{Program, belongs, board, build};
use driveline_qemu::link::Telling;
use driveline_qemu::setup::Need;
use driveline_report::format::significant;

/// Watch a running drive: its telemetry from QEMU, a serial port, a file or standard input.
///
/// Shows each channel's last value, least and most while frames come, and how many records the drive dropped. A serial
/// port is set up beforehand, as by `stty -F /dev/ttyACM0 raw 921600`. With --web the same is a scope in the browser:
/// plots with zoom, trigger, orders and phasors, on the loopback address only. Nothing is sent to the drive.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline watch --qemu hoist/f32/reduced/10000 --records 20000
  cargo driveline watch /dev/ttyACM0 --csv run.csv
  cargo driveline watch /dev/ttyACM0 --web --rate 1000
  cargo driveline watch - --json < recorded.bin")]
pub struct Watch {
    /// A serial port or a file; `-` is standard input
    #[arg(conflicts_with = "qemu")]
    source: Option<PathBuf>,
    /// Run this variant in QEMU over its built-in inputs
    #[arg(long, value_name = "VARIANT")]
    qemu: Option<String>,
    /// The core for QEMU: m4f, m3
    #[arg(long, default_value = "m4f", requires = "qemu")]
    core: String,
    /// Write every record to this file
    #[arg(long, value_name = "PATH")]
    csv: Option<PathBuf>,
    /// Stop after so many records
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    records: Option<u64>,
    /// Serve a scope at this port of the loopback address until Ctrl-C; a free port without a number
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "0", require_equals = true)]
    #[arg(conflicts_with = "json")]
    web: Option<u16>,
    /// Records a second, as the drive makes them, for times in the scope; a variant in QEMU has its own
    #[arg(long, value_name = "HZ", requires = "web", value_parser = clap::value_parser!(u32).range(1..))]
    rate: Option<u32>,
    /// Records that the scope keeps, the last ones
    #[arg(long, value_name = "COUNT", requires = "web", default_value_t = 6_000_000)]
    #[arg(value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=100_000_000))]
    keep: usize,
    /// Print {records, dropped, damaged, unknown, channels: [...]} at the end, and nothing before
    #[arg(long)]
    pub json: bool,
}

/// How often a line says what has come where no picture is drawn.
const SAID: Duration = Duration::from_secs(5);

/// Bytes without one sound frame after which a source is no telemetry: at 921,600 baud eleven seconds of them.
const NO_TELEMETRY: u64 = 1 << 20;

/// How often the picture is drawn, and what was recorded is put into the file: a stop by Ctrl-C loses no more.
const DRAWN: Duration = Duration::from_millis(100);

/// Records that wait for the channels' descriptions: four of their periods in our firmware.
const PATIENCE: usize = 4096;

/// Longest name or unit of a channel that is shown, in characters; a frame holds some 240.
const LONGEST: usize = 40;

/// A channel and its course.
#[derive(Debug, serde::Serialize)]
struct Course {
    #[serde(flatten)]
    channel: Described,
    last: f64,
    least: f64,
    most: f64,
}

/// All that has been seen.
#[derive(Debug, Default, serde::Serialize)]
struct Seen {
    records: u64,
    dropped: u32,
    damaged: u64,
    unknown: u64,
    channels: Vec<Course>,
}

impl Seen {
    fn add(&mut self, decoder: &Decoder, told: &Told) {
        self.records += 1;
        self.dropped = told.dropped;
        self.channels.truncate(told.words.len());
        for (index, &word) in told.words.iter().enumerate() {
            let value = decoder.value(index, word);
            let anew = || Course { channel: decoder.channel(index), last: value, least: value, most: value };
            match self.channels.get_mut(index) {
                // one that was not described when it was first seen begins anew
                Some(course) if decoder.described(index).is_none_or(|channel| *channel == course.channel) => {
                    course.last = value;
                    course.least = course.least.min(value);
                    course.most = course.most.max(value);
                }
                Some(course) => *course = anew(),
                None => self.channels.push(anew()),
            }
        }
    }

    fn lines(&self) -> Vec<String> {
        let head = format!("  {:<16} {:<6} {:>12} {:>12} {:>12}", "channel", "unit", "now", "least", "most");
        let row = |course: &Course| {
            let [last, least, most] = [course.last, course.least, course.most].map(significant);
            let [name, unit] = [&course.channel.name, &course.channel.unit].map(|text| printable(text, LONGEST));
            format!("  {name:<16} {unit:<6} {last:>12} {least:>12} {most:>12}")
        };
        [head].into_iter().chain(self.channels.iter().map(row)).chain([self.foot()]).collect()
    }

    fn foot(&self) -> String {
        let Seen { records, dropped, damaged, unknown, .. } = self;
        let mut foot = format!("{records} records, {dropped} dropped by the drive, {damaged} frames damaged");
        if *unknown > 0 {
            foot.push_str(&format!(", {unknown} of an unknown kind, from a later firmware"));
        }
        foot
    }
}

impl Watch {
    /// Watches until the source ends.
    ///
    /// # Errors
    /// A source that cannot be opened or read, a variant that is not there, a file that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let sources: Vec<&Path> = self.source.iter().map(PathBuf::as_path).collect();
        let table = self.csv.as_deref().map(|path| Destination::chosen("table", path));
        check(&sources, &table)?;
        let mut source = self.open()?;
        let live = self.web.map(|port| self.live(port)).transpose()?;
        let mut csv = table.map(Csv::new);
        let mut seen = Seen::default();
        let mut decoder = Decoder::default();
        // records before the channels' descriptions wait for names and units
        let mut waiting: Vec<Told> = Vec::new();
        let (mut drawn, mut said, mut lines) = (Instant::now(), Instant::now(), 0);
        let in_terminal = io::stderr().is_terminal() && !self.json;
        let mut bytes = vec![0; 65_536];
        let mut unwritten = None;
        let broken = loop {
            // a source that breaks off has ended, too: what it gave is kept, and then it is said
            let (length, broken) = match source.read(&mut bytes) {
                Ok(length) => (length, None),
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => (0, Some(error)),
            };
            decoder.take(&bytes[..length], |decoder, told| {
                if self.records.is_none_or(|most| seen.records < most) {
                    seen.add(decoder, &told);
                    waiting.push(told);
                }
            });
            (seen.damaged, seen.unknown) = (decoder.damaged, decoder.unknown);
            let is_none = decoder.bytes >= NO_TELEMETRY && decoder.is_empty() && seen.records == 0;
            let ended = length == 0 || is_none || self.records.is_some_and(|most| seen.records >= most);
            let described = waiting.first().is_some_and(|told| decoder.describes(told.words.len()));
            let is_ripe = described || ended || waiting.len() >= PATIENCE;
            let ripe = if is_ripe { mem::take(&mut waiting) } else { Vec::new() };
            if let Some(live) = &live {
                live.show(&decoder, &seen, &ripe, ended);
            }
            let due = ended || drawn.elapsed() >= DRAWN;
            // a full disk ends the file and, unless there is a scope, the watch; what was seen is printed
            if let Err(failure) = csv.as_mut().map_or(Ok(()), |csv| csv.write(&decoder, &ripe, due)) {
                if live.is_some() {
                    let _ = writeln!(io::stderr(), "{failure}");
                }
                (unwritten, csv) = (Some(failure), None);
            }
            let ended = ended || (unwritten.is_some() && live.is_none());
            if due || ended {
                if in_terminal {
                    lines = draw(&seen.lines(), lines);
                } else if !self.json && said.elapsed() >= SAID {
                    let _ = writeln!(io::stderr(), "{} bytes: {}", decoder.bytes, seen.foot());
                    said = Instant::now();
                }
                drawn = Instant::now();
            }
            if ended {
                break broken;
            }
        };
        let name = self.name();
        if let Some(live) = live.filter(|_| seen.records > 0) {
            live.stay(broken.as_ref());
        }
        if let Some(error) = broken {
            let kept = if seen.records > 0 { format!(", after {} records", seen.records) } else { String::new() };
            return Err(Failure::failed(format!("{name}: {error}{kept}")));
        }
        if seen.records == 0 {
            return Err(Failure::failed(nothing(&name, &decoder)));
        }
        if self.json {
            say_json(&seen)?;
        } else if !in_terminal {
            seen.lines().iter().for_each(say);
        }
        unwritten.map_or(Ok(()), Err)
    }

    /// What is watched.
    fn name(&self) -> String {
        self.source.as_deref().map_or("QEMU".into(), |path| path.display().to_string())
    }

    /// Serves the scope.
    fn live(&self, port: u16) -> Result<Live, Failure> {
        let of_variant = || self.qemu.as_ref()?.rsplit('/').next()?.parse().ok();
        let scope = Scope {
            source: self.qemu.as_ref().map_or_else(|| self.name(), |variant| format!("{variant} in QEMU")),
            rate_hz: self.rate.or_else(of_variant),
            store: Store::new(self.keep),
            channels: Vec::new(),
            records: 0,
            dropped: 0,
            damaged: 0,
            ended: None,
        };
        let scope = Arc::new(Mutex::new(scope));
        let address = serve(&scope, port).map_err(|error| Failure::failed(format!("port {port}: {error}")))?;
        // a closed stream is no reason to stop
        let _ = writeln!(io::stderr(), "the scope is at http://{address}/ until Ctrl-C");
        Ok(Live(scope))
    }

    fn open(&self) -> Result<Box<dyn Read>, Failure> {
        if let Some(variant) = &self.qemu {
            if !driveline_firmware::scenes::VARIANTS.contains(&variant.as_str()) {
                let names = driveline_firmware::scenes::VARIANTS.join(", ");
                return Err(Failure::usage(format!("no variant is called `{variant}`; there are {names}")));
            }
            let board = board(&self.core).filter(|board| belongs(variant, board));
            let board = board.ok_or_else(|| {
                let cores = BOARDS.iter().filter(|board| belongs(variant, board)).map(|board| board.core);
                let cores = cores.collect::<Vec<_>>().join(", ");
                Failure::usage(format!("{variant} does not run on `{}`, but on {cores}", self.core))
            })?;
            ready(&Need::to_run([&board]))?;
            let image = build(variant, board, Program::Told, |line| eprintln!("{line}"));
            let image = image.map_err(|error| Failure::failed(error.to_string()))?;
            return Ok(Box::new(Telling::start(&image).map_err(|error| Failure::failed(error.to_string()))?));
        }
        match self.source.as_deref() {
            None => {
                Err(Failure::usage("there is nothing to watch: name a serial port, a file, `-` or `--qemu VARIANT`"))
            }
            Some(path) if path.as_os_str() == "-" => Ok(Box::new(io::stdin().lock())),
            Some(path) => {
                let file = File::open(path).map_err(|error| Failure::usage(format!("{}: {error}", path.display())))?;
                Ok(Box::new(file))
            }
        }
    }
}

/// The scope that is served.
struct Live(Arc<Mutex<Scope>>);

impl Live {
    /// Shows what has come.
    fn show(&self, decoder: &Decoder, seen: &Seen, ripe: &[Told], ended: bool) {
        let mut scope = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        (scope.records, scope.dropped, scope.damaged) = (seen.records, seen.dropped, decoder.damaged);
        if ended || !ripe.is_empty() {
            scope.channels = (0..seen.channels.len()).map(|index| decoder.channel(index)).collect();
            for told in ripe {
                let values = told.words.iter().enumerate().map(|(index, &word)| decoder.value(index, word) as f32);
                scope.store.push(told.tick, &values.collect::<Vec<f32>>());
            }
        }
    }

    /// Keeps the page until the program is stopped.
    fn stay(&self, broken: Option<&io::Error>) -> ! {
        let why = broken.map_or_else(|| "no more records came".to_owned(), ToString::to_string);
        let _ = writeln!(io::stderr(), "{why}; the scope stays until Ctrl-C");
        self.0.lock().unwrap_or_else(PoisonError::into_inner).ended = Some(why);
        loop {
            thread::park();
        }
    }
}

/// Why there is nothing to show.
fn nothing(name: &str, decoder: &Decoder) -> String {
    let Decoder { bytes, damaged, unknown, .. } = decoder;
    let why = match (bytes, unknown) {
        (0, _) => "the source sent nothing".into(),
        _ if decoder.describes(1) => "its channels described themselves, and none was recorded".into(),
        (_, 0) => format!("{bytes} bytes came, and {damaged} damaged frames: no telemetry, or the wrong baud rate"),
        _ => format!("{unknown} frames of an unknown kind: the firmware is newer than this program"),
    };
    format!("{name}: no record: {why}")
}

/// Records on their way into a file.
struct Csv {
    table: Destination,
    /// Begun with the first record: until it is written, what is there stays.
    file: Option<BufWriter<File>>,
    /// Values of a line, once there is one.
    columns: Option<usize>,
}

impl Csv {
    fn new(table: Destination) -> Self {
        Csv { table, file: None, columns: None }
    }

    fn write(&mut self, decoder: &Decoder, ripe: &[Told], flush: bool) -> Result<(), Failure> {
        self.put(decoder, ripe, flush).map_err(|error| self.table.unwritable(&error))
    }

    fn put(&mut self, decoder: &Decoder, ripe: &[Told], flush: bool) -> io::Result<()> {
        for told in ripe {
            let mut text = format!("{}\n", line(decoder, told));
            // a drive whose telemetry changes gets a head of its own
            if self.columns != Some(told.words.len()) {
                self.columns = Some(told.words.len());
                text.insert_str(0, &format!("{}\n", header(decoder, told)));
            }
            match &mut self.file {
                Some(file) => file.write_all(text.as_bytes())?,
                none => *none = Some(BufWriter::new(self.table.begin(text.as_bytes())?)),
            }
        }
        self.file.as_mut().filter(|_| flush).map_or(Ok(()), BufWriter::flush)
    }
}

/// The first line of the CSV: `tick,dropped,torque [N m],...`.
fn header(decoder: &Decoder, told: &Told) -> String {
    let mut text = String::from("tick,dropped");
    for index in 0..told.words.len() {
        text.push(',');
        text.push_str(&field(&decoder.channel(index).heading()));
    }
    text
}

fn line(decoder: &Decoder, told: &Told) -> String {
    let mut text = format!("{},{}", told.tick, told.dropped);
    for (index, &word) in told.words.iter().enumerate() {
        text.push_str(&format!(",{}", decoder.value(index, word)));
    }
    text
}

/// Draws over the lines of the last picture; gives how many there are now.
fn draw(lines: &[String], last: usize) -> usize {
    let mut text = if last > 0 { format!("\x1b[{last}A") } else { String::new() };
    for line in lines {
        text.push_str(&format!("\x1b[2K{line}\n"));
    }
    eprint!("{text}");
    lines.len()
}
