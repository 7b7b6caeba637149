//! Limits of the supervision: how far a machine within its tolerances departs from what its drive expects.

use super::{Encoder, RigidDesign, Tolerance, TwoMassDesign};
use crate::configure::Rating;
use crate::settings::Screening;

/// Ticks within which a response is looked for: the observers' slowest poles have decayed by then.
const LONGEST: u32 = 30_000;

/// Limits of a drive's supervision, in SI units.
///
/// The observer's innovation answers within milliseconds to a torque that the drive knows nothing of. Its largest
/// response to a step of one newton metre, at the motor and at the load, follows from transition and gains. A machine
/// within its tolerances has such torques up to the error of the torque constant at the torque limit, the offset, the
/// acceleration of inertias that differ, and the largest step of its load. A fault is beyond their sum.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::design::Supervision;
/// // twice the torque limit in the shaft, a quarter over rated speed, a hundredth of a turn behind the brake
/// const LIMITS: Supervision = Roll::SUPERVISION;
/// assert_eq!((LIMITS.shaft_torque, LIMITS.speed), (1100.0, 187.5));
/// assert!((LIMITS.slip.to_degrees() - 3.6).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Supervision {
    /// Largest innovation, either way (rad).
    pub innovation: f64,
    /// Largest change of the load torque against its average over [`recent`](Self::recent) (N m).
    pub change: f64,
    /// Time over which the load torque is averaged (s).
    pub recent: f64,
    /// Least and largest load torque (N m).
    pub load_torque: [f64; 2],
    /// Largest torque of the shaft, either way (N m).
    pub shaft_torque: f64,
    /// Largest speed of motor and load, either way (rad/s).
    pub speed: f64,
    /// Largest difference of the reported torque from the commanded one, averaged over [`average`](Self::average)
    /// (N m).
    pub report: f64,
    /// Time over which the difference is averaged (s).
    pub average: f64,
    /// Turn of the motor behind a closed brake that counts as slipping (rad).
    pub slip: f64,
    /// Change of the torque under which a motor at rest has to turn (N m).
    pub breakaway: f64,
    /// Speed below which the motor is at rest (rad/s).
    pub still: f64,
    /// Duration of an innovation beyond its limit before a stop (s).
    pub sudden: f64,
    /// Duration beyond another limit before a stop (s).
    pub lasting: f64,
    /// Time within a stop in which the cause is determined (s).
    pub naming: f64,
    /// Torque by which a machine is stopped (N m).
    pub stop_torque: f64,
    /// Speed below which a machine has stopped (rad/s).
    pub standstill: f64,
}

/// Largest change of the load torque that belongs to the work.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadStep {
    /// Change (N m, at the motor).
    pub torque: f64,
    /// Time that it takes (s).
    pub rise: f64,
}

impl TwoMassDesign {
    /// Largest innovations (rad): after a step of one newton metre at the motor that was not reported, and after the
    /// load's step.
    #[must_use]
    pub const fn innovation_response(&self, load: &LoadStep) -> [f64; 2] {
        let ticks = 1.0 + load.rise / self.period;
        let share = load.torque / ticks;
        [self.largest_innovation(1.0, 0.0, 0), self.largest_innovation(0.0, share, ticks as u32)]
    }

    const fn largest_innovation(&self, motor: f64, load: f64, rise: u32) -> f64 {
        let [a, b, c, d, _] = self.transition.0;
        largest_innovation([a, b, c, d], self.gains, self.input, [motor, load], rise)
    }
}

impl RigidDesign {
    /// As [`TwoMassDesign::innovation_response`]; of one mass both answer alike.
    #[must_use]
    pub const fn innovation_response(&self, load: &LoadStep) -> [f64; 2] {
        let ticks = 1.0 + load.rise / self.period;
        let share = load.torque / ticks;
        [self.largest_innovation(1.0, 1), self.largest_innovation(share, ticks as u32)]
    }

    /// As two masses without a twist.
    const fn largest_innovation(&self, load: f64, rise: u32) -> f64 {
        let ([[a0, a1, a2], [b0, b1, b2], _], [k0, k1, k2]) = (self.transition.0, self.gains);
        let rows = [[a0, a1, 0.0, 0.0, a2], [b0, b1, 0.0, 0.0, b2], [0.0; 5], [0.0; 5]];
        largest_innovation(rows, [k0, k1, 0.0, 0.0, k2], [0.0; 5], [0.0, load], rise)
    }
}

