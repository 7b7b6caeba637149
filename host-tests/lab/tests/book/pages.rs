//! The pages: README, CHANGELOG and the book, as headings, links, code and tables.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

/// The repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().find(|at| at.join("doc/SUMMARY.md").exists()).unwrap().into()
}

/// A page as it is read.
#[derive(Default)]
pub struct Page {
    /// Its path from the repository.
    pub path: PathBuf,
    /// Headings with their anchors, in order.
    pub sections: Vec<Section>,
    /// Targets of links and images.
    pub links: Vec<String>,
    /// Code within sentences.
    pub code: Vec<String>,
    /// Fenced code: the word after the fence, and the text.
    pub fences: Vec<(String, String)>,
}

/// A heading, and the tables under it.
#[derive(Default)]
pub struct Section {
    /// Its text.
    pub title: String,
    pub code: Vec<String>,
    /// What a link to it ends in.
    pub anchor: String,
    /// Cells of the tables, row by row; code keeps its backticks.
    pub rows: Vec<Vec<String>>,
}

impl Page {
    /// Reads a page of the repository.
    pub fn read(path: &str) -> Self {
        let text = fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        let mut page = Self { path: path.into(), sections: vec![Section::default()], ..Self::default() };
        let mut taken: HashMap<String, usize> = HashMap::new();
        let (mut heading, mut fence, mut cell) = (false, None, None);
        for event in Parser::new_ext(&text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Heading { .. }) => {
                    page.sections.push(Section::default());
                    heading = true;
                }
                Event::End(TagEnd::Heading(_)) => {
                    let section = page.section();
                    let slug = slug(&section.title);
                    let count = taken.entry(slug.clone()).or_default();
                    section.anchor = if *count == 0 { slug } else { format!("{slug}-{count}") };
                    *count += 1;
                    heading = false;
                }
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(dest_url.into_string());
                }
                Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                    fence = Some((info.into_string(), String::new()))
                }
                Event::End(TagEnd::CodeBlock) => page.fences.extend(fence.take()),
                Event::Start(Tag::TableRow) => page.section().rows.push(Vec::new()),
                Event::Start(Tag::TableCell) => cell = Some(String::new()),
                Event::End(TagEnd::TableCell) => {
                    let done = cell.take().unwrap_or_default();
                    if let Some(row) = page.section().rows.last_mut() {
                        row.push(done);
                    }
                }
                Event::Text(text) => match (&mut fence, &mut cell) {
                    (Some((_, code)), _) => code.push_str(&text),
                    (None, Some(cell)) => cell.push_str(&text),
                    (None, None) if heading => page.section().title.push_str(&text),
                    (None, None) => {}
                },
                Event::Code(code) => {
                    if let Some(cell) = &mut cell {
                        cell.push_str(&format!("`{code}`"));
                    }
                    if heading {
                        page.section().title.push_str(&code);
                        page.section().code.push(code.to_string());
                    }
                    page.code.push(code.into_string());
                }
                _ => {}
            }
        }
        page
    }

    fn section(&mut self) -> &mut Section {
        self.sections.last_mut().expect("a page begins with a section")
    }
}

/// A heading's anchor, as GitHub and mdbook make it.
fn slug(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || "_- ".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

/// The paths of README, CHANGELOG and all pages of both books.
pub fn all() -> Vec<Page> {
    let mut paths = vec!["README.md".to_owned(), "CHANGELOG.md".to_owned()];
    for folder in ["doc", "doc/walks", "doc/makers"] {
        for entry in fs::read_dir(root().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") {
                paths.push(format!("{folder}/{name}"));
            }
        }
    }
    paths.sort();
    paths.iter().map(|path| Page::read(path)).collect()
}
