//! Records through the ring, the frames and the host's decoder, which was written from their description.

use std::convert::Infallible;
use std::ops::{Deref, DerefMut};
use std::thread;

use cargo_driveline::telemetry::{Decoder, Told};
use driveline::telemetry::{Channel, Kind, Ring};
use driveline_firmware::control_loop::telemetry::{VALUES, values};
use driveline_firmware::scene::Scene;
use driveline_firmware::scenes::find;
use driveline_firmware::self_test::fingerprint::SEED;
use driveline_firmware::self_test::inputs::Program as Inputs;
use driveline_qemu::image::{Program, board, build};
use driveline_qemu::link::Telling;
use embedded_io::{ErrorType, Write};

/// What was written: that `embedded-io` writes to a `Vec` is a feature, which the command does without.
#[derive(Default)]
struct Wire(Vec<u8>);

impl ErrorType for Wire {
    type Error = Infallible;
}

impl Write for Wire {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl Deref for Wire {
    type Target = Vec<u8>;

    fn deref(&self) -> &Vec<u8> {
        &self.0
    }
}

impl DerefMut for Wire {
    fn deref_mut(&mut self) -> &mut Vec<u8> {
        &mut self.0
    }
}

fn decoded(bytes: &[u8]) -> (Vec<Told>, Decoder) {
    let (mut records, mut decoder) = (Vec::new(), Decoder::default());
    decoder.take(bytes, |_, told| records.push(told));
    (records, decoder)
}

/// Values with zeros, ones and everything else in every byte.
fn awkward(tick: u32) -> [u32; 3] {
    [tick.wrapping_mul(0x9e37_79b9), tick & 0x00ff_00ff, [0, u32::MAX, 0x0100, 1][tick as usize % 4]]
}

#[test]
fn what_is_recorded_arrives() {
    let ring = Ring::<3, 16>::new();
    let mut bytes = Wire::default();
    for tick in 0..10_000 {
        ring.record(&awkward(tick));
        if tick % 10 == 9 {
            assert_eq!(ring.send(&mut bytes), Ok(10));
        }
    }
    let (records, decoder) = decoded(&bytes);
    assert_eq!((records.len(), decoder.damaged, ring.dropped()), (10_000, 0, 0));
    for (tick, told) in (0..).zip(records) {
        assert_eq!(told, Told { tick, dropped: 0, words: awkward(tick).to_vec() });
    }
}

#[test]
fn a_full_ring_drops_and_counts_and_the_gap_is_as_long() {
    let ring = Ring::<3, 8>::new();
    (0..10).for_each(|tick| ring.record(&awkward(tick)));
    assert_eq!(ring.dropped(), 3);
    let kept: Vec<_> = std::iter::from_fn(|| ring.take()).collect();
    assert_eq!(
        kept.iter().map(|record| (record.tick, record.dropped)).collect::<Vec<_>>(),
        (0..7).map(|tick| (tick, 0)).collect::<Vec<_>>()
    );
    ring.record(&awkward(10));
    let next = ring.take().unwrap();
    assert_eq!((next.tick, next.dropped, next.values), (10, 3, awkward(10)));
}

#[test]
fn channels_describe_themselves() {
    let channels = [
        Channel { name: "motor speed", unit: "rad/s", kind: Kind::Single },
        Channel { name: "angle", unit: "turn", kind: Kind::Integer(1.0 / 4_294_967_296.0) },
    ];
    let mut bytes = Wire::default();
    Channel::send(&channels, &mut bytes).unwrap();
    let (_, decoder) = decoded(&bytes);
    let [speed, angle] = [decoder.channel(0), decoder.channel(1)];
    assert_eq!(
        (speed.name.as_str(), speed.unit.as_str(), speed.value(1.5_f32.to_bits())),
        ("motor speed", "rad/s", 1.5)
    );
    assert_eq!((angle.name.as_str(), angle.unit.as_str(), angle.value(1 << 30)), ("angle", "turn", 0.25));
    assert_eq!(decoder.channel(2).name, "value 2");
}

/// A CSV's first line, parted and unquoted as RFC 4180 says.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        let field = fields.last_mut().unwrap();
        match c {
            '"' if quoted && characters.peek() == Some(&'"') => field.extend(characters.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            c => field.push(c),
        }
    }
    fields
}

