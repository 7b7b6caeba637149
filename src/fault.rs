//! Fault flags of a tick. A tick never fails; it returns a value and raises flags.

use core::fmt;
use core::ops::{BitAnd, BitOr, BitOrAssign};

/// A set of faults.
///
/// ```
/// use driveline::fault::Faults;
/// let faults = Faults::NONE.with(Faults::TORQUE).with(Faults::SETPOINT);
/// assert!(faults.contains(Faults::TORQUE) && !faults.contains(Faults::ANGLE_LOST));
/// ```
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Faults(u32);

impl Faults {
    /// Nothing wrong.
    pub const NONE: Faults = Faults(0);
    /// The applied torque of the sample was NaN, infinite or beyond the drive's limit; the tick used the last command
    /// instead, or without a governor the last plausible torque. From an
    /// [`ActuatorMonitor`](crate::governor::ActuatorMonitor): not the torque that was commanded; the expected one was
    /// used.
    pub const TORQUE: Faults = Faults(1 << 5);
    /// The speed setpoint was NaN, infinite or beyond the drive's limit; the last good one stands.
    pub const SETPOINT: Faults = Faults(1 << 1);
    /// The motor angle jumped further from the prediction than any torque could have moved the motor; the tick
    /// went by the prediction alone.
    pub const ANGLE_JUMP: Faults = Faults(1 << 2);
    /// The motor angle stands still while the motor turns; the tick went by the prediction alone.
    pub const ANGLE_FROZEN: Faults = Faults(1 << 3);
    /// The angle has been unusable for longer than the estimates stay good without it; the drive commands no torque
    /// until two successive angles give position and speed.
    pub const ANGLE_LOST: Faults = Faults(1 << 4);
    /// A state of the observer is beyond its fixed-point base, which is beyond the machine's limits; at twice the base
    /// it is held.
    pub const RANGE: Faults = Faults(1 << 0);
    /// The angle's sensor gave none that is new and sound: its bus, a parity or an error bit of its own, a tooth that
    /// is overdue. The tick went by the prediction alone.
    pub const ANGLE_MISSING: Faults = Faults(1 << 24);
    /// The vibration's sensor gave no sample that is new and sound; none was taken.
    pub const VIBRATION_MISSING: Faults = Faults(1 << 25);
    /// The vibration's sensor was at an end of its range; no sample was taken.
    pub const VIBRATION_CLIPPED: Faults = Faults(1 << 29);
    /// The torque could not be written to its output.
    pub const TORQUE_OUTPUT: Faults = Faults(1 << 26);
    /// A line of the enable chain or the trip output could not be set.
    pub const ENABLE: Faults = Faults(1 << 27);
    /// The axis has tripped: no torque, its enable chain taken back, until it is started again.
    pub const TRIPPED: Faults = Faults(1 << 28);
    /// Ticks did not run before this one; up to [`MADE_UP`](crate::drive::MADE_UP) were made up by prediction.
    pub const TICK_MISSED: Faults = Faults(1 << 30);

    /// The load is blocked: it jams, or a brake is closed or drags. From the motor's side these are the same.
    pub const LOAD_BLOCKED: Faults = Faults(1 << 6);
    /// The load is lost: a rope or a coupling is broken or slips, or the load stands on the ground.
    pub const LOAD_LOST: Faults = Faults(1 << 7);
    /// The machine does not follow the torque that is commanded: the power stage gives less, the torque constant or
    /// the angle's sign or ratio is wrong, or the load is more than the motor can hold.
    pub const NOT_FOLLOWED: Faults = Faults(1 << 8);
    /// Motor or load is faster than permitted.
    pub const OVERSPEED: Faults = Faults(1 << 9);
    /// The shaft's torque is beyond its limit.
    pub const SHAFT_OVERLOAD: Faults = Faults(1 << 10);
    /// The reported torque is not the commanded one: the power stage does not follow, or its report is wrong.
    pub const TORQUE_REPORT: Faults = Faults(1 << 11);
    /// The motor turns behind a closed brake.
    pub const BRAKE_SLIP: Faults = Faults(1 << 12);
    /// A stop of the supervision has ended: no torque is commanded, and the brake is to be closed.
    pub const STOPPED: Faults = Faults(1 << 13);

