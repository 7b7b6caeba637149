//! Records in blocks, each with the least and the most of its channels: a window of any length is found in a time that
//! does not grow with what lies in it.

use std::collections::VecDeque;
use std::sync::Arc;

use serde::Serialize;

/// Records in a block.
const BLOCK: usize = 256;

/// The last records of a drive.
#[derive(Debug)]
pub struct Store {
    /// Shared with what is being saved.
    blocks: VecDeque<Arc<Block>>,
    channels: usize,
    /// Records that are kept at most.
    keep: usize,
    kept: usize,
    /// The first tick of the drive's own count, in that of the store; it grows where the drive begins anew.
    offset: u64,
    last: Option<u64>,
    /// Records that are missing between others.
    pub missing: u64,
    /// How often the drive began to count anew.
    pub restarts: u64,
}

/// Successive records.
#[derive(Clone, Debug, Default)]
pub struct Block {
    ticks: Vec<u64>,
    /// A record after the other.
    values: Vec<f32>,
    least: Vec<f32>,
    most: Vec<f32>,
}

impl Block {
    fn records(&self, channels: usize) -> impl Iterator<Item = (u64, &[f32])> {
        self.ticks.iter().copied().zip(self.values.chunks_exact(channels.max(1)))
    }
}

/// Records from one tick to another, taken block by block.
#[derive(Debug)]
pub struct Part {
    blocks: VecDeque<Arc<Block>>,
    from: u64,
    to: u64,
    channels: usize,
}

impl Part {
    /// Those of its records that a block has.
    pub fn records<'b>(&self, block: &'b Block) -> impl Iterator<Item = (u64, &'b [f32])> + use<'b> {
        let (from, to) = (self.from, self.to);
        block.records(self.channels).filter(move |(tick, _)| (from..=to).contains(tick))
    }
}

impl Iterator for Part {
    type Item = Arc<Block>;

    fn next(&mut self) -> Option<Arc<Block>> {
        self.blocks.pop_front()
    }
}

/// A part of the records: for each of its places the least and the most of each channel since the place before.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Window {
    /// The places (ticks).
    pub ticks: Vec<u64>,
    /// The least of each channel; `null` in a gap, and where a value was none.
    pub least: Vec<Vec<Option<f32>>>,
    /// The most of each channel.
    pub most: Vec<Vec<Option<f32>>>,
}

/// Least and most of values so far. A value that is not a number changes neither.
#[derive(Clone, Debug)]
struct Range {
    least: Vec<f32>,
    most: Vec<f32>,
}

impl Range {
    fn new(channels: usize) -> Self {
        Self { least: vec![f32::INFINITY; channels], most: vec![f32::NEG_INFINITY; channels] }
    }

    fn add(&mut self, least: &[f32], most: &[f32]) {
        self.least.iter_mut().zip(least).for_each(|(of, value)| *of = of.min(*value));
        self.most.iter_mut().zip(most).for_each(|(of, value)| *of = of.max(*value));
    }
}

impl Window {
    fn new(channels: usize) -> Self {
        Self { ticks: Vec::new(), least: vec![Vec::new(); channels], most: vec![Vec::new(); channels] }
    }

    fn push(&mut self, tick: u64, range: &Range) {
        let known = |value: f32| value.is_finite().then_some(value);
        self.ticks.push(tick);
        self.least.iter_mut().zip(&range.least).for_each(|(of, value)| of.push(known(*value)));
        self.most.iter_mut().zip(&range.most).for_each(|(of, value)| of.push(known(*value)));
    }
}

impl Store {
    /// An empty one for so many records; whole blocks are given up, so somewhat more may be kept.
    pub fn new(keep: usize) -> Self {
        Self { blocks: VecDeque::new(), channels: 0, keep, kept: 0, offset: 0, last: None, missing: 0, restarts: 0 }
    }

