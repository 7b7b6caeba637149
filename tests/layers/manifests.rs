//! What the crates may name in their manifests.

use super::workspace;

/// The lines of a manifest that are no comments.
fn manifest(package: &str) -> String {
    let path = workspace().join("host-tests").join(package).join("Cargo.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.lines().filter(|line| !line.trim_start().starts_with('#')).map(|line| format!("{line}\n")).collect()
}

/// Names of the packages that a manifest depends on, in whichever table.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut table = "";
    let mut names = Vec::new();
    for line in manifest.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix('[') {
            table = name.trim_end_matches(']');
            // [dependencies.name]
            names.extend(table.rsplit_once("dependencies.").map(|(_, name)| name.to_owned()));
        } else if table.ends_with("dependencies") && !line.is_empty() {
            names.push(line.split(['.', '=', ' ']).next().unwrap_or_default().to_owned());
            names.extend(
                line.split_once("package = \"").and_then(|(_, rest)| rest.split('"').next()).map(str::to_owned),
            );
        }
    }
    names
}

#[test]
fn the_solver_shares_no_code_with_the_library() {
    let names = dependencies(&manifest("solver"));
    assert!(names.iter().any(|name| name == "nalgebra"), "{names:?}");
    assert!(!names.iter().any(|name| name.starts_with("driveline") || name == "cargo-driveline"), "{names:?}");
}

#[test]
fn the_report_knows_no_machine_and_no_scene() {
    let names = dependencies(&manifest("report"));
    assert!(names.iter().any(|name| name == "minijinja"), "{names:?}");
    assert!(!names.iter().any(|name| name.starts_with("driveline") || name == "cargo-driveline"), "{names:?}");
}

#[test]
fn the_longest_path_knows_machine_code_alone() {
    let names = dependencies(&manifest("longest-path"));
    assert!(names.iter().any(|name| name == "object"), "{names:?}");
    assert!(!names.iter().any(|name| name.starts_with("driveline") || name == "cargo-driveline"), "{names:?}");
}

#[test]
fn images_and_their_link_know_no_plant() {
    let names = dependencies(&manifest("qemu"));
    assert!(names.iter().any(|name| name == "driveline-firmware"), "{names:?}");
    assert!(!names.iter().any(|name| name == "driveline-solver" || name == "cargo-driveline"), "{names:?}");
}

#[test]
fn a_dependency_is_found_however_it_is_written() {
    let text = "[package]\nname = \"x\"\n[dependencies]\na = \"1\"\nb.workspace = true\nc = { package = \"d\" \
        }\n[dev-dependencies.e]\npath = \"f\"\n";
    assert_eq!(dependencies(text), ["a", "b", "c", "d", "e"]);
}
