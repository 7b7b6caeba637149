//! Counts of the shaft torque for a machine.

use super::{Configure, Machine};
use crate::fatigue::{Rainflow, TorqueClasses, WoehlerLine};
use crate::number::Fixed;

/// A machine whose shaft's life is counted.
pub trait HasLife: Machine {
    /// S-N curve of the shaft.
    const SHAFT: WoehlerLine;
    /// The torque to which the classes reach (N m), either way.
    const CLASSED_TORQUE: f64 = 1.5 * Self::RATING.torque_limit.0;
    /// The torque beyond which time is counted (N m), either way.
    const OVERLOAD: f64 = Self::RATING.torque_limit.0;
}

macro_rules! rainflow {
    ($number:ident $(, $base:expr)?) => {
        impl<M: HasLife, const CLASSES: usize> Configure<M, $number> for Rainflow<CLASSES> {
            type Config = TorqueClasses<$number>;
            const CONFIG: Self::Config =
                TorqueClasses::<$number>::new::<CLASSES>(M::CLASSED_TORQUE $(, $base)?).with_period(M::PERIOD);
        }
    };
}

rainflow!(f32);
rainflow!(f64);
rainflow!(Fixed, M::BASES.torque);
