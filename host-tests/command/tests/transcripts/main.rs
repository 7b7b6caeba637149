//! The book's pages as a reader follows them: what stands in a `console` block is typed, what stands under it is what
//! is printed.
//!
//! - A page begins in an empty folder, and its blocks follow each other.
//! - `$ ` begins a command for the shell, `> ` continues it. A line of `...` stands for any lines. A last line of
//!   `? CODE` is an exit code other than 0.
//! - A listing whose fence ends in `,file=PATH` is that file from there on. One in `,edit=PATH` has lines of it that
//!   replace those of the same key.
//! - A block in `console,needs=TOOL` is run where that tool is on the path.
//! - `<!-- drawn: PAGE N PICTURE -->` is a picture of the book: the N-th plot of a page that a command has written.
//!
//! With `DRIVELINE_WRITE` set a page gets what is printed, and its pictures what is drawn.

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

/// Begin of the line above a picture.
const DRAWN: &str = "<!-- drawn: ";

/// The N-th plot of a page as a file: with the colours and type that it has on the page.
fn picture(page: &str, number: usize) -> Option<String> {
    let (_, style) = page.split_once("<style>")?;
    let mut plots = page.split("<svg ").filter(|part| part.contains(r#" role="img""#));
    let (svg, _) = plots.nth(number.checked_sub(1)?)?.split_once("</svg>")?;
    let is_class = |word: &str| word.len() > 1 && svg.contains(word);
    let is_used = |line: &&str| {
        [":root", "--", "@media (prefers", "svg "].iter().any(|begin| line.starts_with(begin))
            || line.starts_with('.') && line.split(|c: char| !c.is_alphanumeric()).any(is_class)
    };
    let used: Vec<&str> = style.split_once("</style>")?.0.lines().filter(is_used).collect();
    let (root, body) = svg.split_once('>')?;
    Some(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" style=\"background:var(--sheet);font-family:sans-serif\" {root}>\
         <style>{}</style>{body}</svg>\n",
        used.join("\n")
    ))
}

/// Draws a picture anew and compares, or writes, it.
fn drawn(line: &str, folder: &Path) -> Result<(), String> {
    let words: Vec<&str> = line[DRAWN.len()..].split_whitespace().collect();
    let &[page, number, name, "-->"] = &words[..] else { return Err("expected PAGE N PICTURE".to_owned()) };
    let text = fs::read_to_string(folder.join(page)).map_err(|error| format!("{page}: {error}"))?;
    let new = number.parse().ok().and_then(|number| picture(&text, number)).ok_or("there is no such plot")?;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../doc/pictures").join(name);
    if std::env::var_os("DRIVELINE_WRITE").is_some() {
        return fs::create_dir_all(path.parent().unwrap())
            .and_then(|()| fs::write(path, new))
            .map_err(|e| e.to_string());
    }
    let is_same = fs::read_to_string(path).is_ok_and(|old| old == new);
    if is_same { Ok(()) } else { Err(format!("{page} has another plot {number} than {name}")) }
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
            Event::Html(text) if text.starts_with(DRAWN) => {
                all.push(Block { info: text.trim().to_owned(), text: String::new(), at });
            }
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
        if block.info.starts_with(DRAWN) {
            wrong.extend(drawn(&block.info, folder.path()).err().map(|why| format!("{}: {why}", block.info)));
        } else if let Some((_, path)) = block.info.split_once(",file=") {
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
    assert_eq!(follow("<!-- drawn: none.html 1 none.svg -->\n![none](pictures/none.svg)\n").1.len(), 1);
}

/// The plots of a page are counted without the keys of its legends, and keep the style of what they have.
#[test]
fn a_picture_is_a_plot_with_its_style() {
    let page = "<style>\n:root{--a:#000}\nbody{margin:0}\n.grid{stroke:var(--a)}\n.disc{fill:red}\n</style>\
        <svg aria-hidden=\"true\"><path/></svg><svg viewBox=\"0 0 9 9\" role=\"img\"><path class=\"grid\"/></svg>";
    let drawn = picture(page, 1).unwrap();
    assert!(
        drawn.contains("<style>:root{--a:#000}\n.grid{stroke:var(--a)}</style><path class=\"grid\"/></svg>"),
        "{drawn}"
    );
    assert_eq!(picture(page, 2), None);
}

/// Every picture of the book is shown where it is drawn.
#[test]
fn every_drawn_picture_is_shown() {
    let mut count = 0;
    for path in pages() {
        let page = fs::read_to_string(&path).unwrap();
        let mut lines = page.lines();
        while let Some(line) = lines.next() {
            let Some(name) = line.strip_prefix(DRAWN).and_then(|rest| rest.split_whitespace().nth(2)) else { continue };
            let shown = lines.next().unwrap_or_default();
            let is_shown = shown.starts_with("![") && shown.ends_with(&format!("pictures/{name})"));
            assert!(is_shown, "{}: {line}: {shown}", path.display());
            count += 1;
        }
    }
    assert!(count >= 20, "{count} pictures");
}
