//! Circles among files, and among what stands in a folder.

use std::collections::{BTreeMap, BTreeSet};

use super::imports::Imports;
use super::tree::Tree;

/// Who imports whom.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// The circles of files, each with the imports that make it.
pub fn circles(imports: &Imports) -> Vec<String> {
    let mut graph = Graph::new();
    for (from, to) in imports.keys() {
        graph.entry(from.clone()).or_default().insert(to.clone());
    }
    let tied = |circle: &BTreeSet<String>| {
        let within = imports.iter().filter(|((from, to), _)| circle.contains(from) && circle.contains(to));
        within.map(|((from, to), names)| line(from, to, names)).collect()
    };
    knots(&graph).iter().map(tied).collect()
}

/// The circles among the files and folders of each folder, each with the imports that make it.
pub fn folders(tree: &Tree, imports: &Imports) -> Vec<String> {
    // A module with files below it is a folder; its own file stands in it.
    let parents: BTreeSet<String> = tree
        .files()
        .iter()
        .filter_map(|(module, _)| module.split_last())
        .map(|(_, parent)| parent.join("::"))
        .collect();
    let place = |label: &str| -> Vec<String> {
        let module = if label == "crate" { "" } else { label };
        let names = module.split("::").filter(|name| !name.is_empty()).map(str::to_owned);
        names.chain(parents.contains(module).then(|| "(its own file)".to_owned())).collect()
    };
    let mut inside: BTreeMap<String, Graph> = BTreeMap::new();
    let mut ties: BTreeMap<(String, String, String), String> = BTreeMap::new();
    for ((from, to), names) in imports {
        let (start, end) = (place(from), place(to));
        let same = start.iter().zip(&end).take_while(|(start, end)| start == end).count();
        let (Some(left), Some(right)) = (start.get(same), end.get(same)) else { continue };
        let folder = start[..same].join("::");
        inside.entry(folder.clone()).or_default().entry(left.clone()).or_default().insert(right.clone());
        ties.entry((folder, left.clone(), right.clone())).or_default().push_str(&line(from, to, names));
    }
    let mut found = Vec::new();
    for (folder, graph) in &inside {
        for knot in knots(graph) {
            let within =
                ties.iter().filter(|((at, from, to), _)| at == folder && knot.contains(from) && knot.contains(to));
            let lines: String = within.map(|(_, lines)| lines.as_str()).collect();
            let names: Vec<&str> = knot.iter().map(String::as_str).collect();
            found.push(format!("in {folder}: {}\n{lines}", names.join(", ")));
        }
    }
    found
}

fn line(from: &str, to: &str, names: &BTreeSet<String>) -> String {
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    format!("  {from} imports {to}: {}\n", names.join(", "))
}

/// Sets of nodes that reach each other.
fn knots(graph: &Graph) -> Vec<BTreeSet<String>> {
    let reach: BTreeMap<&String, BTreeSet<&String>> = graph.keys().map(|node| (node, reached(graph, node))).collect();
    let mut knots: Vec<BTreeSet<String>> = Vec::new();
    for (node, ahead) in &reach {
        if ahead.contains(node) && !knots.iter().any(|knot| knot.contains(*node)) {
            let back = ahead.iter().filter(|other| reach.get(**other).is_some_and(|from| from.contains(node)));
            knots.push(back.map(|other| (**other).clone()).collect());
        }
    }
    knots
}

/// Everything that a node leads to.
fn reached<'a>(graph: &'a Graph, node: &'a String) -> BTreeSet<&'a String> {
    let mut found = BTreeSet::new();
    let mut ahead: Vec<&String> = graph.get(node).into_iter().flatten().collect();
    while let Some(next) = ahead.pop() {
        if found.insert(next) {
            ahead.extend(graph.get(next).into_iter().flatten());
        }
    }
    found
}
