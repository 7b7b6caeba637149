//! The worst of inputs that are drawn and of inputs that are sought.
//!
//! The search is that of fuzzers by coverage: an input that does something new is kept, and new ones are made from
//! those that were kept. What is new here is the number of instructions that a tick took, with the faults that it
//! raised and the number of the tick before. A drive has a state, so the ticks before belong to it: kept are the last
//! inputs up to that tick.
//!
//! New inputs are kept ones one after the other, with words that were changed: by bits, by steps around the value, to
//! the ends of the number's range, to a word that the drive gave back, to a constant of the image, where its limits
//! are. An input may also be held, left out, or be one of the built-in ones. Nothing is started anew: each round goes
//! on from the state that the last one left.

use std::collections::BTreeSet;
use std::error::Error;
use std::fs;

use driveline_firmware::Words;
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::self_test::fingerprint::SEED;
use driveline_firmware::self_test::inputs::Program as Inputs;
use object::{Object, ObjectSection};

use crate::image::Image;
use crate::link::Link;

use super::cost::variant;

/// The most instructions of a tick.
pub fn worst_drawn(image: &Image, ticks: usize) -> Result<u32, Box<dyn Error>> {
    let mut inputs = Inputs::new(SEED, variant(image)?.words());
    worst(image, ticks, |_| (0..ROUND).map(|_| inputs.next_input()).collect())
}

/// Inputs of a round, which are made before their outputs are known.
const ROUND: usize = 1024;

/// Plays rounds of inputs and gives the most instructions that a tick took.
fn worst(image: &Image, ticks: usize, mut next: impl FnMut(&[Output]) -> Vec<Input>) -> Result<u32, Box<dyn Error>> {
    let (mut link, mut most, mut done) = (Link::start(image)?, 0, 0);
    let mut outputs = Vec::new();
    while done < ticks {
        let mut inputs = next(&outputs);
        inputs.truncate(ticks - done);
        outputs = link.exchange_all(&inputs)?;
        most = outputs.iter().fold(most, |most, output| most.max(output.instructions));
        done += inputs.len();
    }
    link.finish()?;
    Ok(most)
}

/// The most instructions of a tick over inputs that are sought, equal for equal images.
pub fn worst_sought(image: &Image, ticks: usize) -> Result<u32, Box<dyn Error>> {
    let mut search = Search::new(variant(image)?.words(), constants(image)?);
    worst(image, ticks, |outputs| search.next(outputs))
}

/// The words of an image's constants.
fn constants(image: &Image) -> Result<Vec<u32>, Box<dyn Error>> {
    let bytes = fs::read(&image.path)?;
    let file = object::File::parse(&*bytes)?;
    let data = file.section_by_name(".rodata").map_or(Ok(&[][..]), |section| section.data())?;
    let words: BTreeSet<u32> = data.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect();
    Ok(words.into_iter().collect())
}

/// Inputs before a tick that are kept with it.
const BEFORE: usize = 32;
/// Runs of inputs that are kept at most, those with the most instructions.
const KEPT: usize = 512;
/// Of these, the ones that half of the draws are from.
const BEST: usize = 64;
/// Key of a panel, at most; there are none above.
const KEYS: u32 = 112;

/// A run of inputs whose last tick did something new. Angles are the steps from one input to the next.
struct Run {
    instructions: u32,
    steps: Vec<Input>,
}

struct Search {
    random: u64,
    words: Words,
    built_in: Inputs,
    /// Words at whose neighbourhood a drive may decide: constants, and its last outputs.
    constants: Vec<u32>,
    given: Vec<u32>,
    /// The last angle given, and that of the built-in inputs.
    angle: u32,
    built_in_angle: u32,
    /// The inputs of the last round behind the last ones of the round before.
    played: Vec<Input>,
    seen: BTreeSet<(u32, u32, u32)>,
    /// Instructions of the last tick.
    before: u32,
    /// By instructions, the most last.
    kept: Vec<Run>,
}

