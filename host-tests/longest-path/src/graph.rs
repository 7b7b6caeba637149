//! The control-flow graph of one function, an instruction a node, with the depth of the stack at each.

use std::collections::BTreeMap;

use crate::code::{Code, Function};
use crate::instruction::{Flow, Instruction, PC, Stack, address};
use crate::refusal::Refusal;

/// `nop`, A7.7.88, as an entry of a jump table.
const NOP: u32 = 0xbf00;

/// An instruction that execution can reach.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its bytes.
    pub size: u32,
    /// Its halfwords; the second is zero in a short one.
    pub code: (u16, u16),
    /// Whether it jumps into another function and leaves the return to it.
    pub hands_over: bool,
    /// Whether it may be skipped.
    pub conditional: bool,
    /// Addresses in the same function where execution goes on.
    pub next: Vec<u32>,
    /// Addresses in the same function from where execution comes.
    pub from: Vec<u32>,
    /// The function that it calls, to return or not.
    pub calls: Option<u32>,
    /// Bytes of stack before it.
    before: i32,
    /// Bytes of stack after it, where a callee begins.
    pub after: i32,
}

#[derive(Clone, Debug)]
pub struct Graph {
    pub function: Function,
    /// By address.
    pub nodes: BTreeMap<u32, Node>,
    /// Most bytes of stack at an instruction, callees apart.
    pub depth: i32,
}

/// A place to go on from: the address, how many instructions of an `IT` block are left, the stack.
type Open = (u32, u8, i32);

impl Graph {
    /// Follows every branch from a function's beginning.
    pub fn of(code: &Code, function: &Function) -> Result<Self, Refusal> {
        let mut graph = Graph { function: function.clone(), nodes: BTreeMap::new(), depth: 0 };
        let mut open: Vec<Open> = vec![(function.start, 0, 0)];
        while let Some(here) = open.pop() {
            if let Some(known) = graph.nodes.get(&here.0) {
                if known.before != here.2 {
                    return Err(Refusal::Stack { function: graph.name(), at: here.0 });
                }
                continue;
            }
            open.extend(graph.visit(code, here)?);
        }
        let edges: Vec<_> = graph.nodes.iter().flat_map(|(at, node)| node.next.iter().map(|to| (*at, *to))).collect();
        for (at, to) in edges {
            if let Some(node) = graph.nodes.get_mut(&to) {
                node.from.push(at);
            }
        }
        graph.depth = graph.nodes.values().map(|node| node.before.max(node.after)).max().unwrap_or(0);
        Ok(graph)
    }

    /// Whether an instruction is the next one behind another.
    pub fn goes_on(&self, from: u32, to: u32) -> bool {
        self.nodes.get(&from).is_some_and(|node| from + node.size == to)
    }

    /// Whether the target of a branch is fetched on the way from one instruction to another, be it taken or not.
    pub fn fetches_target(&self, from: u32, to: u32) -> bool {
        let branches = |node: &Node| {
            matches!(Instruction::decode(from, node.code.0, node.code.1).flow, Flow::Branch { .. })
                && node.calls.is_none()
        };
        !self.goes_on(from, to) || self.nodes.get(&from).is_some_and(branches)
    }

    fn name(&self) -> String {
        self.function.readable()
    }

    /// Adds the instruction at an address and gives the places to go on from.
    fn visit(&mut self, code: &Code, (at, in_it, before): Open) -> Result<Vec<Open>, Refusal> {
        let function = self.name();
        let inside = self.function.start..self.function.end;
        let none = || Refusal::NoCode { function: function.clone(), at };
        let first = code.halfword(at).filter(|_| inside.contains(&at)).ok_or_else(none)?;
        let second = if Instruction::is_long(first) { code.halfword(at + 2).ok_or_else(none)? } else { 0 };
        let Instruction { size, flow, stack } = Instruction::decode(at, first, second);
        let conditional = in_it > 0;
        let after = match stack {
            Stack::Same => before,
            // a pop that may not take place is followed where it does
            Stack::Grows(bytes) if !conditional || flow == Flow::Return => before + bytes,
            _ => return Err(Refusal::Stack { function, at }),
        };
        let behind = (at + size, in_it.saturating_sub(1), if flow == Flow::Return { before } else { after });
        let (mut open, mut calls) = (Vec::new(), None);
        match flow {
            Flow::Next => open.push(behind),
            Flow::It { instructions } => open.push((at + size, instructions, after)),
            Flow::Branch { target, conditional: by_itself } => {
                if inside.contains(&target) {
                    open.push((target, 0, after));
                } else if code.at(target).is_some() {
                    calls = Some(target);
                } else {
                    return Err(Refusal::IntoFunction { function, at, target });
                }
                open.extend((by_itself || conditional).then_some(behind));
            }
            Flow::Call { target } => {
                calls = Some(target);
                open.push(behind);
            }
            Flow::Return if after != 0 => return Err(Refusal::Stack { function, at }),
            Flow::Return => open.extend(conditional.then_some(behind)),
            Flow::Trap => {}
            Flow::Table { wide, base } => {
                let origin = at + size;
                let table = if base == PC {
                    origin
                } else {
                    // the instruction before puts the table's address into the register
                    let before = at - 4;
                    let known = code.halfword(before).zip(code.halfword(before + 2));
                    let known = known.and_then(|(first, second)| address(before, first, second));
                    let known = known.filter(|(register, _)| *register == base && self.nodes.contains_key(&before));
                    known.ok_or_else(|| Refusal::Indirect { function: function.clone(), at })?.1
                };
                let end = code.constants_at(table).filter(|end| *end <= self.function.end).ok_or_else(none)?;
                let entry = if wide { 2 } else { 1 };
                let mut targets = Vec::new();
                for place in (table..end).step_by(entry) {
                    let bytes = code.data(place, entry).ok_or_else(none)?;
                    let forward = bytes.iter().rev().fold(0, |sum, byte| sum << 8 | u32::from(*byte));
                    targets.push(origin + 2 * forward);
                }
                // zeros and `nop`s behind the last entry fill up to where the code goes on: as entries they would lead
                // to the table itself, and far behind the function
                let nop = origin + 2 * NOP;
                while targets.last().is_some_and(|last| *last == origin || *last == nop && nop >= self.function.end) {
                    targets.pop();
                }
                open.extend(targets.into_iter().map(|target| (target, 0, after)));
            }
            Flow::Unknown => return Err(Refusal::Indirect { function, at }),
        }
        let hands_over = calls.is_some() && matches!(flow, Flow::Branch { .. });
        let next = open.iter().map(|(to, ..)| *to).collect();
        self.nodes.insert(
            at,
            Node { size, code: (first, second), hands_over, conditional, next, from: Vec::new(), calls, before, after },
        );
        Ok(open)
    }
}
