//! Every public type can be logged: this does not compile where one cannot.

use crate::{balance, constants, design, drive, fault, governor, machine, number, observer, sample};

const fn is_logged<T: defmt::Format>() {}

macro_rules! all {
    ($($type:ty),+ $(,)?) => { $(is_logged::<$type>();)+ };
}

macro_rules! all_of_number {
    ($($number:ty),+) => {$(
        all!(
            drive::Limits<$number>,
            drive::Config<$number, observer::TwoMassConfig<$number>, (), governor::SpeedLoopConfig<$number>, ()>,
            drive::Drive<$number, observer::TwoMass<$number>, (), governor::SpeedLoop<$number>, ()>,
            governor::SpeedLoop<$number>,
            governor::SpeedLoopConfig<$number>,
            balance::Phasors<$number, 2, 9>,
            balance::PhasorsConfig<$number, 2>,
            observer::Geared<observer::Rigid<$number>>,
            observer::GearedConfig<$number, observer::RigidConfig<$number>>,
            observer::GearedPrediction<observer::RigidPrediction<$number>>,
            observer::Rigid<$number>,
            observer::RigidConfig<$number>,
            observer::RigidPrediction<$number>,
            observer::SemiImplicit<$number>,
            observer::SemiImplicitConfig<$number>,
            observer::SemiImplicitPrediction<$number>,
            observer::TwoMass<$number>,
            observer::TwoMassConfig<$number>,
            observer::TwoMassPrediction<$number>,
            sample::Command<$number>,
            sample::Estimate<$number>,
            sample::Sample<$number>,
        );
    )+};
}

const _: () = {
    all_of_number!(f32, f64, number::Fixed);
    all!(
        balance::Doubt,
        balance::Motion,
        balance::Phasor,
        balance::Reading,
        balance::Sensor,
        balance::Steadiness,
        balance::Turning,
        balance::TurningConfig,
        constants::Bases,
        constants::Error,
        constants::Gear,
        constants::Measured,
        constants::MeasuredError,
        constants::Screening,
        constants::SpeedLoopSettings,
        design::ApproximateStep,
        design::Disturbance,
        design::Doubling<5>,
        design::Encoder,
        design::Error,
        design::ExactStep,
        design::Fidelity,
        design::Kalman<5, 1>,
        design::Margins,
        design::Matrix<5, 5>,
        design::Rate,
        design::RigidDesign,
        design::SemiImplicitStep,
        design::SpeedLoopDesign,
        design::SpeedLoopTuning,
        design::StandardDeviation,
        design::StepChoice,
        design::TwoMassDesign,
        fault::Faults,
        machine::Chain,
        machine::Damping,
        machine::Diameter,
        machine::Efficiency,
        machine::Element,
        machine::Error,
        machine::Falls,
        machine::Flow,
        machine::Gap,
        machine::Inertia,
        machine::Length,
        machine::LinearDamping,
        machine::Mass,
        machine::Match,
        machine::Mode,
        machine::Modes,
        machine::Part,
        machine::Planetary,
        machine::Ratio,
        machine::ReductionError,
        machine::Rigid,
        machine::Shaft,
        machine::Side,
        machine::Speed,
        machine::Stiffness,
        machine::Torque,
        machine::TwoMass,
        machine::Worth,
        number::Coefficient,
        number::Fixed,
    );
};

#[cfg(feature = "balancing")]
const _: () = {
    all!(
        balance::Entry,
        balance::Halt,
        balance::InRunConfig<f32, 1>,
        balance::Mode,
        balance::Objective,
        balance::Refusal,
        balance::Step,
        balance::Tolerance<f32>,
        balance::Verdict<f32>,
    );
};
