//! Observer of two masses from the motor's angle alone.

use super::tuning::{Disturbance, Encoder, Rate, Variances};
use super::{Error, ExactStep, Kalman, Matrix, SemiImplicitStep, StepChoice, eigenvalues, spectral_radius};
use crate::machine::TwoMass;
use crate::math::{exp, sqrt};

/// Share of a swing that may survive one tick where the resonance lies above half the sample rate.
const SURVIVING_SWING: f64 = 0.1;

/// Predicted standard deviations of the estimates, after the measurement of a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StandardDeviation {
    /// Motor angle (rad).
    pub motor_angle: f64,
    /// Motor speed (rad/s).
    pub motor_speed: f64,
    /// Twist (rad).
    pub twist: f64,
    /// Shaft torque (N m).
    pub shaft_torque: f64,
    /// Load speed (rad/s).
    pub load_speed: f64,
    /// Load torque (N m).
    pub load_torque: f64,
}

/// A finished observer of two masses.
///
/// The state is `[theta_m, omega_m, delta, omega_l, tau_L]` (rad, rad/s, rad, rad/s, N m), the input the motor's
/// torque. The transition is exact: momentum moves as one rigid machine, and the twist by [`ExactStep`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TwoMassDesign {
    /// Time between two ticks (s).
    pub period: f64,
    /// The machine that it observes.
    pub machine: TwoMass,
    /// The exact step of twist and twist rate.
    pub step: ExactStep,
    /// The cheap step, with its error.
    pub semi_implicit: SemiImplicitStep,
    /// Which of the two to take: at [`StepChoice::THRESHOLD`], the exact one where the error of the estimate grows with
    /// the other, unless [`with_step`](Self::with_step) overruled it.
    pub chosen: StepChoice,
    /// Transition of the state over a tick.
    pub transition: Matrix<5, 5>,
    /// The motor torque's effect on the state over a tick (state/(N m)).
    pub input: [f64; 5],
    /// Filter gain K, correction of each state per radian of innovation.
    pub gains: [f64; 5],
    /// Poles of the estimate's error, real and imaginary part.
    pub poles: [(f64, f64); 5],
    /// Largest size of a pole.
    pub spectral_radius: f64,
    /// Largest size of a pole with the semi-implicit step and the same gains; from 1 on the error grows.
    pub semi_implicit_radius: f64,
    /// Predicted standard deviations.
    pub standard_deviation: StandardDeviation,
    /// Predicted standard deviation of the innovation (rad).
    pub innovation: f64,
    /// Covariance after the measurement.
    pub posterior: Matrix<5, 5>,
}

impl TwoMass {
    stops! {
        /// Designs the observer.
        ///
        /// A backlash counts as closed, a weight as part of the load torque.
        pub const fn observer(
            &self,
            rate: Rate,
            encoder: Encoder,
            disturbance: Disturbance,
        ) -> TwoMassDesign = try_observer
    }

    /// Whether the sample rate can follow the shaft.
    ///
    /// # Errors
    /// [`Error::Period`] for a rate that is not positive; [`Error::SampleRate`] where the resonance lies above half of
    /// it and survives a tick.
    pub const fn try_follow(&self, rate: Rate) -> Result<(), Error> {
        let period = get!(rate.period());
        let decay = self.damping_ratio() * self.resonance();
        if self.damped_resonance() * period >= core::f64::consts::PI && exp(-decay * period) > SURVIVING_SWING {
            return Err(Error::SampleRate);
        }
        Ok(())
    }

