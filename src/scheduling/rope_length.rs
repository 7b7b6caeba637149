//! Length of a hoist's rope, from the turns of its motor.

/// Length of a rope (m) that shortens as the motor turns forwards.
///
/// The angle wraps within a turn; between two updates the motor may turn further. The whole turns between them are
/// those of the speed, whose mean must be right to half a turn.
///
/// ```
/// use driveline::scheduling::RopeLength;
/// // 12 m of rope, 0.02 m a radian; a second up at 100 rad/s, looked at twenty times: 5 rad each
/// let mut rope = RopeLength::new(0.02, 12.0, 0);
/// for look in 1..=20 {
///     let turns = 5.0 * look as f64 / core::f64::consts::TAU;
///     rope.update((turns.fract() * 4_294_967_296.0) as u32, 100.0, 0.05);
/// }
/// assert!((rope.length() - (12.0 - 0.02 * 100.0)).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RopeLength {
    /// Travel per angle of the motor [m per 2^-32 turn].
    travel: f32,
    /// Turns of the motor up from the start (2^-32 turn).
    wound: i64,
    /// Length at the start (m).
    start: f32,
    angle: u32,
    speed: f32,
}

/// Units of the angle to the radian.
const PER_RADIAN: f32 = (4_294_967_296.0 / core::f64::consts::TAU) as f32;

impl RopeLength {
    /// A rope of this length now (m), whose load moves by `travel` per angle of the motor (m/rad), at rest at
    /// `angle` (2^-32 turn).
    pub fn new(travel: f32, length: f32, angle: u32) -> Self {
        RopeLength { travel: travel / PER_RADIAN, wound: 0, start: length, angle, speed: 0.0 }
    }

    /// Takes angle (2^-32 turn) and speed of the motor (rad/s), `elapsed` (s) after the last update. A speed that
    /// is not finite counts as the last one, such a time as none.
    pub fn update(&mut self, angle: u32, speed: f32, elapsed: f32) -> f32 {
        let speed = if speed.is_finite() { speed } else { self.speed };
        let elapsed = if elapsed.is_finite() { elapsed } else { 0.0 };
        let predicted = (0.5 * (self.speed + speed) * elapsed * PER_RADIAN) as i64;
        let beside = angle.wrapping_sub(self.angle).wrapping_sub(predicted as u32) as i32;
        self.wound = self.wound.saturating_add(predicted.saturating_add(i64::from(beside)));
        (self.angle, self.speed) = (angle, speed);
        self.length()
    }

    /// The present length (m).
    pub fn length(&self) -> f32 {
        self.start - self.wound as f32 * self.travel
    }

    /// Starts anew from a known length (m), as at a limit switch.
    pub fn resync(&mut self, length: f32) {
        (self.start, self.wound) = (length, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::RopeLength;

    #[test]
    fn turns_between_two_updates_are_counted_by_the_speed() {
        // Up at 3 turns in an update, from rest by a ramp of ten updates, and down again.
        let travel = 0.01;
        let mut rope = RopeLength::new(travel, 30.0, 0xf000_0000);
        let (mut turned, mut speed) = (0.0_f64, 0.0_f64);
        let steps = (0..10).map(|_| 0.3).chain((0..100).map(|_| 0.0)).chain((0..20).map(|_| -0.3));
        for change in steps.chain((0..100).map(|_| 0.0)) {
            let next = speed + change;
            turned += 0.5 * (speed + next);
            speed = next;
            let angle = 0xf000_0000_u32.wrapping_add((turned.rem_euclid(1.0) * 4_294_967_296.0) as u32);
            // 20 updates a second: a turn in an update is 40 pi rad/s
            rope.update(angle, (speed * 40.0 * core::f64::consts::PI) as f32, 0.05);
        }
        let expected = 30.0 - 0.01 * turned * core::f64::consts::TAU;
        // f32 of 30 m: 2e-6
        assert!((f64::from(rope.length()) - expected).abs() < 1e-5, "{} {expected}", rope.length());
        rope.resync(12.0);
        assert_eq!(rope.length(), 12.0);
        // what cannot be neither stops the drive nor leaves a length that is not a number
        for (speed, elapsed) in [(f32::MAX, 1.0), (f32::MAX, f32::INFINITY), (f32::NAN, f32::NAN), (-f32::MAX, 1e30)] {
            assert!(rope.update(7, speed, elapsed).is_finite());
        }
    }
}
