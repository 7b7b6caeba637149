//! The page of dependencies against `cargo metadata`: what is depended on, under which licence, and from where.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;

use super::pages::{Page, root};

/// The crates in workspaces of their own, and what they are compiled for.
const EXAMPLES: [&str; 3] = ["examples/rtic", "examples/embassy", "host-tests/peers"];
const EXAMPLES_TARGET: &str = "thumbv7em-none-eabihf";

/// The rules, as `cargo deny` reads them.
fn rules() -> toml::Table {
    toml::from_str(&std::fs::read_to_string(root().join(".cargo/deny.toml")).unwrap()).unwrap()
}

fn words(list: &toml::Value) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect()
}

/// Packages with a licence that is allowed to them alone.
fn exceptions(rules: &toml::Table) -> BTreeMap<&str, Vec<&str>> {
    let exceptions = rules["licenses"]["exceptions"].as_array().unwrap().iter();
    exceptions.map(|one| (one["crate"].as_str().unwrap(), words(&one["allow"]))).collect()
}

/// Of the workspace.
fn metadata() -> Value {
    metadata_of(".", &format!("{}-unknown-linux-gnu", std::env::consts::ARCH))
}

/// Of the workspace and of the examples beside it.
fn all_metadata() -> Vec<Value> {
    let examples = EXAMPLES.map(|folder| metadata_of(folder, EXAMPLES_TARGET));
    [metadata()].into_iter().chain(examples).collect()
}

/// For one platform alone: what is built here is here, and nothing is fetched for others.
fn metadata_of(folder: &str, platform: &str) -> Value {
    let (manifest, platform) = (format!("{folder}/Cargo.toml"), format!("--filter-platform={platform}"));
    let arguments = ["metadata", "--format-version=1", "--locked", "--all-features", &platform];
    let arguments = [&arguments[..], &["--manifest-path", &manifest]].concat();
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn packages(metadata: &Value) -> impl Iterator<Item = &Value> {
    metadata["packages"].as_array().unwrap().iter()
}

fn is_ours(package: &Value) -> bool {
    package["source"].is_null()
}

fn text<'a>(package: &'a Value, key: &str) -> &'a str {
    package[key].as_str().unwrap_or_default()
}

/// The page lists every direct dependency, with its licence, and nothing else.
#[test]
fn the_page_lists_every_dependency_with_its_licence() {
    let all = all_metadata();
    let licences: BTreeMap<&str, &str> =
        all.iter().flat_map(packages).map(|package| (text(package, "name"), text(package, "license"))).collect();
    let mut expected = BTreeMap::new();
    for package in all.iter().flat_map(packages).filter(|package| is_ours(package)) {
        for dependency in package["dependencies"].as_array().unwrap() {
            let name = text(dependency, "name");
            if !dependency["source"].is_null() {
                expected.insert(name.to_owned(), licences[name].to_owned());
            }
        }
    }
    let page = Page::read("doc/makers/dependencies.md");
    let rows = page.sections.iter().flat_map(|section| &section.rows).filter(|row| row[0].starts_with('`'));
    let listed: BTreeMap<String, String> =
        rows.map(|row| (row[0].trim_matches('`').to_owned(), row[3].clone())).collect();
    assert_eq!(listed, expected);
}

/// What is used in tests alone stays there: the crate that reaches it is not published, and no crate of ours has it.
#[test]
fn packages_under_mpl_are_reached_from_tests_alone() {
    let metadata = metadata();
    let log = packages(&metadata).find(|package| package["name"] == "driveline-defmt-log").unwrap();
    assert_eq!(log["publish"].as_array().map(Vec::len), Some(0));
    let above = |name: &str| -> Vec<String> {
        let nodes = metadata["resolve"]["nodes"].as_array().unwrap().iter();
        let named = |id: &Value| packages(&metadata).find(|package| package["id"] == *id).map(|it| text(it, "name"));
        let has = |node: &&Value| node["dependencies"].as_array().unwrap().iter().any(|id| named(id) == Some(name));
        nodes.filter(has).filter_map(|node| named(&node["id"]).map(str::to_owned)).collect()
    };
    for name in exceptions(&rules()).into_keys() {
        assert_eq!(above(name), ["defmt-decoder"], "{name}");
    }
    assert_eq!(above("defmt-decoder"), ["driveline-defmt-log"]);
    assert!(above("driveline-defmt-log").is_empty());
}
