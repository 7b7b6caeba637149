//! The semi-implicit two-mass observer: for soft shafts that are sampled fast.

use super::{AngleTracker, Observer, Prediction};
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`SemiImplicitObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for
/// floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SemiImplicitConfig<N: Number> {
    /// T/J_m.
    pub motor: N::Coefficient,
    /// T/J_l.
    pub load: N::Coefficient,
    /// Shaft torque from the new and from the old twist rate: k T + d and -d.
    pub shaft: [N::Coefficient; 2],
    /// Turn of the motor from its new speed (2^-32 turn).
    pub turn: N::Coefficient,
    /// Correction of motor speed, load speed, shaft torque and load torque per innovation.
    pub correction: [N::Coefficient; 4],
    /// The share of an innovation that is taken off the residual.
    pub angle_correction: N::Coefficient,
    /// Speed from a turn in a tick [rad/s per 2^-32 turn].
    pub speed: N::Coefficient,
}

/// The observer of two masses with the semi-implicit step.
///
/// Speeds first, from the torques as they were, then the shaft torque from the speeds as they have become:
///
/// ```text
/// omega_m' = omega_m + T/J_m (tau_m - tau_s)
/// omega_l' = omega_l + T/J_l (tau_s - tau_L)
/// tau_s'   = tau_s + (k T + d) (omega_m' - omega_l') - d (omega_m - omega_l)
/// ```
///
/// Symplectic Euler: the undamped pair turns on an ellipse that closes, whatever the rounding, as long as omega T < 2;
/// its frequency is high by (omega T)^2/24. `design` states the error of both and chooses between this step and the
/// exact one.
///
/// ```
/// use driveline::design::{Disturbance, Encoder, Rate};
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// use driveline::observer::{Observer, SemiImplicitConfig, SemiImplicitObserver};
/// use driveline::settings::Bases;
/// const HOIST: TwoMass = TwoMass::new(Inertia(0.62), Inertia(0.35), Stiffness(900.0), Damping(0.5));
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 2.0, load_torque_step: 100.0, within: 10.0 };
/// const CONFIG: SemiImplicitConfig<f64> =
///     SemiImplicitConfig::<f64>::new(&HOIST.observer(Rate::hz(10_000), Encoder::lines(2048), LOAD), Bases::SI);
/// let mut observer = SemiImplicitObserver::<f64>::at_rest(&CONFIG, 0, 0.0);
/// // two seconds of 50 rad/s2 under 50 (0.62 + 0.35) N m, without load: the shaft accelerates 0.35 kg m2
/// for tick in 1..=20_000 {
///     let turns = 25.0 * (tick as f64 * 1e-4).powi(2) / core::f64::consts::TAU;
///     observer.step(&CONFIG, (turns.fract() * 4_294_967_296.0) as u32, 48.5);
/// }
/// let estimate = observer.estimate(&CONFIG);
/// assert!((estimate.shaft_torque - 17.5).abs() < 0.1 && estimate.load_torque.abs() < 0.1);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub struct SemiImplicitObserver<N = f32> {
    shaft_torque: N,
    load_speed: N,
    load_torque: N,
    motor_speed: N,
    angle: AngleTracker<N>,
}

impl<N: Number> Observer<N> for SemiImplicitObserver<N> {
    type Config = SemiImplicitConfig<N>;
    type States = [N; 4];

    fn steady(_config: &SemiImplicitConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        let speed = speed.saturated();
        SemiImplicitObserver {
            motor_speed: speed,
            load_speed: speed,
            shaft_torque: torque,
            load_torque: torque,
            angle: AngleTracker::new(angle),
        }
    }

    tracked!();

    #[inline(always)]
    fn predict(&self, config: &SemiImplicitConfig<N>, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let mut carry = N::CARRY;
        let accelerating = torque - self.shaft_torque;
        let motor_speed = self.motor_speed.accumulate(&mut carry, [config.motor], [accelerating]);
        let accelerating = self.shaft_torque - self.load_torque;
        let load_speed = self.load_speed.accumulate(&mut carry, [config.load], [accelerating]);
        let twist_rates = [motor_speed - load_speed, self.motor_speed - self.load_speed];
        let shaft_torque = self.shaft_torque.accumulate(&mut carry, config.shaft, twist_rates);
        let states = [motor_speed, load_speed, shaft_torque, self.load_torque];
        self.angle.predict(states, ([config.turn], [motor_speed]), angle, carry)
    }

    #[inline(always)]
    fn correct(&mut self, config: &SemiImplicitConfig<N>, predicted: Prediction<N, Self::States>, angle: u32) {
        let states = [&mut self.motor_speed, &mut self.load_speed, &mut self.shaft_torque, &mut self.load_torque];
        self.angle.correct(predicted, config.correction, &config.angle_correction, angle, states);
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        [self.motor_speed, self.load_speed, self.shaft_torque, _] = self.angle.coast(predicted, angle);
    }

    #[inline(always)]
    fn estimate(&self, _config: &SemiImplicitConfig<N>) -> Estimate<N> {
        Estimate {
            motor_speed: self.motor_speed,
            shaft_torque: self.shaft_torque,
            load_speed: self.load_speed,
            load_torque: self.load_torque,
        }
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        N::beyond_base([self.motor_speed, self.shaft_torque, self.load_speed, self.load_torque])
    }
}
