//! Gains of the speed loop: proportional, integral, and active damping of the shaft by the estimated twist rate.

use super::tuning::Rate;
use super::{Error, ExactStep, Matrix, eigenvalues, spectral_radius};
use crate::machine::TwoMass;
use crate::math::sqrt;

/// How the speed loop is to behave.
///
/// ```
/// use driveline::design::{Rate, SpeedLoopTuning};
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// const TWO: TwoMass = TwoMass::new(Inertia(0.5), Inertia(0.5), Stiffness(1.0e4), Damping(0.0));
/// // a third of the antiresonance, sqrt(1e4/0.5) = 141.4 rad/s
/// const CALM: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.3, ..SpeedLoopTuning::of(&TWO) };
/// assert!((TWO.speed_loop(Rate::hz(10_000), CALM).bandwidth - 42.43).abs() < 0.01);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "PID tuning")]
pub struct SpeedLoopTuning {
    /// Natural frequency of the speed over the antiresonance, above 0 and below 1; from 0.3 to 0.6 in practice. Above
    /// the resonance for a load that swings slowly: the motor holds its speed against the swing, which is left at
    /// about the antiresonance with a damping ratio of some hundredths. Its setpoint is for an
    /// [`InputShaper`](crate::governor::InputShaper).
    pub bandwidth: f64,
    /// Damping ratio of the speed.
    pub damping: f64,
    /// Damping ratio of the shaft's vibration.
    pub shaft_damping: f64,
}

impl SpeedLoopTuning {
    /// Brisk: 0.4 of the antiresonance, damping ratios 1 and 0.2. For a load of about the motor's inertia; others take
    /// [`of`](Self::of).
    pub const USUAL: Self = Self { bandwidth: 0.4, damping: 1.0, shaft_damping: 0.2 };

    /// Robust for a machine: as [`USUAL`](Self::USUAL), with the damping ratio of the shaft at which the gain on the
    /// twist rate is a tenth of the proportional one.
    ///
    /// A large gain on the twist rate, either way, costs margin, since its estimate lags. The proportional gain alone
    /// damps the shaft of a heavy load well and that of a light load little.
    #[must_use]
    pub const fn of(machine: &TwoMass) -> Self {
        Self::with_bandwidth(machine, Self::USUAL.bandwidth)
    }

    /// The same with another bandwidth (of the antiresonance), above 0 and below 1.
    #[must_use]
    pub const fn with_bandwidth(machine: &TwoMass, bandwidth: f64) -> Self {
        Self { bandwidth, ..Self::USUAL }.with_twist_gain(machine, Self::TWIST_GAIN)
    }

    /// The gain on the twist rate over the proportional one that [`of`](Self::of) takes.
    pub const TWIST_GAIN: f64 = 0.1;

    /// With the damping ratio of the shaft, from 1e-3 to 1e3, at which the gain on the twist rate is this ratio of the
    /// proportional one: the larger, the faster a swing decays, and the less margin the observer's lag leaves.
    pub(super) const fn with_twist_gain(self, machine: &TwoMass, ratio: f64) -> Self {
        let mut tuning = self;
        let (mut low, mut high) = (1e-3, 1e3);
        each!(halving, 0..40, {
            tuning.shaft_damping = sqrt(low * high);
            let [proportional, _, damping, _] = machine.speed_loop_gains(&tuning);
            if damping > ratio * proportional {
                high = tuning.shaft_damping;
            } else {
                low = tuning.shaft_damping;
            }
        });
        tuning
    }
}

/// A finished speed loop.
///
/// With `tau_m = K_p e + K_i int e - K_v v`, e the error of the motor's speed and v the twist rate, the undamped
/// machine has the closed loop `s^4 + (k_p + k_v) s^3 + (k_i + w_r^2) s^2 + k_p w_a^2 s + k_i w_a^2`. Its gains are per
/// motor inertia; w_r is the resonance and w_a the antiresonance. Setting it equal to `(s^2 + 2 z1 w1 s + w1^2)(s^2 + 2
/// z2 w2 s + w2^2)` fixes all gains and w2 once w1, z1, z2 are chosen:
///
/// - `(1 - b^2) w2^2 + 4 z1 z2 w1 w2 + w1^2 - w_r^2 = 0` with `b = w1/w_a`: one positive root for every b below 1, and
///   for every w1 above w_r;
/// - `k_i = b^2 w2^2`, `k_p = 2 w1 w2 (z1 w2 + z2 w1)/w_a^2`, `k_v = 2 z1 w1 + 2 z2 w2 - k_p`.
///
/// Pole placement by the coefficients, after [Zhang and Furusho 2000, IEEE Trans. Ind. Electron. 47(3)], with the twist
/// rate added.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpeedLoopDesign {
    /// Time between two ticks (s).
    pub period: f64,
    /// Proportional gain (N m s/rad) on the error of the motor's speed.
    pub proportional: f64,
    /// Integral gain (N m/rad).
    pub integral: f64,
    /// Active damping: gain on the twist rate (N m s/rad), subtracted from the torque.
    pub damping: f64,
    /// Time constant of the lag on the damping (s), 0 without: [`with_damping_lag`](Self::with_damping_lag).
    pub damping_lag: f64,
    /// Time constant of the lag on the motor's speed (s), 0 without: [`with_speed_lag`](Self::with_speed_lag).
    pub speed_lag: f64,
    /// Natural frequency of the speed (rad/s).
    pub bandwidth: f64,
    /// Natural frequency of the damped shaft (rad/s).
    pub shaft_frequency: f64,
    /// Largest size of a pole of the discrete closed loop.
    pub spectral_radius: f64,
}

