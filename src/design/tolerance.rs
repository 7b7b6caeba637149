//! Tolerances of a machine: how far it may differ from its description.

use super::Undescribed;
use crate::machine::TwoMass;
use crate::math::{exp, ln};

/// Between which factors of its value a quantity lies.
///
/// ```
/// use driveline::design::Spread;
/// let [tenth, rope] = [Spread::within(0.1), Spread::between(0.4, 2.4)];
/// assert!((tenth.max - 1.1).abs() < 1e-12 && rope.min == 0.4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Spread {
    /// The smallest factor, above 0 and at most 1.
    pub min: f64,
    /// The largest factor, 1 or above.
    pub max: f64,
}

impl Spread {
    /// Known exactly.
    pub const NONE: Self = Self { min: 1.0, max: 1.0 };

    /// A deviation either way, as a fraction.
    #[must_use]
    pub const fn within(fraction: f64) -> Self {
        Self { min: 1.0 - fraction, max: 1.0 + fraction }
    }

    /// Between two factors: a load of 0.05 to 1.1 times the one that is described.
    #[must_use]
    pub const fn between(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// Mean square of the deviation from 1, uniform between the two factors.
    pub(super) const fn mean_square(&self) -> f64 {
        let (low, high) = (self.min - 1.0, self.max - 1.0);
        (low * low + low * high + high * high) / 3.0
    }

    /// The middle of the range plus a number of half ranges.
    pub(super) const fn mean_plus(&self, halves: f64) -> f64 {
        0.5 * (self.min + self.max + halves * (self.max - self.min))
    }

    const fn is_sound(&self) -> bool {
        self.min > 0.0 && self.min <= 1.0 && self.max >= 1.0 && self.max.is_finite()
    }

    /// Points from the least to the most of which each is at most twice the one before.
    const fn points(&self) -> u32 {
        let mut points = if self.max > self.min { 2 } else { 1 };
        let mut reach = 2.0 * self.min;
        while reach < self.max {
            reach *= 2.0;
            points += 1;
        }
        points
    }

    /// One of the points, in equal ratios.
    const fn at(&self, point: u32) -> f64 {
        let last = self.points() - 1;
        if point == 0 {
            self.min
        } else if point >= last {
            self.max
        } else {
            self.min * exp(ln(self.max / self.min) * point as f64 / last as f64)
        }
    }
}

/// How far machine and motor may differ from their description.
///
/// ```
/// use driveline::design::{Spread, Tolerance};
/// // as usual, and a load between the empty hook and a tenth more than the chain has
/// const LIFT: Tolerance = Tolerance { load_inertia: Spread::between(0.05, 1.1), ..Tolerance::USUAL };
/// // inertias and stiffness at two ends each; the load at 0.05, and 22 times that in steps of two at most: six points
/// assert_eq!((Tolerance::USUAL.machines(), LIFT.machines()), (2 * 2 * 2, 2 * 6 * 2));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tolerance {
    /// Inertia on the motor side of the shaft.
    pub motor_inertia: Spread,
    /// Inertia on the load side.
    pub load_inertia: Spread,
    /// Stiffness of the shaft.
    pub stiffness: Spread,
    /// Acting torque over the reported one: the motor's torque constant.
    pub torque: Spread,
    /// Ticks by which the torque may act later than described.
    pub late: u32,
    /// Lag of the torque (s) on top of the actuator's.
    pub lag: f64,
    /// Torque at the shaft that is not reported, either way, as a fraction of rated torque.
    pub offset: f64,
    /// Efficiency of the gears, either way, as a difference.
    pub efficiency: f64,
    /// Gap of a backlash.
    pub gap: Spread,
    /// Damping of the shaft. The loop is tested with the least.
    pub damping: Spread,
    /// A resonance that the description leaves out.
    pub undescribed: Undescribed,
}

impl Tolerance {
    /// A machine by its drawings and a motor by its data sheet: motor side 10 %, load side and stiffness 20 %, torque
    /// constant 5 %, a torque that may come a tick late and through a current control of 500 Hz, an offset of 1 % of
    /// rated torque, an efficiency off by 3 points, a gap off by 30 %, damping of a tenth to twice, and
    /// [`Undescribed::USUAL`].
    pub const USUAL: Self = Self {
        motor_inertia: Spread::within(0.1),
        load_inertia: Spread::within(0.2),
        stiffness: Spread::within(0.2),
        torque: Spread::within(0.05),
        late: 1,
        lag: 1.0 / (core::f64::consts::TAU * 500.0),
        offset: 0.01,
        efficiency: 0.03,
        gap: Spread::within(0.3),
        damping: Spread::between(0.1, 2.0),
        undescribed: Undescribed::USUAL,
    };

    /// Everything is as described.
    pub const NONE: Self = Self {
        motor_inertia: Spread::NONE,
        load_inertia: Spread::NONE,
        stiffness: Spread::NONE,
        torque: Spread::NONE,
        late: 0,
        lag: 0.0,
        offset: 0.0,
        efficiency: 0.0,
        gap: Spread::NONE,
        damping: Spread::NONE,
        undescribed: Undescribed::NONE,
    };

    /// Whether every field is in its range.
    pub(super) const fn is_sound(&self) -> bool {
        let Self { motor_inertia, load_inertia, stiffness, torque, lag, offset, efficiency, gap, .. } = self;
        let inertias = motor_inertia.is_sound() && load_inertia.is_sound();
        let spreads = inertias && stiffness.is_sound() && self.damping.is_sound() && torque.is_sound();
        let rest = *offset >= 0.0 && offset.is_finite() && *efficiency >= 0.0 && *efficiency < 1.0;
        spreads
            && rest
            && self.undescribed.is_sound()
            && gap.min >= 0.0
            && gap.max >= gap.min
            && *lag >= 0.0
            && lag.is_finite()
    }

    /// Number of machines that sample these tolerances: all combinations of the points of both inertias and the
    /// stiffness.
    #[must_use]
    pub const fn machines(&self) -> u32 {
        self.motor_inertia.points() * self.load_inertia.points() * self.stiffness.points()
    }

    /// One of the [`machines`](Self::machines), by its index from 0, with the least damping.
    #[must_use]
    pub const fn machine(&self, nominal: &TwoMass, index: u32) -> TwoMass {
        let (motor, load) = (self.motor_inertia.points(), self.load_inertia.points());
        let mut machine = *nominal;
        machine.motor_inertia *= self.motor_inertia.at(index % motor);
        machine.load_inertia *= self.load_inertia.at(index / motor % load);
        machine.stiffness *= self.stiffness.at(index / motor / load);
        machine.damping *= self.damping.min;
        machine
    }
}
