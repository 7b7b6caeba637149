//! Argument lists out of what `--help` says of each command.

use std::ffi::{OsStr, OsString};
use std::os::unix::ffi::OsStrExt;
use std::sync::OnceLock;

use super::cases::Case;
use super::random::Random;
use super::run::Place;

/// A command's options, each with whether it takes a value.
struct Command {
    words: Vec<String>,
    options: Vec<(String, bool)>,
}

/// What a command prints with `--help`.
fn help(words: &[String]) -> String {
    let arguments: Vec<OsString> = words.iter().map(OsString::from).chain(["--help".into()]).collect();
    String::from_utf8(Place::new().run(&arguments, &[]).out).unwrap()
}

fn listed(help: &str, heading: &str) -> Vec<String> {
    let Some((_, rest)) = help.split_once(heading) else { return Vec::new() };
    let lines = rest.lines().skip(1).take_while(|line| !line.is_empty());
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| line.split_whitespace().next().map(str::to_owned)).filter(|name| name != "help").collect()
}

/// All commands and theirs, by the help.
fn commands() -> &'static [Command] {
    static COMMANDS: OnceLock<Vec<Command>> = OnceLock::new();
    COMMANDS.get_or_init(|| {
        let mut commands = Vec::new();
        let mut open: Vec<Vec<String>> = listed(&help(&[]), "Commands:").into_iter().map(|name| vec![name]).collect();
        while let Some(words) = open.pop() {
            let help = help(&words);
            open.extend(listed(&help, "Commands:").into_iter().map(|name| [&words[..], &[name]].concat()));
            let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with("--"));
            let option = |line: &str| {
                let name = line.split([' ', '=', '[']).next().unwrap_or_default().to_owned();
                (name, line.contains('<') || line.contains("[=<") || line.contains("[<"))
            };
            commands.push(Command { words, options: lines.map(option).collect() });
        }
        // fewer would mean that the help is laid out otherwise than it is read here
        assert!(commands.len() > 20, "{} commands", commands.len());
        assert!(commands.iter().map(|command| command.options.len()).sum::<usize>() > 80);
        commands
    })
}

/// Commands that would work for minutes on a right argument: they get none.
const HEAVY: [&str; 1] = ["campaign"];

/// Values, wrong for most options.
fn value(random: &mut Random) -> OsString {
    #[rustfmt::skip]
    const TEXTS: [&str; 42] = [
        "", " ", "-", "--", "-1", "-0", "0", "1", "3", "NaN", "inf", "-inf", "1e999", "1e-400", "0x10", "1,5", "1_000",
        "4294967296", "18446744073709551616", "-9223372036854775809", "nothing", "nothing.toml", "machine.toml",
        "train.toml", "empty", "noise", ".", "/", "/dev/null", "/dev/full", "no/such/page.html", "page.html",
        "\u{1b}[2J",
        "\u{202e}abc", "a\nb", "a=b", "a=1..", "0:load=1", "hoist/f32/reduced/10000", "m3", "1/0", "--json",
    ];
    match random.below(24) {
        0 => OsStr::from_bytes(b"\xff\xfe.toml").to_owned(),
        1 => "long".repeat(1 + random.below(3000)).into(),
        2 => "machine.toml/page.html".into(),
        _ => random.one(&TEXTS).into(),
    }
}

/// An argument list of any command.
pub fn case(random: &mut Random) -> Case {
    let command = &commands()[random.below(commands().len())];
    let heavy = HEAVY.contains(&command.words[0].as_str()) && command.words.len() == 1;
    let mut arguments: Vec<OsString> = Vec::new();
    for _ in 0..random.below(4) {
        if heavy {
            arguments.push(random.one(&["nothing", "nothing.toml", "empty", "noise", ".", "-1", ""]).into());
        } else {
            arguments.push(value(random));
        }
    }
    for _ in 0..random.below(5) {
        let Some((name, takes)) = command.options.get(random.below(command.options.len())) else { break };
        let name = if random.in_ten(1) { format!("{name}x") } else { name.clone() };
        let at = random.below(arguments.len() + 1);
        match (*takes, random.below(10)) {
            (true, 0..7) => drop(arguments.splice(at..at, [name.into(), value(random)])),
            (true, 7) | (false, 0) => {
                let mut joined = OsString::from(name + "=");
                joined.push(value(random));
                arguments.insert(at, joined);
            }
            _ => arguments.insert(at, name.into()),
        }
    }
    let arguments = command.words.iter().map(OsString::from).chain(arguments).collect();
    let noise = (0..300).map(|_| random.next() as u8).collect();
    let files = vec![
        ("machine.toml", include_bytes!("../../../command/machines/roll.toml").to_vec()),
        ("train.toml", include_bytes!("../../../command/trains/gear-pair.toml").to_vec()),
        ("empty", Vec::new()),
        ("noise", noise),
    ];
    // a right argument may name any file
    Case { files, arguments, results: vec!["*"], ..Case::default() }
}
