//! The wheel itself: edges in, angle out.

use super::check::Check;
use super::cycle::{CycleTimes, Record, ToothCycle};
use super::place::{RATIOS, Search, Set, ratio};
use super::track::Track;
use crate::fault::Faults;

/// Teeth in a row that may be without an edge.
pub const SKIPPED: u32 = 2;

/// Edges too many and teeth without an edge that lose the place, without a good turn between.
const DOUBTS: u32 = 8;

/// Good teeth in a row that show the wheel to be the one described: a turn's, or two turns' of a wheel with fewer teeth
/// than [`MANY`], and no fewer than these; twice as many with jitter.
const FEWEST: u32 = 20;
const MANY: u32 = 30;

/// Good turns that count: a place that is lost takes one away, and the last one means that the wheel is to be checked
/// anew.
const TRUST: u32 = 4;

/// Good teeth less one after which one of the doubts is forgotten; all ones in binary.
const FORGOTTEN: u32 = 15;

/// Good intervals before a wheel that is known is found at its gap.
const FAMILIAR: u32 = 8;

/// A tooth. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tooth {
    /// Its angle [2^-32 turn].
    pub angle: u32,
    /// The same less that of the tooth before [2^-32 turn]: its span.
    pub span: u32,
    /// Half of the least of the spans before and behind it [2^-32 turn].
    pub slack: u32,
    /// Spans to a turn [2^-12].
    pub spans: u32,
}

/// The constants of a wheel with `TEETH` teeth. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothedWheelConfig<const TEETH: usize> {
    /// The teeth.
    pub teeth: [Tooth; TEETH],
    /// Teeth in the smallest part of the wheel that repeats; all of them where none does.
    pub sector: u32,
    /// For each ratio of two successive intervals: the teeth of the sector that it may end at.
    pub(crate) fitting: [Set; RATIOS],
    /// Turns to a cycle.
    pub turns: u32,
    /// Longest time of a turn [clock]: below that speed there is no angle.
    pub slowest: u32,
    /// Time of a count of the clock \[s\].
    pub period: f64,
}

/// How much is known of the place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stage {
    /// Not known.
    #[default]
    Searching,
    /// One place is left, and is being checked.
    Checking,
    /// Known.
    Known,
}

/// The angle from a wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WheelAngle {
    /// The angle [2^-32 turn].
    pub angle: u32,
    /// Its standard deviation [2^-32 turn], from the errors of the predicted passages.
    pub deviation: u32,
}

/// A toothed wheel. Its angle is that of [`crate::settings::Teeth`]. `R` is what it records: nothing, or
/// [`CycleTimes`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothedWheel<R = ()> {
    /// The last edge that was taken, and the time from the one before; 0 where there is none.
    last: u32,
    interval: u32,
    search: Search,
    pub(super) stage: Stage,
    /// Good turns.
    trust: u32,
    /// The last tooth, and its number in the cycle.
    pub(super) place: u32,
    pub(super) in_cycle: u32,
    pub(super) track: Track,
    /// Edges too many and teeth without an edge.
    doubts: u32,
    /// An edge too many has come since the last tooth.
    extra: bool,
    /// The last edge is a tooth, with no edge too many before it.
    firm: bool,
    /// Good teeth in a row.
    good: u32,
    check: Check,
    /// Span of the last tooth that was checked.
    span: u32,
    pub(super) cam: super::cam::Phase,
    pub(super) record: R,
}

impl<R: Record + Default> Default for ToothedWheel<R> {
    fn default() -> Self {
        ToothedWheel {
            last: 0,
            interval: 0,
            search: Search::NEW,
            stage: Stage::Searching,
            trust: 0,
            place: 0,
            in_cycle: 0,
            track: Track::NEW,
            doubts: 0,
            extra: false,
            firm: false,
            good: 0,
            check: Check::NEW,
            span: 0,
            cam: super::cam::Phase::NEW,
            record: R::default(),
        }
    }
}

impl<R: Record> ToothedWheel<R> {
    /// An edge of a tooth, at this reading of a clock that wraps; to be called from the interrupt of its capture.
    pub fn tooth<const TEETH: usize>(&mut self, config: &ToothedWheelConfig<TEETH>, time: u32) {
        if self.stage != Stage::Searching {
            self.follow(config, time);
            if self.stage == Stage::Searching || self.doubts == 0 {
                self.last = time;
                return;
            }
        }
        self.look(config, time);
    }

