//! Stiff and extreme cases of every subject: right, or refused with a sentence.

use driveline_lab::extremes::Cases;

#[test]
fn nothing_is_wrong_without_a_word() {
    let all = Cases::all();
    println!("{all}");
    let wrong: Vec<_> = all.wrong().map(|case| (case.subject, &case.name, &case.outcome)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../doc/makers/atlas.md")).unwrap();
    assert!(page.contains(&all.summary().markdown()), "the page has other counts: cargo lab atlas --markdown");
    assert!(all.subjects.len() >= 10 && all.cases.len() >= 120, "{} of {}", all.cases.len(), all.subjects.len());
}
