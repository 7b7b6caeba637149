//! Files that are no longer what they were: texts, tables, archives, streams.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::random::Random;

/// In place of a number or a word.
#[rustfmt::skip]
const VALUES: [&str; 30] = [
    "nan", "inf", "-inf", "-1", "0", "-0.0", "1e308", "1e-308", "5e-324", "1e400", "99999999999999999999", "1e-9",
    "-1e9", "true", "\"\"", "\"\\u0000\"", "[]", "[[]]", "{}", "[1, 2, 3]", "1979-05-27", "0x10", "1_000", "1__0",
    "\"\\u202e\"", "'''", "# ", "=", "1e6", "0.5",
];

/// Any bytes.
fn noise(random: &mut Random, most: usize) -> Vec<u8> {
    (0..random.below(most)).map(|_| random.next() as u8).collect()
}

/// A text with one to three faults. Some leave it as good as it was.
pub fn text(random: &mut Random, text: &str) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..1 + random.below(3) {
        bytes = once(random, &bytes);
    }
    bytes
}

fn once(random: &mut Random, bytes: &[u8]) -> Vec<u8> {
    let whole = String::from_utf8_lossy(bytes).into_owned();
    let mut lines: Vec<String> = whole.lines().map(str::to_owned).collect();
    let (at, other) = (random.below(lines.len()), random.below(lines.len()));
    if lines.is_empty() {
        return noise(random, 100);
    }
    match random.below(20) {
        // the value of a key, some words of a line
        0..=6 => match lines[at].split_once('=') {
            Some((key, _)) => lines[at] = format!("{key}= {}", random.one(&VALUES)),
            None => lines[at] = number(random, &lines[at]),
        },
        7 => drop(lines.remove(at)),
        8 => lines.insert(other, lines[at].clone()),
        9 => lines.swap(at, other),
        // a key that is almost one
        10 => lines[at] = lines[at].replacen(['a', 'e', 'i', 'n'], "x", 1),
        11 => {
            let mut cut = bytes.to_vec();
            cut.truncate(random.below(bytes.len()));
            return cut;
        }
        12 => {
            let mut with = bytes.to_vec();
            let place = random.below(with.len());
            drop(with.splice(place..place, noise(random, 8)));
            return with;
        }
        13 => {
            let mut with = bytes.to_vec();
            let place = random.below(with.len());
            with[place] ^= 1 << random.below(8);
            return with;
        }
        14 => lines[at] = lines[at].replace(['"', '[', ']', '=', ','], random.one(&["", "\"", "[", "]]", ";", "=="])),
        15 => return [b"\xef\xbb\xbf", bytes].concat(),
        16 => return whole.replace('\n', random.one(&["\r\n", "\r", "\n\n", "\u{2028}"])).into_bytes(),
        17 => lines.insert(at, format!("x = {}{}", "[".repeat(3000), "]".repeat(random.below(3000)))),
        18 => lines.insert(at, format!("name = \"{}\"", "long \u{1b}[2J".repeat(random.below(2000)))),
        _ => {
            let section: Vec<String> = lines[at.min(other)..=at.max(other)].to_vec();
            let times = 1 + random.below(20);
            lines.extend((0..times).flat_map(|_| section.clone()));
        }
    }
    (lines.join("\n") + "\n").into_bytes()
}

/// A cell of a line in place of which stands something else.
fn number(random: &mut Random, line: &str) -> String {
    let mut cells: Vec<&str> = line.split(',').collect();
    let at = random.below(cells.len());
    cells[at] = random.one(&VALUES);
    cells.join(",")
}

/// Bytes with flips, cuts, repetitions.
pub fn bytes(random: &mut Random, bytes: &[u8]) -> Vec<u8> {
    let mut with = bytes.to_vec();
    for _ in 0..1 + random.below(8) {
        let (at, length) = (random.below(with.len()), random.below(64));
        let end = (at + length).min(with.len());
        match random.below(5) {
            0 => with.truncate(at),
            1 => drop(with.drain(at..end)),
            2 => {
                let piece = with[at..end].to_vec();
                drop(with.splice(at..at, piece));
            }
            3 => drop(with.splice(at..at, noise(random, 64))),
            _ if !with.is_empty() => with[at] ^= 1 << random.below(8),
            _ => {}
        }
    }
    with
}

