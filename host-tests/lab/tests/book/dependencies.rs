//! The page of dependencies against `cargo metadata`: what is depended on, under which licence, and from where.

use std::collections::{BTreeMap, BTreeSet};
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

/// Whether a licence expression offers an allowed one: `A OR B` if either does, `A AND B` if both do.
fn offers(expression: &str, allowed: &[&str]) -> bool {
    let expression = expression.trim();
    // the expressions of the registry nest no deeper than one pair of parentheses, before an `AND`
    if let Some((left, right)) = expression.split_once(" AND ") {
        let inner = |part: &str| part.trim().trim_start_matches('(').trim_end_matches(')').to_owned();
        return offers(&inner(left), allowed) && offers(&inner(right), allowed);
    }
    expression.split(" OR ").flat_map(|part| part.split('/')).any(|part| {
        let licence = part.trim().split(" WITH ").next().unwrap_or_default();
        allowed.contains(&licence)
    })
}

/// Every package, however far down, comes from the registry and offers a licence that may be combined with ours.
#[test]
fn every_package_has_an_allowed_licence_and_comes_from_the_registry() {
    let (all, rules) = (all_metadata(), rules());
    let (usual, exceptions) = (words(&rules["licenses"]["allow"]), exceptions(&rules));
    let mut wrong = Vec::new();
    for package in all.iter().flat_map(packages).filter(|package| !is_ours(package)) {
        let (name, licence) = (text(package, "name"), text(package, "license"));
        let allowed = offers(licence, &usual) || exceptions.get(name).is_some_and(|own| offers(licence, own));
        if !allowed || !text(package, "source").starts_with("registry+https://github.com/rust-lang/crates.io-index") {
            wrong.push(format!("{name}: {licence:?}, {}", text(package, "source")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
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

/// No package has two versions but those that the rules name, and they name no other.
#[test]
fn one_version_of_each_package_but_for_those_named() {
    let arguments = ["tree", "--workspace", "--all-features", "--locked", "--duplicates", "--depth=0", "--prefix=none"];
    let output = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    // the same version for the host's programs and for the target is one
    let tree = String::from_utf8(output.stdout).unwrap();
    let mut found: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (name, version) in tree.lines().filter_map(|line| line.split_once(" v")) {
        found.entry(name).or_default().insert(version.split(' ').next().unwrap_or_default());
    }
    found.retain(|_, versions| versions.len() > 1);
    let rules = rules();
    for one in rules["bans"]["skip"].as_array().unwrap() {
        let (name, version) = one["crate"].as_str().unwrap().split_once('@').unwrap();
        assert!(found.get_mut(name).is_some_and(|all| all.remove(version)), "{name}@{version} is named, and is none");
    }
    found.retain(|_, versions| versions.len() > 1);
    assert!(found.is_empty(), "{found:?}: several versions that .cargo/deny.toml does not name");
}

#[test]
fn an_expression_offers_what_it_says() {
    let mit = ["MIT"];
    for good in ["MIT", "Apache-2.0 OR MIT", "MIT/Apache-2.0", "(MIT OR Apache-2.0) AND MIT"] {
        assert!(offers(good, &mit), "{good}");
    }
    for bad in ["", "GPL-3.0", "MIT-0", "MIT AND GPL-3.0", "(Apache-2.0 OR MIT) AND BSD-3-Clause"] {
        assert!(!offers(bad, &mit), "{bad}");
    }
}