    /// Takes a record. One with another number of values than those before begins the store anew.
    pub fn push(&mut self, tick: u32, values: &[f32]) {
        if values.len() != self.channels {
            *self = Self { channels: values.len(), restarts: self.restarts, ..Self::new(self.keep) };
        }
        let mut at = self.offset + u64::from(tick);
        if let Some(last) = self.last {
            // the drive's count comes round after 2^32 ticks; one that jumps back begins anew
            if at <= last {
                let is_round = last - at > 1 << 31;
                self.restarts += u64::from(!is_round);
                // a place is left free between the counts, so that the line breaks there
                self.offset = if is_round { self.offset + (1 << 32) } else { last + 2 - u64::from(tick) };
                at = self.offset + u64::from(tick);
                self.missing += if is_round { at - last - 1 } else { 0 };
            } else {
                self.missing += at - last - 1;
            }
        }
        self.last = Some(at);
        if self.blocks.back().is_none_or(|block| block.ticks.len() == BLOCK) {
            let range = Range::new(self.channels);
            let block = Block { least: range.least, most: range.most, ..Block::default() };
            self.blocks.push_back(Arc::new(block));
        }
        // copied where a part holds it
        if let Some(block) = self.blocks.back_mut().map(Arc::make_mut) {
            block.ticks.push(at);
            block.values.extend_from_slice(values);
            for (c, &value) in values.iter().enumerate() {
                block.least[c] = block.least[c].min(value);
                block.most[c] = block.most[c].max(value);
            }
        }
        self.kept += 1;
        while self.kept > self.keep.saturating_add(BLOCK) {
            self.kept -= self.blocks.pop_front().map_or(self.kept, |block| block.ticks.len());
        }
    }

    /// First and last tick that is kept.
    pub fn ends(&self) -> Option<(u64, u64)> {
        Some((*self.blocks.front()?.ticks.first()?, self.last?))
    }

    /// Channels of a record.
    pub const fn channels(&self) -> usize {
        self.channels
    }

    /// The blocks that hold ticks from one on.
    fn from(&self, tick: u64) -> impl Iterator<Item = &Arc<Block>> {
        let first = self.blocks.partition_point(|block| block.ticks.last().is_some_and(|&last| last < tick));
        self.blocks.range(first..)
    }

    /// The records from one tick to another, both included.
    pub fn records(&self, from: u64, to: u64) -> impl Iterator<Item = (u64, &[f32])> {
        let records = self.from(from).flat_map(|block| block.records(self.channels));
        records.skip_while(move |(tick, _)| *tick < from).take_while(move |(tick, _)| *tick <= to)
    }

    /// The same as they are now, whatever comes later.
    pub fn part(&self, from: u64, to: u64) -> Part {
        let begins_before = |block: &&Arc<Block>| block.ticks.first().is_some_and(|&first| first <= to);
        let blocks = self.from(from).take_while(begins_before).map(Arc::clone).collect();
        Part { blocks, from, to, channels: self.channels }
    }

    /// What lies from one tick to another, in at most so many places, and one more in each gap.
    pub fn window(&self, from: u64, to: u64, places: u64) -> Window {
        let mut window = Window::new(self.channels);
        let (first, last) = self.ends().unwrap_or_default();
        let (from, to) = (from.max(first), to.min(last));
        let width = to.saturating_sub(from) / places.max(1) + 1;
        let empty = Range::new(self.channels);
        // place, last tick in it, range
        let mut open: Option<(u64, u64, Range)> = None;
        let mut add = |tick: u64, last: u64, least: &[f32], most: &[f32]| {
            let place = (tick - from) / width;
            if let Some((_, before, range)) = open.take_if(|(now, ..)| *now != place) {
                window.push(before, &range);
                if tick - before > 1 {
                    window.push(before + 1, &empty);
                }
            }
            let (_, end, range) = open.get_or_insert_with(|| (place, last, empty.clone()));
            *end = last;
            range.add(least, most);
        };
        for block in self.from(from) {
            let (Some(&first), Some(&last)) = (block.ticks.first(), block.ticks.last()) else { continue };
            if first > to {
                break;
            }
            let is_within = first >= from && last <= to && (first - from) / width == (last - from) / width;
            if is_within {
                add(first, last, &block.least, &block.most);
                continue;
            }
            for (tick, record) in block.records(self.channels) {
                if (from..=to).contains(&tick) {
                    add(tick, tick, record, record);
                }
            }
        }
        if let Some((_, last, range)) = open {
            window.push(last, &range);
        }
        window
    }

