//! The times of a cycle's teeth, handed to the main loop.

/// What a wheel records of its teeth, on the interrupt.
pub trait ToothRecord {
    /// A tooth of the cycle passed at this time (clock counts).
    fn tooth(&mut self, place: u32, time: u32);
    /// The place was lost: the cycle is not finished.
    fn lost(&mut self);
}

/// Nothing: a wheel that gives an angle alone.
impl ToothRecord for () {
    #[inline(always)]
    fn tooth(&mut self, _place: u32, _time: u32) {}

    #[inline(always)]
    fn lost(&mut self) {}
}

/// Step of the cycles' numbers where the place was lost: more than are ever missed while it is known.
pub(crate) const LOST: u32 = 1 << 16;

/// A finished cycle: the passages of its `TEETH` teeth, of all turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothCycle<const TEETH: usize> {
    /// Passages (clock counts), wrapping; that of a tooth without an edge is before the first.
    pub(crate) times: [u32; TEETH],
    /// Passage of the next cycle's first tooth (clock counts).
    pub(crate) end: u32,
    /// Its number, which goes on by [`LOST`] where the place was lost.
    pub(crate) number: u32,
}

impl<const TEETH: usize> ToothCycle<TEETH> {
    const EMPTY: Self = ToothCycle { times: [0; TEETH], end: 0, number: 0 };

    /// Duration (clock counts).
    pub fn length(&self) -> u32 {
        self.end.wrapping_sub(self.times.first().copied().unwrap_or(self.end))
    }

    /// Its number: consecutive where none was missed, and 65,536 further where the place was lost between.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// From the cycle's first tooth to each (clock counts); none for a tooth without an edge.
    pub fn since_first(&self) -> impl Iterator<Item = Option<u32>> + '_ {
        let first = self.times.first().copied().unwrap_or(0);
        let length = self.length();
        self.times.iter().map(move |time| {
            let since = time.wrapping_sub(first);
            (since < length).then_some(since)
        })
    }
}

/// Two cycles of `TEETH` teeth: one is filled while the other stands until it is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleTimes<const TEETH: usize> {
    cycles: [ToothCycle<TEETH>; 2],
    filling: u32,
    /// The place that comes next; none before a cycle has begun.
    next: Option<u32>,
    number: u32,
    ready: bool,
}

impl<const TEETH: usize> Default for CycleTimes<TEETH> {
    fn default() -> Self {
        CycleTimes { cycles: [ToothCycle::EMPTY; 2], filling: 0, next: None, number: 0, ready: false }
    }
}

impl<const TEETH: usize> ToothRecord for CycleTimes<TEETH> {
    fn tooth(&mut self, place: u32, time: u32) {
        let [even, odd] = &mut self.cycles;
        let (filled, other) = if self.filling & 1 == 0 { (even, odd) } else { (odd, even) };
        match self.next {
            _ if place as usize >= TEETH => return,
            Some(next) if place >= next => {
                // Teeth without an edge: their times are before the cycle's beginning.
                if place > next {
                    let before = filled.times.first().copied().unwrap_or(time).wrapping_sub(1);
                    for absent in filled.times.iter_mut().take(place as usize).skip(next as usize) {
                        *absent = before;
                    }
                }
                if let Some(passage) = filled.times.get_mut(place as usize) {
                    *passage = time;
                }
            }
            _ if place != 0 => {
                // without its first tooth neither the cycle before nor this one is finished
                if self.next.is_some() {
                    self.number = self.number.wrapping_add(2);
                }
                self.next = None;
                return;
            }
            begun => {
                if begun == Some(TEETH as u32) {
                    filled.end = time;
                    filled.number = self.number;
                    self.number = self.number.wrapping_add(1);
                    self.filling ^= 1;
                    self.ready = true;
                    if let Some(first) = other.times.first_mut() {
                        *first = time;
                    }
                } else {
                    if begun.is_some() {
                        self.number = self.number.wrapping_add(1);
                    }
                    if let Some(first) = filled.times.first_mut() {
                        *first = time;
                    }
                }
            }
        }
        self.next = Some(place.wrapping_add(1));
    }

    fn lost(&mut self) {
        self.next = None;
        self.number = self.number.wrapping_add(LOST);
    }
}

impl<const TEETH: usize> CycleTimes<TEETH> {
    /// Takes the finished cycle, once.
    pub(super) fn take(&mut self) -> Option<ToothCycle<TEETH>> {
        let [even, odd] = &self.cycles;
        core::mem::take(&mut self.ready).then_some(if self.filling & 1 == 0 { *odd } else { *even })
    }
}
