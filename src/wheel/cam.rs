//! The phase of the cycle from a cam, and the zero of a wheel without a gap from an index.

use super::cycle::ToothRecord;
use super::description::ToothedWheelConfig;
use super::phase::Cam;
use super::state::{Open, Synchronization, ToothedWheel};

impl<R: ToothRecord> ToothedWheel<R> {
    /// An edge of the cam; to be called from the interrupt of its capture. The parts of the cycle in which the cam has
    /// no edge here are excluded; when one is left, the cycle goes on from there. An edge that excludes all is left
    /// out, and the next begin anew.
    ///
    /// ```
    /// use driveline::settings::{Teeth, ToothClock};
    /// use driveline::wheel::{Cam, ToothedWheel, ToothedWheelConfig};
    /// const CONFIG: ToothedWheelConfig<58> =
    ///     ToothedWheelConfig::new(&Teeth::gap(60, 2), ToothClock { turns: 2, clock: 6e6, lowest_speed: 10.0 });
    /// let cam = Cam::degrees(2, [100.0], 15.0); // in the first turn of a four-stroke cycle
    /// let mut wheel = ToothedWheel::<()>::default();
    /// for place in (0..60 * 6_u32).filter(|place| place % 60 < 58) {
    ///     wheel.tooth(&CONFIG, 1000 * place);
    ///     if place % 120 == 16 {
    ///         wheel.cam(&CONFIG, &cam, 1000 * place + 667);
    ///     }
    /// }
    /// assert!(wheel.has_phase() && wheel.turn(&CONFIG) == 1); // of the turns 0 and 1
    /// ```
    pub fn cam<const TEETH: usize, const EDGES: usize>(
        &mut self,
        config: &ToothedWheelConfig<TEETH>,
        cam: &Cam<EDGES>,
        time: u32,
    ) {
        let end = (TEETH as u32).wrapping_mul(config.turns);
        let parts = end.checked_div(config.sector).unwrap_or(0);
        let turn = self.in_cycle.checked_div(TEETH as u32).unwrap_or(0);
        let elapsed = time.wrapping_sub(self.track.passage) as i32;
        let (Some(tooth), 1..=32) = (config.teeth.get(self.place as usize), parts) else { return };
        if self.synchronization == Synchronization::Searching {
            return;
        }
        let share = |whole: u32, parts: u32| whole.checked_div(parts).unwrap_or(0);
        // signed: an edge just before a turn's first tooth is in the turn before
        let beyond = (self.track.scale().angle(elapsed) as i32).checked_div(config.turns as i32).unwrap_or(0);
        let begin = share(u32::MAX, config.turns).wrapping_mul(turn);
        let place = begin.wrapping_add(share(tooth.angle, config.turns)).wrapping_add(beyond as u32);
        let mut fitting = 0;
        for part in 0..parts {
            let here = place.wrapping_add(share(u32::MAX, parts).wrapping_mul(part));
            if cam.edges.iter().any(|edge| (here.wrapping_sub(*edge) as i32).unsigned_abs() <= cam.tolerance) {
                fitting |= 1 << part;
            }
        }
        self.cam.left &= fitting;
        if self.cam.left == 0 {
            self.cam.left = u32::MAX;
        }
        if self.cam.left.is_power_of_two() && self.cam.left != 1 {
            let later = self.cam.left.trailing_zeros().wrapping_mul(config.sector);
            self.in_cycle = wrapped(self.in_cycle.wrapping_add(later), end);
            self.place = self.in_cycle.checked_rem(TEETH as u32).unwrap_or(0);
            self.cam.left = 1;
            self.record.lost();
        }
    }

    /// An edge of the index of a wheel without a gap: the next tooth is the first. The angle is given once all teeth
    /// have been counted between two edges of the index.
    pub fn index<const TEETH: usize>(&mut self, _config: &ToothedWheelConfig<TEETH>) {
        let last = (TEETH as u32).wrapping_sub(1);
        match self.cam.turns {
            Some(turns) if self.place == last => {
                self.cam.turns = Some(turns.saturating_add(1));
                self.open = Open::Nothing;
            }
            _ if self.synchronization == Synchronization::Known => self.lose(),
            _ => {
                self.cam.turns = Some(0);
                self.place = last;
                self.in_cycle = last;
            }
        }
    }

    /// The turn of the cycle that the wheel is in, counted from 0; which is the first is open until a cam has shown it.
    pub fn turn<const TEETH: usize>(&self, _config: &ToothedWheelConfig<TEETH>) -> u32 {
        self.in_cycle.checked_div(TEETH as u32).unwrap_or(0)
    }

    /// Whether the cam has shown the phase of the cycle.
    pub fn has_phase(&self) -> bool {
        self.synchronization == Synchronization::Known && self.cam.left == 1
    }
}

/// A number below twice `end`, less `end` where it reaches it.
fn wrapped(number: u32, end: u32) -> u32 {
    if number >= end { number.wrapping_sub(end) } else { number }
}
