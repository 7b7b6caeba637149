//! Contribution of each cylinder, from the orders of the speed below the firing order.
//!
//! Equal cylinders that fire evenly give only multiples of the firing order. A cylinder whose torque differs from the
//! others' by `d` adds to the m-th order of the cycle `2 d P(m)` in the phase of its firing. So the differences follow
//! from the torque's orders below the firing order by an inverse discrete Fourier transform. Torques of compression
//! and of the masses are the same for all cylinders and cancel.
//!
//! The torque is that which accelerates the inertia, `d/dphi (J omega^2/2)`, with a crankshaft that is rigid at the orders
//! used. Behind an elastic coupling (k, d) the load J_l swings by itself: at the frequency w of an order, J is
//! `J_e + J_l (k + j w d)/(k - J_l w^2 + j w d)` \[derived\]. `P` is that of a combustion torque `x e^(-x/a)` behind
//! the dead centre, with its largest value at the angle `a`: `1/(1 + j k a)^2` at the k-th order of a turn.

use core::f64::consts::TAU;

use super::Ripple;
use super::series::{FourierSeries, Order, circle};
use crate::math::{hypot, sin_cos, sqrt};
use crate::number::Real;

/// An engine with `CYLINDERS` cylinders that fire evenly, once in the cycle of its ripple.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Engine<const CYLINDERS: usize> {
    /// Numbers of the cylinders in the order in which they fire.
    pub firing_order: [u8; CYLINDERS],
    /// Top dead centre before the first of them fires: angle from the beginning of the cycle (rad).
    pub first: f64,
    /// From top dead centre to the largest torque of combustion (rad); 0.6 as a rule.
    pub peak: f64,
    /// Inertia of engine and flywheel, and of all that is rigidly coupled to them (kg m2).
    pub inertia: f64,
    /// The elastic coupling of the load; `None` where the load is rigidly coupled.
    pub coupling: Option<Coupling>,
    /// Turns of the crank to a cycle: 2 of a four-stroke engine, 1 of a two-stroke engine.
    pub turns: u32,
}

/// An elastic coupling and the load behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Coupling {
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Inertia of the load (kg m2).
    pub load: f64,
}

impl<const CYLINDERS: usize> Engine<CYLINDERS> {
    /// Torque over acceleration at a frequency (rad/s), real and imaginary part (kg m2).
    fn inertia_at(&self, frequency: f64) -> (f64, f64) {
        let Some(Coupling { stiffness, damping, load }) = self.coupling else { return (self.inertia, 0.0) };
        let (free, loss) = (stiffness - load * frequency * frequency, frequency * damping);
        let share = load / (free * free + loss * loss);
        (self.inertia + share * (stiffness * free + loss * loss), share * loss * (free - stiffness))
    }
}

/// Verdict on a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CylinderVerdict {
    /// At least 0.9 of the others.
    Good,
    /// Between 0.4 and 0.9 of the others, and short by more than a third of what the weakest lacks.
    Weak,
    /// Less than 0.4 of the others.
    Misfire,
    /// The scatter of the cycles is too large to tell 0.9 from 1: average over more cycles.
    Uncertain,
}

/// A cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CylinderReading {
    /// Its number.
    pub number: u8,
    /// Its mean torque over the cycle (N m).
    pub torque: f64,
    /// Its torque over the median of all.
    pub share: f64,
    /// Standard deviation of the share, from the scatter of the cycles' teeth.
    pub deviation: f64,
    /// Verdict.
    pub verdict: CylinderVerdict,
}

/// Shares that separate a good cylinder, a weak one and a misfire.
const WEAK: f64 = 0.9;
const MISFIRE: f64 = 0.4;

/// Part of the largest shortfall that the others may show where the combustion is not the one assumed.
const LEAKED: f64 = 0.35;

/// Standard deviations between a good share and its limit that are certain enough. The scatter of a cycle is mostly in
/// the lowest orders; taken as even over all it is stated too large.
const CERTAIN: f64 = 2.0;

