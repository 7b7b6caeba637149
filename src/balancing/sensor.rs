//! Transfer of a vibration sensor: from its signal to the motion.

use super::reading::Phasor;

/// Quantity that a sensor measures, or a reading is converted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Motion {
    /// (m); a displacement sensor looks at the shaft.
    Displacement,
    /// (m/s).
    Velocity,
    /// (m/s2).
    Acceleration,
}

impl Motion {
    /// Times that the motion is differentiated.
    const fn order(self) -> i32 {
        match self {
            Motion::Displacement => 0,
            Motion::Velocity => 1,
            Motion::Acceleration => 2,
        }
    }
}

/// A sensor: its quantity and its transfer function.
///
/// Its transfer is `sensitivity (i w/high) / (1 + i w/high) / (1 + i w/low)`, a high-pass below and a low-pass above,
/// each of the first order.
///
/// ```
/// use driveline::balancing::{Motion, Phasor, Sensor};
/// // 10 mm/s at 100 rad/s are 0.1 mm and 1 m/s2
/// const PICKUP: Sensor = Sensor::ideal(Motion::Velocity);
/// let reading = Phasor { re: 0.01, im: 0.0 };
/// let travel = PICKUP.motion(reading, 100.0, Motion::Displacement)?.amplitude();
/// let acceleration = PICKUP.motion(reading, 100.0, Motion::Acceleration)?.amplitude();
/// assert!((travel - 1e-4).abs() < 1e-9 && (acceleration - 1.0).abs() < 1e-5);
/// # Ok::<(), driveline::balancing::SensorError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sensor {
    /// Measured quantity.
    pub motion: Motion,
    /// Units of the channel to the unit of motion.
    pub sensitivity: f32,
    /// Corner below which it gives less (rad/s); 0 for none.
    pub high_pass: f32,
    /// Corner above which it gives less (rad/s); infinite for none.
    pub low_pass: f32,
    /// Angle that it is mounted at, from the rotor's zero in the sense of turning (rad).
    pub angle: f32,
}

sentences! {
    /// A parameter of a sensor that is out of its range, or a reading that it cannot give.
    SensorError:
    Sensitivity => "the sensor's sensitivity must be a number above zero",
    HighPass => "the sensor's lower corner must be a number, zero for none",
    LowPass => "the sensor's upper corner must be above zero, infinite for none",
    Angle => "the sensor's angle must be a number of radians within ten turns",
    Frequency => "the frequency of the reading must be a number above zero",
    Phasor => "the sensor's phasor is not a number",
}

/// Largest angle of mounting: ten turns, larger than any angle in radians; most numbers of degrees are beyond it.
const MOST_ANGLE: f32 = 10.0 * core::f32::consts::TAU;

impl Sensor {
    /// A sensor that gives the motion as it is.
    pub const fn ideal(motion: Motion) -> Self {
        Sensor { motion, sensitivity: 1.0, high_pass: 0.0, low_pass: f32::INFINITY, angle: 0.0 }
    }

    /// The motion at `frequency` (rad/s), above 0, behind a phasor of the channel: in m, m/s or m/s2.
    ///
    /// The phase is that of a sensor at the rotor's zero only where the bearings are alike in all directions.
    ///
    /// # Errors
    /// [`SensorError`]: an invalid parameter of the sensor or the reading.
    pub fn motion(&self, phasor: Phasor, frequency: f32, wanted: Motion) -> Result<Phasor, SensorError> {
        let above_zero = |value: f32| value > 0.0 && value < f32::INFINITY;
        let sound = [
            (above_zero(self.sensitivity), SensorError::Sensitivity),
            (self.high_pass >= 0.0 && self.high_pass < f32::INFINITY, SensorError::HighPass),
            (self.low_pass > 0.0, SensorError::LowPass),
            ((-MOST_ANGLE..=MOST_ANGLE).contains(&self.angle), SensorError::Angle),
            (above_zero(frequency), SensorError::Frequency),
            (phasor.re.is_finite() && phasor.im.is_finite(), SensorError::Phasor),
        ];
        if let Some((_, error)) = sound.iter().find(|(sound, _)| !sound) {
            return Err(*error);
        }
        // (1 + i w/low) (1 + high/(i w)) / sensitivity
        let passed = phasor
            .times(Phasor { re: 1.0, im: frequency / self.low_pass })
            .times(Phasor { re: 1.0, im: -self.high_pass / frequency })
            .scaled(1.0 / self.sensitivity);
        let wanted = match wanted.order() - self.motion.order() {
            0 => passed,
            1 => passed.times(Phasor { re: 0.0, im: frequency }),
            2 => passed.scaled(-frequency * frequency),
            -1 => passed.times(Phasor { re: 0.0, im: -1.0 / frequency }),
            _ => passed.scaled(-1.0 / (frequency * frequency)),
        };
        // (cos, sin) of the angle of mounting; a sensor further round has the same signal later
        let (sine, cosine) = crate::math::sin_cos(f64::from(self.angle));
        Ok(wanted.times(Phasor { re: cosine as f32, im: sine as f32 }))
    }
}
