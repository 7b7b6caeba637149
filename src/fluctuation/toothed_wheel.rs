//! A toothed wheel with missing teeth as the source: the times at which its teeth pass a sensor.
//!
//! The gap marks the wheel's zero. The times since the cycle's first tooth are averaged tooth by tooth over several
//! cycles. Their deviation from uniform rotation is the ripple plus the wheel's pitch errors: a tooth displaced by a
//! tenth of a degree appears as a delta of 1/500. So the errors are learnt while there is no ripple, as the machine
//! coasts without fuel or load, and taken off.

use core::f64::consts::TAU;

use super::series::{Order, Series};
use super::window::Ramp;
use super::{CycleConfig, MAX_ORDER, Ripple};

/// A wheel: so many places to a turn, the last of them without a tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothedWheelConfig {
    /// The cycle, a whole number of turns of the wheel, its tick being that of the clock that the teeth are timed with.
    pub cycle: CycleConfig,
    /// Places to a turn, missing teeth included: 60 of a 60-2 wheel.
    pub places: u32,
    /// Missing teeth: 2 of a 60-2 wheel.
    pub missing: u32,
    /// Cycles in a window.
    pub cycles: u32,
}

/// A place of the wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Place {
    in_turn: u32,
    in_cycle: u32,
}

/// The measured wheel. `PLACES` is the number in a cycle: 60 of a 60-2 wheel that turns once in it, 120 where it turns
/// twice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothedWheel<const PLACES: usize> {
    last: u32,
    /// The last interval that was a pitch; 0 where none is known.
    pitch: u32,
    /// The last tooth; `None` until a gap has passed.
    place: Option<Place>,
    /// When the cycle's first tooth passed.
    began: u32,
    filling: bool,
    full: bool,
    window: ToothWindow<PLACES>,
}

/// A finished window of a toothed wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothWindow<const PLACES: usize> {
    /// Sum of the times from the cycle's first tooth to each [clock].
    times: [u64; PLACES],
    cycles: u32,
    /// The lengths of all its cycles, of the first and of the last [clock].
    whole: u64,
    opening: u32,
    closing: u32,
}

/// By how much each tooth passes later than its place would \[rad\], 2 pi to the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ToothErrors<const PLACES: usize>([f32; PLACES]);

impl<const PLACES: usize> ToothErrors<PLACES> {
    /// A perfect wheel.
    pub const NONE: Self = ToothErrors([0.0; PLACES]);

    /// The errors, tooth by tooth from the first after the gap; 0 where there is none.
    pub fn radians(&self) -> &[f32; PLACES] {
        &self.0
    }
}

impl<const PLACES: usize> ToothWindow<PLACES> {
    const EMPTY: Self = ToothWindow { times: [0; PLACES], cycles: 0, whole: 0, opening: 0, closing: 0 };
}

impl<const PLACES: usize> Default for ToothedWheel<PLACES> {
    fn default() -> Self {
        ToothedWheel {
            last: 0,
            pitch: 0,
            place: None,
            began: 0,
            filling: false,
            full: false,
            window: ToothWindow::EMPTY,
        }
    }
}

impl<const PLACES: usize> ToothedWheel<PLACES> {
    /// A tooth has passed, at this reading of a clock that wraps; to be called from the interrupt of its capture.
    ///
    /// A gap is an interval longer than halfway between the last pitch and a gap at that pitch, and shorter than
    /// halfway to that of one more missing tooth. One that comes where there is none, does not come, or is longer voids
    /// the window, and the place is looked for anew: a wheel that is not the one that was described gives no window.
    pub fn tooth(&mut self, config: &ToothedWheelConfig, time: u32) {
        let interval = time.wrapping_sub(self.last);
        self.last = time;
        let limit = u64::from(self.pitch) * (2 + u64::from(config.missing)) / 2;
        let gap = self.pitch != 0 && u64::from(interval) > limit;
        // More missing teeth than any wheel has places for do not stop the machine.
        let longest = u64::from(self.pitch).wrapping_mul(3 + 2 * u64::from(config.missing)) / 2;
        if gap && u64::from(interval) > longest {
            self.disturb();
            return;
        }
        if !gap {
            self.pitch = interval;
        }
        let Some(place) = self.place else {
            if gap {
                self.place = Some(Place { in_turn: 0, in_cycle: 0 });
                self.began = time;
            }
            return;
        };
        let due = place.in_turn.wrapping_add(1).wrapping_add(config.missing) >= config.places;
        if gap != due {
            self.disturb();
            return;
        }
        let mut next = Place { in_turn: place.in_turn.wrapping_add(1), in_cycle: place.in_cycle.wrapping_add(1) };
        if gap {
            next = Place { in_turn: 0, in_cycle: next.in_cycle.wrapping_add(config.missing) };
            if next.in_cycle as usize >= PLACES {
                next.in_cycle = 0;
                self.end(config, time);
            }
        }
        self.place = Some(next);
        if self.filling
            && let Some(sum) = self.window.times.get_mut(next.in_cycle as usize)
        {
            *sum = sum.wrapping_add(u64::from(time.wrapping_sub(self.began)));
        }
    }