impl Search {
    fn new(words: Words, constants: Vec<u32>) -> Self {
        Search {
            random: u64::from(SEED),
            words,
            built_in: Inputs::new(SEED, words),
            constants,
            given: Vec::new(),
            angle: 0,
            built_in_angle: 0,
            played: Vec::new(),
            seen: BTreeSet::new(),
            before: 0,
            kept: Vec::new(),
        }
    }

    /// The inputs of the next round, after the outputs of the last one.
    fn next(&mut self, outputs: &[Output]) -> Vec<Input> {
        self.learn(outputs);
        let given = outputs.iter().step_by(ROUND / 16);
        self.given =
            given.flat_map(|given| [given.torque, given.motor_speed, given.shaft_torque, given.load_torque]).collect();
        self.played.drain(..self.played.len().saturating_sub(BEFORE));
        let start = self.played.len();
        while self.played.len() < start + ROUND {
            let mut run = self.run();
            self.change(&mut run);
            self.played.append(&mut run);
        }
        let place = |step: &Input| {
            self.angle = self.angle.wrapping_add(step.angle);
            Input { angle: self.angle, ..*step }
        };
        self.played[start..].iter().map(place).collect()
    }

    fn learn(&mut self, outputs: &[Output]) {
        let first = self.played.len() - outputs.len();
        for (index, output) in outputs.iter().enumerate() {
            let Output { faults, instructions, .. } = *output;
            let before = std::mem::replace(&mut self.before, instructions);
            if !self.seen.insert((instructions, before, faults)) {
                continue;
            }
            let end = first + index + 1;
            let steps = self.played[end.saturating_sub(BEFORE)..end].to_vec();
            let place = self.kept.partition_point(|run| run.instructions <= instructions);
            self.kept.insert(place, Run { instructions, steps });
            if self.kept.len() > KEPT {
                self.kept.remove(0);
            }
        }
    }

    /// A kept run, or some built-in inputs.
    fn run(&mut self) -> Vec<Input> {
        if self.kept.is_empty() || self.below(8) == 0 {
            return (0..BEFORE).map(|_| self.built_in()).collect();
        }
        let from = if self.below(2) == 0 { self.kept.len().saturating_sub(BEST) } else { 0 };
        let chosen = from + self.below(self.kept.len() - from);
        let half = self.below(2) == 0;
        let steps = &self.kept[chosen].steps;
        steps[if half { steps.len() / 2 } else { 0 }..].to_vec()
    }

    fn built_in(&mut self) -> Input {
        let input = self.built_in.next_input();
        let angle = input.angle.wrapping_sub(self.built_in_angle);
        self.built_in_angle = input.angle;
        Input { angle, ..input }
    }

    /// Changes a run, or leaves it as it is.
    fn change(&mut self, run: &mut Vec<Input>) {
        for _ in 0..self.below(5) {
            // the last ones more often than the first
            let back = self.below(run.len()).min(self.below(run.len()));
            let at = run.len() - 1 - back;
            match self.below(16) {
                0 => run[at] = self.built_in(),
                1 => {
                    run.remove(at);
                }
                2 => {
                    let times = 1 << self.below(7);
                    run.splice(at..at, std::iter::repeat_n(run[at], times).collect::<Vec<_>>());
                }
                3 => run[at].flags ^= Input::RELEASED,
                4 => run[at].flags ^= 2 << self.below(15),
                5 => {
                    let value = match self.below(3) {
                        0 => self.below(16) as u32,
                        1 => (self.below(16) as f32 * 0.25).to_bits(),
                        _ => self.word(0),
                    };
                    run[at].asked = [self.below(KEYS as usize) as u32, value];
                }
                6 => run[at].asked = [0; 2],
                7 => self.glitch(&mut run[at..]),
                8..=9 => {
                    let angle = self.step(run[at].angle);
                    self.some(&mut run[at..]).iter_mut().for_each(|step| step.angle = angle);
                }
                10..=12 => {
                    let torque = self.word(run[at].torque);
                    self.some(&mut run[at..]).iter_mut().for_each(|step| step.torque = torque);
                }
                13..=14 => {
                    let setpoint = self.word(run[at].setpoint);
                    self.some(&mut run[at..]).iter_mut().for_each(|step| step.setpoint = setpoint);
                }
                _ => {
                    let channel = self.below(2);
                    run[at].vibration[channel] = self.word(run[at].vibration[channel]);
                }
            }
            if run.is_empty() {
                run.push(self.built_in());
            }
        }
    }