/// The estimate's error advances by the transition, whose last state stays, and is corrected by its first element times
/// the gains `k`. The motor's torque acts by `u`; the load's rises in each of the first `rise` ticks.
// Written out: the compiler's evaluation takes thousands of ticks.
const fn largest_innovation(
    [a, b, c, d]: [[f64; 5]; 4],
    k: [f64; 5],
    u: [f64; 5],
    [motor, load]: [f64; 2],
    rise: u32,
) -> f64 {
    let (mut e0, mut e1, mut e2, mut e3, mut e4) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let (mut largest, mut at, mut tick) = (0.0, 0, 0);
    while tick < LONGEST && tick < rise + 64 + 8 * at {
        if tick < rise {
            e4 += load;
        }
        let innovation = a[0] * e0 + a[1] * e1 + a[2] * e2 + a[3] * e3 + a[4] * e4 + u[0] * motor;
        let p1 = b[0] * e0 + b[1] * e1 + b[2] * e2 + b[3] * e3 + b[4] * e4 + u[1] * motor;
        let p2 = c[0] * e0 + c[1] * e1 + c[2] * e2 + c[3] * e3 + c[4] * e4 + u[2] * motor;
        let p3 = d[0] * e0 + d[1] * e1 + d[2] * e2 + d[3] * e3 + d[4] * e4 + u[3] * motor;
        e0 = innovation - k[0] * innovation;
        e1 = p1 - k[1] * innovation;
        e2 = p2 - k[2] * innovation;
        e3 = p3 - k[3] * innovation;
        e4 -= k[4] * innovation;
        tick += 1;
        if innovation.abs() > largest {
            largest = innovation.abs();
            at = tick;
        }
    }
    largest
}

impl Supervision {
    /// Share of the limits that is added to them.
    const MARGIN: f64 = 0.25;

    /// Least time over which the load torque is averaged (s).
    const RECENT: f64 = 0.05;

    /// Ticks over which a figure is averaged at least.
    const TICKS: f64 = 64.0;

    /// Duration beyond a limit (s).
    const LASTING: f64 = 0.02;

    /// The limits of a machine, from its observer's [largest innovations](TwoMassDesign::innovation_response).
    ///
    /// - innovation: the response to the error of the torque constant at the torque limit, the offset, and a twentieth
    ///   of rated torque of friction, all at the motor, and to the step of the load, a quarter more; 0.15 counts and the
    ///   encoder's interpolation error
    /// - change of the load torque: these torques at the motor, and the part of the load's step within the average's
    ///   time, a quarter more
    /// - load torque: the torque limit, either way, and the error of the torque constant, and a twentieth more. With
    ///   more than this the motor cannot hold the speed
    /// - shaft torque: twice the torque limit, the dynamic factor of a sudden load
    /// - speed: a quarter over rated speed, above the largest setpoint of a sample
    /// - report: 1.2 % of the torque limit, over 10 ms and at least 64 ticks
    /// - slip of a brake: a hundredth of a turn
    /// - breakaway: 0.15 of rated torque; the motor stands below the speed that the ramp passes within 10 ms
    /// - 2 ms and three ticks beyond the innovation; 20 ms beyond another limit; 60 ms to determine the cause of a
    ///   stop, which is made with rated torque
    #[must_use]
    pub const fn of(
        rating: &Rating,
        [by_motor, by_load]: [f64; 2],
        tolerance: &Tolerance,
        encoder: Encoder,
        load: &LoadStep,
        ramp: f64,
        period: f64,
    ) -> Self {
        let (rated, limit) = (rating.torque.0, rating.torque_limit.0);
        let count = or_stop!(encoder.resolution());
        let constant = tolerance.torque.max - 1.0;
        let unknown = constant * limit + (tolerance.offset + 0.05) * rated;
        let within = by_motor * unknown + by_load;
        let least = Self::TICKS * period;
        let recent = if least > Self::RECENT { least } else { Self::RECENT };
        let part = if load.rise > recent { recent / load.rise } else { 1.0 };
        let most = limit * (1.0 + constant) * 1.05;
        Self {
            innovation: (1.0 + Self::MARGIN) * within + 0.15 * count + encoder.amplitudes[0],
            change: (1.0 + Self::MARGIN) * (unknown + load.torque * part),
            recent,
            load_torque: [-most, most],
            shaft_torque: 2.0 * limit,
            speed: 1.25 * rating.speed.0,
            report: 0.012 * limit,
            average: if least > 0.01 { least } else { 0.01 },
            slip: 0.01 * core::f64::consts::TAU,
            breakaway: 0.15 * rated,
            still: 0.25 * ramp * Self::LASTING,
            sudden: 2e-3,
            lasting: Self::LASTING,
            naming: 0.06,
            stop_torque: rated,
            standstill: 0.01 * rating.speed.0,
        }
    }

    /// The same, with an innovation of at most half of the one beyond which a sample is left out.
    #[must_use]
    pub const fn within(mut self, screening: &Screening) -> Self {
        let half = 0.5 * screening.innovation;
        if self.innovation > half {
            self.innovation = half;
        }
        self
    }
}
