//! The page of scenes against the lists of scenes.

use std::collections::BTreeSet;

use driveline_firmware::scenes::VARIANTS;

use super::pages::Page;

/// Every section with a name is about a scene that can be flashed, and each of these has one.
#[test]
fn every_section_is_about_a_scene() {
    let page = Page::read("doc/makers/scenes.md");
    let told: BTreeSet<&str> = page.sections.iter().flat_map(|section| &section.code).map(String::as_str).collect();
    let there: BTreeSet<&str> = VARIANTS.iter().filter_map(|name| name.split('/').next()).collect();
    assert_eq!(told, there);
}
