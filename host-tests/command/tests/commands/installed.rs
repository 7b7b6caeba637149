//! What `cargo install` puts on the path.

use std::process::{Command, Output};

use super::bench::Bench;

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Those for who designs a machine, and none of the laboratory's: in the groups of the book's page, each with what it
/// does.
#[test]
fn the_installed_commands_are_the_designers() {
    let bench = Bench::new();
    let help = bench.said(&["--help"]);
    let (_, page) =
        include_str!("../../../../doc/commands.md").split_once("| for | `cargo driveline` |\n|---|---|\n").unwrap();
    let mut names = 0;
    for row in page.lines().take_while(|line| line.starts_with('|')) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        // the runner of new projects is not listed
        let wanted: Vec<&str> =
            cells[2].split(", ").map(|name| name.trim_matches('`')).filter(|name| *name != "qemu").collect();
        let (_, group) = help
            .to_lowercase()
            .split_once(&format!("\n{}:\n", cells[1]))
            .map(|(a, b)| (a.to_owned(), b.to_owned()))
            .unwrap_or_else(|| panic!("{}: {help}", cells[1]));
        let lines: Vec<&str> = group.split("\n\n").next().unwrap().lines().collect();
        let listed: Vec<&str> = lines.iter().filter_map(|line| line.split_whitespace().next()).collect();
        assert_eq!(listed, wanted, "{help}");
        assert!(lines.iter().all(|line| line.split_whitespace().count() > 3), "{help}");
        names += listed.len();
    }
    let man = bench.said(&["shell", "man"]);
    // the manual page lists them all, and `help`
    assert_eq!(man.matches(".TP\ncargo\\-driveline\\-").count(), names + 1, "{man}");
}

/// The label of an error is red where that is asked for, and plain in a pipe.
#[test]
fn an_error_is_coloured_as_asked() {
    let bench = Bench::new();
    for (options, is_red) in [(&["--color", "always"][..], true), (&["--color=never"], false), (&[], false)] {
        for arguments in [&["modes", "none.toml"][..], &["modes", "--no-such-option"]] {
            let said = err(&bench.run(&[arguments, options].concat()));
            assert_eq!(said.starts_with("\x1b[1;31merror:\x1b[0m "), is_red, "{options:?}: {said:?}");
            assert!(is_red || said.starts_with("error: "), "{said:?}");
        }
    }
    bench.refused(&["modes", "--color", "red"]);
}

/// Completions and manual page name every command and the options of one; JSON has the version of its keys.
#[test]
fn a_shell_completes_every_command() {
    let bench = Bench::new();
    for form in ["bash", "elvish", "fish", "zsh", "man"] {
        let printed = bench.said(&["shell", form]);
        for word in ["design", "campaign", "balancing", "watch"] {
            assert!(printed.contains(word), "{form} has no {word}");
        }
        assert!(form == "man" || printed.contains("vibration-limit"), "{form} has no option of export");
    }
    // of a shell that is there
    let ask = "COMP_WORDS=(cargo-driveline des); COMP_CWORD=1; registered=$(complete -p cargo-driveline)\n\
        registered=${registered#*-F }; ${registered%% *} cargo-driveline des cargo-driveline\n\
        echo \"found ${COMPREPLY[*]}\"";
    let script = format!("{}\n{ask}", bench.said(&["shell", "bash"]));
    let completed = Command::new("bash").args(["-c", &script]).output().unwrap();
    assert!(out(&completed).contains("found design"), "{completed:?}");
    assert_eq!(bench.json(&["example", "hoist"])["schema"], 1);
}

/// In a folder of nothing: what a file is needed for gets it from the program, what a clone is needed for says so.
#[test]
fn an_installed_command_works_in_any_folder() {
    let bench = Bench::new();
    let names = bench.said(&["example"]);
    for line in names.lines() {
        let (name, commands) = (line[..15].trim(), line[16..33].trim());
        // a recording of another rate and sensor needs them said: below
        if name == "bench-log" {
            continue;
        }
        let file = format!("{name}.toml");
        bench.write(&file, bench.said(&["example", name]));
        for command in commands.split(", ") {
            bench.said(&[command, &file]);
        }
    }
    bench.write("bench.csv", bench.said(&["example", "bench-log"]));
    let recorded = ["bench.csv", "--rate", "2500", "--torque-constant", "0.564"];
    for options in [&["identify", "--to", "5", "--toml", "bench.toml"][..], &["replay", "--machine", "bench.toml"]] {
        bench.said(&[options, &recorded].concat());
    }
}
