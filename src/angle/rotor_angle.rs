//! The angle of a rotor behind a gear, exact over any number of turns.

/// Least number of units on a turn: the angle that is passed on has a resolution of 2^-26 turns (1e-7 rad).
const UNITS: u32 = 1 << 26;

/// A gear as the tick path loads it.
///
/// Behind a gear of `p/q` turns of the rotor to one of the motor the rotor's angle does not follow from the motor's,
/// which wraps. Its increments do: the position is counted in units of `1/q` of 2^-32 turn, of which a motor's
/// increment is a whole number `p`. So the sum is exact, and it wraps where the rotor has turned once. After a year of
/// turns it is where it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RotorAngleConfig {
    /// Units that the rotor turns by, for a turn of the motor; negative where the rotor turns the other way.
    pub(crate) step: i32,
    /// Units on a turn of the rotor.
    pub(crate) turn: u32,
    /// 2^58 over the units on a turn.
    pub(crate) inverse: u32,
}

impl RotorAngleConfig {
    /// `turns` of the rotor, times the order, to `motor_turns` of the motor. The numbers of teeth will do, or their
    /// products.
    ///
    /// The rotor has to turn forwards where it is measured: for a motor that turns backwards, or a gear that reverses,
    /// take `turns` negative.
    ///
    /// `None` where `motor_turns` is not between 1 and 2^20, or the ratio not between 1/65536 and 15.
    pub const fn new(turns: i32, motor_turns: u32) -> Option<Self> {
        if motor_turns == 0 || motor_turns > 1 << 20 || turns == 0 {
            return None;
        }
        let scale = (2 * UNITS - 1) / motor_turns;
        let turn = scale * motor_turns;
        let step = scale as i64 * turns as i64;
        let size = step.abs();
        if size > 15 * turn as i64 || size < (turn >> 16) as i64 || turn < UNITS {
            return None;
        }
        // turn is above 2^26 - 1, and 2^58 / 2^26 just out of a word
        let inverse = (1_u64 << 58) / turn as u64;
        let inverse = if inverse > u32::MAX as u64 { u32::MAX } else { inverse as u32 };
        Some(RotorAngleConfig { step: step as i32, turn, inverse })
    }

    /// Turns of the rotor (times the order) to a turn of the motor.
    pub const fn ratio(&self) -> f64 {
        self.step as f64 / self.turn as f64
    }
}

/// Whether a rotor has passed its zero in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passed {
    /// It has not.
    Not,
    /// Forwards.
    Zero,
    /// Backwards.
    Astray,
}

/// Where a rotor is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct RotorAngle {
    /// The motor's angle at the last tick (2^-32 turn).
    motor: u32,
    /// Units of the rotor's position in the upper word, 2^-32 units in the lower.
    position: i64,
}

impl RotorAngle {
    /// Follows the motor to an angle (2^-32 turn); false where the rotor has passed its zero: then call
    /// [`RotorAngle::wrap`].
    #[inline(always)]
    pub(crate) fn follow(&mut self, config: &RotorAngleConfig, motor: u32) -> bool {
        let turned = motor.wrapping_sub(self.motor) as i32;
        self.motor = motor;
        self.position = self.position.wrapping_add(turned as i64 * config.step as i64);
        self.units() < config.turn
    }

    /// Begins the next turn; false where the rotor has turned backwards, or by more than a turn at once.
    #[inline(always)]
    pub(crate) fn wrap(&mut self, config: &RotorAngleConfig) -> bool {
        let forwards = self.position >= 0;
        let turn = i64::from(config.turn) << 32;
        self.position = self.position.wrapping_sub(if forwards { turn } else { turn.wrapping_neg() });
        if self.units() < config.turn {
            return forwards;
        }
        self.position = 0;
        false
    }

    /// Follows the motor to an angle (2^-32 turn), and returns whether the rotor has passed its zero.
    #[inline(always)]
    pub(crate) fn advance(&mut self, config: &RotorAngleConfig, motor: u32) -> Passed {
        let turned = motor.wrapping_sub(self.motor) as i32;
        self.motor = motor;
        let position = self.position.wrapping_add(turned as i64 * config.step as i64);
        if ((position >> 32) as u32) < config.turn {
            self.position = position;
            return Passed::Not;
        }
        // The same comparison with the sign: what is backwards is below. A rotor that has come a turn further wraps
        // once a tick until it has not.
        if (position >> 32) as i32 >= config.turn as i32 {
            self.position = position.wrapping_sub(i64::from(config.turn) << 32);
            return Passed::Zero;
        }
        let back = position.wrapping_add(i64::from(config.turn) << 32);
        self.position = if ((back >> 32) as u32) < config.turn { back } else { 0 };
        Passed::Astray
    }

    /// The rotor's angle times the order (2^-26 turn).
    #[inline(always)]
    pub(crate) fn direction(&self, config: &RotorAngleConfig) -> u32 {
        ((u64::from(self.units()) * u64::from(config.inverse)) >> 32) as u32
    }

    /// Whole units of the position.
    #[inline(always)]
    pub(crate) fn units(&self) -> u32 {
        (self.position >> 32) as u32
    }

    /// The rotor's angle times the order (2^-32 turn).
    #[inline(always)]
    pub fn angle(&self, config: &RotorAngleConfig) -> u32 {
        ((u64::from(self.units()) * u64::from(config.inverse)) >> 26) as u32
    }

    /// Sets the rotor's angle (2^-32 turn) at an angle of the motor (2^-32 turn), as an index on the rotor shows it.
    pub fn set_at(&mut self, config: &RotorAngleConfig, motor: u32, angle: u32) {
        self.motor = motor;
        self.set(config, angle);
    }

    /// Sets the rotor's angle (2^-32 turn) at the motor's angle of the last tick.
    pub fn set(&mut self, config: &RotorAngleConfig, angle: u32) {
        self.position = i64::from(angle) * i64::from(config.turn);
    }
}