    /// An edge while the place is unknown.
    fn look<const TEETH: usize>(&mut self, config: &ToothedWheelConfig<TEETH>, time: u32) {
        let interval = time.wrapping_sub(self.last);
        let before = self.interval;
        // A bounce. The interval goes on, so that a long standstill does not make bounces of teeth for long.
        if interval < before >> 3 && before < config.slowest {
            return;
        }
        self.last = time;
        self.interval = interval;
        if interval == 0 || interval >= config.slowest || before == 0 || before >= config.slowest {
            self.search = Search::NEW;
            return;
        }
        if let Some(fitting) = config.fitting.get(ratio(interval, before)) {
            self.search.advance(fitting, config.sector);
        }
        let Some(place) = self.search.found() else { return };
        let fewest = if config.sector / 2 < FAMILIAR { config.sector / 2 } else { FAMILIAR };
        if self.trust > 0 && self.search.intervals < fewest {
            // A single strange interval is no gap.
            self.search = Search::NEW;
            return;
        }
        // A doubled edge looks like the tooth behind a gap: where the gap itself was not seen, the place is checked.
        let familiar = self.trust > 0 && interval >= before;
        if self.stage != Stage::Searching && !familiar {
            self.search = Search::NEW;
            return;
        }
        if self.stage != Stage::Searching {
            // The sector that the wheel is in is not known from the ratios.
            // A tooth without an edge looks like a gap, but is where it was expected.
            if self.firm || self.place.checked_rem(config.sector) == Some(place) {
                return;
            }
            self.lose();
        }
        let (Some(tooth), Some(last)) = (tooth(config, place), tooth(config, before_place(config, place))) else {
            return;
        };
        self.last = time;
        self.interval = interval;
        self.place = place;
        self.in_cycle = place;
        self.good = 0;
        self.doubts = 0;
        self.check = Check::NEW;
        self.span = tooth.span;
        self.track = Track::begin(interval, before, time, tooth, last);
        self.cam = super::cam::Phase::NEW;
        self.stage = if familiar { Stage::Known } else { Stage::Checking };
        self.note(time);
    }

    /// An edge while a place is assumed or known.
    fn follow<const TEETH: usize>(&mut self, config: &ToothedWheelConfig<TEETH>, time: u32) {
        let known = self.stage == Stage::Known;
        let (mut place, mut in_cycle) = (self.place, self.in_cycle);
        let mut passage = self.track.passage;
        for skipped in 0..=SKIPPED {
            place = place.wrapping_add(1);
            in_cycle = in_cycle.wrapping_add(1);
            if place as usize >= TEETH {
                place = 0;
                if in_cycle as usize >= TEETH.wrapping_mul(config.turns as usize) {
                    in_cycle = 0;
                }
            }
            let Some(tooth) = tooth(config, place) else { return };
            passage = passage.wrapping_add(self.track.time_of(tooth.span));
            let error = time.wrapping_sub(passage) as i32;
            let half = self.track.time_of(tooth.slack) as i32;
            let [early, late] = if known { self.track.window(half) } else { [half; 2] };
            if error < early.wrapping_neg() {
                // Between two teeth: a bounce within a quarter of a pitch of the last, or an edge too many.
                let since = time.wrapping_sub(self.track.passage) as i32;
                if !known || since >= half >> 1 {
                    (self.extra, self.firm) = (true, false);
                    self.doubt(known, 1);
                }
                return;
            }
            if error <= late {
                if skipped != 0 && !known {
                    break;
                }
                self.firm = !core::mem::take(&mut self.extra);
                self.place = place;
                self.in_cycle = in_cycle;
                self.track.correct(passage, error, tooth, config.slowest);
                if self.track.turn == 0 {
                    return self.lose();
                }
                if !known {
                    let interval = time.wrapping_sub(self.last);
                    // Only where two spans differ can the description be told from even teeth.
                    let before = self.span;
                    let differs = tooth.span.abs_diff(before) > before >> 3;
                    self.check.tooth(error, half, differs.then(|| interval.abs_diff(self.interval)));
                    self.span = tooth.span;
                    self.interval = interval;
                }
                self.good = self.good.saturating_add(1);
                if known && self.good & FORGOTTEN == FORGOTTEN {
                    self.doubts = self.doubts.saturating_sub(1);
                }
                if skipped != 0 {
                    self.doubt(known, skipped);
                } else if self.good as usize >= TEETH {
                    self.doubts = 0;
                    if known {
                        self.good = 0;
                        self.trust = if self.trust < TRUST { self.trust.wrapping_add(1) } else { TRUST };
                    }
                    if !known && self.placed(config) {
                        match self.check.verdict(self.good, const { fewest(TEETH as u32) }) {
                            None => {}
                            Some(true) => {
                                self.trust = 1;
                                self.stage = Stage::Known;
                            }
                            Some(false) => return self.lose(),
                        }
                    }
                }
                return self.note(time);
            }
        }
        // Longer than for teeth without an edge: the machine has paused, and goes on from the next tooth.
        if known {
            let next = if self.place as usize + 1 >= TEETH { 0 } else { self.place.wrapping_add(1) };
            let end = TEETH.wrapping_mul(config.turns as usize);
            self.in_cycle = if self.in_cycle as usize + 1 >= end { 0 } else { self.in_cycle.wrapping_add(1) };
            self.place = next;
            self.track.passage = time;
            self.firm = false;
            self.doubt(known, 1 + SKIPPED);
            return self.note(time);
        }
        self.lose();
    }