/// An archive as an FMU is one, with what is wrong in its list or its description; its library is none.
pub fn fmu(random: &mut Random, description: &str) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let method = if random.in_ten(5) { CompressionMethod::Stored } else { CompressionMethod::Deflated };
    let options = SimpleFileOptions::default().compression_method(method);
    let xml = match random.below(4) {
        0 => description.as_bytes().to_vec(),
        1 => bytes(random, description.as_bytes()),
        2 => xml(random, description).into_bytes(),
        _ => text(random, &description.replace('>', ">\n")),
    };
    let library = format!("binaries/{}/spin.so", random.one(&["x86_64-linux", "linux64", "win64", "../../.."]));
    let names =
        ["modelDescription.xml", library.as_str(), "resources/a", "../outside", "/outside", "a/b/../../../outside"];
    for name in names.iter().take(if random.in_ten(7) { 3 } else { 6 }) {
        if random.in_ten(1) {
            continue;
        }
        let content = if *name == "modelDescription.xml" { xml.clone() } else { noise(random, 200) };
        // a name that stands there twice is refused by the writer
        if archive.start_file(*name, options).is_ok() {
            archive.write_all(&content).unwrap();
        }
    }
    let written = archive.finish().unwrap().into_inner();
    if random.in_ten(4) { bytes(random, &written) } else { written }
}

const LONG: &str =
    "999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999999";

/// A description whose attributes have other values.
fn xml(random: &mut Random, description: &str) -> String {
    let parts: Vec<&str> = description.split('"').collect();
    let at = random.below(parts.len() / 2) * 2 + 1;
    let values = ["", "-1", "4294967296", "NaN", "1e999", "../../x", "&bad;", "&lt;", "x\u{1b}[2J", LONG];
    let value: &str = random.one(&values);
    let mut parts: Vec<String> = parts.iter().map(|part| (*part).to_owned()).collect();
    if let Some(part) = parts.get_mut(at) {
        *part = value.to_owned();
    }
    parts.join("\"")
}

/// What has no end, no begin or no content is refused in little time and memory by every command that reads a file.
#[test]
fn special_files_are_refused_and_named() {
    let mut place = super::cases::sources();
    place.put("line.txt", &vec![b'x'; 3 << 20]);
    place.put("nul.txt", &[0; 4096]);
    std::os::unix::fs::symlink("loop", place.at("loop")).unwrap();
    std::os::unix::fs::symlink("nowhere", place.at("dangling")).unwrap();
    std::fs::create_dir(place.at("folder")).unwrap();
    for file in ["/dev/zero", "/dev/urandom", "/dev/null", "line.txt", "nul.txt", "loop", "dangling", "folder"] {
        for line in [
            "modes FILE",
            "simulate FILE",
            "rotor FILE",
            "balancing FILE",
            "design FILE",
            "identify FILE --rate 1000",
            "replay FILE --machine machine.toml",
            "campaign FILE --draws 2",
            "campaign merge FILE one.draws",
            "cosim FILE FILE",
            "watch FILE",
        ] {
            // half a gibibyte of addresses: what is read to its end does not fit
            let program = env!("CARGO_BIN_EXE_lab");
            let line = line.replace("FILE", file);
            let mut command = place.command("/bin/sh");
            command.args(["-c", &format!("ulimit -v 524288; exec '{program}' {line}")]);
            let begun = std::time::Instant::now();
            let ended = place.piped(command);
            let said = ended.said();
            assert!(matches!(ended.code, Some(1 | 2)), "{line}: {:?} {:?} {said}", ended.code, ended.signal);
            assert!(said.starts_with("error: ") && said.contains(file), "{line}: {said}");
            assert!(begun.elapsed().as_secs() < 20, "{line}: {:?}", begun.elapsed());
        }
    }
}

/// Any digit of a campaign's results that is changed is refused with its line.
#[test]
fn a_changed_digit_of_results_is_refused_with_its_line() {
    let mut place = super::cases::sources();
    let text = super::cases::campaign()[0].clone();
    let digits: Vec<usize> = text.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
    for at in digits {
        let mut bytes = text.clone().into_bytes();
        bytes[at] = b'0' + (bytes[at] - b'0' + 1) % 10;
        place.put("changed.draws", &bytes);
        let path = place.at("changed.draws");
        let line = text[..=at].lines().count();
        match cargo_driveline::campaign::record::read(&path) {
            // the version
            Err(sentence) if line == 1 => assert!(sentence.contains("of this version"), "{sentence}"),
            // the settings have one check sum, on their last line
            Err(sentence) => {
                let is_setting = |line: usize| text.lines().nth(line - 1).unwrap().starts_with('#');
                let last = (line..).take_while(|&line| is_setting(line)).last().unwrap_or(line);
                let has = |line: usize| sentence.contains(&format!("changed.draws, line {line}: "));
                let is_unread = sentence.contains("of this version") && is_setting(line);
                assert!(has(line) || has(last) || is_unread, "{at}: {sentence}");
            }
            Ok(_) => panic!("digit {at} in line {line} was read"),
        }
    }
}