#[test]
fn whatever_a_channel_is_called_the_table_has_its_columns_and_the_terminal_its_peace() {
    let channels = [
        Channel { name: "torque, \"shaft\"", unit: "N m", kind: Kind::Integer(1.0) },
        // clears the screen; sets the title by an eight-bit code; a line's end
        Channel { name: "\x1b[2Jspeed", unit: "\u{9b}31m", kind: Kind::Integer(1.0) },
        Channel { name: "two\r\nlines", unit: "", kind: Kind::Integer(1.0) },
    ];
    let ring = Ring::<3, 16>::new();
    let mut bytes = Wire::default();
    Channel::send(&channels, &mut bytes).unwrap();
    ring.record(&[1, 2, 3]);
    ring.send(&mut bytes).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let [recorded, csv] = ["recorded.bin", "run.csv"].map(|name| folder.path().join(name));
    std::fs::write(&recorded, &bytes.0).unwrap();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_lab"))
        .args(["watch", recorded.to_str().unwrap(), "--csv", csv.to_str().unwrap()])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = std::fs::read_to_string(csv).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        fields(lines[0]),
        ["tick", "dropped", "torque, \"shaft\" [N m]", "\u{fffd}[2Jspeed [\u{fffd}31m]", "two\u{fffd}\u{fffd}lines"]
    );
    assert_eq!(lines[1..], ["0,0,1,2,3"]);
    for text in [&output.stdout, &output.stderr] {
        let text = std::str::from_utf8(text).unwrap();
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text:?}");
    }
    assert!(std::str::from_utf8(&output.stdout).unwrap().contains("\u{fffd}[2Jspeed"));
}

#[test]
fn no_damaged_byte_makes_a_record_that_was_not_sent() {
    let ring = Ring::<3, 8>::new();
    let mut bytes = Wire::default();
    (0..5).for_each(|tick| ring.record(&awkward(tick + 100)));
    ring.send(&mut bytes).unwrap();
    let (sound, _) = decoded(&bytes);
    assert_eq!(sound.len(), 5);
    for place in 0..bytes.len() {
        for flip in 1..=255 {
            let mut damaged = bytes.clone();
            damaged[place] ^= flip;
            let (records, _) = decoded(&damaged);
            // a CRC of 16 bits sees every error within 16 of them; a zero that comes or goes parts a frame or joins two
            assert!(records.iter().all(|told| sound.contains(told)), "{place} {flip:#x}");
            assert!(records.len() >= 3, "{place} {flip:#x}");
        }
    }
}

#[test]
fn a_listener_that_comes_late_begins_with_the_next_frame() {
    let ring = Ring::<3, 8>::new();
    let mut bytes = Wire::default();
    (0..5).for_each(|tick| ring.record(&awkward(tick)));
    ring.send(&mut bytes).unwrap();
    let (records, decoder) = decoded(&bytes[10..]);
    assert_eq!((records.len(), decoder.damaged), (4, 0));
}

#[test]
fn the_tick_and_the_main_loop_may_run_at_the_same_time() {
    const TICKS: u32 = 50_000;
    let ring = Ring::<3, 8>::new();
    thread::scope(|scope| {
        scope.spawn(|| (0..TICKS).for_each(|tick| ring.record(&awkward(tick))));
        let (mut taken, mut last) = (0, None);
        while last.is_none_or(|last| last < TICKS - 1) && taken + ring.dropped() < TICKS {
            if let Some(record) = ring.take() {
                // whole records, in order, with all that was dropped before them
                assert_eq!(record.values, awkward(record.tick));
                assert_eq!(record.dropped, record.tick - taken);
                assert!(last.is_none_or(|last| last < record.tick));
                last = Some(record.tick);
                taken += 1;
            }
        }
    });
}