    /// The end of a cycle.
    fn end(&mut self, config: &ToothedWheelConfig, time: u32) {
        let length = time.wrapping_sub(self.began);
        self.began = time;
        if self.filling {
            let window = &mut self.window;
            window.cycles += 1;
            window.whole = window.whole.wrapping_add(u64::from(length));
            window.closing = length;
            if window.cycles == 1 {
                window.opening = length;
            }
            if window.cycles >= config.cycles {
                self.filling = false;
                self.full = true;
            }
        } else if !self.full {
            self.window = ToothWindow::EMPTY;
            self.filling = true;
        }
    }

    /// The wheel stands, the capture has timed out, a tooth was missed: the place is looked for anew.
    pub fn disturb(&mut self) {
        self.place = None;
        self.pitch = 0;
        self.filling = false;
    }

    /// Takes a finished window and lets the next one begin; `None` while there is none.
    pub fn take(&mut self) -> Option<ToothWindow<PLACES>> {
        core::mem::take(&mut self.full).then_some(self.window)
    }
}

impl<const PLACES: usize> ToothWindow<PLACES> {
    /// Whether the place has a tooth.
    fn has_tooth(config: &ToothedWheelConfig, place: u32) -> bool {
        let places = config.places.max(1);
        place % places < places.saturating_sub(config.missing)
    }

    /// A cycle's mean length [clock], the relative rise of the slowness over a cycle, linear and quadratic, and the
    /// ramp.
    fn trend(&self) -> (f64, [f64; 2], Ramp) {
        let cycles = f64::from(self.cycles.max(1));
        let whole = self.whole as f64;
        let ramp = Ramp::of(whole, f64::from(self.opening), f64::from(self.closing), self.cycles);
        let mean = whole / cycles;
        let per_cycle = TAU / (cycles * mean);
        (mean, [ramp.slowness * per_cycle, 0.5 * TAU * ramp.slope * per_cycle], ramp)
    }

    /// How much later each tooth passed than in an even cycle, as a share of the cycle, the trend taken off.
    fn lateness(&self, mean: f64, [slope, square]: [f64; 2]) -> [f64; PLACES] {
        let mut late = [0.0; PLACES];
        let cycles = f64::from(self.cycles.max(1));
        for ((place, late), &time) in (0_u32..).zip(&mut late).zip(&self.times) {
            let x = f64::from(place) / PLACES as f64;
            // The integral of slope (x - 1/2) + square ((x - 1/2)^2 - 1/12), which is 0 at both ends.
            let trend = 0.5 * (x * x - x) * (slope + square * (2.0 * x - 1.0) / 3.0);
            *late = time as f64 / cycles / mean - x - trend;
        }
        late
    }

    /// The wheel's errors, from a window in which the machine had no ripple: it coasted, without fuel and without load.
    /// Over some 16 turns: fewer average less of the clock's rounding, and while the speed falls by more than a quarter
    /// it falls no longer as steadily as is taken off.
    pub fn errors(&self, config: &ToothedWheelConfig) -> ToothErrors<PLACES> {
        let (mean, trend, _) = self.trend();
        let mut errors = [0.0; PLACES];
        for ((place, error), late) in (0_u32..).zip(&mut errors).zip(self.lateness(mean, trend)) {
            if Self::has_tooth(config, place) {
                *error = (late * TAU) as f32;
            }
        }
        ToothErrors(errors)
    }

    /// The waveform of the wheel's speed with the orders up to `highest`, which counts at most [`MAX_ORDER`] and a
    /// sixth of the places.
    ///
    /// Take no more orders than the machine has: the clock's rounding, which a steady speed may repeat in every turn,
    /// shows in the n-th order n times.
    ///
    /// The lateness of the missing teeth follows from the orders of the others, by iteration.
    pub fn ripple(&self, config: &ToothedWheelConfig, errors: &ToothErrors<PLACES>, highest: usize) -> Ripple {
        let highest = highest.min(MAX_ORDER).min(PLACES / 6);
        let (mean, trend, ramp) = self.trend();
        let late = self.lateness(mean, trend);
        let mut slowness = Series::constant(1.0);
        // The passage time of a tooth's error depends on the ripple there.
        for _ in 0..3 {
            let mut own = late;
            for ((place, own), &error) in (0_u32..).zip(&mut own).zip(&errors.0) {
                *own -= f64::from(error) / TAU * slowness.at(TAU * f64::from(place) / PLACES as f64);
            }
            for _ in 0..ROUNDS {
                let series = Series::sampled(own.iter().copied(), PLACES, 0.0, highest);
                for (place, own) in (0_u32..).zip(&mut own) {
                    if !Self::has_tooth(config, place) {
                        *own = series.at(TAU * f64::from(place) / PLACES as f64);
                    }
                }
            }
            // Time over the cycle's is theta/2 pi and the lateness; its derivative is the slowness over its mean.
            slowness = Series::sampled(own.iter().copied(), PLACES, 0.0, highest).derivative();
            slowness.mean = 1.0;
            for order in &mut slowness.orders {
                *order = Order { cos: TAU * order.cos, sin: TAU * order.sin };
            }
        }
        let speed = config.cycle.angle / (mean * config.cycle.period);
        let acceleration = config.cycle.angle / TAU * ramp.acceleration / (config.cycle.period * config.cycle.period);
        Ripple::of(slowness, speed, acceleration, config.cycle.angle, highest, self.cycles)
    }
}

/// How often the missing teeth are put where the orders have them: with a sixth of the places as orders each time is
/// closer by a third or more.
const ROUNDS: u32 = 40;
