//! What can be wrong with a tick, as flags: the tick never fails, it returns a value and says what it thinks of it.

use core::fmt;
use core::ops::{BitOr, BitOrAssign};

/// A set of faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Faults(u32);

impl Faults {
    /// Nothing wrong.
    pub const NONE: Faults = Faults(0);
    /// The applied torque of the sample was NaN, infinite or beyond the drive's limit; the tick used the last command instead, or without a governor
    /// the last torque that was believed.
    pub const TORQUE: Faults = Faults(1 << 5);
    /// The speed set point was NaN, infinite or beyond the drive's limit; the last good one stands.
    pub const REFERENCE: Faults = Faults(1 << 1);
    /// The motor angle jumped further from the prediction than any torque could have moved the motor; the tick
    /// went by the prediction alone.
    pub const ANGLE_JUMP: Faults = Faults(1 << 2);
    /// The motor angle stands still while the motor turns; the tick went by the prediction alone.
    pub const ANGLE_FROZEN: Faults = Faults(1 << 3);
    /// The angle has been unusable for longer than the estimates stay good without it; the drive commands no torque until two angles in a row tell where the
    /// motor is and how it turns.
    pub const ANGLE_LOST: Faults = Faults(1 << 4);
    /// A state of the observer is beyond its fixed-point base, which is beyond the machine's limits; at twice the base it is held.
    pub const RANGE: Faults = Faults(1 << 0);

    /// Every flag with its name.
    pub const NAMES: [(Faults, &'static str); 6] = [
        (Faults::TORQUE, "torque"),
        (Faults::REFERENCE, "reference"),
        (Faults::ANGLE_JUMP, "angle jump"),
        (Faults::ANGLE_FROZEN, "angle frozen"),
        (Faults::ANGLE_LOST, "angle lost"),
        (Faults::RANGE, "range"),
    ];

    /// Whether there is none.
    #[inline(always)]
    pub const fn is_none(self) -> bool {
        self.0 == 0
    }

    /// Whether every fault of `other` is among these.
    #[inline(always)]
    pub const fn contains(self, other: Faults) -> bool {
        self.0 & other.0 == other.0
    }

    /// The bits.
    #[inline(always)]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// [`Faults::RANGE`] where `beyond` is 1, none where it is 0.
    #[inline(always)]
    pub(crate) const fn range(beyond: u32) -> Faults {
        Faults(beyond)
    }

    /// The faults with these bits; bits that mean nothing are dropped.
    pub const fn from_bits(bits: u32) -> Faults {
        Faults(bits & 0x3f)
    }
}

impl BitOr for Faults {
    type Output = Faults;

    #[inline(always)]
    fn bitor(self, other: Faults) -> Faults {
        Faults(self.0 | other.0)
    }
}

impl BitOrAssign for Faults {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Faults) {
        self.0 |= other.0;
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_none() {
            return f.write_str("none");
        }
        let mut between = "";
        for (fault, name) in Faults::NAMES {
            if self.contains(fault) {
                write!(f, "{between}{name}")?;
                between = ", ";
            }
        }
        Ok(())
    }
}
