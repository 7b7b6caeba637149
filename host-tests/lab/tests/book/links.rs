//! Links, and the paths of the repository that a page names.

use std::fs;

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
