//! The longest path through ordered elements, and the path itself.

use std::collections::BTreeMap;

use crate::graph::Graph;
use crate::loops::Element;

/// A stretch of the longest path: instructions one after the other, executed `times` times.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    pub function: String,
    /// Depth of calls below the requested function.
    pub depth: usize,
    /// The first instruction.
    pub from: u32,
    /// The address after the last.
    pub to: u32,
    pub instructions: u64,
    /// How often the path goes through them.
    pub times: u64,
}

/// The most instructions up to and with an instruction.
#[derive(Clone, Debug)]
struct Best {
    weight: u64,
    from: Option<u32>,
    /// Of a loop's entry: the turns before the last.
    earlier: Option<(u64, Longest, u32)>,
}

/// The longest ways to the instructions of a function or of a loop's turn.
#[derive(Clone, Debug)]
pub struct Longest(BTreeMap<u32, Best>);

impl Longest {
    /// Through the elements. They have the `weight` of an instruction behind another, its callee included, and the
    /// `turns` of a loop by its entry. The first has none before it.
    pub fn through(
        graph: &Graph,
        elements: &[Element],
        weight: &impl Fn(Option<u32>, u32) -> u64,
        turns: &impl Fn(u32) -> u64,
    ) -> Self {
        let mut longest = Longest(BTreeMap::new());
        for element in elements {
            match element {
                Element::Instruction(at) => {
                    let (weight, from) = longest.to(graph, *at, weight);
                    longest.0.insert(*at, Best { weight, from, earlier: None });
                }
                Element::Loop { entry, body } => {
                    let turn = Longest::through(graph, body, weight, turns);
                    let (entered, from) = longest.to(graph, *entry, weight);
                    let (again, last) = turn.to(graph, *entry, weight);
                    // each turn's weight is that behind its entry
                    let first = turn.0.get(entry).map_or(0, |best| best.weight);
                    let repeats = turns(*entry).saturating_sub(1);
                    for (at, best) in &turn.0 {
                        let weight = entered + repeats * (again - first) + (best.weight - first);
                        longest.0.insert(*at, Best { weight, ..best.clone() });
                    }
                    if let Some(best) = longest.0.get_mut(entry) {
                        best.from = from;
                        best.earlier = last.filter(|_| repeats > 0).map(|last| (repeats, turn, last));
                    }
                }
            }
        }
        longest
    }

    /// The most instructions up to and with one, and the one before it.
    fn to(&self, graph: &Graph, at: u32, weight: &impl Fn(Option<u32>, u32) -> u64) -> (u64, Option<u32>) {
        let from = graph.nodes.get(&at).into_iter().flat_map(|node| &node.from);
        let known = from.filter_map(|from| Some((self.0.get(from)?.weight + weight(Some(*from), at), Some(*from))));
        known.max_by_key(|(weight, _)| *weight).unwrap_or((weight(None, at), None))
    }

    /// The most instructions, and the last of them.
    pub fn most(&self) -> (u64, u32) {
        let ends = self.0.iter().map(|(at, best)| (best.weight, *at));
        ends.max_by_key(|(weight, _)| *weight).unwrap_or((0, 0))
    }

    /// The instructions of the longest path to one, each with how often it is executed.
    pub fn path(&self, to: u32) -> Vec<(u32, u64)> {
        let mut backwards = Vec::new();
        let mut at = Some(to);
        while let Some((here, best)) = at.and_then(|at| Some((at, self.0.get(&at)?))) {
            backwards.push((here, 1));
            if let Some((repeats, turn, last)) = &best.earlier {
                let turn = turn.path(*last).into_iter().rev();
                backwards.extend(turn.map(|(at, times)| (at, times * repeats)));
            }
            at = best.from;
        }
        backwards.reverse();
        backwards
    }
}
