//! Design of observers and governors: from the machine to gains, margins and predicted errors.
//!
//! Every function is a `const fn` in `f64`. In a constant the compiler evaluates it, and the firmware holds nothing but
//! the coefficients; at run time (a machine read from a file, or commissioned in the field) it gives the same bits. A
//! design that cannot work is a compile error in a constant, and an [`Error`] with the same sentence from the `try_`
//! form.
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | period T | time between two ticks of the controller | s |
//! | twist delta | motor angle less load angle, referred to the motor | rad |
//! | twist rate v | rate of the twist, motor speed less load speed | rad/s |
//! | forcing s | `tau_m/J_m + tau_L/J_l`: acceleration of the twist | rad/s2 |
//! | filter gain K | correction of each state per radian of innovation, applied at the tick of the measurement | state/rad |
//! | prior, posterior | covariance before and after the measurement of a tick | state squared |

mod approximate;
mod backlash;
mod backlash_takeup;
mod barred;
mod closed_loop;
mod complex;
mod controller;
mod error;
mod estimate_error;
mod exponential;
mod flywheel;
mod geared_loop;
mod governor;
mod input_shaper;
mod kalman;
mod late_loop;
mod margins;
mod matrix;
mod mechanism;
mod natural_damping;
mod observer;
mod observer_choice;
mod placed;
mod plant;
mod poles;
mod polynomial;
mod predicted_error;
mod riccati;
mod rigid;
mod robustness;
mod scheduled_loop;
mod speed_loop;
mod speed_response;
mod step;
mod supervision;
mod tolerance;
mod tonnage;
mod torque_curve;
mod tuning;
mod undescribed;

pub use approximate::{Fidelity, SemiImplicitStep, StepChoice};
pub use backlash::{BacklashDesign, BacklashTuning};
pub use backlash_takeup::{BacklashTakeUpDesign, BacklashTakeUpTuning};
pub use barred::{BarredSpeeds, USUAL_MARGIN};
pub use closed_loop::{ClosedLoop, Ranges};
pub use controller::Controller;
pub use error::Error;
pub use estimate_error::EstimateError;
pub use exponential::{discretise, exponential};
pub use flywheel::{energy_swing, flywheel_inertia};
pub use geared_loop::LoopGears;
pub use governor::{Actuator, GovernorDesign, LoadFeedForward, VirtualInertia};
pub use input_shaper::InputShaperDesign;
pub use kalman::Kalman;
pub use late_loop::Averaging;
pub use margins::{CutLoop, Margins};
pub use matrix::Matrix;
pub use mechanism::MechanismDesign;
pub use natural_damping::NaturalDamping;
pub use observer::{StandardDeviation, TwoMassDesign};
pub use observer_choice::{LoadCycle, ObserverChoice, ObserverSelection, Penalty, Requirement};
pub use placed::PlacedObserver;
pub use plant::Plant;
pub use poles::{eigenvalues, spectral_radius};
pub use predicted_error::{Operation, PredictedErrors};
pub use riccati::doubling;
pub use rigid::RigidDesign;
pub use robustness::{LoopObserver, Robustness};
pub use speed_loop::{SpeedLoopDesign, SpeedLoopTuning};
pub use step::ExactStep;
pub use supervision::{LoadStep, Supervision};
pub use tolerance::{Spread, Tolerance};
pub use tonnage::ForceAccuracy;
pub use torque_curve::TorqueCurve;
pub use tuning::{Disturbance, Encoder, Rate};
pub use undescribed::Undescribed;
