//! The edges of the teeth: the place is looked for, checked and followed.

use super::angle::SKIPPED;
use super::check::Check;
use super::cycle::ToothRecord;
use super::description::{Tooth, ToothedWheelConfig, before_place, next_place, tooth};
use super::phase::Phase;
use super::place::{Search, ratio};
use super::state::{Open, Synchronization, ToothedWheel};
use super::track::Track;

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

impl<R: ToothRecord> ToothedWheel<R> {
    /// An edge of a tooth, at this reading of a clock that wraps; to be called from the interrupt of its capture.
    pub fn tooth<const TEETH: usize>(&mut self, config: &ToothedWheelConfig<TEETH>, time: u32) {
        if self.synchronization != Synchronization::Searching {
            self.follow(config, time);
            if self.synchronization == Synchronization::Searching || self.doubts == 0 && self.open != Open::Place {
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
        if self.synchronization == Synchronization::Searching {
            self.place = next_place(config, self.place);
            let fresh = self.search.intervals == 0;
            self.track.pace = if fresh || interval < self.track.pace { interval } else { self.track.pace };
        }
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
        let familiar = self.trust > 0 && interval >= before && config.sector > 1;
        if self.synchronization != Synchronization::Searching && !familiar {
            self.search = Search::NEW;
            return;
        }
        // The sector that the wheel is in is not known from the ratios. Edges that were counted through a stall and
        // agree with them exclude a machine that has turned back, and teeth without an edge that look like a gap; so
        // does a speed that has not changed.
        let agrees = self.place.checked_rem(config.sector) == Some(place);
        if self.synchronization != Synchronization::Searching {
            if agrees && self.open == Open::Place {
                self.open = Open::Nothing;
                return self.note(time);
            }
            // A tooth without an edge looks like a gap, but is where it was expected.
            if agrees || self.firm && self.open != Open::Place {
                return;
            }
            self.lose();
        }
        let (Some(tooth), Some(last)) = (tooth(config, place), tooth(config, before_place(config, place))) else {
            return;
        };
        // A machine that turns back slows down before the long interval.
        let steady = before >> 1 <= self.track.pace && (agrees || self.is_due(config, time, tooth));
        self.last = time;
        self.interval = interval;
        self.place = place;
        self.in_cycle = place;
        self.good = 0;
        self.doubts = 0;
        self.check = Check::NEW;
        self.span = tooth.span;
        self.track = Track::begin(interval, before, time, tooth, last);
        self.cam = Phase::NEW;
        self.open = Open::Nothing;
        self.synchronization = if familiar && steady { Synchronization::Known } else { Synchronization::Checking };
        self.note(time);
    }

    /// An edge while a place is assumed or known.
    fn follow<const TEETH: usize>(&mut self, config: &ToothedWheelConfig<TEETH>, time: u32) {
        let known = self.synchronization == Synchronization::Known;
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
            let span = self.track.time_of(tooth.span);
            passage = passage.wrapping_add(span);
            let error = time.wrapping_sub(passage) as i32;
            let half = self.track.time_of(tooth.slack) as i32;
            let [early, late] = if known { self.track.window(half, span) } else { [half; 2] };
            if error < early.wrapping_neg() {
                // Between two teeth: a bounce within a quarter of a pitch of the last, or an edge too many.
                let since = time.wrapping_sub(self.track.passage) as i32;
                if !known || since >= half >> 1 {
                    (self.extra, self.firm) = (true, false);
                    if !known {
                        self.place = place;
                    }
                    self.doubt(known, 1);
                    // A pitch behind the tooth before a gap: there is none here.
                    let regular = since.wrapping_sub(half << 1).unsigned_abs() <= half as u32 >> 1;
                    if regular {
                        self.reopen(Open::Place);
                    }
                }
                return;
            }
            if error <= late {
                if skipped != 0 && !known {
                    break;
                }
                self.firm = !core::mem::take(&mut self.extra);
                let quarter = half as u32 >> 1;
                let ambiguous = error.unsigned_abs() > quarter;
                if matches!(self.open, Open::Tooth | Open::Teeth) {
                    let interval = time.wrapping_sub(self.last).wrapping_sub(span) as i32;
                    let clear = self.firm && skipped == 0 && !ambiguous && interval.unsigned_abs() <= quarter;
                    match self.open {
                        Open::Teeth if ambiguous => self.reopen(Open::Place),
                        Open::Teeth if clear => self.open = Open::Tooth,
                        _ if clear => self.open = Open::Nothing,
                        _ => {}
                    }
                }
                let doubtful = ambiguous || self.track.error.unsigned_abs() > quarter;
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
                if self.track.has_slowed() {
                    self.search = Search::NEW;
                    self.reopen(Open::Place);
                }
                if !self.firm && ambiguous {
                    self.reopen(Open::Place);
                }
                if error.unsigned_abs() > half as u32 {
                    self.reopen(Open::Tooth);
                }
                if skipped != 0 {
                    self.doubt(known, skipped);
                    self.reopen(if doubtful { Open::Place } else { Open::Teeth });
                } else if self.good as usize >= TEETH {
                    self.doubts = 0;
                    if known {
                        self.good = 0;
                        self.trust = if self.trust < TRUST { self.trust.wrapping_add(1) } else { TRUST };
                    }
                    if !known && self.placed(config) {
                        match self.check.verdict(self.good, fewest(TEETH as u32) >> u32::from(self.trust > 0)) {
                            None => {}
                            Some(true) => {
                                self.trust = self.trust.max(1);
                                self.synchronization = Synchronization::Known;
                            }
                            Some(false) => return self.lose(),
                        }
                    }
                }
                return self.note(time);
            }
        }
        // Longer than for teeth without an edge: the machine has paused. Where it had not slowed down before, it goes
        // on from the next tooth; else it may have turned back.
        let steady = known && self.open < Open::Place && self.track.is_steady();
        self.place = next_place(config, self.place);
        if !steady {
            return self.lose();
        }
        let end = TEETH.wrapping_mul(config.turns as usize);
        self.in_cycle = if self.in_cycle as usize + 1 >= end { 0 } else { self.in_cycle.wrapping_add(1) };
        self.track.passage = time;
        self.firm = false;
        self.doubt(known, 1 + SKIPPED);
        self.reopen(Open::Teeth);
        self.note(time);
    }

    /// Whether a place found while searching is where time and speed since the place was last known lead to.
    fn is_due<const TEETH: usize>(&self, config: &ToothedWheelConfig<TEETH>, time: u32, found: &Tooth) -> bool {
        let elapsed = time.wrapping_sub(self.track.passage);
        let last = self.in_cycle.checked_rem(TEETH as u32).and_then(|last| tooth(config, last));
        let (Some(last), true) = (last, self.track.turn != 0 && elapsed >> 1 < self.track.turn) else { return false };
        let angle = last.angle.wrapping_add(self.track.scale().angle(elapsed as i32));
        (angle.wrapping_sub(found.angle) as i32).unsigned_abs() <= found.slack
    }

    /// More has to be seen before the angle is given.
    fn reopen(&mut self, open: Open) {
        if self.open < open && self.synchronization == Synchronization::Known {
            self.open = open;
            if open == Open::Place {
                self.search = Search::NEW;
                self.cam.left = u32::MAX;
                self.record.lost();
            }
        }
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
        if self.synchronization == Synchronization::Known && self.open != Open::Place {
            self.record.tooth(self.in_cycle, time);
        }
    }

    /// Whether the teeth alone give the place, or an index does.
    fn placed<const TEETH: usize>(&self, config: &ToothedWheelConfig<TEETH>) -> bool {
        config.sector > 1 || self.cam.counted()
    }
}

/// Good teeth that show a wheel with so many to be the one described.
const fn fewest(teeth: u32) -> u32 {
    let turns = if teeth < MANY { 2 * teeth } else { teeth };
    if turns < FEWEST { FEWEST } else { turns }
}
