//! The page of commands against `--help`.

use std::collections::BTreeSet;
use std::process::Command;

use super::pages::{Page, all};

/// What `cargo driveline COMMAND --help` prints.
fn help(command: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_lab")).args(command).arg("--help").output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

/// The commands that the help lists.
fn commands() -> Vec<String> {
    let help = help(&[]);
    let (_, listed) = help.split_once("Commands:").unwrap();
    let names = listed.lines().skip(1).take_while(|line| line.starts_with("  "));
    names.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help").map(str::to_owned).collect()
}

#[test]
fn every_command_has_a_section_and_a_table_all_its_options() {
    let [tool, laboratory] = ["doc/commands.md", "doc/makers/laboratory.md"].map(Page::read);
    let commands = commands();
    assert!(commands.len() > 10, "{commands:?}");
    let (mut wrong, mut found) = (Vec::new(), 0);
    for command in &commands {
        let options: BTreeSet<String> = help(&[command])
            .lines()
            .map(str::trim_start)
            .filter(|line| line.starts_with("--") || line.starts_with("-h"))
            .filter_map(|line| line.split([' ', ',']).find(|word| word.starts_with("--")).map(str::to_owned))
            .filter(|option| !["--help", "--color"].contains(&&**option))
            .collect();
        found += options.len();
        let of = |page: &Page| page.sections.iter().position(|section| section.code == [command.as_str()]);
        // the page of a machine's designer leaves options to the help
        let Some(section) = of(&laboratory).map(|at| &laboratory.sections[at]) else {
            if of(&tool).is_none() {
                wrong.push(format!("`{command}` has no section"));
            }
            continue;
        };
        let told: BTreeSet<String> = section
            .rows
            .iter()
            .filter_map(|row| row[0].trim_matches('`').split([' ', ',']).next())
            .filter(|option| option.starts_with("--"))
            .map(str::to_owned)
            .collect();
        wrong.extend(options.difference(&told).map(|option| format!("`{command} {option}` is missing")));
        wrong.extend(told.difference(&options).map(|option| format!("`{command}` has no {option}")));
    }
    // fewer would mean that the help is laid out otherwise than it is read here
    assert!(found > 40, "{found} options in the help");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every line of `cargo driveline` and `cargo lab` in the pages names a command that there is.
#[test]
fn every_command_line_names_a_command() {
    let commands = commands();
    for page in all() {
        let lines = page.fences.iter().flat_map(|(_, text)| text.lines().map(str::to_owned)).chain(page.code);
        for line in lines {
            let after = |program| line.split_once(program).map(|(_, rest)| rest);
            let Some(rest) = after("cargo driveline ").or_else(|| after("cargo lab ")) else { continue };
            let Some(word) = rest.split_whitespace().next() else { continue };
            // the runner of new projects is not listed
            let known = word == "qemu" || commands.iter().any(|command| command == word) || word.starts_with("--");
            let placeholder = word.chars().all(|c| c.is_ascii_uppercase());
            assert!(known || placeholder, "{}: {line}", page.path.display());
        }
    }
}
