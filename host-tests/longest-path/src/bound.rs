//! Bounds of functions over the graph of their calls.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::code::{Code, Function};
use crate::cycles::{Core, Cycles};
use crate::flash::Flash;
use crate::graph::Graph;
use crate::instruction::{Flow, Instruction};
use crate::loops::{entries, ordered};
use crate::neighbours::Neighbours;
use crate::path::{Longest, Piece};
use crate::refusal::Refusal;

/// Upper bounds of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bound {
    /// Instructions on the longest path, the return included.
    pub instructions: u64,
    /// Bytes of stack on the deepest one.
    pub stack: u32,
}

/// The stated turns of loops, by function: a number for each loop, by the address of its first instruction.
#[derive(Clone, Debug, Default)]
pub struct Loops(BTreeMap<String, Vec<u64>>);

impl Loops {
    /// States the turns of a function's loops.
    pub fn state(&mut self, function: &str, turns: Vec<u64>) {
        self.0.insert(function.into(), turns);
    }
}

/// A function that has a bound.
#[derive(Debug)]
struct Bounded {
    graph: Graph,
    longest: Longest,
    bound: Bound,
}

/// Bounds of a program's functions, each found once.
#[derive(Debug)]
pub struct Bounds<'c> {
    code: &'c Code,
    loops: &'c Loops,
    known: BTreeMap<u32, Result<Rc<Bounded>, Refusal>>,
    /// Functions whose callees are being bounded.
    open: Vec<u32>,
    /// The core and the flash whose most cycles are the weight of an instruction; without them it is 1.
    clock: Option<(Core, Flash)>,
}

impl<'c> Bounds<'c> {
    /// Of some code, with the stated turns of its loops.
    pub fn new(code: &'c Code, loops: &'c Loops) -> Self {
        Bounds { code, loops, known: BTreeMap::new(), open: Vec::new(), clock: None }
    }

    /// The cycles of a call from its first instruction to its return. The most is a bound, of the path with the most
    /// cycles on that flash; the least is that of the same path without wait states.
    pub fn cycles(code: &'c Code, loops: &'c Loops, core: Core, flash: Flash, start: u32) -> Result<Cycles, Refusal> {
        let mut bounds = Bounds { clock: Some((core, flash)), ..Bounds::new(code, loops) };
        let most = bounds.of(start)?.instructions;
        Ok(Cycles { least: bounds.least(core, start & !1)?, most })
    }

    /// The least cycles of the path with the most.
    fn least(&mut self, core: Core, start: u32) -> Result<u64, Refusal> {
        let here = self.bounded(start)?;
        let neighbours = Neighbours { graph: &here.graph, core };
        let mut before = None;
        let mut sum = 0;
        for (at, times) in here.longest.path(here.longest.most().1) {
            let Some(node) = here.graph.nodes.get(&at) else { continue };
            // in a loop the instruction before may be one or the other
            let further = node.from.iter().filter(|_| times > 1).map(|from| Some(*from));
            let all = further.chain([before]).map(|before| neighbours.cycles(before, at).least);
            sum += times * all.min().unwrap_or(0);
            // a jump into another function on a condition need not be taken
            if let Some(target) = node.calls.filter(|_| !node.hands_over || node.next.is_empty()) {
                sum += times * (self.least(core, target)? + if node.hands_over { core.taken().least } else { 0 });
            }
            before = Some(at);
        }
        Ok(sum)
    }

    /// The bound of the function that begins at an address; the bit that marks Thumb code is ignored.
    ///
    /// # Errors
    /// A function that has none, or that calls one that has none.
    pub fn of(&mut self, start: u32) -> Result<Bound, Refusal> {
        Ok(self.bounded(start & !1)?.bound)
    }

    /// The longest path from an address, callees included, in the order of execution. Of a loop, all turns before the
    /// last stand before the last one.
    pub fn path(&mut self, start: u32) -> Result<Vec<Piece>, Refusal> {
        let mut pieces = Vec::new();
        self.pieces(start & !1, 1, 0, &mut pieces)?;
        Ok(pieces)
    }

