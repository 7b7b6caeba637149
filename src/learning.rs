//! Learning: parameters of the machine that a data sheet gives roughly, identified while it runs.
//!
//! Each learner is a part of its own and costs nothing when it is left out. It changes a parameter only within a bound
//! and only where two findings agree, and returns a [`Finding`]. Its result can be kept in the record of parameters.
//! Data that it cannot use is left out. [`Learners`](crate::adaptive::Learners) are all of them in an adaptive drive.
//!
//! | learner | finds | from |
//! |---|---|---|
//! | [`GearLoss`] | friction of a gear per shaft torque | motor torque, up and down at a steady speed |
//! | [`TorqueConstant`] | torque constant and offset of the motor | the same under known loads |
//! | [`RunUp`] | inertia | motor torque above that of the steady motion, per change of the speed |
//! | [`MechanismFit`] | inertia and weight torque of a mechanism over its turn | work of the motor and speeds, in a run at two speeds |
//! | [`EccentricityObserver`] | eccentricity of the encoder | the innovation at once a turn |

mod eccentricity;
mod gear_loss;
mod mechanism;
mod record;
mod run_up;
mod steady;
mod torque_constant;

pub use eccentricity::{EccentricityConfig, EccentricityNumber, EccentricityObserver};
pub use gear_loss::{GearLoss, GearLossConfig};
pub use mechanism::{LearntMechanism, MechanismFit};
pub use record::{LearningBounds, Learnt};
pub use run_up::{RunUp, RunUpConfig};
pub use torque_constant::{TorqueCalibration, TorqueConstant, TorqueConstantConfig};

/// What an update of a learner has done.
///
/// ```
/// use driveline::learning::{Finding, GearLoss, GearLossConfig};
/// const CONFIG: GearLossConfig = GearLossConfig::new(300.0, 150.0, [0.8, 0.99], 0.01);
/// let mut learner = GearLoss::new(&CONFIG, 0.05);
/// // nothing to be learnt at a standstill, nor from one direction alone
/// let findings = [0.0, 100.0].map(|speed| (0..500).all(|_| learner.update(&CONFIG, 100.0, speed) == Finding::None));
/// assert_eq!(findings, [true, true]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Finding {
    /// Nothing is found yet.
    #[default]
    None,
    /// A first finding, to be confirmed by a second one.
    Unconfirmed,
    /// The parameter has changed.
    Changed,
    /// The parameter has changed and is at its bound: the machine differs by more, or something else is wrong.
    AtBound,
    /// A finding was left out: out of bounds, or it does not agree with the one before.
    Rejected,
}