#[test]
fn qemu_tells_what_the_host_calculates() {
    use std::io::Read;

    let variant = "hoist/fixed/reduced/10000";
    let image = build(variant, board("m3").unwrap(), Program::Told, |_| {}).unwrap();
    let mut telling = Telling::start(&image).unwrap();
    let (mut records, mut decoder) = (Vec::new(), Decoder::default());
    let mut bytes = [0; 4096];
    while records.len() < 3_000 {
        let length = telling.read(&mut bytes).unwrap();
        assert!(length > 0, "QEMU ended after {} records", records.len());
        decoder.take(&bytes[..length], |_, told| records.push(told));
    }
    assert_eq!(decoder.damaged, 0);
    assert!(decoder.describes(VALUES));
    let row = find(variant).unwrap();
    let (mut scene, mut inputs) = (row.start(), Inputs::new(SEED, row.words()));
    for (tick, told) in (0..).zip(&records) {
        let input = inputs.next_input();
        let words = values(&input, &scene.tick(&input)).to_vec();
        assert_eq!(*told, Told { tick, dropped: 0, words }, "tick {tick}");
    }
}

#[test]
fn a_recorded_file_becomes_csv() {
    let directory = tempfile::tempdir().unwrap();
    let (recorded, csv) = (directory.path().join("recorded.bin"), directory.path().join("run.csv"));
    let ring = Ring::<2, 8>::new();
    let mut bytes = Wire::default();
    // a record that comes before its columns have names waits for them
    ring.record(&[2.5_f32.to_bits(), 1 << 31]);
    ring.send(&mut bytes).unwrap();
    let kind = Kind::Integer(1.0 / 4_294_967_296.0);
    let channels =
        [Channel { name: "torque", unit: "N m", kind: Kind::Single }, Channel { name: "angle", unit: "turn", kind }];
    Channel::send(&channels, &mut bytes).unwrap();
    ring.record(&[(-0.125_f32).to_bits(), 1 << 30]);
    ring.send(&mut bytes).unwrap();
    std::fs::write(&recorded, &bytes.0).unwrap();
    let arguments = ["driveline", "watch", recorded.to_str().unwrap(), "--json", "--csv", csv.to_str().unwrap()];
    cargo_driveline::cli::main(arguments.map(Into::into));
    let written = std::fs::read_to_string(csv).unwrap();
    assert_eq!(written, "tick,dropped,torque [N m],angle [turn]\n0,0,2.5,-0.5\n1,0,-0.125,0.25\n");
}

/// `watch` over a file: its exit code, what it says, and what it says on errors.
fn watch(source: &std::ffi::OsStr, arguments: &[&str]) -> (Option<i32>, String, String) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lab"));
    let output = command.arg("watch").arg(source).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn what_is_no_telemetry_is_said_to_be_none_and_the_last_recording_stays() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("run.csv");
    std::fs::write(&csv, "the last run\n").unwrap();
    let csv = csv.to_str().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let garbage: Vec<u8> = (0..100_000_u32).map(|at| (at.wrapping_mul(0x9e37_79b9) >> 24) as u8).collect();
    let directory = folder.path().join("directory");
    std::fs::create_dir(&directory).unwrap();
    for (source, said) in [
        (file("empty.bin", &[]), "empty.bin: no record: the source sent nothing"),
        (file("garbage.bin", &garbage), "bytes came, and"),
        (file("endless.bin", &[1; 300_000]), "300000 bytes came, and 0 damaged frames"),
        (directory, "directory: Is a directory"),
        (folder.path().join("missing.bin"), "missing.bin: No such file"),
    ] {
        for json in [&["--csv", csv][..], &["--csv", csv, "--json"]] {
            let (code, out, err) = watch(source.as_os_str(), json);
            assert!(matches!(code, Some(1 | 2)) && (err.clone() + &out).contains(said), "{code:?}: {out}{err}");
            assert!(!err.contains("panicked"), "{err}");
        }
        assert_eq!(std::fs::read_to_string(csv).unwrap(), "the last run\n", "{said}");
    }
}

