//! Design of an input shaper: a setpoint that leaves no vibration behind.

use core::f64::consts::PI;

use super::Error;
use crate::machine::{Length, STANDARD_GRAVITY};
use crate::math::{exp, hypot, sin_cos, sqrt};

/// Design of an [`InputShaper`](crate::governor::InputShaper).
///
/// A change of the setpoint is given in parts, half a damped period apart. Each part's vibration cancels that of the
/// parts before it. With `K = exp(-zeta pi/sqrt(1 - zeta^2))`, the decay within half a period, two parts have the
/// shares `1/(1+K)` and `K/(1+K)` (zero vibration, ZV); three have those of two such pairs in a row (ZVD, zero
/// derivative by the frequency) [Singer and Seering 1990, J. Dyn. Syst. Meas. Control 112(1); Smith 1957, posicast].
///
/// ```
/// use driveline::design::InputShaperDesign;
/// let shaper = InputShaperDesign::new(1.8, 0.0);
/// assert!(shaper.residual(2, 1.8, 0.0) < 1e-9); // two parts leave nothing of the swing
/// assert!(shaper.residual(3, 2.0, 0.0) < shaper.residual(2, 2.0, 0.0)); // three bear another rope
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InputShaperDesign {
    /// Time between two parts (s): half a damped period.
    pub delay: f64,
    /// Share of the later of two parts, above 0 and at most 1/2.
    pub share: f64,
}

impl InputShaperDesign {
    stops! {
        /// For a vibration of a natural frequency (rad/s) and damping ratio.
        pub const fn new(frequency: f64, damping: f64) -> Self = try_new
    }

    /// [`new`](Self::new), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::Shaper`].
    pub const fn try_new(frequency: f64, damping: f64) -> Result<Self, Error> {
        if !(frequency > 0.0 && frequency.is_finite() && damping >= 0.0 && damping < 1.0) {
            return Err(Error::Shaper);
        }
        let damped = sqrt((1.0 - damping) * (1.0 + damping));
        let decay = exp(-PI * damping / damped);
        Ok(Self { delay: PI / (frequency * damped), share: decay / (1.0 + decay) })
    }

    /// For a load on a rope (m) under a trolley whose speed is held: `sqrt(g/l)`, undamped.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    #[must_use]
    pub const fn pendulum(rope: Length) -> Self {
        Self::new(sqrt(STANDARD_GRAVITY / rope.0), 0.0)
    }

    /// The design for a rope of the length `from`, at the length `to` (m): the frequency goes with the inverse root of
    /// the length. The speed loop that holds the trolley changes it by the same share at both lengths, if its bandwidth
    /// is well above the swing's frequency.
    ///
    /// # Errors
    /// [`Error::Shaper`].
    pub const fn try_at_rope(self, from: Length, to: Length) -> Result<Self, Error> {
        let delay = self.delay * sqrt(to.0 / from.0);
        if from.0 > 0.0 && to.0 > 0.0 && delay > 0.0 && delay.is_finite() {
            Ok(Self { delay, ..self })
        } else {
            Err(Error::Shaper)
        }
    }

    /// Ticks of one of so many slots between two parts. A delay that is 2 % off leaves 3 % of the swing with two parts:
    /// none where whole ticks are further off.
    pub(crate) const fn slot(&self, slots: u32, period: f64) -> Option<u32> {
        let exact = self.delay / (slots as f64 * period);
        let slot = (exact + 0.5) as u32;
        let off = slot as f64 / exact - 1.0;
        let is_near = off <= 0.02 && off >= -0.02;
        if slot >= 1 && exact < 2_147_483_647.0 && is_near { Some(slot) } else { None }
    }

    /// Vibration that a shaper of so many parts leaves at another frequency (rad/s) and damping ratio, over that of the
    /// unshaped setpoint at the same time: `|1 - v + v exp((zeta omega + i omega_d) d)|^(parts - 1)` with the share v
    /// and the delay d.
    ///
    /// Without damping, and with a frequency off by the fraction r, `|sin(pi r/2)|^(parts - 1)`: at 5 % 7.8 % of two
    /// parts and 0.62 % of three. A rope 10 % longer has -4.7 %, which leaves 7.3 and 0.53 %; one 10 % shorter has
    /// +5.4 %, which leaves 8.5 and 0.72 %.
    #[must_use]
    pub const fn residual(&self, parts: u32, frequency: f64, damping: f64) -> f64 {
        let growth = self.share * exp(damping * frequency * self.delay);
        let (sine, cosine) = sin_cos(frequency * sqrt((1.0 - damping) * (1.0 + damping)) * self.delay);
        let pair = hypot(1.0 - self.share + growth * cosine, growth * sine);
        let (mut left, mut part) = (1.0, 1);
        while part < parts {
            left *= pair;
            part += 1;
        }
        left
    }
}
