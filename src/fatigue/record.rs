//! A machine's life so far, as a part of the record in flash.

use serde::{Deserialize, Serialize};

use super::{Classed, TorqueClasses};
use super::{Counts, Rainflow, WoehlerLine};
use crate::parameters::Parameters;

/// Damage and largest torque over the machine's life: a field of one's own
/// [`Parameters`](crate::parameters::Parameters), or all of them.
///
/// It holds the closed cycles of all counts that were added. The residue of the present count stays on the tick until
/// [`LifeRecord::close`]. A largest torque beyond the classes means that the damage is too small.
///
/// ```
/// use driveline::fatigue::{LifeRecord, Rainflow, TorqueClasses, WoehlerLine};
/// use driveline::{fluctuation::Fluctuation, sample::Estimate};
/// const CLASSES: TorqueClasses<f32> = TorqueClasses::<f32>::new::<64>(640.0);
/// const STEEL: WoehlerLine = WoehlerLine { knee: 300.0, cycles: 1.0e6, slope: 5.0, below: 9.0 };
/// let (mut life, mut rainflow) = (LifeRecord::default(), Rainflow::<64, f32>::default());
/// for tick in 0..40_000 {
///     let shaft_torque = if tick / 20 % 2 == 0 { 310.0 } else { -290.0 };
///     rainflow.measure(&CLASSES, 0, 0.0, &Estimate { shaft_torque, ..Estimate::default() });
/// }
/// // 1000 cycles at the knee of a million, the last two still open; kept over a power cut, the count goes on from none
/// life.take(&mut rainflow, &CLASSES, &STEEL, 500.0);
/// assert!((life.damage / 1e-3 - 1.0).abs() < 3e-3 && (life.remaining() - 0.999).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LifeRecord {
    /// Damage by Miner's rule; failure at 1.
    pub damage: f64,
    /// Time beyond the limit of one's own (s).
    pub time_above: f64,
    /// The largest torque, either way (N m).
    pub largest: f64,
}

/// Alone in a flash of its own.
impl Parameters for LifeRecord {
    const IDENTITY: u32 = u32::from_be_bytes(*b"life");
    const VERSION: u16 = 1;
}

impl LifeRecord {
    /// Takes the closed cycles, the time above `limit` (N m) and the largest torque out of a running count: between
    /// two ticks.
    pub fn take<N: Classed, const CLASSES: usize>(
        &mut self,
        count: &mut Rainflow<CLASSES, N>,
        config: &TorqueClasses<N>,
        line: &WoehlerLine,
        limit: f64,
    ) {
        let taken: Counts<CLASSES> = count.take(config);
        self.damage += taken.closed_damage(line);
        self.add(&taken, limit);
    }

    /// Takes the whole count, each range of its residue as half a cycle, and the count begins anew: before the
    /// controller is switched off, so that the cycle from start to stop counts.
    pub fn close<N: Classed, const CLASSES: usize>(
        &mut self,
        count: &mut Rainflow<CLASSES, N>,
        config: &TorqueClasses<N>,
        line: &WoehlerLine,
        limit: f64,
    ) {
        let all = count.counts(config);
        *count = Rainflow::default();
        self.damage += all.damage(line);
        self.add(&all, limit);
    }

    fn add<const CLASSES: usize>(&mut self, counts: &Counts<CLASSES>, limit: f64) {
        self.time_above += counts.time_above(limit);
        self.largest = if counts.largest() > self.largest { counts.largest() } else { self.largest };
    }

    /// Share of the life that is left; none below zero.
    #[must_use]
    pub fn remaining(&self) -> f64 {
        if self.damage < 1.0 { 1.0 - self.damage } else { 0.0 }
    }
}