#[cfg(unix)]
#[test]
fn a_path_need_not_be_unicode_and_a_recording_may_be_cut_off() {
    use std::os::unix::ffi::OsStrExt;

    let folder = tempfile::tempdir().unwrap();
    let ring = Ring::<3, 8>::new();
    let mut bytes = Wire::default();
    (0..5).for_each(|tick| ring.record(&awkward(tick)));
    ring.send(&mut bytes).unwrap();
    let path = folder.path().join(std::ffi::OsStr::from_bytes(b"run\xff.bin"));
    let csv = folder.path().join(std::ffi::OsStr::from_bytes(b"run\xff.csv"));
    let frames = bytes.iter().filter(|&&byte| byte == 0).count();
    assert_eq!(frames, 5);
    for length in 0..=bytes.len() {
        // whatever is behind the last whole frame
        let whole = bytes[..length].iter().filter(|&&byte| byte == 0).count();
        let (records, decoder) = decoded(&bytes[..length]);
        assert_eq!((records.len(), decoder.damaged), (whole, 0));
    }
    std::fs::write(&path, &bytes[..bytes.len() - 3]).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_lab"));
    let output = command.arg("watch").arg(&path).arg("--csv").arg(&csv).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    assert_eq!(std::fs::read_to_string(csv).unwrap().lines().count(), 1 + 4);
}

/// A frame of a packet, as its description says.
fn framed(packet: &[u8]) -> Vec<u8> {
    let crc = packet.iter().fold(0xffff_u16, |crc, &byte| {
        (0..8).fold(crc ^ u16::from(byte) << 8, |crc, _| if crc >> 15 == 1 { crc << 1 ^ 0x1021 } else { crc << 1 })
    });
    let packet = [packet, &crc.to_le_bytes()].concat();
    let runs = packet.split(|&byte| byte == 0).flat_map(|run| [&[run.len() as u8 + 1], run].concat());
    runs.chain([0]).collect()
}

#[test]
fn frames_of_a_later_firmware_are_counted_and_not_called_damaged() {
    let later = [
        // a kind of packet, a kind of channel and a length of a record that there are not
        &[3, 1, 2, 3][..],
        &[2, 0, 1, 7, 0, 0, 128, 63, 1, b'x'],
        &[1, 0, 0, 0, 0, 0, 0, 0, 0, 9],
        // a name that is longer than its packet
        &[2, 0, 1, 0, 0, 0, 128, 63, 200, b'x'],
        &[],
    ];
    let mut bytes: Vec<u8> = later.iter().flat_map(|packet| framed(packet)).collect();
    let (records, decoder) = decoded(&bytes);
    assert_eq!((records.len(), decoder.damaged, decoder.unknown), (0, 0, 5));
    assert_eq!(decoder.channel(0).name, "value 0");
    let folder = tempfile::tempdir().unwrap();
    let (path, csv) = (folder.path().join("later.bin"), folder.path().join("later.csv"));
    std::fs::write(&path, &bytes).unwrap();
    let (code, _, err) = watch(path.as_os_str(), &[]);
    assert!(code == Some(1) && err.contains("newer than this program"), "{err}");
    // records beside them are shown; where they have another length, a head comes between
    bytes.extend(framed(&[1, 0, 0, 0, 0, 0, 0, 0, 0, 5, 0, 0, 0]));
    bytes.extend(framed(&[1, 1, 0, 0, 0, 0, 0, 0, 0, 6, 0, 0, 0, 7, 0, 0, 0]));
    std::fs::write(&path, &bytes).unwrap();
    let (code, out, err) = watch(path.as_os_str(), &["--csv", csv.to_str().unwrap()]);
    assert!(code == Some(0) && out.contains("5 of an unknown kind, from a later firmware"), "{out}{err}");
    let table = std::fs::read_to_string(csv).unwrap();
    assert_eq!(table, "tick,dropped,value 0\n0,0,5\ntick,dropped,value 0,value 1\n1,0,6,7\n");
}
