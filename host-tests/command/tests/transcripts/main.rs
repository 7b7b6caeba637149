//! The book's pages as a reader follows them: what stands in a `console` block is typed, what stands under it is what
//! is printed.
//!
//! - A page begins in an empty folder, and its blocks follow each other.
//! - `$ ` begins a command for the shell, `> ` continues it. A line of `...` stands for any lines. A last line of
//!   `? CODE` is an exit code other than 0.
//! - A listing whose fence ends in `,file=PATH` is that file from there on. One in `,edit=PATH` has lines of it that
//!   replace those of the same key.
//! - A block in `console,needs=TOOL` is run where that tool is on the path.
//!
//! With `DRIVELINE_WRITE` set a page gets what is printed.

mod json;
mod troubleshooting;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use driveline_qemu::clone::target_directory;
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag, TagEnd};

/// A fenced block: its info string, its text and where the text stands in the page.
struct Block {
    info: String,
    text: String,
    at: std::ops::Range<usize>,
}

/// A command of a block, and what the page says it prints.
struct Step<'t> {
    command: String,
    expected: Vec<&'t str>,
}

fn blocks(page: &str) -> Vec<Block> {
    let (mut all, mut open): (Vec<Block>, Option<Block>) = (Vec::new(), None);
    for (event, at) in Parser::new(page).into_offset_iter() {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                open = Some(Block { info: info.into_string(), text: String::new(), at: 0..0 });
            }
            Event::Text(text) => {
                if let Some(block) = &mut open {
                    let start = if block.text.is_empty() { at.start } else { block.at.start };
                    block.at = start..at.end;
                    block.text.push_str(&text);
                }
            }
            Event::End(TagEnd::CodeBlock) => all.extend(open.take()),
            _ => {}
        }
    }
    all
}

fn steps(text: &str) -> Vec<Step<'_>> {
    let mut steps: Vec<Step<'_>> = Vec::new();
    for line in text.lines() {
        let continued = steps.last_mut().filter(|step| step.expected.is_empty()).zip(line.strip_prefix("> "));
        if let Some(command) = line.strip_prefix("$ ") {
            steps.push(Step { command: command.to_owned(), expected: Vec::new() });
        } else if let Some((step, more)) = continued {
            write!(step.command, "\n{more}").unwrap();
        } else {
            steps.last_mut().unwrap_or_else(|| panic!("{line:?} before a command")).expected.push(line);
        }
    }
    steps
}

/// Whether the lines are those expected, where `...` stands for any.
fn agree(expected: &[&str], printed: &[&str]) -> bool {
    match expected.split_first() {
        None => printed.is_empty(),
        Some((&"...", rest)) => (0..=printed.len()).any(|skipped| agree(rest, &printed[skipped..])),
        Some((line, rest)) => printed.split_first().is_some_and(|(first, more)| first == line && agree(rest, more)),
    }
}

/// Types a command; what it prints on both streams, with its exit code where that is not 0. Projects are compiled in one
/// place, as other tests do.
fn typed(command: &str, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_cargo-driveline"));
    let path = std::env::var("PATH").unwrap_or_default();
    let output = Command::new("sh")
        .args(["-c", &format!("exec 2>&1\n{command}")])
        .env("PATH", format!("{}:{path}", program.parent().unwrap().display()))
        .env("CARGO_TARGET_DIR", target_directory().unwrap().join("exported/target"))
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .current_dir(folder)
        .output()
        .unwrap();
    let mut text = String::from_utf8(output.stdout).unwrap();
    if let Some(code) = output.status.code().filter(|code| *code != 0) {
        writeln!(text, "? {code}").unwrap();
    }
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Replaces the lines of a file that give a key another value; a line that the file lacks is added.
fn edit(file: &Path, lines: &str) {
    let mut text = fs::read_to_string(file).unwrap();
    for line in lines.lines().filter(|line| !line.is_empty()) {
        let key = line.split_inclusive('=').next().unwrap();
        let there = text.lines().filter(|old| line.contains('=') && old.starts_with(key)).collect::<Vec<_>>();
        assert!(there.len() < 2, "{key:?} stands more than once");
        match there.first().map(|old| (*old).to_owned()) {
            Some(old) => text = text.replacen(&old, line, 1),
            None => writeln!(text, "{line}").unwrap(),
        }
    }
    fs::write(file, text).unwrap();
}

/// Follows a page: what it should say instead, and the faults that were found.
fn follow(page: &str) -> (String, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let (mut new, mut wrong, mut kept) = (String::new(), Vec::new(), 0);
    let is_run = |info: &str| match info.strip_prefix("console") {
        Some("") => true,
        Some(rest) => rest.strip_prefix(",needs=").is_some_and(|tool| {
            let paths = std::env::var_os("PATH").unwrap_or_default();
            std::env::split_paths(&paths).any(|path| path.join(tool).exists())
        }),
        None => false,
    };
    for block in blocks(page) {
        if let Some((_, path)) = block.info.split_once(",file=") {
            fs::write(folder.path().join(path), &block.text).unwrap();
        } else if let Some((_, path)) = block.info.split_once(",edit=") {
            edit(&folder.path().join(path), &block.text);
        } else if is_run(&block.info) {
            new.push_str(&page[kept..block.at.start]);
            kept = block.at.end;
            for Step { command, expected } in steps(&block.text) {
                let printed = typed(&command, folder.path());
                let lines: Vec<&str> = printed.lines().collect();
                let as_told = agree(&expected, &lines);
                if !as_told {
                    wrong.push(format!("$ {command}\n{printed}is not\n{}", expected.join("\n")));
                }
                writeln!(new, "$ {}", command.replace('\n', "\n> ")).unwrap();
                let shown = if as_told { expected } else { lines };
                shown.iter().for_each(|line| writeln!(new, "{line}").unwrap());
            }
        }
    }
    new.push_str(&page[kept..]);
    (new, wrong)
}

/// All pages of the book that have something to type.
fn pages() -> Vec<PathBuf> {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../doc");
    let folders = [book.clone(), book.join("walks"), book.join("makers")];
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .filter(|path| fs::read_to_string(path).unwrap().contains("```console"))
        .collect();
    pages.sort();
    pages
}

#[test]
fn every_page_prints_what_it_shows() {
    let only = std::env::var("DRIVELINE_PAGE").unwrap_or_default();
    let mut faults = Vec::new();
    let pages = pages();
    assert!(pages.len() > 5, "{pages:?}");
    for path in pages.iter().filter(|path| path.ends_with(&only) || only.is_empty()) {
        let page = fs::read_to_string(path).unwrap();
        let (new, wrong) = follow(&page);
        faults.extend(wrong.into_iter().map(|fault| format!("{}:\n{fault}", path.display())));
        if std::env::var_os("DRIVELINE_WRITE").is_some() {
            fs::write(path, new).unwrap();
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
}

/// The runner itself finds what is wrong.
#[test]
fn a_page_that_is_wrong_is_found() {
    let page = |printed: &str| format!("```toml,file=a.toml\nb = 1\n```\n```console\n$ cat a.toml\n{printed}```\n");
    assert!(follow(&page("b = 1\n")).1.is_empty());
    assert!(follow(&page("...\n")).1.is_empty());
    for wrong in ["", "b = 2\n", "b = 1\nc\n", "...\nb\n"] {
        let (new, faults) = follow(&page(wrong));
        assert_eq!((faults.len(), new), (1, page("b = 1\n")), "{wrong:?}");
    }
    assert!(follow("```console\n$ exit 2\n? 2\n```\n").1.is_empty());
    assert_eq!(follow("```console\n$ exit 2\n```\n").1.len(), 1);
}
