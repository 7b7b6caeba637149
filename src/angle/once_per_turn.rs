//! The angle of a rotor with one pulse a turn: a photo tacho, or a mark on the shaft.

/// Turns of memory.
const MEMORY: usize = 12;
/// Zeros of the angle without a pulse until it is lost.
const MOST_TURNS: u32 = 3;
/// Pulses beside their place in a row until the angle is lost.
const MOST_ASTRAY: u32 = 3;

/// Gains of the pulses in angle and speed (2^-16): `2 (2 k - 1)/(k (k + 1))` and `6/(k (k + 1))` for the pulse `k`.
const GAINS: [[i64; 2]; MEMORY] = {
    let mut gains = [[0; 2]; MEMORY];
    each!(at, 0..MEMORY, {
        let k = at as i64 + 1;
        gains[at] = [2 * (2 * k - 1) * 65_536 / (k * (k + 1)), 6 * 65_536 / (k * (k + 1))];
    });
    gains
};

/// The angle of a rotor with one pulse a turn, advanced once a tick.
///
/// The pulse is the rotor's zero; [`crate::balancing::Phasors`] takes the angle as that of a motor.
///
/// Between pulses the angle grows with the speed of the turns before. Each pulse corrects angle and speed with the
/// gains of a straight line through the pulses so far, with a memory of twelve turns (alpha-beta filter of growing
/// memory). A pulse is only known to a tick. Less than that error is left in the angle, and next to none on average
/// over the turns of a reading.
///
/// ```
/// use driveline::angle::OncePerTurn;
///
/// let mut tacho = OncePerTurn::new();
/// // a pulse every 20 ticks, each 0.25 of a tick before the tick it is seen at
/// let angle = (0..200).filter_map(|tick| tacho.tick((tick % 20 == 0).then_some(1 << 30))).last().unwrap();
/// // 19.25 ticks after the last pulse
/// let expected = (19.25 / 20.0 * 4_294_967_296.0) as u32;
/// assert!(angle.abs_diff(expected) < 1 << 12);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OncePerTurn {
    /// Angle, and its growth in a tick (2^-64 turn).
    angle: u64,
    step: u64,
    /// Pulses in use.
    pulses: u32,
    /// Ticks since the first pulse, and how long before its tick it was (2^-32 tick).
    since: u32,
    late: u32,
    /// Turns since the last pulse; pulses beside their place since the last good one.
    turns: u32,
    astray: u32,
}

impl OncePerTurn {
    /// No pulse yet.
    pub const fn new() -> Self {
        OncePerTurn { angle: 0, step: 0, pulses: 0, since: 0, late: 0, turns: 0, astray: 0 }
    }

    /// Takes a tick, and returns the rotor's angle (2^-32 turn); `None` before the second pulse, and where pulses
    /// stay away or come astray.
    ///
    /// `pulse` is how long before this tick the pulse came (2^-32 tick), by a capture timer. Where a level is sampled
    /// that is half a tick on average: `1 << 31`.
    pub fn tick(&mut self, pulse: Option<u32>) -> Option<u32> {
        self.since = self.since.saturating_add(1);
        let (angle, wrapped) = self.angle.overflowing_add(self.step);
        self.angle = angle;
        self.turns = self.turns.saturating_add(u32::from(wrapped));
        if self.turns > MOST_TURNS {
            *self = OncePerTurn::new();
        }
        if let Some(late) = pulse {
            self.pulse(late);
        }
        (self.pulses >= 2).then_some((self.angle >> 32) as u32)
    }

    /// Turns that the rotor makes in a tick; zero before the second pulse.
    pub fn speed(&self) -> f32 {
        (self.step >> 32) as f32 / 4_294_967_296.0
    }

    fn pulse(&mut self, late: u32) {
        if self.pulses < 2 {
            let lasted = (u64::from(self.since) << 32).wrapping_add(u64::from(self.late)).wrapping_sub(u64::from(late));
            // a turn has eight ticks at least
            if self.pulses == 1 && lasted < 8 << 32 {
                return;
            }
            // 2^96 over it: twice in half the width
            let step = if self.pulses == 1 { ((1 << 63) / lasted) << 33 } else { 0 };
            *self = OncePerTurn { step, pulses: self.pulses + 1, late, ..OncePerTurn::new() };
            self.angle = self.passed(late);
            return;
        }
        // how far the rotor was past its zero when the pulse came
        let past = self.angle.wrapping_sub(self.passed(late)) as i64;
        if past.unsigned_abs() > 1 << 62 {
            self.astray += 1;
            if self.astray >= MOST_ASTRAY {
                *self = OncePerTurn { pulses: 1, late, ..OncePerTurn::new() };
            }
            return;
        }
        (self.turns, self.astray) = (0, 0);
        self.pulses = self.pulses.saturating_add(1);
        let place = (self.pulses as usize).min(MEMORY).saturating_sub(1);
        let [angle, speed] = GAINS.get(place).copied().unwrap_or([0, 0]);
        let error = -(past >> 32);
        self.angle = self.angle.wrapping_add(((error * angle) << 16) as u64);
        // over the ticks of a turn, which is times the turns of a tick
        let step = ((self.step >> 32) as i64 * error) >> 16;
        self.step = self.step.wrapping_add((step * speed) as u64);
    }

    /// How far the rotor turns in a part of a tick (2^-64 turn).
    fn passed(&self, late: u32) -> u64 {
        (self.step >> 32) * u64::from(late)
    }
}
