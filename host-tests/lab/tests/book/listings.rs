//! The five drives of the book as a reader counts them: lines that are not blank, and names that they import or
//! implement. A prelude's glob is one name.

use crate::pages::Page;

const LISTINGS: [&str; 5] =
    ["README.md", "doc/hoist.md", "doc/rolling-mill.md", "doc/generator-set.md", "doc/self-balancing.md"];

/// Names of a `use`: the leaves of its tree.
fn leaves(tree: &str) -> usize {
    tree.split(['{', '}', ',', ';']).filter(|part| !part.trim().is_empty() && !part.trim().ends_with("::")).count()
}

#[test]
fn five_drives_fit_on_twenty_lines() {
    for path in LISTINGS {
        let page = Page::read(path);
        let (_, text) = page.fences.iter().find(|(word, _)| word == "rust").unwrap();
        let shown: Vec<&str> =
            text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with("# ")).map(str::trim).collect();
        let imported: usize = shown.iter().filter_map(|line| line.strip_prefix("use ")).map(leaves).sum();
        let implemented = text.matches("impl").count() + text.matches("const ").count();
        assert!(shown.len() <= 20, "{path}: {} lines", shown.len());
        assert!(imported + implemented <= 15, "{path}: {} names", imported + implemented);
    }
}
