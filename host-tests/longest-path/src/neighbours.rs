//! Cycles of an instruction behind another one: what the cores' manuals and public measurements say of pairs.
//!
//! On the Cortex-M3 and M4; the M0 and M0+ have no such rules. Pages are those of Arm DDI 0337I (M3) and DDI 0439D (M4).
//! *Measured* is "pipeline cycle test" of `jnk0le/random` (STM32F103 and STM32F407, CC0), *alignment* the rules measured
//! at compendium.i-0.nl (M4).
//!
//! - **Address made by the instruction before**: one more (3-9; 3-12; measured). If a load made it, or an instruction
//!   that may be skipped, or if it is the stack pointer, the manuals are silent: none or one.
//! - **Load behind a load**: one less, unless the first makes the address of the second (3-9; 3-12). Wide ones off a word
//!   boundary might not pair (note b of table 3-1; measured), nor might loads of two memories or indexed ones (measured):
//!   one less or none.
//! - **Store**: at a constant offset always 1, at one in a register 2, or 1 behind a load (3-9; 3-11). Behind a load the
//!   first may take nothing (measured), and one that writes its base back may take 2 on the M3 (measured).
//! - **Load behind a store**: none or one more (3-9; 3-12; measured).
//! - **Load of a constant among the code**: none or one more, by contention with the fetch (3-9; 3-12).
//! - **NOP behind a load or an indexed store**: none or 1 (measured).
//! - **IT**: folded into a short instruction before it, 1 otherwise (note d of table 3-1).
//! - **Result of the floating-point unit** that the next instruction uses, but not as an addend: one more (7-6).
//! - **Branch not taken** whose target is fetched early: none or one more (DDI 0337G 1-15; measured).
//! - **Branch taken**, P: 1 to 3 by the alignment and width of the target and by whether its address is known early
//!   (table 3-1). That of a branch to a constant address is (DDI 0337G 15-7). A wide target off a word boundary takes one
//!   more (alignment). So P is 1 or 2, and 2 or 3 to such a target.
//! - **Third of three wide instructions off a word boundary**: none or one more (DDI 0337G 1-15; measured; alignment).
//!   The two before it must take a cycle each, or the fetch catches up.

use crate::cycles::{Core, Cycles, between, exactly};
use crate::graph::{Graph, Node};
use crate::instruction::{Flow, Instruction};
use crate::operands::{Kind, Operands, SP, bit};

/// Instructions of a graph on a core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Neighbours<'g> {
    pub graph: &'g Graph,
    pub core: Core,
}

