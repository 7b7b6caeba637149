//! Prediction of an observer's errors over the tolerances of machine, motor and encoder.

use super::complex::{Complex, over, times};
use super::observer::transition;
use super::tuning::Encoder;
use super::{EstimateError, LoadCycle, LoopObserver, Matrix, PlacedObserver, Tolerance, TwoMassDesign};
use crate::machine::TwoMass;
use crate::math::{exp, sin_cos, sqrt};

/// Conditions that errors are predicted for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Operation {
    /// Rated torque (N m), which an offset is a fraction of.
    pub rated_torque: f64,
    /// Motor torque (N m), rms.
    pub torque: f64,
    /// Acceleration (rad/s2), rms.
    pub acceleration: f64,
    /// Speed at which the encoder's errors act (rad/s).
    pub speed: f64,
    /// Noise of the reported torque (N m), rms.
    pub torque_noise: f64,
    /// The load cycle.
    pub cycle: LoadCycle,
}

/// Predicted errors by their causes.
///
/// To the first order, with deviations that are independent of one another, the squares of these parts add:
///
/// - **static**: at the motor's torque T and the acceleration a, a torque constant that is off by g, an offset o, a
///   gear's efficiency that is off by e and inertias that are off by `j_m`, `j_l` make errors of
///   `g^2 T^2 + o^2 + e^2 T^2 + j_m^2 a^2` of the shaft torque, squared, and with `(j_m + j_l)^2` of the load torque;
/// - **encoder**: a periodic error of the angle passes through the estimates as `C (1 - A/z)^-1 K`, A = (1 - K H) F the
///   observer's transition, at `z = e^(j w T)` with w the error's periods on a turn times the speed;
/// - **noise** of torque, count and jitter: white, by the covariance `P = A P A^T + K r K^T + b q b^T`,
///   b = (1 - K H) B;
/// - **swing**: a free swing of the shaft of a machine that differs from the model, with the eigenvalue s, turns the
///   motor by `theta`. It has the shaft torque `-J_m s^2 theta`; the estimates are the response above at `z = e^(s T)`.
///
/// A deviation is uniform within its tolerance: its variance is that of a uniform distribution, and means over the
/// machines are taken by Gauss' formula of three points for each of inertias and stiffness.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PredictedErrors {
    /// Torque constant, offset, efficiency and inertias.
    pub statics: EstimateError,
    /// Periodic errors of the encoder.
    pub encoder: EstimateError,
    /// Noise of torque and angle.
    pub noise: EstimateError,
    /// Swings after the changes of the load cycle.
    pub swing: EstimateError,
}

impl PredictedErrors {
    /// All together.
    #[must_use]
    pub const fn total(&self) -> EstimateError {
        self.statics.and(&self.encoder).and(&self.noise).and(&self.swing)
    }
}

/// An observer as a linear system of five states; one of one mass leaves two of them at zero.
pub(super) struct Linear {
    pub(super) period: f64,
    /// `A = (1 - K H) F`.
    transition: Matrix<5, 5>,
    gains: Matrix<5, 1>,
    /// `(1 - K H) B`.
    input: Matrix<5, 1>,
    /// Rows of shaft torque, load speed and load torque.
    outputs: Matrix<3, 5>,
    /// Share of the motor's torque in the shaft torque.
    through: f64,
}

impl Linear {
    pub(super) const fn of(observer: LoopObserver<'_>, nominal: &TwoMass) -> Self {
        let (period, transition, input, gains, outputs, through) = match observer {
            LoopObserver::TwoMass(TwoMassDesign { machine, step, gains, period, .. })
            | LoopObserver::Placed(PlacedObserver { machine, step, gains, period, .. }) => {
                let (transition, input) = transition(machine, step, *period);
                let TwoMass { stiffness: k, damping: d, .. } = *machine;
                let outputs = [[0.0, d, k, -d, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0, 1.0]];
                (*period, transition, input, *gains, Matrix(outputs), 0.0)
            }
            LoopObserver::Rigid(design) => {
                let share = nominal.load_inertia / nominal.total_inertia();
                let (mut transition, mut input, mut gains) = (Matrix::ZERO, [0.0; 5], [0.0; 5]);
                each!(i, 0..3, {
                    each!(j, 0..3, {
                        transition.0[i][j] = design.transition.0[i][j];
                    });
                    (input[i], gains[i]) = (design.input[i], design.gains[i]);
                });
                let outputs = [[0.0, 0.0, 1.0 - share, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0]];
                (design.period, transition, input, gains, Matrix(outputs), share)
            }
        };
        let gains = Matrix([gains]).transpose();
        let left = Matrix::IDENTITY.plus(-1.0, &gains.times(&Matrix([[1.0, 0.0, 0.0, 0.0, 0.0]])));
        Self {
            period,
            transition: left.times(&transition),
            gains,
            input: left.times(&Matrix([input]).transpose()),
            outputs,
            through,
        }
    }
}