    /// An edge too many, or teeth without one.
    fn doubt(&mut self, known: bool, edges: u32) {
        if self.doubts == 0 {
            self.search = Search::NEW;
            self.interval = 0;
        }
        self.good = 0;
        self.doubts = self.doubts.wrapping_add(edges);
        if !known || self.doubts > DOUBTS {
            self.trust = self.trust.saturating_sub(1);
            self.lose();
        }
    }

    /// Records the last tooth.
    fn note(&mut self, time: u32) {
        if self.stage == Stage::Known {
            self.record.tooth(self.in_cycle, time);
        }
    }

    /// Whether the teeth alone give the place, or an index does.
    fn placed<const TEETH: usize>(&self, config: &ToothedWheelConfig<TEETH>) -> bool {
        config.sector > 1 || self.cam.counted()
    }

    /// The wheel stands, the capture has timed out, edges were missed: the place is looked for anew.
    pub fn lose(&mut self) {
        self.stage = Stage::Searching;
        self.search = Search::NEW;
        self.interval = 0;
        self.record.lost();
    }

    /// Whether the place is known.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// The angle at `now`, on the same clock. To be read in every tick, so that a stopped wheel is not taken for one
    /// that has just turned once.
    ///
    /// # Errors
    /// [`Faults::ANGLE_MISSING`] where the place is not known or a tooth is overdue by more than half a pitch.
    pub fn at<const TEETH: usize>(
        &mut self,
        config: &ToothedWheelConfig<TEETH>,
        now: u32,
    ) -> Result<WheelAngle, Faults> {
        if self.stage != Stage::Known {
            return Err(Faults::ANGLE_MISSING);
        }
        let next = if self.place as usize + 1 >= TEETH { 0 } else { self.place.wrapping_add(1) };
        let (Some(last), Some(next)) = (tooth(config, self.place), tooth(config, next)) else {
            return Err(Faults::ANGLE_MISSING);
        };
        let elapsed = now.wrapping_sub(self.track.passage) as i32;
        let due = self.track.time_of(next.span.saturating_add(next.slack));
        if elapsed >= 0 && elapsed as u32 > due {
            if elapsed as u32 > due.saturating_mul(2 + SKIPPED) {
                self.lose();
            }
            return Err(Faults::ANGLE_MISSING);
        }
        let scale = self.track.scale();
        let angle = last.angle.wrapping_add(scale.angle(elapsed));
        Ok(WheelAngle { angle, deviation: scale.angle(self.track.deviation() as i32) })
    }
}

impl<const TEETH: usize> ToothedWheel<CycleTimes<TEETH>> {
    /// Takes the last finished cycle; none where there is none that was not taken. To be called with the capture's
    /// interrupt off, once a cycle at least: [`ToothCycle::number`] shows cycles that were missed.
    pub fn take(&mut self) -> Option<ToothCycle<TEETH>> {
        self.record.take()
    }
}

/// Good teeth that show a wheel with so many to be the one described.
const fn fewest(teeth: u32) -> u32 {
    let turns = if teeth < MANY { 2 * teeth } else { teeth };
    if turns < FEWEST { FEWEST } else { turns }
}

/// The tooth at a place.
pub(super) fn tooth<const TEETH: usize>(config: &ToothedWheelConfig<TEETH>, place: u32) -> Option<&Tooth> {
    config.teeth.get(place as usize)
}

/// The place before.
fn before_place<const TEETH: usize>(_: &ToothedWheelConfig<TEETH>, place: u32) -> u32 {
    place.checked_sub(1).unwrap_or((TEETH as u32).wrapping_sub(1))
}