    /// The first of some inputs, or all.
    fn some<'r>(&mut self, run: &'r mut [Input]) -> &'r mut [Input] {
        let count = if self.below(2) == 0 { 1 } else { run.len() };
        &mut run[..count]
    }

    /// One angle is off, or up to 64 are; behind them it is as it would have been, or has not moved.
    fn glitch(&mut self, run: &mut [Input]) {
        let doublings = self.below(7);
        let length = self.below(1 << doublings) + 1;
        let Some((next, off)) = run.get_mut(..=length).and_then(<[Input]>::split_last_mut) else { return };
        let jump = self.random() as u32;
        let turned = off.iter().fold(jump, |sum, step| sum.wrapping_add(step.angle));
        off[0].angle = off[0].angle.wrapping_add(jump);
        next.angle = if self.below(2) == 0 { next.angle.wrapping_sub(jump) } else { turned.wrapping_neg() };
    }

    /// A changed step of the angle.
    fn step(&mut self, step: u32) -> u32 {
        match self.below(6) {
            0 => 0,
            1 => step ^ 1 << self.below(32),
            2 => step.wrapping_neg(),
            3 => self.random() as u32,
            4 => step.wrapping_add((self.random() as i32 >> self.below(32)) as u32),
            _ => 1 << self.below(32),
        }
    }

    /// A changed word.
    fn word(&mut self, word: u32) -> u32 {
        match self.below(8) {
            0 => word ^ 1 << self.below(32),
            1 => word.wrapping_add(self.below(65) as u32).wrapping_sub(32),
            2 => self.opposite(word),
            3 => {
                let constant = self.of(|search| &search.constants);
                if self.below(2) == 0 { constant } else { self.share(constant) }
            }
            4 => {
                let given = self.of(|search| &search.given);
                if self.below(2) == 0 { given } else { self.opposite(given) }
            }
            5 => self.built_in.next_word(),
            6 => self.random() as u32,
            _ => self.end(),
        }
    }

    /// A part of a word.
    fn share(&mut self, word: u32) -> u32 {
        let share = self.below(65_536) as i64 - 32_768;
        match self.words {
            Words::Single => (f32::from_bits(word) * share as f32 / 32_768.0).to_bits(),
            Words::Fixed => ((i64::from(word as i32) * share) >> 15) as u32,
        }
    }

    fn opposite(&self, word: u32) -> u32 {
        match self.words {
            Words::Single => word ^ 1 << 31,
            Words::Fixed => word.wrapping_neg(),
        }
    }

    /// Zero, an end of the range, or no number.
    fn end(&mut self) -> u32 {
        let single = [0.0, f32::MAX, f32::MIN_POSITIVE, f32::from_bits(1), f32::INFINITY, f32::NAN].map(f32::to_bits);
        let fixed = [0, 1, i32::MAX as u32, i32::MIN as u32, 1 << 28, 1 << 30];
        let ends = match self.words {
            Words::Single => single,
            Words::Fixed => fixed,
        };
        let end = ends[self.below(ends.len())];
        if self.below(2) == 0 { end } else { self.opposite(end) }
    }

    /// One of some words; zero where there are none.
    fn of(&mut self, words: impl Fn(&Self) -> &Vec<u32>) -> u32 {
        let count = words(self).len();
        let chosen = self.below(count.max(1));
        words(self).get(chosen).copied().unwrap_or(0)
    }

    /// A number below another.
    fn below(&mut self, bound: usize) -> usize {
        (self.random() % bound as u64) as usize
    }

    /// 32 random bits: Steele, Lea, Flood, Fast splittable pseudorandom number generators (2014), its SplitMix64.
    fn random(&mut self) -> u64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.random ^ self.random >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ mixed >> 31) >> 32
    }
}