    /// [`Adaptive::background`](crate::adaptive::Adaptive::background) has not run for a second: the gains do not follow
    /// load and rope, and nothing is learnt.
    pub const BACKGROUND_MISSING: Faults = Faults(1 << 15);

    /// The causes of a [`Supervised`](crate::governor::Supervised) governor's stops.
    pub const SUPERVISION: Faults = Faults(0x1fc0);

    /// Every flag with its name.
    pub const NAMES: [(Faults, &'static str); 22] = [
        (Faults::TORQUE, "torque"),
        (Faults::SETPOINT, "setpoint"),
        (Faults::ANGLE_JUMP, "angle jump"),
        (Faults::ANGLE_FROZEN, "angle frozen"),
        (Faults::ANGLE_LOST, "angle lost"),
        (Faults::RANGE, "range"),
        (Faults::ANGLE_MISSING, "angle missing"),
        (Faults::VIBRATION_MISSING, "vibration missing"),
        (Faults::VIBRATION_CLIPPED, "vibration clipped"),
        (Faults::TORQUE_OUTPUT, "torque output"),
        (Faults::ENABLE, "enable"),
        (Faults::TRIPPED, "tripped"),
        (Faults::TICK_MISSED, "tick missed"),
        (Faults::LOAD_BLOCKED, "load blocked"),
        (Faults::LOAD_LOST, "load lost"),
        (Faults::NOT_FOLLOWED, "not followed"),
        (Faults::OVERSPEED, "overspeed"),
        (Faults::SHAFT_OVERLOAD, "shaft overload"),
        (Faults::TORQUE_REPORT, "torque report"),
        (Faults::BRAKE_SLIP, "brake slip"),
        (Faults::STOPPED, "stopped"),
        (Faults::BACKGROUND_MISSING, "background missing"),
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

    /// Whether any fault of `other` is among these.
    #[inline(always)]
    pub const fn intersects(self, other: Faults) -> bool {
        self.0 & other.0 != 0
    }

    /// The bits.
    #[inline(always)]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// These and those of `other`; `|` for constants.
    #[inline(always)]
    pub const fn with(self, other: Faults) -> Faults {
        Faults(self.0 | other.0)
    }

    /// [`Faults::RANGE`] where `beyond` is 1, none where it is 0.
    #[inline(always)]
    pub(crate) const fn range(beyond: u32) -> Faults {
        Faults(beyond)
    }

    /// [`Faults::BACKGROUND_MISSING`] where `overdue` is 1, none where it is 0.
    #[inline(always)]
    pub(crate) const fn background_missing(overdue: u32) -> Faults {
        Faults(overdue << 15)
    }

    /// The faults with these bits; bits that mean nothing are dropped.
    pub const fn from_bits(bits: u32) -> Faults {
        const ALL: u32 = {
            let (mut all, mut k) = (0, 0);
            while k < Faults::NAMES.len() {
                all |= Faults::NAMES[k].0.0;
                k += 1;
            }
            all
        };
        Faults(bits & ALL)
    }
}

impl BitOr for Faults {
    type Output = Faults;

    #[inline(always)]
    fn bitor(self, other: Faults) -> Faults {
        Faults(self.0 | other.0)
    }
}

impl BitAnd for Faults {
    type Output = Faults;

    #[inline(always)]
    fn bitand(self, other: Faults) -> Faults {
        Faults(self.0 & other.0)
    }
}

impl BitOrAssign for Faults {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Faults) {
        self.0 |= other.0;
    }
}

/// Shows the names, as the display does.
impl fmt::Debug for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Faults({self})")
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
