//! Observer of a rigid machine from the motor's angle alone.

use super::tuning::{Disturbance, Encoder, Rate, Variances};
use super::{Error, Kalman, Matrix};
use crate::machine::Rigid;
use crate::math::sqrt;

/// A finished observer of a rigid machine.
///
/// The state is `[theta, omega, tau_L]` (rad, rad/s, N m), the input the motor's torque.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RigidDesign {
    /// Time between two ticks (s).
    pub period: f64,
    /// The machine that it observes.
    pub machine: Rigid,
    /// Transition of the state over a tick.
    pub transition: Matrix<3, 3>,
    /// The motor torque's effect on the state over a tick (state/(N m)).
    pub input: [f64; 3],
    /// Filter gain K, correction of each state per radian of innovation.
    pub gains: [f64; 3],
    /// Poles of the estimate's error, real and imaginary part.
    pub poles: [(f64, f64); 3],
    /// Largest size of a pole.
    pub spectral_radius: f64,
    /// Predicted standard deviations of angle (rad), speed (rad/s) and load torque (N m) after the measurement.
    pub standard_deviation: [f64; 3],
    /// Predicted standard deviation of the innovation (rad).
    pub innovation: f64,
}

impl Rigid {
    stops! {
        /// Designs the observer.
        pub const fn observer(
            &self,
            rate: Rate,
            encoder: Encoder,
            disturbance: Disturbance,
        ) -> RigidDesign = try_observer
    }

    /// [`observer`](Self::observer), with an error instead of a panic.
    ///
    /// # Errors
    /// A value out of range; [`Error::NotConverged`], also where a deviation is not a number, or
    /// [`Error::NotStabilising`].
    pub const fn try_observer(
        &self,
        rate: Rate,
        encoder: Encoder,
        disturbance: Disturbance,
    ) -> Result<RigidDesign, Error> {
        if !(self.inertia > 0.0 && self.inertia.is_finite()) {
            return Err(Error::Machine(crate::machine::Error::MotorInertia));
        }
        let variances = get!(Variances::of(rate, encoder, &disturbance));
        let t = variances.period;
        let (jump, glide) = (t / self.inertia, 0.5 * t * t / self.inertia);
        let transition = Matrix([[1.0, t, -glide], [0.0, 1.0, -jump], [0.0, 0.0, 1.0]]);
        let input = [glide, jump, 0.0];
        let mut noise = Matrix::<3, 1>::square_of(&input, variances.torque);
        noise.0[2][2] = variances.load_torque;
        let seen = Matrix([[1.0, 0.0, 0.0]]);
        let filter = get!(Kalman::<3, 1>::design(&transition, &seen, &noise, &Matrix([[variances.angle]])));
        let p = &filter.posterior.0;
        let standard_deviation = [sqrt(p[0][0]), sqrt(p[1][1]), sqrt(p[2][2])];
        let innovation = sqrt(filter.innovation.0[0][0]);
        // A NaN makes the sum one.
        if !(standard_deviation[0] + standard_deviation[1] + standard_deviation[2] + innovation).is_finite() {
            return Err(Error::NotConverged);
        }
        Ok(RigidDesign {
            period: t,
            machine: *self,
            transition,
            input,
            gains: filter.gain.transpose().0[0],
            poles: filter.poles,
            spectral_radius: filter.spectral_radius,
            standard_deviation,
            innovation,
        })
    }
}
