//! The signals of a recording as an observer takes them, and what it is compared with.

use std::f64::consts::TAU;

use crate::machine_file::Diagnostic;
use crate::recording::{Quantity, Recording, unwrapped};
use driveline::machine::TwoMass;

/// The torque between two samples of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Between {
    /// It runs straight from one sample to the next: a measured current.
    Straight,
    /// It stays as it was: a command.
    Held,
}

/// Inputs of each tick, and the measured motion of the load where there is one.
#[derive(Clone, Debug)]
pub struct Signals {
    /// Time from the first sample (s).
    pub time: Vec<f64>,
    /// Angle of the motor (2^-32 turn); none where a toothed wheel has none.
    pub angle: Vec<Option<u32>>,
    /// Mean torque over the tick that ends with the sample (N m).
    pub torque: Vec<f64>,
    /// Speed of the motor (rad/s), where it or its angle was recorded.
    pub motor_speed: Option<Vec<f64>>,
    /// Measured speed of the load (rad/s).
    pub load_speed: Option<Vec<f64>>,
    /// Torque of the shaft (N m): measured, from the measured twist, or that of the motor less what accelerates it.
    pub shaft_torque: Option<Vec<f64>>,
    /// Whether the shaft torque has no zero of its own: two encoders whose zeros differ.
    pub floating: bool,
    /// Measured load torque (N m).
    pub load_torque: Option<Vec<f64>>,
}

impl Signals {
    /// The signals of a recording of a machine. The torque acts `delay` (s) after its sample. Where there is a toothed
    /// wheel its angle in each tick is the motor's.
    ///
    /// # Errors
    /// A recording without torque, or without angle and speed of the motor.
    pub fn of(
        recording: &Recording,
        machine: Option<&TwoMass>,
        torque_constant: Option<f64>,
        between: Between,
        delay: f64,
        wheel: Option<Vec<Option<u32>>>,
    ) -> Result<Self, Diagnostic> {
        let period = recording.period;
        let torque = recording.torque(torque_constant)?;
        let integrated = || recording.signal(Quantity::Speed).map(|speed| integral(speed, period));
        let motion = recording.signal(Quantity::Angle).map(unwrapped).or_else(integrated);
        let Some(angle) = wheel.or_else(|| Some(motion.as_ref()?.iter().copied().map(turned).map(Some).collect()))
        else {
            return Err(recording.fault(recording.found(), "a column of the motor's angle or speed"));
        };
        let measured = |quantity| recording.signal(quantity).map(<[f64]>::to_vec);
        let motor_speed = measured(Quantity::Speed).or_else(|| Some(derivative(motion.as_ref()?, period)));
        let load_angle = recording.signal(Quantity::LoadAngle).map(unwrapped);
        let load_speed =
            measured(Quantity::LoadSpeed).or_else(|| load_angle.as_ref().map(|angle| derivative(angle, period)));
        let sensor = measured(Quantity::ShaftTorque);
        let both =
            machine.zip(motion.as_ref().zip(load_angle.as_ref())).zip(motor_speed.as_ref().zip(load_speed.as_ref()));
        let twisted = both.map(|((machine, (motor_angle, load_angle)), (motor_speed, load_speed))| {
            let twist = motor_angle.iter().zip(load_angle).map(|(motor, load)| motor - load);
            let rate = motor_speed.iter().zip(load_speed).map(|(motor, load)| motor - load);
            twist.zip(rate).map(|(twist, rate)| machine.stiffness * twist + machine.damping * rate).collect()
        });
        // of the motor's own balance J a = T - T_s; the torque is that of the two ticks about the sample
        let torque = over_ticks(&torque, between, delay / period);
        let around = torque.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).chain(torque.last().copied());
        let balance = |(machine, acceleration): (&TwoMass, &[f64])| {
            around
                .zip(acceleration)
                .map(|(torque, acceleration)| torque - machine.motor_inertia * acceleration)
                .collect()
        };
        let floating = sensor.is_none() && twisted.is_some();
        let balanced = machine.zip(recording.signal(Quantity::Acceleration)).map(balance);
        Ok(Self {
            time: (0..recording.len()).map(|sample| period * sample as f64).collect(),
            torque,
            floating,
            shaft_torque: sensor.or(twisted).or(balanced),
            load_torque: measured(Quantity::LoadTorque),
            angle,
            motor_speed,
            load_speed,
        })
    }
}

/// An angle (rad) as 2^32 per turn.
pub fn turned(angle: f64) -> u32 {
    // the remainder is below one, the product below 2^32 but for rounding, which the cast saturates
    ((angle / TAU).rem_euclid(1.0) * 4_294_967_296.0) as u32
}

fn integral(speed: &[f64], period: f64) -> Vec<f64> {
    let mut angle = 0.0;
    let mut last = speed.first().copied().unwrap_or(0.0);
    let step = |speed: &f64| {
        angle += 0.5 * period * (last + speed);
        last = *speed;
        angle
    };
    speed.iter().map(step).collect()
}

/// Central differences; one-sided at the ends.
fn derivative(angle: &[f64], period: f64) -> Vec<f64> {
    let last = angle.len().saturating_sub(1);
    let slope = |index: usize| {
        let (from, to) = (index.saturating_sub(1), (index + 1).min(last));
        (angle[to] - angle[from]) / (period * (to - from).max(1) as f64)
    };
    (0..angle.len()).map(slope).collect()
}

/// Mean torque of the tick that ends with each sample, `late` ticks late.
fn over_ticks(torque: &[f64], between: Between, late: f64) -> Vec<f64> {
    let at = |index: i64| torque[usize::try_from(index).unwrap_or(0).min(torque.len() - 1)];
    let (whole, part) = (late.floor() as i64, late - late.floor());
    let mean = |index: usize| {
        let end = index as i64 - whole;
        match between {
            Between::Held => part * at(end - 2) + (1.0 - part) * at(end - 1),
            Between::Straight => {
                let (first, middle, last) = (at(end - 2), at(end - 1), at(end));
                let rest = 1.0 - part;
                part * (first * 0.5 * part + middle * (1.0 - 0.5 * part))
                    + rest * (middle * (1.0 - 0.5 * rest) + last * 0.5 * rest)
            }
        }
    };
    (0..torque.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::{Between, over_ticks};

    #[test]
    fn the_mean_of_a_ramp_lags_by_half_a_tick_and_its_delay() {
        let ramp: Vec<f64> = (0..10).map(f64::from).collect();
        for late in [0.0, 0.3, 1.7] {
            let straight = over_ticks(&ramp, Between::Straight, late);
            // the mean of a straight line is its middle; rounding of sums of ten
            assert!((straight[7] - (7.0 - 0.5 - late)).abs() < 1e-12, "{straight:?}");
            let held = over_ticks(&ramp, Between::Held, late);
            assert!((held[7] - (6.0 - late)).abs() < 1e-12, "{held:?}");
        }
    }
}