impl Linear {
    /// States over the angle (rad/rad, ...) that a motion `z^n` of the measured angle brings about; not numbers where
    /// there are none.
    pub(super) const fn states(&self, z: Complex) -> [Complex; 5] {
        // (z - A) x = z K, states in units of their gains, real and imaginary part one below the other
        let mut system = Matrix::<10, 10>::ZERO;
        let mut right = Matrix::<10, 1>::ZERO;
        each!(i, 0..5, {
            each!(j, 0..5, {
                let entry = self.transition.0[i][j] * self.unit(j) / self.unit(i);
                (system.0[i][j], system.0[i + 5][j + 5]) = (-entry, -entry);
            });
            system.0[i][i] += z.0;
            system.0[i + 5][i + 5] += z.0;
            system.0[i][i + 5] -= z.1;
            system.0[i + 5][i] += z.1;
            let gain = self.gains.0[i][0] / self.unit(i);
            (right.0[i][0], right.0[i + 5][0]) = (z.0 * gain, z.1 * gain);
        });
        let mut states = [(f64::NAN, f64::NAN); 5];
        if let Some(found) = system.solve(&right) {
            each!(i, 0..5, {
                states[i] = (found.0[i][0] * self.unit(i), found.0[i + 5][0] * self.unit(i));
            });
        }
        states
    }

    /// Estimates over the angle (N m/rad, ...) that such a motion brings about.
    const fn response(&self, z: Complex) -> [Complex; 3] {
        let states = self.states(z);
        let mut outputs = [(0.0, 0.0); 3];
        each!(k, 0..3, {
            each!(j, 0..5, {
                let factor = self.outputs.0[k][j];
                outputs[k].0 += factor * states[j].0;
                outputs[k].1 += factor * states[j].1;
            });
        });
        // the accelerating torque of the tick that has ended has the load torque from before it
        let before = over(outputs[2], z);
        outputs[0].0 += self.through * (outputs[2].0 - before.0);
        outputs[0].1 += self.through * (outputs[2].1 - before.1);
        outputs
    }

    /// Unit of a state: its gain.
    const fn unit(&self, state: usize) -> f64 {
        let gain = self.gains.0[state][0].abs();
        if gain > 0.0 { gain } else { 1.0 }
    }

    /// Mean squares of the errors that a periodic error of the angle makes.
    const fn of_periodic(&self, amplitude: f64, frequency: f64) -> [f64; 3] {
        let (sine, cosine) = sin_cos(frequency * self.period);
        let outputs = self.response((cosine, sine));
        let mut squares = [0.0; 3];
        each!(k, 0..3, {
            squares[k] = 0.5 * amplitude * amplitude * (outputs[k].0 * outputs[k].0 + outputs[k].1 * outputs[k].1);
        });
        squares
    }

    /// Mean squares of the errors that white noise of angle and torque makes, of these variances.
    const fn of_white(&self, angle: f64, torque: f64) -> [f64; 3] {
        let mut sum = self.gains.times(&self.gains.transpose()).scaled(&[angle; 5], &[1.0; 5]);
        sum = sum.plus(torque, &self.input.times(&self.input.transpose()));
        let mut power = self.transition;
        // 2^20 ticks: the slowest observer has settled
        each!(doubling, 0..20, {
            sum = sum.plus(1.0, &power.times(&sum).times(&power.transpose()));
            power = power.times(&power);
        });
        let covariance = self.outputs.times(&sum).times(&self.outputs.transpose());
        let mut squares = [0.0; 3];
        each!(k, 0..3, {
            squares[k] = covariance.0[k][k];
        });
        let beside = self.outputs.times(&self.input).0[0][0];
        squares[0] += torque * self.through * (self.through + 2.0 * beside);
        squares
    }