impl Neighbours<'_> {
    /// Of the instruction at `at` behind that at `before`, the branch between them included; at the beginning of a
    /// function behind none.
    pub(crate) fn cycles(&self, before: Option<u32>, at: u32) -> Cycles {
        let Some(node) = self.graph.nodes.get(&at) else { return exactly(0) };
        let all = self.executed(before, at, node);
        // skipped it takes one
        let all = if node.conditional { between(all.least.min(1), all.most) } else { all };
        all + before.map_or(exactly(0), |before| self.branch(before, at)) + self.fetched(before, at)
    }

    /// Without branch and fetch.
    fn executed(&self, before: Option<u32>, at: u32, node: &Node) -> Cycles {
        let all = self.befores(before, at, 0).into_iter().map(|before| self.core.behind(before, (at, node)));
        all.reduce(Cycles::or).unwrap_or_default()
    }

    /// The instructions that may be executed right before the one at `at`: an IT or a NOP that takes no cycle is looked
    /// through. None is a branch or a call.
    fn befores(&self, before: Option<u32>, at: u32, depth: u32) -> Vec<Option<(u32, &Node)>> {
        let found = before.and_then(|before| Some((before, self.graph.nodes.get(&before)?)));
        let Some((from, node)) = found.filter(|(from, node)| node.calls.is_none() && self.graph.goes_on(*from, at))
        else {
            return vec![None];
        };
        let mut all = vec![Some((from, node))];
        let kind = Operands::of(node.code.0, node.code.1).kind;
        let is_short = |at: &&u32| self.graph.nodes.get(at).is_some_and(|node| node.size == 2);
        if depth < 4 && matches!(kind, Kind::It | Kind::Nop) {
            let further = node.from.iter().filter(|further| kind == Kind::Nop || is_short(further));
            all.extend(further.flat_map(|further| self.befores(Some(*further), from, depth + 1)));
        }
        all
    }

    /// What a branch before adds, taken or not.
    fn branch(&self, before: u32, at: u32) -> Cycles {
        let Some(node) = self.graph.nodes.get(&before) else { return exactly(0) };
        let (first, second) = node.code;
        let goes_on = self.graph.goes_on(before, at);
        let (target, may_not) = match Instruction::decode(before, first, second).flow {
            Flow::Branch { target, conditional } => (Some(target), conditional || node.conditional),
            _ => (None, node.conditional),
        };
        let is_taken = !goes_on || target == Some(at);
        // CBZ and CBNZ branch when they are executed
        let is_early = target.is_some() && first & 0xf500 != 0xb100 && !self.core.is_small();
        let taken = if is_early {
            let crosses = self.graph.nodes.get(&at).is_some_and(|target| target.size == 4 && !at.is_multiple_of(4));
            exactly(u64::from(crosses)) + between(1, 2)
        } else {
            self.core.taken()
        };
        let not_taken = between(0, u64::from(is_early));
        match (is_taken, goes_on && may_not) {
            (true, false) => taken,
            (true, true) => taken.or(not_taken),
            (false, _) => not_taken,
        }
    }

    /// What a fetch that falls behind adds.
    fn fetched(&self, before: Option<u32>, at: u32) -> Cycles {
        let crosses = |at: u32| self.graph.nodes.get(&at).filter(|node| node.size == 4 && !at.is_multiple_of(4));
        let takes = |at: u32| crosses(at).map(|node| self.least_and_most(at, node));
        let in_a_row = before == Some(at.wrapping_sub(4)) && crosses(at).is_some();
        let two = takes(at.wrapping_sub(4)).zip(takes(at.wrapping_sub(8)));
        let fills = takes(at.wrapping_sub(12)).is_none_or(|cycles| cycles.most > 1);
        match two {
            Some((last, other)) if in_a_row && fills && !self.core.is_small() => {
                between(0, u64::from(last.least <= 1 && other.least <= 1))
            }
            _ => exactly(0),
        }
    }

    /// Behind any instruction that can be before.
    fn least_and_most(&self, at: u32, node: &Node) -> Cycles {
        let all = node.from.iter().map(|before| self.executed(Some(*before), at, node));
        all.reduce(Cycles::or).unwrap_or_else(|| self.core.behind(None, (at, node)))
    }
}

impl Core {
    /// Of an instruction behind another; behind none where a branch is between them.
    fn behind(self, before: Option<(u32, &Node)>, (at, node): (u32, &Node)) -> Cycles {
        let (first, second) = node.code;
        let alone = Cycles::of(self, first, second);
        if self.is_small() {
            return alone;
        }
        let here = Operands::of(first, second);
        let contention = between(0, u64::from(here.is_literal()));
        let Some((from, before)) = before else {
            return match here.kind {
                Kind::It => between(0, 1),
                _ => alone + contention,
            };
        };
        let known = Operands::of(before.code.0, before.code.1);
        let surely = !before.conditional;
        let is_store = matches!(known.kind, Kind::Store | Kind::StoreIndexed);
        let makes_address = known.writes & here.address != 0;
        let of_one_memory = known.address == here.address && !known.indexed && !here.indexed;
        let aligned = |at: u32, node: &Node| node.size == 2 || at.is_multiple_of(4);
        let alone = match here.kind {
            Kind::It => between(u64::from(before.size == 4), 1),
            Kind::Nop if matches!(known.kind, Kind::Load | Kind::StoreIndexed) => between(0, 1),
            Kind::Load if known.kind == Kind::Load && !makes_address => {
                let pairs = of_one_memory && surely && aligned(from, before) && aligned(at, node);
                between(1, if pairs { 1 } else { 2 })
            }
            Kind::StoreIndexed if known.kind == Kind::Load && !makes_address => between(1, 2),
            Kind::Store if known.kind == Kind::Load => between(0, if here.indexed && self == Core::M3 { 2 } else { 1 }),
            Kind::Load | Kind::Several { loads: true } | Kind::Float { loads: true } if is_store => {
                alone + between(0, 1)
            }
            _ => alone,
        };
        let address = match makes_address {
            true => {
                let is_told = known.kind == Kind::Data && surely && known.writes & here.address & !bit(SP) != 0;
                between(u64::from(is_told), 1)
            }
            false => exactly(0),
        };
        let result = match known.kind == Kind::Arithmetic && known.float_writes & here.float_reads != 0 {
            true => between(u64::from(surely), 1),
            false => exactly(0),
        };
        alone + contention + address + result
    }
}