    fn bounded(&mut self, start: u32) -> Result<Rc<Bounded>, Refusal> {
        if let Some(known) = self.known.get(&start) {
            return known.clone();
        }
        let function = self.code.at(start).ok_or(Refusal::NoFunction { at: start })?;
        self.open.push(start);
        let found = self.find(function).map(Rc::new);
        self.open.pop();
        self.known.insert(start, found.clone());
        found
    }

    fn find(&mut self, function: &Function) -> Result<Bounded, Refusal> {
        let graph = Graph::of(self.code, function)?;
        if let Some((core, _)) = self.clock
            && let Some((&at, _)) = graph.nodes.iter().find(|(_, node)| !core.has(node.code.0, node.code.1))
        {
            return Err(Refusal::OtherCore { function: function.readable(), at });
        }
        let mut callees = BTreeMap::new();
        for (&at, node) in &graph.nodes {
            let Some(target) = node.calls else { continue };
            if self.open.contains(&target) {
                return Err(Refusal::Recursion { function: function.readable(), at });
            }
            callees.insert(at, self.bounded(target)?.bound);
        }
        let elements = ordered(&graph)?;
        let turns = self.turns(function, entries(&elements).into_iter().collect())?;
        let weight = |before: Option<u32>, at: u32| {
            let called = callees.get(&at).map_or(0, |it: &Bound| it.instructions);
            let Some((node, (core, flash))) = graph.nodes.get(&at).zip(self.clock) else { return 1 + called };
            let leaves = node.calls.is_some() || Instruction::decode(at, node.code.0, node.code.1).flow == Flow::Return;
            // a jump into another function is taken
            let taken = if node.hands_over { core.taken().most } else { 0 };
            let goes_on = |before| core.is_small() && graph.goes_on(before, at);
            let branches = before.is_some_and(|before| graph.fetches_target(before, at) && !goes_on(before));
            let waits = flash.straight(at, node.size, node.code)
                + if leaves { flash.jump() } else { 0 }
                + if branches { flash.jump() } else { 0 };
            Neighbours { graph: &graph, core }.cycles(before, at).most + taken + waits + called
        };
        let turns = |entry| turns.get(&entry).copied().unwrap_or(1);
        let longest = Longest::through(&graph, &elements, &weight, &turns);
        let deep =
            |(at, callee): (&u32, &Bound)| graph.nodes.get(at).map_or(0, |node| node.after) + callee.stack as i32;
        let depth = callees.iter().map(deep).max().unwrap_or(0).max(graph.depth);
        let bound = Bound { instructions: longest.most().0, stack: depth.unsigned_abs() };
        Ok(Bounded { graph, longest, bound })
    }

    /// The stated turns of a function's loops.
    fn turns(&self, function: &Function, loops: Vec<u32>) -> Result<BTreeMap<u32, u64>, Refusal> {
        let name = || function.readable();
        let stated = self.loops.0.get(&name()).map_or(&[][..], Vec::as_slice);
        if stated.is_empty()
            && let Some(&at) = loops.first()
        {
            return Err(Refusal::Loop { function: name(), at, index: 0 });
        }
        if stated.len() != loops.len() {
            return Err(Refusal::NoSuchLoop { function: name(), found: loops.len(), stated: stated.len() });
        }
        Ok(loops.into_iter().zip(stated.iter().copied()).collect())
    }

    fn pieces(&mut self, start: u32, times: u64, depth: usize, pieces: &mut Vec<Piece>) -> Result<(), Refusal> {
        let here = self.bounded(start)?;
        let mut joins = false;
        for (at, repeats) in here.longest.path(here.longest.most().1) {
            let Some(node) = here.graph.nodes.get(&at) else { continue };
            let times = times * repeats;
            match pieces.last_mut() {
                Some(last) if joins && last.to == at && last.times == times => {
                    last.to += node.size;
                    last.instructions += 1;
                }
                _ => pieces.push(Piece {
                    function: here.graph.function.readable(),
                    depth,
                    from: at,
                    to: at + node.size,
                    instructions: 1,
                    times,
                }),
            }
            joins = node.calls.is_none();
            if let Some(target) = node.calls {
                self.pieces(target, times, depth + 1, pieces)?;
            }
        }
        Ok(())
    }
}