    /// [`observer`](Self::observer), with an error instead of a panic.
    ///
    /// # Errors
    /// A value out of range; [`Error::Unobservable`] without stiffness; [`Error::SampleRate`] where the resonance lies
    /// above half the rate and more than a tenth of a swing survives a tick (a faster decay leaves nothing to follow);
    /// [`Error::NotConverged`] or [`Error::NotStabilising`].
    pub const fn try_observer(
        &self,
        rate: Rate,
        encoder: Encoder,
        disturbance: Disturbance,
    ) -> Result<TwoMassDesign, Error> {
        get!(self.check(), Error::Machine);
        let variances = get!(Variances::of(rate, encoder, &disturbance));
        let period = variances.period;
        if self.stiffness == 0.0 {
            return Err(Error::Unobservable);
        }
        get!(self.try_follow(rate));

        let step = ExactStep::new(self, period);
        let (transition, input) = transition(self, &step, period);
        let mut noise = Matrix::<5, 1>::square_of(&input, variances.torque);
        noise.0[4][4] += variances.load_torque;
        let seen = Matrix([[1.0, 0.0, 0.0, 0.0, 0.0]]);
        let filter = get!(Kalman::<5, 1>::design(&transition, &seen, &noise, &Matrix([[variances.angle]])));

        let semi_implicit = SemiImplicitStep::new(self, period);
        let p = &filter.posterior;
        let torque_row = Matrix([[0.0, self.damping, self.stiffness, -self.damping, 0.0]]);
        let shaft_torque = torque_row.times(p).times(&torque_row.transpose()).0[0][0];
        let gains = filter.gain.transpose().0[0];
        let radius = semi_implicit_radius(self, &gains, p, period);
        let chosen =
            if radius < 1.0 { StepChoice::choose(&semi_implicit, StepChoice::THRESHOLD) } else { StepChoice::Exact };
        Ok(TwoMassDesign {
            period,
            machine: *self,
            step,
            semi_implicit,
            chosen,
            transition,
            input,
            gains,
            poles: filter.poles,
            spectral_radius: filter.spectral_radius,
            semi_implicit_radius: radius,
            standard_deviation: StandardDeviation {
                motor_angle: sqrt(p.0[0][0]),
                motor_speed: sqrt(p.0[1][1]),
                twist: sqrt(p.0[2][2]),
                shaft_torque: sqrt(shaft_torque),
                load_speed: sqrt(p.0[3][3]),
                load_torque: sqrt(p.0[4][4]),
            },
            innovation: sqrt(filter.innovation.0[0][0]),
            posterior: *p,
        })
    }
}

impl TwoMassDesign {
    /// The same design with its choice of the step overruled: the semi-implicit one is cheaper, and wrong by
    /// [`SemiImplicitStep::fidelity`].
    #[must_use]
    pub const fn with_step(mut self, step: StepChoice) -> Self {
        self.chosen = step;
        self
    }
}

/// Largest size of a pole of the estimate's error where these gains correct the semi-implicit step, of the states
/// `[theta_m, omega_m, tau_s/k, omega_l, tau_L]`; the covariance is the unit.
const fn semi_implicit_radius(machine: &TwoMass, gains: &[f64; 5], covariance: &Matrix<5, 5>, t: f64) -> f64 {
    let TwoMass { motor_inertia: jm, load_inertia: jl, stiffness: k, damping, .. } = *machine;
    let (by_motor, by_load, lag) = (t * k / jm, t * k / jl, damping / k);
    let step = Matrix([
        [1.0, t, -t * by_motor, 0.0, 0.0],
        [0.0, 1.0, -by_motor, 0.0, 0.0],
        [0.0, t, 1.0 - (t + lag) * (by_motor + by_load), -t, (t + lag) * t / jl],
        [0.0, 0.0, by_load, 1.0, -t / jl],
        [0.0, 0.0, 0.0, 0.0, 1.0],
    ]);
    let [angle, motor, twist, load, torque] = *gains;
    let gain = Matrix([[angle], [motor], [twist + lag * (motor - load)], [load], [torque]]);
    let left = Matrix::IDENTITY.plus(-1.0, &gain.times(&Matrix([[1.0, 0.0, 0.0, 0.0, 0.0]])));
    let mut per = [1.0; 5];
    each!(i, 0..5, {
        if covariance.0[i][i] > 0.0 {
            per[i] = 1.0 / sqrt(covariance.0[i][i]);
        }
    });
    spectral_radius(&eigenvalues(&left.times(&step).scaled(&per, &per)))
}

/// Exact transition and input of the five states over a tick.
pub(super) const fn transition(machine: &TwoMass, step: &ExactStep, t: f64) -> (Matrix<5, 5>, [f64; 5]) {
    let (jm, jl, total) = (machine.motor_inertia, machine.load_inertia, machine.total_inertia());
    let (motor, load) = (jm / total, jl / total);
    // theta_m = mean angle + (J_l/J) delta; the mean angle moves as one rigid machine.
    let glide = 0.5 * t * t / total;
    // The twist rate's change splits in inverse proportion to the inertias, on top of the mean speed's T (tau_m -
    // tau_L)/J.
    let transition = Matrix([
        [1.0, t * motor + load * step.n12, load * step.n11, t * load - load * step.n12, load * step.g1 / jl - glide],
        [0.0, 1.0 + load * step.n22, load * step.n21, -load * step.n22, -step.lag / total],
        [0.0, step.n12, 1.0 + step.n11, -step.n12, step.g1 / jl],
        [0.0, -motor * step.n22, -motor * step.n21, 1.0 + motor * step.n22, -(t + jm / jl * step.g2) / total],
        [0.0, 0.0, 0.0, 0.0, 1.0],
    ]);
    let input = [glide + load * step.g1 / jm, (t + jl / jm * step.g2) / total, step.g1 / jm, step.lag / total, 0.0];
    (transition, input)
}
