//! The speed without its ripple, for a governor: the mean over the last cycle, extrapolated by half of the change of
//! speed in it.
//!
//! ```text
//! omega = phi_c/(t - t_c) + (omega_m - omega_m,c)/2
//! ```
//!
//! Index c is where the motor was exactly one cycle ago. Both parts are blind to whatever repeats every cycle, of any
//! shape and at any speed, for the cycle is one of angle. The mean alone is late by half a cycle; with half the change
//! it is exact under a steady acceleration, and late by nothing but the second order otherwise:
//! `(1 - e^-sT)(1/sT + 1/2) = 1 - (sT)^2/12 + ...`.
//!
//! It is renewed at the end of every segment of the cycle. The mean comes from two angles and the ticks between them by
//! one division in integers, the same bits in every number; nothing is summed up, so nothing drifts.
//!
//! There is none before a first whole cycle, nor after the angle was lost or the direction has changed. Nor is there
//! one while the machine takes more than four times as long for a segment as it did on average. Then a governor has to
//! act on the speed as it is.

use super::position::{Crossing, Position};
use super::{CycleConfig, Fluctuation};
use crate::number::Number;
use crate::sample::Estimate;

/// Ticks that a cycle may last: 419 s at 10 kHz.
const LONGEST: u32 = 1 << 22;

/// Constants of [`CycleMean`]. Made by [`crate::settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleMeanConfig<N: Number> {
    /// The cycle, in as many segments as the measurement has.
    pub cycle: CycleConfig,
    /// Its angle (2^-26 turn).
    pub angle: u32,
    /// Speed from a turn in a tick [rad/s per 2^-32 turn].
    pub speed: N::Coefficient,
}

/// The end of a segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Mark<N> {
    /// The first tick beyond it; wraps.
    tick: u32,
    /// How far that tick was beyond it (2^-26 turn).
    beyond: u32,
    /// The motor's estimated speed.
    speed: N,
}

/// The speed without its ripple, renewed `SEGMENTS` times a cycle: a power of two from 4 on, no segment longer than a
/// quarter of a turn.
///
/// ```
#[doc = include_str!("ripple.txt")]
/// const CONFIG: CycleMeanConfig<f64> = CycleMeanConfig::<f64>::new::<8>(Cycle::TURN, 1e-4, Bases::SI);
/// let mut mean = CycleMean::<8, f64>::default();
/// // in the mean by time 150 sqrt(1 - 0.02^2)
/// for (angle, motor_speed) in turning().take(4_000) {
///     mean.measure(&CONFIG, angle, 0.0, &Estimate { motor_speed, ..Estimate::default() });
/// }
/// assert!(mean.steady_speed().is_some_and(|speed| (speed - 149.97).abs() < 0.02));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CycleMean<const SEGMENTS: usize, N = f32> {
    position: Position,
    tick: u32,
    /// The tick of the last angle that could not be used.
    disturbed: u32,
    forward: bool,
    marks: [Mark<N>; SEGMENTS],
    /// Segments that have been passed since the last that nothing is known of, at most all of them.
    known: u32,
    /// The place of the next mark.
    at: u32,
    /// When the mean was renewed, and for how many ticks it stands; none for a mean that is not there.
    renewed: u32,
    stands: u32,
    mean: N,
}

impl<N: Number, const SEGMENTS: usize> Default for CycleMean<SEGMENTS, N> {
    fn default() -> Self {
        const {
            assert!(
                SEGMENTS.is_power_of_two() && SEGMENTS >= 4 && SEGMENTS <= 1024,
                "a power of two from 4 to \
            1024"
            )
        };
        CycleMean {
            position: Position::default(),
            tick: 0,
            disturbed: u32::MAX,
            forward: true,
            marks: [Mark::default(); SEGMENTS],
            known: 0,
            at: 0,
            renewed: 0,
            stands: 0,
            mean: N::ZERO,
        }
    }
}

impl<N: Number, const SEGMENTS: usize> Fluctuation<N> for CycleMean<SEGMENTS, N> {
    type Config = CycleMeanConfig<N>;

    #[inline(always)]
    fn measure(&mut self, config: &CycleMeanConfig<N>, angle: u32, _torque: N, estimate: &Estimate<N>) {
        self.tick = self.tick.wrapping_add(1);
        if self.position.within(angle) >= config.cycle.length {
            self.pass(config, angle, estimate.motor_speed);
        }
    }

    /// A tick or some without a usable angle are no harm: the end of a segment is then seen a little late. Where ticks
    /// are not measured at all, as while the angle is lost or the drive is held, it begins anew.
    fn disturb(&mut self) {
        if self.disturbed == self.tick {
            self.give_up();
        }
        self.disturbed = self.tick;
    }

    #[inline(always)]
    fn steady_speed(&self) -> Option<N> {
        if self.tick.wrapping_sub(self.renewed) < self.stands { Some(self.mean) } else { None }
    }
}

impl<N: Number, const SEGMENTS: usize> CycleMean<SEGMENTS, N> {
    fn give_up(&mut self) {
        self.known = 0;
        self.stands = 0;
    }

    /// A tick that ends a segment.
    #[cold]
    #[inline(never)]
    fn pass(&mut self, config: &CycleMeanConfig<N>, angle: u32, speed: N) {
        let before = self.position.segment;
        let crossing = self.position.pass(&config.cycle, angle);
        let passed = self.position.segment.wrapping_sub(before) & config.cycle.last_segment;
        if crossing == Crossing::Lost {
            self.give_up();
            return;
        }
        if passed == 0 {
            // Between the last segment's end and the cycle's.
            return;
        }
        let forward = passed == 1;
        if forward != self.forward {
            self.give_up();
            self.forward = forward;
        }
        let within = self.position.within(angle);
        let beyond = if forward { within } else { config.cycle.length.wrapping_sub(within) };
        let now = Mark { tick: self.tick, beyond: beyond >> 6, speed };
        let Some(place) = self.marks.get_mut(self.at as usize & (SEGMENTS - 1)) else { return };
        let then = core::mem::replace(place, now);
        self.at = self.at.wrapping_add(1);
        if (self.known as usize) < SEGMENTS {
            self.known += 1;
            return;
        }
        let ticks = now.tick.wrapping_sub(then.tick);
        if ticks == 0 || ticks > LONGEST {
            self.stands = 0;
            return;
        }
        // Turned in a tick, in two digits: the angle is below 2^31 and the remainder of the first division below 2^22.
        let turned = config.angle.wrapping_add(now.beyond).wrapping_sub(then.beyond);
        let (whole, rest) = (turned / ticks, turned % ticks);
        let per_tick = (whole << 6 | ((rest << 10) / ticks) >> 4) as i32;
        let mean = N::from_angle(if forward { per_tick } else { per_tick.wrapping_neg() }).speed_of_turn(config.speed);
        let change = (now.speed - then.speed).scaled(N::fraction(1 << 31));
        self.mean = (mean + change).saturated();
        self.renewed = self.tick;
        self.stands = (ticks / SEGMENTS as u32).wrapping_mul(4).wrapping_add(4);
    }
}