    /// Mean squares of the errors over a free swing of a machine, per mean square of its shaft torque.
    const fn of_swing(&self, machine: &TwoMass) -> [f64; 3] {
        let (resonance, damping) = (machine.resonance(), machine.damping_ratio());
        if damping >= 1.0 {
            return [0.0; 3];
        }
        let s = (-damping * resonance, resonance * sqrt((1.0 - damping) * (1.0 + damping)));
        let size = exp(s.0 * self.period);
        let (sine, cosine) = sin_cos(s.1 * self.period);
        let estimated = self.response((size * cosine, size * sine));
        let square = times(s, s);
        let shaft = (-machine.motor_inertia * square.0, -machine.motor_inertia * square.1);
        let ratio = -machine.motor_inertia / machine.load_inertia;
        let truth = [shaft, (ratio * s.0, ratio * s.1), (0.0, 0.0)];
        let mut squares = [0.0; 3];
        each!(k, 0..3, {
            let error = over((estimated[k].0 - truth[k].0, estimated[k].1 - truth[k].1), shaft);
            squares[k] = error.0 * error.0 + error.1 * error.1;
        });
        squares
    }
}

/// Gauss' nodes of a uniform distribution from -1 to 1, and their weights.
const NODES: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];

impl TwoMass {
    /// Predicted errors of an observer of this machine, over the tolerances: the root of the mean square of all
    /// machines. `encoder` has its accuracy stated.
    #[must_use]
    pub const fn predicted_errors(
        &self,
        observer: LoopObserver<'_>,
        encoder: Encoder,
        tolerance: &Tolerance,
        operation: &Operation,
    ) -> PredictedErrors {
        let linear = Linear::of(observer, self);
        let Operation { rated_torque, torque, acceleration, speed, torque_noise, cycle } = *operation;

        let gain = tolerance.torque.mean_square() * torque * torque;
        let offset = rated_torque * rated_torque * tolerance.offset * tolerance.offset / 3.0;
        let loss = tolerance.efficiency * tolerance.efficiency / 3.0 * torque * torque;
        let motor = tolerance.motor_inertia.mean_square() * self.motor_inertia * self.motor_inertia;
        let load = tolerance.load_inertia.mean_square() * self.load_inertia * self.load_inertia;
        let square = acceleration * acceleration;
        let torques = gain + offset + loss;
        let statics = EstimateError::of([torques + motor * square, 0.0, torques + (motor + load) * square]);

        let [interpolation, eccentricity] = encoder.amplitudes;
        let periods = encoder.periods as f64 * speed;
        let mut periodic = linear.of_periodic(eccentricity, speed);
        let mut white = match encoder.resolution() {
            Ok(count) => count * count / 12.0 + encoder.jitter * encoder.jitter,
            Err(_) => f64::NAN,
        };
        if periods * linear.period < core::f64::consts::PI {
            periodic = sum(periodic, 1.0, linear.of_periodic(interpolation, periods));
        } else {
            // beyond half the rate: anywhere
            white += 0.5 * interpolation * interpolation;
        }
        let noise = linear.of_white(white, torque_noise * torque_noise);

        let mut swing = [0.0; 3];
        each!(index, 0..27, {
            let nodes = [NODES[index % 3], NODES[index / 3 % 3], NODES[index / 9]];
            let mut machine = *self;
            machine.motor_inertia *= tolerance.motor_inertia.mean_plus(nodes[0].0);
            machine.load_inertia *= tolerance.load_inertia.mean_plus(nodes[1].0);
            machine.stiffness *= tolerance.stiffness.mean_plus(nodes[2].0);
            let amplitude = machine.rms_until(cycle.every, machine.amplitude_after(&cycle));
            let weight = nodes[0].1 * nodes[1].1 * nodes[2].1 * amplitude * amplitude;
            swing = sum(swing, weight, linear.of_swing(&machine));
        });
        PredictedErrors {
            statics,
            encoder: EstimateError::of(periodic),
            noise: EstimateError::of(noise),
            swing: EstimateError::of(swing),
        }
    }
}

const fn sum(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}