    /// The first tick after one at which a channel comes above a level.
    pub fn rise(&self, channel: usize, level: f32, after: u64) -> Option<u64> {
        let mut was_above = true;
        for block in self.from(after) {
            let most = *block.most.get(channel)?;
            if most <= level {
                was_above = false;
                continue;
            }
            for (tick, record) in block.records(self.channels) {
                if tick < after {
                    continue;
                }
                let is_above = *record.get(channel)? > level;
                if is_above && !was_above {
                    return Some(tick);
                }
                was_above = is_above;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, Store};

    fn store(ticks: impl Iterator<Item = u32>, keep: usize) -> Store {
        let mut store = Store::new(keep);
        ticks.for_each(|tick| store.push(tick, &[tick as f32, (tick % 7) as f32]));
        store
    }

    /// Against a search through all records.
    #[test]
    fn a_window_has_the_least_and_the_most_of_each_place() {
        let gapped = store((0..10_000).filter(|tick| !(3_000..3_700).contains(tick)), usize::MAX);
        assert_eq!(gapped.missing, 700);
        for (from, to, places) in [(0, 9_999, 10), (17, 5_003, 700), (2_990, 3_710, 1_000), (5, 5, 3), (0, 99_999, 1)] {
            let window = gapped.window(from, to, places);
            let gaps = window.least[0].iter().filter(|least| least.is_none()).count();
            assert!(window.ticks.len() - gaps <= places as usize + 1, "{from} {to} {places}");
            assert!(window.ticks.is_sorted());
            let mut records = gapped.records(from, to).peekable();
            for (place, &last) in window.ticks.iter().enumerate() {
                let mut range = [f32::INFINITY, f32::NEG_INFINITY];
                while let Some((_, values)) = records.next_if(|(tick, _)| *tick <= last) {
                    range = [range[0].min(values[1]), range[1].max(values[1])];
                }
                let expected = range.map(|value| value.is_finite().then_some(value));
                assert_eq!([window.least[1][place], window.most[1][place]], expected, "{from} {to} {places} {place}");
            }
            assert!(records.next().is_none());
        }
        // a single record too
        let single = store([0, 1, 3, 500, 501].into_iter(), 100);
        assert_eq!((single.missing, single.window(0, 501, 1_000).ticks), (497, vec![0, 1, 2, 3, 4, 500, 501]));
        // the gap is seen where its records are drawn one by one
        assert!(gapped.window(2_990, 3_710, 1_000).least[0].contains(&None));
        assert!(!gapped.window(0, 2_900, 1_000).least[0].contains(&None));
    }

    #[test]
    fn what_is_kept_is_the_end_and_no_more() {
        let store = store(0..5_000, 1_000);
        let (first, last) = store.ends().unwrap();
        assert!(last == 4_999 && (1_000..=1_000 + 2 * BLOCK as u64).contains(&(last - first + 1)), "{first}");
        assert_eq!(store.window(0, u64::MAX, 1).least[0], [Some(first as f32)]);
    }

    #[test]
    fn a_count_that_comes_round_goes_on_and_one_that_jumps_back_begins_anew() {
        let mut store = store([u32::MAX - 1, u32::MAX, 0, 1].into_iter(), 100);
        assert_eq!((store.ends().unwrap().1, store.restarts, store.missing), ((1 << 32) + 1, 0, 0));
        store.push(0, &[0.0, 0.0]);
        assert_eq!((store.ends().unwrap().1, store.restarts, store.missing), ((1 << 32) + 3, 1, 0));
        // another telemetry
        store.push(0, &[0.0]);
        assert_eq!((store.ends(), store.channels()), (Some((0, 0)), 1));
    }

    #[test]
    fn a_rise_is_the_first_after_a_tick() {
        let mut store = Store::new(usize::MAX);
        for tick in 0..3_000_u32 {
            store.push(tick, &[f32::from(u8::from(tick % 1_000 >= 900))]);
        }
        assert_eq!(store.rise(0, 0.5, 0), Some(900));
        assert_eq!(store.rise(0, 0.5, 900), Some(1_900), "it is above already");
        assert_eq!(store.rise(0, 0.5, 2_901), None);
        assert_eq!((store.rise(0, 1.5, 0), store.rise(1, 0.5, 0)), (None, None));
    }
}