impl SpeedLoopDesign {
    /// The same with a lag on the damping (s), for a governor with [`DampingLag`](crate::governor::DampingLag). The
    /// reciprocal of the resonance keeps the damping off vibrations of several times its frequency.
    #[must_use]
    pub const fn with_damping_lag(self, damping_lag: f64) -> Self {
        Self { damping_lag, ..self }
    }

    /// The same with a lag on the speed (s) of the proportional and integral part, for a governor with
    /// [`SpeedLag`](crate::governor::SpeedLag): a roll-off. A tenth to a fifth of the bandwidth's reciprocal keeps the
    /// loop off resonances that are not described or hardly damped, and costs some 6 to 20 degrees of phase.
    #[must_use]
    pub const fn with_speed_lag(self, speed_lag: f64) -> Self {
        Self { speed_lag, ..self }
    }
}

impl TwoMass {
    stops! {
        /// Designs the speed loop.
        ///
        /// The gains come from the undamped machine in continuous time; the poles from the damped machine, sampled, the
        /// torque acting one tick after its sample, with estimates taken as exact: the observer's own lag comes on top.
        pub const fn speed_loop(&self, rate: Rate, tuning: SpeedLoopTuning) -> SpeedLoopDesign = try_speed_loop
    }

    /// [`speed_loop`](Self::speed_loop), with an error instead of a panic.
    ///
    /// # Errors
    /// A value out of range, or [`Error::SpeedLoopUnstable`].
    pub const fn try_speed_loop(&self, rate: Rate, tuning: SpeedLoopTuning) -> Result<SpeedLoopDesign, Error> {
        get!(self.check(), Error::Machine);
        let period = get!(rate.period());
        let b = tuning.bandwidth;
        let placed = b > 0.0 && b < 1.0 || b * self.antiresonance() > self.resonance() && b.is_finite();
        if !(placed && self.stiffness > 0.0) {
            return Err(Error::Bandwidth);
        }
        let (z1, z2) = (tuning.damping, tuning.shaft_damping);
        if !(z1 > 0.0 && z1.is_finite() && z2 > 0.0 && z2.is_finite()) {
            return Err(Error::DampingRatio);
        }
        let w1 = b * self.antiresonance();
        let [proportional, integral, slip, w2] = self.speed_loop_gains(&tuning);

        let step = ExactStep::new(self, period);
        let spectral_radius =
            spectral_radius(&eigenvalues(&closed_loop(self, &step, period, proportional, integral, slip)));
        if spectral_radius.is_nan() || spectral_radius >= 1.0 {
            return Err(Error::SpeedLoopUnstable);
        }
        Ok(SpeedLoopDesign {
            period,
            proportional,
            integral,
            damping: slip,
            damping_lag: 0.0,
            speed_lag: 0.0,
            bandwidth: w1,
            shaft_frequency: w2,
            spectral_radius,
        })
    }

    /// Proportional gain, integral gain, gain on the twist rate, natural frequency of the damped shaft.
    pub(super) const fn speed_loop_gains(&self, tuning: &SpeedLoopTuning) -> [f64; 4] {
        let SpeedLoopTuning { bandwidth: b, damping: z1, shaft_damping: z2 } = *tuning;
        let (wa, wr) = (self.antiresonance(), self.resonance());
        let w1 = b * wa;
        // The positive root, without cancellation: c/(half + sqrt(half^2 + a c)), of negative a and c the other form.
        let half = 2.0 * z1 * z2 * w1;
        let (a, c) = ((1.0 - b) * (1.0 + b), (wr - w1) * (wr + w1));
        let sum = half + sqrt(half * half + a * c);
        let w2 = if b < 1.0 { c / sum } else { -sum / a };
        let kp = 2.0 * b * (w2 / wa) * (z1 * w2 + z2 * w1);
        let kv = 2.0 * (z1 * w1 + z2 * w2) - kp;
        let jm = self.motor_inertia;
        [jm * kp, jm * (b * w2) * (b * w2), jm * kv, w2]
    }
}

/// Closed loop of `[delta w_r, v, mean speed, integral part, torque]`, the last two over the motor's inertia and w_r.
const fn closed_loop(machine: &TwoMass, step: &ExactStep, t: f64, kp: f64, ki: f64, kv: f64) -> Matrix<5, 5> {
    let total = machine.total_inertia();
    let load = machine.load_inertia / total;
    let w = machine.resonance();
    let unit = machine.motor_inertia * w;
    // Motor speed = mean speed + load v; the integral includes the present sample.
    let (p, i, v) = (kp / unit, ki * t / unit, kv / unit);
    let whole = p + i;
    Matrix([
        [1.0 + step.n11, step.n12 * w, 0.0, 0.0, step.g1 * w * w],
        [step.n21 / w, 1.0 + step.n22, 0.0, 0.0, step.g2 * w],
        [0.0, 0.0, 1.0, 0.0, t * unit / total],
        [0.0, i * load, i, 1.0, 0.0],
        [0.0, -(whole * load + v), -whole, -1.0, 0.0],
    ])
}
