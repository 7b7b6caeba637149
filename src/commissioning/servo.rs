//! The servo that holds the motor to a moving reference: a rigid observer of deviation, speed and disturbance, and a
//! state feedback.

use super::TestConfig;

/// Gains over a block, of a machine of one inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Servo {
    inertia: f32,
    /// 1/inertia.
    lightness: f32,
    /// Corrections of deviation, speed and disturbance per radian of innovation.
    correct: [f32; 3],
    /// Torque per radian and per rad/s of deviation.
    feedback: [f32; 2],
}

/// State of the servo: deviations from the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Deviation {
    /// Angle (rad).
    pub angle: f32,
    /// Speed (rad/s).
    pub speed: f32,
    /// Torque other than the motor's (N m).
    pub disturbance: f32,
}

impl Servo {
    /// The servo of a machine of this inertia (kg m2).
    ///
    /// The observer has three equal poles three times as fast as the servo's two [critically damped filter of third
    /// order: Benedict and Bordner 1962].
    pub(crate) fn new(config: &TestConfig, inertia: f64) -> Self {
        Self::of(config, inertia, config.servo)
    }

    /// A slow one, three times: for a motor whose load friction holds on a spring. The servo's integral takes damping
    /// from that swing, by the third power of its own frequency.
    pub(crate) fn slow(config: &TestConfig, inertia: f64) -> Self {
        Self::of(config, inertia, config.servo / 3.0)
    }

    /// A quick one, for the swing of the shaft: its observer's poles are at half of the band's upper end, of whose
    /// period a block is a twelfth. A resonance at two fifths of that end is seen at half of its size.
    pub(crate) fn quick(config: &TestConfig, inertia: f64) -> Self {
        Self::of(config, inertia, core::f64::consts::TAU / (72.0 * config.block))
    }

    fn of(config: &TestConfig, inertia: f64, w: f64) -> Self {
        let h = config.block;
        let rho = crate::math::exp(-3.0 * w * h);
        let left = 1.0 - rho;
        let square = left * left;
        Self {
            inertia: inertia as f32,
            lightness: (1.0 / inertia) as f32,
            correct: [
                (1.0 - rho * rho * rho) as f32,
                (1.5 * square * (1.0 + rho) / h) as f32,
                (inertia * square * left / (h * h)) as f32,
            ],
            feedback: [(inertia * w * w) as f32, (2.0 * inertia * w) as f32],
        }
    }

    /// One block: the measurement under `torque`, while the reference accelerated.
    #[inline(always)]
    pub(crate) fn observe(&self, state: &mut Deviation, h: f32, measured: f32, torque: f32, acceleration: f32) {
        let gain = (torque + state.disturbance) * self.lightness - acceleration;
        state.angle += h * (state.speed + 0.5 * h * gain);
        state.speed += h * gain;
        let innovation = measured - state.angle;
        let [angle, speed, disturbance] = self.correct;
        state.angle += angle * innovation;
        state.speed += speed * innovation;
        state.disturbance += disturbance * innovation;
    }

    /// The torque that takes the deviation away.
    #[inline(always)]
    pub(crate) fn torque(&self, state: &Deviation, acceleration: f32) -> f32 {
        let [angle, speed] = self.feedback;
        self.inertia * acceleration - angle * state.angle - speed * state.speed - state.disturbance
    }
}