impl<R: Real> Ripple<R> {
    /// The cylinders in the firing order, from a ripple whose orders reach half the number of cylinders, and from the
    /// mean torque of the engine's gases (N m): that of the load, friction included.
    ///
    /// `teeth` is the number that a cycle was measured by: the deviation takes the scatter of its teeth as independent.
    /// With fewer orders every cylinder is [`CylinderVerdict::Uncertain`], its deviation NaN.
    pub fn cylinders<const CYLINDERS: usize>(
        &self,
        engine: &Engine<CYLINDERS>,
        mean_torque: f64,
        teeth: usize,
    ) -> [CylinderReading; CYLINDERS] {
        let turns = f64::from(engine.turns.max(1));
        let count = CYLINDERS.max(1) as f64;
        let circle = circle();
        let half = CYLINDERS / 2;
        let [mean, spread] = [self.mean, self.quality.spread].map(Into::<f64>::into);
        let energy = self.speed.grid(&super::series::circle()).map(|speed| 0.5 * speed.into() * speed.into());
        let per_inertia = FourierSeries::of(&energy, &circle, half).derivative();
        let mut differences = [0.0; CYLINDERS];
        let mut variance = 0.0;
        // The scatter of an amplitude (rad) over its teeth and cycles, and of the order of the torque that it makes.
        let scatter = spread / sqrt(0.5 * teeth.max(1) as f64 * f64::from(self.cycles.max(1)));
        for (m, order) in (1_u32..).zip(per_inertia.orders.iter().take(half)) {
            let k = f64::from(m) / turns;
            // (1 + j k a)^2/2, as a complex number.
            let ka = k * engine.peak;
            let (re, im) = (0.5 * (1.0 - ka * ka), ka);
            // cos - j sin, per radian of the crank.
            let (a, b) = (order.cos / turns, -order.sin / turns);
            let (j, lag) = engine.inertia_at(k * mean);
            let (a, b) = (a * j - b * lag, a * lag + b * j);
            let sum = Order { cos: a * re - b * im, sin: a * im + b * re };
            let alone = 2 * m as usize == CYLINDERS;
            let weight = if alone { 1.0 } else { 2.0 } / count;
            for (place, difference) in (0_u32..).zip(&mut differences) {
                let firing = engine.first / turns + TAU * f64::from(place) / count;
                let (s, c) = sin_cos(f64::from(m) * firing);
                *difference += weight * (sum.cos * c - sum.sin * s);
            }
            let size = 0.5 * (1.0 + ka * ka) * hypot(j, lag) * mean * mean * k * k * scatter;
            variance += weight * weight * size * size;
        }
        let own = mean_torque / count;
        let mut sorted = differences;
        sorted.sort_unstable_by(f64::total_cmp);
        let at = |index: usize| sorted.get(index).copied().unwrap_or(0.0);
        let median = own + 0.5 * (at(half) + at((CYLINDERS.saturating_sub(1)) / 2));
        // an order that is exactly zero was not among those of the ripple
        let missing = self.speed.orders.iter().take(half).any(|order| *order == Order::default());
        let deviation = if missing { f64::NAN } else { sqrt(variance) / median.abs() };
        let largest = differences.iter().fold(0.0_f64, |most, difference| most.max(1.0 - (own + difference) / median));
        let mut cylinders =
            [CylinderReading { number: 0, torque: 0.0, share: 0.0, deviation, verdict: CylinderVerdict::Good };
                CYLINDERS];
        for ((cylinder, &number), &difference) in cylinders.iter_mut().zip(&engine.firing_order).zip(&differences) {
            let share = (own + difference) / median;
            cylinder.number = number;
            cylinder.torque = own + difference;
            cylinder.share = share;
            cylinder.verdict = if !(deviation * CERTAIN < 1.0 - WEAK && median > 0.0) {
                CylinderVerdict::Uncertain
            } else if share < MISFIRE {
                CylinderVerdict::Misfire
            } else if share < WEAK && 1.0 - share > LEAKED * largest {
                CylinderVerdict::Weak
            } else {
                CylinderVerdict::Good
            };
        }
        cylinders
    }
}
