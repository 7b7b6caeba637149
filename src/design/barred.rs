//! Speeds that a machine must not dwell at: where an order of its excitation meets a torsional frequency.

use super::Error;
use crate::machine::{Cylinder, Modes, phasor_sum};

/// Margin to a critical speed, either side, within which a machine should not dwell: 10 %.
pub const USUAL_MARGIN: f64 = 0.1;

/// Barred ranges of speed, rising and apart, at most `K`.
///
/// ```
/// use driveline::design::{BarredSpeeds, USUAL_MARGIN};
/// // an engine's order 1.5 on a coupling of 20 Hz: 83.8 rad/s
/// let barred = BarredSpeeds::<1>::new(&[125.66], &[1.5], USUAL_MARGIN, 140.0);
/// assert!(barred.ranges()[0][0] < 83.8 && barred.ranges()[0][1] > 83.8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BarredSpeeds<const K: usize> {
    ranges: [[f64; 2]; K],
    count: usize,
}

impl<const K: usize> BarredSpeeds<K> {
    stops! {
        /// The ranges about the critical speeds `frequency/order` [derived; heading: Pfützner 1980 ch. 1], as wide as
        /// `margin` of them either way, as far as they begin below `up_to` (rad/s). Ranges that touch are one.
        ///
        /// `frequencies` (rad/s) of the torsional vibration, `orders` in multiples of a turn (a four-stroke engine has
        /// 1/2, 1, 3/2 ...).
        pub const fn new(frequencies: &[f64], orders: &[f64], margin: f64, up_to: f64) -> Self = try_new
    }

    /// [`new`](Self::new), with an error instead of a panic.
    ///
    /// # Errors
    /// [`Error::Barred`] for a frequency or order that is not positive and finite, or a margin that is not above 0 and
    /// below 1; [`Error::BarredCount`] for more ranges than `K`.
    pub const fn try_new(frequencies: &[f64], orders: &[f64], margin: f64, up_to: f64) -> Result<Self, Error> {
        if !(margin > 0.0 && margin < 1.0) {
            return Err(Error::Barred);
        }
        let mut barred = BarredSpeeds { ranges: [[0.0; 2]; K], count: 0 };
        each!(f, 0..frequencies.len(), {
            each!(o, 0..orders.len(), {
                let (frequency, order) = (frequencies[f], orders[o]);
                if !(frequency > 0.0 && frequency.is_finite() && order > 0.0 && order.is_finite()) {
                    return Err(Error::Barred);
                }
                let critical = frequency / order;
                let range = [critical * (1.0 - margin), critical * (1.0 + margin)];
                if range[0] < up_to && !barred.take(range) {
                    return Err(Error::BarredCount);
                }
            });
        });
        Ok(barred)
    }

    /// The ranges about the critical speeds of a piston engine whose phasor sum is at least `least`, of the shape's
    /// amplitude where it is largest. Cylinder `j` works on the mass `at[j]`, counted from 0 at the motor, and the
    /// crankshaft turns at the motor's speed.
    ///
    /// # Panics
    /// At compile time in a constant, as [`new`](Self::new).
    #[must_use]
    pub const fn of_engine<const N: usize>(
        modes: &Modes,
        (cylinders, at): (&[Cylinder; N], [usize; N]),
        orders: &[f64],
        least: f64,
        margin: f64,
        up_to: f64,
    ) -> Self {
        or_stop!(Self::try_of_engine(modes, (cylinders, at), orders, least, margin, up_to))
    }

    /// [`of_engine`](Self::of_engine), with an error instead of a panic.
    ///
    /// # Errors
    /// As [`try_new`](Self::try_new); [`Error::Barred`] for a mass that the modes lack, or a `least` that is not zero or
    /// above and finite.
    pub const fn try_of_engine<const N: usize>(
        modes: &Modes,
        (cylinders, at): (&[Cylinder; N], [usize; N]),
        orders: &[f64],
        least: f64,
        margin: f64,
        up_to: f64,
    ) -> Result<Self, Error> {
        if !(least >= 0.0 && least.is_finite()) {
            return Err(Error::Barred);
        }
        // no range begins below zero: only the errors
        let mut barred = get!(Self::try_new(&[1.0], orders, margin, 0.0));
        each!(m, 0..modes.resonances().len(), {
            let mode = &modes.resonances()[m];
            let (mut throws, mut largest, mut j) = ([0.0; N], 0.0, 0);
            while j < N {
                if at[j] > modes.resonances().len() {
                    return Err(Error::Barred);
                }
                throws[j] = mode.shape[at[j]];
                j += 1;
            }
            j = 0;
            while j < mode.shape.len() {
                largest = max(largest, mode.shape[j].abs());
                j += 1;
            }
            each!(o, 0..orders.len(), {
                if phasor_sum(cylinders, &throws, orders[o]) >= least * largest {
                    match Self::try_new(&[mode.frequency], &[orders[o]], margin, up_to) {
                        Ok(one) if one.count == 0 || barred.take(one.ranges[0]) => {}
                        Ok(_) => return Err(Error::BarredCount),
                        Err(error) => return Err(error),
                    }
                }
            });
        });
        Ok(barred)
    }

    /// The ranges, lower and upper edge (rad/s).
    #[must_use]
    pub const fn ranges(&self) -> &[[f64; 2]] {
        self.ranges.split_at(self.count).0
    }

    /// Adds a range, joined with those that it touches; whether there was room.
    const fn take(&mut self, mut range: [f64; 2]) -> bool {
        let (mut kept, mut count, mut k) = ([[0.0; 2]; K], 0, 0);
        let mut placed = false;
        while k < self.count {
            let other = self.ranges[k];
            if other[1] < range[0] || placed && other[0] > range[1] {
                kept[count] = other;
                count += 1;
            } else if other[0] > range[1] {
                if count + 1 >= K {
                    return false;
                }
                kept[count] = range;
                kept[count + 1] = other;
                count += 2;
                placed = true;
            } else {
                range = [min(other[0], range[0]), max(other[1], range[1])];
            }
            k += 1;
        }
        if !placed {
            if count >= K {
                return false;
            }
            kept[count] = range;
            count += 1;
        }
        self.ranges = kept;
        self.count = count;
        true
    }
}

const fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

const fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
