//! Result of a count: cycles by range, time by torque, damage.

use super::WoehlerLine;

/// Places of a residue: of 128 classes 253 ranges at most, three in front of them, and one that is tried.
pub(super) const LONGEST: usize = 259;

/// Cycles, times and residue up to a moment.
///
/// ```
/// use driveline::fatigue::{Rainflow, TorqueClasses, WoehlerLine};
/// use driveline::{fluctuation::Fluctuation, sample::Estimate};
/// const CLASSES: TorqueClasses<f32> = TorqueClasses::<f32>::new::<64>(640.0).with_period(1e-3);
/// let mut rainflow = Rainflow::<64, f32>::default();
/// for tick in 0..4000 {
///     let shaft_torque = if tick / 20 % 2 == 0 { 310.0 } else { -290.0 };
///     rainflow.measure(&CLASSES, 0, 0.0, &Estimate { shaft_torque, ..Estimate::default() });
/// }
/// let counts = rainflow.counts(&CLASSES);
/// // half of 4 s above 300 N m
/// assert!((counts.time_above(300.0) - 2.0).abs() < 1e-9 && (counts.largest() - 310.0).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "Miner")]
pub struct Counts<const CLASSES: usize> {
    pub(super) width: f64,
    pub(super) period: f64,
    pub(super) cycles: [u32; CLASSES],
    pub(super) ticks: [u32; CLASSES],
    /// At the end, this many.
    pub(super) residue: [u8; LONGEST],
    pub(super) length: usize,
    pub(super) largest: f64,
    pub(super) lost: u32,
}

impl<const CLASSES: usize> Counts<CLASSES> {
    /// Closed cycles by their range in classes, from none on.
    pub fn cycles(&self) -> &[u32; CLASSES] {
        &self.cycles
    }

    /// Reversals that close no cycle, as classes; the last is the present torque. None of counts that were taken: there
    /// the residue stays on the tick.
    pub fn residue(&self) -> &[u8] {
        self.residue.get(LONGEST.saturating_sub(self.length)..).unwrap_or_default()
    }

    /// Ticks at which a reversal came too fast to be counted, since the count began; wraps, as the counts of ticks do.
    pub fn lost(&self) -> u32 {
        self.lost
    }

    /// Whether a torque was beyond the classes, since the last [`take`](super::Rainflow::take). It counted in the
    /// outermost one: the damage is that of a smaller cycle.
    pub fn exceeds_classes(&self) -> bool {
        self.largest > 0.5 * CLASSES as f64 * self.width
    }

    /// Damage by Miner's rule: the closed cycles, and each range of the residue as half a cycle. Too small where
    /// [`exceeds_classes`](Self::exceeds_classes).
    pub fn damage(&self, line: &WoehlerLine) -> f64 {
        self.closed_damage(line) + self.residual_damage(line)
    }

    /// Damage of the closed cycles.
    pub fn closed_damage(&self, line: &WoehlerLine) -> f64 {
        let each = (0_u32..).zip(&self.cycles).filter(|&(_, &cycles)| cycles > 0);
        each.map(|(range, &cycles)| f64::from(cycles) * self.of_range(line, range)).sum()
    }

    /// Damage of the residue, each of its ranges as half a cycle.
    pub fn residual_damage(&self, line: &WoehlerLine) -> f64 {
        let pairs = self.residue().windows(2);
        let range = |pair: &[u8]| match pair {
            [from, to] => u32::from(from.abs_diff(*to)),
            _ => 0,
        };
        pairs.map(|pair| 0.5 * self.of_range(line, range(pair))).sum()
    }

    fn of_range(&self, line: &WoehlerLine, range: u32) -> f64 {
        line.damage(0.5 * f64::from(range) * self.width)
    }

    /// Time in which the torque was beyond a limit (N m), either way, to the class (s, or ticks): classes that
    /// begin at the limit or beyond it. The outermost classes hold all that is beyond them: no limit divides them.
    pub fn time_above(&self, limit: f64) -> f64 {
        let middle = CLASSES as f64 / 2.0;
        let limit = limit.min((middle - 1.0) * self.width);
        let each = (0_u32..).zip(&self.ticks);
        let beyond = each.filter(|&(class, _)| {
            let low = f64::from(class) - middle;
            let nearest = if low < 0.0 { -(low + 1.0) } else { low };
            nearest * self.width >= limit
        });
        beyond.map(|(_, &ticks)| f64::from(ticks)).sum::<f64>() * self.period
    }

    /// The largest torque, either way (N m).
    pub fn largest(&self) -> f64 {
        self.largest
    }
}
