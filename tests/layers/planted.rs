//! The check itself, on sources that have the faults it looks for.

use std::path::Path;

use super::faults;
use super::tree::Tree;

/// The faults of planted sources.
fn found(sources: &[(&str, &str)]) -> Vec<String> {
    faults(&Tree::planted(sources))
}

#[test]
fn files_in_order_have_no_fault() {
    let sources = [
        ("", "mod a; mod b; pub use b::Top;"),
        ("a", "pub struct Ground;"),
        ("b", "use crate::a::Ground; pub struct Top(Ground);"),
    ];
    assert_eq!(found(&sources), Vec::<String>::new());
}

#[test]
fn two_files_that_import_each_other_are_a_circle() {
    let sources = [
        ("", "mod a; mod b;"),
        ("a", "use super::b::Top; pub struct Ground(Top);"),
        ("b", "use crate::a::Ground; pub struct Top(Box<Ground>);"),
    ];
    let faults = found(&sources);
    assert!(faults[0].contains("a imports b: Top") && faults[0].contains("b imports a: Ground"), "{faults:?}");
}

#[test]
fn a_circle_of_three_through_paths_alone_is_found() {
    let sources = [
        ("", "mod a; mod b; mod c;"),
        ("a", "pub fn go() { crate::b::go() }"),
        ("b", "use super::c; pub fn go() { if true { c::go() } }"),
        ("c", "pub fn go() { println!(\"{:?}\", crate::a::go()) }"),
    ];
    assert!(found(&sources)[0].contains("c imports a: go"), "{:?}", found(&sources));
}

#[test]
fn a_circle_through_re_exports_is_found_where_the_items_stand() {
    let sources = [
        ("", "mod a; mod b;"),
        ("a", "mod inner; pub use inner::Item;"),
        ("a::inner", "use crate::b::Other; pub struct Item(Other);"),
        ("b", "use crate::a::Item; pub struct Other(Box<Item>);"),
    ];
    let faults = found(&sources);
    assert!(faults[0].contains("b imports a::inner: Item"), "{faults:?}");
}

#[test]
fn a_file_that_its_own_children_import_and_that_uses_them_is_a_circle() {
    let sources = [
        ("", "mod a;"),
        ("a", "mod inner; use inner::Item; pub fn say() { Item.go() }"),
        ("a::inner", "use super::say; pub struct Item; impl Item { pub fn go(&self) { say() } }"),
    ];
    assert!(found(&sources)[0].contains("a::inner imports a: say"), "{:?}", found(&sources));
}

#[test]
fn folders_may_not_import_each_other_though_no_file_does() {
    let sources = [
        ("", "mod left; mod right;"),
        ("left", "pub mod high; pub mod low;"),
        ("left::high", "use crate::right::high::Right; pub struct High(Right);"),
        ("left::low", "pub struct Low;"),
        ("right", "pub mod high;"),
        ("right::high", "use crate::left::low::Low; pub struct Right(Low);"),
    ];
    let faults = found(&sources);
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert!(faults[0].starts_with("imports that run back up") && faults[0].contains("left, right"), "{faults:?}");
}

#[test]
fn a_path_in_an_attribute_is_an_import() {
    let sources = [
        ("", "mod a; mod b;"),
        ("a", "use crate::b::Top; pub struct Ground(Top); mod as_null {}"),
        ("b", "pub struct Top { #[serde(with = \"super::a::as_null\")] x: f64 }"),
    ];
    assert!(found(&sources)[0].contains("b imports a"), "{:?}", found(&sources));
}

#[test]
fn what_is_compiled_only_for_unit_tests_does_not_count() {
    let sources = [
        ("", "mod a; mod b;"),
        ("a", "pub struct Ground; #[cfg(test)] mod tests { use crate::b::Top; fn t(_: Top) {} }"),
        ("b", "use crate::a::Ground; pub struct Top(Ground);"),
    ];
    assert_eq!(found(&sources), Vec::<String>::new());
}

/// Nor does a file of unit tests, which is read all the same.
#[test]
fn a_file_of_unit_tests_does_not_count() {
    let tree = Tree::planted(&[
        ("", "mod a; mod b;"),
        ("a", "pub struct Ground; #[cfg(test)] mod tests;"),
        ("a::tests", "use crate::b::Top; fn t(_: Top) {}"),
        ("b", "use crate::a::Ground; pub struct Top(Ground);"),
    ]);
    assert!(tree.reads(Path::new("a::tests")));
    assert_eq!(faults(&tree), Vec::<String>::new());
}

#[test]
fn names_from_elsewhere_do_not_count() {
    let sources = [
        ("", "mod a; mod b;"),
        ("a", "use foreign::b::Top; pub struct Ground(Top);"),
        ("b", "use crate::a::Ground; pub struct Top(Ground);"),
    ];
    assert_eq!(found(&sources), Vec::<String>::new());
}
