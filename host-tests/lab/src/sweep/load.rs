//! Load program of the sweep: a load step, and a motor torque about it.

/// Load torque (N m).
pub const LOAD_TORQUE: f64 = 0.25;

/// Motor torques: the load's, more by a level for `hold` ticks and less by it for as many, then another level. The
/// first level is the largest; the others are pseudo-random. The mean speed is therefore bounded, and back at zero
/// after every pair.
///
/// Every torque is a multiple of 2^-10 N m, which all numbers hold exactly.
#[derive(Clone, Debug)]
pub struct Torques {
    hold: u64,
    left: u64,
    level: f64,
    rising: bool,
    random: u64,
}

impl Torques {
    /// Torques that are held for so many ticks.
    pub fn new(hold: u64) -> Self {
        Torques { hold, left: hold, level: 0.5, rising: true, random: 0x9e37_79b9_7f4a_7c15 }
    }

    /// The torque of the next tick (N m).
    #[inline]
    pub fn next(&mut self) -> f64 {
        if self.left == 0 {
            self.left = self.hold;
            self.rising = !self.rising;
            if self.rising {
                self.draw();
            }
        }
        self.left -= 1;
        if self.rising { LOAD_TORQUE + self.level } else { LOAD_TORQUE - self.level }
    }

    /// A level from -1/2 to 1/2 N m [Vigna 2016, ACM TOMS 42(4)].
    fn draw(&mut self) {
        self.random ^= self.random >> 12;
        self.random ^= self.random << 25;
        self.random ^= self.random >> 27;
        let bits = self.random.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 54;
        self.level = (bits as f64 - 512.0) / 1024.0;
    }
}
