//! Loops of a graph: its instructions in an order in which each comes after all that lead to it, a loop as one element.

use std::collections::BTreeSet;

use crate::graph::Graph;
use crate::refusal::Refusal;

/// An instruction, or a loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Element {
    Instruction(u32),
    /// Instructions that lead back to the first of them.
    Loop {
        /// Where the loop is entered.
        entry: u32,
        /// One turn, from the entry on.
        body: Vec<Element>,
    },
}

/// The elements of a graph, in order.
pub fn ordered(graph: &Graph) -> Result<Vec<Element>, Refusal> {
    let all: BTreeSet<u32> = graph.nodes.keys().copied().collect();
    elements(graph, &all, graph.function.start, false)
}

/// The entries of all loops, by address.
pub fn entries(elements: &[Element]) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for element in elements {
        if let Element::Loop { entry, body } = element {
            found.insert(*entry);
            found.extend(entries(body));
        }
    }
    found
}

/// Orders some nodes of a graph, from `entry` on; in a loop's body the way back to it does not count.
fn elements(graph: &Graph, nodes: &BTreeSet<u32>, entry: u32, in_loop: bool) -> Result<Vec<Element>, Refusal> {
    let counts = |to: &u32| nodes.contains(to) && !(in_loop && *to == entry);
    let next = |at: u32| graph.nodes.get(&at).into_iter().flat_map(|node| &node.next).copied().filter(counts);
    let mut found = Vec::new();
    for part in components(entry, &next, |at| graph.nodes.get(&at).map_or(&[], |node| &node.from)) {
        let Some(&first) = part.first() else { continue };
        if part.len() == 1 && next(first).all(|to| to != first) {
            found.push(Element::Instruction(first));
            continue;
        }
        let is_entered = |at: &u32| {
            let mut from = graph.nodes.get(at).into_iter().flat_map(|node| &node.from);
            *at == entry || from.any(|from| nodes.contains(from) && !part.contains(from))
        };
        let entered: Vec<u32> = part.iter().copied().filter(is_entered).collect();
        let [only] = entered[..] else {
            return Err(Refusal::Irreducible { function: graph.function.readable(), at: first });
        };
        found.push(Element::Loop { entry: only, body: elements(graph, &part, only, true)? });
    }
    Ok(found)
}

/// Strongly connected components of what `entry` reaches, each after all that lead to it (Kosaraju's algorithm).
fn components<'g, I: Iterator<Item = u32>>(
    entry: u32,
    next: &impl Fn(u32) -> I,
    from: impl Fn(u32) -> &'g [u32],
) -> Vec<BTreeSet<u32>> {
    // by the order in which the search leaves them
    let mut left = Vec::new();
    let mut seen = BTreeSet::from([entry]);
    let mut open = vec![(entry, next(entry))];
    while let Some((at, rest)) = open.last_mut() {
        match rest.next() {
            Some(to) if seen.insert(to) => open.push((to, next(to))),
            Some(_) => {}
            None => {
                left.push(*at);
                open.pop();
            }
        }
    }
    let mut parts: Vec<BTreeSet<u32>> = Vec::new();
    let mut taken = BTreeSet::new();
    for root in left.into_iter().rev() {
        let (mut part, mut open) = (BTreeSet::new(), vec![root]);
        while let Some(at) = open.pop() {
            if seen.contains(&at) && taken.insert(at) {
                part.insert(at);
                open.extend(from(at).iter().copied().filter(|from| next(*from).any(|to| to == at)));
            }
        }
        if !part.is_empty() {
            parts.push(part);
        }
    }
    parts
}
