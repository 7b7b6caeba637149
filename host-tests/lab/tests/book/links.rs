//! Links, and the paths of the repository that a page names.

use std::collections::HashSet;
use std::fs;
use std::path::Path;

use super::pages::{Page, all, root};

/// Every relative link leads to a file, and its anchor to a heading of that file.
#[test]
fn every_link_leads_somewhere() {
    let mut dead = Vec::new();
    for page in all() {
        let folder = page.path.parent().unwrap().to_owned();
        for link in page.links.iter().filter(|link| !link.contains("://")) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.path.clone() } else { folder.join(file) };
            let leads = root().join(&target).exists()
                && (anchor.is_empty()
                    || Page::read(target.to_str().unwrap()).sections.iter().any(|section| section.anchor == anchor));
            if !leads {
                dead.push(format!("{}: {link}", page.path.display()));
            }
        }
    }
    assert!(dead.is_empty(), "links that lead nowhere:\n{}", dead.join("\n"));
}

/// A path in backticks that begins with a folder of the repository is one of its files or folders.
#[test]
fn every_path_that_a_page_names_is_there() {
    const FOLDERS: [&str; 6] = ["src/", "firmware/", "host-tests/", "doc/", "examples/", ".ci/"];
    let mut dead = Vec::new();
    for page in all() {
        for code in &page.code {
            let path = code.split(['#', ':']).next().unwrap_or_default();
            let ours = FOLDERS.iter().any(|folder| path.starts_with(folder)) && !path.contains([' ', '*', '<', '{']);
            // a name in capitals stands for any: `src/NAME.rs`
            let any = path
                .split(['/', '.'])
                .any(|part| part.len() > 1 && part.chars().all(|c| c.is_ascii_uppercase() || c == '_'));
            if ours && !any && !root().join(path).exists() {
                dead.push(format!("{}: {path}", page.path.display()));
            }
        }
    }
    assert!(dead.is_empty(), "paths that are not there:\n{}", dead.join("\n"));
}

/// The table of contents lists every page once, and nothing else.
#[test]
fn the_table_of_contents_is_complete() {
    let mut listed = Page::read("doc/SUMMARY.md").links;
    let names = |folder: &'static str| {
        let entries = fs::read_dir(root().join("doc").join(folder)).unwrap();
        entries.map(move |entry| format!("{folder}{}", entry.unwrap().file_name().to_str().unwrap()))
    };
    let mut pages: Vec<String> = ["", "walks/"].into_iter().flat_map(names).collect();
    pages.retain(|name| name.ends_with(".md") && name != "SUMMARY.md");
    listed.sort();
    pages.sort();
    assert_eq!(listed, pages);
}

/// A type that a page names in backticks is one of the tree: a word in capitals and small letters.
#[test]
fn every_type_that_a_page_names_is_there() {
    let mut words = HashSet::new();
    for folder in ["src", "hal/src", "firmware/src", "host-tests"] {
        sources(&root().join(folder), &mut words);
    }
    let mut unknown = Vec::new();
    // the glossary has the names that were given up
    for page in all().into_iter().filter(|page| !page.path.ends_with("glossary.md")) {
        for code in &page.code {
            let name =
                code.split(['<', '(', '{', '[']).next().unwrap_or_default().split("::").last().unwrap_or_default();
            let of_a_type = name.starts_with(|c: char| c.is_ascii_uppercase())
                && name.contains(|c: char| c.is_ascii_lowercase())
                && name.chars().all(char::is_alphanumeric);
            if of_a_type && !words.contains(name) {
                unknown.push(format!("{}: {code}", page.path.display()));
            }
        }
    }
    assert!(unknown.is_empty(), "types that are not there:\n{}", unknown.join("\n"));
}

/// Every word of the Rust sources in a folder.
fn sources(folder: &Path, words: &mut HashSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, words);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            words.extend(text.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::to_owned));
        }
    }
}
